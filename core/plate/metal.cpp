#include "core/plate/metal.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/base/elementary.hpp"
#include "core/plate/web.hpp"

namespace tubecut::plate {
namespace {

using cutout::Chain;
using cutout::Flat;
using Eigen::Vector3d;

constexpr double kInset = 1.5 * kLeastPlates;  // mm: of the outermost lines below a surface
constexpr double kSamePlane = 1e-6;            // sine of the planes' angle
constexpr int kHeights = 5;                    // of lines in a plate

using Interval = std::pair<double, double>;
using Intervals = std::vector<Interval>;

/// Returns the parts of `from` outside of `what`; both ascend.
Intervals without(const Intervals& from, const Intervals& what) {
  Intervals out;
  for (auto rest : from) {
    for (const auto& [low, high] : what) {
      if (high <= rest.first || low >= rest.second) continue;
      if (low > rest.first) out.emplace_back(rest.first, low);
      rest.first = high;
    }
    if (rest.first < rest.second) out.push_back(rest);
  }
  return out;
}

/// A plate seen along a direction of its plane: its places are `across` that direction and along
/// it.
class Seen {
 public:
  Seen(const Metal& metal, const Vector3d& along) : metal_(metal), along_(along) {
    const auto& frame = metal.plate().frame;
    across_ = along.cross(Vector3d(frame.rows.row(2)));
    const Flat to = (frame.rows * along).head<2>();
    const double turn = 0.5 * kPi - elementary::atan2(to.y(), to.x());
    outline_ = cutout::turned(metal.plate().outline, turn);
    for (const auto& hole : metal.plate().holes) holes_.push_back(cutout::turned(hole.chain, turn));
    bounds_ = cutout::bounds(outline_);
  }

  [[nodiscard]] const Vector3d& across() const { return across_; }
  [[nodiscard]] Interval width() const { return {bounds_.least.x(), bounds_.most.x()}; }
  [[nodiscard]] std::vector<double> corners() const {
    std::vector<double> out;
    for (const auto& s : outline_) out.push_back(s.from.x());
    return out;
  }
  [[nodiscard]] Vector3d place(double across, double height) const {
    const auto& frame = metal_.plate().frame;
    return frame.origin + height * Vector3d(frame.rows.row(2)) + across * across_;
  }
  /// Returns the metal on the line through a point of the world, from that point on.
  [[nodiscard]] Intervals on_line(const Vector3d& point) const {
    const auto& frame = metal_.plate().frame;
    const double height = frame.local(point).z();
    if (height >= 0.0 || height <= -metal_.thickness()) return {};
    const Vector3d from = point - frame.origin;
    const double across = from.dot(across_), start = from.dot(along_);
    Intervals out = cutout::stretches(outline_, across);
    for (const auto& hole : holes_) out = without(out, cutout::stretches(hole, across));
    for (auto& [low, high] : out) low -= start, high -= start;
    return out;
  }

 private:
  const Metal& metal_;
  Vector3d along_, across_;
  Chain outline_;
  std::vector<Chain> holes_;
  cutout::Bounds bounds_;
};

/// Returns places of an interval: near both ends, and evenly between them.
std::vector<double> places(const Interval& of, int count) {
  const double low = of.first + kInset, high = of.second - kInset;
  if (!(low < high)) return {0.5 * (of.first + of.second)};
  std::vector<double> out;
  for (int k = 0; k < count; ++k) out.push_back(low + (high - low) * k / (count - 1));
  return out;
}

/// The search on lines in the plate `a`.
class Search {
 public:
  Search(const Metal& a, const Metal& b, const Vector3d& along)
      : a_(a), b_(b), along_(along), on_a_(a, along), on_b_(b, along) {}

  void run(SharedPlace& out) const {
    for (const double height : places({-a_.thickness(), 0.0}, kHeights))
      for (const double across : lines(height)) see(on_a_.place(across, height), out);
  }

 private:
  /// Returns where the lines lie at a height of `a` that are within the thickness of `b`.
  [[nodiscard]] std::vector<double> lines(double height) const {
    const Vector3d n = b_.plate().frame.rows.row(2);
    const double at = b_.plate().frame.local(on_a_.place(0.0, height)).z();
    const double rise = n.dot(on_a_.across());
    auto range = on_a_.width();
    if (std::abs(rise) > kSamePlane) {
      const auto [low, high] = std::minmax({-at / rise, (-b_.thickness() - at) / rise});
      range = {std::max(range.first, low), std::min(range.second, high)};
    }
    if (!(range.first < range.second)) return {};
    auto out = places(range, static_cast<int>(std::lround(1.0 / kBetweenLines)) + 1);
    for (const double corner : on_a_.corners())
      for (const double by : {-kInset, kInset})
        if (corner + by > range.first && corner + by < range.second) out.push_back(corner + by);
    return out;
  }

  void see(const Vector3d& point, SharedPlace& out) const {
    const auto own = on_a_.on_line(point);
    if (own.empty()) return;
    for (const auto& [low, high] : on_b_.on_line(point))
      for (const auto& [from, to] : own) {
        const Interval both{std::max(low, from), std::min(high, to)};
        if (!(both.first < both.second)) continue;
        for (const double at : places(both, kHeights)) {
          const Vector3d p = point + at * along_;
          const double depth =
              std::min(a_.depth(a_.plate().frame.local(p)), b_.depth(b_.plate().frame.local(p)));
          if (depth > out.depth) out = {depth, p};
        }
      }
  }

  const Metal& a_;
  const Metal& b_;
  Vector3d along_;
  Seen on_a_, on_b_;
};

}  // namespace

Metal::Metal(const Plate& plate, double thickness) : plate_(plate), thickness_(thickness) {
  for (const auto& hole : plate.holes) boxes_.push_back(cutout::bounds(hole.chain));
  const auto flat = cutout::bounds(plate.outline);
  const auto world = [&](double x, double y, double z) {
    return Vector3d(plate.frame.origin + plate.frame.rows.transpose() * Vector3d(x, y, z));
  };
  low_ = high_ = world(flat.least.x(), flat.least.y(), 0.0);
  for (const double x : {flat.least.x(), flat.most.x()})
    for (const double y : {flat.least.y(), flat.most.y()})
      for (const double z : {0.0, -thickness}) {
        low_ = low_.cwiseMin(world(x, y, z));
        high_ = high_.cwiseMax(world(x, y, z));
      }
}

bool Metal::near(const Metal& other) const {
  return (low_.array() < other.high_.array()).all() && (other.low_.array() < high_.array()).all();
}

double Metal::depth(const Vector3d& p) const {
  double out = std::min(-p.z(), p.z() + thickness_);
  const Flat flat = p.head<2>();
  if (out <= 0.0 || !encloses(plate_.outline, flat)) return -1.0;
  out = std::min(out, cutout::distance(plate_.outline, flat));
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    if (box_gap(boxes_[i], {flat, flat}) >= out) continue;
    if (encloses(plate_.holes[i].chain, flat)) return -1.0;
    out = std::min(out, cutout::distance(plate_.holes[i].chain, flat));
  }
  return out;
}

std::optional<SharedPlace> shared_metal(const Metal& a, const Metal& b) {
  if (!a.near(b)) return std::nullopt;
  const auto& rows = a.plate().frame.rows;
  const Vector3d line = rows.row(2).cross(b.plate().frame.rows.row(2));
  const Vector3d along =
      line.norm() > kSamePlane ? Vector3d(line.normalized()) : Vector3d(rows.row(0));
  SharedPlace out;
  Search(a, b, along).run(out);
  Search(b, a, along).run(out);
  return out.depth > kLeastPlates ? std::optional(out) : std::nullopt;
}

}  // namespace tubecut::plate
