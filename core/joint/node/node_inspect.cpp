#include <algorithm>
#include <cmath>

#include "core/base/elementary.hpp"
#include "core/joint/node/cut_away.hpp"
#include "core/joint/node/node_parts.hpp"
#include "core/joint/node/shared_corner.hpp"
#include "core/joint/section/section_contour.hpp"
#include "core/joint/section/section_place.hpp"

namespace tubecut::joint::detail {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kScan = 180;  // generators in the scan for ghosts and the highest z

/// Cheap bounds of a cutter's sheet on radius rho: the highest z, and the extent along its own
/// axis.
struct Bounds {
  double z, axial;
};
/// A section lies within the tube of its placement.
Bounds bounds_on(double rho, const CutBy& cut) {
  const double by = seat(cut.stated, 0.0, 0.0);
  if (cut.plane) {
    auto plane = *cut.plane;
    if (by != 0.0) plane.grow(by);
    const Vector3d n = plane.normal / plane.normal.z();
    return {plane.point.dot(n) + rho * elementary::hypot(n.x(), n.y()), 0.0};
  }
  auto t = cut.placement.tube;
  if (by != 0.0) t.grow(by);
  const auto turn = elementary::sincos(t.inclination.rad());
  return {t.height + (t.radius + rho * std::abs(turn.cos)) / turn.sin,
          (t.radius * std::abs(turn.cos) + rho) / turn.sin};
}

/// Returns the position along a member, from its start, of w, which is measured from the common
/// perpendicular along its axis.
double along(const CutBy& cut, double w) { return w - cut.placement.point_axial; }

/// Returns true if that is beyond the member's ends.
bool beyond(const Member& m, const CutBy& cut, double w) {
  const double length = (m.finish - m.start).norm();
  const double slack = 1e-9 * (length + std::abs(cut.placement.point_axial));
  return along(cut, w) < -slack || along(cut, w) > length + slack;
}

/// Returns true if an end is mitred with a member that does not continue its line.
bool mitred(const Lines& lines, const Applied::Pair& one) {
  const auto& mate = lines.mates[one.first];
  return !mate || mate->end / 2 != one.second;
}

/// The inspection of one end.
class EndInspection {
 public:
  EndInspection(const Joints& joints, MemberEnd& end)
      : spec_(joints.spec),
        lines_(joints.lines),
        applied_(joints.applied),
        end_(end),
        seen_(end.cut_by.size()) {
    for (const auto& cut : end.cut_by) {
      cut_away_.emplace_back(joints, end.member, cut.member);
      auto& planes = planes_.emplace_back();
      for (const auto at : {2 * cut.member, 2 * cut.member + 1})
        for (auto it = applied_.mitres.lower_bound({at, 0});
             it != applied_.mitres.end() && it->first.first == at; ++it)
          if (mitred(lines_, it->first)) planes.push_back(&*it);
    }
  }

  /// Returns true if a partner ends before its work point, so that contacts may lie beyond it.
  [[nodiscard]] bool any_cut_away() const {
    return !std::ranges::all_of(cut_away_, &CutAway::empty) ||
           !std::ranges::all_of(planes_, &Planes::empty);
  }

  /// Finds ghosts and the highest z on the generators of one surface.
  void scan(std::span<const PreparedCutter> cutters, const std::vector<Generator>& lines,
            double length) {
    for (const auto& line : lines) {
      const auto top = highest(cutters, line);
      if (!top) continue;
      auto& seen = seen_[top->cutter];
      seen.anywhere = true;
      seen.consumes = seen.consumes || top->z > length;
      seen.highest = std::max(seen.highest, top->z);
      end_.consumed = end_.consumed || top->z > length;
      see_hidden(cutters, line, *top);
      const auto at = hit(cutters[top->cutter], line);
      if (end_.cut_by[top->cutter].plane || !at)
        see_plane(top->cutter, line, top->z);
      else
        see(cutters, top->cutter, line, *at);
    }
  }
  /// Finds the partners that run past the member or only touch its surfaces.
  void see_passing(std::span<const PreparedCutter> cutters,
                   const std::vector<std::vector<Generator>>& inside) {
    for (std::size_t i = 0; i < cutters.size(); ++i)
      seen_[i].passes = std::ranges::none_of(inside, [&](const auto& lines) {
        return std::ranges::any_of(
            lines, [&](const Generator& line) { return hit(cutters[i], line).has_value(); });
      });
  }
  [[nodiscard]] bool some_unseen() const {
    return !std::ranges::all_of(seen_, &Presence::anywhere);
  }
  void all_there() {
    for (auto& one : seen_) one.anywhere = one.there = true;
  }
  [[nodiscard]] std::vector<Presence> take() { return std::move(seen_); }

 private:
  /// Sees partners whose surface is flush with the highest one: a face below that is cut away
  /// before it does not hold the end, although rounding may put it on top elsewhere.
  void see_hidden(std::span<const PreparedCutter> cutters, const Generator& line,
                  const Contact& top) {
    for (std::size_t i = 0; i < cutters.size(); ++i) {
      if (i == top.cutter || (cut_away_[i].empty() && planes_[i].empty())) continue;
      const auto at = hit(cutters[i], line);
      if (!at || at->z < top.z - kFlushFaces) continue;
      const auto off = missing(i, line, *at);
      auto& seen = seen_[i];
      (off.by <= kStep || off.instead ? seen.there : seen.flush) = true;
      seen.nearest = std::min(seen.nearest, off.by);
    }
  }
  /// Sees a mitre's plane, behind which another member may have cut the partner away.
  void see_plane(std::size_t cutter, const Generator& line, double z) {
    seen_[cutter].there = true;
    if (cut_away_[cutter].empty()) return;
    const double off = cut_away_[cutter].length(in_space(line, z));
    // Less is where a line touches the other member, by rounding.
    if (off <= kBehindPlane * spec_.members[end_.member].reach()) return;
    auto& cut = end_.cut_by[cutter];
    cut.ghost = true;
    cut.missing = std::max(cut.missing, off);
  }
  [[nodiscard]] Vector3d in_space(const Generator& line, double z) const {
    return end_.frame.origin + end_.frame.rows.transpose() * Vector3d(line.radius * line.cos_phi,
                                                                      line.radius * line.sin_phi,
                                                                      z);
  }
  /// Returns true if the metal of another partner is flush with this place: two partners in line
  /// have one surface, and rounding decides which of them is the highest there.
  [[nodiscard]] bool held_by_another(std::span<const PreparedCutter> cutters, std::size_t cutter,
                                     const Generator& line, double z) const {
    for (std::size_t i = 0; i < cutters.size(); ++i) {
      if (i == cutter || end_.cut_by[i].plane) continue;
      const auto at = hit(cutters[i], line);
      if (at && std::abs(at->z - z) <= kFlushFaces && missing(i, line, *at).by <= kStep)
        return true;
    }
    return false;
  }
  void see(std::span<const PreparedCutter> cutters, std::size_t cutter, const Generator& line,
           const Hit& at) {
    auto& cut = end_.cut_by[cutter];
    auto& seen = seen_[cutter];
    const auto off = missing(cutter, line, at);
    if (off.by <= kStep || off.instead) seen.there = true;
    if (off.by <= kStep) return;
    seen.nearest = std::min(seen.nearest, off.by);
    if (held_by_another(cutters, cutter, line, at.z)) return;
    cut.ghost = true;
    if (off.by <= cut.missing) return;
    cut.missing = off.by;
    cut.instead = off.instead;
    cut.past_mitre = off.past_mitre;
  }
  [[nodiscard]] Short missing(std::size_t cutter, const Generator& line, const Hit& at) const {
    const auto& cut = end_.cut_by[cutter];
    const auto& m = spec_.members[cut.member];
    const bool is_beyond = beyond(m, cut, at.axial);
    if (!is_beyond && cut_away_[cutter].empty() && planes_[cutter].empty()) return {};
    const Vector3d place = in_space(line, at.z);
    if (const double off = cut_away_[cutter].length(place); off > kCutAway) return {.by = off};
    const auto end = end_index(cut.member, along(cut, at.axial) < 0.0 ? End::start : End::finish);
    const bool has_planes = std::ranges::any_of(
        planes_[cutter], [&](const auto* plane) { return plane->first.first == end; });
    if (const double off = beyond_planes(cutter, place); off > 0.0 || has_planes)
      return {.by = off, .past_mitre = off > 0.0};
    if (!is_beyond) return {};
    return short_of(spec_, lines_, end, place);
  }
  /// Returns the other member of a plane, with sharp corners if the partner cuts by its faces.
  [[nodiscard]] Member surface_of(std::size_t cutter, std::size_t other) const {
    auto out = spec_.members[other];
    if (const auto& box = end_.cut_by[cutter].box;
        box && out.section && box->corner == kSharpCorner)
      out.section->corner = kSharpCorner;
    return out;
  }
  /// Returns how far a point of a partner's extended surface lies beyond the planes at which its
  /// ends are mitred: along it, or to the other member of that plane if that is nearer; 0 where
  /// that one goes on flush.
  [[nodiscard]] double beyond_planes(std::size_t cutter, const Vector3d& point) const {
    double out = 0.0;
    for (const auto* plane : planes_[cutter]) {
      const auto& [end, other] = plane->first;
      const auto& m = spec_.members[end / 2];
      const Vector3d from = m.at(end_of(end)) + plane->second.point;
      const double off = (from - point).dot(plane->second.normal) /
                         plane->second.normal.dot(m.into(end_of(end)).normalized());
      const double aside = distance_from(surface_of(cutter, other), point);
      if (off > kCutAway && aside > kFlushFaces) out = std::max(out, std::min(off, aside));
    }
    return out;
  }

  static constexpr double kStep = 0.01;         // mm: negligible
  static constexpr double kFlushFaces = 0.05;   // mm
  static constexpr double kBehindPlane = 0.25;  // of the member's reach
  static constexpr double kCutAway = 0.5;       // mm: where two cuts meet, either may hold

  const NodeSpec& spec_;
  const Lines& lines_;
  const Applied& applied_;
  MemberEnd& end_;
  std::vector<Presence> seen_;
  std::vector<CutAway> cut_away_ = {};  // of each partner
  using Planes = std::vector<const std::pair<const Applied::Pair, Mitre>*>;
  std::vector<Planes> planes_ = {};  // likewise, at both its ends
};

/// The generators of one surface for the scan.
std::vector<Generator> lines_on(double rho) {
  std::vector<Generator> out;
  for (std::size_t k = 0; k < kScan; ++k)
    out.push_back(generator_at(rho, kTwoPi * static_cast<double>(k) / static_cast<double>(kScan)));
  return out;
}
std::vector<Generator> lines_on(const section::Curve& outline) {
  std::vector<Generator> out;
  const double step = outline.girth() / static_cast<double>(kScan);
  for (std::size_t k = 0; k < kScan; ++k)
    out.push_back(generator_through(outline.at(static_cast<double>(k) * step).point));
  for (const double s : outline.seams()) out.push_back(generator_through(outline.at(s).point));
  return out;
}

/// One surface of the inspected member.
struct Surface {
  double reach;                                // from the axis
  std::optional<section::Curve> outline = {};  // of a section
  std::optional<section::Curve> smaller = {};  // the outline within kSlightOverhang
};
std::vector<Surface> surfaces_of(const Member& m) {
  if (!m.section) return {{m.outer_radius - m.wall}, {m.outer_radius}};
  const auto bore = m.section->bore(), outer = m.section->outer();
  const auto smaller = [](double height, double width, double corner) {
    return section::Curve(height - 2.0 * kSlightOverhang, width - 2.0 * kSlightOverhang,
                          std::max(0.0, corner - kSlightOverhang));
  };
  const auto& s = *m.section;
  return {{bore.reach(), bore,
           smaller(s.height - 2.0 * s.wall, s.width - 2.0 * s.wall, s.inner_corner)},
          {outer.reach(), outer, smaller(s.height, s.width, s.corner)}};
}

}  // namespace

/// Returns true if every generator of radius rho meets some cutter.
bool closed(std::span<const PreparedCutter> cutters, double rho) {
  for (const auto& cutter : cutters)
    if (met(cutter, rho) == Met::always) return true;
  return divide(cutters, rho).open.empty();
}

// The lines that meet a convex cutter fill a convex region, so one that all lines of the circle
// about the outline meet is met by the outline too.
bool closed(std::span<const Cutter> cutters, const section::Curve& outline) {
  for (const auto& cutter : cutters)
    if (const auto one = prepare(cutter); one && met(*one, outline.reach()) == Met::always)
      return true;
  return trace(cutters, outline).has_value();
}

std::vector<Presence> inspect(const Joints& joints, MemberEnd& end) {
  const auto& spec = joints.spec;
  const auto& m = spec.members[end.member];
  const double length = (m.finish - m.start).norm();
  const auto cutters = prepared_seats(end);
  EndInspection inspection(joints, end);
  std::vector<Cutter> seats;
  if (m.section)
    for (const auto& cut : end.cut_by)
      seats.push_back(by_kind(seat_of(cut), [](const auto& seat) { return Cutter(seat); }));
  for (const auto& surface : surfaces_of(m)) {
    const double rho = surface.reach;
    if (!(surface.outline ? closed(seats, *surface.outline) : closed(cutters, rho))) {
      const bool slightly = surface.outline ? closed(seats, *surface.smaller)
                                            : closed(cutters, rho - kSlightOverhang);
      (slightly ? end.overhangs : end.open) = true;
    }
    const bool nothing = std::ranges::all_of(end.cut_by, [&](const CutBy& cut) {
      const auto most = bounds_on(rho, cut);
      if (cut.plane) return most.z < length;
      return most.z < length && !beyond(spec.members[cut.member], cut, most.axial) &&
             !beyond(spec.members[cut.member], cut, -most.axial);
    });
    if (nothing && !inspection.any_cut_away())
      inspection.all_there();
    else
      // Of a face flush with that of a partner, rounding decides which partner it meets.
      inspection.scan(cutters, surface.smaller ? lines_on(*surface.smaller) : lines_on(rho),
                      length);
  }
  if (!end.open && !inspection.some_unseen()) return inspection.take();
  std::vector<std::vector<Generator>> inside;
  for (const auto& surface : surfaces_of(m))
    inside.push_back(surface.smaller ? lines_on(*surface.smaller)
                                     : lines_on(surface.reach - kSlightOverhang));
  inspection.see_passing(cutters, inside);
  return inspection.take();
}

}  // namespace tubecut::joint::detail

namespace tubecut::joint {

std::vector<bool> cuts_anywhere(const Member& member, const MemberEnd& end) {
  std::vector<bool> out(end.cut_by.size(), end.cut_by.size() < 2);
  if (end.cut_by.size() < 2) return out;
  const auto cutters = detail::prepared_seats(end);
  // A little inside, because of a face flush with that of a cutter, rounding decides which it
  // meets.
  for (const auto& surface : detail::surfaces_of(member))
    for (const auto& line : surface.smaller ? detail::lines_on(*surface.smaller)
                                            : detail::lines_on(surface.reach - kSlightOverhang)) {
      const auto top = highest(cutters, line);
      if (!top) continue;
      out[top->cutter] = true;
      for (std::size_t i = 0; i < cutters.size(); ++i)
        if (!out[i])
          if (const auto at = hit(cutters[i], line))
            out[i] = at->z > top->z - kHidden * member.reach();
    }
  return out;
}

}  // namespace tubecut::joint
