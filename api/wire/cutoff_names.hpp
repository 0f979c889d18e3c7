#pragma once

#include "core/base/names.hpp"
#include "core/cutoff/command.hpp"

/// Wire names of the enumerations of feed curves.
namespace tubecut {

/// A request cannot choose the last value: answers contain it in addition to the others, for
/// comparison.
template <>
inline constexpr auto kNames<cutoff::FitMethod> =
    std::to_array<Option<cutoff::FitMethod>>({{"minimax", cutoff::FitMethod::minimax},
                                              {"least_squares", cutoff::FitMethod::least_squares},
                                              {"three_point", cutoff::FitMethod::three_point},
                                              {"auto", cutoff::FitMethod::automatic},
                                              {"equispaced", cutoff::FitMethod::equispaced}});

}  // namespace tubecut
