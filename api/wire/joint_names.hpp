#pragma once

#include "core/base/names.hpp"
#include "core/joint/intersection.hpp"
#include "core/joint/joint.hpp"

/// Wire names of the enumerations of joints and their curves.
namespace tubecut {

template <>
inline constexpr auto kNames<joint::Metric> = std::to_array<Option<joint::Metric>>(
    {{"developed", joint::Metric::developed}, {"chord", joint::Metric::chord}});
template <>
inline constexpr auto kNames<joint::Surfaces> =
    std::to_array<Option<joint::Surfaces>>({{"inner", joint::Surfaces::inner},
                                            {"outer", joint::Surfaces::outer},
                                            {"both", joint::Surfaces::both}});
template <>
inline constexpr auto kNames<joint::EventKind> =
    std::to_array<Option<joint::EventKind>>({{"junction", joint::EventKind::junction},
                                             {"jump", joint::EventKind::jump},
                                             {"kink", joint::EventKind::kink}});
template <>
inline constexpr auto kNames<joint::MitrePlane> = std::to_array<Option<joint::MitrePlane>>(
    {{"bisecting", joint::MitrePlane::bisecting},
     {"corner_to_corner", joint::MitrePlane::corner_to_corner}});

}  // namespace tubecut

namespace tubecut::api {

/// Of a curve on one wall.
[[nodiscard]] constexpr std::string_view wall_name(bool outer) {
  return name_of(outer ? joint::Surfaces::outer : joint::Surfaces::inner);
}

}  // namespace tubecut::api
