#include "core/part/text_clearance.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "core/cutout/rows.hpp"
#include "core/part/wall_line.hpp"

namespace tubecut::part {
namespace {

constexpr double kLeastClearance =
    2.0;                            // mm: a stroke of a marking tool stays whole next to an edge
constexpr double kFineEdge = 1e-3;  // mm, of a chord off its edge
constexpr double kRounding = 1e-9;  // mm

/// An opening on the developed outside.
struct OutsideOpening {
  WallLine line;
  WallPoint at;
  std::string name;
};

/// The developed outside of a part, with its edges.
struct Outside {
  double girth = 0.0;
  double clearance = 0.0;
  Edge start, finish;
  std::vector<OutsideOpening> openings;
};

/// A text on the developed outside: x is the way round.
struct TextLines {
  std::vector<WallLine> strokes;
  WallBox box;
};

TextLines lines_of(const cutout::Lettering& text) {
  TextLines out;
  for (const auto& stroke : text.strokes) {
    std::vector<WallPoint> points;
    for (const auto& p : stroke) points.emplace_back(p.y(), p.x());
    out.strokes.emplace_back(std::move(points), false);
    out.box.take(out.strokes.back().box().least);
    out.box.take(out.strokes.back().box().most);
  }
  return out;
}

WallLine outer_line(const bevel::Hole& rows, double radius) {
  std::vector<WallPoint> out;
  for (std::size_t i = 0; i < rows.phi.size(); ++i)
    out.emplace_back(radius * rows.phi[i], rows.z[i]);
  return {std::move(out), true};
}

void add_cutouts(const cutout::Layout& layout, Outside& out) {
  const double radius = out.girth / kTwoPi;
  std::vector<WallLine> lines;
  for (const auto& mould : layout.moulds) {
    const auto rows = cutout::rows(mould, {.tolerance = kFineEdge});
    lines.push_back(outer_line(rows ? *rows : mould.rows, radius));
  }
  for (const auto& one : layout.instances)
    out.openings.push_back({lines[one.mould], {radius * one.phi, one.z}, "cut-out " + one.name});
}

/// How near a text comes to one opening; 0 across it or within it.
double distance_to(const OutsideOpening& opening, const TextLines& text, double girth,
                   double within) {
  const auto& box = opening.line.box();
  const double low = text.box.least.x() - within - opening.at.x() - box.most.x();
  const double high = text.box.most.x() + within - opening.at.x() - box.least.x();
  double out = kFar;
  for (double turn = std::ceil(low / girth); turn <= high / girth; turn += 1.0) {
    const WallPoint shift = opening.at + WallPoint(turn * girth, 0.0);
    if (text.box.apart(box, shift) > within) continue;
    for (const auto& stroke : text.strokes) {
      if (stroke.box().apart(box, shift) > std::min(within, out)) continue;
      if (opening.line.holds(stroke.points().front() - shift)) return 0.0;
      WallWay way;
      stroke.shorten(opening.line, shift, way);
      out = std::min(out, way.length);
    }
  }
  return out;
}

Issue too_near(std::size_t asked, const std::string& opening, double distance, double clearance) {
  return {.code = ErrorCode::cutouts_cross,
          .member = cutout::path_of_text(asked),
          .got = distance,
          .limit = clearance,
          .unit = "mm",
          .hint = (distance > 0.0 ? "it comes within " + brief(distance) + " mm of "
                                  : std::string("it meets ")) +
                  opening + "; strokes keep " + brief(clearance) + " mm off every edge"};
}

/// An end's edge, once round and as often again as a text goes round.
class EndOfOutside {
 public:
  EndOfOutside(const Outside& outside, bool finish)
      : edge_(finish ? outside.finish : outside.start),
        girth_(outside.girth),
        clearance_(outside.clearance),
        finish_(finish),
        extreme_(finish ? edge_.lowest() : edge_.highest()) {}

  /// Returns how far along the tube a text must move, so that it keeps off this end; 0 if it does.
  [[nodiscard]] double lacking(const TextLines& text) const {
    // Beyond this way the text is clear of the whole edge.
    const double most =
        clearance_ + (finish_ ? text.box.most.y() - extreme_ : extreme_ - text.box.least.y());
    if (most <= kRounding) return 0.0;
    const auto line = line_near(text);
    if (is_clear(text, line, 0.0)) return 0.0;
    double low = 0.0, high = most;
    for (int i = 0; i < 60 && high - low > kRounding; ++i) {
      const double middle = 0.5 * (low + high);
      (is_clear(text, line, middle) ? high : low) = middle;
    }
    return high;
  }

 private:
  [[nodiscard]] WallLine line_near(const TextLines& text) const {
    const double from = std::floor((text.box.least.x() - clearance_) / girth_);
    std::vector<WallPoint> points;
    // Ascending, so that two copies meet at the datum line.
    for (double turn = from - 1.0; girth_ * (turn - 1.0) <= text.box.most.x() + clearance_;
         turn += 1.0)
      for (std::size_t i = 0; i < edge_.z.size(); ++i)
        points.emplace_back(girth_ * (edge_.phi[i] / kTwoPi + turn), edge_.z[i]);
    return {std::move(points), false};
  }
  [[nodiscard]] bool is_clear(const TextLines& text, const WallLine& line, double moved) const {
    const WallPoint by(0.0, finish_ ? moved : -moved);  // of the end, in place of the text
    for (const auto& stroke : text.strokes) {
      for (const auto& p : stroke.points()) {
        const auto there = edge_.at(p.x() / girth_ * kTwoPi);
        if (finish_ ? p.y() >= there.low + by.y() : p.y() <= there.high + by.y()) return false;
      }
      WallWay way;
      stroke.shorten(line, by, way);
      if (way.length < clearance_ - kRounding) return false;
    }
    return true;
  }

  const Edge& edge_;
  double girth_, clearance_;
  bool finish_;
  double extreme_;
};

Issue off_part(const cutout::Lettering& text, double lacking, bool finish, double clearance) {
  const auto& spec = text.spec;
  const bool from_there = (spec.at.from == cutout::Anchor::From::finish) == finish;
  return {.code = ErrorCode::cutout_off_part,
          .member = cutout::path_of_text(text.asked) + "/at/z",
          .got = spec.at.z,
          .limit = spec.at.z + (from_there ? lacking : -lacking),
          .unit = "mm",
          .hint = "its strokes keep " + brief(clearance) + " mm off the cut at the " +
                  std::string(joint::end_name(finish)) + ": move it by " + brief(lacking) + " mm"};
}

std::vector<Issue> check(const Outside& outside, const std::vector<cutout::Lettering>& texts) {
  std::vector<Issue> out;
  for (const auto& one : texts) {
    const auto text = lines_of(one);
    for (const bool finish : {false, true}) {
      const double lacking = EndOfOutside(outside, finish).lacking(text);
      if (lacking > 0.0) out.push_back(off_part(one, lacking, finish, outside.clearance));
    }
    double nearest = outside.clearance - kRounding;
    const OutsideOpening* met = nullptr;
    for (const auto& opening : outside.openings) {
      const double distance = distance_to(opening, text, outside.girth, outside.clearance);
      if (distance >= nearest) continue;
      nearest = distance;
      met = &opening;
    }
    if (met != nullptr) out.push_back(too_near(one.asked, met->name, nearest, outside.clearance));
  }
  return out;
}

}  // namespace

double text_clearance(double kerf) { return std::max(kLeastClearance, kerf); }

std::vector<Issue> check_texts(const PartSpec& spec, const Part& part,
                               const std::vector<cutout::Lettering>& texts) {
  if (texts.empty()) return {};
  Outside outside{.girth = kTwoPi * spec.target.outer_radius,
                  .clearance = text_clearance(spec.cutouts.kerf),
                  .start = {part.start.table.phi, part.start.table.z_outer},
                  .finish = {part.finish.table.phi, part.finish.table.z_outer},
                  .openings = {}};
  add_cutouts(part.cutouts, outside);
  for (const auto& placed : part.holes)
    outside.openings.push_back({outer_line(placed.hole, spec.target.outer_radius),
                                WallPoint::Zero(), name_of(spec.holes[placed.asked])});
  return check(outside, texts);
}

std::vector<Issue> check_texts(const SectionPartSpec& spec, const SectionPart& part,
                               const std::vector<cutout::Lettering>& texts) {
  if (texts.empty()) return {};
  Outside outside{.girth = spec.section.outer().girth(),
                  .clearance = text_clearance(spec.cutouts.kerf),
                  .start = edge_over_girth(part.start.table, part.start.table.z_outer),
                  .finish = edge_over_girth(part.finish.table, part.finish.table.z_outer),
                  .openings = {}};
  add_cutouts(part.cutouts, outside);
  return check(outside, texts);
}

Mark mark_of(const PartSpec& spec, cutout::Lettering text) {
  const auto box = cutout::bounds(text.strokes);
  return {.kind = Mark::Kind::text,
          .text = text.spec.text,
          .phi = text.s / spec.target.outer_radius,
          .z_from = box.least.x(),
          .z_to = box.most.x(),
          .lettering = std::move(text)};
}

SectionMark mark_of(const SectionPartSpec& /*spec*/, cutout::Lettering text) {
  const auto box = cutout::bounds(text.strokes);
  return {.kind = Mark::Kind::text,
          .text = text.spec.text,
          .s = text.s,
          .z_from = box.least.x(),
          .z_to = box.most.x(),
          .lettering = std::move(text)};
}

}  // namespace tubecut::part
