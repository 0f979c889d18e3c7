#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/angle.hpp"
#include "tests/support/call.hpp"

namespace tubecut::testing {
namespace {

api::Json t_joint() { return example("nodes/rhs-t-joint.json"); }

/// The example as the node of one end.
api::Json end_of(const std::string& member) {
  api::Json node = api::Json::Object{};
  node = with(node, "members", at(t_joint(), "members"));
  node = with(node, "connect", at(t_joint(), "connect"));
  node = with(node, "member", member);
  node = with(node, "end", "start");
  api::Json out = api::Json::Object{};
  return with(out, "node", node);
}

std::string refusal(const api::Json& request, std::string_view pointer, std::string_view path) {
  const auto answer = post(path, request);
  if (!answer.outcome.error) return "no error";
  for (const auto& one : *at(answer.body, "errors").as<api::Json::Array>())
    if (text(one, "pointer") == pointer) return text(one, "code");
  return answer.outcome.body;
}

const api::Json& end(const api::Json& answer, std::size_t index) {
  return at(answer, "result/ends/" + std::to_string(index));
}

TEST(SectionMembers, TJointOfRectangularTubes) {
  const auto answer = post("/v1/nodes", t_joint());
  ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 1500);
  EXPECT_EQ(at(answer.body, "verification/passed"), api::Json{true});
  EXPECT_EQ(text(answer.body, "request/members/0/kind"), "rectangular_tube");
  EXPECT_TRUE(at(answer.body, "result/overlaps").as<api::Json::Array>()->empty());
  const auto& post_start = end(answer.body, 2);
  EXPECT_EQ(text(post_start, "cut_by/0/member"), "chord");
  EXPECT_EQ(text(post_start, "cut_by/0/partner/kind"), "rectangular_tube");
  EXPECT_EQ(number(post_start, "cut_by/0/partner/height_mm"), 150.0);
  EXPECT_NEAR(number(post_start, "cut_by/0/placement/inclination_deg"), 90.0, 1e-9);
  EXPECT_EQ(text(post_start, "section/corners"), "nominal");
  EXPECT_EQ(number(post_start, "section/width_mm"), 60.0);
  // It stands on the chord's upper face, 75 mm above its axis, all round.
  for (const double z : numbers(post_start, "profiles/1/points/z_mm")) EXPECT_NEAR(z, 75.0, 1e-9);
  // The round brace is cut by both.
  const auto& brace = end(answer.body, 4);
  EXPECT_EQ(at(brace, "cut_by").as<api::Json::Array>()->size(), 2U);
  EXPECT_EQ(number(brace, "profiles/1/radius_mm"), 24.15);
}

/// Turned in plan with three decimals, a post as wide as its rail passes it by less than 0.001 mm.
TEST(SectionMembers, APostAsWideAsItsRailHasTheProfileOfItsBore) {
  const auto rounded = [](double value) { return std::round(1000.0 * value) / 1000.0; };
  for (int degrees = 0; degrees <= 90; degrees += 6) {
    const double x = std::sin(degrees * kRadPerDeg), y = std::cos(degrees * kRadPerDeg);
    const auto point = [&](double along, double z) {
      return api::Json{api::Json::Array{rounded(along * x), rounded(along * y), z}};
    };
    auto rail = *api::parse(R"({"id": "rail", "up": [0, 0, 1], "priority": 0})");
    auto stile = *api::parse(R"({"id": "post", "priority": 1})");
    for (auto* member : {&rail, &stile}) *member = with(*member, "size", "SHS 60x60x4 EN 10219");
    rail = with(with(rail, "start_mm", point(-500, 0)), "end_mm", point(500, 0));
    stile = with(with(stile, "start_mm", point(0, 0)), "end_mm", point(0, 600));
    stile = with(stile, "up", point(1, 0));
    auto node = *api::parse(R"({"connect": {"within_mm": 30}, "include": ["profiles"]})");
    const auto answer =
        post("/v1/nodes", with(node, "members", api::Json{api::Json::Array{rail, stile}}));
    ASSERT_FALSE(answer.outcome.error) << degrees << answer.outcome.body.substr(0, 600);
    EXPECT_TRUE(at(answer.body, "warnings").as<api::Json::Array>()->empty()) << degrees;
    const auto& profiles = *at(end(answer.body, 2), "profiles").as<api::Json::Array>();
    ASSERT_FALSE(profiles.empty()) << degrees;
    // On the rail's face, and 4 mm into its corner of 8 mm.
    const auto z = numbers(profiles.front(), "points/z_mm");
    EXPECT_NEAR(std::ranges::max(z), 30.0, 1e-3);
    EXPECT_NEAR(std::ranges::min(z), 22.0 + std::sqrt(64.0 - 16.0), 0.01);
  }
}

TEST(SectionMembers, AnEndIsTheAnswerOfItsPartners) {
  const auto node = post("/v1/nodes", t_joint());
  ASSERT_FALSE(node.outcome.error);
  for (const auto& [member, index] :
       {std::pair<std::string, std::size_t>{"post", 2}, {"brace", 4}}) {
    auto request = with(end_of(member), "sampling", at(t_joint(), "sampling"));
    const auto by_node = post("/v1/intersections", request);
    ASSERT_FALSE(by_node.outcome.error) << by_node.outcome.body.substr(0, 1500);
    EXPECT_EQ(at(by_node.body, "result/profiles"), at(end(node.body, index), "profiles"));
    EXPECT_EQ(text(by_node.body, "result/cutter_ids/0"), "chord");
    // The same by target and cutters, as the node states them.
    api::Json::Array cutters;
    for (const auto& cut : *at(end(node.body, index), "cut_by").as<api::Json::Array>())
      cutters.push_back(at(cut, "partner"));
    api::Json target = api::Json::Object{};
    if (member == "post") {
      for (const auto* field : {"kind", "height_mm", "width_mm", "wall_mm", "corners"})
        target = with(target, field, at(t_joint(), std::string("members/1/") + field));
    } else {
      target = with(with(target, "outer_diameter_mm", 48.3), "wall_mm", 3.2);
    }
    api::Json direct = api::Json::Object{};
    direct = with(with(direct, "target", target), "cutters", api::Json{std::move(cutters)});
    direct = with(direct, "sampling", at(t_joint(), "sampling"));
    const auto given = post("/v1/intersections", direct);
    ASSERT_FALSE(given.outcome.error) << given.outcome.body.substr(0, 1500);
    EXPECT_EQ(at(given.body, "result/profiles"), at(by_node.body, "result/profiles"));
  }
}

TEST(SectionMembers, BevelTableOfANodesEnd) {
  auto request = with(with(end_of("post"), "preset", "tube_laser"), "kerf_mm", 0.3);
  const auto answer = post("/v1/bevel-tables", request);
  ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 1500);
  EXPECT_EQ(number(answer.body, "result/section/height_mm"), 80.0);
  EXPECT_EQ(text(answer.body, "result/cutter_ids/0"), "chord");
  EXPECT_EQ(numbers(answer.body, "result/points/girth_mm").front(), 0.0);
  request = with(request, "columns", api::Json{api::Json::Array{api::Json{"girth_mm"}}});
  EXPECT_FALSE(post("/v1/bevel-tables", request).outcome.error);
  request = with(request, "columns", api::Json{api::Json::Array{api::Json{"phi_deg"}}});
  EXPECT_EQ(refusal(request, "/columns/0", "/v1/bevel-tables"), "bad_choice");
}

TEST(SectionMembers, TablesOfAllEnds) {
  auto request = t_joint();
  request = with(request, "include", api::Json{api::Json::Array{api::Json{"tables"}}});
  const auto options = *api::parse(
      R"({"root_surface": "inner", "groove": {"rule": "fixed", "angle_deg": 40}, "kerf_mm": 1,
          "smoothing": {"method": "none"}, "columns": ["phi_deg", "b_deg"]})");
  const auto answer = post("/v1/nodes", with(request, "tables", options));
  ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 1500);
  const auto& of_post = end(answer.body, 2);
  EXPECT_EQ(numbers(of_post, "table/points/girth_mm").size(),
            numbers(of_post, "table/points/b_deg").size());
  EXPECT_EQ(number(of_post, "table/section/height_mm"), 80.0);
  EXPECT_FALSE(numbers(end(answer.body, 4), "table/points/phi_deg").empty());
}

TEST(SectionMembers, RefusesWhatIsMissing) {
  EXPECT_EQ(refusal(without(t_joint(), "members/1/up"), "/members/1/up", "/v1/nodes"),
            "missing_field");
  EXPECT_EQ(
      refusal(with(t_joint(), "members/1/up",
                   api::Json{api::Json::Array{api::Json{0.0}, api::Json{0.0}, api::Json{1.0}}}),
              "/members/1/up", "/v1/nodes"),
      "bad_reference_direction");
  EXPECT_EQ(refusal(with(t_joint(), "members/1/kind", "hexagon"), "/members/1/kind", "/v1/nodes"),
            "bad_choice");
  EXPECT_EQ(refusal(with(t_joint(), "members/0/size", "SHS 80x80"), "/members/0/size", "/v1/nodes"),
            "unknown_size");
  EXPECT_FALSE(post("/v1/nodes", with(t_joint(), "members/2/kind", "round")).outcome.error);
}

/// The example as a frame.
api::Json frame() {
  api::Json out = api::Json::Object{};
  out = with(out, "members", at(t_joint(), "members"));
  out = with(out, "connect", at(t_joint(), "connect"));
  out = with(out, "defaults",
             *api::parse(R"({"root_surface": "inner", "groove": {"rule": "fixed", "angle_deg": 40},
                             "smoothing": {"method": "none"}})"));
  return with(out, "kerf_mm", 1.0);
}

/// The part of a frame's answer, with its request and result.
api::Json part_of(const api::Json& frame, const std::string& id) {
  for (const auto& one : *at(frame, "parts").as<api::Json::Array>())
    if (text(one, "part") == id) return at(one, "answer");
  return {};
}

/// Numbers of a frame's requests are written to 1e-6 mm; a point on a corner moves by some more.
constexpr double kWritten = 1e-5;

TEST(SectionMembers, AFrameMakesThePartsOfItsMembers) {
  const auto answer = post("/v1/frames", frame());
  ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 1500);
  EXPECT_EQ(at(answer.body, "verification/passed"), api::Json{true});
  const auto defaults = at(frame(), "defaults");
  for (const char* id : {"chord", "post", "brace"}) {
    auto request = with(with(at(end_of(id), "node"), "member", id), "kerf_mm", 1.0);
    request = without(request, "end");
    for (const auto& [name, value] : *defaults.as<api::Json::Object>())
      request = with(request, name, value);
    const auto alone = post("/v1/parts", request);
    ASSERT_FALSE(alone.outcome.error) << alone.outcome.body.substr(0, 1500);
    const auto own = part_of(answer.body, id);
    for (const char* name : {"long_mm", "blank_mm", "weld_mm", "mass_kg"})
      EXPECT_NEAR(number(own, std::string("result/lengths/") + name),
                  number(alone.body, std::string("result/lengths/") + name), kWritten)
          << id << " " << name;
    for (const char* end : {"start", "finish"}) {
      const auto points = std::string("result/ends/") + end + "/points/z_outer_mm";
      const auto framed = numbers(own, points), direct = numbers(alone.body, points);
      ASSERT_EQ(framed.size(), direct.size()) << id << " " << end;
      for (std::size_t i = 0; i < framed.size(); ++i)
        ASSERT_NEAR(framed[i], direct[i], kWritten) << id << " " << end << " " << i;
    }
  }
  // The branches are marked on the chord, where /v1/parts marks them.
  const auto chord = part_of(answer.body, "chord");
  EXPECT_EQ(at(chord, "request/marks").as<api::Json::Array>()->size(), 2U);
  EXPECT_EQ(text(chord, "request/target/size"), text(t_joint(), "members/0/size"));
}

/// The post as a part: its end as its table, moved to its long point; the brace's mark on it.
TEST(SectionMembers, ArePartsWithTheTablesOfTheirEnds) {
  auto part = at(end_of("post"), "node");
  part = without(part, "end");
  const auto options = *api::parse(
      R"({"root_surface": "inner", "groove": {"rule": "fixed", "angle_deg": 40},
          "smoothing": {"method": "none"}, "kerf_mm": 1})");
  for (const auto& [name, value] : *options.as<api::Json::Object>()) part = with(part, name, value);
  const auto whole = post("/v1/parts", part);
  ASSERT_FALSE(whole.outcome.error) << whole.outcome.body.substr(0, 1500);
  EXPECT_EQ(at(whole.body, "verification/passed"), api::Json{true});
  auto alone = with(api::Json{api::Json::Object{}}, "node", at(end_of("post"), "node"));
  for (const auto& [name, value] : *options.as<api::Json::Object>())
    alone = with(alone, name, value);
  const auto table = post("/v1/bevel-tables", alone);
  ASSERT_FALSE(table.outcome.error) << table.outcome.body.substr(0, 1500);
  const auto moved = numbers(whole.body, "result/ends/start/points/z_outer_mm");
  const auto own = numbers(table.body, "result/points/z_outer_mm");
  ASSERT_EQ(moved.size(), own.size());
  const double long_point = numbers(whole.body, "result/frame/origin_mm")[2];
  for (std::size_t i = 0; i < own.size(); ++i) EXPECT_NEAR(moved[i] + long_point, own[i], 1e-9);
  // The brace leaves the post's face at x = 40, 40 mm above its own start.
  const auto& marks = *at(whole.body, "result/marks").as<api::Json::Array>();
  const auto& mark = marks.back();
  EXPECT_EQ(text(mark, "text"), "brace");
  EXPECT_NEAR(number(mark, "z_from_mm"), 100.0 - long_point, 1e-9);
  EXPECT_NEAR(number(mark, "girth_mm"), 0.0, 1e-9);
  for (const char* other : {"brace", "chord"}) {
    const auto answer = post("/v1/parts", with(part, "member", other));
    EXPECT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 1500);
  }
  // A hole in it is a cut-out on one flat; a member that does not end on it has none.
  const auto hole = *api::parse(R"([{"member": "chord", "joint": {"kind": "set_in"}}])");
  EXPECT_EQ(refusal(with(part, "holes", hole), "/holes/0/member", "/v1/parts"), "no_contact");
}

}  // namespace
}  // namespace tubecut::testing
