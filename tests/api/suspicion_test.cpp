#include "api/suspicion.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <random>

#include "api/api.hpp"
#include "tests/support/call.hpp"

namespace tubecut::api {
namespace {

using testing::example;
using testing::post;
using testing::with;

std::string suspects(const std::string& text) {
  std::string out;
  for (const auto& warning : unit_suspicions(parse(text).value())) {
    out += warning.member + ": " + warning.detail + "\n";
  }
  return out;
}

TEST(Suspicion, FallsOnOtherUnits) {
  EXPECT_EQ(suspects(R"({"target":{"outer_diameter_mm":6.625,"wall_mm":0.5}})"),
            "target/outer_diameter_mm: 6.625 looks like inches: 168.275 mm\n");
  EXPECT_EQ(suspects(R"({"cutters":[{},{"outer_diameter_mm":70,"inclination_deg":1.5708}]})"),
            "cutters/1/inclination_deg: 1.5708 looks like rad: 90 deg\n");
  EXPECT_EQ(suspects(R"({"cutters":[{"clocking_deg":-0.785}]})"),
            "cutters/0/clocking_deg: -0.785 looks like rad: -45 deg\n");
  EXPECT_EQ(suspects(R"({"target":{"outer_diameter_mm":70,"length_mm":0.4}})"),
            "target/length_mm: 0.4 looks like metres: 400 mm\n");
  EXPECT_EQ(
      suspects(R"({"members":[{"start_mm":[0,0,0],"end_mm":[3,4,0],"outer_diameter_mm":219.1}]})"),
      "members/0/end_mm: 5 looks like metres: 5000 mm between the ends\n");
}

TEST(Suspicion, IgnoresPlausibleValues) {
  for (
      const auto* text :
      {R"({"target":{"outer_diameter_mm":114.3,"wall_mm":6.3,"length_mm":400}})",
       R"({"target":{"outer_diameter_mm":600,"wall_mm":0.5}})",
       R"({"target":{"outer_diameter_mm":70,"length_mm":40}})",
       R"({"cutters":[{"inclination_deg":90,"clocking_deg":0},{"inclination_deg":1.5,"clocking_deg":2}]})",
       R"({"cutters":[{"inclination_deg":0.9,"clocking_deg":3}]})",
       R"({"members":[{"start_mm":[0,0,0],"end_mm":[0,0,0],"outer_diameter_mm":60.3}]})"}) {
    EXPECT_EQ(suspects(text), "") << text;
  }
  for (const auto& example : examples())
    EXPECT_EQ(suspects(std::string(example.body)), "") << example.name;
  for (const auto* golden :
       {"feed-curves", "grooves-and-milling", "intersections-and-bevels", "pulse-schedules"}) {
    const auto file = "tests/golden/" + std::string(golden) + ".json";
    EXPECT_EQ(suspects(testing::read_project_file(file)), "") << golden;
  }
}

// Angles as people write them in radians, to any number of decimals, and angles that were computed,
// which lie as near to a round one and have all their digits.
TEST(Suspicion, DistinguishesTypedFromComputedNumbers) {
  std::mt19937_64 random{20261127};
  const auto angle = [](const std::string& digits) {
    return suspects(R"({"cutters":[{"clocking_deg":)" + digits + "}]}");
  };
  int written = 0, computed = 0;
  for (int i = 0; i < 400; ++i) {
    const int fifteens = std::uniform_int_distribution<int>(1, 23)(random);
    const double rad = fifteens * 15.0 * std::acos(-1.0) / 180.0;
    std::array<char, 40> text{};
    const int decimals = std::uniform_int_distribution<int>(4, 15)(random);
    std::snprintf(text.data(), text.size(), "%.*f", decimals, rad);
    EXPECT_NE(angle(text.data()), "") << text.data();
    ++written;
    const double off = std::uniform_real_distribution<double>(2e-9, 1e-3)(random);
    std::snprintf(text.data(), text.size(), "%.11f", rad * (i % 2 == 0 ? 1.0 + off : 1.0 - off));
    EXPECT_EQ(angle(text.data()), "") << text.data();
    ++computed;
  }
  EXPECT_EQ(written + computed, 800);
}

// A brace whose chords are turned by 1.5708 deg to each other: the service computes that clocking.
TEST(Suspicion, SparesTheNumbersOfAFramesParts) {
  const auto text = testing::read_project_file("tests/field/unit_suspicion_of_own_number.json");
  const auto answer = post("/v1/frames", parse(text).value());
  ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 800);
  EXPECT_EQ(answer.outcome.body.find("unit_suspicion"), std::string::npos);
  EXPECT_EQ(testing::text(answer.body, "verdict/status"), "ok");
}

// A table at an odd place on site: all its coordinates differ by typed lengths, so that 1234.567,
// which is 31358 mm were it inches, is one chance and not three. Metric lengths in inches are not.
TEST(Suspicion, CountsLengthsThatDifferByTypedOnesOnce) {
  const auto members = [](const std::string& a, const std::string& b, const std::string& c) {
    return suspects(R"({"members":[{"start_mm":[)" + a + "," + a + R"(,0.1],"end_mm":[)" + b + "," +
                    c + R"(,0.1]}]})");
  };
  EXPECT_EQ(members("1234.567", "2034.567", "1734.567"), "");
  EXPECT_NE(members("11.811", "19.685", "33.465"), "");
}

// One rail of a round length: two odd coordinates that are near round lengths were they inches are
// chance, and a default of 0.02 mm is no third. The same rail in inches has nothing round in mm.
TEST(Suspicion, TakesRoundCoordinatesForMillimetres) {
  const auto rail = [](const std::string& from, const std::string& to, const std::string& y,
                       const std::string& z) {
    return suspects(R"({"alike_within_mm":0.02,"members":[{"start_mm":[)" + from + "," + y + "," +
                    z + R"(],"end_mm":[)" + to + "," + y + "," + z + "]}]}");
  };
  const auto inches = [](double mm) {
    std::array<char, 40> out{};
    std::snprintf(out.data(), out.size(), "%.3f", mm / 25.4);
    return std::string(out.data());
  };
  std::mt19937_64 random{20261130};
  const auto any = [&](int from, int to) {
    return std::uniform_int_distribution<int>(from, to)(random);
  };
  int metric = 0, imperial = 0;
  for (int i = 0; i < 200; ++i) {
    const auto y = inches(0.5 * any(200, 4000)), z = inches(0.5 * any(4000, 40000));
    const auto from = std::to_string(5 * any(1, 40)), to = std::to_string(5 * any(100, 400));
    if (!rail(from, to, y, z).empty()) ++metric;
    if (!rail(inches(std::stod(from)), inches(std::stod(to)), y, z).empty()) ++imperial;
  }
  EXPECT_EQ(metric, 0);
  EXPECT_GT(imperial, 180);  // but where lengths are round in inches too
  EXPECT_EQ(suspects(R"({"members":[{"start_mm":[-146.063,155.807,180],"height_mm":40,"wall_mm":3,
                                     "end_mm":[-4.646,-631.594,180]}]})"),
            "");
}

/// The unit_suspicion warnings of an answer, each "pointer: detail".
std::string warned(const Json& answer) {
  std::string out;
  for (const auto& warning : *testing::at(answer, "warnings").as<Json::Array>()) {
    if (testing::text(warning, "code") != "unit_suspicion") continue;
    out += testing::text(warning, "pointer") + ": " + testing::text(warning, "detail") + "\n";
  }
  return out;
}

// A request that runs, and the same with a value off by each factor, as a client gets it wrong.
TEST(Suspicion, IsInTheAnswer) {
  const auto mitre = example("bevel-tables/mitre.json");
  const auto saddle = example("bevel-tables/source-000-table-1.json");
  const auto node = example("nodes/k-joint-from-centre-lines.json");
  const auto tube = [&](double diameter) {
    return with(with(mitre, "target/outer_diameter_mm", diameter), "target/wall_mm", 0.5);
  };
  const auto metres = with(with(node, "members/0/start_mm", Json::Array{-1.5, 0.0, 0.0}),
                           "members/0/end_mm", Json::Array{1.5, 0.0, 0.0});
  auto named = example("nodes/mitre.json");
  for (const auto* end : {"members/0/start_mm/2", "members/1/end_mm/0", "members/1/end_mm/2"})
    named = with(named, end, testing::number(named, end) / 1000.0);
  const struct {
    std::string_view path;
    Json request;
    std::string_view warning;
  } rows[] = {
      {"/v1/bevel-tables", mitre, ""},
      {"/v1/bevel-tables", saddle, ""},
      {"/v1/nodes", node, ""},
      {"/v1/bevel-tables", tube(6.625),
       "/target/outer_diameter_mm: 6.625 looks like inches: 168.275 mm\n"},
      {"/v1/bevel-tables", tube(219.1), "/target/wall_mm: 0.5 looks like inches: 12.7 mm\n"},
      {"/v1/bevel-tables", with(saddle, "cutters/0/clocking_deg", 0.785),
       "/cutters/0/clocking_deg: 0.785 looks like rad: 45 deg\n"},
      {"/v1/nodes", metres, "/members/0/end_mm: 3 looks like metres: 3000 mm between the ends\n"},
      {"/v1/nodes", named,
       "/members/0/end_mm: 0.8 looks like metres: 800 mm between the ends\n"
       "/members/1/end_mm: 0.9486832980505138 looks like metres: 948.683 mm between the ends\n"},
  };
  for (const auto& row : rows) {
    const auto answer = post(row.path, row.request);
    ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 800);
    EXPECT_EQ(warned(answer.body), row.warning);
    if (!row.warning.empty()) {
      EXPECT_EQ(testing::text(answer.body, "verdict/status"), "review");
    }
  }
}

TEST(Suspicion, SuggestsAUnitIfAValueIsOutOfRange) {
  EXPECT_EQ(other_unit_hint(4.5, "mm", 5, 5000), "; were it inches: 114.3 mm");
  EXPECT_EQ(other_unit_hint(0.1143, "mm", 5, 5000), "; were it metres: 114.3 mm");
  EXPECT_EQ(other_unit_hint(114300, "mm", 5, 5000), "; were it micrometres: 114.3 mm");
  EXPECT_EQ(other_unit_hint(0.2191, "mm", 5, 5000), "; were it metres: 219.1 mm");
  EXPECT_EQ(other_unit_hint(0.323, "mm", 1, 5000), "; were it metres: 323 mm, or inches: 8.204 mm");
  EXPECT_EQ(other_unit_hint(1.5708, "deg", 5, 90), "; were it radians: 90 deg");
  EXPECT_EQ(other_unit_hint(1.4, "deg", 5, 90), "");
  EXPECT_EQ(other_unit_hint(67.0, "rad", 0, 3.14), "; were it degrees: 1.169 rad");
  EXPECT_EQ(other_unit_hint(-4.5, "mm", 5, 5000), "");
  EXPECT_EQ(other_unit_hint(0, "mm", 5, 5000), "");
}

}  // namespace
}  // namespace tubecut::api
