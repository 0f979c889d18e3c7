#include <algorithm>
#include <string>
#include <utility>

#include "api/catalog/machines.hpp"
#include "api/catalog/posts.hpp"
#include "api/formats/drawing/part_marks.hpp"
#include "api/formats/gcode/gcode.hpp"
#include "api/formats/numbers.hpp"
#include "api/stop.hpp"
#include "core/motion/path/upright.hpp"
#include "core/torch/marks.hpp"

namespace tubecut::api {
namespace {

/// Returns the cuts with the passes of their lands, or the reason for the refusal.
std::vector<torch::TorchCut> in_passes(Result<std::vector<torch::TorchCut>> cuts) {
  ask();
  if (cuts) return *std::move(cuts);
  const auto& issue = cuts.error().issues.front();
  throw UnfitOption{"passes", std::string(info(issue.code).code) + " " + issue.hint};
}

/// Adds the strokes of a part's marks before its cuts, and the marks that remain manual work.
template <class Spec, class Part>
void add_marks(const Spec& spec, const Part& part, const FormatOptions& o, TorchJob& job) {
  for (const auto& step : part.sequence) {
    if (step.what != part::Step::What::mark) continue;
    const auto& mark = part.marks[step.index];
    if (!o.marks || mark.kind == part::Mark::Kind::part_mark)
      job.by_hand.push_back(mark_by_hand(mark, post_of(o)));
  }
  if (!o.marks) return;
  const auto& post = post_of(o);
  if (post.mark_on.empty())
    throw UnfitOption{"marks", "post " + post.name + " has no mark_on, by which a tool marks"};
  job.cuts = torch::with_marks(spec, part, std::move(job.cuts));
}

/// The machine whose table is taken must move its torch across the tube.
void refuse_without_across(const std::string& name) {
  for (const auto& one : *machines())
    if (one.machine.name == name && !motion::crosses(one.machine))
      throw UnfitOption{"machine", "the target is not round, and machine " + name +
                                       " has no axis across the tube: take a machine of type "
                                       "tube_table"};
}

/// Refuses what no program around a section has.
void refuse_on_section(const FormatOptions& o) {
  const auto refuse = [](bool is, std::string_view option) {
    if (is)
      throw UnfitOption{option,
                        "a target that is not round is cut in one pass, without tabs, from a "
                        "flat or its first point"};
  };
  refuse(o.passes == Passes::both, "passes");
  refuse(o.tabs.has_value(), "tabs");
  refuse(o.start.has_value(), "start_deg");
  if (o.process != nullptr) refuse_without_across(o.process->machine);
}

void tell_length(const part::Lengths& lengths, const FormatOptions& o, TorchJob& job) {
  const auto& post = post_of(o);
  job.lengths.push_back("blank " + post.length(lengths.blank) + ", finished part " +
                        post.length(lengths.longest) + " from tip to tip");
}

}  // namespace

TorchJob torch_job(const bevel::TableSpec& spec, const bevel::Table& table,
                   const Caption& caption) {
  return {.outer_radius = spec.target.outer_radius,
          .wall = spec.target.wall,
          .cuts = caption.options.passes == Passes::both
                      ? in_passes(torch::torch_passes(spec, table))
                      : std::vector{torch::torch_cut(spec, table)},
          .zero = "the work point, z 0",
          .onward = "from the cut into the kept tube",
          .line = "the seam, phi 0,",
          .seen_from = "the cut"};
}

TorchJob torch_job(const section::Section& section, const bevel::TableSpec& spec,
                   const bevel::SectionTable& table, const Caption& caption) {
  refuse_on_section(caption.options);
  auto cut = torch::torch_cut(section, spec, table);
  return {.outer_radius = cut.path.outer_radius,
          .section = section,
          .wall = cut.path.wall,
          .cuts = {std::move(cut)},
          .zero = "the work point, z 0",
          .onward = "from the cut into the kept tube",
          .line = "the middle of face 1, girth 0,",
          .seen_from = "the cut"};
}

TorchJob torch_job(const part::SectionPartSpec& spec, const part::SectionPart& part,
                   const Caption& caption) {
  refuse_on_section(caption.options);
  const auto tube = motion::around(spec.section);
  TorchJob out{.outer_radius = tube.outer_radius,
               .section = spec.section,
               .wall = tube.wall,
               .cuts = torch::torch_cuts(spec, part),
               .zero = "the long point of the start, z 0",
               .onward = "from the start to the finish",
               .line = "the middle of face 1, girth 0,",
               .seen_from = "the start"};
  tell_length(part.lengths, caption.options, out);
  add_marks(spec, part, caption.options, out);
  return out;
}

TorchJob torch_job(const part::PartSpec& spec, const part::Part& part, const Caption& caption) {
  TorchJob out{.outer_radius = spec.target.outer_radius,
               .wall = spec.target.wall,
               .cuts = caption.options.passes == Passes::both
                           ? in_passes(torch::torch_passes(spec, part))
                           : torch::torch_cuts(spec, part),
               .zero = "the long point of the start, z 0",
               .onward = "from the start to the finish",
               .line = "the datum line, phi 0,",
               .seen_from = "the start"};
  tell_length(part.lengths, caption.options, out);
  add_marks(spec, part, caption.options, out);
  return out;
}

}  // namespace tubecut::api
