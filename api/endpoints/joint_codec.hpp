#pragma once

#include <vector>

#include "api/reader.hpp"
#include "api/writer.hpp"
#include "core/joint/intersection.hpp"

namespace tubecut::api {

/// Fields that every request about a joint shares.
[[nodiscard]] joint::Target decode_target(Reader& in);
[[nodiscard]] std::vector<joint::Partner> decode_cutters(Reader& in);
[[nodiscard]] joint::Sampling decode_sampling(Reader& in);

/// One event as an object; `outer` names the wall it is on.
void encode_event(const joint::Event& event, bool outer, Writer& w);
/// The column phi_deg: on uniform points exactly 360 i / n.
void encode_phi(const std::vector<double>& phi, const joint::Sampling& sampling, Writer& w);

}  // namespace tubecut::api
