#include "api/formats/hole_formats.hpp"

#include <algorithm>

#include "api/formats/chart.hpp"
#include "api/formats/csv.hpp"
#include "api/formats/development.hpp"
#include "api/formats/dxf.hpp"
#include "api/formats/sections.hpp"
#include "api/formats/wrap_template.hpp"

namespace tubecut::api {
namespace {

/// The columns of all holes one below the other.
template <class Column>
std::vector<double> joined(const bevel::HoleCut& cut, Column column) {
  std::vector<double> out;
  for (const auto& hole : cut.holes) {
    const std::vector<double>& part = column(hole);
    out.insert(out.end(), part.begin(), part.end());
  }
  return out;
}

std::vector<double> closed(std::vector<double> values, double scale = 1.0) {
  for (auto& v : values) v *= scale;
  values.push_back(values.front());
  return values;
}

Chart edge_chart(const bevel::HoleSpec& spec, const bevel::Hole& hole) {
  const double ro = spec.chord.outer_radius;
  return {.title = hole.far ? "Far hole on the developed chord" : "Hole on the developed chord",
          .x_label = "around the chord's outer surface, mm",
          .y_label = "z, mm",
          .series = {{.name = "outer edge", .x = closed(hole.developed), .y = closed(hole.z)},
                     {.name = "inner edge",
                      .x = closed(hole.phi_inner, ro),
                      .y = closed(hole.z_inner),
                      .color = "#1e8449"},
                     {.name = "torch",
                      .x = closed(hole.torch_phi, ro),
                      .y = closed(hole.torch_z),
                      .color = "#c0392b",
                      .dashed = true}}};
}

Chart gap_chart(const bevel::Hole& hole) {
  auto phase = hole.branch_phi;
  for (auto& v : phase) v *= kDegPerRad;
  return {.title = hole.far ? "Gap to the branch, far side" : "Gap between the cut surfaces",
          .x_label = "phase on the branch, deg",
          .y_label = "gap, mm",
          .series = {{.name = "root", .x = phase, .y = hole.fit.root},
                     {.name = "other edge", .x = phase, .y = hole.fit.face, .color = "#1e8449"}},
          .y_from_zero = true};
}

}  // namespace

std::string hole_csv(const bevel::HoleSpec&, const bevel::HoleCut& cut, const Caption&) {
  using H = bevel::Hole;
  std::vector<std::string> side;
  for (const auto& hole : cut.holes)
    side.insert(side.end(), hole.phi.size(), hole.far ? "far" : "near");
  const auto all = [&](std::vector<double> H::*column) {
    return joined(cut, [column](const H& h) -> const std::vector<double>& { return h.*column; });
  };
  return Csv()
      .cells_column("side", std::move(side))
      .degrees("branch_phi_deg", all(&H::branch_phi))
      .column("length_mm", all(&H::length))
      .degrees("phi_deg", all(&H::phi))
      .column("z_mm", all(&H::z))
      .column("developed_mm", all(&H::developed))
      .degrees("phi_inner_deg", all(&H::phi_inner))
      .column("z_inner_mm", all(&H::z_inner))
      .degrees("dihedral_deg", all(&H::dihedral))
      .degrees("groove_deg", all(&H::groove))
      .degrees("b_deg", all(&H::b))
      .degrees("a_deg", all(&H::a))
      .column("beam_mm", all(&H::beam))
      .degrees("torch_phi_deg", all(&H::torch_phi))
      .column("torch_z_mm", all(&H::torch_z))
      .degrees("torch_phi_inner_deg", all(&H::torch_phi_inner))
      .column("torch_z_inner_mm", all(&H::torch_z_inner))
      .column("gap_root_mm",
              joined(cut, [](const H& h) -> const std::vector<double>& { return h.fit.root; }))
      .column("gap_face_mm",
              joined(cut, [](const H& h) -> const std::vector<double>& { return h.fit.face; }))
      .column("gap_least_mm",
              joined(cut, [](const H& h) -> const std::vector<double>& { return h.fit.least; }))
      .print();
}

std::string hole_svg(const bevel::HoleSpec& spec, const bevel::HoleCut& cut,
                     const Caption& caption) {
  if (caption.view == "template") return print_wrap_template(developed(spec, cut), caption);
  if (caption.view == "section") return print_sections(sections_of(spec, cut), caption);
  std::vector<Chart> charts;
  for (const auto& hole : cut.holes) {
    charts.push_back(edge_chart(spec, hole));
    charts.push_back(gap_chart(hole));
  }
  return print_charts(charts, job_line(caption));
}

std::string hole_dxf(const bevel::HoleSpec& spec, const bevel::HoleCut& cut,
                     const Caption& caption) {
  return print_dxf(developed(spec, cut), caption);
}

}  // namespace tubecut::api
