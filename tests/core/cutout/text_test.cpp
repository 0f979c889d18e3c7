#include "core/cutout/text.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/support/golden.hpp"

/// The font, and texts as they lie on the outside: an independent program's strokes, and laws.
namespace tubecut::testing::cutout_texts {
namespace {

using namespace cutout;
using api::Json;

/// Straight pieces of strokes, as [x, y, x, y].
std::vector<std::array<double, 4>> pieces_of(const std::vector<Stroke>& strokes) {
  std::vector<std::array<double, 4>> out;
  for (const auto& stroke : strokes)
    for (std::size_t i = 1; i < stroke.size(); ++i)
      out.push_back({stroke[i - 1].x(), stroke[i - 1].y(), stroke[i].x(), stroke[i].y()});
  return out;
}

void expect_pieces(const Json& expected, const std::vector<Stroke>& strokes) {
  const auto pieces = pieces_of(strokes);
  const auto& all = *expected.as<Json::Array>();
  ASSERT_EQ(all.size(), pieces.size());
  const std::array<const char*, 4> where{"0/0", "0/1", "1/0", "1/1"};
  for (std::size_t i = 0; i < pieces.size(); ++i)
    for (std::size_t k = 0; k < where.size(); ++k)
      EXPECT_NEAR(pieces[i][k], number(all[i], where[k]), 1e-9) << i << " " << where[k];
}

TextSpec text_of(std::string text, double height = 7.0) {
  return {.id = "t", .at = {}, .text = std::move(text), .height = height};
}

Ground round_ground(double diameter, double wall, double length) {
  return {.tube = {.outer_radius = 0.5 * diameter, .wall = wall, .length = length},
          .finish_long = length,
          .finish_work = length};
}

Ground square_ground() {
  const section::Section section{80.0, 80.0, 4.0, 8.0, 4.0};
  return {.tube = {.outer_radius = section.outer().girth() / kTwoPi, .wall = 4.0, .length = 500.0},
          .section = section::Wall(section),
          .finish_long = 500.0,
          .finish_work = 500.0};
}

Lettering laid(const TextSpec& spec, const Ground& ground) {
  auto found = lay_texts({spec}, ground);
  EXPECT_TRUE(found.issues.empty());
  return found.all.empty() ? Lettering{} : found.all.front();
}

TEST(Texts, StrokesAreThoseOfAnIndependentProgram) {
  const auto all = golden("cutouts.json");
  const auto& cases = *at(all, "text").as<Json::Array>();
  ASSERT_EQ(cases.size(), 1u);
  const auto& one = cases.front();
  auto spec = text_of("F", number(one, "height_mm"));
  expect_pieces(at(one, "strokes_drawing"), letter('F'));
  spec.at = {.z = number(one, "at/z_mm"), .phi = number(one, "at/phi_deg") * kRadPerDeg};
  const auto ground = round_ground(number(one, "section/H"), number(one, "section/t"), 400.0);
  expect_pieces(at(one, "strokes_z_s"), laid(spec, ground).strokes);
}

TEST(StrokeFont, HasEveryPrintableLetterOnceOnItsGrid) {
  std::set<std::set<std::array<double, 4>>> known;
  int count = 0;
  for (char c = kFirstLetter; c <= kLastLetter; ++c, ++count) {
    const auto strokes = letter(c);
    EXPECT_EQ(strokes.empty(), c == ' ') << c;
    std::set<std::array<double, 4>> pieces;
    for (const auto& p : pieces_of(strokes)) {
      EXPECT_TRUE(p[0] != p[2] || p[1] != p[3]) << c << " has a stroke of no length";
      const bool ahead = std::pair(p[0], p[1]) < std::pair(p[2], p[3]);
      pieces.insert(ahead ? p : std::array{p[2], p[3], p[0], p[1]});
      for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_GE(p[k], 0.0) << c;
        EXPECT_LE(p[k], k % 2 == 0 ? kGridWidth : kGridHeight) << c;
        EXPECT_EQ(2.0 * p[k], std::round(2.0 * p[k])) << c;
      }
    }
    for (const auto& stroke : strokes) EXPECT_GE(stroke.size(), 2u) << c;
    EXPECT_TRUE(known.insert(pieces).second) << c << " is another letter too";
  }
  EXPECT_EQ(count, 95);
  for (const std::string high = "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"; const char c : high) {
    const auto box = bounds(letter(c));
    EXPECT_EQ(box.least.y(), 0.0) << c;
    EXPECT_EQ(box.most.y(), kGridHeight) << c;
  }
}

TEST(StrokeFont, HasNoOtherLetters) {
  for (int c = 0; c < 256; ++c)
    EXPECT_EQ(has_letter(static_cast<char>(c)), c >= 32 && c <= 126) << c;
}

TEST(Texts, LettersFollowEachOtherBySixUnits) {
  const auto one = written(text_of("H", 14.0)), two = written(text_of("iH", 14.0));
  const auto before = letter('i').size();
  ASSERT_EQ(two.size(), before + one.size());
  for (std::size_t i = 0; i < one.size(); ++i)
    for (std::size_t k = 0; k < one[i].size(); ++k)
      EXPECT_NEAR((two[before + i][k] - one[i][k] - Flat(12.0, 0.0)).norm(), 0.0, 1e-12);
}

/// A text with no symmetry of its own.
const char* const kAny = "R2-d7";

TEST(Texts, ATurnedTextIsTheSameAboutItsAnchor) {
  auto spec = text_of(kAny, 9.0);
  const auto plain = written(spec);
  spec.turn = 0.5 * kPi;
  const auto quarter = written(spec);
  for (std::size_t i = 0; i < plain.size(); ++i)
    for (std::size_t k = 0; k < plain[i].size(); ++k)  // +z turns into growing s
      EXPECT_NEAR((quarter[i][k] - Flat(-plain[i][k].y(), plain[i][k].x())).norm(), 0.0, 1e-12);
  spec.turn = 0.7;
  const auto any = written(spec);
  for (std::size_t i = 0; i < plain.size(); ++i)
    for (std::size_t k = 0; k < plain[i].size(); ++k) {
      EXPECT_NEAR(any[i][k].norm(), plain[i][k].norm(), 1e-12);
      EXPECT_NEAR(any[i][k].dot(plain[i][k]), std::cos(0.7) * plain[i][k].squaredNorm(), 1e-9);
    }
}

TEST(Texts, AMirroredTextIsTurnedOverItsBaseLine) {
  auto spec = text_of(kAny);
  const auto plain = written(spec);
  spec.mirrored = true;
  const auto mirrored = written(spec);
  ASSERT_EQ(plain.size(), mirrored.size());
  for (std::size_t i = 0; i < plain.size(); ++i)
    for (std::size_t k = 0; k < plain[i].size(); ++k) {
      EXPECT_EQ(mirrored[i][k].x(), plain[i][k].x());
      EXPECT_EQ(mirrored[i][k].y(), -plain[i][k].y());
      EXPECT_LE(plain[i][k].y(), 0.0);  // letters stand against s
    }
}

TEST(Texts, AHigherTextIsLargerByAsMuch) {
  const auto small = written(text_of(kAny, 4.0)), large = written(text_of(kAny, 10.0));
  for (std::size_t i = 0; i < small.size(); ++i)
    for (std::size_t k = 0; k < small[i].size(); ++k)
      EXPECT_NEAR((2.5 * small[i][k] - large[i][k]).norm(), 0.0, 1e-12);
  const auto box = bounds(large);
  EXPECT_NEAR(box.most.y() - box.least.y(), 10.0, 1e-12);
}

TEST(Texts, FromTheFinishIsTheLengthLessFromTheStart) {
  const auto ground = round_ground(88.9, 5.0, 400.0);
  auto spec = text_of(kAny);
  spec.at = {.z = 100.0, .phi = 1.0};
  const auto start = laid(spec, ground);
  spec.at = {.z = 300.0, .from = Anchor::From::finish, .phi = 1.0 - kPi, .opposite = true};
  const auto finish = laid(spec, ground);
  for (std::size_t i = 0; i < start.strokes.size(); ++i)
    for (std::size_t k = 0; k < start.strokes[i].size(); ++k)
      EXPECT_NEAR((start.strokes[i][k] - finish.strokes[i][k]).norm(), 0.0, 1e-9);
}

TEST(Texts, ATextOnAFlatLiesThereWholly) {
  const auto ground = square_ground();
  const auto& outer = ground.section->outer();
  for (int face = 1; face <= 4; ++face) {
    auto spec = text_of(kAny, 10.0);
    spec.at = {.z = 100.0, .face = face, .offset = 5.0};
    const auto one = laid(spec, ground);
    EXPECT_EQ(one.face, face);
    for (const auto& stroke : one.strokes)
      for (const auto& p : stroke) {
        const auto there = outer.at(p.y());
        EXPECT_EQ(there.face, face);
        EXPECT_FALSE(there.on_corner);
      }
  }
}

TEST(Texts, ATextOverACornerIsRefusedAndItsLimitIsAccepted) {
  const auto ground = square_ground();
  auto spec = text_of(kAny, 10.0);
  spec.at = {.z = 100.0, .face = 2, .offset = -28.0};
  const auto refused = lay_texts({spec, text_of("ok")}, ground);
  ASSERT_EQ(refused.issues.size(), 1u);
  EXPECT_EQ(refused.all.size(), 1u);
  const auto& issue = refused.issues.front();
  EXPECT_EQ(issue.code, ErrorCode::out_of_range);
  EXPECT_EQ(issue.member, "texts/0/at/offset");
  spec.at.offset = std::get<double>(issue.limit);
  EXPECT_NEAR(spec.at.offset, -32.0 + 10.0, 1e-9);  // half a flat of 64 mm
  EXPECT_TRUE(lay_texts({spec}, ground).issues.empty());
  spec.at = {.z = 100.0, .phi = (40.0 - 8.0 + 2.0) / ground.tube.outer_radius};
  const auto by_girth = lay_texts({spec}, ground);
  ASSERT_EQ(by_girth.issues.size(), 1u);
  EXPECT_EQ(by_girth.issues.front().member, "texts/0/at/girth");
  spec.at.phi = std::get<double>(by_girth.issues.front().limit) / ground.tube.outer_radius;
  EXPECT_TRUE(lay_texts({spec}, ground).issues.empty());
}

TEST(Texts, ATextThatIsTooHighForItsFlatIsToldTheHeightThatFits) {
  const auto ground = square_ground();
  auto spec = text_of("AB", 90.0);
  spec.at = {.z = 100.0, .face = 3, .offset = 20.0};
  auto refused = lay_texts({spec}, ground);
  ASSERT_EQ(refused.issues.size(), 1u);
  EXPECT_EQ(refused.issues.front().member, "texts/0/height");
  EXPECT_NEAR(std::get<double>(refused.issues.front().limit), 64.0, 1e-9);
  spec = text_of(std::string(60, 'W'), 10.0);
  spec.turn = 0.5 * kPi;
  refused = lay_texts({spec}, round_ground(60.3, 4.0, 500.0));
  ASSERT_EQ(refused.issues.size(), 1u);
  EXPECT_EQ(refused.issues.front().member, "texts/0/height");
  spec.height = std::get<double>(refused.issues.front().limit) * (1.0 - 1e-9);
  EXPECT_TRUE(lay_texts({spec}, round_ground(60.3, 4.0, 500.0)).issues.empty());
}

TEST(Texts, OverACornerStrokesTurnOnItsSeams) {
  const auto ground = square_ground();
  const auto& outer = ground.section->outer();
  auto spec = text_of("HELLO", 20.0);
  spec.turn = 0.4;
  spec.over_corner = true;
  spec.at = {.z = 100.0, .face = 1, .offset = 25.0};
  const auto one = laid(spec, ground);
  auto flat = written(spec);
  double length = 0.0, straight = 0.0;
  std::size_t corners = 0;
  for (const auto& p : pieces_of(one.strokes)) {
    length += std::hypot(p[2] - p[0], p[3] - p[1]);
    const auto from = outer.at(p[1] + 1e-7 * (p[3] - p[1])),
               to = outer.at(p[3] + 1e-7 * (p[1] - p[3]));
    EXPECT_EQ(from.on_corner, to.on_corner);
    EXPECT_EQ(from.face, to.face);
    corners += from.on_corner;
  }
  for (const auto& p : pieces_of(flat)) straight += std::hypot(p[2] - p[0], p[3] - p[1]);
  EXPECT_NEAR(length, straight, 1e-9);
  EXPECT_GT(corners, 3u);
}

}  // namespace
}  // namespace tubecut::testing::cutout_texts
