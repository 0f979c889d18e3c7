#include "api/formats/hole_formats.hpp"

#include <algorithm>

#include "api/formats/bevel_table_formats.hpp"
#include "api/formats/csv.hpp"
#include "api/formats/drawing/chart.hpp"
#include "api/formats/drawing/cut_sheets.hpp"
#include "api/formats/dxf/dxf.hpp"
#include "api/wire/tables.hpp"

namespace tubecut::api {
namespace {

std::vector<double> closed_ring(std::vector<double> values, double scale = 1.0) {
  for (auto& v : values) v *= scale;
  values.push_back(values.front());
  return values;
}

Chart edge_chart(const NamedHole& spec, const bevel::Hole& hole) {
  const double ro = spec.chord.outer_radius;
  return {
      .title = for_branch(hole.far ? "Far hole" : "Hole", spec.branch_name) +
               " on the developed chord" + (spec.chord_name.empty() ? "" : " " + spec.chord_name),
      .x_label = "around the chord's outer surface, mm",
      .y_label = "z, mm",
      .series = {{.name = "outer edge", .x = closed_ring(hole.developed), .y = closed_ring(hole.z)},
                 {.name = "inner edge",
                  .x = closed_ring(hole.phi_inner, ro),
                  .y = closed_ring(hole.z_inner),
                  .color = "#6f8598"},
                 {.name = "torch",
                  .x = closed_ring(hole.torch_phi, ro),
                  .y = closed_ring(hole.torch_z),
                  .color = "#c0392b",
                  .dashed = true}},
      .undistorted = true};
}

Chart gap_chart(const bevel::Hole& hole) {
  auto phase = hole.branch_phi;
  for (auto& v : phase) v *= kDegPerRad;
  phase.push_back(phase.front() + 360.0);
  return {.title = hole.far ? "Gap to the branch, far side" : "Gap between the cut surfaces",
          .x_label = "phase on the branch, °",
          .y_label = "gap, mm",
          .series = {{.name = "root", .x = phase, .y = closed_ring(hole.fit.root)},
                     {.name = "other edge",
                      .x = phase,
                      .y = closed_ring(hole.fit.face),
                      .color = "#c2571a"}},
          .y_from_zero = true};
}

}  // namespace

std::string hole_csv(const NamedHole& spec, const bevel::HoleCut& cut, const Caption& caption) {
  std::vector<std::pair<std::string, Columns>> sides;
  for (const auto& hole : cut.holes)
    sides.emplace_back(hole.far ? "far" : "near",
                       hole_columns(spec, hole).append("fit_up_", fit_up_columns(hole)));
  if (cut.branch) sides.emplace_back("branch", branch_columns(spec, *cut.branch));
  return Csv(caption).remark(std::string("b_sign: ") + kBSignInPart).stacked("side", sides).print();
}

std::string hole_svg(const NamedHole& spec, const bevel::HoleCut& cut, const Caption& caption) {
  if (caption.view == "template" || caption.view == "section") return cut_svg(spec, cut, caption);
  refuse_paper(caption);
  std::vector<Chart> charts;
  for (const auto& hole : cut.holes) {
    charts.push_back(edge_chart(spec, hole));
    charts.push_back(gap_chart(hole));
  }
  return print_charts(charts, caption);
}

std::string hole_pdf(const NamedHole& spec, const bevel::HoleCut& cut, const Caption& caption) {
  return cut_pdf(spec, cut, caption);
}

std::string hole_dxf(const NamedHole& spec, const bevel::HoleCut& cut, const Caption& caption) {
  return print_dxf(developed(spec, cut), caption);
}

}  // namespace tubecut::api
