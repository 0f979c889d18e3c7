#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/base/try.hpp"
#include "core/frame/frame_parts.hpp"
#include "core/joint/node/in_line.hpp"
#include "core/joint/node/shape.hpp"
#include "core/part/member.hpp"

namespace tubecut::frame::detail {
namespace {

using Eigen::Vector3d;
using joint::AxisLine;
using joint::AxisTube;
using joint::End;
using joint::MemberFrame;
using joint::Partner;

/// If an axis rises by less, it counts as at right angles to the member.
constexpr double kLevel = 1e-9;

constexpr double kWritten = 1e6;  // numbers are compared to six decimals

/// Returns the foot of the perpendicular from the frame's origin, because for a line and a plane
/// any point is valid.
Vector3d foot_on_line(const Vector3d& point, const Vector3d& unit) {
  return point - point.dot(unit) * unit;
}

/// Transforms a partner from the world into a frame: one overload for every kind.
struct In {
  const MemberFrame& frame;

  [[nodiscard]] Vector3d turned(const Vector3d& v) const { return (frame.rows * v).normalized(); }

  /// Orients the axis so that it rises with z. If it is level, its common perpendicular lies in the
  /// first half turn.
  Result<Partner> operator()(const AxisTube& tube) const {
    auto axis = frame.local(tube.axis);
    axis.direction.normalize();
    const auto& d = axis.direction;
    const bool level = std::abs(d.z()) <= kLevel;
    // The perpendicular is z x d = (-d.y, d.x).
    const bool back = level ? d.x() < -kLevel || (d.x() < kLevel && d.y() > 0.0) : d.z() < 0.0;
    if (back) axis.direction = -axis.direction;
    TRY(const auto placed, joint::place(axis, tube.radius));
    return Partner(placed.tube);
  }
  Result<Partner> operator()(const joint::TubeCutter& tube) const {
    return (*this)(AxisTube{tube.radius, joint::axis_of(tube)});
  }
  Result<Partner> operator()(const joint::PlaneCutter& plane) const {
    const Vector3d normal = turned(plane.normal);
    return Partner(joint::PlaneCutter{normal * normal.dot(frame.local(plane.point)), normal});
  }
  Result<Partner> operator()(joint::RectangularTubeCutter tube) const {
    tube.direction = turned(tube.direction);
    tube.point = foot_on_line(frame.local(tube.point), tube.direction);
    tube.up = turned(tube.up);
    joint::straighten_as_drawn(tube);
    return Partner(tube);
  }
  Result<Partner> operator()(joint::ConeCutter cone) const {
    cone.direction = turned(cone.direction);
    cone.point = frame.local(cone.point);
    return Partner(cone);
  }
  Result<Partner> operator()(joint::ElbowCutter elbow) const {
    elbow.direction = turned(elbow.direction);
    elbow.inwards = turned(elbow.inwards);
    elbow.point = frame.local(elbow.point);
    return Partner(elbow);
  }
};

/// A body that cuts an end, in the world.
struct InWorld {
  Partner partner;
  std::optional<joint::Joint> stated;
  std::size_t joint = 0;
  std::string at;  // for errors
  double missing = 0.0;
};

std::vector<InWorld> cutters_at(const FrameSpec& spec, const Joined& joined, std::size_t index) {
  std::vector<InWorld> out;
  const auto& end = joined.nodes.ends[index];
  for (const auto& cut : end.cut_by) {
    const auto& m = spec.members[cut.member];
    InWorld one{.partner = AxisTube{m.outer_radius, {m.start, m.finish - m.start}},
                .stated = cut.stated,
                .joint = joined.joint_of(end.member, cut.member),
                .at = "members/" + std::to_string(cut.member),
                .missing = cut.missing};
    if (cut.box) {
      auto box = joint::box_of(m);
      box.corner = cut.box->corner;  // sharp where two ends share it
      box.height = cut.box->height;  // larger where the end is wider than its face
      box.width = cut.box->width;
      one.partner = box;
    }
    if (cut.plane)
      one.partner =
          joint::PlaneCutter{end.frame.origin + end.frame.rows.transpose() * cut.plane->point,
                             end.frame.rows.transpose() * cut.plane->normal};
    out.push_back(std::move(one));
  }
  for (const auto& one : joined.others[index])
    out.push_back({.partner = partner_of(spec, one),
                   .stated = joint::Joint{.kind = joint::JointKind::set_on,
                                          .gap = gap_of(joined.joints[one.joint])},
                   .joint = one.joint,
                   .at = path_of(one)});
  return out;
}

Result<std::vector<Cutter>> placed(const std::vector<InWorld>& all, const MemberFrame& frame) {
  std::vector<Cutter> out;
  for (const auto& one : all) {
    TRY(auto partner, under(one.at, joint::by_kind(one.partner, In{frame})));
    out.push_back({std::move(partner), one.stated, one.joint, one.missing});
  }
  return out;
}

/// Returns true if a plane is square to the axis within the rounding of coordinates.
bool is_square(const Partner& partner) {
  const auto* plane = std::get_if<joint::PlaneCutter>(&partner);
  if (plane == nullptr) return false;
  const Vector3d n = plane->normal.normalized();
  return elementary::hypot(n.x(), n.y()) <= 0.5 * joint::kButtMost;
}

/// Returns the partners that have a side.
std::vector<Partner> partners(const std::vector<Cutter>& cutters) {
  std::vector<Partner> out;
  for (const auto& one : cutters)
    if (!is_square(one.partner)) out.push_back(one.partner);
  return out;
}

/// An end of a branch that a member's tube cuts, or a branch that passes through it.
struct Branch {
  std::size_t member = 0, joint = 0;
  End end = End::start;
  bool passes = false;
};

/// Returns for each member the branches that are set on it or pass through it. A cutter that others
/// hide everywhere gets neither a hole nor a mark, because the branch does not reach it.
std::vector<std::vector<Branch>> branches(const Joined& joined) {
  std::vector<std::vector<Branch>> out(joined.node.members.size());
  for (const auto& end : joined.nodes.ends) {
    const auto touched = joint::cuts_anywhere(joined.node.members[end.member], end);
    for (std::size_t i = 0; i < end.cut_by.size(); ++i)
      if (const auto& cut = end.cut_by[i]; !cut.plane && touched[i])
        out[cut.member].push_back(
            {end.member, joined.joint_of(end.member, cut.member), end.end, false});
  }
  for (std::size_t i = 0; i < joined.joints.size(); ++i)
    if (const auto& one = joined.joints[i]; one.how.kind == How::Kind::through && !one.plate)
      out[one.chord].push_back({one.branch, i, End::start, true});
  return out;
}

struct Frames {
  MemberFrame start, finish;
};
Result<Frames> frames(const joint::Member& m, const Vector3d& x) {
  Frames out;
  TRY(out.start, joint::member_frame(m.start, m.finish, x));
  TRY(out.finish, joint::member_frame(m.finish, m.start, x));
  return out;
}

/// A side. `either` is true if the opposite side is equivalent, because the first cutter is level.
struct Side {
  Vector3d x;
  bool either = false;
};

bool is_level(const std::vector<Cutter>& cutters) {
  for (const auto& one : cutters)
    if (const auto to = joint::bearing(one.partner); to && !is_square(one.partner))
      return !to->lean.has_value();
  return false;
}

/// Returns the member's own side: of `up`, of the first cutter that has one, or of the first
/// branch.
Result<Side> side(const FrameSpec& spec, const joint::Member& m, const std::vector<InWorld>& start,
                  const std::vector<InWorld>& finish, const std::vector<Branch>& on_it) {
  if (m.up) return Side{*m.up};
  TRY(const auto any, frames(m, (m.finish - m.start).unitOrthogonal()));
  TRY(const auto at_start, placed(start, any.start));
  TRY(const auto at_finish, placed(finish, any.finish));
  auto turn =
      part::datum_angle(part::Datum::first_cutter, {}, partners(at_start), partners(at_finish));
  if (!turn && !on_it.empty()) {
    const auto& branch = spec.members[on_it.front().member];
    const Vector3d along = any.start.rows * branch.into(on_it.front().end);
    turn = Angle::rad(joint::bearing_of_axis(along).perpendicular);
  }
  const auto by = elementary::sincos(turn ? turn->rad() : 0.0);
  const auto& of = at_start.empty() ? at_finish : at_start;
  return Side{by.cos * any.start.rows.row(0) + by.sin * any.start.rows.row(1), is_level(of)};
}

/// Numbers, as they are written, that order two views of one piece.
class Written {
 public:
  void operator()(const joint::TubeCutter& t) {
    const auto turn = elementary::sincos(t.clocking.rad());
    add({t.inclination.rad(), turn.cos, turn.sin, t.offset, t.height});
  }
  void operator()(const AxisTube& t) { add(t.axis.point, t.axis.direction); }
  void operator()(const joint::PlaneCutter& p) { add(p.point, p.normal); }
  void operator()(const joint::RectangularTubeCutter& t) { add(t.point, t.direction, t.up); }
  void operator()(const joint::ConeCutter& c) { add(c.point, c.direction); }
  void operator()(const joint::ElbowCutter& e) { add(e.point, e.direction, e.inwards); }

  [[nodiscard]] std::vector<double> take() { return std::move(out_); }

 private:
  void add(std::initializer_list<double> numbers) {
    for (const double one : numbers) out_.push_back(std::round(one * kWritten));
  }
  template <class... V>
  void add(const V&... vectors) {
    (add({vectors.x(), vectors.y(), vectors.z()}), ...);
  }
  std::vector<double> out_;
};

std::vector<double> written(const Piece& piece) {
  Written out;
  for (const auto* end : {&piece.start, &piece.finish})
    for (const auto& one : *end) joint::by_kind(one.partner, out);
  for (const auto& one : piece.holes) out(one.branch);
  for (const auto& one : piece.stands) out(joint::TubeCutter{.clocking = Angle::rad(one.phi)});
  return out.take();
}

/// Orders along the member, then around it, at the written precision.
auto order(double z, double turn) {
  return std::tuple(std::round(z * kWritten), std::round(turn * kWritten));
}

/// Returns the place where the axis of a branch leaves the outside of the member `chord`.
Stand stand_of(const Branch& one, const joint::Member& branch, const joint::Member& chord,
               const Piece& piece) {
  if (!chord.section) {
    const auto mark = part::mark_of(branch, one.end, piece.frame, piece.target.outer_radius);
    return {.phi = mark.phi, .z = mark.z_from, .member = one.member};
  }
  const section::Curve outer(chord.section->outer());
  const auto mark = part::mark_of(branch, one.end, piece.frame, outer);
  return {.girth = mark.s, .z = mark.z_from, .member = one.member};
}

Result<void> add_branches(const FrameSpec& spec, const Joined& joined, const joint::Member& chord,
                          const std::vector<Branch>& on_it, Piece& out) {
  for (const auto& one : on_it) {
    const auto& branch = spec.members[one.member];
    const auto& how = joined.joints[one.joint].how;
    const auto stand = stand_of(one, branch, chord, out);
    const double reach = 2.0 * (out.target.outer_radius + branch.half_size());
    const bool on_tube = stand.z > -reach && stand.z < *out.target.length + reach;
    if (!one.passes && on_tube) out.stands.push_back(stand);
    if (!how.hole) continue;
    const AxisLine axis{branch.at(one.end), branch.into(one.end)};
    const auto local = out.frame.local(axis);
    TRY(const auto at,
        under("members/" + std::to_string(one.member), joint::place(local, branch.half_size())));
    Hole hole{at.tube, branch.thickness(), one.member, one.joint, one.end};
    hole.square = chord.section.has_value() || branch.section.has_value();
    const Vector3d along = local.direction.normalized();
    hole.axis = {foot_on_line(local.point, along), along};
    if (branch.up) hole.up = out.frame.rows * *branch.up;
    out.holes.push_back(std::move(hole));
  }
  std::ranges::stable_sort(
      out.holes, {}, [](const Hole& h) { return order(h.branch.height, h.branch.clocking.rad()); });
  std::ranges::stable_sort(out.stands, {},
                           [](const Stand& s) { return order(s.z, s.phi + s.girth); });
  return {};
}

/// The bodies that cut a member, and the branches on it.
struct Around {
  std::vector<InWorld> start, finish;
  const std::vector<Branch>& on_it;
};

Result<Piece> seen_from(const FrameSpec& spec, const Joined& joined, std::size_t member,
                        const Around& around, const Vector3d& x) {
  const auto& m = spec.members[member];
  TRY(const auto own, under("members/" + std::to_string(member), frames(m, x)));
  Piece out{.target = {.outer_radius = m.half_size(),
                       .wall = m.thickness(),
                       .length = (m.finish - m.start).norm()},
            .frame = own.start,
            .start = {},
            .finish = {},
            .holes = {},
            .stands = {}};
  TRY(out.start, placed(around.start, own.start));
  TRY(out.finish, placed(around.finish, own.finish));
  TRY(add_branches(spec, joined, m, around.on_it, out));
  return out;
}

Result<Piece> piece(const FrameSpec& spec, const Joined& joined, std::size_t member,
                    const std::vector<Branch>& on_it) {
  const Around around{cutters_at(spec, joined, 2 * member),
                      cutters_at(spec, joined, 2 * member + 1), on_it};
  TRY(const auto to, side(spec, spec.members[member], around.start, around.finish, on_it));
  TRY(auto out, seen_from(spec, joined, member, around, to.x));
  if (!to.either) return out;
  TRY(auto across, seen_from(spec, joined, member, around, -to.x));
  return written(across) < written(out) ? across : out;
}

}  // namespace

joint::Beside seats_of_others(const FrameSpec& spec, const Joined& joined) {
  joint::Beside out(joined.others.size());
  for (std::size_t i = 0; i < out.size(); ++i)
    for (const auto& one : joined.others[i]) {
      const auto partner = joint::by_kind(partner_of(spec, one), In{joined.nodes.ends[i].frame});
      if (!partner) continue;  // `pieces` rejects it
      const std::array grown{joint::grown(*partner, gap_of(joined.joints[one.joint]))};
      const auto cutters = joint::resolve(grown);
      if (cutters) out[i].push_back(cutters->front());
    }
  return out;
}

Result<std::vector<Piece>> pieces(const FrameSpec& spec, const Joined& joined) {
  const auto on = branches(joined);
  std::vector<Piece> out;
  out.reserve(spec.members.size());
  for (std::size_t i = 0; i < spec.members.size(); ++i) {
    if (stopped()) return fail({.code = ErrorCode::cancelled});
    TRY(auto one, piece(spec, joined, i, on[i]));
    out.push_back(std::move(one));
  }
  return out;
}

}  // namespace tubecut::frame::detail
