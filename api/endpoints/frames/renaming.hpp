#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/base/error.hpp"

namespace tubecut::api {

/// A part of core's spec, and what the request calls it.
struct Renaming {
  std::string from, to;   // "cutters/1", and all below it; "start/": what is below it alone
  bool with_rest = true;  // what stands below keeps its name; else all of it is `to`
};
using Renamings = std::vector<Renaming>;

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
