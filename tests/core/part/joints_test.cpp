// One joint in three ways: the chord's hole, the branch's own end and the hole endpoint's, put into
// the world and measured there in long double, only from the members' centre-lines.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>

#include "core/bevel/table/end_tables.hpp"
#include "tests/core/part/random_member.hpp"

namespace tubecut::testing {
namespace {

using Real = long double;
using Point = std::array<Real, 3>;
using joint::JointKind;

constexpr Real kFit = 0.01L;          // mm
constexpr double kTolerance = 0.004;  // mm, of the sampling

/// Number of each kind: a few, or TUBECUT_JOINTS.
int count_of_each() {
  const char* asked = std::getenv("TUBECUT_JOINTS");  // NOLINT(concurrency-mt-unsafe)
  return asked == nullptr ? 12 : std::atoi(asked);
}

/// A point of a part's wall, in the world.
Point placed(const joint::MemberFrame& frame, Real radius, Real phi, Real z) {
  const Real local[] = {radius * std::cos(phi), radius * std::sin(phi), z};
  Point out{};
  for (int i = 0; i < 3; ++i) {
    out[static_cast<std::size_t>(i)] = frame.origin[i];
    for (int k = 0; k < 3; ++k)
      out[static_cast<std::size_t>(i)] += local[k] * static_cast<Real>(frame.rows(k, i));
  }
  return out;
}

/// Distance from a member's axis by Lagrange's identity.
Real from_axis(const Point& p, const joint::Member& m) {
  Real pp = 0, pd = 0, dd = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const Real a = p[i] - m.start[k], d = static_cast<Real>(m.finish[k]) - m.start[k];
    pp += a * a;
    pd += a * d;
    dd += d * d;
  }
  return std::sqrt(std::max<Real>(0, pp - pd * pd / dd));
}

Point mix(const Point& a, const Point& b, Real t) {
  Point out{};
  for (std::size_t i = 0; i < 3; ++i) out[i] = (1 - t) * a[i] + t * b[i];
  return out;
}

/// Error of the requested distance at the root, and the largest amount below it anywhere.
struct Seen {
  Real root = 0, under = 0;
  void see(const Point& at_root, const Point& face, const joint::Member& from, Real asked) {
    root = std::max(root, std::abs(from_axis(at_root, from) - asked));
    for (int k = 0; k <= 4; ++k)
      under = std::max(under, asked - from_axis(mix(at_root, face, k / 4.0L), from));
  }
};

/// Calls `f(root, face)` along an end, straight from row to row as the machine goes.
template <class F>
void along_end(const part::Part& p, const bevel::Table& t, F f) {
  const auto& target = p.start.spec.target;
  const auto n = t.phi.size();
  for (std::size_t i = 0; i < n; ++i)
    for (const Real u : {0.0L, 0.25L, 0.5L, 0.75L}) {
      const auto j = (i + 1) % n;
      const auto at = [&](const std::vector<double>& v, Real turn = 0) {
        return (1 - u) * v[i] + u * (v[j] + (j == 0 ? turn : 0));
      };
      const Real phi = at(t.phi, 2 * std::acos(Real{-1}));
      f(placed(p.frame, target.inner_radius(), phi, at(t.z_inner)),
        placed(p.frame, target.outer_radius, phi, at(t.z_outer)));
    }
}

/// Calls `f(inner, outer)` along a hole's wall.
template <class F>
void along_hole(const joint::MemberFrame& frame, const joint::Target& chord, const bevel::Hole& h,
                F f) {
  for (std::size_t i = 0; i < h.phi.size(); ++i)
    for (const Real u : {0.0L, 0.25L, 0.5L, 0.75L}) {
      const auto j = (i + 1) % h.phi.size();
      const auto at = [&](const std::vector<double>& v) { return (1 - u) * v[i] + u * v[j]; };
      f(placed(frame, chord.inner_radius(), at(h.phi_inner), at(h.z_inner)),
        placed(frame, chord.outer_radius, at(h.phi), at(h.z)));
    }
}

struct Pair {
  joint::NodeSpec node;  // 0 the chord, 1 the branch, whose start is at the chord
  joint::Joint joint;
  bevel::TableSpec cut;
};

/// A branch on a chord, both turned at random in the world; the joint is stated by one or by both.
Pair random_pair(Random& random, JointKind kind) {
  Pair out;
  joint::Member chord{.name = "C"}, branch{.name = "B"};
  chord.outer_radius = random.between(40, 250);
  chord.wall = chord.outer_radius * random.between(0.04, 0.15);
  branch.outer_radius = chord.outer_radius * random.between(0.2, 0.7);
  branch.wall = branch.outer_radius * random.between(0.06, 0.25);
  const Vector3d axis = random.direction(), at = 1000 * random.direction();
  chord.start = at - random.between(900, 1500) * axis;
  chord.finish = at + random.between(900, 1500) * axis;
  const Vector3d lean = leaning(random, axis, random.between(45, 135) * kRadPerDeg);
  const double room = 0.9 * (chord.outer_radius - chord.wall - branch.outer_radius - 3.0);
  const Vector3d aside = random.between(-room, room) * axis.cross(lean).normalized();
  branch.start = at + aside + random.between(-5, 5) * lean;
  branch.finish = branch.start + random.between(900, 1500) * lean;
  if (kind == JointKind::through) branch.start -= 900 * lean;
  if (random.upto(1) == 0) std::swap(chord.start, chord.finish);
  branch.priority = 1;
  out.node.members = {chord, branch};
  if (kind == JointKind::through || random.upto(1) == 0)
    out.node.connect = joint::Within{20.0 + 0.5 * chord.outer_radius};
  else
    out.node.connect = std::vector<joint::Link>{{.member = 1, .end = joint::End::start, .to = {0}}};
  out.joint = {.kind = kind, .gap = random.upto(2) == 0 ? 0.0 : random.between(0, 2.5)};
  if (kind == JointKind::set_in && random.upto(1) == 0)
    out.joint.depth = chord.wall * random.between(0.5, 1.4);
  const int side = random.upto(2);
  if (side != 0) out.node.joints.push_back({0, 1, out.joint});
  if (side != 1) out.node.joints.push_back({1, 0, out.joint});
  out.cut.sampling.tolerance = joint::Tolerance{.value = kTolerance};
  out.cut.groove = bevel::HalfDihedral{};
  out.cut.kerf = random.between(0, 2);
  out.cut.torch = {Angle::deg(-85), Angle::deg(85)};
  out.cut.smoothing = bevel::NoSmoothing{};
  return out;
}

part::MemberSpec member_spec(const Pair& pair, std::size_t member) {
  part::MemberSpec out;
  out.node = pair.node;
  out.member = member;
  out.cut = pair.cut;
  // If nothing cuts one side of an end, phi is 0 on the stated side.
  if (member == 0 || pair.joint.kind == JointKind::through) {
    const auto& m = pair.node.members[member];
    out.datum = part::Datum::up;
    out.up = (m.finish - m.start).unitOrthogonal();
  }
  if (member == 1) return out;
  bevel::HoleSpec hole{.kind = pair.joint.kind,
                       .gap = pair.joint.gap,
                       .depth = pair.joint.depth,
                       .groove = bevel::HalfDihedral{},
                       .tilt = bevel::Tilt::free,
                       .torch = pair.cut.torch,
                       .kerf = pair.cut.kerf,
                       .sampling = pair.cut.sampling};
  out.holes = {{hole, 1}};
  return out;
}

struct Made {
  part::FoundMember found;
  part::Part part;
};
Result<Made> make(const part::MemberSpec& spec) {
  auto found = part::find_member(spec);
  if (!found) return tl::unexpected(found.error());
  auto made = part::part(found->part);
  if (!made) return tl::unexpected(made.error());
  for (const auto& check : part::verify(found->part, *made))
    EXPECT_TRUE(check.passed()) << check.name << ' ' << check.value;
  return Made{*std::move(found), *std::move(made)};
}

/// Warnings other than the free far ends.
std::vector<Warning> said(const Made& m) {
  auto out = m.found.warnings;
  out.insert(out.end(), m.part.warnings.begin(), m.part.warnings.end());
  std::erase_if(out, [](const Warning& w) {
    return w.code == WarningCode::free_end || w.code == WarningCode::torch_range_binds;
  });
  return out;
}

/// The branch given by its own end: the cutter that the hole's answer names.
part::PartSpec direct_branch(const Pair& pair, const bevel::HoleCut& cut) {
  const auto& m = pair.node.members[1];
  part::PartSpec out;
  out.target = {
      .outer_radius = m.outer_radius, .wall = m.wall, .length = (m.finish - m.start).norm()};
  auto options = pair.cut;
  options.target = out.target;
  out.finish = part::square_end(options, 0.0);
  out.start.cut = options;
  out.start.cut.partners = {cut.branch->chord};
  if (pair.joint.kind == JointKind::set_in) out.start.cut.groove = bevel::NoGroove{};
  return out;
}

/// The heights of an end over its own lowest point, at like places.
Real shape_off(const bevel::Table& a, const bevel::Table& b) {
  if (a.phi.size() != b.phi.size()) return 1e9L;
  Real worst = 0;
  for (std::size_t i = 0; i < a.phi.size(); ++i)
    worst = std::max({worst, std::abs(static_cast<Real>(a.z_inner[i]) - b.z_inner[i]),
                      std::abs(static_cast<Real>(a.z_outer[i]) - b.z_outer[i])});
  return worst;
}

void measure(const Pair& pair, const Made& chord, const Made& branch, Seen& end, Seen& hole,
             Real& agree) {
  const auto& [c, b] = std::tie(pair.node.members[0], pair.node.members[1]);
  const auto& [kind, gap, depth, plane] = pair.joint;
  if (kind != JointKind::through) {
    const Real seat = kind == JointKind::set_on ? c.outer_radius + static_cast<Real>(gap)
                                                : c.outer_radius - depth.value_or(c.wall);
    along_end(branch.part, branch.part.start.table,
              [&](const Point& root, const Point& face) { end.see(root, face, c, seat); });
    const auto direct = part::part(direct_branch(pair, chord.part.hole_cuts.front()));
    ASSERT_TRUE(direct);
    agree = std::max(agree, shape_off(direct->start.table, branch.part.start.table));
  }
  for (const auto& placed_hole : chord.part.holes)
    along_hole(chord.part.frame, chord.found.part.target, placed_hole.hole,
               [&](const Point& inner, const Point& outer) {
                 if (kind == JointKind::set_on)
                   hole.root = std::max(hole.root,
                                        std::abs(from_axis(outer, b) - (b.outer_radius - b.wall)));
                 else
                   hole.see(inner, outer, b, b.outer_radius + static_cast<Real>(gap));
               });
}

class StatedJoint : public ::testing::TestWithParam<JointKind> {};

// The branch's end lies on its seat in the chord, the hole's wall is at the gap's distance from the
// branch, and the branch's end is the same by members and from the hole's answer.
TEST_P(StatedJoint, ChordAndBranchFitInTheWorld) {
  Random random{std::mt19937_64(20261122)};
  const auto kind = GetParam();
  const int wanted = count_of_each();
  int made = 0, refused = 0;
  Seen end, hole;
  Real agree = 0;
  while (made < wanted && refused < wanted + 10) {
    const auto pair = random_pair(random, kind);
    const auto chord = make(member_spec(pair, 0));
    const auto branch = make(member_spec(pair, 1));
    if (!chord || !branch) {
      ++refused;
      const auto& error = chord ? branch.error() : chord.error();
      EXPECT_TRUE(error.code() == ErrorCode::torch_range || error.code() == ErrorCode::open_profile)
          << info(error.code()).code << ' ' << error.issues.front().member;
      continue;
    }
    ++made;
    for (const auto* one : {&*chord, &*branch})
      for (const auto& w : said(*one)) ADD_FAILURE() << info(w.code).code << ' ' << w.detail;
    EXPECT_EQ(chord->part.holes.size(), kind == JointKind::through ? 2U : 1U);
    measure(pair, *chord, *branch, end, hole, agree);
    if (HasFailure()) return;
  }
  std::printf(
      "%d joints, %d refused: end off by %.2Lg, below by %.2Lg; hole off by %.2Lg, below by "
      "%.2Lg; ways differ by %.2Lg mm\n",
      made, refused, end.root, end.under, hole.root, hole.under, agree);
  EXPECT_EQ(made, wanted);
  for (const Real value : {end.root, end.under, hole.root, hole.under}) EXPECT_LT(value, kFit);
  EXPECT_LT(agree, kFit);
}

INSTANTIATE_TEST_SUITE_P(EveryKind, StatedJoint,
                         ::testing::Values(JointKind::set_on, JointKind::set_in,
                                           JointKind::through));

/// Two members that end near one point; `skew` parts their axes.
Pair random_mitre(Random& random, double skew) {
  Pair out;
  joint::Member a{.name = "A"}, b{.name = "B"};
  a.outer_radius = b.outer_radius = random.between(10, 120);
  a.wall = b.wall = a.outer_radius * random.between(0.05, 0.2);
  const Vector3d at = 1000 * random.direction(), u = random.direction();
  const Vector3d v = leaning(random, u, random.between(40, 179) * kRadPerDeg);
  a.start = at + random.between(-20, 20) * u;
  a.finish = at + random.between(900, 1500) * u;
  b.start = at + random.between(-20, 20) * v + skew * u.cross(v).normalized();
  b.finish = b.start + random.between(900, 1500) * v;
  if (random.upto(1) == 0) std::swap(b.start, b.finish);
  out.node.members = {a, b};
  out.node.connect = joint::Within{60.0};
  out.joint = {.kind = JointKind::mitre, .gap = random.upto(1) == 0 ? 0.0 : random.between(0, 3)};
  const auto by = static_cast<std::size_t>(random.upto(1));
  out.node.joints = {{by, 1 - by, out.joint}};
  out.cut.sampling.tolerance = joint::Tolerance{.value = kTolerance};
  out.cut.groove = bevel::NoGroove{};
  out.cut.torch = {Angle::deg(-88), Angle::deg(88)};
  out.cut.smoothing = bevel::NoSmoothing{};
  return out;
}

/// Both edges of the end that `other` mitres.
std::vector<Point> rim(const Made& m, const std::vector<std::size_t>& start_cutters) {
  std::vector<Point> out;
  const auto& t = (start_cutters.empty() ? m.part.finish : m.part.start).table;
  along_end(m.part, t, [&](const Point& inner, const Point& outer) {
    out.push_back(inner);
    out.push_back(outer);
  });
  return out;
}

Point minus(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Real dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// Both faces are planes, parallel, at the distance of the gap; without a gap the edges coincide.
TEST(StatedMitre, TheFacesMeetInOnePlane) {
  Random random{std::mt19937_64(31)};
  Real off = 0, edges = 0;
  for (int count = 0; count < count_of_each(); ++count) {
    const auto pair = random_mitre(random, 0.0);
    const auto a = make(member_spec({pair.node, {}, pair.cut}, 1));
    auto spec = member_spec(pair, 1);
    spec.member = 0;
    const auto b = make(spec);
    ASSERT_TRUE(a && b) << count;
    for (const auto* one : {&*a, &*b})
      for (const auto& w : said(*one)) ADD_FAILURE() << info(w.code).code << ' ' << w.detail;
    const auto one = rim(*a, a->found.start_cutters), two = rim(*b, b->found.start_cutters);
    // A plane through three points of the one face, a third of the way round from one another.
    const auto n = one.size();
    const Point p = minus(one[n / 3 | 1], one[1]), q = minus(one[(2 * n / 3) | 1], one[1]);
    Point normal{p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
    const Real norm = std::sqrt(dot(normal, normal));
    for (auto& x : normal) x /= norm;
    for (const auto& at : one) off = std::max(off, std::abs(dot(minus(at, one[1]), normal)));
    for (const auto& at : two)
      off = std::max(off, std::abs(std::abs(dot(minus(at, one[1]), normal)) -
                                   static_cast<Real>(pair.joint.gap)));
    if (pair.joint.gap > 0.0) continue;
    // Every edge point of the one is as far from the other's axis as it is itself wide.
    for (std::size_t i = 0; i < n; ++i)
      edges = std::max(edges, std::abs(from_axis(one[i], pair.node.members[0]) -
                                       from_axis(one[i], pair.node.members[1])));
  }
  std::printf("%d mitres: faces off by %.2Lg mm, edges apart by %.2Lg mm\n", count_of_each(), off,
              edges);
  EXPECT_LT(off, kFit);
  EXPECT_LT(edges, kFit);
}

TEST(StatedMitre, AWarningReportsAxesThatMissAndUnequalDiameters) {
  Random random{std::mt19937_64(5)};
  auto pair = random_mitre(random, 3.0);
  auto nodes = joint::solve(pair.node);
  ASSERT_TRUE(nodes);
  ASSERT_EQ(nodes->warnings.size(), 2U);  // the far ends are free, and near nothing
  int steps = 0;
  for (const auto& w : nodes->warnings) steps += w.code == WarningCode::mitre_steps ? 1 : 0;
  EXPECT_EQ(steps, 2);
  for (const auto& check : joint::verify(pair.node, *nodes))
    EXPECT_TRUE(check.passed()) << check.name;
  pair = random_mitre(random, 0.0);
  pair.node.members[1].outer_radius += 4.0;
  nodes = joint::solve(pair.node);
  ASSERT_TRUE(nodes);
  steps = 0;
  for (const auto& w : nodes->warnings) steps += w.code == WarningCode::mitre_steps ? 1 : 0;
  EXPECT_EQ(steps, 2);
}

/// Span of the outer points of an edge along a direction.
std::pair<Real, Real> span_of(const std::vector<Point>& edge, const Point& along) {
  std::pair<Real, Real> out{1e30L, -1e30L};
  for (std::size_t i = 1; i < edge.size(); i += 2) {
    out.first = std::min(out.first, dot(edge[i], along));
    out.second = std::max(out.second, dot(edge[i], along));
  }
  return out;
}

ErrorCode refused(const joint::NodeSpec& node, std::string_view at) {
  const auto nodes = joint::solve(node);
  if (nodes) return ErrorCode::internal_error;
  EXPECT_EQ(nodes.error().issues.front().member, at);
  return nodes.error().code();
}

// Tubes of different sizes, trimmed at the plane through the corners of their outlines, meet edge
// to edge there: in the plane of both axes neither extends beyond the other. A bisecting plane
// leaves a step.
TEST(StatedMitre, UnlikeTubesMeetCornerToCorner) {
  Random random{std::mt19937_64(77)};
  Real off = 0, least_step = 1e30L;
  for (int count = 0; count < count_of_each(); ++count) {
    auto pair = random_mitre(random, 0.0);
    const auto& a = pair.node.members[0];
    auto& b = pair.node.members[1];
    const Vector3d u = (a.finish - a.start).normalized();
    const bool leaves = (b.finish - a.start).norm() > (b.start - a.start).norm();
    const Vector3d v = (leaves ? 1.0 : -1.0) * (b.finish - b.start).normalized();
    if (std::abs(u.dot(v)) > 0.8) continue;
    b.outer_radius *= random.between(0.6, 0.95);
    const Vector3d w = (u + v).normalized();
    const Point along{w.x(), w.y(), w.z()};
    pair.node.joints[0].joint.gap = 0.0;
    for (const auto plane : {joint::MitrePlane::bisecting, joint::MitrePlane::corner_to_corner}) {
      pair.node.joints[0].joint.plane = pair.joint.plane = plane;
      const auto nodes = joint::solve(pair.node);
      ASSERT_TRUE(nodes) << count;
      for (const auto& check : joint::verify(pair.node, *nodes))
        EXPECT_TRUE(check.passed()) << check.name << ' ' << check.value;
      auto spec = member_spec(pair, 1);
      const auto two = make(spec);
      spec.member = 0;
      const auto one = make(spec);
      ASSERT_TRUE(one && two) << count;
      const auto [from, to] = span_of(rim(*one, one->found.start_cutters), along);
      const auto [other_from, other_to] = span_of(rim(*two, two->found.start_cutters), along);
      const auto step = std::max(std::abs(from - other_from), std::abs(to - other_to));
      if (plane == joint::MitrePlane::bisecting)
        least_step = std::min(least_step, step);
      else
        off = std::max(off, step);
    }
  }
  std::printf("corners apart by %.2Lg mm, bisected by at least %.2Lg mm\n", off, least_step);
  EXPECT_LT(off, kFit);
  EXPECT_GT(least_step, 20 * kFit);
}

TEST(StatedMitre, InOneLineUnlikeTubesHaveNoCorners) {
  joint::NodeSpec node;
  joint::Member a{.name = "A"}, b{.name = "B"};
  a.start = {0, 0, 0};
  a.finish = b.start = {1000, 0, 0};
  b.finish = {2500, 0, 0};
  a.outer_radius = 57.15;
  b.outer_radius = 44.45;
  a.wall = b.wall = 5;
  node.members = {a, b};
  node.connect = joint::Within{1.0};
  node.joints = {
      {0, 1, {.kind = JointKind::mitre, .gap = 3.0, .plane = joint::MitrePlane::corner_to_corner}}};
  EXPECT_EQ(refused(node, "members/0/joints/0"), ErrorCode::parallel_axes);
}

// Laid end to end the mitre is a square butt.
TEST(StatedMitre, InOneLineItIsASquareButt) {
  Pair pair;
  joint::Member a{.name = "A"}, b{.name = "B"};
  a.start = {0, 0, 0};
  a.finish = {1000, 0, 0};
  b.start = {1000, 0, 0};
  b.finish = {2500, 0, 0};
  a.outer_radius = b.outer_radius = 57.15;
  a.wall = b.wall = 5;
  pair.node.members = {a, b};
  pair.node.connect = joint::Within{1.0};
  pair.node.joints = {{0, 1, {.kind = JointKind::mitre, .gap = 3.0}}};
  pair.cut.sampling.uniform_points = 36;
  pair.cut.groove = bevel::NoGroove{};
  pair.cut.smoothing = bevel::NoSmoothing{};
  auto spec = member_spec(pair, 1);
  spec.datum = part::Datum::up;
  spec.up = Vector3d::UnitZ();
  const auto made = make(spec);
  ASSERT_TRUE(made);
  EXPECT_NEAR(made->part.lengths.longest, 1500 - 1.5, 1e-9);
  EXPECT_NEAR(made->part.lengths.shortest, 1500 - 1.5, 1e-9);
}

TEST(StatedJoints, ContradictoryJointsAreRejected) {
  Random random{std::mt19937_64(8)};
  const auto good = random_pair(random, JointKind::set_in);
  auto node = good.node;
  node.joints = {{0, 1, {.kind = JointKind::set_in, .gap = 1}},
                 {1, 0, {.kind = JointKind::set_in, .gap = 2}}};
  EXPECT_EQ(refused(node, "members/1/joints/0"), ErrorCode::joint_contradicts);
  node.joints[1].joint = {.kind = JointKind::set_on, .gap = 1};
  EXPECT_EQ(refused(node, "members/1/joints/0"), ErrorCode::joint_contradicts);
  node.joints = {{0, 1, {.kind = JointKind::set_in, .depth = 400.0}}};
  EXPECT_EQ(refused(node, "members/0/joints/0/depth"), ErrorCode::out_of_range);
  node = good.node;
  node.members.push_back(node.members[1]);
  for (auto* p : {&node.members[2].start, &node.members[2].finish}) *p += Vector3d(9e3, 9e3, 9e3);
  for (const auto kind : {JointKind::set_on, JointKind::through, JointKind::mitre}) {
    node.joints = {{2, 0, {.kind = kind}}};
    EXPECT_EQ(refused(node, "members/2/joints/0"), ErrorCode::no_contact);
  }
  // The hole contradicts the members; the end's root gap too.
  auto spec = member_spec(good, 0);
  spec.holes[0].cut.gap += 0.5;
  const auto found = part::find_member(spec);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code(), ErrorCode::joint_contradicts);
  EXPECT_EQ(found.error().issues.front().member, "holes/0/joint");
  auto on = random_pair(random, JointKind::set_on);
  on.cut.root_gap = on.joint.gap + 1.0;
  const auto end = make(member_spec(on, 1));
  ASSERT_FALSE(end);
  EXPECT_EQ(end.error().code(), ErrorCode::joint_contradicts);
  EXPECT_EQ(end.error().issues.front().member, "start/root_gap");
}

TEST(StatedJoints, AJointAppliedToOneSideOnlyIsAWarning) {
  Random random{std::mt19937_64(9)};
  auto pair = random_pair(random, JointKind::set_in);
  auto spec = member_spec(pair, 0);
  spec.holes.clear();
  const auto without = part::find_member(spec);
  ASSERT_TRUE(without);
  ASSERT_EQ(without->warnings.size(), 1U);
  EXPECT_EQ(without->warnings[0].code, WarningCode::hole_missing);
  pair.node.joints.clear();
  const auto unsaid = part::find_member(member_spec(pair, 0));
  ASSERT_TRUE(unsaid);
  ASSERT_EQ(unsaid->warnings.size(), 1U);
  EXPECT_EQ(unsaid->warnings[0].code, WarningCode::joint_not_stated);
}

// The nodes' own table of the branch's end is the part's.
TEST(StatedJoints, NodesGiveTheSameEnd) {
  Random random{std::mt19937_64(10)};
  for (const auto kind : {JointKind::set_on, JointKind::set_in}) {
    const auto pair = random_pair(random, kind);
    const auto branch = make(member_spec(pair, 1));
    ASSERT_TRUE(branch);
    const auto nodes = joint::solve(pair.node);
    ASSERT_TRUE(nodes);
    const auto tables = bevel::end_tables(pair.node, *nodes, pair.cut);
    ASSERT_TRUE(tables);
    ASSERT_TRUE((*tables)[2] && (*tables)[2]->table);
    EXPECT_LT(shape_off(*(*tables)[2]->table, branch->part.start.own), 1e-9L);
  }
}

// So do the hole's answer, and the cutter it names.
TEST(StatedJoints, HolesGiveTheSameEnd) {
  Random random{std::mt19937_64(11)};
  for (const auto kind : {JointKind::set_on, JointKind::set_in})
    for (int k = 0; k < 10; ++k) {
      auto pair = random_pair(random, kind);
      pair.cut.sampling = {.uniform_points = 72};
      const auto chord = make(member_spec(pair, 0));
      ASSERT_TRUE(chord);
      const auto& cut = chord->part.hole_cuts.front();
      const auto direct = part::part(direct_branch(pair, cut));
      ASSERT_TRUE(direct);
      const auto& own = direct->start.own;
      ASSERT_EQ(own.phi.size(), cut.branch->phi.size());
      for (std::size_t i = 0; i < own.phi.size(); ++i) {
        EXPECT_NEAR(own.z_inner[i], cut.branch->z_inner[i], 1e-9) << i;
        EXPECT_NEAR(own.z_outer[i], cut.branch->z_outer[i], 1e-9) << i;
      }
    }
}

}  // namespace
}  // namespace tubecut::testing
