// Joints as users draw them every day, of catalogue tubes: a refused request must be impossible by
// an independent oracle (rays against cylinders, in long double).

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <random>

#include "tests/support/call.hpp"
#include "tests/support/ray_caster.hpp"

namespace tubecut::testing {
namespace {

using api::Json;
using ray::Real;
using Vec = std::array<double, 3>;

constexpr std::uint64_t kSeed = 20261122;
constexpr double kDeg = 0.017453292519943295;

/// Fraction of the 830 that is sent: all with TUBECUT_EVERYDAY=1.
int share(int whole) {
  const char* all = std::getenv("TUBECUT_EVERYDAY");  // NOLINT(concurrency-mt-unsafe)
  return all != nullptr ? whole : (whole + 9) / 10;
}

struct Size {
  double diameter, wall;
};
/// ASME B36.10 (NPS 3/4 to 12), EN 10210 (trusses), cage tubes of 1 1/2 to 2 in, bicycle tubes.
constexpr std::array<Size, 12> kPipes{{{26.7, 2.87},
                                       {33.4, 3.38},
                                       {48.3, 3.68},
                                       {60.3, 3.91},
                                       {73.0, 5.16},
                                       {88.9, 5.49},
                                       {114.3, 6.02},
                                       {141.3, 6.55},
                                       {168.3, 7.11},
                                       {219.1, 8.18},
                                       {273.0, 9.27},
                                       {323.8, 9.53}}};
constexpr std::array<Size, 8> kHollow{{{48.3, 3.2},
                                       {60.3, 4.0},
                                       {76.1, 4.0},
                                       {88.9, 5.0},
                                       {114.3, 6.3},
                                       {139.7, 6.3},
                                       {168.3, 8.0},
                                       {219.1, 10.0}}};
constexpr std::array<Size, 4> kCage{{{38.1, 2.41}, {41.3, 2.41}, {44.5, 3.05}, {50.8, 2.11}}};

class Random {
 public:
  double any(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  int upto(int last) { return std::uniform_int_distribution<int>(0, last)(engine_); }
  template <std::size_t N>
  Size one_of(const std::array<Size, N>& sizes) {
    return sizes[static_cast<std::size_t>(upto(static_cast<int>(N) - 1))];
  }
  /// Of two, the wider first.
  template <std::size_t N>
  std::pair<Size, Size> two_of(const std::array<Size, N>& sizes) {
    auto a = one_of(sizes), b = one_of(sizes);
    if (a.diameter < b.diameter) std::swap(a, b);
    return {a, b};
  }

 private:
  std::mt19937_64 engine_{kSeed};
};

Json vec(const Vec& v) { return Json{Json::Array{v[0], v[1], v[2]}}; }
Vec at(const Vec& p, double t, const Vec& d) {
  return {p[0] + t * d[0], p[1] + t * d[1], p[2] + t * d[2]};
}

struct Tube {
  std::string id;
  Vec start, finish;
  Size size;
  int priority = 1;
  Json joints = {};
};

Json member(const Tube& t) {
  Json out{Json::Object{{"id", t.id},
                        {"start_mm", vec(t.start)},
                        {"end_mm", vec(t.finish)},
                        {"outer_diameter_mm", t.size.diameter},
                        {"wall_mm", t.size.wall},
                        {"priority", static_cast<double>(t.priority)}}};
  if (t.joints != Json{}) out = with(out, "joints", t.joints);
  return out;
}

/// Everyday options of a cut: the root inside, grooves as in procedures.
Json cut_options(Random& r) {
  static constexpr std::array kGrooves{R"({"rule": "half_dihedral"})", R"({"rule": "none"})",
                                       R"({"rule": "fixed", "angle_deg": 30})"};
  Json out = *api::parse(R"({"root_surface": "inner", "smoothing": {"method": "none"},
                             "sampling": {"tolerance_mm": 0.1}})");
  out = with(out, "groove", *api::parse(kGrooves[static_cast<std::size_t>(r.upto(2))]));
  out = with(out, "contact", r.upto(2) == 0 ? "auto" : "inner");
  return with(out, "kerf_mm", r.upto(1) == 0 ? 1.5 : 0.0);
}

struct Case {
  std::string kind, path;
  Json request;
  std::vector<Tube> tubes;                 // of a node: the first is the part
  std::vector<std::size_t> start, finish;  // which tubes cut its ends
};

/// The first tube as a part of a node, its ends cut by those named.
Case part_of(std::string kind, Random& r, std::vector<Tube> tubes, std::vector<std::size_t> start,
             std::vector<std::size_t> finish) {
  Json::Array members, links;
  for (const auto& t : tubes) members.push_back(member(t));
  for (const bool last : {false, true}) {
    Json::Array to;
    for (const auto i : last ? finish : start) to.emplace_back(tubes[i].id);
    if (!to.empty())
      links.push_back(Json{Json::Object{{"member", tubes[0].id},
                                        {"end", last ? "finish" : "start"},
                                        {"to", Json{std::move(to)}}}});
  }
  auto request = cut_options(r);
  request = with(request, "members", Json{std::move(members)});
  request = with(request, "connect", Json{std::move(links)});
  request = with(request, "member", tubes[0].id);
  request = with(request, "datum", "up");
  const Vec d = {tubes[0].finish[0] - tubes[0].start[0], tubes[0].finish[1] - tubes[0].start[1],
                 tubes[0].finish[2] - tubes[0].start[2]};
  request = with(request, "up",
                 vec(std::abs(d[1]) < 0.5 * std::hypot(d[0], d[2]) ? Vec{0, 1, 0} : Vec{1, 0, 0}));
  return {std::move(kind),  "/v1/parts",      std::move(request),
          std::move(tubes), std::move(start), std::move(finish)};
}

/// A brace between two chords; in most trusses another one next to its foot cuts it.
Case truss(Random& r) {
  const auto [chord, brace] = r.two_of(kHollow);
  const double deep = r.any(6, 14) * chord.diameter, foot = r.any(-0.25, 0.25) * chord.diameter;
  const double lean = r.upto(3) == 0 ? 90.0 : r.any(32, 60);
  const double run = deep / std::tan(lean * kDeg);
  const double aside = r.upto(2) == 0 ? r.any(-0.1, 0.1) * brace.diameter : 0.0;
  std::vector<Tube> t{{"B", {0, aside, foot}, {run, aside, deep}, brace, 2},
                      {"C", {-9000, 0, 0}, {9000, 0, 0}, chord, 0},
                      {"T", {-9000, 0, deep}, {9000, 0, deep}, chord, 0}};
  std::vector<std::size_t> start{1};
  if (r.upto(2) != 0) {
    const auto other = r.any(0, 1) < 0.5 ? brace : r.two_of(kHollow).second;
    if (other.diameter <= chord.diameter) {
      t.push_back({"N",
                   {-r.any(0.2, 1.0) * brace.diameter, 0, 0},
                   {-deep / std::tan(r.any(35, 80) * kDeg), 0, deep},
                   other,
                   1});
      start.push_back(3);
    }
  }
  return part_of("truss", r, std::move(t), std::move(start), {2});
}

/// A top, down or stay tube between two tubes of a frame that are nearly square to it.
Case bicycle(Random& r) {
  static constexpr std::array<Size, 6> kOwn{
      {{28.6, 0.9}, {31.8, 0.9}, {34.9, 0.9}, {22.2, 0.8}, {16.0, 0.8}, {25.4, 0.9}}};
  static constexpr std::array<Size, 4> kAcross{
      {{36.0, 1.1}, {44.0, 1.5}, {28.6, 0.9}, {40.0, 3.0}}};
  auto own = r.one_of(kOwn);
  const auto one = r.one_of(kAcross), two = r.one_of(kAcross);
  while (own.diameter > std::min(one.diameter, two.diameter)) own = r.one_of(kOwn);
  const double length = r.any(350, 620);
  const auto across = [&](double x, const char* id, Size size) {
    const double lean = r.any(55, 125) * kDeg, out = r.upto(2) == 0 ? r.any(-8, 8) * kDeg : 0.0;
    const Vec d{std::cos(lean) * std::cos(out), std::sin(out), std::sin(lean) * std::cos(out)};
    return Tube{id, at({x, 0, 0}, -300, d), at({x, 0, 0}, 300, d), size, 0};
  };
  return part_of("bicycle", r,
                 {{"tube", {0, 0, 0}, {length, 0, 0}, own, 2},
                  across(0, "head", one),
                  across(length, "seat", two)},
                 {1}, {2});
}

/// A bar of a cage on one to three others of its size, through one point.
Case cage(Random& r) {
  const auto size = r.one_of(kCage);
  std::vector<Tube> t{{"bar", {0, 0, 0}, {0, 0, r.any(500, 1400)}, size, 3}};
  std::vector<std::size_t> start;
  const int others = 1 + r.upto(2);
  for (int k = 0; k < others; ++k) {
    const double lean = (k == 0 ? r.any(45, 135) : r.any(30, 150)) * kDeg;
    const double turn = r.any(0, 360) * kDeg;
    const Vec d{std::sin(lean) * std::cos(turn), std::sin(lean) * std::sin(turn), std::cos(lean)};
    const bool ends = k > 0 && r.upto(1) == 0;
    t.push_back({"o" + std::to_string(k), ends ? Vec{0, 0, 0} : at({0, 0, 0}, -900, d),
                 at({0, 0, 0}, 900, d), size, k});
    start.push_back(static_cast<std::size_t>(k) + 1);
  }
  return part_of("cage", r, std::move(t), std::move(start), {});
}

/// One pipe on another.
Case saddle(Random& r) {
  const auto [run, branch] = r.two_of(kPipes);
  const double lean = r.upto(1) == 0 ? 90.0 : r.any(30, 150), turn = lean * kDeg;
  const double free = 0.5 * (run.diameter - branch.diameter);
  const double aside = r.upto(3) == 0 ? r.any(-1, 1) * free : 0.0;
  return part_of(
      "saddle", r,
      {{"branch", {0, aside, 0}, {1500 * std::cos(turn), aside, 1500 * std::sin(turn)}, branch, 1},
       {"run", {-2000, 0, 0}, {2000, 0, 0}, run, 0}},
      {1}, {});
}

/// Two alike in a mitre.
Case mitre(Random& r) {
  const auto size = r.upto(1) == 0 ? r.one_of(kPipes) : r.one_of(kCage);
  const double turn = (r.upto(2) == 0 ? 90.0 : r.any(45, 170)) * kDeg;
  Tube a{"a", {0, 0, 0}, {1500, 0, 0}, size, 1};
  a.joints = Json{Json::Array{Json{Json::Object{{"member", "b"}, {"kind", "mitre"}}}}};
  return part_of("mitre", r,
                 {a, {"b", {0, 0, 0}, {1500 * std::cos(turn), 0, 1500 * std::sin(turn)}, size, 1}},
                 {1}, {});
}

struct HoleSizes {
  Size chord, branch;
  double lean, aside;
};

/// A hole for one pipe in another: on it, in it or through it, the branch narrower than the bore
/// where it enters.
Case hole(Random& r) {
  static constexpr std::array kKinds{"set_on", "set_in", "through"};
  const auto kind = kKinds[static_cast<std::size_t>(r.upto(2))];
  auto [chord, branch] = r.two_of(kPipes);
  const double gap = r.upto(1) == 0 ? 0.0 : 1.5;
  const bool enters = kind != kKinds[0];
  while (enters && branch.diameter + 2 * gap > 0.95 * (chord.diameter - 2 * chord.wall))
    std::tie(chord, branch) = r.two_of(kPipes);
  const double lean = r.upto(1) == 0 ? 90.0 : r.any(40, 140);
  const bool free = r.upto(1) == 0;
  Json joint{Json::Object{{"kind", kind}, {"gap_mm", gap}}};
  Json out = *api::parse(R"({"groove": {"rule": "none"}, "kerf_mm": 1.5,
                             "sampling": {"tolerance_mm": 0.1}})");
  out = with(out, "chord",
             Json{Json::Object{{"outer_diameter_mm", chord.diameter}, {"wall_mm", chord.wall}}});
  out = with(out, "branch",
             Json{Json::Object{{"outer_diameter_mm", branch.diameter},
                               {"wall_mm", branch.wall},
                               {"inclination_deg", lean}}});
  out = with(out, "joint", joint);
  out = with(out, "tilt", free ? "free" : "axial");
  return {"hole", "/v1/holes", out, {}, {}, {}};
}

// ---- the oracle

using Long = ray::Point;
Long sub(const Long& a, const Long& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Real dot(const Long& a, const Long& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Long cross(const Long& a, const Long& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Long unit(Long a) {
  const Real n = std::sqrt(dot(a, a));
  for (auto& x : a) x /= n;
  return a;
}
Long wide(const Vec& v) { return {v[0], v[1], v[2]}; }

/// The tubes that cut an end, seen along its member.
std::vector<ray::Body> bodies(const Case& c, bool finish) {
  const auto& own = c.tubes[0];
  const Long origin = wide(finish ? own.finish : own.start);
  const Long z = unit(sub(wide(finish ? own.start : own.finish), origin));
  const Long x = unit(cross(z, std::abs(z[0]) < 0.7L ? Long{1, 0, 0} : Long{0, 1, 0}));
  const Long y = cross(z, x);
  const auto seen = [&](const Long& v) { return Long{dot(v, x), dot(v, y), dot(v, z)}; };
  std::vector<ray::Body> out;
  for (const auto i : finish ? c.finish : c.start) {
    const auto& t = c.tubes[i];
    out.push_back({static_cast<Real>(t.size.diameter) / 2, seen(sub(wide(t.start), origin)),
                   unit(seen(sub(wide(t.finish), wide(t.start))))});
  }
  return out;
}

/// Returns the reason why an end cannot be cut with its root on the inner wall, or an empty text.
std::string impossible(const Case& c, bool finish) {
  const auto partners = bodies(c, finish);
  if (partners.empty()) return "";
  const Real outer = static_cast<Real>(c.tubes[0].size.diameter) / 2;
  const Real inner = outer - c.tubes[0].size.wall;
  for (int k = 0; k < 720; ++k) {
    const Real phi = ray::kPi * k / 360;
    const auto root = ray::highest(partners, inner, phi);
    if (!root) return "open_profile";
    // The steepest line that the torch can cut from the root must clear every partner in the wall.
    for (int n = 1; n <= 40; ++n) {
      const Real rho = inner + (outer - inner) * n / 40;
      const auto top = ray::highest(partners, rho, phi);
      if (top && (top->z - root->z) / (rho - inner) > std::tan(80.0L * ray::kPi / 180))
        return "torch_range";
    }
  }
  return "";
}

/// Returns the reason why a hole is impossible.
std::string impossible_hole(const Json& request) {
  const bool on = text(request, "joint/kind") == "set_on";
  const Real chord = number(request, "chord/outer_diameter_mm") / 2;
  const Real bore = chord - number(request, "chord/wall_mm");
  const Real branch = number(request, "branch/outer_diameter_mm") / 2;
  const Real rho = on ? branch - number(request, "branch/wall_mm")
                      : branch + static_cast<Real>(number(request, "joint/gap_mm"));
  // Its edge must lie on the chord's surface all round; along the branch its wall must meet the
  // bore.
  if (rho >= (on ? chord : bore)) return "open_profile";
  if (on && rho > bore && text(request, "tilt") == "free") return "open_profile";
  return "";
}

std::string refusal_of(const Case& c, const Posted& answer) {
  const auto code = text(answer.body, "code");
  if (c.path == "/v1/holes") return impossible_hole(c.request) == code ? "" : code;
  for (const bool finish : {false, true})
    if (impossible(c, finish) == code) return "";
  return code;
}

TEST(EverydayJoints, OnlyImpossibleJointsAreRefused) {
  struct Kind {
    Case (*make)(Random&);
    int count;
  };
  const std::array<Kind, 6> kinds{
      {{truss, 250}, {bicycle, 120}, {cage, 150}, {saddle, 100}, {mitre, 80}, {hole, 130}}};
  Random random;
  int asked = 0, refused = 0, falsely = 0;
  std::map<std::string, int> codes;
  for (const auto& kind : kinds)
    for (int k = 0; k < share(kind.count); ++k) {
      const auto c = kind.make(random);
      ++asked;
      const auto answer = post(c.path, c.request);
      if (!answer.outcome.error) continue;
      ++refused;
      ++codes[c.kind + ' ' + text(answer.body, "code")];
      const auto wrong = refusal_of(c, answer);
      if (wrong.empty()) continue;
      ++falsely;
      ADD_FAILURE() << c.kind << ' ' << answer.outcome.body.substr(0, 900) << '\n'
                    << api::dump(c.request);
    }
  std::printf("%d everyday joints, %d refused, %d of them falsely\n", asked, refused, falsely);
  for (const auto& [code, count] : codes) std::printf("  %s: %d\n", code.c_str(), count);
  EXPECT_GE(asked, 83);
  EXPECT_EQ(falsely, 0);
}

}  // namespace
}  // namespace tubecut::testing
