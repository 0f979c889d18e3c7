#include "server/jobs/capacity.hpp"

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

/// Fraction of the permitted memory for bodies, jobs and answers; the rest is for the program, the
/// log and the allocator's gaps.
constexpr double kShare = 0.6;

std::string first_line(const std::string& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

/// Returns whether a line "4:cpu,cpuacct:/a/b" of /proc/self/cgroup belongs to the controller;
/// version 2 names no controller.
bool is_of(const std::string& line, std::string_view controller) {
  const auto first = line.find(':'), second = line.find(':', first + 1);
  if (second == std::string::npos) return false;
  const auto names = line.substr(first + 1, second - first - 1);
  if (controller.empty() || names.empty()) return controller.empty() && names.empty();
  std::istringstream in(names);
  for (std::string name; std::getline(in, name, ',');)
    if (name == controller) return true;
  return false;
}

/// Returns the group's folders from its own up to the root, because a limit of any of them binds.
/// For version 2, or for one controller of version 1, whose folder is named after it below the
/// root.
std::vector<std::string> folders(const std::string& root, const std::string& self,
                                 const std::string& controller = "") {
  std::string path;
  std::ifstream in(self);
  for (std::string line; std::getline(in, line);)
    if (is_of(line, controller)) path = line.substr(line.find(':', line.find(':') + 1) + 1);
  const auto base = controller.empty() ? root : root + "/" + controller;
  std::vector<std::string> all;
  for (; path.size() > 1; path = path.substr(0, path.rfind('/'))) all.push_back(base + path);
  all.push_back(base);
  return all;
}

/// Returns the minimum of the values that are present.
template <class Number>
void take_least(Number& least, Number said) {
  if (said > Number{}) least = least == Number{} ? said : std::min(least, said);
}

int quota_slots(const std::string& root, const std::string& self) {
  int least = 0;
  for (const auto& group : folders(root, self))
    take_least(least, slots_of_quota(first_line(group + "/cpu.max")));
  for (const auto& group : folders(root, self, "cpu"))
    take_least(least, slots_of_quota(first_line(group + "/cpu.cfs_quota_us") + " " +
                                     first_line(group + "/cpu.cfs_period_us")));
  return least;
}

int affinity_slots() {
  cpu_set_t set;
  CPU_ZERO(&set);
  return sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 0;
}

double group_memory(const std::string& root, const std::string& self) {
  double least = 0.0;
  const auto read = [&least](const std::string& file) {
    double bytes = 0.0;
    std::istringstream(first_line(file)) >> bytes;  // "max" leaves 0
    take_least(least, bytes);
  };
  for (const auto& group : folders(root, self)) read(group + "/memory.max");
  for (const auto& group : folders(root, self, "memory")) read(group + "/memory.limit_in_bytes");
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
  const int machine = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const int affinity = affinity_slots();
  const int quota = quota_slots(root, self);
  Capacity out{.slots = machine, .slots_from = "machine"};
  if (affinity > 0 && affinity < out.slots) {
    out.slots = affinity;
    out.slots_from = "affinity";
  }
  if (quota > 0 && quota <= out.slots) {
    out.slots = quota;
    out.slots_from = "cgroup";
  }
  const double group = group_memory(root, self);
  if (group > 0.0 && group < machine_memory()) out.memory_from = "cgroup";
  const double bytes = out.memory_from == "cgroup" ? group : machine_memory();
  out.memory = static_cast<std::size_t>(kShare * bytes);
  return out;
}

}  // namespace tubecut::server
