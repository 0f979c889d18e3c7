#pragma once

#include <vector>

#include "api/formats/gcode/torch_moves.hpp"
#include "core/motion/path/upright.hpp"

namespace tubecut::api {

/// Where a torch that keeps the normal of a section up stands over it: rad and mm.
struct UprightPlace {
  double angle = 0.0;   // of the normal, with whole revolutions
  double across = 0.0;  // towards growing girth
  double out = 0.0;     // height over the tube's axis
};

/// The outside of a section as a program goes around it, its phi the girth over the radius of a
/// circle as long.
class SectionTurn {
 public:
  explicit SectionTurn(const section::Section& section);

  [[nodiscard]] UprightPlace at(const TorchPlace& place) const;
  [[nodiscard]] const section::Section& section() const { return section_; }

  /// Returns the ends of moves from one place to another, the last of them `to`: at the ends of
  /// flats and of the blends there, and so short that tip and both edges leave their lines by at
  /// most `limit` while every axis goes straight and evenly. `worst`: raised to the most.
  ///
  /// Accuracy  the sum of `sag`, and of the turn 1.5 times the most at three places of each move,
  ///           between which its axes are smooth; stops after 16 halvings.
  [[nodiscard]] std::vector<TorchPlace> moves(const TorchReach& reach, const TorchPlace& from,
                                              const TorchPlace& to, double limit,
                                              double& worst) const;

 private:
  [[nodiscard]] double turn_sag(const TorchReach& reach, const TorchPlace& from,
                                const TorchPlace& to) const;

  section::Section section_;
  motion::Upright up_;
  double radius_;
};

}  // namespace tubecut::api
