#include "core/base/elementary.hpp"
#include "core/motion/path/path.hpp"

namespace tubecut::motion {
namespace {

double behind(const std::vector<double>& p, std::size_t j) {
  return j == 0 ? 2.0 * p[0] - p[1] : p[j - 1];
}
double ahead(const std::vector<double>& p, std::size_t j) {
  return j + 1 == p.size() ? 2.0 * p[j] - p[j - 1] : p[j + 1];
}

/// Position, slope, curvature and third derivative of one coordinate at a knot, for the interval
/// after it.
struct Cubic {
  double x, first, second, third;
};
Cubic derivatives(const std::vector<double>& p, std::size_t i, double d) {
  const double a = behind(p, i), b = p[i], c = p[i + 1], e = ahead(p, i + 1);
  return {at_knot(p, i), (c - a) / (2.0 * d), (c - 2.0 * b + a) / (d * d),
          (e - 3.0 * c + 3.0 * b - a) / (d * d * d)};
}

}  // namespace

double at_knot(const std::vector<double>& p, std::size_t j) {
  if (j == 0 || j + 1 == p.size()) return p[j];
  return (p[j - 1] + 4.0 * p[j] + p[j + 1]) / 6.0;
}

std::array<double, 4> cubic(const std::vector<double>& p, std::size_t i, double d) {
  const auto [x, first, second, third] = derivatives(p, i, d);
  return {x, first, 0.5 * second, third / 6.0};
}

std::array<double, 4> Path::cubic(std::size_t c, std::size_t i) const {
  return motion::cubic(control[c], i, d);
}

Coordinates Path::at(std::size_t i, double offset) const {
  return PathCursor(*this, false).at(i, offset).x;
}

Pose PathCursor::at(std::size_t i, double w) {
  const std::size_t n = path_.control.size();
  if (i != interval_) {
    for (std::size_t c = 0; c < n; ++c) cubic_[c] = path_.cubic(c, i);
    interval_ = i;
  }
  const bool end = i + 1 == path_.intervals() && w >= path_.d;
  Pose out;
  for (std::size_t c = 0; c < n; ++c) {
    const auto& q = cubic_[c];
    out.x[c] = end ? path_.control[c].back() : q[0] + w * (q[1] + w * (q[2] + w * q[3]));
  }
  if (bends_) {
    const auto [sin, cos] = elementary::sincos(out.x[2]);
    out.sin_b = sin;
    out.cos_b = cos;
  }
  if (bends_ && path_.turns()) {
    const auto up = elementary::sincos(out.x[0]);
    out.sin_up = up.sin;
    out.cos_up = up.cos;
  }
  return out;
}

Jet Path::jet(std::size_t i, double w, bool bends) const {
  Jet out;
  for (std::size_t c = 0; c < control.size(); ++c) {
    const Cubic q = derivatives(control[c], i, d);
    out.value[c] = q.x + w * (q.first + w * (0.5 * q.second + w * (q.third / 6.0)));
    out.first[c] = q.first + w * (q.second + w * 0.5 * q.third);
    out.second[c] = q.second + w * q.third;
    out.third[c] = q.third;
  }
  if (bends) {
    const auto [sin, cos] = elementary::sincos(out.value[2]);
    out.sin_b = sin;
    out.cos_b = cos;
  }
  if (bends && turns()) {
    const auto up = elementary::sincos(out.value[0]);
    out.sin_up = up.sin;
    out.cos_up = up.cos;
  }
  return out;
}

}  // namespace tubecut::motion
