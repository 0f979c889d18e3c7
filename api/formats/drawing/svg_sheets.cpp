#include "api/formats/drawing/svg_sheets.hpp"

#include <algorithm>

#include "api/formats/text.hpp"
#include "api/stop.hpp"

namespace tubecut::api {
namespace {

std::string named(std::string_view id) {
  return id.empty() ? std::string{} : " id=\"" + xml_text(id) + "\"";
}

std::string attribute(std::string_view name, std::string_view value) {
  return " " + std::string(name) + "=\"" + std::string(value) + "\"";
}

std::string look(const Stroke& s) {
  std::string out = attribute("fill", s.fill) + attribute("stroke", s.color) +
                    attribute("stroke-width", fixed(s.width));
  if (!s.dashes.empty()) out += attribute("stroke-dasharray", s.dashes);
  return out;
}

class SvgPrinter {
 public:
  void sheet(const Canvas& canvas, double top) {
    top_ = top + canvas.height();
    for (const auto& ink : canvas.drawn()) {
      ask();
      draw(ink);
    }
  }
  std::string out;

 private:
  [[nodiscard]] std::string x(DrawingPoint p) const { return fixed(p.x, 3); }
  [[nodiscard]] std::string y(DrawingPoint p) const { return fixed(top_ - p.y, 3); }
  [[nodiscard]] std::string place(DrawingPoint p) const { return x(p) + "," + y(p); }
  [[nodiscard]] std::string places(const std::vector<DrawingPoint>& points) const {
    std::string all;
    for (const auto& p : points) all += place(p) + " ";
    return all;
  }

  void draw(const Ink& ink) {
    switch (ink.kind) {
      case Ink::Kind::line:
        return line(ink);
      case Ink::Kind::polyline:
      case Ink::Kind::polygon:
        out += std::string(ink.kind == Ink::Kind::polygon ? "<polygon" : "<polyline") +
               named(ink.id) + look(ink.stroke) + " stroke-linejoin=\"round\"";
        out += attribute("points", places(ink.points));
        out += "/>\n";
        return;
      case Ink::Kind::rectangle:
        return rectangle(ink);
      case Ink::Kind::text:
        return text(ink);
      case Ink::Kind::clip: {
        const auto id = "clip-" + std::to_string(++clips_);
        out += "<clipPath id=\"" + id + "\"><polygon" + attribute("points", places(ink.points)) +
               "/></clipPath><g clip-path=\"url(#" + id + ")\">\n";
        return;
      }
      case Ink::Kind::end:
        out += "</g>\n";
        return;
    }
  }
  void line(const Ink& ink) {
    const auto a = ink.points.front(), b = ink.points.back();
    out += "<line" + named(ink.id) + attribute("x1", x(a)) + attribute("y1", y(a)) +
           attribute("x2", x(b)) + attribute("y2", y(b)) + look(ink.stroke) + "/>\n";
  }
  void rectangle(const Ink& ink) {
    const auto low = ink.points.front(), high = ink.points.back();
    out += "<rect" + named(ink.id) + attribute("x", x(low)) + attribute("y", y(high)) +
           attribute("width", fixed(high.x - low.x, 3)) +
           attribute("height", fixed(high.y - low.y, 3)) + look(ink.stroke) + "/>\n";
  }
  void text(const Ink& ink) {
    const auto& l = ink.lettering;
    const auto at = ink.points.front();
    out += "<text" + attribute("font-size", fixed(l.height)) + attribute("fill", l.color);
    if (l.bold) out += attribute("font-weight", "600");
    if (l.anchor != Anchor::start)
      out += attribute("text-anchor", l.anchor == Anchor::middle ? "middle" : "end");
    if (l.turn != 0.0)
      out += attribute("transform", "translate(" + place(at) + ") rotate(" + fixed(-l.turn) + ")");
    else
      out += attribute("x", x(at)) + attribute("y", y(at));
    out += ">" + xml_text(ink.text) + "</text>\n";
  }

  double top_ = 0.0;
  int clips_ = 0;
};

}  // namespace

std::string print_svg(const std::vector<Canvas>& sheets, std::string_view title) {
  double width = 0.0, height = 0.0;
  for (const auto& sheet : sheets) {
    width = std::max(width, sheet.width());
    height += sheet.height();
  }
  const auto w = fixed(width, 3), h = fixed(height, 3);
  SvgPrinter printer;
  printer.out =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + w + "mm\" height=\"" + h +
      "mm\" viewBox=\"0 0 " + w + " " + h +
      "\" font-family=\"Arial, Liberation Sans, Helvetica, DejaVu Sans, sans-serif\">\n<title>" +
      xml_text(title) + "</title>\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n";
  double top = 0.0;
  for (std::size_t i = 0; i < sheets.size(); ++i) {
    if (sheets.size() > 1) printer.out += "<g id=\"sheet-" + std::to_string(i + 1) + "\">\n";
    printer.sheet(sheets[i], top);
    if (sheets.size() > 1) printer.out += "</g>\n";
    top += sheets[i].height();
  }
  printer.out += "</svg>\n";
  return std::move(printer.out);
}

}  // namespace tubecut::api
