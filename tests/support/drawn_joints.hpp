#pragma once

// Joints of two tubes as models have them: of every kind, drawn from either end, with coordinates
// that are rounded, in inches, or turned in plan; and the requests of the three endpoints that take
// centre-lines. Nothing here is core's.

#include <array>
#include <cmath>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/call.hpp"

namespace tubecut::drawn {

using api::Json;
using Real = long double;
using Point = std::array<Real, 3>;

inline const Real kTurn = 2 * std::acos(Real{-1});

inline Point operator+(const Point& a, const Point& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Point operator*(Real s, const Point& a) { return {s * a[0], s * a[1], s * a[2]}; }
inline Point operator-(const Point& a, const Point& b) { return a + Real{-1} * b; }
inline Real dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline Real norm(const Point& a) { return std::sqrt(dot(a, a)); }
inline Point unit(const Point& a) { return (1 / norm(a)) * a; }

struct Tube {
  std::string id;
  Point start{}, finish{};
  Real radius = 0, wall = 0;
  int priority = 0;

  [[nodiscard]] Real off(const Point& p) const {
    return norm(cross(p - start, unit(finish - start)));
  }
  [[nodiscard]] const Point& at(bool last) const { return last ? finish : start; }
  [[nodiscard]] Point into(bool last) const {
    return last ? unit(start - finish) : unit(finish - start);
  }
};

enum class Kind { set_on, set_in, through, mitre, corner_to_corner, butt };
inline constexpr std::array kKinds{Kind::set_on, Kind::set_in,           Kind::through,
                                   Kind::mitre,  Kind::corner_to_corner, Kind::butt};

/// Returns the wire name of a frame's joint; a member of a node has `mitre` if two are butted.
inline std::string word(Kind kind, bool frame) {
  static constexpr std::array kWords{"set_on", "set_in", "through", "mitre", "mitre"};
  if (kind == Kind::butt) return frame ? "butt" : "mitre";
  return kWords[static_cast<std::size_t>(kind)];
}
inline bool faces(Kind kind) { return kind >= Kind::mitre; }

/// How a model's coordinates are written.
enum class Written { exact, thousandths, inches, in_plan, hundredths, tenths, whole };
inline constexpr std::array kWritten{Written::exact,   Written::thousandths, Written::inches,
                                     Written::in_plan, Written::hundredths,  Written::tenths,
                                     Written::whole};
inline Real grid(Written written) {
  static constexpr std::array<Real, 7> kSteps{0, 1e-3L, 25.4e-3L, 1e-3L, 0.01L, 0.1L, 1};
  return kSteps[static_cast<std::size_t>(written)];
}

/// Of two tubes, by their places in a list.
struct Said {
  std::size_t branch = 0, chord = 0;
  Kind kind = Kind::set_on;
  Real gap = 0, depth = 0;
  bool hole = false;
  bool branch_end = false, chord_end = false;  // of those that meet: the finish?
};

struct Model {
  std::vector<Tube> tubes;
  std::vector<Said> joints;
  Real within = 0;  // mm: members nearer than this are joined; 0: only stated joints
};

struct Random {
  std::mt19937_64 engine;
  explicit Random(std::uint64_t seed) : engine(seed) {}
  Real between(Real from, Real to) {
    return std::uniform_real_distribution<double>(static_cast<double>(from),
                                                  static_cast<double>(to))(engine);
  }
  std::size_t upto(std::size_t last) {
    return std::uniform_int_distribution<std::size_t>(0, last)(engine);
  }
  bool coin() { return upto(1) == 1; }
  Point direction() {
    std::normal_distribution<double> normal;
    return unit({normal(engine), normal(engine), normal(engine)});
  }
  Point leaning(const Point& axis, Real deg) {
    const Point side = unit(cross(direction(), axis));
    const Real a = deg * kTurn / 360;
    return std::cos(a) * axis + std::sin(a) * side;
  }
};

/// A second tube at `at`, the end of the first that leaves along `axis`.
inline Tube facing(Random& random, const Tube& first, const Point& at, const Point& axis,
                   Kind kind) {
  Tube out = first;
  const Point lean =
      kind == Kind::butt ? Real{-1} * axis : random.leaning(axis, random.between(50, 165));
  if (kind == Kind::corner_to_corner) {
    out.radius *= random.between(0.6L, 0.95L);
    out.wall = out.radius * random.between(0.05L, 0.15L);
  }
  const Real gap = random.coin() ? 0 : random.between(2, 10);
  out.start = at + gap * lean;
  out.finish = at + random.between(900, 2000) * lean;
  return out;
}

/// A branch of a chord at the place `at` of its axis, which lies along `axis`.
inline Tube standing(Random& random, const Tube& chord, const Point& at, const Point& axis,
                     Kind kind, Real least_lean = 60) {
  Tube out;
  out.radius = chord.radius * random.between(0.2L, 0.6L);
  out.wall = out.radius * random.between(0.06L, 0.2L);
  const Point lean = random.leaning(axis, random.between(least_lean, 180 - least_lean));
  const Real room = 0.7L * (chord.radius - chord.wall - out.radius - 3);
  out.start = at;
  if (random.coin()) out.start = at + random.between(-room, room) * unit(cross(axis, lean));
  out.finish = out.start + random.between(4, 9) * chord.radius * lean;
  if (kind == Kind::through) out.start = out.start - random.between(3, 6) * chord.radius * lean;
  return out;
}

/// Two tubes and their joint; `ends`: two bits, which of the chord's and of the branch's ends meet.
inline Model pair(Random& random, Kind kind, std::size_t ends) {
  Tube chord{.id = "C"};
  chord.radius = random.between(30, 220);
  chord.wall = chord.radius * random.between(0.05L, 0.15L);
  const Point at = random.between(0, 1500) * random.direction(), axis = random.direction();
  Said said{.branch = 1, .chord = 0, .kind = kind};
  said.gap = random.coin() ? 0 : random.between(0.2L, 2.5L);
  Tube branch;
  if (faces(kind)) {
    chord.start = random.coin() ? at : at + random.between(2, 10) * axis;
    chord.finish = at + random.between(900, 2000) * axis;
    branch = facing(random, chord, at, axis, kind);
  } else {
    chord.start = at - random.between(5, 9) * chord.radius * axis;
    chord.finish = at + random.between(5, 9) * chord.radius * axis;
    branch = standing(random, chord, at, axis, kind);
    said.depth = chord.wall * random.between(0.5L, 1.3L);
    said.hole = kind != Kind::set_on || random.coin();
  }
  branch.id = "B";
  branch.priority = 1;
  if ((ends & 1U) != 0) std::swap(chord.start, chord.finish);
  if ((ends & 2U) != 0) std::swap(branch.start, branch.finish);
  said.chord_end = (ends & 1U) != 0;
  said.branch_end = (ends & 2U) != 0;
  return {{chord, branch}, {said}, random.coin() ? Real{15} : Real{0}};
}

/// The model as a program writes it, here or far out in the world.
inline void write_down(Model& model, Written written, Random& random) {
  const Real turn = written == Written::in_plan ? random.between(0, kTurn) : 0;
  const Real far = random.coin() ? 0 : random.between(0, 2e5L);
  const Point to{std::round(far * random.between(-1, 1)), std::round(far * random.between(-1, 1)),
                 std::round(0.1L * far)};
  for (auto& tube : model.tubes)
    for (auto* p : {&tube.start, &tube.finish}) {
      const Real x = (*p)[0], y = (*p)[1];
      (*p)[0] = std::cos(turn) * x - std::sin(turn) * y;
      (*p)[1] = std::sin(turn) * x + std::cos(turn) * y;
      *p = *p + to;
      const Real step = grid(written);
      // Rounds the values in place, so that the sent values are also those of the measurement.
      for (auto& v : *p) v = static_cast<double>(step > 0 ? step * std::round(v / step) : v);
    }
}

inline Json numbers_of(const Point& p) {
  Json::Array out;
  for (const Real v : p) out.emplace_back(static_cast<double>(v));
  return Json{std::move(out)};
}
inline Json number_of(Real value) { return Json{static_cast<double>(value)}; }

inline Json::Object member(const Tube& t) {
  return {{"id", Json{t.id}},
          {"start_mm", numbers_of(t.start)},
          {"end_mm", numbers_of(t.finish)},
          {"outer_diameter_mm", number_of(2 * t.radius)},
          {"wall_mm", number_of(t.wall)},
          {"priority", Json{static_cast<double>(t.priority)}}};
}

/// Writes the fields of a joint, the same for both sides, except for who joins whom.
inline void say(const Said& said, bool frame, Json::Object& out) {
  out.emplace_back("kind", Json{word(said.kind, frame)});
  out.emplace_back("gap_mm", number_of(said.gap));
  if (said.kind == Kind::set_in) out.emplace_back("depth_mm", number_of(said.depth));
  if (said.kind == Kind::corner_to_corner) out.emplace_back("plane", Json{"corner_to_corner"});
}

inline Json within_of(const Model& model) {
  return Json{Json::Object{{"within_mm", number_of(model.within)}}};
}

/// Returns `members` and `connect`, in the form of nodes and parts: each joint stated by one of its
/// two.
inline Json::Object members_of(const Model& model, Random& random) {
  std::vector<Json::Array> joints(model.tubes.size());
  Json::Array links;
  for (const auto& said : model.joints) {
    const bool by_chord = random.coin();
    Json::Object one{{"member", Json{model.tubes[by_chord ? said.branch : said.chord].id}}};
    say(said, false, one);
    joints[by_chord ? said.chord : said.branch].emplace_back(std::move(one));
    links.emplace_back(Json::Object{{"member", Json{model.tubes[said.branch].id}},
                                    {"end", Json{said.branch_end ? "finish" : "start"}},
                                    {"to", Json{Json::Array{Json{model.tubes[said.chord].id}}}}});
  }
  Json::Array members;
  for (std::size_t i = 0; i < model.tubes.size(); ++i) {
    auto one = member(model.tubes[i]);
    if (!joints[i].empty()) one.emplace_back("joints", Json{joints[i]});
    members.emplace_back(std::move(one));
  }
  return {{"members", Json{std::move(members)}},
          {"connect", model.within > 0 ? within_of(model) : Json{std::move(links)}}};
}

/// A frame's `members` and `joints`, of two in any order.
inline Json::Object frame_of(const Model& model, Random& random) {
  Json::Array members, joints;
  for (const auto& tube : model.tubes) members.emplace_back(member(tube));
  for (const auto& said : model.joints) {
    Json::Array between{Json{model.tubes[said.branch].id}, Json{model.tubes[said.chord].id}};
    if (random.coin()) std::swap(between[0], between[1]);
    Json::Object one{{"between", Json{std::move(between)}}};
    say(said, true, one);
    if (said.kind == Kind::set_on) one.emplace_back("hole", Json{said.hole ? "cut" : "none"});
    joints.emplace_back(std::move(one));
  }
  Json::Object out{{"members", Json{std::move(members)}}, {"joints", Json{std::move(joints)}}};
  if (model.within > 0) out.emplace_back("connect", within_of(model));
  return out;
}

/// Returns whether a pointer of an answer leads to a field of the request.
inline bool leads_into(const Json& request, std::string_view pointer) {
  if (pointer.empty() || pointer.front() != '/') return pointer.empty();
  try {
    (void)testing::at(request, pointer.substr(1));
    return true;
  } catch (const std::exception&) {
    return false;
  }
}

}  // namespace tubecut::drawn
