#pragma once

#include "api/endpoints/tube_laser.hpp"
#include "api/wire/reader.hpp"
#include "core/part/part.hpp"

namespace tubecut::api {

/// Returns true if the branch of a hole is a section.
[[nodiscard]] bool has_section_branch(const Reader& in);

/// Decodes a hole whose wall is square to the part, because the part or the branch is not round.
/// `half`: half the smaller side of the part, or its radius, which a set-in branch does not reach.
[[nodiscard]] part::SquareHole decode_square_hole(Reader& in, double half, std::size_t asked);

/// Gives issues of the cut-outs that branches' holes became hints that a joint can follow, because
/// it has no fields of a cut-out.
[[nodiscard]] Error on_branches(Error error, const part::CutoutSpecs& cutouts);

}  // namespace tubecut::api
