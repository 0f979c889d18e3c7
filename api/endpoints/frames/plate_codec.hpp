#pragma once

#include <vector>

#include "api/wire/reader.hpp"
#include "core/frame/frame.hpp"

namespace tubecut::api {

inline constexpr std::size_t kMostPlates = 1'000;

/// Decodes `plates` of a frame; none if the field is absent.
[[nodiscard]] std::vector<plate::PlateSpec> decode_plates(Reader& in);

/// Refuses fields that a joint with a plate cannot have, each by itself: kinds of two tubes, a hole
/// other than the one of its kind, and the groove of a hole that is cut square. `known_kind`: the
/// joint's kind was understood.
void check_plate_joint(Reader& in, bool known_kind, const frame::StatedJoint& joint);

}  // namespace tubecut::api
