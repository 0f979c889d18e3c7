#include "core/torch/torch_program.hpp"

#include <cmath>
#include <utility>

#include "core/base/try.hpp"

namespace tubecut::torch {

Approach approach(const TorchCut& cut, const Setup& setup) {
  Approach out{.lead = setup.lead};
  if (setup.lead) out.start = {.at = motion::Start::At::automatic, .seam = Angle{}};
  if (setup.start && cut.path.scrap != motion::Scrap::inside)
    out.start = {.at = motion::Start::At::phi, .phi = *setup.start};
  return out;
}

Result<ProgramCut> program_cut(TorchCut cut, const Setup& setup, const std::stop_token& stop) {
  const auto from = approach(cut, setup);
  TRY(auto way, torch_way(cut, from, stop));
  return ProgramCut{std::move(cut), std::move(way), from.start.at};
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
