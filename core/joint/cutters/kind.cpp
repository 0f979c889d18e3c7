#include "core/joint/cutters/kind.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/elementary.hpp"
#include "core/math/rotation.hpp"

namespace tubecut::joint {

Bearing bearing_of_axis(Eigen::Vector3d d) {
  d /= d.norm();
  Bearing out{math::whole_turn(elementary::atan2(d.x(), -d.y())), std::nullopt};
  if (std::abs(d.z()) <= kSquare) return out;
  if (d.z() < 0.0) d = -d;
  out.lean = math::whole_turn(elementary::atan2(d.y(), d.x()));
  return out;
}

tl::unexpected<Error> beyond_limit(std::string_view field, double got, double limit,
                                   std::string unit) {
  return fail({.code = ErrorCode::out_of_range,
               .member = std::string(field),
               .got = got,
               .limit = limit,
               .unit = std::move(unit)});
}

tl::unexpected<Error> zero_length(std::string_view field) {
  return fail({.code = ErrorCode::zero_length,
               .member = std::string(field),
               .got = 0.0,
               .limit = 0.0,
               .hint = "the vector's length must be greater than the limit"});
}

tl::unexpected<Error> parallel_axes(std::string_view field, double sine, std::string hint) {
  return fail({.code = ErrorCode::parallel_axes,
               .member = std::string(field),
               .got = elementary::asin(std::clamp(sine, -1.0, 1.0)) * kDegPerRad,
               .limit = elementary::asin(kParallel) * kDegPerRad,
               .unit = "deg",
               .hint = std::move(hint)});
}

}  // namespace tubecut::joint
