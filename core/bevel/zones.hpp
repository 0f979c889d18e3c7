#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/base/angle.hpp"
#include "core/base/error.hpp"

namespace tubecut::bevel {

/// The groove angle over one interval of the dihedral, straight between its two ends; in a band
/// shared with another zone only a part of what is cut.
struct GrooveZone {
  std::string id;
  Angle dihedral_from, dihedral_to;  // ascending, within 0..180 deg
  Angle groove_from, groove_to;      // at those ends, >= 0
};

/// A user's table of grooves, for example a welding procedure's. Where two zones meet or overlap
/// the transition may lie anywhere in a band from `overlap` / 2 below the upper zone's first
/// dihedral to `overlap` / 2 above the lower zone's last. There the groove is the mean of both, the
/// upper zone's weight running straight from 0 to 1 across the band, each zone's own groove held at
/// its end beyond it: a straight line where both are constant in the band, else a parabola. Without
/// any band the groove steps, and the border belongs to the upper zone.
struct ZonedGroove {
  std::vector<GrooveZone> zones;  // in any order
  Angle overlap = {};
};

/// The zones ready for use, ascending.
class Zones {
 public:
  Zones() = default;
  explicit Zones(const ZonedGroove& table);

  struct At {
    double groove = 0.0;   // rad
    std::size_t zone = 0;  // index in the table as given: in a band the nearer zone
    bool inside = false;   // the table has this dihedral
  };
  [[nodiscard]] At at(double dihedral) const;

 private:
  struct Row {
    double from, to, groove_from, groove_to;
    std::size_t index;
    double band_from, band_to;  // of the transition to the next row
  };
  std::vector<Row> rows_;
};

/// Errors    wrong_count, out_of_range (zones/i: not ascending, a gap before it, bands that meet).
[[nodiscard]] Result<void> check_zones(const ZonedGroove& table);

}  // namespace tubecut::bevel
