#include "api/formats/section_part_formats.hpp"

#include <string>
#include <utility>
#include <vector>

#include "api/formats/bevel_table_formats.hpp"
#include "api/formats/csv.hpp"
#include "api/formats/drawing/development.hpp"
#include "api/formats/drawing/order/section_work_order.hpp"
#include "api/formats/drawing/part_edges.hpp"
#include "api/formats/drawing/pdf_sheets.hpp"
#include "api/formats/drawing/svg_sheets.hpp"
#include "api/formats/drawing/wrap_template.hpp"
#include "api/formats/dxf/dxf.hpp"
#include "api/formats/dxf/section_dstv.hpp"
#include "api/formats/gcode/gcode.hpp"
#include "api/formats/part_formats.hpp"
#include "api/wire/section_tables.hpp"

namespace tubecut::api {

std::string section_part_csv(const part::SectionPartSpec& spec, const part::SectionPart& part,
                             const Caption& caption) {
  if (caption.view == "check_dimensions")
    return Csv(caption).table(dimension_columns(part.check_dimensions)).print();
  NamedColumns cuts;
  for (const auto& mark : part.marks)
    if (mark.lettering) add_strokes(*mark.lettering, cuts);
  for (const auto& step : part.sequence)
    if (step.what == part::Step::What::cutout) {
      const auto& one = part.cutouts.instances[step.index];
      const auto rows = cutout::placed(part.cutouts, one);
      cuts.emplace_back("cut-out " + cutout_tag(part.cutouts, step.index),
                        part.cutouts.mould_of(one).laying.over() != nullptr
                            ? corner_cutout_columns(rows, spec.section)
                            : flat_cutout_columns(rows, spec.section));
    }
  cuts.emplace_back("finish", bevel_columns(part.finish.spec, part.finish.table));
  cuts.emplace_back("start", bevel_columns(part.start.spec, part.start.table));
  return Csv(caption)
      .remark(std::string("b_sign: ").append(kBSignInPart))
      .stacked("cut", cuts)
      .print();
}

namespace {

std::vector<Canvas> sheets(const part::SectionPartSpec& spec, const part::SectionPart& part,
                           const Caption& caption) {
  if (caption.view == "template")
    return wrap_template(developed(spec, part, BoreOn::outside), caption);
  refuse_options_of_template(caption);
  return section_work_order(spec, part, caption);
}

}  // namespace

std::string section_part_svg(const part::SectionPartSpec& spec, const part::SectionPart& part,
                             const Caption& caption) {
  return print_svg(sheets(spec, part, caption), title_of_part(caption));
}

std::string section_part_pdf(const part::SectionPartSpec& spec, const part::SectionPart& part,
                             const Caption& caption) {
  return print_pdf(sheets(spec, part, caption), title_of_part(caption));
}

std::string section_part_dxf(const part::SectionPartSpec& spec, const part::SectionPart& part,
                             const Caption& caption) {
  const auto development = developed(spec, part, BoreOn::bore);
  return print_dxf(development, development.marks, caption);
}

std::string section_part_dstv(const part::SectionPartSpec& spec, const part::SectionPart& part,
                              const Caption& caption) {
  return print_dstv(spec, part, caption);
}

std::string section_part_gcode(const part::SectionPartSpec& spec, const part::SectionPart& part,
                               const Caption& caption) {
  return print_gcode(torch_job(spec, part, caption), caption);
}

}  // namespace tubecut::api
