#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/variant.hpp"

namespace tubecut::cutout {

struct Once {};
struct Linear {
  int count = 1;
  double pitch = 0.0, turn = 0.0;  // mm along, rad round
};
struct Round {
  int count = 1;
  double turn = 0.0;  // rad
};
struct Grid {
  enum class Stagger { none, along, round };
  int along = 1, round = 1;
  double pitch = 0.0, turn = 0.0;  // mm along, rad round
  Stagger stagger = Stagger::none;
  double offset = 0.0;  // of odd rows; mm along, or rad round
};
/// The same on several faces of a section.
struct Faces {
  std::vector<int> faces;  // 1 to 4
  Variant<Once, Linear, Grid> each;
};
using Pattern = Variant<Once, Linear, Round, Grid, Faces>;

/// One of a pattern: how far from the anchor, and the suffix of its name.
struct Step {
  std::string suffix;
  double along = 0.0, turn = 0.0;  // mm, rad
  std::optional<int> face = {};    // another face than the anchor's
};

[[nodiscard]] std::size_t count_of(const Pattern& pattern);

/// All of a pattern, the anchor's own first.
///
/// Errors  pattern_wraps (pattern/count, or pattern/round/count).
[[nodiscard]] Result<std::vector<Step>> steps(const Pattern& pattern);

}  // namespace tubecut::cutout
