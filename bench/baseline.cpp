#include "bench/baseline.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>

namespace baseline {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kNothing = -std::numeric_limits<double>::infinity();

/// A tube with the sines and cosines of its own angles.
struct Prepared {
  double r, s, h, sin_a, cos_a, sin_b, cos_b;
};

std::vector<Prepared> prepared(const std::vector<Tube>& tubes) {
  std::vector<Prepared> out;
  for (const auto& t : tubes)
    out.push_back({t.radius, t.offset, t.height, std::sin(t.inclination), std::cos(t.inclination),
                   std::sin(t.clocking), std::cos(t.clocking)});
  return out;
}

/// A generator of the target seen from a tube.
struct Local {
  double cos_delta, sin_delta, x, chord;  // chord: S, NaN where the tube is missed
};

Local local(const Prepared& t, double cos_phi, double sin_phi, double rho) {
  const double cos_delta = cos_phi * t.cos_b + sin_phi * t.sin_b;
  const double sin_delta = sin_phi * t.cos_b - cos_phi * t.sin_b;
  const double x = rho * cos_delta + t.s;
  return {cos_delta, sin_delta, x, std::sqrt((t.r - x) * (t.r + x))};
}

double height(const Prepared& t, const Local& p, double rho) {
  return t.h + (p.chord - rho * p.sin_delta * t.cos_a) / t.sin_a;
}

/// The highest tube of one generator.
struct Hit {
  int tube = -1;
  double z = kNothing;
  Local at{};
};

Hit highest(const std::vector<Prepared>& tubes, double cos_phi, double sin_phi, double rho) {
  Hit best;
  for (std::size_t i = 0; i < tubes.size(); ++i) {
    const Local p = local(tubes[i], cos_phi, sin_phi, rho);
    const double z = height(tubes[i], p, rho);
    if (z > best.z) best = {static_cast<int>(i), z, p};
  }
  return best;
}

/// The tube's normal as (radial, tangential, axial) of the target.
struct Normal {
  double r, phi, z;
};

Normal normal(const Prepared& t, const Local& p) {
  const double cos_theta = p.x / t.r, sin_theta = p.chord / t.r;
  return {cos_theta * p.cos_delta + t.cos_a * sin_theta * p.sin_delta,
          -cos_theta * p.sin_delta + t.cos_a * sin_theta * p.cos_delta, t.sin_a * sin_theta};
}

void append_angles(const Normal& n, Angles& out) {
  const double sine = std::sqrt(n.phi * n.phi + n.z * n.z);
  const double psi = std::atan2(sine, -n.r);
  const bool sharp = psi < 0.5 * kPi;
  const double groove = sharp ? 0.5 * psi : 0.25 * kPi;
  out.dihedral.push_back(psi);
  out.groove.push_back(groove);
  out.tau.push_back(0.5 * kPi - psi + groove);
  out.gamma.push_back(std::atan2(n.phi, n.z));
  out.flush.push_back(std::atan2(-n.r, n.z));
  out.b.push_back(sharp ? std::atan2(1.0 - n.r, n.z)
                        : std::atan2(sine * (sine - n.r), (sine + n.r) * n.z));
}

template <class See>
void walk(const std::vector<Prepared>& tubes, double rho, int n, Contour& out, See see) {
  for (int i = 0; i < n; ++i) {
    const double phi = 2.0 * kPi * i / n;
    const double c = std::cos(phi), s = std::sin(phi);
    const Hit hit = highest(tubes, c, s, rho);
    out.phi.push_back(phi);
    out.z.push_back(hit.z);
    out.tube.push_back(hit.tube);
    see(hit, c, s);
  }
}

/// The end of a cut's line: radii of both walls.
struct Wall {
  double inner, outer;
};

/// Slope of the steepest straight line across the wall from the root to this tube. Section 5.3.
double steepest(const Prepared& t, const Wall& wall, const Hit& root, bool own, double c,
                double s) {
  const Local p = local(t, c, s, wall.inner);
  if (own) {
    const Normal n = normal(t, p);
    return -n.r / n.z;
  }
  double from = wall.inner, to = wall.outer;  // where it is met
  const double side = std::copysign(1.0, p.cos_delta), cd = std::abs(p.cos_delta);
  from = std::max(from, (-t.r - side * t.s) / cd);
  to = std::min(to, (t.r - side * t.s) / cd);
  if (!(from <= to)) return kNothing;
  double best = kNothing;
  for (const double rho : {from, to})
    if (rho > wall.inner)
      best = std::max(best, (height(t, local(t, c, s, rho), rho) - root.z) / (rho - wall.inner));
  // The tangent from the root, in the tube's cross-section.
  const double x = p.x, y = (root.z - t.h) * t.sin_a + wall.inner * p.sin_delta * t.cos_a;
  const double square = x * x + y * y, root_of = std::sqrt(square - t.r * t.r);
  for (const double turn : {t.r * root_of / square, -t.r * root_of / square}) {
    const double tx = t.r * t.r / square * x - turn * y, ty = t.r * t.r / square * y + turn * x;
    const double rho = (tx - t.s) / p.cos_delta;
    if (ty > 0.0 && rho >= from && rho <= to)
      best = std::max(best, -(tx * p.cos_delta + t.cos_a * ty * p.sin_delta) / (t.sin_a * ty));
  }
  return best;
}

/// True length from one station to the next: five Gauss points on one tube, the chord elsewhere.
double stretch(const Prepared& t, double from, double to, double rho) {
  constexpr std::array<double, 5> kAt{0.0, -0.5384693101056831, 0.5384693101056831,
                                      -0.906179845938664, 0.906179845938664};
  constexpr std::array<double, 5> kWeight{0.5688888888888889, 0.47862867049936647,
                                          0.47862867049936647, 0.23692688505618908,
                                          0.23692688505618908};
  double sum = 0.0;
  for (std::size_t k = 0; k < kAt.size(); ++k) {
    const double phi = 0.5 * (from + to) + 0.5 * (to - from) * kAt[k];
    const Local p = local(t, std::cos(phi), std::sin(phi), rho);
    const double rise = p.x * rho * p.sin_delta / p.chord;
    const double slope = (rise - rho * p.cos_delta * t.cos_a) / t.sin_a;
    sum += kWeight[k] * std::sqrt(rho * rho + slope * slope);
  }
  return 0.5 * (to - from) * sum;
}

std::vector<double> lengths(const std::vector<Prepared>& tubes, const Contour& c, double rho) {
  std::vector<double> out{0.0};
  for (std::size_t i = 0; i + 1 < c.phi.size(); ++i) {
    const bool one = c.tube[i] == c.tube[i + 1];
    const double width = c.phi[i + 1] - c.phi[i];
    const double more =
        one ? stretch(tubes[static_cast<std::size_t>(c.tube[i])], c.phi[i], c.phi[i + 1], rho)
            : std::hypot(rho * width, c.z[i + 1] - c.z[i]);
    out.push_back(out.back() + more);
  }
  return out;
}

/// The braking envelope of B over even steps h round the ring. Section 6.2.
class Envelope {
 public:
  Envelope(const std::vector<double>& b, double h, const Limits& limits)
      : b_(b), h_(h), limits_(limits), n_(b.size()) {}

  std::vector<double> smoothed() const {
    std::vector<double> start(n_);
    for (std::size_t j = 0; j < n_; ++j) start[j] = start_slope(j);
    auto e = b_;
    sweep(start, true, e);
    sweep(start, false, e);
    return rolled(e);
  }

 private:
  double start_slope(std::size_t j) const {
    const double in = (b_[j] - b_[(j + n_ - 1) % n_]) / h_, out = (b_[(j + 1) % n_] - b_[j]) / h_;
    const double low = in - 0.5 * limits_.curvature * h_, high = out + 0.5 * limits_.curvature * h_;
    double m = 0.5 * (low + high);
    if (low > high) m = std::abs(in) <= std::abs(out) ? low : high;
    return std::clamp(m, -limits_.slope, limits_.slope);
  }

  void sweep(const std::vector<double>& start, bool forward, std::vector<double>& e) const {
    const auto top = static_cast<std::size_t>(std::max_element(b_.begin(), b_.end()) - b_.begin());
    const double sense = forward ? 1.0 : -1.0;
    double value = b_[top], slope = sense * start[top];
    std::size_t j = top;
    for (std::size_t visit = 0; visit < 2 * n_; ++visit) {
      const double braking = std::min(h_, (slope + limits_.slope) / limits_.curvature);
      const double end = slope - limits_.curvature * braking;
      value += 0.5 * (slope + end) * braking - limits_.slope * (h_ - braking);
      slope = end;
      j = forward ? (j + 1) % n_ : (j + n_ - 1) % n_;
      if (b_[j] >= value) {
        value = b_[j];
        slope = sense * start[j];
      }
      if (visit >= n_) e[j] = std::max(e[j], value);
    }
  }

  /// The upper hull of e - A s^2/2, over one turn from the highest e.
  std::vector<double> rolled(const std::vector<double>& e) const {
    const auto top = static_cast<std::size_t>(std::max_element(e.begin(), e.end()) - e.begin());
    const double a = 0.5 * limits_.curvature;
    const auto y = [&](std::size_t k) {
      const double s = h_ * static_cast<double>(k);
      return e[(top + k) % n_] - a * s * s;
    };
    std::vector<std::size_t> hull;
    for (std::size_t k = 0; k <= n_; ++k) {
      while (hull.size() > 1) {
        const std::size_t o = hull[hull.size() - 2], q = hull.back();
        if ((y(q) - y(o)) * static_cast<double>(k - q) >=
            (y(k) - y(q)) * static_cast<double>(q - o))
          break;
        hull.pop_back();
      }
      hull.push_back(k);
    }
    auto f = e;
    for (std::size_t c = 0; c + 1 < hull.size(); ++c)
      for (std::size_t k = hull[c] + 1; k < hull[c + 1]; ++k) {
        const double t =
            static_cast<double>(k - hull[c]) / static_cast<double>(hull[c + 1] - hull[c]);
        const double s = h_ * static_cast<double>(k);
        f[(top + k) % n_] = (1.0 - t) * y(hull[c]) + t * y(hull[c + 1]) + a * s * s;
      }
    return f;
  }

  const std::vector<double>& b_;
  double h_;
  Limits limits_;
  std::size_t n_;
};

void print(std::string_view name, const std::vector<double>& values, double unit,
           std::string& out) {
  std::array<char, 32> text{};
  out += out.empty() ? "{\"" : ",\"";
  out += name;
  out += "\":[";
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) out += ',';
    const auto end = std::to_chars(text.data(), text.data() + text.size(), values[i] * unit).ptr;
    out.append(text.data(), end);
  }
  out += ']';
}

}  // namespace

Contour contour(const std::vector<Tube>& tubes, double rho, int n) {
  Contour out;
  walk(prepared(tubes), rho, n, out, [](const Hit&, double, double) {});
  return out;
}

Angles contour_with_angles(const std::vector<Tube>& tubes, double rho, int n) {
  const auto ready = prepared(tubes);
  Angles out;
  walk(ready, rho, n, out.at, [&](const Hit& hit, double, double) {
    append_angles(normal(ready[static_cast<std::size_t>(hit.tube)], hit.at), out);
  });
  return out;
}

Table table(const End& end, const Limits& limits, int n) {
  const auto tubes = prepared(end.partners);
  const Wall wall{end.outer_radius - end.wall, end.outer_radius};
  Table out;
  std::vector<double> floor;
  walk(tubes, wall.inner, n, out.angles.at, [&](const Hit& hit, double c, double s) {
    append_angles(normal(tubes[static_cast<std::size_t>(hit.tube)], hit.at), out.angles);
    double slope = kNothing;
    for (std::size_t i = 0; i < tubes.size(); ++i)
      slope = std::max(slope, steepest(tubes[i], wall, hit, static_cast<int>(i) == hit.tube, c, s));
    out.required.push_back(std::atan(slope));
    floor.push_back(std::max(out.required.back(), out.angles.b.back()));
    out.developed.push_back(wall.inner * out.angles.at.phi.back());
  });
  out.length = lengths(tubes, out.angles.at, wall.inner);
  out.b = Envelope(floor, wall.inner * 2.0 * kPi / n, limits).smoothed();
  for (std::size_t i = 0; i < out.b.size(); ++i) {
    out.z_outer.push_back(out.angles.at.z[i] + end.wall * std::tan(out.b[i]));
    out.beam.push_back(end.wall / std::cos(out.b[i]));
  }
  return out;
}

std::string json(const Table& t) {
  constexpr double kDeg = 180.0 / kPi;
  std::string out;
  print("phi_deg", t.angles.at.phi, kDeg, out);
  print("developed_mm", t.developed, 1.0, out);
  print("length_mm", t.length, 1.0, out);
  print("z_inner_mm", t.angles.at.z, 1.0, out);
  print("z_outer_mm", t.z_outer, 1.0, out);
  print("dihedral_deg", t.angles.dihedral, kDeg, out);
  print("groove_deg", t.angles.groove, kDeg, out);
  print("tau_deg", t.angles.tau, kDeg, out);
  print("gamma_deg", t.angles.gamma, kDeg, out);
  print("flush_deg", t.angles.flush, kDeg, out);
  print("b_raw_deg", t.angles.b, kDeg, out);
  print("b_required_deg", t.required, kDeg, out);
  print("b_deg", t.b, kDeg, out);
  print("beam_mm", t.beam, 1.0, out);
  return out + '}';
}

}  // namespace baseline
