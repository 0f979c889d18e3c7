// Root gaps that the groove's zones name: of every row the distance from its root to the partner is
// measured in long double, and so is the dihedral there. Nothing here is core's.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "tests/support/call.hpp"

namespace tubecut::testing {
namespace {

using api::Json;
using Real = long double;
using Point = std::array<Real, 3>;

constexpr const char* kTables = "/v1/bevel-tables";
const Real kHalf = std::acos(Real{-1});

Point operator-(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Point operator*(Real s, const Point& a) { return {s * a[0], s * a[1], s * a[2]}; }
Real dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

struct Zone {
  Real from, to, gap;
};

/// A groove by zones that overlap, from the top down, with gaps.
Json groove_of(const std::vector<Zone>& zones) {
  Json::Array out;
  for (const auto& zone : zones)
    out.push_back(Json{Json::Object{
        {"id", Json{std::string(1, static_cast<char>('A' + out.size()))}},
        {"dihedral_deg", Json{Json::Array{Json{double(zone.from)}, Json{double(zone.to)}}}},
        {"groove_deg", Json{Json::Array{Json{30.0}, Json{35.0}}}},
        {"root_gap_mm", Json{double(zone.gap)}}}});
  return Json{Json::Object{{"rule", Json{"zones"}}, {"zones", Json{std::move(out)}}}};
}

/// The gap at a dihedral: that of its zone, linear across the overlap of two zones.
Real gap_at(const std::vector<Zone>& zones, Real deg) {
  for (std::size_t k = 0; k < zones.size(); ++k) {
    if (k + 1 < zones.size() && deg < zones[k + 1].to && deg >= zones[k].from)
      return (zones[k].gap * (deg - zones[k].from) + zones[k + 1].gap * (zones[k + 1].to - deg)) /
             (zones[k + 1].to - zones[k].from);
    if (deg >= zones[k].from) return zones[k].gap;
  }
  return zones.back().gap;
}

struct Random {
  std::mt19937_64 engine{20261129};
  double between(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(engine);
  }
  std::vector<Zone> zones() {
    return {{135, 180, between(2, 6)},
            {50, between(140, 155), between(1, 5)},
            {30, between(60, 75), between(1, 5)},
            {0, between(35, 40), between(0, 4)}};
  }
};

Json table_of(double target, double wall, Json cutter, const std::vector<Zone>& zones) {
  return Json{Json::Object{
      {"target", Json{Json::Object{{"outer_diameter_mm", Json{target}}, {"wall_mm", Json{wall}}}}},
      {"cutters", Json{Json::Array{std::move(cutter)}}},
      {"root_surface", Json{"inner"}},
      {"groove", groove_of(zones)},
      {"kerf_mm", Json{0.0}},
      {"torch", *api::parse(R"({"min_deg": -88, "max_deg": 88})")},
      {"smoothing", *api::parse(R"({"method": "none"})")}}};
}

/// A round partner by its four numbers.
struct Round {
  Real radius, inclination, offset;
  /// The nearest point's outward normal, and the distance to the surface.
  [[nodiscard]] std::pair<Point, Real> at(const Point& p) const {
    const Point axis{0, -std::sin(inclination), std::cos(inclination)};
    const Point to = p - Point{-offset, 0, 0};
    const Point off = to - dot(to, axis) * axis;
    const Real length = std::sqrt(dot(off, off));
    return {(1 / length) * off, length - radius};
  }
};

/// The largest error of a root's distance against its zone's gap, at rows or between them.
template <class Partner>
Real missed(const Json& answer, const Partner& partner, const std::vector<Zone>& zones, Real radius,
            bool between) {
  const auto phi = numbers(answer, "result/points/phi_deg");
  const auto z = numbers(answer, "result/points/z_inner_mm");
  Real worst = 0;
  for (std::size_t i = 0; i < phi.size(); ++i) {
    const auto j = (i + 1) % phi.size();
    const Real more = between ? 0.5L : 0;
    const Real turn = (phi[i] + more * (phi[j] + (j == 0 ? 360 : 0) - phi[i])) * kHalf / 180;
    const Real at = z[i] + more * (z[j] - z[i]);
    const Point out{std::cos(turn), std::sin(turn), 0};
    const Point p{radius * out[0], radius * out[1], at};
    const auto [normal, distance] = partner.at(p);
    const Real dihedral = std::acos(-dot(normal, out)) * 180 / kHalf;
    worst = std::max(
        worst, std::abs(distance - gap_at(zones, dihedral)) * (between ? std::abs(normal[2]) : 1));
  }
  return worst;
}

TEST(ZoneGaps, EveryRootKeepsItsZonesGap) {
  Random random;
  int made = 0;
  for (int i = 0; i < 240; ++i) {
    const double radius = random.between(50, 200), ratio = random.between(0.3, 0.9);
    const double target = 2 * radius * ratio, wall = 0.5 * target * random.between(0.05, 0.2);
    const double lean = random.between(40, 140);
    const double offset = 0.3 * radius * (1 - ratio) * random.between(-1, 1);
    const auto zones = random.zones();
    auto request = table_of(target, wall,
                            Json{Json::Object{{"kind", Json{"tube"}},
                                              {"outer_diameter_mm", Json{2 * radius}},
                                              {"inclination_deg", Json{lean}},
                                              {"offset_mm", Json{offset}}}},
                            zones);
    const bool by_tolerance = i % 4 == 0;
    request = with(request, "sampling",
                   by_tolerance ? *api::parse(R"({"tolerance_mm": 0.02})")
                                : *api::parse(R"({"uniform_points": 48})"));
    if (i % 3 == 0) request = with(request, "contact", "auto");
    if (i % 5 == 0) request = with(request, "coating_mm", 0.0);
    const auto answer = post(kTables, request);
    if (answer.outcome.error) continue;  // a groove that the torch does not reach
    ++made;
    const Round partner{radius, lean * kHalf / 180, offset};
    const Real inner = Real{target} / 2 - wall;
    if (i % 3 != 0) {
      EXPECT_LT(missed(answer.body, partner, zones, inner, false), 1e-6L) << i;
      if (by_tolerance) {
        EXPECT_LT(missed(answer.body, partner, zones, inner, true), 0.03L) << i;
      }
    }
    const auto asked = numbers(answer.body, "result/points/root_gap_mm");
    const auto dihedral = numbers(answer.body, "result/points/dihedral_deg");
    for (std::size_t k = 0; k < asked.size(); ++k)
      EXPECT_NEAR(asked[k], static_cast<double>(gap_at(zones, dihedral[k])), 1e-9);
    if (HasFailure()) return;
  }
  EXPECT_GE(made, 160);
}

// A row is that of a table which has this gap all round.
TEST(ZoneGaps, EachRowIsThatOfItsOwnGap) {
  Random random;
  for (int i = 0; i < 12; ++i) {
    const auto zones = random.zones();
    const double lean = random.between(60, 120);
    const auto cutter = Json{Json::Object{{"kind", Json{"tube"}},
                                          {"outer_diameter_mm", Json{219.1}},
                                          {"inclination_deg", Json{lean}}}};
    auto request = with(table_of(114.3, 8, cutter, zones), "sampling",
                        *api::parse(R"({"uniform_points": 16})"));
    const auto answer = post(kTables, request);
    ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 600);
    const auto asked = numbers(answer.body, "result/points/root_gap_mm");
    for (std::size_t k = 0; k < asked.size(); k += 3) {
      auto flat = zones;
      for (auto& zone : flat) zone.gap = asked[k];
      const auto alone = post(kTables, with(request, "groove", groove_of(flat)));
      ASSERT_FALSE(alone.outcome.error);
      for (const auto* column : {"z_inner_mm", "z_outer_mm", "b_deg", "dihedral_deg"}) {
        const auto path = std::string("result/points/") + column;
        EXPECT_NEAR(numbers(answer.body, path)[k], numbers(alone.body, path)[k], 1e-8) << column;
      }
    }
  }
}

// Of a plane the dihedral does not change with the gap: cos = -sin(lean) cos(phi), and the root
// rises by the gap over cos(lean).
TEST(ZoneGaps, OfAPlaneInClosedForm) {
  const std::vector<Zone> zones{{135, 180, 5}, {50, 150, 3}, {30, 75, 2}, {0, 40, 1}};
  for (const double lean : {10.0, 25.0, 40.0, 55.0}) {
    const Real a = lean * kHalf / 180;
    Json normal{Json::Array{Json{double(std::sin(a))}, Json{0.0}, Json{double(std::cos(a))}}};
    const auto cutter = Json{Json::Object{
        {"kind", Json{"plane"}}, {"point_mm", *api::parse("[0, 0, 0]")}, {"normal", normal}}};
    const auto answer = post(kTables, with(table_of(88.9, 5, cutter, zones), "sampling",
                                           *api::parse(R"({"uniform_points": 90})")));
    ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 600);
    const auto phi = numbers(answer.body, "result/points/phi_deg");
    const auto z = numbers(answer.body, "result/points/z_inner_mm");
    for (std::size_t i = 0; i < phi.size(); ++i) {
      const Real turn = phi[i] * kHalf / 180;
      const Real dihedral = std::acos(-std::sin(a) * std::cos(turn)) * 180 / kHalf;
      const Real root =
          -39.45L * std::cos(turn) * std::tan(a) + gap_at(zones, dihedral) / std::cos(a);
      EXPECT_NEAR(z[i], static_cast<double>(root), 1e-9) << lean << ' ' << phi[i];
    }
  }
}

TEST(ZoneGaps, TheFieldsInputHasThem) {
  const auto request =
      *api::parse(read_project_file("tests/field/zones-with-own-root-gap.bevel-table.json"));
  const auto answer = post(kTables, request);
  ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 800);
  const std::vector<Zone> zones{{135, 180, 5}, {50, 150, 3}, {30, 75, 3}, {15, 40, 3}};
  EXPECT_LT(missed(answer.body, Round{161.95L, 35 * kHalf / 180, 0}, zones, 74.15L, false), 1e-6L);
}

TEST(ZoneGaps, ContradictionsAreRefused) {
  const auto request =
      *api::parse(read_project_file("tests/field/zones-with-own-root-gap.bevel-table.json"));
  const auto refused = [&](const Json& asked, std::string_view pointer, std::string_view code) {
    const auto answer = post(kTables, asked);
    EXPECT_TRUE(answer.outcome.error);
    EXPECT_EQ(text(answer.body, "errors/0/pointer"), pointer) << answer.outcome.body;
    EXPECT_EQ(text(answer.body, "errors/0/code"), code) << answer.outcome.body;
  };
  refused(with(request, "root_gap_mm", 2.0), "/root_gap_mm", "unsupported_combination");
  refused(without(request, "groove/zones/2/root_gap_mm"), "/groove/zones/2",
          "unsupported_combination");
  refused(with(request, "groove/zones/1/dihedral_deg/1", 135.0), "/groove/zones/0/root_gap_mm",
          "out_of_range");
  refused(with(request, "groove/zones/0/root_gap_mm", -1.0), "/groove/zones/0/root_gap_mm",
          "out_of_range");
  refused(with(request, "contact", "none"), "/contact", "unsupported_combination");
}

// A frame's end and the part of it are cut so; a joint that has a gap of its own is refused where
// it is stated.
TEST(ZoneGaps, FramesTakeThem) {
  const std::vector<Zone> zones{{135, 180, 4}, {50, 150, 2}, {30, 75, 2}, {0, 40, 1}};
  Json request = *api::parse(R"({
    "members": [
      {"id": "C", "start_mm": [-600, 0, 0], "end_mm": [600, 0, 0], "outer_diameter_mm": 219.1, "wall_mm": 8},
      {"id": "B", "start_mm": [0, 0, 0], "end_mm": [700, 0, 500], "outer_diameter_mm": 114.3, "wall_mm": 6}],
    "joints": [{"between": ["B", "C"], "kind": "set_on"}],
    "defaults": {"root_surface": "inner", "groove": {}, "smoothing": {"method": "none"}},
    "kerf_mm": 1})");
  request = with(request, "defaults/groove", groove_of(zones));
  const auto answer = post("/v1/frames", request);
  ASSERT_FALSE(answer.outcome.error) << answer.outcome.body.substr(0, 800);
  EXPECT_EQ(number(answer.body, "result/totals/made"), 2.0);
  for (const auto& part : *at(answer.body, "parts").as<Json::Array>()) {
    if (text(part, "part") != "B") continue;
    const auto gaps = numbers(part, "answer/result/ends/start/points/root_gap_mm");
    ASSERT_FALSE(gaps.empty());
    EXPECT_GT(std::ranges::max(gaps) - std::ranges::min(gaps), 0.5);
  }
  const auto refused = post("/v1/frames", with(request, "joints/0/gap_mm", 1.0));
  ASSERT_TRUE(refused.outcome.error);
  EXPECT_EQ(text(refused.body, "errors/0/pointer"), "/joints/0/gap_mm");
}

}  // namespace
}  // namespace tubecut::testing
