#pragma once

#include <string>
#include <vector>

#include "api/formats/drawing/canvas.hpp"
#include "api/wire/format.hpp"

namespace tubecut::api {

/// Sheets of A4 upright that take blocks from top to bottom; a block that does not fit goes to the
/// next sheet. Each has the same head: title, part, a DataMatrix of the part and of the result's
/// hash in two lines, verdict; and a foot: the job, sheet of sheets.
class OrderSheets {
 public:
  static constexpr double kWidth = 210.0, kHeight = 297.0, kBorder = 10.0;
  static constexpr double kPad = 3.0, kLeft = kBorder + kPad, kRight = kWidth - kBorder - kPad,
                          kWide = kRight - kLeft;  // of its content

  OrderSheets(std::string title, std::string part, const Caption& caption);

  /// Room for a block as wide as the sheet: the y of its upper edge.
  double take(double height);
  /// Begins another sheet if less than `height` remains on this one.
  void keep_together(double height);
  /// Returns the remaining height of this sheet.
  [[nodiscard]] double left() const { return y_ - kLow; }
  [[nodiscard]] Canvas& canvas() { return sheets_.back(); }
  /// With the foot of each.
  [[nodiscard]] std::vector<Canvas> finished();

 private:
  static constexpr double kLow = 17.0;
  void begin();

  std::string title_, part_;
  const Caption& caption_;
  std::vector<Canvas> sheets_;
  double y_ = 0.0;
};

}  // namespace tubecut::api
