#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/joint/intersection.hpp"

/// The set of degenerate joints: each is a valid answer or a typed error.
namespace tubecut::joint::degenerate {

inline constexpr double kRadius = 50.0;

struct Case {
  std::string name;
  std::vector<Partner> partners;
  std::optional<ErrorCode> error;  // empty: a valid answer
  Surfaces surfaces = Surfaces::both;
};

inline Partner tube(double radius, double inclination_deg, double offset = 0.0,
                    double clocking_deg = 0.0) {
  return TubeCutter{radius, Angle::deg(inclination_deg), Angle::deg(clocking_deg), offset, 0.0};
}

inline std::vector<Case> cases() {
  using enum ErrorCode;
  const double r = kRadius;
  return {
      {"equal radii at 90 deg", {tube(r, 90)}, {}},
      {"equal radii at 60 deg", {tube(r, 60)}, {}},
      {"radius (1 + 1e-9) r", {tube(r * (1 + 1e-9), 90)}, {}},
      {"radius (1 - 1e-9) r", {tube(r * (1 - 1e-9), 90)}, open_profile},
      {"internal tangency", {tube(2 * r, 70, r)}, {}},
      {"internal tangency, other side", {tube(2 * r, 70, -r)}, {}},
      {"just beyond internal tangency", {tube(2 * r, 70, r * (1 + 1e-9))}, open_profile},
      {"external tangency", {tube(2 * r, 70, 3 * r)}, no_contact},
      {"just inside external tangency",
       {tube(2 * r, 70, 3 * r * (1 - 1e-9))},
       open_profile,
       Surfaces::outer},
      {"inclination 1e-6 deg", {tube(2 * r, 1e-6)}, parallel_axes},
      {"inclination 1e-5 deg", {tube(2 * r, 1e-5)}, parallel_axes},
      {"inclination 1e-4 deg", {tube(2 * r, 1e-4)}, {}},
      {"inclination 1e-3 deg", {tube(2 * r, 1e-3)}, {}},
      {"inclination 0.01 deg", {tube(2 * r, 0.01)}, {}},
      {"inclination 0.1 deg", {tube(2 * r, 0.1)}, {}},
      {"inclination 1 deg", {tube(2 * r, 1)}, {}},
      {"inclination 179 deg", {tube(2 * r, 179)}, {}},
      {"coaxial", {AxisTube{2 * r, {{0, 0, 0}, {0, 0, 1}}}}, parallel_axes},
      {"brace inside the chord", {tube(10 * r, 45)}, {}},
      {"brace wider than the chord", {tube(0.5 * r, 90)}, open_profile},
      {"through: two chords", {tube(2 * r, 90), tube(2 * r, 45, 0, 90)}, {}},
      {"identical cutters", {tube(2 * r, 60), tube(2 * r, 60)}, {}},
      {"no contact", {tube(r, 90, 5 * r)}, no_contact},
      {"partial contact", {tube(r, 90, r)}, open_profile},
      {"partial contact completed", {tube(r, 90, r), tube(2 * r, 60)}, {}},
      {"zero direction", {AxisTube{2 * r, {{0, 0, 0}, {0, 0, 0}}}}, zero_length},
  };
}

}  // namespace tubecut::joint::degenerate
