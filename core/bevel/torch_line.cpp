#include "core/bevel/torch_line.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/bevel/polyline.hpp"
#include "core/math/mixed.hpp"

namespace tubecut::bevel {
namespace {

// No length stands here but as a share of another: tables scale exactly.
constexpr double kFlat = 5e-4;  // of kerf and a tenth of the wall, normal to the line: straight,
constexpr double kFlattest = 1.5e-5;  // and of the radius
constexpr double kHollow = 4.0;       // times that: a stretch hollow by less
constexpr double kWidest = 0.0125;    // of the radius, between places that are looked at
constexpr int kNewton = 30;           // at most: halvings, where Newton leaves the range
constexpr double kStill = 1e-6;       // of half the kerf: a step that raises what is needed by less
constexpr double kLines = 0.25;       // of half a kerf: between finished lines across the wall,
constexpr double kMostLines = 16.0;   // and no more from row to row
constexpr std::size_t kNodes = 4;     // looked at singly; more are searched by halves
constexpr int kDeepest = 12;          // halvings of the stretch between two rows

/// One circle of the finished surface, straight from row to row, and the least z of its stretches,
/// of pairs of them, of fours and so on.
struct Circle {
  double rho;
  double reach;  // rad: how far to the side the beam reaches
  double ahead;  // of the axis's own distance, there
  std::vector<double> z;
  std::vector<std::vector<double>> least;

  Circle(double radius, double half, std::vector<double> heights)
      : rho(radius),
        reach(half < radius ? elementary::asin(half / radius) : 0.5 * kPi),
        ahead(half < radius ? std::sqrt((radius - half) * (radius + half)) : 0.0),
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
/// w^2 k / (10 rho^2) where they are w apart: less than 1e-3 of the kerf, and than 1e-5 of the
/// radius.
std::vector<double> shares(double inner, double outer, double kerf) {
  const double wide = std::sqrt(std::max(1.0, 100.0 * kerf / outer));
  const double parts = 14.0 * wide * (outer - inner) / inner;
  const int n = static_cast<int>(std::clamp(std::ceil(parts), 2.0, 24.0));
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
  LeastDrop(const TableSpec& spec, const Table& t, const std::stop_token& stop)
      : stop_(stop),
        half_(0.5 * spec.kerf),
        inner_(spec.target.inner_radius()),
        flat_(std::min(kFlattest * spec.target.outer_radius,
                       kFlat * (spec.kerf + 0.1 * spec.target.wall))),
        widest_(kWidest * spec.target.outer_radius),
        phi_(t.phi) {
    const double outer = spec.target.outer_radius;
    const bool land = !t.z_face.empty();
    const double edge = land ? inner_ + spec.root_face : inner_;
    const auto& from = land ? t.z_face : t.z_inner;
    if (land) circles_.emplace_back(inner_, half_, t.z_inner);
    for (const double u : shares(inner_, outer, spec.kerf)) {
      if (stop.stop_requested()) return;  // and nothing is asked of what there is
      std::vector<double> z(from.size());
      for (std::size_t i = 0; i < z.size(); ++i) z[i] = math::mixed(from[i], t.z_outer[i], u);
      circles_.emplace_back(math::mixed(edge, outer, u), half_, std::move(z));
    }
    for (auto* column : {&slope_, &foot_}) column->reserve(phi_.size());
    for (std::size_t i = 0; i < phi_.size() && !stops(stop, i); ++i) {
      slope_.push_back((t.z_outer[i] - from[i]) / (outer - edge));
      foot_.push_back(from[i] - (edge - inner_) * slope_[i]);
      turns_.push_back(elementary::sincos(phi_[i]));
    }
    bands_.push_back(band(edge, outer, foot_, slope_));
    if (!land) return;
    std::vector<double> slope;
    for (std::size_t i = 0; i < phi_.size(); ++i)
      slope.push_back((t.z_face[i] - t.z_inner[i]) / spec.root_face);
    bands_.push_back(band(inner_, edge, t.z_inner, slope));
  }

  /// What an axis needs, and which stretch of which circle asks for it.
  struct Need {
    double drop;
    std::size_t circle = 0, stretch = 0;
  };
  /// Of row i's line; a place that asked most nearby is looked at first.
  [[nodiscard]] Need at(std::size_t i, const Need& nearby) const {
    return at(axis_at(i, 0.0), nearby);
  }
  [[nodiscard]] Need at(const Axis& axis, const Need& nearby) const {
    Need best{half_ * axis.secant, nearby.circle, nearby.stretch};  // to its own line
    search(axis, nearby.circle, 0.0, 0, nearby.stretch, best);
    for (const double turn : {0.0, -kTwoPi, kTwoPi}) {
      const auto run = within(axis.phi - turn);
      for (std::size_t circle = 0; circle < circles_.size(); ++circle)
        for (auto node = run.first; node < run.end; ++node)
          search(axis, circle, turn, run.level, node, best);
    }
    for (const auto& band : bands_) best.drop = past_lines(axis, band, best.drop);
    return best;
  }

  /// Places between row i and the next, ascending, both ends included, between which the least drop
  /// is all but straight.
  struct Place {
    double u;
    Need need;
  };
  [[nodiscard]] std::vector<Place> stretch(std::size_t i, const Need& from, const Need& to) const {
    int least = 0;
    double wide = way(i);
    for (; least < kDeepest && half_ > 0.0 && wide > std::min(half_, widest_); ++least) wide *= 0.5;
    std::vector<Place> out{{0.0, from}};
    halve(i, {0.0, from}, {1.0, to}, {least, kDeepest}, out);
    out.push_back({1.0, to});
    return out;
  }

  /// Length of the finished edges' way from row i to the next, the longer one's.
  [[nodiscard]] double way(std::size_t i) const {
    double rise = 0.0;
    for (const auto& circle : circles_)
      rise = std::max(rise, std::abs(circle.z[(i + 1) % circle.z.size()] - circle.z[i]));
    return elementary::hypot(inner_ * width(i), rise);
  }
  [[nodiscard]] double inner() const { return inner_; }
  [[nodiscard]] double width(std::size_t i) const { return phase(i + 1) - phi_[i]; }
  [[nodiscard]] double foot(std::size_t i, double u) const {
    return math::mixed(foot_[i], foot_[(i + 1) % foot_.size()], u);
  }

 private:
  [[nodiscard]] double phase(std::size_t i) const {
    return i < phi_.size() ? phi_[i] : phi_[i - phi_.size()] + kTwoPi;
  }

  [[nodiscard]] Axis axis_at(std::size_t i, double u) const {
    return mixed_line(i, u, foot_, slope_);
  }

  /// The finished lines of one part of the wall, at rows and between them.
  struct Band {
    double low, high;  // radii
    std::vector<Axis> lines;
  };
  [[nodiscard]] Band band(double low, double high, const std::vector<double>& foot,
                          const std::vector<double>& slope) const {
    Band out{low, high, {}};
    if (half_ == 0.0) return out;
    out.lines.reserve(phi_.size());
    for (std::size_t i = 0; i < phi_.size() && !stops(stop_, i); ++i) {
      const double parts = std::ceil(high * width(i) / (kLines * half_));
      const int n = static_cast<int>(std::clamp(parts, 1.0, kMostLines));
      for (int k = 0; k < n; ++k)
        out.lines.push_back(mixed_line(i, static_cast<double>(k) / n, foot, slope));
    }
    return out;
  }

  [[nodiscard]] Axis mixed_line(std::size_t i, double u, const std::vector<double>& foot,
                                const std::vector<double>& slopes) const {
    const auto j = (i + 1) % phi_.size();
    const double slope = math::mixed(slopes[i], slopes[j], u);
    const double phi = math::mixed(phi_[i], phase(i + 1), u);
    return {.phi = phi,
            .turn = u == 0.0 ? turns_[i] : elementary::sincos(phi),
            .foot = math::mixed(foot[i], foot[j], u),
            .slope = slope,
            .secant = elementary::hypot(1.0, slope)};
  }

  /// The larger of `best` and what the finished lines across the wall ask for within it. Where the
  /// axis leans more than a line, most is needed where that all but leaves the beam: the sum of a
  /// rising line and the beam's round, which has a closed form.
  [[nodiscard]] double past_lines(const Axis& axis, const Band& band, double best) const {
    const double reach = half_ < band.low ? elementary::asin(half_ / band.low) : 0.5 * kPi;
    for (const double turn : {0.0, -kTwoPi, kTwoPi}) {
      const double from = axis.phi - reach - turn, to = axis.phi + reach - turn;
      auto line = std::ranges::lower_bound(band.lines, from, {}, &Axis::phi);
      for (; line != band.lines.end() && line->phi <= to; ++line) {
        const double sin = line->turn.sin * axis.turn.cos - line->turn.cos * axis.turn.sin;
        const double cos = line->turn.cos * axis.turn.cos + line->turn.sin * axis.turn.sin;
        const double leans = axis.slope * cos - line->slope, falls = axis.secant * std::abs(sin);
        if (!(leans > 0.0 && falls > 0.0)) continue;
        const double beside = half_ * leans / elementary::hypot(leans, falls);
        const double rho = beside / std::abs(sin);
        if (!(rho > band.low && rho < band.high)) continue;
        best = std::max(best, axis.foot + (rho * cos - inner_) * axis.slope - line->foot -
                                  (rho - inner_) * line->slope + round(axis, beside));
      }
    }
    return best;
  }

  /// Few nodes of the least z, of one level, over all stretches in reach of an axis at this phase.
  struct Run {
    std::size_t level, first, end;
  };
  [[nodiscard]] Run within(double phi) const {
    const double reach = circles_.front().reach;  // the innermost circle's
    const double from = phi - reach, to = phi + reach;
    if (from > phi_.front() + kTwoPi || to < phi_.front()) return {0, 0, 0};
    const auto first = std::ranges::lower_bound(phi_, from) - phi_.begin();
    const auto end = std::ranges::upper_bound(phi_, to) - phi_.begin();
    auto low = static_cast<std::size_t>(std::max<std::ptrdiff_t>(first - 1, 0));
    auto high = static_cast<std::size_t>(end);  // > 0
    std::size_t level = 0;
    for (; high - low > kNodes; ++level) {
      low /= 2;
      high = (high + 1) / 2;
    }
    return {level, low, high};
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
  void search(const Axis& axis, std::size_t of, double turn, std::size_t level, std::size_t index,
              Need& best) const {
    const auto& circle = circles_[of];
    const auto first_row = index << level;
    const auto end_row = std::min(phi_.size(), (index + 1) << level);
    const double from = phi_[first_row] + turn - axis.phi;
    const double to = phase(end_row) + turn - axis.phi;
    if (!(from <= circle.reach && to >= -circle.reach)) return;
    double above = half_ * axis.secant;  // of the round of the beam, at most
    if (from > 0.0) above = round(axis, side(axis, circle.rho, first_row).beside);
    if (to < 0.0) above = round(axis, side(axis, circle.rho, end_row).beside);
    const double ahead = axis.slope < 0.0 ? circle.ahead : circle.rho;
    const double bound =
        axis.foot + (ahead - inner_) * axis.slope - circle.least[level][index] + above;
    if (!(bound > best.drop)) return;
    if (level == 0) {
      const double asked = of_stretch(axis, circle, index, from, to);
      if (asked > best.drop) best = {asked, of, index};
      return;
    }
    const auto first = 2 * index, second = first + 1;
    const bool nearer = from + to < 0.0;  // the second
    for (const auto half : {nearer ? second : first, nearer ? first : second})
      if (half < circle.least[level - 1].size()) search(axis, of, turn, level - 1, half, best);
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
    const double x = highest(axis, circle.rho, rate, a_in ? a.beside / half_ : -1.0,
                             b_in ? b.beside / half_ : 1.0);
    const Side at{x, std::sqrt((circle.rho - x) * (circle.rho + x))};
    return needed(at, low + rate * (elementary::asin(x / circle.rho) - from));
  }

  /// The tangent of half an angle by its sine, within a quarter turn.
  static double half_tangent(double sine) {
    const double s = std::clamp(sine, -1.0, 1.0);
    return s / (1.0 + std::sqrt((1.0 - s) * (1.0 + s)));
  }

  /// Distance to the side at which most is needed, between two sines of the angle round the beam:
  /// by Newton from the plane's own answer. Over the angle nothing is steep where the beam ends; it
  /// goes by the tangent of its half, so that no sine is asked for.
  [[nodiscard]] double highest(const Axis& axis, double rho, double rate, double first,
                               double last) const {
    const double slope = rate / rho;
    double low = half_tangent(first), high = half_tangent(last);
    double t = std::clamp(half_tangent(-slope / elementary::hypot(axis.secant, slope)), low, high);
    for (int k = 0;; ++k) {
      const double per_angle = 0.5 * (1.0 + t * t);  // of t
      const double x = half_ * t / per_angle, root = half_ * (1.0 - per_angle) / per_angle;
      const double ahead = std::sqrt((rho - x) * (rho + x));
      const double pull = (rate + x * axis.slope) / ahead;
      const double grows = -pull * root - axis.secant * x;
      const double bend = pull * x - axis.slope * root * root / ahead - axis.secant * root;
      (grows > 0.0 ? low : high) = t;
      const double newton = t - grows / bend * per_angle;
      const bool inside = bend < 0.0 && newton > low && newton < high;
      const double next = inside ? newton : 0.5 * (low + high);
      if (k == kNewton || !(std::abs(grows * (next - t)) > kStill * half_ * per_angle)) return x;
      t = next;
    }
  }

  struct Halvings {
    int least, most;
  };
  void halve(std::size_t i, Place from, Place to, Halvings left, std::vector<Place>& out) const {
    if (stop_.stop_requested()) return;
    const double u = 0.5 * (from.u + to.u);
    const auto axis = axis_at(i, u);
    const Place middle{u, at(axis, from.need)};
    const double bulge = middle.need.drop - 0.5 * (from.need.drop + to.need.drop);
    const double flat = flat_ * axis.secant;
    const bool on = left.least > 0 || bulge > flat || bulge < -kHollow * flat;
    const Halvings next{left.least - 1, left.most - 1};
    const bool deeper = on && left.most > 0 && width(i) > 0.0;
    if (deeper) halve(i, from, middle, next, out);
    out.push_back(middle);
    if (deeper) halve(i, middle, to, next, out);
  }

  const std::stop_token& stop_;
  double half_, inner_, flat_, widest_;
  const std::vector<double>& phi_;
  std::vector<double> foot_, slope_;
  std::vector<elementary::SinCos> turns_;  // of the rows' phases
  std::vector<Circle> circles_;
  std::vector<Band> bands_;
};

std::vector<LeastDrop::Need> at_rows(const LeastDrop& drop, std::size_t n,
                                     const std::stop_token& stop) {
  std::vector<LeastDrop::Need> out(n, {0.0});
  for (std::size_t i = 0; i < n && !stop.stop_requested(); ++i)
    out[i] = drop.at(i, out[i > 0 ? i - 1 : 0]);
  return out;
}

/// Phases between row i and the next at which the line of the least drop bends.
void append_bends(const LeastDrop& drop, std::size_t i, double phi, double tolerance,
                  const std::vector<LeastDrop::Place>& places, std::vector<double>& out) {
  constexpr double kNarrow = 2e-6;  // rad: no finer
  const double width = drop.width(i);
  if (width < kNarrow) return;
  Points line;
  for (const auto& [u, need] : places)
    line.emplace_back(drop.inner() * u * width, drop.foot(i, u) - need.drop);
  std::vector<std::size_t> at;
  bends(line, 0, line.size() - 1, tolerance, at);
  for (const auto k : at) {
    const double row = phi + places[k].u * width;
    out.push_back(row < kTwoPi ? row : row - kTwoPi);
  }
}

}  // namespace

TorchLine torch_line(const TableSpec& spec, const Table& table, const std::stop_token& stop) {
  const auto n = table.phi.size();
  TorchLine out{std::vector<double>(n, 0.0), {}};
  if (spec.kerf == 0.0 && table.z_face.empty()) return out;
  const LeastDrop drop(spec, table, stop);
  const auto least = at_rows(drop, n, stop);
  for (std::size_t i = 0; i < n; ++i) out.drops[i] = least[i].drop;
  for (std::size_t i = 0; i < n && !stop.stop_requested(); ++i) {
    const auto j = (i + 1) % n;
    const auto places = drop.stretch(i, least[i], least[j]);
    for (const auto& [u, need] : places) raise(out.drops[i], out.drops[j], u, need.drop);
    if (spec.sampling.tolerance)
      append_bends(drop, i, table.phi[i], spec.sampling.tolerance->value, places, out.rows);
  }
  return out;
}

}  // namespace tubecut::bevel
