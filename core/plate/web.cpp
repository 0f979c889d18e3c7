#include "core/plate/web.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/base/angle.hpp"
#include "core/base/elementary.hpp"

namespace tubecut::plate {
namespace {

using cutout::Chain;
using cutout::cross;
using cutout::Flat;
using cutout::Segment;

constexpr double kTouching = 1e-9;  // mm

/// Returns true if an arc passes the direction from its centre.
bool passes(const Segment& arc, const Flat& towards) {
  const double turns = (elementary::atan2(towards.y(), towards.x()) - arc.angle) / arc.sweep;
  const double whole = kTwoPi / std::abs(arc.sweep);
  return turns - whole * std::floor(turns / whole) <= 1.0;
}

/// Keeps the least distance of places of two segments.
class Least {
 public:
  void see(const Flat& a, const Flat& b) { least_ = std::min(least_, (a - b).norm()); }
  [[nodiscard]] double value() const { return least_; }

 private:
  double least_ = std::numeric_limits<double>::infinity();
};

/// Returns the place of a segment next to another place: on its line or arc, else an end.
Flat nearest(const Segment& s, const Flat& p) {
  if (!s.arc()) {
    const Flat way = s.to - s.from;
    const double share = std::clamp((p - s.from).dot(way) / way.squaredNorm(), 0.0, 1.0);
    return s.from + share * way;
  }
  const Flat out = p - s.centre;
  if (out.norm() > 0.0 && passes(s, out)) return s.centre + s.radius * out.normalized();
  return (s.from - p).norm() < (s.to - p).norm() ? s.from : s.to;
}

bool cross_lines(const Segment& a, const Segment& b) {
  const Flat u = a.to - a.from, v = b.to - b.from;
  return cross(u, b.from - a.from) * cross(u, b.to - a.from) < 0.0 &&
         cross(v, a.from - b.from) * cross(v, a.to - b.from) < 0.0;
}

bool cross_line_arc(const Segment& line, const Segment& arc) {
  const Flat way = (line.to - line.from).normalized(), to = line.from - arc.centre;
  const double length = (line.to - line.from).norm();
  const double middle = -to.dot(way), off = cross(way, to);
  const double square = arc.radius * arc.radius - off * off;
  if (!(square > 0.0)) return false;
  for (const double sign : {-1.0, 1.0}) {
    const double at = middle + sign * std::sqrt(square);
    if (at >= 0.0 && at <= length && passes(arc, to + at * way)) return true;
  }
  return false;
}

bool cross_arcs(const Segment& a, const Segment& b) {
  const Flat way = b.centre - a.centre;
  const double apart = way.norm();
  if (!(apart > 0.0)) return false;
  const double along = (apart * apart + a.radius * a.radius - b.radius * b.radius) / (2.0 * apart);
  const double square = a.radius * a.radius - along * along;
  if (!(square > 0.0)) return false;
  const Flat unit = way / apart, side(-unit.y(), unit.x());
  for (const double sign : {-1.0, 1.0}) {
    const Flat at = along * unit + sign * std::sqrt(square) * side;
    if (passes(a, at) && passes(b, at - way)) return true;
  }
  return false;
}

bool crosses(const Segment& a, const Segment& b) {
  if (!a.arc()) return b.arc() ? cross_line_arc(a, b) : cross_lines(a, b);
  return b.arc() ? cross_arcs(a, b) : cross_line_arc(b, a);
}

/// The least distance lies at an end of one, or where one line is normal to both.
double between(const Segment& a, const Segment& b) {
  if (crosses(a, b)) return 0.0;
  Least least;
  for (const auto& p : {a.from, a.to}) least.see(p, nearest(b, p));
  for (const auto& p : {b.from, b.to}) least.see(p, nearest(a, p));
  const auto towards = [&](const Segment& arc, const Segment& other, const Flat& place) {
    const Flat out = place - arc.centre;
    if (!(out.norm() > 0.0)) return;
    for (const double sign : {-1.0, 1.0})
      if (passes(arc, sign * out)) {
        const Flat p = arc.centre + sign * arc.radius * out.normalized();
        least.see(p, nearest(other, p));
      }
  };
  if (a.arc()) towards(a, b, b.arc() ? b.centre : nearest(b, a.centre));
  if (b.arc()) towards(b, a, a.arc() ? a.centre : nearest(a, b.centre));
  return least.value();
}

}  // namespace

double gap(const Chain& a, const Chain& b) {
  double out = std::numeric_limits<double>::infinity();
  for (const auto& s : a)
    for (const auto& t : b) out = std::min(out, between(s, t));
  return out > kTouching ? out : 0.0;
}

bool encloses(const Chain& chain, const Flat& place) {
  double turned = 0.0;
  for (const auto& s : chain) {
    const int parts = s.arc() ? std::max(1, static_cast<int>(std::ceil(std::abs(s.sweep)))) : 1;
    for (int i = 0; i < parts; ++i) {
      const Flat from = s.at(static_cast<double>(i) / parts) - place;
      const Flat to = s.at(static_cast<double>(i + 1) / parts) - place;
      turned += elementary::atan2(cross(from, to), from.dot(to));
      // Between the chord and its arc the two pass the place on different sides.
      const double side = std::copysign(1.0, s.sweep) * cross(to - from, -from);
      if (s.arc() && side < 0.0 && (place - s.centre).norm() < s.radius)
        turned += std::copysign(kTwoPi, s.sweep);
    }
  }
  return std::abs(turned) > kPi;
}

double box_gap(const cutout::Bounds& a, const cutout::Bounds& b) {
  return (a.least - b.most).cwiseMax(b.least - a.most).cwiseMax(0.0).norm();
}

Chain moved(Chain chain, const Flat& by) {
  for (auto& s : chain)
    for (auto* point : {&s.from, &s.to, &s.centre}) *point += by;
  return chain;
}

}  // namespace tubecut::plate
