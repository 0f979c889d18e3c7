#include "api/formats/drawing/part_development.hpp"

#include <algorithm>

#include "api/formats/drawing/labels.hpp"
#include "api/formats/drawing/part_edges.hpp"
#include "api/formats/numbers.hpp"

namespace tubecut::api {
namespace {

// mm on paper
constexpr double kMostGirth = 76.0;
constexpr double kLeft = 13.0, kRight = 32.0;  // next to a strip: phases; lengths and girth
constexpr double kAbove = 7.0, kBelow = 22.0;
constexpr double kRoom = 4.0, kBreak = 6.0;  // of plain tube around the drawn range; of a break

constexpr Stroke kCut{.color = "#1d242b", .width = 0.35};
constexpr Stroke kInner{.color = "#566370", .width = 0.2, .dashes = "1.6 1"};
constexpr Stroke kQuarter{.color = "#7a8794", .width = 0.15, .dashes = "2 1.5"};
constexpr Stroke kDatum{.color = "#c0392b", .width = 0.35};
constexpr Stroke kMark{.color = "#2b6ca3", .width = 0.3};
constexpr Stroke kDimension{.color = "#1d242b", .width = 0.18};
constexpr std::string_view kMetal = "#eef3f8";
constexpr Lettering kGrey{.height = 2.2, .color = "#566370"};

double tag_width(const Opening& one) { return text_width(one.tag, kTagHeight, true); }

/// `factor`: of the drawing's scale if there must be room for the tags, else 0.
std::vector<SurfaceRange> surface_ranges(const part::Part& part, double factor) {
  std::vector<SurfaceRange> out{surface_range(part.start.table), surface_range(part.finish.table)};
  for (const auto& one : openings(part)) {
    auto range = surface_range(one.rows);
    const double wide = factor > 0.0 && one.tagged ? tag_width(one) / factor : 0.0;
    const double more = std::max(0.0, 0.5 * (wide - (range.z_to - range.z_from)));
    range.z_from -= more;
    range.z_to += more;
    out.push_back(range);
  }
  for (const auto& mark : part.marks)
    if (mark.kind != part::Mark::Kind::datum_line)
      out.push_back({.z_from = mark.z_from, .z_to = mark.z_to});
  std::ranges::sort(out, {}, &SurfaceRange::z_from);
  return out;
}

std::vector<DevelopmentPlan::Strip> strips_of(const std::vector<SurfaceRange>& ranges, double scale,
                                              double room) {
  std::vector<DevelopmentPlan::Strip> out(1);
  if (scale * (ranges.back().z_to - ranges.front().z_from) <= room)
    return {{{.from = ranges.front().z_from, .to = ranges.back().z_to, .at = 0.0}}};
  double used = 0.0;
  for (const auto& range : ranges) {
    const double size = scale * (range.z_to - range.z_from);
    auto& strip = out.back();
    const double gap = strip.empty() ? 0.0 : scale * (range.z_from - strip.back().to);
    const double between = std::min(gap, kBreak);
    if (!strip.empty() && used + between + size > room) {
      out.push_back({{.from = range.z_from, .to = range.z_to, .at = 0.0}});
      used = size;
      continue;
    }
    if (strip.empty() || gap > kBreak)
      strip.push_back({.from = range.z_from, .to = range.z_to, .at = used + between});
    else
      strip.back().to = range.z_to;
    used += between + size;
  }
  return out;
}

/// Draws one segment of a strip, cut off at its ends.
class SegmentDrawing {
 public:
  SegmentDrawing(Canvas& canvas, const DevelopmentPlan& plan, const StripSegment& segment,
                 const part::PartSpec& spec, const part::Part& part, DrawingPoint top)
      : canvas_(canvas), plan_(plan), segment_(segment), spec_(spec), part_(part), top_(top) {}

  void draw() {
    canvas_.begin_clip({top_.x + segment_.at, top_.y - plan_.scale.factor * plan_.girth},
                       {x(segment_.to), top_.y});
    metal();
    quarters();
    if (holds(surface_range(part_.start.table))) end(part_.start, spec_.start.welded, "start", 0);
    if (holds(surface_range(part_.finish.table)))
      end(part_.finish, spec_.finish.welded, "finish", part_.start.spec.partners.size());
    for (std::size_t i = 0; i < openings_.size(); ++i)
      if (holds(surface_range(openings_[i].rows))) opening(i);
    for (const auto& mark : part_.marks)
      if (mark.kind != part::Mark::Kind::datum_line &&
          holds({.z_from = mark.z_from, .z_to = mark.z_to}))
        draw(mark);
    canvas_.end_group();
  }

 private:
  [[nodiscard]] double x(double z) const {
    return top_.x + segment_.at + plan_.scale.factor * (z - segment_.from);
  }
  [[nodiscard]] DrawingPoint at(double phi, double z) const {
    return {x(z), top_.y - plan_.scale.factor * spec_.target.outer_radius * (phi - plan_.opened)};
  }
  [[nodiscard]] bool holds(const SurfaceRange& range) const {
    return range.z_to >= segment_.from && range.z_from <= segment_.to;
  }
  [[nodiscard]] std::vector<DrawingPoint> curve(const RoundEdge& edge) const {
    std::vector<DrawingPoint> out;
    for (const auto& [phi, z] : edge.points()) out.push_back(at(phi, z));
    return out;
  }
  [[nodiscard]] RoundEdge outer(const part::End& end) const {
    return {end.table.phi, end.table.z_outer, plan_.opened};
  }

  void metal() {
    auto border = curve(outer(part_.start));
    auto back = curve(outer(part_.finish));
    border.insert(border.end(), back.rbegin(), back.rend());
    canvas_.polyline(std::move(border), {.color = "none", .fill = kMetal}, {}, true);
  }
  /// At multiples of 90 deg, from edge to edge.
  void quarters() {
    const auto start = outer(part_.start), finish = outer(part_.finish);
    for (int i = 0; i < 4; ++i) {
      const double phi = turned_from(plan_.opened, 0.5 * kPi * i);
      const auto from = std::max(start.at(phi), segment_.from);
      const auto to = std::min(finish.at(phi), segment_.to);
      canvas_.line(at(phi, from), at(phi, to), i == 0 ? kDatum : kQuarter);
      if (i == 0 && phi == plan_.opened)
        canvas_.line(at(phi + kTwoPi, from), at(phi + kTwoPi, to), kDatum);
    }
  }
  void end(const part::End& end, bool welded, const std::string& name, std::size_t first_color) {
    canvas_.polyline(curve(RoundEdge(end.table.phi, end.table.z_inner, plan_.opened)), kInner,
                     name + "_inner");
    const auto& t = end.table;
    if (welded) colored(t, first_color);
    canvas_.polyline(curve(outer(end)), kCut, name + "_outer");
  }

  /// Each part of the edge in its partner's colour.
  void colored(const bevel::Table& t, std::size_t first_color) {
    std::vector<DrawingPoint> run;
    const auto end_run = [&](std::size_t partner) {
      if (run.size() > 1)
        canvas_.polyline(run, {.color = partner_color(first_color + partner), .width = 0.9});
      run.clear();
    };
    double before = plan_.opened;
    for (std::size_t i = 0; i < t.phi.size(); ++i) {
      const double phi = turned_from(plan_.opened, t.phi[i]);
      const bool next = i > 0 && t.cutter[i] != t.cutter[i - 1];
      if (next && phi >= before) run.push_back(at(phi, t.z_outer[i]));
      if (next || phi < before) end_run(t.cutter[i - 1]);  // phi of the first is not below
      run.push_back(at(phi, t.z_outer[i]));
      before = phi;
    }
    if (!t.cutter.empty()) end_run(t.cutter.back());
  }

  /// Drawn again a turn on where it reaches beyond the lower edge.
  void opening(std::size_t i) {
    const auto& [hole, tag, tagged] = openings_[i];
    const auto range = surface_range(hole);
    const double turn = turned_from(plan_.opened, range.phi_from) - range.phi_from;
    for (const double more : {0.0, -kTwoPi}) {
      if (range.phi_to + turn + more < plan_.opened) continue;
      std::vector<DrawingPoint> edge, inner;
      for (std::size_t k = 0; k < hole.phi.size(); ++k) {
        edge.push_back(at(hole.phi[k] + turn + more, hole.z[k]));
        inner.push_back(at(hole.phi_inner[k] + turn + more, hole.z_inner[k]));
      }
      const auto id = "hole-" + std::to_string(i + 1) + (more < 0.0 ? "-again" : "");
      canvas_.polyline(std::move(edge), {.width = 0.35, .fill = "#ffffff"}, id, true);
      canvas_.polyline(std::move(inner), kInner, id + "-inner", true);
    }
    if (!tagged) return;
    const auto above = at(range.phi_from + turn, 0.5 * (range.z_from + range.z_to));
    const auto below = at(range.phi_to + turn, 0.5 * (range.z_from + range.z_to));
    const DrawingPoint where{above.x, above.y + 3.4 < top_.y ? above.y + 0.8 : below.y - 2.8};
    const double half = 0.5 * tag_width(openings_[i]);
    const auto covers = [&](const Cell& other) {
      return where.x - half < other.high.x && where.x + half > other.low.x &&
             where.y < other.high.y && where.y + kTagHeight > other.low.y;
    };
    if (std::ranges::any_of(tags_, covers)) return;  // its name is in the table
    tags_.push_back({{where.x - half, where.y}, {where.x + half, where.y + kTagHeight}});
    canvas_.text(where, tag, {.height = kTagHeight, .anchor = Anchor::middle, .bold = true});
  }

  /// Draws the strokes of a text, again a turn on where it reaches beyond the lower edge.
  void draw(const cutout::Lettering& text) {
    const double radius = spec_.target.outer_radius;
    const double phi = text.s / radius, turn = turned_from(plan_.opened, phi) - phi;
    for (const auto& stroke : text.strokes)
      for (const double more : {-kTwoPi, 0.0, kTwoPi}) {
        std::vector<DrawingPoint> points;
        bool shown = false;
        for (const auto& p : stroke) {
          const double there = p.y() / radius + turn + more;
          shown = shown || (there >= plan_.opened && there <= plan_.opened + kTwoPi);
          points.push_back(at(there, p.x()));
        }
        if (shown) canvas_.polyline(std::move(points), kMark);
      }
  }

  void draw(const part::Mark& mark) {
    if (mark.lettering) return draw(*mark.lettering);
    const double phi = turned_from(plan_.opened, mark.phi);
    const auto where = at(phi, 0.5 * (mark.z_from + mark.z_to));
    if (mark.z_to > mark.z_from) {
      canvas_.line(at(phi, mark.z_from), at(phi, mark.z_to), kMark);
    } else {
      canvas_.line({where.x - 1.0, where.y}, {where.x + 1.0, where.y}, kMark);
      canvas_.line({where.x, where.y - 1.0}, {where.x, where.y + 1.0}, kMark);
    }
    double below = where.y - 1.0;
    for (const auto& one : openings_) {  // a branch's name stands below its hole
      const auto range = surface_range(one.rows);
      const double phi_in = turned_from(range.phi_from, phi);
      if (phi_in <= range.phi_to && mark.z_from >= range.z_from && mark.z_to <= range.z_to)
        below = std::min(
            below, where.y - 2.6 -
                       plan_.scale.factor * spec_.target.outer_radius * (range.phi_to - phi_in));
    }
    const bool room = below - 2.6 > top_.y - plan_.scale.factor * plan_.girth;
    canvas_.label({where.x, room ? below - 2.3 : where.y + 1.2}, mark.text,
                  {.height = kLeastText, .anchor = Anchor::middle, .color = kMark.color}, 24.0);
  }

  Canvas& canvas_;
  const DevelopmentPlan& plan_;
  const StripSegment& segment_;
  const part::PartSpec& spec_;
  const part::Part& part_;
  DrawingPoint top_;
  std::vector<Opening> openings_ = openings(part_);
  std::vector<Cell> tags_;  // drawn so far
};

/// Annotations next to the segments of a strip.
class Beside {
 public:
  Beside(Canvas& canvas, const DevelopmentPlan& plan, std::size_t index, const part::Part& part,
         DrawingPoint top)
      : canvas_(canvas), plan_(plan), strip_(plan.strips[index]), part_(part), top_(top) {
    high_ = plan.scale.factor * plan.girth;
    left_ = top.x;
    right_ = x(strip_.back().to);
    first_ = index == 0;
    last_ = index + 1 == plan.strips.size();
  }

  void draw() {
    phases();
    for (std::size_t i = 0; i + 1 < strip_.size(); ++i)
      torn(x_of(strip_[i], strip_[i].to), strip_[i + 1].at + left_);
    if (!first_) torn(left_ - 3.0, left_);
    if (!last_) torn(right_, right_ + 3.0);
    distances();
    if (last_) lengths();
  }

 private:
  [[nodiscard]] double x_of(const StripSegment& s, double z) const {
    return top_.x + s.at + plan_.scale.factor * (z - s.from);
  }
  [[nodiscard]] double x(double z) const {
    for (const auto& s : strip_)
      if (z <= s.to) return x_of(s, z);
    return x_of(strip_.back(), z);
  }
  [[nodiscard]] bool holds(double z) const {
    return std::ranges::any_of(strip_, [&](const auto& s) { return z >= s.from && z <= s.to; });
  }
  [[nodiscard]] double y(double phi) const {
    return top_.y - high_ * (turned_from(plan_.opened, phi) - plan_.opened) / kTwoPi;
  }

  void phases() {
    auto left = kGrey;
    left.anchor = Anchor::end;
    for (int i = 0; i < 4; ++i) {
      auto l = left;
      if (i == 0) l = {.height = 2.3, .anchor = Anchor::end, .bold = true, .color = kDatum.color};
      canvas_.text({left_ - 4.0, y(0.5 * kPi * i) - 0.8}, degrees(0.5 * kPi * i), l);
    }
    if (plan_.opened == 0.0)
      canvas_.text({left_ - 4.0, top_.y - high_ - 0.8}, degrees(kTwoPi),
                   {.height = 2.3, .anchor = Anchor::end, .bold = true, .color = kDatum.color});
    draw_arrow(canvas_, {left_ - 11.5, top_.y - 0.15 * high_}, {left_ - 11.5, top_.y - 0.5 * high_},
               kDimension);
    canvas_.text({left_ - 11.5, top_.y - 0.15 * high_ + 1.0}, "phi",
                 {.height = 2.3, .anchor = Anchor::middle});
  }
  void torn(double from, double to) {
    for (const double side : {from, to}) {
      std::vector<DrawingPoint> line;
      for (int i = 0; i <= 12; ++i)
        line.push_back({side + (i % 2 == 0 ? -0.5 : 0.5), top_.y - high_ * i / 12.0});
      canvas_.polyline(std::move(line), kDimension);
    }
  }

  /// Draws the distances of all beginnings and ends from z = 0, each on its own line.
  void distances() {
    std::vector<double> all{0.0};
    for (const auto* end : {&part_.start, &part_.finish})
      for (const double z : {end->longest.z, end->shortest.z}) all.push_back(z);
    for (const auto& one : openings(part_))
      if (const auto range = surface_range(one.rows); one.tagged)
        all.insert(all.end(), {range.z_from, range.z_to});
    std::erase_if(all, [&](double z) { return !holds(z); });
    std::ranges::sort(all);
    const auto again = std::ranges::unique(all, [](double a, double b) { return b - a < 0.005; });
    all.erase(again.begin(), again.end());
    std::vector<double> wanted;
    for (const double z : all) wanted.push_back(x(z));
    const double low = top_.y - high_;
    const auto places = spread(wanted, 2.9, left_, std::max(right_, left_ + 40.0));
    for (std::size_t i = 0; i < all.size(); ++i) {
      canvas_.polyline({{wanted[i], low - 0.8},
                        {wanted[i], low - 2.0},
                        {places[i], low - 5.0},
                        {places[i], low - 6.0}},
                       kDimension);
      canvas_.text({places[i] + 0.8, low - 6.6}, number(all[i], Unit::mm),
                   {.height = 2.2, .anchor = Anchor::end, .turn = 90.0});
    }
    canvas_.text({left_, low - kBelow + 3.4},
                 first_ ? "mm from the start's long point, along the tube; L: from edge to edge"
                        : "mm, the same",
                 kGrey);
  }

  /// At the right: the lengths at the quarters, and the girth.
  void lengths() {
    for (int i = 0; i < 4; ++i) {
      const std::string name = "length_at_" + std::to_string(90 * i);
      for (const auto& d : part_.check_dimensions)
        if (d.name == name)
          canvas_.text({right_ + 4.0, y(0.5 * kPi * i) - 0.8}, "L " + number(d.value, Unit::mm),
                       {.height = 2.3, .color = "#1d7a46"});
    }
    const double at = right_ + 24.0;
    draw_arrows(canvas_, {at, top_.y}, {at, top_.y - high_}, kDimension);
    canvas_.text({at + 3.0, top_.y - 0.5 * high_}, "girth " + number(plan_.girth, Unit::mm),
                 {.height = 2.3, .anchor = Anchor::middle, .turn = 90.0});
  }

  Canvas& canvas_;
  const DevelopmentPlan& plan_;
  const DevelopmentPlan::Strip& strip_;
  const part::Part& part_;
  DrawingPoint top_;
  double high_ = 0.0, left_ = 0.0, right_ = 0.0;
  bool first_ = true, last_ = true;
};

}  // namespace

double DevelopmentPlan::height() const { return kAbove + scale.factor * girth + kBelow; }

DevelopmentPlan plan_development(const part::PartSpec& spec, const part::Part& part, double width) {
  DevelopmentPlan out{.scale = {}, .opened = phase_off_openings(part), .girth = {}, .strips = {}};
  out.girth = kTwoPi * spec.target.outer_radius;
  const double room = width - kLeft - kRight;
  double longest = 0.0;
  for (const auto& range : joined(surface_ranges(part, 0.0), 0.0))
    longest = std::max(longest, range.z_to - range.z_from);
  out.scale = drawing_scale(out.girth, kMostGirth);
  if (const auto other = drawing_scale(longest, room - 2.0 * kRoom);
      other.factor < out.scale.factor)
    out.scale = other;
  auto shown = joined(surface_ranges(part, out.scale.factor), kRoom / out.scale.factor);
  const bool grown = std::ranges::any_of(shown, [&](const SurfaceRange& range) {
    return out.scale.factor * (range.z_to - range.z_from) > room;
  });
  if (grown) shown = joined(surface_ranges(part, 0.0), 0.0);
  shown.front().z_from = std::min(shown.front().z_from, 0.0);
  out.strips = strips_of(shown, out.scale.factor, room);
  return out;
}

void draw_strip(Canvas& canvas, const DevelopmentPlan& plan, std::size_t index,
                const part::PartSpec& spec, const part::Part& part, DrawingPoint at) {
  const DrawingPoint top{at.x + kLeft, at.y - kAbove};
  canvas.text({at.x, at.y - 3.4},
              "Outside developed, seen from outside, " + plan.scale.name +
                  (plan.strips.size() > 1 ? ", strip " + std::to_string(index + 1) + " of " +
                                                std::to_string(plan.strips.size())
                                          : ""),
              {.height = 3.0, .bold = true});
  for (const auto& segment : plan.strips[index])
    SegmentDrawing(canvas, plan, segment, spec, part, top).draw();
  Beside(canvas, plan, index, part, top).draw();
}

}  // namespace tubecut::api
