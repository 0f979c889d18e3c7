#pragma once

#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "core/frame/frame.hpp"
#include "core/joint/node/overlap.hpp"

/// For `solve` only.
namespace tubecut::frame::detail {

/// One of the others, or a plate, that cuts an end, by its joint.
struct OtherAt {
  std::size_t other = 0, joint = 0;
  bool plate = false;            // `other` is the plate
  joint::PlaneCutter face = {};  // of a plate: where it cuts, in the world
};

/// How a member meets a plate, in the plate's frame.
struct AtPlate {
  joint::End end = joint::End::start;
  bool front = true;             // the member comes from the side of the normal
  double from = 0.0, to = 0.0;   // heights between which the tube is within the plate, from > to
  double depth = 0.0;            // of an end that is set in
  joint::PlaneCutter face = {};  // where the end is cut, in the world
};
/// Errors  ambiguous_connection, out_of_range (joints/i), those of plate::frame_of (plates/k).
[[nodiscard]] Result<AtPlate> at_plate(const FrameSpec& spec, std::size_t index);

/// Returns the partner that cuts, in the world, and where errors about it point.
[[nodiscard]] joint::Partner partner_of(const FrameSpec& spec, const OtherAt& one);
[[nodiscard]] std::string path_of(const OtherAt& one);
/// Returns the gap of an end at it: an end set in a plate is cut at its depth.
[[nodiscard]] double gap_of(const FrameJoint& joint);

/// The joints and the members at each, before the change to local frames.
struct Joined {
  joint::NodeSpec node;
  joint::Nodes nodes;
  std::vector<FrameJoint> joints;
  std::map<std::pair<std::size_t, std::size_t>, std::size_t>
      of_members;                            // the earlier member first
  std::vector<std::vector<OtherAt>> others;  // of each end

  [[nodiscard]] std::size_t joint_of(std::size_t a, std::size_t b) const {
    return of_members.at(std::minmax(a, b));
  }
};

/// Returns the surfaces of the others that cut each end, in that end's frame.
[[nodiscard]] joint::Beside seats_of_others(const FrameSpec& spec, const Joined& joined);

/// Returns the end that a stated joint with one of the others, or with a plate, belongs to.
/// Errors  ambiguous_connection (joints/i: both are equally near).
[[nodiscard]] Result<joint::End> end_at(const FrameSpec& spec, std::size_t index);

/// The distance of an end of a joint from the surface that cuts it, along its axis. `what` that is,
/// and what may be done instead, for errors.
struct EndOff {
  double distance = 0.0;  // mm
  std::string what, instead = {};
};
/// An end is at most so far from a surface as one may be from a member as wide as its own, because
/// the cut would move it by more than anybody draws it short or long.
/// Errors  no_contact (joints/i).
[[nodiscard]] Result<void> check_near(std::size_t index, const joint::Member& member,
                                      const EndOff& off);
/// Checks the end of a stated joint with one of the others.
[[nodiscard]] Result<void> check_near_other(const FrameSpec& spec, std::size_t index,
                                            joint::End end);

/// Errors  as `solve`.
[[nodiscard]] Result<std::vector<Piece>> pieces(const FrameSpec& spec, const Joined& joined);

/// Errors  as `solve`.
[[nodiscard]] Result<std::vector<FramePlate>> plates(const FrameSpec& spec, const Joined& joined);

/// Warns of members that enter a plate although no joint names the two, and of ends that reach
/// beyond the plate that they are set on.
[[nodiscard]] Result<std::vector<Warning>> warnings_of_plates(const FrameSpec& spec,
                                                              const Joined& joined,
                                                              const std::vector<FramePlate>& plates,
                                                              const joint::Beside& beside);

}  // namespace tubecut::frame::detail
