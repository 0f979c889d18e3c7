#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

namespace tubecut::section {

/// A place on an outline. The tangent is the normal turned by a quarter turn, from x towards y.
struct Station {
  double s = 0.0;  // mm, [0, girth)
  Eigen::Vector2d point = Eigen::Vector2d::Zero();
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();  // outward, unit
  double nu = 0.0;         // rad, 0..2 pi, direction of the normal from x towards y
  double curvature = 0.0;  // 1/mm, 0 on a flat
  int face = 1;            // 1..4; on a corner's arc the face before it
  bool on_corner = false;
  double along = 0.0;  // on a face: mm from its middle; on a corner: rad from the face before it

  [[nodiscard]] Eigen::Vector2d tangent() const { return {-normal.y(), normal.x()}; }
};

/// A straight or circular part of an outline, as long as it goes on.
struct OutlineSegment {
  double from = 0.0;    // s where it begins; below 0 if it crosses the datum
  double length = 0.0;  // > 0
  double nu = 0.0;      // rad, where it begins
  double radius = 0.0;  // 0 of a flat
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();   // an arc's centre; a flat's first point
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();  // where it begins

  [[nodiscard]] bool is_arc() const { return radius > 0.0; }
  [[nodiscard]] double to() const { return from + length; }
};

/// The closed outline of a rectangle with round corners: four flats and four arcs,
/// counter-clockwise seen against z. s = 0 is the middle of face 1, whose normal is +x; face 2 has
/// +y. A flat or an arc may have no length.
/// Source  docs/theory/sections.md, section 1.
class Curve {
 public:
  /// height along x, width along y; corner from 0 to half the smaller side.
  Curve(double height, double width, double corner);

  [[nodiscard]] double girth() const { return girth_; }
  [[nodiscard]] double corner() const { return corner_; }
  /// Return the distance of a face from the axis, and half the length of its flat.
  [[nodiscard]] double face_distance(int face) const { return distance_[axis(face)]; }
  [[nodiscard]] double half_flat(int face) const { return half_flat_[axis(face)]; }
  [[nodiscard]] Eigen::Vector2d corner_centre(int corner) const;
  /// Returns the largest distance from the axis.
  [[nodiscard]] double reach() const;

  /// Returns the place at s, which is taken modulo the girth. If two segments meet there, it
  /// belongs to the second.
  [[nodiscard]] Station at(double s) const;
  /// Returns the place `way` (mm, >= 0) after another. Costs a fifth of `at` if both lie on one
  /// face or one corner within a sixth of a turn of each other; equal to `at` within rounding.
  [[nodiscard]] Station after(const Station& from, double way) const;
  /// Return s of a place on a face, mm from its middle; on a corner, rad from the face before it.
  [[nodiscard]] double on_face(int face, double along) const;
  [[nodiscard]] double on_corner(int corner, double angle) const;

  /// Segments with a length, ascending, each as long as its curvature and centre stay.
  [[nodiscard]] const std::vector<OutlineSegment>& segments() const { return segments_; }
  /// s of the places where the curvature jumps, ascending, [0, girth).
  [[nodiscard]] const std::vector<double>& seams() const { return seams_; }

  [[nodiscard]] static Eigen::Vector2d face_normal(int face);

 private:
  // Faces and corners in the order of s: half of face 1, corner 1, face 2, ..., half of face 1.
  static constexpr std::size_t kParts = 9;
  [[nodiscard]] static std::size_t axis(int face) { return face % 2 == 1 ? 0 : 1; }
  void join_segments();

  double corner_;
  std::array<double, 2> distance_, half_flat_;  // of faces 1 and 3; of faces 2 and 4
  std::array<double, kParts + 1> start_{};      // s where each part begins
  double girth_ = 0.0;
  std::vector<OutlineSegment> segments_;
  std::vector<double> seams_;
};

}  // namespace tubecut::section
