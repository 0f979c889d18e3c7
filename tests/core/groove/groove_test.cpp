#include "core/groove/groove.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <functional>
#include <limits>

#include "core/groove/groove_limits.hpp"
#include "tests/core/groove/groove_cases.hpp"
#include "tests/support/cancelled.hpp"

namespace tubecut::groove {
namespace {

using namespace testing;
using Eigen::Vector2d;
using Eigen::Vector3d;

GrooveSpec good() { return groove_case("A_source_like"); }

struct Refusal {
  const char* what;
  ErrorCode code;
  const char* member;
  std::function<void(GrooveSpec&)> spoil;
};

const std::vector<Refusal>& refusals() {
  static const double kNan = std::numeric_limits<double>::quiet_NaN(),
                      kInf = std::numeric_limits<double>::infinity();
  static const std::vector<Refusal> all = {
      {"nan", ErrorCode::not_finite, "eccentricity", [](GrooveSpec& s) { s.eccentricity = kNan; }},
      {"infinite", ErrorCode::not_finite, "chord/outer_diameter",
       [](GrooveSpec& s) { s.chord.outer_diameter = kInf; }},
      {"nan_area", ErrorCode::not_finite, "filler/area",
       [](GrooveSpec& s) { s.filler = FillerArea{kNan}; }},
      {"zero_diameter", ErrorCode::out_of_range, "branch/outer_diameter",
       [](GrooveSpec& s) { s.branch.outer_diameter = 0; }},
      {"zero_width", ErrorCode::out_of_range, "root_face/width",
       [](GrooveSpec& s) { s.root_face.width = 0; }},
      {"negative_height", ErrorCode::out_of_range, "root_face/height",
       [](GrooveSpec& s) { s.root_face.height = -1; }},
      {"zero_groove_height", ErrorCode::out_of_range, "filler/height",
       [](GrooveSpec& s) {
         s.filler = FillerHeight{0.0, {}};
       }},
      {"no_sections", ErrorCode::out_of_range, "sections", [](GrooveSpec& s) { s.sections = 0; }},
      {"bevel", ErrorCode::out_of_range, "compare/bevel",
       [](GrooveSpec& s) { s.compare = FixedBevel{Angle::deg(90)}; }},
      {"chord_wall", ErrorCode::wall, "chord/wall", [](GrooveSpec& s) { s.chord.wall = 150; }},
      {"branch_wall", ErrorCode::wall, "branch/wall", [](GrooveSpec& s) { s.branch.wall = 80; }},
      {"root_width", ErrorCode::root_width, "root_face/width",
       [](GrooveSpec& s) { s.root_face.width = 12; }},
      {"area", ErrorCode::area, "filler/area", [](GrooveSpec& s) { s.filler = FillerArea{0.0}; }},
      {"area_of_height", ErrorCode::area, "filler/height",
       [](GrooveSpec& s) {
         s = groove_case("C_oblique_offset");
         s.filler = FillerHeight{1.0, Angle::deg(0)};
       }},
      {"angle_zero", ErrorCode::angle, "inclination",
       [](GrooveSpec& s) { s.inclination = Angle::deg(0); }},
      {"angle_wide", ErrorCode::angle, "inclination",
       [](GrooveSpec& s) { s.inclination = Angle::deg(90.1); }},
      {"no_pierce", ErrorCode::no_pierce, "eccentricity",
       [](GrooveSpec& s) { s.eccentricity = -80; }},
      {"no_p2", ErrorCode::no_p2, "branch/wall", [](GrooveSpec& s) { s.eccentricity = 79; }},
      {"no_p2_at_the_reference", ErrorCode::no_p2, "filler/at",
       [](GrooveSpec& s) {
         s.eccentricity = 79;
         s.filler = FillerHeight{10.0, Angle::deg(90)};
       }},
      {"p3_below_p1", ErrorCode::p3_below_p1, "filler",
       [](GrooveSpec& s) { s.filler = FillerArea{40}; }},
      {"groove_in_chord", ErrorCode::groove_in_chord, "filler",
       [](GrooveSpec& s) {
         s = groove_case("C_oblique_offset");
         s.filler = FillerArea{0.01};
       }},
      {"face_in_chord", ErrorCode::face_in_chord, "filler",
       [](GrooveSpec& s) {
         s.chord = {200, 10};
         s.branch = {168.8, 67.2};
         s.root_face.width = 29.9;
         s.inclination = Angle::deg(58.4);
         s.eccentricity = 22.4;
         s.filler = FillerArea{964};
       }},
      {"p2_ambiguous", ErrorCode::p2_ambiguous, "branch/wall",
       [](GrooveSpec& s) {
         s.chord = {200, 10};
         s.branch = {198.8, 37.2};
         s.root_face.width = 3.2;
         s.inclination = Angle::deg(32.3);
         s.eccentricity = -26.5;
         s.filler = FillerArea{2870};
       }},
  };
  return all;
}

TEST(GrooveErrors, EachIsGiven) {
  for (const Refusal& refusal : refusals()) {
    GrooveSpec spec = good();
    refusal.spoil(spec);
    const auto found = groove(spec);
    ASSERT_FALSE(found) << refusal.what;
    EXPECT_EQ(info(found.error().code()).code, info(refusal.code).code) << refusal.what;
    EXPECT_EQ(found.error().issues.front().member, refusal.member) << refusal.what;
  }
}

TEST(GrooveErrors, EveryBadFieldIsNamedAtOnce) {
  GrooveSpec spec = good();
  spec.chord.wall = -1;
  spec.branch.outer_diameter = std::numeric_limits<double>::quiet_NaN();
  spec.inclination = Angle::deg(120);
  const auto found = groove(spec);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().issues.size(), 3U);
}

TEST(GrooveErrors, TheLeastAreaIsTheLimit) {
  GrooveSpec spec = good();
  spec.filler = FillerArea{40.0};
  const auto found = groove(spec);
  ASSERT_FALSE(found);
  const double limit = std::get<double>(found.error().issues.front().limit);
  const double least = number(golden_case("A_source_like"), "derived/S_D_minimum_720");
  EXPECT_GE(limit, least);
  EXPECT_LE(limit, least + 1e-3);
}

TEST(GrooveErrors, ALimitThatIsFollowedIsAccepted) {
  const auto refused_by = [](const GrooveSpec& spec, ErrorCode code) {
    const auto found = groove(spec);
    return !found && found.error().code() == code;
  };
  const auto limit_of = [](const GrooveSpec& spec) {
    const auto found = groove(spec);
    EXPECT_FALSE(found);
    return found ? 0.0 : std::get<double>(found.error().issues.front().limit);
  };
  for (const double wall : {7.1, 8.0, 12.0, 12.345}) {
    GrooveSpec spec = good();
    spec.branch.wall = wall;
    spec.root_face.width = wall;
    spec.root_face.width = limit_of(spec);
    EXPECT_GT(spec.root_face.width, wall - 0.02);
    EXPECT_FALSE(refused_by(spec, ErrorCode::root_width)) << wall;
  }
  for (const double eccentricity : {-80.0, 80.0, 200.0}) {
    GrooveSpec spec = good();
    spec.eccentricity = eccentricity;
    ASSERT_TRUE(refused_by(spec, ErrorCode::no_pierce));
    spec.eccentricity = std::copysign(limit_of(spec), eccentricity);
    EXPECT_FALSE(refused_by(spec, ErrorCode::no_pierce)) << eccentricity;
  }
  for (const double at : {0.0, 20.0, 160.0, 340.0}) {
    GrooveSpec spec = groove_case("C_oblique_offset");
    spec.filler = FillerHeight{0.01, Angle::deg(at)};
    if (!refused_by(spec, ErrorCode::area)) continue;
    spec.filler = FillerHeight{limit_of(spec), Angle::deg(at)};
    EXPECT_FALSE(refused_by(spec, ErrorCode::area)) << at;
  }
  for (const char* name : {"A_source_like", "C_oblique_offset"}) {
    GrooveSpec spec = groove_case(name);
    spec.filler = FillerArea{1.0};
    if (!refused_by(spec, ErrorCode::p3_below_p1)) continue;
    spec.filler = FillerArea{limit_of(spec)};
    EXPECT_FALSE(refused_by(spec, ErrorCode::p3_below_p1)) << name;
  }
}

TEST(GrooveErrors, Cancelled) {
  const auto spec = good();
  const CancelledScope cancelled;
  const auto found = groove(spec);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code(), ErrorCode::cancelled);
}

bool warns(const GrooveSpec& spec, WarningCode code) {
  const auto found = groove(spec);
  EXPECT_TRUE(found) << (found ? "" : info(found.error().code()).code);
  return found && std::any_of(found->warnings.begin(), found->warnings.end(),
                              [code](const Warning& w) { return w.code == code; });
}

TEST(GrooveWarnings, EachIsGiven) {
  GrooveSpec bore = good();
  bore.chord.wall = 3;
  EXPECT_TRUE(warns(bore, WarningCode::root_in_bore));
  GrooveSpec overhang =
      groove_case("C_oblique_offset");  // a steep heel takes most of the weld's width upwards
  overhang.inclination = Angle::deg(28);
  overhang.filler = FillerArea{2500};
  EXPECT_TRUE(warns(overhang, WarningCode::p2_inside_branch));
  GrooveSpec wide = groove_case("B_near_equal");
  wide.branch.outer_diameter = 304;
  wide.branch.wall = 30;
  wide.root_face.width = 20;
  EXPECT_TRUE(warns(wide, WarningCode::branch_wider));
  GrooveSpec steep = good();
  steep.filler = FillerArea{700};
  EXPECT_TRUE(warns(steep, WarningCode::groove_angle));
  EXPECT_TRUE(groove(good())->warnings.empty());
}

TEST(GrooveFigures, VolumeIsThatOfASolidCutIntoPrisms) {
  // Filler between fine sections: prisms on triangles P1 P2 P3 less the bow, their volume by the
  // divergence theorem.
  const GrooveSpec spec = groove_case("B_near_equal");
  GrooveSpec fine = spec;
  fine.sections = 2880;
  const auto found = groove(fine);
  ASSERT_TRUE(found);
  double volume = 0.0, length = 0.0;
  for (std::size_t i = 0; i < found->sections.size(); ++i) {
    const auto &a = found->sections[i], &b = found->sections[(i + 1) % found->sections.size()];
    length += (a.curves.c3 - b.curves.c3).norm();
    constexpr int kStrips = 200;  // of the section, radially
    for (int k = 0; k < kStrips; ++k) {
      const double x = a.p1.x() + (a.p2.x() - a.p1.x()) * (k + 0.5) / kStrips, w = a.omega.rad();
      const double chord = std::sqrt(150.0 * 150.0 - x * x * std::sin(w) * std::sin(w));
      const double top = x < 120.0
                             ? a.p1.y() + (x - a.p1.x()) * a.height / 12.0
                             : a.p3.y() + (x - 120.0) * (a.p2.y() - a.p3.y()) / (a.p2.x() - 120.0);
      volume += x * (top - chord) * (a.p2.x() - a.p1.x()) / kStrips * kTwoPi / 2880;
    }
  }
  EXPECT_NEAR(found->filler_volume / volume, 1.0,
              2e-5);  // the strips' own error is 1 / (kStrips^2)
  EXPECT_NEAR(found->weld_length / length, 1.0, 1e-5);
}

TEST(GrooveFigures, DenserSurveyChangesNothing) {
  // Trapezoids of periodic functions: 720 stations against the sections of a groove with eight
  // times as many.
  RandomJoints joints{14};
  double worst = 0.0;
  for (int i = 0; i < 20; ++i) {
    GrooveSpec spec = joints.next();
    spec.sections = 5760;
    const auto found = groove(spec);
    ASSERT_TRUE(found);
    const auto joint = joint_geometry(spec);
    double length = 0.0;
    for (const auto& s : found->sections)
      length += kTwoPi / 5760 * std::hypot(s.p1.x(), section(*joint, s.omega)->z3_d);
    worst = std::max(worst, std::abs(found->weld_length / length - 1.0));
  }
  EXPECT_LE(worst, 1e-12);
  std::printf("weld length, 720 against 5760 stations: %.1e\n", worst);
}

/// The filler in a plane, by points of a grid in it: in a section of the answer, over the chord and
/// under groove and face. The plane passes through P1 of section `index`, normal to the direction
/// of its neighbours.
double cut_by_plane(const GrooveSpec& spec, const Groove& g, std::size_t index) {
  constexpr double kStep = 0.05;  // mm
  const auto n = g.sections.size();
  const auto at = [&](std::size_t k) {
    const auto& s = g.sections[k % n];
    return Vector3d(s.p1.x() * std::cos(s.omega.rad()), s.p1.x() * std::sin(s.omega.rad()),
                    s.p1.y());
  };
  const Vector3d root = at(index), along = (at(index + 1) - at(index + n - 1)).normalized();
  const Vector3d out = Vector3d(root.x(), root.y(), 0.0).normalized(), up = along.cross(out);
  const double turn = spec.inclination.rad(), radius = 0.5 * spec.chord.outer_diameter;
  const auto inside = [&](const Vector3d& p) {
    const double s = std::hypot(p.x(), p.y());
    const double omega = std::atan2(p.y(), p.x());
    const double station = (omega < 0 ? omega + 2 * M_PI : omega) / (2 * M_PI) * double(n);
    const auto k = static_cast<std::size_t>(station);
    const double u = station - double(k);
    const auto &a = g.sections[k % n], &b = g.sections[(k + 1) % n];
    const Vector2d p1 = (1 - u) * a.p1 + u * b.p1, p2 = (1 - u) * a.p2 + u * b.p2;
    const Vector2d p3 = (1 - u) * a.p3 + u * b.p3;
    if (s < p1.x() || s > std::max(p2.x(), p3.x())) return false;
    // The chord's axis lies in the half plane omega = 0, to the branch's at the inclination.
    const double across = s * std::sin(omega) + spec.eccentricity;
    const double high = p.z() * std::sin(turn) - s * std::cos(omega) * std::cos(turn);
    if (high < 0 || std::hypot(across, high) < radius) return false;
    const auto& [from, to] = s < p3.x() ? std::pair{p1, p3} : std::pair{p3, p2};
    return p.z() < from.y() + (s - from.x()) / (to.x() - from.x()) * (to.y() - from.y());
  };
  int count = 0;
  for (double a = -2.0; a < 60.0; a += kStep)
    for (double b = -60.0; b < 60.0; b += kStep)
      count += inside(root + (a + 0.013) * out + (b + 0.017) * up) ? 1 : 0;
  return count * kStep * kStep;
}

TEST(GrooveFigures, NormalAreaIsTheRequestedOneAcrossTheSeam) {
  for (const char* name : kCases) {
    GrooveSpec spec = groove_case(name);
    spec.area_in = AreaIn::normal;
    spec.sections = 1440;
    const auto found = groove(spec);
    ASSERT_TRUE(found);
    for (std::size_t k = 0; k < 1440; k += 120)
      EXPECT_NEAR(cut_by_plane(spec, *found, k) / found->area, 1.0, 2e-3) << name << ' ' << k / 4;
  }
}

TEST(GrooveFigures, NormalSectionsThatCannotBeEqualAreRefused) {
  const GrooveSpec spec{.chord = {366.869, 20.0},
                        .branch = {302.196, 18.985},
                        .root_face = {2.0, 3.865},
                        .inclination = Angle::deg(45),
                        .eccentricity = -14.143,
                        .filler = FillerArea{585.9},
                        .area_in = AreaIn::normal};
  const auto found = groove(spec);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code(), ErrorCode::normal_area);
  EXPECT_EQ(found.error().issues.front().member, "area_in");
}

TEST(GrooveFigures, ComparedWithAFixedBevel) {
  GrooveSpec spec = good();
  spec.compare = FixedBevel{Angle::deg(45)};
  const auto found = groove(spec);
  ASSERT_TRUE(found && found->compare);
  EXPECT_NEAR(found->compare->height, 10.0, 1e-14);
  ASSERT_EQ(found->compare->filler_area.size(), 24U);
  EXPECT_NEAR(found->compare->filler_area[0], 0.5 * 10.0 * 20.0,
              1e-11);  // flat at the heel: half of h c
  // At 90 deg, from the hand check: triangle P1 P2 P3 less the bow.
  const double dy = 122.17317775 - 132.66499, D = 17.02709141;
  EXPECT_NEAR(found->compare->filler_area[6], 0.5 * (10.0 * D - 10.0 * dy) - 4.45038, 1e-4);
  EXPECT_LT(found->compare->filler_area[0], found->compare->filler_area[6]);
}

using Corrupt = std::function<void(Groove&, double)>;

struct Proof {
  const char* check;
  Corrupt corrupt;  // by this much
};

const std::vector<Proof>& all_proofs() {
  static const std::vector<Proof> all = {
      {"on_chord", [](Groove& g, double by) { g.sections[3].curves.c3.z() += 2 * by; }},
      {"weld_width", [](Groove& g, double by) { g.sections[4].p2.x() += 2 * by; }},
      {"filler_area", [](Groove& g, double by) { g.sections[5].areas.d += by; }},
      {"area_sum", [](Groove& g, double by) { g.sections[5].areas.e += by; }},
      {"curves", [](Groove& g, double by) { g.sections[6].curves.c1.x() += by; }},
      {"twist",
       [](Groove& g, double by) {
         g.sections[2].ruling.twist = g.sections[2].ruling.twist + Angle::deg(by);
       }},
      {"heights", [](Groove& g, double by) { g.height_max *= 1.0 + by; }},
      {"least_area", [](Groove& g, double by) { g.least_area += by * g.area; }},
      {"filler_volume", [](Groove& g, double by) { g.filler_volume *= 1.0 + by; }},
      {"weld_length", [](Groove& g, double by) { g.weld_length *= 1.0 + by; }},
      {"normal_area", [](Groove& g, double by) { g.area *= 1.0 + by; }},
      {"compare_area", [](Groove& g, double by) { g.compare->filler_area[7] += by; }},
      {"compare_volume",
       [](Groove& g, double by) { g.compare->filler_volume += by * g.filler_volume; }},
  };
  return all;
}

class Proofs : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Cases, Proofs, ::testing::ValuesIn(kCases));

TEST_P(Proofs, PassAndSeeEveryCorruption) {
  for (const AreaIn in : {AreaIn::axial, AreaIn::normal}) {
    GrooveSpec spec = groove_case(GetParam());
    spec.compare = FixedBevel{Angle::deg(50)};
    spec.area_in = in;
    const auto found = groove(spec);
    ASSERT_TRUE(found);
    const auto checks = verify(spec, *found);
    auto proofs = all_proofs();
    if (in == AreaIn::axial)
      std::erase_if(proofs, [](const Proof& p) { return p.check == std::string("normal_area"); });
    ASSERT_EQ(checks.size(), proofs.size());
    for (std::size_t i = 0; i < checks.size(); ++i) {
      EXPECT_TRUE(checks[i].passed())
          << checks[i].name << ' ' << checks[i].value << " > " << checks[i].limit;
      ASSERT_EQ(checks[i].name, proofs[i].check);
      Groove bad = *found;
      proofs[i].corrupt(bad, 10.0 * checks[i].limit);
      EXPECT_FALSE(verify(spec, bad)[i].passed()) << checks[i].name;
    }
  }
}

TEST(GrooveProof, PassesOnRandomJoints) {
  RandomJoints joints{15};
  for (int i = 0; i < 60; ++i) {
    GrooveSpec spec = joints.next();
    spec.compare = FixedBevel{Angle::deg(joints.uniform(10, 60))};
    spec.sections = 16;
    const auto found = groove(spec);
    ASSERT_TRUE(found);
    for (const Check& check : verify(spec, *found))
      EXPECT_TRUE(check.passed()) << i << ' ' << check.name << ' ' << check.value << " > "
                                  << check.limit;
  }
}

TEST(GrooveProof, NanFails) {
  const auto found = groove(good());
  Groove bad = *found;
  bad.sections[1].p2.y() = std::numeric_limits<double>::quiet_NaN();
  const auto checks = verify(good(), bad);
  EXPECT_FALSE(checks[1].passed());
}

}  // namespace
}  // namespace tubecut::groove
