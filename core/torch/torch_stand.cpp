#include "core/torch/torch_stand.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "core/base/try.hpp"
#include "core/motion/path/course.hpp"

namespace tubecut::torch {
namespace {

Result<std::vector<motion::AxisFunction>> functions(motion::Machine machine,
                                                    const motion::CutPath& tube, double off) {
  motion::set_standoff(machine, off);
  return motion::axis_functions({.cut = tube, .machine = std::move(machine)});
}

}  // namespace

motion::Coordinates first_of(const motion::Machine& machine, const ProgramCut& cut, double turns,
                             Angle lean) {
  motion::CutPath tube = cut.cut.path;
  if (tube.still) *tube.still += turns;
  motion::CutPoint point = cut.first();
  point.phi += turns;
  if (machine.b_positive == motion::BPositive::outer_edge_to_waste) point.b = -point.b;
  return motion::coordinates_of(tube, lean, point);
}

double highest(const motion::CutPath& tube) {
  return tube.section ? tube.section->reach() : tube.outer_radius;
}

Result<TorchStand> TorchStand::of(const motion::Machine& machine, const motion::CutPath& tube,
                                  const Setup& setup, Angle lean) {
  TorchStand out;
  out.machine_ = machine;
  out.lean_ = lean;
  TRY(out.cutting_, functions(machine, tube, setup.cut_height));
  TRY(out.piercing_, functions(machine, tube, setup.pierce_off()));
  out.set_height(tube, setup);
  return out;
}

void TorchStand::set_height(const motion::CutPath& tube, const Setup& setup) {
  const auto lift = motion::lift_of(machine_);
  if (!lift) return;
  const auto find = [&](std::string_view name) {
    return static_cast<std::size_t>(std::ranges::find(machine_.axes, name, &motion::Axis::name) -
                                    machine_.axes.begin());
  };
  Height height{.axis = find(lift->axis),
                .clear = highest(tube) + lift->pivot_length + setup.clearance};
  if (const auto fine = find(lift->fine); fine < machine_.axes.size()) height.fine = fine;
  height_ = height;
}

std::vector<double> TorchStand::values(const Functions& axes, const ProgramCut& cut,
                                       double turns) const {
  const auto at = first_of(machine_, cut, turns, lean_);
  std::vector<double> out;
  for (const auto& f : axes) out.push_back(f.at(at));
  return out;
}

std::vector<double> TorchStand::cutting(const ProgramCut& cut, double turns) const {
  return values(cutting_, cut, turns);
}

std::vector<double> TorchStand::piercing(const ProgramCut& cut, double turns) const {
  return values(piercing_, cut, turns);
}

std::vector<double> TorchStand::clear(std::vector<double> axes) const {
  if (height_) axes[height_->axis] = height_->clear - (height_->fine ? axes[*height_->fine] : 0.0);
  return axes;
}

Result<void> TorchStand::check(const std::vector<double>& axes) const {
  std::vector<Issue> issues;
  for (std::size_t a = 0; a < axes.size(); ++a) {
    const auto& axis = machine_.axes[a];
    const auto see = [&](bool beyond, const char* bound, const std::optional<double>& limit) {
      if (beyond)
        issues.push_back({ErrorCode::soft_limit, "machine/axes/" + std::to_string(a) + "/" + bound,
                          axes[a], *limit, std::string(name_of(axis.unit)),
                          "axis " + axis.name + " between two cuts"});
    };
    see(axis.soft_min && axes[a] < *axis.soft_min, "soft_min", axis.soft_min);
    see(axis.soft_max && axes[a] > *axis.soft_max, "soft_max", axis.soft_max);
  }
  return no_issues(std::move(issues));
}

}  // namespace tubecut::torch
