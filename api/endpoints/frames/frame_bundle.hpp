#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "api/endpoints/frames/frame_answer.hpp"
#include "api/wire/format.hpp"

namespace tubecut::api {

/// Returns a shop's packet as a zip archive: for each part a folder with the requested files, the
/// cut list as CSV, the request with defaults applied, and `manifest.json`: every file with its
/// SHA-256, every part with its verdict and hashes, and the omitted files with their reasons. File
/// names contain the reference's part, the member's id, and the first digits of their part's hash.
/// Throws UnfitOption (acknowledge: a code that no part warns of).
[[nodiscard]] std::string frame_bundle(const FrameJob& frame, const MadeParts& made,
                                       const Caption& caption);

/// The query parameters it reads.
[[nodiscard]] const std::vector<std::string_view>& bundle_options();

}  // namespace tubecut::api
