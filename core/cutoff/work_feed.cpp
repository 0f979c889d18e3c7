#include "core/cutoff/work_feed.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/base/try.hpp"
#include "core/cutoff/preconditions.hpp"

namespace tubecut::cutoff {
namespace {

constexpr std::size_t kGridPoints = 1601;
constexpr double kShortest = 1e-3;  // mm of work feed
// Maximum ratio of the largest to the smallest cylinder speed of a work feed. Beyond it the window
// approaches an end of the linkage, and a grid no longer finds the extremes; machines stay below 3.
constexpr double kMostUneven = 100.0;

Result<void> check(const FeedWindow& window) {
  Preconditions on("cut/");
  on.require(true, "start_feed", window.start_feed, {}, "mm");
  on.require(window.end_feed - window.start_feed >= kShortest, "end_feed", window.end_feed,
             "at least 0.001 above start_feed_mm", "mm");
  return on.met();
}

Result<void> check(const CutDistances& d) {
  Preconditions on("cut/");
  on.not_negative("clearance", d.clearance, "mm");
  on.not_negative("slowdown", d.slowdown, "mm");
  on.positive("wall", d.wall, "mm");
  on.not_negative("overcut", d.overcut, "mm");
  TRY(on.met());
  if (d.slowdown > d.clearance)
    return fail({.code = ErrorCode::s2_gt_s1,
                 .member = "cut/slowdown",
                 .got = d.slowdown,
                 .limit = d.clearance,
                 .unit = "mm"});
  return {};
}

FeedWindow window_of(const Cut& cut) {
  if (const auto* window = std::get_if<FeedWindow>(&cut.range)) return *window;
  const auto& d = std::get<CutDistances>(cut.range);
  return {d.clearance - d.slowdown, d.clearance + d.wall + d.overcut};
}

/// Returns the largest magnitude of `f` over time; `sampled` holds magnitudes on the grid.
template <class F>
double largest_magnitude(const F& f, const std::vector<double>& grid,
                         const std::vector<double>& sampled) {
  return math::grid_maximum([&f](double t) { return std::abs(f(t)); }, grid, sampled).value;
}

}  // namespace

Result<WorkFeed> WorkFeed::make(const Mechanism& mechanism, const Cut& cut) {
  TRY(std::visit([](const auto& range) { return check(range); }, cut.range));
  Preconditions on("cut/");
  on.positive("feed", cut.feed, "mm_s");
  TRY(on.met());
  const FeedWindow window = window_of(cut);
  const bool by_ends = std::holds_alternative<FeedWindow>(cut.range);
  const auto& geometry = mechanism.geometry();
  const auto unreachable = [&](const char* member, double feed) {
    const auto limit = feed > 0.0 ? geometry.feed_high : geometry.feed_low;
    return fail({.code = ErrorCode::unreachable_x,
                 .member = member,
                 .got = feed,
                 .limit = limit ? Shown{*limit} : Shown{},
                 .unit = "mm"});
  };
  if (!mechanism.reaches(window.start_feed))
    return unreachable(by_ends ? "cut/start_feed" : "cut/clearance", window.start_feed);
  if (!mechanism.reaches(window.end_feed))
    return unreachable(by_ends ? "cut/end_feed" : "cut/wall", window.end_feed);
  WorkFeed out(mechanism);
  out.work_.start_feed = window.start_feed;
  out.work_.end_feed = window.end_feed;
  out.work_.feed = cut.feed;
  out.work_.duration = (window.end_feed - window.start_feed) / cut.feed;
  if (!(out.work_.duration > 0.0) || !std::isfinite(out.work_.duration))
    return fail(
        {.code = ErrorCode::out_of_range, .member = "cut/feed", .got = cut.feed, .unit = "mm_s"});
  out.find_extremes();
  const double uneven = out.work_.max_cylinder_speed / out.work_.min_cylinder_speed;
  if (!(uneven <= kMostUneven))
    return fail({.code = ErrorCode::dead_point,
                 .member = by_ends ? "cut/end_feed" : "cut/overcut",
                 .got = uneven,
                 .limit = kMostUneven,
                 .hint = "largest to smallest cylinder speed of the work feed: it comes too near "
                         "the linkage's end"});
  return out;
}

double WorkFeed::feed_at(double time) const {
  return time >= work_.duration ? work_.end_feed : work_.start_feed + work_.feed * time;
}

CylinderState WorkFeed::state(double feed, const Inverse& g) const {
  const double v = work_.feed;
  return {feed, g.stroke, v * g.first, v * v * g.second, v * v * v * g.third};
}

CylinderState WorkFeed::at(double time) const {
  const double feed = feed_at(time);
  return state(feed, mechanism_.inverse(feed));
}

CylinderState WorkFeed::at(double time, StrokeCursor& cursor) const {
  const double feed = feed_at(time);
  return state(feed, cursor.at(feed));
}

void WorkFeed::find_extremes() {
  work_.start_stroke = mechanism_.inverse(work_.start_feed).stroke;
  work_.end_stroke = mechanism_.inverse(work_.end_feed).stroke;
  // The curve owns a copy of this mechanism and window, so it stays a value.
  speed_.at = [mechanism = mechanism_, w = work_](double time) {
    const double feed = time >= w.duration ? w.end_feed : w.start_feed + w.feed * time;
    return w.feed * mechanism.inverse(feed).first;
  };
  speed_.grid = math::chebyshev_grid(kGridPoints, 0.0, work_.duration);
  const auto& grid = speed_.grid;
  std::vector<double> negated(grid.size()), acceleration(grid.size()), jerk(grid.size());
  speed_.values.resize(grid.size());
  StrokeCursor cursor(mechanism_);
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const CylinderState here = at(grid[i], cursor);
    speed_.values[i] = here.speed;
    negated[i] = -here.speed;
    acceleration[i] = std::abs(here.acceleration);
    jerk[i] = std::abs(here.jerk);
  }
  const auto top =
      static_cast<std::size_t>(std::ranges::max_element(speed_.values) - speed_.values.begin());
  const auto acceleration_at = [this](double t) { return at(t).acceleration; };
  work_.max_cylinder_speed = speed_.values[top];
  if (top > 0 && top + 1 < grid.size()) {
    work_.time_at_peak = math::sign_change(acceleration_at, grid[top - 1], grid[top + 1]);
    work_.max_cylinder_speed = at(*work_.time_at_peak).speed;
  }
  work_.min_cylinder_speed =
      -math::grid_maximum([this](double t) { return -at(t).speed; }, grid, negated).value;
  work_.max_cylinder_acceleration = largest_magnitude(acceleration_at, grid, acceleration);
  work_.max_cylinder_jerk = largest_magnitude([this](double t) { return at(t).jerk; }, grid, jerk);
}

}  // namespace tubecut::cutoff
