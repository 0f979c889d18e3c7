#include <algorithm>
#include <cmath>

#include "core/base/stop.hpp"
#include "core/base/try.hpp"
#include "core/groove/mill_parts.hpp"

namespace tubecut::groove {
namespace {

/// Exact poses between optima.
class Route {
 public:
  Route(const Shop& shop, const Increments& increments) : shop_(shop), increments_(increments) {}

  /// Returns the stations to emit: the optima, and between each two as many equal parts as keep the
  /// sag small.
  [[nodiscard]] Result<std::vector<double>> stations() const {
    std::vector<double> out;
    const int most = most_emitted(shop_.spec.check);
    for (int i = 0; i < shop_.spec.positions; ++i) {
      if (stopped()) return fail({.code = ErrorCode::cancelled});
      const auto count = parts(i);
      if (!count) return failed(count.error(), shop_.omega(i));
      for (int k = 0; k < *count; ++k) out.push_back(i + double(k) / *count);
      if (out.size() > std::size_t(most))
        return fail(
            {.code = ErrorCode::too_many_nodes,
             .member = most < kMaxPositions ? "check" : "setup/pivot_length",
             .got = double(out.size()),
             .limit = double(most),
             .hint = "positions that keep the axes' sag below 0.001 mm" +
                     std::string(most < kMaxPositions ? ", each checked at all points and rulings"
                                                      : "")});
    }
    return out;
  }

 private:
  struct Exact {
    ToolPose pose;
    Block block;
  };

  [[nodiscard]] tl::expected<Exact, ErrorCode> exact(double station) const {
    const MillPathSpec& spec = shop_.spec;
    const Angle omega = Angle::rad(shop_.omega(station));
    TRY(const auto here, section(shop_.joint, omega));
    const ToolPose pose = moved(initial_pose(shop_.joint, here, spec.mill, spec.setup), spec.setup,
                                spec.optimise.hold, increments_.at(station));
    const AxisPosition at = axis_position(pose, spec.setup, omega);
    return Exact{pose, {omega.rad(), at.x, at.z, at.b.rad()}};
  }

  /// Returns the error of the tool's ends and the axes at the middle of a linear move.
  [[nodiscard]] double sag(const Exact& a, const Exact& middle, const Exact& b) const {
    const Block half{0.0, 0.5 * (a.block.x + b.block.x), 0.5 * (a.block.z + b.block.z),
                     0.5 * (a.block.b + nearest_turn(b.block.b, a.block.b))};
    const ToolPose linear = pose_of(half, shop_.spec.setup);
    const Eigen::Vector2d tip = linear.tip - middle.pose.tip;
    const Eigen::Vector2d back = tip + shop_.cone.length * (linear.axis - middle.pose.axis);
    return std::max({tip.norm(), back.norm(), std::abs(half.x - middle.block.x),
                     std::abs(half.z - middle.block.z)});
  }

  [[nodiscard]] tl::expected<double, ErrorCode> worst_sag(int interval, int count) const {
    double out = 0.0;
    auto from = exact(interval);
    for (int k = 0; k < count; ++k) {
      const auto middle = exact(interval + (k + 0.5) / count),
                 to = exact(interval + (k + 1.0) / count);
      if (!from || !middle || !to) return tl::unexpected(ErrorCode::no_p2);
      out = std::max(out, sag(*from, *middle, *to));
      from = to;
    }
    return out;
  }

  [[nodiscard]] tl::expected<int, ErrorCode> parts(int interval) const {
    int count = 1;
    while (count <= kMaxPositions) {  // grows by one at least
      TRY(const double worst, worst_sag(interval, count));
      if (worst <= kAxisSag) return count;
      count =
          std::max(count + 1, int(std::ceil(count * std::sqrt(std::min(worst / kAxisSag, 1e8)))));
    }
    return count;
  }

  const Shop& shop_;
  const Increments& increments_;
};

}  // namespace

Result<std::vector<double>> emitted_stations(const Shop& shop, const Increments& increments) {
  return Route{shop, increments}.stations();
}

}  // namespace tubecut::groove
