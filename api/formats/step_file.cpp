#include "api/formats/step_file.hpp"

#include "api/formats/text.hpp"
#include "core/base/elementary.hpp"

namespace tubecut::api {
namespace {

constexpr int kDirectionDigits = 12;
constexpr int kAngleDigits = 9;  // rad: 1e-6 mm at a radius of 1 m

std::string triple(const Eigen::Vector3d& v, int digits) {
  return "(" + step_real(v.x(), digits) + "," + step_real(v.y(), digits) + "," +
         step_real(v.z(), digits) + ")";
}

}  // namespace

std::string step_ref(StepEntities::Id id) { return "#" + std::to_string(id); }

std::string step_refs(const std::vector<StepEntities::Id>& ids) {
  std::string out = "(";
  for (const auto id : ids) out += (out.size() > 1 ? "," : "") + step_ref(id);
  return out + ")";
}

std::string step_real(double value, int digits) {
  auto out = fixed(value, digits);
  out.erase(out.find_last_not_of('0') + 1);
  return out;
}

std::string step_string(std::string_view text) { return "'" + step_text(text) + "'"; }

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
  return shared("CARTESIAN_POINT(''," + triple(p, digits_) + ")");
}

StepEntities::Id StepEntities::point(const Eigen::Vector2d& p) {
  return shared("CARTESIAN_POINT('',(" + step_real(p.x(), kAngleDigits) + "," +
                step_real(p.y(), digits_) + "))");
}

StepEntities::Id StepEntities::direction(const Eigen::Vector3d& d) {
  return shared("DIRECTION(''," + triple(d, kDirectionDigits) + ")");
}

StepEntities::Id StepEntities::placement(const Eigen::Vector3d& origin, double phi) {
  const auto [sin, cos] = elementary::sincos(phi);
  const auto at = point(origin), z = direction({0, 0, 1}), x = direction({cos, sin, 0});
  return shared("AXIS2_PLACEMENT_3D(''," + step_ref(at) + "," + step_ref(z) + "," + step_ref(x) +
                ")");
}

}  // namespace tubecut::api
