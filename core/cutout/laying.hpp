#pragma once

#include <memory>

#include "core/base/angle.hpp"
#include "core/cutout/chain.hpp"
#include "core/cutout/section_lay.hpp"
#include "core/joint/target.hpp"
#include "core/section/section.hpp"

namespace tubecut::cutout {

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
  /// Over corners of a section; `s`: of the anchor on the near side.
  Laying(const section::Wall& wall, double s, Lay lay, bool far)
      : outer_(wall.outer().girth() / kTwoPi),
        inner_(wall.bore().girth() / kTwoPi),
        wall_(wall.section().wall),
        lay_(lay),
        far_(far),
        over_(std::make_shared<const SectionLay>(wall, s, lay, far)) {}

  [[nodiscard]] double outer() const { return outer_; }
  [[nodiscard]] double inner() const { return inner_; }
  [[nodiscard]] double wall() const { return wall_; }
  [[nodiscard]] Lay lay() const { return lay_; }
  [[nodiscard]] bool far() const { return far_; }
  /// Of one that reaches over corners, else nullptr.
  [[nodiscard]] const SectionLay* over() const { return over_.get(); }
  /// Returns true if the same chain has the same rows about its anchor.
  [[nodiscard]] bool is_like(const Laying& other) const;
  /// Returns true if the walls of the cut-out are parallel, so that the beam is offset in the local
  /// plane.
  [[nodiscard]] bool parallel() const { return lay_ == Lay::prism || lay_ == Lay::flat; }

  /// The same place with walls along the anchor's normal: the way of a straight tool.
  [[nodiscard]] Laying straight() const;
  /// Way round on the outside from a fixed place there, mm, towards +b.
  [[nodiscard]] double outside(double b) const;

  /// Way round from the anchor's generator, rad, before the side counts: of b, on the radius rho,
  /// which over corners is that of the outside or of the bore.
  [[nodiscard]] double turn(double b, double rho) const;
  /// Phase from the anchor's, on its own side or the opposite one.
  [[nodiscard]] double phase(double turn) const { return far_ ? kPi - turn : turn; }
  /// How much a step of b is longer on the developed outside.
  [[nodiscard]] double stretch(double b) const;
  /// The torch's lean across on a prism at b, rad: `a` of the rows.
  [[nodiscard]] double lean(double b) const;
  /// Phase on the bore of a beam square to the outside whose axis lies a way round from the anchor
  /// there, mm.
  [[nodiscard]] double square_on_bore(double way) const;

 private:
  double outer_, inner_, wall_;
  Lay lay_;
  bool far_;
  std::shared_ptr<const SectionLay> over_ = {};
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
