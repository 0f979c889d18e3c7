#pragma once

#include <optional>
#include <stop_token>
#include <tl/expected.hpp>
#include <vector>

#include "core/groove/mill_path.hpp"
#include "core/groove/periodic_spline.hpp"

/// The parts of `mill_path`, for its own sources and the probe.
namespace tubecut::groove {

/// What every position of a path needs; values, made once. A station counts optimised positions
/// from omega = 0, with its fraction.
struct Shop {
  const MillPathSpec& spec;
  Joint joint;
  Cone cone;

  [[nodiscard]] double omega(double station) const { return kTwoPi * station / spec.positions; }
};

/// A position and all that is said about it: optimised by the spec's method, or with a `given`
/// increment.
///
/// Errors  of `gap` and of the method; cancelled.
[[nodiscard]] tl::expected<MillPosition, ErrorCode> position(const Shop& shop, double station,
                                                             std::optional<Increment> given,
                                                             std::stop_token stop);

/// Increments between the optima: smooth where the optima are, broken lines where they are noise.
class Increments {
 public:
  Increments(const std::vector<MillPosition>& optima, Method method);
  [[nodiscard]] Increment at(double station) const;

 private:
  bool smooth_;
  std::vector<Increment> optima_;
  PeriodicSpline dz_, db_;
};

/// Stations to emit: the optima, and between each two as many equal parts as keep the sag of linear
/// axes below `kAxisSag`.
///
/// Errors  too_many_nodes, cancelled, those of `section`.
[[nodiscard]] Result<std::vector<double>> emitted_stations(const Shop& shop,
                                                           const Increments& increments,
                                                           std::stop_token stop);

/// `angle` turned by whole turns to within half a turn of `to`; rad.
[[nodiscard]] double nearest_turn(double angle, double to);

/// A position's failure as the request's: which member to blame, and where.
[[nodiscard]] tl::unexpected<Error> failed(ErrorCode code, double omega);

}  // namespace tubecut::groove
