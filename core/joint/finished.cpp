#include "core/joint/finished.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/elementary.hpp"

namespace tubecut::joint::detail {
namespace {

using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLeastCorner = 1e-6;  // mm: of a rectangular tube that is made smaller

/// Where the generators near one leave a seat.
struct Leaves {
  double least = -kInfinity;  // z of those that meet it
  bool all = false, none = false;
};

Leaves leaves(const PreparedTube& t, const Cutter& /*cutter*/, const Generator& line,
              const Slack& slack) {
  const double r = t.radius + slack.keep;
  const double u = line.radius * (line.cos_phi * t.cos_clocking + line.sin_phi * t.sin_clocking);
  const double v = line.radius * (line.sin_phi * t.cos_clocking - line.cos_phi * t.sin_clocking);
  const double x = std::abs(u + t.offset), far = x + slack.off;
  Leaves out{.all = far <= r, .none = x - slack.off > r};
  const double half = out.all ? std::sqrt((r - far) * (r + far)) : 0.0;
  out.least = t.height + (half - v * t.cos_inclination - slack.off * std::abs(t.cos_inclination)) /
                             t.sin_inclination;
  return out;
}

Leaves leaves(const PreparedPlane& p, const Cutter& /*cutter*/, const Generator& line,
              const Slack& slack) {
  return {.least = p.continued_sheet(line) + slack.keep / p.normal.z() -
                   slack.off * elementary::hypot(p.slope_x, p.slope_y),
          .all = true};
}

Cutter moved(Cutter cutter, double by) {
  by_kind(cutter, [&]<class Kind>(Kind& kind) {
    if constexpr (std::is_same_v<Kind, RectangularTubeCutter>) {
      // Inside a larger corner radius, the smaller box has sharp corners.
      const double corner = std::max(kLeastCorner, kind.corner + by);
      kind.grow(by);
      kind.corner = corner;
    } else {
      kind.grow(by);
    }
  });
  return cutter;
}

std::optional<double> top_of(const Cutter& cutter, const Generator& line) {
  const auto prepared = prepare(cutter);
  return prepared ? upper_sheet(*prepared, line) : std::nullopt;
}

/// Any other kind: a solid smaller by `off` lies within every solid that is moved by at most `off`.
template <class Kind>
Leaves leaves(const Kind& /*prepared*/, const Cutter& cutter, const Generator& line,
              const Slack& slack) {
  if (const auto z = top_of(moved(cutter, slack.keep - slack.off), line))
    return {.least = *z, .all = true};
  const bool met = slack.off > 0.0 && top_of(moved(cutter, slack.keep + slack.off), line);
  return {.none = !met};
}

FinishedEnd end_of(const MemberEnd& end, const std::vector<Cutter>* beside) {
  FinishedEnd out{.frame = end.frame, .seats = {}, .prepared = {}};
  const auto add = [&](const Cutter& cutter) {
    auto one = prepare(cutter);
    if (!one) return;
    out.seats.push_back(cutter);
    out.prepared.push_back(*std::move(one));
  };
  for (const auto& cut : end.cut_by)
    by_kind(seat_of(cut), [&](const auto& seat) { add(Cutter(seat)); });
  if (beside != nullptr)
    for (const auto& cutter : *beside) add(cutter);
  return out;
}

}  // namespace

double FinishedEnd::top(double rho, const Vector3d& q) const {
  const Generator line{rho, q.dot(frame.rows.row(0)), q.dot(frame.rows.row(1))};
  const auto hit = highest(prepared, line);
  return hit ? hit->z : 0.0;
}

double FinishedEnd::begins(double rho, const Vector3d& q, const Slack& slack) const {
  const Generator line{rho, q.dot(frame.rows.row(0)), q.dot(frame.rows.row(1))};
  double met = -kInfinity, least = slack.keep;
  bool all = false;
  for (std::size_t i = 0; i < seats.size(); ++i) {
    const auto one =
        by_kind(prepared[i], [&](const auto& kind) { return leaves(kind, seats[i], line, slack); });
    if (one.none) continue;
    least = std::min(least, one.least);
    if (!one.all) continue;
    met = std::max(met, one.least);
    all = true;
  }
  return all ? met : least;
}

Vector3d Finished::side(double phi) const {
  const auto at = elementary::sincos(phi);
  return at.cos * first.frame.rows.row(0).transpose() +
         at.sin * first.frame.rows.row(1).transpose();
}

// A place of a section at one depth moves by at most the way along the outside, because the centre
// of a corner lies further in than the wall.
double Finished::bundle_reach(double rho, double half_rho, double half_phi) const {
  if (section) return elementary::hypot(half_rho, turn_of(rho) * half_phi);
  return std::sqrt(half_rho * half_rho + rho * (rho + half_rho) * half_phi * half_phi);
}

bool Finished::in_bore(const Line& line, double off, double keep) const {
  constexpr double kHair = 1e-9;  // mm: rounding
  return section && section->bore.distance(line.rho * section->across(line.q)) < keep - off - kHair;
}

double Finished::support(const Vector3d& direction) const {
  if (section) return section->outside.support(section->across(direction));
  return outer * (direction - direction.dot(axis) * axis).norm();
}

double Finished::below(const Vector3d& point) const {
  const Vector3d from = point - start;
  if (section) return -section->outside.distance(section->across(from));
  return outer - (from - from.dot(axis) * axis).norm();
}

Line Finished::on_section(double phi, double rho) const {
  const auto& s = *section;
  const auto at = s.curve.at(turn_of(rho) * phi);
  const Eigen::Vector2d p = at.point - (outer - rho) * at.normal;
  const double from_axis = p.norm();
  if (!(from_axis > 0.0)) return {0.0, s.x};
  return {from_axis, (p.x() * s.x + p.y() * s.y) / from_axis};
}

namespace {

/// Returns the thickness of a section's wall where it is thickest along its outside's normal.
double thickest(const section::Section& section) {
  const section::Wall wall(section);
  const auto& outer = wall.outer();
  double out = section.wall;
  for (const auto& segment : outer.segments())
    for (const double share : {0.0, 0.5})
      out = std::max(out, wall.across(outer.at(segment.from + share * segment.length)).wall);
  return out;
}

}  // namespace

Finished finished(const NodeSpec& spec, const Nodes& nodes, std::size_t member,
                  const Beside& beside) {
  const auto& m = spec.members[member];
  const Vector3d along = m.finish - m.start;
  const auto end = [&](std::size_t index) {
    return end_of(nodes.ends[index], index < beside.size() ? &beside[index] : nullptr);
  };
  Finished out{.start = m.start,
               .axis = along.normalized(),
               .length = along.norm(),
               .inner = m.outer_radius - m.wall,
               .outer = m.outer_radius,
               .first = end(2 * member),
               .last = end(2 * member + 1)};
  if (const auto& section = m.section) {
    out.outer = section->reach();
    out.inner = out.outer - thickest(*section);
    const Vector3d x = height_of(m);
    out.section = FinishedSection{section->outer(), Outline::outside(*section),
                                  Outline::bore(*section), x, out.axis.cross(x)};
  }
  return out;
}

}  // namespace tubecut::joint::detail
