#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "tests/core/part/random_member.hpp"
#include "tests/support/ray_caster.hpp"

namespace tubecut::testing {
namespace {

using part::Part;

constexpr std::size_t kMembers = 500;

/// Rows and origin of a part's frame as one 3x4 matrix into the world.
using Placed = Eigen::Matrix<double, 3, 4>;
Placed into_world(const Part& p) {
  Placed out;
  for (int k = 0; k < 3; ++k) out.col(k) = p.frame.rows.row(k).transpose();
  out.col(3) = p.frame.origin;
  return out;
}
Vector3d placed(const Placed& m, double radius, double phi, double z) {
  return m * Eigen::Vector4d(radius * std::cos(phi), radius * std::sin(phi), z, 1.0);
}

double outside(const Vector3d& p, const joint::Member& m) {
  const Vector3d along = (m.finish - m.start).normalized();
  return (p - m.start).cross(along).norm() - m.outer_radius;
}

struct Built {
  part::MemberSpec spec;
  part::FoundMember found;
  Part part;
};

std::optional<Built> build(const part::MemberSpec& spec) {
  auto found = part::find_member(spec);
  if (!found) return std::nullopt;
  auto made = part::part(found->part);
  if (!made) return std::nullopt;
  return Built{spec, *std::move(found), *std::move(made)};
}

/// The next random member that can be cut; `refused` counts the others.
Built next(Random& random, const joint::Sampling& sampling, int& refused) {
  while (true) {
    auto spec = random_member(random);
    spec.cut.sampling = sampling;
    if (auto built = build(spec)) return *std::move(built);
    ++refused;
  }
}

// Both ends, placed in the world only by the part frame, meet the partners that joined them there:
// nowhere inside, and the root on one of them.
TEST(Part, FiveHundredMembersMeetTheirPartnersInTheWorld) {
  Random random{std::mt19937_64(20261121)};
  int refused = 0;
  double deepest = 0, open = 0;
  std::size_t points = 0;
  for (std::size_t count = 0; count < kMembers; ++count) {
    const auto b = next(random, {.tolerance = joint::Tolerance{.value = 0.01}}, refused);
    const auto world = into_world(b.part);
    const auto& own = b.spec.node.members[0];
    const auto& links = std::get<std::vector<joint::Link>>(b.spec.node.connect);
    for (const bool finish : {false, true}) {
      const auto& t = (finish ? b.part.finish : b.part.start).table;
      const auto n = t.phi.size();
      for (std::size_t i = 0; i < n; ++i) {
        const auto j = (i + 1) % n;
        const double step = t.phi[j] - t.phi[i] + (j == 0 ? kTwoPi : 0.0);
        for (const double u : {0.0, 0.5}) {
          const double phi = t.phi[i] + u * step;
          double root = 1e300;
          for (const double v : {0.0, 0.25, 0.5, 0.75, 1.0}) {
            const double low = (1 - u) * t.z_inner[i] + u * t.z_inner[j];
            const double high = (1 - u) * t.z_outer[i] + u * t.z_outer[j];
            const auto p =
                placed(world, own.outer_radius - (1 - v) * own.wall, phi, (1 - v) * low + v * high);
            for (const auto k : links[finish ? 1 : 0].to) {
              const double d = outside(p, b.spec.node.members[k]);
              deepest = std::max(deepest, -d);
              if (v == 0.0 && u == 0.0) root = std::min(root, d);
              ++points;
            }
          }
          if (u == 0.0) open = std::max(open, root);
        }
      }
    }
  }
  std::printf("%zu members (%d refused), %zu distances: deepest %.4g mm, root off by %.4g mm\n",
              kMembers, refused, points, deepest, open);
  EXPECT_LE(deepest, 0.01);
  EXPECT_LE(open, 0.01);
  EXPECT_LT(refused, 500);
}

/// Largest distance between the edges of two parts in the world; `other` row i is row
/// `turn ? n - i : i` of the uniform grid of `one`.
double apart(const part::End& one, const Placed& at_one, const part::End& other,
             const Placed& at_other, bool turn) {
  const auto& a = one.table;
  const auto& b = other.table;
  const auto n = a.phi.size();
  if (b.phi.size() != n) return 1e300;
  const auto& target = one.spec.target;
  double worst = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const auto j = turn ? (n - i) % n : i;
    worst = std::max({worst,
                      (placed(at_one, target.inner_radius(), a.phi[i], a.z_inner[i]) -
                       placed(at_other, target.inner_radius(), b.phi[j], b.z_inner[j]))
                          .norm(),
                      (placed(at_one, target.outer_radius, a.phi[i], a.z_outer[i]) -
                       placed(at_other, target.outer_radius, b.phi[j], b.z_outer[j]))
                          .norm(),
                      (placed(at_one, target.outer_radius, a.phi[i], a.torch_outer[i]) -
                       placed(at_other, target.outer_radius, b.phi[j], b.torch_outer[j]))
                          .norm()});
  }
  return worst;
}

TEST(Part, ReversingStartAndFinishChangesNoSolid) {
  Random random{std::mt19937_64(7)};
  int refused = 0;
  double worst = 0, mass = 0, length = 0;
  for (int count = 0; count < 60; ++count) {
    const auto b = next(random, {.uniform_points = 120}, refused);
    auto spec = b.spec;
    std::swap(spec.node.members[0].start, spec.node.members[0].finish);
    auto& links = std::get<std::vector<joint::Link>>(spec.node.connect);
    std::swap(links[0].to, links[1].to);
    const auto r = build(spec);
    ASSERT_TRUE(r);
    worst = std::max(
        {worst, apart(b.part.start, into_world(b.part), r->part.finish, into_world(r->part), true),
         apart(b.part.finish, into_world(b.part), r->part.start, into_world(r->part), true)});
    mass = std::max(mass, std::abs(r->part.lengths.mass / b.part.lengths.mass - 1));
    length = std::max(length, std::abs(r->part.lengths.longest - b.part.lengths.longest));
  }
  std::printf("reversed: %.3g mm, mass %.3g, length %.3g mm\n", worst, mass, length);
  EXPECT_LE(worst, 1e-6);
  EXPECT_LE(mass, 1e-9);
  EXPECT_LE(length, 1e-6);
}

TEST(Part, TurningTheWorldTurnsTheSolid) {
  Random random{std::mt19937_64(8)};
  int refused = 0;
  double worst = 0;
  for (int count = 0; count < 60; ++count) {
    const auto b = next(random, {.uniform_points = 120}, refused);
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(random.between(-3, 3), random.direction()).toRotationMatrix();
    const Vector3d shift = 1000 * random.direction();
    auto spec = b.spec;
    for (auto& m : spec.node.members) {
      m.start = turn * m.start + shift;
      m.finish = turn * m.finish + shift;
      if (m.up) m.up = turn * *m.up;
    }
    const auto r = build(spec);
    ASSERT_TRUE(r);
    Placed moved = turn * into_world(b.part);
    moved.col(3) += shift;
    worst = std::max({worst, apart(b.part.start, moved, r->part.start, into_world(r->part), false),
                      apart(b.part.finish, moved, r->part.finish, into_world(r->part), false)});
  }
  std::printf("turned world: %.3g mm\n", worst);
  EXPECT_LE(worst, 1e-6);
}

TEST(Part, MirroringTheNodeMirrorsTheSolid) {
  Random random{std::mt19937_64(9)};
  int refused = 0;
  double worst = 0, clocking = 0;
  const Eigen::Matrix3d flip = Vector3d(-1, 1, 1).asDiagonal();
  for (int count = 0; count < 60; ++count) {
    const auto b = next(random, {.uniform_points = 120}, refused);
    auto spec = b.spec;
    for (auto& m : spec.node.members) {
      m.start = flip * m.start;
      m.finish = flip * m.finish;
      if (m.up) m.up = flip * *m.up;
    }
    const auto r = build(spec);
    ASSERT_TRUE(r);
    const Placed mirrored = flip * into_world(b.part);
    worst =
        std::max({worst, apart(b.part.start, mirrored, r->part.start, into_world(r->part), true),
                  apart(b.part.finish, mirrored, r->part.finish, into_world(r->part), true)});
    clocking = std::max(clocking, std::abs(std::sin(0.5 * (r->part.clocking + b.part.clocking))));
  }
  std::printf("mirrored: %.3g mm, clocking %.3g\n", worst, clocking);
  EXPECT_LE(worst, 1e-6);
  EXPECT_LE(clocking, 1e-9);
}

// Another datum turns the numbers, not the solid.
TEST(Part, TheDatumTurnsTheNumbersOnly) {
  Random random{std::mt19937_64(10)};
  int refused = 0;
  double worst = 0;
  for (int count = 0; count < 30; ++count) {
    const auto b = next(random, {.uniform_points = 120}, refused);
    auto spec = b.spec;
    spec.datum = part::Datum::seam;
    spec.seam = Angle::deg(3 * random.upto(119));  // a whole number of grid steps
    const auto r = build(spec);
    ASSERT_TRUE(r);
    const auto shift = static_cast<std::size_t>(std::lround(spec.seam.deg() / 3));
    const auto& a = b.part.finish.table;
    const auto& c = r->part.finish.table;
    for (std::size_t i = 0; i < 120; ++i) {
      const auto j = (i + 120 - shift) % 120;
      worst = std::max({worst, std::abs(a.z_outer[i] - c.z_outer[j]), std::abs(a.b[i] - c.b[j]),
                        std::abs(a.torch_inner[i] - c.torch_inner[j])});
    }
    // phi = 0 of the new frame lies `seam` round from the old one's, from x towards y.
    const Vector3d x = r->part.frame.rows.row(0);
    const Vector3d seen = b.part.frame.rows * x;
    worst = std::max({worst, std::abs(seen.x() - std::cos(spec.seam.rad())),
                      std::abs(seen.y() - std::sin(spec.seam.rad()))});
  }
  std::printf("datum: %.3g\n", worst);
  EXPECT_LE(worst, 1e-6);
}

TEST(Part, FrameStartsAtTheLongPoint) {
  Random random{std::mt19937_64(11)};
  int refused = 0;
  for (int count = 0; count < 50; ++count) {
    const auto b = next(random, {.uniform_points = 72}, refused);
    double low = 1e300, high = -1e300;
    for (const auto* t : {&b.part.start.table, &b.part.finish.table})
      for (const auto* column : {&t->z_inner, &t->z_outer})
        for (const double z : *column) {
          low = std::min(low, z);
          high = std::max(high, z);
        }
    EXPECT_NEAR(low, 0.0, 1e-12);
    EXPECT_NEAR(high, b.part.lengths.longest, 1e-9);
    EXPECT_NEAR(b.part.frame.rows.determinant(), 1.0, 1e-12);
    const auto& m = b.spec.node.members[0];
    EXPECT_NEAR((m.finish - m.start).norm(), b.part.lengths.work_point, 1e-9);
    // B in the part's frame: the outer edge lies further towards +z by wall tan B.
    for (const auto* t : {&b.part.start.table, &b.part.finish.table})
      for (std::size_t i = 0; i < t->b.size(); ++i)
        ASSERT_NEAR(t->z_outer[i] - t->z_inner[i], m.wall * std::tan(t->b[i]), 1e-9);
    for (const auto& check : part::verify(b.found.part, b.part))
      EXPECT_TRUE(check.passed()) << check.name << " " << check.value << " of " << check.limit;
  }
}

part::PartSpec direct(const std::vector<joint::Partner>& start,
                      const std::vector<joint::Partner>& finish, double length) {
  part::PartSpec out;
  out.target = {.outer_radius = 50, .wall = 6, .length = length};
  bevel::TableSpec cut{.target = out.target};
  cut.sampling = {.uniform_points = 360};
  cut.smoothing = bevel::NoSmoothing{};
  cut.groove = bevel::NoGroove{};
  for (const bool end : {false, true}) {
    const auto& partners = end ? finish : start;
    auto& e = end ? out.finish : out.start;
    e = partners.empty() ? part::square_end(cut, 0.0) : part::EndSpec{.cut = cut};
    if (!partners.empty()) e.cut.partners = partners;
  }
  return out;
}

TEST(Part, PlainTubeHasItsClosedForms) {
  auto spec = direct({}, {}, 1000);
  spec.start.cut.kerf = spec.finish.cut.kerf = 2.0;
  spec.clamping = 80;
  spec.facing = 5;
  const auto p = part::part(spec);
  ASSERT_TRUE(p);
  const double volume = kPi * (50.0 * 50 - 44.0 * 44) * 1000;
  EXPECT_NEAR(p->lengths.volume / volume, 1.0, 1e-12);
  EXPECT_NEAR(p->lengths.mass, volume * 7850e-9, 1e-9);
  EXPECT_NEAR(p->lengths.longest, 1000, 1e-9);
  EXPECT_NEAR(p->lengths.shortest, 1000, 1e-9);
  EXPECT_NEAR(p->lengths.blank, 1000 + 2 * 2.0 + 80 + 5, 1e-9);
  EXPECT_EQ(p->lengths.weld, 0.0);
  EXPECT_EQ(p->clocking, 0.0);
  EXPECT_GE(p->check_dimensions.size(), 8u);
}

// A plane across the axis at any slope leaves the same volume: its mean height is where it meets
// the axis.
TEST(Part, MitredTubeHasItsClosedForms) {
  const auto spec =
      direct({joint::PlaneCutter{.point = {0, 0, 30}, .normal = {0.6, 0, 0.8}}},
             {joint::PlaneCutter{.point = {0, 0, 0}, .normal = {-0.6, 0, 0.8}}}, 1000);
  const auto p = part::part(spec);
  ASSERT_TRUE(p);
  EXPECT_NEAR(p->lengths.volume / (kPi * (50.0 * 50 - 44.0 * 44) * 970), 1.0, 1e-12);
  EXPECT_NEAR(p->lengths.longest, 970 + 2 * 50 * 0.75, 1e-9);
  EXPECT_NEAR(p->lengths.shortest, 970 - 2 * 50 * 0.75, 1e-9);
  // Straight from row to row the cut lies above the plane where that is hollow, half the turn.
  const double step = kTwoPi / 360;
  const double above = 0.75 * step * step / 12 * 2 * (50.0 * 50 * 50 - 44.0 * 44 * 44) / 3;
  EXPECT_NEAR(p->start.groove_volume / above, 1.0, 1e-3);
  // The root is the ellipse of the bore.
  double perimeter = 0;
  for (int k = 0; k < 100'000; ++k)
    perimeter += kTwoPi / 100'000 * 44 * std::hypot(1.0, 0.75 * std::sin(kTwoPi * k / 100'000));
  EXPECT_NEAR(p->start.weld_length, perimeter, 1e-6);
  // Long points on opposite sides: half a turn between the ends.
  EXPECT_NEAR(std::abs(p->clocking) * kDegPerRad, 180, 1e-9);
}

TEST(Part, GrooveOfASquareButtIsAConeRing) {
  auto spec = direct({joint::PlaneCutter{}}, {}, 800);
  spec.start.cut.groove = bevel::FixedGroove{Angle::deg(30)};
  const auto p = part::part(spec);
  ASSERT_TRUE(p);
  const double t = 6, r = 44;  // 2 pi tan 30 times the integral of (rho - r) rho
  const double volume = kTwoPi * std::tan(30 * kRadPerDeg) * (r * t * t / 2 + t * t * t / 3);
  EXPECT_NEAR(p->start.groove_volume / volume, 1.0, 1e-9);
  EXPECT_NEAR(p->start.weld_length, kTwoPi * 44, 1e-9);
}

/// Volume between a table's cut, straight from row to row, and a body, within the wall: rays on a
/// grid of 720 by 30.
double filled(const joint::Target& target, const bevel::Table& t, double root_face,
              const ray::Body& body) {
  constexpr int kAround = 720, kAcross = 30;
  const bool land = !t.z_face.empty();
  std::size_t i = 0;
  double sum = 0;
  for (int a = 0; a < kAround; ++a) {
    const double phi = kTwoPi * (a + 0.5) / kAround;
    while (i + 1 < t.phi.size() && t.phi[i + 1] <= phi) ++i;
    const auto from = phi < t.phi[0] ? t.phi.size() - 1 : i, to = (from + 1) % t.phi.size();
    const double start = t.phi[from] - (phi < t.phi[0] ? kTwoPi : 0);
    const double u =
        (phi - start) / (t.phi[to] + (to == 0 && phi >= t.phi[0] ? kTwoPi : 0) - start);
    const auto z = [&](const std::vector<double>& edge) {
      return (1 - u) * edge[from] + u * edge[to];
    };
    for (int k = 0; k < kAcross; ++k) {
      const double depth = target.wall * (k + 0.5) / kAcross;
      const double face = land ? root_face : 0.0;
      const double share = depth < face ? depth / face : (depth - face) / (target.wall - face);
      const auto& low = land && depth >= face ? t.z_face : t.z_inner;
      const auto& high = land && depth < face ? t.z_face : t.z_outer;
      const double rho = target.outer_radius - target.wall + depth;
      const auto top = ray::top(body, rho, phi);
      if (!top) continue;
      const double over = (1 - share) * z(low) + share * z(high) - static_cast<double>(*top);
      sum += std::max(0.0, over) * rho * target.wall / kAcross * kTwoPi / kAround;
    }
  }
  return sum;
}

TEST(Part, GrooveEqualsTheVolumeFoundByRays) {
  for (const double inclination : {35.0, 60.0, 90.0})
    for (const double root_face : {0.0, 2.0}) {
      const joint::TubeCutter on{.radius = 60, .inclination = Angle::deg(inclination)};
      auto spec = direct({on}, {}, 800);
      spec.start.cut.groove = bevel::HalfDihedral{};
      spec.start.cut.root_face = root_face;
      spec.start.cut.sampling = {.tolerance = joint::Tolerance{}};
      const auto p = part::part(spec);
      ASSERT_TRUE(p) << inclination;
      const auto body = ray::tube(60, inclination * kRadPerDeg, 0, 0, 0);
      const double expected = filled(spec.target, p->start.own, root_face, body);
      EXPECT_NEAR(p->start.groove_volume / expected, 1.0, 1e-3) << inclination << ' ' << root_face;
    }
}

joint::TubeCutter chord(double inclination, double clocking, double offset = 0) {
  return {.radius = 90,
          .inclination = Angle::deg(inclination),
          .clocking = Angle::deg(clocking),
          .offset = offset};
}

TEST(Part, ClockingBetweenTheEnds) {
  const auto turn = [](joint::Partner a, joint::Partner b) {
    const auto p = part::part(direct({std::move(a)}, {std::move(b)}, 900));
    return p ? p->clocking * kDegPerRad : 1e9;
  };
  // Both ends lean to phi = -90 deg of the start: seen from the finish that is +90.
  EXPECT_NEAR(turn(chord(60, 0), chord(60, 180)), 0.0, 1e-9);
  EXPECT_NEAR(turn(chord(60, 0), chord(120, 0)), 0.0, 1e-9);  // the same chord drawn the other way
  EXPECT_NEAR(std::abs(turn(chord(60, 0), chord(60, 0))), 180.0, 1e-9);
  // The finish turned on by 25 deg in the part's sense is -25 in its own.
  EXPECT_NEAR(turn(chord(60, 0), chord(60, 180 - 25)), 25.0, 1e-9);
  EXPECT_NEAR(turn(chord(60, 40), chord(60, 180 - 40 - 25)), 25.0, 1e-9);
  // At right angles the partner leans both ways.
  EXPECT_NEAR(turn(chord(90, 0), chord(90, -70)), 70.0, 1e-9);
  EXPECT_NEAR(turn(chord(90, 0), chord(90, -110)), -70.0, 1e-9);
}

TEST(Part, LongPointsFollowTheClocking) {
  const auto p = part::part(direct({chord(45, 30)}, {chord(40, 100)}, 900));
  ASSERT_TRUE(p);
  const double turn = p->finish.longest.phi - p->start.longest.phi - p->clocking;
  EXPECT_NEAR(std::sin(turn / 2), 0.0, 0.01);
}

/// A set-in branch square on a chord 50/44, its hole cut with the torch free to tilt.
bevel::HoleSpec square_branch(double radius, double height, std::size_t points,
                              double clocking = 0) {
  return {
      .chord = {.outer_radius = 50, .wall = 6},
      .branch =
          joint::TubeCutter{.radius = radius, .clocking = Angle::rad(clocking), .height = height},
      .branch_wall = 3,
      .kind = bevel::JointKind::set_in,
      .groove = bevel::NoGroove{},
      .tilt = bevel::Tilt::free,
      .sampling = {.uniform_points = points}};
}

TEST(Part, SequenceEndsAtTheClampedSide) {
  auto spec = direct({chord(60, 30)}, {chord(70, 100)}, 900);
  for (const double height : {300.0, 600.0})
    spec.holes.push_back({square_branch(20, height, 72), "", spec.holes.size()});
  const auto p = part::part(spec);
  ASSERT_TRUE(p);
  std::vector<part::Step::What> order;
  std::vector<std::size_t> holes;
  for (const auto& step : p->sequence) {
    order.push_back(step.what);
    if (step.what == part::Step::What::hole) holes.push_back(step.index);
    EXPECT_LE(step.z_from, step.z_to);
  }
  EXPECT_TRUE(std::ranges::is_sorted(order));  // marks, holes, finish, start
  EXPECT_EQ(order.back(), part::Step::What::start);
  EXPECT_EQ(holes, (std::vector<std::size_t>{1, 0}));  // from the free end towards the clamp
  // The hole's plug: a cylinder of 20 mm through the wall.
  const auto whole = part::part(direct({chord(60, 30)}, {chord(70, 100)}, 900));
  const double plug = (whole->lengths.volume - p->lengths.volume) / 2;
  double exact = 0;  // of a branch square on the chord: by slices across the branch
  for (int k = 0; k < 20'000; ++k) {
    const double x = -20 + 40 * (k + 0.5) / 20'000;
    exact += 40.0 / 20'000 * 2 * std::sqrt(400 - x * x) *
             (std::sqrt(2500 - x * x) - std::sqrt(44.0 * 44 - x * x));
  }
  EXPECT_NEAR(plug / exact, 1.0, 0.01);  // 72 points of a curved wall
  for (const auto& check : part::verify(spec, *p))
    EXPECT_TRUE(check.passed()) << check.name << " " << check.value << " of " << check.limit;
}

/// Square branches of radius 12 on the middle of a chord 50/44, at these heights.
part::PartSpec drilled(std::initializer_list<double> heights, double clocking = 0.4) {
  auto spec = direct({}, {}, 900);
  for (const double height : heights)
    spec.holes.push_back({square_branch(12, height, 360, clocking), "", spec.holes.size()});
  return spec;
}

/// Volume of such holes: slices across the branches, the lengths along the chord united.
double drilled_volume(std::vector<double> heights, double from, double to) {
  std::ranges::sort(heights);
  double sum = 0;
  const int n = 40'000;
  for (int k = 0; k < n; ++k) {
    const double x = -12 + 24 * (k + 0.5) / n, half = std::sqrt(144 - x * x);
    double length = 0, reached = from;
    for (const double height : heights) {
      const double low = std::max(height - half, reached), high = std::min(height + half, to);
      length += std::max(0.0, high - low);
      reached = std::max(reached, high);
    }
    sum += 24.0 / n * length * (std::sqrt(2500 - x * x) - std::sqrt(44.0 * 44 - x * x));
  }
  return sum;
}

TEST(Part, TheOverlapOfTwoHolesCountsOnce) {
  const double whole = part::part(drilled({}))->lengths.volume;
  for (const double clocking : {0.4, 0.02, 6.27}) {  // the last two across phi = 0
    for (const std::vector<double>& heights : {std::vector<double>{400, 418},
                                               {400, 400},
                                               {400, 409, 420},
                                               {400, 425},
                                               {300, 500},
                                               {893, 880}}) {
      part::PartSpec spec = drilled({}, clocking);
      for (const double height : heights)
        spec.holes.push_back(
            {drilled({height}, clocking).holes.front().hole, "", spec.holes.size()});
      const auto p = part::part(spec);
      ASSERT_TRUE(p);
      const double exact = drilled_volume(heights, 0, 900);
      // The wall's lines are tangent to the branch: outside they are up to 0.03 mm off it.
      EXPECT_NEAR((whole - p->lengths.volume) / exact, 1.0, 1e-3)
          << heights[0] << " " << heights[1];
      const bool meeting = std::abs(heights[0] - heights[1]) < 24;
      EXPECT_EQ(
          std::ranges::any_of(p->warnings,
                              [](const Warning& w) { return w.code == WarningCode::holes_meet; }),
          meeting);
      for (const auto& check : part::verify(spec, *p))
        EXPECT_TRUE(check.passed()) << check.name << " " << check.value << " of " << check.limit;
    }
  }
}

// Beyond an end there is nothing to cut: with any number of holes there, the first is refused.
TEST(Part, AHoleBeyondAnEndIsRefused) {
  for (const auto& heights : {std::vector<double>{-60}, {-60, -70}, {960}, {400, 960, 955}}) {
    part::PartSpec spec = drilled({});
    for (const double height : heights)
      spec.holes.push_back({drilled({height}).holes.front().hole, "", spec.holes.size()});
    const auto p = part::part(spec);
    ASSERT_FALSE(p);
    EXPECT_EQ(p.error().code(), ErrorCode::hole_off_part);
    EXPECT_EQ(p.error().issues.front().member, heights[0] == 400 ? "holes/1" : "holes/0");
  }
}

// Lines that graze the bore: the branch nearly as wide as it, and as wide.
TEST(Part, TheVerificationPassesIfAHoleGrazesTheBore) {
  int cut = 0;
  for (const double radius : {40.0, 43.0, 43.5, 43.9, 43.99, 44.0}) {
    for (const auto kind : {bevel::JointKind::set_in, bevel::JointKind::set_on}) {
      auto spec = drilled({400});
      auto& hole = spec.holes.front().hole;
      hole.kind = kind;
      hole.branch = joint::TubeCutter{.radius = radius, .height = 400};
      const auto p = part::part(spec);
      if (!p) continue;  // too wide for the bore
      ++cut;
      for (const auto& check : part::verify(spec, *p))
        EXPECT_TRUE(check.passed())
            << radius << " " << check.name << " " << check.value << " of " << check.limit;
    }
  }
  EXPECT_GE(cut, 6);
}

TEST(Part, TheSameHoleTwiceCountsOnce) {
  const auto volume = [](const part::PartSpec& spec) { return part::part(spec)->lengths.volume; };
  const double whole = volume(drilled({})), once = whole - volume(drilled({400}));
  EXPECT_NEAR((whole - volume(drilled({400, 400}))) / once, 1.0, 1e-9);
  EXPECT_NEAR((whole - volume(drilled({400, 440}))) / once, 2.0, 1e-9);
  EXPECT_NEAR((whole - volume(drilled({0}))) / once, 0.5, 1e-9);  // half of it lies beyond the end
}

TEST(Part, Refuses) {
  auto spec = direct({chord(60, 30)}, {chord(70, 100)}, 900);
  spec.target.length.reset();
  EXPECT_EQ(part::part(spec).error().code(), ErrorCode::missing_field);
  const auto short_one = part::part(direct({chord(60, 30)}, {chord(70, 100)}, 180));
  ASSERT_FALSE(short_one);
  EXPECT_EQ(short_one.error().code(), ErrorCode::member_consumed);
  const auto side = part::datum_angle(part::Datum::first_cutter, {}, {joint::PlaneCutter{}}, {});
  EXPECT_EQ(side.error().code(), ErrorCode::bad_reference_direction);
  spec = direct({chord(60, 30)}, {chord(90, 0, 200)}, 900);
  const auto missed = part::part(spec);
  ASSERT_FALSE(missed);
  EXPECT_TRUE(missed.error().issues.front().member.starts_with("finish/cutters"));
  spec = direct({chord(60, 30)}, {}, 900);
  bevel::HoleSpec hole{.chord = {.outer_radius = 50, .wall = 6},
                       .branch = joint::TubeCutter{.radius = 20, .height = 100},
                       .branch_wall = 3,
                       .groove = bevel::NoGroove{},
                       .sampling = {.uniform_points = 72}};
  spec.holes = {{hole, "", 0}};
  const auto off = part::part(spec);  // the cut takes all of it
  ASSERT_FALSE(off);
  EXPECT_EQ(off.error().code(), ErrorCode::hole_off_part);
}

// Each number of the answer's own proof, off by ten times its limit.
TEST(Part, ProofFailsWhenANumberIsOff) {
  const auto spec = direct({chord(60, 30)}, {chord(70, 100)}, 900);
  const auto good = part::part(spec);
  ASSERT_TRUE(good);
  const auto check = [&](const Part& p, const char* name) {
    for (const auto& c : part::verify(spec, p))
      if (c.name == name) return c;
    return Check{};
  };
  for (auto column : {&bevel::Table::z_inner, &bevel::Table::z_outer, &bevel::Table::torch_inner,
                      &bevel::Table::torch_outer, &bevel::Table::phi, &bevel::Table::b})
    for (auto end : {&Part::start, &Part::finish}) {
      auto bad = *good;
      ((bad.*end).table.*column)[7] += 10 * check(bad, "placed").limit;
      EXPECT_FALSE(check(bad, "placed").passed());
    }
  auto bad = *good;
  bad.lengths.mass *= 1 + 10 * check(bad, "volume").limit;
  EXPECT_FALSE(check(bad, "volume").passed());
  for (std::size_t i = 0; i < 5; ++i) {
    bad = *good;
    bad.check_dimensions[i].value += 10 * check(bad, "check_dimensions").limit;
    EXPECT_FALSE(check(bad, "check_dimensions").passed()) << bad.check_dimensions[i].name;
  }
}

}  // namespace
}  // namespace tubecut::testing
