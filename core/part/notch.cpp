#include "core/part/notch.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "core/base/elementary.hpp"
#include "core/joint/intersection.hpp"
#include "core/math/rotation.hpp"

namespace tubecut::part {
namespace {

constexpr int kPhases = 1440;
constexpr double kStep = kTwoPi / kPhases;

/// Finds the minimum over one revolution: the best phase, refined by ternary search.
double least(const std::function<double(double)>& value) {
  double best = 0.0, low = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kPhases; ++i)
    if (const double v = value(kStep * i); v < low) {
      low = v;
      best = kStep * i;
    }
  constexpr int kThirds = 60;
  double from = best - kStep, to = best + kStep;
  for (int i = 0; i < kThirds; ++i) {
    const double a = from + (to - from) / 3.0, b = to - (to - from) / 3.0;
    const double at_a = value(a), at_b = value(b);
    low = std::min({low, at_a, at_b});
    (at_a < at_b ? to : from) = at_a < at_b ? b : a;
  }
  return low;
}

/// Returns the partner as a round tube, in the end's own frame; empty when it is not round.
std::optional<joint::TubeCutter> round(const joint::Partner& partner) {
  if (const auto* tube = std::get_if<joint::TubeCutter>(&partner)) return *tube;
  const auto* line = std::get_if<joint::AxisTube>(&partner);
  if (line == nullptr) return std::nullopt;
  const auto tube = line->tube();
  return tube ? std::optional(*tube) : std::nullopt;
}

bool is_set_on(const bevel::TableSpec& cut, std::size_t partner) {
  const auto& joint = bevel::stated_joint(cut, partner);
  return !joint || joint->kind == joint::JointKind::set_on;
}

/// The outer wall's contour at one end.
class OuterWall {
 public:
  explicit OuterWall(const bevel::TableSpec& cut) : radius_(cut.target.outer_radius) {
    const auto resolved = joint::resolve(cut.partners);
    if (!resolved) return;
    for (const auto& one : *resolved)
      if (auto cutter = joint::prepare(one)) cutters_.push_back(*std::move(cutter));
    if (cutters_.size() == cut.partners.size())
      tip_ = least([this](double phi) {
        double z = -std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < cutters_.size(); ++i) z = std::max(z, sheet(i, phi));
        return std::isfinite(z) ? z : std::numeric_limits<double>::infinity();
      });
  }
  /// Returns the depth from the long point; empty when it is undefined.
  [[nodiscard]] std::optional<double> depth(std::size_t partner) const {
    if (!std::isfinite(tip_)) return std::nullopt;
    const double throat = -least([&](double phi) { return -sheet(partner, phi); });
    return std::isfinite(throat) ? std::optional(throat - tip_) : std::nullopt;
  }

 private:
  [[nodiscard]] double sheet(std::size_t partner, double phi) const {
    return joint::upper_sheet(cutters_[partner], joint::generator_at(radius_, phi))
        .value_or(-std::numeric_limits<double>::infinity());
  }

  double radius_;
  std::vector<joint::PreparedCutter> cutters_;
  double tip_ = std::numeric_limits<double>::infinity();
};

/// A side of the tube, in the part's phi: the direction in which the partner leans, else its
/// perpendicular.
struct Side {
  double phi = 0.0;
  bool leans = false;
};
Side side_of(const joint::TubeCutter& tube, bool finish) {
  const auto bearing = tube.bearing();
  const double own = bearing->lean.value_or(bearing->perpendicular);
  return {finish ? -own : own, bearing->lean.has_value()};
}

/// Returns the rotation from one side to another; if a partner leans both ways, between the
/// perpendiculars.
double turn(const joint::TubeCutter& from, bool from_finish, const joint::TubeCutter& to,
            bool to_finish) {
  const auto a = side_of(from, from_finish), b = side_of(to, to_finish);
  const bool both = a.leans && b.leans;
  const auto square = [](const joint::TubeCutter& tube, bool finish) {
    const double own = tube.bearing()->perpendicular;
    return finish ? -own : own;
  };
  const double whole = both ? b.phi - a.phi : square(to, to_finish) - square(from, from_finish);
  const double period = both ? kTwoPi : kPi;
  const double out = whole - period * std::floor(whole / period);
  return out > 0.5 * period ? out - period : out;
}

}  // namespace

std::vector<Notch> notches(const PartSpec& spec, const Part& part) {
  std::vector<Notch> out;
  std::optional<joint::TubeCutter> first;
  bool first_finish = false;
  for (const auto* end : {&part.start, &part.finish}) {
    const bool finish = end == &part.finish;
    if (!(finish ? spec.finish : spec.start).welded) continue;
    std::optional<OuterWall> wall;
    for (std::size_t i = 0; i < end->spec.partners.size(); ++i) {
      const auto tube = round(end->spec.partners[i]);
      const bool cuts = std::ranges::find(end->own.cutter, i) != end->own.cutter.end();
      if (!tube || !cuts || !is_set_on(end->spec, i)) continue;
      if (!wall) wall.emplace(end->spec);
      const auto depth = wall->depth(i);
      if (!depth) continue;
      if (!first) {
        first = tube;
        first_finish = finish;
      }
      const auto foot = joint::axis_of(*tube).point;
      const double towards = elementary::atan2(foot.y(), foot.x());
      out.push_back({.finish = finish,
                     .partner = i,
                     .saw_diameter = 2.0 * tube->radius,
                     .angle = std::abs(0.5 * kPi - tube->inclination.rad()),
                     .offset = std::abs(tube->offset),
                     .offset_towards = math::whole_turn(finish ? -towards : towards),
                     .depth = *depth,
                     .rotation = turn(*first, first_finish, *tube, finish)});
    }
  }
  return out;
}

}  // namespace tubecut::part
