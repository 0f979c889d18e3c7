#pragma once

#include "api/endpoints/node_codec.hpp"
#include "core/bevel/table.hpp"

namespace tubecut::api {

/// A bevel table asked for by its joint, given directly or as an end of a node; `resolve` fills in
/// target and partners.
struct BevelTableRequest : bevel::TableSpec {
  JointSource source;
};

/// A /v1/bevel-tables request, also where it is nested in another.
[[nodiscard]] BevelTableRequest decode_bevel_table_request(Reader& in);

/// Errors  those of the node; members as in the request.
[[nodiscard]] Result<BevelTableRequest> resolve(BevelTableRequest request,
                                                const std::stop_token& stop);

}  // namespace tubecut::api
