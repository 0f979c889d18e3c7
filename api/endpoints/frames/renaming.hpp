#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/base/error.hpp"

namespace tubecut::api {

/// A part of core's spec, and its name in the request.
struct Renaming {
  std::string from, to;   // "cutters/1", and all below it; "start/": only the fields below it
  bool with_rest = true;  // fields below keep their names; else all of them become `to`
};
using Renamings = std::vector<Renaming>;

/// Returns true if a path names a member, or something below it.
[[nodiscard]] bool is_at(const std::string& path, const std::string& member);

/// The path by the first that matches it, or as it is.
[[nodiscard]] std::string renamed(const std::string& member, const Renamings& by);

/// Of issues or warnings.
template <class Finding>
[[nodiscard]] std::vector<Finding> renamed(std::vector<Finding> all, const Renamings& by) {
  for (auto& one : all) one.member = renamed(one.member, by);
  return all;
}
[[nodiscard]] inline Error renamed(Error error, const Renamings& by) {
  return Error{renamed(std::move(error.issues), by)};
}

}  // namespace tubecut::api
