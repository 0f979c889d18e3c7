#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/base/angle.hpp"
#include "core/base/try.hpp"
#include "core/bevel/envelope_parts.hpp"

namespace tubecut::bevel {
namespace detail {
namespace {

constexpr std::size_t kLaps = 16;  // 4 are the most seen, on 10 000 hostile profiles

double clamped(double x, double bound) { return std::clamp(x, -bound, bound); }

void choose_start(Turn& turn, std::size_t j) {
  const auto& b = turn.b;
  const auto before = turn.previous(j);
  const double rate = turn.limits.curvature;
  const double slope_in = (b[j] - b[before]) / turn.ahead[before];
  const double slope_out = (b[turn.next(j)] - b[j]) / turn.ahead[j];
  const double low = slope_in - 0.5 * rate * turn.ahead[before];
  const double high = slope_out + 0.5 * rate * turn.ahead[j];
  turn.corner[j] = low > high;
  double m = 0.5 * (low + high);
  if (turn.corner[j]) m = std::abs(slope_in) <= std::abs(slope_out) ? low : high;
  m = clamped(m, turn.limits.slope);
  turn.leave[j] = clamped(m, turn.start_bound(j));
  turn.quiet[j] =
      !turn.corner[j] && std::max(std::abs(slope_in), std::abs(slope_out)) <= turn.limits.slope;
}

}  // namespace

double Turn::start_bound(std::size_t j) const {
  return std::min(steepest_start, std::sqrt(2.0 * limits.curvature * (highest - b[j])));
}

Turn make_turn(const AngleProfile& profile, const EnvelopeSpec& spec) {
  const std::size_t n = profile.b.size();
  Turn turn{
      .s = profile.s,
      .b = profile.b,
      .period = profile.period,
      .limits = spec.limits,
      .highest = spec.highest,
      .steepest_start = std::min(spec.limits.slope, 0.25 * spec.limits.curvature * profile.period),
      .ahead = std::vector<double>(n),
      .width = std::vector<double>(n),
      .leave = std::vector<double>(n),
      .quiet = std::vector<char>(n),
      .corner = std::vector<char>(n),
      .under = std::vector<std::size_t>(n, Turn::kNone),
      .covers = std::vector<char>(n)};
  for (std::size_t j = 0; j < n; ++j) turn.ahead[j] = turn.distance(j, turn.next(j));
  for (std::size_t j = 0; j < n; ++j) {
    turn.width[j] = 0.5 * (turn.ahead[turn.previous(j)] + turn.ahead[j]);
    choose_start(turn, j);
  }
  return turn;
}

Braking brake(Braking from, double h, const SwingLimits& limits) {
  if (from.slope < -limits.slope) return kNoCurve;
  const double slope = from.slope - limits.curvature * h;
  if (slope >= -limits.slope)
    return {from.value + h * (from.slope - 0.5 * limits.curvature * h), slope};
  const double fading = (from.slope + limits.slope) / limits.curvature;
  return {from.value + 0.5 * fading * (from.slope - limits.slope) - limits.slope * (h - fading),
          -limits.slope};
}

std::size_t step(const Turn& turn, std::size_t j, Sense sense) {
  return sense == Sense::forward ? turn.next(j) : turn.previous(j);
}

double arriving(const Turn& turn, std::size_t j, Sense sense) {
  return turn.ahead[sense == Sense::forward ? turn.previous(j) : j];
}

Braking start(const Turn& turn, std::size_t j, Sense sense) {
  if (turn.quiet[j]) return {turn.b[j], kNoCurve.slope};
  return {turn.b[j], sense == Sense::forward ? turn.leave[j] : -turn.leave[j]};
}

double node_bound(const Turn& turn, std::size_t j, Sense sense) {
  // B + m d - A d^2/2 <= highest at the distance d of every node; m's bound is convex in d, least
  // at `apex`.
  if (turn.start_bound(j) >= turn.steepest_start) return turn.steepest_start;
  const double room = turn.highest - turn.b[j];
  const double half_rate = 0.5 * turn.limits.curvature;
  const double apex = std::sqrt(room / half_rate);
  double bound = turn.steepest_start;
  double away = 0.0;
  for (auto i = j; away < apex || away == 0.0;) {
    if (away > turn.period) break;
    i = step(turn, i, sense);
    const double before = away;
    away += arriving(turn, i, sense);
    if (before > 0.0 && away >= apex) bound = std::min(bound, room / before + half_rate * before);
  }
  return std::min(bound, room / away + half_rate * away);
}

namespace {

/// Once round from j to j, the state there after it. What it passes goes to `out`, or raises it.
Braking lap(const Turn& turn, std::size_t j, Sense sense, Braking at, bool raise, Sweep& out) {
  for (std::size_t visit = 0; visit < turn.size(); ++visit) {
    j = step(turn, j, sense);
    at = brake(at, arriving(turn, j, sense), turn.limits);
    out.restarted[j] = turn.restarts(j, at.value);
    if (out.restarted[j]) at = start(turn, j, sense);
    out.value[j] = raise ? std::max(out.value[j], at.value) : at.value;
    out.slope[j] = at.slope;
  }
  return at;
}

}  // namespace

Sweep sweep(const Turn& turn, Sense sense) {
  const std::size_t n = turn.size();
  Sweep out{std::vector<double>(n), std::vector<double>(n), std::vector<char>(n)};
  const auto top = static_cast<std::size_t>(std::ranges::max_element(turn.b) - turn.b.begin());
  std::vector<Braking> seen{start(turn, top, sense)};
  while (seen.size() <= kLaps) {
    const auto at = lap(turn, top, sense, seen.back(), false, out);
    const auto again = std::ranges::find(seen, at);
    const auto period = seen.end() - again;
    if (again == seen.end()) {
      seen.push_back(at);
      continue;
    }
    out.closed = period == 1;
    // Curves as long as the turn can take turns: the laps then repeat in twos or more. Each lap of
    // the endless path is sound, so is their highest, and that closes.
    auto state = at;
    for (auto more = period; more > 1; --more) state = lap(turn, top, sense, state, true, out);
    return out;
  }
  // Never seen. The constant is sound too.
  out.value.assign(n, turn.b[top]);
  return out;
}

// Both are the upper hull of e - A s^2/2, written in differences: no s^2 to cancel, and no origin.
bool touches(const Turn& turn, const std::vector<double>& e, std::size_t i, std::size_t j,
             std::size_t k) {
  const double left = turn.distance(i, j);
  const double right = turn.distance(j, k);
  return (e[j] - e[i]) / left + 0.5 * turn.limits.curvature * (left + right) >=
         (e[k] - e[j]) / right;
}

double rolled(const Turn& turn, const std::vector<double>& e, std::size_t i, std::size_t j,
              std::size_t k) {
  const double chord = (e[k] - e[i]) / turn.distance(i, k);
  return std::max(e[j], e[i] + turn.distance(i, j) *
                                   (chord - 0.5 * turn.limits.curvature * turn.distance(j, k)));
}

namespace {

/// The contacts from the highest e (always one: the constant through it lies above e) once round to
/// it again.
std::vector<std::size_t> contacts(const Turn& turn, const std::vector<double>& e) {
  const std::size_t n = turn.size();
  const auto top = static_cast<std::size_t>(std::ranges::max_element(e) - e.begin());
  std::vector<std::size_t> hull{top};
  std::size_t k = top;
  for (std::size_t visit = 0; visit < n; ++visit) {
    k = turn.next(k);
    while (hull.size() > 1 && !touches(turn, e, hull[hull.size() - 2], hull.back(), k))
      hull.pop_back();
    hull.push_back(k);
  }
  return hull;
}

}  // namespace

Envelope make_envelope(const Turn& turn) {
  const std::size_t n = turn.size();
  Envelope out{.forward = sweep(turn, Sense::forward),
               .backward = sweep(turn, Sense::backward),
               .e = turn.b,
               .f = {},
               .contact = std::vector<char>(n),
               .contact_after = std::vector<std::size_t>(n),
               .contact_before = std::vector<std::size_t>(n)};
  for (std::size_t j = 0; j < n; ++j)
    out.e[j] = std::max(out.forward.value[j], out.backward.value[j]);
  out.f = out.e;
  const auto hull = contacts(turn, out.e);
  for (std::size_t c = 0; c + 1 < hull.size(); ++c) {
    const auto i = hull[c];
    const auto k = hull[c + 1];
    out.contact[i] = 1;
    out.contact_after[i] = k;
    out.contact_before[k] = i;
    for (auto j = turn.next(i); j != k; j = turn.next(j)) out.f[j] = rolled(turn, out.e, i, j, k);
  }
  for (std::size_t j = 0; j < n; ++j) {
    out.area += (out.f[j] - turn.b[j]) * turn.width[j];
    if (out.e[j] < turn.b[j]) out.area = std::numeric_limits<double>::infinity();
  }
  return out;
}

}  // namespace detail

namespace {

Result<void> check_limits(const AngleProfile& profile, const EnvelopeSpec& spec) {
  const auto positive = [](double x) { return std::isfinite(x) && x > 0.0; };
  if (!positive(spec.limits.slope))
    return fail({.code = ErrorCode::out_of_range,
                 .member = "limits/slope",
                 .got = spec.limits.slope * kDegPerRad,
                 .limit = 0.0,
                 .unit = "deg/mm"});
  if (!positive(spec.limits.curvature))
    return fail({.code = ErrorCode::out_of_range,
                 .member = "limits/curvature",
                 .got = spec.limits.curvature * kDegPerRad,
                 .limit = 0.0,
                 .unit = "deg/mm^2"});
  for (std::size_t j = 0; j < profile.b.size(); ++j) {
    if (!(profile.b[j] <= spec.highest))
      return fail({.code = ErrorCode::out_of_range,
                   .member = "b/" + std::to_string(j),
                   .got = profile.b[j] * kDegPerRad,
                   .limit = spec.highest * kDegPerRad,
                   .unit = "deg"});
  }
  return {};
}

}  // namespace

namespace {
/// The last bits by which a parabola may overshoot the limit it is tangent to.
std::vector<double> kept_below(std::vector<double> f, double highest) {
  for (auto& value : f) value = std::min(value, highest);
  return f;
}
}  // namespace

Result<std::vector<double>> envelope(const AngleProfile& profile, const EnvelopeSpec& spec,
                                     std::stop_token stop) {
  TRY(check_profile(profile));
  TRY(check_limits(profile, spec));
  auto turn = detail::make_turn(profile, spec);
  auto plain = detail::make_envelope(turn);
  if (!spec.refine) return kept_below(std::move(plain.f), spec.highest);
  auto best = std::pair{plain.area, plain.f};
  for (const auto start : {detail::Start::refined, detail::Start::plain}) {
    auto found = turn;
    if (!detail::refine(found, plain, start, stop)) return fail({.code = ErrorCode::cancelled});
    // Each answer is one whole evaluation of what was found, so that its guarantees rest on nothing
    // local.
    auto whole = detail::make_envelope(found);
    if (whole.area < best.first) best = {whole.area, std::move(whole.f)};
  }
  return kept_below(std::move(best.second), spec.highest);
}

}  // namespace tubecut::bevel
