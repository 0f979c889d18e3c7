#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <optional>
#include <random>
#include <string>

#include "core/groove/groove.hpp"
#include "core/groove/survey.hpp"
#include "tests/support/golden.hpp"

namespace tubecut::groove::testing {

using tubecut::testing::at;
using tubecut::testing::golden;
using tubecut::testing::number;
using tubecut::testing::numbers;
using tubecut::testing::text;

inline constexpr std::array kCases = {"A_source_like", "B_near_equal", "C_oblique_offset"};

inline const api::Json& golden_case(const std::string& name) {
  static const api::Json all = golden("grooves-and-milling.json");
  return at(all, "cases/" + name);
}

inline const api::Json::Array& golden_sections(const std::string& name) {
  const auto& sections = *at(golden_case(name), "sections").as<api::Json::Array>();
  EXPECT_EQ(sections.size(), 24U);
  return sections;
}

inline GrooveSpec groove_case(const std::string& name) {
  const api::Json& in = at(golden_case(name), "inputs/joint");
  GrooveSpec out;
  out.chord = {2.0 * number(in, "R"), number(in, "delta1")};
  out.branch = {2.0 * number(in, "r"), number(in, "delta2")};
  out.root_face = {number(in, "a"), number(in, "b")};
  out.filler = FillerArea{number(in, "S_D")};
  out.inclination = Angle::deg(number(in, "alpha_deg"));
  out.eccentricity = number(in, "ecc");
  return out;
}

/// |got - want| within the golden file's geometry tolerance.
inline void expect_geometry(double got, double want, const std::string& what) {
  EXPECT_NEAR(got, want, 1e-12 * std::abs(want) + 1e-11) << what;
}

/// Joints over the whole allowed range of shapes; those without a groove are drawn again.
class RandomJoints {
 public:
  explicit RandomJoints(unsigned seed) : random_(seed) {}

  double uniform(double low, double high) {
    return std::uniform_real_distribution(low, high)(random_);
  }

  GrooveSpec next() {
    for (;;) {
      const GrooveSpec spec = draw();
      const auto joint = joint_geometry(spec);
      if (joint && survey(*joint, 0.0)) return spec;
    }
  }

 private:
  GrooveSpec draw() {
    GrooveSpec out;
    const double R = uniform(20.0, 600.0);
    const double r = R * uniform(0.15, 0.95);
    out.chord = {2.0 * R, R * uniform(0.03, 0.3)};
    out.branch = {2.0 * r, r * uniform(0.05, 0.35)};
    out.root_face = {uniform(0.0, 0.5) * out.branch.wall, uniform(0.05, 0.4) * out.branch.wall};
    out.inclination = Angle::deg(uniform(35.0, 90.0));
    out.eccentricity = uniform(-0.3, 0.3) * (R - r);
    const double H = out.branch.wall - out.root_face.width;
    out.filler = FillerArea{H * H * uniform(0.6, 3.0)};
    return out;
  }

  std::mt19937 random_;
};

}  // namespace tubecut::groove::testing
