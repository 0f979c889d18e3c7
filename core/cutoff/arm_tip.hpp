#pragma once

#include "core/base/elementary.hpp"
#include "core/cutoff/linkage.hpp"

namespace tubecut::cutoff {

/// Tool feed and its derivatives with respect to the stroke.
struct TipFeed {
  double feed = 0.0;              // mm
  double first = 0.0;             // mm/mm
  double second = 0.0;            // 1/mm
  double second_terms = 0.0;      // sum of the magnitudes of its terms
  double elevation_cosine = 1.0;  // |cos psi|
  double tangency = 1.0;          // (1 - rho cos e) / (its largest value): 0 at a dead point
};

/// Eq. (4) in coordinates of the arm tip P, without arctangents: tan psi is a quotient of two
/// lengths. The verification computes feeds from strokes with it; it shares only the dimensions and
/// k with `Mechanism`.
///
/// Source    docs/theory/feed-curves.md, section 2, eq. (4).
class ArmTip {
 public:
  ArmTip(const Linkage& linkage, double rad_per_mm);
  [[nodiscard]] TipFeed at(double stroke) const;
  /// Computes the stroke of a feed by Newton's method from a close `guess`; at most 50 steps.
  [[nodiscard]] double stroke_of(double feed, double guess) const;

 private:
  Linkage linkage_;
  double rate_;
  double height_;
  elementary::SinCos slot_;
  double rod_height_ = 0.0;
};

}  // namespace tubecut::cutoff
