#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/bevel/table/table.hpp"
#include "core/part/part.hpp"

namespace tubecut::api {

/// One edge of an end, as drawings go round it: from one phase to the same a turn later.
class RoundEdge {
 public:
  RoundEdge(const std::vector<double>& phi, const std::vector<double>& z, double opened);

  /// (phi, z) from `opened` on, a turn long; the last is the first again.
  [[nodiscard]] const std::vector<std::pair<double, double>>& points() const { return points_; }
  /// Straight between two points, at any phase.
  [[nodiscard]] double at(double phi) const;

 private:
  double opened_;
  std::vector<std::pair<double, double>> points_;
};

/// The phase within a turn from `from` on.
[[nodiscard]] double turned_from(double from, double phi);

/// Range along the tube and round it; for a hole, phi is continuous.
struct SurfaceRange {
  double z_from = 0.0, z_to = 0.0, phi_from = 0.0, phi_to = 0.0;
};
[[nodiscard]] SurfaceRange surface_range(const bevel::Hole& hole);
/// Of an end, both walls.
[[nodiscard]] SurfaceRange surface_range(const bevel::Table& end);

/// Returns the colour of partner `i`.
[[nodiscard]] std::string_view partner_color(std::size_t i);

/// A hole's name on a drawing: "H1".
[[nodiscard]] std::string hole_tag(std::size_t i);
/// A cut-out's: its id, with the side of one that goes through both walls.
[[nodiscard]] std::string cutout_tag(const cutout::Layout& layout, std::size_t i);

/// A hole or a cut-out of a part, in its frame.
struct Opening {
  bevel::Hole rows;
  std::string tag;
  bool tagged = true;  // where there is room for its name
};
/// The holes, then the cut-outs. More cut-outs than `kMostTagged` have no tags.
[[nodiscard]] std::vector<Opening> openings(const part::Part& part);
inline constexpr std::size_t kMostTagged = 24;
inline constexpr double kTagHeight = 2.6, kTagRow = 3.4;  // mm, of a tag and of a row of them

/// Merges ranges, ascending, that overlap when `room` is added on both sides.
[[nodiscard]] std::vector<SurfaceRange> joined(const std::vector<SurfaceRange>& ranges,
                                               double room);
/// Returns a phase off all openings: 0, else of the multiples of 15 deg the one furthest from them.
[[nodiscard]] double phase_off_openings(const part::Part& part);

}  // namespace tubecut::api
