#include "core/frame/tab_slots.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/base/angle.hpp"
#include "core/base/elementary.hpp"
#include "core/base/rounding.hpp"
#include "core/cutout/flats.hpp"
#include "core/frame/tab_place.hpp"

namespace tubecut::frame {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using joint::End;

constexpr double kStraight = 1e-9;  // of a turned slot
constexpr double kUpright = 0.01;   // mm, that a slot along its tab may lean
constexpr double kAskew = 1.0 * kRadPerDeg;

/// The face of the chord that a tab meets first, and where its middle line meets the outside.
struct Entry {
  int face = 1;
  cutout::PlaneWall wall;
  Vector3d at;
};

std::optional<Entry> flat_of(const joint::Member& chord, const Piece& piece, const WorldTab& tab) {
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
    const double fillet = 0.5 * stated_.end_kerf;
    out_.stands_off = cutout::shoulder_stands_off(fillet, stated_.clearance.width);
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
    out_.branch = tabbed_member(spec_, said);
    out_.chord = out_.branch == said.member ? said.with : said.member;
    if (!branch().section) {
      const bool first = out_.branch == said.member;
      issue(ErrorCode::unsupported_combination, first ? "between/0" : "between/1",
            "tabs are parts of faces: use a rectangular member, or give the tabs to the other one");
      return false;
    }
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

  /// The slot's corners are as round as its beam leaves them, where the tab's are sharp.
  void check_corners(double lacks, double corner) {
    if (!(lacks > kKept) || narrow_told_) return;
    narrow_told_ = true;
    issues_.push_back({.code = ErrorCode::slot_too_narrow,
                       .member = at_ + "/clearance",
                       .got = stated_.clearance.width,
                       .limit = rounded_up(corner / (2.0 + std::sqrt(2.0))),
                       .unit = "mm",
                       .hint = "the beam rounds the slot's corners by " + brief(corner) +
                               " mm, where the tab's are sharp; with the limit on all sides they "
                               "stay clear"});
  }

  void fit_tab(const section::Wall& wall, std::size_t k) {
    const auto& asked = stated_.tabs[k];
    const auto before = issues_.size();
    check_tab(wall, k);
    if (issues_.size() > before) return;
    const auto tab = tab_in_world(spec_, frame_, out_.branch, out_.end, asked);
    if (chord().section)
      fit_flat(tab, k);
    else
      fit_round(tab, k);
  }

  void add(std::size_t k, double length, const FaceSlot& slot) {
    const auto& asked = stated_.tabs[k];
    out_.tabs.push_back(
        {{.face = asked.face, .offset = asked.offset, .width = asked.width, .length = length},
         slot});
  }

  void fit_flat(const WorldTab& tab, std::size_t k) {
    const auto& piece = frame_.pieces[out_.chord];
    const auto entry = flat_of(chord(), piece, tab);
    if (!entry)
      return issue(ErrorCode::out_of_range, tab_field(k, "offset"),
                   "the tab meets no flat of " + chord().name + " at 20 deg or more");
    const auto slot = cutout::slot_in_plane(tab.tab, entry->wall, stated_.clearance);
    const auto on_face = slot_on_face(chord(), piece, *entry, slot, stated_.slot_kerf);
    const auto& s = *chord().section;
    check_upright(2.0 * slot.middle.norm());
    check_slot(on_face, k);
    check_corners(cutout::tab_lacks(tab.tab, entry->wall, slot, stated_.clearance, on_face.corner),
                  on_face.corner);
    check_proud(2.0 * s.outer().face_distance(entry->face) - 2.0 * s.wall);
    add(k, (entry->wall.thickness + stated_.proud) / -tab.tab.axis.dot(entry->wall.normal),
        on_face);
  }

  void fit_round(const WorldTab& tab, std::size_t k) {
    const auto entry = entry_of(frame_.pieces[out_.chord], tab, stated_.clearance);
    const auto before = issues_.size();
    check_way(entry, k);
    if (issues_.size() > before) return;
    const auto slot = slot_of(*entry, stated_.along, stated_.slot_kerf);
    const double inner = entry->wall.inner;
    const auto x = [&](double y) { return std::sqrt((inner - y) * (inner + y)); };
    const double out = x(entry->tab.nearest());
    check_upright((entry->wall.outer - inner) * std::abs(entry->tab.lean));
    check_middle(*entry);
    check_narrow(slot, 2.0 * slot.corner, k);
    check_corners(tab_lacks(*entry, slot), slot.corner);
    check_proud(out + x(entry->tab.farthest()));
    add(k, (entry->tab.deep(entry->wall) + stated_.proud) / entry->sine, slot);
  }

  /// A tab goes into a round wall with its sides along the tube, and within the bore's width.
  void check_way(const std::optional<RoundEntry>& entry, std::size_t k) {
    const double most = entry ? rounded_down(most_across(*entry)) : 0.0;
    if (!(most > 0.0))
      return issue(ErrorCode::out_of_range, "between",
                   branch().name + " meets " + chord().name + " at less than 20 deg");
    if (entry->askew > kAskew)
      return issue(ErrorCode::unsupported_combination, tab_field(k, "face"),
                   "this face is turned by " + brief(entry->askew * kDegPerRad) +
                       " deg out of the axis of " + chord().name + ", which is round; turn " +
                       branch().name +
                       " about its own axis (up), so that two of its faces lie along that axis");
    const double reach = entry->tab.farthest() + entry->clearance.x();
    if (reach <= most) return;
    const bool wide = entry->across && stated_.tabs[k].offset == 0.0;
    issues_.push_back({.code = ErrorCode::out_of_range,
                       .member = at_ + "/" + tab_field(k, wide ? "width" : "offset"),
                       .got = wide ? stated_.tabs[k].width : stated_.tabs[k].offset,
                       .unit = "mm",
                       .hint = "with its clearance the tab reaches " + brief(rounded_up(reach)) +
                               " mm from the middle of " + chord().name +
                               ", where its bore falls away; at most " + brief(most) +
                               " mm meet it at 20 deg or more"});
  }

  /// Walls along a tab are made where they are square to a flat, or those of a prism.
  void check_upright(double leans) {
    if (!stated_.along || along_told_ || !(leans > kUpright)) return;
    along_told_ = true;
    issue(ErrorCode::unsupported_combination, "slot_wall",
          "the tab leans: over the wall it moves by " + brief(leans) +
              " mm along it, and cut-outs have no walls that lean like this; use square, whose "
              "slots are longer by this way");
  }

  void check_middle(const RoundEntry& entry) {
    if (!stated_.along || along_told_) return;
    const double off = std::abs(entry.tab.middle.x());
    const bool centred = off <= kUpright;
    if (centred && stated_.tilts) return;
    along_told_ = true;
    issue(ErrorCode::unsupported_combination, "slot_wall",
          centred ? "walls along a tab lean across the round tube, and the tube laser's head never "
                    "tilts; use square"
                  : "the tab goes in " + brief(off) + " mm off the middle of " + chord().name +
                        "; walls along it are made only in the middle: use square");
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

  void check_narrow(const FaceSlot& slot, double beam, std::size_t k) {
    const double narrow = std::min(slot.along, slot.round);
    if (narrow > beam) return;
    issues_.push_back({.code = ErrorCode::out_of_range,
                       .member = at_ + "/" + tab_field(k, "width"),
                       .got = narrow,
                       .limit = beam,
                       .unit = "mm",
                       .hint = "the slot must be wider than the beam that cuts it"});
  }

  void check_slot(const FaceSlot& slot, std::size_t k) {
    check_narrow(slot, stated_.slot_kerf, k);
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

  void check_proud(double inside) {
    if (proud_told_ || stated_.proud < inside) return;
    proud_told_ = true;
    issues_.push_back({.code = ErrorCode::out_of_range,
                       .member = at_ + "/proud",
                       .got = stated_.proud,
                       .limit = rounded_down(inside),
                       .unit = "mm",
                       .hint = "the tab must end before the far wall"});
  }

  static constexpr double kKept = 1e-6;         // mm, of the clearances
  static constexpr double kRoundOff = 1e-9;     // mm
  static constexpr double kBetweenTabs = 0.01;  // mm

  const FrameSpec& spec_;
  const Frame& frame_;
  const TabStatement& stated_;
  std::string at_;
  std::vector<Issue> issues_;
  bool narrow_told_ = false, along_told_ = false, proud_told_ = false;  // once for all tabs
  FittedTabs out_;
};

/// A slot on a flat, and the tip of its tab.
double lack_on_flat(const joint::Member& chord, const Piece& piece, const WorldTab& tab,
                    const TabStatement& stated, const FittedTab& one) {
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
  double worst = cutout::tab_lacks(tab.tab, wall, slot, stated.clearance, one.slot.corner);
  worsen(worst, std::abs(one.tab.length * into - chord.section->wall - stated.proud));
  return worst;
}

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
    if (one.slot.face > 0) {
      worsen(worst, lack_on_flat(chord, piece, tab, stated, one));
      continue;
    }
    const auto entry = entry_of(piece, tab, stated.clearance);
    if (!entry) return std::numeric_limits<double>::infinity();
    worsen(worst, tab_lacks(*entry, one.slot));
    worsen(worst,
           std::abs(one.tab.length * entry->sine - entry->tab.deep(entry->wall) - stated.proud));
  }
  return worst;
}

}  // namespace tubecut::frame
