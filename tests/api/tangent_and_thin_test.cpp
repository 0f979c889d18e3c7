#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>
#include <random>

#include "tests/support/call.hpp"

// Partners whose side touches the root's circle within rounding, thin plates and thick walls:
// answered, or refused with a reason, but never withheld.
namespace tubecut::testing {
namespace {

using api::Json;

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : engine_(seed) {}
  double any(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  template <class T, std::size_t N>
  T of(const std::array<T, N>& all) {
    return all[std::uniform_int_distribution<std::size_t>(0, N - 1)(engine_)];
  }
  double sign() { return of(std::array{1.0, -1.0}); }

 private:
  std::mt19937_64 engine_;
};

Json field(std::string_view file) {
  return *api::parse(read_project_file("tests/field/" + std::string(file)));
}

Json triple(double x, double y, double z) { return Json{Json::Array{x, y, z}}; }

Json target(double diameter, double wall) {
  return Json{Json::Object{{"outer_diameter_mm", diameter}, {"wall_mm", wall}}};
}

Json plane(double z, double lean_x = 0.0, double lean_y = 0.0) {
  return Json{Json::Object{
      {"kind", "plane"}, {"point_mm", triple(0, 0, z)}, {"normal", triple(lean_x, lean_y, 1)}}};
}

/// How an end is cut.
Json::Object cut(Draw& draw) {
  const bool inner = draw.of(std::array{true, false});
  const auto* rule = draw.of(std::array{"half_dihedral", "none", "fixed", "square"});
  Json::Object groove{{"rule", rule}};
  if (std::string_view(rule) == "fixed") groove.emplace_back("angle_deg", 30.0);
  Json::Object smoothing{{"method", draw.of(std::array{"none", "envelope"})}};
  if (text(Json{smoothing}, "method") == "envelope")
    smoothing.emplace_back("limits", Json{Json::Object{{"max_slope_deg_per_mm", 2.0},
                                                       {"max_curvature_deg_per_mm2", 0.5}}});
  return {{"root_surface", inner ? "inner" : "outer"},
          {"contact", inner ? draw.of(std::array{"none", "inner", "auto"}) : "none"},
          {"groove", Json{std::move(groove)}},
          {"smoothing", Json{std::move(smoothing)}}};
}

Json table(const Json& target, const Json::Array& cutters, Json::Object how) {
  Json::Object out{{"target", target},
                   {"cutters", Json{cutters}},
                   {"kerf_mm", 1.0},
                   {"sampling", Json{Json::Object{{"uniform_points", 72.0}}}}};
  for (auto& one : how) out.push_back(std::move(one));
  return Json{std::move(out)};
}

Json curves(const Json& target, const Json::Array& cutters) {
  return Json{Json::Object{{"target", target}, {"cutters", Json{cutters}}}};
}

/// Counts of outcomes; no answer may be withheld.
struct Answers {
  std::map<std::string, int> count;

  bool good(std::string_view path, const Json& request) {
    const auto answer = post(path, request);
    const auto code = answer.outcome.error ? text(answer.body, "errors/0/code") : "good";
    ++count[code];
    const bool withheld = code == "verification_failed" || code == "internal_error";
    EXPECT_FALSE(withheld) << answer.outcome.body.substr(0, 400) << '\n' << api::dump(request);
    return code == "good";
  }
  ~Answers() {
    for (const auto& [code, times] : count) std::printf("%d %s\n", times, code.c_str());
  }
};

TEST(Tangent, APartnerThatTouchesTheRootsCircleIsCut) {
  const auto request = field("tangent-partner-500.bevel-table.json");
  for (const double apart : {1e-13, 1e-12, 1e-11, 1e-10, 1e-9, 1e-8, 1e-7, 5e-7, 1e-6, 0.0}) {
    const auto answer = post("/v1/bevel-tables", with(request, "cutters/0/offset_mm", 70 - apart));
    EXPECT_FALSE(answer.outcome.error) << apart << answer.outcome.body.substr(0, 400);
  }
}

/// A distance that is rounding or nearly so.
double hair(Draw& draw) {
  return draw.sign() * draw.of(std::array{0.0, 1.0, 1.0, 1.0}) *
         std::pow(10.0, draw.any(-13.0, -5.5));
}

/// Its side as far from the target's axis as one of the target's surfaces, but for a hair.
Json tangent(Draw& draw, double rho, double hair) {
  const double lean = draw.of(std::array{90.0, 90.0, 60.0, draw.any(30, 150)});
  const double turn = draw.of(std::array{0.0, 90.0, 180.0, draw.any(0, 360)});
  const double half = draw.any(1.0, 3.0) * rho;
  const double offset = draw.sign() * (half - rho - hair);
  if (draw.of(std::array{true, false}))
    return Json{Json::Object{{"kind", "tube"},
                             {"outer_diameter_mm", 2 * half},
                             {"inclination_deg", lean},
                             {"clocking_deg", turn},
                             {"offset_mm", offset}}};
  const double a = lean * std::numbers::pi / 180, b = turn * std::numbers::pi / 180;
  return Json{Json::Object{
      {"kind", "rectangular_tube"},
      {"width_mm", 2 * half},
      {"height_mm", draw.any(60, 200)},
      {"corner_radius_mm", draw.of(std::array{0.5, 2.0, 8.0})},
      {"axis",
       Json{Json::Object{{"point_mm", triple(-offset * std::cos(b), -offset * std::sin(b), 0)},
                         {"direction", triple(std::sin(a) * std::sin(b), -std::sin(a) * std::cos(b),
                                              std::cos(a))}}}},
      {"up", triple(0, 0, 1)}}};
}

/// An elbow whose side is as far from the target's axis as one of the target's surfaces, but for a
/// hair: where it passes, its bend runs across the target, and its plane holds the target's axis or
/// is square to it. A generator then touches it at two heights at once.
Json tangent_elbow(Draw& draw, double rho, double hair) {
  using Eigen::Vector3d;
  const double radius = draw.any(1.0, 3.0) * rho;
  const double bend_radius = radius * draw.of(std::array{1.2, 1.5, 3.0});
  const double bend = draw.of(std::array{60.0, 90.0, 180.0});
  const double turned = 0.5 * bend * std::numbers::pi / 180 * draw.any(0.3, 0.9);
  const Vector3d along = Vector3d::UnitY();
  const Vector3d outwards =
      draw.sign() * draw.of(std::array{Vector3d(Vector3d::UnitX()), Vector3d(Vector3d::UnitZ())});
  const Vector3d start = std::cos(turned) * along - std::sin(turned) * outwards;
  const Vector3d inwards = std::sin(turned) * along + std::cos(turned) * outwards;
  const Vector3d place(draw.sign() * (radius - rho - hair), 0.0, draw.any(-5, 5));
  const Vector3d point =
      place - bend_radius * (std::sin(turned) * start + (1.0 - std::cos(turned)) * inwards);
  const auto json = [](const Vector3d& v) { return triple(v.x(), v.y(), v.z()); };
  return Json{Json::Object{
      {"kind", "elbow"},
      {"outer_diameter_mm", 2 * radius},
      {"bend_radius_mm", bend_radius},
      {"bend_deg", bend},
      {"axis", Json{Json::Object{{"point_mm", json(point)}, {"direction", json(start)}}}},
      {"inwards", json(inwards)}}};
}

TEST(Tangent, ElbowsAtEveryHairAreAnsweredOrRefused) {
  Draw draw(103);
  Answers answers;
  int good = 0;
  for (int round = 0; round < 300; ++round) {
    const double diameter = draw.of(std::array{60.0, 48.3, 114.3}), wall = draw.any(2, 8);
    const bool outer = draw.of(std::array{true, false});
    const double rho = 0.5 * diameter - (outer ? 0.0 : wall);
    const auto elbow = tangent_elbow(draw, rho, hair(draw));
    const Json::Array cutters{elbow,
                              plane(draw.any(-40, 40), draw.any(-0.5, 0.5), draw.any(-0.5, 0.5))};
    good += answers.good("/v1/intersections", curves(target(diameter, wall), cutters)) ? 1 : 0;
    if (round % 5 == 0)
      answers.good("/v1/bevel-tables", table(target(diameter, wall), cutters, cut(draw)));
  }
  EXPECT_GT(good, 290);
}

TEST(Tangent, EveryKindAtEveryHairIsAnsweredOrRefused) {
  Draw draw(48);
  Answers answers;
  int good = 0;
  for (int round = 0; round < 200; ++round) {
    const double diameter = draw.of(std::array{60.0, 48.3, 114.3}), wall = draw.any(2, 8);
    const double rho = 0.5 * diameter - draw.of(std::array{0.0, wall});
    Json::Array cutters{tangent(draw, rho, hair(draw))};
    if (round % 3 == 0) cutters.push_back(plane(-2 * diameter, 0.1));
    const auto tube = target(diameter, wall);
    good += answers.good("/v1/bevel-tables", table(tube, cutters, cut(draw))) ? 1 : 0;
    good += answers.good("/v1/intersections", curves(tube, cutters)) ? 1 : 0;
  }
  EXPECT_GT(good, 150);
}

TEST(Tangent, HolesOfBranchesThatTouchTheChordsSide) {
  Draw draw(49);
  Answers answers;
  int good = 0;
  for (int round = 0; round < 200; ++round) {
    const double chord = draw.of(std::array{114.3, 168.3}), wall = draw.of(std::array{4.0, 8.0});
    const double branch = chord * draw.of(std::array{0.8, 0.6, 0.5});
    const double own = draw.of(std::array{3.0, 5.0});
    const double rho = 0.5 * chord - draw.of(std::array{0.0, wall});
    const double r = 0.5 * branch - draw.of(std::array{0.0, own});
    const Json request{Json::Object{
        {"chord", target(chord, wall)},
        {"branch", Json{Json::Object{{"outer_diameter_mm", branch},
                                     {"wall_mm", own},
                                     {"inclination_deg", draw.of(std::array{90.0, 60.0})},
                                     {"clocking_deg", draw.of(std::array{0.0, 90.0, 33.0})},
                                     {"offset_mm", draw.sign() * (rho - r - hair(draw))}}}},
        {"joint",
         Json{Json::Object{{"kind", draw.of(std::array{"set_on", "set_in"})}, {"gap_mm", 0.0}}}},
        {"groove", Json{Json::Object{{"rule", draw.of(std::array{"none", "half_dihedral"})}}}},
        {"tilt", draw.of(std::array{"none", "axial", "free"})},
        {"kerf_mm", 1.0},
        {"sampling", Json{Json::Object{{"uniform_points", 72.0}}}}}};
    good += answers.good("/v1/holes", request) ? 1 : 0;
  }
  EXPECT_GT(good, 20);
}

TEST(ThinPlate, OneOfThreeMillimetresIsAPartner) {
  const auto request = field("slot-for-3-mm-gusset.intersection.json");
  EXPECT_FALSE(post("/v1/intersections", request).outcome.error);
  EXPECT_FALSE(post("/v1/intersections", with(with(request, "cutters/1/width_mm", 0.5),
                                              "cutters/1/corner_radius_mm", 0.25))
                   .outcome.error);
  // Narrow both ways it is likely in metres.
  const auto rod = post("/v1/intersections", with(with(request, "cutters/1/height_mm", 4.0),
                                                  "cutters/1/corner_radius_mm", 0.25));
  EXPECT_EQ(text(rod.body, "errors/0/pointer"), "/cutters/1/height_mm");
}

TEST(ThickWall, UpToHalfTheDiameterLessATenth) {
  for (const double diameter : {5.0, 60.3, 508.0, 5000.0}) {
    const double most = 0.5 * diameter - 0.1;
    EXPECT_FALSE(
        post("/v1/intersections", curves(target(diameter, most), {plane(0, 0.2)})).outcome.error)
        << diameter;
    const auto more =
        post("/v1/intersections", curves(target(diameter, most + 0.01), {plane(0, 0.2)}));
    EXPECT_EQ(text(more.body, "errors/0/pointer"), "/target/wall_mm");
  }
}

// On every row of a plane's cut both edges lie in the plane.
void hold_plane(const Posted& answer, double diameter, double wall, double x, double y) {
  for (const std::size_t surface : {0U, 1U}) {
    const double rho = 0.5 * diameter - (surface == 0U ? wall : 0.0);
    const auto at_profile = "result/profiles/" + std::to_string(surface);
    const auto phi = numbers(answer.body, at_profile + "/points/phi_deg");
    const auto z = numbers(answer.body, at_profile + "/points/z_mm");
    ASSERT_GT(phi.size(), 8U);
    for (std::size_t i = 0; i < phi.size(); ++i) {
      const double turn = phi[i] * std::numbers::pi / 180;
      EXPECT_NEAR(z[i], -rho * (x * std::cos(turn) + y * std::sin(turn)), 1e-9 * diameter);
    }
  }
}

TEST(ThickWall, AndThinPlatesGoThroughCurvesTablesAndParts) {
  Draw draw(50);
  Answers answers;
  int good = 0;
  for (int round = 0; round < 200; ++round) {
    const double diameter = draw.of(std::array{5.0, 10.0, 21.3, 60.3});
    const double wall = draw.of(std::array{0.5 * diameter - 0.1, 0.5, 0.3 * diameter});
    const auto tube = target(diameter, std::max(0.5, wall));
    const double x = draw.any(-0.7, 0.7), y = draw.any(-0.7, 0.7), thin = draw.any(0.5, 3.0);
    hold_plane(post("/v1/intersections", curves(tube, {plane(0, x, y)})), diameter,
               std::max(0.5, wall), x, y);
    const Json plate{
        Json::Object{{"kind", "rectangular_tube"},
                     {"width_mm", thin},
                     {"height_mm", std::max(5.0, draw.any(1.1, 3.0) * diameter)},
                     {"corner_radius_mm", draw.of(std::array{0.5, 0.1}) * thin},
                     {"axis", Json{Json::Object{{"point_mm", triple(0, 0, 0)},
                                                {"direction", triple(1, 0, draw.any(-0.5, 0.5))}}}},
                     {"up", draw.of(std::array{triple(0, 1, 0), triple(0, 0, 1)})}}};
    const Json::Array cutters{plane(-0.5 * diameter, x, y), plate};
    const auto how = cut(draw);
    good += answers.good("/v1/intersections", curves(tube, cutters)) ? 1 : 0;
    if (round % 10 != 0) continue;  // bevels through solid bars take time
    good += answers.good("/v1/bevel-tables", table(tube, cutters, how)) ? 1 : 0;
    if (round % 20 != 0) continue;
    auto start = how, finish = how;
    start.emplace_back("cutters", Json{cutters});
    finish.emplace_back("cutters", Json{Json::Array{plane(0, y, x)}});
    const Json part{
        Json::Object{{"target", with(tube, "length_mm", 20 * diameter)},
                     {"ends", Json{Json::Object{{"start", Json{start}}, {"finish", Json{finish}}}}},
                     {"kerf_mm", 0.5},
                     {"sampling", Json{Json::Object{{"uniform_points", 72.0}}}}}};
    good += answers.good("/v1/parts", part) ? 1 : 0;
  }
  EXPECT_GT(good, 200);
}

}  // namespace
}  // namespace tubecut::testing
