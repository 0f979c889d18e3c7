#include "core/joint/height_proof.hpp"

#include <cmath>
#include <optional>

namespace tubecut::joint {
namespace {

constexpr double kOnCutter = 1e-12;  // of the larger of the solid's size + `wide` and |z|
constexpr double kAbove = 1e-9;      // likewise
constexpr double kTouches = 1e-12;   // likewise
constexpr double kGraze = 4e-12;     // likewise: two verifications of one contact
constexpr double kLabel = 1e-7;      // likewise: the curve is vertical at a silhouette
constexpr double kEvent = 1e-8;      // likewise

/// Returns true if a line along z only touches the partner between the two heights, within
/// rounding: then neither height is exact.
bool grazes(const Solid& solid, const Eigen::Vector3d& at, double top, double size) {
  const Eigen::Vector3d middle(at.x(), at.y(), 0.5 * (at.z() + top));
  return std::abs(solid.distance(middle)) <= kGraze * size;
}

}  // namespace

void Worst::see(double value, double limit) {
  const bool known = std::isnan(check_.value) ||  // because NaN counts as the worst
                     (check_.limit > 0.0 && value / limit <= check_.value / check_.limit);
  if (known) return;
  check_.value = value;
  check_.limit = limit;
}

double HeightProof::size(std::size_t k, double z) const {
  return std::max(solids_.at(k).scale() + wide_, std::abs(z));
}

void HeightProof::see_height(const Eigen::Vector3d& at, std::size_t cutter,
                             const std::vector<std::size_t>& joined) {
  const auto& own = solids_.at(cutter);
  const double size = this->size(cutter, at.z()), off = std::abs(own.distance(at));
  double on = off;
  // Where two partners meet tangentially the place of their junction is known to a root of
  // rounding: the height is that of the one that is less steep.
  for (const auto k : joined) on = std::min(on, std::abs(solids_.at(k).distance(at)));
  on_cutter_.see(on, kOnCutter * size);
  const auto top = own.top(at.x(), at.y());
  // A silhouette may be missed by rounding; then the line touches instead.
  const bool touches = !top && std::abs(own.clearance(at.x(), at.y())) <= kTouches * size;
  const double apart = top ? std::abs(*top - at.z()) : size;
  const bool grazed = apart > kLabel * size && top && grazes(own, at, *top, size);
  labels_.see(touches || grazed ? off : apart, kLabel * size);
}

void HeightProof::see_other(std::size_t k, const Eigen::Vector3d& at, double size) {
  const auto& solid = solids_[k];
  const auto top = solid.top(at.x(), at.y());
  if (!top) return;
  const double above = worst_of({0.0, *top - at.z()});
  // A partner that only touches the line removes no metal.
  const bool touches = above > kAbove * size &&
                       (solid.clearance(at.x(), at.y()) >= -kTouches * (solid.scale() + wide_) ||
                        grazes(solid, at, *top, size));
  none_above_.see(touches ? 0.0 : above, kAbove * size);
}

void HeightProof::see_junction(const Eigen::Vector3d& at, std::size_t from, std::size_t to) {
  const auto &a = solids_.at(from), &b = solids_.at(to);
  const double size = std::max(a.scale(), b.scale()) + wide_;
  const auto top_a = a.top(at.x(), at.y()), top_b = b.top(at.x(), at.y());
  double gap = top_a && top_b ? std::abs(*top_a - *top_b) : size;
  const auto meets = [&](const Solid& solid, const std::optional<double>& top) {
    return top ? std::abs(*top - at.z()) <= kEvent * size || grazes(solid, at, *top, size)
               : std::abs(solid.clearance(at.x(), at.y())) <= kTouches * size;
  };
  if (gap > kEvent * size && meets(a, top_a) && meets(b, top_b))
    gap = std::max(std::abs(a.distance(at)), std::abs(b.distance(at)));
  event_gap_.see(gap, kEvent * size);
}

void HeightProof::see_touch(const Eigen::Vector3d& at, std::size_t from, std::size_t to,
                            std::size_t lost) {
  const double size = std::max(solids_.at(from).scale(), solids_.at(to).scale()) + wide_;
  event_gap_.see(std::abs(solids_.at(lost).clearance(at.x(), at.y())), kEvent * size);
}

void HeightProof::see_seam(const Eigen::Vector3d& at, std::size_t cutter) {
  const auto& own = solids_.at(cutter);
  event_gap_.see(std::abs(own.distance(at)), kEvent * (own.scale() + wide_));
}

std::vector<Check> HeightProof::checks() const {
  std::vector<Check> out;
  for (const auto* worst : {&on_cutter_, &none_above_, &event_gap_, &labels_})
    out.push_back(worst->check());
  return out;
}

}  // namespace tubecut::joint
