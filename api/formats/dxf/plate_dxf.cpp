#include "api/formats/dxf/plate_dxf.hpp"

#include <algorithm>
#include <cmath>

#include "api/formats/dxf/dstv_text.hpp"
#include "api/formats/dxf/dxf_writer.hpp"
#include "api/formats/numbers.hpp"
#include "api/formats/text.hpp"
#include "api/stop.hpp"
#include "api/verdict.hpp"
#include "api/wire/words.hpp"
#include "core/base/angle.hpp"
#include "core/base/elementary.hpp"

namespace tubecut::api {
namespace {

constexpr double kPlateChord = 0.005;   // mm, of a chord off its arc
constexpr double kLargestBore = 200.0;  // mm: a larger circle is cut, as of tubes

constexpr DxfWriter::Layer kPlateOuter{"CUT_OUTER", 5}, kPlateInner{"CUT_INNER", 3},
    kPlateText{"TEXT", 7}, kPlateMark{"MARK", 6};

std::string size_of(const PlateDrawing& plate) {
  const auto box = cutout::bounds(plate.outline);
  return "plate " + plate.name + ", " + mm(box.most.x() - box.least.x()) + " x " +
         mm(box.most.y() - box.least.y()) + " x " + mm(plate.thickness);
}

std::string mass_in_words(double mass) { return "mass " + fixed(mass, 3) + " kg"; }

/// Places along a chain, from which chords run.
std::vector<cutout::Flat> chords(const cutout::Chain& chain) {
  std::vector<cutout::Flat> out;
  for (const auto& s : chain) {
    ask();
    int parts = 1;
    if (s.arc()) {
      const double step = 2.0 * elementary::acos(1.0 - std::min(1.0, kPlateChord / s.radius));
      parts = std::max(2, static_cast<int>(std::ceil(std::abs(s.sweep) / step)));
    }
    for (int k = 0; k < parts; ++k) out.push_back(s.at(static_cast<double>(k) / parts));
  }
  return out;
}

/// A contour of face v, from `corner`; an inner one runs against the outline.
std::string contour(std::string_view block, const cutout::Chain& chain, const cutout::Flat& corner,
                    bool against) {
  auto points = chords(chain);
  if (against) std::ranges::reverse(points);
  points.push_back(points.front());
  std::string out = std::string(block) + "\r\n";
  for (std::size_t i = 0; i < points.size(); ++i)
    out += dstv_point("v", points[i].x() - corner.x(), points[i].y() - corner.y(), 0.0, i == 0);
  return out;
}

}  // namespace

std::string print_plate_dxf(const PlateDrawing& plate, const Caption& caption) {
  DxfWriter w({kPlateOuter, kPlateInner, kPlateMark, kPlateText}, verdict_lines(caption.verdict));
  w.chain(kPlateOuter, plate.outline);
  for (const auto& hole : plate.holes) w.chain(kPlateInner, hole.chain);
  const auto box = cutout::bounds(plate.outline);
  std::vector<std::string> lines{size_of(plate), mass_in_words(plate.mass),
                                 "CUT_OUTER its outline, CUT_INNER its openings, square to it"};
  for (const auto& mark : plate.marks) {
    if (!mark.front) {
      lines.push_back("tube " + mark.name + " is set on the back: not marked on this side");
      continue;
    }
    w.chain(kPlateMark, mark.outline);
    const auto on = cutout::bounds(mark.outline);
    w.text(kPlateMark, 0.5 * (on.least + on.most), 3.0, mark.name);
  }
  for (const auto& [name, text] : caption.reference)
    lines.push_back(called(name, Term::field) + ": " + text);
  lines.push_back(job_line(
      {.reference = {}, .input_sha256 = caption.input_sha256, .result_sha256 = {}, .view = {}}));
  for (const auto& line : verdict_lines(caption.verdict, {.plain = true})) lines.push_back(line);
  double y = box.least.y() - 5.0;
  for (const auto& line : lines) w.text(kPlateText, {box.least.x(), y -= 5.0}, 3.0, line);
  return w.print();
}

std::string print_plate_dstv(const PlateDrawing& plate, const Caption& caption) {
  const auto box = cutout::bounds(plate.outline);
  const double along = box.most.x() - box.least.x(), across = box.most.y() - box.least.y();
  std::string out = "ST\r\n" + dstv_comment(job_line({.reference = {},
                                                      .input_sha256 = caption.input_sha256,
                                                      .result_sha256 = {},
                                                      .view = {}}));
  for (const auto* text :
       {"unit mm, deg; B = plate, seen on its face, which is v; x to the right, y up",
        "AK its outline, BO a bore, its diameter, depth 0 = through; IK the edge of an opening",
        "every edge is square to the plate; arcs are chords within 0.005 mm of them"})
    out += dstv_comment(text);
  out += dstv_comment(mass_in_words(plate.mass));
  for (const auto& [name, text] : caption.reference)
    out += dstv_comment(called(name, Term::field) + ": " + dstv_text(text) +
                        std::string(spelling_note(text)));
  for (const auto& text : verdict_lines(caption.verdict, {.width = 76, .plain = true}))
    out += dstv_comment(dstv_text(text));
  for (const auto& mark : plate.marks) {
    const auto on = cutout::bounds(mark.outline);
    out += dstv_comment(
        "tube " + dstv_text(mark.name) + " is set on the " + (mark.front ? "face" : "back") +
        ", x " + fixed(on.least.x() - box.least.x(), 3) + " to " +
        fixed(on.most.x() - box.least.x(), 3) + ", y " + fixed(on.least.y() - box.least.y(), 3) +
        " to " + fixed(on.most.y() - box.least.y(), 3));
  }
  out += dstv_header({.name = "PL" + fixed(plate.thickness, 1) + "x" + fixed(across, 1),
                      .code = "B",
                      .height = across,
                      .width = 0.0,
                      .wall = plate.thickness,
                      .radius = 0.0,
                      .kg_per_m = across * plate.thickness * plate.density * 1e-6,
                      .girth = 2.0 * (across + plate.thickness)},
                     {.over_long = along, .saw = along}, caption, plate.name);
  out += contour("AK", plate.outline, box.least, false);
  for (const auto& hole : plate.holes) {
    out += dstv_comment("opening " + dstv_text(hole.name));
    if (hole.diameter && *hole.diameter <= kLargestBore)
      out += dstv_bore("v", hole.centre.x() - box.least.x(), hole.centre.y() - box.least.y(),
                       *hole.diameter);
    else
      out += contour("IK", hole.chain, box.least, true);
  }
  return out + "EN\r\n";
}

}  // namespace tubecut::api
