#pragma once

// A flat plate of a frame: its outline, its own openings and the holes for tubes, in its own plane.
//
// Idea: a plate is cut square, so every hole is a prism along its normal. A tube that passes at an
// angle gets its shadow through the whole thickness.
//
// Example: a base plate with four bolt holes.
//     plate::PlateSpec spec;
//     spec.thickness = 15;
//     spec.outline = cutout::Rectangle{200, 200, 0};
//     spec.openings = {{.id = "bolt",
//                       .shape = cutout::Circle{18},
//                       .at = {-70, -70},
//                       .pattern = plate::Grid{2, 2, 140, 140}}};
//     const auto plate = plate::make(spec, {}).value();
//     const double area = plate.area;  // 38982.1

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/variant.hpp"
#include "core/cutout/shape.hpp"
#include "core/plate/passage.hpp"

namespace tubecut::plate {

/// The same opening several times: the anchor is the first of a grid, and the middle of a ring.
struct Once {};
struct Grid {
  int columns = 1, rows = 1;
  double column_pitch = 0.0, row_pitch = 0.0;  // mm, along x and y
};
struct Ring {
  int count = 1;
  double diameter = 0.0;  // mm, of the circle through their anchors
  double angle = 0.0;     // rad, of the first, from x towards y
};
using Pattern = Variant<Once, Grid, Ring>;

/// An opening of the plate's own; a rectangle is `along` x and `round` y.
struct Opening {
  std::string id;
  cutout::Shape shape = {};
  double turn = 0.0;  // rad, from x towards y
  cutout::Flat at = cutout::Flat::Zero();
  Pattern pattern = {};
};

/// Lengths in mm. Seen with the normal towards the eye, y is `up` and x to its right; the metal
/// lies behind the face.
struct PlateSpec {
  std::string name = {};
  Eigen::Vector3d point = Eigen::Vector3d::Zero();    // of the face: x = y = 0
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // out of the metal
  Eigen::Vector3d up = Eigen::Vector3d::UnitY();      // made perpendicular to the normal
  double thickness = 0.0;
  cutout::Shape outline = {};
  std::vector<Opening> openings = {};
  double least_web = 0.0;  // between two openings, and between an opening and the outline
};

inline constexpr std::size_t kMostOpenings = 1'000;  // of one plate, with patterns

/// A tube that the plate has to let pass. `at`: for errors.
struct Passing {
  Passage passage;
  std::string name, at;
};

/// One opening of the finished plate.
struct Hole {
  std::string name;  // "id", in a pattern "id.3"
  std::string at;    // for errors: "cutouts/0", or of the tube
  cutout::Chain chain;
  std::optional<double> diameter = {};  // of a circle
  cutout::Flat centre = cutout::Flat::Zero();
  std::optional<std::size_t> passing = {};  // of a tube: which it is
  double greatest_gap = 0.0;
};

/// The least web of a plate; `b` is empty if it is to the outline.
struct Web {
  double width = 0.0;
  std::string a, b = {};
};

struct Plate {
  joint::MemberFrame frame;  // x, y and the normal in the world
  cutout::Chain outline;
  std::vector<Hole> holes;  // its own in their order, then those for tubes
  std::optional<Web> web;
  double area = 0.0, volume = 0.0;  // mm^2, mm^3
};

/// Returns the plate's frame.
/// Errors  zero_length (normal, up), bad_reference_direction (up), as `make`.
[[nodiscard]] Result<joint::MemberFrame> frame_of(const PlateSpec& spec);

/// Errors    zero_length (normal, up), bad_reference_direction (up); of the outline (outline/...)
///           and of openings (cutouts/k/...): out_of_range, contour_open, contour_crosses;
///           wrong_count (cutouts); of passings (their `at`): parallel_axes; of each opening:
///           cutout_off_part, cutouts_cross, out_of_range (least_web). All of one kind at once.
/// Accuracy  area, volume and webs exact for lines and arcs; see `hole_of` for tubes at an angle.
[[nodiscard]] Result<Plate> make(const PlateSpec& spec, const std::vector<Passing>& passing);

/// Verifies the plate by points of space: hole walls at many depths against the tubes
/// (plate_clear), and the reported web against points of the openings' edges and the outline
/// (plate_web).
[[nodiscard]] std::vector<Check> verify(const PlateSpec& spec, const std::vector<Passing>& passing,
                                        const Plate& plate);

}  // namespace tubecut::plate
