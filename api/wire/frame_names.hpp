#pragma once

#include "core/base/names.hpp"
#include "core/frame/frame.hpp"

/// Wire names of the enumerations of frames.
namespace tubecut {

template <>
inline constexpr auto kNames<frame::How::Kind> = std::to_array<Option<frame::How::Kind>>(
    {{name_of(joint::JointKind::set_on), frame::How::Kind::set_on},
     {name_of(joint::JointKind::set_in), frame::How::Kind::set_in},
     {name_of(joint::JointKind::through), frame::How::Kind::through},
     {name_of(joint::JointKind::mitre), frame::How::Kind::mitre},
     {"butt", frame::How::Kind::butt},
     {"tab_slot", frame::How::Kind::tab_slot}});
template <>
inline constexpr auto kNames<frame::Why> =
    std::to_array<Option<frame::Why>>({{"free", frame::Why::free},
                                       {"cuts_the_others", frame::Why::cuts_the_others},
                                       {"parallel", frame::Why::parallel},
                                       {"not_joined", frame::Why::not_joined}});

}  // namespace tubecut
