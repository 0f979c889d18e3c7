#include "api/endpoints/frames/plate_answer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "api/endpoints/frames/cutter_fields.hpp"
#include "api/formats/dxf/plate_dxf.hpp"
#include "api/formats/step/plate_solid.hpp"
#include "api/wire/sha256.hpp"

namespace tubecut::api {
namespace {

constexpr double kGramsInKg = 1e-9;  // kg/m^3 times mm^3

Json flat(const cutout::Flat& p) {
  return Json{Json::Array{written::mm(p.x()), written::mm(p.y())}};
}

/// Returns the chain from its lowest corner on, of several alike the left one: a tube
/// that is set on turned by half a turn has the same outline.
cutout::Chain from_lowest(cutout::Chain chain) {
  const auto place = [](const cutout::Segment& s) {
    return std::pair(std::round(s.from.y() * 1e6), std::round(s.from.x() * 1e6));
  };
  std::ranges::rotate(chain, std::ranges::min_element(chain, {}, place));
  return chain;
}

/// A chain as a contour of a request, x to the right and y up.
void add_contour(const cutout::Chain& chain, Json::Object& out) {
  Json::Array pieces;
  for (const auto& s : chain) {
    Json::Object piece{{"kind", Json{s.arc() ? "arc" : "line"}}, {"to_mm", flat(s.to)}};
    if (s.arc()) {
      piece.emplace_back("centre_mm", flat(s.centre));
      piece.emplace_back("sense", Json{s.sweep > 0.0 ? "ccw" : "cw"});
    }
    pieces.emplace_back(std::move(piece));
  }
  out.emplace_back("start_mm", flat(chain.front().from));
  out.emplace_back("pieces", Json{std::move(pieces)});
}

/// Returns the name of a joint's tube on a plate: by its part, so that plates under equal posts
/// are equal.
const std::string& tube_of(const FrameJob& frame, std::size_t joint) {
  return name_of_part(frame, frame.part_of[frame.frame.joints[joint].branch]);
}

const std::string& hole_name(const FrameJob& frame, const frame::FramePlate& of,
                             const plate::Hole& hole) {
  return hole.passing ? tube_of(frame, of.joints[*hole.passing]) : hole.name;
}

Json holes(const FrameJob& frame, const frame::FramePlate& of) {
  Json::Array out;
  for (const auto& hole : of.plate.holes) {
    Json::Object one{{hole.passing ? "part" : "id", Json{hole_name(frame, of, hole)}}};
    one.emplace_back("at_mm", flat(hole.centre));
    if (hole.passing) {
      const auto& how = frame.frame.joints[of.joints[*hole.passing]].how;
      one.emplace_back("gap_mm", Json{how.gap});
      one.emplace_back("greatest_gap_mm", written::mm(hole.greatest_gap));
    }
    if (hole.diameter)
      one.emplace_back("diameter_mm", written::mm(*hole.diameter));
    else
      add_contour(hole.passing ? from_lowest(hole.chain) : hole.chain, one);
    out.emplace_back(std::move(one));
  }
  return Json{std::move(out)};
}

Json marks(const FrameJob& frame, const frame::FramePlate& of) {
  Json::Array out;
  for (const auto& stood : of.stood) {
    Json::Object one{{"part", Json{tube_of(frame, stood.joint)}},
                     {"face", Json{stood.front ? "front" : "back"}}};
    add_contour(from_lowest(stood.outline), one);
    out.emplace_back(std::move(one));
  }
  return Json{std::move(out)};
}

/// Returns everything about a plate but its ids and its place.
Json::Object geometry(const FrameJob& frame, std::size_t index) {
  const auto& of = frame.frame.plates[index];
  const auto box = cutout::bounds(of.plate.outline);
  Json::Object out{{"thickness_mm", Json{frame.spec.plates[index].thickness}},
                   {"width_mm", written::mm(box.most.x() - box.least.x())},
                   {"height_mm", written::mm(box.most.y() - box.least.y())},
                   {"area_mm2", written::mm(of.plate.area)},
                   {"mass_kg", written::mm(mass_of_plate(frame, index))}};
  if (of.plate.web) out.emplace_back("web_mm", written::mm(of.plate.web->width));
  Json::Object outline;
  add_contour(of.plate.outline, outline);
  out.emplace_back("outline", Json{std::move(outline)});
  out.emplace_back("holes", holes(frame, of));
  out.emplace_back("marks", marks(frame, of));
  return out;
}

double density_of(const FrameJob& frame) {
  for (const auto& [name, value] : frame.once)
    if (name == "density_kg_m3") return *value.as<double>();
  throw std::logic_error("a frame without a density");
}

}  // namespace

double mass_of_plate(const FrameJob& frame, std::size_t plate) {
  return frame.frame.plates[plate].plate.volume * density_of(frame) * kGramsInKg;
}

std::vector<PlatePart> plate_parts_of(const FrameJob& frame) {
  std::vector<PlatePart> out;
  for (std::size_t i = 0; i < frame.spec.plates.size(); ++i) {
    ask();
    auto own = geometry(frame, i);
    auto hash = sha256(dump(Json{own}));
    const auto known = std::ranges::find(out, hash, &PlatePart::sha256);
    if (known != out.end())
      known->plates.push_back(i);
    else
      out.push_back({{i}, std::move(own), std::move(hash)});
  }
  return out;
}

const std::string& name_of_plate(const FrameJob& frame, const PlatePart& part) {
  return frame.spec.plates[part.plates.front()].name;
}

std::vector<std::string> ids_of_plates(const FrameJob& frame, const PlatePart& part) {
  std::vector<std::string> out;
  for (const auto one : part.plates) out.push_back(frame.spec.plates[one].name);
  return out;
}

void write_plates(const FrameJob& frame, Writer& w) {
  if (frame.plate_parts.empty()) return;
  w.array("plates", frame.plate_parts, [&](Writer& each, const PlatePart& part) {
    each.object([&](Writer& o) {
      o.field("plate", name_of_plate(frame, part));
      o.field("count", part.plates.size());
      o.column("ids", ids_of_plates(frame, part));
      for (const auto& [name, value] : part.geometry) o.field(name, value);
      o.field("sha256", part.sha256);
    });
  });
}

PlateDrawing drawing_of(const FrameJob& frame, const PlatePart& part) {
  const auto index = part.plates.front();
  const auto& of = frame.frame.plates[index];
  PlateDrawing out{.name = name_of_plate(frame, part),
                   .thickness = frame.spec.plates[index].thickness,
                   .density = density_of(frame),
                   .mass = mass_of_plate(frame, index),
                   .outline = of.plate.outline,
                   .holes = {},
                   .marks = {}};
  for (const auto& hole : of.plate.holes)
    out.holes.push_back({hole_name(frame, of, hole), hole.chain, hole.diameter, hole.centre});
  for (const auto& stood : of.stood)
    out.marks.push_back({tube_of(frame, stood.joint), stood.outline, stood.front});
  return out;
}

const PlateFile* find_plate_file(std::string_view format) {
  static constexpr std::array<PlateFile, 3> kFiles{
      {{"dxf", print_plate_dxf}, {"nc1", print_plate_dstv}, {"step", print_plate_step}}};
  const auto* found = std::ranges::find(kFiles, format, &PlateFile::format);
  return found == kFiles.end() ? nullptr : found;
}

}  // namespace tubecut::api
