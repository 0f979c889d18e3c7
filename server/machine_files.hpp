#pragma once

#include <string>

namespace tubecut::server {

/// Adds every *.json of a folder, in the order of their names, to the built-in machines that
/// requests can name, in place of those read before. If one is wrong, loads no file. Returns an
/// error text (file and reason), or an empty text. An empty folder name changes nothing.
[[nodiscard]] std::string load_machines(const std::string& folder);
/// The same of posts.
[[nodiscard]] std::string load_posts(const std::string& folder);

}  // namespace tubecut::server
