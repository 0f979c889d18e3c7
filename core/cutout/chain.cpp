#include "core/cutout/chain.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "core/base/angle.hpp"
#include "core/base/elementary.hpp"
#include "core/math/polygon.hpp"

namespace tubecut::cutout {
namespace {

constexpr double kClosed = 1e-6;   // mm
constexpr double kCrossed = 1e-9;  // of the area

Flat on_circle(const Flat& centre, double radius, double angle) {
  const auto [sin, cos] = elementary::sincos(angle);
  return centre + radius * Flat(cos, sin);
}

Chain reversed(const Chain& chain) {
  Chain out(chain.rbegin(), chain.rend());
  for (auto& s : out) {
    std::swap(s.from, s.to);
    s.angle += s.sweep;
    s.sweep = -s.sweep;
  }
  return out;
}

/// Enough corners for a test of crossings: an arc as 48 chords a turn.
math::Polygon polygon(const Chain& chain) {
  math::Polygon out;
  for (const auto& s : chain) {
    const int parts =
        s.arc() ? std::max(2, static_cast<int>(std::ceil(48.0 * std::abs(s.sweep) / kTwoPi))) : 1;
    for (int i = 0; i < parts; ++i) {
      const auto p = s.at(static_cast<double>(i) / parts);
      out.x.push_back(p.x());
      out.y.push_back(p.y());
    }
  }
  return out;
}

Result<Segment> segment(const Flat& from, const DrawnSegment& piece, double up, std::size_t index) {
  const auto at = "pieces/" + std::to_string(index);
  const Flat to(piece.to.x(), up * piece.to.y());
  if (!piece.centre) {
    if ((to - from).norm() > kClosed) return line(from, to);
    return fail(
        {.code = ErrorCode::out_of_range, .member = at + "/to", .hint = "the line has no length"});
  }
  const Flat centre(piece.centre->x(), up * piece.centre->y());
  const double radius = (from - centre).norm(), other = (to - centre).norm();
  if (!(radius > kClosed) || std::abs(radius - other) > kClosed)
    return fail({.code = ErrorCode::out_of_range,
                 .member = at + "/centre",
                 .got = radius,
                 .limit = other,
                 .unit = "mm",
                 .hint = "both ends of an arc are one radius from its centre"});
  const bool a_to_b = piece.clockwise == (up < 0.0);
  const double angle = elementary::atan2(from.y() - centre.y(), from.x() - centre.x());
  const double end = elementary::atan2(to.y() - centre.y(), to.x() - centre.x());
  double sweep = a_to_b ? end - angle : angle - end;
  if (sweep <= 0.0 || (to - from).norm() <= kClosed) sweep += kTwoPi;
  if ((to - from).norm() <= kClosed) sweep = kTwoPi;
  auto out = arc(centre, radius, angle, a_to_b ? sweep : -sweep);
  out.from = from;
  out.to = to;
  return out;
}

/// From a place to the segment, mm.
double way_to(const Segment& s, const Flat& p) {
  if (!s.arc()) {
    const Flat way = s.to - s.from;
    const double share = std::clamp((p - s.from).dot(way) / way.squaredNorm(), 0.0, 1.0);
    return (s.at(share) - p).norm();
  }
  const Flat from = p - s.centre;
  const double turns = (elementary::atan2(from.y(), from.x()) - s.angle) / s.sweep;
  const double whole = kTwoPi / std::abs(s.sweep);
  if (turns - whole * std::floor(turns / whole) <= 1.0) return std::abs(from.norm() - s.radius);
  return std::min((s.from - p).norm(), (s.to - p).norm());
}

}  // namespace

Segment line(const Flat& from, const Flat& to) { return {.from = from, .to = to}; }

Segment arc(const Flat& centre, double radius, double angle, double sweep) {
  return {.from = on_circle(centre, radius, angle),
          .to = on_circle(centre, radius, angle + sweep),
          .centre = centre,
          .radius = radius,
          .angle = angle,
          .sweep = sweep};
}

Flat Segment::at(double share) const {
  if (share == 0.0) return from;
  if (share == 1.0) return to;
  if (!arc()) return (1.0 - share) * from + share * to;
  return on_circle(centre, radius, angle + share * sweep);
}

Flat Segment::along(double share) const {
  if (!arc()) return (to - from).normalized();
  const auto [sin, cos] = elementary::sincos(angle + share * sweep);
  return std::copysign(1.0, sweep) * Flat(-sin, cos);
}

double Segment::length() const { return arc() ? radius * std::abs(sweep) : (to - from).norm(); }

Chain circle(double diameter) { return {arc(Flat::Zero(), 0.5 * diameter, 0.0, kTwoPi)}; }

Chain slot(double length, double width) {
  const double half = 0.5 * (length - width), radius = 0.5 * width;
  if (!(half > 0.0)) return circle(width);
  return {line({-half, -radius}, {half, -radius}), arc({half, 0.0}, radius, -0.5 * kPi, kPi),
          line({half, radius}, {-half, radius}), arc({-half, 0.0}, radius, 0.5 * kPi, kPi)};
}

Chain rectangle(double along, double round, double radius) {
  const double x = 0.5 * along, y = 0.5 * round, u = x - radius, v = y - radius;
  Chain out;
  const auto side = [&](const Flat& from, const Flat& to) {
    if ((to - from).norm() > 0.0) out.push_back(line(from, to));
  };
  const auto corner = [&](double cx, double cy, int quarter) {
    if (radius > 0.0) out.push_back(arc({cx, cy}, radius, 0.5 * kPi * quarter, 0.5 * kPi));
  };
  side({-u, -y}, {u, -y});
  corner(u, -v, -1);
  side({x, -v}, {x, v});
  corner(u, v, 0);
  side({u, y}, {-u, y});
  corner(-u, v, 1);
  side({-x, v}, {-x, -v});
  corner(-u, -v, 2);
  return out;
}

Result<Chain> drawn(const Flat& start, const std::vector<DrawnSegment>& pieces, bool mirrored) {
  const double up = mirrored ? 1.0 : -1.0;
  const Flat first(start.x(), up * start.y());
  Chain out;
  std::vector<Issue> issues;
  Flat at = first;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    auto next = segment(at, pieces[i], up, i);
    at = {pieces[i].to.x(), up * pieces[i].to.y()};
    if (next) {
      out.push_back(*next);
      out.back().piece = i;
    } else {
      issues.push_back(next.error().issues.front());
    }
  }
  const double gap = (at - first).norm();
  if (gap > kClosed)
    issues.push_back({.code = ErrorCode::contour_open,
                      .got = gap,
                      .limit = 0.0,
                      .unit = "mm",
                      .hint = "the last piece ends where the first begins"});
  if (!issues.empty()) return tl::unexpected(Error{std::move(issues)});
  out.back().to = first;
  const double enclosed = area(out);
  const auto corners = polygon(out);
  if (!(std::abs(enclosed) > kClosed) ||
      math::crossed_area(corners) > kCrossed * std::abs(math::area(corners)))
    return fail({.code = ErrorCode::contour_crosses,
                 .hint = "a piece crosses another one, or nothing is enclosed"});
  return enclosed > 0.0 ? out : reversed(out);
}

Chain turned(Chain chain, double angle) {
  if (angle == 0.0) return chain;
  const auto [sin, cos] = elementary::sincos(angle);
  const auto turn = [s = sin, c = cos](const Flat& p) {
    return Flat(c * p.x() - s * p.y(), s * p.x() + c * p.y());
  };
  for (auto& s : chain) {
    s.from = turn(s.from);
    s.to = turn(s.to);
    s.centre = turn(s.centre);
    s.angle += angle;
  }
  return chain;
}

double area(const Chain& chain) {
  double twice = 0.0;
  for (const auto& s : chain) {
    twice += cross(s.from, s.to);
    if (s.arc()) twice += s.radius * s.radius * (s.sweep - elementary::sin(s.sweep));
  }
  return 0.5 * twice;
}

Bounds bounds(const Chain& chain) {
  Bounds out{chain.front().from, chain.front().from};
  const auto see = [&](const Flat& p) {
    out.least = out.least.cwiseMin(p);
    out.most = out.most.cwiseMax(p);
  };
  for (const auto& s : chain) {
    see(s.from);
    see(s.to);
    if (!s.arc()) continue;
    static const std::array<Flat, 4> kQuarters{Flat(1, 0), Flat(0, 1), Flat(-1, 0), Flat(0, -1)};
    for (int quarter = -8; quarter <= 8; ++quarter) {
      const double share = (0.5 * kPi * quarter - s.angle) / s.sweep;
      if (share > 0.0 && share < 1.0)
        see(s.centre + s.radius * kQuarters[static_cast<std::size_t>(quarter + 8) % 4]);
    }
  }
  return out;
}

double distance(const Chain& chain, const Flat& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& s : chain) {
    // No place of an arc is nearer than its circle.
    if (s.arc() && std::abs((p - s.centre).norm() - s.radius) > least + kClosed) continue;
    least = std::min(least, way_to(s, p));
  }
  return least;
}

bool holds(const Chain& chain, const Flat& p) {
  return std::ranges::any_of(stretches(chain, p.x()), [&](const auto& stretch) {
    return p.y() > stretch.first && p.y() < stretch.second;
  });
}

std::vector<std::pair<double, double>> stretches(const Chain& chain, double at) {
  std::vector<double> met;
  for (const auto& s : chain) {
    if (!s.arc()) {
      if ((s.from.x() > at) != (s.to.x() > at))
        met.push_back(s.from.y() +
                      (at - s.from.x()) / (s.to.x() - s.from.x()) * (s.to.y() - s.from.y()));
      continue;
    }
    // Each place of an arc is as near to its ends as the arc is long.
    if (std::abs(at - s.from.x()) > s.length() + kClosed) continue;
    const double off = at - s.centre.x(), square = s.radius * s.radius - off * off;
    if (!(square > 0.0)) continue;
    const double half = std::sqrt(square);
    for (const double b : {-half, half}) {
      const double turns = (elementary::atan2(b, off) - s.angle) / s.sweep;
      const double whole = kTwoPi / std::abs(s.sweep);
      const double share = turns - whole * std::floor(turns / whole);
      if (share >= 0.0 && share < 1.0) met.push_back(s.centre.y() + b);
    }
  }
  std::ranges::sort(met);
  std::vector<std::pair<double, double>> out;
  for (std::size_t i = 0; i + 1 < met.size(); i += 2) out.emplace_back(met[i], met[i + 1]);
  return out;
}

namespace {

/// Returns the shares at which |b| may be greatest.
std::vector<double> turning_shares(const Segment& s) {
  std::vector<double> out{0.0, 1.0};
  if (!s.arc()) return out;
  for (int k = -4; k <= 4; ++k) {
    const double share = ((k + 0.5) * kPi - s.angle) / s.sweep;
    if (share > 0.0 && share < 1.0) out.push_back(share);
  }
  return out;
}

}  // namespace

double reach_across(const Segment& s) {
  double out = 0.0;
  for (const double share : turning_shares(s)) out = std::max(out, std::abs(s.at(share).y()));
  return out;
}

std::vector<double> shares_towards(const Segment& s, int count, double near) {
  constexpr int kFiner = 24;  // halvings
  std::vector<double> out;
  for (const double at : turning_shares(s)) {
    if (std::abs(s.at(at).y()) < near) continue;
    out.push_back(at);
    for (int i = 1; i <= kFiner; ++i)
      for (const double sign : {-1.0, 1.0})
        if (const double share = at + sign * std::ldexp(1.0, -i); share > 0.0 && share < 1.0)
          out.push_back(share);
  }
  if (out.empty()) return out;
  for (int i = 0; i <= count; ++i) out.push_back(static_cast<double>(i) / count);
  std::ranges::sort(out);
  return out;
}

}  // namespace tubecut::cutout
