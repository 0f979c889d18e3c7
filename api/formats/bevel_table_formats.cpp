#include "api/formats/bevel_table_formats.hpp"

#include <algorithm>

#include "api/formats/csv.hpp"
#include "api/formats/drawing/chart.hpp"
#include "api/formats/drawing/cut_sheets.hpp"
#include "api/formats/drawing/development.hpp"
#include "api/formats/drawing/part_edges.hpp"
#include "api/formats/drawing/partner_names.hpp"
#include "api/formats/dxf/dstv.hpp"
#include "api/formats/dxf/dxf.hpp"
#include "api/formats/gcode/gcode.hpp"
#include "api/formats/mesh/cut_solid.hpp"
#include "api/formats/numbers.hpp"
#include "api/wire/motion_names.hpp"
#include "api/wire/tables.hpp"
#include "api/wire/words.hpp"

namespace tubecut::api {
namespace {

double root_radius(const bevel::TableSpec& spec) {
  return spec.root_surface == bevel::RootSurface::outer ? spec.target.outer_radius
                                                        : spec.target.inner_radius();
}

Chart bevel_chart(const bevel::TableSpec& spec, const bevel::Table& table, const Caption& caption) {
  const double rho = root_radius(spec);
  auto before = table.b_raw;
  if (spec.contact == bevel::Contact::inner || spec.contact == bevel::Contact::automatic)
    for (std::size_t i = 0; i < before.size(); ++i)
      before[i] = std::max(before[i], table.b_required[i]);
  Chart out{
      .title = "Cutting angle B before and after smoothing",
      .x_label = "developed length, mm",
      .y_label = "B, °, " + called(name_of_b_sign(table), Term::value),
      .series = {
          {.name = "before",
           .x = table.developed,
           .y = in_degrees(std::move(before)),
           .color = "#a2998c",
           .dashed = true},
          {.name = "after", .x = table.developed, .y = in_degrees(table.b), .color = "#c2571a"}}};
  for (const auto& binding : table.torch_binds)
    out.bands.push_back({rho * binding.from, rho * binding.to, "torch range binds"});
  const auto& events =
      spec.root_surface == bevel::RootSurface::outer ? table.outer_events : table.inner_events;
  for (const auto& event : events)
    out.marks.push_back({rho * event.phi, change_of_partner(caption, event.from, event.to)});
  return out;
}

/// Stretches of one partner after another, to the end of the turn.
std::vector<Band> partner_bands(const bevel::Table& table, const Caption& caption) {
  std::vector<Band> out;
  const auto phi = closed(in_degrees(table.phi), 360.0);
  for (std::size_t i = 0; i < table.cutter.size(); ++i) {
    const auto partner = table.cutter[i];
    if (i == 0 || partner != table.cutter[i - 1])
      out.push_back({.from = phi[i],
                     .label = partner < caption.partners.size() ? caption.partners[partner]
                                                                : std::to_string(partner + 1),
                     .color = std::string(partner_color(partner)),
                     .ribbon = true});
    out.back().to = phi[i + 1];
  }
  return out;
}

/// Returns the torch limits to draw: the nearer one, and both if the curves pass zero.
std::vector<Limit> torch_limits(const bevel::TableSpec& spec, const bevel::Table& table) {
  const auto [low, high] = std::ranges::minmax(table.b);
  const double least = spec.torch.min.rad(), most = spec.torch.max.rad();
  const bool both = low < 0.0 && high > 0.0, upper = most - high <= low - least;
  std::vector<Limit> out;
  if (both || !upper) out.push_back({least * kDegPerRad, "torch limit " + degrees(least)});
  if (both || upper) out.push_back({most * kDegPerRad, "torch limit " + degrees(most)});
  return out;
}

/// Returns the source's own picture, over phi: the B that the groove requires, the B that clears
/// the partners, the B that is cut; the partner of each segment, and the jumps of B.
Chart b_curve(const bevel::TableSpec& spec, const bevel::Table& table, const Caption& caption) {
  const auto phi = closed(in_degrees(table.phi), 360.0);
  const auto curve = [&](const char* name, const std::vector<double>& b, const char* color,
                         bool dashed = false) {
    return Series{
        .name = name, .x = phi, .y = closed(in_degrees(b)), .color = color, .dashed = dashed};
  };
  Chart out{.title = "Cutting angle B round the tube",
            .x_label = "phi, °",
            .y_label = "B, °, " + called(name_of_b_sign(table), Term::value),
            .series = {curve("as the groove requires", table.b_raw, "#a2998c", true),
                       curve("minimum that clears the partners", table.b_required, "#2c6a9b"),
                       curve("as the torch follows it", table.b, "#c2571a")},
            .bands = partner_bands(table, caption),
            .limits = torch_limits(spec, table)};
  for (const auto& [at, step] : table.mutations)
    out.marks.push_back({at * kDegPerRad, "jump of " + degrees(step)});
  return out;
}

Chart edge_chart(const bevel::Table& table) {
  const auto phi = closed(in_degrees(table.phi), 360.0);
  return {
      .title = "Finished edges",
      .x_label = "phi, °",
      .y_label = "z, mm",
      .series = {{.name = "inner edge", .x = phi, .y = closed(table.z_inner), .color = "#6f8598"},
                 {.name = "outer edge", .x = phi, .y = closed(table.z_outer)}}};
}

/// Stretches of one zone after another, with their names.
std::vector<Band> zone_bands(const bevel::ZonedGroove& zoned, const bevel::Table& table) {
  static constexpr const char* kColors[] = {"#2471a3", "#b9770e"};
  std::vector<Band> out;
  for (std::size_t i = 0; i < table.zone.size(); ++i) {
    if (i > 0) out.back().to = table.developed[i];
    if (i == 0 || table.zone[i] != table.zone[i - 1])
      out.push_back({table.developed[i], table.developed[i], zoned.zones[table.zone[i]].id,
                     kColors[out.size() % 2]});
  }
  if (!out.empty()) out.back().to = table.developed.back();
  return out;
}

Chart zone_chart(const bevel::ZonedGroove& zoned, const bevel::Table& table) {
  Chart out{.title = "Zones: dihedral and groove angle",
            .x_label = "developed length, mm",
            .y_label = "angle, °",
            .series = {{.name = "dihedral", .x = table.developed, .y = in_degrees(table.dihedral)},
                       {.name = "groove",
                        .x = table.developed,
                        .y = in_degrees(table.groove),
                        .color = "#c2571a"}}};
  out.bands = zone_bands(zoned, table);
  return out;
}

}  // namespace

std::string_view name_of_b_sign(const bevel::Table& table) {
  return name_of(table.inward ? BSign::inward : BSign::outer_edge_into_part);
}

std::vector<bool> corners(const bevel::TableSpec& spec, const bevel::Table& table) {
  if (!spec.sampling.tolerance) return std::vector<bool>(table.phi.size(), false);
  return torch::corner_rows(table);
}

std::string bevel_table_csv(const bevel::TableSpec& spec, const bevel::Table& table,
                            const std::vector<std::string>& columns, const Caption& caption) {
  return Csv(caption)
      .remark("b_sign: " + std::string(name_of_b_sign(table)))
      .table(bevel_columns(spec, table).only(columns))
      .print();
}

std::string bevel_table_svg(const bevel::TableSpec& spec, const bevel::Table& table,
                            const Caption& caption) {
  if (caption.view == "template" || caption.view == "section") return cut_svg(spec, table, caption);
  refuse_paper(caption);
  if (caption.view == "b_curve") return print_charts({b_curve(spec, table, caption)}, caption);
  std::vector<Chart> charts{bevel_chart(spec, table, caption), edge_chart(table)};
  if (const auto* zoned = std::get_if<bevel::ZonedGroove>(&spec.groove))
    charts.push_back(zone_chart(*zoned, table));
  return print_charts(charts, caption);
}

std::string bevel_table_pdf(const bevel::TableSpec& spec, const bevel::Table& table,
                            const Caption& caption) {
  return cut_pdf(spec, table, caption);
}

std::string bevel_table_dxf(const bevel::TableSpec& spec, const bevel::Table& table,
                            const Caption& caption) {
  return print_dxf(developed(spec, table), caption);
}

std::string bevel_table_gltf(const bevel::TableSpec& spec, const bevel::Table& table,
                             const Caption& caption) {
  return print_cut_gltf(spec, table, caption);
}

std::string bevel_table_stl(const bevel::TableSpec& spec, const bevel::Table& table,
                            const Caption& caption) {
  return print_cut_stl(spec, table, caption);
}

std::string bevel_table_dstv(const bevel::TableSpec& spec, const bevel::Table& table,
                             const Caption& caption) {
  return print_dstv(spec, table, caption);
}

std::string bevel_table_gcode(const bevel::TableSpec& spec, const bevel::Table& table,
                              const Caption& caption) {
  return print_gcode(torch_job(spec, table, caption), caption);
}

}  // namespace tubecut::api
