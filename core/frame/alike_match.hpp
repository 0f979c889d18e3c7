#pragma once

#include <optional>
#include <vector>

#include "core/frame/alike_form.hpp"

/// For `Gatherer` only.
namespace tubecut::frame::detail {

inline constexpr double kSameTurn = 1e-7;  // rad

/// Returns the angle reduced to [-pi, pi].
[[nodiscard]] double near_zero(double angle);

/// A part in a comparison.
struct Side {
  const Form& form;
  const Shape& shape;

  /// Returns true if every partner, hole and mark has a key.
  [[nodiscard]] bool whole() const;
};

/// Returns the rotations about the axis, rad, that may map a part onto another: they map each
/// matching side of the part to the side of the other's first partner that has one, else of its
/// first hole or mark. Each also occurs plus pi, because an axis has no sense. If turns differ by
/// at most a tenth of `within` on the surface, only the first is kept.
[[nodiscard]] std::vector<double> turns(const Side& member, const Side& by, double within);

/// Checks whether two parts resemble each other after the member is turned, at a few phases of each
/// partner and by the positions of holes and marks. `shift` is an estimate from these.
[[nodiscard]] std::optional<Laid> resembles(const Side& member, const Side& by, double turn,
                                            double within);

/// Returns the largest difference of how far the cuts follow matching partners beyond their metal;
/// mm.
[[nodiscard]] double missing_apart(const Shape& member, const Shape& by, const Laid& laid);

/// Returns the maximum distance of the square holes of two parts, each from the hole of the other
/// in the same place of the list: a bound by their branches' axes and orientations; mm.
[[nodiscard]] double square_holes_apart(const Form& one, const Form& other);

}  // namespace tubecut::frame::detail
