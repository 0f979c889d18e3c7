#include "api/formats/groove_formats.hpp"

#include <algorithm>
#include <cmath>

#include "api/formats/csv.hpp"
#include "api/formats/drawing/chart.hpp"
#include "api/formats/drawing/groove_section_sheet.hpp"
#include "api/formats/drawing/svg_sheets.hpp"
#include "api/formats/mesh/gltf.hpp"
#include "api/stop.hpp"
#include "api/wire/tables.hpp"

namespace tubecut::api {
namespace {

template <class Items, class F>
std::vector<double> each(const Items& items, F value) {
  std::vector<double> out;
  for (const auto& item : items) out.push_back(value(item));
  return out;
}

using S = const groove::GrooveSection&;
using P = const groove::MillPosition&;

}  // namespace

std::string groove_csv(const groove::GrooveSpec&, const groove::Groove& g, const Caption& caption) {
  auto columns = section_columns(g);
  for (const auto& [name, points] : kCurves)
    columns.append(std::string(name) + "_", curve_columns(g, points));
  if (g.compare) columns.append("compare_", compare_columns(*g.compare));
  return Csv(caption).table(columns).print();
}

std::string groove_svg(const groove::GrooveSpec& spec, const groove::Groove& g,
                       const Caption& caption) {
  if (caption.view == "section")
    return print_svg({groove_section_sheet(spec, g, caption)}, "Sections of the groove");
  if (caption.options.omega)
    throw UnfitOption{"omega_deg", "the section at an angle is drawn by view=section"};
  const auto omega = each(g.sections, [](S s) { return s.omega.deg(); });
  std::vector<Chart> charts{
      {.title = "Groove height for equal filler area",
       .x_label = "section omega, °",
       .y_label = "height, mm",
       .series = {
           {.name = "height", .x = omega, .y = each(g.sections, [](S s) { return s.height; })}}}};
  if (g.compare)
    charts.push_back({.title = "Filler area per section, compared with a fixed bevel",
                      .x_label = "section omega, °",
                      .y_label = "filler area, mm²",
                      .series = {{.name = "ours",
                                  .x = omega,
                                  .y = each(g.sections, [](S s) { return s.areas.d; })},
                                 {.name = "fixed bevel",
                                  .x = omega,
                                  .y = g.compare->filler_area,
                                  .color = "#c2571a",
                                  .dashed = true}},
                      .y_from_zero = true});
  return print_charts(charts, caption);
}

std::string groove_gltf(const groove::GrooveSpec&, const groove::Groove& g,
                        const Caption& caption) {
  Mesh mesh{.name = "groove", .positions = {}, .colors = {}, .indices = {}};
  double worst = 1e-12;
  for (const auto& s : g.sections) worst = std::max(worst, std::abs(s.ruling.twist.rad()));
  mesh.reserve(4 * g.sections.size());
  for (const auto& s : g.sections)
    for (const auto& point : {s.curves.c1, s.curves.c2, s.curves.c3, s.curves.c4}) {
      mesh.positions.push_back(point);
      mesh.colors.push_back(diverging(s.ruling.twist.rad() / worst));
    }
  mesh.indices = band_triangles(g.sections.size(), 4);
  return print_gltf({mesh}, caption);
}

std::string mill_path_csv(const groove::MillPathSpec&, const groove::MillPath& path,
                          const Caption& caption) {
  return Csv(caption).table(position_columns(path)).print();
}

std::string mill_path_svg(const groove::MillPathSpec&, const groove::MillPath& path,
                          const Caption& caption) {
  const auto& all = path.positions;
  const auto omega = each(all, [](P p) { return p.omega.deg(); });
  const auto um = [&](auto value) { return each(all, [&](P p) { return 1e3 * value(p); }); };
  return print_charts(
      {{.title = "Before: overcut of the initial position",
        .x_label = "section omega, °",
        .y_label = "µm",
        .series = {{.name = "overcut",
                    .x = omega,
                    .y = um([](P p) { return p.before.over; }),
                    .color = "#c2571a"},
                   {.name = "undercut", .x = omega, .y = um([](P p) { return p.before.under; })}}},
       {.title = "After: overcut of the optimised position",
        .x_label = "section omega, °",
        .y_label = "µm",
        .series = {{.name = "overcut",
                    .x = omega,
                    .y = um([](P p) { return p.after.over; }),
                    .color = "#c2571a"},
                   {.name = "undercut", .x = omega, .y = um([](P p) { return p.after.under; })}}},
       {.title = "Axes X and Z",
        .x_label = "section omega, °",
        .y_label = "mm",
        .series = {{.name = "X", .x = omega, .y = each(all, [](P p) { return p.at.x; })},
                   {.name = "Z",
                    .x = omega,
                    .y = each(all, [](P p) { return p.at.z; }),
                    .color = "#4a8a57"}}},
       {.title = "Axis B",
        .x_label = "section omega, °",
        .y_label = "B, °",
        .series = {{.name = "B", .x = omega, .y = each(all, [](P p) { return p.at.b.deg(); })}}}},
      caption);
}

std::string mill_path_gltf(const groove::MillPathSpec& spec, const groove::MillPath& path,
                           const Caption& caption) {
  const auto joint = groove::joint_geometry(spec.groove);
  std::vector<Mesh> meshes{{.name = "before", .positions = {}, .colors = {}, .indices = {}},
                           {.name = "after", .positions = {}, .colors = {}, .indices = {}}};
  double worst = 1e-12;
  for (const auto& p : path.positions) worst = std::max(worst, p.before.largest);
  const std::size_t across = path.positions.empty() ? 0 : path.positions.front().after.gap.size();
  for (auto& mesh : meshes) mesh.reserve(across * path.positions.size());
  for (const auto& p : path.positions) {
    ask();
    const auto section = groove::section(*joint, p.omega);
    for (std::size_t k = 0; k < across; ++k) {
      const double v = static_cast<double>(k) / static_cast<double>(across - 1);
      for (auto& mesh : meshes)
        mesh.positions.push_back(groove::surface_point(*joint, *section, v));
      meshes[0].colors.push_back(diverging(-p.before.gap[k] / worst));
      meshes[1].colors.push_back(diverging(-p.after.gap[k] / worst));
    }
  }
  for (auto& mesh : meshes) mesh.indices = band_triangles(path.positions.size(), across);
  return print_gltf(meshes, caption);
}

}  // namespace tubecut::api
