#include "core/bevel/torch_line.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/elementary.hpp"

namespace tubecut::bevel {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kFlat = 5e-4;   // of kerf and a tenth of the wall, normal to the line: straight
constexpr double kHollow = 4.0;  // times that: a stretch hollow by less
constexpr int kNewton = 3;       // from the plane's own answer, which is second order off
constexpr int kDeepest = 12;     // halvings of the stretch between two rows

double mixed(double a, double b, double u) { return (1.0 - u) * a + u * b; }

/// One circle of the finished surface, straight from row to row, and the least z of its stretches,
/// of pairs of them, of fours and so on.
struct Circle {
  double rho;
  double reach;  // rad: how far to the side the beam reaches
  std::vector<double> z;
  std::vector<std::vector<double>> least;

  Circle(double radius, double half, std::vector<double> heights)
      : rho(radius),
        reach(half < radius ? elementary::asin(half / radius) : 0.5 * kPi),
        z(std::move(heights)) {
    const auto n = z.size();
    least.emplace_back(n);
    for (std::size_t i = 0; i < n; ++i) least[0][i] = std::min(z[i], z[(i + 1) % n]);
    while (least.back().size() > 1) {
      const auto& below = least.back();
      std::vector<double> level((below.size() + 1) / 2);
      for (std::size_t i = 0; i < level.size(); ++i)
        level[i] = std::min(below[2 * i], below[std::min(2 * i + 1, below.size() - 1)]);
      least.push_back(std::move(level));
    }
  }
};

/// Places across the wall, its edges first. Between them what is needed bends by
/// w^2 k / (10 rho^2) where they are w apart: less than 1e-3 of the kerf.
std::vector<double> shares(double inner, double outer) {
  const double parts = 14.0 * (outer - inner) / inner;
  const int n = static_cast<int>(std::clamp(std::ceil(parts), 2.0, 8.0));
  std::vector<double> out{0.0, 1.0};
  for (int k = 1; k < n; ++k) out.push_back(static_cast<double>(k) / n);
  return out;
}

/// The axis before it is lowered: its phase and its line in that half plane.
struct Axis {
  double phi;
  elementary::SinCos turn;  // of phi
  double foot;              // on the inner wall
  double slope;
  double secant;  // 1 / cos B
};

class LeastDrop {
 public:
  LeastDrop(const TableSpec& spec, const Table& t)
      : half_(0.5 * spec.kerf),
        inner_(spec.target.inner_radius()),
        flat_(kFlat * (spec.kerf + 0.1 * spec.target.wall)),
        phi_(t.phi) {
    const double outer = spec.target.outer_radius;
    const bool land = !t.z_face.empty();
    const double edge = land ? inner_ + spec.root_face : inner_;
    const auto& from = land ? t.z_face : t.z_inner;
    if (land) circles_.emplace_back(inner_, half_, t.z_inner);
    for (const double u : shares(inner_, outer)) {
      std::vector<double> z(from.size());
      for (std::size_t i = 0; i < z.size(); ++i) z[i] = mixed(from[i], t.z_outer[i], u);
      circles_.emplace_back(mixed(edge, outer, u), half_, std::move(z));
    }
    for (std::size_t i = 0; i < phi_.size(); ++i) {
      slope_.push_back((t.z_outer[i] - from[i]) / (outer - edge));
      foot_.push_back(from[i] - (edge - inner_) * slope_[i]);
      turns_.push_back(elementary::sincos(phi_[i]));
    }
  }

  /// Of the line the share u of the way from row i to the next.
  [[nodiscard]] double at(std::size_t i, double u) const {
    const auto axis = axis_at(i, u);
    double best = half_ * axis.secant;  // to its own line
    for (const auto& circle : circles_)
      for (const double turn : {0.0, -kTwoPi, kTwoPi})
        best = search(axis, circle, turn, circle.least.size() - 1, 0, best);
    return best;
  }

  /// Places between row i and the next, ascending, both ends included, between which the least drop
  /// is all but straight.
  struct Place {
    double u, drop;
  };
  [[nodiscard]] std::vector<Place> stretch(std::size_t i, double from, double to) const {
    int least = 0;
    double wide = inner_ * width(i);
    for (; least < kDeepest && half_ > 0.0 && wide > half_; ++least) wide *= 0.5;
    std::vector<Place> out{{0.0, from}};
    halve(i, {0.0, from}, {1.0, to}, {least, kDeepest}, out);
    out.push_back({1.0, to});
    return out;
  }

  [[nodiscard]] double width(std::size_t i) const { return phase(i + 1) - phi_[i]; }
  [[nodiscard]] double foot(std::size_t i, double u) const { return axis_at(i, u).foot; }

 private:
  [[nodiscard]] double phase(std::size_t i) const {
    return i < phi_.size() ? phi_[i] : phi_[i - phi_.size()] + kTwoPi;
  }

  [[nodiscard]] Axis axis_at(std::size_t i, double u) const {
    const auto j = (i + 1) % phi_.size();
    const double slope = mixed(slope_[i], slope_[j], u);
    const double phi = mixed(phi_[i], phase(i + 1), u);
    return {.phi = phi,
            .turn = u == 0.0 ? turns_[i] : elementary::sincos(phi),
            .foot = mixed(foot_[i], foot_[j], u),
            .slope = slope,
            .secant = elementary::hypot(1.0, slope)};
  }

  /// Row i seen from the axis: its distance to the side and ahead on the circle.
  struct Side {
    double beside, ahead;
  };
  [[nodiscard]] Side side(const Axis& axis, double rho, std::size_t i) const {
    const auto& row = turns_[i % phi_.size()];
    return {rho * (row.sin * axis.turn.cos - row.cos * axis.turn.sin),
            rho * (row.cos * axis.turn.cos + row.sin * axis.turn.sin)};
  }
  /// Height of the round of the beam above its axis, along z, this far to the side.
  [[nodiscard]] double round(const Axis& axis, double beside) const {
    return axis.secant * std::sqrt(std::max(0.0, (half_ - beside) * (half_ + beside)));
  }

  /// The larger of `best` and what the run of rows `index` of this level asks for; a run whose
  /// lowest point could not ask for more is passed by.
  [[nodiscard]] double search(const Axis& axis, const Circle& circle, double turn,
                              std::size_t level, std::size_t index, double best) const {
    const auto first_row = index << level;
    const auto end_row = std::min(phi_.size(), (index + 1) << level);
    const double from = phi_[first_row] + turn - axis.phi;
    const double to = phase(end_row) + turn - axis.phi;
    if (!(from <= circle.reach && to >= -circle.reach)) return best;
    double beside = 0.0;
    if (from > 0.0) beside = side(axis, circle.rho, first_row).beside;
    if (to < 0.0) beside = side(axis, circle.rho, end_row).beside;
    const double far = axis.slope < 0.0 ? std::min(half_, circle.rho) : 0.0;
    const double ahead = std::sqrt((circle.rho - far) * (circle.rho + far));
    const double bound = axis.foot + (ahead - inner_) * axis.slope - circle.least[level][index] +
                         round(axis, beside);
    if (!(bound > best)) return best;
    if (level == 0) return std::max(best, of_stretch(axis, circle, index, from, to));
    const auto first = 2 * index, second = first + 1;
    if (second == circle.least[level - 1].size())
      return search(axis, circle, turn, level - 1, first, best);
    const bool nearer = from + to < 0.0;  // the second
    best = search(axis, circle, turn, level - 1, nearer ? second : first, best);
    return search(axis, circle, turn, level - 1, nearer ? first : second, best);
  }

  /// What the straight stretch after row i asks for; `from` and `to` are its phases from the axis.
  /// A concave function: at an end, or by Newton from where it would be largest on a plane.
  [[nodiscard]] double of_stretch(const Axis& axis, const Circle& circle, std::size_t i,
                                  double from, double to) const {
    const double low = circle.z[i], high = circle.z[(i + 1) % phi_.size()];
    const double rate = to > from ? (high - low) / (to - from) : 0.0;
    const auto needed = [&](const Side& at, double z) {
      return axis.foot + (at.ahead - inner_) * axis.slope - z + round(axis, at.beside);
    };
    const auto grows = [&](const Side& at) {
      const double root = std::sqrt((half_ - at.beside) * (half_ + at.beside));
      return -rate - at.beside * axis.slope - axis.secant * at.beside * at.ahead / root;
    };
    const auto a = side(axis, circle.rho, i), b = side(axis, circle.rho, i + 1);
    const bool a_in = from > -circle.reach, b_in = to < circle.reach;
    if (a_in && !(grows(a) > 0.0)) return needed(a, low);
    if (b_in && !(grows(b) < 0.0)) return needed(b, high);
    const double first = std::max(from, -circle.reach), last = std::min(to, circle.reach);
    const double slope = rate / circle.rho;
    const double guess = -half_ * slope / elementary::hypot(axis.secant, slope);
    double at = std::clamp(guess / circle.rho, first, last);
    Side here{};
    for (int k = 0; k <= kNewton; ++k) {
      const auto turn = elementary::sincos(at);
      here = {circle.rho * turn.sin, circle.rho * turn.cos};
      const double root = std::sqrt(std::max(0.0, (half_ - here.beside) * (half_ + here.beside)));
      if (k == kNewton || !(root > 0.0)) break;
      const double x = here.beside, y = here.ahead;
      const double bend = -y * axis.slope - axis.secant * ((y * y - x * x) / root +
                                                           x * x * y * y / (root * root * root));
      if (!(bend < 0.0)) break;
      at = std::clamp(at - grows(here) / bend, first, last);
    }
    return needed(here, low + rate * (at - from));
  }

  struct Halvings {
    int least, most;
  };
  void halve(std::size_t i, Place from, Place to, Halvings left, std::vector<Place>& out) const {
    const double u = 0.5 * (from.u + to.u);
    const Place middle{u, at(i, u)};
    const double bulge = middle.drop - 0.5 * (from.drop + to.drop);
    const double flat = flat_ * axis_at(i, u).secant;
    const bool on = left.least > 0 || bulge > flat || bulge < -kHollow * flat;
    const Halvings next{left.least - 1, left.most - 1};
    const bool deeper = on && left.most > 0 && width(i) > 0.0;
    if (deeper) halve(i, from, middle, next, out);
    out.push_back(middle);
    if (deeper) halve(i, middle, to, next, out);
  }

  double half_, inner_, flat_;
  const std::vector<double>& phi_;
  std::vector<double> foot_, slope_;
  std::vector<elementary::SinCos> turns_;  // of the rows' phases
  std::vector<Circle> circles_;
};

/// Raises the ends of a straight stretch until it is no lower than `value` at u: the lower end
/// first.
void raise(double& a, double& b, double u, double value) {
  if (!(value > mixed(a, b, u))) return;
  double& low = a < b ? a : b;
  const double high = std::max(a, b);
  const double share = a < b ? u : 1.0 - u;  // of the higher end
  const double needed = share < 1.0 ? (value - share * high) / (1.0 - share) : kInfinity;
  if (needed <= high) {
    low = needed;
  } else {
    a = b = std::max(high, value);
  }
}

using Points = std::vector<std::pair<double, double>>;

/// Indices at which the line must bend to follow the points within the tolerance.
void bends(const Points& p, std::size_t from, std::size_t to, double tolerance,
           std::vector<std::size_t>& out) {
  const double dx = p[to].first - p[from].first, dy = p[to].second - p[from].second;
  const double length = elementary::hypot(dx, dy);
  double worst = tolerance;
  std::size_t at = from;
  for (std::size_t k = from + 1; k < to; ++k) {
    const double x = p[k].first - p[from].first, y = p[k].second - p[from].second;
    const double off = length > 0.0 ? std::abs(x * dy - y * dx) / length : elementary::hypot(x, y);
    if (off <= worst) continue;
    worst = off;
    at = k;
  }
  if (at == from) return;
  bends(p, from, at, tolerance, out);
  out.push_back(at);
  bends(p, at, to, tolerance, out);
}

std::vector<double> at_rows(const LeastDrop& drop, std::size_t n, const std::stop_token& stop) {
  std::vector<double> out(n, 0.0);
  for (std::size_t i = 0; i < n && !stop.stop_requested(); ++i) out[i] = drop.at(i, 0.0);
  return out;
}

}  // namespace

std::vector<double> torch_drops(const TableSpec& spec, const Table& table,
                                const std::stop_token& stop) {
  const auto n = table.phi.size();
  if (spec.kerf == 0.0 && table.z_face.empty()) return std::vector<double>(n, 0.0);
  const LeastDrop drop(spec, table);
  const auto least = at_rows(drop, n, stop);
  auto out = least;
  for (std::size_t i = 0; i < n && !stop.stop_requested(); ++i) {
    const auto j = (i + 1) % n;
    for (const auto& place : drop.stretch(i, least[i], least[j]))
      raise(out[i], out[j], place.u, place.drop);
  }
  return out;
}

std::vector<double> torch_rows(const TableSpec& spec, const Table& table,
                               const std::stop_token& stop) {
  constexpr double kNarrow = 2e-6;  // rad: no finer
  if ((spec.kerf == 0.0 && table.z_face.empty()) || !spec.sampling.tolerance) return {};
  const auto n = table.phi.size();
  const LeastDrop drop(spec, table);
  const auto least = at_rows(drop, n, stop);
  const double radius = spec.target.inner_radius();
  std::vector<double> out;
  for (std::size_t i = 0; i < n && !stop.stop_requested(); ++i) {
    const double width = drop.width(i);
    if (width < kNarrow) continue;
    const auto places = drop.stretch(i, least[i], least[(i + 1) % n]);
    Points line;
    for (const auto& [u, d] : places) line.emplace_back(radius * u * width, drop.foot(i, u) - d);
    std::vector<std::size_t> at;
    bends(line, 0, line.size() - 1, spec.sampling.tolerance->value, at);
    for (const auto k : at) {
      const double phi = table.phi[i] + places[k].u * width;
      out.push_back(phi < kTwoPi ? phi : phi - kTwoPi);
    }
  }
  return out;
}

}  // namespace tubecut::bevel
