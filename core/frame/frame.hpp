#pragma once

// Finds the joints of a structure once, and from each both sides of it as parts to cut.
//
// Idea: a joint determines the branch's end and the chord's hole, or both faces of a mitre. Because
// both sides come from one joint, they always agree.
//
// Example: two chords and the strut between them, found by their distance.
//     frame::FrameSpec spec;
//     spec.members = {{{0, 0, 0}, {2000, 0, 0}, 57.15, 5},
//                     {{0, 0, 800}, {2000, 0, 800}, 57.15, 5},
//                     {{1000, 0, 0}, {1000, 0, 800}, 30.15, 4}};
//     spec.within = 1;
//     const auto frame = frame::solve(spec).value();
//     const auto joints = frame.joints.size();  // 2

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/frame/frame_plate.hpp"
#include "core/joint/node/node.hpp"
#include "core/part/part.hpp"

namespace tubecut::frame {

/// How two bodies that meet are joined, stated once for both. Lengths in mm, as in joint::Joint.
struct How {
  enum class Kind {
    set_on,
    set_in,
    through,
    mitre,
    butt,     // two ends in line, face to face, both square
    tab_slot  // set on, with tabs of the branch in slots of the chord
  };
  Kind kind = Kind::set_on;
  double gap = 0.0;
  std::optional<double> depth = {};
  joint::MitrePlane plane = joint::MitrePlane::bisecting;
  bool hole = false;  // true if the chord's hole is cut; set-on: the branch's bore
  friend bool operator==(const How&, const How&) = default;
};

/// A body that cuts ends and is not cut itself, placed in the world.
struct Other {
  joint::Partner partner;
  std::string name = {};
};

/// With a plate: see frame_plate.hpp.
struct StatedJoint {
  std::size_t member = 0;
  std::size_t with = 0;                // another member, one of the others, or a plate
  bool other = false;                  // true if `with` is one of the others
  std::optional<joint::End> end = {};  // of the branch; empty: the nearer end
  How how;
  bool plate = false;  // true if `with` is a plate

  [[nodiscard]] bool of_members() const { return !other && !plate; }
};

/// Members of one structure with their joints. Priority, diameter and position determine which of
/// two members is the branch, as in joint::NodeSpec; through: the thinner one. Members found in
/// line get a butt joint or a mitre with the gap of `found`.
struct FrameSpec {
  std::vector<joint::Member> members;
  std::vector<Other> others;
  std::vector<StatedJoint> joints;
  std::optional<double> within = {};  // mm, as joint::Within; empty: only stated joints exist
  How found;                          // for joints of members that are not stated
  std::vector<plate::PlateSpec> plates = {};
};

/// One joint as both sides are cut for it.
struct FrameJoint {
  std::size_t branch = 0, chord = 0;  // for a mitre or a butt joint in the stated order
  bool other = false;                 // true if the chord is one of the others
  How how;                            // if set-in, with its depth
  std::optional<std::size_t> stated;  // empty: found
  bool plate = false;                 // true if the chord is a plate

  [[nodiscard]] bool of_members() const { return !other && !plate; }
};

/// One partner of an end, in the end's own frame.
struct Cutter {
  joint::Partner partner;
  std::optional<joint::Joint> stated;
  std::size_t joint = 0;
  double missing = 0.0;  // the cut follows the partner up to this far beyond its end, mm
};
/// A hole for a branch, which is given in the start's frame and points out of the chord.
struct Hole {
  joint::TubeCutter branch;  // of one that is not round: half its larger side
  double wall = 0.0;         // of the branch
  std::size_t member = 0, joint = 0;
  joint::End end = joint::End::start;  // of the branch; unused if it passes through
  bool square = false;                 // branch or chord is not round: see part::SquareHole
  joint::AxisLine axis = {};           // of the branch
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  // of a branch that is not round
};
/// Returns the indices of a piece's holes between round tubes.
[[nodiscard]] std::vector<std::size_t> round_holes(const std::vector<Hole>& holes);
/// The position of a branch, in the start's frame: around the tube by phi, or along the girth of
/// one that is not round.
struct Stand {
  double phi = 0.0, girth = 0.0, z = 0.0;  // rad; mm
  std::size_t member = 0;
};

/// A member as a part: the input of part::PartSpec except the cut options. Both ends have one x: on
/// the side of the member's `up`; else on the side where the first cutter that has a side, or the
/// first branch on the member, has clocking 0. Axes of cutters rise with z, and lists without an
/// order of their own are sorted along the member, so congruent members get equal pieces,
/// regardless of the direction in which their chords were drawn.
struct Piece {
  joint::Target target;      // not round: half its larger side
  joint::MemberFrame frame;  // of the start, in the world
  std::vector<Cutter> start, finish;
  std::vector<Hole> holes;
  std::vector<Stand> stands;
};

/// The reason why an end is left square at its work point, or why an other body cuts nothing.
enum class Why { free, cuts_the_others, parallel, not_joined };
struct NotCut {
  Why why = Why::free;
  std::size_t index = 0;  // of the member; for not_joined: of the other body
  std::optional<joint::End> end = {};
};

struct Frame {
  std::vector<Piece> pieces;       // of each member, in their order
  std::vector<FrameJoint> joints;  // stated joints in their order, then found joints
  std::vector<NotCut> not_cut;
  std::vector<Warning> warnings;  // of ends, and of members that overlap
  std::vector<FramePlate> plates = {};
};

/// Finds every joint once. From it derives the branch's end and the chord's hole, or both ends of a
/// mitre, so the two sides always agree.
///
/// Errors    those of joint::solve (members/...; joints/i/... for stated joints, defaults/... for
///           found ones) and of joint::overlaps; joint_contradicts (joints/i: two are already
///           joined; through, of two alike; butt, out of line), zero_length (others/i/...),
///           ambiguous_connection (joints/i: which end?), parallel_axes (others/i), cancelled;
///           of plates see frame_plate.hpp.
/// Accuracy  of joint::solve.
/// Cost      twice that of joint::solve, with joint::overlaps; otherwise linear in members.
[[nodiscard]] Result<Frame> solve(const FrameSpec& spec);

/// Verifies the requested parts by their own numbers: places them back into the world and compares
/// them with the centre-lines, and compares the two sides of each joint. `asked`: of each member;
/// if a part is refused by itself, it is null and is skipped.
[[nodiscard]] std::vector<Check> verify(const FrameSpec& spec, const Frame& frame,
                                        std::span<const part::PartSpec* const> asked);

}  // namespace tubecut::frame
