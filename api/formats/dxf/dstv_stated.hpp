#pragma once

#include <string>
#include <string_view>

#include "core/cutout/cutout.hpp"
#include "core/part/part.hpp"
#include "core/part/section/section_part.hpp"

namespace tubecut::api {

// Comment lines of a DSTV file that state the parts of a request that its blocks do not contain,
// for a reader that makes the request again (clients/import). Lengths in mm, angles in degrees, x
// and y as in the blocks, numbers to 1e-9.

[[nodiscard]] std::string dstv_work_points(const cutout::Ground& ground);
/// `cut`: the end as it was cut, in its own frame; `work`: x of its work point; `square`: nothing
/// is welded to it.
[[nodiscard]] std::string dstv_end(const bevel::TableSpec& cut, bool square, bool finish,
                                   double work);

/// Returns the line of both corners: the header has only the outer one.
[[nodiscard]] std::string dstv_corners(const section::Section& section);

/// Returns the lines of a cut-out's shape, whose anchor lies at x, y of its block.
[[nodiscard]] std::string dstv_shape(const cutout::Spec& cutout, double x, double y);

/// Returns the line of a countersink, which no block of the file has.
[[nodiscard]] std::string dstv_countersink(const std::string& name, const cutout::Cone& cone);

inline constexpr const char* kTextColumns =
    "SI: a text to be marked; x and y where its base line begins, its angle from x to y, height";
/// Returns the block of a text, with the line that states all of it. `y` of its anchor on the face
/// and `up`, true if y grows against the girth, are the block's. Throws UnfitOption for a mirrored
/// text, which the block cannot state.
[[nodiscard]] std::string dstv_lettering(const cutout::Lettering& text, std::string_view face,
                                         double y, bool up);

/// Returns the lines of both ends and of their work points. An end has a line if it is square or
/// cut by one plane: where the plane meets the axis, and its normal in the part's frame, x to phi 0
/// or to face 1, z along the tube.
template <class Spec, class Part>
[[nodiscard]] std::string dstv_ends(const Spec& spec, const Part& part) {
  const auto ground = cutout_ground(spec, part);
  return dstv_work_points(ground) +
         dstv_end(part.start.spec, !spec.start.welded, false, ground.start_work) +
         dstv_end(part.finish.spec, !spec.finish.welded, true, ground.finish_work);
}

}  // namespace tubecut::api
