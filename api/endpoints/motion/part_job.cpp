#include "api/endpoints/motion/part_job.hpp"

#include <utility>
#include <variant>

#include "core/base/try.hpp"
#include "core/torch/marks.hpp"

namespace tubecut::api {
namespace {

constexpr const char* kAlong = "the machine's torch swings along the tube only";

Issue refusal_of(std::size_t cutout, const std::string& member, const char* hint) {
  return {.code = ErrorCode::unsupported_combination,
          .member = "part/cutouts/" + std::to_string(cutout) + "/" + member,
          .hint = hint};
}

/// Refuses the cut-outs that a torch without an axis across the tube cannot cut. `round`: a prism
/// is one of them, because only a tube that is not round is still for it while the torch runs
/// across.
Result<void> check_cutouts(const std::vector<cutout::Spec>& all, bool round) {
  for (std::size_t k = 0; k < all.size(); ++k)
    if (std::holds_alternative<cutout::Slit>(all[k].shape)) {
      auto slit = refusal_of(k, "shape/kind",
                             "a slit has no pulses yet, because its path ends in the metal");
      slit.got = "slit";
      return fail(std::move(slit));
    }
  for (std::size_t k = 0; k < all.size(); ++k)
    if (all[k].countersink) return fail(refusal_of(k, "countersink", kAlong));
  for (std::size_t k = 0; k < all.size() && round; ++k)
    if (cutout::lay_of(all[k].wall, all[k].tilt) == cutout::Lay::prism) {
      auto prism = refusal_of(k, "tilt", kAlong);
      prism.got = "free";
      prism.limit = "axial|none";
      return fail(std::move(prism));
    }
  return {};
}

Result<void> check_holes(const std::vector<part::HoleSpec>& holes) {
  for (const auto& hole : holes)
    if (hole.hole.tilt == bevel::Tilt::free)
      return fail({.code = ErrorCode::unsupported_combination,
                   .member = "part/holes/" + std::to_string(hole.asked) + "/tilt",
                   .got = "free",
                   .limit = "axial|none",
                   .hint = kAlong});
  return {};
}

/// Adds the cuts of a part as core has made it.
template <class Spec, class Part>
void add_cuts(const ScheduleRequest& request, const PartRequest& of, const Spec& spec,
              const Part& part, ScheduleJob& job) {
  job.checks = part::verify(spec, part);
  auto warnings = on_request(of, part.warnings);
  warnings.insert(warnings.end(), of.warnings.begin(), of.warnings.end());
  job.warnings = under("part", std::move(warnings));
  auto cuts = torch::torch_cuts(spec, part);
  if (request.marks) cuts = torch::with_marks(spec, part, std::move(cuts));
  job.program = {.cuts = std::move(cuts),
                 .setup = request.setup,
                 .machine = request.machine,
                 .motion = request.motion,
                 .max_periods = request.max_periods};
  for (const auto& cut : job.program->cuts)
    warn_of_land("part", "cut " + cut.name + ": ", cut.land, job);
}

}  // namespace

void warn_of_land(std::string member, const std::string& of, double land, ScheduleJob& job) {
  if (land > 0.0)
    job.warnings.push_back({WarningCode::land_left, std::move(member),
                            of + "the bevel's pass leaves its land of " + brief(land) + " mm"});
}

Result<void> add_part(const ScheduleRequest& request, const PartRequest& of, ScheduleJob& job) {
  const auto named = [&](Error error) { return under("part", on_request(of, std::move(error))); };
  if (of.section) {
    TRY(const auto part, part::section_part(of.of_section).map_error(named));
    add_cuts(request, of, of.of_section, part, job);
  } else {
    TRY(const auto part, part::part(of.part).map_error(named));
    add_cuts(request, of, of.part, part, job);
  }
  return {};
}

Result<ScheduleRequest> resolve(ScheduleRequest request) {
  auto* const part = std::get_if<PartRequest>(&request.cut);
  if (part == nullptr) return request;
  TRY(auto resolved, under("part", resolve(std::move(*part))));
  const bool round = !resolved.section;
  if (round) TRY(check_holes(resolved.part.holes));
  TRY(check_cutouts(round ? resolved.part.cutouts.all : resolved.of_section.cutouts.all, round));
  request.cut = std::move(resolved);
  return request;
}

}  // namespace tubecut::api
