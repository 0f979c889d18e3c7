#pragma once

// Computes the cylinder motion that gives a rotary cut-off machine a constant tool feed.
//
// Idea: the linkage has a closed inverse, so strokes, speeds and accelerations are exact. A
// polynomial of time approximates the cylinder speed for a controller, with its error.
//
// Example: a measured pair determines the linkage's arm angle per stroke.
//     cutoff::FeedCurveSpec spec;
//     spec.linkage = {323, 268, 56, Angle::rad(1.17), Angle::rad(1.82)};
//     spec.linkage.calibrate = cutoff::MeasuredPair{.feed = 50, .stroke = 273.2};
//     spec.cut = {cutoff::FeedWindow{16.588, 98.027}, 0.87};
//     const auto curve = cutoff::feed_curve(spec).value();
//     const double error = curve.fit.errors.max_relative_error;  // 0.0021

#include <optional>
#include <variant>
#include <vector>

#include "core/base/error.hpp"
#include "core/cutoff/command.hpp"
#include "core/cutoff/cycle.hpp"
#include "core/cutoff/linkage.hpp"
#include "core/cutoff/tool.hpp"
#include "core/cutoff/work_feed.hpp"

namespace tubecut::cutoff {

/// Equally spaced rows over the work feed, ends included.
struct TablePoints {
  int points = 400;  // 2..20 000
};
/// Rows at every `step` mm of feed and at the end.
struct TableStep {
  double step = 0.1;  // mm, > 0; at most 100 000 rows
};
using TableSpec = std::variant<TablePoints, TableStep>;

/// The exact work feed in rows, times from its start.
struct Table {
  std::vector<double> time;          // s
  std::vector<double> feed;          // mm
  std::vector<double> stroke;        // mm
  std::vector<double> speed;         // cylinder, mm/s
  std::vector<double> acceleration;  // cylinder, mm/s^2
};

struct FeedCurveSpec {
  Linkage linkage = {};
  Cut cut = {};
  FitSpec fit = {};
  TableSpec table = {};
  std::optional<CycleSpec> cycle = {};
  std::optional<ToolSpec> tool = {};
  std::optional<TubeSpec> tube = {};
  std::optional<ComparisonSpec> comparison = {};
};

/// `cycle`, `tool` and `comparison` are present if requested.
struct FeedCurve {
  Geometry geometry = {};
  Work work = {};
  Table table = {};
  Command fit = {};
  std::optional<std::vector<Command>> comparison = {};
  std::optional<Cycle> cycle = {};
  std::optional<ToolOutputs> tool = {};
  std::vector<Warning> warnings = {};
};

inline constexpr int kMostTablePoints = 20'000;
inline constexpr double kMostTableRows = 100'000.0;

/// Computes the table, polynomial command, cycle and cutting figures of a constant tool feed
/// through one linkage.
///
/// Errors    those of Mechanism::make, WorkFeed::make, command, comparison, cycle and tool_outputs;
///           out_of_range for the table; unsupported_combination (tube/wall differs from the
///           cut's).
/// Accuracy  strokes and speeds 1e-12 relative, accelerations 1e-12 of their largest value.
/// Cost      under 1 us a table row or servo sample, some 3 ms a fit.
[[nodiscard]] Result<FeedCurve> feed_curve(const FeedCurveSpec& spec);

}  // namespace tubecut::cutoff
