#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "api/formats/step/wall_curve.hpp"
#include "api/formats/step/wall_spline.hpp"

namespace tubecut::api {

/// A cut of a tube: both ends go round it, holes do not.
struct TubeCut {
  enum class Kind { start, finish, hole };
  Kind kind = Kind::start;
  std::string name;
  std::variant<double, WallCurve> shape;  // z of a plane square to the axis, or a cut wall
};

/// A closed solid by its boundary: vertices, edges shared by two faces each, faces.
struct TubeSolid {
  struct Line {};
  struct Arc {
    double radius = 0.0, z = 0.0;  // counter-clockwise about z
  };
  /// From knot to knot of one edge of a cut wall.
  struct EdgeSpan {
    std::size_t wall = 0, edge = 0, from = 0, to = 0;
  };
  struct Edge {
    std::size_t from = 0, to = 0;
    std::variant<Line, Arc, EdgeSpan> curve;
  };
  /// Edges head to tail, the face to the left as seen from outside; false: against its direction.
  using Loop = std::vector<std::pair<std::size_t, bool>>;
  /// A half, whose surface begins on the other side, because readers split a cylinder there.
  struct Cylinder {
    double radius = 0.0;
    double begins = 0.0;  // phi
  };
  struct Plane {
    double z = 0.0;
  };
  /// Ruled from an edge of a cut wall to the next one out.
  struct Ruled {
    std::size_t wall = 0, edge = 0, from = 0, to = 0;
  };
  struct Face {
    std::string name;
    std::variant<Cylinder, Plane, Ruled> surface;
    bool same = true;         // the surface's own normal points out of the solid
    bool cut = false;         // else a wall of the tube
    std::vector<Loop> loops;  // the outer one first
  };
  double wall = 0.0;  // mm
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Edge> edges;
  std::vector<Face> faces;
  std::vector<WallSpline> walls;
};

/// Returns the tube's wall between a start and a finish, without the holes; no two cuts may meet.
/// Each cylinder is two faces that meet at the same two phases, away from holes if possible.
[[nodiscard]] TubeSolid tube_solid(double inner, double outer, const std::vector<TubeCut>& cuts);

}  // namespace tubecut::api
