#include "api/formats/drawing/order/order_cutouts.hpp"

#include <algorithm>
#include <functional>
#include <set>
#include <utility>
#include <vector>

#include "api/formats/drawing/order/order_blocks.hpp"
#include "api/formats/drawing/part_edges.hpp"
#include "api/formats/numbers.hpp"

namespace tubecut::api {
namespace {

/// "circle 14", "slot 40 x 12 at 90°".
std::string in_words(const cutout::Spec& spec) {
  const auto mm = [](double value) { return number(value, Unit::mm); };
  std::string out = "contour";
  if (const auto* c = std::get_if<cutout::Circle>(&spec.shape)) return "circle " + mm(c->diameter);
  if (const auto* s = std::get_if<cutout::Slot>(&spec.shape))
    out = "slot " + mm(s->length) + " x " + mm(s->width);
  if (const auto* s = std::get_if<cutout::Slit>(&spec.shape))
    out = "slit " + mm(s->length) + ", one kerf wide";
  if (const auto* r = std::get_if<cutout::Rectangle>(&spec.shape))
    out = "window " + mm(r->along) + " x " + mm(r->round) + ", R " + mm(r->radius);
  return spec.turn == 0.0 ? out : out + " at " + degrees(spec.turn);
}

/// "sunk to 16 at 90°, 3.5 deep".
std::string in_words(const cutout::Cone& cone) {
  return "sunk to " + number(cone.diameter, Unit::mm) + " at " + degrees(2.0 * cone.half) + ", " +
         number(cone.depth(), Unit::mm) + " deep";
}

std::string in_words(cutout::Lay lay) {
  switch (lay) {
    case cutout::Lay::developed:
      return "size on the outside";
    case cutout::Lay::prism:
      return "straight through";
    case cutout::Lay::bored:
      return "size on the bore";
    case cutout::Lay::flat:
      return "square to the face";
  }
  return {};
}

/// `way` states a step round the tube.
using WayText = std::function<std::string(double turn)>;
std::string in_words(const cutout::Pattern& pattern, const WayText& way) {
  const auto steps = [&](double along, double turn) {
    return (along != 0.0 ? number(along, Unit::mm) : "") +
           (along != 0.0 && turn != 0.0 ? ", " : "") + (turn != 0.0 ? way(turn) : "");
  };
  if (const auto* l = std::get_if<cutout::Linear>(&pattern))
    return std::to_string(l->count) + " by " + steps(l->pitch, l->turn);
  if (const auto* r = std::get_if<cutout::Round>(&pattern))
    return std::to_string(r->count) + " by " + way(r->turn);
  if (const auto* g = std::get_if<cutout::Grid>(&pattern))
    return std::to_string(g->along) + " by " + number(g->pitch, Unit::mm) + ", " +
           std::to_string(g->round) + " by " + way(g->turn) +
           (g->stagger == cutout::Grid::Stagger::none ? "" : ", staggered");
  if (const auto* f = std::get_if<cutout::Faces>(&pattern)) {
    std::string out = "faces";
    for (const int face : f->faces) out += " " + std::to_string(face);
    const auto each =
        std::visit([&](const auto& one) { return in_words(cutout::Pattern(one), way); }, f->each);
    return each == "one" ? out : out + ", " + each;
  }
  return "one";
}

}  // namespace

namespace {

/// `position` states where an instance lies round the tube.
template <class PositionText, class WayOnSide>
void draw_cutout_rows(OrderSheets& sheets, const std::vector<cutout::Spec>& specs,
                      const cutout::Layout& layout, double longest, const PositionText& position,
                      const WayOnSide& way) {
  if (layout.empty()) return;
  constexpr double kRow = 6.4;
  draw_head(sheets, "Cut-outs: anchor of the first of each, outside, in mm",
            {{0.0, "cut-out"},
             {22.0, "size"},
             {66.0, "from the long points"},
             {100.0, "round"},
             {116.0, "repeated"},
             {162.0, "measured"}},
            2.0 * kRow);
  std::set<std::pair<std::size_t, std::size_t>> drawn;
  for (const auto& one : layout.instances) {
    if (!drawn.emplace(one.asked, one.mould).second) continue;
    const auto& mould = layout.mould_of(one);
    const auto& asked = specs[one.asked];
    const double top = sheets.take(kRow);
    auto& canvas = sheets.canvas();
    const auto put = [&](double x, double y, const std::string& text, double room,
                         bool bold = false) {
      canvas.label({OrderSheets::kLeft + x, top - y}, text, {.height = 2.3, .bold = bold}, room);
    };
    put(0.0, 2.9, asked.id + (mould.laying.far() ? ", far" : ""), 21.0, true);
    put(0.0, 5.7, mould.cone ? "after its circle" : in_words(mould.laying.lay()), 64.0);
    put(22.0, 2.9, mould.cone ? in_words(*mould.cone) : in_words(asked), 43.0);
    put(66.0, 2.9, number(one.z, Unit::mm) + "; " + number(longest - one.z, Unit::mm), 33.0);
    put(100.0, 2.9, position(one), 15.0);
    const bool far = mould.laying.far();
    put(116.0, 2.9, in_words(asked.pattern, [&](double turn) { return way(turn, far); }), 45.0);
    draw_box(canvas, top, kRow);
    draw_row_line(canvas, top - kRow);
  }
}

}  // namespace

void draw_cutouts(OrderSheets& sheets, const part::PartSpec& spec, const part::Part& part) {
  draw_cutout_rows(
      sheets, spec.cutouts.all, part.cutouts, part.lengths.longest,
      [&](const cutout::Instance& one) {
        const auto& laying = part.cutouts.mould_of(one).laying;
        const double middle = turned_from(0.0, one.phi + laying.phase(0.0));
        return number(spec.target.outer_radius * middle, Unit::mm);
      },
      [](double turn, bool) { return degrees(turn); });
}

void draw_cutouts(OrderSheets& sheets, const part::SectionPartSpec& spec,
                  const part::SectionPart& part) {
  draw_cutout_rows(
      sheets, spec.cutouts.all, part.cutouts, part.lengths.longest,
      [&](const cutout::Instance& one) {
        return (part.cutouts.mould_of(one).laying.over() != nullptr ? "over corner, face "
                                                                    : "face ") +
               std::to_string(one.face) +
               (one.offset == 0.0 ? "" : ", " + number(one.offset, Unit::mm));
      },
      // The girth of the opposite face grows the other way across.
      [girth = spec.section.outer().girth()](double turn, bool far) {
        return number((far ? 0.0 - turn : turn) / kTwoPi * girth, Unit::mm) + " across";
      });
}

std::optional<CutoutRun> cutout_run(const std::vector<part::Step>& all, std::size_t first,
                                    const part::CutoutSpecs& specs, const cutout::Layout& layout) {
  constexpr std::size_t kLeast = 3;
  const auto asked = [&](const part::Step& step) { return layout.instances[step.index].asked; };
  const auto is_cutout = [](const part::Step& step) {
    return step.what == part::Step::What::cutout;
  };
  auto last = first;
  while (last < all.size() && is_cutout(all[last]) && asked(all[last]) == asked(all[first])) ++last;
  if (last - first < kLeast) return {};
  double from = all[first].z_from, to = all[first].z_to;
  for (auto i = first; i < last; ++i) {
    from = std::min(from, all[i].z_from);
    to = std::max(to, all[i].z_to);
  }
  return CutoutRun{
      "cut " + std::to_string(last - first) + " of " + specs.all[asked(all[first])].id + ", " +
          cutout_tag(layout, all[first].index) + " to " + cutout_tag(layout, all[last - 1].index) +
          ", from " + number(from, Unit::mm) + " to " + number(to, Unit::mm),
      last - first};
}

}  // namespace tubecut::api
