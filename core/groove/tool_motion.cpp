#include "core/groove/tool_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/elementary.hpp"

namespace tubecut::groove {
namespace {

constexpr double kNear = 0.25 * kTwoPi;  // tools further around than this do not reach a ruling
// Steps of a golden section between two blocks. The flank's minimum is a parabola, the finite
// cutter's may be a corner.
constexpr int kSmoothSteps = 21;  // accurate to 4e-5 of a block
constexpr int kCornerSteps = 37;  // accurate to 2e-8 of a block
constexpr double kRounding =
    1e-9;  // mm, of a distance; far above the actual rounding at any permitted size

/// A tool with the direction of its section.
struct Station {
  Direction dir;
  ToolPose pose;

  [[nodiscard]] Eigen::Vector3d seen(const WorkPoint& p) const {
    return {p.s * (p.dir.cos * dir.cos + p.dir.sin * dir.sin),
            p.s * (p.dir.sin * dir.cos - p.dir.cos * dir.sin), p.z};
  }
};

Station station_of(const Block& block, const Setup& setup) {
  const auto [s, c] = elementary::sincos(block.omega);
  return {{s, c}, pose_of(block, setup)};
}

/// Returns the first of the smallest of the first `count` values.
Eigen::Index least_of(const Eigen::ArrayXd& values, Eigen::Index count) {
  const double least = values.head(count).minCoeff();
  Eigen::Index i = 0;
  while (values[i] != least) ++i;
  return i;
}

/// Returns a lower bound along a line whose ends have distances `a` and `b` and slopes there,
/// because no tangent of a convex function rises above it.
double above_tangents(double a, double slope_a, double b, double slope_b) {
  if (slope_a >= 0.0) return a;
  if (slope_b <= 0.0) return b;
  const double share = (b - slope_b - a) / (slope_a - slope_b);
  return std::min(a + share * slope_a, std::min(a, b));
}

}  // namespace

ToolMotion::ToolMotion(const Cone& cone, const Setup& setup, std::span<const Block> blocks,
                       Between between)
    : cone_(cone), setup_(setup), blocks_(blocks), between_(between) {
  const auto n = Eigen::Index(blocks.size());
  for (auto* const values : {&sin_, &cos_, &tip_s_, &tip_z_, &axis_s_, &axis_z_})
    values->resize(2 * n);
  for (auto* const values : {&ahead_, &aside_, &rho_, &along_, &distance_}) values->resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Station at = station_of(blocks[std::size_t(i)], setup);
    for (const Eigen::Index k : {i, i + n}) {
      sin_[k] = at.dir.sin;
      cos_[k] = at.dir.cos;
      tip_s_[k] = at.pose.tip.x();
      tip_z_[k] = at.pose.tip.y();
      axis_s_[k] = at.pose.axis.x();
      axis_z_[k] = at.pose.axis.y();
    }
  }
}

void ToolMotion::select_ruling(double omega, Direction dir) {
  const auto n = Eigen::Index(blocks_.size());
  const auto first_at = [&](double from) {
    const double turns = std::floor(from / kTwoPi);
    const auto found =
        std::lower_bound(blocks_.begin(), blocks_.end(), from - turns * kTwoPi,
                         [](const Block& b, double value) { return b.omega < value; });
    return Eigen::Index(found - blocks_.begin()) + Eigen::Index(turns) * n;
  };
  const Eigen::Index from = first_at(omega - kNear);
  count_ = first_at(omega + kNear) - from;
  first_ = (from % n + n) % n;
  const auto sin = sin_.segment(first_, count_), cos = cos_.segment(first_, count_);
  ahead_.head(count_) = dir.cos * cos + dir.sin * sin;
  aside_.head(count_) = dir.sin * cos - dir.cos * sin;
}

Least ToolMotion::at_blocks(const WorkPoint& p, Part part) {
  if (count_ == 0) return {std::numeric_limits<double>::infinity(), 0.0};
  const auto window = [this](const Eigen::ArrayXd& values) {
    return values.segment(first_, count_);
  };
  const auto ahead = p.s * ahead_.head(count_) - window(tip_s_);
  const auto up = p.z - window(tip_z_);
  rho_.head(count_) = ((ahead * window(axis_z_) - up * window(axis_s_)).square() +
                       (p.s * aside_.head(count_)).square())
                          .sqrt();
  along_.head(count_) = ahead * window(axis_s_) + up * window(axis_z_);
  distance_.head(count_) =
      (rho_.head(count_) - cone_.tip_radius) * cone_.cos_k - along_.head(count_) * cone_.sin_k;
  if (part == Part::solid) return least_solid();
  const Eigen::Index i = least_of(distance_, count_);
  return {distance_[i], double((first_ + i) % Eigen::Index(blocks_.size()))};
}

/// The planes of the flank and both faces bound the cutter, so its distance is at least the largest
/// of theirs: it is computed only if that is below the minimum so far.
Least ToolMotion::least_solid() {
  const auto along = along_.head(count_);
  distance_.head(count_) = distance_.head(count_).max(-along).max(along - cone_.length);
  const auto solid = [this](Eigen::Index i) { return cone_.solid(rho_[i], along_[i]); };
  const double enough = solid(least_of(distance_, count_)) + kRounding;
  Least best{std::numeric_limits<double>::infinity(), 0.0};
  for (Eigen::Index i = 0; i < count_; ++i) {
    if (distance_[i] > enough) continue;
    const double d = solid(i);
    if (d < best.value) best = {d, double((first_ + i) % Eigen::Index(blocks_.size()))};
  }
  return best;
}

double ToolMotion::distance(const WorkPoint& point, Part part, double t) const {
  const Station at = station_of(block_at(blocks_, t), setup_);
  const Eigen::Vector3d p = at.seen(point);
  return part == Part::flank ? cone_.flank(at.pose, p) : cone_.solid(at.pose, p);
}

Least ToolMotion::by_golden_section(const WorkPoint& point, Part part, double low) const {
  constexpr double kGolden = 0.6180339887498949;
  const auto at = [&](double t) { return Least{distance(point, part, t), t}; };
  double high = low + 1.0;
  Least left = at(high - kGolden * (high - low)), right = at(low + kGolden * (high - low));
  for (int i = 0; i < (part == Part::flank ? kSmoothSteps : kCornerSteps); ++i) {
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

Least ToolMotion::over_motion(const WorkPoint& point, Part part) {
  Least best = at_blocks(point, part);
  if (between_ == Between::nothing) return best;
  // One by one, because the motion has a corner at the block.
  const double block = best.station;
  for (const double low : {block - 1.0, block}) {
    const Least found = by_golden_section(point, part, low);
    if (found.value < best.value) best = found;
  }
  return best;
}

ToolMotion::ToolFramePoint ToolMotion::in_tool_frame(const WorkPoint& point, Part part,
                                                     double t) const {
  const Station at = station_of(block_at(blocks_, t), setup_);
  const Eigen::Vector3d p = at.seen(point);
  const auto [rho, l, across] = Cone::meridian(at.pose, p);
  const Cone::Rise rise = part == Part::flank ? cone_.flank_rise() : cone_.solid_rise(rho, l);
  const double out = rho > 0.0 ? rise.by_rho / rho : 0.0;  // on the axis, 0 is a subgradient
  return {{across, p.y(), l},
          {out * across, out * p.y(), rise.by_l},
          part == Part::flank ? cone_.flank(rho, l) : cone_.solid(rho, l),
          p - Eigen::Vector3d(at.pose.tip.x(), 0.0, at.pose.tip.y()),
          p.x(),
          at.pose.axis};
}

ToolMotion::Step ToolMotion::step_from(double block) const {
  const auto n = double(blocks_.size());
  const auto i = std::size_t(block - n * std::floor(block / n));
  const Block &a = blocks_[i], &b = blocks_[(i + 1) % blocks_.size()];
  return {b.omega - a.omega + (i + 1 == blocks_.size() ? kTwoPi : 0.0), b.x - a.x, b.z - a.z,
          b.b - a.b};
}

/// Computes the velocity of the point in the tool's frame, per block: the ruling turns against the
/// section, the pivot runs straight, the axis tilts.
Eigen::Vector3d ToolMotion::velocity(const ToolFramePoint& at, const Step& step) const {
  const double sign = setup_.mount == Mount::end_up ? -1.0 : 1.0;
  const Eigen::Vector2d& axis = at.axis;
  const Eigen::Vector2d lean = sign * step.lean * Eigen::Vector2d(axis.y(), -axis.x());
  const double s = at.at.y() * step.turn - step.x + setup_.pivot_length * lean.x();
  const double z = -sign * step.z + setup_.pivot_length * lean.y();
  const double from_s = at.from_tip.x(), from_z = at.from_tip.z();
  return {s * axis.y() + from_s * lean.y() - z * axis.x() - from_z * lean.x(),
          -at.ahead * step.turn,
          s * axis.x() + from_s * lean.x() + z * axis.y() + from_z * lean.y()};
}

/// Returns a bound of the acceleration, per square of a block, of a point in the tool's frame.
double ToolMotion::acceleration(const WorkPoint& point, const ToolFramePoint& at_one_end,
                                const Step& step) const {
  const double lean = std::abs(step.lean), turn = step.turn;
  const double way = std::abs(step.x) + std::abs(step.z) + turn * point.s;
  const double arm = at_one_end.at.norm() + setup_.pivot_length + way;
  return lean * lean * arm + 2.0 * lean * way + turn * turn * point.s;
}

/// Returns a lower bound of the second derivative of the flank's distance, per square of a block,
/// between two places at one block's distance: the point's path past the axis bends its distance
/// from that, and its acceleration removes at most its whole magnitude. Returns at most 0 if there
/// is no bound.
double ToolMotion::bend(const ToolFramePoint& from, const ToolFramePoint& to,
                        double acceleration) const {
  const Eigen::Vector2d line = to.at.head<2>() - from.at.head<2>();
  const Eigen::Vector2d half_way = 0.5 * (to.at.head<2>() + from.at.head<2>());
  const double rho = half_way.norm(), apart = 0.5 * line.norm() + acceleration / 8.0;
  if (!(apart < rho)) return 0.0;
  const double past = std::abs(half_way.x() * line.y() - half_way.y() * line.x()) / rho;
  const double turned = 2.0 * apart / (2.0 * rho - apart);  // of the direction from the axis
  const double off = 0.5 * acceleration;                    // of the velocity
  const double slowest = past - off - turned * (line.norm() + off);
  if (!(slowest > 0.0)) return 0.0;
  return cone_.cos_k * slowest * slowest / (rho + apart) - acceleration;
}

void ToolMotion::search_between(const WorkPoint& point, Part part, const ToolFramePoint& here,
                                double from, double to, LeastRange& out) const {
  const Step step = step_from(std::min(from, to));
  const ToolFramePoint there = in_tool_frame(point, part, to);
  const double most = acceleration(point, here, step), ahead = to - from;
  const double down = ahead * here.slope.dot(velocity(here, step));
  const double up = ahead * there.slope.dot(velocity(there, step));
  const double bent = part == Part::flank ? bend(here, there, most) : 0.0;
  if (bent > 0.0 && down >= 0.0) return;
  const double share = down < 0.0 && up > 0.0 ? std::clamp(down / (down - up), 0.05, 0.95) : 0.5;
  const double station = from + share * ahead;
  const ToolFramePoint middle = in_tool_frame(point, part, station);
  if (middle.distance < out.met.value) out.met = {middle.distance, station};
  if (bent > 0.0) {
    const double slope = middle.slope.dot(velocity(middle, step));
    out.low = std::min(out.low, middle.distance - 0.5 * slope * slope / bent);
    return;
  }
  const auto above = [most](const ToolFramePoint& a, const ToolFramePoint& b,
                            double part_of_block) {
    const Eigen::Vector3d way = b.at - a.at;
    return above_tangents(a.distance, a.slope.dot(way), b.distance, b.slope.dot(way)) -
           most * part_of_block * part_of_block / 8.0;
  };
  out.low = std::min({out.low, above(here, middle, share), above(middle, there, 1.0 - share)});
}

LeastRange ToolMotion::range(const WorkPoint& point, Part part, const Least& best) const {
  LeastRange out{best.value, best};
  if (between_ == Between::nothing) return out;
  const ToolFramePoint here = in_tool_frame(point, part, best.station);
  for (const double to : {best.station - 1.0, best.station + 1.0})
    search_between(point, part, here, best.station, to, out);
  return out;
}

}  // namespace tubecut::groove
