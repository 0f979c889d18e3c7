#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "api/endpoints/frames/node_codec.hpp"
#include "api/endpoints/joint_codec.hpp"
#include "api/wire/reader.hpp"
#include "core/plate/plate.hpp"

namespace tubecut::api {

/// A member, one of the others, or a plate.
struct BodyRef {
  std::size_t index = 0;
  enum class Of { members, others, plates } of = Of::members;
};
struct BodyIndex {
  std::map<std::string, BodyRef, std::less<>> by_id;
  bool complete = true;
};

/// Returns all bodies by their ids, which all lists of a frame share.
[[nodiscard]] BodyIndex body_index(Reader& in, const NamedMembers& members,
                                   const std::vector<WorldCutter>& others,
                                   const std::vector<plate::PlateSpec>& plates);
/// Returns the body of an id; `pointer` names the field for an issue.
[[nodiscard]] std::optional<BodyRef> known_body(Reader& in, const BodyIndex& bodies,
                                                const std::string& id, const std::string& pointer);

}  // namespace tubecut::api
