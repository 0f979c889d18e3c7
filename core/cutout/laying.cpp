#include "core/cutout/laying.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/base/angle.hpp"
#include "core/base/elementary.hpp"
#include "core/math/quadrature.hpp"

namespace tubecut::cutout {
namespace {

constexpr int kGaussPoints = 12;
constexpr double kPlacesATurn = 40.0;
constexpr double kNearBore = 0.95;
constexpr double kFlat = 1e-3;  // of the radius: a step of b below which Gauss serves for a line

/// T(b) of one quantity and, for lines, its integral P(b).
struct Integrand {
  std::function<double(double)> t, p;
};

double root(double rho, double b) { return std::sqrt(std::max(0.0, rho * rho - b * b)); }

/// Way round on the radius rho from a prism's middle to b.
Integrand way(double rho) {
  return {[rho](double b) { return rho * elementary::asin(b / rho); },
          [rho](double b) { return rho * (b * elementary::asin(b / rho) + root(rho, b)); }};
}

/// Area under the circle of radius rho from a prism's middle to b.
Integrand under(double rho) {
  return {
      [rho](double b) { return 0.5 * (b * root(rho, b) + rho * rho * elementary::asin(b / rho)); },
      [rho](double b) {
        const double q = root(rho, b);
        return 0.5 * (rho * rho * (b * elementary::asin(b / rho) + q) - q * q * q / 3.0);
      }};
}

double by_gauss(const Segment& s, const Integrand& of, int places, double rho) {
  static const auto kRule = math::gauss_legendre(kGaussPoints);
  const auto graded = shares_towards(s, places, kNearBore * rho);
  const auto pieces = graded.empty() ? static_cast<std::size_t>(places) : graded.size() - 1;
  double sum = 0.0;
  for (std::size_t i = 0; i < pieces; ++i)
    for (std::size_t k = 0; k < kRule.nodes.size(); ++k) {
      const double along = 0.5 * (1.0 + kRule.nodes[k]);
      const double part = graded.empty() ? 0.0 : graded[i + 1] - graded[i];
      const double share =
          graded.empty() ? (static_cast<double>(i) + along) / places : graded[i] + along * part;
      const double da = graded.empty()
                            ? s.along(share).x() * s.length() * 0.5 * kRule.weights[k] / places
                            : s.along(share).x() * s.length() * 0.5 * kRule.weights[k] * part;
      sum += of.t(s.at(share).y()) * da;
    }
  return sum;
}

/// Of T(b) da around the chain, without its sign: that of an enclosed quantity.
double around(const Chain& chain, const Integrand& of, double rho) {
  double sum = 0.0;
  for (const auto& s : chain) {
    const double rise = s.to.y() - s.from.y();
    if (s.arc())
      sum += by_gauss(
          s, of,
          std::max(1, static_cast<int>(std::ceil(kPlacesATurn * std::abs(s.sweep) / kTwoPi))), rho);
    else if (std::abs(rise) < kFlat * rho)
      sum += by_gauss(s, of, 1, rho);
    else
      sum += (s.to.x() - s.from.x()) * (of.p(s.to.y()) - of.p(s.from.y())) / rise;
  }
  return std::abs(sum);
}

Taken taken_over(const SectionLay& lay, const Chain& chain) {
  static const auto kRule = math::gauss_legendre(kGaussPoints);
  const double none = lay.area(0.0);  // an area of the wall, not from the datum
  const auto start = lay.at(0.0);
  Taken out;
  for (const auto& s : divided(chain, lay.breaks())) {
    const auto shares = cells(s);
    for (std::size_t i = 0; i + 1 < shares.size(); ++i)
      for (std::size_t k = 0; k < kRule.nodes.size(); ++k) {
        const double part = shares[i + 1] - shares[i];
        const double share = shares[i] + 0.5 * (1.0 + kRule.nodes[k]) * part;
        const double da = s.along(share).x() * s.length() * 0.5 * kRule.weights[k] * part;
        const double b = s.at(share).y();
        const auto here = lay.at(b);
        out.outer_area += (here.s - start.s) * da;
        out.inner_area += (here.s_bore - start.s_bore) * da;
        out.volume += (lay.area(b) - none) * da;
      }
  }
  return {std::abs(out.outer_area), std::abs(out.inner_area), std::abs(out.volume)};
}

}  // namespace

Laying Laying::straight() const {
  auto out = *this;
  out.lay_ = Lay::prism;
  if (over_)
    out.over_ =
        std::make_shared<const SectionLay>(over_->wall(), over_->s_of_spec(), Lay::prism, far_);
  return out;
}

double Laying::outside(double b) const {
  return over_ ? over_->sense() * over_->at(b).s : outer_ * turn(b, outer_);
}

double Laying::turn(double b, double rho) const {
  if (over_) return over_->way(b, rho != inner_) / rho;
  if (lay_ == Lay::developed) return b / outer_;
  if (lay_ == Lay::flat) return b / rho;
  return elementary::asin(std::clamp(b / (lay_ == Lay::prism ? rho : inner_), -1.0, 1.0));
}

double Laying::stretch(double b) const {
  if (over_) return over_->rates(b).outer;
  return lay_ == Lay::bored ? outer_ / root(inner_, b) : 1.0;
}

double Laying::lean(double b) const {
  if (lay_ != Lay::prism) return far_ ? 0.0 : -0.0;
  if (over_) return 0.0 - over_->lean(b);
  const double lean = elementary::asin(b / outer_);
  return far_ ? lean : -lean;
}

double Laying::square_on_bore(double way) const {
  if (over_) return over_->way_on_bore(way) / inner_;
  // On a flat both surfaces have the same way.
  return way / (lay_ == Lay::flat ? inner_ : outer_);
}

bool Laying::is_like(const Laying& other) const {
  if (lay_ != other.lay_ || far_ != other.far_ || !over_ != !other.over_) return false;
  return !over_ || over_->s_of_spec() == other.over_->s_of_spec();
}

Taken taken(const Laying& laying, const Chain& chain) {
  if (laying.over() != nullptr) return taken_over(*laying.over(), chain);
  const double outer = laying.outer(), inner = laying.inner(), wall = outer - inner;
  const double square = wall * (1.0 - 0.5 * wall / outer);  // volume of a square wall, per area
  if (laying.lay() == Lay::developed) {
    const double flat = area(chain);
    return {flat, flat * inner / outer, flat * square};
  }
  if (laying.lay() == Lay::flat) {
    const double flat = area(chain);
    return {flat, flat, flat * laying.wall()};
  }
  const double bore = around(chain, way(inner), inner);
  if (laying.lay() == Lay::bored) {
    const double outside = bore * outer / inner;
    return {outside, bore, outside * square};
  }
  return {around(chain, way(outer), outer), bore,
          around(chain, under(outer), outer) - around(chain, under(inner), inner)};
}

double removed(const Laying& laying, const Chain& chain, double at) {
  const double outer = laying.outer(), inner = laying.inner();
  double sum = 0.0;
  for (const auto& [from, to] : stretches(chain, at)) {
    if (laying.over() != nullptr)
      sum += std::abs(laying.over()->area(to) - laying.over()->area(from));
    else if (laying.lay() == Lay::flat)
      sum += (to - from) * laying.wall();
    else if (laying.lay() == Lay::prism)
      sum += under(outer).t(to) - under(outer).t(from) - under(inner).t(to) + under(inner).t(from);
    else
      sum += (laying.turn(to, outer) - laying.turn(from, outer)) * 0.5 *
             (outer * outer - inner * inner);
  }
  return sum;
}

}  // namespace tubecut::cutout
