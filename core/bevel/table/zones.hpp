#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/base/angle.hpp"
#include "core/base/error.hpp"

namespace tubecut::bevel {

/// The groove angle over one interval of the dihedral, linear between its two ends; in a band
/// shared with another zone it is only a part of the groove, and of the root gap.
struct GrooveZone {
  std::string id;
  Angle dihedral_from, dihedral_to;  // ascending, within 0..180 deg
  Angle groove_from, groove_to;      // at those ends, >= 0
  std::optional<double> root_gap =
      {};  // mm, between root and partner; either all zones have it or no zone
};

/// A user's table of grooves, for example a welding procedure's. If two zones meet or overlap, the
/// transition may lie anywhere in a band from `overlap` / 2 below the upper zone's first dihedral
/// to `overlap` / 2 above the lower zone's last. There the groove is the mean of both; the upper
/// zone's weight is linear from 0 to 1 across the band, and each zone's own groove is constant
/// beyond its end: a straight line if both are constant in the band, else a parabola. Without a
/// band the groove steps, and the border belongs to the upper zone; a root gap never steps.
struct ZonedGroove {
  std::vector<GrooveZone> zones;  // in any order
  Angle overlap = {};

  /// Returns true if each zone has a root gap of its own.
  [[nodiscard]] bool has_root_gaps() const { return !zones.empty() && zones.front().root_gap; }
};

/// The minimum band over which a root gap changes from one zone to the next.
inline constexpr Angle kLeastGapBand = Angle::deg(0.5);

/// The zones in ascending order, prepared for use.
class Zones {
 public:
  Zones() = default;
  explicit Zones(const ZonedGroove& table);

  struct At {
    double groove = 0.0;    // rad
    double root_gap = 0.0;  // mm; without root gaps 0
    std::size_t zone = 0;   // index in the given table: in a band the nearer zone
    bool inside = false;    // the table has this dihedral
  };
  [[nodiscard]] At at(double dihedral) const;
  /// Returns the smallest root gap.
  [[nodiscard]] double least_gap() const;
  [[nodiscard]] double greatest_gap() const;

 private:
  struct Row {
    double from, to, groove_from, groove_to, root_gap;
    std::size_t index;
    double band_from, band_to;  // of the transition to the next row
  };
  std::vector<Row> rows_;
};

/// Errors    wrong_count, out_of_range (zones/i: not ascending, a gap before it, bands that meet, a
///           root gap that steps), unsupported_combination (zones/i/root_gap: some have one).
[[nodiscard]] Result<void> check_zones(const ZonedGroove& table);

}  // namespace tubecut::bevel
