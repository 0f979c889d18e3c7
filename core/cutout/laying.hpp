#pragma once

#include "core/base/angle.hpp"
#include "core/cutout/chain.hpp"
#include "core/joint/target.hpp"
#include "core/section/section.hpp"

namespace tubecut::cutout {

/// How a local plane lies on a tube, about its anchor.
enum class Lay {
  developed,  // on the outside, the wall square to it: b is way round the outside
  prism,      // straight along the anchor's normal
  bored,  // the prism's edge on the bore, the wall square from there: a torch that does not tilt
  flat,   // on one face of a section: the same shape on the outside and on the bore
};

/// Lays a chain on one side of a tube. Phases count from the anchor's own. On a section, a phase is
/// the share of a girth in rad, and a radius that of the circle of this girth.
class Laying {
 public:
  Laying(const joint::Target& tube, Lay lay, bool far)
      : outer_(tube.outer_radius),
        inner_(tube.inner_radius()),
        wall_(tube.wall),
        lay_(lay),
        far_(far) {}
  /// On a flat of a section.
  Laying(const section::Section& section, bool far)
      : outer_(section.outer().girth() / kTwoPi),
        inner_(section.bore().girth() / kTwoPi),
        wall_(section.wall),
        lay_(Lay::flat),
        far_(far) {}

  [[nodiscard]] double outer() const { return outer_; }
  [[nodiscard]] double inner() const { return inner_; }
  [[nodiscard]] double wall() const { return wall_; }
  [[nodiscard]] Lay lay() const { return lay_; }
  [[nodiscard]] bool far() const { return far_; }
  /// Returns true if the walls of the cut-out are parallel, so that the beam is offset in the local
  /// plane.
  [[nodiscard]] bool parallel() const { return lay_ == Lay::prism || lay_ == Lay::flat; }

  /// Way round from the anchor's generator, rad, before the side counts: of b, on the radius rho.
  [[nodiscard]] double turn(double b, double rho) const;
  /// Phase from the anchor's, on its own side or the opposite one.
  [[nodiscard]] double phase(double turn) const { return far_ ? kPi - turn : turn; }
  /// How much a step of b is longer on the developed outside.
  [[nodiscard]] double stretch(double b) const;

 private:
  double outer_, inner_, wall_;
  Lay lay_;
  bool far_;
};

/// What a chain takes, each by a closed form or, along arcs, by Gauss.
struct Taken {
  double outer_area = 0.0, inner_area = 0.0;  // mm^2
  double volume = 0.0;                        // mm^3
};
/// Accuracy  1e-12 of itself.
/// Source    docs/theory/cutouts.md, section 3.
[[nodiscard]] Taken taken(const Laying& laying, const Chain& chain);

/// The area that the chain removes from the tube's section at a = `at`, mm^2.
[[nodiscard]] double removed(const Laying& laying, const Chain& chain, double at);

}  // namespace tubecut::cutout
