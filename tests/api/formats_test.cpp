#include <gtest/gtest.h>

#include "api/catalog/post.hpp"
#include "api/endpoint.hpp"
#include "api/formats/csv.hpp"
#include "api/formats/drawing/labels.hpp"
#include "api/formats/drawing/pdf_sheets.hpp"
#include "api/formats/drawing/sheet.hpp"
#include "api/formats/drawing/svg_sheets.hpp"
#include "api/formats/drawing/tiles.hpp"
#include "api/formats/dxf/dxf_writer.hpp"
#include "api/formats/numbers.hpp"
#include "api/formats/text.hpp"
#include "api/stop.hpp"
#include "api/wire/cbor.hpp"
#include "api/wire/text_encoding.hpp"
#include "api/wire/words.hpp"
#include "core/base/angle.hpp"
#include "tests/support/call.hpp"
#include "tests/support/cancelled.hpp"

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

TEST(Formats, NumbersForPeopleAreShort) {
  using api::Unit;
  EXPECT_EQ(api::mm(411.604999), "411.6 mm");
  EXPECT_EQ(api::mm(-0.0004), "< 0.001 mm");
  EXPECT_EQ(api::mm(-1e-12), "0 mm");
  EXPECT_EQ(api::mm(0.004), "0.004 mm");
  EXPECT_EQ(api::mm(123456.789), "123457 mm");
  EXPECT_EQ(api::mm(1234567.89), "1234570 mm");
  EXPECT_EQ(api::mm(9999.996), "10000 mm");
  EXPECT_EQ(api::measure(269.99999999999994, Unit::deg), "270°");
  EXPECT_EQ(api::degrees(-kPi / 7.0), "-25.7°");
  EXPECT_EQ(api::measure(0.0123456, Unit::s), "0.012 s");
  EXPECT_EQ(api::measure(123.456, Unit::s), "123.5 s");
  EXPECT_EQ(api::number(1234.5678), "1235");
  EXPECT_EQ(api::number(360.0), "360");
  EXPECT_EQ(api::number(7.1e-15), "0");
  EXPECT_EQ(api::number(2e-8), "< 0.001");
}

TEST(Formats, SentencesForPeopleNameNoField) {
  EXPECT_EQ(api::in_plain_words("root_opens at /cutters/1/wall_mm: by up to 2.3094010767585047 mm, "
                                "at phi 269.99999999999994 deg"),
            "root opens at partners 2, wall: by up to 2.31 mm, at phi 270°");
  EXPECT_EQ(api::in_plain_words("max_b_deg: 41.6988 above 0.5, my_tube-4x4.2"),
            "B at most: 41.7° above 0.5°, my tube-4x4.2");
  EXPECT_EQ(api::called("torch_range_binds", api::Term::value), "torch range binds");
  EXPECT_EQ(api::called("no_such_name", api::Term::field), "no such name");
}

TEST(Formats, LabelsAreSpreadAndKeepTheirOrder) {
  const auto places = api::spread({10.0, 10.5, 30.0, 99.0, 11.0}, 3.0, 0.0, 100.0);
  EXPECT_EQ(places, (std::vector<double>{7.5, 10.5, 30.0, 99.0, 13.5}));
  const auto crowded = api::spread(std::vector<double>(11, 5.0), 3.0, 0.0, 20.0);
  for (std::size_t i = 0; i < crowded.size(); ++i)
    EXPECT_NEAR(crowded[i], 2.0 * static_cast<double>(i), 1e-12);
  const auto at_the_edge = api::spread({-5.0, -4.0}, 3.0, 0.0, 20.0);
  EXPECT_EQ(at_the_edge, (std::vector<double>{0.0, 3.0}));
}

TEST(Formats, APdfSpellsLettersThatItsFontsLack) {
  api::Canvas sheet(50.0, 20.0);
  sheet.text({1.0, 1.0}, "(30\u00b0) \u0159");
  const auto pdf = api::print_pdf({sheet}, "a");
  EXPECT_NE(pdf.find("(\\05030\\260\\051 r)"), std::string::npos);
  api::Canvas other(50.0, 20.0);
  other.text({1.0, 1.0}, "\u7ba1");
  EXPECT_THROW((void)api::print_pdf({other}, "a"), api::Unspellable);
}

/// Between two looks at the budget lies one line of a drawing, not its pages: a template of 20 000
/// points on A4 took 0.2 s to lay and print.
TEST(Formats, DrawingsEndAtTheirLimits) {
  api::Canvas sheet(500.0, 500.0), other(500.0, 500.0);
  sheet.line({0.0, 0.0}, {400.0, 400.0});
  const api::DrawingBox window{{0.0, 0.0}, {500.0, 500.0}};
  const api::TemplateDrawing drawing{sheet, sheet};
  const api::TemplateLabels labels({}, {}, {}, "");
  EXPECT_GT(api::tiles(drawing, labels, api::Paper::a4, {}).size(), 1U);
  const CancelledScope cancelled;
  EXPECT_THROW((void)api::tiles(drawing, labels, api::Paper::a4, {}), api::Stopped);
  EXPECT_THROW(other.place(sheet, {0.0, 0.0}, {}, window), api::Stopped);
  EXPECT_THROW((void)api::print_svg({sheet}, "a"), api::Stopped);
  EXPECT_THROW((void)api::print_pdf({sheet}, "a"), api::Stopped);
}

/// A cancelled job draws no more: a work order of 20 000 points took 42 ms to lay out.
TEST(Formats, ACancelledJobDrawsNothing) {
  api::Canvas sheet(500.0, 500.0);
  sheet.line({0.0, 0.0}, {400.0, 400.0});
  const CancelledScope cancelled;
  EXPECT_THROW(sheet.line({0.0, 0.0}, {400.0, 400.0}), api::Stopped);
  EXPECT_THROW(sheet.polyline({{0.0, 0.0}, {400.0, 400.0}}), api::Stopped);
  EXPECT_THROW(sheet.text({0.0, 0.0}, "a"), api::Stopped);
  EXPECT_THROW(sheet.begin_clip({0.0, 0.0}, {1.0, 1.0}), api::Stopped);
  EXPECT_EQ(sheet.drawn().size(), 1U);
}

/// Columns of a million numbers are copied into a CSV: 37 ms.
TEST(Formats, ACsvCanBeCancelledBetweenColumns) {
  const api::Caption caption{};
  const auto columns = api::Columns().column("a", {1.0, 2.0});
  api::Csv csv(caption);
  csv.table(columns).stacked("b", {{"c", columns}});
  const CancelledScope cancelled;
  EXPECT_THROW(csv.table(columns), api::Stopped);
  EXPECT_THROW(csv.stacked("b", {{"c", columns}}), api::Stopped);
}

/// A program of a frame's longest leads has 5 MB.
TEST(Formats, AProgramsBlocksAreNumbered) {
  std::string program;
  for (int i = 0; i < 20000; ++i) program += "G1 X" + std::to_string(i) + "\n";
  api::Post post;
  post.comment_begin = "(";
  const auto* const bytes = program.data();
  program = post.numbered(std::move(program));
  EXPECT_EQ(program.data(), bytes) << "without numbers it is the same text, not a copy";
  post.block_numbers = 10;
  const auto numbered = post.numbered(program);
  EXPECT_TRUE(numbered.starts_with("N10 G1 X0\nN20 G1 X1\n"));
  EXPECT_TRUE(numbered.ends_with("\nN200000 G1 X19999\n"));
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
