#pragma once

#include <string>
#include <vector>

#include "api/formats/step/brep.hpp"
#include "core/cutout/cutout.hpp"
#include "core/section/section.hpp"

namespace tubecut::api {

/// The border of a cut-out over corners on one side of the wall: its rows, with the metal to the
/// left as seen from outside the tube, and the edge from each to the next.
struct OverBorder {
  std::vector<double> s;  // on this side's own outline
  std::vector<std::size_t> vertices, edges;
};
struct OverCutout {
  OverBorder outside, bore;
};

/// Adds the wall of a cut-out over corners to a solid: a plane or a ruled patch from each row to
/// the next.
[[nodiscard]] OverCutout add_over_cutout(const section::Wall& wall, const cutout::Layout& layout,
                                         const cutout::Instance& one, const std::string& name,
                                         Brep& solid);

/// One strip of the tube between two seams, on one side of the wall: the edges of both ends as s
/// grows, and the two seams' vertices at start and finish.
struct Strip {
  double from = 0.0, to = 0.0;  // s on this side's own outline, to > from
  Eigen::Vector2d across;       // unit, along the outline in its middle
  Brep::Loop low, high;
};

/// Whether a loop on a strip goes round another one.
[[nodiscard]] bool goes_round(const Brep::Loop& loop, const Eigen::Vector2d& across,
                              const Brep::Loop& other, const Brep& solid);

/// The seams of one side with the pieces that cut-outs leave of them.
class SeamPieces {
 public:
  SeamPieces(const section::Curve& curve, std::vector<OverBorder> borders, std::string names)
      : girth_(curve.girth()), borders_(std::move(borders)), names_(std::move(names)) {}

  /// Adds the metal of a seam at `s` from the vertex at the start to that at the finish.
  [[nodiscard]] std::vector<std::size_t> add(double s, std::size_t start, std::size_t finish,
                                             Brep& solid) const;
  /// Returns the faces that are left of a strip, each by its loops, the outer one first, with the
  /// face to the left as seen from outside the tube. `before` and `after` are its seams.
  [[nodiscard]] std::vector<std::vector<Brep::Loop>> faces_of(
      const Strip& strip, const std::vector<std::size_t>& before,
      const std::vector<std::size_t>& after, const Brep& solid) const;

 private:
  double girth_;
  std::vector<OverBorder> borders_;
  std::string names_;
};

}  // namespace tubecut::api
