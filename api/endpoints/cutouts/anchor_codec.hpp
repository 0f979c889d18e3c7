#pragma once

#include <set>
#include <string>

#include "api/wire/reader.hpp"
#include "core/cutout/cutout.hpp"
#include "core/section/section.hpp"

namespace tubecut::api {

/// The tube on which anchors of cut-outs and texts lie, as far as it is known.
struct AnchorTube {
  double outer_radius = 0.0;                  // mm, of a round one
  const section::Section* section = nullptr;  // of one that is not round
  bool sure = true;                           // the request's tube was understood

  /// Returns the radius of the circle that is as long as the girth, at least 1 mm.
  [[nodiscard]] double radius() const;
};

/// Decodes `at` of a cut-out or a text.
[[nodiscard]] cutout::Anchor decode_anchor(Reader& in, const AnchorTube& tube);

/// Decodes an `id` that no earlier one of the list has; `taken` says so if one has it.
[[nodiscard]] std::string decode_own_id(Reader& in, std::set<std::string>& ids, const char* taken);

}  // namespace tubecut::api
