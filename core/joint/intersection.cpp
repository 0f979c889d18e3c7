#include "core/joint/intersection.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/stop.hpp"
#include "core/base/try.hpp"
#include "core/joint/height_proof.hpp"
#include "core/joint/solid.hpp"
#include "core/math/cylinder.hpp"

namespace tubecut::joint {
namespace {

Result<Profile> profile(const Contour& contour, const Sampling& sampling, bool outer) {
  TRY(const auto samples, sample(contour, sampling, {}));
  Profile out{.outer = outer, .radius = contour.radius};
  for (const auto& node : samples.nodes) {
    out.phi.push_back(node.phi);
    out.z.push_back(node.z);
    out.cutter.push_back(node.after);
  }
  out.events = contour.events;
  out.length = samples.true_length;
  out.developed = samples.developed_length;
  return out;
}

constexpr double kHere = 1e-9;  // rad: a row at an event

/// Returns the distance on the circle.
double apart(double a, double b) {
  const double d = std::abs(a - b);
  return std::min(d, kTwoPi - d);
}

}  // namespace

Result<std::vector<Cutter>> resolve(std::span<const Partner> partners) {
  std::vector<Cutter> out;
  std::vector<Issue> issues;
  for (std::size_t i = 0; i < partners.size(); ++i) {
    by_kind(partners[i], [&]<class Kind>(const Kind& partner) {
      if constexpr (std::is_same_v<Kind, AxisTube>) {
        auto tube = under("cutters/" + std::to_string(i), partner.tube());
        if (tube)
          out.emplace_back(*tube);
        else
          issues.insert(issues.end(), tube.error().issues.begin(), tube.error().issues.end());
      } else {
        out.emplace_back(partner);
      }
    });
  }
  TRY(no_issues(std::move(issues)));
  return out;
}

std::vector<Warning> partner_warnings(const Contour& contour) {
  std::vector<Warning> out;
  for (const auto i : contour.missed)
    out.push_back({.code = WarningCode::cutter_missed, .member = "cutters/" + std::to_string(i)});
  for (const auto i : contour.near_parallel)
    out.push_back({.code = WarningCode::near_parallel, .member = "cutters/" + std::to_string(i)});
  return out;
}

Result<void> check_length(const Target& target, std::span<const double> z) {
  const double highest = *std::max_element(z.begin(), z.end());
  if (!target.length || highest <= *target.length) return {};
  return fail({.code = ErrorCode::member_consumed,
               .member = "target/length",
               .got = highest,
               .limit = *target.length,
               .unit = "mm"});
}

Result<Intersection> intersect(const IntersectionSpec& spec) {
  TRY(const auto cutters, resolve(spec.partners));
  Intersection out;
  for (const bool outer : {false, true}) {
    if (spec.surfaces == (outer ? Surfaces::inner : Surfaces::outer)) continue;
    const double rho = outer ? spec.target.outer_radius : spec.target.inner_radius();
    TRY(const auto contour, trace(cutters, rho));
    TRY(auto curve, profile(contour, spec.sampling, outer));
    TRY(check_length(spec.target, curve.z));
    out.profiles.push_back(std::move(curve));
    out.warnings = partner_warnings(contour);  // of the outer surface if both are requested
  }
  return out;
}

std::vector<Check> verify(const IntersectionSpec& spec, const Intersection& answer) {
  const auto cutters = resolve(spec.partners);
  std::vector<Solid> solids;
  if (cutters)
    for (const auto& cutter : *cutters) solids.emplace_back(cutter);
  HeightProof proof(solids);
  for (const auto& p : answer.profiles) {
    proof.see_surface(p.radius);
    for (std::size_t i = 0; i < p.phi.size() && !stopped(); ++i)
      proof.see_row(math::cylinder_point(p.radius, p.phi[i], p.z[i]), p.cutter[i], p.events,
                    [&](const Event& e) { return apart(e.phi, p.phi[i]) < kHere; });
    for (const auto& e : p.events) {
      const auto at = math::cylinder_point(p.radius, e.phi, e.z_from);
      if (e.kind == EventKind::junction)
        proof.see_junction(at, e.from, e.to);
      else
        proof.see_touch(at, e.from, e.to, e.z_from > e.z_to ? e.from : e.to);
    }
  }
  return proof.checks();
}

}  // namespace tubecut::joint
