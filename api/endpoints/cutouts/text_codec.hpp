#pragma once

#include <vector>

#include "api/endpoints/cutouts/anchor_codec.hpp"
#include "core/cutout/text.hpp"

namespace tubecut::api {

/// Decodes `texts` of a part or of a frame's member.
[[nodiscard]] std::vector<cutout::TextSpec> decode_texts(Reader& in, const AnchorTube& tube);

}  // namespace tubecut::api
