#include "core/section/section.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/angle.hpp"
#include "core/base/elementary.hpp"

namespace tubecut::section {
namespace {

constexpr double kDiagonal = 1.4142135623730951;  // of a unit square
constexpr double kSteel = 0.00785;                // kg per m and mm2
constexpr double kLeastInside = 0.05;             // of the wall, from the bore to a corner's centre
constexpr double kLeastDiagonal = 0.5;            // of the wall, of metal on the diagonal
constexpr double kHair = 1e-9;  // relative: rounding of what the caller calculated

tl::unexpected<Error> bad_radius(std::string member, double got, double limit, std::string hint) {
  return fail({.code = ErrorCode::out_of_range,
               .member = std::move(member),
               .got = got,
               .limit = limit,
               .unit = "mm",
               .hint = std::move(hint)});
}

}  // namespace

double Section::reach() const {
  return elementary::hypot(0.5 * height - corner, 0.5 * width - corner) + corner;
}

CornerRadii corner_radii(Standard standard, double wall) {
  if (standard == Standard::en_10210) return {1.5 * wall, wall};
  if (standard == Standard::astm_a500) return {2.0 * wall, wall};
  const double outer = wall <= 6.0 ? 2.0 : wall <= 10.0 ? 2.5 : 3.0;
  return {outer * wall, (outer - 1.0) * wall};
}

Result<void> check(const Section& s) {
  const double side = std::min(s.height, s.width), slack = kHair * side;
  if (!(s.corner >= 0.0) || 2.0 * s.corner > side + slack)
    return bad_radius("corner_radius", s.corner, 0.5 * side, "at most half the smaller side");
  if (!(s.inner_corner >= 0.0) || 2.0 * s.inner_corner > side - 2.0 * s.wall + slack)
    return bad_radius("inner_corner_radius", s.inner_corner, 0.5 * side - s.wall,
                      "at most half the bore's smaller side");
  const double further_in = s.wall + s.inner_corner - s.corner;
  const double inside =
      further_in <= kHair * s.wall ? s.corner - s.wall : s.inner_corner - kDiagonal * further_in;
  if (inside < kLeastInside * s.wall * (1.0 - kHair)) {
    const double not_concentric =
        s.wall + s.inner_corner - (s.inner_corner - kLeastInside * s.wall) / kDiagonal;
    const bool concentric =
        further_in <= kHair * s.wall || not_concentric >= s.wall + s.inner_corner;
    return bad_radius(
        "corner_radius", s.corner, concentric ? (1.0 + kLeastInside) * s.wall : not_concentric,
        "the centre of the outer corner must lie inside the bore, or lines across the wall of one "
        "corner would cross; use a larger corner radius");
  }
  const double diagonal = kDiagonal * s.wall - (kDiagonal - 1.0) * (s.corner - s.inner_corner);
  if (diagonal < kLeastDiagonal * s.wall)
    return bad_radius("inner_corner_radius", s.inner_corner,
                      s.corner - (kDiagonal - kLeastDiagonal) * s.wall / (kDiagonal - 1.0),
                      "less than half the wall would be left on the corner's diagonal");
  return {};
}

double area(const Section& s) {
  const double sharp = s.height * s.width - (s.height - 2.0 * s.wall) * (s.width - 2.0 * s.wall);
  return sharp - (4.0 - kPi) * (s.corner * s.corner - s.inner_corner * s.inner_corner);
}

double mass_per_metre(const Section& s) { return kSteel * area(s); }

Wall::Wall(const Section& section)
    : section_(section),
      outer_(section.outer()),
      bore_(section.bore()),
      apart_(section.wall + bore_.corner() - outer_.corner()) {
  if (std::abs(apart_) <= kHair * section.wall) apart_ = 0.0;
}

Across Wall::across(const Station& outside) const {
  return outside.on_corner ? from_corner(outside) : from_face(outside);
}

double Wall::thickness(const Station& outside) const {
  const bool own =
      outside.on_corner ? concentric() : std::abs(outside.along) <= bore_.half_flat(outside.face);
  return own ? section_.wall : across(outside).wall;
}

Across Wall::from_face(const Station& outside) const {
  const int face = outside.face;
  const double beyond = std::abs(outside.along) - bore_.half_flat(face);
  if (!(beyond > 0.0)) return {section_.wall, bore_.at(bore_.on_face(face, outside.along))};
  const double r = bore_.corner();
  const double off = std::min(beyond, r), left = std::sqrt((r - off) * (r + off));
  const double angle = elementary::atan2(off, left);
  const bool after = outside.along > 0.0;
  const int corner = after ? face : (face + 2) % 4 + 1;
  return {section_.wall + r - left,
          bore_.at(bore_.on_corner(corner, after ? angle : 0.5 * kPi - angle))};
}

Across Wall::from_corner(const Station& outside) const {
  const int corner = outside.face, next = corner % 4 + 1;
  const double ro = outer_.corner(), ri = bore_.corner();
  if (apart_ == 0.0) {
    if (ri > 0.0) return {section_.wall, bore_.at(bore_.on_corner(corner, outside.along))};
    return {section_.wall, bore_.at(bore_.on_face(next, -bore_.half_flat(next)))};
  }
  const auto turn = elementary::sincos(outside.along);
  const double beside = apart_ * (turn.cos - turn.sin);
  const double far =
      std::sqrt(std::max(0.0, (ri - beside) * (ri + beside))) - apart_ * (turn.cos + turn.sin);
  const double x = apart_ + far * turn.cos, y = apart_ + far * turn.sin;  // from the bore's centre
  if (x >= 0.0 && y >= 0.0)
    return {ro - far, bore_.at(bore_.on_corner(corner, elementary::atan2(y, x)))};
  const bool before = turn.cos >= turn.sin;  // the flat nearer to the outer centre
  const double flat = (ro - section_.wall) / (before ? turn.cos : turn.sin);
  const int face = before ? corner : next;
  const double along = outer_.half_flat(face) + flat * (before ? turn.sin : turn.cos);
  return {ro - flat, bore_.at(bore_.on_face(face, before ? along : -along))};
}

double Wall::outside_of(const Station& bore) const {
  const int face = bore.face, next = face % 4 + 1;
  const double ro = outer_.corner(), ri = bore_.corner();
  if (!bore.on_corner) {
    const double beyond = std::abs(bore.along) - outer_.half_flat(face);
    if (!(beyond > 0.0)) return outer_.on_face(face, bore.along);
    const double angle = elementary::atan2(beyond, ro - section_.wall);
    return bore.along > 0.0 ? outer_.on_corner(face, angle)
                            : outer_.on_corner((face + 2) % 4 + 1, 0.5 * kPi - angle);
  }
  if (apart_ == 0.0) return outer_.on_corner(face, bore.along);
  // From the outer corner's centre: along the normals of the faces before and after the corner.
  const auto turn = elementary::sincos(bore.along);
  const double x = ri * turn.cos - apart_, y = ri * turn.sin - apart_;
  if (y < 0.0) return outer_.on_face(face, outer_.half_flat(face) + y);
  if (x < 0.0) return outer_.on_face(next, -outer_.half_flat(next) - x);
  return outer_.on_corner(face, elementary::atan2(y, x));
}

}  // namespace tubecut::section
