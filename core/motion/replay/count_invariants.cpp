#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "core/base/stop.hpp"
#include "core/motion/replay/invariants.hpp"
#include "core/motion/schedule/schedule.hpp"

namespace tubecut::motion {
namespace {

constexpr std::ptrdiff_t kAskEvery = 1024;  // periods
constexpr double kStrict = 1e-6;            // an integer must be below its limit, not equal to it
constexpr double kTravelSlack = 0.51;       // pulses: half of one, and rounding
constexpr double kHalf = 0.5;               // pulses: maximum error of a rounded count
constexpr double kRounding = 1e-6;          // pulses, of values far from the start

struct AxisCounts {
  const Axis& axis;
  std::span<const std::int32_t> counts;
  double period;
  double start = 0.0;
  std::int64_t before = 0;  // pulses from the start of the whole to the start of these

  /// Returns true if the loop continues with period `k`.
  [[nodiscard]] bool goes_on(std::ptrdiff_t k) const { return k % kAskEvery != 0 || !stopped(); }
  [[nodiscard]] double pulses() const { return axis.pulses_per_axis_unit(); }
  /// Returns the count of period `k`, at rest before and after.
  [[nodiscard]] double at(std::ptrdiff_t k) const {
    const bool inside = k >= 0 && k < static_cast<std::ptrdiff_t>(counts.size());
    return inside ? counts[static_cast<std::size_t>(k)] : 0.0;
  }
  [[nodiscard]] std::int64_t total() const {
    std::int64_t sum = 0;
    for (const std::int32_t n : counts) sum += n;
    return sum;
  }
};

AxisCounts counts_of(const Machine& machine, const Counted& counted, std::size_t axis) {
  return {machine.axes[axis], counted.counts[axis], counted.period, counted.start[axis],
          counted.pulses_before(axis)};
}

/// I2: checks the sum against the axis values at both ends of the program; for a part of it,
/// rounded from the start of the whole.
void check_sum(const PreparedCut& job, const AxisCounts& a, const AxisFunction& f, bool stretch,
               Worst& worst) {
  const double start = f.at(coordinates_of(job.program, 0));
  const double end = f.at(coordinates_of(job.program, job.program.size() - 1));
  const double from = stretch ? a.start : start;
  const std::int64_t expected =
      rounded(ideal_pulses(a.axis, end, from)) - rounded(ideal_pulses(a.axis, start, from));
  worst.see(std::abs(static_cast<double>(a.total() - expected)), 0.0);
}

/// I3: checks for whole revolutions of a rotary axis, and zero on all others, except those that
/// follow phi without a count per revolution.
void check_closure(const PreparedCut& job, const AxisCounts& a, const AxisFunction& f,
                   Worst& worst) {
  const bool goes_round = f.linear[0] != 0.0 && job.program.turns != 0;
  if (goes_round && a.axis.pulses_per_turn == 0) return;
  const double way = f.at(coordinates_of(job.program, job.program.size() - 1)) -
                     f.at(coordinates_of(job.program, 0));
  const std::int64_t turns = a.axis.pulses_per_turn == 0 ? 0 : rounded(way / 360.0);
  worst.see(std::abs(static_cast<double>(a.total() - turns * a.axis.pulses_per_turn)), 0.0);
}

void check_rates(const AxisCounts& a, Worst& overflow, Worst& speed, Worst& acceleration) {
  const double v = a.axis.v_max * a.period * a.pulses() + 1.0 - kStrict;
  const double second = a.axis.a_max * a.period * a.period * a.pulses() + 2.0 - kStrict;
  const auto n = static_cast<std::ptrdiff_t>(a.counts.size());
  for (std::ptrdiff_t k = 0; k < n && a.goes_on(k); ++k) {
    const double count = std::abs(a.at(k));
    if (a.axis.n_max) overflow.see(count, static_cast<double>(*a.axis.n_max));
    speed.see(count, v);
  }
  for (std::ptrdiff_t k = -1; k < n && a.goes_on(k); ++k)
    acceleration.see(std::abs(a.at(k + 1) - a.at(k)), second);
}

void check_jerk(const AxisCounts& a, Worst& worst) {
  if (!a.axis.j_max) return;
  const double limit = *a.axis.j_max * a.period * a.period * a.period * a.pulses() + 4.0 - kStrict;
  const auto n = static_cast<std::ptrdiff_t>(a.counts.size());
  for (std::ptrdiff_t k = -2; k < n && a.goes_on(k); ++k) {
    worst.see(std::abs(a.at(k + 2) - 2.0 * a.at(k + 1) + a.at(k)), limit);
  }
}

/// I8: counts the pulses beyond a soft limit.
void check_travel(const AxisCounts& a, Worst& worst) {
  std::int64_t sum = a.before;
  for (std::size_t k = 0; k <= a.counts.size(); ++k) {
    if (!a.goes_on(static_cast<std::ptrdiff_t>(k))) return;
    const double q = a.start + static_cast<double>(sum) / a.pulses();
    if (a.axis.soft_min) worst.see((*a.axis.soft_min - q) * a.pulses(), kTravelSlack);
    if (a.axis.soft_max) worst.see((q - *a.axis.soft_max) * a.pulses(), kTravelSlack);
    if (k < a.counts.size()) sum += a.counts[k];
  }
}

/// I9: checks that an axis that reverses is slow on both sides.
void check_reversals(const AxisCounts& a, Worst& worst) {
  const double limit = a.axis.a_max * a.period * a.period * a.pulses() + 2.0;
  std::int32_t before = 0;
  for (const std::int32_t n : a.counts) {
    if (n == 0) continue;
    if ((n > 0 && before < 0) || (n < 0 && before > 0)) {
      worst.see(std::max(std::abs(n), std::abs(before)), limit);
    }
    before = n;
  }
}

/// I16: compares the start with the axis value at the program's first point, in pulses, modulo
/// whole revolutions of a rotary axis. Needed because a schedule within the path's tolerance may
/// still begin away from its start.
void check_start(const PreparedCut& job, const AxisCounts& a, const AxisFunction& f, bool stretch,
                 Worst& worst) {
  double off =
      (a.start - f.at(coordinates_of(job.program, 0))) * a.pulses() + static_cast<double>(a.before);
  if (a.axis.pulses_per_turn > 0) {
    const auto turn = static_cast<double>(a.axis.pulses_per_turn);
    off -= turn * std::floor(off / turn + 0.5);
  }
  worst.see(std::abs(off), stretch ? kHalf + kRounding : kHalf);
}

void add(const Worst& worst, const char* name, std::vector<Check>& out) {
  if (worst.any()) out.push_back(worst.check(name, "pulses"));
}

}  // namespace

std::vector<Check> rate_invariants(const Machine& machine, const Counted& counted, bool jerk) {
  Worst overflow, speed, acceleration, third, travel, reversal;
  for (std::size_t i = 0; i < counted.counts.size() && !stopped(); ++i) {
    const AxisCounts a = counts_of(machine, counted, i);
    check_rates(a, overflow, speed, acceleration);
    if (jerk) check_jerk(a, third);
    check_travel(a, travel);
    check_reversals(a, reversal);
  }
  std::vector<Check> out;
  add(overflow, "I4", out);
  add(speed, "I5", out);
  add(acceleration, "I6", out);
  add(third, "I7", out);
  add(travel, "I8", out);
  add(reversal, "I9", out);
  return out;
}

std::vector<Check> place_invariants(const PreparedCut& job, const Counted& counted) {
  Worst sum, closed, begin;
  const bool stretch = !counted.before.empty();
  for (std::size_t i = 0; i < counted.counts.size() && !stopped(); ++i) {
    const AxisFunction& f = job.course.axes[i];
    const AxisCounts a = counts_of(job.course.machine, counted, i);
    check_sum(job, a, f, stretch, sum);
    if (job.program.closed) check_closure(job, a, f, closed);
    check_start(job, a, f, stretch, begin);
  }
  std::vector<Check> out;
  add(sum, "I2", out);
  add(closed, "I3", out);
  add(begin, "I16", out);
  return out;
}

}  // namespace tubecut::motion
