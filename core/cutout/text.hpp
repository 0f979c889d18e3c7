#pragma once

#include <string>
#include <vector>

#include "core/cutout/cutout.hpp"
#include "core/cutout/stroke_font.hpp"

/// Texts that a tool draws on the outside of a part.
namespace tubecut::cutout {

struct TextSpec {
  std::string id;
  Anchor at;            // where its base line begins
  double turn = 0.0;    // rad, of the base line, from +z towards growing phi
  std::string text;     // of letters of the font, not only spaces
  double height = 0.0;  // mm, of capitals
  bool mirrored = false;
  bool over_corner = false;  // of a section: it may leave the flat of its anchor
};

inline constexpr std::size_t kMostTexts = 500;
inline constexpr std::size_t kLongestText = 80;

/// A text on the outside, in the part's frame. Of a point, x is z and y is s, the way round the
/// outside; s goes on beyond the datum line, so that strokes have no jumps.
struct Lettering {
  TextSpec spec;
  std::size_t asked = 0;    // index of the spec
  double z = 0.0, s = 0.0;  // of the anchor; s in [0, girth)
  int face = 0;             // of a section: of the anchor, or before its corner
  double offset = 0.0;      // mm, of the anchor from the middle of this face
  std::vector<Stroke> strokes = {};
};

/// Returns the strokes about the anchor, before they lie on a part: x is a, along +z; y is b, the
/// way s grows. A drawing as seen from outside with the start on the left.
[[nodiscard]] std::vector<Stroke> written(const TextSpec& spec);

/// The texts that lie where they may, and the reasons why others do not.
struct LaidTexts {
  std::vector<Lettering> all;
  std::vector<Issue> issues;
};
/// Lays every text on the developed outside, where its strokes are straight. On a section, strokes
/// have points on the seams that they cross.
///
/// Errors  at texts/k: out_of_range (height: longer round than the flat or the outside; at/offset or
///         at/girth: beyond the flat).
/// Source  docs/theory/cutouts.md, section 7.
[[nodiscard]] LaidTexts lay_texts(const std::vector<TextSpec>& specs, const Ground& ground);

/// Returns how far the ends of strokes lie off the font's grid, found again from where they lie on
/// the part, mm: at most, of all of a text.
[[nodiscard]] double off_grid(const Lettering& text);

/// A box around all strokes.
[[nodiscard]] Bounds bounds(const std::vector<Stroke>& strokes);

/// "texts/3": where errors about a spec point.
[[nodiscard]] std::string path_of_text(std::size_t asked);

}  // namespace tubecut::cutout
