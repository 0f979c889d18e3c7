#include "core/joint/solid.hpp"

namespace tubecut::joint {

using Eigen::Vector3d;

Solid::Solid(const Cutter& cutter)
    : kind_(by_kind(cutter, [](const auto& kind) -> Kind { return kind.solid(); })) {}

double Solid::distance(const Vector3d& point) const {
  return by_kind(kind_, [&](const auto& solid) { return solid.distance(point); });
}
Vector3d Solid::normal(const Vector3d& point) const {
  return by_kind(kind_, [&](const auto& solid) { return solid.normal(point); });
}
std::optional<double> Solid::top(double x, double y) const {
  return by_kind(kind_, [&](const auto& solid) { return solid.top(x, y); });
}
double Solid::clearance(double x, double y) const {
  return by_kind(kind_, [&](const auto& solid) { return solid.clearance(x, y); });
}
double Solid::least_distance(const Vector3d& a, const Vector3d& b) const {
  return by_kind(kind_, [&](const auto& solid) { return solid.least_distance(a, b); });
}
double Solid::scale() const {
  return by_kind(kind_, [](const auto& solid) { return solid.scale(); });
}

}  // namespace tubecut::joint
