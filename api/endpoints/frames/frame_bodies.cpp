#include "api/endpoints/frames/frame_bodies.hpp"

namespace tubecut::api {

BodyIndex body_index(Reader& in, const NamedMembers& members,
                     const std::vector<WorldCutter>& others,
                     const std::vector<plate::PlateSpec>& plates) {
  using Of = BodyRef::Of;
  BodyIndex out{.by_id = {}, .complete = members.ids.complete && !in.refused()};
  for (const auto& [id, index] : members.ids.indices)
    out.by_id.emplace(id, BodyRef{index, Of::members});
  const auto add = [&](const char* list, const auto& bodies, Of of) {
    for (std::size_t i = 0; i < bodies.size(); ++i)
      if (!bodies[i].name.empty() && !out.by_id.emplace(bodies[i].name, BodyRef{i, of}).second) {
        out.complete = false;
        in.issue({.code = ErrorCode::duplicate_id,
                  .pointer = list + std::to_string(i) + "/id",
                  .got = Json{bodies[i].name},
                  .hint = "duplicate: another one has this id"});
      }
  };
  add("others/", others, Of::others);
  add("plates/", plates, Of::plates);
  return out;
}

std::optional<BodyRef> known_body(Reader& in, const BodyIndex& bodies, const std::string& id,
                                  const std::string& pointer) {
  if (const auto found = bodies.by_id.find(id); found != bodies.by_id.end()) return found->second;
  if (id.empty() || !bodies.complete) return std::nullopt;  // has its issue already
  std::vector<std::string> names;
  for (const auto& [name, body] : bodies.by_id) names.push_back(name);
  const auto near = nearest_name(id, names);
  in.issue({.code = ErrorCode::bad_choice,
            .pointer = pointer,
            .got = Json{id},
            .hint = near.empty() ? "no member has this id" : "did you mean " + near + "?"});
  return std::nullopt;
}

}  // namespace tubecut::api
