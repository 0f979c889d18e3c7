#include "api/endpoints/frames/frame_formats.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "api/endpoints/frames/plate_answer.hpp"
#include "api/formats/csv.hpp"
#include "api/formats/step/plate_solid.hpp"
#include "api/formats/step/section_solid.hpp"
#include "api/formats/step/step.hpp"
#include "api/stop.hpp"
#include "api/wire/columns.hpp"

namespace tubecut::api {
namespace {

/// A row of a table as columns of one cell.
struct CsvRow {
  Columns columns = {};

  void field(std::string_view name, double value) {
    columns.column(name, std::vector<double>{value});
  }
  void field(std::string_view name, std::size_t value) {
    columns.integers(name, std::vector<std::size_t>{value});
  }
  void field(std::string_view name, std::string_view value) {
    columns.texts(name, {std::string(value)});
  }
  void column(std::string_view name, const std::vector<std::string>& values) {
    std::string all;
    for (const auto& value : values) all += (all.empty() ? "" : ", ") + value;
    columns.texts(name, {std::move(all)});
  }
};

/// A part as a solid of the file.
StepFile::Shape add_solid(const FrameJob& frame, std::size_t i, const Worked<Parts>& part,
                          const Caption& caption, StepFile& file) {
  const auto& name = name_of_part(frame, i);
  try {
    if (part.out.of_section)
      return file.solid(section_solid(part.spec.of_section, *part.out.of_section),
                        product_of(part.spec.of_section.section, name, caption));
    return file.solid(part_solid(part.spec.part, part.out, caption),
                      product_of(part.spec.part.target, name, caption));
  } catch (const UnfitOption& met) {
    throw UnfitOption{met.name, "part " + name + ": " + met.hint};
  }
}

}  // namespace

std::string cut_list_csv(const FrameJob& frame, const MadeParts& made, const Caption& caption) {
  std::vector<std::pair<std::string, Columns>> rows;
  for (std::size_t i = 0; i < made.size(); ++i) {
    ask();
    CsvRow row;
    cut_list_row(frame, i, made[i], row);
    rows.emplace_back(name_of_part(frame, i), std::move(row.columns));
  }
  for (const auto& part : frame.plate_parts) {
    CsvRow row;
    plate_row(frame, part, row);
    rows.emplace_back(name_of_plate(frame, part), std::move(row.columns));
  }
  Csv out(caption);
  for (const auto& [name, value] : caption.reference)
    out.remark(name + ": " + value + (name == "quantity" ? " frames (count is of one frame)" : ""));
  return out.stacked("part", rows).print();
}

std::string frame_step(const FrameJob& frame, const MadeParts& made, const Caption& caption) {
  double thinnest = limit::wall_max_mm;
  for (const auto& m : frame.spec.members) thinnest = std::min(thinnest, m.wall);
  for (const auto& p : frame.spec.plates) thinnest = std::min(thinnest, p.thickness);
  auto of_parts = caption;  // they are called by their own names
  std::erase_if(of_parts.reference, [](const auto& one) { return one.first == "part"; });
  StepFile file(thinnest, caption);
  std::vector<StepFile::Shape> shapes(made.size());
  for (std::size_t i = 0; i < made.size(); ++i)
    if (made[i].made) shapes[i] = add_solid(frame, i, *made[i].made, of_parts, file);
  std::vector<StepFile::Placed> placed;
  for (std::size_t i = 0; i < frame.part_of.size(); ++i) {
    const auto part = frame.part_of[i];
    if (!made[part].made) continue;
    const auto [origin, rows] = place_of(frame, *made[part].made, i);
    placed.push_back({shapes[part], frame.spec.members[i].name, origin, rows});
  }
  for (const auto& part : frame.plate_parts) {
    ask();
    const auto drawing = drawing_of(frame, part);
    const auto shape = file.solid(plate_solid(drawing), product_of(drawing, of_parts));
    for (const auto one : part.plates) {
      const auto& at = frame.frame.plates[one].plate.frame;
      placed.push_back({shape, frame.spec.plates[one].name, at.origin, at.rows});
    }
  }
  Product whole{.id = caption.input_sha256.substr(0, 16), .name = "frame", .revision = {}};
  for (const auto& [key, text] : caption.reference) {
    if (key == "part") whole.id = text;
    if (key == "revision") whole.revision = text;
  }
  file.assembly(whole, placed);
  return file.print(whole, "an assembly of closed solids");
}

}  // namespace tubecut::api
