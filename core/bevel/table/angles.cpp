#include "core/bevel/table/angles.hpp"

#include <cmath>
#include <vector>

#include "core/base/elementary.hpp"

namespace tubecut::bevel {
namespace {

/// The components of the normal that determine the angles. For the inside dihedral, the whole
/// derivation holds with the radial part reversed.
struct Parts {
  double radial;      // cos(dihedral) = -radial
  double across;      // sin(dihedral)
  double tangential;  // depends on the kind of dihedral; hypot(tangential, axial) = slant
  double slant;
  double axial;
};

Parts parts(const Eigen::Vector3d& n, Dihedral dihedral) {
  Parts p{.radial = dihedral == Dihedral::weld_side ? n.x() : -n.x(),
          .across = 0.0,
          .tangential = n.y(),
          .slant = elementary::hypot(n.y(), n.z()),
          .axial = n.z()};
  // The published normal is not a unit vector, but its radial part is correct, so the sine follows
  // from it.
  p.across = dihedral == Dihedral::as_published
                 ? std::sqrt(std::max(0.0, (1.0 - n.x()) * (1.0 + n.x())))
                 : p.slant;
  return p;
}

/// Returns slant or axial part as a factor of tan B. Where the surfaces touch both are 0: gamma
/// then counts as 0, and B is tau.
double factor(double part, double slant) { return slant > 0.0 ? part : 1.0; }

}  // namespace

Rule::Rule(const GrooveRule& rule, Dihedral dihedral) : rule_(rule), dihedral_(dihedral) {
  if (const auto* half = std::get_if<HalfDihedral>(&rule)) limit_ = half->cap.rad();
  if (const auto* fixed = std::get_if<FixedGroove>(&rule)) limit_ = fixed->angle.rad();
  if (const auto* zoned = std::get_if<ZonedGroove>(&rule)) zones_ = Zones(*zoned);
  const auto at = elementary::sincos(limit_);
  cos_limit_ = at.cos;
  sin_limit_ = at.sin;
}

// Computes tan B = tan tau / cos gamma with cos gamma = axial / slant, and tau = 90 deg - dihedral
// + groove. With groove = dihedral / 2: tan tau = (1 + cos dihedral) / sin dihedral.
Angles Rule::angles(const Eigen::Vector3d& normal) const {
  const auto p = parts(normal, dihedral_);
  Angles a{.dihedral = elementary::quick_atan2(p.across, -p.radial),
           .gamma = elementary::quick_atan2(p.tangential, p.axial),
           .flush = elementary::quick_atan2(-p.radial, p.axial)};
  if (std::holds_alternative<SquareCut>(rule_)) {
    a.groove = a.dihedral - 0.5 * kPi;
    return a;
  }
  if (std::holds_alternative<HalfDihedral>(rule_) && 0.5 * a.dihedral < limit_) {
    a.groove = 0.5 * a.dihedral;
    a.tau = 0.5 * kPi - a.groove;
    a.b = dihedral_ == Dihedral::as_published
              ? elementary::quick_atan2((1.0 - p.radial) * p.slant, p.across * p.axial)
              : elementary::quick_atan2(1.0 - p.radial, p.axial);
    return a;
  }
  a.groove = limit_;
  elementary::SinCos groove{sin_limit_, cos_limit_};
  if (std::holds_alternative<ZonedGroove>(rule_)) {
    a.groove = zones_.at(a.dihedral).groove;
    groove = elementary::sincos(a.groove);
  }
  a.tau = 0.5 * kPi - a.dihedral + a.groove;
  const double sin_tau = p.across * groove.sin - p.radial * groove.cos;
  const double cos_tau = p.across * groove.cos + p.radial * groove.sin;
  a.b = elementary::quick_atan2(sin_tau * factor(p.slant, p.slant),
                                cos_tau * factor(p.axial, p.slant));
  return a;
}

void Rule::angles(const joint::Normals& normals, std::span<Angles> out) const {
  const auto n = out.size();
  const bool weld = dihedral_ == Dihedral::weld_side;
  const bool square = std::holds_alternative<SquareCut>(rule_);
  const bool half = std::holds_alternative<HalfDihedral>(rule_);
  std::vector<double> radial(n), slant(n), against(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double t = normals.tangential[i], a = normals.axial[i];
    radial[i] = weld ? normals.radial[i] : -normals.radial[i];
    against[i] = -radial[i];
    slant[i] = std::sqrt(t * t + a * a);
  }
  std::vector<double> dihedral(n), gamma(n), flush(n), b(n, 0.0);
  elementary::quick_atan2(slant, against, dihedral);
  elementary::quick_atan2(normals.tangential, normals.axial, gamma);
  elementary::quick_atan2(against, normals.axial, flush);
  if (!square) {
    std::vector<double> rise(n), run(n);
    for (std::size_t i = 0; i < n; ++i) {
      const bool sharp = half & (0.5 * dihedral[i] < limit_);
      const double sin_tau = slant[i] * sin_limit_ - radial[i] * cos_limit_;
      const double cos_tau = slant[i] * cos_limit_ + radial[i] * sin_limit_;
      rise[i] = sharp ? 1.0 - radial[i] : sin_tau * factor(slant[i], slant[i]);
      run[i] = sharp ? normals.axial[i] : cos_tau * factor(normals.axial[i], slant[i]);
    }
    elementary::quick_atan2(rise, run, b);
  }
  for (std::size_t i = 0; i < n; ++i) {
    const bool sharp = half && 0.5 * dihedral[i] < limit_;
    const double groove = square ? dihedral[i] - 0.5 * kPi : sharp ? 0.5 * dihedral[i] : limit_;
    const double tau = square ? 0.0 : sharp ? 0.5 * kPi - groove : 0.5 * kPi - dihedral[i] + groove;
    out[i] = {dihedral[i], groove, tau, gamma[i], flush[i], b[i]};
  }
}

}  // namespace tubecut::bevel
