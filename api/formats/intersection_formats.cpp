#include "api/formats/intersection_formats.hpp"

#include <algorithm>

#include "api/formats/csv.hpp"
#include "api/formats/drawing/chart.hpp"
#include "api/formats/drawing/cut_sheets.hpp"
#include "api/formats/drawing/development.hpp"
#include "api/formats/drawing/partner_names.hpp"
#include "api/formats/dxf/dxf.hpp"
#include "api/wire/joint_names.hpp"
#include "api/wire/tables.hpp"

namespace tubecut::api {
namespace {

Chart profile_chart(const joint::Intersection& cut, const Caption& caption) {
  Chart out{
      .title = "The cut on both walls", .x_label = "phi, °", .y_label = "z, mm", .series = {}};
  for (const auto& p : cut.profiles) {
    Series s{.name = p.outer ? "outer wall" : "inner wall",
             .x = p.phi,
             .y = p.z,
             .color = p.outer ? "#2c6a9b" : "#6f8598"};
    for (auto& phi : s.x) phi *= kDegPerRad;
    s.x.push_back(s.x.front() + 360.0);  // closes at its start
    s.y.push_back(s.y.front());
    out.series.push_back(std::move(s));
    if (!p.outer) continue;
    for (const auto& event : p.events)
      out.marks.push_back(
          {event.phi * kDegPerRad, change_of_partner(caption, event.from, event.to)});
  }
  return out;
}

/// Returns the furthest height of the cut: on the outer wall, if it is given.
double long_point(const joint::Intersection& cut) {
  const auto* lead = &cut.profiles.front();
  for (const auto& p : cut.profiles)
    if (p.outer) lead = &p;
  return std::ranges::min(lead->z);
}

}  // namespace

std::string intersection_csv(const joint::IntersectionSpec& spec, const joint::Intersection& cut,
                             const Caption& caption) {
  std::vector<std::pair<std::string, Columns>> walls;
  const double tip = long_point(cut);
  for (const auto& p : cut.profiles) {
    std::vector<double> girth, drop;  // on the paper that is wrapped round the outside
    for (std::size_t i = 0; i < p.phi.size(); ++i) {
      girth.push_back(spec.target.outer_radius * p.phi[i]);
      drop.push_back(p.z[i] - tip);
    }
    walls.emplace_back(wall_name(p.outer), profile_columns(p, spec.sampling)
                                               .column("girth_mm", std::move(girth))
                                               .column("drop_mm", std::move(drop)));
  }
  return Csv(caption).stacked("surface", walls).print();
}

std::string intersection_svg(const joint::IntersectionSpec& spec, const joint::Intersection& cut,
                             const Caption& caption) {
  if (caption.view == "template" || caption.view == "section") return cut_svg(spec, cut, caption);
  refuse_paper(caption);
  return print_charts({profile_chart(cut, caption)}, caption);
}

std::string intersection_pdf(const joint::IntersectionSpec& spec, const joint::Intersection& cut,
                             const Caption& caption) {
  return cut_pdf(spec, cut, caption);
}

std::string intersection_dxf(const joint::IntersectionSpec& spec, const joint::Intersection& cut,
                             const Caption& caption) {
  return print_dxf(developed(spec, cut), caption);
}

}  // namespace tubecut::api
