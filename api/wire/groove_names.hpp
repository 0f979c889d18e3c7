#pragma once

#include "core/base/names.hpp"
#include "core/groove/mill_path.hpp"

/// Wire names of the enumerations of grooves and mill paths.
namespace tubecut {

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

}  // namespace tubecut
