#include "api/endpoints/frames/renaming.hpp"

#include <algorithm>

namespace tubecut::api {

bool is_at(const std::string& path, const std::string& member) {
  const auto n = member.size();
  return path.starts_with(member) && (path.size() == n || path[n] == '/');
}

std::string renamed(const std::string& member, const Renamings& by) {
  const auto matches = [&](const Renaming& one) {
    return one.from.ends_with('/') ? member.starts_with(one.from) : is_at(member, one.from);
  };
  const auto found = std::ranges::find_if(by, matches);
  if (found == by.end()) return member;
  return found->with_rest ? found->to + member.substr(found->from.size()) : found->to;
}

}  // namespace tubecut::api
