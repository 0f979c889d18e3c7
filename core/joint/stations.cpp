#include "core/joint/stations.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/elementary.hpp"
#include "core/base/lanes.hpp"
#include "core/joint/cutters/tube_local.hpp"

namespace tubecut::joint {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();
constexpr double kStationTie = 1e-12;  // of radius + |z|, rounding of one height
constexpr double kOnSurface = 1e-14;   // relative, of lengths: the root is on the tube

/// Stations in parallel: cosines and sines of their phases.
struct Run {
  const double *cos_phi, *sin_phi;
  std::size_t n;
};
Run run_of(const Stations& s, std::size_t from, std::size_t to) {
  return {s.cos_phi.data() + from, s.sin_phi.data() + from, to - from};
}

// ---- a tube

TUBECUT_WIDE void sheets_of(const PreparedTube& tube, double radius, Run on, double* z) {
  const auto t = tube;
  for (std::size_t i = 0; i < on.n; ++i)
    z[i] = tube_sheet(t, tube_local(t, radius, on.cos_phi[i], on.sin_phi[i]));
}

/// Where the tube is higher than the current maximum, stores its height and its number.
TUBECUT_WIDE void raise(const PreparedTube& tube, double radius, Run on, double number, double* z,
                        double* highest) {
  const auto t = tube;
  for (std::size_t i = 0; i < on.n; ++i) {
    const auto p = tube_local(t, radius, on.cos_phi[i], on.sin_phi[i]);
    const double height = tube_sheet(t, p);
    const bool higher = tube_met(t, p, radius) & (height > z[i]);
    z[i] = higher ? height : z[i];
    highest[i] = higher ? number : highest[i];
  }
}

TUBECUT_WIDE void slopes_on(const PreparedTube& tube, double radius, Run on, double* out) {
  const auto t = tube;
  for (std::size_t i = 0; i < on.n; ++i)
    out[i] = tube_slope(t, tube_local(t, radius, on.cos_phi[i], on.sin_phi[i]));
}

struct NormalsOut {
  double *radial, *tangential, *axial;
};
TUBECUT_WIDE void normals_on(const PreparedTube& tube, double radius, Run on, NormalsOut out) {
  const auto t = tube;
  for (std::size_t i = 0; i < on.n; ++i) {
    const auto p = tube_local(t, radius, on.cos_phi[i], on.sin_phi[i]);
    const double cos_theta = std::max(-1.0, std::min(1.0, p.x / t.radius));
    const double sin_theta = p.s / t.radius;
    out.radial[i] = cos_theta * p.cos_delta + t.cos_inclination * sin_theta * p.sin_delta;
    out.tangential[i] = -cos_theta * p.sin_delta + t.cos_inclination * sin_theta * p.cos_delta;
    out.axial[i] = t.sin_inclination * sin_theta;
  }
}

/// Computes PreparedTube::steepest without branches, for many: stores the larger of `slope` and it.
TUBECUT_WIDE void steepen(const PreparedTube& tube, const Wall& wall, Run on, const double* root,
                          double* slope) {
  const auto t = tube;
  const auto w = wall;
  const double after = w.inner * (1.0 + kSameHeight);
  for (std::size_t i = 0; i < on.n; ++i) {
    const double c = on.cos_phi[i], s = on.sin_phi[i], z = root[i];
    const double cd = c * t.cos_clocking + s * t.sin_clocking;
    const double sd = s * t.cos_clocking - c * t.sin_clocking;
    const auto met = tube_section(t, w, cd);
    const auto leaning = [&](double x, double y) {
      const double radial = x * cd + t.cos_inclination * y * sd;
      const double steep = radial > 0.0 ? -kUnbounded : kUnbounded;
      return y > 0.0 ? -radial / (t.sin_inclination * y) : steep;
    };
    const double x = w.inner * cd + t.offset;
    const double y = (z - t.height) * t.sin_inclination + w.inner * sd * t.cos_inclination;
    const double noise = kOnSurface * (t.radius + std::abs(z) + std::abs(t.height));
    const double square = x * x + y * y, radius2 = t.radius * t.radius;
    // If the root is on it: its own slope.
    const double own = leaning(x, std::sqrt(std::max(0.0, (t.radius - x) * (t.radius + x))));
    // From outside: to both ends of the met part, and along the tangents.
    double best = -kUnbounded;
    const auto see = [&](bool seen, double value) {
      best = (seen & (value > best)) ? value : best;
    };
    const auto rise = [&](double rho) {
      return (tube_sheet(t, tube_local(t, rho, c, s)) - z) / (rho - w.inner);
    };
    see(met.from > after, rise(met.from));
    see(met.to > after, rise(met.to));
    const double f = radius2 / square;
    const double tangent = t.radius * std::sqrt(square - radius2) / square;
    const auto touch = [&](double side) {
      const double tx = f * x - side * y, ty = f * y + side * x;
      const double rho = (tx - t.offset) / cd;
      see((ty >= 0.0) & (rho >= met.from) & (rho <= met.to), leaning(tx, ty));
    };
    touch(tangent);
    touch(-tangent);
    const bool stands =
        (met.from <= w.inner) & (square <= t.radius * (t.radius + noise)) & (y >= 0.0);
    const double here = stands ? own : best;
    const bool counts = (met.from <= met.to) & (met.to > after) & (here > slope[i]);
    slope[i] = counts ? here : slope[i];
  }
}

// ---- any other kind, one by one

template <class Kind>
void sheets_of(const Kind& cutter, double radius, Run on, double* z) {
  for (std::size_t i = 0; i < on.n; ++i)
    z[i] = cutter.continued_sheet({radius, on.cos_phi[i], on.sin_phi[i]});
}

template <class Kind>
void raise(const Kind& cutter, double radius, Run on, double number, double* z, double* highest) {
  for (std::size_t i = 0; i < on.n; ++i) {
    const auto height = cutter.upper_sheet({radius, on.cos_phi[i], on.sin_phi[i]});
    if (!height || !(*height > z[i])) continue;
    z[i] = *height;
    highest[i] = number;
  }
}

template <class Kind>
void slopes_on(const Kind& cutter, double radius, Run on, double* out) {
  for (std::size_t i = 0; i < on.n; ++i)
    out[i] = cutter.continued_hit({radius, on.cos_phi[i], on.sin_phi[i]}).z_dphi;
}

template <class Kind>
void normals_on(const Kind& cutter, double radius, Run on, NormalsOut out) {
  for (std::size_t i = 0; i < on.n; ++i) {
    const auto n = cutter.continued_hit({radius, on.cos_phi[i], on.sin_phi[i]}).normal;
    out.radial[i] = n.x();
    out.tangential[i] = n.y();
    out.axial[i] = n.z();
  }
}

template <class Kind>
void steepen(const Kind& cutter, const Wall& wall, Run on, const double* root, double* slope) {
  for (std::size_t i = 0; i < on.n; ++i)
    slope[i] = std::max(slope[i],
                        cutter.steepest(wall, {wall.inner, on.cos_phi[i], on.sin_phi[i]}, root[i]));
}

/// Calls `with` for the runs of stations that one cutter holds.
template <class F>
void by_runs(std::span<const std::size_t> cutter, const F& with) {
  for (std::size_t from = 0; from < cutter.size();) {
    std::size_t to = from + 1;
    while (to < cutter.size() && cutter[to] == cutter[from]) ++to;
    with(cutter[from], from, to);
    from = to;
  }
}

}  // namespace

Stations stations_at(double radius, std::span<const double> phi) {
  Stations out{radius, std::vector<double>(phi.size()), std::vector<double>(phi.size())};
  elementary::sincos(phi, out.sin_phi, out.cos_phi);
  return out;
}

Contacts contacts_at(const Contour& contour, const Stations& stations,
                     std::span<const double> phi) {
  const auto n = stations.size();
  Contacts out{std::vector<double>(n), std::vector<std::size_t>(n)};
  std::size_t next = 0;  // segment that begins after the phase
  for (std::size_t i = 0; i < n; ++i) {
    while (next < contour.segments.size() && contour.segments[next].from <= phi[i]) ++next;
    out.cutter[i] = (next > 0 ? contour.segments[next - 1] : contour.segments.back()).cutter;
  }
  by_runs(out.cutter, [&](std::size_t cutter, std::size_t from, std::size_t to) {
    by_kind(contour.cutters[cutter], [&](const auto& kind) {
      sheets_of(kind, stations.radius, run_of(stations, from, to), out.z.data() + from);
    });
  });
  std::vector<double> best(n, -kUnbounded), number(n, 0.0);
  for (std::size_t k = 0; k < contour.cutters.size(); ++k)
    by_kind(contour.cutters[k], [&](const auto& kind) {
      raise(kind, stations.radius, run_of(stations, 0, n), static_cast<double>(k), best.data(),
            number.data());
    });
  for (std::size_t i = 0; i < n; ++i) {
    const double tie = kStationTie * (contour.radius + std::abs(out.z[i]));
    if (!(best[i] > out.z[i] + tie)) continue;
    out.z[i] = best[i];
    out.cutter[i] = static_cast<std::size_t>(number[i]);
  }
  return out;
}

Normals normals_at(std::span<const PreparedCutter> cutters, const Stations& stations,
                   std::span<const std::size_t> cutter) {
  const auto n = stations.size();
  Normals out{std::vector<double>(n), std::vector<double>(n), std::vector<double>(n)};
  by_runs(cutter, [&](std::size_t own, std::size_t from, std::size_t to) {
    by_kind(cutters[own], [&](const auto& kind) {
      normals_on(kind, stations.radius, run_of(stations, from, to),
                 {out.radial.data() + from, out.tangential.data() + from, out.axial.data() + from});
    });
  });
  return out;
}

void slopes_of(const PreparedCutter& cutter, const Stations& stations, std::span<double> out) {
  by_kind(cutter, [&](const auto& kind) {
    slopes_on(kind, stations.radius, run_of(stations, 0, stations.size()), out.data());
  });
}

std::vector<double> steepest_at(std::span<const PreparedCutter> cutters, const Wall& wall,
                                const Stations& inner, std::span<const double> z_root) {
  std::vector<double> out(inner.size(), -kUnbounded);
  for (const auto& cutter : cutters)
    by_kind(cutter, [&](const auto& kind) {
      steepen(kind, wall, run_of(inner, 0, inner.size()), z_root.data(), out.data());
    });
  return out;
}

}  // namespace tubecut::joint
