#pragma once

#include "core/base/names.hpp"
#include "core/cutoff/command.hpp"

/// What the enumerations of feed curves are called on the wire.
namespace tubecut {

/// The last is no choice of a request's: answers hold it beside the others, for comparison.
template <>
inline constexpr auto kNames<cutoff::FitMethod> =
    std::to_array<Option<cutoff::FitMethod>>({{"minimax", cutoff::FitMethod::minimax},
                                              {"least_squares", cutoff::FitMethod::least_squares},
                                              {"three_point", cutoff::FitMethod::three_point},
                                              {"auto", cutoff::FitMethod::automatic},
                                              {"equispaced", cutoff::FitMethod::equispaced}});

}  // namespace tubecut
