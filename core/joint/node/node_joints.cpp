#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/try.hpp"
#include "core/joint/node/node_parts.hpp"
#include "core/joint/node/passing.hpp"

namespace tubecut::joint {

const Joint* stated_joint(const NodeSpec& spec, std::size_t a, std::size_t b) {
  for (const auto& one : spec.joints)
    if ((one.member == a && one.with == b) || (one.member == b && one.with == a)) return &one.joint;
  return nullptr;
}

namespace detail {
namespace {

using Eigen::Vector3d;

/// Returns its own path, or "members/3/joints/0": the statement in its member.
std::string place_of(const NodeSpec& spec, std::size_t index) {
  if (const auto& own = spec.joints[index].at; !own.empty()) return own;
  const auto member = spec.joints[index].member;
  const auto before = spec.joints.begin() + static_cast<std::ptrdiff_t>(index);
  const auto own = std::count_if(spec.joints.begin(), before,
                                 [&](const StatedJoint& s) { return s.member == member; });
  return "members/" + std::to_string(member) + "/joints/" + std::to_string(own);
}

/// Returns for example "set_in, gap 1.5 mm, depth 8 mm".
std::string told(const Joint& joint) {
  return std::string(name_of(joint.kind)) + ", gap " + shown(joint.gap) + " mm" +
         (joint.depth ? ", depth " + shown(*joint.depth) + " mm" : "") +
         (joint.plane == MitrePlane::corner_to_corner ? ", corner to corner" : "");
}

/// Checks that two statements of one joint do not differ.
Result<void> check_sides(const NodeSpec& spec) {
  std::map<Applied::Pair, std::size_t> out;
  for (std::size_t i = 0; i < spec.joints.size(); ++i) {
    const auto& said = spec.joints[i];
    const auto n = spec.members.size();
    if (said.member >= n || said.with >= n || said.member == said.with)
      return fail({.code = ErrorCode::out_of_range, .member = place_of(spec, i)});
    const auto [known, fresh] = out.emplace(std::minmax(said.member, said.with), i);
    const auto& first = spec.joints[known->second];
    if (fresh || first.joint == said.joint) continue;
    return fail({.code = ErrorCode::joint_contradicts,
                 .member = place_of(spec, i),
                 .got = told(said.joint),
                 .limit = told(first.joint),
                 .unit = {},
                 .hint = called(spec, first.member) + " states it otherwise"});
  }
  return {};
}

bool joins(const Joined& joined, std::size_t member, std::size_t other) {
  for (const auto end : {2 * member, 2 * member + 1})
    if (std::ranges::find(joined[end], other, &Touch::other) != joined[end].end()) return true;
  return false;
}

void part(Joined& joined, std::size_t member, std::size_t other) {
  for (const auto end : {2 * member, 2 * member + 1})
    std::erase_if(joined[end], [&](const Touch& t) { return t.other == other; });
}

const Vector3d& point_of(const NodeSpec& spec, std::size_t end) {
  return spec.members[end / 2].at(end % 2 == 0 ? End::start : End::finish);
}
/// Returns the unit direction from an end into its member.
Vector3d into(const NodeSpec& spec, std::size_t end) {
  return (point_of(spec, end ^ 1U) - point_of(spec, end)).normalized();
}

/// Returns the two ends, one of each member, that are nearest to each other.
std::pair<std::size_t, std::size_t> facing_ends(const NodeSpec& spec, std::size_t a,
                                                std::size_t b) {
  std::pair out{2 * a, 2 * b};
  double least = (point_of(spec, out.first) - point_of(spec, out.second)).norm();
  for (const auto p : {2 * a, 2 * a + 1})
    for (const auto q : {2 * b, 2 * b + 1})
      if (const double d = (point_of(spec, p) - point_of(spec, q)).norm(); d < least) {
        least = d;
        out = {p, q};
      }
  return out;
}

void join(Joined& joined, const NodeSpec& spec, std::size_t end, std::size_t other) {
  auto& touches = joined[end];
  const auto at = std::ranges::lower_bound(touches, other, {}, &Touch::other);
  if (at != touches.end() && at->other == other) return;
  const auto& m = spec.members[other];
  touches.insert(at, {end, other, nearness(point_of(spec, end), {m.start, m.finish, 0.0})});
}

/// Returns the normal towards the first of two tubes that leave their corner along unit `u` and
/// `v`. The outlines of radii r and s in the plane of both axes meet r / (n.u) and s / -(n.v) along
/// the plane of normal n from its point: equal if n is normal to s u + r v.
Vector3d mitre_normal(MitrePlane plane, const Vector3d& u, double r, const Vector3d& v, double s) {
  if (plane == MitrePlane::bisecting) return u - v;
  const double c = u.dot(v);
  return ((r + s * c) * u - (s + r * c) * v) / (r + s);
}

/// Returns the direction across unit `u` in the plane of `u` and `v`.
Vector3d across(const Vector3d& u, const Vector3d& v) { return v - v.dot(u) * u; }
/// Returns how far a member that leaves along `u` reaches from its axis in that plane.
double extent(const Member& m, const Vector3d& u, const Vector3d& v) {
  return m.section ? support(m, across(u, v).normalized()) : m.outer_radius;
}

/// Joins the two ends at the plane of this normal; their members join at no other end.
void face(const NodeSpec& spec, std::size_t p, std::size_t q, const Vector3d& normal,
          Joined& joined, Applied& out) {
  const auto a = p / 2, b = q / 2;
  const Vector3d u = into(spec, p), v = into(spec, q);
  part(joined, a, b);
  part(joined, b, a);
  join(joined, spec, p, b);
  join(joined, spec, q, a);
  const auto [s, t] = meeting(spec, p, q);
  const Vector3d w = point_of(spec, q) - point_of(spec, p);
  const double eccentricity = (w + t * v - s * u).cross(u).norm();
  out.mitres.emplace(std::pair{p, b},
                     Mitre{0.5 * (w + t * v + s * u), normal.normalized(), eccentricity});
  out.mitres.emplace(std::pair{q, a},
                     Mitre{0.5 * (t * v + s * u - w), -normal.normalized(), eccentricity});
}

Result<void> mitre(const NodeSpec& spec, std::size_t index, Joined& joined, Applied& out) {
  const auto a = spec.joints[index].member, b = spec.joints[index].with;
  const auto [p, q] = facing_ends(spec, a, b);
  const auto* within = std::get_if<Within>(&spec.connect);
  const double most = far_end(spec.members[a], spec.members[b]) + (within ? within->distance : 0.0);
  if (const double off = (point_of(spec, p) - point_of(spec, q)).norm(); off > most)
    return fail({.code = ErrorCode::no_contact,
                 .member = place_of(spec, index),
                 .got = off,
                 .limit = most,
                 .unit = "mm",
                 .hint = "the ends that face each other are too far apart; move them together, or, "
                         "if one member goes on past the other, join them by set_on"});
  const Vector3d u = into(spec, p), v = into(spec, q);
  const auto& first = spec.members[a];
  const auto& second = spec.members[b];
  const auto plane = spec.joints[index].joint.plane;
  const Vector3d normal = mitre_normal(plane, u, extent(first, u, v), v, extent(second, v, u));
  if (!(normal.norm() >= 2.0 * kParallel))  // because the plane would lie along the members
    return fail(
        {.code = ErrorCode::parallel_axes,
         .member = place_of(spec, index),
         .hint = u.dot(v) > 0.0
                     ? "the two members lie along each other; no plane between them cuts both"
                     : "the two lie in line and their outlines have no corners; a bisecting "
                       "plane cuts both square"});
  // Turned out of the plane of both axes, the outlines that face each other there are edges, and no
  // plane makes the rest of both meet.
  if (plane == MitrePlane::corner_to_corner &&
      !(is_square_to(first, across(u, v)) && is_square_to(second, across(v, u))))
    return fail({.code = ErrorCode::unsupported_combination,
                 .member = place_of(spec, index) + "/plane",
                 .got = std::string("corner_to_corner"),
                 .limit = std::string("bisecting"),
                 .unit = {},
                 .hint = "a face of each section must be square to the plane of both axes"});
  face(spec, p, q, normal, joined, out);
  return {};
}

tl::unexpected<Error> apart(const NodeSpec& spec, std::size_t index, const std::string& hint) {
  return fail({.code = ErrorCode::no_contact, .member = place_of(spec, index), .hint = hint});
}

/// Checks that one of two members passes through the other.
Result<void> check_passing(const NodeSpec& spec, std::size_t index) {
  auto branch = spec.joints[index].member, chord = spec.joints[index].with;
  if (which_passes(spec.members[branch], spec.members[chord]) == Passing::second)
    std::swap(branch, chord);
  return check_passes({spec.members[branch], called(spec, branch)},
                      {spec.members[chord], called(spec, chord)}, place_of(spec, index) + "/kind");
}

Result<void> apply(const NodeSpec& spec, const Lines& lines, std::size_t index, Joined& joined,
                   Applied& out) {
  const auto a = spec.joints[index].member, b = spec.joints[index].with;
  const auto& joint = spec.joints[index].joint;
  const auto& p = spec.members[a];
  const auto& q = spec.members[b];
  if (joint.kind == JointKind::through) {
    const double reach = p.reach() + q.reach();
    if (!(nearness(AxisSegment{p.start, p.finish}, AxisSegment{q.start, q.finish}) < reach))
      return apart(spec, index, "the two do not reach each other");
    TRY(check_passing(spec, index));
    part(joined, a, b);
    part(joined, b, a);
    return {};
  }
  if (joint.kind == JointKind::mitre) {
    const bool found = index + spec.found >= spec.joints.size();
    if (!found && !joins(joined, a, b) && !joins(joined, b, a))
      return apart(spec, index, "no end of either joins the other");
    return mitre(spec, index, joined, out);
  }
  const bool first = lines.goes_before(spec, a, b);
  const auto chord = first ? a : b, branch = first ? b : a;
  if (!joins(joined, branch, chord))
    return apart(spec, index,
                 "no end of " + called(spec, branch) + " joins " + called(spec, chord) +
                     ", which goes before it");
  // Deeper than a section's corner radius there is no surface with round corners.
  const auto& section = spec.members[chord].section;
  const double radius = section ? section->corner : spec.members[chord].outer_radius;
  if (joint.depth && !(*joint.depth < radius))
    return fail({.code = ErrorCode::out_of_range,
                 .member = place_of(spec, index) + "/depth",
                 .got = *joint.depth,
                 .limit = radius,
                 .unit = "mm",
                 .hint = section ? "must be less than the chord's corner radius"
                                 : "must be less than the chord's radius"});
  return {};
}

}  // namespace

bool goes_before(const NodeSpec& spec, std::size_t a, std::size_t b) {
  const auto& p = spec.members[a];
  const auto& q = spec.members[b];
  if (p.priority != q.priority) return p.priority < q.priority;
  if (p.half_size() != q.half_size()) return p.half_size() > q.half_size();
  return a < b;
}

std::string called(const NodeSpec& spec, std::size_t member) {
  const auto& name = spec.members[member].name;
  return name.empty() ? "member " + std::to_string(member) : name;
}

double sine_between(const Member& a, const Member& b) {
  return (a.finish - a.start).normalized().cross((b.finish - b.start).normalized()).norm();
}

Result<Applied> apply_joints(const NodeSpec& spec, const Lines& lines, Joined& joined) {
  TRY(check_sides(spec));
  Applied out;
  for (std::size_t i = 0; i < spec.joints.size(); ++i) {
    const auto pair = std::minmax(spec.joints[i].member, spec.joints[i].with);
    if (!out.joints.emplace(pair, spec.joints[i].joint).second) continue;
    if (i + spec.found >= spec.joints.size()) out.found.insert(pair);
    TRY(apply(spec, lines, i, joined, out));
  }
  return out;
}

/// Computes where the axes are nearest to each other. If the members are in line, the rounding of
/// the coordinates hides that point (0.01 mm of offset and 0.01 deg out of line move it 57 mm from
/// the ends). In line, and nearly in line if that point is further from the ends than their
/// distance and the tubes' thickness, the plane midway between the ends meets either axis there.
std::pair<double, double> meeting(const NodeSpec& spec, std::size_t p, std::size_t q) {
  const Vector3d w = point_of(spec, q) - point_of(spec, p);
  const Vector3d u = into(spec, p), v = into(spec, q);
  const Vector3d n = u.cross(v);
  const double square = n.squaredNorm();
  const double midway = 0.5 * w.dot(u - v) / (1.0 - u.dot(v));
  const bool opposed = u.dot(v) < 0.0;
  if (opposed && !(square >= kInLine * kInLine)) return {midway, midway};
  const std::pair nearest{w.cross(v).dot(n) / square, w.cross(u).dot(n) / square};
  const double near = w.norm() + std::max(spec.members[p / 2].reach(), spec.members[q / 2].reach());
  const bool far = std::max(std::abs(nearest.first), std::abs(nearest.second)) > near;
  return opposed && square < kNearParallel * kNearParallel && far ? std::pair{midway, midway}
                                                                  : nearest;
}

bool is_set_on(const Applied& applied, std::size_t member, std::size_t other) {
  const auto known = applied.joints.find(std::minmax(member, other));
  return known == applied.joints.end() || known->second.kind == JointKind::set_on;
}

void part_passing(const NodeSpec& spec, Joined& joined) {
  for (const auto& said : spec.joints) {
    if (said.joint.kind != JointKind::through) continue;
    part(joined, said.member, said.with);
    part(joined, said.with, said.member);
  }
}

void mitre_ends(const NodeSpec& spec, std::size_t p, std::size_t q, Joined& joined, Applied& out) {
  const Applied::Pair pair = std::minmax(p / 2, q / 2);
  if (!out.joints.emplace(pair, Joint{.kind = JointKind::mitre}).second) return;
  out.found.insert(pair);
  face(spec, p, q, into(spec, p) - into(spec, q), joined, out);
}

void join_lines(const NodeSpec& spec, const Lines& lines, Joined& joined, Applied& out) {
  for (std::size_t p = 0; p < lines.mates.size(); ++p) {
    if (!lines.mates[p] || lines.mates[p]->end < p) continue;
    const auto q = lines.mates[p]->end;
    if (out.joints.contains(std::minmax(p / 2, q / 2)) || separated(spec, joined, lines, p, q))
      continue;
    mitre_ends(spec, p, q, joined, out);
  }
}

}  // namespace detail
}  // namespace tubecut::joint
