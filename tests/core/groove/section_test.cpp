#include "core/groove/section.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "core/groove/groove.hpp"
#include "tests/core/groove/groove_cases.hpp"
#include "tests/support/drawings.hpp"

namespace tubecut::groove {
namespace {

using namespace testing;

class GoldenGroove : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Cases, GoldenGroove, ::testing::ValuesIn(kCases));

void expect_point(const Eigen::Vector3d& got, const api::Json& want, const std::string& what) {
  const auto values = numbers(want);
  for (int k = 0; k < 3; ++k) expect_geometry(got[k], values.at(std::size_t(k)), what);
}

void expect_pair(const Eigen::Vector2d& got, const api::Json& want, const std::string& what) {
  const auto values = numbers(want);
  for (int k = 0; k < 2; ++k) expect_geometry(got[k], values.at(std::size_t(k)), what);
}

TEST_P(GoldenGroove, EverySection) {
  const auto joint = joint_geometry(groove_case(GetParam()));
  const auto found = groove(groove_case(GetParam()));
  ASSERT_TRUE(joint && found);
  const auto& want = golden_sections(GetParam());
  ASSERT_EQ(found->sections.size(), want.size());
  for (std::size_t i = 0; i < want.size(); ++i) {
    const GrooveSection& got = found->sections[i];
    const std::string where = std::string(GetParam()) + " section " + std::to_string(i);
    ASSERT_NEAR(got.omega.deg(), number(want[i], "omega_deg"), 1e-12);
    expect_point(got.curves.c1, at(want[i], "C1"), where + " C1");
    expect_point(got.curves.c2, at(want[i], "C2"), where + " C2");
    expect_point(got.curves.c3, at(want[i], "C3"), where + " C3");
    expect_point(got.curves.c4, at(want[i], "C4"), where + " C4");
    expect_pair(got.p1, at(want[i], "P1"), where + " P1");
    expect_pair(got.p2, at(want[i], "P2"), where + " P2");
    expect_pair(got.p3, at(want[i], "P3"), where + " P3");
    expect_geometry(got.height, number(want[i], "h"), where + " h");
    const auto solved = section(*joint, got.omega);
    ASSERT_TRUE(solved);
    expect_geometry(solved->z3_d, number(want[i], "dz3_domega"), where + " z3'");
    expect_geometry(solved->height_d, number(want[i], "dh_domega"), where + " h'");
    expect_geometry(got.groove_angle.deg(), number(want[i], "beta_deg"), where + " beta");
    expect_geometry(got.areas.a, number(want[i], "areas/A"), where + " A");
    expect_geometry(got.areas.b, number(want[i], "areas/B"), where + " B");
    expect_geometry(got.areas.c, number(want[i], "areas/C"), where + " C");
    expect_geometry(got.areas.d, number(want[i], "areas/D"), where + " D");
    expect_geometry(got.areas.e, number(want[i], "areas/E"), where + " E");
    const api::Json& shape = at(want[i], "nondevelopability");
    expect_geometry(got.ruling.determinant, number(shape, "det"), where + " det");
    expect_geometry(got.ruling.twist.deg(), number(shape, "twist_deg"), where + " twist");
  }
}

TEST_P(GoldenGroove, Extremes) {
  const auto found = groove(groove_case(GetParam()));
  ASSERT_TRUE(found);
  const api::Json& want = at(golden_case(GetParam()), "derived");
  expect_geometry(found->height_min, number(want, "h_min_720"), "h min");
  expect_geometry(found->height_max, number(want, "h_max_720"), "h max");
  expect_geometry(found->least_area, number(want, "S_D_minimum_720"), "least area");
  EXPECT_TRUE(found->warnings.empty());
}

/// The chord's upper side at x of a section, only from the joint's distances: bisection on the
/// distance to the chord's axis.
double chord_height(const GrooveSpec& spec, double omega, double x) {
  const double a = spec.inclination.rad();
  const Eigen::Vector3d along(0.0, std::sin(a), std::cos(a)), axis(spec.eccentricity, 0.0, 0.0);
  const Eigen::Vector3d foot(-x * std::sin(omega), x * std::cos(omega), 0.0);
  const double R = 0.5 * spec.chord.outer_diameter;
  const auto outside = [&](double z) {
    return (foot + Eigen::Vector3d(0.0, 0.0, z) - axis).cross(along).norm() > R;
  };
  double low = along.dot(foot - axis) != 0.0 ? foot.y() * std::cos(a) / std::sin(a)
                                             : 0.0;  // nearest the axis
  double high = low + 2.0 * R / std::sin(a);
  for (int i = 0; i < 60; ++i) (outside(0.5 * (low + high)) ? high : low) = 0.5 * (low + high);
  return 0.5 * (low + high);
}

/// Filler region as a plane integral over x: groove line and weld face above, chord below;
/// tanh-sinh for the chord's possible vertical end.
double filler_by_quadrature(const GrooveSpec& spec, const GrooveSection& s) {
  const double omega = s.omega.rad(), x1 = s.p1.x(), x2 = s.p2.x();
  double chord = 0.0;
  constexpr double kStep = 1.0 / 12.0;
  for (int k = -40; k <= 40; ++k) {
    const double u = k * kStep, reach = 0.5 * M_PI * std::sinh(u);
    const double weight = 0.5 * M_PI * std::cosh(u) / (std::cosh(reach) * std::cosh(reach));
    const double x = 0.5 * (x1 + x2) + 0.5 * (x2 - x1) * std::tanh(reach);
    chord += 0.5 * (x2 - x1) * weight * kStep * (chord_height(spec, omega, x) - s.p1.y());
  }
  // Below P1 P3 and P3 P2, heights from P1; signed, so an overhanging face (x2 < x3) subtracts
  // itself.
  const double to_edge = 0.5 * (s.p3.x() - x1) * (s.p3.y() - s.p1.y());
  const double to_toe = 0.5 * (x2 - s.p3.x()) * (s.p3.y() + s.p2.y() - 2.0 * s.p1.y());
  return to_edge + to_toe - chord;
}

TEST(GrooveSections, AreaByQuadratureIsTheRequestedAreaOnRandomJoints) {
  RandomJoints joints{11};
  double worst = 0.0;
  for (int i = 0; i < 1000; ++i) {
    GrooveSpec spec = joints.next();
    spec.sections = 5;
    const auto found = groove(spec);
    ASSERT_TRUE(found);
    const auto& section = found->sections[std::size_t(i) % 5];
    worst = std::max(worst, std::abs(filler_by_quadrature(spec, section) / found->area - 1.0));
  }
  EXPECT_LE(worst, 1e-10);
  RecordProperty("worst_ratio", std::to_string(worst * 1e12) + "e-12");
  std::printf("worst relative area by quadrature: %.2e\n", worst);
}

TEST(GrooveSections, FlatPlateLimit) {
  GrooveSpec spec = groove_case("A_source_like");
  spec.chord.outer_diameter = 2e7;
  const auto found = groove(spec);
  ASSERT_TRUE(found);
  for (const auto& s : found->sections) EXPECT_NEAR(s.height, 2.0 * 120.0 / 20.0, 1e-4);
  spec.chord.outer_diameter = 4e7;  // the remaining curvature goes with 1 / R
  const auto flatter = groove(spec);
  ASSERT_TRUE(flatter);
  const double far = found->sections[6].height - 12.0, near = flatter->sections[6].height - 12.0;
  EXPECT_NEAR(far / near, 2.0, 1e-3);
}

TEST(GrooveSections, RightAngleWithoutOffsetHasTwoMirrors) {
  const auto joint = joint_geometry(groove_case("B_near_equal"));
  ASSERT_TRUE(joint);
  std::vector<Section> s;
  for (int i = 0; i < 24; ++i) s.push_back(*section(*joint, Angle::deg(15.0 * i)));
  for (std::size_t i = 0; i < 24; ++i) {
    EXPECT_NEAR(s[i].height, s[(24 - i) % 24].height, 1e-12);
    EXPECT_NEAR(s[i].height, s[(36 - i) % 24].height, 1e-12);
    EXPECT_NEAR(s[i].height_d, -s[(24 - i) % 24].height_d, 1e-10);
  }
}

TEST(GrooveSections, MirroredOffsetMirrorsTheGroove) {
  GrooveSpec spec = groove_case("C_oblique_offset");
  const auto left = groove(spec);
  spec.eccentricity = -spec.eccentricity;
  const auto right = groove(spec);
  ASSERT_TRUE(left && right);
  for (std::size_t i = 0; i < 24; ++i) {
    const auto& a = left->sections[i];
    const auto& b = right->sections[(24 - i) % 24];
    EXPECT_NEAR(a.height, b.height, 1e-12);
    EXPECT_NEAR(a.root_z, b.root_z, 1e-11);
    EXPECT_NEAR(a.ruling.twist.rad(), -b.ruling.twist.rad(), 1e-12);
  }
}

TEST(GrooveSections, ScaledByAPowerOfTwoIsTheSameGroove) {
  GrooveSpec spec = groove_case("C_oblique_offset");
  const auto small = groove(spec);
  for (double* length :
       {&spec.chord.outer_diameter, &spec.chord.wall, &spec.branch.outer_diameter,
        &spec.branch.wall, &spec.root_face.height, &spec.root_face.width, &spec.eccentricity})
    *length *= 4.0;
  spec.filler = FillerArea{16.0 * 200.0};
  const auto big = groove(spec);
  ASSERT_TRUE(small && big);
  for (std::size_t i = 0; i < 24; ++i) {
    EXPECT_EQ(4.0 * small->sections[i].height, big->sections[i].height);
    EXPECT_EQ(4.0 * small->sections[i].p2.y(), big->sections[i].p2.y());
    EXPECT_EQ(small->sections[i].ruling.twist.rad(), big->sections[i].ruling.twist.rad());
  }
  EXPECT_EQ(64.0 * small->filler_volume, big->filler_volume);
}

TEST(GrooveSections, AreaFromAReferenceHeightInverts) {
  RandomJoints joints{12};
  for (int i = 0; i < 100; ++i) {
    GrooveSpec spec = joints.next();
    spec.area_in = i % 2 == 0 ? AreaIn::axial : AreaIn::normal;
    spec.sections = 16;
    const auto first = groove(spec);
    if (!first)
      continue;  // too small as a normal area, or an area that no constant value matches
                 // all round
    const double equal = spec.area_in == AreaIn::axial ? 1e-12 : 5e-4;
    const auto& reference = first->sections[std::size_t(i) % 16];
    spec.filler = FillerHeight{reference.height, reference.omega};
    const auto again = groove(spec);
    ASSERT_TRUE(again);
    EXPECT_NEAR(again->area / first->area, 1.0, equal);
    EXPECT_NEAR(again->sections[std::size_t(i) % 16].height / reference.height, 1.0, 1e-12);
  }
}

TEST(GrooveSections, DerivativesAreThoseOfTheSections) {
  RandomJoints joints{13};
  for (int i = 0; i < tubecut::testing::drawings(50, 200); ++i) {
    GrooveSpec spec = joints.next();
    spec.area_in = i % 2 == 0 ? AreaIn::axial : AreaIn::normal;
    const auto joint = joint_geometry(spec);
    const double omega = joints.uniform(0.0, kTwoPi), step = 2e-4;
    if (!joint && spec.area_in == AreaIn::normal) continue;  // no value is equal all round
    ASSERT_TRUE(joint);
    const auto y = [&](int k) { return section(*joint, Angle::rad(omega + k * step)); };
    const auto middle = y(0);
    ASSERT_TRUE(middle);
    const auto slope = [&](auto pick) {  // fourth order
      return (8.0 * (pick(*y(1)) - pick(*y(-1))) - (pick(*y(2)) - pick(*y(-2)))) / (12.0 * step);
    };
    const double scale = joint->branch_radius;
    EXPECT_NEAR(middle->height_d, slope([](const Section& s) { return s.height; }), 2e-8 * scale);
    EXPECT_NEAR(middle->z3_d, slope([](const Section& s) { return s.toe.y1; }), 2e-8 * scale);
  }
}

}  // namespace
}  // namespace tubecut::groove
