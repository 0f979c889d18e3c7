#include "api/formats/work_order.hpp"

#include <algorithm>
#include <cmath>

#include "api/formats/part_formats.hpp"
#include "api/formats/sheet.hpp"
#include "api/formats/text.hpp"
#include "api/wire_names.hpp"

namespace tubecut::api {
namespace {

constexpr double kPad = 4.0, kDevelopment = 78.0, kCheckRow = 8.0, kStepRow = 4.2;
constexpr Stroke kCut{.width = 0.35};
constexpr Stroke kInner{.width = 0.2, .dashes = "1.6 1"};
constexpr Stroke kDatum{.color = "#7a8794", .width = 0.18, .dashes = "4 1 0.8 1"};
constexpr Stroke kLine{.color = "#7a8794", .width = 0.18};
constexpr Lettering kHead{.height = 3.4, .bold = true};
constexpr Lettering kSmall{.height = 2.3};
constexpr Lettering kGrey{.height = 2.1, .color = "#566370"};

/// The outside laid flat as it is seen from outside: z to the right, hence phi downwards (x, y, z
/// is right-handed), each with its own scale, for a long tube is thin.
class Development {
 public:
  Development(Canvas& canvas, const part::PartSpec& spec, const part::Part& part, Cell room)
      : canvas_(canvas), spec_(spec), part_(part) {
    const double girth = kTwoPi * spec.target.outer_radius;
    double high = 0.0;
    for (const auto* z : {&part.start.table.z_outer, &part.start.table.z_inner,
                          &part.finish.table.z_outer, &part.finish.table.z_inner})
      for (const double one : *z) {
        low_ = std::min(low_, one);
        high = std::max(high, one);
      }
    const double wide = room.high.x - room.low.x - 2.0 * kPad - 10.0;
    const double tall = room.high.y - room.low.y - 14.0;
    along_ = drawing_scale(high - low_, wide);
    round_ = drawing_scale(girth, tall);
    if (along_.factor > 0.5 * round_.factor) {  // one scale for both where that is still readable
      if (along_.factor > round_.factor) along_ = round_;
      round_ = along_;
    }
    at_ = {room.low.x + kPad + 10.0 - low_ * along_.factor,
           room.high.y - 8.0 - girth * round_.factor};
    top_ = girth;
    end_ = high;
  }

  void draw() {
    canvas_.text(
        {at_.x + low_ * along_.factor - 10.0, at_.y + top_ * round_.factor + 3.0},
        "Outside developed, seen from outside: along " + along_.name + ", round " + round_.name,
        kHead);
    for (int quarter = 0; quarter <= 4; ++quarter) {
      const double phi = 0.25 * kTwoPi * quarter;
      canvas_.line(at(phi, low_), at(phi, end_), quarter % 4 == 0 ? kLine : kDatum);
      canvas_.text({at_.x + low_ * along_.factor - 10.0, at(phi, 0.0).y - 0.8},
                   fixed(90.0 * quarter, 0) + " deg", kGrey);
    }
    edge(part_.start.table, "start");
    edge(part_.finish.table, "finish");
    canvas_.begin_clip(at(kTwoPi, low_), at(0.0, end_));
    for (const auto& placed : part_.holes) ring(placed.hole);
    for (const auto& mark : part_.marks) line(mark);
    canvas_.end_group();
    canvas_.text(at(kTwoPi, low_) - down(4.0), "start, z = 0 at its long point", kGrey);
    auto right = kGrey;
    right.anchor = Anchor::end;
    canvas_.text(at(kTwoPi, low_) - down(8.0), "full line: outer edge; dashes: inner edge", kGrey);
    const auto corner = at(kTwoPi, low_);
    canvas_.text({std::max(at(0.0, end_).x, corner.x + 100.0), corner.y - 4.0},
                 "finish, long point " + fixed(part_.finish.longest.z) + " mm", right);
  }

 private:
  struct Down {
    double by;
  };
  static Down down(double by) { return {by}; }
  friend DrawingPoint operator-(DrawingPoint p, Down d) { return {p.x, p.y - d.by}; }

  [[nodiscard]] DrawingPoint at(double phi, double z) const {
    return {at_.x + z * along_.factor,
            at_.y + (top_ - spec_.target.outer_radius * phi) * round_.factor};
  }

  void curve(const std::vector<double>& phi, const std::vector<double>& z, const Stroke& stroke,
             const std::string& id) {
    std::vector<std::pair<double, double>> sorted;
    for (std::size_t i = 0; i < phi.size(); ++i)
      sorted.emplace_back(phi[i] - kTwoPi * std::floor(phi[i] / kTwoPi), z[i]);
    std::ranges::sort(sorted);
    std::vector<DrawingPoint> points;
    for (const auto& [p, height] : sorted) points.push_back(at(p, height));
    if (!sorted.empty()) points.push_back(at(sorted.front().first + kTwoPi, sorted.front().second));
    canvas_.polyline(points, stroke, id);
  }
  void edge(const bevel::Table& table, const std::string& end) {
    curve(table.phi, table.z_outer, kCut, end + "_outer");
    curve(table.phi, table.z_inner, kInner, end + "_inner");
  }

  /// Drawn three times, so that one across the seam shows both its parts.
  void ring(const bevel::Hole& hole) {
    for (const double turn : {-kTwoPi, 0.0, kTwoPi}) {
      std::vector<DrawingPoint> outer, inner;
      for (std::size_t i = 0; i < hole.phi.size(); ++i) {
        outer.push_back(at(hole.phi[i] + turn, hole.z[i]));
        inner.push_back(at(hole.phi_inner[i] + turn, hole.z_inner[i]));
      }
      canvas_.polyline(outer, kCut, {}, true);
      canvas_.polyline(inner, kInner, {}, true);
    }
  }

  void line(const part::Mark& mark) {
    const double phi = mark.phi - kTwoPi * std::floor(mark.phi / kTwoPi);
    constexpr Stroke kMark{.color = "#2b6ca3", .width = 0.3};
    if (mark.z_to > mark.z_from)
      canvas_.line(at(phi, mark.z_from), at(phi, mark.z_to), kMark);
    else
      cross(at(phi, mark.z_from), kMark);
    const auto where = at(phi, 0.5 * (mark.z_from + mark.z_to));
    if (mark.kind != part::Mark::Kind::datum_line)
      canvas_.text({where.x + 0.5, where.y + (phi < kPi ? -2.6 : 1.0)}, mark.text, kSmall);
  }

  void cross(DrawingPoint place, const Stroke& stroke) {
    constexpr double kArm = 1.0;  // mm on paper
    canvas_.line({place.x - kArm, place.y}, {place.x + kArm, place.y}, stroke);
    canvas_.line({place.x, place.y - kArm}, {place.x, place.y + kArm}, stroke);
  }

  Canvas& canvas_;
  const part::PartSpec& spec_;
  const part::Part& part_;
  DrawingScale along_, round_;
  DrawingPoint at_;
  double low_ = 0.0, end_ = 0.0, top_ = 0.0;
};

std::string joined(const std::vector<part::Mistake>& mistakes) {
  std::string out;
  for (const auto one : mistakes) out += (out.empty() ? "" : ", ") + std::string(name_of(one));
  return out.empty() ? "none by more than 1 mm" : out;
}

/// Returns the y below.
double checks(Canvas& canvas, double y, const part::Part& part) {
  const double left = Sheet::kBorder + kPad, right = Sheet::kWidth - Sheet::kBorder - kPad;
  canvas.text({left, y}, "Check dimensions, mm", kHead);
  auto measured = kGrey;
  measured.anchor = Anchor::end;
  canvas.text({right, y}, "measured", measured);
  y -= 2.0;
  for (const auto& d : part.check_dimensions) {
    auto value = kHead;
    value.anchor = Anchor::end;
    canvas.text({left, y - 3.2}, d.name, {.height = 2.6, .bold = true});
    canvas.text({left + 60.0, y - 3.2}, fixed(d.value, 1), value);
    canvas.text({left + 64.0, y - 3.2}, name_of(d.tool), kSmall);
    canvas.text({left + 80.0, y - 3.2}, "changes with: " + joined(d.changes_with), kGrey);
    canvas.text({left, y - 6.4}, d.measured_from, kGrey);
    canvas.rectangle({right - 22.0, y - kCheckRow + 1.0}, {right, y - 0.8}, kLine);
    canvas.line({left, y - kCheckRow + 0.4}, {right, y - kCheckRow + 0.4}, kLine);
    y -= kCheckRow;
  }
  return y;
}

std::string words(const part::PartSpec& spec, const part::Part& part, const part::Step& step) {
  const auto from = fixed(step.z_from, 1), to = fixed(step.z_to, 1);
  const auto range = from == to ? " at z " + from : " from z " + from + " to " + to;
  switch (step.what) {
    case part::Step::What::mark: {
      const auto& mark = part.marks[step.index];
      const auto what = mark.kind == part::Mark::Kind::datum_line ? "the datum line" : mark.text;
      return "mark " + what + " at " + fixed(mark.phi * kDegPerRad, 1) + " deg" + range;
    }
    case part::Step::What::hole: {
      const auto& name = spec.holes[part.holes[step.index].asked].name;
      return "cut hole" + (name.empty() ? "" : " " + name) + range;
    }
    case part::Step::What::finish:
      return "cut the finish, scrap towards +z," + range;
    case part::Step::What::start:
      return "cut the start, scrap towards -z," + range;
  }
  return {};
}

/// In two columns; what does not fit is counted, and stands in the other formats.
void steps(Canvas& canvas, double y, double low, const part::PartSpec& spec,
           const part::Part& part) {
  const double left = Sheet::kBorder + kPad, column = 0.5 * (Sheet::kWidth - 2.0 * Sheet::kBorder);
  const bool none = y - low - 4.0 < kStepRow;
  canvas.text({left, y},
              none ? "Sequence: see the CSV or the JSON" : "Sequence, z in mm in the part's frame",
              kHead);
  const auto fit = static_cast<std::size_t>(std::max(0.0, (y - low - 4.0) / kStepRow));
  const std::size_t count = part.sequence.size(), shown = std::min(count, 2 * fit);
  const std::size_t half = std::min(fit, (shown + 1) / 2);
  for (std::size_t i = 0; i < shown; ++i) {
    const bool last = i + 1 == shown && shown < count;
    const DrawingPoint at{
        left + (i < half ? 0.0 : column),
        y - kStepRow * static_cast<double>(i % std::max<std::size_t>(half, 1) + 1)};
    canvas.text(at,
                last ? "and " + std::to_string(count - i) + " more steps: see the CSV or the JSON"
                     : std::to_string(i + 1) + "  " + words(spec, part, part.sequence[i]),
                kSmall);
  }
}

}  // namespace

std::string work_order(const part::PartSpec& spec, const part::Part& part, const Caption& caption) {
  const auto& target = spec.target;
  const auto mm = [](double value, int digits = 2) { return fixed(value, digits) + " mm"; };
  const SheetFacts facts{
      {"part", spec.name.empty() ? "-" : spec.name},
      {"tube", mm(2.0 * target.outer_radius) + " x " + mm(target.wall)},
      {"blank", mm(part.lengths.blank, 1) + " with kerfs, clamping and facing"},
      {"long to long", mm(part.lengths.longest)},
      {"short to short", mm(part.lengths.shortest)},
      {"finish turned against start", fixed(part.clocking * kDegPerRad, 2) + " deg"},
      {"weld", mm(part.lengths.weld, 1)},
      {"mass", fixed(part.lengths.mass, 2) + " kg"}};
  Sheet sheet("Work order", facts, caption);
  auto& canvas = sheet.canvas();
  const auto low = sheet.low(), high = sheet.high();
  Development(canvas, spec, part, {{low.x, high.y - kDevelopment}, high}).draw();
  const double below = checks(canvas, high.y - kDevelopment - 4.0, part);
  steps(canvas, below - 6.0, low.y + 2.0, spec, part);
  return sheet.print();
}

}  // namespace tubecut::api
