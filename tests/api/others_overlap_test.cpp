// Members that run into a body of `others`, as drawings have them: turned, rounded to 0.001 mm,
// with both orders of ends, and the body a tube, a rectangular tube or both. The oracle is the
// drawing.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>

#include "core/base/angle.hpp"
#include "tests/support/call.hpp"

namespace tubecut::testing {
namespace {

using Eigen::Vector3d;

class Drawing {
 public:
  explicit Drawing(std::uint64_t seed) : random_(seed) {
    turn_ = Eigen::Quaterniond(any(-1, 1), any(-1, 1), any(-1, 1), any(-1, 1)).normalized();
    shift_ = {any(-5000, 5000), any(-5000, 5000), any(-5000, 5000)};
  }
  double any(double low, double high) {
    return std::uniform_real_distribution<>(low, high)(random_);
  }
  bool flip() { return any(0, 1) < 0.5; }
  [[nodiscard]] std::string at(const Vector3d& p) const {
    return printed(turn_ * p + shift_, "%.3f");
  }
  [[nodiscard]] std::string along(const Vector3d& d) const { return printed(turn_ * d, "%.9f"); }

  std::string member(const char* id, Vector3d from, Vector3d to, double diameter) {
    if (flip()) std::swap(from, to);
    return std::string(R"({"id": ")") + id + R"(", "start_mm": )" + at(from) + R"(, "end_mm": )" +
           at(to) + R"(, "outer_diameter_mm": )" + std::to_string(diameter) +
           R"(, "wall_mm": 2.6})";
  }

 private:
  static std::string printed(const Vector3d& v, const char* format) {
    std::string out;
    for (int k = 0; k < 3; ++k) {
      char text[40];
      std::snprintf(text, sizeof text, format, v[k]);
      out += (k == 0 ? "[" : ", ") + std::string(text);
    }
    return out + "]";
  }
  std::mt19937_64 random_;
  Eigen::Quaterniond turn_;
  Vector3d shift_;
};

/// Two posts joined to a rail along x, and a bar of 33.7 across it at this distance of the axes.
api::Json guard(Drawing& d, bool round, double off) {
  const std::string rail =
      round ? R"({"kind": "tube", "id": "rail", "outer_diameter_mm": 60.3, "axis": {"point_mm": )" +
                  d.at({0, 0, 0}) + R"(, "direction": )" + d.along({1, 0, 0}) + "}}"
            : R"({"kind": "rectangular_tube", "id": "rail", "width_mm": 60, "height_mm": 60, )"
              R"("corner_radius_mm": 6, "axis": {"point_mm": )" +
                  d.at({0, 0, 0}) + R"(, "direction": )" + d.along({1, 0, 0}) + R"(}, "up": )" +
                  d.along({0, 0, 1}) + "}";
  const std::string body = R"({"members": [)" + d.member("post 1", {0, 0, 0}, {0, 0, -900}, 42.4) +
                           ", " + d.member("post 2", {1500, 0, 0}, {1500, 0, -900}, 42.4) + ", " +
                           d.member("bar", {700, -400, off}, {700, 400, off}, 33.7) +
                           R"(], "others": [)" + rail +
                           R"(], "joints": [{"between": ["post 1", "rail"], "kind": "set_on"},
                       {"between": ["post 2", "rail"], "kind": "set_on"}],
        "defaults": {"root_surface": "inner", "groove": {"rule": "none"}, "smoothing": {"method": "none"}},
        "kerf_mm": 0})";
  return *api::parse(body);
}

std::vector<std::string> overlapping(const Posted& answer) {
  std::vector<std::string> out;
  for (const auto& w : *at(answer.body, "warnings").as<api::Json::Array>())
    if (text(w, "code") == "members_overlap")
      out.push_back(text(w, "pointer") + ": " + text(w, "detail"));
  return out;
}

TEST(OthersOverlap, ABarThroughARailIsForReviewAndOneBesideItIsNot) {
  for (std::uint64_t n = 0; n < 100; ++n) {
    Drawing d(n);
    const bool round = n % 2 == 0;
    const double touching = (round ? 30.15 : 30.0) + 16.85;
    const bool through = n % 4 < 2;
    const double off = through ? d.any(-touching + 0.2, touching - 0.2)
                               : (d.flip() ? 1 : -1) * d.any(touching + 0.02, touching + 60);
    const auto answer = post("/v1/frames", guard(d, round, off));
    ASSERT_FALSE(answer.outcome.error) << n << answer.outcome.body.substr(0, 600);
    const auto found = overlapping(answer);
    ASSERT_EQ(found.size(), through ? 1U : 0U) << n << ": " << off;
    if (!through) continue;
    EXPECT_EQ(found[0].rfind("/members/2: ", 0), 0U) << found[0];
    EXPECT_NE(found[0].find("rail"), std::string::npos) << found[0];
    EXPECT_EQ(text(answer.body, "verdict/status"), "review") << n;
  }
}

/// A leg of 42.4 whose end is this far above a floor, leaning by so many degrees.
api::Json above_floor(double height, double lean, const char* kind) {
  const double run = 900.0 * std::tan(lean * kRadPerDeg);
  const auto at = [](double x, double z) {
    return "[" + std::to_string(x) + ", 0, " + std::to_string(z) + "]";
  };
  const std::string plane = R"({"kind": "plane", "id": "floor", "point_mm": [0, 0, 0],
                                "normal": [0, 0, 1]})";
  const std::string pipe = R"({"kind": "tube", "id": "floor", "outer_diameter_mm": 60.3,
      "axis": {"point_mm": [0, 0, -30.15], "direction": [0, 1, 0]}})";
  return *api::parse(R"({"preset": "tube_laser", "kerf_mm": 0.2, "members": [{"id": "leg",
      "start_mm": )" +
                     at(0, height) + R"(, "end_mm": )" + at(run, height + 900.0) +
                     R"(, "outer_diameter_mm": 42.4, "wall_mm": 3}], "others": [)" +
                     (std::string(kind) == "plane" ? plane : pipe) +
                     R"(], "joints": [{"between": ["leg", "floor"], "kind": "set_on",
                                       "end": "start"}]})");
}

/// An end is not lengthened further than to a member or a plate: 1.5 times twice its radius.
TEST(OthersOverlap, AnEndFarFromABodyIsNotLengthenedToIt) {
  constexpr double kMost = 1.5 * 42.4;
  for (const char* kind : {"plane", "pipe"})
    for (const double lean : {0.0, 30.0}) {
      if (std::string(kind) == "pipe" && lean > 0.0) continue;
      const double along = std::cos(lean * kRadPerDeg);
      for (const double way : {-60.0, 0.0, 0.99 * kMost}) {
        const auto near = post("/v1/frames", above_floor(way * along, lean, kind));
        EXPECT_FALSE(near.outcome.error) << kind << way << near.outcome.body.substr(0, 500);
      }
      for (const double way : {1.01 * kMost, 1000.0}) {
        const auto far = post("/v1/frames", above_floor(way * along, lean, kind));
        ASSERT_TRUE(far.outcome.error) << kind << way;
        EXPECT_EQ(text(far.body, "errors/0/code"), "no_contact");
        EXPECT_EQ(text(far.body, "errors/0/pointer"), "/joints/0");
        EXPECT_NEAR(number(far.body, "errors/0/got"), way, 1e-3);
        EXPECT_NEAR(number(far.body, "errors/0/limit"), kMost, 1e-9);
      }
    }
}

}  // namespace
}  // namespace tubecut::testing
