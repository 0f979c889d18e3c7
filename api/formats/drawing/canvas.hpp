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

/// Stroke of a line; the width in mm. Colours are "#rrggbb" or "none".
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

/// How wide a text is in mm, in the widest of the fonts that a viewer may take.
[[nodiscard]] double text_width(std::string_view text, double height, bool bold = false);

/// The smallest lettering on paper, mm: smaller text cannot be read at the machine.
inline constexpr double kLeastText = 2.2;

/// Returns `l`, reduced until the text fits into `room` mm, but not below kLeastText: if it is
/// still wider, use `wrapped` or `shortened`.
[[nodiscard]] Lettering fitted(std::string_view text, Lettering l, double room);

/// The text as lines within `room` mm, broken at blanks, and within words that are wider.
[[nodiscard]] std::vector<std::string> wrapped(std::string_view text, double height, double room,
                                               bool bold = false);

/// The text, or as much of its beginning as fits into `room` mm with "..." behind it.
[[nodiscard]] std::string shortened(std::string_view text, double height, double room,
                                    bool bold = false);

/// An upright rectangle of a drawing.
struct DrawingBox {
  DrawingPoint low, high;

  [[nodiscard]] bool holds(const DrawingBox& other) const;
  [[nodiscard]] bool meets(const DrawingBox& other) const;
};

/// Returns the box of a text, in the widest of the fonts.
[[nodiscard]] DrawingBox text_box(DrawingPoint at, std::string_view what, const Lettering& l);

/// One thing drawn.
struct Ink {
  enum class Kind { line, polyline, polygon, rectangle, text, clip, end };
  Kind kind = Kind::line;
  std::vector<DrawingPoint> points = {};  // of a rectangle: lower left, upper right
  Stroke stroke = {};
  Lettering lettering = {};
  std::string text = {}, id = {};
};

/// A drawing in millimetres, 1:1. Printed by svg_sheets.hpp and pdf_sheets.hpp.
class Canvas {
 public:
  /// The sheet's size; its origin is the lower left corner. Drawing throws Stopped if cancelled.
  Canvas(double width, double height) : width_(width), height_(height) {}

  void line(DrawingPoint a, DrawingPoint b, const Stroke& stroke = {}, std::string_view id = {});
  void polyline(std::vector<DrawingPoint> points, const Stroke& stroke = {},
                std::string_view id = {}, bool closed = false);
  void rectangle(DrawingPoint low, DrawingPoint high, const Stroke& stroke = {},
                 std::string_view id = {});
  void text(DrawingPoint at, std::string_view what, const Lettering& lettering = {});
  /// A text in one line of at most `room` mm: as `fitted`, then as `shortened`.
  void label(DrawingPoint at, std::string_view what, const Lettering& lettering, double room);
  /// Places another drawing, moved by `by`, its ids with a suffix. Omits everything off this sheet,
  /// and texts that are not wholly within `window` of this sheet.
  void place(const Canvas& other, DrawingPoint by, std::string_view suffix,
             const DrawingBox& window);
  /// Everything drawn until `end_group` is cut off at the rectangle, or the polygon.
  void begin_clip(DrawingPoint low, DrawingPoint high);
  void begin_clip(std::vector<DrawingPoint> border);
  void end_group();

  [[nodiscard]] double width() const { return width_; }
  [[nodiscard]] double height() const { return height_; }
  [[nodiscard]] const std::vector<Ink>& drawn() const { return drawn_; }

 private:
  void add(Ink ink);

  double width_;
  double height_;
  std::vector<Ink> drawn_;
};

/// A line of `length` with a head at both ends.
void draw_arrows(Canvas& canvas, DrawingPoint from, DrawingPoint to, const Stroke& stroke);
/// A line with a head at `to`.
void draw_arrow(Canvas& canvas, DrawingPoint from, DrawingPoint to, const Stroke& stroke);

/// A ruler of `length` mm with ticks every 10 mm, along x or y from `from`; its line has the id
/// `id` and is exactly that long.
void draw_ruler(Canvas& canvas, DrawingPoint from, double length, bool upright,
                std::string_view id);

}  // namespace tubecut::api
