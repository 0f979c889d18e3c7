#include "core/joint/node/body_overlap.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "core/frame/frame.hpp"

namespace tubecut::joint {
namespace body_overlap {  // one of a program of several files

using Eigen::Vector3d;

class Draw {
 public:
  double of(double low, double high) {
    return std::uniform_real_distribution<>(low, high)(random_);
  }
  Vector3d direction() {
    Vector3d v;
    do v = {of(-1, 1), of(-1, 1), of(-1, 1)};
    while (v.norm() > 1 || v.norm() < 0.1);
    return v.normalized();
  }

 private:
  std::mt19937 random_{48};
};

/// A body, and its signed distance by formulas of this test.
struct Drawn {
  Partner partner;
  std::function<double(const Vector3d&)> distance;
};

Vector3d across_of(const Vector3d& direction, const Vector3d& by) {
  return (by - by.dot(direction) * direction).normalized();
}

Drawn tube(Draw& draw, const Vector3d& at, const Vector3d& along) {
  const double r = draw.of(10, 60);
  return {AxisTube{r, {at, along}},
          [=](const Vector3d& p) { return (p - at - (p - at).dot(along) * along).norm() - r; }};
}

Drawn box(Draw& draw, const Vector3d& at, const Vector3d& along) {
  const double width = draw.of(20, 120), height = draw.of(20, 120), corner = draw.of(1, 10);
  const Vector3d up = across_of(along, draw.direction()), side = along.cross(up);
  return {RectangularTubeCutter{width, height, corner, at, along, up}, [=](const Vector3d& p) {
            const double x = std::abs((p - at).dot(side)) - 0.5 * width + corner;
            const double y = std::abs((p - at).dot(up)) - 0.5 * height + corner;
            return std::hypot(std::max(x, 0.0), std::max(y, 0.0)) + std::min(std::max(x, y), 0.0) -
                   corner;
          }};
}

Drawn cone(Draw& draw, const Vector3d& at, const Vector3d& along) {
  const double r = draw.of(20, 60), half = draw.of(5, 30) / 180.0 * M_PI;
  const ConeCutter cutter{r, Angle::deg(half / M_PI * 180.0), at, along};
  const Vector3d tip = at - r / std::tan(half) * along;
  return {cutter, [=](const Vector3d& p) {
            const double z = (p - tip).dot(along), rho = (p - tip - z * along).norm();
            // Behind the tip's own cone of normals, the tip is nearest.
            if (z * std::cos(half) + rho * std::sin(half) < 0.0) return std::hypot(z, rho);
            return rho * std::cos(half) - z * std::sin(half);
          }};
}

Drawn elbow(Draw& draw, const Vector3d& at, const Vector3d& along) {
  const double r = draw.of(15, 50), bend_radius = draw.of(2, 4) * r, bend = draw.of(0.5, 2.5);
  const Vector3d inwards = across_of(along, draw.direction());
  const ElbowCutter cutter{
      r,     bend_radius, Angle::deg(bend / M_PI * 180.0), at - 0.7 * bend_radius * inwards,
      along, inwards};
  const Vector3d begin = at - 0.7 * bend_radius * inwards, center = begin + bend_radius * inwards;
  return {cutter, [=](const Vector3d& p) {
            const auto point = [&](double t) {
              return Vector3d(center + bend_radius * (std::sin(t) * along - std::cos(t) * inwards));
            };
            // On the arc, the nearest point is in the direction of p, or at an end.
            const double turn = std::atan2((p - center).dot(along), -(p - center).dot(inwards));
            double least = std::min((p - point(0)).norm(), (p - point(bend)).norm());
            if (turn > 0 && turn < bend) least = std::min(least, (p - point(turn)).norm());
            const Vector3d leaving = std::cos(bend) * along + std::sin(bend) * inwards;
            const double before = std::min(0.0, (p - begin).dot(along));
            const double after = std::max(0.0, (p - point(bend)).dot(leaving));
            least = std::min({least, (p - begin - before * along).norm(),
                              (p - point(bend) - after * leaving).norm()});
            return least - r;
          }};
}

/// The deepest of many points of a wall that is square at both ends.
double deepest(const Member& m, const Drawn& body) {
  const double length = (m.finish - m.start).norm();
  const Vector3d axis = (m.finish - m.start) / length, x = across_of(axis, {0.3, 0.5, 0.8}),
                 y = axis.cross(x);
  double out = -1e300;
  for (const double rho : {m.outer_radius, m.outer_radius - 0.5 * m.wall, m.outer_radius - m.wall})
    for (int i = 0; i < 90; ++i)
      for (int k = 0; k <= 150; ++k) {
        const double phi = 2 * M_PI * i / 90;
        out = std::max(out, -body.distance(m.start + length * k / 150 * axis +
                                           rho * (std::cos(phi) * x + std::sin(phi) * y)));
      }
  return out;
}

// Members of 300 mm and bodies through or beside them. The points of the oracle are 2 mm and 4 deg
// apart; so it may miss a depth of 1.6 mm, but a depth that it finds exists.
TEST(BodyOverlap, AgreesWithManyPointsOfTheWall) {
  Draw draw;
  int inside = 0, clear = 0;
  const std::array kinds{tube, box, cone, elbow};
  for (int n = 0; n < 400; ++n) {
    Member m{.start = {0, 0, 0},
             .finish = 300.0 * draw.direction(),
             .outer_radius = draw.of(8, 40),
             .wall = 2,
             .name = "M"};
    m.wall = draw.of(0.04, 0.5) * m.outer_radius;
    const Vector3d off = across_of(m.finish.normalized(), draw.direction()) * draw.of(0, 130);
    const auto body = kinds[n % 4](draw, draw.of(0.2, 0.8) * m.finish + off, draw.direction());
    const NodeSpec spec{.members = {m}, .connect = {}};
    const auto nodes = solve(spec);
    ASSERT_TRUE(nodes);
    const auto found = overlaps_with({{body.partner}}, spec, *nodes, {});
    ASSERT_TRUE(found);
    if (n % 4 == 3) continue;  // of an elbow only the bend counts: below
    const double deep = deepest(m, body);
    const bool liner = body.distance(m.start) <= 0 && body.distance(m.finish) <= 0;
    if (deep > 0.02 && !liner) {
      ASSERT_EQ(found->size(), 1U) << n << ": " << deep;
      EXPECT_GT(found->front().depth, 0.99 * deep - 0.01) << n;
      EXPECT_LT(found->front().depth, deep + 1.7) << n;
      EXPECT_NEAR(-body.distance(found->front().at), found->front().depth, 1e-6) << n;
      ++inside;
    } else if (deep < -1.7 || liner) {
      EXPECT_TRUE(found->empty()) << n << ": " << deep;
      ++clear;
    }
  }
  EXPECT_GT(inside, 60);
  EXPECT_GT(clear, 60);
}

TEST(BodyOverlap, ElbowCountsAtItsBend) {
  Draw draw;
  int inside = 0, clear = 0;
  for (int n = 0; n < 120; ++n) {
    Member m{.start = {0, 0, 0},
             .finish = 300.0 * draw.direction(),
             .outer_radius = draw.of(8, 40),
             .wall = 2,
             .name = "M"};
    const Vector3d off = across_of(m.finish.normalized(), draw.direction()) * draw.of(0, 130);
    const auto body = elbow(draw, draw.of(0.4, 0.6) * m.finish + off, draw.direction());
    const NodeSpec spec{.members = {m}, .connect = {}};
    const auto nodes = solve(spec);
    const auto found = overlaps_with({{body.partner}}, spec, *nodes, {});
    ASSERT_TRUE(nodes && found);
    const double deep = deepest(m, body);
    if (!found->empty()) {
      EXPECT_GT(deep, -1.7) << n;
      EXPECT_NEAR(-body.distance(found->front().at), found->front().depth, 1e-6) << n;
      ++inside;
    } else if (deep < -1.7) {
      ++clear;
    }
  }
  EXPECT_GT(inside, 20);
  EXPECT_GT(clear, 20);
}

frame::FrameSpec rail(std::vector<double> posts, double crossing) {
  frame::FrameSpec spec;
  spec.others = {{AxisTube{30.15, {{0, 0, 0}, {1, 0, 0}}}, "rail"}};
  for (const double x : posts) {
    spec.members.push_back(
        {.start = {x, 0, 0}, .finish = {x, 0, 500}, .outer_radius = 20, .wall = 2});
    spec.joints.push_back({.member = spec.members.size() - 1, .with = 0, .other = true});
  }
  spec.members.push_back({.start = {crossing, -300, 5},
                          .finish = {crossing, 300, 5},
                          .outer_radius = 20,
                          .wall = 2,
                          .name = "bar"});
  return spec;
}

std::vector<Warning> overlapping(const frame::FrameSpec& spec) {
  const auto frame = frame::solve(spec);
  EXPECT_TRUE(frame);
  auto out = frame->warnings;
  std::erase_if(out, [](const Warning& w) { return w.code != WarningCode::members_overlap; });
  return out;
}

TEST(BodyOverlap, FrameWarnsOfAMemberThroughABodyThatNoJointNames) {
  const auto between = overlapping(rail({0, 1000}, 500));
  ASSERT_EQ(between.size(), 1U);
  EXPECT_EQ(between[0].member, "members/2");
  EXPECT_NE(between[0].detail.find("rail"), std::string::npos) << between[0].detail;
  EXPECT_EQ(overlapping(rail({}, 500)).size(), 1U);
  // In a drawing, the rail ends somewhere beyond its last post.
  EXPECT_TRUE(overlapping(rail({0, 1000}, 1400)).empty());
  EXPECT_EQ(overlapping(rail({0, 1000}, 1050)).size(), 1U);
  auto stated = rail({0, 1000}, 500);
  stated.joints.push_back({.member = 2, .with = 0, .other = true, .end = End::start});
  EXPECT_TRUE(overlapping(stated).empty());
}

TEST(BodyOverlap, LinerAndContinuationAreLeftOut) {
  frame::FrameSpec spec;
  spec.others = {{AxisTube{30.15, {{0, 0, 0}, {1, 0, 0}}}, "pipe"}};
  spec.members = {{.start = {100, 1, 0}, .finish = {900, -1, 0}, .outer_radius = 30.15, .wall = 3}};
  EXPECT_TRUE(overlapping(spec).empty());
  spec.members = {{.start = {0, 58, 0}, .finish = {900, 58, 0}, .outer_radius = 30.15, .wall = 3}};
  EXPECT_EQ(overlapping(spec).size(), 1U);
  spec.members = {
      {.start = {0, 60.3, 0}, .finish = {900, 60.3, 0}, .outer_radius = 30.15, .wall = 3}};
  EXPECT_TRUE(overlapping(spec).empty());
}

}  // namespace body_overlap
}  // namespace tubecut::joint
