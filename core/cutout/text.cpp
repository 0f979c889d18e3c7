#include "core/cutout/text.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/elementary.hpp"
#include "core/base/rounding.hpp"
#include "core/cutout/flats.hpp"
#include "core/math/rotation.hpp"

namespace tubecut::cutout {
namespace {

constexpr double kWithinFlat = 1e-9;  // mm, by rounding
constexpr const char* kOverCorner = "; over_corner true lets it go on";

/// How far strokes reach round the outside from their anchor, mm.
struct RoundReach {
  double from, to;
  [[nodiscard]] double length() const { return to - from; }
};

RoundReach reach_of(const std::vector<Stroke>& strokes) {
  const auto box = bounds(strokes);
  return {box.least.y(), box.most.y()};
}

Issue too_high(const TextSpec& spec, const RoundReach& reach, double room, std::string where) {
  return {.code = ErrorCode::out_of_range,
          .member = "height",
          .got = spec.height,
          .limit = rounded_down(spec.height * room / reach.length()),
          .unit = "mm",
          .hint = "the text is " + brief(reach.length()) + " mm long round the tube, and " +
                  std::move(where) + " " + brief(room) + " mm"};
}

/// Returns the reason why a text leaves the flat of its face.
std::vector<Issue> beyond_its_flat(const TextSpec& spec, const Lettering& one,
                                   const RoundReach& reach, const section::Curve& outer) {
  const double half = outer.half_flat(one.face);
  const double beyond = std::max(one.offset + reach.to - half, -half - one.offset - reach.from);
  if (beyond <= kWithinFlat) return {};
  const auto face = "the flat of face " + std::to_string(one.face);
  if (reach.length() > 2.0 * half + kWithinFlat)
    return {too_high(spec, reach, 2.0 * half, face + " is only")};
  const double low = -half - reach.from, high = half - reach.to;
  const bool above = one.offset > high;
  // A text that fills its flat fits at one offset, which rounding must not leave.
  const double rounded = above ? rounded_down(high) : rounded_up(low);
  const double wanted = rounded < low || rounded > high ? (above ? high : low) : rounded;
  const bool by_face = spec.at.face != 0;
  return {{.code = ErrorCode::out_of_range,
           .member = by_face ? "at/offset" : "at/girth",
           .got = by_face ? one.offset : outer.on_face(one.face, one.offset),
           .limit = by_face ? wanted : outer.on_face(one.face, wanted),
           .unit = "mm",
           .hint = "the text reaches " + brief(beyond) + " mm beyond " + face + ", which is " +
                   brief(2.0 * half) + " mm wide" + kOverCorner}};
}

/// Adds a point to a stroke wherever it crosses a seam.
Stroke split_at_seams(const Stroke& stroke, const section::Curve& outer) {
  Stroke out{stroke.front()};
  for (std::size_t i = 1; i < stroke.size(); ++i) {
    const Flat from = stroke[i - 1], to = stroke[i];
    std::vector<double> shares;
    const double low = std::min(from.y(), to.y()), high = std::max(from.y(), to.y());
    for (const double seam : outer.seams())
      for (double s = seam + outer.girth() * std::ceil((low - seam) / outer.girth()); s < high;
           s += outer.girth())
        if (s > low) shares.push_back((s - from.y()) / (to.y() - from.y()));
    std::ranges::sort(shares);
    for (const double share : shares) out.push_back(from + share * (to - from));
    out.push_back(to);
  }
  return out;
}

Lettering anchored(std::size_t asked, const TextSpec& spec, const Ground& ground) {
  Lettering out{.spec = spec, .asked = asked, .z = height_of(spec.at, ground)};
  if (!ground.section) {
    const double phi = spec.at.phi + (spec.at.opposite ? kPi : 0.0);
    out.s = ground.tube.outer_radius * math::whole_turn(phi);
    return out;
  }
  const auto& outer = ground.section->outer();
  const auto place = face_place(outer, spec.at);
  out.face = place.face;
  out.offset = place.offset;
  out.s = outer.on_face(place.face, place.offset);
  return out;
}

/// Returns the reasons why a text does not lie where it may.
std::vector<Issue> misplaced(const TextSpec& spec, const Lettering& one,
                             const std::vector<Stroke>& strokes, const Ground& ground) {
  const auto reach = reach_of(strokes);
  if (ground.section && !spec.over_corner)
    return beyond_its_flat(spec, one, reach, ground.section->outer());
  const double girth =
      ground.section ? ground.section->outer().girth() : kTwoPi * ground.tube.outer_radius;
  if (reach.length() < girth) return {};
  return {too_high(spec, reach, girth, "the outside is only")};
}

}  // namespace

std::vector<Stroke> written(const TextSpec& spec) {
  const double unit = spec.height / kGridHeight, up = spec.mirrored ? unit : -unit;
  const auto [sin, cos] = elementary::sincos(spec.turn);
  std::vector<Stroke> out;
  for (std::size_t i = 0; i < spec.text.size(); ++i)
    for (auto& stroke : letter(spec.text[i])) {
      for (auto& p : stroke) {
        const double a = unit * (kAdvance * static_cast<double>(i) + p.x()), b = up * p.y();
        p = {a * cos - b * sin, a * sin + b * cos};
      }
      out.push_back(std::move(stroke));
    }
  return out;
}

LaidTexts lay_texts(const std::vector<TextSpec>& specs, const Ground& ground) {
  LaidTexts out;
  for (std::size_t k = 0; k < specs.size(); ++k) {
    auto one = anchored(k, specs[k], ground);
    one.strokes = written(specs[k]);
    auto issues = misplaced(specs[k], one, one.strokes, ground);
    for (auto& issue : issues) {
      issue.member = path_of_text(k) + "/" + issue.member;
      out.issues.push_back(std::move(issue));
    }
    if (!issues.empty()) continue;
    for (auto& stroke : one.strokes) {
      for (auto& p : stroke) p += Flat(one.z, one.s);
      if (ground.section) stroke = split_at_seams(stroke, ground.section->outer());
    }
    out.all.push_back(std::move(one));
  }
  return out;
}

double off_grid(const Lettering& text) {
  const auto& spec = text.spec;
  const double unit = spec.height / kGridHeight;
  const auto [sin, cos] = elementary::sincos(spec.turn);
  double out = 0.0;
  for (const auto& stroke : text.strokes)
    for (const auto& end : {stroke.front(), stroke.back()}) {
      const double dz = end.x() - text.z, ds = end.y() - text.s;
      const double along = (dz * cos + ds * sin) / unit;
      const double up = (spec.mirrored ? 1.0 : -1.0) * (ds * cos - dz * sin) / unit;
      const double over = std::max({0.0, -up, up - kGridHeight});
      worsen(out, unit * worst_of({over, 0.5 * std::abs(std::remainder(2.0 * along, 1.0)),
                                   0.5 * std::abs(std::remainder(2.0 * up, 1.0))}));
    }
  return out;
}

Bounds bounds(const std::vector<Stroke>& strokes) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  Bounds out{Flat::Constant(kInfinite), Flat::Constant(-kInfinite)};
  for (const auto& stroke : strokes)
    for (const auto& p : stroke) {
      out.least = out.least.cwiseMin(p);
      out.most = out.most.cwiseMax(p);
    }
  return out;
}

std::string path_of_text(std::size_t asked) { return "texts/" + std::to_string(asked); }

}  // namespace tubecut::cutout
