#pragma once

#include <optional>
#include <vector>

#include "core/motion/machine/kinematics.hpp"
#include "core/torch/torch_program.hpp"

namespace tubecut::torch {

/// Returns the first point of a cut as the machine has it, the tube turned on by so many rad.
[[nodiscard]] motion::Coordinates first_of(const motion::Machine& machine, const ProgramCut& cut,
                                           double turns, Angle lean);

/// Returns the largest distance of the outside from the tube's axis, mm.
[[nodiscard]] double highest(const motion::CutPath& tube);

/// The positions of a machine's axes along a program on one tube.
class TorchStand {
 public:
  /// Errors  unsupported_combination (a machine without a torch, or without maps).
  static Result<TorchStand> of(const motion::Machine& machine, const motion::CutPath& tube,
                               const Setup& setup, Angle lean);

  /// Returns the axes with the tip at the first point of a cut, the tube turned on by so many rad:
  /// at the cutting height, or at the pierce height.
  [[nodiscard]] std::vector<double> cutting(const ProgramCut& cut, double turns) const;
  [[nodiscard]] std::vector<double> piercing(const ProgramCut& cut, double turns) const;
  /// Returns the same position along and around the tube, with the tip clear of it in every swing;
  /// unchanged if the machine has no height axis.
  [[nodiscard]] std::vector<double> clear(std::vector<double> axes) const;
  [[nodiscard]] bool lifts() const { return height_.has_value(); }

  /// Errors  soft_limit, as motion::check_soft_limits.
  [[nodiscard]] Result<void> check(const std::vector<double>& axes) const;

 private:
  using Functions = std::vector<motion::AxisFunction>;
  struct Height {
    std::size_t axis = 0;
    std::optional<std::size_t> fine = {};
    double clear = 0.0;  // of both together, mm
  };
  TorchStand() = default;
  void set_height(const motion::CutPath& tube, const Setup& setup);
  [[nodiscard]] std::vector<double> values(const Functions& axes, const ProgramCut& cut,
                                           double turns) const;

  motion::Machine machine_ = {};
  Angle lean_ = {};  // of a section, see motion::Motion
  Functions cutting_ = {}, piercing_ = {};
  std::optional<Height> height_ = {};
};

}  // namespace tubecut::torch
