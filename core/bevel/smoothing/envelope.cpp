#include <cmath>
#include <string>

#include "core/base/angle.hpp"
#include "core/base/stop.hpp"
#include "core/base/try.hpp"
#include "core/bevel/smoothing/braking_envelope.hpp"
#include "core/bevel/smoothing/least_area.hpp"
#include "core/bevel/smoothing/least_envelope.hpp"

namespace tubecut::bevel {
namespace {

Result<void> check_limits(const AngleProfile& profile, const EnvelopeSpec& spec) {
  const auto positive = [](double x) { return std::isfinite(x) && x > 0.0; };
  if (!positive(spec.limits.slope))
    return fail({.code = ErrorCode::out_of_range,
                 .member = "limits/slope",
                 .got = spec.limits.slope * kDegPerRad,
                 .limit = 0.0,
                 .unit = "deg/mm"});
  if (!positive(spec.limits.curvature))
    return fail({.code = ErrorCode::out_of_range,
                 .member = "limits/curvature",
                 .got = spec.limits.curvature * kDegPerRad,
                 .limit = 0.0,
                 .unit = "deg/mm^2"});
  for (std::size_t j = 0; j < profile.b.size(); ++j) {
    if (!(profile.b[j] <= spec.highest))
      return fail({.code = ErrorCode::out_of_range,
                   .member = "b/" + std::to_string(j),
                   .got = profile.b[j] * kDegPerRad,
                   .limit = spec.highest * kDegPerRad,
                   .unit = "deg"});
  }
  return {};
}

}  // namespace

Result<Envelope> envelope(const AngleProfile& profile, const EnvelopeSpec& spec) {
  TRY(check_profile(profile));
  TRY(check_limits(profile, spec));
  if (!spec.refine) return Envelope{.b = braking_envelope(profile, spec), .multipliers = {}};
  if (auto least = least_envelope(profile, spec)) return std::move(*least);
  if (stopped()) return fail({.code = ErrorCode::cancelled});
  return Envelope{.b = braking_envelope(profile, spec), .multipliers = no_multipliers(profile)};
}

}  // namespace tubecut::bevel
