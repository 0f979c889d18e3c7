#pragma once

#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "core/joint/node/node.hpp"
#include "core/part/part.hpp"

namespace tubecut::frame {

/// How two that meet are joined, said once for both. Lengths in mm, as joint::Joint has them.
struct How {
  enum class Kind {
    set_on,
    set_in,
    through,
    mitre,
    butt  // two ends in line, face to face: both square
  };
  Kind kind = Kind::set_on;
  double gap = 0.0;
  std::optional<double> depth = {};
  joint::MitrePlane plane = joint::MitrePlane::bisecting;
  bool hole = false;  // is the chord's hole cut? Set-on: the branch's bore
  friend bool operator==(const How&, const How&) = default;
};

/// What cuts ends and is not cut itself, placed in the world.
struct Other {
  joint::Partner partner;
  std::string name = {};
};

struct StatedJoint {
  std::size_t member = 0;
  std::size_t with = 0;                // another member, or one of the others
  bool other = false;                  // it is one of the others
  std::optional<joint::End> end = {};  // of the branch; empty: the end that is nearer
  How how;
};

/// Members of one structure with their joints. Of two members which is the branch follows from
/// priority, diameter and place, as in joint::NodeSpec; through: the thinner one. What is found in
/// line is a butt joint or a mitre with the gap of `found`.
struct FrameSpec {
  std::vector<joint::Member> members;
  std::vector<Other> others;
  std::vector<StatedJoint> joints;
  std::optional<double> within = {};  // mm, as joint::Within; empty: only what is stated is joined
  How found;                          // joints of members that nobody states
};

/// One joint as both sides are cut for it.
struct Joint {
  std::size_t branch = 0, chord = 0;  // of a mitre or a butt joint as they are stated
  bool other = false;                 // the chord is one of the others
  How how;                            // set-in with its depth
  std::optional<std::size_t> stated;  // empty: found
};

/// One partner of an end, in the end's own frame.
struct Cutter {
  joint::Partner partner;
  std::optional<joint::Joint> stated;
  std::size_t joint = 0;
  double missing = 0.0;  // so far the cut follows it where it is not, mm
};
/// A hole for a branch, which stands in the start's frame and points out of the chord.
struct Hole {
  joint::TubeCutter branch;
  double wall = 0.0;  // of the branch
  std::size_t member = 0, joint = 0;
  joint::End end = joint::End::start;  // of the branch; passing through it has none
};
/// Where a branch stands, in the start's frame.
struct Stand {
  part::Mark mark;
  std::size_t member = 0;
};

/// A member as a part: what part::PartSpec asks for, but for how the cuts are made. Both ends have
/// one x: on the side of the member's `up`; else where the first cutter that has a side, or the
/// first branch on it, has clocking 0. Axes of cutters rise with z, and what has no order of its
/// own is sorted along the member: congruent members have like pieces, whatever way round their
/// chords were drawn.
struct Piece {
  joint::Target target;
  joint::MemberFrame frame;  // of the start, in the world
  std::vector<Cutter> start, finish;
  std::vector<Hole> holes;
  std::vector<Stand> stands;
};

/// Why an end is left square at its work point, or an other cuts nothing.
enum class Why { free, cuts_the_others, parallel, not_joined };
struct NotCut {
  Why why = Why::free;
  std::size_t index = 0;  // of the member; not_joined: of the other
  std::optional<joint::End> end = {};
};

struct Frame {
  std::vector<Piece> pieces;  // of each member, in their order
  std::vector<Joint> joints;  // those stated in their order, then those found
  std::vector<NotCut> not_cut;
  std::vector<Warning> warnings;  // of ends, and of members that share metal
};

/// Finds every joint once, and from it the branch's end and the chord's hole, or both ends of a
/// mitre: they cannot differ.
///
/// Errors    those of joint::solve (members/...; joints/i/... of what is stated, defaults/... of
///           what is found) and of joint::overlaps; joint_contradicts (joints/i: two are already
///           joined; through, of two alike; butt, out of line), zero_length (others/i/...),
///           ambiguous_connection (joints/i: which end?), parallel_axes (others/i), cancelled.
/// Accuracy  of joint::solve.
/// Cost      twice that of joint::solve, with joint::overlaps; linear in members else.
[[nodiscard]] Result<Frame> solve(const FrameSpec& spec, const std::stop_token& stop = {});

/// The parts as they are asked for, by their own numbers alone, put back into the world and held
/// against the centre-lines; and the two sides of each joint against one another. `asked`: of each
/// member; none is looked at where it is null, a part that is refused by itself.
[[nodiscard]] std::vector<Check> verify(const FrameSpec& spec, const Frame& frame,
                                        std::span<const part::PartSpec* const> asked,
                                        const std::stop_token& stop = {});

}  // namespace tubecut::frame
