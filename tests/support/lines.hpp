#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "tests/support/call.hpp"

/// Frames whose members are pieces of lines, and the properties of their answers that follow from
/// only the centre-lines, in long double, without any code of core.
namespace tubecut::testing::lines {

using api::Json;
using Real = long double;
using Point = std::array<Real, 3>;

inline const Real kRad = std::acos(Real{-1}) / 180;

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
/// Degrees between two directions.
inline Real between(const Point& a, const Point& b) {
  return std::atan2(norm(cross(a, b)), dot(a, b)) / kRad;
}

struct Random {
  std::mt19937_64 engine;
  explicit Random(std::uint64_t seed) : engine(seed) {}
  Real between(Real from, Real to) {
    return std::uniform_real_distribution<double>(static_cast<double>(from),
                                                  static_cast<double>(to))(engine);
  }
  std::size_t below(std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n - 1)(engine);
  }
  bool coin() { return below(2) == 1; }
  template <class T>
  T one_of(std::initializer_list<T> all) {
    return all.begin()[below(all.size())];
  }
  Point direction() {
    std::normal_distribution<double> normal;
    return unit({normal(engine), normal(engine), normal(engine)});
  }
  /// Returns a direction tilted by `deg` degrees, to any side.
  Point leaning(const Point& axis, Real deg) {
    const Point side = unit(cross(direction(), axis));
    return std::cos(deg * kRad) * unit(axis) + std::sin(deg * kRad) * side;
  }
};

/// A member as it is sent.
struct Tube {
  std::string id;
  Point start, finish;
  Real diameter = 0, wall = 0;

  [[nodiscard]] Point along() const { return unit(finish - start); }
  [[nodiscard]] Real length() const { return norm(finish - start); }
  [[nodiscard]] Real off(const Point& p) const { return norm(cross(p - start, along())); }
  [[nodiscard]] Real axial(const Point& p) const { return dot(p - start, along()); }
};

inline void round_to(Real step, Tube& tube) {
  if (!(step > 0)) return;
  for (auto* p : {&tube.start, &tube.finish})
    for (auto& x : *p) x = std::round(x / step) * step;
}

inline Json numbers_of(const Point& p) {
  Json::Array out;
  // As a file has them: not more digits than they were rounded to.
  for (const Real v : p) out.emplace_back(static_cast<double>(v));
  return Json{std::move(out)};
}

inline Json request_of(const std::vector<Tube>& tubes, double within, bool merge) {
  Json::Array members;
  for (const auto& t : tubes)
    members.emplace_back(Json::Object{{"id", Json{t.id}},
                                      {"start_mm", numbers_of(t.start)},
                                      {"end_mm", numbers_of(t.finish)},
                                      {"outer_diameter_mm", Json{static_cast<double>(t.diameter)}},
                                      {"wall_mm", Json{static_cast<double>(t.wall)}}});
  Json::Object out{
      {"members", Json{std::move(members)}},
      {"connect", Json{Json::Object{{"within_mm", Json{within}}}}},
      {"defaults", *api::parse(R"({"root_surface": "inner", "groove": {"rule": "half_dihedral"},
                                   "smoothing": {"method": "none"}, "contact": "auto"})")},
      {"kerf_mm", Json{0.0}},
      {"torch", *api::parse(R"({"min_deg": -88, "max_deg": 88})")},
      {"sampling", *api::parse(R"({"tolerance_mm": 0.1})")}};
  if (merge) out.emplace_back("merge_in_line", Json{true});
  return Json{std::move(out)};
}

/// Returns the value of a JSON pointer, if it exists.
inline const Json* resolved(const Json& json, std::string_view pointer) {
  const Json* here = &json;
  while (here != nullptr && !pointer.empty()) {
    pointer.remove_prefix(1);
    const auto end = std::min(pointer.find('/'), pointer.size());
    const std::string step(pointer.substr(0, end));
    pointer.remove_prefix(end);
    if (const auto* array = here->as<Json::Array>()) {
      const auto index = std::stoul(step);
      here = index < array->size() ? &(*array)[index] : nullptr;
    } else {
      here = here->find(step);
    }
  }
  return here;
}

/// Texts of warnings and problems that point outside the frame's request.
inline std::vector<std::string> outside(const Json& answer) {
  std::vector<std::string> out;
  const auto& request = at(answer, "request");
  for (const auto& one : *at(answer, "warnings").as<Json::Array>()) {
    const auto detail = text(one, "detail");
    for (const auto* word : {"/marks", "/ends/start", "/ends/finish", "/target", "/holes"})
      if (detail.find(word) != std::string::npos) out.push_back(detail);
    if (resolved(request, text(one, "pointer")) == nullptr) out.push_back(text(one, "pointer"));
  }
  for (const auto& part : *at(answer, "parts").as<Json::Array>()) {
    if (part.find("problem") == nullptr) continue;
    for (const auto& issue : *at(part, "problem/errors").as<Json::Array>())
      if (resolved(request, text(issue, "pointer")) == nullptr)
        out.push_back(text(issue, "pointer") + " " + text(issue, "hint"));
  }
  return out;
}

inline bool warned(const Json& answer, std::string_view code) {
  for (const auto& one : *at(answer, "warnings").as<Json::Array>())
    if (text(one, "code") == code) return true;
  return false;
}

inline const Json* member_of(const Json& answer, std::string_view id) {
  for (const auto& one : *at(answer, "result/members").as<Json::Array>())
    if (text(one, "id") == id) return &one;
  return nullptr;
}
/// Returns the part of a member; null if it has no part.
inline const Json* part_of(const Json& answer, std::string_view id) {
  const auto* member = member_of(answer, id);
  if (member == nullptr) return nullptr;
  for (const auto& one : *at(answer, "parts").as<Json::Array>())
    if (text(one, "part") == text(*member, "part")) return one.find("answer");
  return nullptr;
}

/// Points on the inner edge of an end, in the world.
inline std::vector<Point> root_of(const Json& answer, const Tube& tube, bool finish) {
  const auto* part = part_of(answer, tube.id);
  const auto* member = member_of(answer, tube.id);
  if (part == nullptr || member->find("frame") == nullptr) return {};
  const auto vector = [&](const char* name) {
    const auto v = numbers(*member, std::string("frame/") + name);
    return Point{v[0], v[1], v[2]};
  };
  const Point o = vector("origin_mm"), x = vector("x"), y = vector("y"), z = vector("z");
  const auto& points =
      at(*part, std::string("result/ends/") + (finish ? "finish" : "start") + "/points");
  const auto phi = numbers(points, "phi_deg"), along = numbers(points, "z_inner_mm");
  const Real r = tube.diameter / 2 - tube.wall;
  std::vector<Point> out;
  for (std::size_t i = 0; i < phi.size(); ++i) {
    const Real a = phi[i] * kRad;
    out.push_back(o + r * std::cos(a) * x + r * std::sin(a) * y + Real{along[i]} * z);
  }
  return out;
}

/// Returns "kind" of the joint of two; empty if they have no joint.
inline std::string joint_of(const Json& answer, std::string_view a, std::string_view b) {
  for (const auto& one : *at(answer, "result/joints").as<Json::Array>()) {
    const auto branch = text(one, "branch"), chord = text(one, "chord");
    if ((branch == a && chord == b) || (branch == b && chord == a)) return text(one, "kind");
  }
  return {};
}

}  // namespace tubecut::testing::lines
