#include "api/formats/drawing/order/section_work_order.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "api/formats/drawing/order/broken_scale.hpp"
#include "api/formats/drawing/order/order_blocks.hpp"
#include "api/formats/drawing/order/order_cutouts.hpp"
#include "api/formats/drawing/order/order_sheets.hpp"
#include "api/formats/drawing/order/order_tables.hpp"
#include "api/formats/drawing/part_edges.hpp"
#include "api/formats/drawing/part_marks.hpp"
#include "api/formats/numbers.hpp"
#include "core/base/angle.hpp"

namespace tubecut::api {
namespace {

constexpr double kLeft = OrderSheets::kLeft, kWide = OrderSheets::kWide;
constexpr Lettering kHead{.height = 3.2, .bold = true};
constexpr Lettering kSmall{.height = 2.3};
constexpr Lettering kGrey{.height = 2.2, .color = "#566370"};
constexpr Stroke kEdge{.color = "#1d242b", .width = 0.4};
constexpr Stroke kSide{.color = "#566370", .width = 0.2};
constexpr Stroke kMiddle{.color = "#566370", .width = 0.15, .dashes = "4 1 1 1"};

std::string angle_of(const part::FaceCut& cut) { return cut.angle ? degrees(*cut.angle) : "-"; }

std::vector<Fact> facts_of(const part::SectionPartSpec& spec, const part::SectionPart& part) {
  const auto& s = spec.section;
  const auto& l = part.lengths;
  return {
      {"tube", number(s.height, Unit::mm) + " x " + number(s.width, Unit::mm) + " x " + mm(s.wall)},
      {"corner radius, outside", mm(s.corner)},
      {"blank, with kerfs, clamping, facing", mm(l.blank)},
      {"tip to tip", mm(l.longest)},
      {"throat to throat", mm(l.shortest)},
      {"between work points", mm(l.work_point)},
      {"weld", mm(l.weld)},
      {"mass", measure(l.mass, Unit::kg)}};
}

/// The four faces, one above the other, each as seen from outside: z to the right, the girth
/// downwards. A length in the middle that no cut reaches is left out, with a break.
class Faces {
 public:
  Faces(const part::SectionPartSpec& spec, const part::SectionPart& part)
      : part_(part),
        outer_(spec.section.outer()),
        start_(part::edge_over_girth(part.start.table, part.start.table.z_outer)),
        finish_(part::edge_over_girth(part.finish.table, part.finish.table.z_outer)),
        along_(shown(part, start_, finish_), kRoom,
               std::min(1.0, kTall / (2.0 * (spec.section.height + spec.section.width)))),
        scale_(along_.scale()) {
    high_ = finish_.highest();
  }

  [[nodiscard]] double height() const {
    double out = 0.0;
    for (int face = 1; face <= 4; ++face) out += side(face) * scale_ + kBetween;
    return out + 2.0;
  }

  void draw(Canvas& canvas, double top) const {
    for (int face = 1; face <= 4; ++face) {
      draw_face(canvas, face, top);
      top -= side(face) * scale_ + kBetween;
    }
  }

 private:
  static constexpr double kTall = 74.0, kRoom = 150.0, kBetween = 7.4;  // mm
  static constexpr double kBreak = 1.2;                                 // half the width of a break
  static constexpr int kPlaces = 80;

  [[nodiscard]] double side(int face) const { return 2.0 * outer_.face_distance(face % 4 + 1); }
  /// Both ends and all cut-outs.
  [[nodiscard]] static std::vector<BrokenScale::Range> shown(const part::SectionPart& part,
                                                             const part::Edge& start,
                                                             const part::Edge& finish) {
    std::vector<BrokenScale::Range> out{{std::min(0.0, start.lowest()), start.highest()},
                                        {finish.lowest(), finish.highest()}};
    std::vector<std::pair<double, double>> reach;
    for (const auto& mould : part.cutouts.moulds) {
      const auto z = std::ranges::minmax(mould.rows.z);
      reach.emplace_back(z.min, z.max);
    }
    for (const auto& one : part.cutouts.instances)
      out.emplace_back(one.z + reach[one.mould].first, one.z + reach[one.mould].second);
    return out;
  }
  [[nodiscard]] double x(double z) const { return kLeft + 17.0 + along_.x(z); }
  [[nodiscard]] double edge(bool finish, double s) const {
    const auto span = (finish ? finish_ : start_).at(s / outer_.girth() * kTwoPi);
    return finish ? span.low : span.high;
  }

  /// The cut as this face shows it: over the face and both of its corners.
  [[nodiscard]] std::vector<DrawingPoint> cut(int face, bool finish, double middle) const {
    const auto normal = section::Curve::face_normal(face);
    const Eigen::Vector2d round(-normal.y(), normal.x());
    const double half = outer_.half_flat(face) + 0.5 * kPi * outer_.corner();
    const double face_middle = outer_.on_face(face, 0.0);
    std::vector<double> places = steps(finish, face_middle, half);
    for (int i = 0; i <= kPlaces; ++i) places.push_back(half * (2.0 * i / kPlaces - 1.0));
    std::ranges::sort(places);
    std::vector<DrawingPoint> out;
    for (const double place : places) {
      const double s = face_middle + place;
      const double v = outer_.at(s).point.dot(round);
      out.push_back({x(edge(finish, s)), middle - v * scale_});
    }
    return out;
  }

  /// Returns places just before and after each step of an end's edge, such as a tab's side, from
  /// the middle of a face.
  [[nodiscard]] std::vector<double> steps(bool finish, double face_middle, double half) const {
    constexpr double kBesideStep = 1e-6;  // mm
    const auto& line = finish ? finish_ : start_;
    std::vector<double> out;
    for (std::size_t i = 0; i + 1 < line.phi.size(); ++i) {
      if (line.phi[i] != line.phi[i + 1] || line.z[i] == line.z[i + 1]) continue;
      const double off =
          std::remainder(line.phi[i] / kTwoPi * outer_.girth() - face_middle, outer_.girth());
      if (std::abs(off) >= half) continue;
      out.push_back(off - kBesideStep);
      out.push_back(off + kBesideStep);
    }
    return out;
  }

  void draw_face(Canvas& canvas, int face, double top) const {
    const double half = 0.5 * side(face) * scale_, middle = top - half;
    const auto id = "face_" + std::to_string(face);
    const auto start = cut(face, false, middle), finish = cut(face, true, middle);
    canvas.polyline(start, kEdge, id + "_start");
    canvas.polyline(finish, kEdge, id + "_finish");
    draw_cutouts(canvas, face, middle);
    for (const auto& [from, to] :
         {std::pair{start.front(), finish.front()}, std::pair{start.back(), finish.back()}})
      draw_side(canvas, from, to);
    for (const double broken : along_.breaks())
      for (const double side : {-kBreak, kBreak})
        canvas.polyline({{kLeft + 17.0 + broken + side - 0.8, middle - half - 1.0},
                         {kLeft + 17.0 + broken + side + 0.8, middle + half + 1.0}},
                        kSide);
    const auto at = static_cast<std::size_t>(face - 1);
    const auto& s = part_.start.faces[at];
    const auto& f = part_.finish.faces[at];
    canvas.line({x(s.z), middle}, {x(f.z), middle}, kMiddle);
    canvas.text({kLeft, middle - 1.0}, "face " + std::to_string(face), kSmall);
    canvas.text({kLeft, middle - 4.0}, "cut " + angle_of(s), kGrey);
    auto length = kHead;
    length.height = 2.8;
    const double right = x(high_) + 2.0;
    canvas.text({right, middle + 0.8}, mm(part_.faces[at].length), length);
    canvas.text({right, middle - 2.8}, "cut " + angle_of(f), kGrey);
    // The corner after this face lies below it.
    auto corner = kGrey;
    corner.anchor = Anchor::end;
    canvas.text({right - 2.0, middle - half - 4.2},
                "corner " + std::to_string(face) + ": " + mm(part_.faces[at].corner), corner);
  }

  /// A side of a face, interrupted at the breaks.
  void draw_side(Canvas& canvas, DrawingPoint from, const DrawingPoint& to) const {
    for (const double broken : along_.breaks()) {
      const double at = kLeft + 17.0 + broken;
      canvas.line(from, {at - kBreak, from.y}, kSide);
      from.x = at + kBreak;
    }
    canvas.line(from, to, kSide);
  }

  void draw_cutouts(Canvas& canvas, int face, double middle) const {
    const auto& layout = part_.cutouts;
    for (std::size_t i = 0; i < layout.instances.size(); ++i) {
      const auto& one = layout.instances[i];
      if (layout.mould_of(one).laying.over() != nullptr) {
        draw_over_corner(canvas, face, middle, i);
        continue;
      }
      if (one.face != face) continue;
      const auto rows = cutout::placed(layout, one);
      const double anchor = outer_.on_face(face, 0.0);
      std::vector<DrawingPoint> line;
      for (std::size_t k = 0; k < rows.z.size(); ++k) {
        const double s = rows.phi[k] / kTwoPi * outer_.girth();
        const double v = std::remainder(s - anchor, outer_.girth());
        line.push_back({x(rows.z[k]), middle - v * scale_});
      }
      canvas.polyline(std::move(line), kEdge, "cutout-" + std::to_string(i + 1), true);
    }
  }

  /// Of a cut-out over corners what this face shows, as of an end's cut.
  void draw_over_corner(Canvas& canvas, int face, double middle, std::size_t i) const {
    const auto rows = cutout::placed(part_.cutouts, part_.cutouts.instances[i]);
    const auto normal = section::Curve::face_normal(face);
    const Eigen::Vector2d round(-normal.y(), normal.x());
    const auto n = rows.z.size();
    std::vector<std::optional<DrawingPoint>> shown(n);
    std::size_t first = n;  // hidden
    for (std::size_t k = 0; k < n; ++k) {
      const auto at = outer_.at(rows.phi[k] / kTwoPi * outer_.girth());
      if (at.normal.dot(normal) > 1e-9)
        shown[k] = {x(rows.z[k]), middle - at.point.dot(round) * scale_};
      else
        first = k;
    }
    const auto id = "cutout-" + std::to_string(i + 1);
    const bool whole = first == n;
    std::vector<DrawingPoint> line;
    int pieces = 0;
    const auto end_line = [&] {
      if (line.size() > 1)
        canvas.polyline(line, kEdge,
                        id + "-face-" + std::to_string(face) +
                            (pieces++ == 0 ? "" : "-" + std::to_string(pieces)),
                        whole);
      line.clear();
    };
    for (std::size_t k = 0; k < n; ++k) {
      const auto& point = shown[(whole ? k : first + 1 + k) % n];
      if (point)
        line.push_back(*point);
      else
        end_line();
    }
    end_line();
  }

  const part::SectionPart& part_;
  section::Curve outer_;
  part::Edge start_, finish_;
  BrokenScale along_;
  double scale_ = 1.0;
  double high_ = 0.0;
};

void draw_faces(OrderSheets& sheets, const part::SectionPartSpec& spec,
                const part::SectionPart& part) {
  const Faces faces(spec, part);
  const double tall = faces.height() + 13.0;
  const double top = sheets.take(tall);
  auto& canvas = sheets.canvas();
  canvas.text({kLeft, top - 5.0}, "Faces, each as seen from outside, start at the left", kHead);
  canvas.text(
      {kLeft, top - 8.6},
      "Lengths along the middle of a face and of the corner below it. Cut: against a square "
      "across the face, above 0 where the end rises downwards on this view.",
      kGrey);
  faces.draw(canvas, top - 11.5);
}

std::string cutout_step(const part::SectionPart& part, const part::Step& step) {
  const auto& one = part.cutouts.instances[step.index];
  const bool over = part.cutouts.mould_of(one).laying.over() != nullptr;
  return "cut " + cutout_tag(part.cutouts, step.index) +
         (over ? " over a corner, from face " : " on face ") + std::to_string(one.face) +
         ", its place " + mm(one.z) + " from the start's long point";
}

std::string text_step(const cutout::Lettering& text) {
  return "mark " + text_in_words(text) + ", on face " + std::to_string(text.face) +
         (text.offset == 0.0 ? "" : ", " + mm(text.offset) + " off its middle") +
         ", its base line from " + mm(text.z) + " on";
}

/// The operations on the blank, in their order.
void draw_section_steps(OrderSheets& sheets, const part::SectionPartSpec& spec,
                        const part::SectionPart& part) {
  std::vector<std::string> steps;
  const auto& all = part.sequence;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto& step = all[i];
    if (auto run = cutout_run(all, i, spec.cutouts, part.cutouts)) {
      steps.push_back(std::move(run->text));
      i += run->count - 1;
    } else if (step.what == part::Step::What::mark) {
      const auto& mark = part.marks[step.index];
      const bool line = mark.kind == part::Mark::Kind::datum_line;
      steps.push_back(mark.lettering ? text_step(*mark.lettering)
                      : line         ? "scribe the datum line on the middle of face 1"
                                     : "mark " + mark.text + " on the middle of face 1, " +
                                   mm(mark.z_from) + " from the start's long point");
    } else if (step.what == part::Step::What::cutout) {
      steps.push_back(cutout_step(part, step));
    } else {
      steps.push_back(step.what == part::Step::What::finish
                          ? "cut the finish"
                          : "cut the start, which parts the piece from the clamped rest");
    }
  }
  constexpr double kRow = 4.4;
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < steps.size(); ++i)
    for (auto& line : wrapped(std::to_string(i + 1) + "  " + steps[i], kSmall.height, kWide))
      lines.push_back(std::move(line));
  const double top = sheets.take(7.0 + kRow * static_cast<double>(lines.size()));
  auto& canvas = sheets.canvas();
  canvas.text({kLeft, top - 5.0}, "Steps", kHead);
  for (std::size_t i = 0; i < lines.size(); ++i)
    canvas.text({kLeft, top - 5.0 - kRow * static_cast<double>(i + 1)}, lines[i], kSmall);
}

/// The saw's settings, if an end is one plane.
void draw_saw(OrderSheets& sheets, const part::SectionPart& part) {
  for (const auto* end : {&part.start, &part.finish}) {
    if (std::ranges::none_of(end->faces, [](const auto& f) { return f.tilt.has_value(); }))
      continue;
    std::string text =
        std::string(end == &part.start ? "start" : "finish") + " sawn in one cut, this face down: ";
    bool first = true;
    for (int face = 1; face <= 4; ++face) {
      const auto& cut = end->faces[static_cast<std::size_t>(face - 1)];
      if (!cut.tilt) continue;
      text += (first ? "" : "; ") + std::string("face ") + std::to_string(face) + " gauge " +
              angle_of(cut) + " tilt " + degrees(*cut.tilt);
      first = false;
    }
    sheets.canvas().label({kLeft, sheets.take(3.6) - 2.8}, text, kSmall, kWide);
  }
}

}  // namespace

std::vector<Canvas> section_work_order(const part::SectionPartSpec& spec,
                                       const part::SectionPart& part, const Caption& caption) {
  OrderSheets sheets("Work order", name_of_part(spec.name, caption), caption);
  draw_facts(sheets, order_facts(caption), 4);
  draw_members(sheets, caption);
  rule(sheets);
  draw_facts(sheets, facts_of(spec, part), 4);
  rule(sheets);
  draw_verdict(sheets,
               bevel_range({&part.start.table.b, &part.finish.table.b}, spec.start.cut.torch),
               caption);
  rule(sheets);
  draw_faces(sheets, spec, part);
  draw_saw(sheets, part);
  draw_partners(sheets, {part.start.spec.partners.size(), spec.start.welded},
                {part.finish.spec.partners.size(), spec.finish.welded}, caption);
  draw_cutouts(sheets, spec, part);
  draw_section_steps(sheets, spec, part);
  draw_checks(sheets, part.check_dimensions);
  draw_sign_off(sheets, spec.start.cut.sampling, caption);
  return sheets.finished();
}

}  // namespace tubecut::api
