#include "api/endpoints/frames/frame_shape.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "api/endpoints/section_target.hpp"
#include "api/wire/common_fields.hpp"
#include "api/wire/writer.hpp"
#include "core/base/angle.hpp"

namespace tubecut::api {
namespace {

/// Without some of its members.
template <std::size_t N>
Json without(const Json& of, const std::array<std::string_view, N>& names) {
  Json::Object out;
  for (const auto& member : *of.as<Json::Object>())
    if (std::ranges::find(names, member.first) == names.end()) out.push_back(member);
  return Json{std::move(out)};
}

std::string text(const Json& value) {
  const auto* found = value.as<std::string>();
  return found == nullptr ? std::string() : *found;
}

/// Returns the partner without its position; the `height` of a round one is its position, that of a
/// rectangular one a size.
std::string partner_key(const Json& partner) {
  static constexpr std::array<std::string_view, 9> kRound{
      "axis",         "up",        "inwards",  "point_mm", "normal", "inclination_deg",
      "clocking_deg", "offset_mm", "height_mm"};
  static constexpr std::array<std::string_view, 5> kOther{"axis", "up", "inwards", "point_mm",
                                                          "normal"};
  const auto* kind = partner.find("kind");
  const bool round = kind == nullptr || text(*kind) == "tube";  // a hole's branch has no kind
  return dump(round ? without(partner, kRound) : without(partner, kOther));
}

/// Returns the cut of the end, and of each partner its type and joint, and how far the cut follows
/// it beyond its metal: a length, which rounded coordinates move.
std::string end_key(const Json& end, std::vector<std::string>& partners,
                    std::vector<double>& missing) {
  static constexpr std::array<std::string_view, 2> kPlaced{"cutters", "joints"};
  static constexpr std::array<std::string_view, 2> kCompared{"cutter", "missing_mm"};
  const auto* cutters = end.find("cutters");
  const auto* joints = end.find("joints");
  if (cutters == nullptr) {
    partners.emplace_back();  // square
    missing.push_back(0.0);
    return dump(end);
  }
  for (const auto& one : *cutters->as<Json::Array>()) partners.push_back(partner_key(one));
  missing.resize(partners.size());
  for (const auto& one : *joints->as<Json::Array>()) {
    const auto cutter = static_cast<std::size_t>(*one.find("cutter")->as<double>());
    partners[cutter] += dump(without(one, kCompared));
    if (const auto* far = one.find("missing_mm")) missing[cutter] = *far->as<double>();
  }
  return dump(without(end, kPlaced));
}

/// Gives a part that is not round the target and marks of a round one of the same girth, by which
/// parts are compared.
void compare_by_girth(Parts::Spec& spec) {
  const auto& section = spec.section->section;
  const double radius = section.outer().girth() / kTwoPi;
  spec.part.target = {.outer_radius = radius, .wall = section.wall, .length = spec.section->length};
  for (const auto& mark : spec.of_section.partners)
    spec.part.partners.push_back({.kind = mark.kind,
                                  .text = mark.text,
                                  .phi = mark.s / radius,
                                  .z_from = mark.z_from,
                                  .z_to = mark.z_to});
}

}  // namespace

frame::Shape shape_of(const Json& part) {
  static constexpr std::array<std::string_view, 1> kLength{"length_mm"};
  static constexpr std::array<std::string_view, 1> kBranch{"branch"};
  frame::Shape out;
  out.key = dump(without(*part.find("target"), kLength));
  const auto& ends = *part.find("ends");
  out.key += end_key(*ends.find("start"), out.start, out.start_missing);
  out.key += end_key(*ends.find("finish"), out.finish, out.finish_missing);
  for (const auto* end : {"start", "finish"})  // tabs are on numbered faces, as cut-outs are
    out.has_cutouts = out.has_cutouts || ends.find(end)->find("end_tabs") != nullptr;
  for (const auto* name : {"cutouts", "texts"})
    if (const auto* own = part.find(name)) {
      out.key += dump(*own);
      out.has_cutouts = true;
    }
  if (const auto* marks = part.find("marks"))
    for (const auto& one : *marks->as<Json::Array>()) out.marks.push_back(text(*one.find("text")));
  if (const auto* holes = part.find("holes"))
    for (const auto& one : *holes->as<Json::Array>()) {
      const auto& branch = *one.find("branch");
      if (is_section(*part.find("target")) || is_section(branch)) {  // it becomes a cut-out
        out.key += partner_key(branch) + dump(without(one, kBranch));
        out.has_cutouts = true;
        continue;
      }
      out.holes.push_back(partner_key(branch) + dump(without(one, kBranch)));
    }
  return out;
}

std::unique_ptr<const Parts::Spec> read_part(const Json& part) {
  Reader in(part);
  (void)read_common_fields(in, Parts::kAccepts);
  auto spec = Parts::decode(in);
  if (!in.finish_root().empty()) return nullptr;
  if (spec.section) compare_by_girth(spec);
  return std::make_unique<const Parts::Spec>(std::move(spec));
}

}  // namespace tubecut::api
