#pragma once

#include <Eigen/Core>
#include <span>
#include <variant>

#include "core/base/angle.hpp"
#include "core/bevel/table/zones.hpp"
#include "core/joint/stations.hpp"

namespace tubecut::bevel {

/// The angle between the two surfaces in which the groove is measured.
enum class Dihedral {
  weld_side,    // between the surfaces outside both tubes; root on the inner wall. The correct one
  inside,       // between the outward normals; root on the outer wall, groove opening inwards
  as_published  // inside, with source 000's wrong sign in gamma. Only for comparison
};

/// Groove angle: half the dihedral, at most the cap.
struct HalfDihedral {
  Angle cap = Angle::deg(45);
};
/// The same groove angle everywhere, >= 0.
struct FixedGroove {
  Angle angle = {};
};
/// No groove: the cut lies flush on the partner in the normal section.
struct NoGroove {};
/// The torch stays perpendicular to the axis: B = 0.
struct SquareCut {};
using GrooveRule = std::variant<HalfDihedral, FixedGroove, NoGroove, SquareCut, ZonedGroove>;

/// The range of B that the torch can reach.
struct TorchRange {
  Angle min = Angle::deg(-80);
  Angle max = Angle::deg(80);
};

/// The angles of one point of the cut, rad.
struct Angles {
  double dihedral = 0.0;  // of the requested kind, 0..pi
  double groove = 0.0;
  double tau = 0.0;    // theoretical angle, in the normal section
  double gamma = 0.0;  // of the curve against the circumference, -pi/2..pi/2
  double flush = 0.0;  // B that is flush with the partner in the axial plane
  double b = 0.0;      // elevation of the torch line above the radial direction, in the axial plane
};

/// A groove rule with precomputed sines and cosines.
class Rule {
 public:
  Rule(const GrooveRule& rule, Dihedral dihedral);

  /// Computes the angles where the partner's outward unit normal is `normal` = (radial, tangential,
  /// axial of the target), axial >= 0. For `as_published` it is joint::published_normal, whose
  /// tangential part has the paper's sign error.
  ///
  /// B > 0: for `weld_side` the outer edge of the cut is higher than the inner one; for the other
  /// two the inner edge is higher than the outer one. B is in (-90, 90] deg, but a fixed groove
  /// wider than the dihedral gives up to 180. If the axial part is 0 (a silhouette), B is +-90 with
  /// the sign of tau.
  /// Accuracy  1e-15 rad of the closed forms (dihedral, gamma, B).
  /// Cost      four arc tangents.
  /// Source    docs/theory/intersections-and-bevels.md, section 2.
  [[nodiscard]] Angles angles(const Eigen::Vector3d& normal) const;

  /// Computes the same for many points, vectorised, with the same bits. Not for a table of zones or
  /// `as_published`.
  void angles(const joint::Normals& normals, std::span<Angles> out) const;

 private:
  GrooveRule rule_;
  Dihedral dihedral_;
  double cos_limit_ = 0.0;  // of the cap or the fixed angle
  double sin_limit_ = 0.0;
  double limit_ = 0.0;
  Zones zones_;
};

}  // namespace tubecut::bevel
