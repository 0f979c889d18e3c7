#include "core/part/edge_mistakes.hpp"

#include <algorithm>
#include <vector>

#include "core/math/rotation.hpp"

namespace tubecut::part {
namespace {

struct OutlinePoint {
  double phi, z;
};

Edge moved(const Edge& e, bool mirror, double by) {
  std::vector<OutlinePoint> nodes;
  for (std::size_t i = 0; i < e.phi.size(); ++i)
    nodes.push_back({math::whole_turn((mirror ? -e.phi[i] : e.phi[i]) + by), e.z[i]});
  if (mirror) std::ranges::reverse(nodes);
  std::ranges::stable_sort(nodes, {}, &OutlinePoint::phi);
  Edge out;
  for (const auto& node : nodes) {
    out.phi.push_back(node.phi);
    out.z.push_back(node.z);
  }
  return out;
}

}  // namespace

void move_end(EndEdges end, bool mirror, double by) {
  for (auto* edge : {end.outer, end.inner}) *edge = moved(*edge, mirror, by);
}

void swing_wrong(EndEdges end, bool root_outer) {
  const auto& root = root_outer ? *end.outer : *end.inner;
  auto& other = root_outer ? *end.inner : *end.outer;
  for (std::size_t k = 0; k < root.z.size(); ++k) other.z[k] = 2.0 * root.z[k] - other.z[k];
}

void thicken(double factor, EndEdges end) {
  const auto& o = end.outer->z;
  auto& i = end.inner->z;
  for (std::size_t k = 0; k < i.size(); ++k) i[k] = o[k] - factor * (o[k] - i[k]);
}

void shift_by_slope(double factor, EndEdges end) {
  auto &o = end.outer->z, &i = end.inner->z;
  for (std::size_t k = 0; k < o.size(); ++k) {
    const double shift = factor * (o[k] - i[k]);
    o[k] += shift;
    i[k] += shift;
  }
}

}  // namespace tubecut::part
