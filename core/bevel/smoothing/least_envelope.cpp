#include "core/bevel/smoothing/least_envelope.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/pack.hpp"
#include "core/base/stop.hpp"
#include "core/bevel/smoothing/interior_point.hpp"
#include "core/bevel/smoothing/least_area.hpp"

namespace tubecut::bevel {
namespace {

using Array = Eigen::ArrayXd;
using Eigen::Index;

constexpr double kProved =
    1e-7;  // of the area: if the excess is larger, tries again with more digits

/// Returns the heights with B's own bits where they touch it: within a hundred millionth of the
/// change that the limits permit at that spacing, or so far from every break that no least profile
/// leaves B.
std::vector<double> touching(const AngleProfile& profile, const EnvelopeSpec& spec,
                             const Programme& p, const Array& f) {
  std::vector<double> out(profile.b.size());
  for (Index j = 0; j < p.size(); ++j) {
    const auto k = p.of_profile(j);
    const double narrow = std::min(p.h[p.previous(j)], p.h[j]) * p.pitch;
    const double touch = std::min(1.6e-8 * spec.limits.curvature * narrow * narrow,
                                  2e-10 * spec.limits.slope * narrow);
    const double height = std::min(f[j], spec.highest);
    const bool same = p.keeps[static_cast<std::size_t>(j)] != 0 || height <= profile.b[k] + touch;
    out[k] = same ? profile.b[k] : height;
  }
  return out;
}

bool keeps_limits(const AngleProfile& smoothed, const BevelRateLimits& limits) {
  const auto steep = steepness(smoothed), most = allowed_steepness(smoothed, limits);
  return steep.slope <= most.slope && steep.second <= most.second;
}

bool proved(const AngleProfile& profile, const EnvelopeSpec& spec, const Envelope& found) {
  return keeps_limits({profile.s, found.b, profile.period}, spec.limits) &&
         area_excess(profile, spec, found.multipliers, area_above(profile, found.b)) <= kProved;
}

template <class Numbers>
std::optional<Envelope> solved(const AngleProfile& profile, const EnvelopeSpec& spec,
                               const Programme& p) {
  // Few profiles come near the limit, so the programme without it comes first: it is smaller and
  // proves as much.
  for (const bool limited : {false, true}) {
    const auto least = interior_point<Numbers>(p, limited);
    if (!least || (!limited && least->heights.maxCoeff() > spec.highest)) continue;
    return Envelope{.b = touching(profile, spec, p, least->heights),
                    .multipliers = least->multipliers};
  }
  return std::nullopt;
}

}  // namespace

std::optional<Envelope> least_envelope(const AngleProfile& profile, const EnvelopeSpec& spec) {
  if (keeps_limits(profile, spec.limits)) return Envelope{profile.b, no_multipliers(profile)};
  if (stopped()) return std::nullopt;
  const Programme p(profile, spec);
  if (stopped()) return std::nullopt;
  std::optional<Envelope> found;
  for (const auto solve : {solved<Pack>, solved<double>, solved<long double>}) {
    found = solve(profile, spec, p);
    if (stopped() || (found && proved(profile, spec, *found))) break;
  }
  if (found && !keeps_limits({profile.s, found->b, profile.period}, spec.limits)) found.reset();
  return found;
}

}  // namespace tubecut::bevel
