#include "core/joint/nearness.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

#include "core/base/stop.hpp"
#include "core/base/try.hpp"

namespace tubecut::joint {
namespace {

using Eigen::Vector3d;

constexpr double kCellsPerMember = 8.0;
constexpr double kCellsAlongAxis = 1 << 20;  // three of them fit one key of 64 bits

using Cell = std::array<std::int64_t, 3>;

/// The ends of all axis segments, sorted into cubes.
class Grid {
 public:
  explicit Grid(std::span<const AxisSegment> segments);

  /// Calls `visit(end)` for every end in a cube that the box meets.
  template <class F>
  void in_box(const Vector3d& low, const Vector3d& high, F visit) const {
    const Cell a = cell(low), b = cell(high);
    for (auto i = a[0]; i <= b[0]; ++i)
      for (auto j = a[1]; j <= b[1]; ++j) {
        auto at = std::ranges::lower_bound(entries_, key({i, j, a[2]}), {}, &Entry::key);
        for (const auto last = key({i, j, b[2]}); at != entries_.end() && at->key <= last; ++at)
          visit(at->end);
      }
  }
  /// Returns the number of rows of cubes that a box meets: the cost of `in_box` without its visits.
  [[nodiscard]] double rows(const Vector3d& low, const Vector3d& high) const {
    const Cell a = cell(low), b = cell(high);
    return static_cast<double>(b[0] - a[0] + 1) * static_cast<double>(b[1] - a[1] + 1);
  }
  [[nodiscard]] double size() const { return size_; }

 private:
  struct Entry {
    std::uint64_t key;
    std::size_t end;
  };
  [[nodiscard]] Cell cell(const Vector3d& at) const {
    Cell out{};
    for (int k = 0; k < 3; ++k)
      out[static_cast<std::size_t>(k)] = static_cast<std::int64_t>(
          std::clamp(std::floor((at[k] - low_[k]) / size_), 0.0, kCellsAlongAxis - 1.0));
    return out;
  }
  [[nodiscard]] static std::uint64_t key(const Cell& c) {
    return (static_cast<std::uint64_t>(c[0]) << 40U) | (static_cast<std::uint64_t>(c[1]) << 20U) |
           static_cast<std::uint64_t>(c[2]);
  }

  Vector3d low_ = Vector3d::Zero();
  double size_ = 1.0;
  std::vector<Entry> entries_;  // ascending key, then end
};

Grid::Grid(std::span<const AxisSegment> segments) {
  Vector3d low = segments.front().start, high = low;
  double length = 0.0, reach = 0.0;
  for (const auto& s : segments) {
    low = low.cwiseMin(s.start).cwiseMin(s.finish);
    high = high.cwiseMax(s.start).cwiseMax(s.finish);
    length += (s.finish - s.start).norm();
    reach += s.reach;
  }
  const auto n = static_cast<double>(segments.size());
  low_ = low;
  size_ = std::max({length / (kCellsPerMember * n), 2.0 * reach / n,
                    (high - low).maxCoeff() / (kCellsAlongAxis - 2.0), 1e-9});
  for (std::size_t i = 0; i < segments.size(); ++i) {
    entries_.push_back({key(cell(segments[i].start)), 2 * i});
    entries_.push_back({key(cell(segments[i].finish)), 2 * i + 1});
  }
  std::ranges::sort(entries_, [](const Entry& a, const Entry& b) {
    return a.key != b.key ? a.key < b.key : a.end < b.end;
  });
}

/// Calls `visit(end)` once for every end near the segment. It searches piece by piece along it, so
/// that a long diagonal member does not search its whole box.
template <class F>
void search(const Grid& grid, const AxisSegment& s, std::size_t ends, F visit) {
  const Vector3d along = s.finish - s.start;
  const Vector3d reach = Vector3d::Constant(s.reach);
  int axis = 0;
  along.cwiseAbs().maxCoeff(&axis);
  const double span = std::abs(along[axis]);
  const double step = std::max(grid.size(), 2.0 * s.reach);
  const auto pieces = static_cast<std::size_t>(std::ceil((span + 2.0 * s.reach) / step));
  const double from = std::min(s.start[axis], s.finish[axis]) - s.reach;
  double rows = 0.0;
  const auto box = [&](std::size_t k, auto each) {
    const double low = from + static_cast<double>(k) * step;
    // The part of the axis whose reach meets this piece, and the box around it.
    const auto share = [&](double at) {
      return std::clamp((at - s.start[axis]) / along[axis], 0.0, 1.0);
    };
    const Vector3d a = s.start + share(low - s.reach) * along;
    const Vector3d b = s.start + share(low + step + s.reach) * along;
    Vector3d bottom = a.cwiseMin(b) - reach, top = a.cwiseMax(b) + reach;
    bottom[axis] = low;
    top[axis] = low + step;
    each(bottom, top);
  };
  for (std::size_t k = 0; k < pieces && rows <= static_cast<double>(ends); ++k)
    box(k, [&](const Vector3d& low, const Vector3d& high) { rows += grid.rows(low, high); });
  if (rows > static_cast<double>(ends)) {  // a scan of all ends is cheaper
    for (std::size_t end = 0; end < ends; ++end) visit(end);
    return;
  }
  for (std::size_t k = 0; k < pieces; ++k)
    box(k, [&](const Vector3d& low, const Vector3d& high) { grid.in_box(low, high, visit); });
}

/// Calls `see(touch)` for every end within the reach of another axis segment, until it returns
/// false.
template <class F>
Result<void> for_touches(std::span<const AxisSegment> segments, F see) {
  if (segments.empty()) return {};
  const Grid grid(segments);
  const auto ends = 2 * segments.size();
  std::vector<std::size_t> seen(ends, segments.size());
  bool more = true;
  for (std::size_t i = 0; i < segments.size() && more; ++i) {
    if (stopped()) return fail({.code = ErrorCode::cancelled});
    search(grid, segments[i], ends, [&](std::size_t end) {
      if (end / 2 == i || seen[end] == i)
        return;  // a cube on the border of two pieces occurs twice
      seen[end] = i;
      const auto& own = segments[end / 2];
      const auto near = nearness(end % 2 == 0 ? own.start : own.finish, segments[i]);
      if (near.distance <= segments[i].reach && !see(Touch{end, i, near})) more = false;
    });
  }
  return {};
}

}  // namespace

Nearness nearness(const Vector3d& point, const AxisSegment& segment) {
  const Vector3d along = segment.finish - segment.start;
  const double length = along.norm();
  const Vector3d unit = along / length;
  const double at = std::clamp((point - segment.start).dot(unit), 0.0, length);
  return {.distance = (point - (segment.start + at * unit)).norm(),
          .inside = std::min(at, length - at)};
}

// The minimum is between the lines' nearest points if both lie within, else at an end.
double nearness(const AxisSegment& a, const AxisSegment& b) {
  const Vector3d u = a.finish - a.start, v = b.finish - b.start, w = b.start - a.start;
  const Vector3d n = u.cross(v);
  double out = std::min({nearness(a.start, b).distance, nearness(a.finish, b).distance,
                         nearness(b.start, a).distance, nearness(b.finish, a).distance});
  const double square = n.squaredNorm();
  if (!(square > 0.0)) return out;
  const double s = w.cross(v).dot(n) / square, t = w.cross(u).dot(n) / square;
  if (s > 0.0 && s < 1.0 && t > 0.0 && t < 1.0)
    out = std::min(out, std::abs(w.dot(n)) / std::sqrt(square));
  return out;
}

Result<std::vector<Touch>> touches(std::span<const AxisSegment> segments, std::size_t most) {
  std::vector<Touch> out;
  std::vector<std::size_t> count(2 * segments.size(), 0);
  std::optional<std::size_t> crowded;
  TRY(for_touches(segments, [&](const Touch& touch) {
    out.push_back(touch);
    if (++count[touch.end] > most) crowded = touch.end;
    return !crowded;
  }));
  if (crowded)
    return fail({.code = ErrorCode::wrong_count,
                 .member = "members/" + std::to_string(*crowded / 2) +
                           (*crowded % 2 == 0 ? "/start" : "/end"),
                 .got = static_cast<double>(count[*crowded]),
                 .limit = static_cast<double>(most),
                 .hint = "more members within reach of this end than one joint may have"});
  std::ranges::sort(out, [](const Touch& a, const Touch& b) {
    return a.end != b.end ? a.end < b.end : a.other < b.other;
  });
  return out;
}

Result<std::vector<std::optional<Touch>>> nearest_touches(std::span<const AxisSegment> segments,
                                                          const std::vector<bool>& ends) {
  std::vector<std::optional<Touch>> out(ends.size());
  const auto share = [&](const Touch& touch) {
    return touch.near.distance / segments[touch.other].reach;
  };
  TRY(for_touches(segments, [&](const Touch& touch) {
    auto& nearest = out[touch.end];
    if (ends[touch.end] && (!nearest || share(touch) < share(*nearest))) nearest = touch;
    return true;
  }));
  return out;
}

}  // namespace tubecut::joint
