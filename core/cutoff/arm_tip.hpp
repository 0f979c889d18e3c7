#pragma once

#include "core/base/elementary.hpp"
#include "core/cutoff/linkage.hpp"

namespace tubecut::cutoff {

/// Tool feed and its derivatives by the stroke, and the terms whose sum the second one is.
struct TipFeed {
  double feed = 0.0;              // mm
  double first = 0.0;             // mm/mm
  double second = 0.0;            // 1/mm
  double second_terms = 0.0;      // sum of the magnitudes of its terms
  double elevation_cosine = 1.0;  // |cos psi|
  double tangency = 1.0;          // 1 - rho cos e over its largest value: 0 at a dead point
};

/// Eq. (4) in coordinates of the arm tip P, with no arctangent: tan psi is a quotient of two
/// lengths. The proof's own way from stroke to feed; shares nothing with `Mechanism` but the
/// dimensions and k.
///
/// Source    docs/theory/feed-curves.md, section 2, eq. (4).
class ArmTip {
 public:
  ArmTip(const Linkage& linkage, double rad_per_mm);
  [[nodiscard]] TipFeed at(double stroke) const;
  /// The stroke of a feed by Newton's method from a near `guess`; at most 50 steps.
  [[nodiscard]] double stroke_of(double feed, double guess) const;

 private:
  Linkage linkage_;
  double rate_;
  double height_;
  elementary::SinCos slot_;
  double rod_height_ = 0.0;
};

}  // namespace tubecut::cutoff
