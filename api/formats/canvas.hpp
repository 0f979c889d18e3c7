#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tubecut::api {

/// A point of a drawing: mm, x to the right, y up.
struct DrawingPoint {
  double x = 0.0;
  double y = 0.0;
};

/// Stroke of a line; the width in mm.
struct Stroke {
  std::string_view color = "#1d242b";
  double width = 0.25;
  std::string_view dashes = {};  // mm, as SVG's stroke-dasharray
  std::string_view fill = "none";
};

enum class Anchor { start, middle, end };

struct Lettering {
  double height = 3.0;  // mm, of the font
  Anchor anchor = Anchor::start;
  double turn = 0.0;  // deg, counter-clockwise
  bool bold = false;
  std::string_view color = "#1d242b";
};

/// A drawing in millimetres, printed 1:1 as SVG: width and height in mm, one unit of the viewBox a
/// mm. Coordinates to 0.001 mm.
class Canvas {
 public:
  /// The sheet's size; its origin is the lower left corner.
  Canvas(double width, double height) : width_(width), height_(height) {}

  void line(DrawingPoint a, DrawingPoint b, const Stroke& stroke = {}, std::string_view id = {});
  void polyline(const std::vector<DrawingPoint>& points, const Stroke& stroke = {},
                std::string_view id = {}, bool closed = false);
  void rectangle(DrawingPoint low, DrawingPoint high, const Stroke& stroke = {},
                 std::string_view id = {});
  void text(DrawingPoint at, std::string_view what, const Lettering& lettering = {});
  /// Everything drawn until `end_group` is cut off at the rectangle.
  void begin_clip(DrawingPoint low, DrawingPoint high);
  void end_group();

  [[nodiscard]] double width() const { return width_; }
  [[nodiscard]] double height() const { return height_; }
  [[nodiscard]] std::string print(std::string_view title) const;

 private:
  [[nodiscard]] std::string place(DrawingPoint p) const;

  double width_;
  double height_;
  int clips_ = 0;
  std::string body_;
};

/// A ruler of `length` mm with ticks every 10 mm, along x or y from `from`; its line has the id
/// `id` and is exactly that long.
void draw_ruler(Canvas& canvas, DrawingPoint from, double length, bool upright,
                std::string_view id);

}  // namespace tubecut::api
