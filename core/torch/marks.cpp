#include "core/torch/marks.hpp"

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

namespace tubecut::torch {
namespace {

/// A point on the outer wall, rad and mm.
struct MarkPoint {
  double phi = 0.0, z = 0.0;
};

/// Returns a straight stroke from one point to the other, through their middle.
TorchCut stroke(const joint::Target& tube, std::string name, MarkPoint from, MarkPoint to) {
  TorchCut out{.name = std::move(name), .path = {}, .mark = true};
  out.path = {.phi = {from.phi, 0.5 * (from.phi + to.phi), to.phi},
              .z = {from.z, 0.5 * (from.z + to.z), to.z},
              .b = {0.0, 0.0, 0.0},
              .outer_radius = tube.outer_radius,
              .wall = tube.wall,
              .closed = false};
  return out;
}

}  // namespace

std::vector<TorchCut> with_marks(const part::PartSpec& spec, const part::Part& part,
                                 std::vector<TorchCut> cuts) {
  using Kind = part::Mark::Kind;
  std::vector<TorchCut> out;
  for (const auto& step : part.sequence) {
    if (step.what != part::Step::What::mark) continue;
    const auto& mark = part.marks[step.index];
    if (mark.kind == Kind::part_mark) continue;
    const auto name = mark.kind == Kind::datum_line ? std::string("mark of the datum line")
                                                    : "mark of partner " + mark.text;
    if (mark.z_to > mark.z_from) {
      out.push_back(stroke(spec.target, name, {mark.phi, mark.z_from}, {mark.phi, mark.z_to}));
      continue;
    }
    const double round = kCrossArm / spec.target.outer_radius;
    out.push_back(stroke(spec.target, name + ", along", {mark.phi, mark.z_from - kCrossArm},
                         {mark.phi, mark.z_from + kCrossArm}));
    out.push_back(stroke(spec.target, name + ", round", {mark.phi - round, mark.z_from},
                         {mark.phi + round, mark.z_from}));
  }
  std::ranges::move(cuts, std::back_inserter(out));
  return out;
}

}  // namespace tubecut::torch
