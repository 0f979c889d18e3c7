#pragma once

#include <string>
#include <vector>

#include "api/catalog/post.hpp"
#include "api/formats/gcode/section_moves.hpp"
#include "api/formats/gcode/torch_moves.hpp"
#include "api/wire/format.hpp"

namespace tubecut::api {

/// The axes of a program as its post has them, at places of the torch. With a pivot length the
/// linear ones are the pivot's, and the one off the tube moves too; without, the control must know
/// the tip and move its height. Around a section the tube turns so that the wall's normal at the
/// torch points up; the axes off the tube and across it follow the wall.
///
/// Errors  the constructor throws UnfitOption if the post lacks a needed axis.
class TorchJoints {
 public:
  /// How the torch leans on any of the cuts.
  struct Leaning {
    bool along = false, across = false;
  };
  /// `section`: of a target that is not round; `outer_radius` is then that of a circle as long.
  TorchJoints(double outer_radius, const std::optional<section::Section>& section, Leaning leaning,
              const FormatOptions& options);

  /// Of the tip this far off the wall along its own axis.
  [[nodiscard]] std::string words(const TorchPlace& at, double off) const;
  /// The same without the height.
  [[nodiscard]] std::string level_words(const TorchPlace& at, double off) const;
  [[nodiscard]] std::string height(const TorchPlace& at, double off) const;
  /// Returns the height at which the tip clears the tube in any swing; needs a pivot.
  [[nodiscard]] std::string clear_height() const;
  /// Returns the turn of the tube, deg.
  [[nodiscard]] double turn_at(const TorchPlace& at) const { return under(at).turn; }
  /// Returns the position of the axis along the tube.
  [[nodiscard]] double along_at(const TorchPlace& at, double off) const;
  /// Returns the distance of all axes as written, with one deg as one unit of length, as a control
  /// counts that feeds them all.
  [[nodiscard]] double distance(const TorchPlace& from, double from_off, const TorchPlace& to,
                                double to_off) const;

  /// How far the decimals of the words move the tip or an edge through a wall so thick, mm, at
  /// most, with a torch that leans up to 60 deg.
  [[nodiscard]] double rounding(double wall) const;

  /// Returns the axes in the words of a move, in their order.
  [[nodiscard]] std::vector<AxisMove> moves(const TorchPlace& from, double from_off,
                                            const TorchPlace& to, double to_off) const;

  [[nodiscard]] const PostAxis& along() const { return along_; }
  [[nodiscard]] const PostAxis& out() const { return out_; }
  [[nodiscard]] const PostAxis& turn() const { return turn_; }
  [[nodiscard]] const PostAxis& swing() const { return swing_; }
  [[nodiscard]] const PostAxis& tilt() const { return tilt_; }
  [[nodiscard]] const PostAxis& across() const { return across_; }
  /// The axis across follows the wall of a section.
  [[nodiscard]] bool follows() const { return section_.has_value(); }
  /// Growing phi runs to plus of the axis across.
  [[nodiscard]] bool phi_to_plus() const { return phi_to_plus_ != across_.reversed; }
  [[nodiscard]] bool tilts() const { return tilts_; }
  [[nodiscard]] bool has_swing() const { return has_swing_; }
  [[nodiscard]] bool has_pivot() const { return pivot_.has_value(); }
  [[nodiscard]] double clearance() const { return clearance_; }

 private:
  /// From the wall to the point that the linear axes carry: outwards, along and round.
  struct Arm {
    double out, along, round;
  };
  /// Where the wall is under the torch: over the axis, across it, and the turn in deg.
  struct Under {
    double out, round, turn;
  };
  [[nodiscard]] Under under(const TorchPlace& at) const;
  [[nodiscard]] bool moves_across() const { return pivot_ && (tilts_ || section_); }
  [[nodiscard]] Arm arm(const TorchPlace& at, double off) const;
  [[nodiscard]] double across_at(const TorchPlace& at, const Arm& arm) const {
    const double round = under(at).round + arm.round;
    return phi_to_plus_ ? round : -round;
  }
  [[nodiscard]] std::string angles(const TorchPlace& at) const;
  [[nodiscard]] std::vector<double> all(const TorchPlace& at, double off) const;
  /// An axis that has a word, and its value.
  struct Shown {
    const PostAxis* axis;
    bool turns;
    double value;
  };
  [[nodiscard]] std::vector<Shown> shown(const TorchPlace& at, double off) const;

  double radius_;  // of the round target
  std::optional<SectionTurn> section_ = {};
  std::optional<double> pivot_;
  double clearance_;
  bool tilts_, has_swing_, phi_to_plus_;
  PostAxis along_, out_, across_, turn_, swing_, tilt_;
};

}  // namespace tubecut::api
