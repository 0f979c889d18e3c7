#pragma once

#include <Eigen/Core>
#include <tl/expected.hpp>
#include <vector>

#include "core/base/error_codes.hpp"
#include "core/groove/mill.hpp"

namespace tubecut::groove {

/// The sampling and limit of the check of one position.
struct GapCheck {
  int points = 11;                // per ruling, v = i / (points - 1), 3..101
  Angle window = Angle::deg(40);  // range of neighbouring rulings to either side, <= 90 deg
  Angle pitch = Angle::deg(1);    // of those rulings, 0 < pitch <= window
  double qualify = 0.5;           // limit of over- and undercut, mm
};

/// Returns the number of rulings to either side of the section's own.
[[nodiscard]] int ruling_reach(const GapCheck& check);

/// The rulings around a section, placed in its half plane; computed once and read by every trial
/// position.
struct Neighbourhood {
  struct Neighbour {
    double delta = 0.0;           // from the section, rad
    double sin = 0.0, cos = 1.0;  // of delta
    double z3 = 0.0, height = 0.0, z3_d = 0.0, height_d = 0.0;
    double D = 0.0, D_d = 0.0;  // of the toe, and by omega
  };
  const JointGeometry* joint = nullptr;
  Angle omega;
  int points = 0;
  std::vector<Neighbour> rulings;        // -window .. window
  std::vector<Eigen::Vector3d> samples;  // points of all rulings, ruling by ruling
};

/// Errors  those of `section`; cancelled.
[[nodiscard]] tl::expected<Neighbourhood, ErrorCode> neighbourhood(const JointGeometry& joint,
                                                                   Angle omega,
                                                                   const GapCheck& check);

/// The source's figures: the ruling that contains the deepest point, read at its points. They omit
/// the surface between rulings.
struct GridFigures {
  double over = 0.0, under = 0.0;                                  // mm, both >= 0
  [[nodiscard]] double objective() const { return over + under; }  // (16)
};
[[nodiscard]] GridFigures grid_figures(const Neighbourhood& near, const Cone& cone,
                                       const ToolPose& pose);

/// The contact of one level v of the groove with the flank at one position: the smallest distance
/// over all neighbouring rulings.
struct Contact {
  double gap = 0.0;       // mm, < 0 overcut
  double delta = 0.0;     // offset of the ruling touched, rad
  double along = 0.0;     // foot on the generatrix from the tip, mm
  Eigen::Vector3d point;  // in the section's half plane
  Eigen::Vector3d gradient;
};

/// The continuous figures of a position, mm.
struct Gap {
  std::vector<Contact> contacts;  // by v
  double over = 0.0, under = 0.0;
  double largest = 0.0;  // max |gap|
  [[nodiscard]] bool qualified(double limit) const { return over < limit && under < limit; }
};

/// Computes the contact line of a position.
///
/// Errors    window (a smallest distance on the border), contact, those of `section`.
/// Accuracy  gap 1e-10 mm (the minimiser enters in second order); worst seen 1.1e-13 against the
///           golden file's 40 digits.
/// Cost      about 12 us for 81 rulings of 11 points: two or three sections a level.
/// Source    docs/theory/grooves-and-milling.md, 7.
[[nodiscard]] tl::expected<Gap, ErrorCode> gap(const Neighbourhood& near, const Cone& cone,
                                               const ToolPose& pose);

}  // namespace tubecut::groove
