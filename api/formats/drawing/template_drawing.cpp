#include "api/formats/drawing/template_drawing.hpp"

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
constexpr Stroke kCorner{.color = "none", .width = 0.0, .fill = "#f4f1ea"};
constexpr Stroke kGlue{.color = "#7a8794", .width = 0.2, .dashes = "1 1", .fill = "#f1f3f5"};

/// Returns the degrees between two marks of the phi scale, for a distance of at least 9 mm.
double scale_step(double radius) {
  for (const double step : {1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 45.0, 90.0})
    if (radius * step * kRadPerDeg >= 9.0) return step;
  return radius * kPi >= 9.0 ? 180.0 : 360.0;
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
    if (d_.section)
      seam_and_faces(*d_.section);
    else if (d_.around())
      seam_and_quarters();
    else
      generator_zero();
    datum();
    if (d_.section)
      girth_scale();
    else
      scale();
    out_.all.begin_clip({0.0, 0.0}, {field_.width(), field_.height()});
    for (std::size_t i = 0; i < d_.cuts.size(); ++i) outline(d_.cuts[i], i);
    for (const auto& mark : d_.marks) draw(mark);
    out_.all.end_group();
    return std::move(out_);
  }

 private:
  [[nodiscard]] DrawingPoint at(double x, double z) const { return field_.at(x, z); }
  [[nodiscard]] double x_of(double phi) const { return d_.outer_radius * phi; }
  void upright(double phi, const Stroke& stroke, std::string_view id = {}) {
    out_.all.line(at(x_of(phi), field_.z_from), at(x_of(phi), field_.z_datum), stroke, id);
  }

  void seam_and_tab() {
    const auto low = at(field_.x_to, field_.z_from), high = at(field_.x_to, field_.z_datum);
    const double out = caption_.options.mirror ? -field_.tab : field_.tab;
    out_.all.polyline({low, {low.x + out, low.y + 6.0}, {high.x + out, high.y - 6.0}, high}, kGlue,
                      "seam-tab", true);
    upright(0.0, kSeam, "seam-0");
    upright(kTwoPi, kSeam, "seam-360");
  }
  void seam_and_quarters() {
    seam_and_tab();
    for (int i = 1; i < 4; ++i) upright(0.25 * i * kTwoPi, kQuarter);
    constexpr double kAgain = 120.0;  // mm: a page of a long part labels its quarters
    for (double z = field_.z_from + 0.5 * kAgain; d_.whole && z < field_.z_datum; z += kAgain)
      for (int i = 0; i < 4; ++i) {
        const auto place = at(x_of(0.25 * i * kTwoPi), z);
        out_.all.text({place.x + 0.8, place.y}, degrees(0.25 * i * kTwoPi),
                      {.height = 2.4, .color = "#56626e"});
      }
    for (const double phi : d_.junctions) upright(phi, kJunction);
  }
  /// Draws the strips of the corners, to crease on the tube, and names the faces.
  void seam_and_faces(const section::Section& section) {
    const auto curve = section.outer();
    for (int corner = 1; corner <= 4; ++corner) {
      const double from = curve.on_corner(corner, 0.0), to = curve.on_corner(corner, 0.5 * kPi);
      out_.all.rectangle(at(from, field_.z_from), at(to, field_.z_datum), kCorner);
      for (const double s : {from, to})
        out_.all.line(at(s, field_.z_from), at(s, field_.z_datum), kQuarter);
    }
    seam_and_tab();
    const double girth = curve.girth(), half = 0.5 * curve.half_flat(1);
    name_face("1, up", half, 2.0 * half);
    name_face("1, up", girth - half, 2.0 * half);
    for (int face = 2; face <= 4; ++face)
      name_face(std::to_string(face), curve.on_face(face, 0.0), 2.0 * curve.half_flat(face));
    for (const double phi : d_.junctions) upright(phi, kJunction);
  }
  void name_face(const std::string& name, double s, double room) {
    const auto place = at(s, field_.z_datum);
    const std::string text = "face " + name;
    const Lettering l{.height = 2.4, .anchor = Anchor::middle, .color = "#56626e"};
    if (text_width(text, l.height) < room) out_.all.text({place.x, place.y - 4.0}, text, l);
  }
  void girth_scale() {
    const double girth = field_.x_to, step = girth > 400.0 ? 20.0 : 10.0;
    for (double s = 0.0; s <= girth; s += step) {
      const auto top = at(s, field_.z_datum);
      out_.all.line(top, {top.x, top.y + 2.0}, {.width = 0.2});
      const bool first = s == 0.0;
      out_.all.text({top.x, top.y + 3.0}, number(s, Unit::mm),
                    {.height = 2.4,
                     .anchor = !first                    ? Anchor::middle
                               : caption_.options.mirror ? Anchor::end
                                                         : Anchor::start});
    }
    way_round("girth, mm");
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
    way_round("phi, °");
  }
  /// Draws an arrow over the scale, its name behind its tail, or before its head if the tail is off
  /// the sheet.
  void way_round(std::string_view name) {
    constexpr double kHeight = 2.2;
    const double y = field_.height() + 7.2, middle = 0.5 * (field_.x_from + field_.x_to);
    const double reach = std::min(10.0, 0.3 * (field_.x_to - field_.x_from));
    const double tail = at(middle - reach, 0.0).x, tip = at(middle + reach, 0.0).x;
    draw_arrow(out_.all, {tail, y}, {tip, y}, {.color = "#56626e", .width = 0.2});
    const double back = tip > tail ? -1.0 : 1.0, width = text_width(name, kHeight) + 2.0;
    const bool room = tail + back * width >= 0.0 && tail + back * width <= field_.width();
    const double side = room ? back : -back;
    out_.all.text({(room ? tail : tip) + side, y - 0.8}, name,
                  {.height = kHeight,
                   .anchor = side < 0.0 ? Anchor::end : Anchor::start,
                   .color = "#56626e"});
  }

  void curve(const CylinderCurve& c, bool around, const Stroke& stroke, const std::string& id) {
    if (c.empty()) return;
    ask();
    bool again = false;
    for (auto& points : copies_on(field_, c, !around && d_.around())) {
      ask();
      out_.cuts.polyline(points, stroke, {}, !around);
      out_.all.polyline(std::move(points), stroke, again ? id + "-again" : id, !around);
      again = true;
    }
  }
  void outline(const CutOutline& cut, std::size_t i) {
    const auto number = i == 0 ? std::string{} : "-" + std::to_string(i + 1);
    if (!cut.sunk) curve(cut.inner, cut.around, kInnerEdge, "cut-inner" + number);
    curve(cut.torch, cut.around, kTorchLine, "torch" + number);
    if (!cut.sunk) curve(cut.outer, cut.around, kOuterEdge, "cut-outer" + number);
  }
  /// Draws the strokes of a text, again a turn on where it reaches beyond the seam.
  void draw(const cutout::Lettering& text) {
    for (const auto& stroke : text.strokes) {
      CylinderCurve curve{.radius = d_.outer_radius};
      for (const auto& p : stroke) {
        curve.phi.push_back(p.y() / d_.outer_radius);
        curve.z.push_back(p.x());
      }
      for (auto& points : copies_on(field_, curve, true))
        out_.all.polyline(std::move(points), kMark);
    }
  }
  void draw(const part::Mark& mark) {
    if (mark.kind == part::Mark::Kind::datum_line) return;
    if (mark.lettering) return draw(*mark.lettering);
    const double phi = mark.phi - kTwoPi * std::floor(mark.phi / kTwoPi);
    constexpr double kArm = 3.0;
    const auto from = at(x_of(phi), mark.z_from), to = at(x_of(phi), mark.z_to);
    out_.all.line({from.x, from.y - kArm}, {to.x, to.y + kArm}, kMark);
    out_.all.line({from.x - kArm, 0.5 * (from.y + to.y)}, {from.x + kArm, 0.5 * (from.y + to.y)},
                  kMark);
  }

  const Development& d_;
  const TemplateField& field_;
  const Caption& caption_;
  TemplateDrawing out_;
};

}  // namespace

std::vector<std::vector<DrawingPoint>> copies_on(const TemplateField& field,
                                                 const CylinderCurve& curve, bool repeated) {
  std::vector<std::vector<DrawingPoint>> out;
  for (const double turn : {0.0, kTwoPi, -kTwoPi}) {
    std::vector<DrawingPoint> points;
    bool inside = turn == 0.0;
    for (std::size_t i = 0; i < curve.phi.size(); ++i) {
      const double x = field.radius * (curve.phi[i] + turn);
      inside = inside || (x >= field.x_from && x <= field.x_to);
      points.push_back(field.at(x, curve.z[i]));
    }
    if (inside) out.push_back(std::move(points));
    if (!repeated) break;
  }
  return out;
}

namespace {

/// Rows of names that their stretches of an edge are too short for.
double name_rows(const Development& d, const Caption& c, bool finish) {
  const auto& names = finish ? c.finish_partners : c.partners;
  double rows = 0.0;
  for (const auto& span : d.spans)
    if (span.finish == finish && span.partner < names.size() &&
        text_width(names[span.partner], kLeastText) >
            d.outer_radius * (span.phi_to - span.phi_from) - 1.0)
      rows += 1.0;
  return std::min(rows, 12.0);
}

}  // namespace

TemplateField template_field(const Development& d, const Caption& caption) {
  constexpr double kBelow = 12.0, kAbove = 15.0, kRow = 3.2;  // SCRAP or KEEP, and a row of names
  const auto e = extent(d);
  const double room = d.around() ? 0.0 : 15.0;
  const auto down = [](double v) { return 10.0 * std::floor(v / 10.0); };
  return {.x_from = d.around() ? 0.0 : d.outer_radius * e.phi_from - room,
          .x_to = d.around() ? d.outer_radius * kTwoPi : d.outer_radius * e.phi_to + room,
          .z_from = down(e.z_from - kBelow - kRow * name_rows(d, caption, false)),
          .z_datum = -down(-e.z_to - kAbove - kRow * name_rows(d, caption, true)),
          .tab = d.around() ? kTab : 0.0,
          .radius = d.outer_radius,
          .mirrored = caption.options.mirror};
}

TemplateDrawing draw_template(const Development& development, const TemplateField& field,
                              const Caption& caption) {
  return Drawing(development, field, caption).drawn();
}

}  // namespace tubecut::api
