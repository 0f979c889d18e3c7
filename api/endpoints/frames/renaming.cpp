#include "api/endpoints/frames/renaming.hpp"

#include <algorithm>

namespace tubecut::api {

std::string renamed(const std::string& member, const Renamings& by) {
  const auto matches = [&](const Renaming& one) {
    const auto n = one.from.size();
    return member.starts_with(one.from) &&
           (one.from.ends_with('/') || member.size() == n || member[n] == '/');
  };
  const auto found = std::ranges::find_if(by, matches);
  if (found == by.end()) return member;
  return found->with_rest ? found->to + member.substr(found->from.size()) : found->to;
}

}  // namespace tubecut::api
