#include "core/torch/torch_program.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "core/base/try.hpp"
#include "core/torch/centre_lead.hpp"
#include "core/torch/stretches.hpp"

namespace tubecut::torch {

Approach approach(const TorchCut& cut, const Setup& setup) {
  if (cut.mark || cut.open) return {};
  Approach out{.lead = setup.lead};
  if (setup.lead) out.start = {.at = motion::Start::At::automatic, .seam = Angle{}};
  if (setup.start && cut.path.scrap != motion::Scrap::inside)
    out.start = {.at = motion::Start::At::phi, .phi = *setup.start};
  return out;
}

Result<std::vector<ProgramCut>> program_cut(const TorchCut& as_asked, const Setup& setup, bool last,
                                            const std::vector<double>& more) {
  const bool window = setup.lead && as_asked.centre;
  const auto cut = window ? with_middles(as_asked) : as_asked;
  const auto from = approach(cut, setup);
  std::vector<ProgramCut> out;
  if (!setup.tabs || !holds(*setup.tabs, cut, last)) {
    TRY(auto way, torch_way(cut, from));
    out.push_back({.cut = cut, .way = std::move(way), .start = from.start.at});
    return out;
  }
  TRY(auto ways, ways_between_tabs(cut, from, *setup.tabs, more));
  for (auto& way : ways) {
    const auto i = out.size();
    out.push_back({.cut = cut,
                   .way = std::move(way),
                   .stretch = i,
                   .stretches = ways.size(),
                   .start = from.start.at});
    auto& name = out.back().cut.name;
    name +=
        (name.empty() ? "" : ", ") + std::to_string(i + 1) + " of " + std::to_string(ways.size());
  }
  return out;
}

std::vector<double> windings(const std::vector<ProgramCut>& cuts) {
  std::vector<double> out;
  double at = 0.0;
  for (const auto& cut : cuts) {
    const double turns =
        out.empty() ? 0.0 : kTwoPi * std::floor((at - cut.first().phi) / kTwoPi + 0.5);
    out.push_back(turns);
    at = cut.last().phi + turns;
  }
  return out;
}

}  // namespace tubecut::torch
