#include "core/bevel/beam/torch_line.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/bevel/beam/drop_lanes.hpp"
#include "core/bevel/smoothing/polyline.hpp"
#include "core/math/mixed.hpp"

namespace tubecut::bevel {
namespace {

// Every length here is a fraction of another, so tables scale exactly.
constexpr double kFlat = 5e-4;  // of kerf and a tenth of the wall, normal to the line: straight,
constexpr double kFlattest = 1.5e-5;  // and of the radius
constexpr double kHollow = 4.0;       // times that: a smaller hollow counts as straight
constexpr double kWidest = 0.0125;    // of the radius, maximum distance of sampled points
constexpr double kLines = 0.25;       // of half a kerf: between finished lines across the wall,
constexpr double kMostLines = 16.0;   // and at most this many from row to row
constexpr int kDeepest = 12;          // halvings of the interval between two rows
constexpr int kMostRounds = 12;       // of a search,
constexpr double kStill =
    1e-5;  // of half the kerf: error of the requirement at which the search ends
constexpr std::size_t kRows = 64;  // whose points are computed together

/// Returns fractions between an edge and the middle of the wall. Between two at distance w, the
/// requirement bends by w^2 k / (10 rho^2): less than 1e-3 of the kerf, and than 1e-5 of the
/// radius.
std::vector<double> shares_between(double inner, double outer, double kerf) {
  const double wide = std::sqrt(std::max(1.0, 100.0 * kerf / outer));
  const double parts = 7.0 * wide * (outer - inner) / inner;
  const int n = static_cast<int>(std::clamp(std::ceil(parts), 1.0, 12.0));
  std::vector<double> out;
  for (int k = 1; k < 2 * n; ++k)
    if (k != n) out.push_back(static_cast<double>(k) / (2 * n));
  return out;
}

/// Returns the number of iterations of the search for the maximum: `lean` is the largest sine of an
/// axis's lean. 0 if it would not converge.
int rounds_of(double half, double rho, double lean) {
  const double share = half / rho;
  if (!(share < 1.0)) return 0;
  const double ahead = std::sqrt((1.0 - share) * (1.0 + share));
  // Each iteration reduces the error by this factor; that of the requirement, by its square.
  const double nearer = lean * share / ahead + 0.385 * share * share / (ahead * ahead * ahead);
  double left = 0.5 * nearer * nearer;
  for (int k = 1; k <= kMostRounds; ++k) {
    left *= nearer * nearer;
    if (left < kStill) return k;
  }
  return 0;
}

/// Returns the halvings of an angle until a series is accurate for its sine.
int halvings_of(double limit, double rho) {
  double cosine = std::sqrt(std::max(0.0, (rho - limit) * (rho + limit))) / rho;
  int times = 0;
  for (double sine = limit / rho; sine > drop::kSeries; ++times) {
    const double twice = 2.0 * (1.0 + cosine);
    sine /= std::sqrt(twice);
    cosine = 0.5 * std::sqrt(twice);
  }
  return times;
}

/// A point between rows: the fraction u from one to the next, and the drop that an axis there
/// requires.
struct DropSample {
  std::size_t row;
  double u;
  double drop = 0.0;
};

/// Rows, straight from one to the next, the last joined to the first.
struct Columns {
  const std::vector<double>& phi;
  std::vector<double> foot, slope;  // of the line across the wall, on the inner one

  [[nodiscard]] std::size_t next(std::size_t i) const { return i + 1 < phi.size() ? i + 1 : 0; }
  [[nodiscard]] double phase(std::size_t i) const {
    return i < phi.size() ? phi[i] : phi[i - phi.size()] + kTwoPi;
  }
  [[nodiscard]] double width(std::size_t i) const { return phase(i + 1) - phi[i]; }
};

class LeastDrop {
 public:
  LeastDrop(const TableSpec& spec, const Table& t)
      : kerf_(spec.kerf),
        flat_(std::min(kFlattest * spec.target.outer_radius,
                       kFlat * (spec.kerf + 0.1 * spec.target.wall))),
        widest_(kWidest * spec.target.outer_radius),
        lines_{.phi = t.phi, .foot = {}, .slope = {}},
        finished_{.half = 0.5 * spec.kerf, .inner = spec.target.inner_radius()} {
    const double inner = finished_.inner, outer = spec.target.outer_radius;
    const bool land = !t.z_face.empty();
    const double edge = land ? inner + spec.root_face : inner;
    const auto& from = land ? t.z_face : t.z_inner;
    const auto n = t.phi.size();
    finished_.phi = t.phi;
    finished_.sine.resize(n);
    finished_.cosine.resize(n);
    elementary::sincos(t.phi, finished_.sine, finished_.cosine);
    set_lines(lines_, from, t.z_outer, outer - edge, edge - inner);
    for (const double slope : lines_.slope) lean_ = std::max(lean_, std::abs(slope));
    lean_ /= elementary::hypot(1.0, lean_);
    if (land) finished_.circles.push_back(circle(inner, t.z_inner));
    const auto across = [&](double u) {
      std::vector<double> z(n);
      for (std::size_t i = 0; i < n; ++i) z[i] = math::mixed(from[i], t.z_outer[i], u);
      return circle(math::mixed(edge, outer, u), std::move(z));
    };
    for (const double u : {0.0, 1.0, 0.5}) finished_.circles.push_back(across(u));
    for (const double u : shares_between(inner, outer, spec.kerf)) {
      if (stopped()) return;  // because the result is not read
      finished_.between.push_back(across(u));
    }
    set_swing(edge, outer);
    if (finished_.half == 0.0) return;
    add_band(edge, outer, lines_);
    if (!land) return;
    Columns on_land{.phi = t.phi, .foot = {}, .slope = {}};
    set_lines(on_land, t.z_inner, t.z_face, spec.root_face, 0.0);
    add_band(inner, edge, on_land);
  }

  /// For the rows from `first` to before `end`, returns points between which the smallest drop is
  /// nearly straight, ascending, each row's own first; then only row `end`.
  [[nodiscard]] std::vector<DropSample> places(std::size_t first, std::size_t end) const {
    std::vector<DropSample> out;
    for (auto i = first; i < end; ++i) {
      const auto parts = std::size_t{1} << least_halvings(i);
      for (std::size_t k = 0; k < parts; ++k)
        out.push_back({i, static_cast<double>(k) / static_cast<double>(parts)});
    }
    out.push_back({end, 0.0});
    const auto secants = set_drops(out);
    auto gaps = bulging(out, secants);
    const auto before = [](const DropSample& a, const DropSample& b) {
      return a.row != b.row ? a.row < b.row : a.u < b.u;
    };
    std::vector<DropSample> both;
    while (!gaps.empty() && !stopped()) {
      std::vector<DropSample> middles;
      gaps = halved(gaps, middles);
      both.resize(out.size() + middles.size());
      std::ranges::merge(out, middles, both.begin(), before);
      out.swap(both);
    }
    return out;
  }

  /// Returns the position along the inner wall, and the height of the finished line there.
  [[nodiscard]] Points::value_type on_line(const DropSample& at) const {
    const double foot = math::mixed(lines_.foot[at.row], lines_.foot[lines_.next(at.row)], at.u);
    return {finished_.inner * at.u * width(at.row), foot - at.drop};
  }
  [[nodiscard]] double width(std::size_t i) const { return lines_.width(i); }

 private:
  /// A part of the path from a row to the next that must be halved.
  struct Gap {
    std::size_t row;
    double from, to;
    double drop_from, drop_to;
    int halvings;
  };

  static void set_lines(Columns& out, const std::vector<double>& from,
                        const std::vector<double>& to, double across, double beyond) {
    const auto n = from.size();
    out.foot.resize(n);
    out.slope.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      out.slope[i] = (to[i] - from[i]) / across;
      out.foot[i] = from[i] - beyond * out.slope[i];
    }
  }

  /// If a line's lean differs by `a` from that of the axis's own lines, its requirement is largest
  /// across the wall, and exceeds those at two points at distance w by at most a w^2 / (4 rho).
  void set_swing(double low, double high) {
    const double wide = 0.5 * (high - low), reach = finished_.circles.front().reach;
    const auto n = lines_.phi.size();
    const auto turns = [&](std::size_t i) {  // derivative of the slope by the phase
      const double rise = lines_.slope[lines_.next(i)] - lines_.slope[i];
      return rise == 0.0 ? 0.0 : rise / lines_.width(i);
    };
    finished_.swing.resize(n);
    double before = turns(n - 1);
    for (std::size_t i = 0; i < n; ++i) {
      const double after = turns(i);
      finished_.swing[i] = std::abs(after - before) * reach * wide * wide / (4.0 * low);
      before = after;
    }
  }

  [[nodiscard]] drop::Circle circle(double rho, std::vector<double> z) const {
    const double half = finished_.half, limit = std::min(half, rho);
    drop::Circle out{.rho = rho,
                     .reach = half < rho ? elementary::asin(half / rho) : 0.5 * kPi,
                     .limit = limit,
                     .rounds = rounds_of(half, rho, lean_),
                     .halvings = halvings_of(limit, rho),
                     .z = std::move(z),
                     .rate = std::vector<double>(lines_.phi.size())};
    for (std::size_t i = 0; i < out.rate.size(); ++i) {
      const double width = lines_.width(i);
      out.rate[i] = width > 0.0 ? (out.z[lines_.next(i)] - out.z[i]) / width : 0.0;
    }
    return out;
  }

  void add_band(double low, double high, const Columns& lines) {
    drop::Lines out{
        .low = low, .high = high, .phi = {}, .sine = {}, .cosine = {}, .foot = {}, .slope = {}};
    const double apart = kLines * finished_.half;
    for (auto* column : {&out.phi, &out.foot, &out.slope}) column->reserve(4 * lines.phi.size());
    for (std::size_t i = 0; i < lines.phi.size() && !stops(i); ++i) {
      const double width = lines.width(i), parts = std::ceil(high * width / apart);
      const auto j = lines.next(i);
      const int n = static_cast<int>(std::clamp(parts, 1.0, kMostLines));
      for (int k = 0; k < n; ++k) {
        const double u = static_cast<double>(k) / n;
        out.phi.push_back(math::mixed(lines.phi[i], lines.phase(i + 1), u));
        out.foot.push_back(math::mixed(lines.foot[i], lines.foot[j], u));
        out.slope.push_back(math::mixed(lines.slope[i], lines.slope[j], u));
      }
    }
    out.sine.resize(out.phi.size());
    out.cosine.resize(out.phi.size());
    elementary::sincos(out.phi, out.sine, out.cosine);
    finished_.bands.push_back(std::move(out));
  }

  /// Returns the length of the finished edges from row i to the next, of the longer one.
  [[nodiscard]] double way(std::size_t i) const {
    double rise = 0.0;
    for (const auto& circle : finished_.circles)
      rise = std::max(rise, std::abs(circle.z[lines_.next(i)] - circle.z[i]));
    return elementary::hypot(finished_.inner * width(i), rise);
  }

  /// Returns at least 1.
  [[nodiscard]] int least_halvings(std::size_t i) const {
    if (!(width(i) > 0.0 && kerf_ > 0.0)) return 1;
    int out = 1;
    for (double wide = 0.5 * way(i); out < kDeepest && wide > std::min(0.5 * kerf_, widest_); ++out)
      wide *= 0.5;
    return out;
  }

  /// Sets the drop that each point requires. Returns the secants of their axes.
  std::vector<double> set_drops(std::vector<DropSample>& at) const {
    const auto n = at.size();
    drop::Axes axes;
    axes.resize(n);
    for (std::size_t k = 0; k < n; ++k) {
      const auto i = at[k].row < lines_.phi.size() ? at[k].row : 0, j = lines_.next(i);
      const double u = at[k].u, slope = math::mixed(lines_.slope[i], lines_.slope[j], u);
      axes.row[k] = i;
      axes.phi[k] = math::mixed(lines_.phi[i], lines_.phase(i + 1), u);
      axes.foot[k] = math::mixed(lines_.foot[i], lines_.foot[j], u);
      axes.slope[k] = slope;
      axes.secant[k] = elementary::hypot(1.0, slope);
    }
    elementary::sincos(axes.phi, axes.sine, axes.cosine);
    std::vector<double> drops(n);
    drop::least(finished_, axes, drops);
    for (std::size_t k = 0; k < n; ++k) at[k].drop = drops[k];
    return std::move(axes.secant);
  }

  /// Returns true if the drop leaves the straight line: above it is a gouge, below it metal stays.
  [[nodiscard]] bool bends(double from, double middle, double to, double secant) const {
    const double bulge = middle - 0.5 * (from + to), flat = flat_ * secant;
    return bulge > flat || bulge < -kHollow * flat;
  }

  /// Returns both halves of the parts that bend at their middle; the points alternate between ends
  /// and middles.
  [[nodiscard]] std::vector<Gap> bulging(const std::vector<DropSample>& at,
                                         const std::vector<double>& secants) const {
    std::vector<Gap> out;
    for (std::size_t k = 1; k + 1 < at.size(); k += 2) {
      const auto &a = at[k - 1], &b = at[k], &c = at[k + 1];
      if (!(width(b.row) > 0.0) || !bends(a.drop, b.drop, c.drop, secants[k])) continue;
      const double to = c.row == b.row ? c.u : 1.0;
      const int halvings = kDeepest - least_halvings(b.row);
      if (halvings == 0) continue;
      out.push_back({b.row, a.u, b.u, a.drop, b.drop, halvings - 1});
      out.push_back({b.row, b.u, to, b.drop, c.drop, halvings - 1});
    }
    return out;
  }

  /// Appends the middles of gaps, in their order; returns both halves of those that bend there.
  std::vector<Gap> halved(const std::vector<Gap>& gaps, std::vector<DropSample>& middles) const {
    for (const auto& gap : gaps) middles.push_back({gap.row, 0.5 * (gap.from + gap.to)});
    const auto secants = set_drops(middles);
    std::vector<Gap> out;
    for (std::size_t k = 0; k < gaps.size(); ++k) {
      const auto& [row, from, to, drop_from, drop_to, halvings] = gaps[k];
      const auto& middle = middles[k];
      if (halvings == 0 || !bends(drop_from, middle.drop, drop_to, secants[k])) continue;
      out.push_back({row, from, middle.u, drop_from, middle.drop, halvings - 1});
      out.push_back({row, middle.u, to, middle.drop, drop_to, halvings - 1});
    }
    return out;
  }

  double kerf_, flat_, widest_;
  double lean_ = 0.0;  // the largest sine of B
  Columns lines_;
  drop::Finished finished_;
};

/// Appends the phases between two rows at which the smallest drop bends.
void append_bends(const LeastDrop& drop, double phi, double tolerance,
                  std::span<const DropSample> places, std::vector<double>& out) {
  constexpr double kNarrow = 2e-6;  // rad: minimum
  const auto row = places.front().row;
  const double width = drop.width(row);
  if (width < kNarrow) return;
  // The distance of a point to a line is at most that along z.
  const auto off = [&](const DropSample& at) {
    const double u = at.row == row ? at.u : 1.0;
    return std::abs(at.drop - math::mixed(places.front().drop, places.back().drop, u));
  };
  if (std::ranges::all_of(places, [&](const auto& at) { return off(at) <= tolerance; })) return;
  Points line;
  for (const auto& at : places)
    line.push_back(drop.on_line(at.row == row ? at : DropSample{row, 1.0, at.drop}));
  std::vector<std::size_t> at;
  bends(line, 0, line.size() - 1, tolerance, at);
  for (const auto k : at) {
    const double there = phi + places[k].u * width;
    out.push_back(there < kTwoPi ? there : there - kTwoPi);
  }
}

}  // namespace

TorchLine torch_line(const TableSpec& spec, const Table& table) {
  return torch_line(spec, table, std::vector<bool>(table.phi.size(), true));
}

TorchLine torch_line(const TableSpec& spec, const Table& table, const std::vector<bool>& wanted) {
  const auto n = table.phi.size();
  TorchLine out{std::vector<double>(n, 0.0), {}};
  if (spec.kerf == 0.0 && table.z_face.empty()) return out;
  const LeastDrop drop(spec, table);
  std::size_t known = 0;  // rows before this one have their drops
  for (std::size_t first = 0, end = 0; first < n && !stopped(); first = end) {
    for (end = first; end < n && end - first < kRows && wanted[end] == wanted[first];) ++end;
    if (!wanted[first]) continue;
    const auto places = drop.places(first, end);
    for (const auto& at : places)  // the first row of a run may be the last of the one before
      if (at.u == 0.0 && at.row < n && at.row >= known) out.drops[at.row] = at.drop;
    known = end + 1;
    for (std::size_t from = 0, to = 1; to < places.size(); ++to) {
      if (places[to].u != 0.0) continue;
      const std::span way(&places[from], to + 1 - from);
      const auto i = places[from].row, j = (i + 1) % n;
      for (const auto& at : way)
        raise(out.drops[i], out.drops[j], at.row == i ? at.u : 1.0, at.drop);
      if (spec.sampling.tolerance)
        append_bends(drop, table.phi[i], spec.sampling.tolerance->value, way, out.rows);
      from = to;
    }
  }
  return out;
}

std::vector<bool> ways_near(const TableSpec& spec, const Table& table,
                            std::span<const double> phases) {
  const auto n = table.phi.size();
  std::vector<bool> out(n, false);
  const double half = 0.5 * spec.kerf, inner = spec.target.inner_radius();
  const double reach = half < inner ? elementary::asin(half / inner) : 0.5 * kPi;
  const auto mark = [&](double from, double to) {  // rad, ascending
    auto i = std::ranges::upper_bound(table.phi, from) - table.phi.begin();
    for (i = std::max<std::ptrdiff_t>(i - 1, 0); i < std::ssize(table.phi); ++i) {
      if (table.phi[static_cast<std::size_t>(i)] > to) return;
      out[static_cast<std::size_t>(i)] = true;
    }
  };
  for (const double phi : phases)
    for (const double turn : {0.0, -kTwoPi, kTwoPi}) mark(phi - reach + turn, phi + reach + turn);
  return out;
}

}  // namespace tubecut::bevel
