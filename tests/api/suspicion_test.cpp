#include "api/suspicion.hpp"

#include <gtest/gtest.h>

#include "api/api.hpp"

namespace tubecut::api {
namespace {

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

TEST(Suspicion, SparesWhatIsPlausible) {
  for (
      const auto* text :
      {R"({"target":{"outer_diameter_mm":114.3,"wall_mm":6.3,"length_mm":400}})",
       R"({"target":{"outer_diameter_mm":70,"length_mm":40}})",
       R"({"cutters":[{"inclination_deg":90,"clocking_deg":0},{"inclination_deg":1.5,"clocking_deg":2}]})",
       R"({"cutters":[{"inclination_deg":0.9,"clocking_deg":3}]})",
       R"({"members":[{"start_mm":[0,0,0],"end_mm":[0,0,0],"outer_diameter_mm":60.3}]})"}) {
    EXPECT_EQ(suspects(text), "") << text;
  }
  for (const auto& example : examples())
    EXPECT_EQ(suspects(std::string(example.body)), "") << example.name;
}

TEST(Suspicion, HelpsWhereAValueIsOutOfRange) {
  EXPECT_EQ(other_unit_hint(4.5, 5, 5000), "; were it inches: 114.3 mm");
  EXPECT_EQ(other_unit_hint(0.1143, 5, 5000), "; were it metres: 114.3 mm");
  EXPECT_EQ(other_unit_hint(114300, 5, 5000), "; were it micrometres: 114.3 mm");
  EXPECT_EQ(other_unit_hint(-4.5, 5, 5000), "");
  EXPECT_EQ(other_unit_hint(0, 5, 5000), "");
}

}  // namespace
}  // namespace tubecut::api
