#include "api/formats/drawing/template_labels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "api/stop.hpp"
#include "core/base/angle.hpp"

namespace tubecut::api {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kOff = 1.2;  // mm, of a text off an edge
constexpr std::string_view kName = "#38424d", kSide = "#1d242b", kMarkColor = "#2b6ca3",
                           kGrey = "#56626e";
constexpr Stroke kLeader{.color = "#56626e", .width = 0.15};

/// Baseline and top of capital letters, of the height.
double cap(const Lettering& l) { return 0.74 * l.height; }

DrawingBox moved(const DrawingBox& box, DrawingPoint by) {
  return {{box.low.x + by.x, box.low.y + by.y}, {box.high.x + by.x, box.high.y + by.y}};
}

DrawingBox common(const DrawingBox& a, const DrawingBox& b) {
  return {{std::max(a.low.x, b.low.x), std::max(a.low.y, b.low.y)},
          {std::min(a.high.x, b.high.x), std::min(a.high.y, b.high.y)}};
}

DrawingBox bounds(const std::vector<DrawingPoint>& points) {
  DrawingBox out{{kInfinity, kInfinity}, {-kInfinity, -kInfinity}};
  for (const auto& p : points) {
    out.low = {std::min(out.low.x, p.x), std::min(out.low.y, p.y)};
    out.high = {std::max(out.high.x, p.x), std::max(out.high.y, p.y)};
  }
  return out;
}

bool is_within(const std::vector<DrawingPoint>& outline, DrawingPoint p) {
  bool in = false;
  for (std::size_t i = 0, k = outline.size() - 1; i < outline.size(); k = i++) {
    const auto &a = outline[i], &b = outline[k];
    if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) in = !in;
  }
  return in;
}

bool is_within(const std::vector<DrawingPoint>& outline, const DrawingBox& box) {
  for (const double x : {box.low.x, 0.5 * (box.low.x + box.high.x), box.high.x})
    for (const double y : {box.low.y, box.high.y})
      if (!is_within(outline, DrawingPoint{x, y})) return false;
  return true;
}

}  // namespace

Skyline::Skyline(double width)
    : low_(static_cast<std::size_t>(std::ceil(width)) + 1, kInfinity),
      high_(low_.size(), -kInfinity) {}

void Skyline::add(const std::vector<DrawingPoint>& points, bool closed) {
  const auto most = static_cast<double>(low_.size() - 1);
  const auto bin = [&](double x) {
    return static_cast<std::size_t>(std::clamp(std::floor(x), 0.0, most));
  };
  const std::size_t count = points.size();
  for (std::size_t i = 0; i + (closed ? 0 : 1) < count; ++i) {
    auto a = points[i], b = points[(i + 1) % count];
    if (a.x > b.x) std::swap(a, b);
    const double slope = b.x > a.x ? (b.y - a.y) / (b.x - a.x) : 0.0;
    for (auto k = bin(a.x); k <= bin(b.x); ++k) {
      const double x0 = std::max(a.x, static_cast<double>(k));
      const double x1 = std::min(b.x, static_cast<double>(k) + 1.0);
      const double y0 = b.x > a.x ? a.y + slope * (x0 - a.x) : a.y;
      const double y1 = b.x > a.x ? a.y + slope * (x1 - a.x) : b.y;
      low_[k] = std::min({low_[k], y0, y1});
      high_[k] = std::max({high_[k], y0, y1});
    }
  }
}

Skyline::Range Skyline::range(double from, double to) const {
  const auto most = static_cast<double>(low_.size() - 1);
  const auto first = static_cast<std::size_t>(std::clamp(std::floor(from), 0.0, most));
  const auto last = static_cast<std::size_t>(std::clamp(std::floor(to), 0.0, most));
  return {*std::min_element(low_.begin() + static_cast<std::ptrdiff_t>(first),
                            low_.begin() + static_cast<std::ptrdiff_t>(last) + 1),
          *std::max_element(high_.begin() + static_cast<std::ptrdiff_t>(first),
                            high_.begin() + static_cast<std::ptrdiff_t>(last) + 1)};
}

/// The texts of one window of the drawing, in the canvas' coordinates.
struct TemplateLabels::Writing {
  Canvas& canvas;
  DrawingPoint by;  // of the drawing's origin
  DrawingBox room;  // shown part of the surface
  std::vector<DrawingBox> taken = {};
  double name_room = 45.0;  // mm, of a partner's name that its span is too short for

  [[nodiscard]] bool is_free(const DrawingBox& box) const {
    return room.holds(box) &&
           std::ranges::none_of(taken, [&](const auto& other) { return other.meets(box); });
  }
  bool put(DrawingPoint at, std::string_view what, const Lettering& l) {
    const auto box = text_box(at, what, l);
    if (!is_free(box)) return false;
    taken.push_back({{box.low.x - 0.5, box.low.y - 0.3}, {box.high.x + 0.5, box.high.y + 0.3}});
    canvas.text(at, what, l);
    return true;
  }
  /// The edge between two x of the canvas.
  [[nodiscard]] Skyline::Range edge(const Skyline& line, double from, double to) const {
    const auto out = line.range(from - by.x, to - by.x);
    return {out.low + by.y, out.high + by.y};
  }
  /// The lower left corner of a free rectangle above one edge and below another, next to the first
  /// that is shown; the middle of the window first.
  [[nodiscard]] std::optional<DrawingPoint> find(double width, double height, const Skyline* above,
                                                 const Skyline* below) const {
    constexpr int kSteps = 24, kRows = 30;
    const double left = room.low.x + 0.8, right = room.high.x - 0.8 - width;
    if (right < left) return std::nullopt;
    for (int i = 0; i <= kSteps; ++i) {
      const double off = 0.5 * ((i + 1) / 2) / (kSteps / 2);
      const double x = left + (0.5 + (i % 2 == 0 ? off : -off)) * (right - left);
      const double floor = above != nullptr ? edge(*above, x, x + width).high + kOff : -kInfinity;
      const double roof = below != nullptr ? edge(*below, x, x + width).low - kOff : kInfinity;
      const double low = std::max(floor, room.low.y + 0.5);
      const double high = std::min(roof, room.high.y - 0.5) - height;
      const bool upwards = floor > room.low.y, downwards = !upwards && roof < room.high.y;
      const double from = upwards ? low : downwards ? high : 0.5 * (low + high);
      for (int k = 0; k <= kRows; ++k) {
        const double way = upwards ? 1.0 : downwards ? -1.0 : k % 2 == 0 ? 0.5 : -0.5;
        const double y = from + way * k;
        if (y < low || y > high) {
          if (upwards || downwards) break;
          continue;
        }
        if (is_free({{x, y}, {x + width, y + height}})) return DrawingPoint{x, y};
      }
    }
    return std::nullopt;
  }
  bool write_between(std::string_view what, Lettering l, const std::vector<double>& heights,
                     const Skyline* above, const Skyline* below) {
    for (const double height : heights) {
      l.height = height;
      const auto box = text_box({0.0, 0.0}, what, l);
      const auto at = find(box.high.x, box.high.y - box.low.y, above, below);
      if (at && put({at->x, at->y - box.low.y}, what, l)) return true;
    }
    return false;
  }
};

TemplateLabels::TemplateLabels(const Development& development, const TemplateField& field,
                               const Caption& caption, std::string part)
    : d_(development),
      field_(field),
      caption_(caption),
      part_(std::move(part)),
      start_(field.width()),
      finish_(field.width()),
      holes_(field.width()) {
  bool finish = false;  // of a part the second cut round it
  for (const auto& cut : development.cuts) {
    ask();
    auto& line = cut.around ? finish ? finish_ : start_ : holes_;
    for (const auto* curve : {&cut.outer, &cut.inner, &cut.torch})
      for (const auto& points : copies_on(field, *curve, !cut.around && development.around()))
        line.add(points, !cut.around);
    finish = finish || cut.around;
    if (!cut.around && !cut.outer.empty())
      hole_labels_.push_back(
          {cut.label, label_place(cut), copies_on(field, cut.outer, development.around())});
  }
}

void TemplateLabels::draw(Canvas& canvas, const DrawingBox& window, DrawingPoint by) const {
  Writing w{.canvas = canvas, .by = by, .room = moved(common(window, field_.surface()), by)};
  for (const auto& ink : canvas.drawn())
    if (ink.kind == Ink::Kind::text)
      w.taken.push_back(text_box(ink.points.front(), ink.text, ink.lettering));
  for (const auto& hole : hole_labels_) write_hole(w, hole);
  for (const auto& mark : d_.marks) write_mark(w, mark);
  share_name_room(w);
  for (const auto& span : d_.spans) write_partner(w, span);
  write_sides(w);
  if (!d_.around()) return;
  const auto surface = field_.surface(),
             shown = common(window, {{0.0, 0.0}, {field_.width(), field_.height()}});
  const double tab =
      field_.mirrored ? 0.5 * surface.low.x : 0.5 * (surface.high.x + field_.width());
  w.room = moved(shown, by);
  w.put({tab + by.x + 0.8, 0.5 * (shown.low.y + shown.high.y) + by.y},
        d_.section ? "glue below girth 0" : "glue below phi 0",
        {.height = 2.4, .anchor = Anchor::middle, .turn = 90.0, .color = kGrey});
}

/// Writes its name in it, or above it if it is too small; SCRAP in it, or below it with a line to
/// it.
void TemplateLabels::write_hole(Writing& w, const Hole& hole) const {
  const Lettering plain{.height = 2.8, .anchor = Anchor::middle, .bold = true, .color = kName};
  const auto l = fitted(hole.label, plain, hole.place.room);
  const auto name = shortened(hole.label, l.height, std::max(30.0, hole.place.room), true);
  const Lettering scrap{.height = 2.4, .anchor = Anchor::middle, .bold = true, .color = kSide};
  bool named = hole.label.empty();
  for (const auto& outline : hole.outlines) {
    ask();
    auto line = outline;
    for (auto& p : line) p = {p.x + w.by.x, p.y + w.by.y};
    const auto box = bounds(line), seen = common(box, w.room);
    if (seen.low.x >= seen.high.x || seen.low.y >= seen.high.y) continue;
    const double middle = 0.5 * (seen.low.x + seen.high.x), tall = seen.high.y - seen.low.y;
    const double place = field_.at(0.0, hole.place.z).y + w.by.y;
    const double half = 0.5 * text_width(name, l.height, true) + 1.0;
    const double x = std::max(std::min(middle, w.room.high.x - half), w.room.low.x + half);
    const auto put_inside = [&](std::string_view what, const Lettering& with, double share) {
      const DrawingPoint at{middle, seen.low.y + share * tall};
      return is_within(line, text_box(at, what, with)) && w.put(at, what, with);
    };
    const auto put_somewhere = [&](std::string_view what, const Lettering& with,
                                   std::initializer_list<double> shares) {
      return std::ranges::any_of(shares,
                                 [&](double share) { return put_inside(what, with, share); });
    };
    named = named || (place > box.low.y && w.put({x, place}, name, l)) ||
            put_somewhere(name, l, {0.75, 0.65, 0.55, 0.85, 0.3, 0.15}) ||
            w.put({x, box.high.y + 1.5}, name, l) || w.put({x, box.low.y - 5.5}, name, l);
    const bool written =
        std::ranges::any_of(std::initializer_list<double>{5.0, 4.0, 3.2}, [&](double h) {
          auto large = scrap;
          large.height = h;
          return put_somewhere("SCRAP", large, {0.45, 0.35, 0.25, 0.6});
        });
    if (written || put_somewhere("SCRAP", scrap, {0.45, 0.35, 0.25, 0.6, 0.7, 0.15})) continue;
    const double half_scrap = 0.5 * text_width("SCRAP", scrap.height, true) + 1.0;
    const double beside =
        std::max(std::min(middle, w.room.high.x - half_scrap), w.room.low.x + half_scrap);
    for (const double off : {kOff + cap(scrap), 5.0, 8.0})
      if (w.put({beside, box.low.y - off}, "SCRAP", scrap)) {
        w.canvas.line({beside, box.low.y - off + cap(scrap) + 0.3},
                      {middle, box.low.y + std::min(2.0, 0.4 * (box.high.y - box.low.y))}, kLeader);
        break;
      }
  }
}

void TemplateLabels::write_mark(Writing& w, const part::Mark& mark) const {
  if (mark.kind == part::Mark::Kind::datum_line || mark.lettering) return;
  const double phi = mark.phi - kTwoPi * std::floor(mark.phi / kTwoPi);
  const auto from = field_.at(field_.radius * phi, mark.z_from);
  const DrawingPoint at{from.x + w.by.x, from.y + w.by.y};
  if (at.x < w.room.low.x || at.x > w.room.high.x) return;
  const double room = std::min(60.0, 0.5 * field_.surface().high.x - field_.surface().low.x);
  Lettering l{.height = 2.8, .color = kMarkColor};
  l = fitted(mark.text, l, room);
  const auto name = shortened(mark.text, l.height, std::max(room, 8.0));
  const bool right = at.x > 0.5 * (w.room.low.x + w.room.high.x);
  for (const double up : {-4.2, 2.2, -8.0, 6.0})
    for (const bool before : {right, !right}) {
      l.anchor = before ? Anchor::end : Anchor::start;
      if (w.put({at.x + (before ? -1.0 : 1.0), at.y + up}, name, l)) return;
    }
}

std::optional<TemplateLabels::VisibleSpan> TemplateLabels::visible_span(
    const Writing& w, const PartnerSpan& span) const {
  const auto& names = span.finish ? caption_.finish_partners : caption_.partners;
  if (span.partner >= names.size()) return std::nullopt;
  double a = field_.at(field_.radius * span.phi_from, 0.0).x + w.by.x;
  double b = field_.at(field_.radius * span.phi_to, 0.0).x + w.by.x;
  if (a > b) std::swap(a, b);
  a = std::max(a, w.room.low.x) + 0.3;
  b = std::min(b, w.room.high.x) - 0.3;
  if (b - a < 0.5) return std::nullopt;
  return VisibleSpan{a, b, names[span.partner]};
}

/// Shortens the names next to their segments until all fit next to each other.
void TemplateLabels::share_name_room(Writing& w) const {
  double wanted = 0.0, count = 0.0;
  for (const auto& span : d_.spans)
    if (const auto s = visible_span(w, span)) {
      const double width = text_width(s->name, kLeastText);
      if (width <= s->to - s->from) continue;
      wanted += std::min(width, w.name_room);
      count += 1.0;
    }
  constexpr double kLeast = 9.0;  // four letters and the ellipsis
  const double room = w.room.high.x - w.room.low.x - 2.0;
  if (wanted > room) w.name_room = std::max(kLeast, room / count);
}

/// Writes the name on the side of the scrap: along its segment of the edge, or, if that is too
/// short, with a line to it.
void TemplateLabels::write_partner(Writing& w, const PartnerSpan& span) const {
  const auto visible = visible_span(w, span);
  if (!visible) return;
  const auto& [a, b, name] = *visible;
  const auto& line = span.finish ? finish_ : start_;
  Lettering l{.height = 2.8, .anchor = Anchor::middle, .color = kName};
  if (text_width(name, kLeastText) <= b - a) {
    l = fitted(name, l, b - a);
    const double half = 0.5 * text_width(name, l.height);
    for (const double share : {0.5, 0.35, 0.65, 0.2, 0.8, 0.0, 1.0}) {
      const double x = a + half + share * (b - a - 2.0 * half);
      const auto edge = w.edge(line, x - half, x + half);
      const double y = span.finish ? edge.high + kOff : edge.low - kOff - cap(l);
      if (std::isfinite(y) && w.put({x, y}, name, l)) return;
    }
  }
  constexpr int kRows = 16;
  l.height = kLeastText;
  const auto text =
      shortened(name, l.height, std::min(w.name_room, w.room.high.x - w.room.low.x - 1.0));
  for (const double share : {0.5, 0.25, 0.75, 0.05, 0.95})
    for (const double side : {0.0, 1.0, -1.0})
      for (int k = 0; k < kRows; ++k)
        if (write_beside(w, line, span.finish, a + share * (b - a), side, k, text, l)) return;
}

/// Writes in the row `k` off the edge, its middle over the line's foot or next to it.
bool TemplateLabels::write_beside(Writing& w, const Skyline& line, bool finish, double foot,
                                  double side, int k, const std::string& text, const Lettering& l) {
  constexpr double kRow = 3.2;
  const double half = 0.5 * text_width(text, l.height), way = finish ? 1.0 : -1.0;
  const double x = std::max(std::min(foot + side * 0.8 * half, w.room.high.x - half - 0.3),
                            w.room.low.x + half + 0.3);
  const auto under = w.edge(line, x - half, x + half), at = w.edge(line, foot - 0.4, foot + 0.4);
  const double edge = finish ? under.high : under.low, near = finish ? at.high : at.low;
  if (!std::isfinite(edge) || !std::isfinite(near)) return false;
  const double y = edge + way * (kOff + 0.4 + kRow * k) - (finish ? 0.0 : cap(l));
  const double end = finish ? y - 0.4 : y + cap(l) + 0.4, to = near + way * 0.3;
  const DrawingBox leader{{foot - 0.2, std::min(end, to)}, {foot + 0.2, std::max(end, to)}};
  if (!w.is_free(leader) || !w.put({x, y}, text, l)) return false;
  w.canvas.line({foot, end}, {foot, to}, kLeader);
  w.taken.push_back(leader);
  return true;
}

/// Writes KEEP and SCRAP next to the edges that separate them; in the kept side also the upward
/// direction, and the part.
void TemplateLabels::write_sides(Writing& w) const {
  const std::vector<double> loud{6.0, 5.0, 4.0, 3.2, 2.6, kLeastText};
  const Lettering side{.bold = true, .color = kSide};
  const bool around = d_.around();
  const auto* above = around ? &start_ : &holes_;
  const auto* below = d_.whole ? &finish_ : nullptr;
  for (const auto& hole : hole_labels_)
    for (const auto& outline : hole.outlines) w.taken.push_back(moved(bounds(outline), w.by));
  if (around) w.write_between("SCRAP", side, loud, nullptr, &start_);
  if (d_.whole) w.write_between("SCRAP", side, loud, &finish_, nullptr);
  if (!w.write_between("KEEP", side, loud, above, below) && !around)
    w.write_between("KEEP", side, loud, nullptr, &holes_);
  const std::string_view up = !around ? "up: +z" : d_.whole ? "up: finish" : "up: kept side";
  const double width = text_width(up, kLeastText) + 3.6, height = 6.0;
  if (const auto at = w.find(width, height, above, below)) {
    draw_arrow(w.canvas, {at->x + 1.2, at->y + 0.3}, {at->x + 1.2, at->y + height - 0.3},
               {.color = kSide, .width = 0.3});
    w.put({at->x + 3.0, at->y + 2.2}, up, {.height = kLeastText, .color = kSide});
    w.taken.push_back({*at, {at->x + width, at->y + height}});
  }
  if (!part_.empty() && around)
    w.write_between(shortened(part_, 3.4, std::max(8.0, w.room.high.x - w.room.low.x - 4.0), true),
                    side, {3.4, 2.8, kLeastText}, above, below);
}

}  // namespace tubecut::api
