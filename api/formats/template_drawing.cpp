#include "api/formats/template_drawing.hpp"

#include <algorithm>
#include <cmath>

#include "api/formats/numbers.hpp"
#include "api/stop.hpp"
#include "core/base/angle.hpp"

namespace tubecut::api {
namespace {

constexpr double kTab = 12.0;  // mm

constexpr Stroke kOuterEdge{.color = "#1f5fbf", .width = 0.4};
constexpr Stroke kInnerEdge{.color = "#1e8449", .width = 0.3, .dashes = "4 2"};
constexpr Stroke kTorchLine{.color = "#c0392b", .width = 0.2, .dashes = "6 1.5 1 1.5"};
constexpr Stroke kSeam{.color = "#1d242b", .width = 0.35};
constexpr Stroke kQuarter{.color = "#7a8794", .width = 0.15, .dashes = "2 2"};
constexpr Stroke kJunction{.color = "#b9770e", .width = 0.15, .dashes = "1 2"};
constexpr Stroke kMark{.color = "#2b6ca3", .width = 0.3};
constexpr Stroke kGlue{.color = "#7a8794", .width = 0.2, .dashes = "1 1", .fill = "#f1f3f5"};

/// Degrees between two marks of the phi scale, at least 9 mm apart.
double scale_step(double radius) {
  for (const double step : {1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 45.0, 90.0})
    if (radius * step * kRadPerDeg >= 9.0) return step;
  return 180.0;
}

class Drawing {
 public:
  Drawing(const Development& d, const TemplateField& field, const Caption& caption)
      : d_(d),
        field_(field),
        caption_(caption),
        out_{{field.width(), field.height() + kScaleRoom},
             {field.width(), field.height() + kScaleRoom}} {}

  TemplateDrawing drawn() {
    if (d_.around())
      seam_and_quarters();
    else
      generator_zero();
    datum();
    scale();
    out_.all.begin_clip({0.0, 0.0}, {field_.width(), field_.height()});
    for (std::size_t i = 0; i < d_.cuts.size(); ++i) outline(d_.cuts[i], i);
    for (const auto& span : d_.spans) partner(span);
    for (const auto& mark : d_.marks) draw(mark);
    for (const auto& cut : d_.cuts)
      if (!cut.around) label(cut);
    out_.all.end_group();
    return std::move(out_);
  }

 private:
  [[nodiscard]] DrawingPoint at(double x, double z) const {
    const double along = caption_.options.mirror ? field_.tab + field_.x_to - x : x - field_.x_from;
    return {along, z - field_.z_from};
  }
  [[nodiscard]] double x_of(double phi) const { return d_.outer_radius * phi; }
  void upright(double phi, const Stroke& stroke, std::string_view id = {}) {
    out_.all.line(at(x_of(phi), field_.z_from), at(x_of(phi), field_.z_datum), stroke, id);
  }

  void seam_and_quarters() {
    const auto low = at(field_.x_to, field_.z_from), high = at(field_.x_to, field_.z_datum);
    const double out = caption_.options.mirror ? -field_.tab : field_.tab;
    out_.all.polyline({low, {low.x + out, low.y + 6.0}, {high.x + out, high.y - 6.0}, high}, kGlue,
                      "seam-tab", true);
    out_.all.text({low.x + 0.5 * out + 0.8, 0.5 * (low.y + high.y)}, "glue below phi 0",
                  {.height = 2.4, .anchor = Anchor::middle, .turn = 90.0, .color = "#56626e"});
    upright(0.0, kSeam, "seam-0");
    upright(kTwoPi, kSeam, "seam-360");
    for (int i = 1; i < 4; ++i) upright(0.25 * i * kTwoPi, kQuarter);
    constexpr double kAgain = 120.0;  // mm: a page of a long part tells its quarters
    for (double z = field_.z_from + 0.5 * kAgain; d_.whole && z < field_.z_datum; z += kAgain)
      for (int i = 0; i < 4; ++i) {
        const auto place = at(x_of(0.25 * i * kTwoPi), z);
        out_.all.text({place.x + 0.8, place.y}, degrees(0.25 * i * kTwoPi),
                      {.height = 2.4, .color = "#56626e"});
      }
    for (const double phi : d_.junctions) upright(phi, kJunction);
  }
  void generator_zero() {
    for (const double phi : {-kTwoPi, 0.0, kTwoPi})
      if (x_of(phi) >= field_.x_from && x_of(phi) <= field_.x_to) upright(phi, kQuarter, "seam-0");
  }
  void datum() {
    out_.all.line(at(field_.x_from, field_.z_datum), at(field_.x_to, field_.z_datum), kSeam,
                  "datum");
    if (field_.z_from < 0.0 && field_.z_datum > 0.0)
      out_.all.line(at(field_.x_from, 0.0), at(field_.x_to, 0.0), kQuarter, "origin");
  }
  void scale() {
    const double step = scale_step(d_.outer_radius), mm_deg = d_.outer_radius * kRadPerDeg;
    const int first = static_cast<int>(std::ceil(field_.x_from / mm_deg / step - 1e-9));
    const int last = static_cast<int>(std::floor(field_.x_to / mm_deg / step + 1e-9));
    for (int i = first; i <= last; ++i) {
      const auto top = at(mm_deg * step * i, field_.z_datum);
      out_.all.line(top, {top.x, top.y + 2.0}, {.width = 0.2});
      auto anchor = i == first ? Anchor::start : i == last ? Anchor::end : Anchor::middle;
      if (caption_.options.mirror && anchor != Anchor::middle)
        anchor = anchor == Anchor::start ? Anchor::end : Anchor::start;
      out_.all.text({top.x, top.y + 3.0}, number(step * i, Unit::deg),
                    {.height = 2.4, .anchor = anchor});
    }
    const double y = field_.height() + 7.2, middle = 0.5 * (field_.x_from + field_.x_to);
    const double reach = std::min(10.0, 0.3 * (field_.x_to - field_.x_from));
    draw_arrow(out_.all, {at(middle - reach, 0.0).x, y}, {at(middle + reach, 0.0).x, y},
               {.color = "#56626e", .width = 0.2});
    const auto tail = at(middle - reach, 0.0).x;
    const bool mirrored = caption_.options.mirror;
    out_.all.text(
        {tail + (mirrored ? 1.0 : -1.0), y - 0.8}, "phi, °",
        {.height = 2.2, .anchor = mirrored ? Anchor::start : Anchor::end, .color = "#56626e"});
  }

  void curve(const CylinderCurve& c, bool around, const Stroke& stroke, const std::string& id) {
    if (c.empty()) return;
    for (const double turn : {0.0, kTwoPi, -kTwoPi}) {
      ask(caption_.stop);
      std::vector<DrawingPoint> points;
      bool inside = false;
      for (std::size_t i = 0; i < c.phi.size(); ++i) {
        const double x = x_of(c.phi[i] + turn);
        inside = inside || (x >= field_.x_from && x <= field_.x_to);
        points.push_back(at(x, c.z[i]));
      }
      const bool again = turn != 0.0;
      if (again && (around || !inside || !d_.around())) continue;
      out_.cuts.polyline(points, stroke, {}, !around);
      out_.all.polyline(std::move(points), stroke, again ? id + "-again" : id, !around);
    }
  }
  void outline(const CutOutline& cut, std::size_t i) {
    const auto number = i == 0 ? std::string{} : "-" + std::to_string(i + 1);
    curve(cut.inner, cut.around, kInnerEdge, "cut-inner" + number);
    curve(cut.torch, cut.around, kTorchLine, "torch" + number);
    curve(cut.outer, cut.around, kOuterEdge, "cut-outer" + number);
  }
  /// Beside its stretch of the edge, on the side of the scrap.
  void partner(const PartnerSpan& span) {
    const auto& names = span.finish ? caption_.finish_partners : caption_.partners;
    if (span.partner >= names.size()) return;
    const auto& name = names[span.partner];
    const double room = d_.outer_radius * (span.phi_to - span.phi_from) - 1.0;
    if (room < 4.0) return;
    const auto l =
        fitted(name, {.height = 2.8, .anchor = Anchor::middle, .color = "#38424d"}, room);
    const auto place = at(x_of(0.5 * (span.phi_from + span.phi_to)), span.z);
    const double off = span.finish ? 1.5 : -1.5 - l.height;
    out_.all.text({place.x, std::clamp(place.y + off, 0.5, field_.height() - 3.0)}, name, l);
  }
  void draw(const part::Mark& mark) {
    if (mark.kind == part::Mark::Kind::datum_line) return;
    const double phi = mark.phi - kTwoPi * std::floor(mark.phi / kTwoPi);
    constexpr double kArm = 3.0;
    const auto from = at(x_of(phi), mark.z_from), to = at(x_of(phi), mark.z_to);
    out_.all.line({from.x, from.y - kArm}, {to.x, to.y + kArm}, kMark);
    out_.all.line({from.x - kArm, 0.5 * (from.y + to.y)}, {from.x + kArm, 0.5 * (from.y + to.y)},
                  kMark);
    const bool right = from.x > 0.5 * field_.width();
    out_.all.text(
        {from.x + (right ? -1.0 : 1.0), from.y - 4.2}, mark.text,
        fitted(mark.text,
               {.height = 2.8, .anchor = right ? Anchor::end : Anchor::start, .color = kMark.color},
               0.5 * field_.width()));
  }

  /// Whole on the sheet, where the hole lies across the seam too.
  void label(const CutOutline& hole) {
    const auto [phi, z, room] = label_place(hole);
    const double here = d_.around() ? phi - kTwoPi * std::floor(phi / kTwoPi) : phi;
    const auto l =
        fitted(hole.label,
               {.height = 2.8, .anchor = Anchor::middle, .bold = true, .color = "#38424d"}, room);
    const double half = 0.5 * text_width(hole.label, l.height, true) + 1.0;
    const double x = std::min(std::max(x_of(here), field_.x_from + half), field_.x_to - half);
    out_.all.text(at(x, z), hole.label, l);
  }

  const Development& d_;
  const TemplateField& field_;
  const Caption& caption_;
  TemplateDrawing out_;
};

}  // namespace

TemplateField template_field(const Development& d) {
  const auto e = extent(d);
  const double room = d.around() ? 0.0 : 15.0;
  const auto down = [](double v) { return 10.0 * std::floor(v / 10.0); };
  return {.x_from = d.around() ? 0.0 : d.outer_radius * e.phi_from - room,
          .x_to = d.around() ? d.outer_radius * kTwoPi : d.outer_radius * e.phi_to + room,
          .z_from = down(e.z_from - 5.0),
          .z_datum = -down(-e.z_to - 15.0),
          .tab = d.around() ? kTab : 0.0};
}

TemplateDrawing draw_template(const Development& development, const TemplateField& field,
                              const Caption& caption) {
  return Drawing(development, field, caption).drawn();
}

}  // namespace tubecut::api
