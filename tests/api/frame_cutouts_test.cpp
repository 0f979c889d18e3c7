// Cut-outs of a frame's members lie in the world where each member's own request places them,
// whichever part its member shares.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <random>

#include "core/base/angle.hpp"
#include "core/section/section.hpp"
#include "tests/support/call.hpp"

namespace tubecut::testing::frame_cutouts {

using api::Json;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr const char* kFrames = "/v1/frames";

Json parsed(const std::string& text) { return *api::parse(text); }
Json three(const Vector3d& v) { return Json{Json::Array{Json{v.x()}, Json{v.y()}, Json{v.z()}}}; }

struct Hole {
  int face = 0;  // 0: of a round tube
  double offset = 0.0, phi = 0.0, z = 0.0;
};
struct Post {
  std::string id;
  Vector3d start, finish, up;
  bool round = false;
  std::vector<Hole> holes;
};

/// SHS 60 x 4 with corners of 8 mm, and a round tube.
const section::Section kPost{60.0, 60.0, 4.0, 8.0, 4.0};
constexpr double kRadius = 30.15;

Json cutout(const Hole& hole, std::size_t i) {
  const auto id = "h" + std::to_string(i);
  auto at = parsed("{}");
  at = with(at, "z_mm", hole.z);
  at = hole.face > 0
           ? with(with(at, "face", static_cast<double>(hole.face)), "offset_mm", hole.offset)
           : with(at, "phi_deg", hole.phi * kDegPerRad);
  auto out = parsed(R"({"shape": {"kind": "circle", "diameter_mm": 9}})");
  return with(with(out, "id", id.c_str()), "at", at);
}

/// Posts that end on a rail above them.
Json frame_of(const std::vector<Post>& posts) {
  Json::Array members{parsed(
      R"({"id": "rail", "start_mm": [-500, 0, 1000], "end_mm": [5000, 0, 1000], "up": [0, 0, 1],
          "kind": "rectangular_tube", "height_mm": 80, "width_mm": 80, "wall_mm": 4,
          "corners": "en_10219"})")};
  for (const auto& post : posts) {
    auto one = parsed(post.round ? R"({"outer_diameter_mm": 60.3, "wall_mm": 4})"
                                 : R"({"kind": "rectangular_tube", "height_mm": 60, "width_mm": 60,
                                       "wall_mm": 4, "corners": "en_10219"})");
    one = with(one, "id", post.id.c_str());
    one = with(with(one, "start_mm", three(post.start)), "end_mm", three(post.finish));
    one = with(with(one, "up", three(post.up)), "priority", 1.0);
    Json::Array cutouts;
    for (std::size_t i = 0; i < post.holes.size(); ++i) cutouts.push_back(cutout(post.holes[i], i));
    if (!cutouts.empty()) one = with(one, "cutouts", Json{std::move(cutouts)});
    members.push_back(std::move(one));
  }
  auto out = parsed(R"({"preset": "tube_laser", "connect": {"within_mm": 1}, "kerf_mm": 0.2,
                        "sampling": {"tolerance_mm": 0.05}})");
  return with(out, "members", Json{std::move(members)});
}

/// The place that the request states, in the world.
Vector3d wanted(const Post& post, const Hole& hole) {
  const Vector3d z = (post.finish - post.start).normalized();
  const Vector3d x = (post.up - post.up.dot(z) * z).normalized(), y = z.cross(x);
  const Vector3d foot = post.start + hole.z * z;
  if (post.round) return foot + kRadius * (std::cos(hole.phi) * x + std::sin(hole.phi) * y);
  const Vector3d normals[] = {x, y, -x, -y}, tangents[] = {y, -x, -y, x};
  const auto face = static_cast<std::size_t>(hole.face - 1);
  return foot + 30.0 * normals[face] + hole.offset * tangents[face];
}

/// The place of a hole in the member's part, moved into the world.
Vector3d placed(const Post& post, const Json& instance, const Json& frame) {
  const auto vector = [&](const char* name) {
    const auto v = numbers(frame, name);
    return Vector3d(v[0], v[1], v[2]);
  };
  const Vector3d x = vector("x"), z = vector("z");
  Vector2d p;
  if (post.round) {
    const double phi = number(instance, "phi_deg") * kRadPerDeg;
    p = kRadius * Vector2d(std::cos(phi), std::sin(phi));
  } else {
    p = kPost.outer().at(number(instance, "girth_mm")).point;
  }
  return vector("origin_mm") + p.x() * x + p.y() * z.cross(x) + number(instance, "z_mm") * z;
}

/// Checks every hole of every post.
void expect_in_place(const std::vector<Post>& posts, const Json& answer, double within = 1e-6) {
  std::map<std::string, const Json*> parts;
  for (const auto& one : *at(answer, "parts").as<Json::Array>()) parts[text(one, "part")] = &one;
  const auto& members = *at(answer, "result/members").as<Json::Array>();
  for (std::size_t i = 0; i < posts.size(); ++i) {
    const auto& member = members[i + 1];
    ASSERT_EQ(text(member, "id"), posts[i].id);
    const auto& part = *parts.at(text(member, "part"));
    if (posts[i].holes.empty()) {
      EXPECT_EQ(at(part, "answer/result").find("cutouts"), nullptr);
      continue;
    }
    const auto& groups = *at(part, "answer/result/cutouts").as<Json::Array>();
    ASSERT_EQ(groups.size(), posts[i].holes.size());
    for (std::size_t k = 0; k < groups.size(); ++k) {
      const auto made = placed(posts[i], at(groups[k], "instances/0"), at(member, "frame"));
      EXPECT_LT((made - wanted(posts[i], posts[i].holes[k])).norm(), within) << posts[i].id << k;
    }
  }
}

TEST(FrameCutouts, LieWhereEachMembersRequestPlacesThem) {
  std::mt19937 random(3);
  const auto between = [&](double a, double b) {
    return std::uniform_real_distribution<>(a, b)(random);
  };
  const std::vector<Hole> some{{1, 5.0, 0.3, 120.0}, {2, -9.0, 2.0, 300.0}};
  for (int drawing = 0; drawing < 6; ++drawing) {
    std::vector<Post> posts;
    for (int i = 0; i < 8; ++i) {
      const double x = 500.0 * i, turn = 0.5 * kPi * static_cast<double>(random() % 4);
      Post one{.id = "post " + std::to_string(i),
               .start = {x, 0, 0},
               .finish = {x, 0, 1000},
               .up = {std::round(std::cos(turn)), std::round(std::sin(turn)), 0},
               .round = drawing % 2 == 1};
      if (random() % 3 == 0) std::swap(one.start, one.finish);
      if (random() % 4 != 0) one.holes = some;
      if (!one.holes.empty() && random() % 4 == 0) one.holes.front().z = between(100, 200);
      for (auto& hole : one.holes)
        if (one.round) hole.face = 0;
      posts.push_back(std::move(one));
    }
    const auto answer = post(kFrames, frame_of(posts));
    ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 1500);
    EXPECT_EQ(at(answer.body, "verification/passed"), Json{true});
    expect_in_place(posts, answer.body);
  }
}

TEST(FrameCutouts, MembersWithTheSameOnesShareAPart) {
  std::vector<Post> posts;
  for (int i = 0; i < 4; ++i)
    posts.push_back({.id = "post " + std::to_string(i),
                     .start = {800.0 * i, 0, 0},
                     .finish = {800.0 * i, 0, 1000},
                     .up = {0, 1, 0},
                     .holes = {{1, 5.0, 0.0, 120.0}}});
  const auto parts = [&] {
    const auto answer = post(kFrames, frame_of(posts));
    EXPECT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 1500);
    expect_in_place(posts, answer.body);
    return number(answer.body, "result/totals/parts");
  };
  EXPECT_EQ(parts(), 2.0);
  posts[2].holes.front().offset = -5.0;
  EXPECT_EQ(parts(), 3.0);
  posts[2].holes.clear();
  EXPECT_EQ(parts(), 3.0);
}

/// A frame turned in plan, its coordinates rounded to 0.001 mm: the parts are those of the frame as
/// it was drawn, and each hole is where its member places it within the tolerance of alike parts.
TEST(FrameCutouts, ATurnedAndRoundedFrameKeepsItsParts) {
  std::vector<Post> posts;
  for (int i = 0; i < 6; ++i)
    posts.push_back({.id = "post " + std::to_string(i),
                     .start = {800.0 * i, 0, 0},
                     .finish = {800.0 * i, 0, 1000},
                     .up = {0, 1, 0},
                     .holes = {{1, 5.0, 0.0, 120.0}, {4, -3.0, 0.0, 240.0}}});
  auto body = frame_of(posts);
  const auto plain = number(post(kFrames, body).body, "result/totals/parts");
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.4, Vector3d::UnitZ()).matrix();
  const auto turned = [&](const Vector3d& p, double unit) {
    return Vector3d((turn * p / unit).array().round() * unit);
  };
  for (std::size_t i = 0; i < at(body, "members").as<Json::Array>()->size(); ++i) {
    const auto member = "members/" + std::to_string(i);
    for (const auto& [name, unit] : {std::pair{"start_mm", 1e-3}, {"end_mm", 1e-3}, {"up", 1e-6}}) {
      const auto v = numbers(body, member + "/" + name);
      body = with(body, member + "/" + name, three(turned({v[0], v[1], v[2]}, unit)));
    }
  }
  for (auto& one : posts) {
    one.start = turned(one.start, 1e-3);
    one.finish = turned(one.finish, 1e-3);
    one.up = turned(one.up, 1e-6);
  }
  const auto answer = post(kFrames, body);
  ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 1500);
  EXPECT_EQ(at(answer.body, "verification/passed"), Json{true});
  EXPECT_EQ(number(answer.body, "result/totals/parts"), plain);
  expect_in_place(posts, answer.body, 0.021);
}

/// Returns the pointer and the code of the one part that is refused.
std::string problem_of(const Json& body) {
  const auto answer = post(kFrames, body);
  EXPECT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 800);
  std::string out;
  for (const auto& part : *at(answer.body, "parts").as<Json::Array>())
    if (const auto* problem = part.find("problem"))
      out += text(*problem, "errors/0/pointer") + " " + text(*problem, "errors/0/code");
  return out;
}

TEST(FrameCutouts, EveryProblemIsAtItsField) {
  Post post{.id = "post", .start = {0, 0, 0}, .finish = {0, 0, 1000}, .up = {0, 1, 0}};
  post.holes = {{1, 5.0, 0.0, 120.0}};
  const auto body = frame_of({post});
  expect_refused(kFrames, with(body, "members/1/cutouts/0/at/phi_deg", 0.0),
                 "/members/1/cutouts/0/at/phi_deg", "unsupported_combination");
  expect_refused(kFrames, with(body, "members/1/cutouts/0/size", 0.0), "/members/1/cutouts/0/size",
                 "unknown_field");
  expect_refused(kFrames, with(body, "merge_in_line", Json{true}), "/merge_in_line",
                 "unsupported_combination");
  post.round = true;
  post.holes.front().face = 0;
  const auto round = frame_of({post});
  expect_refused(kFrames, without(round, "members/1/up"), "/members/1/up", "missing_field");
  // What lies beyond an end or a flat is the part's problem; the others are made.
  EXPECT_EQ(problem_of(with(round, "members/1/cutouts/0/at/z_mm", 2.0)),
            "/members/1/cutouts/0/at/z_mm cutout_off_part");
  EXPECT_EQ(problem_of(with(body, "members/1/cutouts/0/at/offset_mm", 40.0)),
            "/members/1/cutouts/0/at/offset_mm out_of_range");
  EXPECT_EQ(problem_of(with(body, "members/1/cutouts/0/at/offset_mm", 20.0)), "");
}

}  // namespace tubecut::testing::frame_cutouts
