#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "tests/support/call.hpp"

// Branches and supports on an elbow of the same diameter, as models have them: on the side, on the
// back, oblique and along a run, started at either end, turned in plan and rounded. The side of the
// elbow is then a tangent of the branch but for the rounding.
namespace tubecut::testing {
namespace {

using api::Json;
using Eigen::Vector3d;

double any(std::mt19937_64& draw, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(draw);
}

template <class T, std::size_t N>
T one_of(std::mt19937_64& draw, const std::array<T, N>& all) {
  return all[std::uniform_int_distribution<std::size_t>(0, N - 1)(draw)];
}

/// An elbow that begins at `begin`, along `along`, and turns towards `inwards`; lengths in mm.
struct Elbow {
  double radius, bend_radius, bend_deg;
  Vector3d begin, along, inwards;

  /// Returns the distance of a point from the surface: from the centre line, an arc and its two
  /// runs, less the radius.
  [[nodiscard]] double distance(const Vector3d& point) const {
    const Vector3d from = point - begin;
    const double u = from.dot(along), v = from.dot(inwards);
    const double w = from.dot(along.cross(inwards));
    const double bend = bend_deg * std::numbers::pi / 180;
    const auto arc = [&](double at) {
      return Vector3d(bend_radius * std::sin(at), bend_radius * (1 - std::cos(at)), 0);
    };
    const Vector3d p(u, v, w), leaves(std::cos(bend), std::sin(bend), 0);
    const double at = std::atan2(u, bend_radius - v);
    const Vector3d first(std::min(0.0, u), 0, 0);
    const Vector3d last = arc(bend) + std::max(0.0, (p - arc(bend)).dot(leaves)) * leaves;
    double least = std::min((p - first).norm(), (p - last).norm());
    for (const double turned : {at, at + 2 * std::numbers::pi})
      if (turned >= 0 && turned <= bend) least = std::min(least, (p - arc(turned)).norm());
    return least - radius;
  }
};

/// The elbow and the branch's axis, from the elbow's centre line outwards.
struct Drawn {
  Elbow elbow;
  Vector3d foot, outwards;
};

Drawn draw_branch(std::mt19937_64& draw) {
  const double diameter = one_of(draw, std::array{60.3, 88.9, 114.3, 168.3});
  const double bend_radius = one_of(draw, std::array{1.0, 1.5, 3.0}) * diameter;
  const double bend_deg = one_of(draw, std::array{45.0, 60.0, 90.0, 180.0});
  const Elbow elbow{diameter / 2,     bend_radius,       bend_deg,
                    Vector3d::Zero(), Vector3d::UnitX(), Vector3d::UnitZ()};
  const double at =
      bend_deg * std::numbers::pi / 180 * one_of(draw, std::array{0.25, 0.5, any(draw, 0.1, 0.9)});
  const Vector3d foot(bend_radius * std::sin(at), 0, bend_radius * (1 - std::cos(at)));
  const Vector3d back(std::sin(at), 0, -std::cos(at)), side = Vector3d::UnitY();
  const std::array<Vector3d, 4> ways{side, back, 0.8 * back + 0.6 * side, Vector3d::UnitX()};
  return {elbow, foot, one_of(draw, ways)};
}

Json triple(const Vector3d& v) { return Json{Json::Array{v.x(), v.y(), v.z()}}; }

Json json_of(const Elbow& elbow) {
  return Json{Json::Object{{"kind", "elbow"},
                           {"outer_diameter_mm", 2 * elbow.radius},
                           {"bend_radius_mm", elbow.bend_radius},
                           {"bend_deg", elbow.bend_deg},
                           {"axis", Json{Json::Object{{"point_mm", triple(elbow.begin)},
                                                      {"direction", triple(elbow.along)}}}},
                           {"inwards", triple(elbow.inwards)}}};
}

/// The model turned about the vertical, in mm rounded to `step`; 0: not rounded.
Json frame_of(const Drawn& drawn, double turned_deg, double step, bool starts_at_elbow,
              double gap) {
  const Eigen::AngleAxisd turn(turned_deg * std::numbers::pi / 180, Vector3d::UnitZ());
  const auto place = [&](const Vector3d& p) {
    const Vector3d at = turn * p;
    return step > 0 ? Vector3d((at / step).array().round().matrix() * step) : at;
  };
  auto elbow = drawn.elbow;
  elbow.begin = place(elbow.begin);
  elbow.along = turn * elbow.along;
  const Vector3d end = drawn.foot + 8 * elbow.radius * drawn.outwards;
  const auto first = triple(place(starts_at_elbow ? drawn.foot : end));
  const auto second = triple(place(starts_at_elbow ? end : drawn.foot));
  return Json{Json::Object{
      {"members", Json{Json::Array{Json{Json::Object{{"id", "branch"},
                                                     {"start_mm", first},
                                                     {"end_mm", second},
                                                     {"outer_diameter_mm", 2 * elbow.radius},
                                                     {"wall_mm", 4.0}}}}}},
      {"others", Json{Json::Array{with(json_of(elbow), "id", Json{"bend"})}}},
      {"joints",
       Json{Json::Array{Json{Json::Object{{"between", Json{Json::Array{"branch", "bend"}}},
                                          {"kind", "set_on"},
                                          {"gap_mm", gap}}}}}},
      {"defaults", Json{Json::Object{{"root_surface", "inner"},
                                     {"contact", "inner"},
                                     {"groove", Json{Json::Object{{"rule", "half_dihedral"}}}},
                                     {"smoothing", Json{Json::Object{{"method", "none"}}}}}}},
      {"kerf_mm", 1.5},
      {"sampling", Json{Json::Object{{"tolerance_mm", 0.1}}}}}};
}

TEST(ElbowBranches, AreCutInEveryOrderTurnAndRounding) {
  std::mt19937_64 draw(2026);
  for (int i = 0; i < 200; ++i) {
    const auto drawn = draw_branch(draw);
    const double step = one_of(draw, std::array{0.0, 1e-3, 1e-2, 0.1, 0.0254, 1.5875});
    const double turned = one_of(draw, std::array{0.0, 90.0, 30.0, 12.345});
    const auto request =
        frame_of(drawn, turned, step, i % 2 == 0, one_of(draw, std::array{0.0, 2.0}));
    const auto answer = post("/v1/frames", request);
    ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 800) << api::dump(request);
    ASSERT_EQ(at(answer.body, "result/cut_list").as<Json::Array>()->size(), 1u)
        << api::dump(at(answer.body, "result")).substr(0, 800) << api::dump(request);
    const auto& not_cut = *at(answer.body, "result/not_cut").as<Json::Array>();
    ASSERT_EQ(not_cut.size(), 1u);  // its free end
    EXPECT_EQ(text(not_cut.front(), "why"), "free");
  }
}

/// The elbow in the frame of a target that begins at the branch's foot, seen from its free end: z
/// along the branch.
Elbow seen_from(const Drawn& drawn) {
  const auto turn = Eigen::Quaterniond::FromTwoVectors(drawn.outwards, Vector3d::UnitZ());
  auto out = drawn.elbow;
  out.begin = turn * (out.begin - drawn.foot);
  out.along = turn * out.along;
  out.inwards = turn * out.inwards;
  return out;
}

TEST(ElbowBranches, CurveLiesOnTheElbowAtTheRowsAndWithinTheToleranceBetween) {
  constexpr double kTolerance = 0.05;
  std::mt19937_64 draw(7);
  std::size_t rows = 0;
  for (int i = 0; i < 200; ++i) {
    const auto elbow = seen_from(draw_branch(draw));
    const double wall = any(draw, 0.02, 0.2) * elbow.radius;
    const auto answer =
        post("/v1/intersections",
             Json{Json::Object{{"target", Json{Json::Object{{"outer_diameter_mm", 2 * elbow.radius},
                                                            {"wall_mm", wall}}}},
                               {"cutters", Json{Json::Array{json_of(elbow)}}},
                               {"surfaces", "inner"},
                               {"sampling", Json{Json::Object{{"tolerance_mm", kTolerance}}}}}});
    ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 800);
    const auto phi = numbers(answer.body, "result/profiles/0/points/phi_deg");
    const auto z = numbers(answer.body, "result/profiles/0/points/z_mm");
    const auto off = [&](double phi_deg, double height) {
      const double at = phi_deg * std::numbers::pi / 180, rho = elbow.radius - wall;
      return std::abs(elbow.distance({rho * std::cos(at), rho * std::sin(at), height}));
    };
    for (std::size_t k = 0; k < phi.size(); ++k) {
      EXPECT_LT(off(phi[k], z[k]), 1e-9 * elbow.bend_radius) << i << ' ' << phi[k];
      if (k + 1 < phi.size() && phi[k + 1] > phi[k]) {
        EXPECT_LT(off(0.5 * (phi[k] + phi[k + 1]), 0.5 * (z[k] + z[k + 1])), kTolerance) << i;
      }
    }
    rows += phi.size();
  }
  EXPECT_GT(rows, 2000u);
}

TEST(ElbowBranches, TableGoesToPulsesInTheNextCall) {
  std::mt19937_64 draw(54);
  for (int i = 0; i < 6; ++i) {
    const auto elbow = seen_from(draw_branch(draw));
    const Json table{Json::Object{
        {"target", Json{Json::Object{{"outer_diameter_mm", 2 * elbow.radius}, {"wall_mm", 4.0}}}},
        {"cutters", Json{Json::Array{json_of(elbow)}}},
        {"root_surface", "inner"},
        {"contact", "inner"},
        {"groove", Json{Json::Object{{"rule", "half_dihedral"}, {"cap_deg", 45.0}}}},
        {"kerf_mm", 1.5},
        {"smoothing",
         Json{Json::Object{{"method", "envelope"},
                           {"limits", Json{Json::Object{{"max_slope_deg_per_mm", 5.0},
                                                        {"max_curvature_deg_per_mm2", 1.0}}}}}}},
        {"sampling", Json{Json::Object{{"uniform_points", 180.0}}}}}};
    const Json job{Json::Object{
        {"cut", table},
        {"machine", Json{"five_axis_cutter"}},
        {"motion", Json{Json::Object{{"speed", Json{Json::Object{{"mm_min", 1000.0}}}}}}}}};
    const auto schedule = post("/v1/pulse-schedules", job);
    ASSERT_FALSE(schedule.outcome.error)
        << schedule.outcome.body.substr(0, 800) << api::dump(table);
    EXPECT_EQ(std::abs(number(schedule.body, "result/total/C")), 360'000.0);
  }
}

}  // namespace
}  // namespace tubecut::testing
