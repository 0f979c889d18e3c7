#pragma once

#include "api/endpoints/node_codec.hpp"
#include "api/writer.hpp"
#include "core/bevel/table.hpp"

namespace tubecut::api {

/// A bevel table asked for by its joint, given directly or as an end of a node; `resolve` fills in
/// target and partners.
struct BevelTableRequest : bevel::TableSpec {
  JointSource source;
};

/// How an end is cut: root, groove, contact, smoothing and the like. `whole`: also dihedral, kerf
/// and torch, which a part has once.
void decode_cut(Reader& in, bool whole, bevel::TableSpec& out);
void decode_torch_and_kerf(Reader& in, bevel::TableSpec& out);

/// The columns of a table; its events, mutations and windows; where the torch binds.
void encode_bevel_points(const bevel::TableSpec& spec, const bevel::Table& table, Writer& w);
void encode_bevel_lists(const bevel::Table& table, Writer& w);
void encode_torch_binds(const bevel::Table& table, Writer& w);

/// A /v1/bevel-tables request, also where it is nested in another.
[[nodiscard]] BevelTableRequest decode_bevel_table_request(Reader& in);

/// Errors  those of the node; members as in the request.
[[nodiscard]] Result<BevelTableRequest> resolve(BevelTableRequest request,
                                                const std::stop_token& stop);

}  // namespace tubecut::api
