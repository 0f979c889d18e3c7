#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/joint/node/node_parts.hpp"
#include "core/joint/node/overlap.hpp"

/// For `overlaps` only: members as they are once cut.
namespace tubecut::joint::detail {

/// How far a search may be off: generators within `off` of the one that is asked for, and surfaces
/// that stand `keep` further into what is kept.
struct Slack {
  double off = 0.0, keep = 0.0;
};

/// One cut end: its frame, and the surfaces that cut it.
struct FinishedEnd {
  MemberFrame frame;
  std::vector<Cutter> seats;
  std::vector<PreparedCutter> prepared;  // of the same order

  /// z into the member where the generator on the side `q` leaves the seats; the work point where
  /// nothing cuts it.
  [[nodiscard]] double top(double rho, const Eigen::Vector3d& q) const;

  /// No generator within the slack begins below this z; without slack, where this one begins.
  /// Accuracy  a bound, within some `off` of the least value; -infinity by a silhouette of a seat
  ///           that is neither a tube nor a plane.
  [[nodiscard]] double begins(double rho, const Eigen::Vector3d& q, const Slack& slack) const;
};

/// A member as it is once cut, its axis from the start. Lengths in mm.
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
  /// That no generator within the slack leaves; all of them, of `rho` 0 and `off` the radius.
  [[nodiscard]] Span span(double rho, const Eigen::Vector3d& q, const Slack& slack) const {
    return {first.begins(rho, q, slack), length - last.begins(rho, q, slack)};
  }
  /// A side of the member: a unit vector across its axis.
  [[nodiscard]] Eigen::Vector3d side(double phi) const;
  [[nodiscard]] Eigen::Vector3d point(double rho, const Eigen::Vector3d& q, double z) const {
    return start + z * axis + rho * q;
  }
};

[[nodiscard]] Finished finished(const NodeSpec& spec, const Nodes& nodes, std::size_t member,
                                const Beside& beside);

/// Metal of less depth is not told: the proofs of two cuts may share as much.
inline constexpr double kLeastShared = 0.01;  // mm

/// The centre of a ball of diameter `kLeastShared` that fits into both walls; empty where there is
/// none. The generators of the thinner member are divided into cells. One whose generators, as a
/// bundle as wide as the cell, nowhere lie in the other's wall between its ends is left out, by
/// the closed form of line and cylinder; one whose middle lies there is the answer; any other is
/// divided. Walls that touch along a surface are told apart beforehand by the distance of the axes
/// and by the planes of their ends.
///
/// Accuracy  decided within kLeastShared; beyond kMostCells what is left is taken as clear: such
///           walls are nearer to each other than about 0.02 mm over most of their length.
/// Cost      5 us where axes are well apart, 0.1 ms for walls 1 mm apart, at most 10 ms.
/// Source    docs/theory/intersections-and-bevels.md, section 1.4.
[[nodiscard]] std::optional<Eigen::Vector3d> shared_metal(const Finished& a, const Finished& b,
                                                          const std::stop_token& stop);
inline constexpr std::size_t kMostCells = 30'000;

}  // namespace tubecut::joint::detail
