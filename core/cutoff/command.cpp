#include "core/cutoff/command.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <functional>

#include "core/base/stop.hpp"
#include "core/base/try.hpp"
#include "core/cutoff/fits.hpp"

namespace tubecut::cutoff {
namespace {

using math::ChebyshevSeries;

constexpr int kMostDigits = 17;          // 17 significant digits restore every double
constexpr double kRoundingShare = 1.01;  // rounding may raise the speed error by 1 %

/// Returns the extent of `f`; `sampled` holds its values on the grid.
template <class F>
Extent extent_of(const F& f, const std::vector<double>& grid, const std::vector<double>& sampled) {
  std::vector<double> negated(sampled.size());
  std::ranges::transform(sampled, negated.begin(), std::negate<>());
  const auto minus = [&f](double t) { return -f(t); };
  return {-math::grid_maximum(minus, grid, negated).value,
          math::grid_maximum(f, grid, sampled).value};
}

/// The state of a command at one time.
class Drive {
 public:
  Drive(const WorkFeed& work, const ChebyshevSeries& series)
      : work_(work), series_(series), integral_(math::antiderivative(series)) {}

  [[nodiscard]] double speed(double t) const { return math::value(series_, t); }
  [[nodiscard]] double stroke(double t) const {
    return work_.work().start_stroke + math::value(integral_, t);
  }
  [[nodiscard]] double speed_error(double t) const {
    return speed_error(t, work_.cylinder_speed(t));
  }
  [[nodiscard]] double speed_error(double t, double exact) const {
    return (speed(t) - exact) / exact;
  }
  [[nodiscard]] double ripple(double t) const { return ripple(t, tool(stroke(t))); }
  [[nodiscard]] double ripple(double t, const Forward& tool) const {
    return speed(t) * tool.rate / work_.work().feed - 1.0;
  }
  [[nodiscard]] double place_error(double t) const { return place_error(t, tool(stroke(t))); }
  [[nodiscard]] double place_error(double t, const Forward& tool) const {
    const auto& w = work_.work();
    return tool.feed - (w.start_feed + w.feed * t);
  }
  [[nodiscard]] Forward tool(double stroke) const { return work_.mechanism().forward(stroke); }

 private:
  const WorkFeed& work_;
  const ChebyshevSeries& series_;
  ChebyshevSeries integral_;
};

/// Errors  tan_pole: the command drives the cylinder beyond the linkage's range.
Result<void> check_range(const WorkFeed& work, const Drive& drive,
                         const std::vector<double>& strokes) {
  const auto& grid = work.speed().grid;
  const Extent range = extent_of([&](double t) { return drive.stroke(t); }, grid, strokes);
  for (const double end : {range.low, range.high})
    if (auto inside = work.mechanism().tool_feed(end); !inside)
      return fail({.code = ErrorCode::tan_pole, .member = "fit", .got = end, .unit = "mm"});
  return {};
}

/// Errors  those of `check_range`.
Result<CommandErrors> assess(const WorkFeed& work, const ChebyshevSeries& series) {
  const auto& w = work.work();
  const auto& [at, grid, exact] = work.speed();
  const Drive drive(work, series);
  const std::size_t n = grid.size();
  std::vector<double> stroke(n), speed(n), ripple(n), place(n);
  for (std::size_t i = 0; i < n; ++i) stroke[i] = drive.stroke(grid[i]);
  TRY(check_range(work, drive, stroke));
  for (std::size_t i = 0; i < n; ++i) {
    const Forward tool = drive.tool(stroke[i]);
    speed[i] = drive.speed_error(grid[i], exact[i]);
    ripple[i] = drive.ripple(grid[i], tool);
    place[i] = drive.place_error(grid[i], tool);
  }
  CommandErrors out;
  out.speed = extent_of([&](double t) { return drive.speed_error(t); }, grid, speed);
  out.tool_speed = extent_of([&](double t) { return drive.ripple(t); }, grid, ripple);
  out.tool_position = extent_of([&](double t) { return drive.place_error(t); }, grid, place);
  out.max_relative_error = out.speed.largest();
  out.tool_ripple = out.tool_speed.largest();
  out.tool_position_error = out.tool_position.largest();
  const double end = drive.stroke(w.duration);
  out.end_drift = drive.tool(end).feed - w.end_feed;
  out.cylinder_end_drift = end - w.end_stroke;
  return out;
}

double rounded(double value, int digits) {
  char text[40];
  const auto end =
      std::to_chars(text, text + sizeof text, value, std::chars_format::scientific, digits - 1).ptr;
  double out = 0.0;
  std::from_chars(text, end, out);
  return out;
}

double speed_error(const WorkFeed& work, const std::vector<double>& seconds) {
  const auto& curve = work.speed();
  const auto error = [&](double t) {
    const double exact = curve.at(t);
    return std::abs(math::horner(seconds, t) - exact) / exact;
  };
  std::vector<double> sampled(curve.grid.size());
  for (std::size_t i = 0; i < sampled.size(); ++i)
    sampled[i] = std::abs(math::horner(seconds, curve.grid[i]) - curve.values[i]) / curve.values[i];
  return math::grid_maximum(error, curve.grid, sampled).value;
}

void round_coefficients(const WorkFeed& work, Command& out) {
  const double allowed = kRoundingShare * out.errors.max_relative_error;
  for (out.digits = 1; out.digits <= kMostDigits; ++out.digits) {
    out.seconds_rounded.clear();
    for (const double c : out.seconds) out.seconds_rounded.push_back(rounded(c, out.digits));
    out.rounded_max_relative_error = speed_error(work, out.seconds_rounded);
    if (out.rounded_max_relative_error <= allowed) return;
  }
  out.digits = kMostDigits;  // if the error is at the rounding floor, keep the coefficients exactly
}

Result<ChebyshevSeries> fit(const WorkFeed& work, FitMethod method, int degree,
                            const std::optional<std::array<double, 3>>& nodes) {
  switch (method) {
    case FitMethod::three_point:
      return three_point(work, nodes);
    case FitMethod::equispaced:
      return equispaced(work, degree);
    case FitMethod::least_squares:
      return least_squares(work, degree);
    case FitMethod::minimax:
    case FitMethod::automatic:
      break;
  }
  return minimax(work, degree);
}

Result<ChebyshevSeries> shifted_fit(const WorkFeed& work, const FitSpec& spec, FitMethod method,
                                    int degree) {
  auto series = fit(work, method, degree, spec.nodes);
  if (!series || !spec.preserve_stroke) return series;
  const auto& w = work.work();
  const double integral = math::value(math::antiderivative(*series), w.duration);
  series->coefficients[0] += (w.end_stroke - w.start_stroke - integral) / w.duration;
  return series;
}

Command describe(const WorkFeed& work, FitMethod method, const ChebyshevSeries& series,
                 const CommandErrors& errors) {
  Command out;
  out.method = method;
  out.degree = static_cast<int>(series.coefficients.size()) - 1;
  out.duration = work.work().duration;
  out.chebyshev = series.coefficients;
  out.scaled = math::scaled_powers(series);
  out.seconds = math::powers(series);
  out.errors = errors;
  round_coefficients(work, out);
  return out;
}

Result<Command> automatic(const WorkFeed& work, const FitSpec& spec) {
  for (int degree = 1; degree <= kHighestDegree; ++degree) {
    TRY(const auto series, shifted_fit(work, spec, FitMethod::minimax, degree));
    const auto errors = assess(work, series);
    if (errors && errors->max_relative_error <= spec.tolerance)
      return describe(work, FitMethod::minimax, series, *errors);
  }
  return fail(
      {.code = ErrorCode::tolerance_not_met, .member = "fit/tolerance", .got = spec.tolerance});
}

Result<void> check(const FitSpec& spec) {
  const auto wrong = [](ErrorCode code, const char* member, double got, Shown limit) {
    return fail({.code = code, .member = member, .got = got, .limit = std::move(limit)});
  };
  const double degree = spec.degree;
  if (spec.method == FitMethod::equispaced)
    return fail({.code = ErrorCode::bad_choice, .member = "fit/method"});
  if (spec.method == FitMethod::automatic &&
      !(spec.tolerance > 0.0 && std::isfinite(spec.tolerance)))
    return wrong(ErrorCode::out_of_range, "fit/tolerance", spec.tolerance, "> 0");
  if (spec.method != FitMethod::automatic && (spec.degree < 1 || spec.degree > kHighestDegree))
    return wrong(ErrorCode::out_of_range, "fit/degree", degree, Intervals{{1.0, kHighestDegree}});
  if (spec.method == FitMethod::three_point && spec.degree != 2)
    return wrong(ErrorCode::unsupported_combination, "fit/degree", degree, 2.0);
  if (spec.method != FitMethod::three_point && spec.nodes)
    return fail({.code = ErrorCode::unsupported_combination, .member = "fit/nodes"});
  return {};
}

}  // namespace

Result<Command> command(const WorkFeed& work, const FitSpec& spec) {
  TRY(check(spec));
  if (spec.method == FitMethod::automatic) return automatic(work, spec);
  TRY(const auto series, shifted_fit(work, spec, spec.method, spec.degree));
  TRY(const auto errors, assess(work, series));
  return describe(work, spec.method, series, errors);
}

Result<std::vector<Command>> comparison(const WorkFeed& work, const ComparisonSpec& spec) {
  if (spec.first_degree < 1 || spec.last_degree > kHighestDegree ||
      spec.first_degree > spec.last_degree)
    return fail({.code = ErrorCode::out_of_range,
                 .member = "comparison",
                 .limit = Intervals{{1.0, kHighestDegree}}});
  constexpr FitMethod kMethods[] = {FitMethod::three_point, FitMethod::equispaced,
                                    FitMethod::least_squares, FitMethod::minimax};
  std::vector<Command> rows;
  for (int degree = spec.first_degree; degree <= spec.last_degree; ++degree)
    for (const FitMethod method : kMethods) {
      if (method == FitMethod::three_point && degree != 2) continue;
      if (stopped()) return fail({.code = ErrorCode::cancelled});
      TRY(const auto series, fit(work, method, degree, std::nullopt));
      if (const auto errors = assess(work, series))
        rows.push_back(describe(work, method, series, *errors));
    }
  return rows;
}

}  // namespace tubecut::cutoff
