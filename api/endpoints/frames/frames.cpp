#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>

#include "api/endpoints/all.hpp"
#include "api/endpoints/frames/frame_answer.hpp"
#include "api/endpoints/frames/frame_bundle.hpp"
#include "api/endpoints/frames/frame_formats.hpp"
#include "api/endpoints/frames/frame_pointers.hpp"
#include "api/endpoints/frames/plate_answer.hpp"
#include "api/endpoints/frames/tab_slots.hpp"
#include "api/endpoints/parts.hpp"
#include "api/pipeline.hpp"
#include "api/wire/common_fields.hpp"
#include "core/base/try.hpp"

namespace tubecut::api {
namespace {

/// The run of a job within another: nobody times or logs it.
Run inner_run() {
  return {.stage = [](std::string_view) {},
          .understood = [](std::string_view) {},
          .judged = [](const Answer&) {}};
}

/// Returns whether the error concerns the whole request, not only one part.
bool spoils_all(ErrorCode code) {
  if (code == ErrorCode::verification_failed) return false;
  return info(code).kind == ErrorKind::internal || code == ErrorCode::cancelled;
}

Result<MadePart> make(const Json& request) {
  Reader in(request);
  const auto common = read_common_fields(in, Parts::kAccepts);
  auto run = inner_run();
  run.accepted = common.accept;
  auto made = worked<Parts>(in, run);
  MadePart out;
  if (!made) {
    if (spoils_all(made.error().code))
      return fail({.code = made.error().code, .hint = made.error().detail});
    out.problem = std::move(made).error();
    return out;
  }
  made->answer.result_sha256 = made->hashed(run_in_order);
  out.made = std::make_unique<const Worked<Parts>>(*std::move(made));
  return out;
}

/// The common part of both answers: with the parts inside, and with the parts as lines.
struct FrameBase {
  using Spec = FrameJob;
  using Out = MadeParts;
  static constexpr std::string_view kId = "frames";
  static constexpr std::string_view kPath = "/v1/frames";
  static constexpr auto kMaxBody = static_cast<std::size_t>(limit::body_large_max_bytes);
  static constexpr double kBudgetS = kLongBudgetS;
  static constexpr auto kAccepts = Parts::kAccepts;
  static constexpr auto kChecks =
      joined(std::to_array<CheckLimit>({
                 {"joint_in_world", "1e-5 max(1, 1e-5 (height + offset))", "mm"},
                 {"joint_faces", "1e-5 max(1, 1e-5 distance)", "mm"},
                 {"joint_sides", "0", "mm"},
                 {"plate_clear", "1e-6", "mm"},
                 {"plate_web", "1e-6", "mm"},
                 {"tab_in_slot", "1e-5", "mm"},
             }),
             Parts::kChecks);

  static Spec decode(Reader& in) {
    Spec out;
    static_cast<FrameRequest&>(out) = decode_frame_request(in);
    return out;
  }

  /// Merges pieces in line, if requested.
  static Result<void> merge(Spec& spec) {
    if (!spec.merge) return {};
    frame::MergeSpec besides;
    for (const auto& one : spec.ends) besides.kept.emplace_back(one.member, one.end);
    besides.alike = [&](std::size_t a, std::size_t b) { return spec.cuts[a] == spec.cuts[b]; };
    TRY(auto merged, frame::merge_in_line(spec.spec, besides));
    auto& out = spec.merged.emplace();
    for (const auto& m : spec.spec.members) out.ids.push_back(m.name);
    std::vector<double> walls;
    std::vector<Json::Object> sections;
    for (const auto& pieces : merged.pieces) {
      walls.push_back(spec.walls[std::ranges::min(pieces)]);
      sections.push_back(spec.sections[std::ranges::min(pieces)]);
    }
    spec.walls = std::move(walls);
    spec.sections = std::move(sections);
    spec.cutouts.assign(spec.walls.size(), Json{});  // decode refuses any
    spec.texts.assign(spec.walls.size(), Json{});
    std::vector<OwnCut> cuts;
    for (const auto joint : merged.joints) cuts.push_back(spec.cuts[joint]);
    for (auto& one : spec.ends) {
      const auto place = merged.of[one.member];
      one.member = place.member;
      if (place.turned)
        one.end = one.end == joint::End::start ? joint::End::finish : joint::End::start;
    }
    spec.cuts = std::move(cuts);
    spec.spec = std::move(merged.spec);
    out.of = std::move(merged.of);
    out.pieces = std::move(merged.pieces);
    out.off = std::move(merged.off);
    out.joints = std::move(merged.joints);
    return {};
  }

  static Result<Spec> resolve(Spec spec) {
    TRY(merge(spec));
    const auto as_asked = [&](Error error) { return in_request(spec, std::move(error)); };
    TRY(spec.frame, frame::solve(spec.spec).map_error(as_asked));
    for (auto& warning : spec.frame.warnings) warning.member = in_request(spec, warning.member);
    TRY(add_tab_slots(spec).map_error(as_asked));
    TRY(auto parts, parts_of(spec, spec.frame).map_error(as_asked));
    static_cast<FrameParts&>(spec) = std::move(parts);
    spec.part_of.resize(spec.spec.members.size());
    for (std::size_t i = 0; i < spec.parts.size(); ++i)
      for (const auto member : spec.parts[i].members) spec.part_of[member] = i;
    spec.plate_parts = plate_parts_of(spec);
    return spec;
  }

  static std::vector<Check> verify(const Spec& spec, const Out& out) {
    std::vector<const part::PartSpec*> asked;
    for (std::size_t i = 0; i < spec.part_of.size(); ++i) {
      const auto* own = spec.own(i);
      asked.push_back(own == nullptr ? nullptr : &own->part);
    }
    auto checks = frame::verify(spec.spec, spec.frame, asked);
    for (std::size_t i = 0; i < spec.frame.plates.size(); ++i)
      keep_worst(checks, plate::verify(spec.spec.plates[i], spec.frame.plates[i].passing,
                                       spec.frame.plates[i].plate));
    for (auto& check : verify_tab_slots(spec)) checks.push_back(std::move(check));
    for (const auto& part : out)
      if (part.made) keep_worst(checks, part.made->answer.checks);
    return checks;
  }

  static const std::vector<Format<Spec, Out>>& formats() {
    static const std::vector<Format<Spec, Out>> kFormats{
        {"csv", "text/csv", &cut_list_csv, {"cut_list"}},
        {"step", "model/step", &frame_step, {"smooth", "straight"}},
        {"zip", "application/zip", &frame_bundle, {}, bundle_options()}};
    return kFormats;
  }
};

struct Frames : FrameBase {
  static Result<Out> compute(const Spec& spec, const ParallelFor& parallel_for) {
    std::vector<std::optional<Result<MadePart>>> made(spec.parts.size());
    parallel_for(made.size(), [&](std::size_t i) {
      ask();
      made[i] = make(spec.parts[i].request);
    });
    Out out;
    out.reserve(made.size());
    for (auto& part : made) {
      TRY(auto one, *std::move(part));
      if (one.problem) one.problem = in_frame(spec, out.size(), *std::move(one.problem));
      out.push_back(std::move(one));
    }
    return out;
  }

  /// Returns the warnings of the ends and of members, then of each part the worst of each code, and
  /// the reason if a part is missing. Numbers that may be in another unit count for the frame if
  /// the frame itself has that warning.
  static std::vector<Warning> warnings(const Spec& spec, const Out& out) {
    auto all = spec.frame.warnings;
    for (std::size_t i = 0; i < out.size(); ++i) {
      const auto first = spec.parts[i].members.front();
      const auto at = in_request(spec, "members/" + std::to_string(first));
      const auto& name = spec.spec.members[first].name;
      if (const auto& why = out[i].problem) {
        all.push_back({.code = WarningCode::no_part, .member = at, .detail = told(name, *why)});
        continue;
      }
      // Those are warnings of the frame itself.
      const std::array said{WarningCode::unit_suspicion, WarningCode::ghost_contact};
      std::vector<const Warning*> worst;  // of each code
      for (const auto& w : out[i].made->answer.warnings) {
        if (info(w.code).severity != Severity::cut || std::ranges::count(said, w.code) > 0)
          continue;
        const auto known = std::ranges::find(worst, w.code, &Warning::code);
        if (known == worst.end())
          worst.push_back(&w);
        else if (w.most > (*known)->most)
          *known = &w;
      }
      for (const auto* w : worst) {
        const auto pointer = in_frame(spec, i, pointer_of(w->member, out[i].made->answer.request));
        all.push_back({.code = w->code,
                       .member = at,
                       .detail = "part " + name + " at " + pointer +
                                 (w->detail.empty() ? "" : ": " + w->detail)});
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
    for (const auto& part : out)
      if (part.made)
        for (const auto& one : part.made->answer.measures) add_worst(one, all);
    return all;
  }

  static void encode(const Spec& spec, const Out& out, Writer& w) {
    write_members(spec, out, w);
    write_joints(spec, out, w);
    write_cut_list(spec, out, w);
    write_plates(spec, w);
    write_totals(spec, out, w);
    write_not_cut(spec, w);
    write_merged(spec, w);
    if (spec.others_left_out > 0) w.field("others_left_out", spec.others_left_out);
  }
  /// Whole answers name their engine, so they are next to the result: its hash covers numbers, and
  /// contains each part's.
  static void encode_beside(const Spec& spec, const Out& out, Writer& w) {
    write_parts(spec, out, w);
  }
};

/// Only the frame, and its parts as requests.
struct FrameLines : FrameBase {
  static Result<Out> compute(const Spec& spec) { return Out(spec.parts.size()); }
  static std::vector<Warning> warnings(const Spec& spec, const Out&) { return spec.frame.warnings; }
  static std::vector<Measure> measure(const Spec&, const Out&) { return {}; }
  static void encode(const Spec& spec, const Out& out, Writer& w) {
    write_members(spec, out, w);
    write_joints(spec, out, w);
    write_cut_list(spec, out, w);
    write_plates(spec, w);
    write_not_cut(spec, w);
    write_merged(spec, w);
    if (spec.others_left_out > 0) w.field("others_left_out", spec.others_left_out);
  }
  static std::string lines(const Spec& spec) {
    std::string all;
    for (std::size_t i = 0; i < spec.parts.size(); ++i) {
      Writer line(1024);
      line.object([&](Writer& o) {
        o.field("id", name_of_part(spec, i));
        o.field("endpoint", Parts::kId);
        o.field("body", spec.parts[i].request);
      });
      all += line.take() + "\n";
    }
    return all;
  }
};

}  // namespace

Endpoint frames() {
  auto out = endpoint<Frames>();
  out.begin = &run<FrameLines>;
  return out;
}

}  // namespace tubecut::api
