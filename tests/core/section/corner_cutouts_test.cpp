#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/cutout/rows.hpp"
#include "core/part/section/section_part.hpp"
#include "tests/core/cutout/square_ends.hpp"
#include "tests/core/section/golden_ends.hpp"

/// Cut-outs over corners of tubes that are not round: an independent program, distances to the
/// section, a round tube, and the same part drawn in another way.
namespace tubecut::testing::corners {
namespace {

using namespace cutout;
using api::Json;
using Eigen::Vector2d;
using Random = std::mt19937;

section::Section drawn_section(Random& random) { return testing::drawn_section(random, 160, 2.5); }

part::SectionPartSpec plain_part(const section::Section& section, std::vector<Spec> cutouts,
                                 double kerf = 0.3) {
  part::SectionPartSpec out{.section = section, .length = 1000.0};
  testing::make_ends_square(out);
  out.cutouts.all = std::move(cutouts);
  out.cutouts.kerf = kerf;
  return out;
}

double share_of(const section::Section& section, double s) {
  return s / section.outer().girth() * kTwoPi;
}

/// Signed, of a rectangle with round corners.
double distance_to(double height, double width, double radius, const Vector2d& p) {
  const Vector2d q = p.cwiseAbs() - Vector2d(0.5 * height - radius, 0.5 * width - radius);
  return q.cwiseMax(0.0).norm() + std::min(std::max(q.x(), q.y()), 0.0) - radius;
}
double outside(const section::Section& s, const Vector2d& p) {
  return distance_to(s.height, s.width, s.corner, p);
}
double in_bore(const section::Section& s, const Vector2d& p) {
  return distance_to(s.height - 2 * s.wall, s.width - 2 * s.wall, s.inner_corner, p);
}
/// How far from `from`, which lies within, a line leaves what `off` is negative in.
template <class F>
double leaves(const Vector2d& from, const Vector2d& way, const F& off, double high = 500.0) {
  double low = 0.0;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (off(from + middle * way) < 0.0 ? low : high) = middle;
  }
  return low;
}

Vector2d point_at(const section::Curve& curve, double phi) {
  return curve.at(phi / kTwoPi * curve.girth()).point;
}

void expect_passed(const std::vector<Check>& checks, const std::string& what) {
  for (const auto& check : checks)
    EXPECT_LE(check.value, check.limit) << check.name << " of " << what;
}

TEST(CornerCutouts, AreThoseOfAnIndependentProgram) {
  const auto all = golden("cutouts.json");
  int made = 0, torches = 0;
  for (const auto& one : *at(all, "cutouts").as<Json::Array>()) {
    if (*at(one, "section/round").as<bool>()) continue;
    const auto section = golden_section(at(one, "section"));
    Spec spec{.id = text(one, "name"), .shape = Circle{20.0}};
    if (text(one, "shape/kind") == "circle") spec.shape = Circle{number(one, "shape/diameter_mm")};
    if (text(one, "shape/kind") == "slot")
      spec.shape = Slot{number(one, "shape/length_mm"), number(one, "shape/width_mm")};
    if (text(one, "shape/kind") == "rectangle")
      spec.shape = Rectangle{number(one, "shape/along_mm"), number(one, "shape/round_mm"),
                             number(one, "shape/corner_radius_mm")};
    spec.turn = number(one, "angle_deg") * kRadPerDeg;
    spec.at.z = number(one, "at/z_mm");
    spec.at.phi = share_of(section, number(one, "at/s_mm"));
    spec.tilt = bevel::Tilt::free;
    const auto kind = text(one, "wall");
    spec.wall = kind == "through"     ? Wall::through
                : kind == "developed" ? Wall::developed
                                      : Wall::normal;
    const section::Wall wall(section);
    const auto layout = lay({spec}, {.tube = {.wall = section.wall}, .section = wall});
    ASSERT_TRUE(layout) << spec.id << layout.error().issues.front().hint;
    const bool far = text(one, "side") == "far";
    const auto& instance = layout->instances[far ? 1 : 0];
    const auto& mould = layout->mould_of(instance);
    const auto* over = mould.laying.over();
    EXPECT_NEAR(mould.taken.outer_area / number(one, "area_outer"), 1.0, 1e-9) << spec.id;
    EXPECT_NEAR(mould.taken.inner_area / number(one, "area_inner"), 1.0, 1e-9) << spec.id;
    EXPECT_NEAR(mould.taken.volume / number(one, "volume"), 1.0, 1e-9) << spec.id;
    if (over == nullptr) continue;
    ++made;
    const auto& local = *at(one, "local").as<Json::Array>();
    for (std::size_t i = 0; i < local.size(); ++i)
      for (const bool outer : {true, false}) {
        const auto place = over->at(number(local[i], "1"));
        const auto& p = outer ? place.outer.point : place.bore.point;
        const auto& wanted = (*at(one, outer ? "outer" : "inner").as<Json::Array>())[i];
        EXPECT_NEAR(p.x(), number(wanted, "0"), 1e-9) << spec.id;
        EXPECT_NEAR(p.y(), number(wanted, "1"), 1e-9) << spec.id;
        EXPECT_NEAR(instance.z + number(local[i], "0"), number(wanted, "2"), 1e-9);
      }
    if (kind != "developed" || one.as<Json::Object>() == nullptr) continue;
    if (text(one, "name") != "box_hole_in_corner") continue;
    ++torches;
    const double kerf = number(one, "torch/kerf");
    const auto& edges = *at(one, "torch/edge_local").as<Json::Array>();
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const Flat edge(number(edges[i], "0"), number(edges[i], "1"));
      const Flat m = over->contact(edge.y(), edge.normalized(), kerf);
      const auto& axis = (*at(one, "torch/axis_local").as<Json::Array>())[i];
      EXPECT_NEAR(edge.x() - 0.5 * kerf * m.x(), number(axis, "0"), 1e-9);
      EXPECT_NEAR(over->axis(edge.y(), 0.5 * kerf * m.y()), number(axis, "1"), 1e-9);
    }
  }
  EXPECT_EQ(made, 7);
  EXPECT_EQ(torches, 1);
}

Spec drawn_cutout(Random& random, const section::Section& section) {
  Spec out{.id = "c", .shape = Circle{between(random, 10.0, 30.0)}};
  const double width = between(random, 10.0, 20.0);
  if (random() % 3 == 0) out.shape = Slot{width + between(random, 0.0, 30.0), width};
  if (random() % 3 == 0)
    out.shape = Rectangle{between(random, 10.0, 40.0), between(random, 10.0, 30.0), 2.0};
  out.turn = random() % 2 == 0 ? 0.0 : between(random, -3.0, 3.0);
  const auto outer = section.outer();
  const double corner = outer.on_corner(static_cast<int>(random() % 4) + 1, 0.25 * kPi);
  out.at.z = 200.0;
  out.at.phi = share_of(section, corner + (random() % 3 == 0 ? 0.0 : between(random, -25, 25)));
  out.tilt = random() % 2 == 0 ? bevel::Tilt::free : bevel::Tilt::axial;
  out.wall = static_cast<Wall>(random() % 3);
  return out;
}

/// Returns true if the rows lie on the prism and the surfaces, by distances.
void expect_on_prism(const section::Section& section, const Spec& spec, const Layout& layout,
                     const Instance& one) {
  const auto& mould = layout.mould_of(one);
  const auto rows = placed(layout, one);
  const auto anchor = section.outer().at(spec.at.phi / kTwoPi * section.outer().girth());
  const double side = mould.laying.far() ? -1.0 : 1.0;
  for (std::size_t i = 0; i < rows.phi.size(); ++i) {
    const auto p = point_at(section.outer(), rows.phi[i]);
    const auto q = point_at(section.bore(), rows.phi_inner[i]);
    EXPECT_NEAR(outside(section, p), 0.0, 1e-9);
    EXPECT_NEAR(in_bore(section, q), 0.0, 1e-9);
    const double b = (q - anchor.point).dot(anchor.tangent());
    EXPECT_LT(distance(mould.chain, {rows.z_inner[i] - one.z, b}), 1e-9);
    // The outermost place of its line.
    const Vector2d axis =
        b * anchor.tangent() + anchor.point.dot(anchor.tangent()) * anchor.tangent();
    const Vector2d way = side * anchor.normal;
    const Vector2d in = q - way * 1e-7;
    EXPECT_LT(
        (in + leaves(in, way, [&](const Vector2d& r) { return in_bore(section, r); }) * way - q)
            .norm(),
        2e-6);
    if (mould.laying.lay() == Lay::prism) {
      EXPECT_NEAR((p - anchor.point).dot(anchor.tangent()), b, 1e-9);
      const auto at = section.outer().at(rows.torch_phi[i] / kTwoPi * section.outer().girth());
      const Vector2d beam(std::cos(at.nu + rows.a[i]), std::sin(at.nu + rows.a[i]));
      EXPECT_LT((beam - way).norm(), 1e-9) << axis.norm();
    } else {
      const auto n = section.outer().at(rows.phi[i] / kTwoPi * section.outer().girth()).normal;
      EXPECT_LT(std::abs((p - q).x() * n.y() - (p - q).y() * n.x()), 1e-9);
    }
  }
}

TEST(CornerCutouts, LieOnTheTubeAndPassTheirOwnChecks) {
  Random random(11);
  int over = 0, tight = 0;
  for (int i = 0; i < 150; ++i) {
    const auto section = drawn_section(random);
    const auto spec = drawn_cutout(random, section);
    const auto part = plain_part(section, {spec});
    const auto made = part::section_part(part);
    if (!made) {
      ++tight;
      EXPECT_TRUE(made.error().code() == ErrorCode::open_profile ||
                  made.error().code() == ErrorCode::cutouts_cross ||
                  made.error().code() == ErrorCode::out_of_range ||
                  made.error().issues.front().member == "cutouts/0/wall")
          << made.error().issues.front().hint;
      continue;
    }
    std::string what = std::to_string(i) + " " + std::to_string(static_cast<int>(spec.wall)) +
                       (spec.tilt == bevel::Tilt::free ? " free" : " axial");
    expect_passed(part::verify(part, *made), what);
    for (const auto& one : made->cutouts.instances) {
      const auto& laying = made->cutouts.mould_of(one).laying;
      if (laying.over() == nullptr) continue;
      ++over;
      if (laying.lay() != Lay::developed) expect_on_prism(section, spec, made->cutouts, one);
    }
  }
  EXPECT_GT(over, 80);
  EXPECT_LT(tight, 60);
}

/// Seen along its anchor, a circle may reach to 1 um of the bore's side, where depth and way round
/// bend as a square root does.
TEST(CornerCutouts, ThatReachAlmostToTheBoresSidePassTheirOwnChecks) {
  const section::Section section{40, 60, 3, 6, 3};
  for (const double diameter : {12.0, 19.05, 30.0})
    for (const double room : {0.0011, 0.002, 0.005, 0.016, 0.05, 0.2})
      for (const double side : {1.0, -1.0})
        for (const auto tilt : {bevel::Tilt::free, bevel::Tilt::axial}) {
          Spec spec{.id = "c", .shape = Circle{diameter}};
          spec.at = {.z = 300.0, .face = 1};
          spec.at.offset = side * (0.5 * 60.0 - 3.0 - 0.5 * diameter - room);
          spec.tilt = tilt;
          const auto part = plain_part(section, {spec});
          const auto made = part::section_part(part);
          ASSERT_TRUE(made) << made.error().issues.front().hint;
          expect_passed(part::verify(part, *made),
                        std::to_string(diameter) + " with " + std::to_string(room));
        }
}

/// A bolt through a corner meets the far wall at an angle, unless that is the opposite corner.
TEST(CornerCutouts, ThroughAWallThatLeansTheToolIsRefusedWithItsLack) {
  const section::Section square{80, 80, 4, 8, 4}, flat{100, 50, 4, 8, 4};
  Spec bolt{.id = "c", .shape = Circle{6.0}};
  bolt.at.z = 200.0;
  bolt.tilt = bevel::Tilt::axial;
  bolt.wall = Wall::through;
  const auto refused = [&](const section::Section& section, const Spec& spec) {
    auto asked = spec;
    asked.at.phi = share_of(section, section.outer().on_corner(1, 0.25 * kPi));
    return part::section_part(plain_part(section, {asked}));
  };
  EXPECT_TRUE(refused(square, bolt));
  const auto error = refused(flat, bolt);
  ASSERT_FALSE(error);
  const auto& issue = error.error().issues.front();
  EXPECT_EQ(issue.code, ErrorCode::unsupported_combination);
  EXPECT_EQ(issue.member, "cutouts/0/wall");
  // The flat leans by 45 deg: the tool moves along it by the wall's thickness.
  EXPECT_NEAR(std::get<double>(issue.got), 4.0, 1e-6);
  for (const auto wall : {Wall::normal, Wall::developed}) {
    auto other = bolt;
    other.wall = wall;
    EXPECT_TRUE(refused(flat, other));
  }
  bolt.tilt = bevel::Tilt::free;
  EXPECT_TRUE(refused(flat, bolt));
}

/// On the crown of an upright flat oval, where s begins anew, a cut-out is that of the other crown.
TEST(CornerCutouts, OnTheCrownOfAnOvalAreThoseOfTheOtherCrown) {
  Random random(14);
  for (const double height : {60.0, 80.0, 120.0}) {
    const section::Section oval{height, 40.0, 3.0, 20.0, 17.0};
    for (int k = 0; k < 12; ++k) {
      auto spec = drawn_cutout(random, oval);
      spec.shape = k % 2 == 0 ? Shape{Circle{between(random, 6.0, 12.0)}} : Shape{Slot{14.0, 6.0}};
      const double off = between(random, -6.0, 6.0);
      std::vector<double> volumes;
      for (const int face : {1, 3}) {
        spec.at.phi = share_of(oval, oval.outer().on_face(face, off));
        const auto asked = plain_part(oval, {spec});
        const auto made = part::section_part(asked);
        if (!made) break;
        expect_passed(part::verify(asked, *made), std::to_string(k));
        volumes.push_back(made->cutouts.moulds.front().taken.volume);
      }
      if (volumes.empty()) continue;
      ASSERT_EQ(volumes.size(), 2U);
      EXPECT_NEAR(volumes[0], volumes[1], 1e-9 * volumes[0]) << k;
    }
  }
}

/// The metal on a line from the bore at b, by distances alone, times how much b moves it.
double depth_at(const section::Section& s, const section::Station& anchor, Wall wall, bool free,
                double b) {
  const auto metal = [&](const Vector2d& from, const Vector2d& way) {
    return leaves(from, way, [&](const Vector2d& p) { return outside(s, p); }) -
           leaves(from, way, [&](const Vector2d& p) { return in_bore(s, p); });
  };
  if (wall != Wall::developed && free) {
    const auto t = anchor.tangent();
    return metal((anchor.point.dot(t) + b) * t, anchor.normal);
  }
  // Square to the outside: the wall's line sweeps less deeper in.
  const auto curve = s.outer();
  const auto at = curve.at(anchor.s + b);
  const double thick = leaves(
      at.point, -at.normal, [&](const Vector2d& p) { return -in_bore(s, p); }, 2.0 * s.wall);
  return thick - 0.5 * at.curvature * thick * thick;
}

TEST(CornerCutouts, TakeTheMetalOfTheirLines) {
  Random random(12);
  int seen = 0;
  for (int i = 0; i < 120 && seen < 40; ++i) {
    const auto section = drawn_section(random);
    auto spec = drawn_cutout(random, section);
    if (spec.wall == Wall::through) spec.wall = Wall::normal;
    const bool free = spec.tilt == bevel::Tilt::free;
    if (spec.wall == Wall::normal && !free) continue;
    const auto layout =
        lay({spec}, {.tube = {.wall = section.wall}, .section = section::Wall(section)});
    if (!layout || layout->moulds.front().laying.over() == nullptr) continue;
    ++seen;
    const auto anchor = section.outer().at(spec.at.phi / kTwoPi * section.outer().girth());
    const auto chain = chain_of(spec).value();
    const auto box = bounds(turned(chain, -0.5 * kPi));  // a along -b
    constexpr int kStrips = 4000;
    const double step = (box.most.x() - box.least.x()) / kStrips;
    double volume = 0.0;
    for (int k = 0; k < kStrips; ++k) {
      const double x = box.least.x() + (k + 0.5) * step;
      double wide = 0.0;
      for (const auto& [from, to] : stretches(turned(chain, -0.5 * kPi), x)) wide += to - from;
      volume += wide * step * depth_at(section, anchor, spec.wall, free, x);
    }
    EXPECT_NEAR(layout->moulds.front().taken.volume / volume, 1.0, 3e-4) << i;
  }
  EXPECT_EQ(seen, 40);
}

/// A square tube with corners of half its side is round.
TEST(CornerCutouts, WithCornersOfHalfTheSideAreThoseOfARoundTube) {
  const section::Section section{100.0, 100.0, 5.0, 50.0, 45.0};
  for (const auto wall : {Wall::developed, Wall::normal, Wall::through})
    for (const auto tilt : {bevel::Tilt::free, bevel::Tilt::axial}) {
      Spec spec{.id = "a", .shape = Slot{40.0, 18.0}, .turn = 0.4};
      spec.at.z = 100.0;
      spec.at.phi = 0.8;
      spec.wall = wall;
      spec.tilt = tilt;
      Ground ground{.tube = {.outer_radius = 50.0, .wall = 5.0}, .kerf = 1.0};
      const auto round = lay({spec}, ground).value();
      ground.section = section::Wall(section);
      const auto made = lay({spec}, ground).value();
      ASSERT_EQ(made.moulds.size(), round.moulds.size());
      for (std::size_t i = 0; i < made.instances.size(); ++i) {
        const auto& one = made.mould_of(made.instances[i]);
        const auto& other = round.mould_of(round.instances[i]);
        ASSERT_NE(one.laying.over(), nullptr);
        EXPECT_NEAR(one.taken.outer_area / other.taken.outer_area, 1.0, 1e-11);
        EXPECT_NEAR(one.taken.inner_area / other.taken.inner_area, 1.0, 1e-11);
        EXPECT_NEAR(one.taken.volume / other.taken.volume, 1.0, 1e-11);
        const auto rows = placed(made, made.instances[i]);
        const auto there = placed(round, round.instances[i]);
        // Each of the one's rows lies on the line of the other's edge and torch.
        for (std::size_t row = 0; row < there.phi.size(); ++row) {
          double nearest = 1.0, torch = 1.0;
          for (std::size_t k = 0; k < rows.phi.size(); ++k) {
            const double dz = rows.z[k] - there.z[row];
            nearest = std::min(
                nearest,
                std::hypot(50.0 * std::remainder(rows.phi[k] - there.phi[row], kTwoPi), dz));
            torch = std::min(
                torch,
                std::hypot(50.0 * std::remainder(rows.torch_phi[k] - there.torch_phi[row], kTwoPi),
                           rows.torch_z[k] - there.torch_z[row]));
          }
          EXPECT_LT(nearest, 1e-9);
          EXPECT_LT(torch, 1e-9);
        }
      }
    }
}

double volume_of(const section::Section& section, const Spec& spec) {
  const auto made = lay(
      {spec},
      {.tube = {.wall = section.wall}, .section = section::Wall(section), .finish_work = 1000.0});
  double out = 0.0;
  for (const auto& one : made.value().instances) out += made->mould_of(one).taken.volume;
  return out;
}

TEST(CornerCutouts, AreTheSameWhereThePartIsTurnedMirroredOrScaled) {
  const section::Section section{80.0, 80.0, 4.0, 6.0, 4.0};
  const double girth = section.outer().girth();
  for (const auto wall : {Wall::developed, Wall::normal, Wall::through})
    for (const auto tilt : {bevel::Tilt::free, bevel::Tilt::axial}) {
      // The far wall would block the tool.
      if (wall == Wall::through && tilt == bevel::Tilt::axial) continue;
      Spec spec{.id = "a", .shape = Slot{30.0, 14.0}, .turn = 0.7};
      spec.at.z = 100.0;
      spec.at.phi = share_of(section, 36.0);
      spec.wall = wall;
      spec.tilt = tilt;
      const double volume = volume_of(section, spec);
      auto other = spec;
      for (int quarter = 1; quarter < 4; ++quarter) {
        other.at.phi = share_of(section, 36.0 + quarter * 0.25 * girth);
        EXPECT_NEAR(volume_of(section, other) / volume, 1.0, 1e-12);
      }
      other = spec;
      other.at.opposite = true;
      EXPECT_NEAR(volume_of(section, other) / volume, 1.0, 1e-12);
      other = spec;
      other.at.phi = share_of(section, girth - 36.0);
      other.turn = -spec.turn;
      EXPECT_NEAR(volume_of(section, other) / volume, 1.0, 1e-12);
      other = spec;
      other.at.from = Anchor::From::finish;
      EXPECT_NEAR(volume_of(section, other) / volume, 1.0, 1e-12);
      other = spec;
      other.shape = Slot{60.0, 28.0};
      other.at.phi = spec.at.phi;
      const section::Section twice{160.0, 160.0, 8.0, 12.0, 8.0};
      EXPECT_NEAR(volume_of(twice, other) / volume, 8.0, 1e-10);
    }
}

TEST(CornerCutouts, WithoutAKerfHaveTheTorchOnTheEdge) {
  const section::Section section{80.0, 60.0, 4.0, 8.0, 4.0};
  for (const auto wall : {Wall::developed, Wall::normal})
    for (const double kerf : {0.0, 1e-6}) {
      Spec spec{.id = "a", .shape = Circle{24.0}};
      spec.at.phi = share_of(section, section.outer().on_corner(1, 0.25 * kPi) + 2.0);
      spec.wall = wall;
      const auto made =
          lay({spec},
              {.tube = {.wall = section.wall}, .section = section::Wall(section), .kerf = kerf});
      const auto& rows = made.value().moulds.front().rows;
      const double radius = section.outer().girth() / kTwoPi;
      for (std::size_t i = 0; i < rows.phi.size(); ++i) {
        EXPECT_NEAR(radius * rows.phi[i], radius * rows.torch_phi[i], 10.0 * kerf + 1e-12);
        EXPECT_NEAR(rows.z[i], rows.torch_z[i], 10.0 * kerf + 1e-12);
      }
    }
}

TEST(CornerCutouts, AreRefusedWithTheirLimit) {
  const section::Section section{80.0, 60.0, 4.0, 6.0, 4.0};
  const auto error_of = [&](const Spec& spec, double kerf) {
    const auto made = lay(
        {spec}, {.tube = {.wall = section.wall}, .section = section::Wall(section), .kerf = kerf});
    return made ? Issue{.member = "none"} : made.error().issues.front();
  };
  Spec spec{.id = "a", .shape = Circle{30.0}};
  spec.at.face = 1;
  spec.at.offset = 14.0;
  EXPECT_EQ(error_of(spec, 0.3).code, ErrorCode::open_profile);
  const auto limit = std::get<double>(error_of(spec, 0.3).limit);
  EXPECT_NEAR(limit, 26.0 - 14.0 - 1e-3, 1.1e-3);
  spec.shape = Circle{2.0 * limit};
  EXPECT_EQ(error_of(spec, 0.3).member, "none");
  spec.wall = Wall::developed;
  // The beam is wider next to the bore of so tight a corner.
  EXPECT_EQ(error_of(spec, 1.5).member, "cutouts/0/shape/diameter");
  EXPECT_EQ(error_of(spec, 4.1).member, "cutouts/0/shape");
  EXPECT_EQ(std::get<double>(error_of(spec, 4.1).limit), 4.0);
  spec.wall = Wall::normal;
  spec.countersink = Countersink{30.0, 0.5 * kPi};
  EXPECT_EQ(error_of(spec, 0.3).code, ErrorCode::out_of_range);
}

}  // namespace
}  // namespace tubecut::testing::corners
