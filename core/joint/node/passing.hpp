#pragma once

#include <optional>
#include <string>

#include "core/base/error.hpp"
#include "core/joint/node/member.hpp"

namespace tubecut::joint {

/// Which of two members passes through the other.
enum class Passing { first, second, neither };

/// The member that is narrower across both axes passes, because the other's wall closes around it
/// there: a rail 60 x 20 passes flat through a post of 50, although its larger side is the longer.
/// Neither does if both are equally wide or their axes are parallel.
[[nodiscard]] Passing which_passes(const Member& a, const Member& b);

/// An end that stops before it is out of a member on its own side.
struct StopsShort {
  End end = End::start;
  double missing = 0.0;  // mm, along the branch's axis to the surface of the other
};
/// Returns the first end of `branch` that is not out of `chord`. An end whose middle lies up to
/// `kFlush` inside counts as flush with the surface.
inline constexpr double kFlush = 0.5;  // mm
[[nodiscard]] std::optional<StopsShort> stops_short(const Member& branch, const Member& chord);

/// A member with the name that messages give it.
struct Called {
  const Member& member;
  std::string name;
};
/// Errors  joint_contradicts (at): the branch is not the narrower one, or an end stops short.
[[nodiscard]] Result<void> check_passes(const Called& branch, const Called& chord,
                                        const std::string& at);

}  // namespace tubecut::joint
