#pragma once

#include <string_view>

#include "core/base/names.hpp"
#include "core/cutout/cutout.hpp"
#include "core/part/cutout_report.hpp"

/// What the enumerations of cut-outs are called on the wire.
namespace tubecut {

template <>
inline constexpr auto kNames<cutout::Wall> =
    std::to_array<Option<cutout::Wall>>({{"normal", cutout::Wall::normal},
                                         {"through", cutout::Wall::through},
                                         {"developed", cutout::Wall::developed}});
template <>
inline constexpr auto kNames<cutout::Lay> =
    std::to_array<Option<cutout::Lay>>({{"developed", cutout::Lay::developed},
                                        {"prism", cutout::Lay::prism},
                                        {"square_from_bore", cutout::Lay::bored},
                                        {"flat", cutout::Lay::flat}});
template <>
inline constexpr auto kNames<cutout::Slit::Pierce> = std::to_array<Option<cutout::Slit::Pierce>>(
    {{"middle", cutout::Slit::Pierce::middle}, {"end", cutout::Slit::Pierce::end}});
/// The wall of a cut-out's cone.
inline constexpr std::string_view kCountersink = "countersink";
template <>
inline constexpr auto kNames<cutout::Anchor::From> = std::to_array<Option<cutout::Anchor::From>>(
    {{"start", cutout::Anchor::From::start}, {"finish", cutout::Anchor::From::finish}});
template <>
inline constexpr auto kNames<cutout::Anchor::Zero> =
    std::to_array<Option<cutout::Anchor::Zero>>({{"work_point", cutout::Anchor::Zero::work_point},
                                                 {"long_point", cutout::Anchor::Zero::long_point}});
template <>
inline constexpr auto kNames<cutout::Grid::Stagger> =
    std::to_array<Option<cutout::Grid::Stagger>>({{"none", cutout::Grid::Stagger::none},
                                                  {"along", cutout::Grid::Stagger::along},
                                                  {"round", cutout::Grid::Stagger::round}});
template <>
inline constexpr auto kNames<part::CutoutWeb::Beside> =
    std::to_array<Option<part::CutoutWeb::Beside>>({{"cutout", part::CutoutWeb::Beside::cutout},
                                                    {"hole", part::CutoutWeb::Beside::hole},
                                                    {"start", part::CutoutWeb::Beside::start},
                                                    {"finish", part::CutoutWeb::Beside::finish}});

}  // namespace tubecut
