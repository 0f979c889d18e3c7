#include "api/formats/section_formats.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "api/formats/csv.hpp"
#include "api/formats/drawing/chart.hpp"
#include "api/formats/drawing/development.hpp"
#include "api/formats/drawing/partner_names.hpp"
#include "api/formats/drawing/pdf_sheets.hpp"
#include "api/formats/drawing/svg_sheets.hpp"
#include "api/formats/drawing/wrap_template.hpp"
#include "api/formats/dxf/dxf.hpp"
#include "api/formats/gcode/gcode.hpp"
#include "api/formats/mesh/cut_solid.hpp"
#include "api/wire/joint_names.hpp"
#include "api/wire/section_tables.hpp"
#include "core/base/elementary.hpp"

namespace tubecut::api {

std::string section_csv(const joint::SectionIntersection& cut, const Caption& caption) {
  double tip = std::ranges::min(cut.profiles.front().z);  // on the outside, if that is there
  for (const auto& p : cut.profiles)
    if (p.outer) tip = std::ranges::min(p.z);
  std::vector<std::pair<std::string, Columns>> surfaces;
  for (const auto& p : cut.profiles) {
    auto drop = p.z;
    for (double& z : drop) z -= tip;
    surfaces.emplace_back(wall_name(p.outer),
                          profile_columns(p).column("drop_mm", std::move(drop)));
  }
  return Csv(caption).stacked("surface", surfaces).print();
}

std::string section_bevel_csv(const bevel::TableSpec& spec, const bevel::SectionTable& table,
                              const std::vector<std::string>& columns, const Caption& caption) {
  return Csv(caption)
      .remark("b_sign: outer_edge_into_part")
      .table(bevel_columns(spec, table).only(columns))
      .print();
}

namespace {

constexpr std::string_view kTemplate = "Wrap template 1:1";

std::vector<double> girths(const std::vector<section::Station>& at, double girth) {
  std::vector<double> out;
  for (const auto& one : at) out.push_back(one.s);
  return closed(std::move(out), girth);
}

/// Marks the changes of partner, and tints the corners.
void tell_places(const section::Curve& outline, const std::vector<joint::SectionEvent>& events,
                 const Caption& caption, Chart& out) {
  for (int corner = 1; corner <= 4; ++corner)
    out.bands.push_back({.from = outline.on_corner(corner, 0.0),
                         .to = outline.on_corner(corner, 0.5 * kPi),
                         .label = "corner " + std::to_string(corner),
                         .color = "#a2998c"});
  for (const auto& event : events)
    if (event.from != event.to)
      out.marks.push_back({event.s, change_of_partner(caption, event.from, event.to)});
}

Chart profile_chart(const section::Section& section, const joint::SectionIntersection& cut,
                    const Caption& caption) {
  Chart out{.title = "The cut on both walls",
            .x_label = "girth of the surface, mm",
            .y_label = "z, mm",
            .series = {}};
  for (const auto& p : cut.profiles) {
    out.series.push_back({.name = p.outer ? "outer wall" : "inner wall",
                          .x = girths(p.at, p.girth),
                          .y = closed(p.z),
                          .color = p.outer ? "#2c6a9b" : "#6f8598"});
    if (p.outer) tell_places(section.outer(), p.events, caption, out);
  }
  return out;
}

std::vector<Chart> bevel_charts(const SectionCut& cut, const Caption& caption) {
  const auto& t = cut.table;
  const auto s = girths(t.at, t.girth);
  Chart b{.title = "Cutting angle B round the tube",
          .x_label = "girth, mm",
          .y_label = "B, °, outer edge into part",
          .series = {{.name = "as the groove requires",
                      .x = s,
                      .y = closed(in_degrees(t.b_raw)),
                      .color = "#a2998c",
                      .dashed = true},
                     {.name = "minimum that clears the partners",
                      .x = s,
                      .y = closed(in_degrees(t.b_required)),
                      .color = "#2c6a9b"},
                     {.name = "as the torch follows it",
                      .x = s,
                      .y = closed(in_degrees(t.b)),
                      .color = "#c2571a"}}};
  tell_places(cut.section.outer(), t.outer_events, caption, b);
  Chart edges{.title = "Finished edges",
              .x_label = "girth, mm",
              .y_label = "z, mm",
              .series = {{.name = "inner edge", .x = s, .y = closed(t.z_inner), .color = "#6f8598"},
                         {.name = "outer edge", .x = s, .y = closed(t.z_outer)}}};
  edges.bands = b.bands;
  return {std::move(b), std::move(edges)};
}

/// Prints the template, or the charts of another view.
template <class Charts>
std::string svg(const Development& development, Charts&& charts, const Caption& caption) {
  if (caption.view == "template") return print_svg(wrap_template(development, caption), kTemplate);
  refuse_paper(caption);
  return print_charts(charts(), caption);
}

}  // namespace

std::string section_svg(const section::Section& section, const joint::SectionIntersection& cut,
                        const Caption& caption) {
  return svg(
      developed(section, cut, BoreOn::outside),
      [&] { return std::vector{profile_chart(section, cut, caption)}; }, caption);
}

std::string section_pdf(const section::Section& section, const joint::SectionIntersection& cut,
                        const Caption& caption) {
  return print_pdf(wrap_template(developed(section, cut, BoreOn::outside), caption), kTemplate);
}

std::string section_dxf(const section::Section& section, const joint::SectionIntersection& cut,
                        const Caption& caption) {
  return print_dxf(developed(section, cut, BoreOn::bore), caption);
}

std::string section_bevel_svg(const SectionCut& cut, const Caption& caption) {
  return svg(
      developed(cut.section, cut.table, BoreOn::outside),
      [&] {
        auto charts = bevel_charts(cut, caption);
        if (caption.view == "b_curve") charts.pop_back();
        return charts;
      },
      caption);
}

std::string section_bevel_pdf(const SectionCut& cut, const Caption& caption) {
  return print_pdf(wrap_template(developed(cut.section, cut.table, BoreOn::outside), caption),
                   kTemplate);
}

std::string section_bevel_dxf(const SectionCut& cut, const Caption& caption) {
  return print_dxf(developed(cut.section, cut.table, BoreOn::bore), caption);
}

std::string section_bevel_stl(const SectionCut& cut, const Caption& caption) {
  const auto which = caption.view == "before" ? Smoothed::before : Smoothed::after;
  return print_stl(cut_solid(cut.section, cut.spec, cut.table, which), caption);
}

std::string section_bevel_gltf(const SectionCut& cut, const Caption& caption) {
  const auto of = [&](Smoothed which) {
    ColouredSolid out{cut_solid(cut.section, cut.spec, cut.table, which), {}};
    for (const auto& ring : out.solid.rings) {
      const auto &a = ring[out.solid.cut_points - 2], &b = ring[out.solid.cut_points - 1];
      const double across = (b - a).head<2>().norm();
      out.b_shares.push_back(elementary::atan2(b.z() - a.z(), across) / (60.0 * kRadPerDeg));
    }
    return out;
  };
  return print_gltf(of(Smoothed::before), of(Smoothed::after), caption);
}

void refuse_section_view(const Caption& caption) {
  if (caption.view == "section")
    throw UnfitOption{.name = "view",
                      .hint = "section requires a round target; use chart or template"};
}

std::string section_bevel_gcode(const SectionCut& cut, const Caption& caption) {
  return print_gcode(torch_job(cut.section, cut.spec, cut.table, caption), caption);
}

UnfitOption no_format_of_section(std::string_view offered) {
  return {.name = "format",
          .hint =
              "this format prints round targets only; a rectangular_tube or flat_oval_tube is "
              "printed as json, cbor, " +
              std::string(offered)};
}

}  // namespace tubecut::api
