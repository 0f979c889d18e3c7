#pragma once

#include <array>
#include <optional>
#include <string>

#include "api/catalog/post_units.hpp"
#include "api/wire/reader.hpp"

namespace tubecut::api {

/// What an axis does. `along` and `out` are the tube's length and the way off it, `across` square
/// to both; `turn` turns the tube, `swing` leans the torch along it, `tilt` across it.
enum class PostRole { along, out, across, turn, swing, tilt };
inline constexpr std::array kPostRoles{"along", "out", "across", "turn", "swing", "tilt"};

/// What a control's axis is called and how it counts: what is written is the program's value,
/// turned round or not, and the offset, in the control's unit. Values here are mm or deg.
struct PostAxis {
  char letter = 'X';
  bool reversed = false;
  double offset = 0.0;  // mm or deg
  int decimals = 0;
  bool within_turn = false;             // counts from 0 to below a turn
  double scale = 1.0;                   // written units in 1 mm or 1 deg
  TurnUnit unit = TurnUnit::deg;        // of `turn` alone
  std::optional<double> diameter = {};  // mm, of a girth; empty: the tube's own

  /// The same of a tube of that radius, mm: how much of a girth is 1 deg.
  [[nodiscard]] PostAxis on_tube(double outer_radius) const;
  /// What is written, before it is rounded.
  [[nodiscard]] double counted(double value) const;
  /// "X-1.50000"
  [[nodiscard]] std::string word(double value) const;
  /// The same number without what `within_turn` takes off it: what ways are told from.
  [[nodiscard]] double written(double value) const;
  /// Where the program's zero is: "A0".
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

/// The axes of a post, by their roles. A turn on a letter that counts lengths (X Y Z U V W) is a
/// girth in the post's units unless `unit` says what it is.
[[nodiscard]] std::array<std::optional<PostAxis>, kPostRoles.size()> decode_post_axes(
    Reader& in, PostUnits units);

}  // namespace tubecut::api
