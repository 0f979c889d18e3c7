#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "api/verdict.hpp"
#include "api/wire/reader.hpp"
#include "api/wire/writer.hpp"
#include "core/bevel/beam/tongue.hpp"
#include "core/bevel/table/table.hpp"
#include "core/part/webs.hpp"

namespace tubecut::api {

/// A set of choices that a request makes by one word.
enum class Preset { none, tube_laser };
[[nodiscard]] Preset decode_preset(Reader& in);

/// Members that `accept` may have for an end in addition to a bevel's own limits, and for a part in
/// addition to an end's.
inline constexpr std::array<std::string_view, 3> kEndAccepts{"max_gap_mm", "max_reach_mm",
                                                             "min_tongue_mm"};
inline constexpr std::array<std::string_view, 3> kPartAccepts{"min_web_mm", "min_hole_to_end_mm",
                                                              "min_seam_to_hole_mm"};

/// What it may hold of a part with cut-outs.
inline constexpr std::array<std::string_view, 2> kCutoutAccepts{"min_diameter_mm",
                                                                "min_diameter_per_wall"};

/// The parts of a request that decide which limits of `accept` something is measured for.
struct Measured {
  Preset preset = Preset::none;
  bool round = true;  // the target, or of a frame some member
  bool cutouts = false, holes = false;
  bool seam_known = false;
};
/// Returns the condition that is missing if nothing is measured for this limit, else nothing.
[[nodiscard]] std::string_view missing_for(std::string_view limit, const Measured& of);
/// Refuses every limit of `accept` that nothing would be measured for, except those that an earlier
/// call for `before` has refused.
void check_accepts(Reader& in, const Measured& of, const std::optional<Measured>& before = {});

/// With the preset: the square groove, no smoothing, a hole's own rule and tilt. Another choice is
/// an issue at its own field.
[[nodiscard]] bevel::GrooveRule decode_square_groove(Reader& in);
void decode_no_smoothing(Reader& in, bevel::TableSpec& out);
[[nodiscard]] bevel::Contact decode_untilted_contact(Reader& in);
[[nodiscard]] bevel::Tilt decode_no_tilt(Reader& in);
void check_torch_reaches_square(Reader& in, const bevel::TorchRange& torch);

/// Values that a laser shop needs for one cut end.
struct EndReport {
  std::optional<bevel::Tongue> tongue;
  double reach = 0.0;
};
[[nodiscard]] EndReport end_report(const bevel::TableSpec& spec, const bevel::Table& table,
                                   bool towards_plus_z);
void encode_end_report(const bevel::Table& table, const EndReport& report, Writer& w);
[[nodiscard]] std::vector<Measure> measures_of(const bevel::Table& table, const EndReport& report);

/// Adds a measure, or keeps the worse of two of one name: the greater, of a `min_...` the less.
void add_worst(Measure one, std::vector<Measure>& to);

/// And of the part between its ends.
void encode_webs(const part::Webs& webs, bool seam_known, Writer& w);
[[nodiscard]] std::vector<Measure> measures_of(const part::Webs& webs, bool seam_known);

}  // namespace tubecut::api
