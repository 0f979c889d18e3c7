#include "api/endpoints/frames/frame_answer.hpp"

#include <algorithm>
#include <utility>

#include "api/endpoints/frames/plate_answer.hpp"
#include "api/endpoints/frames/tab_slots.hpp"
#include "api/endpoints/place_text.hpp"
#include "api/wire/answer_text.hpp"
#include "api/wire/frame_names.hpp"
#include "api/wire/joint_names.hpp"
#include "core/part/cut_edges.hpp"

namespace tubecut::api {
namespace {

/// Data of a joint from both of its parts, once they are made.
struct Seam {
  double weld = 0.0;                               // mm
  std::optional<double> groove;                    // mm^3, if only one partner cuts the end
  std::optional<double> least_gap, greatest_root;  // of a hole, mm
  bool whole = true;                               // every part of it is made
};

/// Length of the root curve along one partner.
template <class Table>
double along(const bevel::TableSpec& spec, const Table& t, std::size_t cutter) {
  double out = 0.0;
  part::each_root_stretch(spec, t, [&](std::size_t partner, double length) {
    if (partner == cutter) out += length;
  });
  return out;
}

/// Length along one partner, and volume of the groove.
template <class End>
std::pair<double, double> seam_of(const End& end, std::size_t cutter) {
  return {along(end.spec, end.own, cutter), end.groove_volume};
}
/// The weld of an end with tabs runs along its shoulder.
template <>
std::pair<double, double> seam_of(const part::SectionEnd& end, std::size_t cutter) {
  return {along(end.spec, end.shoulder ? *end.shoulder : end.own, cutter), end.groove_volume};
}

template <class T>
std::vector<std::size_t> indices(const std::vector<T>& of) {
  std::vector<std::size_t> out(of.size());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = i;
  return out;
}
/// Writes the position of the finished part in the world; if it is not yet made, its start.
void write_member(const FrameJob& frame, const MadePart& part, std::size_t member, Writer& o) {
  o.field("id", frame.spec.members[member].name);
  o.field("part", name_of_part(frame, frame.part_of[member]));
  const auto start = frame.start_of(member);
  if (part.is_open())
    o.object("start", [&](Writer& f) { write_place(start.origin, start.rows, f); });
  if (!part.made) return;
  const auto [origin, rows] = place_of(frame, *part.made, member);
  o.object("frame", [&](Writer& f) { write_place(origin, rows, f); });
}

void add_ends(const FrameJob& frame, const MadeParts& made, std::size_t member,
              std::vector<Seam>& seams) {
  const auto& piece = frame.frame.pieces[member];
  const auto& part = made[frame.part_of[member]];
  for (const bool finish : {false, true}) {
    const auto& cutters = finish ? piece.finish : piece.start;
    const auto& of_part = finish ? frame.laid[member].finish : frame.laid[member].start;
    for (std::size_t k = 0; k < cutters.size(); ++k) {
      auto& seam = seams[cutters[k].joint];
      seam.whole = seam.whole && part.made != nullptr;
      const auto kind = frame.frame.joints[cutters[k].joint].how.kind;
      if (!part.made || kind == frame::How::Kind::set_in) continue;
      const auto& out = part.made->out;
      const auto [length, volume] =
          out.of_section
              ? seam_of(finish ? out.of_section->finish : out.of_section->start, of_part[k])
              : seam_of(finish ? out.finish : out.start, of_part[k]);
      const bool faces = kind == frame::How::Kind::mitre || kind == frame::How::Kind::butt;
      seam.weld = faces ? std::max(seam.weld, length) : seam.weld + length;
      if (cutters.size() == 1) seam.groove = seam.groove.value_or(0.0) + volume;
    }
  }
}
void add_holes(const FrameJob& frame, const MadeParts& made, std::size_t member,
               std::vector<Seam>& seams) {
  const auto& piece = frame.frame.pieces[member];
  const auto& part = made[frame.part_of[member]];
  for (const auto& hole : piece.holes)
    seams[hole.joint].whole = seams[hole.joint].whole && part.made != nullptr;
  if (!part.made) return;
  const auto round = frame::round_holes(piece.holes);
  for (const auto& placed : part.made->out.holes) {
    const auto at = std::ranges::find(frame.laid[member].holes, placed.asked);
    const auto own = round[static_cast<std::size_t>(at - frame.laid[member].holes.begin())];
    const auto joint = piece.holes[own].joint;
    auto& seam = seams[joint];
    const auto& fit = placed.hole.fit;
    if (frame.frame.joints[joint].how.kind != frame::How::Kind::set_on)
      seam.weld += placed.hole.length_total;
    seam.least_gap = std::min(seam.least_gap.value_or(fit.least_between), fit.least_between);
    seam.greatest_root =
        std::max(seam.greatest_root.value_or(fit.greatest_root_between), fit.greatest_root_between);
  }
}
/// Adds holes that are cut-outs. Their part is made for members as they stand, so that its holes
/// are those of each member.
void add_square_holes(const FrameJob& frame, const MadeParts& made, std::size_t member,
                      std::vector<Seam>& seams) {
  const auto& part = made[frame.part_of[member]];
  if (!part.made) return;
  const auto& spec = part.made->spec;
  const auto& section = part.made->out.of_section;
  const auto& specs = section ? spec.of_section.cutouts : spec.part.cutouts;
  const auto& layout = section ? section->cutouts : part.made->out.cutouts;
  for (const auto& one : specs.holes) {
    const auto& branch = one.hole.branch;
    if (branch.kind == joint::JointKind::set_on) continue;
    auto& seam = seams[frame.frame.pieces[member].holes[one.hole.asked].joint];
    for (const auto& instance : layout.instances)
      if (instance.asked == one.cutout) seam.weld += layout.mould_of(instance).rows.length_total;
    seam.least_gap = std::min(seam.least_gap.value_or(branch.gap), branch.gap);
    seam.greatest_root = std::max(seam.greatest_root.value_or(one.greatest_gap), one.greatest_gap);
  }
}
/// Adds the holes in plates: welded all round, with the gap of their walls.
void add_plate_holes(const FrameJob& frame, std::vector<Seam>& seams) {
  for (const auto& one : frame.frame.plates)
    for (const auto& hole : one.plate.holes) {
      if (!hole.passing) continue;
      auto& seam = seams[one.joints[*hole.passing]];
      for (const auto& s : hole.chain) seam.weld += s.length();
      seam.least_gap = one.passing[*hole.passing].passage.gap;
      seam.greatest_root = hole.greatest_gap;
    }
}
std::vector<Seam> seams_of(const FrameJob& frame, const MadeParts& made) {
  std::vector<Seam> seams(frame.frame.joints.size());
  for (std::size_t i = 0; i < frame.spec.members.size(); ++i) {
    add_ends(frame, made, i, seams);
    add_holes(frame, made, i, seams);
    add_square_holes(frame, made, i, seams);
  }
  add_plate_holes(frame, seams);
  return seams;
}

void write_joint(const FrameJob& frame, const frame::FrameJoint& joint, const Seam& seam,
                 Writer& o) {
  const auto& chord = joint.other   ? frame.spec.others[joint.chord].name
                      : joint.plate ? frame.spec.plates[joint.chord].name
                                    : frame.spec.members[joint.chord].name;
  o.field("branch", frame.spec.members[joint.branch].name);
  o.field("chord", chord);
  o.field("kind", name_of(joint.how.kind));
  o.field("gap_mm", joint.how.gap);
  if (joint.how.kind == frame::How::Kind::set_in && joint.how.depth)
    o.field("depth_mm", *joint.how.depth);
  if (joint.how.kind == frame::How::Kind::mitre) o.field("plane", name_of(joint.how.plane));
  o.field("hole", joint.how.hole ? "cut" : "none");
  for (std::size_t i = 0; i < frame.fitted.size(); ++i)
    if (joint.stated == frame.tabs[i].joint) o.column("slots", slot_names(frame.tabs[i]));
  o.field("stated", joint.stated.has_value());
  if (!seam.whole) return;
  o.field("weld_mm", seam.weld);
  if (seam.groove) o.field("groove_mm3", *seam.groove);
  if (seam.least_gap)
    o.object("fit_up", [&](Writer& f) {
      f.field("least_mm", *seam.least_gap);
      f.field("greatest_root_mm", *seam.greatest_root);
    });
}

void write_not_cut(const FrameJob& frame, const frame::NotCut& one, Writer& o) {
  o.field("why", name_of(one.why));
  o.field("id", one.why == frame::Why::not_joined ? frame.spec.others[one.index].name
                                                  : frame.spec.members[one.index].name);
  if (one.end) o.field("end", name_of(*one.end));
}

/// Writes a part's body, equal to that of its own request to /v1/parts, byte by byte.
void write_part(const FrameJob& frame, std::size_t i, const MadePart& part, Writer& o) {
  o.field("part", name_of_part(frame, i));
  o.field("canonical_sha256", frame.parts[i].sha256);
  if (part.problem) {
    o.field("request", frame.parts[i].request);
    o.object("problem", [&](Writer& p) {
      p.field("code", info(part.problem->code).code);
      write_issues(p, part.problem->issues);
    });
    return;
  }
  const auto& answer = part.made->answer;
  o.object("answer", [&](Writer& a) {
    write_head(a, Parts::kId, own_job_id(answer), answer, answer.request);
    a.object("result", [&](Writer& r) { Parts::encode(part.made->spec, part.made->out, r); });
    write_judgement(a, answer, answer.request);
  });
}

}  // namespace

const std::string& name_of_part(const FrameJob& frame, std::size_t part) {
  return frame.spec.members[frame.parts[part].members.front()].name;
}

FramePlace place_of(const FrameJob& frame, const Worked<Parts>& part, std::size_t member) {
  const auto start = frame.start_of(member);
  const auto& own = part.out.of_section ? part.out.of_section->frame : part.out.frame;
  return {start.origin + start.rows.transpose() * own.origin, own.rows * start.rows};
}

const part::Lengths& lengths_of(const Parts::Out& part) {
  return part.of_section ? part.of_section->lengths : part.lengths;
}

std::vector<std::string> members_of_part(const FrameJob& frame, std::size_t part) {
  std::vector<std::string> out;
  for (const auto one : frame.parts[part].members) out.push_back(frame.spec.members[one].name);
  return out;
}

void write_members(const FrameJob& frame, const MadeParts& made, Writer& w) {
  w.array("members", indices(frame.part_of), [&](Writer& each, std::size_t i) {
    each.object([&](Writer& o) { write_member(frame, made[frame.part_of[i]], i, o); });
  });
}

void write_joints(const FrameJob& frame, const MadeParts& made, Writer& w) {
  const auto seams = seams_of(frame, made);
  w.array("joints", indices(frame.frame.joints), [&](Writer& each, std::size_t i) {
    each.object([&](Writer& o) { write_joint(frame, frame.frame.joints[i], seams[i], o); });
  });
}

void write_cut_list(const FrameJob& frame, const MadeParts& made, Writer& w) {
  w.array("cut_list", indices(made), [&](Writer& each, std::size_t i) {
    each.object([&](Writer& o) {
      o.field("part", name_of_part(frame, i));
      cut_list_row(frame, i, made[i], o);
    });
  });
}

void write_totals(const FrameJob& frame, const MadeParts& made, Writer& w) {
  double blank = 0.0, mass = 0.0;
  std::size_t members = 0;
  for (std::size_t i = 0; i < made.size(); ++i) {
    if (!made[i].made) continue;
    const auto& lengths = lengths_of(made[i].made->out);
    const auto count = frame.parts[i].members.size();
    members += count;
    blank += static_cast<double>(count) * lengths.blank;
    mass += static_cast<double>(count) * lengths.mass;
  }
  w.object("totals", [&](Writer& o) {
    o.field("members", frame.spec.members.size());
    o.field("made", members);
    o.field("parts", made.size());
    o.field("blank_mm", blank);
    o.field("mass_kg", mass);
    if (frame.plate_parts.empty()) return;
    double of_plates = 0.0;
    for (std::size_t i = 0; i < frame.spec.plates.size(); ++i) of_plates += mass_of_plate(frame, i);
    o.field("plates", frame.spec.plates.size());
    o.field("plates_mass_kg", of_plates);
  });
}

void write_not_cut(const FrameJob& frame, Writer& w) {
  w.array("not_cut", frame.frame.not_cut, [&](Writer& each, const frame::NotCut& one) {
    each.object([&](Writer& o) { write_not_cut(frame, one, o); });
  });
}

void write_merged(const FrameJob& frame, Writer& w) {
  if (!frame.merged) return;
  std::vector<std::size_t> several;
  for (std::size_t i = 0; i < frame.merged->pieces.size(); ++i)
    if (frame.merged->pieces[i].size() > 1) several.push_back(i);
  w.array("merged", several, [&](Writer& each, std::size_t i) {
    each.object([&](Writer& o) {
      std::vector<std::string> ids;
      for (const auto piece : frame.merged->pieces[i]) ids.push_back(frame.merged->ids[piece]);
      o.field("id", frame.spec.members[i].name);
      o.column("members", ids);
      o.field("off_line_mm", frame.merged->off[i]);
    });
  });
}

void write_parts(const FrameJob& frame, const MadeParts& made, Writer& w) {
  w.array("parts", indices(made), [&](Writer& each, std::size_t i) {
    each.object([&](Writer& o) { write_part(frame, i, made[i], o); });
  });
}

}  // namespace tubecut::api
