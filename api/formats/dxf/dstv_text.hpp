#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/wire/format.hpp"
#include "core/cutout/cutout.hpp"

namespace tubecut::api {

// The lines that DSTV files of all tubes have.

struct DstvLengths {
  double low = 0.0;  // z of x = 0
  double over_long = 0.0, over_short = 0.0, work_point = 0.0;
  double saw = 0.0;      // from the start of the torch line
  bool assumed = false;  // nobody gave the far end
};

/// Of a whole part: x = 0 at the start's long point.
template <class Part>
[[nodiscard]] DstvLengths lengths_of_part(const Part& p) {
  const auto& s = p.start.table;
  const auto& f = p.finish.table;
  const double from =
      std::min({0.0, std::ranges::min(s.torch_inner), std::ranges::min(s.torch_outer)});
  const double to = std::max(
      {p.lengths.longest, std::ranges::max(f.torch_inner), std::ranges::max(f.torch_outer)});
  return {.over_long = p.lengths.longest,
          .over_short = p.lengths.shortest,
          .work_point = p.lengths.work_point,
          .saw = to - from};
}

struct DstvProfile {
  std::string name, code;
  double height = 0.0, width = 0.0, wall = 0.0, radius = 0.0;  // mm
  double kg_per_m = 0.0;
  double girth = 0.0;  // mm
};

[[nodiscard]] std::string dstv_field(double value, int digits = 3);
[[nodiscard]] std::string dstv_comment(const std::string& text);
/// The comments at the top; `frame` says how x, y and the faces lie.
[[nodiscard]] std::string dstv_comments(const DstvLengths& lengths,
                                        const std::vector<std::string>& frame, bool constant,
                                        const Caption& caption);
/// `name`: name of the piece if the reference has no name.
[[nodiscard]] std::string dstv_header(const DstvProfile& profile, const DstvLengths& lengths,
                                      const Caption& caption, std::string_view name = {});
/// Returns a point of a contour; face and reference edge "u" only for the first of the block.
[[nodiscard]] std::string dstv_point(std::string_view face, double x, double y, double bevel,
                                     bool first);
/// Returns the bevel in degrees if the whole cut has the same.
[[nodiscard]] std::optional<double> one_bevel(const std::vector<double>& b);

/// Returns the comment that names a cut-out and states how its wall stands.
[[nodiscard]] std::string dstv_cutout_title(const std::string& name, cutout::Lay lay);
/// Returns the diameter of a circle that a drill makes; empty for any other shape.
[[nodiscard]] std::optional<double> dstv_bore_diameter(const cutout::Spec& cutout);
/// Returns the block of a bore through one wall.
[[nodiscard]] std::string dstv_bore(std::string_view face, double x, double y, double diameter);

}  // namespace tubecut::api
