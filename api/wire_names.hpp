#pragma once

#include "api/format.hpp"
#include "core/base/names.hpp"
#include "core/base/warning_codes.hpp"
#include "core/bevel/hole.hpp"
#include "core/bevel/table.hpp"
#include "core/cutoff/command.hpp"
#include "core/groove/mill_path.hpp"
#include "core/joint/node.hpp"
#include "core/motion/cut_path.hpp"
#include "core/motion/machine.hpp"
#include "core/part/member.hpp"
#include "core/part/webs.hpp"

namespace tubecut::api {

/// How the points of a cut count B.
enum class BSign { outer_edge_into_part, outer_edge_to_plus_z, inward };

}  // namespace tubecut::api

/// What enumerations are called on the wire, but for those that core itself calls by name.
namespace tubecut {
template <>
inline constexpr auto kNames<Severity> =
    std::to_array<Option<Severity>>({{"cut", Severity::cut}, {"note", Severity::note}});
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

template <>
inline constexpr auto kNames<groove::AreaIn> = std::to_array<Option<groove::AreaIn>>(
    {{"axial", groove::AreaIn::axial}, {"normal", groove::AreaIn::normal}});
template <>
inline constexpr auto kNames<groove::Mount> = std::to_array<Option<groove::Mount>>(
    {{"end_up", groove::Mount::end_up}, {"end_down", groove::Mount::end_down}});
template <>
inline constexpr auto kNames<groove::Method> =
    std::to_array<Option<groove::Method>>({{"chebyshev", groove::Method::chebyshev},
                                           {"annealing", groove::Method::annealing},
                                           {"none", groove::Method::none}});
template <>
inline constexpr auto kNames<groove::Hold> = std::to_array<Option<groove::Hold>>(
    {{"tip", groove::Hold::tip}, {"pivot", groove::Hold::pivot}});
template <>
inline constexpr auto kNames<groove::Bias> = std::to_array<Option<groove::Bias>>(
    {{"centred", groove::Bias::centred}, {"no_overcut", groove::Bias::no_overcut}});

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
inline constexpr auto kNames<part::Datum> =
    std::to_array<Option<part::Datum>>({{"up", part::Datum::up},
                                        {"seam", part::Datum::seam},
                                        {"first_cutter", part::Datum::first_cutter}});
template <>
inline constexpr auto kNames<part::Mark::Kind> =
    std::to_array<Option<part::Mark::Kind>>({{"datum_line", part::Mark::Kind::datum_line},
                                             {"part_mark", part::Mark::Kind::part_mark},
                                             {"partner", part::Mark::Kind::partner}});
template <>
inline constexpr auto kNames<part::Step::What> =
    std::to_array<Option<part::Step::What>>({{"mark", part::Step::What::mark},
                                             {"hole", part::Step::What::hole},
                                             {"finish", part::Step::What::finish},
                                             {"start", part::Step::What::start}});
template <>
inline constexpr auto kNames<part::Beside> =
    std::to_array<Option<part::Beside>>({{"hole", part::Beside::hole},
                                         {"start", part::Beside::start},
                                         {"finish", part::Beside::finish}});
template <>
inline constexpr auto kNames<part::Mistake> =
    std::to_array<Option<part::Mistake>>({{"diameter", part::Mistake::diameter},
                                          {"wall", part::Mistake::wall},
                                          {"clocking", part::Mistake::clocking},
                                          {"mirror", part::Mistake::mirror},
                                          {"b_sign", part::Mistake::b_sign},
                                          {"pivot_length", part::Mistake::pivot_length}});
template <>
inline constexpr auto kNames<part::Tool> =
    std::to_array<Option<part::Tool>>({{"wrap", part::Tool::wrap},
                                       {"tape", part::Tool::tape},
                                       {"rule", part::Tool::rule},
                                       {"caliper", part::Tool::caliper}});

/// The last is no choice of a request's: answers hold it beside the others, for comparison.
template <>
inline constexpr auto kNames<cutoff::FitMethod> =
    std::to_array<Option<cutoff::FitMethod>>({{"minimax", cutoff::FitMethod::minimax},
                                              {"least_squares", cutoff::FitMethod::least_squares},
                                              {"three_point", cutoff::FitMethod::three_point},
                                              {"auto", cutoff::FitMethod::automatic},
                                              {"equispaced", cutoff::FitMethod::equispaced}});

}  // namespace tubecut
