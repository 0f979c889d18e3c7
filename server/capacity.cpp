#include "server/capacity.hpp"

#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <thread>
#include <vector>

namespace tubecut::server {
namespace {

/// Of the memory allowed, for bodies, jobs and answers; the rest is for the program, the log, the
/// allocator's gaps and what a job needs beyond its estimate.
constexpr double kShare = 0.6;

std::string first_line(const std::string& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

/// The group's folders from its own up to the root: a limit of any of them binds.
std::vector<std::string> folders(const std::string& root, const std::string& self) {
  std::string path;
  std::ifstream in(self);
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("0::")) path = line.substr(3);
  }
  std::vector<std::string> all;
  for (; path.size() > 1; path = path.substr(0, path.rfind('/'))) all.push_back(root + path);
  all.push_back(root);
  return all;
}

int quota_slots(const std::vector<std::string>& groups) {
  int least = 0;
  for (const auto& group : groups) {
    const int slots = slots_of_quota(first_line(group + "/cpu.max"));
    if (slots > 0) least = least == 0 ? slots : std::min(least, slots);
  }
  return least;
}

int affinity_slots() {
  cpu_set_t set;
  CPU_ZERO(&set);
  return sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 0;
}

double group_memory(const std::vector<std::string>& groups) {
  double least = 0.0;
  for (const auto& group : groups) {
    double bytes = 0.0;
    std::istringstream(first_line(group + "/memory.max")) >> bytes;  // "max" leaves 0
    if (bytes > 0.0) least = least == 0.0 ? bytes : std::min(least, bytes);
  }
  return least;
}

double machine_memory() {
  return static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
}

}  // namespace

int slots_of_quota(std::string_view cpu_max) {
  double quota = 0.0;
  double period = 0.0;
  std::istringstream in{std::string(cpu_max)};
  if (!(in >> quota >> period) || quota <= 0.0 || period <= 0.0) return 0;  // "max 100000"
  return std::max(1, static_cast<int>(std::ceil(quota / period)));
}

Capacity capacity(const std::string& root, const std::string& self) {
  const auto groups = folders(root, self);
  const int machine = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const int affinity = affinity_slots();
  const int quota = quota_slots(groups);
  Capacity out{.slots = machine, .slots_from = "machine"};
  if (affinity > 0 && affinity < out.slots) {
    out.slots = affinity;
    out.slots_from = "affinity";
  }
  if (quota > 0 && quota <= out.slots) {
    out.slots = quota;
    out.slots_from = "cgroup";
  }
  const double group = group_memory(groups);
  if (group > 0.0 && group < machine_memory()) out.memory_from = "cgroup";
  const double bytes = out.memory_from == "cgroup" ? group : machine_memory();
  out.memory = static_cast<std::size_t>(kShare * bytes);
  return out;
}

}  // namespace tubecut::server
