#include "core/groove/swept.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/stop.hpp"
#include "core/base/try.hpp"
#include "core/groove/tool_motion.hpp"

namespace tubecut::groove {
namespace {

constexpr double kFarAway = std::numeric_limits<double>::infinity();
constexpr double kSearched =
    1e-6;  // mm; the error of a search between blocks, and of its bounds, is smaller

/// The position of a sampled point.
struct At {
  int ruling = 0, level = 0;
};

/// A point and a lower bound of its value.
struct Bounded {
  double bound = 0.0;
  At at;
  bool tight = true;  // false: `range` gives a better bound
  [[nodiscard]] bool operator<(const Bounded& other) const {
    if (bound != other.bound) return bound > other.bound;  // the smallest on top of the heap
    return std::pair(at.ruling, at.level) > std::pair(other.at.ruling, other.at.level);
  }
};

/// Smallest distances of all points, computed only if their bounds can change the result.
class Sweep {
 public:
  Sweep(const JointGeometry& joint, const SweptPoints& points, ToolMotion motion)
      : joint_(joint), points_(points), motion_(std::move(motion)) {}

  tl::expected<Swept, ErrorCode> run() {
    for (int j = 0; j < points_.rulings; ++j) {
      if (stopped()) return tl::unexpected(ErrorCode::cancelled);
      TRY(const auto found, section(joint_, omega(j)));
      sections_.push_back(found);
      motion_.select_ruling(omega(j).rad(), found.dir);
      for (int i = 0; i < points_.per_ruling; ++i) bound_on_groove({j, i});
      for (int i = 0; i < points_.root_levels; ++i) bound_on_root_face({j, i});
    }
    const auto groove = [this](At at) { return on_groove(at); };
    const auto root = [this](At at) { return on_root_face(at); };
    Swept out;
    out.flank_min = extreme(std::move(deepest_), groove, Part::flank, 1.0);
    out.flank_max = extreme(std::move(highest_), groove, Part::flank, -1.0);
    out.stock_left_max = extreme(std::move(left_), groove, Part::solid, -1.0);
    out.root_face_min = extreme(std::move(root_), root, Part::solid, 1.0);
    if (stopped()) return tl::unexpected(ErrorCode::cancelled);
    return out;
  }

 private:
  struct Point {
    WorkPoint place;
    double level = 0.0;
  };

  [[nodiscard]] Angle omega(int ruling) const {
    return Angle::rad(kTwoPi * ruling / points_.rulings);
  }

  [[nodiscard]] Point on_groove(At at) const {
    const Section& s = sections_[std::size_t(at.ruling)];
    const double v = double(at.level) / (points_.per_ruling - 1);
    return {{s.dir, joint_.root_radius + v * joint_.groove_width, s.toe.y1 + v * s.height}, v};
  }

  [[nodiscard]] Point on_root_face(At at) const {
    const Section& s = sections_[std::size_t(at.ruling)];
    const double level = double(at.level) / (points_.root_levels - 1);
    return {{s.dir, joint_.root_radius, s.toe.y1 - level * joint_.root_height}, level};
  }

  void bound_on_groove(At at) {
    const WorkPoint p = on_groove(at).place;
    const LeastRange flank = motion_.range(p, Part::flank, motion_.at_blocks(p, Part::flank));
    deepest_.push_back({flank.low, at});
    highest_.push_back({-flank.met.value, at});
    // The cutter itself cuts at most as deep as its distance where the flank is deepest.
    left_.push_back({-motion_.distance(p, Part::solid, flank.met.station), at, false});
  }

  void bound_on_root_face(At at) {
    const WorkPoint p = on_root_face(at).place;
    root_.push_back({motion_.range(p, Part::solid, motion_.at_blocks(p, Part::solid)).low, at});
  }

  /// Returns the smallest of `sign` times the values, the first of equals: from the smallest bound
  /// on, until no other can be smaller.
  template <class PointAt>
  Extreme extreme(std::vector<Bounded> heap, const PointAt& point_at, Part part, double sign) {
    std::make_heap(heap.begin(), heap.end());
    Bounded best{kFarAway, {}};
    Extreme out{.value = sign * kFarAway};
    while (!heap.empty() && heap.front().bound <= best.bound + kSearched && !stopped()) {
      std::pop_heap(heap.begin(), heap.end());
      const auto [bound, at, tight] = heap.back();
      heap.pop_back();
      const Point p = point_at(at);
      motion_.select_ruling(omega(at.ruling).rad(), p.place.dir);
      if (!tight) {
        const LeastRange range = motion_.range(p.place, part, motion_.at_blocks(p.place, part));
        heap.push_back({sign > 0.0 ? range.low : -range.met.value, at});
        std::push_heap(heap.begin(), heap.end());
        continue;
      }
      const Least found = motion_.over_motion(p.place, part);
      const Bounded here{sign * found.value, at};
      if (!(best < here)) continue;
      best = here;
      out = {found.value, omega(at.ruling), p.level, found.station};
    }
    return out;
  }

  const JointGeometry& joint_;
  const SweptPoints& points_;
  ToolMotion motion_;
  std::vector<Section> sections_;
  std::vector<Bounded> deepest_, highest_, left_, root_;
};

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

tl::expected<Swept, ErrorCode> swept(const JointGeometry& joint, const Cone& cone,
                                     const Setup& setup, std::span<const Block> blocks,
                                     Between between, const SweptPoints& points) {
  return Sweep{joint, points, ToolMotion{cone, setup, blocks, between}}.run();
}

}  // namespace tubecut::groove
