#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/frame/alike.hpp"
#include "core/joint/cutters/cutter.hpp"

/// For `Gatherer` only.
namespace tubecut::frame::detail {

/// The number of phases around the middle of the wall at which a partner's height is sampled.
inline constexpr std::size_t kHeightPhases = 16;
using PartnerHeights = std::array<std::optional<double>, kHeightPhases>;

/// One end of a form, with each partner separately.
struct FormEnd {
  std::vector<joint::PreparedCutter> partners;
  std::vector<std::optional<double>> perpendicular;  // in the end's frame, rad; empty: no side
  double left = 0.0;  // mean height of the contour on the bore; NaN if it is open

  [[nodiscard]] PartnerHeights heights(std::size_t partner, double radius, double turned_by) const;
};

/// The data of a form that is known before its walls are computed: enough to find forms that
/// resemble each other.
struct Form {
  const part::PartSpec* part = nullptr;
  const section::Section* section = nullptr;  // of a tube that is not round
  FormEnd start, finish;
  std::vector<joint::TubeCutter> holes;  // the branches of the holes
  double left = 0.0;                     // mean length between both cuts on the bore; NaN: unknown

  [[nodiscard]] double middle() const;  // mean radius of the wall
};
/// Returns empty when the partners are invalid.
[[nodiscard]] std::optional<Form> form_of(const AskedPart& asked);

/// The finished wall of a form at the phases of the comparison: z in the start's frame, for holes
/// also phi.
struct FormWall {
  struct Line {
    std::vector<double> z, phi;       // phi: only of a hole
    std::vector<double> events = {};  // of an end: phases where z or its slope may jump
    double radius = 0.0;
  };
  std::vector<Line> ends;                // of the start, then of the finish, from the bore out
  std::vector<std::vector<Line>> holes;  // of each hole
};
/// Computes the wall of the part rotated by `turn` about its axis. Returns empty when the part
/// cannot be cut on these phases.
[[nodiscard]] std::optional<FormWall> wall_of(const Form& form, Angle turn);

}  // namespace tubecut::frame::detail
