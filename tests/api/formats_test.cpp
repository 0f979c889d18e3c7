#include <gtest/gtest.h>

#include "api/endpoint.hpp"
#include "api/formats/sheet.hpp"
#include "api/formats/text.hpp"
#include "tests/support/call.hpp"

namespace tubecut::testing {
namespace {

constexpr const char* kPath = "/v1/bevel-tables";

std::string table_1() { return api::dump(example("bevel-tables/source-000-table-1.json")); }

std::string detail(const Posted& answer) {
  return answer.outcome.error ? text(answer.body, "detail") : "";
}

TEST(Formats, EveryFormatOfEveryEndpointHasAName) {
  for (const auto& endpoint : api::endpoints())
    for (const auto& format : endpoint.formats) {
      EXPECT_FALSE(format.name.empty()) << endpoint.id;
      EXPECT_NE(format.media.find('/'), std::string_view::npos) << format.name;
    }
}

TEST(Formats, AreChosenByNameOrByAccept) {
  for (const auto& endpoint : api::endpoints()) {
    if (endpoint.id != "bevel-tables") continue;
    EXPECT_GE(endpoint.formats.size(), 7U);
    for (const auto& format : endpoint.formats) {
      const std::string speed = format.needs_speed ? "speed_mm_min=600" : "";
      const auto named = post(kPath, table_1(), "format=" + std::string(format.name) + "&" + speed);
      const auto accepted = post(kPath, table_1(), speed, format.media);
      EXPECT_EQ(named.outcome.content_type, format.media);
      EXPECT_EQ(accepted.outcome.content_type, format.media);
      EXPECT_EQ(named.outcome.body, accepted.outcome.body);
      EXPECT_FALSE(named.outcome.body.empty());
    }
  }
}

TEST(Formats, AcceptGoesByWeightThenByOrder) {
  const auto media = [](std::string_view accept) {
    return post(kPath, table_1(), "", accept).outcome.content_type;
  };
  EXPECT_EQ(media("text/plain, text/csv;q=0.5, image/svg+xml; q=0.9"), "image/svg+xml");
  EXPECT_EQ(media("text/csv, application/json"), "text/csv");
  EXPECT_EQ(media("application/json;q=0, Text/CSV"), "text/csv");
  EXPECT_EQ(media("text/csv;q=0"), "application/problem+json");
}

TEST(Formats, EveryViewIsAnother) {
  for (const auto& endpoint : api::endpoints()) {
    if (endpoint.id != "bevel-tables") continue;
    for (const auto& format : endpoint.formats) {
      std::vector<std::string> seen;
      for (const auto view : format.views) {
        const auto query = "format=" + std::string(format.name) + "&view=" + std::string(view);
        const auto answer = post(kPath, table_1(), query);
        EXPECT_FALSE(answer.outcome.error) << query;
        for (const auto& other : seen) EXPECT_NE(answer.outcome.body, other) << query;
        seen.push_back(answer.outcome.body);
      }
      if (format.views.empty() || format.needs_speed) continue;
      const auto plain = post(kPath, table_1(), "format=" + std::string(format.name));
      EXPECT_EQ(plain.outcome.body, seen.front()) << format.name;
    }
  }
}

TEST(Formats, AnUnknownViewIsNotAcceptableAndListsThoseThereAre) {
  const auto answer = post(kPath, table_1(), "format=svg&view=plan");
  EXPECT_EQ(text(answer.body, "code"), "not_acceptable");
  EXPECT_NE(detail(answer).find("chart, template, section"), std::string::npos);
  const auto none = post(kPath, table_1(), "format=nc1&view=plan");
  EXPECT_NE(detail(none).find("offered: none"), std::string::npos);
}

TEST(Formats, OptionsAreReadStrictlyAndOnlyByDrawings) {
  for (const auto* query :
       {"format=svg&mirror=yes", "format=gcode&speed_mm_min=0", "format=gcode&speed_mm_min=6e9",
        "format=gcode&speed_mm_min=600x", "format=gcode&speed_mm_min=nan",
        "format=gcode&speed_mm_min=600&torch=true", "format=gcode&speed_mm_min=600&axial=y",
        "format=gcode&speed_mm_min=600&dialect=fanuc", "format=gcode&speed_mm_min=600&lead_mm=-1",
        "format=gcode&speed_mm_min=600&pivot_length_mm=1e9", "format=gcode", "mirror=true",
        "format=csv&mirror=true", "format=svg&torch=on", "format=cbor&axial=x"})
    EXPECT_EQ(text(post(kPath, table_1(), query).body, "code"), "bad_request") << query;
}

TEST(Formats, TextIsHarmlessInEveryLanguage) {
  EXPECT_EQ(api::xml_text("a<b>&\"c\x01"), "a&lt;b&gt;&amp;&quot;c_");
  EXPECT_EQ(api::dxf_text("50%%c\\U+0041^J\n"), "50%%%%%%c\\U+005CU+0041^ J_");
  EXPECT_EQ(api::xml_text("'"), "&#39;");
  EXPECT_EQ(api::step_text("a'b\\c\x01"), "a''b\\\\c_");
  EXPECT_EQ(api::step_text("\xc3\xa4\xf0\xa0\xae\xb7"), "\\X2\\00E4\\X0\\\\X4\\00020BB7\\X0\\");
  for (const auto text : {&api::gcode_text, &api::dstv_text, &api::structured_text_text}) {
    EXPECT_TRUE(text("a)(MSG,x);[1]\n\xc3\xa9").starts_with("a__MSG,x___1__e"));
    EXPECT_EQ(text("*) VAR x (* {p} $'\"%~"), "__ VAR x __ _p_ _____");
  }
  EXPECT_EQ(api::dstv_text("   "), "-");
}

TEST(Formats, ACellOfTextIsNeverComputed) {
  EXPECT_EQ(api::csv_text("B1"), "B1");
  EXPECT_EQ(api::csv_text("a-b=c"), "a-b=c");
  EXPECT_EQ(api::csv_text("=1+1"), "'=1+1");
  EXPECT_EQ(api::csv_text("  -1"), "  '-1");
  EXPECT_EQ(api::csv_text("'=1"), "''=1");
  EXPECT_EQ(api::csv_text("a,b"), "\"a,b\"");
  EXPECT_EQ(api::csv_text("a; @x|+y"), "\"a; '@x|'+y\"");
  EXPECT_EQ(api::csv_text("\"=1\""), "\"\"\"'=1\"\"\"");
}

TEST(Formats, FixedNumbersHaveNoNegativeZero) {
  EXPECT_EQ(api::fixed(-0.0001, 3), "0.000");
  EXPECT_EQ(api::fixed(-0.0006, 3), "-0.001");
  EXPECT_EQ(api::fixed(1e6 + 0.125, 3), "1000000.125");
}

TEST(Formats, DrawingScalesAreTheUsualOnesAndFit) {
  for (const double size : {0.5, 3.0, 19.9, 20.0, 150.0, 4999.0, 1e6}) {
    const auto scale = api::drawing_scale(size, 40.0);
    EXPECT_LE(size * scale.factor, 40.0 * (1.0 + 1e-12)) << size;
    if (scale.factor < 50.0) {
      EXPECT_GT(size * scale.factor, 40.0 / 2.6) << size;
    }
  }
  EXPECT_EQ(api::drawing_scale(30.0, 40.0).name, "1:1");
  EXPECT_EQ(api::drawing_scale(15.0, 40.0).name, "2:1");
  EXPECT_EQ(api::drawing_scale(350.0, 40.0).name, "1:10");
}

}  // namespace
}  // namespace tubecut::testing
