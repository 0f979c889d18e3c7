#pragma once

#include "core/base/names.hpp"
#include "core/motion/machine/machine.hpp"
#include "core/motion/path/cut_path.hpp"
#include "core/motion/schedule/schedule.hpp"
#include "core/torch/program_schedule.hpp"

namespace tubecut::api {

/// How the points of a cut count B.
enum class BSign { outer_edge_into_part, outer_edge_to_plus_z, inward };

}  // namespace tubecut::api

/// Wire names of the enumerations of machines, schedules and programs.
namespace tubecut {

template <>
inline constexpr auto kNames<motion::Surface> = std::to_array<Option<motion::Surface>>(
    {{"outer", motion::Surface::outer}, {"inner", motion::Surface::inner}});
template <>
inline constexpr auto kNames<motion::Scrap> =
    std::to_array<Option<motion::Scrap>>({{"-z", motion::Scrap::minus_z},
                                          {"+z", motion::Scrap::plus_z},
                                          {"inside", motion::Scrap::inside}});
template <>
inline constexpr auto kNames<motion::Direction> = std::to_array<Option<motion::Direction>>(
    {{"ccw", motion::Direction::ccw}, {"cw", motion::Direction::cw}});
template <>
inline constexpr auto kNames<motion::SwingCenter> = std::to_array<Option<motion::SwingCenter>>(
    {{"remote", motion::SwingCenter::remote}, {"pivot", motion::SwingCenter::pivot}});
template <>
inline constexpr auto kNames<motion::BPositive> = std::to_array<Option<motion::BPositive>>(
    {{"outer_edge_into_part", motion::BPositive::outer_edge_into_part},
     {"outer_edge_to_waste", motion::BPositive::outer_edge_to_waste}});
template <>
inline constexpr auto kNames<api::BSign> =
    std::to_array<Option<api::BSign>>({{"outer_edge_into_part", api::BSign::outer_edge_into_part},
                                       {"outer_edge_to_plus_z", api::BSign::outer_edge_to_plus_z},
                                       {"inward", api::BSign::inward}});

template <>
inline constexpr auto kNames<motion::EventKind> =
    std::to_array<Option<motion::EventKind>>({{"pierce", motion::EventKind::pierce},
                                              {"torch_on", motion::EventKind::torch_on},
                                              {"pierce_end", motion::EventKind::pierce_end},
                                              {"cut_start", motion::EventKind::cut_start},
                                              {"cut_end", motion::EventKind::cut_end},
                                              {"torch_off", motion::EventKind::torch_off},
                                              {"rapid_start", motion::EventKind::rapid_start},
                                              {"rapid_end", motion::EventKind::rapid_end},
                                              {"mark_on", motion::EventKind::mark_on},
                                              {"mark_off", motion::EventKind::mark_off}});
template <>
inline constexpr auto kNames<torch::Segment::Kind> =
    std::to_array<Option<torch::Segment::Kind>>({{"rapid", torch::Segment::Kind::rapid},
                                                 {"pierce", torch::Segment::Kind::pierce},
                                                 {"cut", torch::Segment::Kind::cut},
                                                 {"mark", torch::Segment::Kind::mark}});
/// Reason for a cut's start.
template <>
inline constexpr auto kNames<motion::Start::At> =
    std::to_array<Option<motion::Start::At>>({{"first_point", motion::Start::At::first_point},
                                              {"asked", motion::Start::At::phi},
                                              {"least_bevel", motion::Start::At::automatic}});
template <>
inline constexpr auto kNames<torch::Tabs::Of> =
    std::to_array<Option<torch::Tabs::Of>>({{"last", torch::Tabs::Of::last},
                                            {"ends", torch::Tabs::Of::ends},
                                            {"holes", torch::Tabs::Of::holes},
                                            {"all", torch::Tabs::Of::all}});

}  // namespace tubecut
