#include "core/cutout/cutout.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "core/cutout/rows.hpp"
#include "core/math/cylinder.hpp"
#include "tests/support/golden.hpp"

namespace tubecut::testing {
namespace {

using namespace cutout;
using api::Json;

double value(const Json& of, const char* path) { return number(of, path); }
Flat place(const Json& pair, std::size_t first = 0) {
  const auto& all = *pair.as<Json::Array>();
  return {number(all[first]), number(all[first + 1])};
}

Contour contour_of(const Json& shape) {
  Contour out{.start = place(at(shape, "start")), .pieces = {}, .mirrored = true};
  for (const auto& piece : *at(shape, "pieces").as<Json::Array>()) {
    DrawnSegment one{.to = place(piece, 1)};
    if (text(piece, "0") == "arc") {
      one.centre = place(piece, 4);
      one.clockwise = text(piece, "6") == "b to a";
    }
    out.pieces.push_back(one);
  }
  return out;
}

Shape shape_of(const Json& shape) {
  const auto kind = text(shape, "kind");
  if (kind == "circle") return Circle{value(shape, "diameter_mm")};
  if (kind == "slot") return Slot{value(shape, "length_mm"), value(shape, "width_mm")};
  if (kind == "contour") return contour_of(shape);
  return Rectangle{value(shape, "along_mm"), value(shape, "round_mm"),
                   value(shape, "corner_radius_mm")};
}

/// A golden cut-out of a round tube, with a torch that leans across.
struct Golden {
  explicit Golden(const Json& of) : json(of) {
    tube = {.outer_radius = 0.5 * value(of, "section/H"), .wall = value(of, "section/t")};
    spec.id = text(of, "name");
    spec.shape = shape_of(at(of, "shape"));
    spec.turn = value(of, "angle_deg") * kRadPerDeg;
    spec.at = {.z = value(of, "at/z_mm"), .phi = value(of, "at/nu_deg") * kRadPerDeg};
    const auto name = text(of, "wall");
    spec.wall = name == "developed" ? Wall::developed
                : name == "normal"  ? Wall::normal
                                    : Wall::through;
    spec.tilt = bevel::Tilt::free;
    far = text(of, "side") == "far";
  }
  const Json& json;
  joint::Target tube;
  Spec spec;
  bool far = false;
};

std::vector<Golden> round_cases(const Json& all) {
  std::vector<Golden> out;
  for (const auto& one : *at(all, "cutouts").as<Json::Array>())
    if (*at(one, "section/round").as<bool>()) out.emplace_back(one);
  return out;
}

double off(const Json& points, std::size_t i, const Eigen::Vector3d& p) {
  const auto& row = (*points.as<Json::Array>())[i];
  return (p - Eigen::Vector3d(number(row, "0"), number(row, "1"), number(row, "2"))).norm();
}

TEST(Cutout, PointsAreasAndVolumesAreThoseOfAnIndependentProgram) {
  const auto all = golden("cutouts.json");
  const auto cases = round_cases(all);
  ASSERT_EQ(cases.size(), 11u);
  for (const auto& one : cases) {
    const auto layout = lay({one.spec}, {.tube = one.tube});
    ASSERT_TRUE(layout) << one.spec.id;
    const auto& instance = layout->instances[one.far ? 1 : 0];
    const auto& mould = layout->mould_of(instance);
    const auto& local = *at(one.json, "local").as<Json::Array>();
    for (std::size_t i = 0; i < local.size(); ++i) {
      const auto p = place(local[i]);
      EXPECT_LT(distance(mould.chain, p), 1e-9);
      for (const bool outer : {true, false}) {
        const double rho = outer ? one.tube.outer_radius : one.tube.inner_radius();
        const auto at_wall = math::cylinder_point(
            rho, instance.phi + mould.laying.phase(mould.laying.turn(p.y(), rho)),
            instance.z + p.x());
        EXPECT_LT(off(at(one.json, outer ? "outer" : "inner"), i, at_wall), 1e-9) << one.spec.id;
      }
    }
    EXPECT_NEAR(mould.taken.outer_area / value(one.json, "area_outer"), 1.0, 1e-9);
    EXPECT_NEAR(mould.taken.inner_area / value(one.json, "area_inner"), 1.0, 1e-9);
    EXPECT_NEAR(mould.taken.volume / value(one.json, "volume"), 1.0, 1e-9);
  }
}

TEST(Cutout, TheTorchRunsWhereTheIndependentProgramPutsIt) {
  const auto all = golden("cutouts.json");
  int places = 0;
  for (const auto& one : round_cases(all)) {
    if (one.json.find("torch") == nullptr) continue;
    const Laying laying(one.tube, lay_of(one.spec.wall, one.spec.tilt), one.far);
    const auto chain = chain_of(one.spec).value();
    const double kerf = value(one.json, "torch/kerf");
    const auto& edges = *at(one.json, "torch/edge_local").as<Json::Array>();
    const auto& axes = *at(one.json, "torch/axis_local").as<Json::Array>();
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const auto edge = place(edges[i]);
      double nearest = 1e9, apart = 1e9;
      for (const auto& s : chain) {  // the share by Newton from the nearest of many
        double share = 0.0;
        for (int k = 0; k <= 1000; ++k)
          if ((s.at(k / 1000.0) - edge).norm() < (s.at(share) - edge).norm()) share = k / 1000.0;
        for (int k = 0; k < 8; ++k)
          share =
              std::clamp(share - (s.at(share) - edge).dot(s.along(share)) / s.length(), 0.0, 1.0);
        if ((s.at(share) - edge).norm() > nearest) continue;
        nearest = (s.at(share) - edge).norm();
        const auto along = s.along(share);
        const Flat axis = s.at(share) + kerf_offset(laying, kerf, {along.y(), -along.x()});
        apart = (axis - place(axes[i])).norm();
      }
      EXPECT_LT(apart, 1e-9) << one.spec.id;
      ++places;
    }
  }
  EXPECT_GT(places, 80);
}

TEST(Cutout, PatternsNameAndPlaceEveryOneAsTheIndependentProgramDoes) {
  const auto all = golden("cutouts.json");
  const joint::Target tube{.outer_radius = 44.45, .wall = 5.0};
  const auto check = [&](const Json& of, const Pattern& pattern) {
    const Spec spec{.id = "p",
                    .shape = Circle{5.0},
                    .at = {.z = value(of, "at/z_mm"), .phi = value(of, "at/phi_deg") * kRadPerDeg},
                    .wall = Wall::developed,
                    .pattern = pattern};
    const auto layout = lay({spec}, {.tube = tube});
    ASSERT_TRUE(layout);
    const auto& anchors = *at(of, "anchors").as<Json::Array>();
    ASSERT_EQ(layout->instances.size(), anchors.size());
    for (std::size_t i = 0; i < anchors.size(); ++i) {
      EXPECT_EQ(layout->instances[i].name, text(anchors[i], "0"));
      EXPECT_NEAR(layout->instances[i].z, number(anchors[i], "1"), 1e-9);
      EXPECT_NEAR(layout->instances[i].phi * tube.outer_radius, number(anchors[i], "2"), 1e-9);
    }
  };
  const auto& patterns = *at(all, "patterns").as<Json::Array>();
  check(patterns[0], Linear{.count = 5, .pitch = 30.0});
  check(patterns[1], Round{.count = 6, .turn = kTwoPi / 6.0});
  check(patterns[2], Grid{.along = 4,
                          .round = 6,
                          .pitch = 20.0,
                          .turn = kTwoPi / 6.0,
                          .stagger = Grid::Stagger::along,
                          .offset = 10.0});
}

TEST(Cutout, ACircleStraightThroughTakesWhatEllipticIntegralsState) {
  for (const double radius : {10.0, 44.45, 300.0})
    for (const double share : {0.02, 0.3, 0.7, 0.95}) {
      const joint::Target tube{.outer_radius = radius, .wall = 0.1 * radius};
      const double d = 2.0 * share * tube.inner_radius();
      const Laying laying(tube, Lay::prism, false);
      const auto took = taken(laying, circle(d));
      const auto area = [&](double rho) {
        const double m = d * d / (4.0 * rho * rho), k = std::sqrt(m);
        return 4.0 * rho * rho * (std::comp_ellint_2(k) - (1.0 - m) * std::comp_ellint_1(k));
      };
      const auto under = [&](double rho) {
        const double m = d * d / (4.0 * rho * rho), k = std::sqrt(m);
        return 4.0 / 3.0 * rho * rho * rho *
               ((1.0 + m) * std::comp_ellint_2(k) - (1.0 - m) * std::comp_ellint_1(k));
      };
      EXPECT_NEAR(took.outer_area / area(radius), 1.0, 1e-10);
      EXPECT_NEAR(took.inner_area / area(tube.inner_radius()), 1.0, 1e-10);
      EXPECT_NEAR(took.volume / (under(radius) - under(tube.inner_radius())), 1.0, 1e-8);
    }
}

TEST(Cutout, RemovesFromTheSectionWhatTheIndependentProgramFinds) {
  const auto all = golden("cutouts.json");
  for (const auto& net : *at(all, "net_sections").as<Json::Array>()) {
    const joint::Target tube{.outer_radius = 0.5 * value(net, "section/H"),
                             .wall = value(net, "section/t")};
    const auto lay = text(net, "name") == "net_normal" ? Lay::prism : Lay::developed;
    const auto chain = circle(value(net, "diameter"));
    const auto z = numbers(net, "z"), expected = numbers(net, "removed");
    for (std::size_t i = 0; i < z.size(); ++i)
      EXPECT_NEAR(removed({tube, lay, false}, chain, z[i] - value(net, "z_centre")), expected[i],
                  1e-7);
  }
}

/// Random shapes on random tubes, as a drawing and as themselves.
class RandomCutouts : public ::testing::Test {
 protected:
  double between(double low, double high) {
    return std::uniform_real_distribution(low, high)(random_);
  }
  joint::Target tube() {
    const double radius = between(15.0, 120.0);
    return {.outer_radius = radius, .wall = between(0.03, 0.25) * radius};
  }
  Spec spec(const joint::Target& tube) {
    const double most = 1.2 * tube.inner_radius();
    Spec out{.id = "p"};
    const double width = between(0.1, 0.5) * most;
    switch (std::uniform_int_distribution(0, 2)(random_)) {
      case 0:
        out.shape = Circle{width};
        break;
      case 1:
        out.shape = Slot{width + between(0.0, 0.4) * most, width};
        break;
      default:
        out.shape = Rectangle{between(0.1, 0.8) * most, width, between(0.02, 0.05) * most};
    }
    out.turn = between(-kPi, kPi);
    out.at = {.z = between(-50.0, 500.0), .phi = between(0.0, kTwoPi)};
    out.wall = static_cast<Wall>(std::uniform_int_distribution(0, 2)(random_));
    out.tilt = between(0.0, 1.0) < 0.5 ? bevel::Tilt::free : bevel::Tilt::axial;
    return out;
  }

  std::mt19937_64 random_{20261127};
};

TEST_F(RandomCutouts, AreProvedByTheirPointsInSpace) {
  int laid = 0;
  for (int i = 0; i < 150; ++i) {
    const auto tube = this->tube();
    const Ground ground{.tube = tube, .kerf = between(0.1, 0.03 * tube.outer_radius)};
    const auto layout = lay({spec(tube)}, ground);
    if (!layout) continue;
    ++laid;
    for (const auto& check : verify(*layout, ground))
      EXPECT_TRUE(check.passed()) << check.name << " " << check.value << " at " << i;
  }
  EXPECT_GT(laid, 100);
}

/// Prisms that reach nearly to the bore's width, where the way round bends like a square root, and
/// developed windows over half the girth, whose opposite edges face each other through the tube.
TEST_F(RandomCutouts, AreProvedUpToTheBoreAndOverHalfTheGirth) {
  int laid = 0;
  for (int i = 0; i < 160; ++i) {
    const auto tube = this->tube();
    const Ground ground{.tube = tube, .kerf = between(0.002, 0.01) * tube.outer_radius};
    Spec asked{.id = "p"};
    asked.as_cut = true;
    asked.turn = i % 4 == 0 ? 0.0 : between(-kPi, kPi);
    asked.wall = i % 2 == 0 ? Wall::developed : i % 3 == 0 ? Wall::through : Wall::normal;
    asked.tilt = between(0.0, 1.0) < 0.5 ? bevel::Tilt::free : bevel::Tilt::axial;
    if (asked.wall == Wall::developed) {
      const double most = 1.8 * tube.outer_radius;
      asked.shape = Rectangle{between(0.5, 1.0) * most, between(0.5, 1.0) * most,
                              between(0.02, 0.1) * tube.outer_radius};
    } else {
      const double ratio = between(0.1, 1.0), corner = between(0.01, 0.04);
      const auto box = bounds(turned(rectangle(1.0, ratio, corner * ratio), asked.turn));
      const double size =
          (1.0 - std::pow(10.0, between(-3.5, -1.0))) * tube.inner_radius() / box.most.y();
      asked.shape = Rectangle{size, ratio * size, corner * ratio * size};
    }
    const auto layout = lay({asked}, ground);
    if (!layout) continue;
    ++laid;
    for (const auto& check : verify(*layout, ground))
      EXPECT_TRUE(check.passed()) << check.name << " " << check.value << " at " << i;
  }
  EXPECT_GT(laid, 120);
}

TEST_F(RandomCutouts, GrowAsTheTubeGrows) {
  for (int i = 0; i < 60; ++i) {
    const auto tube = this->tube();
    auto one = spec(tube);
    const auto first = lay({one}, {.tube = tube});
    if (!first) continue;
    constexpr double kScale = 2.5;
    struct Grown {
      Shape operator()(const Circle& c) const { return Circle{kScale * c.diameter}; }
      Shape operator()(const Slot& s) const { return Slot{kScale * s.length, kScale * s.width}; }
      Shape operator()(const Rectangle& r) const {
        return Rectangle{kScale * r.along, kScale * r.round, kScale * r.radius};
      }
      Shape operator()(const Contour& c) const { return c; }
      Shape operator()(const Slit& s) const {
        return Slit{kScale * s.length, kScale * s.width, s.pierce};
      }
    };
    one.shape = std::visit(Grown{}, one.shape);
    const auto second = lay(
        {one}, {.tube = {.outer_radius = kScale * tube.outer_radius, .wall = kScale * tube.wall}});
    ASSERT_TRUE(second);
    EXPECT_NEAR(second->moulds[0].taken.volume / first->moulds[0].taken.volume,
                kScale * kScale * kScale, 1e-8);
  }
}

TEST_F(RandomCutouts, DevelopedTakesLessThanFlatAndStraightTakesMore) {
  for (int i = 0; i < 60; ++i) {
    const auto tube = this->tube();
    const auto chain = chain_of(spec(tube)).value();
    const double flat = area(chain) * tube.wall;
    if (bounds(chain).most.y() >= tube.inner_radius()) continue;
    EXPECT_LT(taken({tube, Lay::developed, false}, chain).volume, flat);
    EXPECT_GT(taken({tube, Lay::prism, false}, chain).volume, flat);
    EXPECT_NEAR(taken({tube, Lay::prism, false}, chain).volume /
                    taken({tube, Lay::prism, true}, chain).volume,
                1.0, 1e-12);
  }
}

TEST(Cutout, ADrawingIsTheSameHoweverItIsBegunAndTurned) {
  const std::vector<DrawnSegment> forth{
      {.to = {20, 0}}, {.to = {20, 10}}, {.to = {0, 10}}, {.to = {0, 0}}};
  const std::vector<DrawnSegment> back{
      {.to = {0, 10}}, {.to = {20, 10}}, {.to = {20, 0}}, {.to = {0, 0}}};
  const std::vector<DrawnSegment> split{{.to = {20, 5}}, {.to = {20, 10}}, {.to = {0, 10}},
                                        {.to = {0, 0}},  {.to = {5, 0}},   {.to = {20, 0}}};
  const Laying laying({.outer_radius = 30.0, .wall = 4.0}, Lay::prism, false);
  const auto volume = [&](const Flat& start, const std::vector<DrawnSegment>& pieces,
                          bool mirrored) {
    return taken(laying, drawn(start, pieces, mirrored).value()).volume;
  };
  const double expected = volume({0, 0}, forth, false);
  EXPECT_NEAR(volume({0, 0}, back, false), expected, 1e-9);
  EXPECT_NEAR(volume({20, 0}, split, false), expected, 1e-9);
  EXPECT_NEAR(volume({0, 0}, forth, true), expected, 1e-9);
}

TEST(Cutout, WithoutAKerfTheTorchRunsOnTheEdge) {
  for (const auto lay : {Lay::developed, Lay::prism, Lay::bored}) {
    const Laying laying({.outer_radius = 30.0, .wall = 4.0}, lay, false);
    const auto made = rows(laying, rectangle(20.0, 15.0, 2.0), {}).value();
    for (std::size_t i = 0; i < made.phi.size(); ++i) {
      EXPECT_NEAR(made.phi[i], made.torch_phi[i], 1e-12);
      EXPECT_NEAR(made.z[i], made.torch_z[i], 1e-12);
    }
  }
}

TEST(Cutout, CornersAsCutKeepTheBeamOutOfThePart) {
  for (const auto tilt : {bevel::Tilt::free, bevel::Tilt::axial})
    for (const auto wall : {Wall::normal, Wall::developed}) {
      const Spec spec{.id = "p",
                      .shape = Rectangle{20.0, 15.0, 0.2},
                      .as_cut = true,
                      .at = {.z = 50.0},
                      .wall = wall,
                      .tilt = tilt};
      const Ground ground{.tube = {.outer_radius = 30.0, .wall = 4.0}, .kerf = 1.5};
      const auto layout = lay({spec}, ground);
      ASSERT_TRUE(layout);
      for (const auto& check : verify(*layout, ground))
        EXPECT_TRUE(check.passed()) << check.name << " " << check.value;
    }
}

TEST(Cutout, SeveralMistakesAreReportedAtOnce) {
  const std::vector<Spec> specs{
      {.id = "a", .shape = Circle{1.0}, .wall = Wall::developed},
      {.id = "b", .shape = Slot{10.0, 12.0}, .wall = Wall::developed},
      {.id = "c", .shape = Circle{79.0}, .wall = Wall::normal, .tilt = bevel::Tilt::free},
      {.id = "d", .shape = Circle{10.0}, .pattern = Round{.count = 7, .turn = kPi / 3.0}}};
  const auto made = lay(specs, {.tube = {.outer_radius = 44.45, .wall = 5.0}, .kerf = 1.5});
  ASSERT_FALSE(made);
  const auto& issues = made.error().issues;
  ASSERT_EQ(issues.size(), 4u);
  EXPECT_EQ(issues[0].member, "cutouts/0/shape/diameter");
  EXPECT_NEAR(std::get<double>(issues[0].limit), 1.90432370956, 1e-9);
  EXPECT_EQ(issues[1].member, "cutouts/1/shape/length");
  EXPECT_EQ(issues[2].code, ErrorCode::open_profile);
  EXPECT_EQ(issues[3].member, "cutouts/3/pattern/count");
  EXPECT_EQ(std::get<double>(issues[3].limit), 6.0);
}

}  // namespace
}  // namespace tubecut::testing
