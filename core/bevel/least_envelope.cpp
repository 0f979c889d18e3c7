#include "core/bevel/least_envelope.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/bevel/interior_point.hpp"
#include "core/bevel/least_area.hpp"

namespace tubecut::bevel {
namespace {

using Array = Eigen::ArrayXd;
using Eigen::Index;

constexpr double kProved = 1e-7;  // of the area: more than that is tried again in longer numbers

/// Nodes further than any curve reaches from where B itself breaks a limit.
std::vector<char> kept_nodes(const Programme& p) {
  const Index n = p.size();
  const auto slope = [&](Index j) { return (p.b[p.next(j)] - p.b[j]) / p.h[j]; };
  Array away(n);
  for (Index j = 0; j < n; ++j) {
    const double in = slope(p.previous(j)), ahead = slope(j);
    const bool breaks = std::max(std::abs(in), std::abs(ahead)) > p.slope ||
                        std::abs(ahead - in) > p.curvature * p.w[j];
    away[j] = breaks ? 0.0 : std::numeric_limits<double>::infinity();
  }
  for (Index k = 0; k < 2 * n; ++k) {
    const Index j = k % n, back = n - 1 - j;
    away[j] = std::min(away[j], away[p.previous(j)] + p.h[p.previous(j)]);
    away[back] = std::min(away[back], away[p.next(back)] + p.h[back]);
  }
  const double range = p.b.maxCoeff() - p.b.minCoeff();
  const double reach = range / p.slope + 4.0 * p.slope / p.curvature;
  std::vector<char> keeps(static_cast<std::size_t>(n));
  for (Index j = 0; j < n; ++j) keeps[static_cast<std::size_t>(j)] = away[j] > reach ? 1 : 0;
  return keeps;
}

Programme programme(const AngleProfile& profile, const EnvelopeSpec& spec) {
  const auto n = static_cast<Index>(profile.b.size());
  const auto at = [](const std::vector<double>& v, Index j) {
    return v[static_cast<std::size_t>(j)];
  };
  const auto ahead = [&](Index j) {
    return j + 1 < n ? at(profile.s, j + 1) - at(profile.s, j)
                     : profile.s.front() + profile.period - profile.s.back();
  };
  Programme out{.profile = profile, .spec = spec};
  for (Array* a : {&out.h, &out.w, &out.b}) a->resize(n);
  const auto behind = [&](Index j) { return ahead(j > 0 ? j - 1 : n - 1); };
  const auto around = [&](Index j) { return behind(j) + ahead(j); };
  for (Index j = 1; j < n; ++j)
    if (around(j) > around(out.first) * (1.0 + 1e-9)) out.first = j;
  const auto [least, most] = std::ranges::minmax_element(profile.b);
  if (*most > *least) out.unit = *most - *least;
  out.pitch = profile.period / static_cast<double>(n);
  for (Index j = 0; j < n; ++j) {
    const Index k = (j + out.first) % n;
    out.h[j] = ahead(k) / out.pitch;
    out.w[j] = 0.5 * around(k) / out.pitch;
    out.b[j] = at(profile.b, k) / out.unit;
  }
  out.slope = spec.limits.slope * out.pitch / out.unit;
  out.curvature = spec.limits.curvature * out.pitch * out.pitch / out.unit;
  out.highest = spec.highest / out.unit;
  out.keeps = kept_nodes(out);
  return out;
}

/// The heights with B's own bits where they touch it: by less than a hundred millionth of what the
/// limits leave at that spacing, or so far from every break that no least profile leaves B.
std::vector<double> touching(const AngleProfile& profile, const EnvelopeSpec& spec,
                             const Programme& p, const Array& f) {
  std::vector<double> out(profile.b.size());
  for (Index j = 0; j < p.size(); ++j) {
    const auto k = static_cast<std::size_t>((j + p.first) % p.size());
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

template <class Real>
std::optional<Envelope> solved(const AngleProfile& profile, const EnvelopeSpec& spec,
                               const Programme& p, const std::stop_token& stop) {
  // Few profiles come near the limit: the programme without it is smaller, and proves as much.
  for (const bool limited : {false, true}) {
    const auto least = interior_point<Real>(p, limited, stop);
    if (!least || (!limited && least->heights.maxCoeff() > spec.highest)) continue;
    return Envelope{.b = touching(profile, spec, p, least->heights),
                    .multipliers = least->multipliers};
  }
  return std::nullopt;
}

}  // namespace

Multipliers Programme::of_profile(Multipliers own) const {
  for (double& c : own.contact) c *= pitch;
  for (double& slope_of : own.slope) slope_of *= pitch * pitch;
  const auto weights = no_multipliers(profile).contact;
  for (auto* values : {&own.contact, &own.slope})
    std::ranges::rotate(*values, values->end() - first);
  // Exactly, where nothing is borne.
  for (Eigen::Index j = 0; j < size(); ++j) {
    const auto k = static_cast<std::size_t>((j + first) % size());
    if (keeps[static_cast<std::size_t>(j)] != 0 && own.contact[k] == w[j] * pitch)
      own.contact[k] = weights[k];
  }
  return own;
}

std::optional<Envelope> least_envelope(const AngleProfile& profile, const EnvelopeSpec& spec,
                                       const std::stop_token& stop) {
  const auto p = programme(profile, spec);
  if (keeps_limits(profile, spec.limits)) return Envelope{profile.b, no_multipliers(profile)};
  auto found = solved<double>(profile, spec, p, stop);
  if (!stop.stop_requested() && !(found && proved(profile, spec, *found)))
    found = solved<long double>(profile, spec, p, stop);
  if (found && !keeps_limits({profile.s, found->b, profile.period}, spec.limits)) found.reset();
  return found;
}

}  // namespace tubecut::bevel
