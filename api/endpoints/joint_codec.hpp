#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "api/limits.hpp"
#include "api/wire/check_limit.hpp"
#include "api/wire/reader.hpp"
#include "api/wire/writer.hpp"
#include "core/joint/intersection.hpp"

namespace tubecut::api {

/// A tube's outer radius and wall, mm.
struct TubeSection {
  double outer_radius = 1.0;
  double wall = 0.5;
};
/// `outer_diameter_mm` and `wall_mm` (if `with_wall`), or `size` by name.
[[nodiscard]] TubeSection decode_tube_section(Reader& in, bool with_wall);

/// Who cuts a target that is not round.
inline constexpr std::string_view kSectionPaths =
    "/v1/intersections, /v1/bevel-tables and /v1/parts";

/// Fields that every request about a joint has in common.
[[nodiscard]] joint::Target decode_target(Reader& in);
[[nodiscard]] std::vector<joint::Partner> decode_cutters(Reader& in);
/// A cutter in world coordinates; a tube only by its axis.
struct WorldCutter {
  joint::Partner partner;
  std::string name;
};
[[nodiscard]] WorldCutter decode_world_cutter(Reader& in);
[[nodiscard]] joint::Sampling decode_sampling(Reader& in);

/// Checks that verify a curve.
inline constexpr std::array<CheckLimit, 4> kProfileChecks{{
    {"on_cutter", "1e-12 max(radius + rho, |z|)", "mm"},
    {"none_above", "1e-9 max(radius + rho, |z|)", "mm"},
    {"event_gap", "1e-8 (radius + rho)", "mm"},
    {"labels", "1e-7 max(radius + rho, |z|)", "mm"},
}};

/// One event as an object; `outer` names the wall it is on.
void encode_event(const joint::Event& event, bool outer, Writer& w);
/// The curve on one wall, as members of an object.
void encode_profile(const joint::Profile& profile, const joint::Sampling& sampling, Writer& w);

}  // namespace tubecut::api
