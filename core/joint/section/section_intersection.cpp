#include "core/joint/section/section_intersection.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/elementary.hpp"
#include "core/base/try.hpp"
#include "core/joint/section/section_sampling.hpp"
#include "core/joint/solid.hpp"

namespace tubecut::joint {
namespace {

using section::Station;

Result<SectionProfile> profile(const SectionContour& contour, const Sampling& sampling, bool outer,
                               std::span<const double> also) {
  TRY(const auto samples, sample(contour, sampling, also));
  SectionProfile out{.outer = outer,
                     .at = {},
                     .z = {},
                     .cutter = {},
                     .events = contour.events,
                     .length = samples.true_length,
                     .girth = contour.curve.girth()};
  for (const auto& node : samples.nodes) {
    out.at.push_back(contour.curve.at(node.s));
    out.z.push_back(node.z);
    out.cutter.push_back(node.after);
  }
  return out;
}

/// The seams of the other surface, as places of this one.
std::vector<double> other_seams(const section::Wall& wall, bool outer) {
  std::vector<double> out;
  if (outer)
    for (const double s : wall.bore().seams()) out.push_back(wall.outside_of(wall.bore().at(s)));
  else
    for (const double s : wall.outer().seams())
      out.push_back(wall.across(wall.outer().at(s)).bore.s);
  return out;
}

/// Worst of its kind, by the share of its own limit.
class Worst {
 public:
  Worst(std::string name, std::string unit) : check_{std::move(name), 0.0, 0.0, std::move(unit)} {}
  void see(double value, double limit) {
    const bool known = std::isnan(check_.value) ||  // which nothing is worse than
                       (check_.limit > 0.0 && value / limit <= check_.value / check_.limit);
    if (known) return;
    check_.value = value;
    check_.limit = limit;
  }
  [[nodiscard]] const Check& check() const { return check_; }

 private:
  Check check_;
};

constexpr double kOnOutline = 1e-12;  // of the outline's size
constexpr double kOnCutter = 1e-12;   // of the larger of radius + size and |z|
constexpr double kAbove = 1e-9;       // likewise
constexpr double kTouch = 1e-12;      // likewise
constexpr double kGraze = 4e-12;      // likewise: two proofs of one touch
constexpr double kLabel = 1e-7;       // likewise: the curve is vertical at a silhouette
constexpr double kBeside = 1e-9;      // of the girth: a row at an event

class Proof {
 public:
  Proof(const section::Section& section, const std::vector<Solid>& solids)
      : section_(section), solids_(solids), wide_(section.outer().reach()) {}

  void see(const SectionProfile& p) {
    for (std::size_t i = 0; i < p.z.size(); ++i) {
      see_place(p, i);
      see_height(p, i);
    }
    for (const auto& event : p.events) see_event(p, event);
  }
  [[nodiscard]] std::vector<Check> checks() const {
    std::vector<Check> out;
    for (const auto* worst : {&on_section_, &on_cutter_, &none_above_, &event_gap_, &labels_})
      out.push_back(worst->check());
    return out;
  }

 private:
  [[nodiscard]] double scale(const Solid& solid, double z) const {
    return std::max(solid.scale() + wide_, std::abs(z));
  }

  /// On the outline, and no further from the row before than the girth between them.
  void see_place(const SectionProfile& p, std::size_t i) {
    const auto& place = p.at[i].point;
    double off = std::abs(outline_distance(section_, p.outer, place));
    if (i > 0) {
      const double way = p.at[i].s - p.at[i - 1].s;
      off = std::max(off, (place - p.at[i - 1].point).norm() - way);
    }
    on_section_.see(off, kOnOutline * wide_);
  }

  void see_height(const SectionProfile& p, std::size_t i) {
    const Eigen::Vector2d place = p.at[i].point;
    const Eigen::Vector3d at(place.x(), place.y(), p.z[i]);
    const auto& own = solids_.at(p.cutter[i]);
    const double size = scale(own, p.z[i]);
    on_cutter_.see(std::abs(own.distance(at)), kOnCutter * size);
    labels_.see(off_label(own, at, size), kLabel * size);
    for (std::size_t k = 0; k < solids_.size(); ++k)
      if (k != p.cutter[i] && !beside_jump(p, i, k))
        none_above_.see(above(k, at, size), kAbove * size);
  }

  /// How far the cutter's own highest place is from the row.
  [[nodiscard]] static double off_label(const Solid& own, const Eigen::Vector3d& at, double size) {
    const auto top = own.top(at.x(), at.y());
    // A silhouette may be missed by rounding: there the line touches instead.
    if (!top && std::abs(own.clearance(at.x(), at.y())) <= kTouch * size)
      return std::abs(own.distance(at));
    const double off = top ? std::abs(*top - at.z()) : size;
    if (!top || off <= kLabel * size) return off;
    const Eigen::Vector3d middle(at.x(), at.y(), 0.5 * (at.z() + *top));
    return std::abs(own.distance(middle)) <= kGraze * size ? std::abs(own.distance(at)) : off;
  }

  /// A partner lost or found here stands above on one side only.
  [[nodiscard]] static bool beside_jump(const SectionProfile& p, std::size_t i, std::size_t k) {
    return std::ranges::any_of(p.events, [&](const SectionEvent& e) {
      const double d = std::abs(e.s - p.at[i].s);
      return e.kind == SectionEventKind::jump && (e.from == k || e.to == k) &&
             std::min(d, p.girth - d) < kBeside * p.girth;
    });
  }

  [[nodiscard]] double above(std::size_t k, const Eigen::Vector3d& at, double size) const {
    const auto height = solids_[k].top(at.x(), at.y());
    if (!height) return 0.0;
    const double out = worst_of({0.0, *height - at.z()});
    // What only touches the line takes no metal off it.
    const bool touches = out > kAbove * size && solids_[k].clearance(at.x(), at.y()) >=
                                                    -kTouch * (solids_[k].scale() + wide_);
    return touches ? 0.0 : out;
  }

  void see_event(const SectionProfile& p, const SectionEvent& event) {
    const auto outline = p.outer ? section_.outer() : section_.bore();
    const auto place = outline.at(event.s).point;
    const auto& from = solids_.at(event.from);
    const auto& to = solids_.at(event.to);
    const double size = std::max(from.scale(), to.scale()) + wide_;
    if (event.kind == SectionEventKind::seam) {
      event_gap_.see(std::abs(from.distance({place.x(), place.y(), event.z_from})), 1e-8 * size);
    } else if (event.kind == SectionEventKind::junction) {
      const auto a = from.top(place.x(), place.y()), b = to.top(place.x(), place.y());
      event_gap_.see(a && b ? std::abs(*a - *b) : size, 1e-8 * size);
    } else {
      // Lost, or turning its corner, where the line touches the partner from outside.
      const auto& lost = event.z_from > event.z_to ? from : to;
      event_gap_.see(std::abs(lost.clearance(place.x(), place.y())), 1e-8 * size);
    }
  }

  const section::Section& section_;
  const std::vector<Solid>& solids_;
  double wide_;
  Worst on_section_{"on_section", "mm"}, on_cutter_{"on_cutter", "mm"},
      none_above_{"none_above", "mm"}, event_gap_{"event_gap", "mm"}, labels_{"labels", "mm"};
};

}  // namespace

double outline_distance(const section::Section& section, bool outer, const Eigen::Vector2d& place) {
  const double less = outer ? 0.0 : section.wall;
  const double corner = outer ? section.corner : section.inner_corner;
  const double x = std::abs(place.x()) - 0.5 * section.height + less + corner;
  const double y = std::abs(place.y()) - 0.5 * section.width + less + corner;
  if (x > 0.0 && y > 0.0) return elementary::hypot(x, y) - corner;
  return std::max(x, y) - corner;
}

std::vector<Warning> partner_warnings(const SectionContour& contour) {
  std::vector<Warning> out;
  for (const auto i : contour.missed)
    out.push_back({.code = WarningCode::cutter_missed, .member = "cutters/" + std::to_string(i)});
  for (const auto i : contour.near_parallel)
    out.push_back({.code = WarningCode::near_parallel, .member = "cutters/" + std::to_string(i)});
  return out;
}

Result<SectionIntersection> intersect(const section::Section& section,
                                      const IntersectionSpec& spec) {
  TRY(const auto cutters, resolve(spec.partners));
  const section::Wall wall(section);
  SectionIntersection out;
  for (const bool outer : {false, true}) {
    if (spec.surfaces == (outer ? Surfaces::inner : Surfaces::outer)) continue;
    TRY(const auto contour, trace(cutters, outer ? wall.outer() : wall.bore()));
    TRY(auto curve, profile(contour, spec.sampling, outer, other_seams(wall, outer)));
    TRY(check_length(spec.target, curve.z));
    out.profiles.push_back(std::move(curve));
    out.warnings = partner_warnings(contour);  // of the outer surface when both are asked for
  }
  return out;
}

std::vector<Check> verify(const section::Section& section, const IntersectionSpec& spec,
                          const SectionIntersection& answer) {
  std::vector<Solid> solids;
  if (const auto cutters = resolve(spec.partners))
    for (const auto& cutter : *cutters) solids.emplace_back(cutter);
  Proof proof(section, solids);
  for (const auto& p : answer.profiles) proof.see(p);
  return proof.checks();
}

}  // namespace tubecut::joint
