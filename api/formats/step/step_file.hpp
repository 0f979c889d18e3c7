#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

namespace tubecut::api {

/// A part of ISO 10303-21: entities one after the other, each named by its number.
class StepEntities {
 public:
  using Id = std::size_t;

  /// `digits` behind the point of a coordinate, mm.
  explicit StepEntities(int digits) : digits_(digits) {}

  /// `entity` without its number: "DIRECTION('',(0.,0.,1.))".
  Id add(std::string_view entity);
  /// The one there is that reads so, or a new one.
  Id shared(const std::string& entity);
  Id point(const Eigen::Vector3d& p);
  /// (angle, height) on a cylinder.
  Id point(const Eigen::Vector2d& p);
  Id direction(const Eigen::Vector3d& d);
  /// A frame with the world's z, and x turned by `phi` about it.
  Id placement(const Eigen::Vector3d& origin, double phi = 0.0);

  /// The bounds of a face, the outer one first; `edges`: of the solid, which its loops use.
  std::vector<Id> bounds(const std::vector<std::vector<std::pair<std::size_t, bool>>>& loops,
                         const std::vector<Id>& edges);

  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
  std::unordered_map<std::string, Id> shared_;
  Id last_ = 0;
  int digits_;
};

[[nodiscard]] std::string step_ref(StepEntities::Id id);
/// ".T." or ".F."
[[nodiscard]] std::string step_logical(bool value);
/// "(#1,#2)"
[[nodiscard]] std::string step_refs(const std::vector<StepEntities::Id>& ids);
/// Returns a real: with a point, at most `digits` digits after it, without trailing zeros.
[[nodiscard]] std::string step_real(double value, int digits);
/// A text that may be a client's, between its apostrophes.
[[nodiscard]] std::string step_string(std::string_view text);

}  // namespace tubecut::api
