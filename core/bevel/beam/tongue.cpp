#include "core/bevel/beam/tongue.hpp"

#include <algorithm>
#include <span>

#include "core/base/stop.hpp"
#include "core/math/rotation.hpp"

namespace tubecut::bevel {
namespace {

/// A closed edge; heights are measured in the direction of its tongues.
class Edge {
 public:
  Edge(std::span<const double> phi, const std::vector<double>& z, double sign)
      : phi_(phi), height_(z) {
    for (double& h : height_) h *= sign;
  }

  [[nodiscard]] std::size_t size() const { return phi_.size(); }
  [[nodiscard]] double height(std::size_t i) const { return height_[i]; }
  [[nodiscard]] bool tip(std::size_t i) const {
    const auto n = size();
    return height_[i] > height_[(i + n - 1) % n] && height_[i] >= height_[(i + 1) % n];
  }
  [[nodiscard]] double relief() const {
    const auto [least, most] = std::ranges::minmax(height_);
    return most - least;
  }
  /// Returns how far the edge stays above `level` from row i forwards, or backwards, rad; a whole
  /// revolution if it never falls to it.
  [[nodiscard]] double above(std::size_t i, double level, bool forwards) const {
    const auto n = size();
    double turned = 0.0;
    for (std::size_t k = 0; k < n; ++k) {
      const auto here = forwards ? (i + k) % n : (i + n - k) % n;
      const auto next = forwards ? (here + 1) % n : (here + n - 1) % n;
      const double step =
          math::whole_turn(forwards ? phi_[next] - phi_[here] : phi_[here] - phi_[next]);
      if (height_[next] <= level) {
        const double fall = height_[here] - height_[next];
        return turned + (fall > 0.0 ? step * (height_[here] - level) / fall : 0.0);
      }
      turned += step;
    }
    return kTwoPi;
  }

 private:
  std::span<const double> phi_;
  std::vector<double> height_;
};

}  // namespace

std::optional<Tongue> narrowest_tongue(const joint::Target& target, const Table& table,
                                       bool towards_plus_z) {
  std::optional<Tongue> out;
  const auto see = [&](double radius, const std::vector<double>& z) {
    const Edge edge(table.phi, z, towards_plus_z ? 1.0 : -1.0);
    if (!(edge.relief() > target.wall)) return;
    for (std::size_t i = 0; i < edge.size() && !stopped(); ++i) {
      if (!edge.tip(i)) continue;
      const double level = edge.height(i) - target.wall;
      const double round = edge.above(i, level, true) + edge.above(i, level, false);
      if (!(round < kTwoPi)) continue;
      if (!out || radius * round < out->width) out = {radius * round, table.phi[i], z[i], radius};
    }
  };
  see(target.inner_radius(), table.z_inner);
  see(target.outer_radius, table.z_outer);
  return out;
}

double reach(const std::vector<double>& torch_inner, const std::vector<double>& torch_outer) {
  const auto a = std::ranges::minmax(torch_inner), b = std::ranges::minmax(torch_outer);
  return std::max(a.max, b.max) - std::min(a.min, b.min);
}

double reach(const Table& table) { return reach(table.torch_inner, table.torch_outer); }

}  // namespace tubecut::bevel
