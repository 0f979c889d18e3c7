#pragma once

#include <optional>
#include <vector>

#include "core/motion/machine/kinematics.hpp"
#include "core/torch/torch_program.hpp"

namespace tubecut::torch {

/// The positions of a machine's axes along a program on one tube.
class TorchStand {
 public:
  /// Errors  unsupported_combination (a machine without a torch, or without maps).
  static Result<TorchStand> of(const motion::Machine& machine, const motion::CutPath& tube,
                               const Setup& setup);

  /// Returns the point as the machine counts it, rotated by this many radians.
  [[nodiscard]] motion::CutPoint counted(motion::CutPoint point, double turns) const;
  /// Returns the axes with the tip at a counted point: at the cutting height, or at the pierce
  /// height.
  [[nodiscard]] std::vector<double> cutting(const motion::CutPoint& point) const;
  [[nodiscard]] std::vector<double> piercing(const motion::CutPoint& point) const;
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

  motion::Machine machine_ = {};
  Functions cutting_ = {}, piercing_ = {};
  std::optional<Height> height_ = {};
};

}  // namespace tubecut::torch
