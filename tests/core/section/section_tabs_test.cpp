#include "core/part/section/section_tabs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/part/cut_edges.hpp"
#include "core/part/section/section_part.hpp"

/// Tabs on the ends of rectangular tubes: where their corners lie, how the beam passes next to
/// them, and what they weigh.
namespace tubecut::part::section_tabs {

using Random = std::mt19937;

double drawn(Random& random, double from, double to) {
  return std::uniform_real_distribution<double>(from, to)(random);
}

const section::Section kRail{.height = 60, .width = 40, .wall = 3, .corner = 6, .inner_corner = 3};

/// Both ends square on planes, which may lean.
SectionPartSpec rail(double kerf, double lean = 0.0) {
  SectionPartSpec out{.section = kRail, .length = 500.0};
  for (auto* end : {&out.start, &out.finish}) {
    end->cut.partners = {joint::PlaneCutter{{0, 0, 10}, {lean, 0.5 * lean, 1}}};
    end->cut.groove = bevel::SquareCut{};
    end->cut.contact = bevel::Contact::automatic;
    end->cut.smoothing = bevel::NoSmoothing{};
    end->cut.sampling.tolerance = joint::Tolerance{.value = 0.05};
    end->cut.kerf = kerf;
  }
  return out;
}

void expect_verified(const SectionPartSpec& spec, const SectionPart& part) {
  for (const auto& check : verify(spec, part))
    EXPECT_TRUE(std::abs(check.value) <= check.limit) << check.name << " " << check.value;
}

TEST(SectionTabs, TheTipIsALengthBeyondTheShoulder) {
  auto spec = rail(0.3);
  spec.start_tabs = {{.face = 1, .offset = 2.0, .width = 18.0, .length = 5.0}};
  spec.finish_tabs = {{.face = 2, .offset = -4.0, .width = 30.0, .length = 7.0},
                      {.face = 4, .offset = 5.0, .width = 10.0, .length = 7.0}};
  const auto part = section_part(spec);
  ASSERT_TRUE(part) << part.error().issues.front().hint;
  expect_verified(spec, *part);
  // Tip to tip, with both shoulders 10 mm within the work points.
  EXPECT_NEAR(part->lengths.longest, 500.0 - 20.0 + 5.0 + 7.0, 1e-9);
  EXPECT_NEAR(part->lengths.shortest, 480.0, 1e-9);
  EXPECT_NEAR(part->faces[0].length, 485.0, 1e-9);
  EXPECT_NEAR(part->lengths.blank, 480.0 + 12.0 + 2.0 * 0.3, 1e-9);
  const auto plain = section_part(rail(0.3));
  ASSERT_TRUE(plain);
  EXPECT_NEAR(part->lengths.volume - plain->lengths.volume,
              3.0 * (18.0 * 5.0 + 30.0 * 7.0 + 10.0 * 7.0), 1e-6);
  EXPECT_NEAR(part->lengths.weld, plain->lengths.weld, 1e-9);
}

TEST(SectionTabs, EdgesStepAtTheStatedPlacesOfTheFace) {
  auto spec = rail(0.3);
  spec.finish_tabs = {{.face = 2, .offset = -4.0, .width = 30.0, .length = 7.0}};
  const auto part = section_part(spec);
  ASSERT_TRUE(part);
  const auto outer = kRail.outer();
  const auto edge = edge_over_girth(part->finish.table, part->finish.table.z_outer);
  const auto z = [&](double offset) {
    return edge.at(outer.on_face(2, offset) / outer.girth() * kTwoPi);
  };
  const double shoulder = lowest(part->finish.table);
  for (const double inside : {-18.99, -4.0, 10.99}) {
    EXPECT_NEAR(z(inside).high, shoulder + 7.0, 1e-9) << inside;
    EXPECT_NEAR(z(inside).low, shoulder + 7.0, 1e-9) << inside;
  }
  for (const double beside : {-19.01, 11.01}) EXPECT_NEAR(z(beside).high, shoulder, 1e-9) << beside;
}

TEST(SectionTabs, TheBeamPassesHalfAKerfBesideEachSide) {
  for (const double kerf : {0.0, 0.3, 1.6}) {
    auto spec = rail(kerf);
    spec.start_tabs = {{.face = 3, .offset = 0.0, .width = 18.0, .length = 5.0}};
    const auto part = section_part(spec);
    ASSERT_TRUE(part) << kerf;
    expect_verified(spec, *part);
    const auto& t = part->start.table;
    const double middle = kRail.outer().on_face(3, 0.0);
    double least = 1e9, most = -1e9;  // of the steps of the torch
    for (std::size_t i = 0; i + 1 < t.at.size(); ++i) {
      if (t.at[i].s != t.at[i + 1].s || t.torch_outer[i] == t.torch_outer[i + 1]) continue;
      EXPECT_NEAR(std::abs(t.torch_outer[i] - t.torch_outer[i + 1]), 5.0, 1e-9);
      least = std::min(least, t.at[i].s - middle);
      most = std::max(most, t.at[i].s - middle);
    }
    EXPECT_NEAR(least, -9.0 - 0.5 * kerf, 1e-9);
    EXPECT_NEAR(most, 9.0 + 0.5 * kerf, 1e-9);
  }
}

TEST(SectionTabs, DrawnTabsOfLeaningEndsVerifyAndWeighTheirOwnMetal) {
  Random random(53);
  for (int i = 0; i < 12; ++i) {
    auto spec = rail(drawn(random, 0.1, 1.8), drawn(random, -0.8, 0.8));
    double metal = 0.0;
    for (auto* tabs : {&spec.start_tabs, &spec.finish_tabs}) {
      const int face = 1 + static_cast<int>(random() % 4);
      const double half = face % 2 == 1 ? 14.0 : 24.0;
      const double width = drawn(random, 4.0, 1.2 * half);
      const double room = half - 0.5 * (width + spec.start.cut.kerf) - 0.01;
      *tabs = {{face, drawn(random, -room, room), width, drawn(random, 2.0, 12.0)}};
      metal += 3.0 * width * tabs->front().length;
    }
    const auto part = section_part(spec);
    ASSERT_TRUE(part) << part.error().issues.front().member << part.error().issues.front().hint;
    expect_verified(spec, *part);
    auto plain = spec;
    plain.start_tabs = plain.finish_tabs = {};
    EXPECT_NEAR(part->lengths.volume - section_part(plain)->lengths.volume, metal, 1e-5);
  }
}

TEST(SectionTabs, OnASaddleTheTipIsTheSaddleMoved) {
  Random random(54);
  for (int i = 0; i < 12; ++i) {
    auto spec = rail(drawn(random, 0.1, 1.8));
    const double radius = drawn(random, 32.0, 120.0), lean = drawn(random, -35.0, 35.0);
    for (auto* end : {&spec.start, &spec.finish})
      end->cut.partners = {joint::TubeCutter{.radius = radius,
                                             .inclination = Angle::deg(90.0 + lean),
                                             .clocking = Angle::deg(i % 2 == 0 ? 0.0 : 90.0),
                                             .offset = 0.0}};
    double metal = 0.0;
    for (auto* tabs : {&spec.start_tabs, &spec.finish_tabs})
      for (const int face : {1, 2, 3, 4}) {
        tabs->push_back({face, 0.0, drawn(random, 6.0, 20.0), drawn(random, 2.0, 12.0)});
        metal += 3.0 * tabs->back().width * tabs->back().length;
      }
    const auto part = section_part(spec);
    ASSERT_TRUE(part) << part.error().issues.front().member << part.error().issues.front().hint;
    expect_verified(spec, *part);
    auto plain = spec;
    plain.start_tabs = plain.finish_tabs = {};
    const auto without = section_part(plain);
    EXPECT_NEAR(part->lengths.volume - without->lengths.volume, metal, 1e-5);
    // Everywhere on a tab the edge lies its length beyond the saddle.
    const auto outer = kRail.outer();
    const auto own = edge_over_girth(part->finish.table, part->finish.table.z_outer);
    const auto saddle = edge_over_girth(without->finish.table, without->finish.table.z_outer);
    const double shift = part->finish.corners[0] - without->finish.corners[0];  // of z = 0
    for (const auto& tab : spec.finish_tabs)
      for (const double share : {-0.49, 0.0, 0.3}) {
        const double turn = outer.on_face(tab.face, share * tab.width) / outer.girth() * kTwoPi;
        EXPECT_NEAR(own.at(turn).high, saddle.at(turn).high + tab.length + shift, 0.01) << tab.face;
      }
  }
}

TEST(SectionTabs, ATabOverTheDatumIsOneOfAnyFace) {
  auto spec = rail(0.3);
  spec.start_tabs = {{.face = 1, .offset = 0.0, .width = 18.0, .length = 5.0}};
  auto other = rail(0.3);
  other.start_tabs = {{.face = 3, .offset = 0.0, .width = 18.0, .length = 5.0}};
  const auto a = section_part(spec), b = section_part(other);
  ASSERT_TRUE(a && b);
  expect_verified(spec, *a);
  EXPECT_NEAR(a->lengths.volume, b->lengths.volume, 1e-6);
  EXPECT_NEAR(a->start.table.length_total, b->start.table.length_total, 1e-9);
  EXPECT_NEAR(a->start.table.length_total, a->start.shoulder->length_total + 10.0, 1e-9);
}

/// The beam leaves a radius of half its width at the tab's foot.
TEST(SectionTabs, AreAsLongAsTheBeamIsWide) {
  for (const double kerf : {0.3, 1.0, 2.5, 4.9}) {
    auto spec = rail(kerf);
    spec.start_tabs = {{.face = 1, .offset = 0.0, .width = 12.0, .length = kerf}};
    const auto part = section_part(spec);
    ASSERT_TRUE(part) << kerf;
    expect_verified(spec, *part);
    spec.start_tabs.front().length = 0.99 * kerf;
    const auto refused = section_part(spec);
    ASSERT_FALSE(refused) << kerf;
    EXPECT_EQ(refused.error().issues.front().member, "start/end_tabs/0/length");
  }
}

std::vector<std::pair<ErrorCode, std::string>> refusals(const SectionPartSpec& spec) {
  std::vector<std::pair<ErrorCode, std::string>> out;
  const auto part = section_part(spec);
  if (!part)
    for (const auto& issue : part.error().issues) out.emplace_back(issue.code, issue.member);
  return out;
}

TEST(SectionTabs, AreRefusedAtTheirOwnFieldAllAtOnce) {
  auto spec = rail(0.3);
  spec.start_tabs = {{1, 0.0, 28.0, 5.0}, {2, 0.0, 20.0, 5.0}, {2, 20.1, 20.0, 5.0}};
  const auto got = refusals(spec);
  ASSERT_EQ(got.size(), 3u);
  EXPECT_EQ(got[0], std::pair(ErrorCode::out_of_range, std::string("start/end_tabs/0/width")));
  EXPECT_EQ(got[1], std::pair(ErrorCode::out_of_range, std::string("start/end_tabs/2/width")));
  EXPECT_EQ(got[2], std::pair(ErrorCode::out_of_range, std::string("start/end_tabs/2/offset")));
  auto bent = rail(0.3);  // over the edge between two planes
  bent.start.cut.partners = {joint::PlaneCutter{{0, 0, 10}, {0.3, 0, 1}},
                             joint::PlaneCutter{{0, 0, 10}, {-0.3, 0, 1}}};
  bent.start_tabs = {{1, 0.0, 18.0, 5.0}, {2, 0.0, 18.0, 5.0}};
  const auto over_edge = refusals(bent);
  ASSERT_EQ(over_edge.size(), 1u);
  EXPECT_EQ(over_edge[0],
            std::pair(ErrorCode::unsupported_combination, std::string("start/end_tabs/1")));
  auto bevelled = rail(0.3);
  bevelled.start.cut.groove = bevel::NoGroove{};
  bevelled.start_tabs = {{1, 0.0, 18.0, 5.0}};
  EXPECT_EQ(refusals(bevelled), std::vector(1, std::pair(ErrorCode::unsupported_combination,
                                                         std::string("start/groove"))));
}

}  // namespace tubecut::part::section_tabs
