#pragma once

#include <array>
#include <optional>
#include <string>

#include "api/catalog/post_units.hpp"
#include "api/wire/reader.hpp"

namespace tubecut::api {

/// Role of an axis. `along` and `out` are the tube's length and the distance from it, `across`
/// square to both; `turn` rotates the tube, `swing` tilts the torch along it, `tilt` across it.
enum class PostRole { along, out, across, turn, swing, tilt };
inline constexpr std::array kPostRoles{"along", "out", "across", "turn", "swing", "tilt"};

/// Name and scale of a control's axis: it writes the program's value, reversed or not, plus the
/// offset, in the control's unit. Values here are mm or deg.
struct PostAxis {
  char letter = 'X';
  bool reversed = false;
  double offset = 0.0;  // mm or deg
  int decimals = 0;
  bool within_turn = false;             // counts from 0 to below a turn
  double scale = 1.0;                   // written units in 1 mm or 1 deg
  TurnUnit unit = TurnUnit::deg;        // only of `turn`
  std::optional<double> diameter = {};  // mm, of a girth; empty: the tube's own

  /// The same of a tube of that radius, mm: how much of a girth is 1 deg.
  [[nodiscard]] PostAxis on_tube(double outer_radius) const;
  /// Returns the written number before rounding.
  [[nodiscard]] double counted(double value) const;
  /// "X-1.50000"
  [[nodiscard]] std::string word(double value) const;
  /// Returns the same number before `within_turn` wraps it, for computing distances.
  [[nodiscard]] double written(double value) const;
  /// Returns the position of the program's zero: "A0".
  [[nodiscard]] std::string zero() const;
  /// A value as a comment has it: "A 13.594".
  [[nodiscard]] std::string shown(double value) const;
  /// Half the last decimal, as mm or deg.
  [[nodiscard]] double rounding() const;

  [[nodiscard]] bool is_girth() const {
    return unit == TurnUnit::mm_girth || unit == TurnUnit::inch_girth;
  }
  /// Whether the control counts the axis as one that goes straight: by its letter in RS-274, or
  /// because a girth is a length.
  [[nodiscard]] bool is_straight() const { return is_girth() || letter >= 'U'; }
};

/// Decodes the axes of a post, by their roles. A turn on a letter that counts lengths (X Y Z U V W)
/// is a girth in the post's units unless `unit` overrides it.
[[nodiscard]] std::array<std::optional<PostAxis>, kPostRoles.size()> decode_post_axes(
    Reader& in, PostUnits units);

}  // namespace tubecut::api
