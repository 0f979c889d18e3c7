#include "api/formats/drawing/canvas.hpp"

#include <algorithm>
#include <cmath>

#include "api/formats/drawing/letter_widths.hpp"
#include "api/formats/text.hpp"
#include "api/stop.hpp"
#include "core/base/angle.hpp"
#include "core/base/elementary.hpp"

namespace tubecut::api {
namespace {

/// DejaVu Sans, which a system without Arial takes, over Helvetica.
constexpr double kWidestPlain = 1.2, kWidestBold = 1.28;

void head(Canvas& canvas, DrawingPoint from, DrawingPoint to, const Stroke& stroke) {
  constexpr double kLong = 2.0, kHalf = 0.55;  // mm
  const double dx = to.x - from.x, dy = to.y - from.y;
  const double length = std::sqrt(dx * dx + dy * dy);
  if (length <= 0.0) return;
  const double ux = dx / length, uy = dy / length;
  const DrawingPoint back{to.x - kLong * ux, to.y - kLong * uy};
  canvas.polyline(
      {to, {back.x - kHalf * uy, back.y + kHalf * ux}, {back.x + kHalf * uy, back.y - kHalf * ux}},
      {.color = stroke.color, .width = 0.05, .fill = stroke.color}, {}, true);
}

}  // namespace

double text_width(std::string_view text, double height, bool bold) {
  return height * (bold ? kWidestBold : kWidestPlain) * helvetica_width(text, bold);
}

Lettering fitted(std::string_view text, Lettering l, double room) {
  constexpr double kInside = 1.0 - 1e-9;  // else rounding makes the reduced text too wide again
  const double width = text_width(text, l.height, l.bold);
  if (width > room)
    l.height = std::max(std::min(kLeastText, l.height), kInside * l.height * room / width);
  return l;
}

namespace {

/// How many bytes of the text, in whole characters, are within `room`; at least one character.
std::size_t bytes_within(std::string_view text, double height, double room, bool bold) {
  std::size_t out = 0;
  while (out < text.size()) {
    auto next = out + 1;
    while (next < text.size() && (static_cast<unsigned char>(text[next]) & 0xC0U) == 0x80U) ++next;
    if (out > 0 && text_width(text.substr(0, next), height, bold) > room) break;
    out = next;
  }
  return out;
}

}  // namespace

std::vector<std::string> wrapped(std::string_view text, double height, double room, bool bold) {
  std::vector<std::string> out;
  while (text_width(text, height, bold) > room) {
    auto end = bytes_within(text, height, room, bold);
    if (end == text.size()) break;  // one character
    const auto blank = text.rfind(' ', end);
    const bool at_blank = blank != std::string_view::npos && blank > 0;
    if (at_blank) end = blank;
    out.emplace_back(text.substr(0, end));
    text.remove_prefix(at_blank ? end + 1 : end);
  }
  out.emplace_back(text);
  return out;
}

std::string shortened(std::string_view text, double height, double room, bool bold) {
  if (text_width(text, height, bold) <= room) return std::string(text);
  static constexpr std::string_view kMore = "...";
  const double left = room - text_width(kMore, height, bold);
  return std::string(text.substr(0, bytes_within(text, height, left, bold))).append(kMore);
}

bool DrawingBox::holds(const DrawingBox& other) const {
  return other.low.x >= low.x && other.high.x <= high.x && other.low.y >= low.y &&
         other.high.y <= high.y;
}

bool DrawingBox::meets(const DrawingBox& other) const {
  return other.high.x > low.x && other.low.x < high.x && other.high.y > low.y &&
         other.low.y < high.y;
}

DrawingBox text_box(DrawingPoint at, std::string_view what, const Lettering& l) {
  constexpr double kUp = 0.8, kDown = 0.25;  // of the height
  const double width = text_width(what, l.height, l.bold);
  const double from = l.anchor == Anchor::start ? 0.0
                      : l.anchor == Anchor::end ? -width
                                                : -0.5 * width;
  const auto [sin, cos] = elementary::sincos(l.turn * kRadPerDeg);
  DrawingBox out{at, at};
  bool first = true;
  for (const double x : {from, from + width})
    for (const double y : {-kDown * l.height, kUp * l.height}) {
      const DrawingPoint p{at.x + x * cos - y * sin, at.y + x * sin + y * cos};
      out.low = first ? p : DrawingPoint{std::min(out.low.x, p.x), std::min(out.low.y, p.y)};
      out.high = first ? p : DrawingPoint{std::max(out.high.x, p.x), std::max(out.high.y, p.y)};
      first = false;
    }
  return out;
}

void Canvas::add(Ink ink) {
  ask();
  drawn_.push_back(std::move(ink));
}

void Canvas::line(DrawingPoint a, DrawingPoint b, const Stroke& stroke, std::string_view id) {
  add({.kind = Ink::Kind::line, .points = {a, b}, .stroke = stroke, .id = std::string(id)});
}

void Canvas::polyline(std::vector<DrawingPoint> points, const Stroke& stroke, std::string_view id,
                      bool closed) {
  add({.kind = closed ? Ink::Kind::polygon : Ink::Kind::polyline,
       .points = std::move(points),
       .stroke = stroke,
       .id = std::string(id)});
}

void Canvas::rectangle(DrawingPoint low, DrawingPoint high, const Stroke& stroke,
                       std::string_view id) {
  add({.kind = Ink::Kind::rectangle,
       .points = {low, high},
       .stroke = stroke,
       .id = std::string(id)});
}

void Canvas::text(DrawingPoint at, std::string_view what, const Lettering& lettering) {
  add({.kind = Ink::Kind::text, .points = {at}, .lettering = lettering, .text = std::string(what)});
}

void Canvas::label(DrawingPoint at, std::string_view what, const Lettering& lettering,
                   double room) {
  const auto l = fitted(what, lettering, room);
  text(at, shortened(what, l.height, room, l.bold), l);
}

void Canvas::place(const Canvas& other, DrawingPoint by, std::string_view suffix,
                   const DrawingBox& window) {
  for (auto ink : other.drawn_) {
    ask();
    const double reach = text_width(ink.text, ink.lettering.height, true) + 1.0;
    DrawingPoint low{width_, height_}, high{0.0, 0.0};
    for (auto& p : ink.points) {
      p = {p.x + by.x, p.y + by.y};
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    const bool off = high.x + reach < 0.0 || low.x - reach > width_ || high.y + reach < 0.0 ||
                     low.y - reach > height_;
    if (off && ink.kind != Ink::Kind::clip && ink.kind != Ink::Kind::end) continue;
    if (ink.kind == Ink::Kind::text &&
        !window.holds(text_box(ink.points.front(), ink.text, ink.lettering)))
      continue;
    if (!ink.id.empty()) ink.id += suffix;
    drawn_.push_back(std::move(ink));
  }
}

void Canvas::begin_clip(DrawingPoint low, DrawingPoint high) {
  begin_clip({low, {high.x, low.y}, high, {low.x, high.y}});
}

void Canvas::begin_clip(std::vector<DrawingPoint> border) {
  add({.kind = Ink::Kind::clip, .points = std::move(border)});
}

void Canvas::end_group() { add({.kind = Ink::Kind::end}); }

void draw_arrows(Canvas& canvas, DrawingPoint from, DrawingPoint to, const Stroke& stroke) {
  draw_arrow(canvas, from, to, stroke);
  head(canvas, to, from, stroke);
}

void draw_arrow(Canvas& canvas, DrawingPoint from, DrawingPoint to, const Stroke& stroke) {
  canvas.line(from, to, stroke);
  head(canvas, from, to, stroke);
}

void draw_ruler(Canvas& canvas, DrawingPoint from, double length, bool upright,
                std::string_view id) {
  const auto at = [&](double along, double across) {
    return upright ? DrawingPoint{from.x + across, from.y + along}
                   : DrawingPoint{from.x + along, from.y + across};
  };
  canvas.line(from, at(length, 0.0), {.width = 0.2}, id);
  const int ticks = static_cast<int>(length / 10.0 + 0.5);
  for (int i = 0; i <= ticks; ++i) {
    const double along = 10.0 * i;
    canvas.line(at(along, 0.0), at(along, i % 5 == 0 ? 3.0 : 1.5), {.width = 0.2});
  }
  canvas.text(at(length / 2, upright ? -1.2 : -3.4), "check: " + fixed(length, 0) + " mm",
              {.height = 2.6, .anchor = Anchor::middle, .turn = upright ? 90.0 : 0.0});
}

}  // namespace tubecut::api
