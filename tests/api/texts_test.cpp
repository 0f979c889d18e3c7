// Texts of parts and of frames' members: the strokes of an independent program in the answer, each
// refusal at its field, and members that have their own.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/base/angle.hpp"
#include "tests/support/call.hpp"

namespace tubecut::testing::texts {

using api::Json;

constexpr const char *kParts = "/v1/parts", *kFrames = "/v1/frames";

Json parsed(const std::string& text) { return *api::parse(text); }
std::size_t count(const Json& body, std::string_view path) {
  return at(body, path).as<Json::Array>()->size();
}

Json text_mark(const std::string& rest = "") {
  return parsed(R"({"id": "t", "at": {"z_mm": 40, "phi_deg": 90}, "text": "F", "height_mm": 7)" +
                rest + "}");
}
Json flat_mark(const std::string& rest = "") {
  return parsed(R"({"id": "t", "at": {"z_mm": 100, "face": 2}, "text": "A-12", "height_mm": 10)" +
                rest + "}");
}
Json list(Json::Array all) { return Json{std::move(all)}; }

/// A tube of 88.9 x 5, 400 long, square at both ends, with a hole of 30 mm at 200 mm.
Json round_part(Json texts) {
  return with(parsed(R"({"target": {"outer_diameter_mm": 88.9, "wall_mm": 5, "length_mm": 400},
                         "ends": {"start": {"square_at_mm": 0}, "finish": {"square_at_mm": 0}},
                         "cutouts": [{"id": "hole", "shape": {"kind": "circle", "diameter_mm": 30},
                                      "at": {"z_mm": 200, "phi_deg": 90}, "wall": "developed"}],
                         "kerf_mm": 1})"),
              "texts", std::move(texts));
}

/// SHS 80 x 4, corners of 8 mm, 500 long.
Json square_part(Json texts) {
  return with(
      parsed(
          R"({"target": {"kind": "rectangular_tube", "height_mm": 80, "width_mm": 80, "wall_mm": 4,
                         "corner_radius_mm": 8, "length_mm": 500},
              "ends": {"start": {"square_at_mm": 0}, "finish": {"square_at_mm": 0}},
              "cutouts": [{"id": "hole", "shape": {"kind": "circle", "diameter_mm": 30},
                           "at": {"z_mm": 300, "face": 2}}],
              "kerf_mm": 0.3})"),
      "texts", std::move(texts));
}

Posted made(const Json& body, const char* endpoint = kParts) {
  auto out = post(endpoint, body);
  EXPECT_FALSE(out.outcome.error) << out.outcome.body.substr(0, 1500);
  return out;
}

/// "code pointer" of every error.
std::multiset<std::string> refusals(const Json& body, const char* endpoint = kParts) {
  const auto answer = post(endpoint, body);
  std::multiset<std::string> out;
  EXPECT_TRUE(answer.outcome.error) << answer.outcome.body.substr(0, 600);
  if (!answer.outcome.error) return out;
  for (const auto& one : *at(answer.body, "errors").as<Json::Array>())
    out.insert(text(one, "code") + " " + text(one, "pointer"));
  return out;
}
using Refusals = std::multiset<std::string>;

TEST(Texts, AreAnIndependentProgramsStrokesAmongTheMarks) {
  const auto all = golden("cutouts.json");
  const auto& expected = at(all, "text/0/strokes_z_s");
  auto mark = with(text_mark(), "at/z_mm", number(all, "text/0/at/z_mm"));
  const auto answer = made(round_part(list({mark})));
  const auto& marks = *at(answer.body, "result/marks").as<Json::Array>();
  const auto& drawn = marks.back();
  EXPECT_EQ(text(drawn, "kind"), "text");
  EXPECT_EQ(text(drawn, "text"), "F");
  std::vector<std::array<double, 4>> pieces;
  for (const auto& stroke : *at(drawn, "lettering/strokes").as<Json::Array>()) {
    const auto z = numbers(stroke, "z_mm"), s = numbers(stroke, "girth_mm");
    ASSERT_EQ(z.size(), s.size());
    for (std::size_t i = 1; i < z.size(); ++i) pieces.push_back({z[i - 1], s[i - 1], z[i], s[i]});
  }
  ASSERT_EQ(pieces.size(), expected.as<Json::Array>()->size());
  for (std::size_t i = 0; i < pieces.size(); ++i)
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_NEAR(
          pieces[i][k],
          number(expected, std::to_string(i) + (k < 2 ? "/0/" : "/1/") + std::to_string(k % 2)),
          1e-9);
  // Marks come first, so nothing has been cut when the text is drawn.
  const auto& sequence = *at(answer.body, "result/sequence").as<Json::Array>();
  ASSERT_GT(sequence.size(), marks.size());
  for (std::size_t i = 0; i < sequence.size(); ++i)
    EXPECT_EQ(text(sequence[i], "what") == "mark", i < marks.size());
}

TEST(Texts, AreVerified) {
  for (const auto& body :
       {round_part(list({text_mark(R"(, "angle_deg": 33.3)")})),
        square_part(
            list({flat_mark(R"(, "angle_deg": 77, "over_corner": true, "mirrored": true)")}))}) {
    const auto answer = made(body);
    EXPECT_EQ(at(answer.body, "verification/passed"), Json{true});
    bool found = false;
    for (const auto& one : *at(answer.body, "verification/checks").as<Json::Array>())
      found = found || text(one, "name") == "text_strokes";
    EXPECT_TRUE(found);
  }
}

TEST(Texts, TheEchoIsTheSameJob) {
  for (const auto& body :
       {round_part(list({text_mark()})),
        square_part(
            list({flat_mark(), with(flat_mark(R"(, "over_corner": true)"), "id", Json{"u"})}))}) {
    const auto first = made(body);
    const auto again = made(at(first.body, "request"));
    EXPECT_EQ(text(first.body, "job/input_sha256"), text(again.body, "job/input_sha256"));
    EXPECT_EQ(text(first.body, "job/result_sha256"), text(again.body, "job/result_sha256"));
    EXPECT_EQ(number(first.body, "request/texts/0/angle_deg"), 0.0);
  }
}

TEST(Texts, WithoutAnyTheAnswerIsThatOfBefore) {
  EXPECT_EQ(text(made(round_part(Json{Json::Array{}})).body, "job/result_sha256"),
            text(made(without(round_part(Json{}), "texts")).body, "job/result_sha256"));
}

TEST(Texts, EveryRefusalIsAtItsField) {
  const auto one = [](const char* path, Json value) {
    return refusals(round_part(list({with(text_mark(), path, std::move(value))})));
  };
  EXPECT_EQ(one("text", Json{""}), Refusals{"bad_text /texts/0/text"});
  EXPECT_EQ(one("text", Json{"  "}), Refusals{"bad_text /texts/0/text"});
  EXPECT_EQ(one("text", Json{std::string(81, 'a')}), Refusals{"bad_text /texts/0/text"});
  EXPECT_EQ(one("text", Json{7.0}), Refusals{"wrong_type /texts/0/text"});
  EXPECT_EQ(one("height_mm", Json{1.9}), Refusals{"out_of_range /texts/0/height_mm"});
  EXPECT_EQ(one("height_mm", Json{100.1}), Refusals{"out_of_range /texts/0/height_mm"});
  EXPECT_EQ(one("angle_deg", Json{361.0}), Refusals{"out_of_range /texts/0/angle_deg"});
  EXPECT_EQ(one("mirrored", Json{1.0}), Refusals{"wrong_type /texts/0/mirrored"});
  EXPECT_EQ(one("over_corner", Json{false}),
            Refusals{"unsupported_combination /texts/0/over_corner"});
  EXPECT_EQ(one("at/face", Json{1.0}).count("unsupported_combination /texts/0/at/face"), 1u);
  EXPECT_EQ(one("font", Json{"serif"}), Refusals{"unknown_field /texts/0/font"});
  EXPECT_EQ(refusals(round_part(list({without(text_mark(), "at")}))),
            Refusals{"missing_field /texts/0/at"});
  EXPECT_EQ(refusals(round_part(list({text_mark(), text_mark()}))),
            Refusals{"duplicate_id /texts/1/id"});
  EXPECT_EQ(refusals(round_part(list(Json::Array(501, text_mark())))).count("wrong_count /texts"),
            1u);
  EXPECT_EQ(refusals(square_part(list({with(text_mark(), "at/z_mm", 100.0)}))),
            Refusals{"unsupported_combination /texts/0/at/phi_deg"});
}

/// A control would mark it as it is read: the block of a text has no word for mirrored.
TEST(Texts, Nc1HasNoneThatIsMirrored) {
  for (const auto& body : {round_part(list({text_mark(R"(, "mirrored": true)")})),
                           square_part(list({flat_mark(R"(, "mirrored": true)")}))}) {
    const auto refused = post(kParts, api::dump(body), "format=nc1");
    ASSERT_TRUE(refused.outcome.error);
    EXPECT_EQ(text(refused.body, "errors/0/pointer"), "?format");
    EXPECT_NE(text(refused.body, "errors/0/hint").find("text t "), std::string::npos);
    for (const char* other : {"format=dxf", "format=step", "format=csv"})
      EXPECT_FALSE(post(kParts, api::dump(body), other).outcome.error) << other;
    const auto plain = without(body, "texts/0/mirrored");
    EXPECT_FALSE(post(kParts, api::dump(plain), "format=nc1").outcome.error);
  }
}

TEST(Texts, AnUnknownLetterIsNamedWithItsSpelling) {
  const auto refused = post(kParts, round_part(list({with(text_mark(), "text",
                                                          Json{"Gr\xC3\xB6\xC3\x9F"
                                                               "e 5"})})));
  ASSERT_TRUE(refused.outcome.error);
  EXPECT_EQ(text(refused.body, "errors/0/pointer"), "/texts/0/text");
  EXPECT_EQ(text(refused.body, "errors/0/code"), "bad_text");
  EXPECT_EQ(text(refused.body, "errors/0/got"), "\xC3\xB6");
  EXPECT_NE(text(refused.body, "errors/0/hint").find("\"Groesse 5\""), std::string::npos);
}

TEST(Texts, TooNearToAnEdgeIsRefusedAndItsLimitIsAccepted) {
  const auto text_at = [](double z, const char* from = "start") {
    return with(with(text_mark(), "at/z_mm", z), "at/from", Json{from});
  };
  // An F of 7 mm is 4 mm long and keeps 2 mm.
  for (const auto& [z, from, limit] : {std::tuple{1.0, "start", 2.0},
                                       {-50.0, "start", 2.0},
                                       {395.0, "start", 394.0},
                                       {5.0, "finish", 6.0},
                                       {399.0, "finish", 398.0}}) {
    const auto refused = post(kParts, round_part(list({text_at(z, from)})));
    ASSERT_TRUE(refused.outcome.error) << z;
    EXPECT_EQ(text(refused.body, "errors/0/code"), "cutout_off_part");
    EXPECT_EQ(text(refused.body, "errors/0/pointer"), "/texts/0/at/z_mm");
    EXPECT_NEAR(number(refused.body, "errors/0/limit"), limit, 1e-6);
    made(round_part(list({text_at(number(refused.body, "errors/0/limit"), from)})));
  }
  // The hole reaches from 185 to 215 mm; the text is 7 mm high and lies beside its middle.
  for (const auto& [z, distance] :
       {std::pair{181.0, std::hypot(16.0, 3.5) - 15.0}, {200.0, 0.0}, {216.0, 1.0}}) {
    const auto refused = post(kParts, round_part(list({text_at(z)})));
    ASSERT_TRUE(refused.outcome.error) << z;
    EXPECT_EQ(text(refused.body, "errors/0/code"), "cutouts_cross");
    EXPECT_EQ(text(refused.body, "errors/0/pointer"), "/texts/0");
    EXPECT_EQ(number(refused.body, "errors/0/limit"), 2.0);
    EXPECT_NEAR(number(refused.body, "errors/0/got"), distance, distance == 0.0 ? 1e-12 : 2e-3);
    EXPECT_NE(text(refused.body, "errors/0/hint").find("cut-out hole"), std::string::npos);
  }
  made(round_part(list({text_at(180.0)})));
  made(round_part(list({text_at(217.5)})));
  // A wider kerf needs more room.
  EXPECT_EQ(refusals(with(round_part(list({text_at(2.5)})), "kerf_mm", 3.0)),
            Refusals{"cutout_off_part /texts/0/at/z_mm"});
}

TEST(Texts, OnAFlatKeepToItUnlessTheyMayLeaveIt) {
  for (const auto& [member, value] :
       {std::pair{"at/offset_mm", -25.0}, {"at/offset_mm", 40.0}, {"height_mm", 90.0}}) {
    const auto asked = with(with(flat_mark(), "at/offset_mm", 0.0), member, value);
    const auto refused = post(kParts, square_part(list({asked})));
    ASSERT_TRUE(refused.outcome.error) << member;
    const double limit = number(refused.body, "errors/0/limit");
    EXPECT_EQ(limit, std::round(limit * 1e3) / 1e3);
    const auto followed = post(kParts, square_part(list({with(asked, member, limit)})));
    if (followed.outcome.error) {
      EXPECT_NE(text(followed.body, "errors/0/pointer"), "/texts/0/" + std::string(member))
          << limit;
    }
  }
  const auto beyond = with(flat_mark(), "at/offset_mm", -25.0);
  EXPECT_EQ(refusals(square_part(list({beyond}))), Refusals{"out_of_range /texts/0/at/offset_mm"});
  made(square_part(list({with(beyond, "over_corner", Json{true})})));
  const auto by_girth =
      parsed(R"({"id": "t", "at": {"z_mm": 100, "girth_mm": 34}, "text": "A", "height_mm": 10})");
  EXPECT_EQ(refusals(square_part(list({by_girth}))), Refusals{"out_of_range /texts/0/at/girth_mm"});
  EXPECT_EQ(refusals(square_part(
                list({with(flat_mark(R"(, "angle_deg": 90)"), "text", Json{"TOO LONG FOR IT"})}))),
            Refusals{"out_of_range /texts/0/height_mm"});
}

TEST(Texts, AllProblemsOfCutoutsAndTextsAreToldAtOnce) {
  auto body = round_part(list({with(text_mark(), "at/z_mm", 1.0),
                               with(with(text_mark(), "id", Json{"u"}), "at/z_mm", 200.0),
                               with(with(text_mark(), "id", Json{"v"}), "at/z_mm", 120.0)}));
  body = with(body, "cutouts",
              parsed(R"([{"id": "hole", "shape": {"kind": "circle", "diameter_mm": 30},
                          "at": {"z_mm": 200, "phi_deg": 90}},
                         {"id": "other", "shape": {"kind": "circle", "diameter_mm": 30},
                          "at": {"z_mm": 210, "phi_deg": 90}}])"));
  EXPECT_EQ(refusals(body),
            (Refusals{"cutouts_cross /cutouts/1", "cutout_off_part /texts/0/at/z_mm",
                      "cutouts_cross /texts/1"}));
  body = with(with(body, "texts/0/height_mm", 1.0), "cutouts/0/shape/diameter_mm", -1.0);
  EXPECT_EQ(refusals(body), (Refusals{"out_of_range /texts/0/height_mm",
                                      "out_of_range /cutouts/0/shape/diameter_mm"}));
}

/// Two round posts on a rail, each with a text.
Json frame_of(const char* first, const char* second) {
  auto out = parsed(R"({"connect": {"within_mm": 1}, "kerf_mm": 1, "preset": "tube_laser",
    "members": [
      {"id": "rail", "start_mm": [-500, 0, 1000], "end_mm": [2000, 0, 1000],
       "outer_diameter_mm": 60.3, "wall_mm": 4},
      {"id": "a", "start_mm": [0, 0, 0], "end_mm": [0, 0, 1000], "up": [0, 1, 0],
       "outer_diameter_mm": 48.3, "wall_mm": 3, "priority": 1},
      {"id": "b", "start_mm": [900, 0, 0], "end_mm": [900, 0, 1000], "up": [0, 1, 0],
       "outer_diameter_mm": 48.3, "wall_mm": 3, "priority": 1}]})");
  for (const auto& [path, word] :
       {std::pair{"members/1/texts", first}, {"members/2/texts", second}})
    if (word != nullptr)
      out = with(out, path,
                 list({with(parsed(R"({"id": "t", "at": {"z_mm": 200, "phi_deg": 45},
                                       "height_mm": 10})"),
                            "text", Json{word})}));
  return out;
}

TEST(FrameTexts, BelongToTheirMember) {
  const auto answer = made(frame_of("POST A", "POST B"), kFrames);
  EXPECT_EQ(at(answer.body, "verification/passed"), Json{true});
  EXPECT_EQ(number(answer.body, "result/totals/parts"), 3.0);
  std::set<std::string> words;
  for (const auto& part : *at(answer.body, "parts").as<Json::Array>())
    for (const auto& mark : *at(part, "answer/result/marks").as<Json::Array>())
      if (text(mark, "kind") == "text") {
        words.insert(text(mark, "text"));
        EXPECT_NEAR(number(mark, "phi_deg"), 45.0, 1e-9);
        EXPECT_NEAR(number(mark, "lettering/z_mm"), 200.0, 1e-6);  // its start is square
      }
  EXPECT_EQ(words, (std::set<std::string>{"POST A", "POST B"}));
}

TEST(FrameTexts, OnlyMembersWithTheSameTextShareAPart) {
  EXPECT_EQ(number(made(frame_of(nullptr, nullptr), kFrames).body, "result/totals/parts"), 2.0);
  EXPECT_EQ(number(made(frame_of("P", "P"), kFrames).body, "result/totals/parts"), 2.0);
  EXPECT_EQ(number(made(frame_of("P", "Q"), kFrames).body, "result/totals/parts"), 3.0);
  EXPECT_EQ(number(made(frame_of("P", nullptr), kFrames).body, "result/totals/parts"), 3.0);
}

TEST(FrameTexts, EveryProblemIsAtItsMember) {
  const auto body = frame_of("P", "Q");
  EXPECT_EQ(refusals(with(body, "members/2/texts/0/height_mm", 0.5), kFrames),
            Refusals{"out_of_range /members/2/texts/0/height_mm"});
  EXPECT_EQ(refusals(without(body, "members/1/up"), kFrames),
            Refusals{"missing_field /members/1/up"});
  EXPECT_EQ(refusals(with(body, "merge_in_line", Json{true}), kFrames),
            Refusals{"unsupported_combination /merge_in_line"});
  const auto answer = made(with(body, "members/2/texts/0/at/z_mm", 0.5), kFrames);
  std::string problems;
  for (const auto& part : *at(answer.body, "parts").as<Json::Array>())
    if (const auto* problem = part.find("problem"))
      problems += text(*problem, "errors/0/code") + " " + text(*problem, "errors/0/pointer");
  EXPECT_EQ(problems, "cutout_off_part /members/2/texts/0/at/z_mm");
}

}  // namespace tubecut::testing::texts
