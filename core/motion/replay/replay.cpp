#include "core/motion/replay/replay.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.hpp"
#include "core/base/stop.hpp"
#include "core/base/try.hpp"
#include "core/motion/path/course.hpp"
#include "core/motion/replay/invariants.hpp"

namespace tubecut::motion {
namespace {

constexpr double kMostCount = 2147483647.0;
constexpr std::size_t kCheckEvery = 1024;  // numbers

Received integers(const std::vector<std::vector<double>>& counts) {
  Received out;
  for (const auto& column : counts) {
    std::vector<std::int32_t> whole;
    whole.reserve(column.size());
    for (const double n : column) {
      if (whole.size() % kCheckEvery == 0 && stopped()) return out;
      const double nearest = std::floor(n + 0.5);
      worsen(out.worst, std::abs(n - nearest));
      whole.push_back(static_cast<std::int32_t>(nearest));
    }
    out.counts.push_back(std::move(whole));
  }
  return out;
}

Result<std::size_t> periods_of(const Machine& machine, double period,
                               const std::vector<std::vector<double>>& counts,
                               const std::vector<double>& start) {
  const std::size_t axes = machine.axes.size();
  const auto wrong = [](const std::string& member, std::size_t got, std::size_t wanted,
                        const char* of) {
    return fail({.code = ErrorCode::wrong_count,
                 .member = member,
                 .got = static_cast<double>(got),
                 .limit = static_cast<double>(wanted),
                 .hint = "as many as " + std::string(of) + ": " + std::to_string(wanted)});
  };
  const auto bad = [](const std::string& member) {
    return fail({.code = ErrorCode::bad_number, .member = member});
  };
  constexpr auto kAxes = "the machine has axes";
  if (counts.size() != axes) return wrong("schedule/counts", counts.size(), axes, kAxes);
  if (start.size() != axes) return wrong("schedule/start", start.size(), axes, kAxes);
  if (!(period > 0.0 && period <= 1.0)) return bad("schedule/period");
  std::size_t periods = 0;
  for (std::size_t a = 0; a < axes; ++a) {
    const auto& column = counts[a];
    const std::string at = "schedule/counts/" + machine.axes[a].name;
    if (!column.empty() && periods != 0 && column.size() != periods)
      return wrong(at, column.size(), periods, "the other axes have periods");
    if (!column.empty()) periods = column.size();
    if (!std::isfinite(start[a])) return bad("schedule/start");
    for (const double n : column) {
      if (!(std::abs(n) < kMostCount)) return bad(at);
    }
  }
  if (periods == 0) return wrong("schedule/counts", 0, 1, "there are periods, at least");
  return periods;
}

std::vector<Check> examine(const ScheduleSpec& spec, const PreparedCut& job, const Counted& counted,
                           double fraction, bool own, double* deviation) {
  std::vector<Check> out{{"I1", fraction, 0.0, "pulses"}};
  // In the order of their numbers except the start, which comes after the rates.
  std::vector<Check> places = place_invariants(job, counted);
  if (places.empty()) return out;  // cancelled
  const Check begin = places.back();
  places.pop_back();
  const std::vector<Check> rates = rate_invariants(spec.machine, counted, spec.motion.jerk);
  out.insert(out.end(), places.begin(), places.end());
  out.insert(out.end(), rates.begin(), rates.end());
  out.push_back(begin);
  const Followed followed = path_invariants(spec, job, counted, own);
  out.insert(out.end(), followed.checks.begin(), followed.checks.end());
  if (deviation != nullptr) *deviation = followed.deviation;
  return out;
}

}  // namespace

void rebuild(const ScheduleSpec& spec, const Counted& counted, Replay& out) {
  if (!std::holds_alternative<CutPath>(spec.cut)) return;
  const Reconstruction torch(spec);
  AxisValues values(counted, spec.machine);
  for (auto* column : {&out.phi, &out.z, &out.b})
    column->reserve(counted.periods + 1);  // because growth of a million would move at once
  for (std::size_t k = 0; k <= counted.periods; ++k) {
    if (k % kCheckEvery == 0 && stopped()) return;
    if (k > 0) values.step(k - 1);
    const Coordinates x = torch.at(values.now());
    out.phi.push_back(x[0]);
    out.z.push_back(x[1]);
    out.b.push_back(x[2]);
    if (!torch.knows(4)) continue;  // of a section
    out.x.push_back(x[3]);
    out.y.push_back(x[4]);
  }
}

Counted Received::counted() const {
  Counted out{period, periods, {}, start, {}};
  for (const auto& column : counts) out.counts.emplace_back(column);
  return out;
}

Result<Received> received(const Machine& machine, double period,
                          const std::vector<std::vector<double>>& counts,
                          std::vector<double> start) {
  TRY(const auto periods, periods_of(machine, period, counts, start));
  Received out = integers(counts);
  out.period = period;
  out.periods = periods;
  out.start = std::move(start);
  if (stopped()) return fail({.code = ErrorCode::cancelled});
  return out;
}

Result<Replay> replay(const ReplaySpec& spec) {
  TRY(const auto job, prepare_cut(spec.job));
  TRY(const auto whole, received(spec.job.machine, spec.period, spec.counts, spec.start));
  const Counted counted = whole.counted();
  Replay out;
  rebuild(spec.job, counted, out);
  if (stopped()) return fail({.code = ErrorCode::cancelled});
  out.invariants = examine(spec.job, job, counted, whole.worst, false, &out.deviation);
  if (stopped()) return fail({.code = ErrorCode::cancelled});
  return out;
}

std::vector<Check> verify(const ScheduleSpec& spec, const Schedule& schedule) {
  const auto job = prepare_cut(spec);
  const bool fits = job && schedule.axes.size() == spec.machine.axes.size() &&
                    schedule.period == spec.machine.period && schedule.periods > 0;
  Counted counted{schedule.period, static_cast<std::size_t>(schedule.periods), {}, {}};
  bool sized = true;
  for (const AxisPulses& axis : schedule.axes) {
    sized = sized && (axis.idle() || axis.counts.size() == counted.periods);
    counted.counts.emplace_back(axis.counts);
    counted.start.push_back(axis.start);
  }
  if (!fits || !sized) return {{"replayable", 1.0, 0.0, ""}};
  return examine(spec, *job, counted, 0.0, true, nullptr);
}

}  // namespace tubecut::motion
