#include "api/formats/part_formats.hpp"

#include "api/formats/bevel_table_formats.hpp"
#include "api/formats/csv.hpp"
#include "api/formats/drawing/development.hpp"
#include "api/formats/drawing/order/work_order.hpp"
#include "api/formats/drawing/part_edges.hpp"
#include "api/formats/drawing/pdf_sheets.hpp"
#include "api/formats/drawing/svg_sheets.hpp"
#include "api/formats/drawing/wrap_template.hpp"
#include "api/formats/dxf/dstv.hpp"
#include "api/formats/dxf/dxf.hpp"
#include "api/formats/gcode/gcode.hpp"
#include "api/stop.hpp"
#include "api/wire/part_names.hpp"
#include "api/wire/tables.hpp"
#include "core/torch/marks.hpp"

namespace tubecut::api {
namespace {

/// The points of every cut, in the order of the sequence.
NamedColumns cuts(const part::PartSpec& spec, const part::Part& p) {
  NamedColumns out;
  for (const auto& step : p.sequence) {
    ask();
    if (step.what == part::Step::What::mark && p.marks[step.index].lettering)
      add_strokes(*p.marks[step.index].lettering, out);
    if (step.what == part::Step::What::hole) {
      const auto& placed = p.holes[step.index];
      out.emplace_back("hole " + std::to_string(step.index),
                       hole_columns(spec.holes[placed.asked].hole, placed.hole)
                           .append("fit_up_", fit_up_columns(placed.hole)));
    }
    if (step.what == part::Step::What::cutout)
      out.emplace_back("cut-out " + cutout_tag(p.cutouts, step.index),
                       cutout_columns(cutout::placed(p.cutouts, p.cutouts.instances[step.index])));
    const auto end = [&](const part::End& cut) {
      out.emplace_back(name_of(step.what), bevel_columns(cut.spec, cut.table));
    };
    if (step.what == part::Step::What::finish) end(p.finish);
    if (step.what == part::Step::What::start) end(p.start);
  }
  return out;
}

std::vector<Canvas> sheets(const part::PartSpec& spec, const part::Part& part,
                           const Caption& caption) {
  if (caption.view == "template") return wrap_template(developed(spec, part), caption);
  refuse_options_of_template(caption);
  return work_order(spec, part, caption);
}

}  // namespace

void add_strokes(const cutout::Lettering& text, NamedColumns& out) {
  for (std::size_t i = 0; i < text.strokes.size(); ++i) {
    std::vector<double> z, girth;
    for (const auto& p : text.strokes[i]) {
      z.push_back(p.x());
      girth.push_back(p.y());
    }
    out.emplace_back(torch::stroke_name(text, i),
                     Columns().column("z_mm", std::move(z)).column("girth_mm", std::move(girth)));
  }
}

Columns dimension_columns(const std::vector<part::CheckDimension>& dimensions) {
  std::vector<std::string> names, from, tools, changes;
  std::vector<double> values;
  for (const auto& d : dimensions) {
    names.push_back(d.name);
    values.push_back(d.value);
    tools.emplace_back(name_of(d.tool));
    from.push_back(d.measured_from);
    std::string with;
    for (const auto mistake : d.changes_with)
      with += (with.empty() ? "" : " ") + std::string(name_of(mistake));
    changes.push_back(std::move(with));
  }
  return Columns()
      .texts("name", std::move(names))
      .column("value_mm", std::move(values))
      .texts("tool", std::move(tools))
      .texts("measured_from", std::move(from))
      .texts("changes_with", std::move(changes));
}

std::string_view title_of_part(const Caption& caption) {
  return caption.view == "template" ? "Wrap template 1:1" : "Work order";
}

void refuse_options_of_template(const Caption& caption) {
  refuse_paper(caption);
  if (caption.options.mirror) throw UnfitOption{"mirror", "goes with view=template"};
}

std::string part_csv(const part::PartSpec& spec, const part::Part& part, const Caption& caption) {
  if (caption.view == "check_dimensions")
    return Csv(caption).table(dimension_columns(part.check_dimensions)).print();
  return Csv(caption)
      .remark(std::string("b_sign: ").append(kBSignInPart))
      .stacked("cut", cuts(spec, part))
      .print();
}

std::string part_svg(const part::PartSpec& spec, const part::Part& part, const Caption& caption) {
  return print_svg(sheets(spec, part, caption), title_of_part(caption));
}

std::string part_pdf(const part::PartSpec& spec, const part::Part& part, const Caption& caption) {
  return print_pdf(sheets(spec, part, caption), title_of_part(caption));
}

std::string part_dxf(const part::PartSpec& spec, const part::Part& part, const Caption& caption) {
  return print_dxf(developed(spec, part), part.marks, caption);
}

std::string part_dstv(const part::PartSpec& spec, const part::Part& part, const Caption& caption) {
  return print_dstv(spec, part, caption);
}

std::string part_gcode(const part::PartSpec& spec, const part::Part& part, const Caption& caption) {
  return print_gcode(torch_job(spec, part, caption), caption);
}

}  // namespace tubecut::api
