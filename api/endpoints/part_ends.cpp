#include "api/endpoints/part_ends.hpp"

#include <algorithm>
#include <utility>

#include "api/endpoints/bevel_table_codec.hpp"
#include "api/endpoints/joint_codec.hpp"
#include "api/endpoints/section_bevel_table.hpp"
#include "api/limits.hpp"

namespace tubecut::api {
namespace {

constexpr auto kMostCutters = static_cast<std::size_t>(limit::cutters_max);
constexpr Range kGap{.min = 0.0, .max = 50.0};

/// A partner is set into at most its radius or half its smaller side; a cone or an elbow not at
/// all.
double deepest_of(const joint::Partner& partner) {
  struct Of {
    double operator()(const joint::TubeCutter& t) const { return t.radius; }
    double operator()(const joint::AxisTube& t) const { return t.radius; }
    double operator()(const joint::PlaneCutter&) const { return 0.0; }
    double operator()(const joint::RectangularTubeCutter& t) const {
      return 0.5 * std::min(t.width, t.height);
    }
    double operator()(const joint::ConeCutter&) const { return 0.0; }
    double operator()(const joint::ElbowCutter&) const { return 0.0; }
  };
  return joint::by_kind(partner, Of{});
}

joint::Joint decode_end_joint(Reader& in, const joint::Partner* partner) {
  using joint::JointKind;
  joint::Joint out;
  const auto kind = in.tag("kind", kOnly<JointKind::set_on, JointKind::set_in, JointKind::mitre>);
  out.kind = kind.value_or(JointKind::set_on);
  out.gap = in.number("gap_mm", kGap, 0.0);
  const bool set_in = out.kind == JointKind::set_in;
  const bool goes =
      partner == nullptr || out.kind == JointKind::set_on ||
      (set_in ? deepest_of(*partner) > 0.0 : std::holds_alternative<joint::PlaneCutter>(*partner));
  if (kind && !goes)
    in.issue({.code = ErrorCode::unsupported_combination,
              .pointer = "kind",
              .hint = set_in ? "only a tube can be entered" : "a mitre's cutter is its plane"},
             in.find("kind"));
  if (!set_in) return out;
  const double deepest = partner == nullptr || !goes ? kDiameter.max / 2.0 : deepest_of(*partner);
  out.depth =
      in.number("depth_mm", {.min = 0.0, .max = deepest, .open_min = true, .open_max = true});
  return out;
}

/// Decodes the joints of an end's cutters, if given, by their index.
void decode_end_joints(Reader& in, const std::string& end, bevel::TableSpec& out,
                       std::vector<Warning>& warnings) {
  in.note("joints");
  if (!in.has("joints")) return;
  const auto n = out.partners.size();
  const bool known = in.understood("cutters") && n > 0;
  out.stated.assign(n, std::nullopt);
  in.array("joints", {.min = 0, .max = kMostCutters}, [&](Reader& j) {
    const int last = static_cast<int>(known ? n : kMostCutters) - 1;
    const auto index = static_cast<std::size_t>(j.integer("cutter", 0, last));
    const bool there = known && j.understood("cutter");
    const auto joint = decode_end_joint(j, there ? &out.partners[index] : nullptr);
    const auto missing = j.optional_number("missing_mm", {.min = 0.0, .max = limit::offset_max_mm});
    if (!there) return 0;
    if (missing.value_or(0.0) > 0.0)
      warnings.push_back({.code = WarningCode::ghost_contact,
                          .member = "ends/" + end + "/cutters/" + std::to_string(index),
                          .detail = "it is missing over " + brief(*missing) + " mm of this cut"});
    if (out.stated[index])
      j.issue({.code = ErrorCode::duplicate_id,
               .pointer = "cutter",
               .hint = "the joint of this cutter is already stated"},
              j.find("cutter"));
    out.stated[index] = joint;
    return 0;
  });
}

constexpr std::size_t kMostEndTabs = 32;
constexpr Range kTabSize{.min = 0.1, .max = 1e4};  // mm

/// Decodes the tabs of an end, which is cut square for them.
std::vector<part::EndTab> decode_end_tabs(Reader& in, bool on_section,
                                          const bevel::TableSpec& cut) {
  in.note("end_tabs");
  if (!in.has("end_tabs")) return {};
  const auto refuse = [&](const char* field, const char* hint) {
    in.issue({.code = ErrorCode::unsupported_combination, .pointer = field, .hint = hint},
             in.find(field));
  };
  if (!on_section) {
    refuse("end_tabs", "requires a target that is not round");
    return {};
  }
  auto out = in.array("end_tabs", {.min = 0, .max = kMostEndTabs}, [](Reader& t) {
    part::EndTab tab{.face = t.integer("face", 1, 4)};
    tab.offset = t.number("offset_mm", kOffset, 0.0);
    tab.width = t.number("width_mm", kTabSize);
    tab.length = t.number("length_mm", kTabSize);
    return tab;
  });
  if (out.empty()) return out;
  if (!std::holds_alternative<bevel::SquareCut>(cut.groove) && in.understood("groove"))
    refuse("groove", "an end with tabs is cut square: rule square");
  if (cut.root_face > 0.0)
    refuse("root_face_mm", "an end with tabs is cut square, without a root face");
  return out;
}

part::EndSpec decode_end(Reader& in, const std::string& end, const bevel::TableSpec& once,
                         PartRequest& request) {
  const auto which = in.exactly_one({"cutters", "square_at_mm"});
  if (!which) {
    in.silence();
    return {};
  }
  part::EndSpec out{.cut = once};
  if (const auto own = in.optional_number("kerf_mm", kKerf)) out.cut.kerf = *own;
  if (which == 1) {
    in.note("end_tabs");
    if (in.has("end_tabs"))
      in.issue({.code = ErrorCode::unsupported_combination,
                .pointer = "end_tabs",
                .hint = "requires cutters: a tab goes into one of them"},
               in.find("end_tabs"));
    return part::square_end(out.cut, in.number("square_at_mm", kOffset));
  }
  out.cut.partners = decode_cutters(in);
  decode_end_joints(in, end, out.cut, request.warnings);
  decode_cut(in, false, request.preset, out.cut);
  if (request.section) refuse_round_only(in, out.cut);
  auto& section = request.of_section;
  (end == "start" ? section.start_tabs : section.finish_tabs) =
      decode_end_tabs(in, request.section.has_value(), out.cut);
  return out;
}

}  // namespace

void decode_ends(Reader& in, const bevel::TableSpec& once, PartRequest& out) {
  in.object("ends", [&](Reader& ends) {
    const auto end = [&](Reader& e, const char* name, bool& own_kerf) {
      own_kerf = e.has("kerf_mm");
      return decode_end(e, name, once, out);
    };
    out.part.start =
        ends.object("start", [&](Reader& e) { return end(e, "start", out.start_kerf); });
    out.part.finish =
        ends.object("finish", [&](Reader& e) { return end(e, "finish", out.finish_kerf); });
    return 0;
  });
}

}  // namespace tubecut::api
