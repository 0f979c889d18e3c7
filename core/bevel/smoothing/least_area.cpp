#include "core/bevel/smoothing/least_area.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace tubecut::bevel {
namespace {

/// Lengths after the nodes and the weights of their heights in the area, mm.
struct Ring {
  std::vector<double> h, w;
};

Ring ring(const AngleProfile& profile) {
  const auto n = profile.s.size();
  Ring out{std::vector<double>(n), std::vector<double>(n)};
  for (std::size_t j = 0; j < n; ++j)
    out.h[j] = j + 1 < n ? profile.s[j + 1] - profile.s[j]
                         : profile.s.front() + profile.period - profile.s.back();
  for (std::size_t j = 0; j < n; ++j) out.w[j] = 0.5 * (out.h[j == 0 ? n - 1 : j - 1] + out.h[j]);
  return out;
}

double sum(const std::vector<double>& v) { return std::accumulate(v.begin(), v.end(), 0.0); }

/// Returns contacts whose sum is that of the weights. The difference goes to contacts that differ
/// from their weight, because where the profile keeps B there is no load, and rounding must not add
/// up there.
std::vector<double> balanced(std::vector<double> contact, const std::vector<double>& weight) {
  double missing = 0.0, able = 0.0;
  const auto takes = [&](std::size_t j) { return contact[j] > 0.0 && contact[j] != weight[j]; };
  for (std::size_t j = 0; j < contact.size(); ++j) {
    missing += weight[j] - contact[j];
    if (takes(j)) able += contact[j];
  }
  if (!(able > 0.0)) return missing == 0.0 ? contact : weight;
  for (std::size_t j = 0; j < contact.size(); ++j)
    if (takes(j)) contact[j] *= 1.0 + missing / able;
  return contact;
}

/// Computes the multipliers of the second differences, mm^2, that balance the others; their mean is
/// free.
std::vector<double> bends(const Ring& r, const std::vector<double>& contact,
                          const std::vector<double>& slope) {
  const auto n = contact.size();
  std::vector<double> shear(n), out(n);
  double so_far = 0.0, moment = 0.0;
  for (std::size_t j = 0; j < n; ++j) {
    so_far += r.w[j] - contact[j];
    shear[j] = so_far;
    moment += r.h[j] * so_far - slope[j];
  }
  const double level = moment / sum(r.h);
  double bend = 0.0;
  for (std::size_t j = 0; j < n; ++j) {
    out[j] = bend;
    bend += slope[j] - r.h[j] * (shear[j] - level);
  }
  return out;
}

/// Returns x with the minimum sum w |x - it|: half of the weight lies on either side.
double weighted_median(const std::vector<double>& x, const std::vector<double>& w) {
  std::vector<std::pair<double, double>> nodes(x.size());
  for (std::size_t j = 0; j < x.size(); ++j) nodes[j] = {x[j], w[j]};
  double below = 0.5 * sum(w);  // remaining weight
  auto from = nodes.begin(), to = nodes.end();
  while (to - from > 1) {
    const auto middle = from + (to - from) / 2;
    std::ranges::nth_element(from, middle, to);
    double weight = 0.0;
    for (auto node = from; node != middle; ++node) weight += node->second;
    if (weight >= below) {
      to = middle;
    } else {
      below -= weight;
      from = middle;
    }
  }
  return from->first;
}

}  // namespace

double least_area(const AngleProfile& profile, const EnvelopeSpec& spec,
                  const Multipliers& multipliers, double area) {
  const auto r = ring(profile);
  const auto n = r.h.size();
  const auto of_the_profile = [&](const std::vector<double>& m) {
    return m.size() == n && std::ranges::all_of(m, [](double x) { return std::isfinite(x); });
  };
  constexpr double kNothing = -std::numeric_limits<double>::infinity();
  if (!of_the_profile(multipliers.contact) || !of_the_profile(multipliers.slope)) return kNothing;
  const auto contact = balanced(multipliers.contact, r.w);
  const auto bend = bends(r, contact, multipliers.slope);
  if (!of_the_profile(bend)) return kNothing;
  const double level = weighted_median(bend, r.w);
  const double middle = sum(profile.b) / static_cast<double>(n);
  double bound = 0.0;
  for (std::size_t j = 0; j < n; ++j) {
    bound += (contact[j] - r.w[j]) * (profile.b[j] - middle);
    if (contact[j] < 0.0)
      bound += contact[j] * std::min(spec.highest - profile.b[j], area / r.w[j]);
    bound -= spec.limits.slope * std::abs(multipliers.slope[j]);
    bound -= spec.limits.curvature * r.w[j] * std::abs(bend[j] - level);
  }
  return bound;
}

Multipliers no_multipliers(const AngleProfile& profile) {
  return {.contact = ring(profile).w, .slope = std::vector<double>(profile.s.size())};
}

double area_excess(const AngleProfile& profile, double least, double area) {
  constexpr double kNothing = 1e-6;  // rad
  const double share = (area - least) / std::max(area, kNothing * profile.period);
  return share < 0.0 ? 0.0 : share;  // NaN stays
}

double area_excess(const AngleProfile& profile, const EnvelopeSpec& spec,
                   const Multipliers& multipliers, double area) {
  return area_excess(profile, least_area(profile, spec, multipliers, area), area);
}

}  // namespace tubecut::bevel
