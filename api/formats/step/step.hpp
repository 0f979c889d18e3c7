#pragma once

#include <string>

#include "api/formats/step/step_solid.hpp"
#include "api/wire/format.hpp"
#include "core/bevel/hole/hole.hpp"
#include "core/bevel/table/table.hpp"
#include "core/part/part.hpp"

namespace tubecut::api {

// One closed solid as ISO 10303-21 text (AP214, mm), in the frame of the answer. View `smooth` (the
// default): through the rows, with corners where the cut has them; `straight`: the finished part as
// answered, straight between its rows. See wall_spline.hpp for how near, tube_solid.hpp for its
// faces. Own writer: Open CASCADE's would add 60 MB and seconds of start.

/// The cut end; the far end is square, where that of the other solids is.
[[nodiscard]] std::string bevel_table_step(const bevel::TableSpec& spec, const bevel::Table& table,
                                           const Caption& caption);
/// The chord around the hole or holes, square on both sides, one outer radius from them.
[[nodiscard]] std::string hole_step(const bevel::HoleSpec& spec, const bevel::HoleCut& cut,
                                    const Caption& caption);
/// The finished part. A hole of which both sides lie beyond an end is not there; holes that meet
/// each other or a cut are no solid this can print, and are refused.
[[nodiscard]] std::string part_step(const part::PartSpec& spec, const part::Part& part,
                                    const Caption& caption);
/// The same solid, for a file of several. Throws UnfitOption.
[[nodiscard]] TubeSolid part_solid(const part::PartSpec& spec, const part::Part& part,
                                   const Caption& caption);
/// What a file calls a tube of this size: the reference's part goes before `member`.
[[nodiscard]] Product product_of(const joint::Target& tube, const std::string& member,
                                 const Caption& caption);

}  // namespace tubecut::api
