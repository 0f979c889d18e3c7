// Nodes with members that are not round: held against boxes and cylinders in the world.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>

#include "core/bevel/table/end_tables.hpp"
#include "core/joint/finished.hpp"
#include "core/joint/node/end_curves.hpp"
#include "core/joint/node/in_line.hpp"
#include "core/joint/node/overlap.hpp"

namespace tubecut::joint {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using section::Section;

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) { std::cout << "seed " << seed << '\n'; }
  double any(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  bool chance(double share) { return any(0, 1) < share; }
  Vector3d in_box(double half) { return {any(-half, half), any(-half, half), any(-half, half)}; }
  Eigen::Matrix3d rotation() {
    return Eigen::Quaterniond(any(-1, 1), any(-1, 1), any(-1, 1), any(-1, 1))
        .normalized()
        .toRotationMatrix();
  }

 private:
  std::mt19937_64 engine_;
};

Section rectangle(double height, double width, double wall) {
  return {
      .height = height, .width = width, .wall = wall, .corner = 2.0 * wall, .inner_corner = wall};
}

Member rectangular(const Vector3d& start, const Vector3d& finish, const Vector3d& up,
                   const Section& section) {
  Member out{.start = start, .finish = finish, .up = up};
  out.section = section;
  return out;
}
Member round(const Vector3d& start, const Vector3d& finish, double radius, double wall) {
  return {.start = start, .finish = finish, .outer_radius = radius, .wall = wall};
}

// ---- the oracle: solids in the world, from the members alone

double box_distance(const Vector2d& place, double height, double width, double corner) {
  const Vector2d inner(0.5 * height - corner, 0.5 * width - corner);
  const Vector2d out = (place.cwiseAbs() - inner).cwiseMax(0.0);
  const double inside = std::min(0.0, (place.cwiseAbs() - inner).maxCoeff());
  return out.norm() + inside - corner;
}
Vector2d across(const Member& m, const Vector3d& p) {
  const Vector3d axis = (m.finish - m.start).normalized();
  const Vector3d y = axis.cross(*m.up).normalized(), x = y.cross(axis);
  return {(p - m.start).dot(x), (p - m.start).dot(y)};
}
double outside_of(const Member& m, const Vector3d& p) {
  if (m.section)
    return box_distance(across(m, p), m.section->height, m.section->width, m.section->corner);
  const Vector3d axis = (m.finish - m.start).normalized();
  return (p - m.start).cross(axis).norm() - m.outer_radius;
}
double outside_of_bore(const Member& m, const Vector3d& p) {
  if (m.section)
    return box_distance(across(m, p), m.section->height - 2.0 * m.section->wall,
                        m.section->width - 2.0 * m.section->wall, m.section->inner_corner);
  return outside_of(m, p) + m.wall;
}

/// Checks a place of an end's curve: on its own surface, on the member that it names, and nothing
/// further into the member is inside any of those that cut it.
void expect_on_envelope(const NodeSpec& spec, const MemberEnd& end, bool outer, const Vector3d& at,
                        std::size_t cutter) {
  const auto& own = spec.members[end.member];
  const Vector3d p = end.frame.origin + end.frame.rows.transpose() * at;
  const Vector3d into = end.frame.rows.row(2);
  EXPECT_NEAR(outer ? outside_of(own, p) : outside_of_bore(own, p), 0.0, 1e-9);
  EXPECT_NEAR(outside_of(spec.members[end.cut_by[cutter].member], p), 0.0, 1e-8);
  for (const auto& cut : end.cut_by)
    for (const double further : {1e-6, 0.1, 1.0, 5.0, 20.0, 60.0, 150.0})
      EXPECT_GT(outside_of(spec.members[cut.member], p + further * into), -1e-8);
}

/// A chord through the origin and braces that leave it, all turned in the world.
NodeSpec random_node(Random& random) {
  const Eigen::Matrix3d turn = random.rotation();
  const Vector3d origin = random.in_box(5000);
  NodeSpec out;
  const auto add = [&](const Vector3d& start, const Vector3d& finish, double size, bool square) {
    const double wall = std::max(1.0, size * random.any(0.02, 0.05));
    if (square) {
      auto section = rectangle(size, size * random.any(0.6, 1.0), wall);
      if (random.chance(0.5)) std::swap(section.height, section.width);
      if (random.chance(0.15)) {  // a flat oval
        section.corner = 0.5 * std::min(section.height, section.width);
        section.inner_corner = section.corner - wall;
      }
      out.members.push_back(
          rectangular(origin + turn * start, origin + turn * finish, random.in_box(1.0), section));
    } else {
      out.members.push_back(round(origin + turn * start, origin + turn * finish, 0.5 * size, wall));
      if (random.chance(0.5)) out.members.back().up = random.in_box(1.0);
    }
  };
  const double chord = random.any(80, 250);
  const bool square = random.chance(0.7);
  add({-1500, 0, 0}, {1500, 0, 0}, chord, square);
  const int braces = static_cast<int>(random.any(1, 4));
  for (int k = 0; k < braces; ++k) {
    const double lean = random.any(0.7, 2.4), around = random.any(-0.4, 0.4) + 1.5 * k;
    const Vector3d away(std::cos(lean), std::sin(lean) * std::cos(around),
                        std::sin(lean) * std::sin(around));
    const Vector3d start(random.any(-40, 40), random.any(-5, 5), random.any(-5, 5));
    add(start, start + 1200 * away, chord * random.any(0.3, 0.55), !square || random.chance(0.5));
    out.members.back().priority = k + 1;
  }
  out.connect = Within{20};
  return out;
}

bool is_mitred(const MemberEnd& end) {
  return std::ranges::any_of(end.cut_by, [](const CutBy& cut) { return cut.plane.has_value(); });
}

Sampling grid(std::size_t points) {
  Sampling out;
  out.uniform_points = points;
  return out;
}

TEST(SectionNode, EveryPlaceLiesOnTheEnvelopeInTheWorld) {
  Random random(20261128);
  int ends = 0, sections = 0, cut_by_sections = 0;
  for (int k = 0; k < 200; ++k) {
    SCOPED_TRACE(k);
    const auto spec = random_node(random);
    const auto nodes = solve(spec);
    ASSERT_TRUE(nodes) << nodes.error().issues.front().member;
    for (const auto& check : verify(spec, *nodes)) EXPECT_TRUE(check.passed()) << check.name;
    Sampling sampling;
    sampling.tolerance = Tolerance{0.2};
    const auto curves = profiles(spec, *nodes, sampling);
    ASSERT_TRUE(curves);
    for (std::size_t i = 0; i < nodes->ends.size(); ++i) {
      const auto& end = nodes->ends[i];
      if (!(*curves)[i] || is_mitred(end)) continue;
      ++ends;
      for (const auto& cut : end.cut_by) cut_by_sections += cut.box ? 1 : 0;
      if (const auto& of_section = (*curves)[i]->of_section) {
        ++sections;
        for (const auto& p : of_section->profiles)
          for (std::size_t j = 0; j < p.z.size(); ++j)
            expect_on_envelope(spec, end, p.outer, {p.at[j].point.x(), p.at[j].point.y(), p.z[j]},
                               p.cutter[j]);
        continue;
      }
      for (const auto& p : (*curves)[i]->profiles)
        for (std::size_t j = 0; j < p.z.size(); ++j)
          expect_on_envelope(spec, end, p.outer,
                             {p.radius * std::cos(p.phi[j]), p.radius * std::sin(p.phi[j]), p.z[j]},
                             p.cutter[j]);
      if (::testing::Test::HasFailure()) return;
    }
  }
  std::cout << ends << " ends, " << sections << " of sections, " << cut_by_sections
            << " cut by sections\n";
  EXPECT_GT(sections, 100);
  EXPECT_GT(cut_by_sections, 150);
}

/// The same target and partners, written down from the members, as a request gives them.
TEST(SectionNode, AnEndIsItsTargetWithItsPartners) {
  Random random(20261129);
  int compared = 0;
  for (int k = 0; k < 60; ++k) {
    SCOPED_TRACE(k);
    const auto spec = random_node(random);
    const auto nodes = solve(spec);
    ASSERT_TRUE(nodes);
    const auto curves = profiles(spec, *nodes, grid(60));
    ASSERT_TRUE(curves);
    for (std::size_t i = 0; i < nodes->ends.size(); ++i) {
      const auto& end = nodes->ends[i];
      if (!(*curves)[i] || is_mitred(end)) continue;
      const auto& m = spec.members[end.member];
      IntersectionSpec given{.target = {m.outer_radius, m.wall, (m.finish - m.start).norm()},
                             .partners = {},
                             .sampling = grid(60)};
      for (const auto& cut : end.cut_by) {
        const auto& other = spec.members[cut.member];
        const AxisLine axis = end.frame.local(AxisLine{other.start, other.finish - other.start});
        if (other.section)
          given.partners.emplace_back(RectangularTubeCutter{.width = other.section->width,
                                                            .height = other.section->height,
                                                            .corner = other.section->corner,
                                                            .point = axis.point,
                                                            .direction = axis.direction,
                                                            .up = end.frame.rows * *other.up});
        else
          given.partners.emplace_back(AxisTube{other.outer_radius, axis});
      }
      ++compared;
      if (m.section) {
        const auto want = intersect(*m.section, given);
        ASSERT_TRUE(want);
        for (const std::size_t s : {0U, 1U})
          for (std::size_t j = 0; j < want->profiles[s].z.size(); ++j)
            EXPECT_NEAR((*curves)[i]->of_section->profiles[s].z[j], want->profiles[s].z[j], 1e-7);
      } else {
        const auto want = intersect(given);
        ASSERT_TRUE(want);
        for (const std::size_t s : {0U, 1U})
          for (std::size_t j = 0; j < want->profiles[s].z.size(); ++j)
            EXPECT_NEAR((*curves)[i]->profiles[s].z[j], want->profiles[s].z[j], 1e-7);
      }
    }
  }
  EXPECT_GT(compared, 60);
}

/// Corners of half the side are a round tube, as cutter and as target.
TEST(SectionNode, RoundLimitGivesTheRoundNumbers) {
  Random random(20261130);
  for (int k = 0; k < 100; ++k) {
    SCOPED_TRACE(k);
    const Eigen::Matrix3d turn = random.rotation();
    const double big = random.any(60, 120), small = big * random.any(0.3, 0.8);
    const double lean = random.any(0.7, 2.4);
    NodeSpec spec;
    spec.members = {
        round(turn * Vector3d(-1000, 0, 0), turn * Vector3d(1000, 0, 0), big, 6),
        round(turn * Vector3d(10, 3, 0),
              turn * Vector3d(10 + 900 * std::cos(lean), 3, 900 * std::sin(lean)), small, 4)};
    for (auto& m : spec.members) m.up = random.in_box(1.0);
    spec.connect = Within{5};
    auto limit = spec;
    for (auto& m : limit.members)
      m.section = Section{.height = 2 * m.outer_radius,
                          .width = 2 * m.outer_radius,
                          .wall = m.wall,
                          .corner = m.outer_radius,
                          .inner_corner = m.outer_radius - m.wall};
    const auto nodes = solve(spec), same = solve(limit);
    ASSERT_TRUE(nodes);
    ASSERT_TRUE(same);
    const auto want = profiles(spec, *nodes, grid(72)), got = profiles(limit, *same, grid(72));
    ASSERT_TRUE(want);
    ASSERT_TRUE(got);
    ASSERT_TRUE((*want)[2]);
    ASSERT_TRUE((*got)[2]);
    for (const std::size_t s : {0U, 1U}) {
      const auto& a = (*want)[2]->profiles[s];
      const auto& b = (*got)[2]->of_section->profiles[s];
      for (std::size_t j = 0; j < a.z.size(); ++j) EXPECT_NEAR(a.z[j], b.z[j], 1e-9);
      EXPECT_NEAR(a.length, b.length, 1e-8 * a.length);
    }
    EXPECT_EQ(same->ends[2].cut_by[0].gap, nodes->ends[2].cut_by[0].gap);
    EXPECT_EQ(same->ends[2].open, nodes->ends[2].open);
    EXPECT_EQ(same->ends[2].cut_by[0].ghost, nodes->ends[2].cut_by[0].ghost);
  }
}

TEST(SectionNode, AQuarterTurnOfUpExchangesHeightAndWidth) {
  Random random(20261201);
  for (int k = 0; k < 50; ++k) {
    SCOPED_TRACE(k);
    const Eigen::Matrix3d turn = random.rotation();
    const auto section = rectangle(random.any(60, 90), random.any(40, 60), 4);
    auto turned = section;
    std::swap(turned.height, turned.width);
    const Vector3d along = turn * Vector3d(0.3, 0.1, 1).normalized();
    const Vector3d up = (turn * Vector3d(1, 0.2, 0)).normalized();
    NodeSpec spec;
    spec.members = {rectangular(turn * Vector3d(-900, 0, 0), turn * Vector3d(900, 0, 0),
                                turn * Vector3d(0, 0.3, 1), rectangle(140, 180, 6)),
                    rectangular(Vector3d::Zero(), 800 * along, up, section)};
    spec.connect = Within{5};
    auto other = spec;
    other.members[1].section = turned;
    other.members[1].up = along.cross(up);
    other.members[0].section = rectangle(180, 140, 6);
    other.members[0].up = (turn * Vector3d(1, 0, 0)).cross(turn * Vector3d(0, 0.3, 1));
    const auto a = solve(spec), b = solve(other);
    ASSERT_TRUE(a);
    ASSERT_TRUE(b);
    Sampling sampling;
    sampling.tolerance = Tolerance{0.05};
    const auto one = profiles(spec, *a, sampling), two = profiles(other, *b, sampling);
    ASSERT_TRUE(one && (*one)[2] && two && (*two)[2]);
    // x of the turned section is y of the first: s = 0 lies in the middle of its face 2.
    const auto outer = section.outer();
    const double shift = outer.on_face(2, 0.0);
    const auto& p = (*one)[2]->of_section->profiles[1];
    const auto& q = (*two)[2]->of_section->profiles[1];
    EXPECT_NEAR(p.length, q.length, 1e-7);
    IntersectionSpec given{
        .target = {}, .partners = seats(joint_of(spec, a->ends[2])), .sampling = grid(8)};
    const auto contour = trace(resolve(given.partners).value(), outer);
    ASSERT_TRUE(contour);
    for (std::size_t j = 0; j < q.z.size(); ++j)
      EXPECT_NEAR(contact_at(*contour, outer.at(q.at[j].s + shift)).z, q.z[j], 1e-9) << q.at[j].s;
  }
}

/// A round brace on a rectangular chord is a round target with a rectangular partner.
TEST(SectionNode, ARoundBraceHasTheTableOfItsRectangularPartner) {
  NodeSpec spec;
  spec.members = {rectangular({0, 0, 0}, {2000, 0, 0}, {0, 0, 1}, rectangle(150, 100, 6)),
                  round({1000, 0, 0}, {1500, 0, 866}, 38.05, 4)};
  spec.connect = Within{1};
  const auto nodes = solve(spec);
  ASSERT_TRUE(nodes);
  bevel::TableSpec asked{.sampling = {.tolerance = Tolerance{0.05}}};
  asked.groove = bevel::FixedGroove{Angle::deg(40)};
  asked.kerf = 1.5;
  asked.smoothing = bevel::NoSmoothing{};
  const auto tables = bevel::end_tables(spec, *nodes, asked);
  ASSERT_TRUE(tables);
  ASSERT_TRUE((*tables)[2]);
  ASSERT_TRUE((*tables)[2]->table) << (*tables)[2]->refused->member << (*tables)[2]->refused->hint;
  const auto& frame = nodes->ends[2].frame;
  asked.target = {38.05, 4, (spec.members[1].finish - spec.members[1].start).norm()};
  asked.partners = {RectangularTubeCutter{.width = 100,
                                          .height = 150,
                                          .corner = 12,
                                          .point = frame.local(Vector3d(0, 0, 0)),
                                          .direction = frame.rows * Vector3d(2000, 0, 0),
                                          .up = frame.rows * Vector3d(0, 0, 1)}};
  const auto direct = bevel::table(asked);
  ASSERT_TRUE(direct);
  const auto& table = *(*tables)[2]->table;
  EXPECT_EQ(table.phi, direct->phi);
  EXPECT_EQ(table.b, direct->b);
  EXPECT_EQ(table.z_inner, direct->z_inner);
  EXPECT_EQ(table.z_outer, direct->z_outer);
  EXPECT_EQ(table.torch_outer, direct->torch_outer);
}

TEST(SectionNode, TheLargerSideIsTheDiameterAndTheReachTheRadius) {
  NodeSpec spec;
  spec.members = {round({0, 0, 0}, {1000, 0, 0}, 45, 4),
                  rectangular({500, 0, 0}, {500, 0, 700}, {1, 0, 0}, rectangle(60, 100, 4))};
  spec.connect = Within{1};
  auto nodes = solve(spec);
  ASSERT_TRUE(nodes);
  EXPECT_TRUE(nodes->ends[2].cut_by.empty());  // 100 > 90: the rectangular one is not cut
  spec.members[1].section = rectangle(60, 80, 4);
  nodes = solve(spec);
  ASSERT_EQ(nodes->ends[2].cut_by.size(), 1U);
  // An end 110 mm off a 200 x 100 chord's axis, whose corners are 107.8 mm away.
  spec.members = {rectangular({0, 0, 0}, {1000, 0, 0}, {0, 0, 1}, rectangle(200, 100, 5)),
                  round({500, 0, 108}, {500, 0, 700}, 30, 4)};
  const double reach = spec.members[0].reach();
  EXPECT_NEAR(reach, std::hypot(90, 40) + 10, 1e-12);
  spec.connect = Within{108 - reach + 0.01};
  EXPECT_EQ(solve(spec)->ends[2].cut_by.size(), 1U);
  spec.connect = Within{108 - reach - 0.01};
  EXPECT_EQ(solve(spec)->ends[2].cut_by.size(), 0U);
}

TEST(SectionNode, RefusesWhatASectionCannotBe) {
  NodeSpec spec;
  spec.members = {rectangular({0, 0, 0}, {1000, 0, 0}, {0, 0, 1}, rectangle(100, 100, 5)),
                  rectangular({500, 0, 0}, {500, 0, 700}, {1, 0, 0}, rectangle(60, 60, 4))};
  spec.connect = Within{1};
  const auto refused = [&](const NodeSpec& s, ErrorCode code, const std::string& member) {
    const auto nodes = solve(s);
    ASSERT_FALSE(nodes);
    EXPECT_EQ(nodes.error().code(), code);
    EXPECT_EQ(nodes.error().issues.front().member, member);
  };
  auto bad = spec;
  bad.members[1].up.reset();
  refused(bad, ErrorCode::bad_reference_direction, "members/1/up");
  bad.members[1].up = Vector3d(0, 0, 2);
  refused(bad, ErrorCode::bad_reference_direction, "members/1/up");
  bad = spec;
  bad.members[0].section->corner = 2;
  refused(bad, ErrorCode::out_of_range, "members/0/corner_radius");
  bad = spec;
  bad.joints = {{.member = 1, .with = 0, .joint = {.kind = JointKind::set_in, .depth = 11}}};
  refused(bad, ErrorCode::out_of_range, "members/1/joints/0/depth");
  bad.joints[0].joint.depth.reset();
  const auto set_in = solve(bad);
  ASSERT_TRUE(set_in);
  EXPECT_EQ(set_in->ends[2].cut_by[0].stated->depth, 5.0);
  // Corner to corner: turned about its axis, the first has no face square to the plane of both.
  bad.members = {rectangular({0, 0, 0}, {1000, 0, 0}, {0, 1, 3}, rectangle(100, 100, 5)),
                 rectangular({0, 0, 0}, {0, 0, 1000}, {1, 0, 0}, rectangle(60, 60, 4))};
  bad.joints[0].joint = {.kind = JointKind::mitre, .plane = MitrePlane::corner_to_corner};
  refused(bad, ErrorCode::unsupported_combination, "members/1/joints/0/plane");
  bad.members[0].up = Vector3d(0, 0, 1);
  const auto nodes = solve(bad);
  ASSERT_TRUE(nodes);
  // Through the corners of 100 and 60: the plane rises 50 over 30.
  const Vector3d n =
      (nodes->ends[0].frame.rows.transpose() * nodes->ends[0].cut_by[0].plane->normal).normalized();
  EXPECT_NEAR(std::abs(n.dot(Vector3d(30, 0, 50).normalized())), 0.0, 1e-12);
  for (const auto& check : verify(bad, *nodes)) EXPECT_TRUE(check.passed()) << check.name;
}

bool has(const Nodes& nodes, WarningCode code) {
  return std::ranges::any_of(nodes.warnings, [&](const Warning& w) { return w.code == code; });
}

TEST(SectionNode, MembersInLineAreMitredAndContinueEachOther) {
  const auto section = rectangle(100, 60, 4);
  NodeSpec spec;
  spec.members = {rectangular({0, 0, 0}, {1000, 0, 0}, {0, 0, 1}, section),
                  rectangular({1000, 0, 0}, {2000, 0, 150}, {0, 0, 1}, section)};
  spec.connect = Within{1};
  auto nodes = solve(spec);
  ASSERT_TRUE(nodes);
  ASSERT_EQ(nodes->ends[1].cut_by.size(), 1U);
  ASSERT_TRUE(nodes->ends[1].cut_by[0].plane);
  EXPECT_FALSE(has(*nodes, WarningCode::mitre_steps));
  const auto shared = overlaps(spec, *nodes);
  ASSERT_TRUE(shared);
  EXPECT_TRUE(shared->empty());
  spec.members[1].up = Vector3d(0, 1, 0);  // a quarter turn: 100 stands on 60
  nodes = solve(spec);
  ASSERT_TRUE(nodes);
  EXPECT_TRUE(has(*nodes, WarningCode::mitre_steps));
  // A brace across the joint of two chords: the second continues the surface of the first.
  spec.members[1] = rectangular({1000, 0, 0}, {2000, 0, 0}, {0, 0, 1}, section);
  spec.members.push_back(round({990, 0, 0}, {990, 0, 600}, 15, 3));
  nodes = solve(spec);
  ASSERT_TRUE(nodes);
  EXPECT_FALSE(has(*nodes, WarningCode::ghost_contact));
  spec.members[1].section = rectangle(80, 60, 4);  // its face lies 10 mm lower
  spec.members[1].priority = 0;
  nodes = solve(spec);
  ASSERT_TRUE(nodes);
  ASSERT_TRUE(has(*nodes, WarningCode::ghost_contact));
  double missing = 0.0;
  for (const auto& cut : nodes->ends[4].cut_by) missing = std::max(missing, cut.missing);
  EXPECT_NEAR(missing, 10.0, 1e-6);
}

// ---- members that share metal

std::vector<Overlap> shared(const NodeSpec& spec) {
  const auto nodes = solve(spec);
  EXPECT_TRUE(nodes);
  const auto out = overlaps(spec, *nodes);
  EXPECT_TRUE(out);
  return *out;
}

TEST(SectionNode, FlushFacesShareNoMetal) {
  const auto section = rectangle(100, 60, 4);
  NodeSpec spec;
  spec.connect = std::vector<Link>{};
  const auto pair = [&](Member a, Member b) { spec.members = {std::move(a), std::move(b)}; };
  const Vector3d z(0, 0, 1);
  const auto first = rectangular({0, 0, 0}, {1000, 0, 0}, z, section);
  pair(first, rectangular({100, 60, 0}, {1200, 60, 0}, z, section));  // side by side
  EXPECT_TRUE(shared(spec).empty());
  pair(first, rectangular({100, 59, 0}, {1200, 59, 0}, z, section));
  ASSERT_EQ(shared(spec).size(), 1U);
  EXPECT_NEAR(shared(spec)[0].depth, 1.0, 0.02);
  pair(first, rectangular({500, -400, 100}, {500, 400, 100}, z, section));  // laid across
  EXPECT_TRUE(shared(spec).empty());
  pair(first, rectangular({500, -400, 97}, {500, 400, 97}, z, section));
  ASSERT_EQ(shared(spec).size(), 1U);
  EXPECT_NEAR(shared(spec)[0].depth, 3.0, 0.02);
  pair(first, rectangular({200, 0, 0}, {1500, 0, 0}, z, rectangle(92, 52, 4)));  // slid into it
  EXPECT_TRUE(shared(spec).empty());
  pair(first, rectangular({200, 0, 0}, {1500, 0, 0}, z, rectangle(93, 52, 4)));
  EXPECT_EQ(shared(spec).size(), 1U);
  pair(first, round({200, 60, 0}, {1500, 60, 0}, 30, 3));  // a tube along its side
  EXPECT_TRUE(shared(spec).empty());
  pair(first, round({200, 59.9, 0}, {1500, 59.9, 0}, 30, 3));
  ASSERT_EQ(shared(spec).size(), 1U);
  EXPECT_NEAR(shared(spec)[0].depth, 0.1, 0.02);
}

bool in_metal(const Member& m, const Vector3d& p, double by) {
  const Vector3d along = m.finish - m.start;
  const double z = (p - m.start).dot(along.normalized());
  return outside_of(m, p) < -by && outside_of_bore(m, p) > by && z > by && z < along.norm() - by;
}

TEST(SectionNode, SharedMetalIsWhereBothHaveIt) {
  Random random(20261202);
  int found = 0, free = 0;
  for (int k = 0; k < 150; ++k) {
    SCOPED_TRACE(k);
    NodeSpec spec;
    spec.connect = std::vector<Link>{};
    for (int i = 0; i < 2; ++i) {
      const Vector3d at = random.in_box(60), along = random.in_box(1.0).normalized();
      const double size = random.any(40, 120);
      auto section = rectangle(size, random.any(0.5, 1) * size, random.any(0.04, 0.08) * size);
      if (k % 3 == 0) {  // EN 10210: the bore's corners are not concentric
        section.corner = 1.5 * section.wall;
        section.inner_corner = section.wall;
      }
      const Vector3d start = at - 250 * along, finish = at + 250 * along;
      if (i == 1 && k % 4 == 1)
        spec.members.push_back(round(start, finish, 0.5 * size, 0.06 * size));
      else
        spec.members.push_back(rectangular(start, finish, random.in_box(1.0), section));
    }
    const auto nodes = solve(spec);
    ASSERT_TRUE(nodes);
    const auto all = overlaps(spec, *nodes);
    ASSERT_TRUE(all);
    const auto& a = spec.members[0];
    const auto& b = spec.members[1];
    if (!all->empty()) {
      ++found;
      const auto at = detail::shared_metal(detail::finished(spec, *nodes, 0, {}),
                                           detail::finished(spec, *nodes, 1, {}));
      ASSERT_TRUE(at);
      EXPECT_TRUE(in_metal(a, *at, 0.004) && in_metal(b, *at, 0.004));
      const Vector3d deep = (*all)[0].at;
      EXPECT_GT((*all)[0].depth, 0.0);
      // The deepest point is metal of one, that deep below the outside of the other.
      const double below = std::max(in_metal(a, deep, -1e-6) ? -outside_of(b, deep) : 0.0,
                                    in_metal(b, deep, -1e-6) ? -outside_of(a, deep) : 0.0);
      EXPECT_GE(below, (*all)[0].depth - 1e-6);
      continue;
    }
    ++free;
    const Vector3d along = (a.finish - a.start).normalized();
    const double wide = a.reach();
    for (int n = 0; n < 40000; ++n) {
      const Vector3d p =
          0.5 * (a.start + a.finish) + random.any(-250, 250) * along + random.in_box(1.0) * wide;
      ASSERT_FALSE(in_metal(a, p, 0.02) && in_metal(b, p, 0.02));
    }
  }
  std::cout << found << " share metal, " << free << " do not\n";
  EXPECT_GT(found, 50);
  EXPECT_GT(free, 15);
}

}  // namespace
}  // namespace tubecut::joint
