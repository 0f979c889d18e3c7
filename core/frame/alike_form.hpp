#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <stop_token>
#include <vector>

#include "core/frame/alike.hpp"
#include "core/joint/cutters/cutter.hpp"

/// For `Gatherer` only.
namespace tubecut::frame::detail {

/// Heights of one partner alone round the middle of the wall; empty where it is missed.
inline constexpr std::size_t kLooks = 16;
using Looks = std::array<std::optional<double>, kLooks>;

/// One end of a form: its partners, each for itself.
struct FormEnd {
  std::vector<joint::PreparedCutter> partners;
  std::vector<std::optional<double>> perpendicular;  // in the end's frame, rad; empty: no side
  double left = 0.0;  // mean height of the contour on the bore; NaN where it is open

  [[nodiscard]] Looks looks(std::size_t partner, double radius, double turned_by) const;
};

/// What is known of a form before its walls are: enough to see which forms resemble each other.
struct Form {
  const part::PartSpec* part = nullptr;
  FormEnd start, finish;
  std::vector<joint::TubeCutter> holes;  // their branches
  double left = 0.0;  // length between both cuts on the bore, of all phases the mean; NaN: unknown

  [[nodiscard]] double middle() const;  // radius
};
/// Empty where the partners cannot be prepared.
[[nodiscard]] std::optional<Form> form_of(const part::PartSpec& part);

/// The finished wall of a form at phases of its own: z in the start's frame, of holes phi too.
struct FormWall {
  struct Line {
    std::vector<double> z, phi;
    double radius = 0.0;  // of a hole's
  };
  std::vector<Line> ends;                // of the start, then of the finish, from the bore out
  std::vector<std::vector<Line>> holes;  // of each
};
/// Turned about its axis by this much first. Empty where it cannot be made on those phases.
[[nodiscard]] std::optional<FormWall> wall_of(const part::PartSpec& part, Angle turn,
                                              const std::stop_token& stop);

}  // namespace tubecut::frame::detail
