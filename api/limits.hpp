#pragma once

#include "api/wire/reader.hpp"

namespace tubecut::api {

/// The limits of numbers in a request, in one table for the reader's checks, `GET /v1/limits` and
/// openapi.yaml. X(name, value): names end in their unit. Core enforces those of pairs, samples and
/// triples, which bound work that grows faster than the request.
#define TUBECUT_LIMITS(X)            \
  X(uniform_points_min, 8)           \
  X(uniform_points_max, 20'000)      \
  X(nodes_max, 100'000)              \
  X(tolerance_min_mm, 1e-4)          \
  X(tolerance_max_mm, 10)            \
  X(cutters_max, 64)                 \
  X(members_max, 10'000)             \
  X(diameter_min_mm, 5)              \
  X(diameter_max_mm, 5'000)          \
  X(wall_min_mm, 0.5)                \
  X(wall_max_mm, 2'499.9)            \
  X(bore_min_mm, 0.2)                \
  X(plate_min_mm, 0.5)               \
  X(offset_max_mm, 1e6)              \
  X(angle_max_deg, 3'600)            \
  X(periods_json_max, 400'000)       \
  X(periods_cbor_max, 4'000'000)     \
  X(body_max_bytes, 1'048'576)       \
  X(body_large_max_bytes, 8'388'608) \
  X(nesting_max, 32)                 \
  X(kerf_pairs_max, 5e6)             \
  X(near_pairs_max, 1'000'000)       \
  X(overlaps_max, 5'000)             \
  X(mill_samples_max, 4e7)           \
  X(mill_triples_max, 1e8)           \
  X(mill_annealed_samples_max, 2e6)  \
  X(problems_named_max, 32)          \
  X(reference_characters_max, 64)

namespace limit {
#define X(name, value) inline constexpr double name = value;
TUBECUT_LIMITS(X)
#undef X
}  // namespace limit

/// Default seconds of CPU: about twice the time of the most expensive requests found on one core of
/// the machine in docs/promises.md, so that every permitted request is answered there. Catalogues
/// have the first.
inline constexpr double kBudgetS = 2.0;       // 1.0 s: a table of 20 000 points by 64 tubes
inline constexpr double kLongBudgetS = 30.0;  // 11.4 s: 20 000 mill positions, direct or nested

inline constexpr Range kDiameter{.min = limit::diameter_min_mm, .max = limit::diameter_max_mm};
inline constexpr Range kWall{.min = limit::wall_min_mm, .max = limit::wall_max_mm};
/// Of a tube of this radius: it has a bore.
constexpr Range wall_of(double outer_radius) {
  return {.min = kWall.min, .max = outer_radius - 0.5 * limit::bore_min_mm};
}
static_assert(2.0 * limit::wall_max_mm + limit::bore_min_mm == limit::diameter_max_mm);
/// Of a rectangular partner: it may be a plate.
inline constexpr Range kPlate{.min = limit::plate_min_mm, .max = limit::diameter_max_mm};
inline constexpr Range kOffset{.min = -limit::offset_max_mm, .max = limit::offset_max_mm};
inline constexpr Range kAnyAngleDeg{.min = -limit::angle_max_deg, .max = limit::angle_max_deg};

}  // namespace tubecut::api
