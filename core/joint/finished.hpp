#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <optional>
#include <vector>

#include "core/joint/node/node_parts.hpp"
#include "core/joint/node/outline.hpp"
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

/// A generator by its distance from the axis and its side, a unit vector across the axis.
struct Line {
  double rho;
  Eigen::Vector3d q;
};

/// What takes the place of the two radii in a section.
struct FinishedSection {
  section::Curve curve;
  Outline outside, bore;
  Eigen::Vector3d x, y;  // of its height and width

  /// Returns a vector's components across the axis.
  [[nodiscard]] Eigen::Vector2d across(const Eigen::Vector3d& v) const {
    return {v.dot(x), v.dot(y)};
  }
};

/// A member after its ends are cut, its axis from the start. Lengths in mm.
///
/// Generators of the wall are named by phi and rho. In a section phi is the share of the girth in
/// rad, and rho how deep they are below the outside: `outer` less that depth.
struct Finished {
  Eigen::Vector3d start, axis;
  double length, inner,
      outer;  // of a section: reach less the thickest place of its wall; its reach
  FinishedEnd first, last;
  std::optional<FinishedSection> section = {};

  /// Returns a generator of the wall.
  [[nodiscard]] Line line(double phi, double rho) const {
    return section ? on_section(phi, rho) : Line{rho, side(phi)};
  }
  /// Returns how far a turn by one rad moves it, at most.
  [[nodiscard]] double turn_of(double rho) const {
    return section ? section->curve.girth() / kTwoPi : rho;
  }
  /// Returns the largest distance of the generators of a bundle from its middle one.
  [[nodiscard]] double bundle_reach(double rho, double half_rho, double half_phi) const;
  /// Returns true if all generators within `off` are in the bore, or less than `keep` outside it;
  /// always false for a round tube, whose `inner` says that.
  [[nodiscard]] bool in_bore(const Line& line, double off, double keep) const;
  /// Returns the radius of a cylinder that lies in the bore.
  [[nodiscard]] double free_radius() const {
    return section ? std::min(section->bore.half_height, section->bore.half_width) : inner;
  }
  /// Returns how far the outside reaches from the axis in a direction.
  [[nodiscard]] double support(const Eigen::Vector3d& direction) const;
  /// Returns how deep a point is below the endless outside.
  [[nodiscard]] double below(const Eigen::Vector3d& point) const;

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
  [[nodiscard]] Eigen::Vector3d point(const Line& line, double z) const {
    return point(line.rho, line.q, z);
  }

 private:
  [[nodiscard]] Line on_section(double phi, double rho) const;
};

[[nodiscard]] Finished finished(const NodeSpec& spec, const Nodes& nodes, std::size_t member,
                                const Beside& beside);

/// Overlap of less depth is not reported, because the verification of two cuts tolerates as much.
inline constexpr double kLeastShared = 0.01;  // mm

/// Returns the centre of a ball of diameter `kLeastShared` that fits into both walls; empty when
/// there is none. The generators of the thinner member are divided into cells. If no generator of a
/// cell's bundle can lie in the other's wall between its ends, by the closed form of line and
/// cylinder, the cell is dropped. If its middle lies there, it is the answer. Otherwise it is
/// divided. Walls that touch along a surface are excluded beforehand by the distance of the axes,
/// by the planes of their ends, and of sections by their faces.
///
/// Accuracy  decided within kLeastShared. Beyond kMostCells, the rest counts as clear: such walls
///           are nearer to each other than about 0.02 mm over most of their length.
/// Cost      5 us if the axes are far from each other, 0.1 ms for walls 1 mm from each other, at
///           most 10 ms.
/// Source    docs/theory/intersections-and-bevels.md, section 1.4.
[[nodiscard]] std::optional<Eigen::Vector3d> shared_metal(const Finished& a, const Finished& b);
inline constexpr std::size_t kMostCells = 30'000;

}  // namespace tubecut::joint::detail
