#pragma once

#include <string>
#include <vector>

#include "api/wire/format.hpp"

namespace tubecut::api {

/// One curve of a chart, of as many points as there are.
struct Series {
  std::string name;  // in the legend
  std::vector<double> x, y;
  std::string color = "#2c6a9b";
  bool dashed = false;
  double every = 0.0;  // spacing from 0, if x is empty
};

/// A tinted interval of x with a word at its top.
struct Band {
  double from = 0.0, to = 0.0;
  std::string label;
  std::string color = "#c0392b";
  bool ribbon = false;  // with a strip of the full colour on the x axis
};

/// A horizontal line with a word.
struct Limit {
  double y = 0.0;
  std::string label;
};

/// A vertical line with a word.
struct Mark {
  double x = 0.0;
  std::string label;
};

/// A line chart, in the colours of the console (web/src/tokens.css), with axes, ticks, units and
/// legend.
struct Chart {
  std::string title;
  std::string x_label;  // with its unit, for example "time, s"
  std::string y_label;
  std::vector<Series> series;
  std::vector<Band> bands = {};
  std::vector<Mark> marks = {};
  std::vector<Limit> limits = {};
  bool y_from_zero = false;
  bool undistorted = false;  // one scale for both axes: a drawing
};

/// Return one revolution with its first value again where it closes, `turn` later; and angles in
/// degrees.
[[nodiscard]] std::vector<double> closed(std::vector<double> values, double turn = 0.0);
[[nodiscard]] std::vector<double> in_degrees(std::vector<double> radians);

/// Returns the charts one below the other as image/svg+xml, above them the verdict, below them the
/// job. Coordinates are printed to 0.01 px. If several consecutive points of a curve lie in one
/// column of pixels, only the first, the last, the lowest and the highest are printed: the picture
/// is the same, and the size of a chart depends only on its pixels.
[[nodiscard]] std::string print_charts(const std::vector<Chart>& charts, const Caption& caption);

}  // namespace tubecut::api
