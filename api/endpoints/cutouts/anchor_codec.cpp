#include "api/endpoints/cutouts/anchor_codec.hpp"

#include <algorithm>
#include <string>

#include "api/endpoints/section_bevel_table.hpp"
#include "api/limits.hpp"
#include "api/wire/cutout_names.hpp"
#include "core/base/angle.hpp"
#include "core/cutout/flats.hpp"

namespace tubecut::api {
namespace {

constexpr Range kGirthPlace{.min = -1e5, .max = 1e5};
constexpr std::string_view kNeedsRound = "requires a round target; ";

/// A place round a tube whose kind is unknown, because its own fields were refused: one of those
/// that the contract has.
void decode_anywhere(Reader& in) {
  const auto which = in.exactly_one({"phi_deg", "girth_mm", "face"});
  if (which && *which == 2) {
    in.integer("face", 1, 4);
    in.optional_number("offset_mm");
    return;
  }
  refuse_fields(in, {"offset_mm"}, "goes with face");
  if (which) in.number(*which == 0 ? "phi_deg" : "girth_mm");
}

/// The other places are left unread, because a field of the other kind of tube is refused.
void note_places(Reader& in) {
  in.note("face");
  in.note("offset_mm");
  in.note("girth_mm");
}

void decode_on_section(Reader& in, const AnchorTube& tube, cutout::Anchor& out) {
  refuse_fields(in, {"phi_deg"}, std::string(kNeedsRound) + "give face and offset_mm, or girth_mm");
  if (in.has("phi_deg")) return note_places(in);
  const auto which = in.exactly_one({"face", "girth_mm"});
  if (which && *which == 1) {
    refuse_fields(in, {"offset_mm"}, "goes with face");
    out.phi = in.number("girth_mm", kGirthPlace) / tube.radius();
    return;
  }
  if (!which) return in.note("offset_mm");
  out.face = in.integer("face", 1, 4);
  const bool known = in.understood("face");
  const auto half =
      known ? cutout::half_flat(section::Wall(*tube.section), out.face) : kGirthPlace.max;
  out.offset = in.number("offset_mm", {.min = -half, .max = half}, 0.0);
}

}  // namespace

cutout::Anchor decode_anchor(Reader& in, const AnchorTube& tube) {
  using Anchor = cutout::Anchor;
  Anchor out{.z = in.number("z_mm", kOffset)};
  out.from = in.choice("from", Anchor::From::start);
  out.zero = in.choice("z_zero", Anchor::Zero::work_point);
  out.opposite = in.flag("opposite", false);
  if (!tube.sure) {
    decode_anywhere(in);
    return out;
  }
  if (tube.section != nullptr) {
    decode_on_section(in, tube, out);
    return out;
  }
  if (in.has("face")) {
    in.note("offset_mm");
    refuse_fields(in, {"face"}, "a round tube has no faces; give phi_deg or girth_mm");
    return out;
  }
  in.note("face");
  refuse_fields(in, {"offset_mm"}, "goes with face, which a round tube does not have");
  if (const auto which = in.exactly_one({"phi_deg", "girth_mm"}))
    out.phi = *which == 0 ? in.angle("phi_deg", kAnyAngleDeg).rad()
                          : in.number("girth_mm", kGirthPlace) / tube.radius();
  return out;
}

double AnchorTube::radius() const {
  const double radius = section != nullptr ? section->outer().girth() / kTwoPi : outer_radius;
  return std::max(radius, 1.0);
}

std::string decode_own_id(Reader& in, std::set<std::string>& ids, const char* taken) {
  auto id = in.text("id");
  if (in.understood("id") && !ids.insert(id).second)
    in.issue({.code = ErrorCode::duplicate_id, .pointer = "id", .got = Json{id}, .hint = taken});
  return id;
}

}  // namespace tubecut::api
