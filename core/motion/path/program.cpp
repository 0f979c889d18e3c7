#include "core/motion/path/program.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/stop.hpp"
#include "core/base/try.hpp"
#include "core/motion/path/lead.hpp"
#include "core/motion/path/stretch.hpp"
#include "core/motion/path/upright.hpp"

namespace tubecut::motion {
namespace {

constexpr double kRadOfDeg = kBevelWeight * kRadPerDeg;  // weight of a coordinate in degrees

Program from_points(const std::vector<CutPoint>& points, double radius) {
  Program out;
  out.coordinates = {{radius, Coordinate::Group::tip},
                     {1.0, Coordinate::Group::tip},
                     {kBevelWeight, Coordinate::Group::bevel}};
  out.x.assign(3, {});
  for (auto* const of : {&out.x[0], &out.x[1], &out.x[2], &out.beam}) of->reserve(points.size());
  for (const CutPoint& p : points) {
    out.x[0].push_back(p.phi);
    out.x[1].push_back(p.z);
    out.x[2].push_back(p.b);
    out.corner.push_back(p.corner);
    out.beam.push_back(p.beam);
  }
  out.cut_last = points.size() - 1;
  return out;
}

/// The most that smoothing moves the tip into the outside of a section, mm. A triangle of half
/// width l moves it by l^2 / (12 r) on an arc of radius r.
constexpr double kIntoArc = 0.03;

/// The same by the curve through the points, because it may leave a straight edge over a corner.
constexpr double kOffStraight = 0.05;

/// Converts the points of a path around a section to the program of a machine that keeps the normal
/// up. Adds points on arcs, because the chord of two points of the path may cut off a corner.
Program over_section(const CutWithLead& way, const Track& whole, Angle lean) {
  const Upright up(*whole.section, lean, whole.still);
  const double radius = whole.radius;
  std::vector<CutPoint> points;
  std::size_t first = 0, last = 0;
  for (std::size_t i = 0; i < way.points.size(); ++i) {
    if (i > 0) {
      const CutPoint &a = way.points[i - 1], &b = way.points[i];
      auto places = up.places(radius * std::min(a.phi, b.phi), radius * std::max(a.phi, b.phi));
      if (b.phi < a.phi) std::ranges::reverse(places);
      for (const double s : places)
        points.push_back(between(whole.wall, a, b, (s / radius - a.phi) / (b.phi - a.phi)));
    }
    if (i == way.cut_first) first = points.size();
    if (i == way.cut_last) last = points.size();
    points.push_back(way.points[i]);
  }
  Program out = from_points(points, 0.0);
  out.coordinates[0].group = Coordinate::Group::turn;
  out.coordinates.resize(5, {1.0, Coordinate::Group::tip});
  out.x.resize(5);
  for (double& angle : out.x[0]) {
    const double s = radius * angle;
    const auto tip = up.point(s);
    angle = up.angle(s);
    out.x[3].push_back(tip.x());
    out.x[4].push_back(tip.y());
  }
  out.cut_first = first;
  out.cut_last = last;
  out.overshoot = kOffStraight;
  out.widest = std::min(out.widest, std::sqrt(12.0 * whole.section->corner * kIntoArc));
  return out;
}

/// Returns the program of points on the outside of a tube, round or a section.
Program over(const CutWithLead& way, const Track& whole, const Motion& motion) {
  if (whole.section) return over_section(way, whole, motion.lean);
  Program out = from_points(way.points, whole.radius);
  out.cut_first = way.cut_first;
  out.cut_last = way.cut_last;
  return out;
}

/// Returns the contour in its direction; for a sector, only that part of it.
Result<Track> stretch(Track whole, const Motion& motion) {
  if (motion.sector) {
    TRY(const auto in_direction, directed(std::move(whole), motion.direction, {}));
    return sector_of(in_direction, *motion.sector);
  }
  return directed(std::move(whole), motion.direction, motion.start);
}

/// Returns the program of points that were placed along a checked path.
Program of_way(const CutWithLead& way, const Track& whole, const Motion& motion) {
  Program out = over(way, whole, motion);
  out.closed = !motion.lead && !way.stretch && whole.closed;
  out.turns = out.closed ? whole.turns : 0;
  return out;
}

/// Checks that the tolerance is small against a closed path: else the tip might leave out a part of
/// it, or go round it twice, and nobody could tell.
Result<void> check_tolerance(const Track& whole, double eps_tip) {
  constexpr double kMostShare = 0.1;
  const double most = whole.closed ? kMostShare * lengths_along(whole).back() : eps_tip;
  if (eps_tip <= most) return {};
  return fail({.code = ErrorCode::out_of_range,
               .member = "motion/eps_tip",
               .got = eps_tip,
               .limit = most,
               .unit = "mm",
               .hint = "at most a tenth of the length of the shortest closed cut"});
}

Result<Program> of_cut_path(const CutPath& cut_path, const ScheduleSpec& spec) {
  TRY(auto whole, track(cut_path));
  TRY(check_tolerance(whole, spec.motion.eps_tip));
  if (stopped()) return fail({.code = ErrorCode::cancelled});
  if (spec.way) return of_way(*spec.way, whole, spec.motion);
  TRY(const auto cut, stretch(std::move(whole), spec.motion));
  if (stopped()) return fail({.code = ErrorCode::cancelled});
  if (!spec.motion.lead) {
    Program out = over({cut.points, 0, cut.points.size() - 1}, cut, spec.motion);
    out.closed = cut.closed;
    out.turns = cut.turns;
    return out;
  }
  TRY(const auto border, part_border(cut_path, spec.machine.sigma()));
  TRY(const auto way, clear_lead(border, cut, *spec.motion.lead, spec.motion.eps_tip));
  return over(way, cut, spec.motion);
}

Coordinate coordinate_of(const Axis& axis, const AxisColumns& columns, bool turns_tip) {
  if (turns_tip) return {columns.tip_radius * kRadPerDeg, Coordinate::Group::tip};
  if (axis.unit == AxisUnit::deg) return {kRadOfDeg, Coordinate::Group::bevel};
  return {1.0, Coordinate::Group::tip};
}

/// Returns true for a mill path without lengths, because its speed is the tip's.
bool follows_tip(const AxisColumns& cut, const Machine& machine) {
  return std::holds_alternative<ConeMill>(machine.kinematics) && cut.length.empty();
}

Result<void> check_sizes(const AxisColumns& cut, const Machine& machine) {
  const auto wrong = [](const std::string& member) {
    return fail({.code = ErrorCode::wrong_count, .member = member});
  };
  if (cut.columns.size() != machine.axes.size()) return wrong("axes");
  const std::size_t n = cut.columns.front().size();
  if (n < 3) return wrong("axes/" + machine.axes.front().name);
  for (std::size_t a = 0; a < cut.columns.size(); ++a) {
    if (cut.columns[a].size() != n) return wrong("axes/" + machine.axes[a].name);
  }
  if (!cut.corner.empty() && cut.corner.size() != n) return wrong("axes/corner");
  const bool mill = follows_tip(cut, machine);
  if (!mill && cut.length.size() != n) return wrong("axes/s");
  if (mill && !(cut.tip_radius > 0.0 && cut.tip_radius < 1e6)) {
    return fail({.code = ErrorCode::bad_number, .member = "axes/tip_radius"});
  }
  return {};
}

Result<void> check_motion_of_columns(const Motion& motion) {
  if (motion.lead || motion.sector || motion.start.at != Start::At::first_point) {
    return fail({ErrorCode::unsupported_combination,
                 "motion",
                 {},
                 {},
                 {},
                 "lead, sector and start need a contour"});
  }
  if (std::holds_alternative<SpeedTable>(motion.speed)) {
    return fail({ErrorCode::unsupported_combination,
                 "motion/speed",
                 {},
                 {},
                 {},
                 "a speed table needs a contour"});
  }
  return {};
}

Result<void> check_values(const Program& p, const Machine& machine) {
  for (std::size_t c = 0; c < p.x.size(); ++c) {
    for (std::size_t i = 0; i < p.size(); ++i) {
      if (!(std::abs(p.x[c][i]) <= 1e6)) {
        const std::string column = c < machine.axes.size() ? machine.axes[c].name : "s";
        return fail(
            {.code = ErrorCode::bad_number, .member = "axes/" + column + "/" + std::to_string(i)});
      }
    }
  }
  for (std::size_t i = 1; i < p.size(); ++i) {
    if (p.step(i - 1, i) == 0.0) {
      return fail(
          {.code = ErrorCode::duplicate_point, .member = "axes", .got = static_cast<double>(i)});
    }
  }
  return {};
}

/// Checks that a closed column path ends where it began, rotary axes modulo whole revolutions.
Result<void> check_closed(const AxisColumns& cut, const Machine& machine) {
  for (std::size_t a = 0; a < cut.columns.size(); ++a) {
    const double gap = cut.columns[a].back() - cut.columns[a].front();
    const bool rotary = machine.axes[a].pulses_per_turn > 0;
    const double open = rotary ? gap - 360.0 * std::floor(gap / 360.0 + 0.5) : gap;
    if (!(std::abs(open) <= 1e-6)) {
      return fail({ErrorCode::not_closed,
                   "axes/" + machine.axes[a].name,
                   open,
                   1e-6,
                   std::string(name_of(machine.axes[a].unit)),
                   {}});
    }
  }
  return {};
}

Result<Program> of_columns(const AxisColumns& cut, const ScheduleSpec& spec) {
  const Machine& machine = spec.machine;
  TRY(check_sizes(cut, machine));
  TRY(check_motion_of_columns(spec.motion));
  const bool mill = follows_tip(cut, machine);
  Program out;
  for (std::size_t a = 0; a < cut.columns.size(); ++a) {
    const bool turns_tip = mill && machine.axes[a].name == "C";
    out.coordinates.push_back(coordinate_of(machine.axes[a], cut, turns_tip));
    out.x.push_back(cut.columns[a]);
  }
  if (!mill) {
    out.coordinates.push_back({1.0, Coordinate::Group::tip});
    out.x.push_back(cut.length);
  }
  out.corner = cut.corner.empty() ? std::vector<bool>(out.size(), false) : cut.corner;
  out.cut_last = out.size() - 1;
  out.closed = cut.closed;
  TRY(check_values(out, machine));
  if (cut.closed) TRY(check_closed(cut, machine));
  return out;
}

}  // namespace

double Program::step(std::size_t from, std::size_t to) const {
  double square = 0.0;
  for (std::size_t c = 0; c < x.size(); ++c) {
    const double d = coordinates[c].weight * (x[c][to] - x[c][from]);
    square += d * d;
  }
  return std::sqrt(square);
}

std::vector<double> Program::lengths() const {
  std::vector<double> s(size(), 0.0);
  for (std::size_t i = 1; i < s.size(); ++i) s[i] = s[i - 1] + step(i - 1, i);
  return s;
}

Result<Program> program(const ScheduleSpec& spec) {
  if (const auto* const cut_path = std::get_if<CutPath>(&spec.cut)) {
    return of_cut_path(*cut_path, spec);
  }
  return of_columns(std::get<AxisColumns>(spec.cut), spec);
}

}  // namespace tubecut::motion
