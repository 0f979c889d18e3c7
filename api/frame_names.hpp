#pragma once

#include "core/base/names.hpp"
#include "core/frame/frame.hpp"

/// The enumerations of frames, as wire_names.hpp has the others.
namespace tubecut {

template <>
inline constexpr auto kNames<frame::JointKind> = std::to_array<Option<frame::JointKind>>(
    {{name_of(joint::JointKind::set_on), frame::JointKind::set_on},
     {name_of(joint::JointKind::set_in), frame::JointKind::set_in},
     {name_of(joint::JointKind::through), frame::JointKind::through},
     {name_of(joint::JointKind::mitre), frame::JointKind::mitre},
     {"butt", frame::JointKind::butt}});
template <>
inline constexpr auto kNames<frame::Why> =
    std::to_array<Option<frame::Why>>({{"free", frame::Why::free},
                                       {"cuts_the_others", frame::Why::cuts_the_others},
                                       {"parallel", frame::Why::parallel},
                                       {"not_joined", frame::Why::not_joined}});

}  // namespace tubecut
