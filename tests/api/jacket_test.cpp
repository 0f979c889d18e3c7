// Whole structures as analysis programs have them: every member in pieces between the nodes.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <map>

#include "tests/support/lines.hpp"

namespace tubecut::testing::lines {
namespace {

struct Brace {
  Tube whole;                       // as designed, not rounded
  std::vector<std::string> pieces;  // from its start on
  Tube at_start, at_finish;         // the legs it ends on, as designed
};
struct Jacket {
  std::vector<Tube> pieces;
  std::vector<Brace> braces;
};

Point at_share(const Tube& t, Real share) { return t.start + share * (t.finish - t.start); }

/// The share of one of two lines that meet, where it meets the other.
Real meeting(const Tube& a, const Tube& b) {
  const Point n = cross(a.finish - a.start, b.finish - b.start);
  return dot(cross(b.start - a.start, b.finish - b.start), n) / dot(n, n);
}

/// Four legs that lean inwards, four bays, an X of braces in each face of each bay. Legs are in two
/// pieces a bay, braces in two halves; half of the walls differ.
Jacket jacket(Real step, Random& random) {
  Jacket out;
  constexpr std::size_t kBays = 4;
  const Real height = 61'234.567L, foot = 8'123.457L, top = 4'012.346L;
  std::vector<Tube> legs;
  for (int i = 0; i < 4; ++i) {
    const Real x = i == 0 || i == 3 ? 1 : -1, y = i < 2 ? 1 : -1;
    legs.push_back({.id = "leg " + std::to_string(i),
                    .start = {foot * x, foot * y, 0},
                    .finish = {top * x, top * y, height},
                    .diameter = 1'200,
                    .wall = 50});
  }
  const auto add = [&](Tube t, const Point& from, const Point& to, const std::string& id,
                       bool thin) {
    t.id = id;
    t.start = from;
    t.finish = to;
    if (thin) t.wall *= 0.7L;
    round_to(step, t);
    if (random.coin()) std::swap(t.start, t.finish);
    out.pieces.push_back(t);
  };
  for (const auto& leg : legs)
    for (std::size_t k = 0; k < 2 * kBays; ++k) {
      // The first and the last go on beyond their nodes.
      const Real from = k == 0 ? -0.06L : k / (2.0L * kBays);
      const Real to = k + 1 == 2 * kBays ? 1.06L : (k + 1) / (2.0L * kBays);
      add(leg, at_share(leg, from), at_share(leg, to), leg.id + "/" + std::to_string(k),
          k / 2 % 2 == 1);
    }
  for (std::size_t face = 0; face < 4; ++face)
    for (std::size_t bay = 0; bay < kBays; ++bay) {
      const auto& a = legs[face];
      const auto& b = legs[(face + 1) % 4];
      const Real low = static_cast<Real>(bay) / kBays, high = (bay + 1.0L) / kBays;
      Tube one{.id = "x" + std::to_string(face) + std::to_string(bay) + "a",
               .start = at_share(a, low),
               .finish = at_share(b, high),
               .diameter = 800,
               .wall = 20};
      Tube two = one;
      two.id.back() = 'b';
      two.start = at_share(b, low);
      two.finish = at_share(a, high);
      for (const auto& [t, other] : {std::pair{one, two}, std::pair{two, one}}) {
        const bool rises_at_b = t.id.back() == 'b';
        Brace brace{.whole = t,
                    .pieces = {t.id + "/0", t.id + "/1"},
                    .at_start = rises_at_b ? b : a,
                    .at_finish = rises_at_b ? a : b};
        const Point middle = at_share(t, meeting(t, other));
        const auto walls = random.below(3);  // thick, thin, of either
        add(t, t.start, middle, brace.pieces[0], walls == 1);
        add(t, middle, t.finish, brace.pieces[1], walls != 0);
        out.braces.push_back(brace);
      }
    }
  std::shuffle(out.pieces.begin(), out.pieces.end(), random.engine);
  return out;
}

/// Which member of the answer a piece is.
std::map<std::string, std::string> now(const Json& answer, const std::vector<Tube>& pieces) {
  std::map<std::string, std::string> out;
  for (const auto& piece : pieces) out[piece.id] = piece.id;
  if (at(answer, "result").find("merged") == nullptr) return out;
  for (const auto& one : *at(answer, "result/merged").as<Json::Array>())
    for (const auto& id : *at(one, "members").as<Json::Array>())
      out[text(id, "")] = text(one, "id");
  return out;
}

/// The least distance of an end's root to a leg's surface, as designed, of both its ends, at worst.
Real off_leg(const Json& answer, const Tube& piece, const Tube& leg) {
  Real best = 1e9L;
  for (const bool finish : {false, true}) {
    Real worst = 0;
    for (const auto& p : root_of(answer, piece, finish))
      worst = std::max(worst, std::abs(leg.off(p) - leg.diameter / 2));
    if (worst > 0) best = std::min(best, worst);
  }
  return best;
}

class Jackets : public ::testing::TestWithParam<bool> {};

TEST_P(Jackets, GiveAllTheirBraces) {
  const bool merge = GetParam();
  Random random(20261126);
  for (const Real step : {0.1L, 1.0L}) {
    const auto model = jacket(step, random);
    const auto answer = post("/v1/frames", request_of(model.pieces, 10, merge));
    ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 900);
    for (const auto& one : outside(answer.body)) ADD_FAILURE() << one;
    const auto is = now(answer.body, model.pieces);
    Real worst = 0;
    for (const auto& brace : model.braces)
      for (const bool upper : {false, true}) {
        const auto& id = brace.pieces[upper ? 1 : 0];
        const auto* part = part_of(answer.body, is.at(id));
        ASSERT_NE(part, nullptr) << id << api::dump(at(answer.body, "warnings"));
        Tube piece = brace.whole;
        piece.id = is.at(id);
        for (const auto& sent : model.pieces)
          if (sent.id == piece.id) piece.wall = sent.wall;
        worst =
            std::max(worst, off_leg(answer.body, piece, upper ? brace.at_finish : brace.at_start));
      }
    EXPECT_LT(worst, 0.15L + 2 * step);
    EXPECT_EQ(number(answer.body, "result/totals/made"),
              number(answer.body, "result/totals/members"));
    EXPECT_FALSE(warned(answer.body, "members_overlap"));
    EXPECT_FALSE(warned(answer.body, "ghost_contact"));
    std::printf(
        "%zu pieces rounded to %.2Lg mm%s: %.0f members, all made, braces within %.2Lg mm\n",
        model.pieces.size(), step, merge ? ", merged" : "",
        number(answer.body, "result/totals/members"), worst);
  }
}

INSTANTIATE_TEST_SUITE_P(MergedOrNot, Jackets, ::testing::Values(false, true));

Json field(const std::string& name) {
  return *api::parse(read_project_file("tests/field/" + name));
}
Json table(const std::string& name) {
  std::vector<Tube> tubes;
  const auto all = read_project_file("tests/field/" + name);
  for (std::size_t from = all.find('\n') + 1; from < all.size();) {
    const auto to = std::min(all.find('\n', from), all.size());
    std::vector<std::string> cells{""};
    for (const char c : all.substr(from, to - from))
      if (c == ',')
        cells.emplace_back();
      else
        cells.back() += c;
    const bool in_m = name.starts_with("csv_fe");
    const auto mm = [&](std::size_t i) { return std::stold(cells.at(i)) * (in_m ? 1000 : 1); };
    tubes.push_back({cells[0], {mm(1), mm(2), mm(3)}, {mm(4), mm(5), mm(6)}, mm(7), mm(8)});
    from = to + 1;
  }
  return request_of(tubes, 5, false);
}

TEST(FieldInputs, InLineHaveAllTheirParts) {
  for (const auto& [request, parts] : {std::pair{table("csv_in_line_pieces_rounded.csv"), 2.0},
                                       std::pair{table("csv_fe_bay_split_at_nodes.csv"), 8.0},
                                       std::pair{field("x_joint_10_um_off_line.json"), 3.0},
                                       std::pair{field("cambered_chord_1_deg.json"), 3.0},
                                       std::pair{field("brace_on_butted_chords.json"), 3.0}}) {
    const auto answer = post("/v1/frames", request);
    ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 900);
    EXPECT_EQ(number(answer.body, "result/totals/made"), parts)
        << api::dump(at(answer.body, "warnings"));
    for (const auto& one : outside(answer.body)) ADD_FAILURE() << one;
    EXPECT_FALSE(warned(answer.body, "ghost_contact"));
    EXPECT_FALSE(warned(answer.body, "members_overlap"));
  }
}

TEST(FieldInputs, MergedAreFewer) {
  for (const auto& [name, members] : {std::pair{"csv_in_line_pieces_rounded.csv", 1.0},
                                      std::pair{"csv_fe_bay_split_at_nodes.csv", 5.0}}) {
    const auto request = with(table(name), "merge_in_line", Json{true});
    const auto answer = post("/v1/frames", request);
    ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 900);
    EXPECT_EQ(number(answer.body, "result/totals/members"), members);
    EXPECT_EQ(number(answer.body, "result/totals/made"), members);
    EXPECT_FALSE(warned(answer.body, "members_overlap"));
  }
}

TEST(FieldInputs, TubeThatEndsBeforeTheCutCutsNothing) {
  const auto answer = post("/v1/frames", field("cut_by_a_tube_181_mm_away.json"));
  ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 900);
  const auto* part = part_of(answer.body, "branch");
  ASSERT_NE(part, nullptr);
  EXPECT_NEAR(number(*part, "result/lengths/long_mm"), 161.0, 1e-6);
  EXPECT_TRUE(warned(answer.body, "free_end"));
}

// If the joint is stated, it is kept, and the part and its row report that the partner is missing.
TEST(FieldInputs, StatedJointWithoutItsPartnerIsForReview) {
  auto request = field("cut_by_a_tube_181_mm_away.json");
  request =
      with(request, "joints", *api::parse(R"([{"between": ["branch", "run"], "kind": "set_on"}])"));
  const auto answer = post("/v1/frames", request);
  ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 900);
  const auto* part = part_of(answer.body, "branch");
  ASSERT_NE(part, nullptr);
  EXPECT_TRUE(warned(*part, "ghost_contact"));
  EXPECT_EQ(text(*part, "verdict/status"), "review");
  EXPECT_EQ(text(answer.body, "result/cut_list/0/verdict"), "review");
}

TEST(Frames, OnlyTheMemberOutOfRangeHasNoPart) {
  for (const auto& [path, value] :
       {std::pair{"members/2/wall_mm", 0.2}, std::pair{"members/2/wall_mm", 60.0},
        std::pair{"members/2/outer_diameter_mm", 3.0}}) {
    auto request = field("cambered_chord_1_deg.json");
    request = with(request, path, Json{value});
    if (value == 3.0) request = with(request, "members/2/wall_mm", Json{0.5});
    const auto answer = post("/v1/frames", request);
    ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 900);
    EXPECT_EQ(number(answer.body, "result/totals/made"), 2.0);
    EXPECT_TRUE(warned(answer.body, "no_part"));
    const auto& parts = *at(answer.body, "parts").as<Json::Array>();
    EXPECT_EQ(text(parts.at(2), "problem/code"), "out_of_range");
    EXPECT_EQ(text(parts.at(2), "problem/errors/0/pointer"), "/" + std::string(path));
    for (const auto& one : outside(answer.body)) ADD_FAILURE() << one;
  }
  // If all are out of range, the request is refused as before, for example in metres.
  auto request = field("cambered_chord_1_deg.json");
  for (const auto* i : {"0", "1", "2"})
    request = with(request, "members/" + std::string(i) + "/outer_diameter_mm", Json{0.1683});
  EXPECT_TRUE(post("/v1/frames", request).outcome.error);
}

TEST(Frames, OthersThatNoJointNamesDoNotCount) {
  auto request = field("cambered_chord_1_deg.json");
  Json::Array others;
  for (int i = 0; i < 1'500; ++i)
    others.emplace_back(
        Json::Object{{"kind", Json{"plane"}},
                     {"id", Json{"plate " + std::to_string(i)}},
                     {"point_mm", *api::parse("[1000, 0, " + std::to_string(5000 + i) + "]")},
                     {"normal", *api::parse("[0, 0, 1]")}});
  others[1'400] = Json::Object{{"kind", Json{"plane"}},
                               {"id", Json{"plate 1400"}},
                               {"point_mm", *api::parse("[1000, 0, 1000]")},
                               {"normal", *api::parse("[0, 0, 1]")}};
  request = with(request, "others", Json{others});
  request = with(request, "joints",
                 *api::parse(R"([{"between": ["brace", "plate 1400"], "kind": "set_on"}])"));
  const auto answer = post("/v1/frames", request);
  ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 900);
  EXPECT_EQ(number(answer.body, "result/totals/made"), 3.0);
  EXPECT_EQ(number(answer.body, "result/others_left_out"), 1'499.0);
  EXPECT_EQ(joint_of(answer.body, "brace", "plate 1400"), "set_on");
}

}  // namespace
}  // namespace tubecut::testing::lines
