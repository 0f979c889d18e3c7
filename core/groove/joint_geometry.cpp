#include "core/groove/joint_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/base/elementary.hpp"
#include "core/base/rounding.hpp"
#include "core/base/try.hpp"
#include "core/groove/normal_area.hpp"
#include "core/groove/section.hpp"

namespace tubecut::groove {
namespace {

class FieldCheck {
 public:
  void length(const char* member, double value, bool zero_allowed) {
    if (!finite(member, value, "mm")) return;
    if (value > 0.0 || (zero_allowed && value == 0.0)) return;
    issues_.push_back({.code = ErrorCode::out_of_range,
                       .member = member,
                       .got = value,
                       .limit = 0.0,
                       .unit = "mm"});
  }
  bool finite(const char* member, double value, const char* unit) {
    if (std::isfinite(value)) return true;
    issues_.push_back({.code = ErrorCode::not_finite, .member = member, .unit = unit});
    return false;
  }
  void add(Issue issue) { issues_.push_back(std::move(issue)); }
  [[nodiscard]] std::vector<Issue>& issues() { return issues_; }

 private:
  std::vector<Issue> issues_;
};

void check_filler(const GrooveSpec& spec, FieldCheck& check) {
  if (const auto* given = std::get_if<FillerArea>(&spec.filler)) {
    if (check.finite("filler/area", given->area, "mm2") && given->area <= 0.0)
      check.add({.code = ErrorCode::area,
                 .member = "filler/area",
                 .got = given->area,
                 .limit = 0.0,
                 .unit = "mm2"});
    return;
  }
  const auto& height = std::get<FillerHeight>(spec.filler);
  check.length("filler/height", height.height, false);
  check.finite("filler/at", height.at.deg(), "deg");
}

void check_compare(const GrooveSpec& spec, FieldCheck& check) {
  if (!spec.compare) return;
  const double deg = spec.compare->bevel.deg();
  if (check.finite("compare/bevel", deg, "deg") && !(deg >= 0.0 && deg < 90.0))
    check.add({.code = ErrorCode::out_of_range,
               .member = "compare/bevel",
               .got = deg,
               .limit = 90.0,
               .unit = "deg"});
}

/// Returns the issues of single fields.
std::vector<Issue> field_issues(const GrooveSpec& spec) {
  FieldCheck check;
  check.length("chord/outer_diameter", spec.chord.outer_diameter, false);
  check.length("chord/wall", spec.chord.wall, false);
  check.length("branch/outer_diameter", spec.branch.outer_diameter, false);
  check.length("branch/wall", spec.branch.wall, false);
  check.length("root_face/height", spec.root_face.height, true);
  check.length("root_face/width", spec.root_face.width, false);
  check.finite("eccentricity", spec.eccentricity, "mm");
  if (check.finite("inclination", spec.inclination.deg(), "deg") &&
      !(spec.inclination.rad() > 0.0 && spec.inclination <= Angle::deg(90)))
    check.add({.code = ErrorCode::angle,
               .member = "inclination",
               .got = spec.inclination.deg(),
               .limit = 90.0,
               .unit = "deg"});
  if (spec.sections < 1 || spec.sections > kMaxSections)
    check.add({.code = ErrorCode::out_of_range,
               .member = "sections",
               .got = double(spec.sections),
               .limit = double(kMaxSections)});
  check_filler(spec, check);
  check_compare(spec, check);
  return std::move(check.issues());
}

void check_wall(const Pipe& pipe, const char* member, std::vector<Issue>& issues) {
  if (pipe.wall < 0.5 * pipe.outer_diameter) return;
  issues.push_back({.code = ErrorCode::wall,
                    .member = member,
                    .got = pipe.wall,
                    .limit = 0.5 * pipe.outer_diameter,
                    .unit = "mm"});
}

constexpr double kLeastWeldWidth = 0.01;  // minimum width in mm of wall next to the root face
constexpr double kAboveNothing = 1e-6;    // mm; a filler of exactly no area is refused

/// Returns the issues of pairs of fields.
std::vector<Issue> shape_issues(const GrooveSpec& spec) {
  std::vector<Issue> issues;
  check_wall(spec.chord, "chord/wall", issues);
  check_wall(spec.branch, "branch/wall", issues);
  if (!issues.empty()) return issues;
  if (spec.branch.wall - spec.root_face.width < kLeastWeldWidth) {
    issues.push_back({.code = ErrorCode::root_width,
                      .member = "root_face/width",
                      .got = spec.root_face.width,
                      .limit = rounded_down(spec.branch.wall - kLeastWeldWidth - kAboveNothing),
                      .unit = "mm"});
    return issues;
  }
  const double root = 0.5 * spec.branch.outer_diameter - spec.branch.wall + spec.root_face.width;
  const double room = 0.5 * spec.chord.outer_diameter - root;
  if (std::abs(spec.eccentricity) >= room)  // if equal, curve 3 has a kink
    issues.push_back(
        {.code = ErrorCode::no_pierce,
         .member = "eccentricity",
         .got = std::abs(spec.eccentricity),
         .limit = std::max(0.0, rounded_down(room - kAboveNothing)),
         .unit = "mm",
         .hint = "the root cylinder, of radius " + brief(root) + " mm, must pierce the chord"});
  return issues;
}

JointGeometry dimensions(const GrooveSpec& spec) {
  JointGeometry out;
  out.chord_radius = 0.5 * spec.chord.outer_diameter;
  out.bore_radius = out.chord_radius - spec.chord.wall;
  out.branch_radius = 0.5 * spec.branch.outer_diameter;
  out.inner_radius = out.branch_radius - spec.branch.wall;
  out.root_radius = out.inner_radius + spec.root_face.width;
  out.groove_width = spec.branch.wall - spec.root_face.width;
  out.weld_width = 2.0 * out.groove_width;
  out.root_height = spec.root_face.height;
  out.eccentricity = spec.eccentricity;
  const Direction inclination = direction(spec.inclination);
  out.sin_a = inclination.sin;
  out.cos_a = inclination.cos;
  return out;
}

/// Computes the axial area of a groove of this height there.
Result<double> area_of_height(const JointGeometry& joint, const FillerHeight& reference) {
  const Direction dir = direction(reference.at);
  const auto found = toe(joint, dir);
  if (!found)
    return fail(
        {.code = found.error(), .member = "filler/at", .got = reference.at.deg(), .unit = "deg"});
  const double area = filler_area(joint, *found, reference.height);
  if (area > 0.0) return area;
  return fail({.code = ErrorCode::area,
               .member = "filler/height",
               .got = reference.height,
               .limit = rounded_up((2.0 * found->bow + joint.groove_width * found->dy) / found->D +
                                   kAboveNothing),
               .unit = "mm",
               .hint = "no filler is left at " + degrees_text(reference.at)});
}

}  // namespace

std::string degrees_text(Angle angle) { return brief(angle.deg()) + " deg"; }

Result<JointGeometry> joint_geometry(const GrooveSpec& spec) {
  TRY(no_issues(field_issues(spec)));
  TRY(no_issues(shape_issues(spec)));
  JointGeometry out = dimensions(spec);
  std::optional<KeptArea> kept;
  if (const auto* given = std::get_if<FillerArea>(&spec.filler)) {
    out.area = given->area;
  } else {
    kept = {std::get<FillerHeight>(spec.filler).at};
    TRY(kept->axial, area_of_height(out, std::get<FillerHeight>(spec.filler)));
    out.area = kept->axial;
  }
  if (spec.area_in == AreaIn::axial) return out;
  TRY(equal_normal_areas(out, kept));
  return out;
}

}  // namespace tubecut::groove
