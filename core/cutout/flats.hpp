#pragma once

#include <optional>

#include "core/cutout/cutout.hpp"

/// Cut-outs on the flats of a section, and which of them leave these.
namespace tubecut::cutout {

struct FacePlace {
  int face;
  double offset;  // mm from its middle, as s grows; beyond its flat on the corner that follows it
};
/// Returns the face of an anchor, or that before its corner.
[[nodiscard]] FacePlace face_place(const section::Curve& outer, const Anchor& at);

/// Returns the face of one of a pattern, `step` from its anchor, and its place there.
[[nodiscard]] FacePlace step_place(const section::Curve& outer, const Anchor& at, const Step& step);

/// Returns s of the anchor of an instance whose chain does not lie within the anchor's flat, on the
/// outside and on the bore; nothing of one that does, and of one that has to.
[[nodiscard]] std::optional<double> over_corner(const section::Wall& wall, const Spec& spec,
                                                const Step& step, const Chain& chain);

/// Places an instance over corners: its face, and its phases.
void put_over_corner(const section::Wall& wall, const SectionLay& over, bool far, Instance& one);

/// Places an instance, `step` from its anchor: its face and the offset there, its phases on the
/// outside and on the bore. On the far side, it lies straight across.
void put_on_face(const section::Wall& wall, const Anchor& at, const Step& step, bool far,
                 Instance& one);

/// Returns what is wrong with the first instance, from index `first` on, that does not lie within
/// its flat on the outside and on the bore.
/// Errors  see `lay`.
[[nodiscard]] std::optional<Issue> beyond_flat(const Spec& spec, const Layout& layout,
                                               std::size_t first, const section::Wall& wall);

/// Returns half the length of a face's flat that lies on the outside and on the bore, mm.
[[nodiscard]] double half_flat(const section::Wall& wall, int face);

}  // namespace tubecut::cutout
