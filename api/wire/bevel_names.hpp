#pragma once

#include "core/base/names.hpp"
#include "core/bevel/hole/hole.hpp"
#include "core/bevel/table/table.hpp"

/// Wire names of the enumerations of bevel tables and holes.
namespace tubecut {

template <>
inline constexpr auto kNames<bevel::RootSurface> = std::to_array<Option<bevel::RootSurface>>(
    {{"inner", bevel::RootSurface::inner}, {"outer", bevel::RootSurface::outer}});
template <>
inline constexpr auto kNames<bevel::Dihedral> =
    std::to_array<Option<bevel::Dihedral>>({{"weld_side", bevel::Dihedral::weld_side},
                                            {"inside", bevel::Dihedral::inside},
                                            {"as_published", bevel::Dihedral::as_published}});
template <>
inline constexpr auto kNames<bevel::Contact> =
    std::to_array<Option<bevel::Contact>>({{"inner", bevel::Contact::inner},
                                           {"outer", bevel::Contact::outer},
                                           {"auto", bevel::Contact::automatic},
                                           {"none", bevel::Contact::none}});
template <>
inline constexpr auto kNames<bevel::Along> = std::to_array<Option<bevel::Along>>(
    {{"developed", bevel::Along::developed}, {"length", bevel::Along::length}});
template <>
inline constexpr auto kNames<bevel::Tilt> = std::to_array<Option<bevel::Tilt>>(
    {{"axial", bevel::Tilt::axial}, {"free", bevel::Tilt::free}, {"none", bevel::Tilt::none}});

}  // namespace tubecut
