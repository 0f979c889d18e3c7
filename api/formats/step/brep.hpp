#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace tubecut::api {

/// A closed solid by its boundary, of planes, cylinders, cones and ruled patches. Lengths in mm.
struct Brep {
  using Points = std::vector<Eigen::Vector3d>;  // two of a line, four of a cubic

  /// Directions are unit vectors. An edge runs from `begins` the way that is positive about `axis`.
  struct Circle {
    Eigen::Vector3d centre, axis, begins;
    double radius = 0.0;
  };
  struct Edge {
    std::size_t from = 0, to = 0;
    Points curve;
    std::optional<Circle> circle = {};  // instead of the curve
  };
  /// Edges head to tail, the face to the left as seen from outside; false: against its direction.
  using Loop = std::vector<std::pair<std::size_t, bool>>;
  struct Plane {
    Eigen::Vector3d point, normal;  // outwards
  };
  /// A cylinder along z.
  struct Cylinder {
    Eigen::Vector2d centre;
    double radius = 0.0;
    double begins = 0.0;  // phi, outside the face
  };
  /// A cylinder along any axis; its parameter begins outside the face.
  struct Bore {
    Eigen::Vector3d centre, axis, begins;
    double radius = 0.0;
  };
  /// A cone that widens along `axis`, of this radius at `centre`; its parameter begins outside the
  /// face.
  struct Cone {
    Eigen::Vector3d centre, axis, begins;
    double radius = 0.0, half = 0.0;  // half: rad, between axis and side
  };
  /// Ruled between two curves with as many points.
  struct Patch {
    Points inner, outer;
  };
  struct Face {
    std::string name;
    std::variant<Plane, Cylinder, Patch, Bore, Cone> surface;
    bool same = true;  // the surface's own normal points out of the solid
    bool cut = false;  // else a wall of the tube
    std::vector<Loop> loops;
  };
  double wall = 0.0;  // the thinnest
  Points vertices;
  std::vector<Edge> edges;
  std::vector<Face> faces;
};

}  // namespace tubecut::api
