// Groups the members of a frame into parts and bounds the differences within a group: frames made
// at random, turned in space, rounded as models are, their members in any order. The distances are
// measured in the world between the part that is made and the part that a member would have by
// itself, point by point in long double, without any code of core.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <random>
#include <set>

#include "tests/support/call.hpp"

namespace tubecut::testing {
namespace {

using api::Json;
using Real = long double;
using Point = std::array<Real, 3>;
using Groups = std::set<std::set<std::string>>;

const Real kTurn = 2 * std::acos(Real{-1});

Point operator+(const Point& a, const Point& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Point operator*(Real s, const Point& a) { return {s * a[0], s * a[1], s * a[2]}; }
Point operator-(const Point& a, const Point& b) { return a + Real{-1} * b; }
Real dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Real norm(const Point& a) { return std::sqrt(dot(a, a)); }
Point unit(const Point& a) { return (1 / norm(a)) * a; }

struct Random {
  std::mt19937_64 engine{20261128};
  Real between(Real from, Real to) {
    return std::uniform_real_distribution<double>(static_cast<double>(from),
                                                  static_cast<double>(to))(engine);
  }
  int whole(int from, int to) { return std::uniform_int_distribution<int>(from, to)(engine); }
  Point direction() {
    std::normal_distribution<double> normal;
    return unit({normal(engine), normal(engine), normal(engine)});
  }
};

/// A rigid motion: never a mirror.
struct Motion {
  std::array<Point, 3> rows{Point{1, 0, 0}, Point{0, 1, 0}, Point{0, 0, 1}};
  Point by{};
  static Motion any(Random& random) {
    Motion out;
    out.rows[0] = random.direction();
    out.rows[1] = unit(cross(random.direction(), out.rows[0]));
    out.rows[2] = cross(out.rows[0], out.rows[1]);
    out.by = random.between(0, 5000) * random.direction();
    return out;
  }
  Point operator()(const Point& p) const {
    return p[0] * rows[0] + p[1] * rows[1] + p[2] * rows[2] + by;
  }
};

struct Bar {
  std::string id;
  Point start, finish;
  Real diameter = 48.3L, wall = 3.2L;
  double priority = 0;
};

struct Model {
  std::vector<Bar> bars;
  Json::Array joints = {};
  bool found = false;  // joints of members within 5 mm
  void mitre(const std::string& a, const std::string& b) {
    joints.push_back(Json{
        Json::Object{{"between", Json{Json::Array{Json{a}, Json{b}}}}, {"kind", Json{"mitre"}}}});
  }
};

Json rounded(const Point& p, Real to) {
  Json::Array out;
  for (const Real v : p)
    out.emplace_back(static_cast<double>(to > 0 ? std::round(v / to) * to : v));
  return Json{std::move(out)};
}

/// `to`: rounding of coordinates, 0 for no rounding.
Json request_of(const Model& model, const Motion& moved, Real to, int rows) {
  Json::Array members;
  for (const auto& bar : model.bars)
    members.push_back(Json{Json::Object{{"id", Json{bar.id}},
                                        {"start_mm", rounded(moved(bar.start), to)},
                                        {"end_mm", rounded(moved(bar.finish), to)},
                                        {"outer_diameter_mm", Json{double(bar.diameter)}},
                                        {"wall_mm", Json{double(bar.wall)}},
                                        {"priority", Json{bar.priority}}}});
  Json::Object out{
      {"members", Json{std::move(members)}},
      {"joints", Json{model.joints}},
      {"defaults", *api::parse(R"({"root_surface": "inner", "groove": {"rule": "half_dihedral"},
                                   "smoothing": {"method": "none"}})")},
      {"kerf_mm", Json{1.0}},
      {"torch", *api::parse(R"({"min_deg": -88, "max_deg": 88})")},
      {"sampling", Json{Json::Object{{"uniform_points", Json{double(rows)}}}}}};
  if (model.found) out.emplace_back("connect", *api::parse(R"({"within_mm": 5})"));
  return Json{std::move(out)};
}

const Json::Array& list(const Json& json, std::string_view path) {
  return *at(json, path).as<Json::Array>();
}

Groups groups_of(const Json& answer) {
  Groups out;
  for (const auto& row : list(answer, "result/cut_list")) {
    std::set<std::string> one;
    for (const auto& id : list(row, "members")) one.insert(*id.as<std::string>());
    out.insert(std::move(one));
  }
  return out;
}

Json answered(const Json& request) {
  const auto answer = post("/v1/frames", request);
  EXPECT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 600);
  return answer.body;
}

/// The edges of a member's part in the world: closed lines.
std::vector<std::vector<Point>> edges_of(const Json& frame, const std::string& id) {
  const Json *member = nullptr, *part = nullptr;
  for (const auto& one : list(frame, "result/members"))
    if (text(one, "id") == id) member = &one;
  for (const auto& one : list(frame, "parts"))
    if (text(one, "part") == text(*member, "part")) part = &one;
  const auto vector = [&](const char* name) {
    const auto v = numbers(*member, std::string("frame/") + name);
    return Point{v[0], v[1], v[2]};
  };
  const auto origin = vector("origin_mm"), x = vector("x"), y = vector("y"), z = vector("z");
  const auto* answer = part->find("answer");
  if (answer == nullptr) return {};
  const Real outer = number(*answer, "request/target/outer_diameter_mm") / 2;
  const Real inner = outer - number(*answer, "request/target/wall_mm");
  std::vector<std::vector<Point>> out;
  const auto add = [&](const Json& points, const char* phi, const char* along, Real radius) {
    const auto a = numbers(points, phi), h = numbers(points, along);
    auto& line = out.emplace_back();
    for (std::size_t i = 0; i < a.size(); ++i) {
      const Real rad = a[i] * kTurn / 360;
      line.push_back(origin + radius * std::cos(rad) * x + radius * std::sin(rad) * y +
                     Real{h[i]} * z);
    }
  };
  for (const auto* end : {"start", "finish"}) {
    const auto& points = at(*answer, std::string("result/ends/") + end + "/points");
    add(points, "phi_deg", "z_inner_mm", inner);
    add(points, "phi_deg", "z_outer_mm", outer);
  }
  return out;
}

/// How far the first line's points lie from the second line.
Real apart(const std::vector<Point>& one, const std::vector<Point>& other, std::size_t every) {
  Real worst = 0;
  for (std::size_t k = 0; k < one.size(); k += every) {
    Real least = 1e30L;
    for (std::size_t i = 0; i < other.size(); ++i) {
      const auto& a = other[i];
      const Point along = other[(i + 1) % other.size()] - a, to = one[k] - a;
      const Real t = std::clamp(dot(to, along) / dot(along, along), Real{0}, Real{1});
      least = std::min(least, norm(to - t * along));
    }
    worst = std::max(worst, least);
  }
  return worst;
}

/// Every member's own edges, made by itself, lie at the part of its group as near as is stated.
void expect_bounds(const Json& request, const Json& frame, Real radius, int rows, Real& worst) {
  const auto own = answered(with(request, "alike_within_mm", 0.0));
  const Real sag = radius * (1 - std::cos(kTurn / (2 * rows))) * 2;
  for (const auto& row : list(frame, "result/cut_list")) {
    const Real stated = number(row, "differs_at_most_mm");
    EXPECT_LE(stated, 0.02L);
    for (const auto& id : list(row, "members")) {
      const auto a = edges_of(frame, *id.as<std::string>());
      const auto b = edges_of(own, *id.as<std::string>());
      ASSERT_EQ(a.size(), b.size());
      for (std::size_t i = 0; i < a.size(); ++i) {
        const Real off = apart(a[i], b[i], 5);
        EXPECT_LE(off, stated + sag + 1e-5L) << *id.as<std::string>() << ' ' << i;
        worst = std::max(worst, off);
      }
    }
  }
}

Model shuffled(Model model, Random& random) {
  std::ranges::shuffle(model.bars, random.engine);
  std::ranges::shuffle(model.joints, random.engine);
  return model;
}

/// Two chords, posts and diagonals, all alike.
Model truss(Random& random, int bays) {
  const Real bay = random.between(400, 700), height = random.between(400, 700);
  const Real inset = random.between(60, 80);
  Model out{.bars = {}, .found = true};
  out.bars.push_back({"bottom", {-200, 0, 0}, {bays * bay + 200, 0, 0}, 88.9L, 5, 0});
  out.bars.push_back({"top", {-200, 0, height}, {bays * bay + 200, 0, height}, 88.9L, 5, 0});
  for (int i = 0; i <= bays; ++i)
    out.bars.push_back(
        {"P" + std::to_string(i), {i * bay, 0, 0}, {i * bay, 0, height}, 48.3L, 3.2L, 1});
  for (int i = 0; i < bays; ++i)
    out.bars.push_back({"D" + std::to_string(i),
                        {i * bay + inset, 0, 0},
                        {(i + 1) * bay - inset, 0, height},
                        48.3L,
                        3.2L,
                        1});
  return out;
}

Model cube(Random& random) {
  const Real a = random.between(400, 1500);
  const Real diameter = random.between(20, 60);
  Model out;
  const auto corner = [&](int k) {
    return Point{a * (k & 1), a * ((k >> 1) & 1), a * ((k >> 2) & 1)};
  };
  const auto name = [](int k, int axis) {
    return std::string("XYZ").substr(static_cast<std::size_t>(axis), 1) + std::to_string(k);
  };
  for (int k = 0; k < 8; ++k)
    for (int axis = 0; axis < 3; ++axis)
      if ((k >> axis & 1) == 0)
        out.bars.push_back(
            {name(k, axis), corner(k), corner(k | 1 << axis), diameter, diameter / 15, 0});
  for (int k = 0; k < 8; ++k)
    for (int i = 0; i < 3; ++i)
      for (int j = i + 1; j < 3; ++j) out.mitre(name(k & ~(1 << i), i), name(k & ~(1 << j), j));
  return out;
}

/// Tubes that run together evenly round an axis, each mitred with its neighbours.
Model collector(Random& random) {
  const int n = random.whole(3, 6);
  const Real lean = random.between(15, 60) * kTurn / 360, length = random.between(500, 900);
  Model out;
  for (int k = 0; k < n; ++k) {
    const Real round = k * kTurn / n;
    out.bars.push_back({"T" + std::to_string(k),
                        {0, 0, 0},
                        length * Point{std::sin(lean) * std::cos(round),
                                       std::sin(lean) * std::sin(round), std::cos(lean)},
                        42.4L,
                        2,
                        0});
  }
  for (int k = 0; k < n; ++k) out.mitre("T" + std::to_string(k), "T" + std::to_string((k + 1) % n));
  return out;
}

/// Braces between two chords that are turned to each other: one, the same turned about its own
/// axis, and its mirror image.
Model hands(Random& random) {
  const Real turn = random.between(15, 75) * kTurn / 360, length = random.between(600, 1200);
  const Real lean = random.between(55, 80) * kTurn / 360;
  Model out{.bars = {}, .found = true};
  const auto add = [&](const std::string& id, const Point& at, Real first, Real sense) {
    const auto chord = [&](const Point& p, Real round) {
      return std::pair{p - Real{300} * Point{std::sin(lean) * std::cos(round),
                                             std::sin(lean) * std::sin(round), std::cos(lean)},
                       p + Real{300} * Point{std::sin(lean) * std::cos(round),
                                             std::sin(lean) * std::sin(round), std::cos(lean)}};
    };
    const Point top = at + Point{0, 0, length};
    const auto [a, b] = chord(at, first);
    const auto [c, d] = chord(top, first + sense * turn);
    out.bars.push_back({id + " foot", a, b, 88.9L, 5, 0});
    out.bars.push_back({id + " head", c, d, 88.9L, 5, 0});
    out.bars.push_back({id, at, top, 48.3L, 3.2L, 1});
  };
  add("one", {0, 0, 0}, 0, 1);
  add("turned", {3000, 0, 0}, random.between(0.1L, 6), 1);
  add("mirror", {0, 3000, 0}, random.between(0.1L, 6), -1);
  return out;
}

std::set<std::string> group_of(const Groups& groups, const std::string& id) {
  for (const auto& one : groups)
    if (one.contains(id)) return one;
  return {};
}

Json field(const char* name) {
  return *api::parse(read_project_file(std::string("tests/field/") + name));
}

TEST(Alike, MitredTubesOfACornerAreOnePart) {
  const auto answer = answered(field("three-alike-mitred-tubes.frame.json"));
  EXPECT_EQ(groups_of(answer), (Groups{{"X", "Y", "Z"}}));
  EXPECT_LE(number(answer, "result/cut_list/0/differs_at_most_mm"), 1e-6);
}

TEST(Alike, ATrussThatIsTurnedInPlanAndRoundedKeepsItsFourParts) {
  const auto answer = answered(field("alike-members-turned.frame.json"));
  EXPECT_EQ(groups_of(answer).size(), 4U);
}

TEST(Alike, TrussesHaveFourPartsInAnyOrientation) {
  Random random;
  Real worst = 0;
  for (int i = 0; i < 20; ++i) {
    const auto model = truss(random, random.whole(3, 5));
    const bool measured = i % 4 == 0;
    const int rows = measured ? 360 : 48;
    const auto request =
        request_of(shuffled(model, random), Motion::any(random), i % 2 == 0 ? 0.001L : 0, rows);
    const auto answer = answered(request);
    const auto groups = groups_of(answer);
    EXPECT_EQ(groups.size(), 4U) << i;
    EXPECT_EQ(group_of(groups, "P0").size(), group_of(groups, "D0").size() + 1) << i;
    if (measured) expect_bounds(request, answer, 25, rows, worst);
    if (HasFailure()) return;
  }
  std::printf("the part of a group lies up to %.2Lg mm from a member's own\n", worst);
}

TEST(Alike, TheTwelveEdgesOfACubeAreOnePart) {
  Random random;
  Real worst = 0;
  for (int i = 0; i < 20; ++i) {
    const auto request = request_of(shuffled(cube(random), random), Motion::any(random),
                                    i % 2 == 0 ? 0.001L : 0, i == 0 ? 360 : 24);
    const auto answer = answered(request);
    EXPECT_EQ(groups_of(answer).size(), 1U) << i;
    if (i == 0) expect_bounds(request, answer, 30, 360, worst);
    if (HasFailure()) return;
  }
}

TEST(Alike, TheTubesOfACollectorAreOnePart) {
  Random random;
  for (int i = 0; i < 60; ++i) {
    const auto model = collector(random);
    const auto answer = answered(
        request_of(shuffled(model, random), Motion::any(random), i % 2 == 0 ? 0.001L : 0, 24));
    EXPECT_EQ(groups_of(answer).size(), 1U) << i << ' ' << model.bars.size();
    if (HasFailure()) return;
  }
}

TEST(Alike, AMirrorImageIsAnotherPartAndATurnedOneIsNot) {
  Random random;
  for (int i = 0; i < 100; ++i) {
    const auto answer = answered(request_of(shuffled(hands(random), random), Motion::any(random),
                                            i % 2 == 0 ? 0.001L : 0, 24));
    const auto groups = groups_of(answer);
    EXPECT_EQ(group_of(groups, "one"), (std::set<std::string>{"one", "turned"})) << i;
    EXPECT_EQ(group_of(groups, "mirror"), (std::set<std::string>{"mirror"})) << i;
    if (HasFailure()) return;
  }
}

// Beyond the requested distance parts differ, within it they are one; the stated difference is the
// real one.
TEST(Alike, TheDistanceDecides) {
  Random random;
  for (int i = 0; i < 30; ++i) {
    Model model{.bars = {}, .found = true};
    const Real longer = random.between(0.002L, 0.2L);
    for (int k = 0; k < 2; ++k) {
      const Real at = 1000 * k;
      model.bars.push_back({"c" + std::to_string(k), {at - 300, 0, 0}, {at + 300, 0, 0}, 88.9L, 5});
      model.bars.push_back(
          {"b" + std::to_string(k), {at, 0, 0}, {at, 0, 500 + k * longer}, 48.3L, 3.2L, 1});
    }
    auto request = request_of(model, Motion::any(random), 0, 24);
    const auto together = answered(with(request, "alike_within_mm", double(longer)));
    EXPECT_EQ(groups_of(together).size(), 2U);
    for (const auto& row : list(together, "result/cut_list"))
      if (text(row, "part").starts_with("b")) {
        // Laid so that half of the difference is at either end.
        EXPECT_NEAR(number(row, "differs_at_most_mm"), static_cast<double>(longer / 2), 1e-6);
      }
    const auto apart = answered(with(request, "alike_within_mm", double(0.49L * longer)));
    EXPECT_EQ(groups_of(apart).size(), 4U) << "the chords carry other parts then";
  }
}

}  // namespace
}  // namespace tubecut::testing
