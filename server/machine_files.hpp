#pragma once

#include <string>

namespace tubecut::server {

/// Adds every *.json of a folder, in the order of their names, to the machines that requests can
/// name. Returns what is wrong (file and reason), or nothing. An empty folder name adds nothing.
[[nodiscard]] std::string load_machines(const std::string& folder);

}  // namespace tubecut::server
