#pragma once

#include <string>
#include <vector>

#include "api/format.hpp"

namespace tubecut::api {

/// One curve of a chart.
struct Series {
  std::string name;  // in the legend
  std::vector<double> x, y;
  std::string color = "#1f5fbf";
  bool dashed = false;
  bool steps = false;  // constant from each x to the next
};

/// A stretch of x set apart by a tint, with a word at its top.
struct Band {
  double from = 0.0, to = 0.0;
  std::string label;
  std::string color = "#c0392b";
};

/// A vertical line with a word.
struct Mark {
  double x = 0.0;
  std::string label;
};

/// A line chart with axes, ticks, units and legend.
struct Chart {
  std::string title;
  std::string x_label;  // with its unit, for example "time, s"
  std::string y_label;
  std::vector<Series> series;
  std::vector<Band> bands = {};
  std::vector<Mark> marks = {};
  bool y_from_zero = false;
};

/// The charts one below the other as image/svg+xml, over them the verdict, below them the job.
/// Coordinates are printed to 0.01 px.
[[nodiscard]] std::string print_charts(const std::vector<Chart>& charts, const Caption& caption);

}  // namespace tubecut::api
