#include "core/frame/tab_slots.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/base/elementary.hpp"
#include "core/base/rounding.hpp"
#include "core/cutout/flats.hpp"

namespace tubecut::frame {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using joint::End;

constexpr double kLeastSine = 0.35;  // of the angle between tab and wall: about 20 deg
constexpr double kStraight = 1e-9;   // of a turned slot

/// A face of a member's part in the world.
struct WorldFace {
  Vector3d point, normal, round, along;  // on its middle line; round: as s grows

  WorldFace(const joint::Member& member, const Piece& piece, int face) {
    const Vector2d n = section::Curve::face_normal(face);
    const auto turned = piece.frame.rows.transpose();
    normal = turned * Vector3d(n.x(), n.y(), 0.0);
    round = turned * Vector3d(-n.y(), n.x(), 0.0);
    along = turned * Vector3d::UnitZ();
    point = piece.frame.origin + member.section->outer().face_distance(face) * normal;
  }
};

/// A tab in the world: its middle line and its sides.
struct WorldTab {
  Vector3d middle;  // of the wall's thickness, anywhere along the line
  cutout::Tab tab;
};

WorldTab tab_in_world(const FrameSpec& spec, const Frame& frame, std::size_t branch, End end,
                      const StatedTab& stated) {
  const auto& member = spec.members[branch];
  const WorldFace face(member, frame.pieces[branch], stated.face);
  const double wall = member.section->wall;
  const Vector3d out = end == End::start ? Vector3d(-face.along) : face.along;
  return {face.point - 0.5 * wall * face.normal + stated.offset * face.round,
          {.axis = out, .face = face.normal, .width = stated.width, .thickness = wall}};
}

/// The face of the chord that a tab meets first, and where its middle line meets the outside.
struct Entry {
  int face = 1;
  cutout::PlaneWall wall;
  Vector3d at;
};

std::optional<Entry> entry_of(const joint::Member& chord, const Piece& piece, const WorldTab& tab) {
  std::optional<Entry> best;
  double nearest = std::numeric_limits<double>::infinity();
  const section::Wall wall(*chord.section);
  for (int number = 1; number <= 4; ++number) {
    const WorldFace face(chord, piece, number);
    const double into = -tab.tab.axis.dot(face.normal);
    if (!(into > kLeastSine)) continue;
    const double way = (tab.middle - face.point).dot(face.normal) / into;
    const Vector3d at = tab.middle + way * tab.tab.axis;
    if (!(std::abs((at - face.point).dot(face.round)) < cutout::half_flat(wall, number))) continue;
    if (!(way < nearest)) continue;
    nearest = way;
    best = Entry{number, {face.normal, chord.section->wall}, at};
  }
  return best;
}

FaceSlot slot_on_face(const joint::Member& chord, const Piece& piece, const Entry& entry,
                      const cutout::PlaneSlot& slot, double kerf) {
  const WorldFace face(chord, piece, entry.face);
  const Vector3d middle = entry.at + slot.middle;
  FaceSlot out{.face = entry.face,
               .z = piece.frame.local(middle).z(),
               .offset = (middle - face.point).dot(face.round),
               .along = slot.length,
               .round = slot.width,
               .corner = std::min(0.5 * kerf, 0.5 * std::min(slot.length, slot.width))};
  const double a = slot.along.dot(face.along), b = slot.along.dot(face.round);
  if (std::abs(a) < kStraight)
    std::swap(out.along, out.round);
  else if (std::abs(b) > kStraight)
    out.turn = elementary::atan2(a < 0.0 ? -b : b, std::abs(a));
  return out;
}

/// Half of the room that a turned slot takes up around the tube, with round corners.
double half_round(const FaceSlot& slot) {
  const auto turn = elementary::sincos(slot.turn);
  const double flat = 0.5 * (slot.round - 2.0 * slot.corner) * std::abs(turn.cos) +
                      0.5 * (slot.along - 2.0 * slot.corner) * std::abs(turn.sin);
  return flat + slot.corner;
}

/// Finds both sides of one joint.
class Fitter {
 public:
  Fitter(const FrameSpec& spec, const Frame& frame, const TabStatement& stated)
      : spec_(spec),
        frame_(frame),
        stated_(stated),
        at_("joints/" + std::to_string(stated.joint)) {}

  Result<FittedTabs> fit() {
    if (!find_ends()) return tl::unexpected(Error{std::move(issues_)});
    check_corners();
    check_shoulder();
    const section::Wall wall(*branch().section);
    for (std::size_t k = 0; k < stated_.tabs.size(); ++k) fit_tab(wall, k);
    if (!issues_.empty()) return tl::unexpected(Error{std::move(issues_)});
    return std::move(out_);
  }

 private:
  [[nodiscard]] const joint::Member& branch() const { return spec_.members[out_.branch]; }
  [[nodiscard]] const joint::Member& chord() const { return spec_.members[out_.chord]; }

  void issue(ErrorCode code, const std::string& field, std::string hint) {
    issues_.push_back({.code = code, .member = at_ + "/" + field, .hint = std::move(hint)});
  }
  [[nodiscard]] static std::string tab_field(std::size_t k, const char* field) {
    return "tab_slots/" + std::to_string(k) + "/" + field;
  }

  /// Finds the end of the first member that the second one cuts.
  bool find_ends() {
    const auto& said = spec_.joints[stated_.joint];
    out_.branch = said.member;
    out_.chord = said.with;
    const char* flat = "tabs and slots lie on faces: use a rectangular member";
    if (!branch().section) issue(ErrorCode::unsupported_combination, "between/0", flat);
    if (!chord().section) issue(ErrorCode::unsupported_combination, "between/1", flat);
    if (!issues_.empty()) return false;
    for (const auto end : {End::start, End::finish}) {
      const auto& piece = frame_.pieces[out_.branch];
      const auto& cutters = end == End::start ? piece.start : piece.finish;
      const auto of_joint = [&](const Cutter& one) {
        return frame_.joints[one.joint].stated == stated_.joint;
      };
      if (std::ranges::none_of(cutters, of_joint)) continue;
      out_.end = end;
      if (cutters.size() == 1) return true;
      issue(ErrorCode::unsupported_combination, "kind",
            "another body cuts this end too; an end with tabs has one partner");
      return false;
    }
    issue(ErrorCode::joint_contradicts, "between",
          "the member with the tabs comes first and ends on the other one; give the other one the "
          "lower priority number");
    return false;
  }

  /// The slot's corners are as round as its beam leaves them.
  void check_corners() {
    const double corner = 0.5 * stated_.slot_kerf;
    if (!(corner > cutout::largest_slot_corner(stated_.clearance) + kRoundOff)) return;
    const double least = rounded_up(corner / (2.0 + std::sqrt(2.0)));
    issues_.push_back({.code = ErrorCode::out_of_range,
                       .member = at_ + "/clearance",
                       .got = stated_.clearance.width,
                       .limit = least,
                       .unit = "mm",
                       .hint = "the beam rounds the slot's corners by " + brief(corner) +
                               " mm, where the tab's are sharp; with the limit on all sides they "
                               "stay clear"});
  }

  /// The beam leaves fillets between the tabs and the shoulder.
  void check_shoulder() {
    const double fillet = 0.5 * stated_.end_kerf;
    const double off = cutout::shoulder_stands_off(fillet, stated_.clearance.width);
    if (!(off > 0.0)) return;
    issues_.push_back(
        {.code = ErrorCode::out_of_range,
         .member = at_ + "/clearance",
         .got = stated_.clearance.width,
         .limit = rounded_up(fillet),
         .unit = "mm",
         .hint = "the beam's fillets next to the tabs would hold the shoulder off by " +
                 brief(off) + " mm"});
  }

  void fit_tab(const section::Wall& wall, std::size_t k) {
    const auto& asked = stated_.tabs[k];
    const auto before = issues_.size();
    check_tab(wall, k);
    if (issues_.size() > before) return;
    const auto tab = tab_in_world(spec_, frame_, out_.branch, out_.end, asked);
    const auto& piece = frame_.pieces[out_.chord];
    const auto entry = entry_of(chord(), piece, tab);
    if (!entry)
      return issue(ErrorCode::out_of_range, tab_field(k, "offset"),
                   "the tab meets no flat of " + chord().name + " at 20 deg or more");
    const auto slot = cutout::slot_in_plane(tab.tab, entry->wall, stated_.clearance);
    const auto on_face = slot_on_face(chord(), piece, *entry, slot, stated_.slot_kerf);
    check_slot(on_face, k);
    const double into = -tab.tab.axis.dot(entry->wall.normal);
    check_proud(*entry, k);
    out_.tabs.push_back({{.face = asked.face,
                          .offset = asked.offset,
                          .width = asked.width,
                          .length = (entry->wall.thickness + stated_.proud) / into},
                         on_face});
  }

  void check_tab(const section::Wall& wall, std::size_t k) {
    const auto& tab = stated_.tabs[k];
    const double most = rounded_down(
        2.0 * (cutout::half_flat(wall, tab.face) - std::abs(tab.offset)) - stated_.end_kerf);
    if (!(tab.width <= most))
      issues_.push_back({.code = ErrorCode::out_of_range,
                         .member = at_ + "/" + tab_field(k, "width"),
                         .got = tab.width,
                         .limit = std::max(0.0, most),
                         .unit = "mm",
                         .hint = "the tab, with the beam on both sides, must lie on the flat of "
                                 "face " +
                                 std::to_string(tab.face) + " of " + branch().name});
    for (std::size_t i = 0; i < k; ++i) {
      const auto& other = stated_.tabs[i];
      const double apart = std::abs(tab.offset - other.offset) - 0.5 * (tab.width + other.width);
      const double least = std::max(stated_.end_kerf, 2.0 * stated_.clearance.width) + kBetweenTabs;
      if (tab.face == other.face && apart < least)
        issues_.push_back({.code = ErrorCode::out_of_range,
                           .member = at_ + "/" + tab_field(k, "offset"),
                           .got = tab.offset,
                           .unit = "mm",
                           .hint = "between tabs of one face must be at least " +
                                   brief(rounded_up(least)) +
                                   " mm, for the beam and the wall between the slots; from this "
                                   "one to tab_slots/" +
                                   std::to_string(i) + " are " + brief(apart) + " mm"});
    }
  }

  void check_slot(const FaceSlot& slot, std::size_t k) {
    const double narrow = std::min(slot.along, slot.round);
    if (!(narrow > stated_.slot_kerf))
      issues_.push_back({.code = ErrorCode::out_of_range,
                         .member = at_ + "/" + tab_field(k, "width"),
                         .got = narrow,
                         .limit = stated_.slot_kerf,
                         .unit = "mm",
                         .hint = "the slot must be wider than the beam that cuts it"});
    const double half = cutout::half_flat(section::Wall(*chord().section), slot.face);
    const double beyond = std::abs(slot.offset) + half_round(slot) - half;
    if (beyond > kRoundOff)
      issues_.push_back({.code = ErrorCode::out_of_range,
                         .member = at_ + "/" + tab_field(k, "offset"),
                         .got = stated_.tabs[k].offset,
                         .unit = "mm",
                         .hint = "the slot reaches " + brief(rounded_up(beyond)) +
                                 " mm beyond the flat of face " + std::to_string(slot.face) +
                                 " of " + chord().name +
                                 "; move the tab, make it narrower or lessen the clearance"});
  }

  void check_proud(const Entry& entry, std::size_t k) {
    const auto& s = *chord().section;
    const double inside = s.outer().face_distance(entry.face) * 2.0 - 2.0 * s.wall;
    if (k > 0 || stated_.proud < inside) return;
    issues_.push_back({.code = ErrorCode::out_of_range,
                       .member = at_ + "/proud",
                       .got = stated_.proud,
                       .limit = rounded_down(inside),
                       .unit = "mm",
                       .hint = "the tab must end before the far wall"});
  }

  static constexpr double kRoundOff = 1e-9;     // mm
  static constexpr double kBetweenTabs = 0.01;  // mm

  const FrameSpec& spec_;
  const Frame& frame_;
  const TabStatement& stated_;
  std::string at_;
  std::vector<Issue> issues_;
  FittedTabs out_;
};

}  // namespace

Result<FittedTabs> fit_tabs(const FrameSpec& spec, const Frame& frame, const TabStatement& stated) {
  return Fitter(spec, frame, stated).fit();
}

double tabs_lack(const FrameSpec& spec, const Frame& frame, const TabStatement& stated,
                 const FittedTabs& asked) {
  double worst = -std::numeric_limits<double>::infinity();
  const auto& chord = spec.members[asked.chord];
  const auto& piece = frame.pieces[asked.chord];
  for (const auto& one : asked.tabs) {
    const auto tab = tab_in_world(spec, frame, asked.branch, asked.end,
                                  {one.tab.face, one.tab.offset, one.tab.width});
    const WorldFace face(chord, piece, one.slot.face);
    const cutout::PlaneWall wall{face.normal, chord.section->wall};
    const double into = -tab.tab.axis.dot(face.normal);
    const double way = (tab.middle - face.point).dot(face.normal) / into;
    const Vector3d entry = tab.middle + way * tab.tab.axis;
    const auto turn = elementary::sincos(one.slot.turn);
    // From the part's own numbers: the slot's sides, turned, about its middle.
    const Vector3d u = turn.cos * face.along + turn.sin * face.round;
    const Vector3d v = turn.cos * face.round - turn.sin * face.along;
    const Vector3d middle = piece.frame.origin + one.slot.z * face.along +
                            (face.point - piece.frame.origin) + one.slot.offset * face.round;
    const bool along = std::abs(u.dot(tab.tab.face)) < std::abs(v.dot(tab.tab.face));
    const cutout::PlaneSlot slot{.along = along ? u : v,
                                 .across = along ? v : u,
                                 .length = along ? one.slot.along : one.slot.round,
                                 .width = along ? one.slot.round : one.slot.along,
                                 .middle = middle - entry};
    worsen(worst, cutout::tab_lacks(tab.tab, wall, slot, stated.clearance, one.slot.corner));
    worsen(worst, std::abs(one.tab.length * into - chord.section->wall - stated.proud));
  }
  return worst;
}

}  // namespace tubecut::frame
