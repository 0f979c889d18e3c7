#include "core/cutout/sizes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>

#include "core/base/elementary.hpp"
#include "core/base/rounding.hpp"
#include "core/cutout/flats.hpp"
#include "core/cutout/pattern.hpp"
#include "core/cutout/rows.hpp"
#include "core/math/mixed.hpp"

namespace tubecut::cutout {
namespace {

/// What is below its least.
void at_least(double value, double least, bool equal, const char* member, const char* hint,
              std::vector<Issue>& out) {
  if (!std::isfinite(least)) return;  // it reaches beyond the bore, which check_open reports
  const double slack = 1e-9 * least;
  if (equal ? value >= least - slack : value > least) return;
  out.push_back({.code = ErrorCode::out_of_range,
                 .member = member,
                 .got = value,
                 .limit = least,
                 .unit = "mm",
                 .hint = hint});
}

constexpr double kInside = 1e-3;  // mm, between a prism's edge and the bore's width

constexpr const char* kNarrow = "the beam is as wide as the kerf, and wider on the bore";
constexpr const char* kTight =
    "the beam cannot follow a tighter corner; corners as_cut accepts what it leaves";

/// Over corners, a prism's lines cross the bore, to each side of an anchor of its own.
std::vector<Issue> check_open_over(const Bounds& box, const SectionLay& over) {
  const auto reach = over.reach();
  const double more = box.most.y() - (reach.most.y() - kInside);
  const double less = reach.least.y() + kInside - box.least.y();
  if (more <= 0.0 && less <= 0.0) return {};
  return {{.code = ErrorCode::open_profile,
           .member = "shape",
           .got = more > less ? box.most.y() : -box.least.y(),
           .limit = rounded_down((more > less ? reach.most.y() : -reach.least.y()) - kInside),
           .unit = "mm",
           .hint = "to one side of its anchor it reaches beyond the bore, seen along the anchor's "
                   "normal; lay it on the wall by wall developed, or make it less wide"}};
}

struct Sizes {
  const Spec& spec;
  const Laying& laying;
  double kerf;

  /// Twice the least radius: what a shape is wide at least.
  [[nodiscard]] double width(double b) const { return 2.0 * least_radius(laying, kerf, b); }
  /// The same of one that reaches so far. Beyond the bore no beam follows it.
  [[nodiscard]] double width(const Bounds& box) const {
    const bool over = laying.over() != nullptr && laying.lay() == Lay::bored;
    return over && !check_open_over(box, *laying.over()).empty()
               ? std::numeric_limits<double>::infinity()
               : width(box.most.y());
  }
  [[nodiscard]] bool prism() const { return laying.parallel(); }

  /// Returns the issue of a shape that is wide enough near its middle, but reaches so near the
  /// bore's width that a beam square to the wall is wider there than the shape.
  [[nodiscard]] std::vector<Issue> near_bore(double reach, double narrowest) const {
    constexpr int kHalvings = 60;
    const bool here =
        laying.lay() == Lay::bored && laying.over() == nullptr && reach < laying.inner();
    if (!here || width(reach) < narrowest || !(width(0.0) < narrowest)) return {};
    double low = 0.0, high = reach;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (low + high);
      (width(middle) < narrowest ? low : high) = middle;
    }
    return {{.code = ErrorCode::out_of_range,
             .member = "shape",
             .got = 2.0 * reach,
             .limit = rounded_down(2.0 * low),
             .unit = "mm",
             .hint = "across it reaches so near the bore's width that the beam, square to the "
                     "wall, is wider there than the shape; make it less wide across, or lay it on "
                     "the wall by wall developed"}};
  }

  std::vector<Issue> operator()(const Circle& c) const {
    if (auto out = near_bore(0.5 * c.diameter, c.diameter); !out.empty()) return out;
    std::vector<Issue> out;
    at_least(c.diameter, width(bounds(circle(c.diameter))), !prism(), "shape/diameter", kNarrow,
             out);
    return out;
  }
  std::vector<Issue> operator()(const Slot& s) const {
    std::vector<Issue> out;
    at_least(s.length, s.width, true, "shape/length", "over all, so at least the width", out);
    const auto box = bounds(turned(slot(std::max(s.length, s.width), s.width), spec.turn));
    if (auto near = near_bore(box.most.y(), s.width); !near.empty()) return near;
    at_least(s.width, width(box), !prism(), "shape/width", kNarrow, out);
    return out;
  }
  std::vector<Issue> operator()(const Rectangle& r) const {
    std::vector<Issue> out;
    const double most = 0.5 * std::min(r.along, r.round);
    const auto box =
        bounds(turned(rectangle(r.along, r.round, std::min(r.radius, most)), spec.turn));
    if (auto near = near_bore(box.most.y(), 2.0 * most); !near.empty()) return near;
    const double least = width(box);
    at_least(r.along, least, !prism(), "shape/along", kNarrow, out);
    at_least(r.round, least, !prism(), "shape/round", kNarrow, out);
    if (r.radius > most)
      out.push_back({.code = ErrorCode::out_of_range,
                     .member = "shape/corner_radius",
                     .got = r.radius,
                     .limit = most,
                     .unit = "mm",
                     .hint = "at most half of the shorter side"});
    if (!spec.as_cut && out.empty())
      at_least(r.radius, 0.5 * least, true, "shape/corner_radius", kTight, out);
    return out;
  }
  std::vector<Issue> operator()(const Contour&) const { return {}; }
  std::vector<Issue> operator()(const Slit& s) const {
    constexpr double kAlong = 1e-12;  // of its length
    if (!(s.width > 0.0))
      return {{.code = ErrorCode::out_of_range,
               .member = "shape",
               .got = s.width,
               .limit = 0.0,
               .unit = "mm",
               .hint = "a slit is as wide as the kerf, which is more than the limit"}};
    const bool leans = lay_of(spec.wall, spec.tilt) == Lay::prism;
    if (laying.lay() == Lay::flat || leans || std::abs(elementary::sin(spec.turn)) <= kAlong)
      return {};
    return {{.code = ErrorCode::unsupported_combination,
             .member = "shape/angle",
             .got = spec.turn * kDegPerRad,
             .limit = 0.0,
             .unit = "deg",
             .hint =
                 "round the tube the beam takes the same width at every depth only if it leans: "
                 "wall normal or through with tilt free"}};
  }
};

/// How deep a place lies within the chain, mm; below 0 outside.
double depth(const Chain& chain, const Flat& p) {
  const double least = distance(chain, p);
  return holds(chain, p) ? least : -least;
}

struct Middle {
  const Chain& chain;

  Flat operator()(const Circle&) const { return Flat::Zero(); }
  Flat operator()(const Slot&) const {
    Flat best = Flat::Zero();
    for (const auto& s : chain)
      if (s.arc() && s.centre.x() < best.x()) best = s.centre;
    return best;
  }
  Flat operator()(const Rectangle&) const { return Flat::Zero(); }
  Flat operator()(const Slit&) const { return Flat::Zero(); }
  /// By a grid that grows finer about its best.
  Flat operator()(const Contour&) const {
    constexpr int kPlaces = 16, kRounds = 4;
    const auto box = bounds(chain);
    Flat best = 0.5 * (box.least + box.most), half = 0.5 * (box.most - box.least);
    double deepest = depth(chain, best);
    for (int round = 0; round < kRounds; ++round) {
      const Flat middle = best;
      for (int i = -kPlaces; i <= kPlaces; ++i)
        for (int j = -kPlaces; j <= kPlaces; ++j) {
          const Flat p = middle + Flat(half.x() * i / kPlaces, half.y() * j / kPlaces);
          if (const double here = depth(chain, p); here > deepest) {
            deepest = here;
            best = p;
          }
        }
      half *= 2.0 / kPlaces;
    }
    return best;
  }
};

}  // namespace

std::vector<Issue> check_sizes(const Spec& spec, const Laying& laying, double kerf) {
  if (const auto* over = laying.over(); over != nullptr && !laying.parallel()) {
    const double most = over->most_kerf();
    if (kerf >= most)
      return {{.code = ErrorCode::out_of_range,
               .member = "shape",
               .got = kerf,
               .limit = rounded_down(most),
               .unit = "mm",
               .hint = "over a corner so tight, a beam square to the outside and as wide as the "
                       "kerf cuts into the next face; cut it by wall normal with tilt free"}};
  }
  return std::visit(Sizes{spec, laying, kerf}, spec.shape);
}

std::vector<Issue> check_open(const Chain& chain, const Laying& laying) {
  const auto box = bounds(chain);
  if (laying.over() != nullptr && laying.lay() != Lay::developed)
    return check_open_over(box, *laying.over());
  if (laying.lay() == Lay::developed) {
    const double round = box.most.y() - box.least.y(), girth = kTwoPi * laying.outer();
    if (round < girth) return {};
    return {{.code = ErrorCode::open_profile,
             .member = "shape",
             .got = round,
             .limit = girth,
             .unit = "mm",
             .hint = "it reaches round the whole tube"}};
  }
  if (laying.lay() == Lay::flat) return {};  // `lay` holds it against the flat
  const double half = std::max(box.most.y(), -box.least.y());
  const double most = rounded_down(2.0 * laying.inner() - kInside);
  if (2.0 * half <= most) return {};
  return {{.code = ErrorCode::open_profile,
           .member = "shape",
           .got = 2.0 * half,
           .limit = most,
           .unit = "mm",
           .hint = "across it reaches beyond the bore; lay it on the wall by wall developed, or "
                   "make it less wide"}};
}

std::vector<Issue> check_straight_tool(const Laying& laying) {
  constexpr double kRoom = 0.01;  // mm
  if (laying.lay() != Lay::bored) return {};
  const double lacks = std::abs(laying.straight().outside(0.0) - laying.outside(0.0));
  if (lacks <= kRoom) return {};
  return {{.code = ErrorCode::unsupported_combination,
           .member = "wall",
           .got = lacks,
           .limit = kRoom,
           .unit = "mm",
           .hint = "the far wall leans against the anchor's normal there: cut square to it, its "
                   "outside lies aside of its bore and blocks a straight tool; give the far wall a "
                   "cut-out of its own, or cut both with a torch that leans (tilt free)"}};
}

double least_corner(const Spec& spec, const Chain& chain, const section::Wall& wall, double kerf) {
  constexpr int kPlaces = 64;
  constexpr double kRound = 1e-3;  // mm: between two places it may be a little more
  const auto box = bounds(chain);
  double out = 0.5 * kerf;
  std::set<double> seen;
  for (const auto& step : steps(spec.pattern).value_or(std::vector<Step>{Step{}})) {
    const auto over = over_corner(wall, spec, step, chain);
    if (!over || !seen.insert(*over).second) continue;
    for (const bool far : {false, true}) {
      if (far && spec.wall != Wall::through) continue;
      const Laying laying(wall, *over, lay_of(spec.wall, spec.tilt), far);
      if (!check_open(chain, laying).empty()) continue;
      for (int i = 0; i <= kPlaces; ++i) {
        const double b = math::mixed(box.least.y(), box.most.y(), static_cast<double>(i) / kPlaces);
        const double least = least_radius(laying, kerf, b);
        if (least > 0.5 * kerf) out = std::max(out, kRound * std::ceil(least / kRound));
      }
    }
  }
  return out;
}

Flat deep_in(const Spec& spec, const Chain& chain) { return std::visit(Middle{chain}, spec.shape); }

}  // namespace tubecut::cutout
