#include "core/joint/intersection.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/base/try.hpp"
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

/// Returns the distance on the circle.
double apart(double a, double b) {
  const double d = std::abs(a - b);
  return std::min(d, kTwoPi - d);
}

/// The worst value of one check, relative to its own limit.
class Worst {
 public:
  Worst(std::string name, std::string unit) : check_{std::move(name), 0.0, 0.0, std::move(unit)} {}
  void see(double value, double limit) {
    const bool known = std::isnan(check_.value) ||  // because NaN counts as the worst
                       (check_.limit > 0.0 && value / limit <= check_.value / check_.limit);
    if (known) return;
    check_.value = value;
    check_.limit = limit;
  }
  [[nodiscard]] const Check& check() const { return check_; }

 private:
  Check check_;
};

constexpr double kOnCutter = 1e-12;  // of the larger of radius + rho and |z|
constexpr double kAbove = 1e-9;      // likewise
constexpr double kTouch = 1e-12;     // likewise
constexpr double kGraze = 4e-12;     // likewise: two verifications of one contact
constexpr double kLabel = 1e-7;      // likewise: the curve is vertical at a silhouette

/// Returns true if a generator only touches the partner between the two heights, within rounding:
/// then neither height is exact.
bool grazes(const Solid& solid, const Eigen::Vector3d& at, double top, double scale) {
  const Eigen::Vector3d middle(at.x(), at.y(), 0.5 * (at.z() + top));
  return std::abs(solid.distance(middle)) <= kGraze * scale;
}

struct Proof {
  Worst on_cutter{"on_cutter", "mm"}, none_above{"none_above", "mm"}, event_gap{"event_gap", "mm"},
      labels{"labels", "mm"};

  void node(const std::vector<Solid>& solids, const Profile& p, std::size_t i);
  void event(const std::vector<Solid>& solids, double rho, const Event& event);
};

void Proof::node(const std::vector<Solid>& solids, const Profile& p, std::size_t i) {
  const auto at = math::cylinder_point(p.radius, p.phi[i], p.z[i]);
  const auto& own = solids.at(p.cutter[i]);
  const double scale = std::max(own.scale() + p.radius, std::abs(p.z[i]));
  on_cutter.see(std::abs(own.distance(at)), kOnCutter * scale);
  const auto top = own.top(at.x(), at.y());
  // A silhouette may be missed by rounding; then the generator touches instead.
  const bool touches = !top && std::abs(own.clearance(at.x(), at.y())) <= kTouch * scale;
  double off = top ? std::abs(*top - p.z[i]) : scale;
  if (touches || (off > kLabel * scale && top && grazes(own, at, *top, scale)))
    off = std::abs(own.distance(at));
  labels.see(off, kLabel * scale);
  for (std::size_t k = 0; k < solids.size(); ++k) {
    if (k == p.cutter[i]) continue;  // `labels` checks its own height
    // A partner lost or found here may be higher on one side only.
    const bool beside = std::any_of(p.events.begin(), p.events.end(), [&](const Event& e) {
      return e.kind == EventKind::jump && (e.from == k || e.to == k) &&
             apart(e.phi, p.phi[i]) < 1e-9;
    });
    if (beside) continue;
    const auto height = solids[k].top(at.x(), at.y());
    if (!height) continue;
    double above = worst_of({0.0, *height - p.z[i]});
    // A partner that only touches the generator removes no metal.
    if (above > kAbove * scale &&
        solids[k].clearance(at.x(), at.y()) >= -kTouch * (solids[k].scale() + p.radius))
      above = 0.0;
    none_above.see(above, kAbove * scale);
  }
}

void Proof::event(const std::vector<Solid>& solids, double rho, const Event& event) {
  const auto turn = elementary::sincos(event.phi);
  const double x = rho * turn.cos, y = rho * turn.sin;
  const auto& from = solids.at(event.from);
  const auto& to = solids.at(event.to);
  const double scale = std::max(from.scale(), to.scale()) + rho;
  if (event.kind == EventKind::junction) {
    const auto a = from.top(x, y);
    const auto b = to.top(x, y);
    event_gap.see(a && b ? std::abs(*a - *b) : scale, 1e-8 * scale);
  } else {
    // The cutter that is lost, or has a corner, where the generator touches the partner from
    // outside.
    const auto& lost = event.z_from > event.z_to ? from : to;
    event_gap.see(std::abs(lost.clearance(x, y)), 1e-8 * scale);
  }
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
  Proof proof;
  for (const auto& p : answer.profiles) {
    for (std::size_t i = 0; i < p.phi.size() && !stopped(); ++i) proof.node(solids, p, i);
    for (const auto& e : p.events) proof.event(solids, p.radius, e);
  }
  std::vector<Check> out;
  for (const auto* worst : {&proof.on_cutter, &proof.none_above, &proof.event_gap, &proof.labels})
    out.push_back(worst->check());
  return out;
}

}  // namespace tubecut::joint
