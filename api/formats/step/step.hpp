#pragma once

#include <string>

#include "api/formats/step/step_solid.hpp"
#include "api/wire/format.hpp"
#include "core/bevel/hole/hole.hpp"
#include "core/bevel/table/table.hpp"
#include "core/part/part.hpp"

namespace tubecut::api {

// One closed solid as ISO 10303-21 text (AP214, mm), in the frame of the answer. View `smooth` (the
// default): through the rows, with the cut's corners; `straight`: the finished part as answered,
// straight between its rows. See wall_spline.hpp for the accuracy, tube_solid.hpp for its faces.
// Own writer: Open CASCADE's would add 60 MB and seconds of start.

/// Returns the cut end; the far end is square, at the position of the other solids' far end.
[[nodiscard]] std::string bevel_table_step(const bevel::TableSpec& spec, const bevel::Table& table,
                                           const Caption& caption);
/// The chord around the hole or holes, square on both sides, one outer radius from them.
[[nodiscard]] std::string hole_step(const bevel::HoleSpec& spec, const bevel::HoleCut& cut,
                                    const Caption& caption);
/// Returns the finished part. If both sides of a hole lie beyond an end, the hole is omitted; if
/// holes meet each other or a cut, the part is refused because this cannot print such a solid.
[[nodiscard]] std::string part_step(const part::PartSpec& spec, const part::Part& part,
                                    const Caption& caption);
/// The same solid, for a file of several. Throws UnfitOption.
[[nodiscard]] TubeSolid part_solid(const part::PartSpec& spec, const part::Part& part,
                                   const Caption& caption);
/// Returns the file's name for a tube of this size: the reference's part takes precedence over
/// `member`.
[[nodiscard]] Product product_of(const joint::Target& tube, const std::string& member,
                                 const Caption& caption);

}  // namespace tubecut::api
