#pragma once

#include "api/names.hpp"
#include "core/frame/frame.hpp"

/// The enumerations of frames, as wire_names.hpp has the others.
namespace tubecut::api {

template <>
inline constexpr auto kNames<frame::JointKind> =
    std::to_array<Option<frame::JointKind>>({{"set_on", frame::JointKind::set_on},
                                             {"set_in", frame::JointKind::set_in},
                                             {"through", frame::JointKind::through},
                                             {"mitre", frame::JointKind::mitre},
                                             {"butt", frame::JointKind::butt}});
template <>
inline constexpr auto kNames<frame::Why> =
    std::to_array<Option<frame::Why>>({{"free", frame::Why::free},
                                       {"cuts_the_others", frame::Why::cuts_the_others},
                                       {"parallel", frame::Why::parallel},
                                       {"not_joined", frame::Why::not_joined}});

}  // namespace tubecut::api
