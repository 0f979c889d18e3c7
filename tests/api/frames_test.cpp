#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "api/wire/sha256.hpp"
#include "tests/support/call.hpp"

namespace tubecut::testing {
namespace {

using api::Json;

constexpr const char* kPath = "/v1/frames";

const Json::Array& list(const Json& json, std::string_view path) {
  return *at(json, path).as<Json::Array>();
}

std::vector<std::pair<std::string, Json>> all_examples() {
  std::vector<std::pair<std::string, Json>> out;
  for (const auto& one : api::examples())
    if (one.endpoint == "frames") out.emplace_back(one.name, *api::parse(one.body));
  return out;
}

Posted asked(const Json& request) {
  auto out = post(kPath, request);
  EXPECT_FALSE(out.outcome.error) << out.outcome.body.substr(0, 1500);
  return out;
}

/// The text of a member of a document, from its first byte to its last.
std::string_view text_of(std::string_view whole, std::size_t from) {
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = from; i < whole.size(); ++i) {
    if (quoted && whole[i] == '\\') {
      ++i;
      continue;
    }
    if (whole[i] == '"') quoted = !quoted;
    if (quoted) continue;
    if (whole[i] == '{') ++depth;
    if (whole[i] == '}' && --depth == 0) return whole.substr(from, i + 1 - from);
  }
  return {};
}

const Json& of_id(const Json& body, std::string_view path, std::string_view field,
                  std::string_view id) {
  for (const auto& one : list(body, path))
    if (text(one, field) == id) return one;
  throw std::runtime_error("none is " + std::string(id));
}

// Each part in a frame's answer is the answer of /v1/parts to the request in it, byte by byte.
TEST(Frames, EveryPartIsTheAnswerToItsOwnRequest) {
  std::size_t parts = 0;
  for (const auto& [name, request] : all_examples()) {
    const auto frame = asked(request);
    EXPECT_EQ(at(frame.body, "verification/passed"), Json{true});
    const std::string key = "\"answer\":";
    std::size_t place = 0;
    for (const auto& part : list(frame.body, "parts")) {
      ASSERT_NE(part.find("answer"), nullptr) << name << ' ' << text(part, "part");
      place = frame.outcome.body.find(key, place) + key.size();
      const auto alone = post("/v1/parts", at(part, "answer/request"));
      ASSERT_FALSE(alone.outcome.error) << alone.outcome.body.substr(0, 500);
      EXPECT_EQ(text_of(frame.outcome.body, place), alone.outcome.body)
          << name << ' ' << text(part, "part");
      ++parts;
    }
  }
  EXPECT_GE(parts, 30U);
}

// An engine of another version has the same hash where it has the same numbers.
TEST(Frames, ResultContainsTheHashOfEveryPartButNoEngine) {
  for (const auto& [name, request] : all_examples()) {
    const auto frame = asked(request);
    EXPECT_EQ(dump(at(frame.body, "result")).find("engine"), std::string::npos) << name;
    const auto& parts = list(frame.body, "parts");
    const auto& rows = list(frame.body, "result/cut_list");
    ASSERT_EQ(parts.size(), rows.size());
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (parts[i].find("answer") == nullptr) continue;
      EXPECT_EQ(text(rows[i], "result_sha256"), text(parts[i], "answer/job/result_sha256"));
    }
  }
}

TEST(Frames, EchoedRequestGivesTheSameAnswer) {
  for (const auto& [name, request] : all_examples()) {
    const auto first = asked(request);
    const auto again = asked(at(first.body, "request"));
    EXPECT_EQ(first.outcome.body, again.outcome.body) << name;
  }
}

TEST(Frames, MembersAreMadeOnceAndCounted) {
  const auto frame = asked(example("frames/truss-of-19.json"));
  std::map<std::string, double> counts;
  double members = 0;
  for (const auto& row : list(frame.body, "result/cut_list")) {
    counts[text(row, "part")] = number(row, "count");
    members += number(row, "count");
  }
  EXPECT_EQ(counts,
            (std::map<std::string, double>{{"top", 1}, {"bottom", 1}, {"P0", 9}, {"D0", 8}}));
  EXPECT_EQ(members, number(frame.body, "result/totals/members"));
  EXPECT_EQ(number(frame.body, "result/totals/made"), 19.0);
  EXPECT_EQ(number(frame.body, "result/totals/parts"), 4.0);
}

/// A truss moved and turned in the world.
Json moved(const Json& request, double deg, double dx) {
  Json out = request;
  const double c = std::cos(deg * M_PI / 180), s = std::sin(deg * M_PI / 180);
  const auto count = list(request, "members").size();
  for (std::size_t i = 0; i < count; ++i)
    for (const auto* field : {"start_mm", "end_mm", "up"}) {
      const auto path = "members/" + std::to_string(i) + "/" + field;
      const auto& member = list(request, "members")[i];
      if (member.find(field) == nullptr) continue;
      const auto p = numbers(request, path);
      const double by = std::string_view(field) == "up" ? 0.0 : dx;
      // about (1, 1, 0): rotations about z, then x
      const double x = c * p[0] - s * p[1], y = s * p[0] + c * p[1];
      out = with(out, path,
                 Json{Json::Array{Json{x + by}, Json{c * y - s * p[2] - by},
                                  Json{s * y + c * p[2] + 2 * by}}});
    }
  return out;
}

// A part is the same at any position of its frame, and has the same hash.
TEST(Frames, PartsDoNotDependOnTheFramesPosition) {
  const auto request = example("frames/truss-of-19.json");
  const auto here = asked(request);
  std::set<std::string> hashes;
  for (const auto& part : list(here.body, "parts")) hashes.insert(text(part, "canonical_sha256"));
  EXPECT_EQ(hashes.size(), 4U);
  for (const double deg : {37.0, 201.5}) {
    const auto there = asked(moved(request, deg, 1234.5));
    ASSERT_EQ(list(there.body, "parts").size(), 4U);
    for (const auto& part : list(there.body, "parts"))
      EXPECT_TRUE(hashes.contains(text(part, "canonical_sha256"))) << text(part, "part");
  }
}

// By frame and by node: the same points, to the printed digits.
TEST(Frames, AMemberIsThatOfItsNode) {
  const auto node = example("parts/chord-with-holes.json");
  Json::Array members;
  for (const auto& one : list(node, "members")) members.push_back(without(one, "joints"));
  Json frame{Json::Object{
      {"members", Json{members}},
      {"joints", *api::parse(R"([
        {"between": ["B1", "C1"], "kind": "set_on", "gap_mm": 2, "hole": "cut"},
        {"between": ["C1", "B2"], "kind": "set_in", "gap_mm": 1.5, "groove": {"rule": "none"}, "tilt": "free"}])")},
      {"defaults", *api::parse(R"({"root_surface": "inner", "groove": {"rule": "half_dihedral"},
                                   "smoothing": {"method": "none"}})")},
      {"kerf_mm", at(node, "kerf_mm")},
      {"sampling", at(node, "sampling")}}};
  const auto whole = asked(frame);
  const auto chord = post("/v1/parts", node);
  const auto stub = post("/v1/parts", example("parts/set-in-branch.json"));
  const auto same = [](const Json& a, const Json& b, const std::string& column) {
    const auto p = numbers(a, "answer/" + column), q = numbers(b, column);
    // The rows may begin at another phi, so no row contains the extreme of the cut.
    const auto [low, high] = std::ranges::minmax(p);
    const auto [least, most] = std::ranges::minmax(q);
    EXPECT_NEAR(high - low, most - least, 0.01) << column;
    EXPECT_GT(high - low, 1.0) << column;
  };
  const auto& own = of_id(whole.body, "parts", "part", "C1");
  for (const int hole : {0, 1})
    for (const char* column : {"z_mm", "z_inner_mm"})
      same(own, chord.body, "result/holes/" + std::to_string(hole) + "/points/" + column);
  EXPECT_EQ(list(own, "answer/result/marks").size(), list(chord.body, "result/marks").size());
  const auto& in = of_id(whole.body, "parts", "part", "B2");
  for (const char* column : {"z_inner_mm", "z_outer_mm"})
    same(in, stub.body, std::string("result/ends/start/points/") + column);
  // Its frame in the world is that of the node's part.
  const auto& member = of_id(whole.body, "result/members", "id", "C1");
  for (const char* axis : {"origin_mm", "x", "y", "z"}) {
    const auto a = numbers(member, std::string("frame/") + axis);
    const auto b = numbers(chord.body, std::string("result/frame/") + axis);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], 1e-5) << axis;
  }
}

// One set-in joint, two cuts: stated separately they differed by 12.9 mm, both `ok`. Here the end
// lies on its hole's joint.
TEST(Frames, BothSidesOfAJointAreOfOneStatement) {
  for (const char* depth : {"", R"(, "depth_mm": 8)"}) {
    auto request = example("frames/jacket-node-with-set-in-stubs.json");
    const auto said = *api::parse(
        std::string(R"({"between": ["S1", "leg"], "kind": "set_in", "gap_mm": 2)") + depth + "}");
    request = with(request, "joints/0", said);
    const auto frame = asked(request);
    const auto& leg = of_id(frame.body, "parts", "part", "leg");
    const auto& stub = of_id(frame.body, "parts", "part", "S1");
    const double deep = number(stub, "answer/request/ends/start/joints/0/depth_mm");
    EXPECT_EQ(deep, *depth == '\0' ? 25.0 : 8.0);
    bool found = false;
    for (const auto& hole : list(leg, "answer/request/holes")) {
      if (text(hole, "branch/id") != "S1") continue;
      found = true;
      EXPECT_EQ(number(hole, "joint/depth_mm"), deep);
      EXPECT_EQ(number(hole, "joint/gap_mm"), 2.0);
    }
    EXPECT_TRUE(found);
    // Every point of the stub's inner edge is depth_mm below the leg's surface.
    const auto& member = of_id(frame.body, "result/members", "id", "S1");
    const auto o = numbers(member, "frame/origin_mm"), x = numbers(member, "frame/x"),
               y = numbers(member, "frame/y"), z = numbers(member, "frame/z");
    const auto phi = numbers(stub, "answer/result/ends/start/points/phi_deg");
    const auto edge = numbers(stub, "answer/result/ends/start/points/z_inner_mm");
    const double r = 273.0 / 2 - 12.5;
    for (std::size_t i = 0; i < phi.size(); ++i) {
      const double c = r * std::cos(phi[i] * M_PI / 180), s = r * std::sin(phi[i] * M_PI / 180);
      const double px = o[0] + c * x[0] + s * y[0] + edge[i] * z[0];
      const double py = o[1] + c * x[1] + s * y[1] + edge[i] * z[1];
      EXPECT_NEAR(std::hypot(px, py), 305.0 - deep, 1e-4);
    }
  }
}

TEST(Frames, UncutEndsAreListed) {
  const auto frame = asked(example("frames/pipe-spool.json"));
  std::set<std::string> told;
  for (const auto& one : list(frame.body, "result/not_cut"))
    told.insert(text(one, "why") + " " + text(one, "id") + " " + text(one, "end"));
  EXPECT_EQ(told, (std::set<std::string>{"free run 2 finish", "free branch finish",
                                         "free drain finish", "free vent finish"}));
  const auto idle = with(example("frames/pipe-spool.json"), "joints", Json{Json::Array{}});
  std::size_t others = 0;
  const auto answer = asked(idle);
  for (const auto& one : list(answer.body, "result/not_cut"))
    others += text(one, "why") == "not_joined" ? 1 : 0;
  EXPECT_EQ(others, 2U);
}

// If a part cannot be cut, it is named, with its request and the reason; the others are valid.
TEST(Frames, AFailedMemberDoesNotAffectOthers) {
  auto request = example("frames/truss-of-19.json");
  request = with(request, "members/2/outer_diameter_mm", Json{120.0});
  request = with(request, "members/2/priority", Json{1.0});
  const auto frame = asked(request);
  const auto& part = of_id(frame.body, "parts", "part", "P0");
  EXPECT_EQ(text(part, "problem/code"), "open_profile");
  const auto alone = post("/v1/parts", at(part, "request"));
  EXPECT_EQ(text(alone.body, "code"), "open_profile");
  EXPECT_EQ(text(part, "problem/errors/0/pointer"), "/members/2/start_mm");  // of the frame
  EXPECT_EQ(number(frame.body, "result/totals/made"), 18.0);
  EXPECT_EQ(text(frame.body, "verdict/status"), "review");
  EXPECT_EQ(text(of_id(frame.body, "warnings", "code", "no_part"), "pointer"), "/members/2");
}

// So nearly parallel that the axes meet beyond the range of a part: the part is refused, but the
// verification does not fail.
TEST(Frames, AJointTooFarAwayDoesNotFailTheVerification) {
  const auto request = *api::parse(R"({"members": [
    {"id": "a", "start_mm": [-900.3564, -499.9965, 949.7226], "end_mm": [-900.0063, 500.308, 949.99715],
     "outer_diameter_mm": 45, "wall_mm": 2.5, "priority": 1},
    {"id": "b", "start_mm": [299.9994, -513.7536, 661.8428], "end_mm": [310.7009, 513.6149, 662.18],
     "outer_diameter_mm": 40, "wall_mm": 2, "priority": 3}],
    "connect": {"within_mm": 997314}, "kerf_mm": 0.3,
    "defaults": {"root_surface": "inner", "groove": {"rule": "none"}, "smoothing": {"method": "none"}, "contact": "auto"}})");
  const auto frame = asked(request);
  EXPECT_NE(frame.outcome.body.find("b meets no member here: it runs past a"), std::string::npos);
  EXPECT_EQ(at(frame.body, "parts").as<Json::Array>()->size(), 2u);
}

std::string first_problem(const Json& request) {
  const auto answer = post(kPath, request);
  if (!answer.outcome.error) return "answered";
  return text(answer.body, "errors/0/code") + " " + text(answer.body, "errors/0/pointer");
}

TEST(Frames, EveryFieldIsChecked) {
  const auto spool = example("frames/pipe-spool.json");
  const auto refused = [&](std::string_view path, const char* value) {
    return first_problem(with(spool, path, *api::parse(value)));
  };
  EXPECT_EQ(refused("joints/0/between", R"(["run 1", "run 3"])"), "bad_choice /joints/0/between/1");
  EXPECT_EQ(refused("joints/0/between", R"(["run 1", "run 1"])"), "bad_choice /joints/0/between");
  EXPECT_EQ(refused("joints/0/between", R"(["bend", "flange"])"), "bad_choice /joints/0/between");
  EXPECT_EQ(refused("joints/1/kind", R"("butt")"), "unsupported_combination /joints/1/kind");
  EXPECT_EQ(refused("joints/1/hole", R"("cut")"), "unsupported_combination /joints/1/hole");
  EXPECT_EQ(refused("joints/0/hole", R"("cut")"), "unknown_field /joints/0/hole");
  EXPECT_EQ(refused("joints/0/depth_mm", "3"), "unknown_field /joints/0/depth_mm");
  EXPECT_EQ(refused("others/0/id", R"("run 1")"), "duplicate_id /others/0/id");
  EXPECT_EQ(refused("others/0/normal", "[0, 0, 0]"), "zero_length /others/0/normal");
  EXPECT_EQ(refused("defaults/root_gap_mm", "2"), "unsupported_combination /defaults/root_gap_mm");
  EXPECT_EQ(refused("joints/2/contact", R"("outer")"), "unsupported_combination /joints/2/contact");
  EXPECT_EQ(refused("members/0/joints", "[]"), "unknown_field /members/0/joints");
  EXPECT_EQ(refused("joints/3", R"({"between": ["branch", "run 1"], "kind": "set_on"})"),
            "joint_contradicts /joints/3");
  EXPECT_EQ(
      refused("joints/2", R"({"between": ["branch", "run 1"], "kind": "set_in", "depth_mm": 90})"),
      "out_of_range /joints/2/depth_mm");
  EXPECT_EQ(refused("joints/2", R"({"between": ["branch", "run 1"], "kind": "butt"})"),
            "no_contact /joints/2");
}

/// A part's request within a frame's answer.
const Json& request_of(const Json& frame, std::string_view part) {
  return at(of_id(frame, "parts", "part", part), "answer/request");
}

// The values of an end override its joint and the defaults, only there.
TEST(Frames, AnEndsOwnFieldsOverrideItsJoint) {
  auto spool = example("frames/pipe-spool.json");
  const auto own = *api::parse(R"([
    {"member": "branch", "end": "start", "groove": {"rule": "none"}, "contact": "auto", "kerf_mm": 2.5},
    {"member": "branch", "end": "finish", "kerf_mm": 4}])");
  const auto before = asked(spool), after = asked(with(spool, "ends", own));
  for (const auto& part : list(before.body, "parts")) {
    const auto name = std::string(text(part, "part"));
    if (name == "branch" || name == "run 1") continue;
    EXPECT_EQ(request_of(before.body, name), request_of(after.body, name)) << name;
  }
  auto expected = request_of(before.body, "branch");
  expected = with(expected, "ends/start/groove", at(own, "0/groove"));
  expected = with(expected, "ends/start/contact", at(own, "0/contact"));
  expected = with(expected, "ends/start/kerf_mm", Json{2.5});
  expected = with(expected, "ends/finish/kerf_mm", Json{4.0});
  const auto alone = post("/v1/parts", expected);
  ASSERT_FALSE(alone.outcome.error) << alone.outcome.body.substr(0, 500);
  EXPECT_EQ(at(alone.body, "result"),
            at(of_id(after.body, "parts", "part", "branch"), "answer/result"));
  // Of a set-on branch the hole's edge goes with its groove.
  EXPECT_EQ(at(request_of(after.body, "run 1"), "holes/0/groove"), at(own, "0/groove"));
}

TEST(Frames, EndsAreChecked) {
  const auto spool = example("frames/pipe-spool.json");
  const auto refused = [&](const char* ends) {
    return first_problem(with(spool, "ends", *api::parse(ends)));
  };
  EXPECT_EQ(refused(R"([{"member": "run 3", "end": "start"}])"), "bad_choice /ends/0/member");
  EXPECT_EQ(refused(R"([{"member": "run 1", "end": "top"}])"), "bad_choice /ends/0/end");
  EXPECT_EQ(refused(R"([{"member": "branch", "end": "start", "kerf_mm": 51}])"),
            "out_of_range /ends/0/kerf_mm");
  EXPECT_EQ(refused(R"([{"member": "branch", "end": "start", "tilt": "free"}])"),
            "unknown_field /ends/0/tilt");
  EXPECT_EQ(
      refused(R"([{"member": "branch", "end": "start"}, {"member": "branch", "end": "start"}])"),
      "duplicate_id /ends/1/end");
  EXPECT_EQ(refused(R"([{"member": "branch", "end": "finish", "groove": {"rule": "none"}}])"),
            "unsupported_combination /ends/0/groove");
  EXPECT_EQ(refused(R"([{"member": "branch", "end": "start", "smoothing": {"method": "soft"}}])"),
            "bad_choice /ends/0/smoothing/method");
}

// Every end and hole of every part is cut square; a field that would tilt the head is refused.
TEST(Frames, ATubeLaserNeverTilts) {
  const auto rack = example("frames/rack-by-tube-laser.json");
  const auto frame = asked(rack);
  std::size_t ends = 0;
  for (const auto& part : list(frame.body, "parts")) {
    EXPECT_EQ(text(part, "answer/request/preset"), "tube_laser");
    for (const auto* end : {"start", "finish"})
      for (const double b :
           numbers(part, std::string("answer/result/ends/") + end + "/points/b_deg")) {
        EXPECT_EQ(b, 0.0);
        ++ends;
      }
    for (const auto& hole : list(part, "answer/result/holes"))
      for (const double b : numbers(hole, "points/b_deg")) EXPECT_EQ(b, 0.0);
  }
  EXPECT_GT(ends, 100U);
  const auto refused = [&](std::string_view path, const char* value) {
    return first_problem(with(rack, path, *api::parse(value)));
  };
  EXPECT_EQ(refused("joints/2/groove", R"({"rule": "half_dihedral"})"),
            "bad_choice /joints/2/groove/rule");
  EXPECT_EQ(refused("defaults/smoothing", R"({"method": "envelope"})"),
            "bad_choice /defaults/smoothing/method");
  EXPECT_EQ(refused("joints/4/tilt", R"("free")"), "bad_choice /joints/4/tilt");
  EXPECT_EQ(refused("accept/min_seam_to_hole_mm", "3"),
            "unsupported_combination /accept/min_seam_to_hole_mm");
  EXPECT_EQ(first_problem(with(example("frames/truss-of-19.json"), "accept/max_gap_mm", Json{3.0})),
            "unsupported_combination /accept/max_gap_mm");
}

TEST(Frames, LimitsHoldForEveryPart) {
  const auto request = example("frames/truss-of-19.json");
  const auto frame = asked(with(request, "accept/max_b_deg", Json{50.0}));
  EXPECT_EQ(text(frame.body, "verdict/status"), "reject");
  const auto& post_part = of_id(frame.body, "parts", "part", "D0");
  EXPECT_EQ(text(post_part, "answer/verdict/status"), "reject");
  EXPECT_EQ(text(of_id(frame.body, "parts", "part", "top"), "answer/verdict/status"), "ok");
}

/// A truss of `n` members.
Json truss(std::size_t n) {
  auto request = example("frames/truss-of-19.json");
  auto members = list(request, "members");
  const auto post_of = members[2], diagonal = members[11];
  members.resize(2);
  const auto placed = [](const Json& m, const std::string& id, double x) {
    auto out = with(m, "id", Json{id});
    for (const auto* field : {"start_mm", "end_mm"})
      out = with(out, std::string(field) + "/0", Json{number(m, std::string(field) + "/0") + x});
    return out;
  };
  for (std::size_t i = 0; members.size() < n; ++i) {
    const double x = 500.0 * static_cast<double>(i);
    members.push_back(placed(post_of, "P" + std::to_string(i), x));
    members.push_back(placed(diagonal, "D" + std::to_string(i), x));
  }
  members.resize(n);
  const double end = 500.0 * static_cast<double>(n);
  for (const std::size_t chord : {0, 1})
    members[chord] = with(members[chord], "end_mm/0", Json{end});
  return with(request, "members", Json{members});
}

TEST(Frames, ATrussOf500IsAHandfulOfParts) {
  const auto frame = asked(truss(500));
  EXPECT_EQ(number(frame.body, "result/totals/made"), 500.0);
  EXPECT_EQ(list(frame.body, "parts").size(), 4U);
  EXPECT_EQ(list(frame.body, "result/joints").size(), 996U);
}

TEST(Frames, CborIsTheSameDocument) {
  const auto body = api::dump(example("frames/k-node-with-plate-and-square-brace.json"));
  const auto json = post(kPath, std::string_view(body));
  const auto cbor = post(kPath, std::string_view(body), "format=cbor");
  ASSERT_FALSE(cbor.outcome.error);
  EXPECT_EQ(json.outcome.job.result_sha256, cbor.outcome.job.result_sha256);
}

}  // namespace
}  // namespace tubecut::testing
