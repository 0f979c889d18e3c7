#include "api/formats/drawing/tiles.hpp"

#include <algorithm>
#include <cmath>

#include "api/formats/numbers.hpp"
#include "api/stop.hpp"

namespace tubecut::api {
namespace {

// mm
constexpr double kMargin = 10.0;   // that printers leave white
constexpr double kOverlap = 10.0;  // of two pages
constexpr double kRuler = 100.0;
constexpr double kRulerRoom = 9.0;  // left of the window
constexpr double kHead = 9.0;
constexpr double kPad = 4.0;  // around the drawing in the first window, so that no label lies on
                              // its frame
constexpr double kMapRoom = 36.0, kMapTall = 18.0;
constexpr double kWord = 2.4, kLine = 3.3;           // of the words below the window
constexpr double kPlaceRow = 7.0, kRulerRow = 10.0;  // above and below those
constexpr double kCrop = 4.0;
constexpr Stroke kCropMark{.width = 0.15};
constexpr Stroke kGlue{.color = "#7a8794", .width = 0.15, .dashes = "3 2"};
constexpr Stroke kMapLine{.color = "#7a8794", .width = 0.15};

/// Short and long side, mm.
std::pair<double, double> size_of(Paper paper) {
  constexpr double kInch = 25.4;
  switch (paper) {
    case Paper::a3:
      return {297.0, 420.0};
    case Paper::letter:
      return {8.5 * kInch, 11.0 * kInch};
    case Paper::tabloid:
      return {11.0 * kInch, 17.0 * kInch};
    case Paper::sheet:
    case Paper::a4:
      break;
  }
  return {210.0, 297.0};
}

/// How pages of one size and turn cover a drawing.
struct Grid {
  double width = 0.0, height = 0.0;  // of the page
  double foot = 0.0;                 // below the window: words, map and ruler
  double window_w = 0.0, window_h = 0.0;
  int columns = 1, rows = 1;
  std::vector<std::string> lines = {};  // the words, as wide as they may be
};

Grid grid_on(double width, double height, const Canvas& drawing, const TileWords& words) {
  Grid g{.width = width, .height = height, .window_w = width - 2.0 * kMargin - kRulerRoom};
  for (const auto& line : words.lines)
    for (auto& part : wrapped(line, kWord, width - 2.0 * kMargin - kMapRoom - 2.0))
      g.lines.push_back(std::move(part));
  g.foot = kPlaceRow + kRulerRow +
           std::max(kMapTall - kRulerRow, kLine * static_cast<double>(g.lines.size()));
  g.window_h = height - 2.0 * kMargin - g.foot - kHead;
  const auto count = [](double size, double window) {
    return std::max(1, static_cast<int>(std::ceil((size - kOverlap) / (window - kOverlap) - 1e-9)));
  };
  g.columns = count(drawing.width() + kPad, g.window_w);
  g.rows = count(drawing.height(), g.window_h);
  return g;
}

bool meets(const DrawingBox& box, DrawingPoint a, DrawingPoint b) {
  return std::max(a.x, b.x) >= box.low.x && std::min(a.x, b.x) <= box.high.x &&
         std::max(a.y, b.y) >= box.low.y && std::min(a.y, b.y) <= box.high.y;
}

/// A page of the grid that something is cut on.
struct Tile {
  int column, row;    // from the upper left
  DrawingBox window;  // on the drawing
};

class Tiles {
 public:
  Tiles(const TemplateDrawing& drawing, const TemplateLabels& labels, const Grid& grid,
        const TileWords& words)
      : drawing_(drawing.all), labels_(labels), grid_(grid), words_(words) {
    for (int row = 0; row < grid.rows; ++row)
      for (int column = 0; column < grid.columns; ++column)
        if (const auto window = window_of(column, row); holds(drawing.cuts, window))
          tiles_.push_back({column, row, window});
  }

  std::vector<Canvas> pages() {
    std::vector<Canvas> out;
    for (std::size_t k = 0; k < tiles_.size(); ++k) out.push_back(page(k));
    return out;
  }

 private:
  [[nodiscard]] DrawingBox window_of(int column, int row) const {
    const double x = column * (grid_.window_w - kOverlap) - kPad;
    const double top = drawing_.height() - row * (grid_.window_h - kOverlap);
    return {{x, top - grid_.window_h}, {x + grid_.window_w, top}};
  }
  [[nodiscard]] bool holds(const Canvas& cuts, const DrawingBox& window) const {
    return std::ranges::any_of(cuts.drawn(), [&](const Ink& ink) {
      ask();
      for (std::size_t i = 0; i + 1 < ink.points.size(); ++i)
        if (meets(window, ink.points[i], ink.points[i + 1])) return true;
      return false;
    });
  }

  Canvas page(std::size_t k) {
    Canvas sheet(grid_.width, grid_.height);
    const auto& tile = tiles_[k];
    const DrawingPoint low{kMargin + kRulerRoom, kMargin + grid_.foot};
    const DrawingPoint high{low.x + grid_.window_w, low.y + grid_.window_h};
    const DrawingPoint by{low.x - tile.window.low.x, low.y - tile.window.low.y};
    sheet.begin_clip(low, high);
    sheet.place(drawing_, by, "-" + std::to_string(k + 1), {low, high});
    sheet.end_group();
    glue(sheet, tile, low, high);
    labels_.draw(sheet, uncovered(tile), by);
    sheet.rectangle(low, high, {.color = "#b8c0c8", .width = 0.1},
                    "window-" + std::to_string(k + 1));
    crop_marks(sheet, low, high);
    draw_ruler(sheet, {low.x + 4.0, kMargin + 4.5}, kRuler, false,
               "ruler-x-" + std::to_string(k + 1));
    draw_ruler(sheet, {kMargin + 3.5, low.y + 4.0}, kRuler, true,
               "ruler-y-" + std::to_string(k + 1));
    words(sheet, k, low, high);
    map(sheet, k);
    return sheet;
  }
  static void crop_marks(Canvas& sheet, DrawingPoint low, DrawingPoint high) {
    for (const double x : {low.x, high.x})
      for (const double y : {low.y, high.y}) {
        const double out_x = x == low.x ? -1.0 : 1.0, out_y = y == low.y ? -1.0 : 1.0;
        sheet.line({x + out_x * 0.5, y}, {x + out_x * kCrop, y}, kCropMark);
        sheet.line({x, y + out_y * 0.5}, {x, y + out_y * kCrop}, kCropMark);
      }
  }
  [[nodiscard]] int number_at(int column, int row) const {
    for (std::size_t k = 0; k < tiles_.size(); ++k)
      if (tiles_[k].column == column && tiles_[k].row == row) return static_cast<int>(k) + 1;
    return 0;
  }
  /// Returns the part of its window on which no other page is glued.
  [[nodiscard]] DrawingBox uncovered(const Tile& tile) const {
    auto out = tile.window;
    if (number_at(tile.column + 1, tile.row) > 0) out.high.x -= kOverlap;
    if (number_at(tile.column, tile.row + 1) > 0) out.low.y += kOverlap;
    return out;
  }
  /// Marks the edges on which the pages to the right and below are glued.
  void glue(Canvas& sheet, const Tile& tile, DrawingPoint low, DrawingPoint high) {
    constexpr Lettering kGlueWord{.height = 2.2, .anchor = Anchor::middle, .color = "#56626e"};
    if (const int next = number_at(tile.column + 1, tile.row); next > 0) {
      const double x = high.x - kOverlap;
      sheet.line({x, low.y}, {x, high.y}, kGlue);
      auto turned = kGlueWord;
      turned.turn = 90.0;
      sheet.text({high.x - 0.8, low.y + 0.12 * (high.y - low.y)},
                 "page " + std::to_string(next) + " to this line", turned);
    }
    if (const int next = number_at(tile.column, tile.row + 1); next > 0) {
      const double y = low.y + kOverlap;
      sheet.line({low.x, y}, {high.x, y}, kGlue);
      sheet.text({low.x + 0.15 * (high.x - low.x), low.y + 0.8},
                 "page " + std::to_string(next) + " to this line", kGlueWord);
    }
  }
  void words(Canvas& sheet, std::size_t k, DrawingPoint low, DrawingPoint high) {
    const auto& window = tiles_[k].window;
    const double from = words_.mirrored ? words_.x - window.high.x : words_.x + window.low.x;
    const auto range = [](std::string_view name, double a, double b) {
      return std::string(name) + " " + number(a, Unit::mm) + " to " + mm(b);
    };
    const auto place = range("round", from, from + grid_.window_w) + ", " +
                       range("along", words_.z + window.low.y, words_.z + window.high.y);
    const auto page = "page " + std::to_string(k + 1) + " of " + std::to_string(tiles_.size());
    const double room = high.x - low.x - 12.0 - text_width(page, 3.4, true);
    sheet.label({low.x + 5.0, high.y + 4.6}, words_.title, {.height = 4.0, .bold = true}, room);
    sheet.text({high.x - 5.0, high.y + 4.6}, page,
               {.height = 3.4, .anchor = Anchor::end, .bold = true});
    double y = low.y - 5.4;
    sheet.text({low.x + 5.0, y}, place, {.height = 2.6, .bold = true});
    y -= kPlaceRow - 5.4;
    for (const auto& line : grid_.lines) sheet.text({kMargin, y -= kLine}, line, {.height = kWord});
  }
  /// Every page of the grid; those without a number are not printed.
  void map(Canvas& sheet, std::size_t k) {
    constexpr double kNumber = kLeastText;
    const double size = std::min((kMapRoom - 4.0) / grid_.columns, kMapTall / grid_.rows);
    const bool numbered =
        size >= std::max(1.4 * kNumber, text_width(std::to_string(tiles_.size()), kNumber) + 0.4);
    const DrawingPoint top{grid_.width - kMargin - size * grid_.columns,
                           kMargin + 1.0 + size * grid_.rows};
    for (int row = 0; row < grid_.rows; ++row)
      for (int column = 0; column < grid_.columns; ++column) {
        const int number = number_at(column, row);
        const DrawingPoint at{top.x + size * column, top.y - size * (row + 1)};
        const bool here = number == static_cast<int>(k) + 1;
        sheet.rectangle(
            at, {at.x + size, at.y + size},
            {.color = kMapLine.color, .width = kMapLine.width, .fill = here ? "#cfe0f5" : "none"});
        if (number > 0 && numbered)
          sheet.text({at.x + 0.5 * size, at.y + 0.5 * size - 0.36 * kNumber},
                     std::to_string(number), {.height = kNumber, .anchor = Anchor::middle});
      }
  }

  const Canvas& drawing_;
  const TemplateLabels& labels_;
  const Grid& grid_;
  const TileWords& words_;
  std::vector<Tile> tiles_;
};

}  // namespace

std::vector<Canvas> tiles(const TemplateDrawing& drawing, const TemplateLabels& labels, Paper paper,
                          const TileWords& words) {
  const auto [small, large] = size_of(paper);
  const auto upright = grid_on(small, large, drawing.all, words),
             across = grid_on(large, small, drawing.all, words);
  const bool turned = across.columns * across.rows < upright.columns * upright.rows;
  return Tiles(drawing, labels, turned ? across : upright, words).pages();
}

}  // namespace tubecut::api
