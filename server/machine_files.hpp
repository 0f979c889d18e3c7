#pragma once

#include <string>

namespace tubecut::server {

/// Puts every *.json of a folder, in the order of their names, beside the built-in machines that
/// requests can name, instead of those read before: all of them or, when one is wrong, none.
/// Returns what is wrong (file and reason), or nothing. An empty folder name changes nothing.
[[nodiscard]] std::string load_machines(const std::string& folder);
/// The same of posts.
[[nodiscard]] std::string load_posts(const std::string& folder);

}  // namespace tubecut::server
