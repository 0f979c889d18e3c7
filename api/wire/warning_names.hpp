#pragma once

#include "core/base/names.hpp"
#include "core/base/warning_codes.hpp"

/// Wire names of the enumerations of warnings.
namespace tubecut {

template <>
inline constexpr auto kNames<Severity> =
    std::to_array<Option<Severity>>({{"cut", Severity::cut}, {"note", Severity::note}});

}  // namespace tubecut
