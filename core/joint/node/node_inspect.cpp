#include <algorithm>
#include <cmath>

#include "core/base/elementary.hpp"
#include "core/joint/node/node_parts.hpp"

namespace tubecut::joint::detail {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kScan = 180;  // generators in the scan for ghosts and the highest z

/// Cheap bounds of a cutter's sheet on radius rho: the highest z, and the extent along its own
/// axis.
struct Bounds {
  double z, axial;
};
struct BoundsOn {
  double rho;
  Bounds operator()(const PlaneCutter& plane) const {
    const Vector3d n = plane.normal / plane.normal.z();
    return {plane.point.dot(n) + rho * elementary::hypot(n.x(), n.y()), 0.0};
  }
  Bounds operator()(const TubeCutter& t) const {
    const auto turn = elementary::sincos(t.inclination.rad());
    return {t.height + (t.radius + rho * std::abs(turn.cos)) / turn.sin,
            (t.radius * std::abs(turn.cos) + rho) / turn.sin};
  }
};

/// Returns the position along a member, from its start, of w, which is measured from the common
/// perpendicular along its axis.
double along(const CutBy& cut, double w) { return w - cut.placement.point_axial; }

/// Returns true if that is beyond the member's ends.
bool beyond(const Member& m, const CutBy& cut, double w) {
  const double length = (m.finish - m.start).norm();
  const double slack = 1e-9 * (length + std::abs(cut.placement.point_axial));
  return along(cut, w) < -slack || along(cut, w) > length + slack;
}

/// Returns the distance of a mitred end's long point beyond its work point.
double overhang(const NodeSpec& spec, const Applied& applied, std::size_t end) {
  const auto& m = spec.members[end / 2];
  const Vector3d axis = m.into(end_of(end)).normalized();
  double out = 0.0;
  for (auto it = applied.mitres.lower_bound({end, 0});
       it != applied.mitres.end() && it->first.first == end; ++it) {
    const double cosine = std::abs(it->second.normal.dot(axis));
    const double sine = it->second.normal.cross(axis).norm();
    worsen(out, m.outer_radius * sine / cosine);
  }
  return out;
}

/// The inspection of one end.
class EndInspection {
 public:
  EndInspection(const NodeSpec& spec, const Lines& lines, const Applied& applied, MemberEnd& end)
      : spec_(spec), lines_(lines), applied_(applied), end_(end), seen_(end.cut_by.size()) {}

  /// Finds ghosts and the highest z on the generators of one surface.
  void scan(std::span<const PreparedCutter> cutters, double rho, double length) {
    for (std::size_t k = 0; k < kScan; ++k) {
      const auto line =
          generator_at(rho, kTwoPi * static_cast<double>(k) / static_cast<double>(kScan));
      const auto top = highest(cutters, line);
      if (!top) continue;
      auto& seen = seen_[top->cutter];
      seen.anywhere = true;
      seen.consumes = seen.consumes || top->z > length;
      seen.highest = std::max(seen.highest, top->z);
      end_.consumed = end_.consumed || top->z > length;
      const auto at = hit(cutters[top->cutter], line);
      if (end_.cut_by[top->cutter].plane || !at)
        seen.there = true;
      else
        see(top->cutter, line, *at);
    }
  }
  void all_there() {
    for (auto& one : seen_) one.anywhere = one.there = true;
  }
  [[nodiscard]] std::vector<Presence> take() { return std::move(seen_); }

 private:
  void see(std::size_t cutter, const Generator& line, const Hit& at) {
    auto& cut = end_.cut_by[cutter];
    auto& seen = seen_[cutter];
    const auto off = missing(cut, line, at);
    if (off.by <= kStep || off.instead) seen.there = true;
    if (off.by <= kStep) return;
    seen.nearest = std::min(seen.nearest, off.by);
    cut.ghost = true;
    if (off.by <= cut.missing) return;
    cut.missing = off.by;
    cut.instead = off.instead;
  }
  [[nodiscard]] Short missing(const CutBy& cut, const Generator& line, const Hit& at) const {
    const auto& m = spec_.members[cut.member];
    if (!beyond(m, cut, at.axial)) return {};
    const auto end = end_index(cut.member, along(cut, at.axial) < 0.0 ? End::start : End::finish);
    const Vector3d place = end_.frame.origin +
                           end_.frame.rows.transpose() * Vector3d(line.radius * line.cos_phi,
                                                                  line.radius * line.sin_phi, at.z);
    auto out = short_of(spec_, lines_, end, place);
    if (!out.instead && !lines_.mates[end]) out.by -= overhang(spec_, applied_, end);
    return out;
  }

  static constexpr double kStep = 0.01;  // mm: negligible

  const NodeSpec& spec_;
  const Lines& lines_;
  const Applied& applied_;
  MemberEnd& end_;
  std::vector<Presence> seen_;
};

}  // namespace

/// Returns true if every generator of radius rho meets some cutter.
bool closed(std::span<const PreparedCutter> cutters, double rho) {
  for (const auto& cutter : cutters)
    if (met(cutter, rho) == Met::always) return true;
  return divide(cutters, rho).open.empty();
}

std::vector<Presence> inspect(const NodeSpec& spec, const Lines& lines, const Applied& applied,
                              MemberEnd& end) {
  const auto& m = spec.members[end.member];
  const double length = (m.finish - m.start).norm();
  const auto cutters = prepared_seats(end);
  EndInspection inspection(spec, lines, applied, end);
  for (const double rho : {m.outer_radius - m.wall, m.outer_radius}) {
    end.open = end.open || !closed(cutters, rho);
    const bool nothing = std::ranges::all_of(end.cut_by, [&](const CutBy& cut) {
      const auto most = by_kind(seat_of(cut), BoundsOn{rho});
      if (cut.plane) return most.z < length;
      return most.z < length && !beyond(spec.members[cut.member], cut, most.axial) &&
             !beyond(spec.members[cut.member], cut, -most.axial);
    });
    if (nothing)
      inspection.all_there();
    else
      inspection.scan(cutters, rho, length);
  }
  return inspection.take();
}

}  // namespace tubecut::joint::detail
