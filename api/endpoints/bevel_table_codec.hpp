#pragma once

#include <array>

#include "api/endpoints/frames/node_codec.hpp"
#include "api/endpoints/joint_codec.hpp"
#include "api/endpoints/tube_laser.hpp"
#include "api/formats/bevel_table_formats.hpp"
#include "api/limits.hpp"
#include "api/wire/check_limit.hpp"
#include "api/wire/reader.hpp"
#include "api/wire/writer.hpp"
#include "core/bevel/table/table.hpp"

namespace tubecut::api {

/// Decodes the options of a table, in addition to its joint and sampling: groove, contact, kerf,
/// torch, smoothing. Fields that a preset sets may be absent.
void decode_table_options(Reader& in, Preset preset, bevel::TableSpec& out);

inline constexpr Range kKerf{.min = 0.0, .max = 50.0};  // mm

/// The rule of a groove; `zones`: that rule too.
[[nodiscard]] bevel::GrooveRule decode_groove(Reader& in, bool zones);
[[nodiscard]] bevel::TorchRange decode_torch(Reader& in);

/// Its method and the mutation limit.
struct Smoothing {
  bevel::Smoothing method = bevel::NoSmoothing{};
  Angle mutation_limit = Angle::deg(10);
};
[[nodiscard]] Smoothing decode_smoothing(Reader& in);

/// `columns`, once the rest is read: those of the table that are printed; empty: all.
[[nodiscard]] std::vector<std::string> decode_table_columns(Reader& in,
                                                            const bevel::TableSpec& spec);

/// The members of a table's `result`. Of its points only the `columns` are seen.
void encode_table(const bevel::TableSpec& spec, const bevel::Table& table,
                  const std::vector<std::string>& columns, Writer& w);

inline constexpr std::array<CheckLimit, 16> kTableChecks{{
    {"dihedral", "1e-9", "deg"},
    {"bevel_plane", "1e-9", ""},
    {"above_required", "1e-9", "deg"},
    {"slope", "max_slope_deg_per_mm (1 + 1e-9)", "deg_per_mm"},
    {"second_difference", "max_curvature_deg_per_mm2 (1 + 1e-6) + rounding", "deg_per_mm2"},
    {"area_excess", "1e-6", ""},
    {"torch_range", "1e-9", "deg"},
    {"penetration", "1e-6", "mm"},
    {"touch", "1e-6", "mm"},
    {"zone_gap", "1e-6", "mm"},
    {"gap_map", "1e-6", "mm"},
    {"penetration_stated", "1e-3", "mm"},
    {"penetration_between", "sampling.tolerance_mm", "mm"},
    {"gouge", "0.01", "mm"},
    {"gouge_stated", "1e-3", "mm"},
    {"left_stated", "max(5e-3, 0.02 left_mm)", "mm"},
}};

/// A request for a bevel table whose joint is given directly or as an end of a node; `resolve`
/// fills in target and partners.
struct BevelTableRequest : bevel::TableSpec {
  JointSource source;
  Preset preset = Preset::none;
  std::vector<std::string> columns = {};  // those that are printed; empty: all
};

/// How an end is cut: root, groove, contact, smoothing and the like. `whole`: also dihedral, kerf
/// and torch, which a part has once.
void decode_cut(Reader& in, bool whole, Preset preset, bevel::TableSpec& out);
/// Refuses unsupported combinations: surface of the root, touching surface, counted angle.
void check_combination(const bevel::TableSpec& s, Reader& in);
void decode_torch_and_kerf(Reader& in, Preset preset, bevel::TableSpec& out);

/// Writes the limits that the table was made with.
void encode_limits(const bevel::TableSpec& spec, Writer& o);
/// Encodes a table's events, mutations and windows, and the intervals in which the torch range
/// binds.
void encode_bevel_lists(const bevel::Table& table, Writer& w);
void encode_torch_binds(const bevel::Table& table, Writer& w);
/// The deepest place of the finished surface in a partner.
void encode_penetration(const bevel::Penetration& deepest, Writer& w);
/// Encodes the depth that the beam cuts into the finished part, and the metal that it leaves.
void encode_torch_line(const bevel::BeamProof& proof, Writer& w);

/// Decodes a /v1/bevel-tables request, also if it is nested in another.
[[nodiscard]] BevelTableRequest decode_bevel_table_request(Reader& in);

/// Errors  those of the node; members as in the request.
[[nodiscard]] Result<BevelTableRequest> resolve(BevelTableRequest request);

}  // namespace tubecut::api
