#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/joint/finished.hpp"

namespace tubecut::joint::detail {
namespace {

using Eigen::Vector3d;

constexpr double kHalf = 0.5 * kLeastShared;  // of the ball that must fit into both
constexpr double kSmall = 0.5 * kHalf;        // mm: smaller cells are not divided
constexpr double kFar = 1e7;                  // mm: beyond every member
constexpr double kAlong =
    1e-9;  // sine: over 10 m the distance of the axes changes by less than 1e-5 mm
constexpr double kOpposite = 1e-12;              // of two unit normals, 1 + their product
constexpr int kAround = 16;                      // initial cells
constexpr std::size_t kBetweenStopChecks = 256;  // cells, about 50 us

struct Interval {
  double from, to;
  [[nodiscard]] bool empty() const { return !(from <= to); }
};

/// A bundle of generators of the thinner member, and a segment of them.
struct Cell {
  double phi, half_phi, rho, half_rho;
  Interval z;
};

/// A straight line relative to an axis: the squared distance is least^2 + sine^2 (z - at)^2.
struct Track {
  Vector3d beside, across;  // across the axis: of z = 0, and growing with z
  double along, rise;       // on the axis: of z = 0, and growing with z
  double sine, at, least;

  Track(const Vector3d& from, const Vector3d& direction, const Vector3d& axis)
      : along(from.dot(axis)), rise(direction.dot(axis)) {
    beside = from - along * axis;
    across = direction - rise * axis;
    sine = across.norm();
    at = sine > kAlong ? -beside.dot(across) / (sine * sine) : 0.0;
    least = (beside + at * across).norm();
  }
  /// Returns the interval within this distance of the axis; may be empty.
  [[nodiscard]] Interval within(double radius) const {
    if (!(least <= radius)) return {1.0, 0.0};
    if (!(sine > kAlong)) return {-kFar, kFar};
    const double half = std::sqrt((radius - least) * (radius + least)) / sine;
    return {at - half, at + half};
  }
  /// Returns the interval within an outline about the axis; may be empty.
  [[nodiscard]] Interval within(const Outline& outline, const FinishedSection& of) const {
    const auto from = of.across(beside);
    if (!(sine > kAlong))
      return !outline.empty() && outline.distance(from) <= 0.0 ? Interval{-kFar, kFar}
                                                               : Interval{1.0, 0.0};
    const auto chord = outline.chord(from, of.across(across));
    return {chord.from, chord.to};
  }
  /// Returns the intervals in the wall, on both sides of the bore, or one: of a line within `off`
  /// of this one, less half of the ball.
  [[nodiscard]] std::array<Interval, 2> in_wall(const Finished& m, double off, Interval z) const {
    Interval near{}, bore{1.0, 0.0};
    if (m.section) {
      near = within(m.section->outside.moved(off - kHalf), *m.section);
      bore = within(m.section->bore.moved(kHalf - off), *m.section);
    } else {
      near = within(m.outer - kHalf + off);
      if (const double inner = m.inner + kHalf - off; inner > 0.0) bore = within(inner);
    }
    z = {std::max(z.from, near.from), std::min(z.to, near.to)};
    if (bore.empty()) return {z, Interval{1.0, 0.0}};
    return {Interval{z.from, std::min(z.to, bore.from)}, Interval{std::max(z.from, bore.to), z.to}};
  }
};

/// Returns the part of the line whose position on the axis is between `low` and `high`.
Interval clip(const Track& line, Interval z, double low, double high) {
  if (std::abs(line.rise) <= kAlong) {
    const double slack = kAlong * (std::abs(z.from) + std::abs(z.to));
    const double there = line.along + line.rise * 0.5 * (z.from + z.to);
    return there + slack < low || there - slack > high ? Interval{1.0, 0.0} : z;
  }
  const double one = (low - line.along) / line.rise, two = (high - line.along) / line.rise;
  return {std::max(z.from, std::min(one, two)), std::min(z.to, std::max(one, two))};
}

/// A point in the other member: its generator, and the position along it.
struct Seen {
  double rho;
  Vector3d q;
};
Seen seen(const Finished& m, const Track& line, double z) {
  const Vector3d beside = line.beside + z * line.across;
  const double rho = beside.norm();
  return {rho, rho > 0.0 ? Vector3d(beside / rho) : m.side(0.0)};
}

/// The search of one pair: generators of `m` in the wall of `other`.
class Search {
 public:
  Search(const Finished& m, const Finished& other) : m_(m), other_(other) {
    curved_ = !other.first.seats.empty() || !other.last.seats.empty();
  }

  std::optional<Vector3d> run() {
    const double half = 0.5 * (m_.outer - m_.inner);
    for (int k = 0; k < kAround; ++k)
      cells_.push_back({kTwoPi * k / kAround,
                        kPi / kAround,
                        m_.inner + half,
                        std::max(0.0, half - kHalf),
                        {-kFar, kFar}});
    for (std::size_t next = 0; next < cells_.size() && next < kMostCells; ++next) {
      if (next % kBetweenStopChecks == 0 && stopped()) return std::nullopt;
      const auto cell = cells_[next];  // a copy, because the list grows
      if (auto found = check_cell(cell)) return found;
    }
    return std::nullopt;
  }

 private:
  std::optional<Vector3d> check_cell(const Cell& cell) {
    const double off = m_.bundle_reach(cell.rho, cell.half_rho, cell.half_phi);
    const auto generator = m_.line(cell.phi, cell.rho);
    if (m_.in_bore(generator, off, kHalf)) return std::nullopt;
    const auto& [rho, q] = generator;
    const Track line(m_.start + rho * q - other_.start, m_.axis, other_.axis);
    const auto own = m_.span(rho, q, {off, kHalf});
    const Interval z{std::max(cell.z.from, own.from), std::min(cell.z.to, own.to)};
    for (const auto& piece : line.in_wall(other_, off, z)) {
      if (piece.empty()) continue;
      const auto rest = between_ends(line, piece, off);
      if (rest.empty()) continue;
      const auto middle = on_middle(line, rho, q, rest);
      if (middle.found && !m_.in_bore(generator, 0.0, kHalf))
        return m_.point(rho, q, *middle.found);
      divide(cell, rest, line.sine, middle.in_wall);
    }
    return std::nullopt;
  }

  /// Returns an interval outside which every generator of the bundle is beyond the other's ends.
  [[nodiscard]] Interval between_ends(const Track& line, Interval z, double off) const {
    const double middle = 0.5 * (z.from + z.to), half = 0.5 * (z.to - z.from);
    const auto at = seen(other_, line, middle);
    const auto ends = other_.span(at.rho, at.q, {off + half * line.sine, kHalf});
    // A step across the one is a step along the other times the sine of their angle.
    return clip(line, z, ends.from - off * line.sine, ends.to + off * line.sine);
  }

  struct Middle {
    std::optional<double> found;  // z of a point in both
    bool in_wall = false;         // ignoring the other's ends
  };
  [[nodiscard]] Middle on_middle(const Track& line, double rho, const Vector3d& q,
                                 Interval z) const {
    const auto own = m_.span(rho, q, {0.0, kHalf});
    Middle out;
    for (const auto& piece :
         line.in_wall(other_, 0.0, {std::max(z.from, own.from), std::min(z.to, own.to)})) {
      if (piece.empty()) continue;
      out.in_wall = true;
      for (const double share : {0.5, 0.0, 1.0}) {
        const double there = piece.from + share * (piece.to - piece.from);
        const auto at = seen(other_, line, there);
        const auto ends = other_.span(at.rho, at.q, {0.0, kHalf});
        const double along = line.along + line.rise * there;
        if (along >= ends.from && along <= ends.to) {
          out.found = there;
          return out;
        }
      }
    }
    return out;
  }

  /// Divides the cell into two, across the longest side; along the generators only if the other's
  /// ends must be decided.
  void divide(const Cell& cell, Interval z, double sine, bool in_wall) {
    const double round = m_.turn_of(cell.rho) * cell.half_phi, across = cell.half_rho;
    const double along = curved_ ? 0.5 * (z.to - z.from) * sine : 0.0;
    if (std::max({round, across, along}) < kSmall) return;
    auto one = cell, two = cell;
    one.z = two.z = z;
    if (along > std::max(round, across) && (in_wall || along > 8.0 * std::max(round, across))) {
      one.z.to = two.z.from = 0.5 * (z.from + z.to);
    } else if (across > round) {
      one.half_rho = two.half_rho = 0.5 * across;
      one.rho -= 0.5 * across;
      two.rho += 0.5 * across;
    } else {
      one.half_phi = two.half_phi = 0.5 * cell.half_phi;
      one.phi -= one.half_phi;
      two.phi += two.half_phi;
    }
    cells_.push_back(one);
    cells_.push_back(two);
  }

  const Finished& m_;
  const Finished& other_;
  bool curved_;
  std::vector<Cell> cells_;
};

/// Returns z bounds of the member's metal.
Interval extent(const Finished& m) {
  const auto all = m.span(0.0, m.side(0.0), {m.outer, 0.0});
  return {std::max(-kFar, all.from), std::min(kFar, all.to)};
}

/// Returns true if they are clear of each other: side by side, one in the other's bore, or one
/// beyond the other's end.
bool clear_of(const Finished& m, Interval z, const Finished& other, Interval ends) {
  const Track axis(m.start - other.start, m.axis, other.axis);
  const auto from_axis = [&](double at) { return (axis.beside + at * axis.across).norm(); };
  const double least = from_axis(std::clamp(axis.at, z.from, z.to));
  if (least >= m.outer + other.outer - kLeastShared) return true;
  const double most = std::max(from_axis(z.from), from_axis(z.to));
  if (most + m.outer <= other.free_radius() + kLeastShared) return true;
  const double one = axis.along + axis.rise * z.from, two = axis.along + axis.rise * z.to;
  const double reach = m.outer * axis.sine;
  return std::max(one, two) + reach <= ends.from + kLeastShared ||
         std::min(one, two) - reach >= ends.to - kLeastShared;
}

/// Returns true if a plane along a section's face, or along both axes, has each on its own side.
bool beside(const Finished& m, Interval z, const Finished& other, Interval ends) {
  std::vector<Vector3d> directions{m.axis.cross(other.axis)};
  for (const auto* one : {&m, &other})
    if (one->section) {
      directions.push_back(one->section->x);
      directions.push_back(one->section->y);
    }
  return std::ranges::any_of(directions, [&](const Vector3d& along) {
    const double length = along.norm();
    if (!(length > kAlong)) return false;
    const Vector3d n = along / length;
    const double rise = m.axis.dot(n), other_rise = other.axis.dot(n);
    const double apart = (other.start - m.start).dot(n);
    const double thick = m.support(n) + other.support(n) - kLeastShared;
    const double low = apart + std::min(other_rise * ends.from, other_rise * ends.to) -
                       std::max(rise * z.from, rise * z.to);
    const double high = std::min(rise * z.from, rise * z.to) - apart -
                        std::max(other_rise * ends.from, other_rise * ends.to);
    return low >= thick || high >= thick;
  });
}

/// Returns true if all of `m` is in the bore of a section, also where it touches its faces: a
/// member is the hull of its edges' discs, and the bore is convex.
bool in_its_bore(const Finished& m, Interval z, const Finished& other) {
  if (!other.section) return false;
  std::vector<Vector3d> centers{Vector3d::Zero()};
  double radius = m.outer;
  if (m.section) {
    const auto& s = *m.section;
    radius = s.outside.corner;
    const double h = s.outside.half_height - radius, w = s.outside.half_width - radius;
    centers = {h * s.x + w * s.y, h * s.x - w * s.y, -h * s.x + w * s.y, -h * s.x - w * s.y};
  }
  return std::ranges::all_of(centers, [&](const Vector3d& center) {
    return std::ranges::all_of(std::array{z.from, z.to}, [&](double at) {
      const Vector3d p = m.start + at * m.axis + center - other.start;
      return other.section->bore.distance(other.section->across(p)) + radius <= kLeastShared;
    });
  });
}

/// A plane that cuts a member, in the world: its metal lies where normal . p >= from.
struct Kept {
  Vector3d normal;
  double from;
};
std::vector<Kept> planes(const Finished& m) {
  std::vector<Kept> out;
  for (const auto* end : {&m.first, &m.last})
    for (const auto& one : end->prepared)
      if (const auto* plane = std::get_if<PreparedPlane>(&one)) {
        const Vector3d normal = end->frame.rows.transpose() * plane->normal;
        out.push_back({normal, normal.dot(end->frame.origin) + plane->height * plane->normal.z()});
      }
  return out;
}

/// Returns true if one of the planes that cut `m` has all of the other on its other side.
bool parted(const Finished& m, const Finished& other, Interval z) {
  const auto others = planes(other);
  for (const auto& plane : planes(m)) {
    const double rise = plane.normal.dot(other.axis);
    const double across = std::sqrt(std::max(0.0, (1.0 - rise) * (1.0 + rise)));
    double most =
        plane.normal.dot(other.start) + std::max(rise * z.from, rise * z.to) + other.outer * across;
    for (const auto& one : others)
      if (1.0 + one.normal.dot(plane.normal) < kOpposite) most = std::min(most, -one.from);
    if (most <= plane.from + kLeastShared) return true;
  }
  return false;
}

}  // namespace

std::optional<Vector3d> shared_metal(const Finished& a, const Finished& b) {
  const auto on_a = extent(a), on_b = extent(b);
  if (on_a.empty() || on_b.empty()) return std::nullopt;
  if (clear_of(a, on_a, b, on_b) || clear_of(b, on_b, a, on_a)) return std::nullopt;
  if (parted(a, b, on_b) || parted(b, a, on_a)) return std::nullopt;
  if ((a.section || b.section) &&
      (beside(a, on_a, b, on_b) || in_its_bore(a, on_a, b) || in_its_bore(b, on_b, a)))
    return std::nullopt;
  return a.outer <= b.outer ? Search(a, b).run() : Search(b, a).run();
}

}  // namespace tubecut::joint::detail
