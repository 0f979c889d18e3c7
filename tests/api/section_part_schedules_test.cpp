// Pulse schedules of whole parts of tubes that are not round.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "tests/support/call.hpp"
#include "tests/support/drawing_seed.hpp"

namespace tubecut::testing::section_part_schedules {

constexpr const char* kSchedules = "/v1/pulse-schedules";
constexpr double kDeg = 0.017453292519943295;
using Random = std::mt19937;

api::Json parsed(const std::string& text) {
  auto out = api::parse(text);
  EXPECT_TRUE(out) << text;
  return *std::move(out);
}

double between(Random& random, double from, double to) {
  return std::round(1000.0 * std::uniform_real_distribution<double>(from, to)(random)) / 1000.0;
}
std::string text_of(double value) { return std::to_string(value); }

/// The outside: a rectangle that a disc is moved over.
struct Outside {
  double x = 0.0, y = 0.0, corner = 0.0;  // half sides between the corners' centres

  [[nodiscard]] double beyond(double u, double v) const {
    const double dx = u - std::clamp(u, -x, x), dy = v - std::clamp(v, -y, y);
    return std::hypot(dx, dy) - corner;
  }
  [[nodiscard]] double reach() const { return std::hypot(x, y) + corner; }
  [[nodiscard]] double girth() const { return 4.0 * (x + y) + 2.0 * M_PI * corner; }
  /// The place at a girth from the middle of the face whose normal is +x, by the flats' lengths.
  [[nodiscard]] std::array<double, 2> at(double s) const {
    s = std::fmod(s, girth()) + (s < 0.0 ? girth() : 0.0);
    s = std::fmod(s + y, girth());  // from the beginning of that face
    for (int face = 0; face < 4; ++face) {
      const double half = face % 2 == 0 ? y : x, out = (face % 2 == 0 ? x : y) + corner;
      const double turn = 0.5 * M_PI * face, quarter = 0.5 * M_PI * corner;
      const auto turned = [&](double u, double v) {
        return std::array{u * std::cos(turn) - v * std::sin(turn),
                          u * std::sin(turn) + v * std::cos(turn)};
      };
      if (s <= 2.0 * half) return turned(out, s - half);
      s -= 2.0 * half;
      const double a = s / corner;
      if (s <= quarter)
        return turned(out - corner + corner * std::cos(a), half + corner * std::sin(a));
      s -= quarter;
    }
    return {x + corner, -y};
  }
};

struct Tube {
  Outside outside;
  std::string fields;
  bool oval = false;  // two of its faces are lines, which have no room for a cut-out
};

Tube drawn_tube(Random& random) {
  const auto make = [](double height, double width, double corner, const std::string& rest) {
    return Tube{{0.5 * height - corner, 0.5 * width - corner, corner},
                R"("height_mm": )" + text_of(height) + R"(, "width_mm": )" + text_of(width) + rest};
  };
  const std::string kind = R"(, "kind": "rectangular_tube", "wall_mm": )";
  switch (random() % 4) {
    case 0:
      return make(80, 60, 6, kind + R"(4, "corners": "en_10210")");
    case 1:
      return make(60, 80, 8, kind + R"(4, "corners": "en_10219")");
    case 2: {
      const double corner = between(random, 5, 14);
      return make(between(random, 60, 90), between(random, 60, 90), corner,
                  kind + R"(3.2, "corner_radius_mm": )" + text_of(corner));
    }
    default: {
      auto out = make(70, 110, 35, R"(, "kind": "flat_oval_tube", "wall_mm": 3)");
      out.oval = true;
      return out;
    }
  }
}

/// An end: square, a mitre in any plane, on a round tube, on a rectangular one.
constexpr int kEnds = 4;
std::string drawn_end(Random& random, int kind) {
  const auto plane = [&](double most) {
    return R"({"cutters": [{"kind": "plane", "point_mm": [0, 0, 0], "normal": [)" +
           text_of(between(random, -most, most)) + ", " + text_of(between(random, -most, most)) +
           ", 1]}]";
  };
  switch (kind) {
    case 0:
      return R"({"square_at_mm": 0)";
    case 1:
      return plane(0.8);
    case 2:
      return R"({"cutters": [{"kind": "tube", "outer_diameter_mm": 168.3, "inclination_deg": )" +
             text_of(between(random, 60, 120)) + R"(, "clocking_deg": )" +
             text_of(between(random, 0, 360)) + R"(, "offset_mm": 0}])";
    default:
      return R"({"cutters": [{"kind": "rectangular_tube", "width_mm": 120, "height_mm": 120,
          "corner_radius_mm": 6, "axis": {"point_mm": [0, 0, 0], "direction": [1, 0, 0]},
          "up": [0, 0, 1]}])";
  }
}

/// Openings on flats and over corners: each kind of shape, of wall and of tilt.
std::string drawn_cutouts(Random& random, const Tube& tube) {
  const std::array<std::string, 4> shapes{
      R"({"kind": "circle", "diameter_mm": 14})",
      R"({"kind": "slot", "length_mm": 24, "width_mm": 11, "angle_deg": )" +
          text_of(between(random, 0, 360)) + "}",
      R"({"kind": "rectangle", "along_mm": 26, "round_mm": 16, "corner_radius_mm": 3})",
      R"({"kind": "contour", "corners": "as_cut", "start_mm": [-9, -7], "pieces": [{"kind": "line", "to_mm": [9, -7]},
          {"kind": "line", "to_mm": [9, 7]}, {"kind": "line", "to_mm": [-9, 7]}, {"kind": "line", "to_mm": [-9, -7]}]})"};
  const double corner = tube.outside.y + 0.25 * M_PI * tube.outside.corner + between(random, -2, 2);
  std::string out;
  for (int i = 0; i < 3; ++i) {
    const bool over = i == 1;
    const std::string wall = over ? (random() % 2 == 0 ? "normal" : "developed")
                                  : (random() % 2 == 0 ? "through" : "normal");
    const std::string tilt = over && wall == "normal" && random() % 2 == 0 ? "free" : "axial";
    const auto face = tube.oval ? 1 + 2 * (random() % 2) : 1 + random() % 4;
    const auto at = over ? R"("girth_mm": )" + text_of(corner)
                         : R"("face": )" + std::to_string(face) + R"(, "offset_mm": )" +
                               text_of(between(random, -2, 2));
    const auto shape = over ? shapes[random() % 3] : shapes[random() % shapes.size()];
    out += (i > 0 ? ", " : "") + std::string(R"({"id": "c)") + std::to_string(i) +
           R"(", "shape": )" + shape + R"(, "wall": ")" + wall + R"(", "tilt": ")" + tilt +
           R"(", "at": {"z_mm": )" + std::to_string(220 + 70 * i) + ", " + at + "}}";
  }
  return "[" + out + "]";
}

/// A table without a swing for square walls, else one that swings its torch about a pivot and
/// counts B in reverse.
std::string swinging_table() {
  return R"({"type": "tube_table", "name": "swinging", "period_us": 4000, "pivot_length_mm": 120,
    "standoff_mm": 2, "b_positive": "outer_edge_to_waste", "axes": [
    {"name": "A", "unit": "deg", "pulses_per_turn": 360000, "v_max": 120, "a_max": 900,
     "j_max": 9000, "n_max": 900},
    {"name": "X", "unit": "mm", "pulses_per_unit": 1000, "v_max": 150, "a_max": 1500, "j_max": 20000},
    {"name": "Y", "unit": "mm", "pulses_per_unit": 1000, "v_max": 150, "a_max": 1500, "j_max": 20000},
    {"name": "Z", "unit": "mm", "pulses_per_unit": 1000, "v_max": 100, "a_max": 1500, "j_max": 20000},
    {"name": "B", "unit": "deg", "pulses_per_unit": 1000, "v_max": 60, "a_max": 500, "j_max": 6000}
  ]})";
}

struct Job {
  Tube tube;
  api::Json request;
  double arm = 1.0;  // from the pivot to the wall
  std::array<double, 5> pulses = {1000.0, 1000.0, 1000.0, 1000.0, 1000.0};
};

Job drawn(Random& random, int k) {
  Job out{.tube = drawn_tube(random)};
  const bool bevelled = k % 3 == 2;
  const std::string end = bevelled
                              ? R"(, "root_surface": "inner", "groove": {"rule": "half_dihedral"},
          "smoothing": {"method": "envelope", "limits": {"max_slope_deg_per_mm": 5,
          "max_curvature_deg_per_mm2": 1}}})"
                              : "}";
  const auto cut_end = [&](int kind) { return drawn_end(random, kind) + (kind == 0 ? "}" : end); };
  std::string part = std::string("{") + (bevelled ? R"("torch": {"min_deg": -60, "max_deg": 60},)"
                                                  : R"("preset": "tube_laser",)");
  part += R"("target": {)" + out.tube.fields + R"(, "length_mm": 600}, "kerf_mm": 0.4,)";
  part += R"("ends": {"start": )" + cut_end(k % kEnds);
  part += R"(, "finish": )" + cut_end(k / kEnds % kEnds);
  auto cutouts = drawn_cutouts(random, out.tube);
  if (!bevelled)  // a tube laser's torch tilts for no cut
    for (auto at = cutouts.find(R"("axial")"); at != std::string::npos;
         at = cutouts.find(R"("axial")"))
      cutouts.replace(at, 7, R"("none")");
  if (!bevelled)
    for (auto at = cutouts.find(R"("free")"); at != std::string::npos;
         at = cutouts.find(R"("free")"))
      cutouts.replace(at, 6, R"("none")");
  part += R"(}, "cutouts": )" + cutouts;
  part += R"(, "texts": [{"id": "t", "at": {"z_mm": 460, "face": 1, "offset_mm": -4},
              "text": "A7", "height_mm": 6}]})";
  std::string motion = R"({"speed": {"mm_min": 2400}, "clearance_mm": 20, "pierce_height_mm": 4)";
  motion += k % 2 == 0 ? R"(, "lead": {"radius_mm": 2})" : R"(, "lead": null)";
  motion += R"(, "pierce_delay_s": 0.1, "marks": {"speed_mm_min": 4000}})";
  out.request =
      parsed(R"({"part": )" + part + R"(, "machine": )" +
             (bevelled ? swinging_table() : R"("tube_table")") + R"(, "motion": )" + motion + "}");
  if (bevelled) out.arm = 122.0;
  return out;
}

Posted answered(const char* path, const api::Json& request) {
  auto answer = post(path, request);
  EXPECT_FALSE(answer.outcome.error)
      << answer.outcome.body.substr(0, 1500) << api::dump(request).substr(0, 3000);
  return answer;
}

/// Values of an axis at the start and at the end of each period.
std::vector<double> sums(const api::Json& body, const std::string& axis, double per_unit) {
  const auto periods = static_cast<std::size_t>(number(body, "result/periods"));
  std::vector<double> out{number(body, "result/start/" + axis)};
  if (at(body, "result/counts").find(axis) == nullptr) return std::vector(periods + 1, out[0]);
  for (const double n : numbers(body, "result/counts/" + axis))
    out.push_back(out.back() + n / per_unit);
  return out;
}

/// The tip by the axes alone, `arm` below the pivot: in the tube's own frame.
struct Tip {
  double x = 0.0, y = 0.0, z = 0.0, over = 0.0;  // over: the tube's axis
};

struct Rebuilt {
  std::vector<Tip> tips;
  std::vector<bool> moves;  // in each period: anything but the height

  Rebuilt(const api::Json& body, double arm, double sigma) {
    const auto a = sums(body, "A", 1000.0), across = sums(body, "X", 1000.0),
               along = sums(body, "Y", 1000.0), height = sums(body, "Z", 1000.0);
    const bool swings = at(body, "result/start").find("B") != nullptr;
    const auto b = swings ? sums(body, "B", 1000.0) : std::vector(a.size(), 0.0);
    for (std::size_t i = 0; i < a.size(); ++i) {
      const double up = -a[i] * kDeg, over = height[i] - arm * std::cos(b[i] * kDeg);
      tips.push_back({over * std::cos(up) - across[i] * std::sin(up),
                      over * std::sin(up) + across[i] * std::cos(up),
                      along[i] + sigma * arm * std::sin(b[i] * kDeg), over});
      if (i > 0)
        moves.push_back(a[i] != a[i - 1] || across[i] != across[i - 1] ||
                        along[i] != along[i - 1] || b[i] != b[i - 1]);
    }
  }
};

using Spot = std::array<double, 3>;

double to_chord(const Tip& p, const Spot& a, const Spot& b) {
  const Spot way{b[0] - a[0], b[1] - a[1], b[2] - a[2]}, off{p.x - a[0], p.y - a[1], p.z - a[2]};
  double along = 0.0, square = 0.0, rest = 0.0;
  for (int c = 0; c < 3; ++c) {
    along += way[c] * off[c];
    square += way[c] * way[c];
  }
  const double share = square > 0.0 ? std::clamp(along / square, 0.0, 1.0) : 0.0;
  for (int c = 0; c < 3; ++c) rest += std::pow(off[c] - share * way[c], 2);
  return std::sqrt(rest);
}

/// The stated way of a cut around the outside, in space, by chords of half a mm.
std::vector<Spot> in_space(const Outside& outside, const api::Json& way) {
  const auto s = numbers(way, "girth_mm"), z = numbers(way, "z_mm");
  std::vector<Spot> out;
  for (std::size_t i = 0; i < s.size(); ++i) {
    const double from = i == 0 ? s[0] : s[i - 1], low = i == 0 ? z[0] : z[i - 1];
    const double length = std::hypot(s[i] - from, z[i] - low);
    const int n = std::max(1, static_cast<int>(std::ceil(length / 0.5)));
    for (int k = i == 0 ? n : 1; k <= n; ++k) {
      const double share = static_cast<double>(k) / n;
      const auto p = outside.at(from + share * (s[i] - from));
      out.push_back({p[0], p[1], low + share * (z[i] - low)});
    }
  }
  return out;
}

/// The largest distance of the tip from its way, searched near the last place, and of the way's
/// places from the tip.
struct Followed {
  double off = 0.0, missed = 0.0;
};
Followed follow(const std::vector<Tip>& tips, std::size_t from, std::size_t to,
                const std::vector<Spot>& way) {
  constexpr double kNear = 1.0;  // mm along the way
  Followed out;
  std::vector<double> nearest(way.size(), 1e9), at(way.size(), 0.0);
  for (std::size_t i = 1; i < way.size(); ++i)
    at[i] = at[i - 1] + std::hypot(way[i][0] - way[i - 1][0], way[i][1] - way[i - 1][1],
                                   way[i][2] - way[i - 1][2]);
  std::size_t near = 0, low = 0;
  for (std::size_t k = from; k <= to; ++k) {
    while (at[low + 1] < at[near] - kNear) ++low;
    double best = 1e9;
    std::size_t found = near;
    for (std::size_t i = low; i + 1 < way.size() && at[i] < at[near] + kNear; ++i) {
      if (const double d = to_chord(tips[k], way[i], way[i + 1]); d < best) {
        best = d;
        found = i;
      }
      for (const auto j : {i, i + 1})
        nearest[j] = std::min(nearest[j], to_chord(tips[k], way[j], way[j]));
    }
    near = found;
    out.off = std::max(out.off, best);
  }
  out.missed = *std::ranges::max_element(nearest);
  return out;
}

/// Differences of the counts alone within the limits of the machine.
void expect_limits(const api::Json& body, const api::Json& machine) {
  const double t = number(machine, "period_us") * 1e-6;
  for (const auto& axis : *at(machine, "axes").as<api::Json::Array>()) {
    const auto name = text(axis, "name");
    if (at(body, "result/counts").find(name) == nullptr) continue;
    const auto* turn = axis.find("pulses_per_turn");
    const double k =
        turn != nullptr ? number(axis, "pulses_per_turn") / 360.0 : number(axis, "pulses_per_unit");
    auto counts = numbers(body, "result/counts/" + name);
    counts.insert(counts.begin(), 3, 0.0);
    counts.insert(counts.end(), 3, 0.0);
    double one = 0.0, two = 0.0, three = 0.0;
    for (std::size_t i = 2; i < counts.size(); ++i) {
      one = std::max(one, std::abs(counts[i]));
      two = std::max(two, std::abs(counts[i] - counts[i - 1]));
      three = std::max(three, std::abs(counts[i] - 2.0 * counts[i - 1] + counts[i - 2]));
    }
    EXPECT_LT(one, number(axis, "v_max") * t * k + 1.0) << name;
    EXPECT_LT(two, number(axis, "a_max") * t * t * k + 2.0) << name;
    EXPECT_LT(three, number(axis, "j_max") * t * t * t * k + 4.0) << name;
    const auto* most = axis.find("n_max");
    if (most == nullptr || *most == api::Json{}) continue;
    EXPECT_LE(one, number(axis, "n_max")) << name;
  }
}

/// Every part is answered, verified by the service and by the counts alone: the tip follows its
/// stated way around the outside, nothing but the height moves below the clearance over the
/// corners, and no limit of the machine is exceeded.
TEST(SectionPartSchedules, CountsKeepTheWayTheStandoffAndTheClearance) {
  Random random(static_cast<unsigned>(drawing_seed()));
  std::set<std::string> kinds;
  int parts = 0;
  for (int k = 0; k < 16; ++k) {
    const auto job = drawn(random, k);
    // Some shapes are too narrow over a corner, for any program.
    if (post("/v1/parts", at(job.request, "part")).outcome.error) continue;
    ++parts;
    const auto answer = answered(kSchedules, job.request);
    if (answer.outcome.error) continue;
    ASSERT_EQ(at(answer.body, "verification/passed"), api::Json{true})
        << api::dump(at(answer.body, "verification")) << api::dump(job.request);
    const bool bevelled = job.arm > 10.0;
    const auto& outside = job.tube.outside;
    const Rebuilt rebuilt(answer.body, job.arm, bevelled ? 1.0 : -1.0);
    double standoff = 0.0, off = 0.0, missed = 0.0, low = 1e9, touch = 1e9;
    for (const auto& segment : *at(answer.body, "result/segments").as<api::Json::Array>()) {
      const auto kind = text(segment, "kind");
      kinds.insert(kind);
      const auto from = static_cast<std::size_t>(number(segment, "from")),
                 to = static_cast<std::size_t>(number(segment, "to"));
      for (std::size_t i = from; i <= to; ++i) {
        const auto& tip = rebuilt.tips[i];
        touch = std::min(touch, outside.beyond(tip.x, tip.y));
        if (kind == "rapid" && i > from && rebuilt.moves[i - 1])
          low = std::min(
              {low, tip.over - outside.reach(), rebuilt.tips[i - 1].over - outside.reach()});
        if (kind == "cut" || kind == "mark")
          standoff = std::max(standoff, std::abs(outside.beyond(tip.x, tip.y)));
      }
      if (kind != "cut" && kind != "mark") continue;
      const auto way = in_space(outside, at(segment, "way"));
      const auto found = follow(rebuilt.tips, from, to, way);
      off = std::max(off, found.off - number(segment, "report/sag_mm"));
      missed = std::max(missed, found.missed);
    }
    const double arm_over = bevelled ? 2.0 : 1.0;  // the standoff is within the arm
    EXPECT_LE(standoff, 0.05) << k;
    EXPECT_GE(touch, -0.05) << k;
    EXPECT_LE(off, 0.1 + 0.02) << k;     // eps_tip and pulses
    EXPECT_LE(missed, 0.1 + 0.35) << k;  // and half a period, half a chord
    EXPECT_GE(low, 20.0 - arm_over - 0.01) << k;
    const auto machine =
        bevelled ? at(job.request, "machine") : parsed(R"({"period_us": 4000, "axes": []})");
    expect_limits(answer.body, machine);
  }
  EXPECT_GE(parts, 8);
  EXPECT_EQ(kinds, (std::set<std::string>{"cut", "mark", "pierce", "rapid"}));
}

/// A replay of the answer holds every invariant, and sees a rapid that is not lifted and a corner
/// that is turned without following it.
TEST(SectionPartSchedules, ReplaysHoldAndSeeWhatWasChanged) {
  Random random(7);
  for (const int k : {5, 9}) {  // bevelled, by a tube laser
    const auto job = drawn(random, k);
    const auto answer = answered(kSchedules, job.request);
    ASSERT_FALSE(answer.outcome.error);
    const auto broken = [&](const api::Json& schedule) {
      const auto replay = answered("/v1/replays", with(job.request, "schedule", schedule));
      std::set<std::string> out, all;
      for (const auto& one : *at(replay.body, "result/invariants").as<api::Json::Array>()) {
        all.insert(text(one, "name"));
        if (at(one, "passed") != api::Json{true}) out.insert(text(one, "name"));
      }
      for (const char* name : {"I1",        "I2",           "I4",           "I5",
                               "I6",        "I7",           "I8",           "I9",
                               "I10",       "I11",          "I12",          "I13",
                               "I14",       "I15",          "I16",          "segments_join",
                               "torch_lit", "pierce_place", "pierce_delay", "rapid_clearance"})
        EXPECT_TRUE(all.contains(name) || std::string(name) == "I8") << name;
      return out;
    };
    const auto& result = at(answer.body, "result");
    EXPECT_EQ(broken(result), std::set<std::string>{}) << k;
    const auto changed = [&](const std::string& axis, std::size_t from, std::size_t to) {
      auto counts = *at(result, "counts/" + axis).as<api::Json::Array>();
      for (auto i = from; i < to; ++i) counts[i] = 0.0;
      return with(result, "counts/" + axis, api::Json{std::move(counts)});
    };
    std::size_t rapid = 0, from = 0, to = 0, cut_from = 0, cut_to = 0;
    for (const auto& segment : *at(result, "segments").as<api::Json::Array>()) {
      if (text(segment, "kind") == "rapid" && rapid++ == 2) {
        from = static_cast<std::size_t>(number(segment, "from"));
        to = static_cast<std::size_t>(number(segment, "to"));
      }
      if (text(segment, "kind") == "cut" && text(segment, "name") == "start") {
        cut_from = static_cast<std::size_t>(number(segment, "from"));
        cut_to = static_cast<std::size_t>(number(segment, "to"));
      }
    }
    EXPECT_TRUE(broken(changed("Z", from, to)).contains("rapid_clearance")) << k;
    EXPECT_TRUE(broken(changed("X", cut_from, cut_to)).contains("I13")) << k;
    EXPECT_TRUE(broken(changed("A", cut_from, cut_to)).contains("I12")) << k;
  }
}

api::Json post_of(const char* file) {
  auto job = example("pulse-schedules/two-ends-and-four-holes-of-a-part.json");
  job = with(job, "part", without(example(file), "accept"));
  return with(job, "machine", api::Json{std::string("tube_table")});
}

/// A flat's cut-outs are cut with the tube still, square to the flat; a prism over a corner too, in
/// its own direction; what is developed turns with the corner.
TEST(SectionPartSchedules, TubeStandsStillForFlatsAndPrisms) {
  auto job = parsed(R"({"part": {"target": {"size": "SHS 80x80x4 EN 10219", "length_mm": 500},
    "ends": {"start": {"square_at_mm": 0}, "finish": {"square_at_mm": 0}}, "kerf_mm": 0.4,
    "cutouts": [
     {"id": "flat", "shape": {"kind": "circle", "diameter_mm": 58}, "at": {"z_mm": 100, "face": 2}},
     {"id": "prism", "shape": {"kind": "circle", "diameter_mm": 14}, "tilt": "free",
      "at": {"z_mm": 200, "girth_mm": 38.283}},
     {"id": "round", "shape": {"kind": "circle", "diameter_mm": 14}, "wall": "developed",
      "at": {"z_mm": 300, "girth_mm": 38.283}}]},
    "machine": "tube_table", "motion": {"speed": {"mm_min": 1200}, "lead": {"radius_mm": 2}}})");
  const auto answer = answered(kSchedules, job);
  ASSERT_FALSE(answer.outcome.error);
  EXPECT_EQ(at(answer.body, "verification/passed"), api::Json{true});
  const auto turn = sums(answer.body, "A", 1000.0);
  std::map<std::string, std::array<double, 2>> range;
  for (const auto& segment : *at(answer.body, "result/segments").as<api::Json::Array>()) {
    if (text(segment, "kind") != "cut") continue;
    const auto from = static_cast<std::ptrdiff_t>(number(segment, "from")),
               to = static_cast<std::ptrdiff_t>(number(segment, "to"));
    const auto [low, high] = std::minmax_element(turn.begin() + from, turn.begin() + to + 1);
    range[text(segment, "name")] = {*low, *high};
  }
  const auto off = [](double value, double wanted) {
    return std::abs(std::remainder(value - wanted, 360.0));
  };
  EXPECT_EQ(range.at("cut-out flat")[0], range.at("cut-out flat")[1]);
  EXPECT_LT(off(range.at("cut-out flat")[0], -90.0), 1e-3);
  EXPECT_EQ(range.at("cut-out prism")[0], range.at("cut-out prism")[1]);
  EXPECT_LT(off(range.at("cut-out prism")[0], -45.0), 0.01);
  EXPECT_GT(range.at("cut-out round")[1] - range.at("cut-out round")[0], 60.0);
}

/// Where a cut turns back over a corner, the slope of the angle jumps; and a straight edge there
/// keeps to the outside: however tight or wide their tolerances are.
TEST(SectionPartSchedules, AnyToleranceIsAnswered) {
  auto job = parsed(R"({"part": {"preset": "tube_laser", "kerf_mm": 0.2,
    "target": {"kind": "flat_oval_tube", "height_mm": 35, "width_mm": 75.7, "wall_mm": 2.35,
               "length_mm": 300},
    "ends": {"start": {"square_at_mm": 0}, "finish": {"square_at_mm": 0}},
    "cutouts": [{"id": "slot", "at": {"z_mm": 180, "girth_mm": 70.74}, "shape":
      {"kind": "slot", "length_mm": 28.287, "width_mm": 7.85, "angle_deg": 2.94}}]},
    "machine": "tube_table", "motion": {"speed": {"mm_min": 1200}, "eps_b_deg": 0.05,
    "lead": {"radius_mm": 2, "overcut_mm": 10}}})");
  EXPECT_EQ(at(answered(kSchedules, job).body, "verification/passed"), api::Json{true});
  job = with(job, "part/target", parsed(R"({"kind": "flat_oval_tube", "height_mm": 49.524,
    "width_mm": 94.029, "wall_mm": 4.367, "length_mm": 700})"));
  job = with(job, "part/kerf_mm", 1.0);
  job = with(job, "part/cutouts", parsed(R"([{"id": "c0", "wall": "normal", "tilt": "none",
    "at": {"z_mm": 120, "girth_mm": 33.31}, "shape": {"kind": "rectangle", "along_mm": 36.196,
      "round_mm": 29.293, "corner_radius_mm": 2.843}}])"));
  job = with(job, "motion", parsed(R"({"speed": {"mm_min": 4000}, "lead": null,
    "eps_tip_mm": 0.5, "eps_b_deg": 0.2})"));
  EXPECT_EQ(at(answered(kSchedules, job).body, "verification/passed"), api::Json{true});
}

/// The first row of this outline lies behind its datum by rounding.
TEST(SectionPartSchedules, RowBesideTheDatumIsThatPoint) {
  const auto job = parsed(R"({"part": {"preset": "tube_laser", "kerf_mm": 0.3, "target":
    {"kind": "rectangular_tube", "height_mm": 79.67364709674378, "width_mm": 51.970548966922316,
     "wall_mm": 2.2695739890301665, "corner_radius_mm": 5.313041770991982, "length_mm": 400},
    "ends": {"start": {"square_at_mm": 0}, "finish": {"square_at_mm": 0}}},
    "machine": "tube_table", "motion": {"speed": {"mm_min": 1500}, "lead": {"radius_mm": 2}}})");
  EXPECT_EQ(at(answered(kSchedules, job).body, "verification/passed"), api::Json{true});
}

/// Each problem at its own field, all in one answer.
TEST(SectionPartSchedules, WhatIsNotCutYetIsRefusedByName) {
  auto job = post_of("parts/shs-base-post.json");
  job = with(job, "motion/tabs", parsed(R"({"count": 2, "width_mm": 2})"));
  job = with(job, "motion/start_phi_deg", 10.0);
  job = with(job, "motion/speed_on", api::Json{std::string("inner")});
  job = with(job, "motion/lean_deg", 9.0);
  for (const auto& [pointer, code] : {std::pair{"/motion/tabs", "unsupported_combination"},
                                      {"/motion/start_phi_deg", "unsupported_combination"},
                                      {"/motion/speed_on", "unsupported_combination"},
                                      {"/motion/lean_deg", "out_of_range"}})
    expect_refused(kSchedules, job, pointer, code);
  for (const char* machine : {"five_axis_cutter", "crawler", "generic"}) {
    auto other = with(post_of("parts/shs-base-post.json"), "machine", std::string(machine));
    for (const char* height : {"clearance_mm", "pierce_height_mm"})
      other = without(other, std::string("motion/") + height);
    const auto answer = post(kSchedules, other);
    const auto* one = error_at(answer, "/machine");
    ASSERT_NE(one, nullptr) << machine << answer.outcome.body.substr(0, 1500);
    EXPECT_NE(text(*one, "hint").find("no axis across the tube"), std::string::npos);
  }
  const auto jamb = post_of("parts/rhs-door-frame-with-countersinks.json");
  expect_refused(kSchedules, jamb, "/part/cutouts/2/shape/kind", "unsupported_combination");
  const auto without_slit =
      with(jamb, "part/cutouts",
           api::Json{api::Json::Array{at(jamb, "part/cutouts/0"), at(jamb, "part/cutouts/1")}});
  expect_refused(kSchedules, without_slit, "/part/cutouts/0/countersink",
                 "unsupported_combination");
  const auto round = with(example("pulse-schedules/two-ends-and-four-holes-of-a-part.json"),
                          "motion/lean_deg", 1.0);
  expect_refused(kSchedules, round, "/motion/lean_deg", "unsupported_combination");
}

/// A member that is not round is cut around its own outside, and by no machine for round tubes.
TEST(SectionPartSchedules, MemberOfANodeIsCutAsItsSection) {
  const auto node = example("nodes/rhs-t-joint.json");
  auto part = with(parsed(R"({"preset": "tube_laser"})"), "members", at(node, "members"));
  part = with(part, "connect", at(node, "connect"));
  part = with(with(part, "member", api::Json{std::string("post")}), "kerf_mm", 0.2);
  auto job = with(post_of("parts/shs-base-post.json"), "part", part);
  job = with(job, "motion/lead", parsed(R"({"radius_mm": 2})"));
  const auto answer = answered(kSchedules, job);
  ASSERT_FALSE(answer.outcome.error);
  EXPECT_EQ(at(answer.body, "verification/passed"), api::Json{true});
  const auto made = answered("/v1/parts", part);
  const auto& section = at(made.body, "result/section");
  const double corner = number(section, "corner_radius_mm");
  const Outside outside{0.5 * number(section, "height_mm") - corner,
                        0.5 * number(section, "width_mm") - corner, corner};
  const Rebuilt rebuilt(answer.body, 1.0, -1.0);
  std::vector<std::string> cuts;
  for (const auto& segment : *at(answer.body, "result/segments").as<api::Json::Array>()) {
    if (text(segment, "kind") != "cut") continue;
    cuts.push_back(text(segment, "name"));
    for (auto i = static_cast<std::size_t>(number(segment, "from"));
         i <= static_cast<std::size_t>(number(segment, "to")); ++i)
      ASSERT_LE(std::abs(outside.beyond(rebuilt.tips[i].x, rebuilt.tips[i].y)), 0.05) << i;
  }
  EXPECT_EQ(cuts, (std::vector<std::string>{"finish", "start"}));
  const auto round = post(kSchedules, with(job, "machine", std::string("five_axis_cutter")));
  ASSERT_NE(error_at(round, "/machine"), nullptr) << round.outcome.body.substr(0, 800);
}

TEST(SectionPartSchedules, ProgramAndChartArePrinted) {
  const auto body = api::dump(post_of("parts/shs-gate-post.json"));
  const auto program = post(kSchedules, std::string_view(body), "format=gcode&torch=on");
  ASSERT_FALSE(program.outcome.error) << program.outcome.body.substr(0, 800);
  for (const char* line : {"(A = axis A, deg)", "(X = axis X, mm)", "(rapid: ", "(cut: start)"})
    EXPECT_NE(program.outcome.body.find(line), std::string::npos) << line;
  for (const char* format : {"format=svg", "format=csv"})
    EXPECT_FALSE(post(kSchedules, std::string_view(body), format).outcome.error) << format;
}

}  // namespace tubecut::testing::section_part_schedules
