#include "core/groove/swept.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/elementary.hpp"

namespace tubecut::groove {
namespace {

// Steps of a golden section between two blocks. The flank's minimum is a parabola, the finite
// cutter's may be a corner.
constexpr int kSmoothSteps = 21;         // leaves 4e-5 of a block
constexpr int kCornerSteps = 37;         // leaves 2e-8 of a block
constexpr double kNear = 0.25 * kTwoPi;  // tools further round than this do not reach a ruling

/// A point of the workpiece on its ruling.
struct WorkPoint {
  double sin = 0.0, cos = 1.0;  // of its omega
  double s = 0.0, z = 0.0;
};

/// A tool with the direction of its section.
struct Station {
  double sin = 0.0, cos = 1.0;
  ToolPose pose;

  [[nodiscard]] Eigen::Vector3d seen(const WorkPoint& p) const {
    return {p.s * (p.cos * cos + p.sin * sin), p.s * (p.sin * cos - p.cos * sin), p.z};
  }
};

Station station_of(const Block& block, const Setup& setup) {
  const auto [s, c] = elementary::sincos(block.omega);
  return {s, c, pose_of(block, setup)};
}

/// The least of a distance over the motion.
struct Least {
  double value = std::numeric_limits<double>::infinity();
  double station = 0.0;
};

class Motion {
 public:
  Motion(const Setup& setup, std::span<const Block> blocks, Between between)
      : setup_(setup), blocks_(blocks), between_(between) {
    for (const Block& block : blocks) stations_.push_back(station_of(block, setup));
  }

  /// Blocks within a quarter turn of omega: first index and count; the index runs past the end
  /// round the turn.
  void look_at(double omega) {
    const auto n = blocks_.size();
    const auto first_at = [&](double from) {
      const double turns = std::floor(from / kTwoPi);
      const auto found =
          std::lower_bound(blocks_.begin(), blocks_.end(), from - turns * kTwoPi,
                           [](const Block& b, double value) { return b.omega < value; });
      return std::ptrdiff_t(found - blocks_.begin()) + std::ptrdiff_t(turns) * std::ptrdiff_t(n);
    };
    first_ = first_at(omega - kNear);
    count_ = first_at(omega + kNear) - first_;
  }

  /// Between the blocks it is only less: a caller after the greatest of such needs no more than a
  /// bound where that is already below the greatest so far.
  template <class Distance>
  [[nodiscard]] Least least(const WorkPoint& point, Distance distance, int steps,
                            double no_need_below) const {
    const auto n = std::ptrdiff_t(blocks_.size());
    Least best;
    for (std::ptrdiff_t i = first_; i < first_ + count_; ++i) {
      const Station& at = stations_[std::size_t((i % n + n) % n)];
      const double d = distance(at.pose, at.seen(point));
      if (d < best.value) best = {d, double((i % n + n) % n)};
    }
    if (best.value <= no_need_below) return best;
    return between_ == Between::linear ? refined(point, distance, best, steps) : best;
  }

 private:
  /// The two segments beside the best block, one by one: in each the distance falls and rises once,
  /// and at the block the motion has a corner.
  template <class Distance>
  [[nodiscard]] Least refined(const WorkPoint& point, Distance distance, Least best,
                              int steps) const {
    const auto at = [&](double t) {
      const Station there = station_of(block_at(blocks_, t), setup_);
      return Least{distance(there.pose, there.seen(point)), t};
    };
    for (const double low : {best.station - 1.0, best.station}) {
      const Least found = by_golden_section(low, low + 1.0, at, steps);
      if (found.value < best.value) best = found;
    }
    return best;
  }

  template <class At>
  static Least by_golden_section(double low, double high, At at, int steps) {
    constexpr double kGolden = 0.6180339887498949;
    Least left = at(high - kGolden * (high - low)), right = at(low + kGolden * (high - low));
    for (int i = 0; i < steps; ++i) {
      if (left.value < right.value) {
        high = right.station;
        right = left;
        left = at(high - kGolden * (high - low));
      } else {
        low = left.station;
        left = right;
        right = at(low + kGolden * (high - low));
      }
    }
    return left.value < right.value ? left : right;
  }

  const Setup& setup_;
  std::span<const Block> blocks_;
  Between between_;
  std::vector<Station> stations_;
  std::ptrdiff_t first_ = 0, count_ = 0;
};

void lower(Extreme& extreme, const Extreme& seen) {
  if (seen.value < extreme.value) extreme = seen;
}
void raise(Extreme& extreme, const Extreme& seen) {
  if (seen.value > extreme.value) extreme = seen;
}

}  // namespace

Block block_at(std::span<const Block> blocks, double station) {
  const double whole = std::floor(station), share = station - whole, n = double(blocks.size());
  const auto i = std::size_t(whole - n * std::floor(whole / n));
  const Block& a = blocks[i];
  Block b = blocks[(i + 1) % blocks.size()];
  if (i + 1 == blocks.size()) b.omega += kTwoPi;
  return {a.omega + share * (b.omega - a.omega), a.x + share * (b.x - a.x),
          a.z + share * (b.z - a.z), a.b + share * (b.b - a.b)};
}

ToolPose pose_of(const Block& block, const Setup& setup) {
  return tool_pose({.c = {}, .x = block.x, .z = block.z, .b = Angle::rad(block.b)}, setup);
}

tl::expected<Swept, ErrorCode> swept(const Joint& joint, const Cone& cone, const Setup& setup,
                                     std::span<const Block> blocks, Between between,
                                     const SweptPoints& points, std::stop_token stop) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Motion motion{setup, blocks, between};
  Swept out{{.value = kFar}, {.value = -kFar}, {.value = -kFar}, {.value = kFar}};
  const auto flank = [&cone](const ToolPose& pose, const Eigen::Vector3d& p) {
    return cone.flank(pose, p);
  };
  const auto solid = [&cone](const ToolPose& pose, const Eigen::Vector3d& p) {
    return cone.solid(pose, p);
  };
  for (int j = 0; j < points.rulings; ++j) {
    if (stop.stop_requested()) return tl::unexpected(ErrorCode::cancelled);
    const Angle omega = Angle::rad(kTwoPi * j / points.rulings);
    const auto found = section(joint, omega);
    if (!found) return tl::unexpected(found.error());
    motion.look_at(omega.rad());
    const auto seen = [&](double s, double z, double level, const auto& distance, int steps,
                          double no_need_below) {
      const Least least =
          motion.least({found->dir.sin, found->dir.cos, s, z}, distance, steps, no_need_below);
      return Extreme{least.value, omega, level, least.station};
    };
    for (int i = 0; i < points.per_ruling; ++i) {
      const double v = double(i) / (points.per_ruling - 1);
      const double s = joint.root_radius + v * joint.groove_width,
                   z = found->toe.y1 + v * found->height;
      const Extreme on_flank = seen(s, z, v, flank, kSmoothSteps, -kFar);
      lower(out.flank_min, on_flank);
      raise(out.flank_max, on_flank);
      raise(out.stock_left_max, seen(s, z, v, solid, kCornerSteps, out.stock_left_max.value));
    }
    for (int i = 0; i < points.root_levels; ++i) {
      const double level = double(i) / (points.root_levels - 1);
      lower(out.root_face_min, seen(joint.root_radius, found->toe.y1 - level * joint.root_height,
                                    level, solid, kCornerSteps, -kFar));
    }
  }
  return out;
}

}  // namespace tubecut::groove
