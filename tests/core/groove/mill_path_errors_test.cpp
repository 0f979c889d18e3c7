#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "tests/core/groove/path_cases.hpp"
#include "tests/support/cancelled.hpp"

namespace tubecut::groove {
namespace {

using namespace testing;

MillPathSpec few(const std::string& name) {
  MillPathSpec out = path_case(name);
  out.positions = 24;
  return out;
}

struct Refusal {
  const char* what;
  ErrorCode code;
  const char* member;
  std::function<void(MillPathSpec&)> spoil;
};

const std::vector<Refusal>& refusals() {
  static const double kNan = std::numeric_limits<double>::quiet_NaN();
  static const std::vector<Refusal> all = {
      {"nested", ErrorCode::wall, "groove/branch/wall",
       [](MillPathSpec& s) { s.groove.branch.wall = 80; }},
      {"nested_filler", ErrorCode::p3_below_p1, "groove/filler",
       [](MillPathSpec& s) { s.groove.filler = FillerArea{40}; }},
      {"nan", ErrorCode::not_finite, "mill/length", [](MillPathSpec& s) { s.mill.length = kNan; }},
      {"half_angle", ErrorCode::tool, "mill/half_angle",
       [](MillPathSpec& s) { s.mill.half_angle = Angle::deg(90); }},
      {"tip_radius", ErrorCode::tool, "mill/tip_radius",
       [](MillPathSpec& s) { s.mill.tip_radius = -1; }},
      {"needle", ErrorCode::tool, "mill/tip_radius",
       [](MillPathSpec& s) {
         s.mill.tip_radius = 0;
         s.mill.half_angle = {};
       }},
      {"length", ErrorCode::tool, "mill/length", [](MillPathSpec& s) { s.mill.length = 0; }},
      {"direction", ErrorCode::tool, "setup/direction",
       [](MillPathSpec& s) { s.setup.direction = 0; }},
      {"short", ErrorCode::tool_short, "mill/length", [](MillPathSpec& s) { s.mill.length = 14; }},
      {"short_overrun", ErrorCode::tool_short, "mill/length",
       [](MillPathSpec& s) { s.setup.overrun = 28; }},
      {"root", ErrorCode::root_collision, "mill/half_angle",
       [](MillPathSpec& s) { s.mill.half_angle = Angle::deg(45); }},
      {"overrun", ErrorCode::out_of_range, "setup/overrun",
       [](MillPathSpec& s) { s.setup.overrun = -1; }},
      {"points", ErrorCode::sampling, "check/points", [](MillPathSpec& s) { s.check.points = 2; }},
      {"many_points", ErrorCode::sampling, "check/points",
       [](MillPathSpec& s) { s.check.points = 102; }},
      {"no_pitch", ErrorCode::sampling, "check/pitch", [](MillPathSpec& s) { s.check.pitch = {}; }},
      {"wide_pitch", ErrorCode::sampling, "check/pitch",
       [](MillPathSpec& s) { s.check.pitch = Angle::deg(41); }},
      {"wide_window", ErrorCode::sampling, "check/window",
       [](MillPathSpec& s) { s.check.window = Angle::deg(91); }},
      {"qualify", ErrorCode::out_of_range, "check/qualify",
       [](MillPathSpec& s) { s.check.qualify = 0; }},
      {"positions", ErrorCode::out_of_range, "positions", [](MillPathSpec& s) { s.positions = 3; }},
      {"many_positions", ErrorCode::out_of_range, "positions",
       [](MillPathSpec& s) { s.positions = 20001; }},
      {"many_annealed", ErrorCode::out_of_range, "positions",
       [](MillPathSpec& s) {
         s.positions = most_positions(s.check, Method::annealing) + 1;
         s.optimise.method = Method::annealing;
       }},
      {"many_samples", ErrorCode::out_of_range, "positions",
       [](MillPathSpec& s) {
         s.check.pitch = Angle::deg(0.05);
         s.positions = 3000;
       }},
      {"many_triples", ErrorCode::out_of_range, "positions",
       [](MillPathSpec& s) {
         s.check.points = 101;
         s.positions = 601;
       }},
      {"many_to_emit", ErrorCode::too_many_nodes, "check",
       [](MillPathSpec& s) {
         s.check.points = 101;
         s.check.window = Angle::deg(90);
         s.check.pitch = Angle::deg(0.05);
       }},
      {"pivot", ErrorCode::setup, "setup/pivot_length",
       [](MillPathSpec& s) { s.setup.pivot_length = -1; }},
      {"mount", ErrorCode::setup, "setup/mount",
       [](MillPathSpec& s) { s.setup.mount = static_cast<Mount>(7); }},
      {"hold", ErrorCode::setup, "optimise/hold",
       [](MillPathSpec& s) { s.optimise.hold = static_cast<Hold>(7); }},
      {"window", ErrorCode::window, "check/window",
       [](MillPathSpec& s) {
         s.check.window = Angle::deg(1);
         s.check.pitch = Angle::deg(0.5);
       }},
      {"z", ErrorCode::z_ineffective, "setup/mount",
       [](MillPathSpec& s) {
         s.groove.filler = FillerArea{1600};
         s.mill.length = 300;
       }},
      {"x_travel", ErrorCode::travel, "setup/travel/x",
       [](MillPathSpec& s) {
         s.setup.travel.x = Range{0, 74};
       }},
      {"z_travel", ErrorCode::travel, "setup/travel/z",
       [](MillPathSpec& s) {
         s.setup.travel.z = Range{-130, 0};
       }},
      {"b_travel", ErrorCode::travel, "setup/travel/b",
       [](MillPathSpec& s) {
         s.setup.travel.b_deg = Range{-110, 110};
       }},
      {"sag", ErrorCode::too_many_nodes, "setup/pivot_length",
       [](MillPathSpec& s) { s.setup.pivot_length = 1e7; }},
  };
  return all;
}

TEST(MillPathErrors, EachIsGiven) {
  for (const Refusal& refusal : refusals()) {
    MillPathSpec spec = few("A_source_like");
    spec.optimise.hold = Hold::tip;
    refusal.spoil(spec);
    const auto found = mill_path(spec);
    ASSERT_FALSE(found) << refusal.what;
    EXPECT_EQ(info(found.error().code()).code, info(refusal.code).code) << refusal.what;
    EXPECT_EQ(found.error().issues.front().member, refusal.member) << refusal.what;
  }
}

TEST(MillPathErrors, CancelledAtOnceAndInTheMiddle) {
  const auto spec = few("A_source_like");
  const CancelledScope cancelled;
  const auto found = mill_path(spec);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code(), ErrorCode::cancelled);
}

bool warns(const MillPath& path, WarningCode code, const char* member) {
  return std::any_of(path.warnings.begin(), path.warnings.end(),
                     [&](const Warning& w) { return w.code == code && w.member == member; });
}

TEST(MillPathWarnings, RootFaceCut) {
  const auto slight = mill_path(few("B_near_equal"));
  ASSERT_TRUE(slight);
  EXPECT_TRUE(warns(*slight, WarningCode::root_face_cut, "optimise/hold"));
  EXPECT_TRUE(slight->qualified);
  const auto deep = mill_path(few("C_oblique_offset"));  // the pivot drags the tip 2 mm into it
  ASSERT_TRUE(deep);
  EXPECT_TRUE(warns(*deep, WarningCode::root_face_cut, "optimise/hold"));
  EXPECT_FALSE(deep->qualified);
  MillPathSpec held = few("C_oblique_offset");
  held.optimise.hold = Hold::tip;
  const auto spared = mill_path(held);
  ASSERT_TRUE(spared);
  EXPECT_TRUE(spared->warnings.empty());
  EXPECT_TRUE(spared->qualified);
}

TEST(MillPathWarnings, WindowNotReachedAndTheGroovesOwn) {
  MillPathSpec spec = few("C_oblique_offset");
  spec.optimise.method = Method::none;
  spec.groove.chord.wall = 3.0;
  const auto path = mill_path(spec);
  ASSERT_TRUE(path);
  EXPECT_TRUE(warns(*path, WarningCode::window_not_reached, "check/qualify"));
  EXPECT_TRUE(warns(*path, WarningCode::root_in_bore, "groove/root_face/height"));
  EXPECT_FALSE(path->qualified);
  EXPECT_EQ(path->positions.front().evaluations, 1);
}

struct Proof {
  const char* check;
  std::function<void(MillPath&, double)> corrupt;  // by this much
};

const std::vector<Proof>& proofs() {
  static const std::vector<Proof> all = {
      {"initial_on_ruling", [](MillPath& p, double by) { p.positions[7].at.x += by; }},
      {"contact_gap", [](MillPath& p, double by) { p.positions[8].after.gap[3] += by; }},
      {"contact_least", [](MillPath& p, double by) { p.positions[0].before.gap[4] += by; }},
      {"cut_figures", [](MillPath& p, double by) { p.positions[9].before.over += by; }},
      {"certificate", [](MillPath& p, double by) { p.positions[0].certificate += by; }},
      {"axis_sag", [](MillPath& p, double by) { p.positions[11].at.z += by; }},
      {"swept", [](MillPath& p, double by) { p.swept.flank_max.value += by; }},
      {"root_face", [](MillPath& p, double by) { p.swept.root_face_min.value += by; }},
  };
  return all;
}

TEST(MillPathProof, SeesEveryCorruption) {
  const MillPathSpec spec = few("B_near_equal");
  const auto path = mill_path(spec);
  ASSERT_TRUE(path);
  const auto checks = verify(spec, *path);
  ASSERT_EQ(checks.size(), proofs().size());
  for (std::size_t i = 0; i < checks.size(); ++i) {
    EXPECT_TRUE(checks[i].passed()) << checks[i].name;
    ASSERT_EQ(checks[i].name, proofs()[i].check);
    for (const double sign : {1.0, -1.0}) {
      if (sign < 0.0 && (checks[i].name == "contact_least"))
        continue;  // a gap too small is contact_gap's to see
      MillPath bad = *path;
      proofs()[i].corrupt(bad, sign * 10.0 * checks[i].limit);
      EXPECT_FALSE(verify(spec, bad)[i].passed()) << checks[i].name;
    }
  }
  // A sub-optimal position does not pass for an optimum, nor a stock left or a flank minimum for
  // another.
  MillPath bad = *path;
  bad.swept.stock_left_max.value -= 1e-5;
  EXPECT_FALSE(verify(spec, bad)[6].passed());
  bad = *path;
  bad.swept.flank_min.value += 1e-5;
  EXPECT_FALSE(verify(spec, bad)[6].passed());
}

TEST(MillPathProof, PassesForEveryWayOfWorking) {
  std::vector<std::pair<const char*, MillPathSpec>> ways;
  const auto way = [&](const char* what, const std::function<void(MillPathSpec&)>& change) {
    MillPathSpec spec = few("C_oblique_offset");
    spec.optimise.hold = Hold::tip;
    change(spec);
    ways.emplace_back(what, spec);
  };
  way("none", [](MillPathSpec& s) { s.optimise.method = Method::none; });
  way("annealing", [](MillPathSpec& s) { s.optimise.method = Method::annealing; });
  way("no overcut", [](MillPathSpec& s) { s.optimise.bias = Bias::no_overcut; });
  way("rear edge", [](MillPathSpec& s) { s.setup.direction = -1; });
  way("rear edge, end down", [](MillPathSpec& s) {
    s.setup.direction = -1;
    s.setup.mount = Mount::end_down;
  });
  way("overrun", [](MillPathSpec& s) { s.setup.overrun = 1.0; });
  way("cylinder", [](MillPathSpec& s) { s.mill.half_angle = {}; });
  way("normal area", [](MillPathSpec& s) { s.groove.area_in = AreaIn::normal; });
  way("no root face", [](MillPathSpec& s) { s.groove.root_face.height = 0.0; });
  way("large", [](MillPathSpec& s) {
    for (double* length :
         {&s.groove.chord.outer_diameter, &s.groove.chord.wall, &s.groove.branch.outer_diameter,
          &s.groove.branch.wall, &s.groove.root_face.height, &s.groove.root_face.width,
          &s.groove.eccentricity, &s.mill.tip_radius, &s.mill.length, &s.setup.pivot_length})
      *length *= 10.0;
    s.groove.filler = FillerArea{20000.0};
    s.check.qualify = 5.0;
  });
  for (const auto& [what, spec] : ways) {
    const auto path = mill_path(spec);
    ASSERT_TRUE(path) << what << ' ' << info(path.error().code()).code;
    for (const Check& check : verify(spec, *path))
      EXPECT_TRUE(check.passed()) << what << ' ' << check.name << ' ' << check.value << " > "
                                  << check.limit;
  }
}

TEST(MillPathLaws, NoOvercutLeavesNone) {
  MillPathSpec spec = path_case("A_source_like");
  spec.optimise.bias = Bias::no_overcut;
  const auto path = mill_path(spec);
  ASSERT_TRUE(path);
  for (const MillPosition& p : path->positions)
    if (p.optimised) {
      EXPECT_LE(p.after.over, 2e-12);
    }
  EXPECT_GE(path->swept.flank_min.value, -0.0015);  // linear axes and the curve between optima
}

TEST(MillPathLaws, AnOverrunTakesTheStockAndCutsTheRootFace) {
  MillPathSpec spec = path_case("A_source_like");
  spec.setup.overrun = 0.5;
  const auto path = mill_path(spec);
  ASSERT_TRUE(path);
  EXPECT_LT(path->swept.stock_left_max.value, 0.005);
  // The tip's edge reaches lam0 sin(beta) into the face, beta 39.8 to 49.8 deg; a point of the face
  // lies less deep in the cutter.
  EXPECT_LT(path->swept.root_face_min.value, -0.25);
  EXPECT_GT(path->swept.root_face_min.value, -0.5 * std::sin(49.8 * kRadPerDeg));
}

TEST(MillPathLaws, SameRequestSameAnswer) {
  MillPathSpec spec = few("A_source_like");
  spec.optimise.method = Method::annealing;
  const auto first = mill_path(spec), second = mill_path(spec);
  spec.optimise.seed = 2;
  const auto other = mill_path(spec);
  ASSERT_TRUE(first && second && other);
  ASSERT_EQ(first->positions.size(), second->positions.size());
  for (std::size_t i = 0; i < first->positions.size(); ++i)
    EXPECT_EQ(first->positions[i].at.z, second->positions[i].at.z);
  EXPECT_NE(first->positions[1].at.z, other->positions[1].at.z);
}

}  // namespace
}  // namespace tubecut::groove
