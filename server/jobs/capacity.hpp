#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace tubecut::server {

/// The CPUs and memory that this process may use, and the sources of these limits.
struct Capacity {
  int slots = 1;
  std::string slots_from = "machine";  // cgroup | affinity | machine | option
  std::size_t memory = 0;              // bytes for bodies, jobs and answers; 0: unknown
  std::string memory_from = "machine";
  int connections = 0;  // open at a time; as many as there are descriptors for
};

/// Slots from the control group's quota (version 2 or 1) rounded up, else the CPUs this process may
/// run on, else the machine's; memory as a part of the control group's limit, else of the
/// machine's. `root` and `self` are for tests: the mounted hierarchy and /proc/self/cgroup.
[[nodiscard]] Capacity capacity(const std::string& root = "/sys/fs/cgroup",
                                const std::string& self = "/proc/self/cgroup");

/// Whole CPUs of a `cpu.max` line such as "150000 100000", rounded up; 0: no quota.
[[nodiscard]] int slots_of_quota(std::string_view cpu_max);

}  // namespace tubecut::server
