#pragma once

#include <compare>
#include <numbers>

namespace tubecut {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kTwoPi = 2.0 * std::numbers::pi;
inline constexpr double kRadPerDeg = std::numbers::pi / 180.0;
inline constexpr double kDegPerRad = 180.0 / std::numbers::pi;

/// A plane angle, stored in radians. Degrees appear only in the reader and the encoders (`deg`).
class Angle {
 public:
  constexpr Angle() = default;
  static constexpr Angle rad(double value) { return Angle{value}; }
  static constexpr Angle deg(double value) { return Angle{value * kRadPerDeg}; }

  [[nodiscard]] constexpr double rad() const { return rad_; }
  [[nodiscard]] constexpr double deg() const { return rad_ * kDegPerRad; }

  constexpr Angle operator-() const { return Angle{-rad_}; }
  friend constexpr Angle operator+(Angle a, Angle b) { return Angle{a.rad_ + b.rad_}; }
  friend constexpr Angle operator-(Angle a, Angle b) { return Angle{a.rad_ - b.rad_}; }
  friend constexpr Angle operator*(double k, Angle a) { return Angle{k * a.rad_}; }
  friend constexpr auto operator<=>(Angle, Angle) = default;

 private:
  explicit constexpr Angle(double value) : rad_(value) {}
  double rad_ = 0.0;
};

}  // namespace tubecut
