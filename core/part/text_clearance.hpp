#pragma once

#include <iterator>
#include <utility>
#include <vector>

#include "core/cutout/text.hpp"
#include "core/part/cutout_webs.hpp"
#include "core/part/part.hpp"
#include "core/part/section/section_part.hpp"

/// Texts on a part whose ends and openings are known.
namespace tubecut::part {

/// Returns how far strokes keep off every edge, mm: 2, or the kerf if it is more.
[[nodiscard]] double text_clearance(double kerf);

/// Returns the reasons why texts do not keep off the edges of the outside, at most one an end and
/// one for all openings of each text.
///
/// Errors    cutout_off_part (texts/k/at/z: too near to an end, or beyond it), cutouts_cross (texts/k:
///           too near to an opening, or across it).
/// Accuracy  2 um: edges are chords that leave the exact ones by 1 um at most.
/// Source    docs/theory/cutouts.md, section 7.
[[nodiscard]] std::vector<Issue> check_texts(const PartSpec& spec, const Part& part,
                                             const std::vector<cutout::Lettering>& texts);
[[nodiscard]] std::vector<Issue> check_texts(const SectionPartSpec& spec, const SectionPart& part,
                                             const std::vector<cutout::Lettering>& texts);

/// Returns the mark of a text.
[[nodiscard]] Mark mark_of(const PartSpec& spec, cutout::Lettering text);
[[nodiscard]] SectionMark mark_of(const SectionPartSpec& spec, cutout::Lettering text);

/// Verifies the texts among a part's marks; nothing if it has none.
template <class Part>
[[nodiscard]] std::vector<Check> verify_texts(const Part& part) {
  constexpr double kOffGrid = 1e-6;  // mm
  Check out{.name = "text_strokes", .value = 0.0, .limit = kOffGrid, .unit = "mm"};
  bool any = false;
  for (const auto& mark : part.marks) {
    if (!mark.lettering) continue;
    any = true;
    worsen(out.value, cutout::off_grid(*mark.lettering));
  }
  return any ? std::vector{out} : std::vector<Check>{};
}

/// Adds the cut-outs to a part whose ends are cut, and its texts to its marks.
///
/// Errors  those of cutout::lay, cutout::lay_texts, check_cutouts and check_texts, all at once as far
///         as they can be found: those that could be laid are checked.
template <class Spec, class Part>
[[nodiscard]] Result<void> add_cutouts_and_texts(const Spec& spec, Part& out) {
  if (spec.cutouts.all.empty() && spec.cutouts.texts.empty()) return {};
  const auto ground = cutout_ground(spec, out);
  std::vector<Issue> issues;
  const auto take = [&](auto made, auto& into) {
    if (made)
      into = *std::move(made);
    else
      std::ranges::move(made.error().issues, std::back_inserter(issues));
  };
  take(cutout::lay(spec.cutouts.all, ground), out.cutouts);
  std::ranges::move(cutout::cone_warnings(out.cutouts, ground.kerf),
                    std::back_inserter(out.warnings));
  if (!out.cutouts.empty()) take(check_cutouts(spec, out), out.cutout_report);
  auto texts = cutout::lay_texts(spec.cutouts.texts, ground);
  std::ranges::move(texts.issues, std::back_inserter(issues));
  std::ranges::move(check_texts(spec, out, texts.all), std::back_inserter(issues));
  for (auto& text : texts.all) out.marks.push_back(mark_of(spec, std::move(text)));
  return no_issues(std::move(issues));
}

}  // namespace tubecut::part
