#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "api/formats/step/brep.hpp"
#include "core/cutout/chain.hpp"

namespace tubecut::api {

/// A line or an arc of at most half a turn, with the metal to its left as seen from outside.
struct WallStroke {
  cutout::Flat from, to;
  cutout::Flat centre = cutout::Flat::Zero(), middle = cutout::Flat::Zero();  // of an arc
  double radius = 0.0;                                                        // 0 of a line
  bool hollow = false;  // the metal lies outside the arc's circle
};

/// Returns the strokes of a chain in its order, or, if `reversed`, the other way round, for a plane
/// that is seen from its other side.
[[nodiscard]] std::vector<WallStroke> strokes_of(const cutout::Chain& chain, bool reversed);

/// The plane of a chain: its axes x and y, and the normal out of the metal, in the solid's frame.
struct StrokePlane {
  Eigen::Vector3d anchor, x, y, normal;

  [[nodiscard]] Eigen::Vector3d at(const cutout::Flat& p) const {
    return anchor + p.x() * x + p.y() * y;
  }
};

/// The wall along a closed chain of strokes, straight down from their plane: a plane for each line
/// and a cylinder for each arc, added to a solid.
class PrismWall {
 public:
  PrismWall(std::vector<WallStroke> strokes, const StrokePlane& plane, Brep& solid)
      : strokes_(std::move(strokes)), plane_(plane), solid_(solid) {}

  /// The border above and below, the metal to the left as seen from outside the solid.
  struct Border {
    Brep::Loop above, below;
  };
  /// Adds the wall, `depth` mm high, with its faces of this name.
  Border add(double depth, const std::string& name);

  [[nodiscard]] const std::vector<WallStroke>& strokes() const { return strokes_; }
  [[nodiscard]] const StrokePlane& plane() const { return plane_; }
  /// Adds an edge, straight unless it has a curve, and returns its index.
  std::size_t add_edge(Brep::Edge edge);
  /// Adds the edge of a stroke at some place below the plane.
  std::size_t add_along(const WallStroke& stroke, std::size_t from, std::size_t to,
                        const Eigen::Vector3d& down);
  [[nodiscard]] decltype(Brep::Face::surface) surface(const WallStroke& stroke) const;

 private:
  std::vector<WallStroke> strokes_;
  StrokePlane plane_;
  Brep& solid_;
};

}  // namespace tubecut::api
