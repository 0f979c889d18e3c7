#include "core/bevel/smoothing/programme.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/bevel/smoothing/least_area.hpp"

namespace tubecut::bevel {
namespace {

using Array = Programme::Array;
using Index = Programme::Index;

constexpr double kLong = 1e-3;  // of the mean spacing: long enough to divide by

/// Returns the nodes that no curve reaches from where B itself breaks a limit.
std::vector<char> kept_nodes(const Programme& p) {
  const Index n = p.size();
  const auto slope = [&](Index j) { return (p.b[p.next(j)] - p.b[j]) / p.h[j]; };
  Array away(n);
  double in = slope(n - 1);
  for (Index j = 0; j < n; ++j) {
    const double ahead = slope(j);
    const bool breaks = std::max(std::abs(in), std::abs(ahead)) > p.slope ||
                        std::abs(ahead - in) > p.curvature * p.w[j];
    away[j] = breaks ? 0.0 : std::numeric_limits<double>::infinity();
    in = ahead;
  }
  // Goes once around in each direction, and continues while that is nearer.
  const auto nearer = [&](Index j, double by_the_last) {
    const bool is = by_the_last < away[j];
    if (is) away[j] = by_the_last;
    return is;
  };
  for (Index k = 1; k < 2 * n; ++k) {
    const Index j = k < n ? k : k - n;
    if (!nearer(j, away[p.previous(j)] + p.h[p.previous(j)]) && k >= n) break;
  }
  for (Index k = 1; k < 2 * n; ++k) {
    const Index j = k < n ? n - 1 - k : 2 * n - 1 - k;
    if (!nearer(j, away[p.next(j)] + p.h[j]) && k >= n) break;
  }
  const double range = p.b.maxCoeff() - p.b.minCoeff();
  const double reach = range / p.slope + 4.0 * p.slope / p.curvature;
  std::vector<char> keeps(static_cast<std::size_t>(n));
  for (Index j = 0; j < n; ++j) keeps[static_cast<std::size_t>(j)] = away[j] > reach ? 1 : 0;
  return keeps;
}

/// Balances the multipliers. Between nodes that keep B there is no load, and rounding must not add
/// up: their contacts are their weights, and each run of other nodes balances by itself, by the
/// contacts at its ends.
void balance_stretches(const Programme& p, Array& contacts, Array& slopes) {
  const Index n = p.size();
  const auto kept = [&](Index j) { return p.keeps[static_cast<std::size_t>(j)] != 0; };
  for (Index j = 0; j < n; ++j) {
    if (kept(j)) contacts[j] = p.w[j];
    if (kept(j) && kept(p.next(j))) slopes[j] = 0.0;
  }
  for (Index before = 0; before < n; ++before) {
    if (!kept(before) || kept(p.next(before))) continue;
    double force = 0.0, moment = -slopes[before], length = p.h[before];
    Index j = p.next(before);
    for (; !kept(j); j = p.next(j)) {
      force += p.w[j] - contacts[j];
      moment += p.h[j] * force - slopes[j];
      length += p.h[j];
    }
    contacts[before] += moment / length;
    contacts[j] += force - moment / length;
  }
}

}  // namespace

Programme::Programme(const AngleProfile& of, const EnvelopeSpec& limits)
    : profile(of), spec(limits) {
  const auto n = static_cast<Index>(profile.b.size());
  const auto at = [](const std::vector<double>& v, Index j) {
    return v[static_cast<std::size_t>(j)];
  };
  const auto ahead = [&](Index j) {
    return j + 1 < n ? at(profile.s, j + 1) - at(profile.s, j)
                     : profile.s.front() + profile.period - profile.s.back();
  };
  for (Array* a : {&h, &w, &b}) a->resize(n);
  const auto around = [&](Index j) { return ahead(j > 0 ? j - 1 : n - 1) + ahead(j); };
  double longest = around(0);
  for (Index j = 1; j < n; ++j) {
    if (!(around(j) > longest * (1.0 + 1e-9))) continue;
    first = j;
    longest = around(j);
  }
  const auto [least, most] = std::ranges::minmax_element(profile.b);
  if (*most > *least) unit = *most - *least;
  pitch = profile.period / static_cast<double>(n);
  for (Index j = 0; j < n; ++j) {
    const auto k = static_cast<Index>(of_profile(j));
    h[j] = ahead(k) / pitch;
    w[j] = 0.5 * around(k) / pitch;
    b[j] = at(profile.b, k) / unit;
  }
  slope = spec.limits.slope * pitch / unit;
  curvature = spec.limits.curvature * pitch * pitch / unit;
  highest = spec.highest / unit;
  keeps = kept_nodes(*this);
}

/// They follow from the forces on either side. Over a step that is too short for a division, those
/// are known except for a part that both its ends share: the last pinned height of such a run takes
/// the remainder of the forces at its long ends.
void Programme::set_pinned(Array& contacts, const Array& slopes, const Array& bends) const {
  const auto shear = [&](Index j) { return (slopes[j] + bends[j] - bends[next(j)]) / h[j]; };
  Index from = 0;
  while (h[previous(from)] < kLong) ++from;  // half of the longest two steps is long
  for (Index seen = 0; seen < size();) {
    double before = shear(previous(from)), left = before;
    Index last = -1, j = from;
    for (;; j = next(j)) {
      const double after = shear(j);
      left += w[j];
      if (no_room(j)) {
        contacts[j] = w[j] + before - after;
        last = j;
      }
      left -= contacts[j];
      before = after;
      ++seen;
      if (h[j] >= kLong) break;
    }
    if (last >= 0) contacts[last] += left - shear(j);
    from = next(j);
  }
}

Multipliers Programme::multipliers(const Array& contacts, const Array& slopes) const {
  Array contact = contacts, of_slope = slopes;
  balance_stretches(*this, contact, of_slope);
  auto out = no_multipliers(profile);
  for (Index j = 0; j < size(); ++j) {
    const auto k = of_profile(j);
    // Exactly its weight if there is no load.
    if (keeps[static_cast<std::size_t>(j)] == 0 || contact[j] != w[j])
      out.contact[k] = contact[j] * pitch;
    out.slope[k] = of_slope[j] * pitch * pitch;
  }
  return out;
}

}  // namespace tubecut::bevel
