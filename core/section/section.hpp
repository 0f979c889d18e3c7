#pragma once

#include <optional>

#include "core/base/error.hpp"
#include "core/base/names.hpp"
#include "core/section/curve.hpp"

/// Hollow sections that are not round, swept along z: height along x, width along y.
namespace tubecut::section {

/// A rectangular hollow section, or a flat-sided oval, whose corner radius is half the smaller
/// side. Lengths in mm.
struct Section {
  double height = 0.0;
  double width = 0.0;
  double wall = 0.0;
  double corner = 0.0;        // radius outside
  double inner_corner = 0.0;  // radius of the bore

  [[nodiscard]] Curve outer() const { return {height, width, corner}; }
  [[nodiscard]] Curve bore() const {
    return {height - 2.0 * wall, width - 2.0 * wall, inner_corner};
  }
  /// Returns the largest distance of the outside from the axis.
  [[nodiscard]] double reach() const;

  friend bool operator==(const Section&, const Section&) = default;
};

enum class Standard { en_10210, en_10219, astm_a500 };

struct CornerRadii {
  double outer = 0.0, inner = 0.0;
};
/// Returns the radii by which a standard calculates properties; delivered corners differ.
/// Source  EN 10210-2, EN 10219-2, ASTM A500; docs/theory/sections.md, section 1.3.
[[nodiscard]] CornerRadii corner_radii(Standard standard, double wall);

/// Checks that the section can be cut along lines normal to its outside.
/// Errors  out_of_range (corner_radius, inner_corner_radius): a radius beyond half the side, an
///         outer corner's centre that is not inside the bore, or less than half the wall left on
///         the diagonal.
/// Source  docs/theory/sections.md, section 1.4.
[[nodiscard]] Result<void> check(const Section& section);

/// Returns the area of the wall across the tube, mm2.
[[nodiscard]] double area(const Section& section);
/// Returns the mass of a metre of steel tube, kg/m.
[[nodiscard]] double mass_per_metre(const Section& section);

/// The way from a place outside along the inward normal to the bore.
struct Across {
  double wall = 0.0;  // along that line
  Station bore;       // where it ends
};

/// Both outlines of a section, and how the wall lies between them.
/// Source  docs/theory/sections.md, section 1.5.
class Wall {
 public:
  explicit Wall(const Section& section);

  [[nodiscard]] const Section& section() const { return section_; }
  [[nodiscard]] const Curve& outer() const { return outer_; }
  [[nodiscard]] const Curve& bore() const { return bore_; }

  [[nodiscard]] Across across(const Station& outside) const;
  /// Returns the wall of `across` alone; cheap where the wall is the section's own.
  [[nodiscard]] double thickness(const Station& outside) const;
  /// Returns s of the place outside whose line ends at this place of the bore.
  [[nodiscard]] double outside_of(const Station& bore) const;
  /// Returns true if the corners are concentric, so that the wall is equally thick everywhere.
  [[nodiscard]] bool concentric() const { return apart_ == 0.0; }

 private:
  [[nodiscard]] Across from_face(const Station& outside) const;
  [[nodiscard]] Across from_corner(const Station& outside) const;

  Section section_;
  Curve outer_, bore_;
  double apart_;  // of the corners' centres, along each axis: that of the bore lies further in
};

}  // namespace tubecut::section

namespace tubecut {

template <>
inline constexpr auto kNames<section::Standard> =
    std::to_array<Option<section::Standard>>({{"en_10210", section::Standard::en_10210},
                                              {"en_10219", section::Standard::en_10219},
                                              {"astm_a500", section::Standard::astm_a500}});

}  // namespace tubecut
