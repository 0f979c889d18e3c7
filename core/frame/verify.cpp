#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/base/elementary.hpp"
#include "core/base/error.hpp"
#include "core/base/stop.hpp"
#include "core/frame/frame.hpp"
#include "core/joint/node/shape.hpp"
#include "core/joint/node/shared_corner.hpp"

namespace tubecut::frame {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using joint::End;

constexpr double kWrittenDecimals =
    1e-5;                     // mm: numbers are written to six decimals, angles to eleven
constexpr double kFar = 1e5;  // mm: farther away, digits are lost with the distance

/// The largest ratio of a value to its limit.
struct Most {
  double value = 0.0, limit = kWrittenDecimals;
  void see(double one, double size) {
    const double most = kWrittenDecimals * std::max(1.0, size / kFar);
    if (!std::isnan(value) && !(one * limit <= value * most)) {
      value = one;
      limit = most;
    }
  }
};

/// The frame of an end, recomputed from only the centre-line and the side.
struct Seen {
  Vector3d origin;
  Matrix3d axes;  // columns
};
Seen seen(const joint::Member& m, const Piece& piece, End end) {
  const Vector3d z = (m.at(end == End::start ? End::finish : End::start) - m.at(end)).normalized();
  const Vector3d x = piece.frame.rows.row(0);
  Seen out{m.at(end), {}};
  out.axes << x, z.cross(x), z;
  return out;
}

struct Line {
  Vector3d point, unit;
};
Line axis_of(const joint::Member& m) { return {m.start, (m.finish - m.start).normalized()}; }

/// Computes a tube's axis from its four numbers, turned and tilted step by step.
Line axis_of(const Seen& frame, const joint::TubeCutter& t) {
  const auto a = elementary::sincos(t.inclination.rad());
  const auto b = elementary::sincos(t.clocking.rad());
  Matrix3d tilt, clock;
  tilt << 1, 0, 0, 0, a.cos, -a.sin, 0, a.sin, a.cos;
  clock << b.cos, -b.sin, 0, b.sin, b.cos, 0, 0, 0, 1;
  return {frame.origin + frame.axes * Vector3d(0, 0, t.height) -
              t.offset * (frame.axes * clock * Vector3d::UnitX()),
          frame.axes * clock * tilt * Vector3d::UnitZ()};
}

/// Returns the distance of an axis to the line that it represents, where the two meet: near `at`,
/// and at `reach` to both sides, because the tubes are that thick.
double beside(const Line& seen, const Line& line, const Vector3d& at, double reach) {
  const Vector3d foot = line.point + (at - line.point).dot(line.unit) * line.unit;
  double worst = 0.0;
  for (const double s : {-reach, 0.0, reach})
    worsen(worst, (foot + s * line.unit - seen.point).cross(seen.unit).norm());
  return worst;
}
double size_of(const joint::TubeCutter& t) { return std::abs(t.height) + std::abs(t.offset); }

struct Worst {
  Most axis, face;
  double sides = 0.0;
};

/// Returns the difference of two mitred faces, each in its own frame: equal planes, compared from
/// both sides.
double apart(const Seen& frame, const joint::PlaneCutter& plane, const Seen& other_frame,
             const joint::PlaneCutter& other, double reach) {
  const Vector3d n = (frame.axes * plane.normal).normalized();
  const Vector3d m = (other_frame.axes * other.normal).normalized();
  const Vector3d p = frame.origin + frame.axes * plane.point;
  const Vector3d q = other_frame.origin + other_frame.axes * other.point;
  return worst_of({std::abs((p - q).dot(n)), reach * (n + m).norm()});
}

const bevel::TableSpec& cut_of(const part::PartSpec& part, End end) {
  return end == End::start ? part.start.cut : part.finish.cut;
}

class Proof {
 public:
  Proof(const FrameSpec& spec, const Frame& frame, std::span<const part::PartSpec* const> asked)
      : spec_(spec), frame_(frame), asked_(asked), mates_(frame.joints.size()) {}

  void see(std::size_t member) {
    for (const auto end : {End::start, End::finish}) see_end(member, end);
    see_holes(member);
  }
  void see_sides() {
    for (std::size_t i = 0; i < frame_.joints.size(); ++i) see_sides(i);
  }
  [[nodiscard]] const Worst& worst() const { return worst_; }

 private:
  /// The cuts of both parts for one joint.
  struct Mate {
    std::vector<joint::Joint> of_ends, of_holes;
    std::vector<std::pair<Seen, joint::PlaneCutter>> faces;
    double reach = 0.0;
  };

  void see_end(std::size_t member, End end) {
    const auto& m = spec_.members[member];
    const auto& cutters =
        end == End::start ? frame_.pieces[member].start : frame_.pieces[member].finish;
    const auto at = seen(m, frame_.pieces[member], end);
    const auto& cut = cut_of(*asked_[member], end);
    for (std::size_t k = 0; k < cutters.size(); ++k) {
      const auto& one = frame_.joints[cutters[k].joint];
      if (!one.of_members()) continue;
      auto& mate = mates_[cutters[k].joint];
      const auto other = one.branch == member ? one.chord : one.branch;
      mate.reach = m.reach() + spec_.members[other].reach();
      if (const auto* tube = std::get_if<joint::TubeCutter>(&cut.partners[k]))
        worst_.axis.see(
            beside(axis_of(at, *tube), axis_of(spec_.members[other]), at.origin, mate.reach),
            size_of(*tube));
      if (const auto* box = std::get_if<joint::RectangularTubeCutter>(&cut.partners[k]))
        see_box(at, *box, met(*box, spec_.members[other], m), mate.reach);
      if (const auto* plane = std::get_if<joint::PlaneCutter>(&cut.partners[k]))
        mate.faces.emplace_back(at, *plane);
      mate.of_ends.push_back(bevel::stated_joint(cut, k).value_or(joint::Joint{}));
    }
  }

  /// Returns the partner of a box by its sizes: as it is, or with a face that goes on to both
  /// sides.
  static joint::Member met(const joint::RectangularTubeCutter& box, const joint::Member& other,
                           const joint::Member& m) {
    const bool plain =
        other.section && box.height == other.section->height && box.width == other.section->width;
    return plain ? other : joint::detail::as_met(other, m);
  }

  /// A partner that is not round: its axis, its sides, and where its height points.
  void see_box(const Seen& at, const joint::RectangularTubeCutter& box, const joint::Member& other,
               double reach) {
    const Line line{at.origin + at.axes * box.point, at.axes * box.direction.normalized()};
    const Vector3d unit = axis_of(other).unit, across = unit.cross(*other.up).normalized();
    // A side that is along the member but for rounded coordinates is turned along it.
    double turned = 0.0;
    for (const Vector3d& normal : {across, Vector3d(across.cross(unit))})
      if (const double off = std::abs(normal.dot(at.axes.col(2))); off < joint::kDrawnAlong)
        turned += reach * off;
    const auto see = [&](double off) {
      worst_.axis.see(std::max(0.0, off - turned), box.point.norm());
    };
    see(beside(line, axis_of(other), at.origin, reach));
    see(reach * std::abs(across.dot(at.axes * box.up.normalized())));
    if (!other.section) return;
    const double corner = box.corner == joint::detail::kSharpCorner
                              ? 0.0  // shared with another end
                              : std::abs(box.corner - other.section->corner);
    worst_.axis.see(worst_of({std::abs(box.height - other.section->height),
                              std::abs(box.width - other.section->width), corner}),
                    0.0);
  }

  void see_holes(std::size_t member) {
    const auto& m = spec_.members[member];
    const auto at = seen(m, frame_.pieces[member], End::start);
    for (std::size_t k = 0; k < frame_.pieces[member].holes.size(); ++k) {
      const auto& hole = frame_.pieces[member].holes[k];
      if (hole.square) {
        see_square_hole(at, member, k);
        continue;
      }
      const auto& asked = std::ranges::find(asked_[member]->holes, k, &part::HoleSpec::asked)->hole;
      const auto& branch = spec_.members[hole.member];
      if (const auto* tube = std::get_if<joint::TubeCutter>(&asked.branch))
        worst_.axis.see(beside(axis_of(at, *tube), axis_of(branch), branch.at(hole.end),
                               m.outer_radius + branch.outer_radius),
                        size_of(*tube));
      mates_[hole.joint].of_holes.push_back(
          {.kind = asked.kind, .gap = asked.gap, .depth = asked.depth});
    }
  }

  /// A hole whose wall is square: the branch's axis and where its height points.
  void see_square_hole(const Seen& at, std::size_t member, std::size_t index) {
    const auto& hole = frame_.pieces[member].holes[index];
    const auto& branch = spec_.members[hole.member];
    const auto& asked =
        std::ranges::find(asked_[member]->square_holes, index, &part::SquareHole::asked)->branch;
    const double reach = spec_.members[member].reach() + branch.reach();
    const Line line{at.origin + at.axes * asked.axis.point,
                    at.axes * asked.axis.direction.normalized()};
    const double size = asked.axis.point.norm();
    worst_.axis.see(beside(line, axis_of(branch), branch.at(hole.end), reach), size);
    if (branch.section) {
      const Vector3d across = axis_of(branch).unit.cross(*branch.up).normalized();
      worst_.axis.see(reach * std::abs(across.dot(at.axes * asked.up.normalized())), size);
    }
    const auto& how = frame_.joints[hole.joint].how;
    mates_[hole.joint].of_holes.push_back(
        {.kind = asked.kind,
         .gap = asked.gap,
         .depth = asked.kind == joint::JointKind::set_in ? how.depth : std::nullopt});
  }

  void see_sides(std::size_t index) {
    const auto& mate = mates_[index];
    for (const auto& end : mate.of_ends)
      for (const auto& hole : mate.of_holes)
        worst_.sides =
            worst_of({worst_.sides, end.kind == hole.kind ? 0.0 : 1.0, std::abs(end.gap - hole.gap),
                      std::abs(end.depth.value_or(0.0) - hole.depth.value_or(0.0))});
    for (std::size_t k = 1; k < mate.faces.size(); ++k)
      worst_.face.see(apart(mate.faces[0].first, mate.faces[0].second, mate.faces[k].first,
                            mate.faces[k].second, mate.reach),
                      mate.faces[0].first.origin.norm());
  }

  const FrameSpec& spec_;
  const Frame& frame_;
  std::span<const part::PartSpec* const> asked_;
  std::vector<Mate> mates_;
  Worst worst_;
};

}  // namespace

std::vector<Check> verify(const FrameSpec& spec, const Frame& frame,
                          std::span<const part::PartSpec* const> asked) {
  Proof proof(spec, frame, asked);
  for (std::size_t i = 0; i < spec.members.size(); ++i) {
    if (stopped()) return {};
    if (asked[i] != nullptr) proof.see(i);
  }
  proof.see_sides();
  return {{"joint_in_world", proof.worst().axis.value, proof.worst().axis.limit, "mm"},
          {"joint_faces", proof.worst().face.value, proof.worst().face.limit, "mm"},
          {"joint_sides", proof.worst().sides, 0.0, "mm"}};
}

}  // namespace tubecut::frame
