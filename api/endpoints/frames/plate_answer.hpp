#pragma once

#include <string>
#include <vector>

#include "api/endpoints/frames/frame_answer.hpp"
#include "api/formats/dxf/plate_dxf.hpp"
#include "api/wire/format.hpp"
#include "api/wire/writer.hpp"

namespace tubecut::api {

/// Returns the plates to be made, those of one kind as one, in the request's order: alike in
/// thickness, outline, openings and marks.
[[nodiscard]] std::vector<PlatePart> plate_parts_of(const FrameJob& frame);

/// Writes `plates` of an answer: a row for each kind. Nothing if no plates were requested.
void write_plates(const FrameJob& frame, Writer& w);

[[nodiscard]] const std::string& name_of_plate(const FrameJob& frame, const PlatePart& part);
[[nodiscard]] std::vector<std::string> ids_of_plates(const FrameJob& frame, const PlatePart& part);
/// Returns the mass of one plate, kg.
[[nodiscard]] double mass_of_plate(const FrameJob& frame, std::size_t plate);

/// Returns one kind of plate as its files draw it.
[[nodiscard]] PlateDrawing drawing_of(const FrameJob& frame, const PlatePart& part);

/// A file of a plate; `caption` has its reference.
struct PlateFile {
  std::string_view format;
  std::string (*print)(const PlateDrawing& plate, const Caption& caption);
};
/// Returns nullptr if a plate has no such file.
[[nodiscard]] const PlateFile* find_plate_file(std::string_view format);

/// Writes the columns of the cut list of a plate, as cut_list_row.
template <class Row>
void plate_row(const FrameJob& frame, const PlatePart& part, Row& row) {
  const auto plate = part.plates.front();
  const auto box = cutout::bounds(frame.frame.plates[plate].plate.outline);
  row.field("count", part.plates.size());
  row.column("members", ids_of_plates(frame, part));
  row.field("height_mm", box.most.y() - box.least.y());
  row.field("width_mm", box.most.x() - box.least.x());
  row.field("thickness_mm", frame.spec.plates[plate].thickness);
  row.field("mass_kg", mass_of_plate(frame, plate));
  row.field("result_sha256", part.sha256);
}

}  // namespace tubecut::api
