#include "api/endpoints/frames/tab_slots.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "api/endpoints/frames/cutter_fields.hpp"
#include "api/endpoints/frames/frame_pointers.hpp"
#include "api/limits.hpp"
#include "core/base/try.hpp"

namespace tubecut::api {
namespace {

constexpr std::size_t kMostTabs = 32;
constexpr Range kClearance{.min = 0.0, .max = 5.0};  // mm
constexpr Range kProud{.min = 0.0, .max = 100.0};
constexpr Range kTabWidth{.min = 1.0, .max = 1e4};
constexpr std::array<const char*, 6> kTabFields{
    "id", "tab_slots", "clearance_mm", "clearance_thickness_mm", "proud_mm", "slot_wall"};

enum class SlotWall { square, along };
constexpr std::array kSlotWalls{Option<SlotWall>{"square", SlotWall::square},
                                Option<SlotWall>{"along", SlotWall::along}};

std::string joint_path(std::size_t joint) { return "joints/" + std::to_string(joint); }

/// The width of the beam that cuts an end, or every cut.
double kerf_of(const FrameRequest& request, std::size_t member, std::optional<joint::End> end) {
  for (const auto& own : request.ends)
    if (own.member == member && end == own.end)
      if (const auto* width = own.cut.kerf.as<double>()) return *width;
  for (const auto& [name, value] : request.once)
    if (name == "kerf_mm")
      if (const auto* width = value.as<double>()) return *width;
  return 0.0;
}

std::string slot_name(const frame::TabStatement& stated, std::size_t k) {
  return stated.name + "." + std::to_string(k);
}

Json slot_of(const std::string& name, const frame::FaceSlot& slot) {
  Json::Object shape{{"kind", Json{"rectangle"}},
                     {"angle_deg", written::deg(Angle::rad(slot.turn))},
                     {"along_mm", written::mm(slot.along)},
                     {"round_mm", written::mm(slot.round)},
                     {"corner_radius_mm", written::mm(slot.corner)}};
  Json::Object at{
      {"z_mm", written::mm(slot.z)}, {"from", Json{"start"}}, {"z_zero", Json{"work_point"}}};
  Json::Object out{{"id", Json{name}}};
  if (slot.face == 0) {
    at.emplace_back("phi_deg", written::deg(Angle::rad(slot.phi)));
    out.emplace_back("wall", Json{slot.prism ? "normal" : "developed"});
    if (slot.prism) out.emplace_back("tilt", Json{"free"});
  } else {
    at.emplace_back("face", Json{static_cast<double>(slot.face)});
    at.emplace_back("offset_mm", written::mm(slot.offset));
    out.emplace_back("wall", Json{"normal"});
  }
  out.emplace_back("shape", Json{std::move(shape)});
  out.emplace_back("at", Json{std::move(at)});
  return Json{std::move(out)};
}

Json tab_of(const part::EndTab& tab) {
  return Json{Json::Object{{"face", Json{static_cast<double>(tab.face)}},
                           {"offset_mm", written::mm(tab.offset)},
                           {"width_mm", written::mm(tab.width)},
                           {"length_mm", written::mm(tab.length)}}};
}

/// Returns the names that a member's cut-outs have already.
std::set<std::string> names_of(const Json& cutouts) {
  std::set<std::string> out;
  if (const auto* all = cutouts.as<Json::Array>())
    for (const auto& one : *all)
      if (const auto* id = one.find("id"))
        if (const auto* name = id->as<std::string>()) out.insert(*name);
  return out;
}

void add_slots(FrameJob& frame, const frame::TabStatement& stated, const frame::FittedTabs& fitted,
               std::vector<Issue>& issues) {
  auto& cutouts = frame.cutouts[fitted.chord];
  const auto taken = names_of(cutouts);
  auto all = cutouts.as<Json::Array>() == nullptr ? Json::Array{} : *cutouts.as<Json::Array>();
  Json::Array tabs;
  bool taken_told = false;
  for (std::size_t k = 0; k < fitted.tabs.size(); ++k) {
    const auto name = slot_name(stated, k);
    if (taken.contains(name) && !taken_told) {
      taken_told = true;
      issues.push_back({.code = ErrorCode::duplicate_id,
                        .member = joint_path(stated.joint) + "/id",
                        .got = name,
                        .hint = "a cut-out of " + frame.spec.members[fitted.chord].name +
                                " has the name of this slot; give the joint another id"});
    }
    frame.slots[{fitted.chord, all.size()}] = {stated.joint, k};
    all.push_back(slot_of(name, fitted.tabs[k].slot));
    tabs.push_back(tab_of(fitted.tabs[k].tab));
  }
  cutouts = Json{std::move(all)};
  frame.end_tabs[{fitted.branch, fitted.end}] = Json{std::move(tabs)};
}

/// The beam's fillets between the tabs and the shoulder meet the slots' edges.
void warn_of_shoulder(FrameJob& frame, const frame::TabStatement& stated, double off) {
  if (!(off > 0.0)) return;
  const double fillet = 0.5 * stated.end_kerf;
  frame.frame.warnings.push_back(
      {.code = WarningCode::shoulder_off,
       .member = in_request(frame, joint_path(stated.joint) + "/clearance"),
       .detail = "by " + brief(off) + " mm, on fillets of " + brief(fillet) +
                 " mm; with this as clearance_mm it bears",
       .most = off});
}

/// The tabs and slots as the two parts request them.
frame::FittedTabs as_requested(const FrameJob& frame, std::size_t of) {
  auto out = frame.fitted[of];
  const auto *branch = frame.own(out.branch), *chord = frame.own(out.chord);
  if (branch == nullptr || chord == nullptr) return {};
  const auto& asked = branch->of_section;
  const auto& tabs = out.end == joint::End::start ? asked.start_tabs : asked.finish_tabs;
  for (std::size_t k = 0; k < out.tabs.size(); ++k) {
    if (k < tabs.size()) out.tabs[k].tab = tabs[k];
    const auto name = slot_name(frame.tabs[of], k);
    for (const auto& one : chord->part.cutouts.all) {
      const auto* shape = std::get_if<cutout::Rectangle>(&one.shape);
      if (one.id != name || shape == nullptr) continue;
      const bool prism = one.wall == cutout::Wall::normal && one.tilt == bevel::Tilt::free;
      out.tabs[k].slot = {one.at.face,  one.at.phi,    one.at.z, one.at.offset, shape->along,
                          shape->round, shape->radius, one.turn, prism};
    }
  }
  return out;
}

}  // namespace

void note_tab_slots(Reader& in) {
  for (const auto* name : kTabFields) in.note(name);
}

frame::TabStatement decode_tab_slots(Reader& in, std::size_t joint) {
  frame::TabStatement out{.joint = joint};
  if (const auto id = in.optional_text("id")) out.name = *id;
  const auto tabs =
      in.array("tab_slots", {.min = 1, .max = kMostTabs}, [](Reader& t) -> frame::StatedTab {
        const int face = t.integer("face", 1, 4);
        const double offset = t.number("offset_mm", kOffset, 0.0);
        return {face, offset, t.number("width_mm", kTabWidth)};
      });
  out.tabs = tabs;
  out.clearance.width = in.number("clearance_mm", kClearance);
  out.clearance.thickness = in.number("clearance_thickness_mm", kClearance, out.clearance.width);
  out.proud = in.number("proud_mm", kProud, 0.0);
  out.along = in.choice("slot_wall", kSlotWalls, SlotWall::square) == SlotWall::along;
  return out;
}

std::vector<std::string> slot_names(const frame::TabStatement& stated) {
  std::vector<std::string> out;
  for (std::size_t k = 0; k < stated.tabs.size(); ++k) out.push_back(slot_name(stated, k));
  return out;
}

OwnCut cut_with_tabs() {
  return {.groove = Json{Json::Object{{"rule", Json{"square"}}}},
          .contact = Json{"auto"},
          .root_face = Json{0.0},
          .smoothing = Json{Json::Object{{"method", Json{"none"}}}}};
}

Result<void> add_tab_slots(FrameJob& frame) {
  std::vector<Issue> issues;
  for (auto& stated : frame.tabs) {
    const auto& said = frame.spec.joints[stated.joint];
    const auto branch = frame::tabbed_member(frame.spec, said);
    if (stated.name.empty()) stated.name = frame.spec.members[branch].name;
    stated.slot_kerf =
        kerf_of(frame, branch == said.member ? said.with : said.member, std::nullopt);
    stated.end_kerf = stated.slot_kerf;
    const auto& piece = frame.frame.pieces[branch];
    for (const auto& [cutters, end] :
         {std::pair{&piece.start, joint::End::start}, std::pair{&piece.finish, joint::End::finish}})
      for (const auto& one : *cutters)
        if (frame.frame.joints[one.joint].stated == stated.joint)
          stated.end_kerf = kerf_of(frame, branch, end);
    stated.tilts = frame.preset != Preset::tube_laser;
    auto fitted = frame::fit_tabs(frame.spec, frame.frame, stated);
    if (!fitted) {
      for (auto& one : fitted.error().issues) issues.push_back(std::move(one));
      continue;
    }
    frame.fitted.push_back(*std::move(fitted));
    warn_of_shoulder(frame, stated, frame.fitted.back().stands_off);
    add_slots(frame, stated, frame.fitted.back(), issues);
  }
  if (!issues.empty()) return tl::unexpected(Error{std::move(issues)});
  return {};
}

std::vector<Check> verify_tab_slots(const FrameJob& frame) {
  if (frame.fitted.empty()) return {};
  double worst = 0.0;
  for (std::size_t i = 0; i < frame.fitted.size(); ++i)
    worsen(worst, frame::tabs_lack(frame.spec, frame.frame, frame.tabs[i], as_requested(frame, i)));
  return {{"tab_in_slot", worst, 1e-5, "mm"}};
}

}  // namespace tubecut::api
