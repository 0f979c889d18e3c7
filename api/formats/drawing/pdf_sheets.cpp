#include "api/formats/drawing/pdf_sheets.hpp"

#include <algorithm>
#include <charconv>

#include "api/api.hpp"
#include "api/formats/drawing/letter_widths.hpp"
#include "api/formats/text.hpp"
#include "api/stop.hpp"
#include "api/wire/text_encoding.hpp"
#include "core/base/angle.hpp"
#include "core/base/elementary.hpp"

namespace tubecut::api {
namespace {

constexpr double kPoint = 72.0 / 25.4;  // of a mm

/// The bytes of WinAnsiEncoding beyond Latin-1 that people type.
constexpr std::pair<char32_t, unsigned char> kWinAnsi[] = {
    {0x20ac, 0x80}, {0x2026, 0x85}, {0x2018, 0x91}, {0x2019, 0x92}, {0x201c, 0x93},
    {0x201d, 0x94}, {0x2022, 0x95}, {0x2013, 0x96}, {0x2014, 0x97}, {0x2122, 0x99}};

/// Returns the text in WinAnsiEncoding; other letters spelled in ASCII.
std::string in_win_ansi(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const auto before = text;
    const auto c = take_character(text);
    if (!c) throw Unspellable{std::string(before)};
    const auto* found = std::ranges::find(kWinAnsi, *c, &std::pair<char32_t, unsigned char>::first);
    if (*c < 0x7f || (*c >= 0xa0 && *c <= 0xff)) {
      out += static_cast<char>(*c);
    } else if (found != std::end(kWinAnsi)) {
      out += static_cast<char>(found->second);
    } else {
      const auto spelled = in_ascii(before.substr(0, before.size() - text.size()));
      if (!spelled) throw Unspellable{std::string(before)};
      out += *spelled;
    }
  }
  return out;
}

/// Returns the text escaped for the parentheses of a string.
std::string literal(std::string_view text) {
  static constexpr char kOctal[] = "01234567";
  std::string out = "(";
  for (const char c : in_win_ansi(text)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte < 0x7f && c != '(' && c != ')' && c != '\\')
      out += c;
    else
      out += {'\\', kOctal[byte >> 6U], kOctal[(byte >> 3U) & 7U], kOctal[byte & 7U]};
  }
  return out + ")";
}

/// Returns "#1f5fbf" as three fractions.
std::string color(std::string_view name) {
  std::string out;
  for (std::size_t i = 1; i + 1 < name.size(); i += 2) {
    int byte = 0;
    std::from_chars(name.data() + i, name.data() + i + 2, byte, 16);
    out += fixed(byte / 255.0, 3) + " ";
  }
  return out;
}

/// The drawing commands of one sheet, in mm.
class Content {
 public:
  Content(const Canvas& canvas) {
    const auto scale = fixed(kPoint, 6);
    out = scale + " 0 0 " + scale + " 0 0 cm 1 j\n";
    for (const auto& ink : canvas.drawn()) {
      ask();
      draw(ink);
    }
  }
  std::string out;

 private:
  static std::string place(DrawingPoint p) { return fixed(p.x, 3) + " " + fixed(p.y, 3) + " "; }

  void draw(const Ink& ink) {
    switch (ink.kind) {
      case Ink::Kind::line:
      case Ink::Kind::polyline:
      case Ink::Kind::polygon:
        begin(ink.stroke);
        path(ink.points);
        return paint(ink.stroke, ink.kind == Ink::Kind::polygon);
      case Ink::Kind::rectangle: {
        const auto low = ink.points.front(), high = ink.points.back();
        begin(ink.stroke);
        out += place(low) + place({high.x - low.x, high.y - low.y}) + "re ";
        return paint(ink.stroke, false);
      }
      case Ink::Kind::text:
        return text(ink);
      case Ink::Kind::clip:
        out += "q ";
        path(ink.points);
        out += "h W n\n";
        return;
      case Ink::Kind::end:
        out += "Q\n";
        return;
    }
  }
  void path(const std::vector<DrawingPoint>& points) {
    for (std::size_t i = 0; i < points.size(); ++i)
      out += place(points[i]) + (i == 0 ? "m " : "l ");
  }
  void begin(const Stroke& s) {
    out += "q ";
    if (s.color != "none") out += color(s.color) + "RG " + fixed(s.width, 3) + " w ";
    if (!s.dashes.empty()) out += "[" + std::string(s.dashes) + "] 0 d ";
    if (s.fill != "none") out += color(s.fill) + "rg ";
  }
  void paint(const Stroke& s, bool close) {
    const bool filled = s.fill != "none", stroked = s.color != "none";
    if (close) out += "h ";
    out += filled && stroked ? "B" : stroked ? "S" : filled ? "f" : "n";
    out += " Q\n";
  }
  void text(const Ink& ink) {
    const auto& l = ink.lettering;
    const double width = l.height * helvetica_width(ink.text, l.bold);
    const double back = l.anchor == Anchor::start ? 0.0
                        : l.anchor == Anchor::end ? width
                                                  : width / 2;
    const auto [sin, cos] = elementary::sincos(l.turn * kRadPerDeg);
    const auto at = ink.points.front();
    out += "BT /F" + std::string(l.bold ? "2 " : "1 ") + fixed(l.height, 3) + " Tf " +
           color(l.color) + "rg " + fixed(cos, 6) + " " + fixed(sin, 6) + " " + fixed(-sin, 6) +
           " " + fixed(cos, 6) + " " + place({at.x - back * cos, at.y - back * sin}) + "Tm " +
           literal(ink.text) + " Tj ET\n";
  }
};

/// Numbered objects, and the table of their offsets.
class File {
 public:
  /// Its number.
  std::size_t add(std::string_view body) {
    begin();
    out_ += body;
    return end();
  }
  std::size_t add_stream(std::string_view content) {
    begin();
    out_ += "<< /Length " + std::to_string(content.size()) + " >>\nstream\n";
    out_ += content;
    out_ += "endstream";
    return end();
  }
  [[nodiscard]] std::string print(std::size_t root, std::size_t info) && {
    const auto table = out_.size();
    out_ += "xref\n0 " + std::to_string(begins_.size() + 1) + "\n0000000000 65535 f \n";
    for (const auto at : begins_) {
      const auto digits = std::to_string(at);
      out_ += std::string(10 - digits.size(), '0') + digits + " 00000 n \n";
    }
    out_ += "trailer\n<< /Size " + std::to_string(begins_.size() + 1) + " /Root " +
            std::to_string(root) + " 0 R /Info " + std::to_string(info) + " 0 R >>\nstartxref\n" +
            std::to_string(table) + "\n%%EOF\n";
    return std::move(out_);
  }

 private:
  void begin() {
    begins_.push_back(out_.size());
    out_ += std::to_string(begins_.size()) + " 0 obj\n";
  }
  std::size_t end() {
    out_ += "\nendobj\n";
    return begins_.size();
  }

  std::string out_ = "%PDF-1.4\n%\xe2\xe3\xcf\xd3\n";
  std::vector<std::size_t> begins_;
};

std::string font(std::string_view name) {
  return "<< /Type /Font /Subtype /Type1 /BaseFont /" + std::string(name) +
         " /Encoding /WinAnsiEncoding >>";
}

}  // namespace

std::string print_pdf(const std::vector<Canvas>& sheets, std::string_view title) {
  File file;
  const auto plain = file.add(font("Helvetica")), bold = file.add(font("Helvetica-Bold"));
  const auto info = file.add("<< /Title " + literal(title) + " /Producer " +
                             literal("tubecut " + std::string(version())) + " >>");
  const auto parent = std::to_string(info + 1 + 2 * sheets.size()) + " 0 R";  // the last but one
  std::string kids;
  for (const auto& sheet : sheets) {
    const auto content = file.add_stream(Content(sheet).out);
    const auto page =
        file.add("<< /Type /Page /Parent " + parent + " /MediaBox [0 0 " +
                 fixed(sheet.width() * kPoint, 3) + " " + fixed(sheet.height() * kPoint, 3) +
                 "] /Contents " + std::to_string(content) + " 0 R /Resources << /Font << /F1 " +
                 std::to_string(plain) + " 0 R /F2 " + std::to_string(bold) + " 0 R >> >> >>");
    kids += std::to_string(page) + " 0 R ";
  }
  const auto pages = file.add("<< /Type /Pages /Kids [" + kids + "] /Count " +
                              std::to_string(sheets.size()) + " >>");
  // "None": a viewer's print dialogue keeps the full size.
  const auto root = file.add("<< /Type /Catalog /Pages " + std::to_string(pages) +
                             " 0 R /ViewerPreferences << /PrintScaling /None >> >>");
  return std::move(file).print(root, info);
}

}  // namespace tubecut::api
