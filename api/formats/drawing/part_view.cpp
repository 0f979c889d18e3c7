#include "api/formats/drawing/part_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "api/formats/drawing/labels.hpp"
#include "api/formats/drawing/part_edges.hpp"
#include "core/base/elementary.hpp"

namespace tubecut::api {
namespace {

constexpr int kPhases = 180;
constexpr double kAlong = 30.0 * kRadPerDeg;  // the tube runs to the right, and back by this angle
constexpr double kFront =
    -40.0 * kRadPerDeg;  // rotation of the most interesting side, upwards from the front
constexpr Stroke kEdge{.color = "#1c2733", .width = 0.3};
constexpr Stroke kDatum{.color = "#c0392b", .width = 0.35};
constexpr Stroke kHidden{.color = "#c0392b", .width = 0.2, .dashes = "1.2 1.2"};
constexpr Lettering kWord{.height = 2.6, .color = "#566370"};

/// Colours from shadow to light, in 32 steps.
class Shades {
 public:
  Shades(int red, int green, int blue) {
    static constexpr char kHex[] = "0123456789abcdef";
    for (std::size_t i = 0; i < names_.size(); ++i) {
      const double light = 0.55 + 0.45 * static_cast<double>(i) / (names_.size() - 1);
      names_[i] = "#";
      for (const int channel : {red, green, blue}) {
        const auto v = static_cast<unsigned>(std::lround(channel * light));
        names_[i] += {kHex[v >> 4U], kHex[v & 15U]};
      }
    }
  }
  [[nodiscard]] std::string_view at(double light) const {
    const double top = static_cast<double>(names_.size() - 1);
    return names_[static_cast<std::size_t>(std::lround(top * std::clamp(light, 0.0, 1.0)))];
  }

 private:
  std::array<std::string, 32> names_;
};

const Shades& outside_shades() {
  static const Shades kOutside(0xcf, 0xdb, 0xe8);
  return kOutside;
}
const Shades& bore_shades() {
  static const Shades kBore(0x9f, 0xb2, 0xc6);
  return kBore;
}
constexpr std::string_view kCutFace = "#e9b872", kDeep = "#6f8296";

/// Plain stretches longer than a tube's width and a half are drawn shorter.
class Shortened {
 public:
  Shortened(const part::Part& part, double diameter) {
    std::vector<SurfaceRange> ranges{surface_range(part.start.table),
                                     surface_range(part.finish.table)};
    for (const auto& one : openings(part)) ranges.push_back(surface_range(one.rows));
    std::ranges::sort(ranges, {}, &SurfaceRange::z_from);
    double end = ranges.front().z_to;
    for (const auto& range : ranges) {
      if (range.z_from - end > 1.5 * diameter)
        cuts_.push_back({.at = 0.5 * (end + range.z_from),
                         .less = range.z_from - end - diameter,
                         .from = end + 0.5 * diameter,
                         .to = range.z_from - 0.5 * diameter});
      end = std::max(end, range.z_to);
    }
  }
  [[nodiscard]] double operator()(double z) const {
    double less = 0.0;
    for (const auto& cut : cuts_) less += std::clamp(z - cut.from, 0.0, cut.to - cut.from);
    return z - less;
  }
  [[nodiscard]] std::vector<double> breaks() const {
    std::vector<double> out;
    for (const auto& cut : cuts_) out.push_back((*this)(cut.from));
    return out;
  }

 private:
  struct Cut {
    double at, less, from, to;
  };
  std::vector<Cut> cuts_;
};

class View {
 public:
  View(Canvas& canvas, const part::PartSpec& spec, const part::Part& part, const Cell& room)
      : canvas_(canvas),
        part_(part),
        openings_(openings(part)),
        welded_(spec.start.welded),
        outer_(spec.target.outer_radius),
        inner_(spec.target.inner_radius()),
        shortened_(part, 2.0 * outer_),
        start_outer_(part.start.table.phi, part.start.table.z_outer, 0.0),
        start_inner_(part.start.table.phi, part.start.table.z_inner, 0.0),
        finish_outer_(part.finish.table.phi, part.finish.table.z_outer, 0.0),
        finish_inner_(part.finish.table.phi, part.finish.table.z_inner, 0.0),
        roll_(kFront - focus()) {
    fit(room);
  }

  void draw() {
    bore();
    face(finish_outer_, finish_inner_, false);
    face(start_outer_, start_inner_, true);
    outside();
    edges();
    datum();
    for (const auto& one : openings_) opening(one.rows);
    breaks();
    words();
  }

 private:
  struct Seen {
    double x, y, depth;
  };
  [[nodiscard]] Seen turned(double radius, double phi, double z) const {
    const auto [sin, cos] = elementary::sincos(phi + roll_);
    const auto [sin_along, cos_along] = elementary::sincos(kAlong);
    const double s = shortened_(z);
    return {s * cos_along + radius * cos * sin_along, -radius * sin,
            s * sin_along - radius * cos * cos_along};
  }
  [[nodiscard]] DrawingPoint at(double radius, double phi, double z) const {
    const auto p = turned(radius, phi, z);
    return {at_.x + scale_ * p.x, at_.y + scale_ * p.y};
  }
  /// Of the outward normal, towards the eye.
  [[nodiscard]] double faces(double phi) const {
    return elementary::sincos(phi + roll_).cos * elementary::sincos(kAlong).cos;
  }
  /// Returns the phase to turn to the front: the widest hole, else the deepest point of the start's
  /// cut.
  [[nodiscard]] double focus() const {
    const bevel::Hole* widest = nullptr;
    for (const auto& one : openings_)
      if (widest == nullptr || one.rows.length_total > widest->length_total) widest = &one.rows;
    if (widest == nullptr) return part_.start.shortest.phi;
    const auto range = surface_range(*widest);
    return 0.5 * (range.phi_from + range.phi_to);
  }

  struct Tag {
    const Opening* opening;
    bool seen;
    std::string text;  // in brackets if the opening is behind the tube
  };
  /// Returns the tags in the order of their places along the tube.
  [[nodiscard]] std::vector<Tag> tags() const {
    std::vector<Tag> out;
    for (const auto& one : openings_) {
      if (!one.tagged) continue;
      const auto range = surface_range(one.rows);
      const bool seen = faces(0.5 * (range.phi_from + range.phi_to)) >= 0.1;
      out.push_back({&one, seen, seen ? one.tag : "(" + one.tag + ")"});
    }
    std::ranges::stable_sort(out, {}, [](const Tag& tag) {
      const auto range = surface_range(tag.opening->rows);
      return range.z_from + range.z_to;
    });
    return out;
  }
  static double apart(const std::vector<Tag>& tags) {
    double widest = 5.5;
    for (const auto& tag : tags) widest = std::max(widest, text_width(tag.text, kTagHeight, true));
    return widest + 1.5;
  }

  void fit(const Cell& room) {
    double left = 1e300, right = -1e300;
    for (int i = 0; i < kPhases; ++i)
      for (const auto* edge : {&start_outer_, &finish_outer_, &start_inner_, &finish_inner_}) {
        const auto p = turned(outer_, phase(i), edge->at(phase(i)));
        left = std::min(left, p.x);
        right = std::max(right, p.x);
      }
    const double w = room.high.x - room.low.x - 30.0, h = room.high.y - room.low.y - 12.0;
    const auto all = tags();
    const auto side_by_side = static_cast<std::size_t>(std::max(1.0, w / apart(all)));
    rows_of_tags_ = std::max<std::size_t>(1, (all.size() + side_by_side - 1) / side_by_side);
    const double more = kTagRow * static_cast<double>(rows_of_tags_ - 1);
    scale_ = std::min(w / (right - left), (h - more) / (2.0 * outer_));
    at_ = {0.5 * (room.low.x + room.high.x) - 0.5 * scale_ * (left + right),
           0.5 * (room.low.y + room.high.y) - 1.0 - 0.5 * more};
    left_ = at_.x + scale_ * left;
    right_ = at_.x + scale_ * right;
    high_ = at_.y + scale_ * outer_;
  }
  static double phase(int i) { return kTwoPi * i / kPhases; }

  void quad(std::array<DrawingPoint, 4> corners, std::string_view color) {
    canvas_.polyline({corners.begin(), corners.end()},
                     {.color = color, .width = 0.3, .fill = color}, {}, true);
  }
  void along(const RoundEdge& from, const RoundEdge& to, double radius, int i,
             std::string_view color) {
    const double p = phase(i), q = phase(i + 1);
    quad({at(radius, p, from.at(p)), at(radius, q, from.at(q)), at(radius, q, to.at(q)),
          at(radius, p, to.at(p))},
         color);
  }
  void outside() {
    for (int i = 0; i < kPhases; ++i)
      if (const double light = faces(phase(i) + 0.5 * phase(1)); light > 0.0)
        along(start_outer_, finish_outer_, outer_, i, outside_shades().at(light));
  }
  void bore() {
    for (int i = 0; i < kPhases; ++i)
      if (const double light = -faces(phase(i) + 0.5 * phase(1)); light > 0.0)
        along(start_inner_, finish_inner_, inner_, i, bore_shades().at(0.7 * light));
  }
  /// Draws the furthest first, so that nearer faces hide those behind them.
  void face(const RoundEdge& outer, const RoundEdge& inner, bool edged) {
    std::vector<std::pair<double, int>> order;
    for (int i = 0; i < kPhases; ++i)
      order.emplace_back(-turned(outer_, phase(i), outer.at(phase(i))).depth, i);
    std::ranges::sort(order);
    for (const auto& [depth, i] : order) {
      const double p = phase(i), q = phase(i + 1);
      quad({at(outer_, p, outer.at(p)), at(outer_, q, outer.at(q)), at(inner_, q, inner.at(q)),
            at(inner_, p, inner.at(p))},
           kCutFace);
      if (edged) start_edge(i);
    }
  }
  void start_edge(int i) {
    const double p = phase(i), q = phase(i + 1);
    canvas_.line(at(outer_, p, start_outer_.at(p)), at(outer_, q, start_outer_.at(q)),
                 {.color = color_at(p), .width = 0.5});
  }

  void edges() {
    for (int i = 0; i < kPhases; ++i) {
      const double p = phase(i), q = phase(i + 1);
      if (faces(p) < 0.0 || faces(q) < 0.0) continue;
      canvas_.line(at(outer_, p, finish_outer_.at(p)), at(outer_, q, finish_outer_.at(q)), kEdge);
    }
    for (int i = 0; i < kPhases; ++i)
      if (faces(phase(i)) > 0.0) start_edge(i);
    for (const double side : {-0.5 * kPi, 0.5 * kPi})
      canvas_.line(at(outer_, side - roll_, start_outer_.at(side - roll_)),
                   at(outer_, side - roll_, finish_outer_.at(side - roll_)), kEdge);
  }
  [[nodiscard]] std::string_view color_at(double phi) const {
    const auto& t = part_.start.table;
    std::size_t best = 0;
    double least = kTwoPi;
    for (std::size_t i = 0; i < t.phi.size(); ++i) {
      const double off = std::abs(turned_from(phi - kPi, t.phi[i]) - phi);
      if (off < least) {
        least = off;
        best = i;
      }
    }
    return welded_ ? partner_color(t.cutter[best]) : kEdge.color;
  }

  /// Its edge on one wall as far as that faces the eye.
  [[nodiscard]] std::vector<DrawingPoint> ring(double radius, const std::vector<double>& phi,
                                               const std::vector<double>& z) const {
    std::vector<DrawingPoint> out;
    const double turn = turned_from(-kPi, phi.front() + roll_) - (phi.front() + roll_);
    for (std::size_t i = 0; i < phi.size(); ++i) {
      const double shown = std::clamp(phi[i] + roll_ + turn, -0.5 * kPi, 0.5 * kPi);
      out.push_back(at(radius, shown - roll_, z[i]));
    }
    return out;
  }
  void opening(const bevel::Hole& hole) {
    const auto range = surface_range(hole);
    if (faces(0.5 * (range.phi_from + range.phi_to)) < 0.1) return;
    const auto border = ring(outer_, hole.phi, hole.z);
    canvas_.polyline(border, {.color = "none", .width = 0.1, .fill = kCutFace}, {}, true);
    canvas_.begin_clip(border);
    canvas_.polyline(ring(inner_, hole.phi_inner, hole.z_inner),
                     {.color = kEdge.color, .width = 0.15, .fill = kDeep}, {}, true);
    canvas_.end_group();
    canvas_.polyline(border, kEdge, {}, true);
  }

  void breaks() {
    for (const double s : shortened_.breaks()) {
      std::vector<DrawingPoint> line;
      for (int i = 0; i <= 24; ++i) {
        const double phi = -0.5 * kPi + kPi * i / 24.0;
        const double wave = 0.12 * outer_ * elementary::sincos(4.0 * phi).sin;
        const auto [sin, cos] = elementary::sincos(phi);
        const auto [sin_along, cos_along] = elementary::sincos(kAlong);
        line.push_back({at_.x + scale_ * ((s + wave) * cos_along + outer_ * cos * sin_along),
                        at_.y - scale_ * outer_ * sin});
      }
      canvas_.polyline(line, {.color = "#ffffff", .width = 1.2});
      for (const double side : {-0.6, 0.6}) {
        auto one = line;
        for (auto& p : one) p.x += side;
        canvas_.polyline(one, {.color = "#566370", .width = 0.2});
      }
    }
  }

  void datum() {
    canvas_.line(at(outer_, 0.0, start_outer_.at(0.0)), at(outer_, 0.0, finish_outer_.at(0.0)),
                 faces(0.0) > 0.0 ? kDatum : kHidden);
    canvas_.text({right_ + 2.0, at(outer_, 0.0, finish_outer_.at(0.0)).y - 0.8}, "phi 0",
                 {.height = 2.4, .color = kDatum.color});
  }
  /// Draws the tags in rows above, each with a line to its hole.
  void words() {
    const auto all = tags();
    for (std::size_t row = 0; row < rows_of_tags_; ++row) {
      std::vector<double> wanted;
      for (auto i = row; i < all.size(); i += rows_of_tags_)
        wanted.push_back(middle(all[i].opening->rows).x);
      const auto places = spread(wanted, apart(all), left_, right_);
      const double low = high_ + 2.2 + kTagRow * static_cast<double>(row);
      for (std::size_t k = 0; k < places.size(); ++k) {
        const auto& tag = all[row + k * rows_of_tags_];
        const auto centre = middle(tag.opening->rows);
        canvas_.line({places[k], low}, tag.seen ? centre : DrawingPoint{centre.x, high_},
                     {.color = "#566370", .width = 0.15});
        canvas_.text({places[k], low + 0.6}, tag.text,
                     {.height = kTagHeight, .anchor = Anchor::middle, .bold = true});
      }
    }
    auto right = kWord;
    right.anchor = Anchor::end;
    canvas_.text({left_ - 2.0, at_.y}, "start", right);
    canvas_.text({right_ - 2.0, at_.y - scale_ * outer_ - 3.5}, "finish", right);
  }
  [[nodiscard]] DrawingPoint middle(const bevel::Hole& hole) const {
    const auto range = surface_range(hole);
    return at(outer_, 0.5 * (range.phi_from + range.phi_to), 0.5 * (range.z_from + range.z_to));
  }

  Canvas& canvas_;
  const part::Part& part_;
  std::vector<Opening> openings_;
  bool welded_;
  double outer_, inner_;
  Shortened shortened_;
  RoundEdge start_outer_, start_inner_, finish_outer_, finish_inner_;
  double roll_;
  double scale_ = 1.0, left_ = 0.0, right_ = 0.0, high_ = 0.0;
  std::size_t rows_of_tags_ = 1;
  DrawingPoint at_;
};

}  // namespace

void draw_part_view(Canvas& canvas, const part::PartSpec& spec, const part::Part& part,
                    const Cell& room) {
  View(canvas, spec, part, room).draw();
}

}  // namespace tubecut::api
