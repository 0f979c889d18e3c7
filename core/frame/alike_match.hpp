#pragma once

#include <optional>
#include <vector>

#include "core/frame/alike_form.hpp"

/// For `Gatherer` only.
namespace tubecut::frame::detail {

inline constexpr double kSameTurn = 1e-7;  // rad

/// An angle brought next to 0.
[[nodiscard]] double near_zero(double angle);

/// What a part is compared by.
struct Side {
  const Form& form;
  const Shape& shape;

  /// Is something said of every partner, hole and mark?
  [[nodiscard]] bool whole() const;
};

/// Turns about its axis, rad, that may lay a part onto another: the side of the other's first
/// partner that has one, else of its first hole or mark, onto each of the part's own. An axis has
/// no sense, so each also the other way round. Of turns that differ by no more than a tenth of
/// `within` on the surface, the first.
[[nodiscard]] std::vector<double> turns(const Side& member, const Side& by, double within);

/// Do two resemble each other, the member turned? By a few places of each partner, and by the
/// places of holes and marks; `shift` is as near as these tell it.
[[nodiscard]] std::optional<Laid> resembles(const Side& member, const Side& by, double turn,
                                            double within);

}  // namespace tubecut::frame::detail
