#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/bevel/smoothing/smoothing.hpp"

namespace tubecut::bevel {

/// The linear programme of the least area, in numbers near 1: heights in units of the range of B,
/// lengths in units of the mean spacing, cut open where the distance of two nodes is largest.
struct Programme {
  using Array = Eigen::ArrayXd;
  using Index = Eigen::Index;

  Programme(const AngleProfile& profile, const EnvelopeSpec& spec);

  const AngleProfile& profile;  // its source
  const EnvelopeSpec& spec;
  Array h, w, b;  // to the next node; weight in the area; B
  double slope = 0.0, curvature = 0.0, highest = 0.0;
  double unit = 1.0, pitch = 1.0;  // rad, mm
  Index first = 0;                 // the node of the profile that is node 0 here
  std::vector<char> keeps;         // nodes so far from every break of a limit that f is B there

  [[nodiscard]] Index size() const { return b.size(); }
  [[nodiscard]] Index next(Index j) const { return j + 1 < size() ? j + 1 : 0; }
  [[nodiscard]] Index previous(Index j) const { return j > 0 ? j - 1 : size() - 1; }
  [[nodiscard]] std::size_t of_profile(Index j) const {
    return static_cast<std::size_t>(j + first < size() ? j + first : j + first - size());
  }

  /// Returns true if there is no room between B and the limit, so the height is that of B.
  [[nodiscard]] bool no_room(Index j) const { return !(highest - b[j] > 1e-12); }

  /// Sets the `contacts` of heights without room from the multipliers of slopes and bends.
  void set_pinned(Array& contacts, const Array& slopes, const Array& bends) const;

  /// Returns multipliers in the profile's own units and order.
  [[nodiscard]] Multipliers multipliers(const Array& contacts, const Array& slopes) const;
};

}  // namespace tubecut::bevel
