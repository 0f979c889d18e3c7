#include "api/formats/wrap_template.hpp"

#include <algorithm>
#include <cmath>

#include "api/formats/numbers.hpp"
#include "api/formats/sheet.hpp"
#include "api/formats/svg_sheets.hpp"
#include "api/verdict.hpp"
#include "api/words.hpp"

namespace tubecut::api {
namespace {

constexpr double kMargin = 12.0, kRuler = 100.0, kRulerRoom = 14.0;
constexpr double kLeastWidth = 190.0;  // of the sheet, so that the header fits
constexpr double kLine = 4.6;          // from one header line to the next
constexpr double kScaleRoom = 9.0;     // above the datum, for the phi scale

constexpr Stroke kOuterEdge{.color = "#1f5fbf", .width = 0.4};
constexpr Stroke kInnerEdge{.color = "#1e8449", .width = 0.3, .dashes = "4 2"};
constexpr Stroke kTorchLine{.color = "#c0392b", .width = 0.2, .dashes = "6 1.5 1 1.5"};
constexpr Stroke kSeam{.color = "#1d242b", .width = 0.35};
constexpr Stroke kQuarter{.color = "#7a8794", .width = 0.15, .dashes = "2 2"};

/// The part of the surface the template shows, mm on the developed outer surface.
struct Field {
  double x_from, x_to, z_from, z_datum;

  [[nodiscard]] double width() const { return x_to - x_from; }
  [[nodiscard]] double height() const { return z_datum - z_from; }
};

Field field_of(const Development& d) {
  const auto e = extent(d);
  const double room = d.around() ? 0.0 : 15.0;
  const auto down = [](double v) { return 10.0 * std::floor(v / 10.0); };
  return {.x_from = d.around() ? 0.0 : d.outer_radius * e.phi_from - room,
          .x_to = d.around() ? d.outer_radius * kTwoPi : d.outer_radius * e.phi_to + room,
          .z_from = down(e.z_from - 5.0),
          .z_datum = -down(-e.z_to - 15.0)};
}

/// Degrees between two marks of the phi scale, at least 9 mm apart.
double scale_step(double radius) {
  for (const double step : {1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 45.0, 90.0})
    if (radius * step * kRadPerDeg >= 9.0) return step;
  return 180.0;
}

std::vector<std::string> header(const Development& d, const Field& field, const Caption& c) {
  std::vector<std::string> lines{
      "Tube " + number(2.0 * d.outer_radius, Unit::mm) + " x " + mm(d.wall) + ", " +
          (d.around() ? "circumference " : "full circumference ") + mm(kTwoPi * d.outer_radius) +
          "; 1:1, wrap round the outside, " + (d.around() ? "kept side up" : "z upwards"),
      c.options.mirror ? "MIRRORED: print side towards the tube" : "print side out",
      "blue: outer edge; green dashed: inner edge, at its phi; red: torch line on the outer wall",
      "datum z = " + mm(field.z_datum) + " from the frame's origin"};
  for (const auto& [name, text] : c.reference)
    lines.push_back(called(name, Term::field) + ": " + text);
  lines.push_back(
      job_line({.reference = {}, .input_sha256 = c.input_sha256, .result_sha256 = {}, .view = {}}));
  return lines;
}

class Template {
 public:
  Template(const Development& d, const Caption& c)
      : d_(d),
        caption_(c),
        field_(field_of(d)),
        header_(header(d, field_, c)),
        verdict_(verdict_lines(c.verdict, {.warnings = 12, .plain = true})),
        canvas_(std::max(kLeastWidth, field_.width() + 2.0 * kMargin + kRulerRoom),
                2.0 * kMargin + kRulerRoom + std::max(field_.height(), kRuler) + kScaleRoom +
                    kLine * (static_cast<double>(header_.size() + verdict_.size()) + 1.0)) {}

  std::string print() {
    if (d_.around())
      seam_and_quarters();
    else
      generator_zero();
    datum();
    scale();
    for (std::size_t i = 0; i < d_.cuts.size(); ++i) outline(d_.cuts[i], i);
    words();
    draw_ruler(canvas_, {kMargin, kMargin + 2.0}, kRuler, false, "ruler-x");
    draw_ruler(canvas_, {kMargin + field_.width() + 9.0, kMargin + kRulerRoom}, kRuler, true,
               "ruler-y");
    return print_svg({canvas_}, "Wrap template 1:1");
  }

 private:
  [[nodiscard]] DrawingPoint at(double x, double z) const {
    const double along = caption_.options.mirror ? field_.x_to - x : x - field_.x_from;
    return {kMargin + along, kMargin + kRulerRoom + z - field_.z_from};
  }
  void upright(double phi, const Stroke& stroke, std::string_view id = {}) {
    const double x = d_.outer_radius * phi;
    canvas_.line(at(x, field_.z_from), at(x, field_.z_datum), stroke, id);
  }
  void seam_and_quarters() {
    upright(0.0, kSeam, "seam-0");
    upright(kTwoPi, kSeam, "seam-360");
    for (int i = 1; i < 4; ++i) upright(0.25 * i * kTwoPi, kQuarter);
    for (const double phi : d_.junctions)
      upright(phi, {.color = "#b9770e", .width = 0.15, .dashes = "1 2"});
  }
  void generator_zero() {
    for (const double phi : {-kTwoPi, 0.0, kTwoPi}) {
      const double x = d_.outer_radius * phi;
      if (x >= field_.x_from && x <= field_.x_to) upright(phi, kQuarter, "seam-0");
    }
  }
  void datum() {
    canvas_.line(at(field_.x_from, field_.z_datum), at(field_.x_to, field_.z_datum), kSeam,
                 "datum");
    if (field_.z_from < 0.0 && field_.z_datum > 0.0)
      canvas_.line(at(field_.x_from, 0.0), at(field_.x_to, 0.0), kQuarter, "origin");
  }
  void scale() {
    const double step = scale_step(d_.outer_radius), mm = d_.outer_radius * kRadPerDeg;
    const int first = static_cast<int>(std::ceil(field_.x_from / mm / step - 1e-9));
    const int last = static_cast<int>(std::floor(field_.x_to / mm / step + 1e-9));
    for (int i = first; i <= last; ++i) {
      const auto top = at(mm * step * i, field_.z_datum);
      canvas_.line(top, {top.x, top.y + 2.0}, {.width = 0.2});
      canvas_.text({top.x, top.y + 3.0}, number(step * i, Unit::deg),
                   {.height = 2.4, .anchor = Anchor::middle});
    }
    canvas_.text({kMargin, kMargin + kRulerRoom + field_.height() + 6.6}, "phi, °",
                 {.height = 2.2, .color = "#56626e"});
  }
  void curve(const CylinderCurve& c, const Stroke& stroke, const std::string& id) {
    if (c.empty()) return;
    std::vector<DrawingPoint> points;
    points.reserve(c.phi.size());
    for (std::size_t i = 0; i < c.phi.size(); ++i)
      points.push_back(at(d_.outer_radius * c.phi[i], c.z[i]));
    canvas_.polyline(std::move(points), stroke, id, !d_.around());
  }
  void outline(const CutOutline& cut, std::size_t i) {
    const auto number = i == 0 ? std::string{} : "-" + std::to_string(i + 1);
    curve(cut.inner, kInnerEdge, "cut-inner" + number);
    curve(cut.torch, kTorchLine, "torch" + number);
    curve(cut.outer, kOuterEdge, "cut-outer" + number);
  }
  void words() {
    double y = canvas_.height() - kMargin;
    canvas_.text({kMargin, y}, "Wrap template", {.height = 4.2, .bold = true});
    for (const auto& line : verdict_)
      canvas_.text({kMargin, y -= kLine}, line, verdict_lettering(caption_, 2.8));
    for (const auto& line : header_) canvas_.text({kMargin, y -= kLine}, line, {.height = 2.8});
    if (!d_.around() || field_.width() < 60.0) return;
    const auto corner = at(caption_.options.mirror ? field_.x_to : field_.x_from, field_.z_datum);
    std::string mark = "KEEP";
    for (const auto& [name, text] : caption_.reference)
      if (name == "part") mark = text + "  " + mark;
    const double fits = (field_.width() - 6.0) / (0.7 * static_cast<double>(mark.size()));
    canvas_.text({corner.x + 3.0, corner.y - 5.5}, mark,
                 {.height = std::min(4.0, fits), .bold = true});
  }

  const Development& d_;
  const Caption& caption_;
  Field field_;
  std::vector<std::string> header_, verdict_;
  Canvas canvas_;
};

}  // namespace

std::string print_wrap_template(const Development& development, const Caption& caption) {
  return Template(development, caption).print();
}

}  // namespace tubecut::api
