#include "api/endpoints/frames/frame_part.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

#include "api/endpoints/frames/cutter_fields.hpp"
#include "api/endpoints/frames/frame_shape.hpp"
#include "api/wire/frame_names.hpp"
#include "api/wire/sha256.hpp"
#include "api/wire/writer.hpp"
#include "core/base/stop.hpp"
#include "core/base/try.hpp"

namespace tubecut::api {
namespace {

/// Names of the parts. Without ids, only the marks on a part are named.
struct Names {
  bool ids = false;
  std::vector<std::string> of_members;  // of the part that each is
};

class PartWriter {
 public:
  PartWriter(const FrameRequest& request, const frame::Frame& frame)
      : request_(request), frame_(frame) {
    for (std::size_t i = 0; i < request.ends.size(); ++i)
      own_ends_.emplace(std::pair{request.ends[i].member, request.ends[i].end}, i);
  }

  [[nodiscard]] Result<Json> part(std::size_t member, const Names& names) const {
    const auto& piece = frame_.pieces[member];
    auto target = shape(member);
    target.emplace_back("length_mm", written::mm(*piece.target.length));
    if (names.ids) target.emplace(target.begin(), "id", Json{names.of_members[member]});
    TRY(auto start, end(member, joint::End::start, names));
    TRY(auto finish, end(member, joint::End::finish, names));
    Json::Object out{
        {"target", Json{std::move(target)}},
        {"ends", Json{Json::Object{{"start", std::move(start)}, {"finish", std::move(finish)}}}}};
    if (!piece.stands.empty()) out.emplace_back("marks", marks(member, piece, names));
    if (!piece.holes.empty()) {
      TRY(auto all, holes(piece, names));
      out.emplace_back("holes", std::move(all));
    }
    if (const auto& cutouts = request_.cutouts[member]; !(cutouts == Json{}))
      out.emplace_back("cutouts", cutouts);
    if (const auto& texts = request_.texts[member]; !(texts == Json{}))
      out.emplace_back("texts", texts);
    for (const auto& one : request_.once)
      if (one.first != "accept")
        out.push_back(one);
      else
        out.emplace_back(one.first, limits_of(member, one.second));
    return Json{std::move(out)};
  }

 private:
  /// Returns the limits that something is measured for in this member's part, because a part by
  /// itself refuses the others.
  [[nodiscard]] Json limits_of(std::size_t member, const Json& accept) const {
    const Measured of{.preset = request_.preset,
                      .round = !is_section(member),
                      .cutouts = !(request_.cutouts[member] == Json{}),
                      .holes = !frame_.pieces[member].holes.empty()};
    Json::Object out;
    if (const auto* limits = accept.as<Json::Object>())
      for (const auto& one : *limits)
        if (missing_for(one.first, of).empty()) out.push_back(one);
    return Json{std::move(out)};
  }

  [[nodiscard]] bool is_section(std::size_t member) const {
    return request_.spec.members[member].section.has_value();
  }

  /// Returns diameter and wall, or the section as it is given.
  [[nodiscard]] Json::Object shape(std::size_t member) const {
    if (is_section(member)) return request_.sections[member];
    return {{"outer_diameter_mm", written::mm(2.0 * frame_.pieces[member].target.outer_radius)},
            {"wall_mm", Json{request_.walls[member]}}};
  }

  [[nodiscard]] const OwnCut* said(std::size_t joint) const {
    const auto& stated = frame_.joints[joint].stated;
    return stated ? &request_.cuts[*stated] : nullptr;
  }

  [[nodiscard]] const std::vector<frame::Cutter>& cutters(std::size_t member,
                                                          joint::End end) const {
    const auto& piece = frame_.pieces[member];
    return end == joint::End::start ? piece.start : piece.finish;
  }

  /// Returns the value of a field that the joints of an end give; null if no joint gives one.
  [[nodiscard]] Result<Json> said_of(const std::vector<frame::Cutter>& cutters, const char* field,
                                     Json OwnCut::*of) const {
    const Json* first = nullptr;
    for (const auto& one : cutters) {
      const auto* own = said(one.joint);
      const bool on_hole =
          of == &OwnCut::groove && frame_.joints[one.joint].how.kind == frame::How::Kind::set_in;
      if (own == nullptr || own->*of == Json{} || on_hole) continue;
      if (first != nullptr && !(*first == own->*of))
        return fail(
            {.code = ErrorCode::joint_contradicts,
             .member = "joints/" + std::to_string(*frame_.joints[one.joint].stated) + "/" + field,
             .hint = "another joint of this end contradicts it"});
      first = &(own->*of);
    }
    return first == nullptr ? Json{} : *first;
  }

  /// Returns the groove of an end that is set in a plate, which is flush at its depth; else null. A
  /// tube laser cuts it square as all ends.
  [[nodiscard]] Json flush_in_plate(const std::vector<frame::Cutter>& cutters) const {
    const bool in_plate = std::ranges::any_of(cutters, [&](const frame::Cutter& one) {
      const auto& joint = frame_.joints[one.joint];
      return joint.plate && joint.how.kind == frame::How::Kind::set_in;
    });
    if (!in_plate || request_.preset == Preset::tube_laser) return {};
    return Json{Json::Object{{"rule", Json{"none"}}}};
  }

  /// Returns the cut of an end: its own values, else those of its joints, else the defaults.
  [[nodiscard]] Result<Json::Object> cut(std::size_t member, joint::End end) const {
    auto out = request_.end;
    const auto own = own_ends_.find({member, end});
    for (const auto& [field, of] : {std::pair{"groove", &OwnCut::groove},
                                    {"contact", &OwnCut::contact},
                                    {"root_face_mm", &OwnCut::root_face},
                                    {"smoothing", &OwnCut::smoothing}}) {
      auto value = own == own_ends_.end() ? Json{} : request_.ends[own->second].cut.*of;
      if (value == Json{}) {
        TRY(value, said_of(cutters(member, end), field, of));
      }
      if (value == Json{} && of == &OwnCut::groove) value = flush_in_plate(cutters(member, end));
      if (value == Json{}) continue;
      std::ranges::find(out, field, &Json::Member::first)->second = std::move(value);
    }
    if (const auto kerf = own_kerf(own); !(kerf == Json{})) out.emplace_back("kerf_mm", kerf);
    return out;
  }

  using OwnEnds = std::map<std::pair<std::size_t, joint::End>, std::size_t>;
  [[nodiscard]] Json own_kerf(OwnEnds::const_iterator own) const {
    return own == own_ends_.end() ? Json{} : request_.ends[own->second].cut.kerf;
  }

  /// Returns an end that is left square: it has only a kerf.
  [[nodiscard]] Result<Json> square_end(std::size_t member, joint::End end) const {
    Json::Object out{{"square_at_mm", Json{0.0}}};
    const auto own = own_ends_.find({member, end});
    if (own == own_ends_.end()) return Json{std::move(out)};
    const auto& cut = request_.ends[own->second].cut;
    for (const auto& [field, value] : {std::pair{"groove", &cut.groove},
                                       {"contact", &cut.contact},
                                       {"root_face_mm", &cut.root_face},
                                       {"smoothing", &cut.smoothing}})
      if (!(*value == Json{}))
        return fail({.code = ErrorCode::unsupported_combination,
                     .member = "ends/" + std::to_string(own->second) + "/" + field,
                     .hint = "nothing is joined to this end: it is left square"});
    if (!(cut.kerf == Json{})) out.emplace_back("kerf_mm", cut.kerf);
    return Json{std::move(out)};
  }

  [[nodiscard]] Result<Json> end(std::size_t member, joint::End which, const Names& names) const {
    const auto& all = cutters(member, which);
    if (all.empty()) return square_end(member, which);
    Json::Array cutters, joints;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const auto kind =
          joint::by_kind(all[i].partner, []<class Kind>(const Kind&) { return Kind::kName; });
      Json::Object cutter{{"kind", Json{std::string(kind)}}};
      if (names.ids)
        if (const auto name = cutter_name(all[i], names); !name.empty())
          cutter.emplace_back("id", Json{name});
      std::ranges::move(joint::by_kind(all[i].partner, written::Fields{}),
                        std::back_inserter(cutter));
      cutters.emplace_back(std::move(cutter));
      if (all[i].stated) joints.push_back(joint(i, *all[i].stated, all[i].missing));
    }
    Json::Object out{{"cutters", Json{std::move(cutters)}}, {"joints", Json{std::move(joints)}}};
    TRY(auto how, cut(member, which));
    for (auto& one : how) out.push_back(std::move(one));
    if (const auto tabs = request_.end_tabs.find({member, which}); tabs != request_.end_tabs.end())
      out.emplace_back("end_tabs", tabs->second);
    return Json{std::move(out)};
  }

  /// A mitre's plane is nobody's.
  [[nodiscard]] std::string cutter_name(const frame::Cutter& one, const Names& names) const {
    const auto& joint = frame_.joints[one.joint];
    if (joint.other) return request_.spec.others[joint.chord].name;
    if (joint.plate) return request_.spec.plates[joint.chord].name;
    if (std::holds_alternative<joint::PlaneCutter>(one.partner)) return {};
    return names.of_members[joint.chord];
  }

  static Json joint(std::size_t cutter, const joint::Joint& joint, double missing) {
    Json::Object out{{"cutter", Json{static_cast<double>(cutter)}},
                     {"kind", Json{std::string(name_of(joint.kind))}},
                     {"gap_mm", Json{joint.gap}}};
    if (joint.kind == joint::JointKind::set_in && joint.depth)
      out.emplace_back("depth_mm", Json{*joint.depth});
    if (missing > 0.0) out.emplace_back("missing_mm", written::tidy(missing, 1e3));
    return Json{std::move(out)};
  }

  /// Returns a place along the girth; the datum, if the rounded one has come round to it.
  [[nodiscard]] Json girth(std::size_t member, double s) const {
    auto out = written::mm(s);
    const double all = request_.spec.members[member].section->outer().girth();
    return *out.as<double>() < all ? out : written::mm(0.0);
  }

  [[nodiscard]] Json marks(std::size_t member, const frame::Piece& piece,
                           const Names& names) const {
    Json::Array out;
    for (const auto& stand : piece.stands) {
      Json::Object one{{"text", Json{names.of_members[stand.member]}}};
      if (is_section(member))
        one.emplace_back("girth_mm", girth(member, stand.girth));
      else
        one.emplace_back("phi_deg", written::deg(Angle::rad(stand.phi)));
      one.emplace_back("z_mm", written::mm(stand.z));
      out.emplace_back(std::move(one));
    }
    return Json{std::move(out)};
  }

  /// Returns the branch of a hole with its size and position.
  [[nodiscard]] Json branch_of(const frame::Hole& hole, const Names& names) const {
    Json::Object out{{"id", Json{names.of_members[hole.member]}}};
    if (is_section(hole.member)) {
      for (const auto& field : request_.sections[hole.member]) out.push_back(field);
      out.emplace_back("axis", written::axis(hole.axis.point, hole.axis.direction));
      out.emplace_back("up", written::direction(hole.up));
      return Json{std::move(out)};
    }
    for (auto& field : written::Fields{}(hole.branch)) out.push_back(std::move(field));
    out.insert(out.begin() + 2, {"wall_mm", Json{request_.walls[hole.member]}});
    return Json{std::move(out)};
  }

  [[nodiscard]] Result<Json> holes(const frame::Piece& piece, const Names& names) const {
    Json::Array out;
    for (const auto& hole : piece.holes) {
      const auto& how = frame_.joints[hole.joint].how;
      Json::Object joint{{"kind", Json{std::string(name_of(how.kind))}}, {"gap_mm", Json{how.gap}}};
      if (how.kind == frame::How::Kind::set_in && how.depth)
        joint.emplace_back("depth_mm", Json{*how.depth});
      const auto* own = said(hole.joint);
      Json::Object one{{"branch", branch_of(hole, names)}, {"joint", Json{std::move(joint)}}};
      if (hole.square) {
        add_square_cut(own, how, one);
      } else {
        TRY(auto groove, hole_groove(hole));
        one.emplace_back("groove", std::move(groove));
        one.emplace_back("tilt",
                         own != nullptr && !(own->tilt == Json{}) ? own->tilt : request_.tilt);
      }
      out.emplace_back(std::move(one));
    }
    return Json{std::move(out)};
  }

  /// A square hole takes nothing of the defaults; what its own joint states may be refused by the
  /// part.
  static void add_square_cut(const OwnCut* own, const frame::How& how, Json::Object& out) {
    const bool of_end = own == nullptr || how.kind == frame::How::Kind::set_on;
    out.emplace_back("groove", of_end || own->groove == Json{}
                                   ? Json{Json::Object{{"rule", Json{"square"}}}}
                                   : own->groove);
    out.emplace_back("tilt", own == nullptr || own->tilt == Json{} ? Json{"none"} : own->tilt);
  }

  /// Set on: that of the branch's end.
  [[nodiscard]] Result<Json> hole_groove(const frame::Hole& hole) const {
    const auto* own = said(hole.joint);
    if (frame_.joints[hole.joint].how.kind == frame::How::Kind::set_on) {
      TRY(const auto end, cut(hole.member, hole.end));
      for (const auto& [name, value] : end)
        if (name == "groove") return value;
    }
    if (own != nullptr && !(own->groove == Json{})) return own->groove;
    for (const auto& [name, value] : request_.end)
      if (name == "groove") return value;
    return Json{};
  }

  const FrameRequest& request_;
  const frame::Frame& frame_;
  OwnEnds own_ends_;
};

/// Members by the text of their requests without ids.
struct Forms {
  std::vector<std::string> texts;
  std::vector<std::size_t> of_members;
  std::vector<std::unique_ptr<const Parts::Spec>> read;
};

Result<Forms> forms(const PartWriter& writer, const Names& names) {
  Forms out;
  std::map<std::string, std::size_t> known;
  for (std::size_t i = 0; i < names.of_members.size(); ++i) {
    if (stopped()) return fail({.code = ErrorCode::cancelled});
    TRY(const auto part, writer.part(i, names));
    auto text = dump(part);
    const auto [at, fresh] = known.emplace(text, out.texts.size());
    out.of_members.push_back(at->second);
    if (!fresh) continue;
    out.texts.push_back(std::move(text));
    out.read.push_back(read_part(part));
  }
  return out;
}

/// Returns members as shapes, with the names of their current parts.
Result<std::vector<frame::Shape>> shapes(const PartWriter& writer, const Forms& forms,
                                         const Names& names) {
  std::vector<frame::Shape> out;
  for (std::size_t i = 0; i < names.of_members.size(); ++i) {
    TRY(const auto part, writer.part(i, names));
    out.push_back(shape_of(part));
    out.back().form = forms.of_members[i];
    out.back().key += names.of_members[i];
  }
  return out;
}

/// Groups parts first by only their shape, then also by the current parts set on them, until no
/// group splits any more.
Result<std::vector<frame::AlikeGroup>> gathered(const PartWriter& writer, const Forms& known,
                                                const FrameRequest& request, Names& names) {
  std::vector<frame::AskedPart> parts;
  for (const auto& one : known.read)
    parts.push_back(
        {one ? &one->part : nullptr, one && one->section ? &one->section->section : nullptr});
  frame::Gatherer gatherer(parts, known.texts, request.alike_within);
  for (std::size_t before = 0;;) {
    TRY(const auto all, shapes(writer, known, names));
    TRY(auto groups, gatherer.groups(all));
    for (const auto& group : groups)
      for (const auto& [i, laid] : group.shapes)
        names.of_members[i] = request.spec.members[group.shapes.front().first].name;
    if (groups.size() == before) return groups;
    before = groups.size();
  }
}

}  // namespace

Result<FrameParts> parts_of(const FrameRequest& request, const frame::Frame& frame) {
  const auto members = request.spec.members.size();
  const PartWriter writer(request, frame);
  Names names{.ids = false, .of_members = std::vector<std::string>(members, "-")};
  TRY(auto known, forms(writer, names));
  TRY(auto groups, gathered(writer, known, request, names));
  FrameParts out{.parts = {},
                 .laid = std::vector<frame::Laid>(members),
                 .forms = std::move(known.read),
                 .form_of = std::move(known.of_members)};
  auto named = names;
  named.ids = true;
  for (auto& group : groups) {
    FramePart part{.members = {}, .by = group.by};
    for (auto& [i, laid] : group.shapes) {
      part.members.push_back(i);
      part.differs = std::max(part.differs, laid.differs);
      out.laid[i] = std::move(laid);
    }
    TRY(const auto unnamed, writer.part(group.by, names));
    part.sha256 = sha256(dump(unnamed));
    TRY(part.request, writer.part(group.by, named));
    out.parts.push_back(std::move(part));
  }
  std::ranges::sort(out.parts, {}, [](const FramePart& p) { return p.members.front(); });
  return out;
}

}  // namespace tubecut::api
