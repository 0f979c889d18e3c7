#include "api/formats/step/step_file.hpp"

#include <array>

#include "api/formats/text.hpp"
#include "core/base/elementary.hpp"

namespace tubecut::api {
namespace {

constexpr int kDirectionDigits = 12;
constexpr int kAngleDigits = 9;  // rad: 1e-6 mm at a radius of 1 m

void append_real(std::string& out, double value, int digits) {
  out += fixed(value, digits);
  out.erase(out.find_last_not_of('0') + 1);
}

/// "CARTESIAN_POINT('',(0.,0.,1.))": the most frequent line of a file, so it is written into one
/// buffer.
template <int N>
std::string listed(std::string_view entity, const Eigen::Matrix<double, N, 1>& values,
                   const std::array<int, N>& digits) {
  std::string out;
  out.reserve(96);
  out += entity;
  for (int i = 0; i < N; ++i) {
    out += i == 0 ? "('',(" : ",";
    append_real(out, values[i], digits[static_cast<std::size_t>(i)]);
  }
  return out += "))";
}

}  // namespace

std::string step_ref(StepEntities::Id id) { return "#" + std::to_string(id); }

std::string step_refs(const std::vector<StepEntities::Id>& ids) {
  std::string out = "(";
  for (const auto id : ids) {
    if (out.size() > 1) out += ',';
    out += step_ref(id);
  }
  return out += ')';
}

std::string step_real(double value, int digits) {
  std::string out;
  append_real(out, value, digits);
  return out;
}

std::string step_string(std::string_view text) { return "'" + step_text(text) + "'"; }

std::string step_logical(bool value) { return value ? ".T." : ".F."; }

std::vector<StepEntities::Id> StepEntities::bounds(
    const std::vector<std::vector<std::pair<std::size_t, bool>>>& loops,
    const std::vector<Id>& edges) {
  std::vector<Id> out;
  for (const auto& loop : loops) {
    std::vector<Id> uses;
    for (const auto& [edge, forward] : loop)
      uses.push_back(
          add("ORIENTED_EDGE('',*,*," + step_ref(edges[edge]) + "," + step_logical(forward) + ")"));
    const auto all = add("EDGE_LOOP(''," + step_refs(uses) + ")");
    out.push_back(
        add((out.empty() ? "FACE_OUTER_BOUND(''," : "FACE_BOUND('',") + step_ref(all) + ",.T.)"));
  }
  return out;
}

StepEntities::Id StepEntities::add(std::string_view entity) {
  ++last_;
  text_ += step_ref(last_);
  text_ += '=';
  text_ += entity;
  text_ += ";\n";
  return last_;
}

StepEntities::Id StepEntities::shared(const std::string& entity) {
  const auto [known, fresh] = shared_.try_emplace(entity, last_ + 1);
  return fresh ? add(entity) : known->second;
}

StepEntities::Id StepEntities::point(const Eigen::Vector3d& p) {
  return shared(listed<3>("CARTESIAN_POINT", p, {digits_, digits_, digits_}));
}

StepEntities::Id StepEntities::point(const Eigen::Vector2d& p) {
  return shared(listed<2>("CARTESIAN_POINT", p, {kAngleDigits, digits_}));
}

StepEntities::Id StepEntities::direction(const Eigen::Vector3d& d) {
  return shared(listed<3>("DIRECTION", d, {kDirectionDigits, kDirectionDigits, kDirectionDigits}));
}

StepEntities::Id StepEntities::placement(const Eigen::Vector3d& origin, double phi) {
  const auto [sin, cos] = elementary::sincos(phi);
  const auto at = point(origin), z = direction({0, 0, 1}), x = direction({cos, sin, 0});
  return shared("AXIS2_PLACEMENT_3D(''," + step_ref(at) + "," + step_ref(z) + "," + step_ref(x) +
                ")");
}

}  // namespace tubecut::api
