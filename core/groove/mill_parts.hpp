#pragma once

#include <optional>
#include <tl/expected.hpp>
#include <vector>

#include "core/groove/mill_path.hpp"
#include "core/groove/periodic_spline.hpp"

/// The parts of `mill_path`, for its own sources and the probe.
namespace tubecut::groove {

/// Values that every position of a path needs, computed once. A station counts optimised positions
/// from omega = 0, with its fraction.
struct Shop {
  const MillPathSpec& spec;
  JointGeometry joint;
  Cone cone;

  [[nodiscard]] double omega(double station) const { return kTwoPi * station / spec.positions; }
};

/// Computes a position and its figures: optimised by the spec's method, or with a `given`
/// increment.
///
/// Errors  of `gap` and of the method; cancelled.
[[nodiscard]] tl::expected<MillPosition, ErrorCode> position(const Shop& shop, double station,
                                                             std::optional<Increment> given);

/// Increments between the optima: smooth if the optima are, polylines if they are noise.
class Increments {
 public:
  Increments(const std::vector<MillPosition>& optima, Method method);
  [[nodiscard]] Increment at(double station) const;

 private:
  bool smooth_;
  std::vector<Increment> optima_;
  PeriodicSpline dz_, db_;
};

/// Returns the stations to emit: the optima, and between each two as many equal parts as keep the
/// sag of linear axes below `kAxisSag`.
///
/// Errors  too_many_nodes, cancelled, those of `section`.
[[nodiscard]] Result<std::vector<double>> emitted_stations(const Shop& shop,
                                                           const Increments& increments);

/// Returns `angle` shifted by whole revolutions to within half a revolution of `to`; rad.
[[nodiscard]] double nearest_turn(double angle, double to);

/// Converts a position's failure to an error of the request: the member at fault, and the position.
[[nodiscard]] tl::unexpected<Error> failed(ErrorCode code, double omega);

}  // namespace tubecut::groove
