// Members that continue in line: pieces of chords, halves of braces, split at nodes and rounded.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>
#include <string>
#include <utility>

#include "tests/support/lines.hpp"

namespace tubecut::testing::lines {
namespace {

constexpr int kCases = 240;

std::string joined(const std::vector<std::string>& all) {
  std::string out;
  for (const auto& one : all) out += one + "\n";
  return out;
}

struct Line {
  std::vector<Tube> pieces;  // one behind the other, each from start to finish
  std::vector<Tube> braces;
  std::vector<std::size_t> at;  // of each brace: the piece whose finish it ends at
  Real step = 0, kink = 0;
};

/// Pieces of 600 to 6000 mm, rounded by 0 to 1 mm, with kinks that a model may have, and braces
/// where two of them meet.
Line random_line(Random& random, bool straight, bool alike) {
  Line out;
  out.step = random.one_of<Real>({0, 0.001L, 0.01L, 0.1L, 1});
  out.kink = straight ? 0 : random.one_of<Real>({0, 0.05L, 0.3L, 1, 2, 5, 9});
  const Real diameter = random.between(60, 900);
  Point at = Real{3000} * random.direction(), along = random.direction();
  const auto n = 2 + random.below(3);
  for (std::size_t i = 0; i < n; ++i) {
    Tube piece{.id = "chord " + std::to_string(i), .start = at, .finish = {}};
    const bool other = !alike && random.below(4) == 0;
    piece.diameter = other ? diameter * random.between(0.7L, 0.95L) : diameter;
    piece.wall = piece.diameter * (random.coin() ? 0.04L : 0.05L);
    piece.finish = at + random.between(3 * diameter, 3 * diameter + 4000) * along;
    round_to(out.step, piece);
    at = piece.finish;
    along = out.kink > 0 ? random.leaning(along, out.kink) : along;
    out.pieces.push_back(piece);
  }
  for (std::size_t i = 0; i + 1 < n; ++i) {
    if (random.coin()) continue;
    const auto& chord = out.pieces[i];
    Tube brace{.id = "brace " + std::to_string(i), .start = chord.finish, .finish = {}};
    const Real least = std::min(out.pieces[i].diameter, out.pieces[i + 1].diameter);
    brace.diameter = least * random.between(0.3L, 0.8L);
    brace.wall = std::max<Real>(0.5L, brace.diameter * 0.06L);
    const Point away = random.leaning(chord.along(), random.between(45, 135));
    brace.finish = brace.start + random.between(3 * diameter, 3 * diameter + 3000) * away;
    round_to(out.step, brace);
    out.braces.push_back(brace);
    out.at.push_back(i);
  }
  return out;
}

/// As a model has them: in any order, each drawn from either end.
std::vector<Tube> shuffled(Random& random, const Line& line) {
  auto out = line.pieces;
  out.insert(out.end(), line.braces.begin(), line.braces.end());
  for (auto& one : out)
    if (random.coin()) std::swap(one.start, one.finish);
  std::shuffle(out.begin(), out.end(), random.engine);
  return out;
}

/// The end of a drawn tube that is at a place.
bool finish_at(const Tube& tube, const Point& place) {
  return norm(tube.finish - place) < norm(tube.start - place);
}

/// How far from the surface of the nearest of two pieces the brace's root is, where that piece is.
Real off_chord(const Json& answer, const std::vector<Tube>& sent, const Line& line,
               std::size_t brace) {
  const auto& own = line.braces[brace];
  const auto drawn = std::ranges::find(sent, own.id, &Tube::id);
  const auto& a = line.pieces[line.at[brace]];
  const auto& b = line.pieces[line.at[brace] + 1];
  const auto root = root_of(answer, *drawn, finish_at(*drawn, own.start));
  if (root.empty()) return 1e9L;
  Real out = 0;
  for (const auto& p : root) {
    const Real from_a = a.axial(p) < a.length() + 1 ? std::abs(a.off(p) - a.diameter / 2) : 1e9L;
    const Real from_b = b.axial(p) > -1 ? std::abs(b.off(p) - b.diameter / 2) : 1e9L;
    out = std::max(out, std::min(from_a, from_b));
  }
  return out;
}

TEST(InLine, PiecesAreButtedOrMitredAndEveryMemberHasItsPart) {
  Random random(20261127);
  int butts = 0, mitres = 0, braces = 0;
  Real worst = 0;
  for (int k = 0; k < kCases; ++k) {
    const auto line = random_line(random, false, false);
    const auto sent = shuffled(random, line);
    const auto request = request_of(sent, 5, false);
    const auto answer = post("/v1/frames", request);
    SCOPED_TRACE("case " + std::to_string(k) + ": " + api::dump(request));
    ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 600);
    EXPECT_EQ(joined(outside(answer.body)), "");
    EXPECT_EQ(number(answer.body, "result/totals/made"), static_cast<double>(sent.size()))
        << api::dump(at(answer.body, "warnings"));
    for (std::size_t i = 0; i + 1 < line.pieces.size(); ++i) {
      const auto& a = line.pieces[i];
      const auto& b = line.pieces[i + 1];
      const Real angle = lines::between(a.along(), b.along());
      const auto kind = joint_of(answer.body, a.id, b.id);
      if (std::abs(angle - 0.5L) > 0.001L) {
        EXPECT_EQ(kind, angle < 0.5L ? "butt" : "mitre") << angle;
      }
      ++(angle < 0.5L ? butts : mitres);
    }
    const bool one_size = std::ranges::all_of(
        line.pieces, [&](const Tube& t) { return t.diameter == line.pieces[0].diameter; });
    for (std::size_t i = 0; i < line.braces.size(); ++i) {
      const auto& a = line.pieces[line.at[i]];
      const auto& b = line.pieces[line.at[i] + 1];
      if (!one_size || line.kink > 0.3L) continue;
      ++braces;
      // The pieces' own bend over the brace's width is all that the cut may be off.
      const Real bend = std::sin(lines::between(a.along(), b.along()) * kRad);
      const Real may = 0.12L + 2 * line.braces[i].diameter * bend;
      const Real off = off_chord(answer.body, sent, line, i);
      EXPECT_LT(off, may);
      worst = std::max(worst, off);
      EXPECT_FALSE(warned(answer.body, "ghost_contact")) << api::dump(at(answer.body, "warnings"));
    }
    if (HasFailure()) return;
  }
  std::printf("%d butts, %d mitres, %d braces within %.2Lg mm of their chords\n", butts, mitres,
              braces, worst);
  EXPECT_GT(butts, 100);
  EXPECT_GT(mitres, 100);
  EXPECT_GT(braces, 50);
}

TEST(InLine, PiecesAlikeBecomeOneMember) {
  Random random(11);
  int merged = 0;
  for (int k = 0; k < kCases; ++k) {
    auto line = random_line(random, true, true);
    const auto sent = shuffled(random, line);
    const auto request = request_of(sent, 5, true);
    const auto answer = post("/v1/frames", request);
    SCOPED_TRACE("case " + std::to_string(k) + ": " + api::dump(request));
    ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 600);
    EXPECT_EQ(joined(outside(answer.body)), "");
    const auto& members = *at(answer.body, "result/members").as<Json::Array>();
    EXPECT_EQ(number(answer.body, "result/totals/made"), static_cast<double>(members.size()));
    // Runs of one wall: each is one, called as the first of them that was sent.
    std::size_t expected = line.braces.size();
    for (std::size_t i = 0; i < line.pieces.size();) {
      auto j = i;
      while (j + 1 < line.pieces.size() && line.pieces[j + 1].wall == line.pieces[i].wall) ++j;
      ++expected;
      std::vector<std::string> ids;
      for (auto p = i; p <= j; ++p) ids.push_back(line.pieces[p].id);
      const auto first = std::ranges::find_if(
          sent, [&](const Tube& t) { return std::ranges::count(ids, t.id) > 0; });
      Real off = 0;
      Tube whole = line.pieces[i];
      whole.finish = line.pieces[j].finish;
      for (auto p = i; p <= j; ++p)
        off = std::max({off, whole.off(line.pieces[p].start), whole.off(line.pieces[p].finish)});
      for (const auto& one : *at(answer.body, "result/merged").as<Json::Array>()) {
        if (text(one, "id") != first->id) continue;
        ++merged;
        std::vector<std::string> told;
        for (const auto& id : *at(one, "members").as<Json::Array>()) told.push_back(text(id, ""));
        std::ranges::sort(told);
        EXPECT_EQ(told, ids);
        EXPECT_NEAR(number(one, "off_line_mm"), static_cast<double>(off), 1e-6);
        EXPECT_LE(off, 2);
      }
      const auto* part = part_of(answer.body, first->id);
      ASSERT_NE(part, nullptr);
      EXPECT_NEAR(number(*part, "request/target/length_mm"), static_cast<double>(whole.length()),
                  1e-6);
      i = j + 1;
    }
    EXPECT_EQ(members.size(), expected);
    if (HasFailure()) return;
  }
  std::printf("%d merged members\n", merged);
  EXPECT_GT(merged, 100);
}

// Every order of ends: /v1/nodes, /v1/parts and /v1/frames see one joint.
TEST(InLine, NodesAndPartsDetectTheSameJointsAsFrames) {
  Random random(3);
  for (int k = 0; k < 40; ++k) {
    auto line = random_line(random, false, false);
    line.pieces.resize(2);
    line.braces.clear();
    for (auto& one : line.pieces)
      if (random.coin()) std::swap(one.start, one.finish);
    const auto request = request_of(line.pieces, 5, false);
    const auto nodes = post("/v1/nodes", Json{Json::Object{{"members", at(request, "members")},
                                                           {"connect", at(request, "connect")}}});
    SCOPED_TRACE(api::dump(request));
    ASSERT_FALSE(nodes.outcome.error) << nodes.outcome.body.substr(0, 600);
    int planes = 0;
    for (const auto& end : *at(nodes.body, "result/ends").as<Json::Array>())
      for (const auto& cut : *at(end, "cut_by").as<Json::Array>()) {
        EXPECT_EQ(text(cut, "joint/kind"), "mitre");
        planes += cut.find("plane") != nullptr ? 1 : 0;
      }
    EXPECT_EQ(planes, 2);
    auto of_part = *request.as<Json::Object>();
    std::erase_if(of_part, [](const auto& m) { return m.first == "defaults"; });
    for (const auto& one : *at(request, "defaults").as<Json::Object>()) of_part.push_back(one);
    of_part.emplace_back("member", Json{line.pieces[0].id});
    of_part.emplace_back("up", numbers_of(unit(cross(line.pieces[0].along(), {0.3L, 0.5L, 0.8L}))));
    const auto part = post("/v1/parts", Json{of_part});
    ASSERT_FALSE(part.outcome.error) << part.outcome.body.substr(0, 600);
  }
}

/// Where along the run the branch's cut meets it, from lines on both of the branch's surfaces.
std::pair<Real, Real> contact(const Tube& branch, const Tube& run) {
  std::pair<Real, Real> out{1e9L, -1e9L};
  const Point z = branch.along(), w = run.along();
  const Point x = unit(cross(z, w)), y = cross(z, x);
  for (const Real rho : {branch.diameter / 2, branch.diameter / 2 - branch.wall})
    for (int k = 0; k < 3600; ++k) {
      const Real a = k * kRad / 10;
      const Point at = branch.start + rho * std::cos(a) * x + rho * std::sin(a) * y - run.start;
      // |at + t z| across w is the run's radius; the higher of the two.
      const Point p = at - dot(at, w) * w, q = z - dot(z, w) * w;
      const Real aa = dot(q, q), bb = dot(p, q), cc = dot(p, p) - run.diameter * run.diameter / 4;
      const Real square = bb * bb - aa * cc;
      if (square < 0) continue;
      const Real t = (-bb + std::sqrt(square)) / aa, s = dot(at + t * z, w);
      out.first = std::min(out.first, s);
      out.second = std::max(out.second, s);
    }
  return out;
}

TEST(InLine, AMemberThatEndsBeforeTheCutDoesNotCut) {
  Random random(7);
  int absent = 0, partly = 0, there = 0;
  for (int k = 0; k < kCases; ++k) {
    Tube run{.id = "run", .start = Real{500} * random.direction(), .finish = {}};
    Tube branch{.id = "branch", .start = {}, .finish = {}};
    run.diameter = random.between(150, 600);
    run.wall = run.diameter * 0.05L;
    branch.diameter = run.diameter * random.between(0.2L, 0.8L);
    branch.wall = branch.diameter * 0.08L;
    const Point w = random.direction(), z = random.leaning(w, random.between(55, 125));
    run.finish = run.start + 2500 * w;
    // The branch is set on the run, prolonged before its start, within reach.
    const Real before = random.between(-1, 1) * run.diameter / 2;
    branch.start = run.start - before * w + (0.2L * run.diameter) * unit(z - dot(z, w) * w);
    branch.finish = branch.start + 1800 * z;
    const auto [low, high] = contact(branch, run);
    if (std::abs(low) < 1 || std::abs(high) < 1) continue;
    const auto request = request_of({run, branch}, 5, false);
    const auto answer = post("/v1/frames", request);
    SCOPED_TRACE("case " + std::to_string(k) + ": " + api::dump(request));
    ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 600);
    EXPECT_EQ(joined(outside(answer.body)), "");
    const auto* part = part_of(answer.body, "branch");
    ASSERT_NE(part, nullptr) << api::dump(at(answer.body, "warnings"));
    const bool cut = at(*part, "request/ends/start").find("cutters") != nullptr;
    const bool reached = norm(branch.start - run.start) < run.diameter / 2 + 5;
    if (!reached) continue;
    EXPECT_EQ(cut, high > 0);
    std::string row;
    for (const auto& one : *at(answer.body, "result/cut_list").as<Json::Array>())
      if (text(one, "part") == "branch") row = text(one, "verdict");
    if (high < 0) {
      ++absent;
      EXPECT_TRUE(warned(answer.body, "free_end"));
    } else if (low < 0) {
      ++partly;
      EXPECT_EQ(row, "review");
      EXPECT_TRUE(warned(*part, "ghost_contact"));
      EXPECT_NEAR(number(*part, "request/ends/start/joints/0/missing_mm"),
                  static_cast<double>(-low), 1e-3 * static_cast<double>(run.diameter));
    } else {
      ++there;
      EXPECT_FALSE(warned(answer.body, "ghost_contact"));
    }
    if (HasFailure()) return;
  }
  std::printf("%d absent, %d partly there, %d there\n", absent, partly, there);
  EXPECT_GT(absent, 20);
  EXPECT_GT(partly, 20);
  EXPECT_GT(there, 10);
}

/// A rail that ends at a round post between two rails in line: those have one surface, which has
/// metal on both sides of the post, so it ends on the post and on them, whichever of the two
/// rounding puts on top, however the model is turned and each rail is drawn.
TEST(InLine, ARailBetweenTwoInLineAtAPostEndsOnAllThree) {
  for (const auto& [post_size, rail_size] :
       {std::pair{"CHS 48.3x3.2", "CHS 42.4x3.2"}, std::pair{"CHS 48.3x3.2", "CHS 48.3x3.2"},
        std::pair{"CHS 60.3x3.2", "CHS 48.3x3.2"}})
    for (const double turned : {0.0, 20.0, 57.08, 181.96, 234.3})
      for (const bool back : {false, true}) {
        const double c = std::cos(turned * 0.017453292519943295);
        const double s = std::sin(turned * 0.017453292519943295);
        const auto at = [&](double x, double y, double z) {
          char out[96];
          std::snprintf(out, sizeof out, "[%.3f, %.3f, %.3f]", c * x - s * y, s * x + c * y, z);
          return std::string(out);
        };
        const auto tube = [](const std::string& id, const std::string& from, const std::string& to,
                             const std::string& size) {
          return R"({"id": ")" + id + R"(", "start_mm": )" + from + R"(, "end_mm": )" + to +
                 R"(, "size": ")" + size + "\"}";
        };
        const auto rail = [&](const std::string& id, const std::string& from,
                              const std::string& to) {
          return back ? tube(id, to, from, rail_size) : tube(id, from, to, rail_size);
        };
        const auto asked = R"({"preset": "tube_laser", "kerf_mm": 0.2,
                               "connect": {"within_mm": 5}, "members": [)" +
                           tube("post", at(900, 0, 0), at(900, 0, 1500), post_size) + "," +
                           rail("left", at(0, 0, 700), at(900, 0, 700)) + "," +
                           rail("right", at(900, 0, 700), at(1800, 0, 700)) + "," +
                           rail("across", at(900, 0, 700), at(900, 400, 700)) + "]}";
        const auto answer = post("/v1/frames", *api::parse(asked));
        ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 600);
        std::set<std::string> joints;
        for (const auto& one : *testing::at(answer.body, "result/joints").as<api::Json::Array>())
          joints.insert(text(one, "branch") + " " + text(one, "kind") + " " + text(one, "chord"));
        EXPECT_EQ(joints, (std::set<std::string>{"left set_on post", "right set_on post",
                                                 "across set_on post", "across set_on left",
                                                 "across set_on right"}))
            << post_size << " " << rail_size << " " << turned << back;
        for (const auto& w : *testing::at(answer.body, "warnings").as<api::Json::Array>())
          EXPECT_NE(text(w, "code"), "members_overlap") << turned;
      }
}

}  // namespace
}  // namespace tubecut::testing::lines
