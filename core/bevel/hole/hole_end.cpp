#include "core/bevel/hole/hole_end.hpp"

#include <algorithm>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/base/try.hpp"
#include "core/bevel/hole/hole_fit.hpp"
#include "core/bevel/table/required.hpp"

namespace tubecut::bevel {
namespace {

constexpr double kOver = 1e-9 * kRadPerDeg;  // of the branch's radius: rounding

/// Converts errors about the joint's one curve to errors about the branch.
Error about_branch(Error error) {
  for (auto& issue : error.issues)
    if (issue.member.starts_with("cutters"))
      issue.member = issue.code == ErrorCode::parallel_axes ? "branch/inclination" : "branch";
  return error;
}

/// Places the root on the inner wall, on the cylinder on which the end is set; B is at least flush
/// if a smaller B would enter the wall.
Result<void> stand_on(const HoleSpec& spec, const joint::Contour& contour, double radius,
                      BranchEnd& end) {
  const Wall wall{contour.radius, radius};
  const bool on = spec.kind == JointKind::set_on;
  const Rule rule(on ? spec.groove : GrooveRule{NoGroove{}}, Dihedral::weld_side);
  Intervals beyond;
  for (const double phi : end.phi) {
    if (stopped()) return fail({.code = ErrorCode::cancelled});
    const auto line = joint::generator_at(contour.radius, phi);
    const auto hit = joint::continued_hit(contour.cutters.front(), line);
    const double required = required_bevel(contour.cutters, wall, line, hit.z);
    const double asked =
        std::clamp(rule.angles(hit.normal).b, spec.torch.min.rad(), spec.torch.max.rad());
    if (required > spec.torch.max.rad()) beyond.emplace_back(phi * kDegPerRad, phi * kDegPerRad);
    const double b = std::max(asked, std::min(required, spec.torch.max.rad()));
    end.b.push_back(b);
    end.z_inner.push_back(hit.z);
    end.z_outer.push_back(hit.z + spec.branch_wall * elementary::tan(b));
  }
  if (beyond.empty()) return {};
  return fail({.code = ErrorCode::torch_range,
               .member = "torch/max",
               .got = Intervals{{beyond.front().first, beyond.back().second}},
               .limit = spec.torch.max.deg(),
               .unit = "deg",
               .hint = "the branch's end cannot be cut flush on the chord here"});
}

}  // namespace

Result<joint::Contour> joint_curve(const joint::TubeCutter& branch, double chord_radius,
                                   double rho) {
  const joint::Cutter chord = chord_seen_from(branch, chord_radius);
  auto out = joint::trace({&chord, 1}, rho);
  if (!out) return tl::unexpected(about_branch(out.error()));
  if (out->events.empty()) return out;
  const double phi = out->events.front().phi * kDegPerRad;
  return fail({.code = ErrorCode::open_profile,
               .member = "branch",
               .got = Intervals{{phi, phi}},
               .limit = "a hole within the chord's sides",
               .unit = "deg",
               .hint = "the branch reaches the chord's side, where the two surfaces are tangent"});
}

Result<BranchEnd> branch_end(const HoleSpec& spec, const joint::TubeCutter& branch,
                             const std::vector<double>& phases) {
  const bool on = spec.kind == JointKind::set_on;
  const double depth = spec.depth.value_or(spec.chord.wall);
  const double radius = spec.chord.outer_radius + (on ? spec.gap : -depth);
  BranchEnd end{.chord = chord_seen_from(branch, radius),
                .phi = phases,
                .z_inner = {},
                .z_outer = {},
                .b = {}};
  TRY(const auto inner, joint_curve(branch, radius, branch.radius - spec.branch_wall));
  TRY(stand_on(spec, inner, branch.radius, end));
  return end;
}

void note_overhang(const HoleSpec& spec, const joint::TubeCutter& branch,
                   std::vector<Warning>& out) {
  const double over = branch.radius + std::abs(branch.offset) - spec.chord.outer_radius - spec.gap;
  if (spec.kind != JointKind::set_on || !(over > kOver * branch.radius)) return;
  out.push_back(
      {.code = WarningCode::wall_overhangs,
       .member = "branch",
       .detail = "its outer surface passes up to " + brief(over) + " mm outside the chord"});
}

}  // namespace tubecut::bevel
