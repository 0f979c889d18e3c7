// Frames of square and rectangular tubes as workshops draw them: gates, trusses with gaps, trailer
// frames, stairs with railings, racks, drawn from either end, turned in space, written with three
// decimals. Every member has a part; placed back in the world, no end enters a partner, and each
// end touches one.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>

#include "core/section/section.hpp"
#include "tests/support/call.hpp"

namespace tubecut::testing {
namespace {

using api::Json;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

struct Tube {
  std::string id;
  Vector3d start, finish, up;
  section::Section section;
  int priority = 0;
};
struct Pair {
  std::string branch, chord;
  bool mitre = false;
};
struct Model {
  std::vector<Tube> tubes;
  std::vector<Pair> joints;
};

section::Section box(double height, double width, double wall) {
  const auto radii = section::corner_radii(section::Standard::en_10219, wall);
  return {height, width, wall, radii.outer, radii.inner};
}

class Drawn {
 public:
  explicit Drawn(unsigned seed) : random_(seed) {}

  double between(double a, double b) {
    return std::round(std::uniform_real_distribution<>(a, b)(random_));
  }
  std::size_t upto(std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n)(random_);
  }
  bool coin() { return upto(1) == 0; }

  /// Four mitred sides, a brace, bars on both sides of it.
  Model gate() {
    const double w = between(900, 2400), h = between(800, 1600), b = between(40, 60);
    const auto side = box(coin() ? b : b + 20, b, 3), bar = box(20, 20, 2);
    Model out;
    out.tubes = {{"bottom", {0, 0, 0}, {w, 0, 0}, {0, 0, 1}, side},
                 {"right", {w, 0, 0}, {w, 0, h}, {1, 0, 0}, side},
                 {"top", {w, 0, h}, {0, 0, h}, {0, 0, 1}, side},
                 {"left", {0, 0, h}, {0, 0, 0}, {1, 0, 0}, side},
                 {"brace", {0, 0, 0}, {w, 0, h}, {0, 1, 0}, box(30, 30, 2), 1}};
    out.joints = {{"bottom", "right", true}, {"right", "top", true}, {"top", "left", true},
                  {"left", "bottom", true},  {"brace", "bottom"},    {"brace", "left"},
                  {"brace", "top"},          {"brace", "right"}};
    for (int i = 1; i < 5; ++i) {
      const double x = 0.2 * i * w, z = 0.2 * i * h;
      const auto name = std::to_string(i);
      const Vector3d up = coin() ? Vector3d::UnitX() : Vector3d::UnitY();
      out.tubes.push_back({"below " + name, {x, 0, 0}, {x, 0, z}, up, bar, 2});
      out.tubes.push_back({"above " + name, {x, 0, h}, {x, 0, z}, up, bar, 2});
      for (const auto* one : {"below ", "above "}) {
        out.joints.push_back({one + name, one[0] == 'b' ? "bottom" : "top"});
        out.joints.push_back({one + name, "brace"});
      }
    }
    return out;
  }

  /// Two chords and braces in K nodes with a gap, square or wider than high.
  Model truss() {
    const double h = between(600, 1200), step = between(700, 1400), side = between(80, 140);
    const auto chord = box(side, side + 20 * static_cast<double>(upto(2)), 5);
    const auto brace = box(between(40, 60), between(40, 60), 4);
    Model out;
    out.tubes = {{"lower", {-300, 0, 0}, {4 * step + 300, 0, 0}, {0, 0, 1}, chord},
                 {"upper", {-300, 0, h}, {4 * step + 300, 0, h}, {0, 0, 1}, chord}};
    const double apart = 0.5 * brace.reach() + between(30, 50);
    for (int i = 0; i < 4; ++i) {
      const double x = i * step;
      const auto name = "brace " + std::to_string(i);
      Tube one{name, {x + apart, 0, 0}, {x + step - apart, 0, h}, {0, 1, 0}, brace, 1};
      if (i % 2 == 1) std::swap(one.start.z(), one.finish.z());
      out.tubes.push_back(one);
      out.joints.push_back({name, "lower"});
      out.joints.push_back({name, "upper"});
    }
    return out;
  }

  /// Two long members, cross members, a drawbar in a V.
  Model trailer() {
    const double l = between(2400, 4200), w = between(1000, 1500);
    const auto main = box(between(80, 120), between(50, 60), 4), cross = box(60, 40, 3);
    Model out;
    out.tubes = {{"left", {0, 0, 0}, {l, 0, 0}, {0, 0, 1}, main},
                 {"right", {0, w, 0}, {l, w, 0}, {0, 0, 1}, main},
                 {"front", {l, 0, 0}, {l, w, 0}, {0, 0, 1}, main}};
    out.joints = {{"left", "front", true}, {"right", "front", true}};
    for (int i = 0; i < 5; ++i) {
      const auto name = "cross " + std::to_string(i);
      const double x = 0.17 * l * (i + 0.3);
      out.tubes.push_back({name, {x, 0, 0}, {x, w, 0}, {0, 0, 1}, cross, 1});
      out.joints.push_back({name, "left"});
      out.joints.push_back({name, "right"});
    }
    const double tip = between(900, 1300);
    for (const double y : {0.15, 0.85}) {
      const std::string name = y < 0.5 ? "bar left" : "bar right";
      out.tubes.push_back(
          {name, {l, y * w, 0}, {l + tip, 0.5 * w, 0}, {0, 0, 1}, box(60, 60, 4), 1});
      out.joints.push_back({name, "front"});
    }
    out.joints.push_back({"bar left", "bar right", true});
    return out;
  }

  /// Two stringers with rungs, posts on one of them, a rail on the posts.
  Model stairs() {
    const double run = between(1500, 3000), rise = between(1200, 2600), w = between(700, 1100);
    const auto stringer = box(120, 60, 4), rung = box(40, 40, 3), post = box(40, 40, 3);
    const Vector3d a(0, 0, 0), b(run, 0, rise), across(0, w, 0), above(0, 0, 900);
    Model out;
    out.tubes = {{"left", a, b, {0, 0, 1}, stringer},
                 {"right", a + across, b + across, {0, 0, 1}, stringer},
                 {"rail", a + above, b + above, {0, 0, 1}, box(60, 40, 3)}};
    for (int i = 1; i < 5; ++i) {
      const Vector3d at = a + 0.2 * i * (b - a);
      const auto name = std::to_string(i);
      out.tubes.push_back(
          {"rung " + name, at, at + across, coin() ? Vector3d(0, 0, 1) : b - a, rung, 1});
      out.joints.push_back({"rung " + name, "left"});
      out.joints.push_back({"rung " + name, "right"});
      const Vector3d foot = at + 0.05 * (b - a);
      out.tubes.push_back({"post " + name, foot, foot + above, {1, 0, 0}, post, 1});
      out.joints.push_back({"post " + name, "left"});
      out.joints.push_back({"post " + name, "rail"});
    }
    return out;
  }

  /// Uprights, beams at three levels, diagonals at one side.
  Model rack() {
    const double w = between(1200, 2700), d = between(600, 1100), h = between(1800, 2600);
    const auto upright = box(60, 60, 3), beam = box(between(40, 55), 40, 2.5);
    Model out;
    for (const double x : {0.0, w})
      for (const double y : {0.0, d})
        out.tubes.push_back({name_of(x, y), {x, y, 0}, {x, y, h}, {1, 0, 0}, upright});
    for (int level = 1; level <= 3; ++level) {
      const double z = 0.3 * level * h;
      for (const double y : {0.0, d})
        add_beam(out, "beam " + std::to_string(level), {0, y, z}, {w, y, z}, beam);
      for (const double x : {0.0, w})
        add_beam(out, "tie " + std::to_string(level), {x, 0, z}, {x, d, z}, beam);
    }
    add_beam(out, "diagonal", {0, 0, 0.35 * h}, {0, d, 0.55 * h}, box(30, 30, 2));
    return out;
  }

  /// Another order, other ends first, another place, other decimals.
  void redraw(Model& model) {
    std::ranges::shuffle(model.tubes, random_);
    std::ranges::shuffle(model.joints, random_);
    const Matrix3d turn = turned();
    const double digits = coin() ? 1e3 : 1e9;
    const Vector3d to(between(-4000, 4000), between(-4000, 4000), between(-500, 500));
    for (auto& t : model.tubes) {
      if (coin()) std::swap(t.start, t.finish);
      for (auto* p : {&t.start, &t.finish}) {
        const Vector3d q = turn * *p + to;
        *p = (digits * q).array().round() / digits;
      }
      t.up = turn * t.up * (coin() ? 1.0 : -1.0);
      t.up = (1e6 * t.up).array().round() / 1e6;
    }
  }

 private:
  static std::string name_of(double x, double y) {
    return "upright " + std::to_string(x > 0.0) + std::to_string(y > 0.0);
  }
  static void add_beam(Model& out, const std::string& name, const Vector3d& a, const Vector3d& b,
                       const section::Section& section) {
    const auto id = name + " " + std::to_string(out.tubes.size());
    out.tubes.push_back({id, a, b, {0, 0, 1}, section, 1});
    out.joints.push_back({id, name_of(a.x(), a.y())});
    out.joints.push_back({id, name_of(b.x(), b.y())});
  }
  Matrix3d turned() {
    const double plan = std::uniform_real_distribution<>(-3.0, 3.0)(random_);
    if (coin()) return Eigen::AngleAxisd(plan, Vector3d::UnitZ()).matrix();
    return Eigen::Quaterniond(Eigen::Vector4d::Random().normalized()).matrix();
  }
  std::mt19937 random_;
};

Json three(const Vector3d& v) { return Json{Json::Array{Json{v.x()}, Json{v.y()}, Json{v.z()}}}; }

Json request_of(const Model& model) {
  Json::Array members, joints;
  for (const auto& t : model.tubes)
    members.emplace_back(Json::Object{{"id", Json{t.id}},
                                      {"start_mm", three(t.start)},
                                      {"end_mm", three(t.finish)},
                                      {"kind", Json{"rectangular_tube"}},
                                      {"height_mm", Json{t.section.height}},
                                      {"width_mm", Json{t.section.width}},
                                      {"wall_mm", Json{t.section.wall}},
                                      {"corners", Json{"en_10219"}},
                                      {"up", three(t.up)},
                                      {"priority", Json{static_cast<double>(t.priority)}}});
  for (const auto& j : model.joints)
    joints.emplace_back(Json::Object{{"between", Json{Json::Array{Json{j.branch}, Json{j.chord}}}},
                                     {"kind", Json{j.mitre ? "mitre" : "set_on"}}});
  return Json{Json::Object{{"preset", Json{"tube_laser"}},
                           {"members", Json{std::move(members)}},
                           {"joints", Json{std::move(joints)}},
                           {"sampling", *api::parse(R"({"tolerance_mm": 0.1})")},
                           {"kerf_mm", Json{0.2}}}};
}

/// Signed distance of a point to a member's outside, across its axis alone.
double outside(const Tube& t, const Vector3d& p) {
  const Vector3d z = (t.finish - t.start).normalized();
  const Vector3d x = (t.up - t.up.dot(z) * z).normalized();
  const Vector3d from = p - t.start;
  const Vector2d q(std::abs(from.dot(x)), std::abs(from.dot(z.cross(x))));
  const double r = t.section.corner;
  const Vector2d d = q - Vector2d(0.5 * t.section.height - r, 0.5 * t.section.width - r);
  return d.cwiseMax(0.0).norm() + std::min(d.maxCoeff(), 0.0) - r;
}

/// The points of both edges of a member's end, in the world.
std::vector<Vector3d> edge_points(const Json& part, const Json& place, const Tube& t,
                                  const std::string& end) {
  const auto column = [&](const char* name) {
    return numbers(part, "result/ends/" + end + "/points/" + name);
  };
  const auto vector = [&](const char* name) {
    const auto v = numbers(place, name);
    return Vector3d(v[0], v[1], v[2]);
  };
  const Vector3d origin = vector("origin_mm"), x = vector("x"), z = vector("z");
  const auto outer = t.section.outer();
  const auto girth = column("girth_mm"), out = column("z_outer_mm"), in = column("z_inner_mm");
  std::vector<Vector3d> points;
  for (std::size_t i = 0; i < girth.size(); ++i) {
    const auto at = outer.at(girth[i]);
    const Vector2d inside = at.point - t.section.wall * at.normal;
    for (const auto& [p, height] :
         {std::pair{at.point, out[i]}, std::pair{Vector2d(inside), in[i]}})
      points.push_back(origin + p.x() * x + p.y() * z.cross(x) + height * z);
  }
  return points;
}

struct Found {
  double deepest = 0.0, farthest = 0.0;
  std::size_t joints = 0;
};

/// Looks at each stated joint that is no mitre: the end of the branch that is nearer to the chord.
Found search(const Model& model, const Json& answer) {
  std::map<std::string, const Tube*> tubes;
  for (const auto& t : model.tubes) tubes[t.id] = &t;
  std::map<std::string, const Json*> parts, places;
  for (const auto& one : *at(answer, "parts").as<Json::Array>()) parts[text(one, "part")] = &one;
  std::map<std::string, std::string> part_of;
  for (const auto& one : *at(answer, "result/members").as<Json::Array>()) {
    part_of[text(one, "id")] = text(one, "part");
    places[text(one, "id")] = &at(one, "frame");
  }
  Found out;
  std::map<std::pair<std::string, std::string>, double> of_ends;  // to its nearest partner
  for (const auto& j : model.joints) {
    ++out.joints;
    if (j.mitre) continue;
    const auto& part = at(*parts.at(part_of.at(j.branch)), "answer");
    double nearest = 1e9;
    std::string of;
    for (const std::string end : {"start", "finish"}) {
      double least = 1e9;
      for (const auto& p : edge_points(part, *places.at(j.branch), *tubes.at(j.branch), end))
        least = std::min(least, outside(*tubes.at(j.chord), p));
      if (std::abs(least) >= std::abs(nearest)) continue;
      nearest = least;
      of = end;
    }
    out.deepest = std::max(out.deepest, -nearest);
    auto& end = of_ends.try_emplace({j.branch, of}, nearest).first->second;
    end = std::min(end, nearest);
  }
  for (const auto& [end, nearest] : of_ends) out.farthest = std::max(out.farthest, nearest);
  return out;
}

using Kind = Model (Drawn::*)();
class SectionFrames : public ::testing::TestWithParam<std::pair<const char*, Kind>> {};

TEST_P(SectionFrames, HaveEveryPartWhereItBelongs) {
  std::size_t joints = 0;
  for (unsigned seed = 1; seed <= 9; ++seed) {
    Drawn drawn(seed);
    auto model = (drawn.*GetParam().second)();
    drawn.redraw(model);
    const auto answer = post("/v1/frames", request_of(model));
    ASSERT_FALSE(answer.outcome.error) << seed << " " << answer.outcome.body.substr(0, 1500);
    EXPECT_EQ(at(answer.body, "verification/passed"), Json{true}) << seed;
    EXPECT_EQ(number(answer.body, "result/totals/made"), static_cast<double>(model.tubes.size()))
        << seed << " " << api::dump(at(answer.body, "warnings")).substr(0, 1500);
    // A laser's square wall leaves the root of a slanting cut open, which is to be reviewed.
    for (const auto& reason : *at(answer.body, "verdict/reasons").as<api::Json::Array>())
      EXPECT_EQ(reason, api::Json{"root_opens"})
          << seed << " " << api::dump(at(answer.body, "warnings")).substr(0, 1500);
    if (::testing::Test::HasFailure()) return;
    const auto found = search(model, answer.body);
    EXPECT_LT(found.deepest, 1e-3) << seed;
    EXPECT_LT(found.farthest, 0.1) << seed;  // the sampling's tolerance
    joints += found.joints;
  }
  RecordProperty("joints", static_cast<int>(joints));
}

TEST_P(SectionFrames, DoNotDependOnHowTheyAreDrawn) {
  const auto masses = [](const Model& model) {
    const auto answer = post("/v1/frames", request_of(model));
    std::map<std::string, double> out;
    std::map<std::string, double> of_parts;
    for (const auto& one : *at(answer.body, "result/cut_list").as<Json::Array>())
      of_parts[text(one, "part")] = number(one, "mass_kg");
    for (const auto& one : *at(answer.body, "result/members").as<Json::Array>())
      out[text(one, "id")] = of_parts.at(text(one, "part"));
    return out;
  };
  for (unsigned seed = 30; seed <= 33; ++seed) {
    Drawn drawn(seed);
    auto model = (drawn.*GetParam().second)();
    const auto before = masses(model);
    drawn.redraw(model);
    const auto after = masses(model);
    ASSERT_EQ(before.size(), after.size());
    for (const auto& [id, mass] : before)
      EXPECT_NEAR(after.at(id), mass, 1e-4 * mass) << seed << " " << id;
  }
}

INSTANTIATE_TEST_SUITE_P(EveryKind, SectionFrames,
                         ::testing::Values(std::pair{"gate", &Drawn::gate},
                                           std::pair{"truss", &Drawn::truss},
                                           std::pair{"trailer", &Drawn::trailer},
                                           std::pair{"stairs", &Drawn::stairs},
                                           std::pair{"rack", &Drawn::rack}),
                         [](const auto& info) { return info.param.first; });

/// A square tube is the same after a quarter turn, a rectangular one after a half.
TEST(SectionFrames, TurnedMembersShareTheirPart) {
  const auto parts = [](const Vector3d& up, const section::Section& bar) {
    Model model;
    model.tubes = {{"a", {0, 0, 0}, {2000, 0, 0}, {0, 0, 1}, box(80, 80, 4)},
                   {"b", {0, 0, 900}, {2000, 0, 900}, {0, 0, 1}, box(80, 80, 4)}};
    int i = 0;
    for (const Vector3d& one : {Vector3d(1, 0, 0), Vector3d(-1, 0, 0), up}) {
      const double x = 400.0 * ++i;
      const auto id = "bar " + std::to_string(i);
      model.tubes.push_back({id, {x, 0, 0}, {x + 300, 0, 900}, one, bar, 1});
      model.joints.push_back({id, "a"});
      model.joints.push_back({id, "b"});
    }
    const auto answer = post("/v1/frames", request_of(model));
    EXPECT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 800);
    EXPECT_LT(search(model, answer.body).deepest, 1e-4);
    EXPECT_LT(search(model, answer.body).farthest, 0.1);
    return number(answer.body, "result/totals/parts");
  };
  EXPECT_EQ(parts({0, 1, 0}, box(40, 40, 3)), 3.0);  // the chords, with other marks, and one bar
  EXPECT_EQ(parts({0, -1, 0}, box(40, 40, 3)), 3.0);
  EXPECT_EQ(parts({-1, 0, 0}, box(60, 40, 3)), 3.0);
  EXPECT_EQ(parts({0, 1, 0}, box(60, 40, 3)), 4.0);  // lies on its side
}

/// Coordinates of a turned model are rounded to 0.001 mm, so that no two requests are equal; the
/// parts are those of the model as it was drawn.
TEST(SectionFrames, RoundedMembersShareTheirParts) {
  const auto parts = [](const Model& model) {
    const auto answer = post("/v1/frames", request_of(model));
    EXPECT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 800);
    const auto found = search(model, answer.body);
    EXPECT_LT(found.deepest, 0.021);  // alike_within_mm, and 0.001
    EXPECT_LT(found.farthest, 0.121);
    for (const auto& row : *at(answer.body, "result/cut_list").as<Json::Array>())
      EXPECT_LE(number(row, "differs_at_most_mm"), 0.02);
    return number(answer.body, "result/totals/parts");
  };
  Drawn drawn(7);
  auto rack = drawn.rack();
  const double before = parts(rack);
  const Matrix3d turn = Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()).matrix();
  for (auto& t : rack.tubes) {
    for (auto* p : {&t.start, &t.finish}) *p = (1e3 * (turn * *p)).array().round() / 1e3;
    t.up = (1e6 * (turn * t.up)).array().round() / 1e6;
  }
  EXPECT_EQ(parts(rack), before);
  EXPECT_LT(before, static_cast<double>(rack.tubes.size()) - 5.0);
}

}  // namespace
}  // namespace tubecut::testing
