// Both sides of a frame's joints, from its answer: edges put into the world and measured there in
// long double, only from the members' centre-lines, without any code of core.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>

#include "tests/support/call.hpp"

namespace tubecut::testing {
namespace {

using api::Json;
using Real = long double;
using Point = std::array<Real, 3>;

constexpr Real kFit = 0.01L;  // mm
const Real kPi2 = 2 * std::acos(Real{-1});

Point operator+(const Point& a, const Point& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Point operator*(Real s, const Point& a) { return {s * a[0], s * a[1], s * a[2]}; }
Point operator-(const Point& a, const Point& b) { return a + Real{-1} * b; }
Real dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Real norm(const Point& a) { return std::sqrt(dot(a, a)); }
Point unit(const Point& a) { return (1 / norm(a)) * a; }

struct Tube {
  Point start, finish;
  Real radius = 0, wall = 0;
  [[nodiscard]] Real off(const Point& p) const {
    return norm(cross(p - start, unit(finish - start)));
  }
};

struct Random {
  std::mt19937_64 engine{20261123};
  Real between(Real from, Real to) {
    return std::uniform_real_distribution<double>(static_cast<double>(from),
                                                  static_cast<double>(to))(engine);
  }
  bool coin() { return std::uniform_int_distribution<int>(0, 1)(engine) == 1; }
  Point direction() {
    std::normal_distribution<double> normal;
    return unit({normal(engine), normal(engine), normal(engine)});
  }
  Point leaning(const Point& axis, Real deg) {
    const Point side = unit(cross(direction(), axis));
    const Real a = deg * kPi2 / 360;
    return std::cos(a) * axis + std::sin(a) * side;
  }
};

/// A chord and a branch, or two of a size that end near one point, and their statement.
struct Pair {
  Tube chord, branch;
  std::string kind;
  Real gap = 0, depth = 0;
  bool within = false;
  std::string plane = {};  // of a mitre; empty: not given
};

Pair random_pair(Random& random, const std::string& kind) {
  Pair out{.chord = {}, .branch = {}, .kind = kind};
  auto& c = out.chord;
  auto& b = out.branch;
  c.radius = random.between(40, 250);
  c.wall = c.radius * random.between(0.04L, 0.15L);
  out.gap = random.coin() ? 0 : random.between(0, 2.5L);
  out.within = random.coin();
  const Point axis = random.direction(), at = Real{1000} * random.direction();
  if (kind == "mitre" || kind == "butt") {
    const Point lean =
        kind == "butt" ? Real{-1} * axis : random.leaning(axis, random.between(40, 170));
    b = c;
    c.start = at + random.between(5, 20) * axis;
    c.finish = at + random.between(1500, 2500) * axis;
    b.start = at + random.between(5, 20) * lean;
    b.finish = at + random.between(1500, 2500) * lean;
    if (random.coin()) std::swap(b.start, b.finish);
    return out;
  }
  b.radius = c.radius * random.between(0.2L, 0.7L);
  b.wall = b.radius * random.between(0.06L, 0.25L);
  c.start = at - random.between(900, 1500) * axis;
  c.finish = at + random.between(900, 1500) * axis;
  const Point lean = random.leaning(axis, random.between(45, 135));
  const Real room = 0.9L * (c.radius - c.wall - b.radius - 3);
  b.start = at + random.between(-room, room) * unit(cross(axis, lean));
  b.finish = b.start + random.between(900, 1500) * lean;
  if (kind == "through") b.start = b.start - Real{900} * lean;
  if (random.coin()) std::swap(c.start, c.finish);
  if (random.coin()) std::swap(b.start, b.finish);
  out.depth = c.wall * (random.coin() ? Real{1} : random.between(0.5L, 1.4L));
  return out;
}

Json numbers_of(const Point& p) {
  Json::Array out;
  for (const Real v : p) out.emplace_back(static_cast<double>(v));
  return Json{std::move(out)};
}
/// Members and statements in any order.
Json request_of(const Pair& pair, bool swapped) {
  const auto member = [](const char* id, const Tube& t, double priority) {
    return Json{Json::Object{{"id", Json{id}},
                             {"start_mm", numbers_of(t.start)},
                             {"end_mm", numbers_of(t.finish)},
                             {"outer_diameter_mm", Json{static_cast<double>(2 * t.radius)}},
                             {"wall_mm", Json{static_cast<double>(t.wall)}},
                             {"priority", Json{priority}}}};
  };
  Json::Object joint{{"between", *api::parse(swapped ? R"(["B", "C"])" : R"(["C", "B"])")},
                     {"kind", Json{pair.kind}},
                     {"gap_mm", Json{static_cast<double>(pair.gap)}}};
  if (pair.kind == "set_in") joint.emplace_back("depth_mm", Json{static_cast<double>(pair.depth)});
  if (pair.kind == "set_on") joint.emplace_back("hole", Json{"cut"});
  if (!pair.plane.empty()) joint.emplace_back("plane", Json{pair.plane});
  Json::Object out{
      {"members", Json{Json::Array{member("C", pair.chord, 0), member("B", pair.branch, 1)}}},
      {"joints", Json{Json::Array{Json{std::move(joint)}}}},
      {"defaults", *api::parse(R"({"root_surface": "inner", "groove": {"rule": "half_dihedral"},
                                   "smoothing": {"method": "none"}, "tilt": "free"})")},
      {"kerf_mm", Json{1.0}},
      {"torch", *api::parse(R"({"min_deg": -88, "max_deg": 88})")},
      {"sampling", *api::parse(R"({"tolerance_mm": 0.004})")}};
  if (pair.within)
    out.emplace_back("connect",
                     Json{Json::Object{
                         {"within_mm", Json{static_cast<double>(30 + 0.5L * pair.chord.radius)}}}});
  return Json{std::move(out)};
}

/// A part as a frame's answer has it, in the world.
struct Placed {
  const Json& answer;
  Point origin, x, y, z;

  [[nodiscard]] Point at(Real radius, Real phi, Real along) const {
    return origin + radius * std::cos(phi) * x + radius * std::sin(phi) * y + along * z;
  }
};

Placed placed(const Json& frame, std::string_view id) {
  const Json *member = nullptr, *part = nullptr;
  for (const auto& one : *at(frame, "result/members").as<Json::Array>())
    if (text(one, "id") == id) member = &one;
  for (const auto& one : *at(frame, "parts").as<Json::Array>())
    if (text(one, "part") == text(*member, "part")) part = &one;
  const auto vector = [&](const char* name) {
    const auto v = numbers(*member, std::string("frame/") + name);
    return Point{v[0], v[1], v[2]};
  };
  return {*part->find("answer"), vector("origin_mm"), vector("x"), vector("y"), vector("z")};
}

/// Pairs of edge points, on the bore and outside, straight between rows as a machine goes.
template <class F>
void along(const Json& points, const char* phi_in, const char* phi_out, const char* z_in,
           const char* z_out, Real turn, F see) {
  const auto a = numbers(points, phi_in), b = numbers(points, phi_out), p = numbers(points, z_in),
             q = numbers(points, z_out);
  ASSERT_GT(a.size(), 8U);
  for (std::size_t i = 0; i < a.size(); ++i)
    for (const Real u : {0.0L, 0.25L, 0.5L, 0.75L}) {
      const auto j = (i + 1) % a.size();
      const auto mixed = [&](const std::vector<double>& v, Real more) {
        return (1 - u) * v[i] + u * (v[j] + (j == 0 ? more : 0));
      };
      const Real rad = kPi2 / 360;
      see(mixed(a, turn) * rad, mixed(b, turn) * rad, mixed(p, 0), mixed(q, 0));
    }
}

struct Seen {
  Real root = 0, under = 0;
  /// `from` may come no nearer than `asked` anywhere between the two edges.
  void see(const Point& at_root, const Point& face, const Tube& from, Real asked) {
    root = std::max(root, std::abs(from.off(at_root) - asked));
    for (int k = 0; k <= 4; ++k)
      under = std::max(under, asked - from.off((1 - k / 4.0L) * at_root + (k / 4.0L) * face));
  }
};

/// The branch's end that is cut, and the chord's holes.
void measure(const Pair& pair, const Json& frame, Seen& end, Seen& hole) {
  const auto chord = placed(frame, "C"), branch = placed(frame, "B");
  const auto& c = pair.chord;
  const auto& b = pair.branch;
  if (pair.kind != "through") {
    const Real seat = pair.kind == "set_on" ? c.radius + pair.gap : c.radius - pair.depth;
    const bool at_start = at(branch.answer, "request/ends/start").find("cutters") != nullptr;
    const auto& points = at(
        branch.answer, std::string("result/ends/") + (at_start ? "start" : "finish") + "/points");
    along(points, "phi_deg", "phi_deg", "z_inner_mm", "z_outer_mm", 360,
          [&](Real phi, Real, Real inner, Real outer) {
            end.see(branch.at(b.radius - b.wall, phi, inner), branch.at(b.radius, phi, outer), c,
                    seat);
          });
  }
  for (const auto& one : *at(chord.answer, "result/holes").as<Json::Array>())
    along(at(one, "points"), "phi_inner_deg", "phi_deg", "z_inner_mm", "z_mm", 0,
          [&](Real phi_in, Real phi_out, Real inner, Real outer) {
            const auto bore = chord.at(c.radius - c.wall, phi_in, inner);
            const auto face = chord.at(c.radius, phi_out, outer);
            if (pair.kind == "set_on")
              hole.root = std::max(hole.root, std::abs(b.off(face) - (b.radius - b.wall)));
            else
              hole.see(bore, face, b, b.radius + pair.gap);
          });
}

int count_of_each() {
  const char* asked = std::getenv("TUBECUT_JOINTS");  // NOLINT(concurrency-mt-unsafe)
  return asked == nullptr ? 12 : std::atoi(asked);
}

class FrameJoint : public ::testing::TestWithParam<const char*> {};

TEST_P(FrameJoint, BranchAndHoleFitInTheWorld) {
  Random random;
  Seen end, hole;
  int made = 0, refused = 0;
  const int wanted = count_of_each();
  while (made < wanted && refused < wanted + 10) {
    const auto pair = random_pair(random, GetParam());
    const auto answer = post("/v1/frames", request_of(pair, random.coin()));
    ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 600);
    if (number(answer.body, "result/totals/made") < 2.0) {
      ++refused;  // a bevel beyond the torch
      continue;
    }
    ++made;
    ASSERT_EQ(at(placed(answer.body, "C").answer, "result/holes").as<Json::Array>()->size(),
              pair.kind == "through" ? 2U : 1U);
    measure(pair, answer.body, end, hole);
    if (HasFailure()) return;
  }
  std::printf(
      "%d joints, %d refused: end off by %.2Lg, below by %.2Lg; hole off by %.2Lg, below "
      "by %.2Lg mm\n",
      made, refused, end.root, end.under, hole.root, hole.under);
  EXPECT_EQ(made, wanted);
  for (const Real value : {end.root, end.under, hole.root, hole.under}) EXPECT_LT(value, kFit);
}

INSTANTIATE_TEST_SUITE_P(EveryKind, FrameJoint, ::testing::Values("set_on", "set_in", "through"));

class FrameFaces : public ::testing::TestWithParam<const char*> {};

// Both faces are planes, parallel, at the distance of the gap, and tilt equally to both tubes.
TEST_P(FrameFaces, AreSeparatedByTheGap) {
  Random random;
  Real off = 0, lean = 0;
  int made = 0;
  for (int count = 0; count < count_of_each(); ++count) {
    const auto pair = random_pair(random, GetParam());
    auto request = request_of(pair, random.coin());
    request = with(request, "defaults/groove", *api::parse(R"({"rule": "none"})"));
    const auto answer = post("/v1/frames", request);
    ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 600);
    if (number(answer.body, "result/totals/made") < 2.0) continue;
    ++made;
    // From the corner into both tubes; the plane between them.
    const auto away = [&](const Tube& t, const Tube& from) {
      const auto to = [&](const Point& p) {
        return std::min(norm(p - from.start), norm(p - from.finish));
      };
      const bool at_start = to(t.start) < to(t.finish);
      return unit(at_start ? t.finish - t.start : t.start - t.finish);
    };
    const Point u = away(pair.chord, pair.branch), v = away(pair.branch, pair.chord);
    const Point n = unit(u - v);
    lean = std::max(lean, std::abs(dot(u, n) + dot(v, n)));
    Real least = 1e30L, most = -1e30L;
    for (const auto* id : {"C", "B"}) {
      const auto part = placed(answer.body, id);
      const bool at_start = at(part.answer, "request/ends/start").find("cutters") != nullptr;
      const auto& points = at(
          part.answer, std::string("result/ends/") + (at_start ? "start" : "finish") + "/points");
      along(points, "phi_deg", "phi_deg", "z_inner_mm", "z_outer_mm", 360,
            [&](Real phi, Real, Real inner, Real) {
              const Real d = dot(part.at(pair.chord.radius - pair.chord.wall, phi, inner), n);
              // Moved by the gap, the branch's face is the chord's.
              const Real shifted = *id == 'C' ? d : d + pair.gap;
              least = std::min(least, shifted);
              most = std::max(most, shifted);
            });
    }
    off = std::max(off, most - least);
  }
  std::printf("%d pairs of faces: apart by what is asked within %.2Lg mm\n", made, off);
  EXPECT_GE(2 * made, count_of_each());
  EXPECT_LT(off, kFit);
  EXPECT_LT(lean, 1e-12L);
}

INSTANTIATE_TEST_SUITE_P(EveryKind, FrameFaces, ::testing::Values("mitre", "butt"));

// The corners of two outlines lie in both faces, so that unlike tubes meet there edge to edge.
TEST(FrameCorners, LieInBothFaces) {
  Random random;
  Real off = 0;
  int made = 0;
  for (int count = 0; count < count_of_each(); ++count) {
    auto pair = random_pair(random, "mitre");
    auto& b = pair.branch;
    b.radius *= random.between(0.6L, 0.95L);
    b.wall = b.radius * random.between(0.04L, 0.15L);
    pair.plane = "corner_to_corner";
    const auto request = with(request_of(pair, random.coin()), "defaults/groove",
                              *api::parse(R"({"rule": "none"})"));
    const auto answer = post("/v1/frames", request);
    ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 600);
    if (number(answer.body, "result/totals/made") < 2.0) continue;
    ++made;
    EXPECT_EQ(text(answer.body, "result/joints/0/plane"), "corner_to_corner");
    // Where the outlines cross, from the axes' crossing: r / sin of the angle between the corner
    // and each tube.
    const auto& c = pair.chord;
    const Point at_c = c.start, x = unit(c.finish - c.start);
    const bool leaves = norm(b.finish - at_c) > norm(b.start - at_c);
    const Point y = unit(leaves ? b.finish - b.start : b.start - b.finish);
    const Point side = unit(cross(x, y));
    const Point m = cross(x, side), n = cross(side, y);
    const Point corner = c.radius * m + ((b.radius - c.radius * dot(m, n)) / dot(x, n)) * x;
    const Point normal = unit(cross(corner, side));
    Real least = 1e30L, most = -1e30L;
    for (const auto* id : {"C", "B"}) {
      const auto part = placed(answer.body, id);
      const auto& tube = *id == 'C' ? c : b;
      const bool at_start = at(part.answer, "request/ends/start").find("cutters") != nullptr;
      const auto& points = at(
          part.answer, std::string("result/ends/") + (at_start ? "start" : "finish") + "/points");
      const Real shift = dot(x, normal) > 0 ? pair.gap : -pair.gap;
      along(points, "phi_deg", "phi_deg", "z_inner_mm", "z_outer_mm", 360,
            [&](Real phi, Real, Real inner, Real) {
              const Real d = dot(part.at(tube.radius - tube.wall, phi, inner), normal) +
                             (*id == 'C' ? 0 : shift);
              least = std::min(least, d);
              most = std::max(most, d);
            });
    }
    off = std::max(off, most - least);
  }
  std::printf("%d corners: faces apart by what is asked within %.2Lg mm\n", made, off);
  EXPECT_GE(3 * made, count_of_each());
  EXPECT_LT(off, kFit);
}

}  // namespace
}  // namespace tubecut::testing
