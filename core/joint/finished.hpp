#pragma once

#include <Eigen/Core>
#include <cmath>
#include <optional>
#include <vector>

#include "core/joint/node/node_parts.hpp"
#include "core/joint/node/overlap.hpp"

/// For `overlaps` only: members after their ends are cut.
namespace tubecut::joint::detail {

/// The tolerance of a search: generators within `off` of the given one, and surfaces `keep` further
/// into the kept part.
struct Slack {
  double off = 0.0, keep = 0.0;
};

/// One cut end: its frame, and the surfaces that cut it.
struct FinishedEnd {
  MemberFrame frame;
  std::vector<Cutter> seats;
  std::vector<PreparedCutter> prepared;  // in the same order

  /// Returns z into the member where the generator on the side `q` leaves the seats; the work point
  /// if nothing cuts it.
  [[nodiscard]] double top(double rho, const Eigen::Vector3d& q) const;

  /// Returns a z below which no generator within the slack begins; without slack, the begin of this
  /// one.
  /// Accuracy  a bound, within some `off` of the minimum; -infinity near a silhouette of a seat
  ///           that is neither a tube nor a plane.
  [[nodiscard]] double begins(double rho, const Eigen::Vector3d& q, const Slack& slack) const;
};

/// A member after its ends are cut, its axis from the start. Lengths in mm.
struct Finished {
  Eigen::Vector3d start, axis;
  double length, inner, outer;
  FinishedEnd first, last;

  struct Span {
    double from, to;
  };
  [[nodiscard]] Span span(double rho, const Eigen::Vector3d& q) const {
    return {first.top(rho, q), length - last.top(rho, q)};
  }
  /// Returns a span that no generator within the slack leaves; for all generators, `rho` is 0 and
  /// `off` the radius.
  [[nodiscard]] Span span(double rho, const Eigen::Vector3d& q, const Slack& slack) const {
    return {first.begins(rho, q, slack), length - last.begins(rho, q, slack)};
  }
  /// Returns a side of the member: a unit vector across its axis.
  [[nodiscard]] Eigen::Vector3d side(double phi) const;
  [[nodiscard]] Eigen::Vector3d point(double rho, const Eigen::Vector3d& q, double z) const {
    return start + z * axis + rho * q;
  }
};

[[nodiscard]] Finished finished(const NodeSpec& spec, const Nodes& nodes, std::size_t member,
                                const Beside& beside);

/// Returns the largest distance of the generators of a bundle from its middle one.
[[nodiscard]] inline double bundle_reach(double rho, double half_rho, double half_phi) {
  return std::sqrt(half_rho * half_rho + rho * (rho + half_rho) * half_phi * half_phi);
}

/// Overlap of less depth is not reported, because the verification of two cuts tolerates as much.
inline constexpr double kLeastShared = 0.01;  // mm

/// Returns the centre of a ball of diameter `kLeastShared` that fits into both walls; empty when
/// there is none. The generators of the thinner member are divided into cells. If no generator of a
/// cell's bundle can lie in the other's wall between its ends, by the closed form of line and
/// cylinder, the cell is dropped. If its middle lies there, it is the answer. Otherwise it is
/// divided. Walls that touch along a surface are excluded beforehand by the distance of the axes
/// and by the planes of their ends.
///
/// Accuracy  decided within kLeastShared. Beyond kMostCells, the rest counts as clear: such walls
///           are nearer to each other than about 0.02 mm over most of their length.
/// Cost      5 us if the axes are far from each other, 0.1 ms for walls 1 mm from each other, at
///           most 10 ms.
/// Source    docs/theory/intersections-and-bevels.md, section 1.4.
[[nodiscard]] std::optional<Eigen::Vector3d> shared_metal(const Finished& a, const Finished& b,
                                                          const std::stop_token& stop);
inline constexpr std::size_t kMostCells = 30'000;

}  // namespace tubecut::joint::detail
