#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "core/joint/contour.hpp"
#include "core/joint/length.hpp"
#include "core/joint/placement.hpp"
#include "core/joint/sampling.hpp"
#include "tests/core/joint/published.hpp"

namespace tubecut::joint {
namespace {

using testing::at;
using testing::number;
using testing::numbers;

bool near_event(const Contour& contour, double phi) {
  for (const auto& event : contour.events)
    if (std::abs(event.phi - phi) < 1e-9) return true;
  return false;
}

void expect_profile(const api::Json& golden, const std::string& block, const Contour& contour) {
  const auto phi = numbers(golden, block + "/phi");
  const auto z = numbers(golden, block + "/z");
  const auto tube = numbers(golden, block + "/tube");
  ASSERT_EQ(phi.size(), 360U);
  for (std::size_t i = 0; i < phi.size(); ++i) {
    const double at_phi = phi[i] * kRadPerDeg;
    if (near_event(contour, at_phi)) continue;
    const auto got = contact_at(contour, at_phi);
    EXPECT_NEAR(got.z, z[i], 1e-10) << block << i;
    EXPECT_EQ(got.cutter, static_cast<std::size_t>(tube[i])) << block << i;
    const auto top = highest(contour.cutters, generator_at(contour.radius, at_phi));
    ASSERT_TRUE(top);
    EXPECT_EQ(top->cutter, got.cutter);
    EXPECT_EQ(top->z, got.z);
  }
}

void expect_events(const api::Json& golden, const std::string& list, const Contour& contour) {
  const auto* want = at(golden, list).as<api::Json::Array>();
  ASSERT_NE(want, nullptr);
  ASSERT_EQ(contour.events.size(), want->size()) << list;
  for (std::size_t i = 0; i < want->size(); ++i) {
    const auto& event = contour.events[i];
    const bool jump = testing::text((*want)[i], "kind") == "jump";
    EXPECT_EQ(event.kind, jump ? EventKind::jump : EventKind::junction);
    EXPECT_NEAR(event.phi, number((*want)[i], "phi_deg_mp") * kRadPerDeg, 1e-12) << list << i;
    EXPECT_NEAR(event.z_from, number((*want)[i], "z0"), jump ? 1e-5 : 1e-10);
    EXPECT_NEAR(event.z_to, number((*want)[i], "z1"), jump ? 1e-5 : 1e-10);
    EXPECT_EQ(event.from, static_cast<std::size_t>(number((*want)[i], "k0")));
    EXPECT_EQ(event.to, static_cast<std::size_t>(number((*want)[i], "k1")));
  }
}

TEST(Golden, Table1OuterAndInner) {
  const auto golden = testing::golden(kGolden);
  for (const std::string block : {"seed000_table1_r35", "seed000_table1_r30"}) {
    const auto contour = trace(table1(), number(golden, block + "/rho"));
    ASSERT_TRUE(contour);
    expect_profile(golden, block, *contour);
    expect_events(golden, block + "/events", *contour);
    EXPECT_NEAR(true_length(*contour), number(golden, block + "/arc_length_true"), 1e-9) << block;
  }
}

TEST(Golden, Eccentric) {
  const auto golden = testing::golden(kGolden);
  const auto cutters = eccentric_cutters(golden);
  const auto outer = trace(cutters, number(golden, "eccentric/rho"));
  ASSERT_TRUE(outer);
  expect_profile(golden, "eccentric", *outer);
  expect_events(golden, "eccentric/events", *outer);
  EXPECT_NEAR(true_length(*outer), number(golden, "eccentric/arc_length_true"), 1e-9);
  const auto inner = trace(cutters, number(golden, "eccentric/r_in"));
  ASSERT_TRUE(inner);
  expect_events(golden, "eccentric/events_r_in", *inner);
  const auto z_in = numbers(golden, "eccentric/wall/z_in");
  ASSERT_EQ(z_in.size(), 360U);
  for (std::size_t i = 0; i < z_in.size(); ++i)
    EXPECT_NEAR(contact_at(*inner, Angle::deg(static_cast<double>(i)).rad()).z, z_in[i], 1e-10);
}

Eigen::Vector3d vector(const api::Json& golden, const std::string& path) {
  const auto v = numbers(golden, path);
  return {v.at(0), v.at(1), v.at(2)};
}

TEST(Golden, Node) {
  const auto golden = testing::golden(kGolden);
  const auto frame = member_frame(vector(golden, "node/p_cut"), vector(golden, "node/p_far"),
                                  vector(golden, "node/phase_ref"));
  ASSERT_TRUE(frame);
  std::vector<Cutter> cutters;
  for (const std::string i : {"0", "1"}) {
    const auto row = vector(golden, "node/frame_rows/" + i);
    EXPECT_LT((frame->rows.row(std::stoi(i)).transpose() - row).norm(), 1e-15);
    const auto a = vector(golden, "node/members/" + i + "/A");
    const auto b = vector(golden, "node/members/" + i + "/B");
    const auto placed =
        place(frame->local(AxisLine{a, b - a}), number(golden, "node/members/" + i + "/r"));
    ASSERT_TRUE(placed);
    const std::string want = "node/cutters/" + i;
    EXPECT_NEAR(placed->tube.inclination.deg(), number(golden, want + "/alpha"), 1e-9);
    EXPECT_NEAR(placed->tube.clocking.deg(), number(golden, want + "/beta"), 1e-9);
    EXPECT_NEAR(placed->tube.offset, number(golden, want + "/s"), 1e-10);
    EXPECT_NEAR(placed->tube.height, number(golden, want + "/h"), 1e-10);
    if (i == "1") {
      EXPECT_NEAR(placed->point_axial, number(golden, want + "/wmin"), 1e-10);
    }
    cutters.emplace_back(placed->tube);
  }
  const auto contour = trace(cutters, number(golden, "node/rho"));
  ASSERT_TRUE(contour);
  const auto z = numbers(golden, "node/z_phi0_30_60_etc");
  const auto tube = numbers(golden, "node/tube");
  ASSERT_EQ(z.size(), 12U);
  for (std::size_t i = 0; i < z.size(); ++i) {
    const auto got = contact_at(*contour, Angle::deg(30.0 * static_cast<double>(i)).rad());
    EXPECT_NEAR(got.z, z[i], 1e-10);
    EXPECT_EQ(got.cutter, static_cast<std::size_t>(tube[i]));
  }
}

TEST(Golden, OffsetPairOfThePatent) {
  const auto golden = testing::golden(kGolden);
  const auto cutter = tube_deg(number(golden, "seed002/R"), number(golden, "seed002/alpha"), 90,
                               -number(golden, "seed002/e"));
  const auto contour =
      trace(std::vector<Cutter>{cutter}, number(golden, "seed002/r") - number(golden, "seed002/t"));
  ASSERT_TRUE(contour);
  EXPECT_TRUE(contour->events.empty());
  const auto z = numbers(golden, "seed002/z");
  ASSERT_EQ(z.size(), 360U);
  for (std::size_t i = 0; i < z.size(); ++i)
    EXPECT_NEAR(contact_at(*contour, Angle::deg(static_cast<double>(i)).rad()).z, z[i], 1e-10);
}

TEST(Golden, AdaptiveCountsAndLengthsOfTable1) {
  const auto contour = trace(table1(), 35.0);
  ASSERT_TRUE(contour);
  const std::map<double, std::size_t> counts{{0.1, 59}, {0.01, 210}, {0.001, 591}};
  for (const auto& [tolerance, count] : counts) {
    const auto samples = sample(*contour, {.tolerance = Tolerance{.value = tolerance}});
    ASSERT_TRUE(samples);
    EXPECT_EQ(samples->nodes.size(), count) << tolerance;
  }
  const auto samples = sample(*contour, {.uniform_points = 360});
  ASSERT_TRUE(samples);
  EXPECT_NEAR(samples->true_length, 290.932586, 5e-7);
  EXPECT_NEAR(samples->developed_length, 219.911486, 5e-7);
}

}  // namespace
}  // namespace tubecut::joint
