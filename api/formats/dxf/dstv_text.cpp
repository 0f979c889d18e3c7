#include "api/formats/dxf/dstv_text.hpp"

#include <algorithm>

#include "api/formats/numbers.hpp"
#include "api/formats/text.hpp"
#include "api/verdict.hpp"
#include "api/wire/words.hpp"
#include "core/base/angle.hpp"

namespace tubecut::api {
namespace {

constexpr double kOneBevel = 0.01 * kRadPerDeg;  // within it a bevel is constant

std::string line(const std::string& text) { return "  " + text + "\r\n"; }

std::string reference(const Caption& caption, std::string_view name) {
  for (const auto& [key, text] : caption.reference)
    if (key == name) return dstv_text(text);
  return "-";
}

}  // namespace

std::string dstv_field(double value, int digits) {
  auto text = fixed(value, digits);
  return std::string(text.size() < 12 ? 12 - text.size() : 1, ' ') + text;
}

std::string dstv_comment(const std::string& text) { return "** " + text + "\r\n"; }

std::string dstv_comments(const DstvLengths& l, const std::vector<std::string>& frame,
                          bool constant, const Caption& c) {
  std::string out = dstv_comment(
      job_line({.reference = {}, .input_sha256 = c.input_sha256, .result_sha256 = {}, .view = {}}));
  for (const auto& text : frame) out += dstv_comment(text);
  out += dstv_comment("bevel angles: positive where the outer edge lies further towards +x");
  for (const auto& [name, text] : c.reference)
    out += dstv_comment(called(name, Term::field) + ": " + dstv_text(text) +
                        std::string(spelling_note(text)));
  for (const auto& text : verdict_lines(c.verdict, {.width = 76, .plain = true}))
    out += dstv_comment(dstv_text(degrees_spelled(text)));
  out += dstv_comment("length over the long point " + mm(l.over_long)) +
         dstv_comment("length over the short point " + mm(l.over_short)) +
         dstv_comment("length from the work point " + mm(l.work_point)) +
         dstv_comment("length to saw, including the cut of the torch line " + mm(l.saw));
  if (l.assumed) out += dstv_comment("no length was given: the far end is assumed");
  if (!constant)
    out += dstv_comment("the bevel varies; sidecar " + c.input_sha256.substr(0, 16) +
                        ".csv = the csv format of the same request, angles of the same sign");
  return out;
}

std::string dstv_header(const DstvProfile& p, const DstvLengths& l, const Caption& c,
                        std::string_view name) {
  const auto given = reference(c, "part");
  const auto part = given == "-" ? dstv_text(name) : given;
  const auto quantity = reference(c, "quantity");
  std::string out = line(reference(c, "order")) + line(reference(c, "drawing")) + line("1") +
                    line(part) + line(reference(c, "material")) +
                    line(quantity == "-" ? "1" : quantity) + line(p.name) + line(p.code);
  out += dstv_field(l.over_long) + "," + dstv_field(l.saw) + "\r\n";
  for (const double v : {p.height, p.width, p.wall, p.wall, p.radius, p.kg_per_m, p.girth * 1e-3,
                         0.0, 0.0, 0.0, 0.0})
    out += dstv_field(v) + "\r\n";
  return out + line("-") + line("-") + line("-") + line("-");
}

std::string dstv_point(std::string_view face, double x, double y, double bevel, bool first) {
  return std::string("  ") + (first ? std::string(face) : " ") + dstv_field(x) +
         (first ? "u" : " ") + dstv_field(y) + dstv_field(0.0) + dstv_field(bevel) +
         dstv_field(0.0) + dstv_field(0.0) + dstv_field(0.0) + "\r\n";
}

std::optional<double> one_bevel(const std::vector<double>& b) {
  const auto [least, most] = std::ranges::minmax(b);
  if (most - least > kOneBevel) return std::nullopt;
  return (least + most) / 2.0 * kDegPerRad;
}

namespace {

std::string wall_words(cutout::Lay lay) {
  switch (lay) {
    case cutout::Lay::developed:
      return "square to the tube";
    case cutout::Lay::prism:
      return "its walls parallel";
    case cutout::Lay::bored:
      return "square to the tube, its size on the bore";
    case cutout::Lay::flat:
      return "square to the face";
  }
  return {};
}

}  // namespace

std::string dstv_cutout_title(const std::string& name, cutout::Lay lay) {
  return dstv_comment("cut-out " + dstv_text(name) + ", " + wall_words(lay));
}

std::optional<double> dstv_bore_diameter(const cutout::Spec& cutout) {
  constexpr double kLargest = 200.0;  // mm
  const auto* circle = std::get_if<cutout::Circle>(&cutout.shape);
  if (circle == nullptr || circle->diameter > kLargest) return {};
  return circle->diameter;
}

std::string dstv_bore(std::string_view face, double x, double y, double diameter) {
  return "BO\r\n  " + std::string(face) + dstv_field(x) + "u" + dstv_field(y) +
         dstv_field(diameter) + dstv_field(0.0) + "\r\n";
}

}  // namespace tubecut::api
