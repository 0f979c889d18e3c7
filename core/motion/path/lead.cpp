#include "core/motion/path/lead.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/base/try.hpp"
#include "core/motion/path/stretch.hpp"

namespace tubecut::motion {
namespace {

constexpr double kArcStep = 3.0 * kRadPerDeg;  // between points of a lead arc
constexpr double kRunStep = 0.5;               // mm between points of a straight run

Flat operator+(Flat a, Flat b) { return {a.s + b.s, a.z + b.z}; }
Flat operator*(double k, Flat a) { return {k * a.s, k * a.z}; }

struct Join {
  CutPoint at;
  Flat point;
  Flat tangent;
  Flat normal;  // unit, towards the scrap
};

Flat flat(const Track& t, const CutPoint& p) { return {t.radius * p.phi, p.z}; }

Flat unit(Flat a) {
  const double length = elementary::hypot(a.s, a.z);
  return length > 0.0 ? (1.0 / length) * a : Flat{1.0, 0.0};
}

/// Returns the first direction of non-zero length from point `i` in steps of `by`; a pure swing of
/// B has none.
Flat chord(const Track& t, std::size_t i, int by) {
  const auto last = static_cast<std::ptrdiff_t>(t.points.size()) - 1;
  for (auto j = static_cast<std::ptrdiff_t>(i) + by; j >= 0 && j <= last; j += by) {
    const auto to = static_cast<std::size_t>(j);
    if (t.tip_step(i, to) > 0.0) return flat(t, t.points[to]) + -1.0 * flat(t, t.points[i]);
  }
  return {};
}

/// Returns the tangent in the middle of a smooth seam (parabola through three points); at a corner,
/// that of the cut's own side.
Flat tangent(const Track& t, Flat before, Flat after, bool starting) {
  const double a = elementary::hypot(before.s, before.z);
  const double b = elementary::hypot(after.s, after.z);
  const Flat own = starting ? after : before;
  const bool smooth = t.closed && !t.points.front().corner &&
                      before.s * after.s + before.z * after.z > 0.94 * a * b;
  return unit(smooth ? (b / a) * before + (a / b) * after : own);
}

Flat scrap_normal(Flat t, int orientation, Scrap scrap) {
  const Flat left{-t.z, t.s};
  if (scrap == Scrap::inside) return orientation * left;
  return (scrap == Scrap::plus_z ? orientation : -orientation) * left;
}

/// Returns the direction along the track just before point `i`; zero at the start of an open track.
Flat behind(const Track& t, std::size_t i) {
  if (i == 0 && !t.closed) return {};
  return -1.0 * chord(t, i == 0 ? t.points.size() - 1 : i, -1);
}

Join join(const Track& t, Scrap scrap, std::size_t i, bool starting) {
  const Flat before = behind(t, i);
  const Flat after = i + 1 == t.points.size() ? before : chord(t, i, 1);
  const bool start = i == 0 && !t.closed;
  const Flat along = tangent(t, start ? after : before, after, starting);
  return {t.points[i], flat(t, t.points[i]), along, scrap_normal(along, t.orientation(), scrap)};
}

/// Returns a point `a` rad around the arc from the join; `way` is -1 before the join, +1 after it.
Flat on_arc(const Join& j, double radius, double a, double way) {
  const auto [sin, cos] = elementary::sincos(a);
  return j.point + radius * (1.0 - cos) * j.normal + way * radius * sin * j.tangent;
}

/// The arc's points away from the join, nearest first, and their distances from it along the path.
struct Away {
  std::vector<Flat> points;
  std::vector<double> distance;
};

Away arc(const Join& j, const Lead& lead, double way) {
  Away out;
  if (lead.shape == Lead::Shape::square) return out;
  const double sweep = lead.sweep.rad();
  const auto n = std::max(1, static_cast<int>(std::ceil(sweep / kArcStep)));
  for (int i = 1; i <= n; ++i) {
    out.points.push_back(on_arc(j, lead.radius, sweep * i / n, way));
    out.distance.push_back(lead.radius * sweep * i / n);
  }
  return out;
}

/// Extends the lead-in by a straight run: until the fan of B fits before the cut, and for a square
/// lead until it begins at the requested distance.
void add_run(Away& way_in, const Join& j, const Lead& lead) {
  const bool square = lead.shape == Lead::Shape::square;
  const double start = square ? 0.0 : way_in.distance.back();
  const double run = std::max(lead.pierce_b ? lead.fan - start : 0.0, square ? lead.radius : 0.0);
  if (run <= 0.0) return;
  const auto [sin, cos] = elementary::sincos(lead.sweep.rad());
  const Flat back = square ? j.normal : sin * j.normal + -cos * j.tangent;
  const Flat from = square ? j.point : way_in.points.back();
  const auto n = std::max(1, static_cast<int>(std::ceil(run / kRunStep)));
  for (int i = 1; i <= n; ++i) {
    way_in.points.push_back(from + (run * i / n) * back);
    way_in.distance.push_back(start + run * i / n);
  }
}

/// B, the beam's length through the wall and its tilt across.
struct Line {
  double b, beam, a;
};

/// Returns the line of a closed cut at this distance after its start, mm, or before it; stops where
/// the cut has a corner or swings without motion.
Line line_of(const Track& cut, double past_start) {
  const auto n = cut.points.size();
  const bool back = past_start < 0.0;
  const auto index = [&](std::size_t k) { return back ? n - 1 - k : k; };
  double left = std::abs(past_start);
  Line out{cut.points.front().b, cut.points.front().beam, cut.points.front().a};
  for (std::size_t k = 0; k + 1 < n && left > 0.0; ++k) {
    const auto &from = cut.points[index(k)], &to = cut.points[index(k + 1)];
    const double step = cut.tip_step(index(k), index(k + 1));
    if (step == 0.0 || (k > 0 && from.corner)) break;
    const auto at = between(cut.wall, from, to, std::min(1.0, left / step));
    out = {at.b, at.beam, at.a};
    left -= step;
  }
  return out;
}

/// Returns the line of the lead at this distance after the cut's start, or before it.
Line line_of(const Track& cut, const Join& j, LeadBevel bevel, double past_start) {
  const bool held = bevel == LeadBevel::held || !cut.closed;
  return held ? Line{j.at.b, j.at.beam, j.at.a} : line_of(cut, past_start);
}

CutPoint placed(const Track& t, Flat p, Line line) {
  return {p.s / t.radius, p.z, line.b, false, line.beam, line.a};
}

std::vector<CutPoint> way_in(const Track& t, const Join& j, const Lead& lead, LeadBevel bevel) {
  Away way = arc(j, lead, -1.0);
  add_run(way, j, lead);
  const double fan = std::min(lead.fan, way.distance.back());
  const Line first = line_of(t, j, bevel, -way.distance.back());
  const double most = lead.pierce_b ? lead.pierce_b->rad() : std::abs(first.b);
  const double pierce = std::clamp(first.b, -most, most);
  std::vector<CutPoint> out;
  for (std::size_t i = way.points.size(); i-- > 0;) {
    CutPoint p = placed(t, way.points[i], line_of(t, j, bevel, -way.distance[i]));
    const double done =
        fan > 0.0 ? std::min(1.0, (way.distance.back() - way.distance[i]) / fan) : 1.0;
    p.b += (1.0 - done) * (pierce - first.b);
    out.push_back(p);
  }
  return out;
}

}  // namespace

CutWithLead with_lead(const Track& cut, const Lead& lead, Scrap scrap, LeadBevel bevel) {
  Track t = cut;
  if (t.closed) {
    std::vector<CutPoint> again = first_stretch(cut, lead.overcut);
    for (auto p = again.begin() + 1; p != again.end(); ++p) {
      p->phi += kTwoPi * cut.turns;
      t.points.push_back(*p);
    }
  }
  CutWithLead out;
  out.points = way_in(cut, join(cut, scrap, 0, true), lead, bevel);
  out.cut_first = out.points.size();
  out.points.insert(out.points.end(), t.points.begin(), t.points.end());
  if (lead.shape == Lead::Shape::square) out.points[out.cut_first].corner = true;
  out.cut_last = out.points.size() - 1;
  const Join end = join(t, scrap, t.points.size() - 1, false);
  const Away way = arc(end, lead, 1.0);
  for (std::size_t i = 0; i < way.points.size(); ++i)
    out.points.push_back(
        placed(t, way.points[i], line_of(cut, end, bevel, lead.overcut + way.distance[i])));
  return out;
}

double lead_touch(const PartBorder& border, double eps_tip) {
  return kLeadTouch + std::min(border.sag, eps_tip);
}

Result<void> check_clear(const CutWithLead& cut, const PartBorder& part, double eps_tip) {
  if (!part.cut.closed) return {};
  const double allowed = lead_touch(part, eps_tip);
  for (std::size_t i = 0; i < cut.points.size(); ++i) {
    if (i >= cut.cut_first && i <= cut.cut_last) continue;
    const CutPoint& p = cut.points[i];
    const double depth = intrusion(part, p);
    if (stopped()) return fail({.code = ErrorCode::cancelled});
    if (depth <= allowed) continue;
    return fail({ErrorCode::lead_blocked, "motion/lead", depth, allowed, "mm",
                 "at phi " + brief(p.phi * kDegPerRad) + " deg"});
  }
  return {};
}

Result<CutWithLead> clear_lead(const PartBorder& border, const Track& cut, const Lead& lead,
                               double eps_tip) {
  const auto with = [&](LeadBevel bevel) -> Result<CutWithLead> {
    CutWithLead out = with_lead(cut, lead, border.scrap, bevel);
    TRY(check_clear(out, border, eps_tip));
    return out;
  };
  auto out = with(LeadBevel::held);
  if (!out && out.error().code() == ErrorCode::lead_blocked)
    if (auto followed = with(LeadBevel::followed)) out = std::move(followed);
  return out;
}

}  // namespace tubecut::motion
