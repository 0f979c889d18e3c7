#include "api/formats/drawing/order/work_order.hpp"

#include <algorithm>
#include <cmath>

#include "api/formats/drawing/order/order_blocks.hpp"
#include "api/formats/drawing/order/order_cutouts.hpp"
#include "api/formats/drawing/order/order_sheets.hpp"
#include "api/formats/drawing/order/order_tables.hpp"
#include "api/formats/drawing/part_development.hpp"
#include "api/formats/drawing/part_edges.hpp"
#include "api/formats/drawing/part_view.hpp"
#include "api/formats/numbers.hpp"

namespace tubecut::api {
namespace {

constexpr Lettering kGrey{.height = 2.2, .color = "#566370"};
constexpr double kLeft = OrderSheets::kLeft, kRight = OrderSheets::kRight,
                 kWide = OrderSheets::kWide;
std::vector<Fact> part_facts(const part::PartSpec& spec, const part::Part& part) {
  const auto& target = spec.target;
  const auto& l = part.lengths;
  return {{"tube", number(2.0 * target.outer_radius, Unit::mm) + " x " + mm(target.wall)},
          {"blank, with kerfs, clamping, facing", mm(l.blank)},
          {"tip to tip", mm(l.longest)},
          {"throat to throat", mm(l.shortest)},
          {"finish turned against start", degrees(part.clocking)},
          {"between work points", mm(l.work_point)},
          {"weld", mm(l.weld)},
          {"mass", measure(l.mass, Unit::kg)}};
}

std::string bevels_of(const part::PartSpec& spec, const part::Part& part) {
  std::vector<const std::vector<double>*> all{&part.start.table.b, &part.finish.table.b};
  for (const auto& placed : part.holes) all.push_back(&placed.hole.b);
  return bevel_range(all, spec.start.cut.torch);
}

/// Draws the view in the height that remains on the sheet.
void draw_view(OrderSheets& sheets, const part::PartSpec& spec, const part::Part& part,
               double others) {
  constexpr double kLeast = 50.0, kMost = 92.0;
  const double tall = std::clamp(sheets.left() - others, kLeast, kMost);
  const double top = sheets.take(tall);
  auto& canvas = sheets.canvas();
  draw_part_view(canvas, spec, part, {{kLeft, top - tall + 3.0}, {kRight, top - 2.0}});
  canvas.text({kLeft, top - tall + 1.6},
              "phi counts from the datum line, clockwise as seen from the start", kGrey);
}

/// Of sheet 1 below the view, where there is one strip.
double height_below(const DevelopmentPlan& plan, const part::PartSpec& spec,
                    const part::Part& part) {
  const auto count = [](std::size_t n) { return static_cast<double>(n); };
  const std::size_t partners = part.start.spec.partners.size() + part.finish.spec.partners.size();
  return plan.height() + 6.0 + 4.0 * std::ceil(count(partners) / 4.0) +
         (part.holes.empty() ? 0.0 : 10.0 + 6.4 * count(part.holes.size())) +
         (part.cutouts.empty() ? 0.0 : 10.0 + 6.4 * count(spec.cutouts.all.size())) + 12.0 +
         4.4 * std::ceil(count(step_texts(spec, part).size()) / 2.0);
}

}  // namespace

std::vector<Canvas> work_order(const part::PartSpec& spec, const part::Part& part,
                               const Caption& caption) {
  OrderSheets sheets("Work order", name_of_part(spec.name, caption), caption);
  draw_facts(sheets, order_facts(caption), 4);
  draw_members(sheets, caption);
  rule(sheets);
  draw_facts(sheets, part_facts(spec, part), 4);
  rule(sheets);
  draw_verdict(sheets, bevels_of(spec, part), caption);
  rule(sheets);
  const auto plan = plan_development(spec, part, kWide);
  draw_view(sheets, spec, part, height_below(plan, spec, part));
  for (std::size_t i = 0; i < plan.strips.size(); ++i) {
    const double top = sheets.take(plan.height());
    draw_strip(sheets.canvas(), plan, i, spec, part, {kLeft, top});
  }
  draw_partners(sheets, {part.start.spec.partners.size(), spec.start.welded},
                {part.finish.spec.partners.size(), spec.finish.welded}, caption);
  draw_holes(sheets, spec, part);
  draw_cutouts(sheets, spec, part);
  draw_steps(sheets, spec, part);
  draw_notches(sheets, spec, part, caption);
  draw_checks(sheets, part.check_dimensions);
  draw_sign_off(sheets, spec.start.cut.sampling, caption);
  return sheets.finished();
}

}  // namespace tubecut::api
