#include "core/bevel/ring_newton.hpp"

namespace tubecut::bevel {
namespace {

constexpr double kPinned = 1e100;  // weight of the end of the ring: it is where it begins

/// The cost to go from a node: 1/2 weight (f + lever v + ahead . end)^2 + 1/2 rest (v + back .
/// end)^2, and what depends on the end alone. f, v: height there and the slope into it.
template <class Real>
struct ToGo {
  Real weight = kPinned, lever = 0.0, rest = kPinned;
  Real ahead[2] = {-1.0, 0.0};
  Real back[2] = {0.0, -1.0};
  Squares<Real> of_end;

  void add_slope(Real w) {
    const Real sum = rest + w;
    const Real share = rest / sum;
    of_end.add(share * w, back[0], back[1]);
    for (Real& b : back) b *= share;
    rest = sum;
  }

  void add_height(Real w) {
    const Real sum = weight + w;
    const Real share = weight / sum;
    const Real left = share * w;  // weight of (lever v + ahead . end)^2
    const Real by_lever = left * lever;
    const Real more = rest + by_lever * lever;
    if (more > 0.0) {
      const Real inverse = 1.0 / more;
      of_end.add(left * rest * inverse, lever * back[0] - ahead[0], lever * back[1] - ahead[1]);
      for (int k = 0; k < 2; ++k) back[k] = (rest * back[k] + by_lever * ahead[k]) * inverse;
    } else {
      of_end.add(left, ahead[0], ahead[1]);
    }
    rest = more;
    lever *= share;
    for (Real& a : ahead) a *= share;
    weight = sum;
  }
};

}  // namespace

template <class Real>
void Squares<Real>::add(Real q, Real of_x, Real of_y) {
  const Real more = q * of_x * of_x;
  const Real sum = weight + more;
  if (!(sum > 0.0)) {
    rest += q * of_y * of_y;
    return;
  }
  const Real off = of_y - of_x * share, inverse = 1.0 / sum;
  rest += q * weight * inverse * off * off;
  share = (weight * share + q * of_x * of_y) * inverse;
  weight = sum;
}

template <class Real>
RingNewton<Real>::RingNewton(const Array& h)
    : h_(h),
      gain_(h.size()),
      from_f_(h.size()),
      from_v_(h.size()),
      from_end_f_(h.size()),
      from_end_v_(h.size()),
      kick_(h.size()) {}

template <class Real>
void RingNewton<Real>::factor(const Array& height, const Array& slope, const Array& bend) {
  ToGo<Real> v;
  for (auto j = h_.size(); j-- > 0;) {
    v.lever += h_[j];
    v.add_slope(slope[j]);
    // The slope after node j is chosen: 1/2 bend (v - v before)^2 beside the cost to go.
    const Real both = v.rest + bend[j];
    const Real pull = v.weight * v.lever;
    const Real gain = 1.0 / (both + pull * v.lever);
    gain_[j] = gain;
    from_f_[j] = pull * gain;
    from_v_[j] = bend[j] * gain;
    from_end_f_[j] = gain * (v.rest * v.back[0] + pull * v.ahead[0]);
    from_end_v_[j] = gain * (v.rest * v.back[1] + pull * v.ahead[1]);
    const Real share = bend[j] / both;
    const Real lost = v.lever * v.rest / both;
    v.weight *= both * gain;
    for (int k = 0; k < 2; ++k) v.ahead[k] -= lost * v.back[k];
    v.lever *= share;
    v.rest *= share;
    v.add_height(height[j]);
  }
  v.of_end.add(v.weight, 1.0 + v.ahead[0], v.lever + v.ahead[1]);
  v.of_end.add(v.rest, v.back[0], 1.0 + v.back[1]);
  end_ = v.of_end;
}

template <class Real>
void RingNewton<Real>::solve(const Array& of_f, const Array& of_v, const Array& of_u, Array& f,
                             Array& v) {
  Real p = 0.0, q = 0.0;          // linear in height and slope
  Real end_f = 0.0, end_v = 0.0;  // and in the end's
  for (auto j = h_.size(); j-- > 0;) {
    q += h_[j] * p + of_v[j] + of_u[j];
    kick_[j] = gain_[j] * q;
    end_f -= q * from_end_f_[j];
    end_v -= q * from_end_v_[j];
    p += of_f[j] - from_f_[j] * q;
    q = from_v_[j] * q - of_u[j];
  }
  end_f += p;
  end_v += q;
  const Real last_v = -(end_v - end_.share * end_f) / end_.rest;
  const Real last_f = -end_f / end_.weight - end_.share * last_v;
  Real height = last_f, slope = last_v;
  for (Eigen::Index j = 0; j < h_.size(); ++j) {
    slope = from_v_[j] * slope - from_f_[j] * height - from_end_f_[j] * last_f -
            from_end_v_[j] * last_v - kick_[j];
    f[j] = static_cast<double>(height);
    v[j] = static_cast<double>(slope);
    height += h_[j] * slope;
  }
}

template class RingNewton<double>;
template class RingNewton<long double>;

}  // namespace tubecut::bevel
