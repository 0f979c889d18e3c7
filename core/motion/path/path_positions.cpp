#include "core/motion/path/path_positions.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/stop.hpp"
#include "core/motion/timing/profile.hpp"

namespace tubecut::motion {
namespace {

/// Integer units of a timing's duration, so that differences of times are exact, and equal on every
/// machine.
using Ticks = std::int64_t;
constexpr double kTicks = 0x1p61;  // in the whole duration, 4e-19 of it each

class Clock {
 public:
  explicit Clock(double whole) : per_second_(kTicks / whole), tick_(whole / kTicks) {}
  [[nodiscard]] Ticks ticks(double seconds) const {
    return static_cast<Ticks>(seconds * per_second_ + 0.5);
  }
  [[nodiscard]] double seconds(Ticks ticks) const { return static_cast<double>(ticks) * tick_; }

 private:
  double per_second_;
  double tick_;
};

/// u(t) before the filter, with u_ddot constant on every interval: knot times and, inside an
/// interval, the distance travelled and its integral.
class Unfiltered {
 public:
  Unfiltered(const std::vector<double>& x, double d, const Clock& clock)
      : clock_(clock), intervals_(x.size() - 1), times_(x.size(), 0) {
    double speed = std::sqrt(x[0]);
    for (std::size_t i = 0; i + 1 < x.size(); ++i) {
      const double next = std::sqrt(x[i + 1]);
      const double span = 2.0 * d / (speed + next), half = 0.5 * (next - speed) / span;
      intervals_[i] = {span, 0.5 * speed, half / 3.0, 0.0};
      intervals_[i].integral = integral(i, span);
      times_[i + 1] = times_[i] + clock.ticks(span);
      speed = next;
    }
  }

  [[nodiscard]] Ticks end() const { return times_.back(); }
  [[nodiscard]] std::size_t intervals() const { return intervals_.size(); }
  [[nodiscard]] double since(std::size_t knot, Ticks t) const {
    return clock_.seconds(t - times_[knot]);
  }
  /// Returns the time from one knot to a later one.
  [[nodiscard]] double between(std::size_t from, std::size_t to) const {
    return clock_.seconds(times_[to] - times_[from]);
  }
  [[nodiscard]] double span(std::size_t i) const { return intervals_[i].span; }
  /// Returns true if `t` is after interval `i` and that is not the last.
  [[nodiscard]] bool behind(std::size_t i, Ticks t) const {
    return i + 1 < intervals_.size() && times_[i + 1] <= t;
  }
  /// Integrates over time the distance travelled since knot `i`, `since` seconds after it.
  [[nodiscard]] double integral(std::size_t i, double since) const {
    return since * since * (intervals_[i].half_speed + since * intervals_[i].sixth);
  }
  [[nodiscard]] double integral(std::size_t i) const { return intervals_[i].integral; }
  [[nodiscard]] double way(std::size_t i, double since) const {
    return since * (2.0 * intervals_[i].half_speed + since * 3.0 * intervals_[i].sixth);
  }

 private:
  struct Interval {
    double span = 0.0;
    double half_speed = 0.0;  // at its start
    double sixth = 0.0;       // of the acceleration
    double integral = 0.0;
  };
  Clock clock_;
  std::vector<Interval> intervals_;
  std::vector<Ticks> times_;
};

/// The moving average at a sequence of times, relative to its window's first knot. The integral
/// between the knots in the window is split at a pivot: the sum after it grows with the window, the
/// sum before it is recomputed once, when the first knot passes the pivot.
class Averaged {
 public:
  Averaged(const Unfiltered& u, double d, double filter, Ticks filter_ticks)
      : u_(u), d_(d), filter_(filter), filter_ticks_(filter_ticks) {}

  PathPosition at(Ticks t) {
    if (filter_ticks_ == 0) {
      while (u_.behind(first_, t)) ++first_;
      return position(u_.way(first_, u_.since(first_, std::min(t, u_.end()))));
    }
    const Ticks start = std::clamp(t - filter_ticks_, Ticks{0}, u_.end());
    const Ticks stop = std::min(t, u_.end());
    advance(start, stop);
    const double since = u_.since(last_, stop);
    double sum = between() - u_.integral(first_, u_.since(first_, start));
    sum += u_.integral(last_, since) + since * d_ * static_cast<double>(last_ - first_);
    sum += u_.since(u_.intervals(), std::max(t, u_.end())) * d_ *
           static_cast<double>(u_.intervals() - first_);
    // Before the start u is 0, which is also the window's first knot: nothing to add.
    return position(sum / filter_);
  }

 private:
  void advance(Ticks start, Ticks stop) {
    for (; u_.behind(last_, stop); ++last_) {
      ahead_ += u_.integral(last_) + u_.span(last_) * d_ * static_cast<double>(last_ - pivot_);
    }
    while (u_.behind(first_, start)) ++first_;
    if (first_ > pivot_) set_pivot();
  }

  void set_pivot() {
    pivot_ = last_;
    ahead_ = 0.0;
    before_.resize(std::max(before_.size(), last_ - first_ + 1));
    before_[0] = 0.0;
    for (std::size_t i = last_; i-- > first_;) {
      const std::size_t back = last_ - i;
      before_[back] = u_.integral(i) + before_[back - 1] + d_ * u_.between(i + 1, pivot_);
    }
  }

  /// Integrates u less u at the first knot, from the first knot to the last.
  [[nodiscard]] double between() const {
    const std::size_t back = pivot_ - first_;
    return before_[back] + ahead_ + d_ * static_cast<double>(back) * u_.between(pivot_, last_);
  }

  /// Splits the distance since the first knot into interval and offset.
  [[nodiscard]] PathPosition position(double way) const {
    const auto whole = static_cast<std::int64_t>(std::max(0.0, way / d_));
    const std::size_t i = std::min(first_ + static_cast<std::size_t>(whole), u_.intervals() - 1);
    const double offset = std::clamp(way - d_ * static_cast<double>(i - first_), 0.0, d_);
    return {static_cast<std::uint32_t>(i), offset};
  }

  const Unfiltered& u_;
  double d_;
  double filter_;
  Ticks filter_ticks_;
  std::size_t first_ = 0, pivot_ = 0, last_ = 0;
  std::vector<double> before_ = {0.0};  // from each knot before the pivot up to it, by their number
  double ahead_ = 0.0;                  // from the pivot to the last knot, of u less u at the pivot
};

bool before(const PathPosition& a, const PathPosition& b) {
  return a.interval < b.interval || (a.interval == b.interval && a.offset < b.offset);
}

}  // namespace

double periods_of(double time, double period) {
  return std::max(1.0, std::ceil(time / period - 1e-6));
}

tl::unexpected<Error> too_many_periods(double periods, std::int64_t most) {
  return fail({.code = ErrorCode::too_many_periods,
               .member = "motion",
               .got = periods,
               .limit = static_cast<double>(most),
               .unit = "periods"});
}

std::vector<PathPosition> sampled(const Timing& timing, double d, std::int64_t periods) {
  const Clock clock(duration(timing.x, d) + timing.filter);
  const Unfiltered u(timing.x, d, clock);
  const Ticks filter = clock.ticks(timing.filter), total = u.end() + filter;
  Averaged average(u, d, timing.filter, filter);
  std::vector<PathPosition> positions;
  positions.reserve(static_cast<std::size_t>(periods) + 1);
  positions.push_back({0, 0.0});
  const Ticks step = total / periods, over = total % periods;
  Ticks t = 0, rest = 0;  // t + rest / periods is the period's end
  for (std::int64_t k = 1; k < periods && !stops(static_cast<std::size_t>(k)); ++k) {
    t += step;
    rest += over;
    if (rest >= periods) {
      rest -= periods;
      ++t;
    }
    const PathPosition next = average.at(t);
    positions.push_back(before(next, positions.back()) ? positions.back() : next);
  }
  positions.push_back({static_cast<std::uint32_t>(u.intervals() - 1), d});
  return positions;
}

}  // namespace tubecut::motion
