#include "core/cutoff/feed_curve.hpp"

#include <cmath>
#include <iterator>

#include "core/base/try.hpp"
#include "core/cutoff/preconditions.hpp"

namespace tubecut::cutoff {
namespace {

void push(Table& table, double time, const CylinderState& state) {
  table.time.push_back(time);
  table.feed.push_back(state.feed);
  table.stroke.push_back(state.stroke);
  table.speed.push_back(state.speed);
  table.acceleration.push_back(state.acceleration);
}

Result<Table> tabulate(const WorkFeed& work, const TablePoints& spec) {
  if (spec.points < 2 || spec.points > kMostTablePoints)
    return fail({.code = ErrorCode::out_of_range,
                 .member = "table/points",
                 .got = static_cast<double>(spec.points),
                 .limit = Intervals{{2.0, kMostTablePoints}}});
  Table out;
  for (int i = 0; i < spec.points; ++i) {
    const double time = work.work().duration * i / (spec.points - 1);
    push(out, time, work.at(time));
  }
  return out;
}

Result<Table> tabulate(const WorkFeed& work, const TableStep& spec) {
  Preconditions on("table/");
  on.positive("step", spec.step, "mm");
  TRY(on.met());
  const auto& w = work.work();
  const double range = w.end_feed - w.start_feed;
  const double steps = std::ceil(
      range / spec.step * (1.0 - 1e-12));  // if the step divides the range, the last row is its end
  if (steps + 1.0 > kMostTableRows)
    return fail({.code = ErrorCode::out_of_range,
                 .member = "table/step",
                 .got = spec.step,
                 .limit = range / (kMostTableRows - 1.0),
                 .unit = "mm"});
  Table out;
  for (int i = 0; i < static_cast<int>(steps); ++i) {
    const double time = spec.step * i / w.feed;
    push(out, time, work.at(time));
  }
  push(out, w.duration, work.at(w.duration));
  return out;
}

std::vector<Warning> warnings_of(const FeedCurveSpec& spec, const Work& work) {
  std::vector<Warning> out{
      {WarningCode::polynomial_window, "fit", "valid from the start of the work feed to its end"}};
  if (!work.time_at_peak)
    out.push_back({WarningCode::monotone_work_range, "cut", "the cylinder speed is monotone"});
  if (!spec.tube) return out;
  if (work.end_feed - work.start_feed < spec.tube->wall)
    out.push_back({WarningCode::not_cut_through, "cut",
                   "the work feed is " + shown(work.end_feed - work.start_feed) +
                       " mm long, the wall " + shown(spec.tube->wall) + " mm thick"});
  auto notes = tube_warnings(spec.linkage, *spec.tube);
  out.insert(out.end(), std::make_move_iterator(notes.begin()),
             std::make_move_iterator(notes.end()));
  return out;
}

/// Checks that both walls are equal, because the request may specify the wall twice: of the cut and
/// of the tube.
Result<void> check_one_wall(const FeedCurveSpec& spec) {
  const auto* cut = std::get_if<CutDistances>(&spec.cut.range);
  if (!spec.tube || cut == nullptr || cut->wall == spec.tube->wall) return {};
  return fail({.code = ErrorCode::unsupported_combination,
               .member = "tube/wall",
               .got = spec.tube->wall,
               .limit = cut->wall,
               .unit = "mm",
               .hint = "the cut is through another wall than this tube's"});
}

Warning missed(const Cycle& cycle, double target) {
  const auto& needs = cycle.target->feed;
  return {WarningCode::target_missed, "cycle/target",
          brief(cycle.pieces_per_hour) + " an hour of the " + brief(target) + " asked for; " +
              (needs ? "a feed of " + brief(*needs) + " mm/s makes them"
                     : "no feed within the limits makes them")};
}

}  // namespace

Result<FeedCurve> feed_curve(const FeedCurveSpec& spec) {
  TRY(const auto mechanism, Mechanism::make(spec.linkage));
  if (spec.tube) TRY(check_tube(*spec.tube));
  TRY(const auto work, WorkFeed::make(mechanism, spec.cut));
  FeedCurve out{.geometry = mechanism.geometry(), .work = work.work()};
  TRY(out.table, std::visit([&](const auto& by) { return tabulate(work, by); }, spec.table));
  TRY(out.fit, command(work, spec.fit));
  out.warnings = warnings_of(spec, out.work);
  if (spec.comparison) {
    TRY(out.comparison, comparison(work, *spec.comparison));
  }
  if (spec.cycle) {
    TRY(out.cycle, cycle(work, *spec.cycle));
    if (out.cycle->target && !out.cycle->target->met)
      out.warnings.push_back(missed(*out.cycle, *spec.cycle->target));
  }
  if (spec.tool) {
    TRY(out.tool, tool_outputs(*spec.tool, spec.tube, out.work.feed, out.fit.errors.tool_ripple));
  }
  TRY(check_one_wall(spec));
  return out;
}

}  // namespace tubecut::cutoff
