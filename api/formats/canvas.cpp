#include "api/formats/canvas.hpp"

#include "api/formats/text.hpp"

namespace tubecut::api {
namespace {

std::string named(std::string_view id) {
  return id.empty() ? std::string{} : " id=\"" + xml_text(id) + "\"";
}

std::string look(const Stroke& s) {
  std::string out = " fill=\"" + std::string(s.fill) + "\" stroke=\"" + std::string(s.color) +
                    "\" stroke-width=\"" + fixed(s.width) + "\"";
  if (!s.dashes.empty()) out += " stroke-dasharray=\"" + std::string(s.dashes) + "\"";
  return out;
}

}  // namespace

std::string Canvas::place(DrawingPoint p) const {
  return fixed(p.x, 3) + "," + fixed(height_ - p.y, 3);
}

void Canvas::line(DrawingPoint a, DrawingPoint b, const Stroke& stroke, std::string_view id) {
  body_ += "<line" + named(id) + " x1=\"" + fixed(a.x, 3) + "\" y1=\"" + fixed(height_ - a.y, 3) +
           "\" x2=\"" + fixed(b.x, 3) + "\" y2=\"" + fixed(height_ - b.y, 3) + "\"" + look(stroke) +
           "/>\n";
}

void Canvas::polyline(const std::vector<DrawingPoint>& points, const Stroke& stroke,
                      std::string_view id, bool closed) {
  body_ += std::string(closed ? "<polygon" : "<polyline") + named(id) + look(stroke) +
           " stroke-linejoin=\"round\" points=\"";
  for (const auto& p : points) body_ += place(p) + " ";
  body_ += "\"/>\n";
}

void Canvas::rectangle(DrawingPoint low, DrawingPoint high, const Stroke& stroke,
                       std::string_view id) {
  body_ += "<rect" + named(id) + " x=\"" + fixed(low.x, 3) + "\" y=\"" +
           fixed(height_ - high.y, 3) + "\" width=\"" + fixed(high.x - low.x, 3) + "\" height=\"" +
           fixed(high.y - low.y, 3) + "\"" + look(stroke) + "/>\n";
}

void Canvas::text(DrawingPoint at, std::string_view what, const Lettering& l) {
  body_ += "<text font-size=\"" + fixed(l.height) + "\" fill=\"" + std::string(l.color) + "\"";
  if (l.bold) body_ += " font-weight=\"600\"";
  if (l.anchor != Anchor::start)
    body_ += l.anchor == Anchor::middle ? " text-anchor=\"middle\"" : " text-anchor=\"end\"";
  if (l.turn != 0.0)
    body_ += " transform=\"translate(" + place(at) + ") rotate(" + fixed(-l.turn) + ")\">";
  else
    body_ += " x=\"" + fixed(at.x, 3) + "\" y=\"" + fixed(height_ - at.y, 3) + "\">";
  body_ += xml_text(what) + "</text>\n";
}

void Canvas::begin_clip(DrawingPoint low, DrawingPoint high) {
  const auto id = "clip-" + std::to_string(++clips_);
  body_ += "<clipPath id=\"" + id + "\">";
  rectangle(low, high);
  body_ += "</clipPath><g clip-path=\"url(#" + id + ")\">\n";
}

void Canvas::end_group() { body_ += "</g>\n"; }

std::string Canvas::print(std::string_view title) const {
  const auto w = fixed(width_, 3), h = fixed(height_, 3);
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + w + "mm\" height=\"" + h +
         "mm\" viewBox=\"0 0 " + w + " " + h +
         "\" font-family=\"DejaVu Sans, Arial, sans-serif\">\n<title>" + xml_text(title) +
         "</title>\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n" + body_ + "</svg>\n";
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
