#pragma once

#include <string>
#include <utility>
#include <vector>

#include "api/formats/drawing/canvas.hpp"
#include "api/wire/format.hpp"

namespace tubecut::api {

/// Names and values of the title block.
using SheetFacts = std::vector<std::pair<std::string, std::string>>;

/// A page of A4 upright with a frame and a title block: title, facts, the caller's reference,
/// engine and hashes; at its top the verdict. The caller draws the content between them.
class Sheet {
 public:
  static constexpr double kWidth = 210.0, kHeight = 297.0, kBorder = 10.0;

  Sheet(const std::string& title, const SheetFacts& facts, const Caption& caption);

  /// The free part of the page.
  [[nodiscard]] DrawingPoint low() const { return {kBorder, low_}; }
  [[nodiscard]] DrawingPoint high() const { return {kWidth - kBorder, high_}; }
  [[nodiscard]] Canvas& canvas() { return canvas_; }

 private:
  void draw_block(const std::string& title, const SheetFacts& facts, const SheetFacts& job);
  void draw_verdict(const Caption& caption);

  Canvas canvas_;
  double low_ = 0.0, high_ = 0.0;
};

/// How a line of the verdict is lettered: loud, unless it is `ok`.
[[nodiscard]] Lettering verdict_lettering(const Caption& caption, double height);

/// The rectangle `index` of a grid over the free part of a sheet, row by row from the top left.
struct Cell {
  DrawingPoint low, high;
};
[[nodiscard]] Cell cell(const Sheet& sheet, int columns, int rows, int index);

/// The drawing scale that fits `size` mm of the part into `room` mm of paper, of the usual ones
/// (1:1, 2:1, 5:1, 10:1, 1:2, 1:5 ...), and its name.
struct DrawingScale {
  double factor = 1.0;
  std::string name = "1:1";
};
[[nodiscard]] DrawingScale drawing_scale(double size, double room);

/// A table of short texts with a header row, its upper left corner at `at`. Returns the y below it.
double draw_table(Canvas& canvas, DrawingPoint at, const std::vector<double>& widths,
                  const std::vector<std::vector<std::string>>& rows);

}  // namespace tubecut::api
