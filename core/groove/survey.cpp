#include "core/groove/survey.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "core/base/elementary.hpp"
#include "core/base/rounding.hpp"
#include "core/base/stop.hpp"
#include "core/groove/section.hpp"
#include "core/groove/surface.hpp"

namespace tubecut::groove {
namespace {

constexpr double kFlattestGroove = 80.0, kSteepestGroove = 10.0;  // deg to the branch axis

/// The number of sections with a property and the first of them: enough for one warning.
struct Seen {
  int count = 0;
  Angle first;
  void note(bool holds, Angle omega) {
    if (holds && count++ == 0) first = omega;
  }
};

std::optional<ErrorCode> fault(const JointGeometry& joint, const Section& section) {
  const Toe& p = section.toe;
  if (!(section.height > 0.0)) return ErrorCode::p3_below_p1;
  if (!(section.height > joint.groove_width * p.slope1)) return ErrorCode::groove_in_chord;
  if (!(section.y3 - p.y2 - p.slope2 * (joint.branch_radius - p.x2) > 0.0))
    return ErrorCode::face_in_chord;
  return std::nullopt;
}

bool in_bore(const JointGeometry& joint, const Section& section, double s) {
  const double t = s * section.dir.sin + joint.eccentricity;
  const double height =
      (section.toe.y1 - joint.root_height) * joint.sin_a - s * section.dir.cos * joint.cos_a;
  return elementary::hypot(t, height) < joint.bore_radius;
}

class Surveyor {
 public:
  Surveyor(const JointGeometry& joint, double fixed_height)
      : joint_(joint), fixed_height_(fixed_height) {
    sums_.height_min = sums_.angle_min = std::numeric_limits<double>::infinity();
  }

  /// Keeps the first section that is not a groove, with its code.
  void add(const Section& section) {
    if (const auto code = fault(joint_, section); code && !bad_) bad_ = Bad{*code, section};
    const Toe& p = section.toe;
    const double least = -0.5 * joint_.groove_width * p.dy - p.bow;
    sums_.least_area = std::max(sums_.least_area, least / axial_factor(joint_, section.dir));
    sums_.height_min = std::min(sums_.height_min, section.height);
    sums_.height_max = std::max(sums_.height_max, section.height);
    const double beta = groove_angle(joint_, section).rad();
    sums_.angle_min = std::min(sums_.angle_min, beta);
    sums_.angle_max = std::max(sums_.angle_max, beta);
    sums_.volume += volume_rate(joint_, section, section.height);
    sums_.fixed_volume += volume_rate(joint_, section, fixed_height_);
    sums_.length += elementary::hypot(joint_.root_radius, section.z3_d);
    note_warnings(section, Angle::rad(beta));
  }

  [[nodiscard]] Result<Survey> finish() const {
    if (bad_) return tl::unexpected(Error{issue()});
    const double step = kTwoPi / kSurveySections;
    Survey out;
    out.least_area = sums_.least_area;
    out.height_min = sums_.height_min;
    out.height_max = sums_.height_max;
    out.groove_angle_min = Angle::rad(sums_.angle_min);
    out.groove_angle_max = Angle::rad(sums_.angle_max);
    out.filler_volume = sums_.volume * step;
    out.fixed_volume = sums_.fixed_volume * step;
    out.weld_length = sums_.length * step;
    out.warnings = warnings();
    return out;
  }

 private:
  struct Bad {
    ErrorCode code;
    Section section;
  };
  struct Sums {
    double least_area = -std::numeric_limits<double>::infinity();
    double height_min = 0.0, height_max = 0.0;
    double angle_min = 0.0, angle_max = 0.0;
    double volume = 0.0, fixed_volume = 0.0, length = 0.0;
  };

  void note_warnings(const Section& section, Angle beta) {
    const bool bore = in_bore(joint_, section, joint_.root_radius) ||
                      in_bore(joint_, section, joint_.inner_radius);
    bore_.note(bore, section.omega);
    overhang_.note(section.toe.x2 < joint_.branch_radius, section.omega);
    angle_.note(beta.deg() < kSteepestGroove || beta.deg() > kFlattestGroove, section.omega);
  }

  [[nodiscard]] Issue issue() const {
    Issue out{.code = bad_->code, .member = "filler", .got = joint_.area, .unit = "mm2"};
    out.hint = "at omega " + degrees_text(bad_->section.omega) + " the groove height is " +
               brief(bad_->section.height) + " mm";
    if (bad_->code == ErrorCode::p3_below_p1) out.limit = rounded_up(sums_.least_area);
    return out;
  }

  [[nodiscard]] std::vector<Warning> warnings() const {
    std::vector<Warning> out;
    const auto tell = [&out](const Seen& seen, WarningCode code, const char* member) {
      if (seen.count == 0) return;
      out.push_back({code, member,
                     std::to_string(seen.count) + " of " + std::to_string(kSurveySections) +
                         " sections, first at omega " + degrees_text(seen.first)});
    };
    tell(bore_, WarningCode::root_in_bore, "root_face/height");
    tell(overhang_, WarningCode::p2_inside_branch, "branch/wall");
    const double widest = joint_.branch_radius + std::abs(joint_.eccentricity);
    if (widest > joint_.chord_radius)
      out.push_back({WarningCode::branch_wider, "branch/outer_diameter",
                     "branch radius plus eccentricity is " + brief(widest) +
                         " mm, the chord's radius " + brief(joint_.chord_radius) + " mm"});
    tell(angle_, WarningCode::groove_angle, "filler");
    return out;
  }

  const JointGeometry& joint_;
  double fixed_height_;
  Sums sums_;
  std::optional<Bad> bad_;
  Seen bore_, overhang_, angle_;
};

}  // namespace

Result<Survey> survey(const JointGeometry& joint, double fixed_height) {
  Surveyor surveyor{joint, fixed_height};
  for (int i = 0; i < kSurveySections; ++i) {
    if (stopped()) return fail({.code = ErrorCode::cancelled});
    const Angle omega = Angle::rad(kTwoPi * i / kSurveySections);
    const auto found = section(joint, omega);
    if (!found)
      return fail({.code = found.error(),
                   .member = "branch/wall",
                   .got = omega.deg(),
                   .unit = "deg",
                   .hint = "first at this omega"});
    surveyor.add(*found);
  }
  return surveyor.finish();
}

}  // namespace tubecut::groove
