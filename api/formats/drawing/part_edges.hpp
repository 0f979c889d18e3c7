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
struct Place {
  double z_from = 0.0, z_to = 0.0, phi_from = 0.0, phi_to = 0.0;
};
[[nodiscard]] Place place_of(const bevel::Hole& hole);
/// Of an end, both walls.
[[nodiscard]] Place place_of(const bevel::Table& end);

/// Returns the colour of partner `i`.
[[nodiscard]] std::string_view partner_color(std::size_t i);

/// A hole's name on a drawing: "H1".
[[nodiscard]] std::string hole_tag(std::size_t i);

}  // namespace tubecut::api
