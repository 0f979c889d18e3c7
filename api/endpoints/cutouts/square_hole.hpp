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

}  // namespace tubecut::api
