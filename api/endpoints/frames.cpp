#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "api/answer_text.hpp"
#include "api/common_fields.hpp"
#include "api/endpoints/all.hpp"
#include "api/endpoints/frame_request.hpp"
#include "api/endpoints/parts.hpp"
#include "api/frame_names.hpp"
#include "api/pipeline.hpp"
#include "api/wire_names.hpp"
#include "core/base/try.hpp"

namespace tubecut::api {
namespace {

std::vector<double> components(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

/// A frame whose joints are found, and its parts as requests, read again as /v1/parts does.
struct FrameJob : FrameRequest {
  frame::Frame frame;
  std::vector<FramePart> parts;
  std::vector<Parts::Spec> asked;    // of each part
  std::vector<std::size_t> part_of;  // of each member
};

/// A part as /v1/parts answers, or why there is none.
struct MadePart {
  std::optional<Worked<Parts>> made;
  std::optional<Problem> problem;
};

/// The run of a job within another: nobody times or logs it.
Run inner_run(const std::stop_token& stop) {
  return {.stop = stop,
          .stage = [](std::string_view) {},
          .understood = [](std::string_view) {},
          .judged = [](const Answer&) {},
          .foresee = [](const Work&) {}};
}

/// Nothing about one part alone.
bool spoils_all(ErrorCode code) {
  return info(code).kind == ErrorKind::internal || code == ErrorCode::cancelled;
}

Result<MadePart> make(const Json& request, const std::stop_token& stop) {
  Reader in(request);
  in.set_stop(stop);
  const auto common = read_common_fields(in, Parts::kAccepts);
  auto run = inner_run(stop);
  run.accepted = common.accept;
  auto made = worked<Parts>(in, run);
  MadePart out;
  if (!made) {
    if (spoils_all(made.error().code))
      return fail({.code = made.error().code, .hint = made.error().detail});
    out.problem = std::move(made).error();
    return out;
  }
  made->answer.result_sha256 = made->hashed(stop);
  out.made = *std::move(made);
  return out;
}

/// What both parts of a joint have of it, once they are made.
struct Seam {
  double weld = 0.0;                               // mm
  std::optional<double> groove;                    // mm^3, where one partner has the end for itself
  std::optional<double> least_gap, greatest_root;  // of a hole, mm
  bool whole = true;                               // every part of it is made
};

/// Length of the root curve along one partner.
double along(const part::End& end, std::size_t cutter) {
  const auto& t = end.own;
  double out = 0.0;
  for (std::size_t i = 0; i < t.length.size(); ++i)
    if (t.cutter[i] == cutter)
      out += (i + 1 < t.length.size() ? t.length[i + 1] : t.length_total) - t.length[i];
  return out;
}

struct Frames {
  using Spec = FrameJob;
  struct Out {
    std::vector<MadePart> parts;
  };
  static constexpr std::string_view kId = "frames";
  static constexpr std::string_view kPath = "/v1/frames";
  static constexpr auto kMaxBody = static_cast<std::size_t>(limit::body_large_max_bytes);
  static constexpr double kBudgetS = kLongBudgetS;
  static constexpr std::array<std::string_view, 3> kAccepts{"max_root_gap_mm",
                                                            "max_extra_bevel_deg", "max_b_deg"};
  static constexpr auto kChecks =
      joined(std::to_array<CheckLimit>({
                 {"joint_in_world", "1e-5 max(1, 1e-5 (height + offset))", "mm"},
                 {"joint_faces", "1e-5 max(1, 1e-5 distance)", "mm"},
                 {"joint_sides", "0", "mm"},
             }),
             Parts::kChecks);

  static Spec decode(Reader& in) { return {decode_frame_request(in), {}, {}, {}, {}}; }

  static Result<Spec> resolve(Spec spec, const std::stop_token& stop) {
    TRY(spec.frame, frame::solve(spec.spec, stop));
    TRY(spec.parts, parts_of(spec, spec.frame, stop));
    spec.part_of.resize(spec.spec.members.size());
    for (std::size_t i = 0; i < spec.parts.size(); ++i) {
      ask(stop);
      for (const auto member : spec.parts[i].members) spec.part_of[member] = i;
      Reader in(spec.parts[i].request);
      (void)read_common_fields(in, Parts::kAccepts);
      spec.asked.push_back(Parts::decode(in));
    }
    return spec;
  }
  static void count(const Spec& spec, Work& work) {
    work.add(Cost::member, 4.0 * static_cast<double>(spec.spec.members.size()));
    for (const auto& part : spec.asked) Parts::count(part, work);
  }
  static Result<Out> compute(const Spec& spec, const std::stop_token& stop) {
    Out out;
    for (const auto& part : spec.parts) {
      ask(stop);
      TRY(auto one, make(part.request, stop));
      out.parts.push_back(std::move(one));
    }
    return out;
  }

  static std::vector<Check> verify(const Spec& spec, const Out& out, const std::stop_token& stop) {
    std::vector<const part::PartSpec*> asked;
    for (const auto part : spec.part_of) asked.push_back(&spec.asked[part].part);
    auto checks = frame::verify(spec.spec, spec.frame, asked, stop);
    for (const auto& part : out.parts)
      if (part.made) keep_worst(checks, part.made->answer.checks);
    return checks;
  }

  /// Those of the ends and of members; then of each part one of a code, and why one is not there.
  static std::vector<Warning> warnings(const Spec& spec, const Out& out) {
    auto all = spec.frame.warnings;
    for (std::size_t i = 0; i < out.parts.size(); ++i) {
      const auto first = spec.parts[i].members.front();
      const auto at = "members/" + std::to_string(first);
      const auto& name = spec.spec.members[first].name;
      if (const auto& why = out.parts[i].problem) {
        all.push_back({.code = WarningCode::no_table, .member = at, .detail = told(name, *why)});
        continue;
      }
      std::vector<WarningCode> said;
      for (const auto& w : out.parts[i].made->answer.warnings) {
        if (info(w.code).severity != Severity::cut || std::ranges::count(said, w.code) > 0)
          continue;
        said.push_back(w.code);
        const auto pointer = pointer_of(w.member, out.parts[i].made->answer.request);
        all.push_back({.code = w.code,
                       .member = at,
                       .detail = "part " + name + " at " + (pointer.empty() ? "/" : pointer) +
                                 (w.detail.empty() ? "" : ": " + w.detail)});
      }
    }
    return all;
  }
  static std::string told(const std::string& name, const Problem& why) {
    std::string out = name + ": " + std::string(info(why.code).code);
    if (why.issues.empty()) return out;
    const auto& first = why.issues.front();
    return out + " at " + first.pointer + (first.hint.empty() ? "" : ": " + first.hint);
  }

  static std::vector<Measure> measure(const Spec&, const Out& out) {
    std::vector<Measure> all;
    for (const auto& part : out.parts)
      if (part.made)
        for (const auto& one : part.made->answer.measures) add_worst(one, all);
    return all;
  }

  static void encode(const Spec& spec, const Out& out, Writer& w) {
    w.array("members", indices(spec.part_of), [&](Writer& each, std::size_t i) {
      each.object([&](Writer& o) { encode_member(spec, out, i, o); });
    });
    const auto seams = seams_of(spec, out);
    w.array("joints", indices(spec.frame.joints), [&](Writer& each, std::size_t i) {
      each.object([&](Writer& o) { encode_joint(spec, spec.frame.joints[i], seams[i], o); });
    });
    w.array("cut_list", indices(out.parts), [&](Writer& each, std::size_t i) {
      each.object([&](Writer& o) { encode_row(spec, i, out.parts[i], o); });
    });
    encode_totals(spec, out, w);
    w.array("not_cut", spec.frame.not_cut, [&](Writer& each, const frame::NotCut& one) {
      each.object([&](Writer& o) { encode_not_cut(spec, one, o); });
    });
  }
  /// Whole answers say which engine made them, so they stand beside the result: its hash is of
  /// numbers, and holds each part's.
  static void encode_beside(const Spec& spec, const Out& out, Writer& w) {
    w.array("parts", indices(out.parts), [&](Writer& each, std::size_t i) {
      each.object([&](Writer& o) { encode_part(spec, i, out.parts[i], o); });
    });
  }

  template <class T>
  static std::vector<std::size_t> indices(const std::vector<T>& of) {
    std::vector<std::size_t> out(of.size());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = i;
    return out;
  }
  static const std::string& name_of_part(const Spec& spec, std::size_t part) {
    return spec.spec.members[spec.parts[part].members.front()].name;
  }

  /// Where the finished part lies in the world.
  static void encode_member(const Spec& spec, const Out& out, std::size_t member, Writer& o) {
    o.field("id", spec.spec.members[member].name);
    o.field("part", name_of_part(spec, spec.part_of[member]));
    const auto& part = out.parts[spec.part_of[member]];
    if (!part.made) return;
    const auto& start = spec.frame.pieces[member].frame;
    const auto& own = part.made->out.frame;
    const Eigen::Matrix3d rows = own.rows * start.rows;
    o.object("frame", [&](Writer& f) {
      f.column("origin_mm", components(start.origin + start.rows.transpose() * own.origin));
      f.column("x", components(rows.row(0)));
      f.column("y", components(rows.row(1)));
      f.column("z", components(rows.row(2)));
    });
  }

  static void add_ends(const Spec& spec, const Out& out, std::size_t member,
                       std::vector<Seam>& seams) {
    const auto& piece = spec.frame.pieces[member];
    const auto& part = out.parts[spec.part_of[member]];
    for (const bool finish : {false, true}) {
      const auto& cutters = finish ? piece.finish : piece.start;
      for (std::size_t k = 0; k < cutters.size(); ++k) {
        auto& seam = seams[cutters[k].joint];
        seam.whole = seam.whole && part.made.has_value();
        const auto kind = spec.frame.joints[cutters[k].joint].how.kind;
        if (!part.made || kind == frame::JointKind::set_in) continue;
        const auto& end = finish ? part.made->out.finish : part.made->out.start;
        const bool faces = kind == frame::JointKind::mitre || kind == frame::JointKind::butt;
        const double length = along(end, k);
        seam.weld = faces ? std::max(seam.weld, length) : seam.weld + length;
        if (cutters.size() == 1) seam.groove = seam.groove.value_or(0.0) + end.groove_volume;
      }
    }
  }
  static void add_holes(const Spec& spec, const Out& out, std::size_t member,
                        std::vector<Seam>& seams) {
    const auto& piece = spec.frame.pieces[member];
    const auto& part = out.parts[spec.part_of[member]];
    for (const auto& hole : piece.holes)
      seams[hole.joint].whole = seams[hole.joint].whole && part.made.has_value();
    if (!part.made) return;
    for (const auto& placed : part.made->out.holes) {
      const auto joint = piece.holes[placed.asked].joint;
      auto& seam = seams[joint];
      const auto& fit = placed.hole.fit;
      if (spec.frame.joints[joint].how.kind != frame::JointKind::set_on)
        seam.weld += placed.hole.length_total;
      seam.least_gap = std::min(seam.least_gap.value_or(fit.least_between), fit.least_between);
      seam.greatest_root = std::max(seam.greatest_root.value_or(fit.greatest_root_between),
                                    fit.greatest_root_between);
    }
  }
  static std::vector<Seam> seams_of(const Spec& spec, const Out& out) {
    std::vector<Seam> seams(spec.frame.joints.size());
    for (std::size_t i = 0; i < spec.spec.members.size(); ++i) {
      add_ends(spec, out, i, seams);
      add_holes(spec, out, i, seams);
    }
    return seams;
  }

  static void encode_joint(const Spec& spec, const frame::Joint& joint, const Seam& seam,
                           Writer& o) {
    const auto& chord =
        joint.other ? spec.spec.others[joint.chord].name : spec.spec.members[joint.chord].name;
    o.field("branch", spec.spec.members[joint.branch].name);
    o.field("chord", chord);
    o.field("kind", name_of(joint.how.kind));
    o.field("gap_mm", joint.how.gap);
    if (joint.how.kind == frame::JointKind::set_in && joint.how.depth)
      o.field("depth_mm", *joint.how.depth);
    o.field("hole", joint.how.hole ? "cut" : "none");
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

  static void encode_row(const Spec& spec, std::size_t i, const MadePart& part, Writer& o) {
    const auto& m = spec.spec.members[spec.parts[i].members.front()];
    std::vector<std::string> members;
    for (const auto one : spec.parts[i].members) members.push_back(spec.spec.members[one].name);
    o.field("part", name_of_part(spec, i));
    o.field("count", members.size());
    o.column("members", members);
    o.field("outer_diameter_mm", 2.0 * m.outer_radius);
    o.field("wall_mm", m.wall);
    o.field("verdict", part.made ? part.made->answer.verdict.status : "none");
    if (!part.made) return;
    const auto& lengths = part.made->out.lengths;
    o.field("long_mm", lengths.longest);
    o.field("blank_mm", lengths.blank);
    o.field("girth_mm", kTwoPi * m.outer_radius);
    o.field("weld_mm", lengths.weld);
    o.field("mass_kg", lengths.mass);
    o.field("result_sha256", part.made->answer.result_sha256);
  }

  static void encode_totals(const Spec& spec, const Out& out, Writer& w) {
    double blank = 0.0, mass = 0.0;
    std::size_t made = 0;
    for (std::size_t i = 0; i < out.parts.size(); ++i) {
      if (!out.parts[i].made) continue;
      const auto& lengths = out.parts[i].made->out.lengths;
      const auto count = spec.parts[i].members.size();
      made += count;
      blank += static_cast<double>(count) * lengths.blank;
      mass += static_cast<double>(count) * lengths.mass;
    }
    w.object("totals", [&](Writer& o) {
      o.field("members", spec.spec.members.size());
      o.field("made", made);
      o.field("parts", out.parts.size());
      o.field("blank_mm", blank);
      o.field("mass_kg", mass);
    });
  }

  static void encode_not_cut(const Spec& spec, const frame::NotCut& one, Writer& o) {
    o.field("why", name_of(one.why));
    o.field("id", one.why == frame::Why::not_joined ? spec.spec.others[one.index].name
                                                    : spec.spec.members[one.index].name);
    if (one.end) o.field("end", name_of(*one.end));
  }

  /// A part's body is that of its own request to /v1/parts, byte by byte.
  static void encode_part(const Spec& spec, std::size_t i, const MadePart& part, Writer& o) {
    o.field("part", name_of_part(spec, i));
    o.field("canonical_sha256", spec.parts[i].sha256);
    if (part.problem) {
      o.field("request", spec.parts[i].request);
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

  static const std::vector<Format<Spec, Out>>& formats() {
    static const std::vector<Format<Spec, Out>> kNone;
    return kNone;
  }
};

}  // namespace

Endpoint frames() { return endpoint<Frames>(); }

}  // namespace tubecut::api
