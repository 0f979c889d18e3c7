#include "core/joint/section/outline_events.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/base/angle.hpp"
#include "core/joint/event_phases.hpp"
#include "core/joint/section/flat_sheets.hpp"
#include "core/math/search.hpp"

namespace tubecut::joint::detail {
namespace {

using Eigen::Vector2d;

constexpr double kEnd = 1e-12;                  // rad; a phase so near an arc's end lies on it
constexpr double kFlatEnd = 1e-9;               // of a flat's length: likewise
constexpr double kSameSurface = 1e-13;          // relative
constexpr double kTouching = 1e-6;              // of a cutter's size; kept without a sign change
constexpr double kLeap = 0.02, kHidden = 1e-4;  // of its size: what a continuous curve cannot do
constexpr std::array kBrackets = {1e-9, 1e-7, 1e-5, 1e-4, 1e-3};  // of a flat's length

// ---- arcs: a round target about their own centre

OutlineEvents on_arc(const OutlineEventSpec& spec, const section::OutlineSegment& arc) {
  std::vector<PreparedCutter> cutters;
  for (const auto& cutter : spec.cutters) cutters.push_back(seen_from(cutter, arc.origin));
  EventPhases found(cutters, arc.radius);
  OutlineEvents out;
  const double turn = arc.length / arc.radius;
  const auto take = [&](double phi, const auto& add) {
    double from = phi - arc.nu;  // of the whole circle, once
    from -= kTwoPi * std::floor((from + kEnd) / kTwoPi);
    if (from <= turn + kEnd) add(arc.from + arc.radius * std::clamp(from, 0.0, turn));
  };
  for (const double phi : found.phases()) take(phi, [&](double s) { out.places.push_back(s); });
  for (const auto& kink : found.kinks())
    take(kink.phi, [&](double s) { out.kinks.push_back({s, kink.cutter}); });
  for (const auto i : found.active())
    if (found.scanned(i))
      if (const auto phi = found.hidden_at(i))
        take(*phi, [&](double s) { out.hidden.push_back({i, s}); });
  return out;
}

// ---- flats

/// By how much a line parallel to z passes outside both sides of a cutter: linear in its place. A
/// plane has no sides.
std::optional<Sides> sides_of(const PreparedTube& tube, const Generator& line) {
  const double across = tube.offset + line.radius * (line.cos_phi * tube.cos_clocking +
                                                     line.sin_phi * tube.sin_clocking);
  return Sides{-across - tube.radius, across - tube.radius};
}
std::optional<Sides> sides_of(const PreparedRectangularTube& box, const Generator& line) {
  return box.sides(line);
}
std::optional<Sides> sides_of(const PreparedCone& cone, const Generator& line) {
  return cone.sides(line);
}
std::optional<Sides> sides_of(const PreparedPlane& /*plane*/, const Generator& /*line*/) {
  return {};
}
std::optional<Sides> sides_of(const PreparedElbow& /*elbow*/, const Generator& /*line*/) {
  return {};
}

class Flat {
 public:
  Flat(const OutlineEventSpec& spec, const section::OutlineSegment& flat)
      : spec_(spec), flat_(flat), way_(flat.length * Vector2d(-flat.normal.y(), flat.normal.x())) {}

  OutlineEvents find() {
    for (std::size_t i = 0; i < spec_.cutters.size(); ++i) add_sides(i);
    std::vector<std::vector<PlaneSheets>> sheets;
    for (const auto& cutter : spec_.cutters) sheets.push_back(plane_sheets(cutter, spec_.wide));
    for (std::size_t i = 0; i < sheets.size(); ++i)
      for (std::size_t j = i + 1; j < sheets.size(); ++j)
        for (const auto& a : sheets[i])
          for (const auto& b : sheets[j])
            for (const double share :
                 crossings(along_line(a, flat_.origin, way_), along_line(b, flat_.origin, way_)))
              add_crossing(i, j, share);
    for (std::size_t i = 0; i < sheets.size(); ++i)
      if (sheets[i].empty()) scan(i);
    return std::move(out_);
  }

 private:
  [[nodiscard]] Generator line(double share) const {
    return generator_through(flat_.origin + share * way_);
  }
  void add(double share) {
    if (share < -kFlatEnd || share > 1.0 + kFlatEnd) return;
    out_.places.push_back(flat_.from + flat_.length * std::clamp(share, 0.0, 1.0));
  }
  [[nodiscard]] double size(std::size_t i) const {
    return rounding_size(spec_.cutters[i], spec_.wide);
  }
  [[nodiscard]] double apart(std::size_t i, std::size_t j, double share) const {
    const auto at = line(share);
    return continued_sheet(spec_.cutters[i], at) - continued_sheet(spec_.cutters[j], at);
  }

  void add_sides(std::size_t i) {
    const auto at = [&](double share) {
      return by_kind(spec_.cutters[i],
                     [&](const auto& kind) { return sides_of(kind, line(share)); });
    };
    const auto first = at(0.0), last = at(1.0);
    if (!first) return;
    for (const auto side : {&Sides::left, &Sides::right}) {
      const double from = *first.*side, to = *last.*side;
      if (from != to) add(from / (from - to));
    }
  }

  void add_crossing(std::size_t i, std::size_t j, double near) {
    const auto g = [&](double share) { return apart(i, j, share); };
    for (const double reach : kBrackets)
      if ((g(near - reach) > 0.0) != (g(near + reach) > 0.0))
        return add(math::sign_change(g, near - reach, near + reach));
    if (std::abs(g(near)) < kTouching * std::max(size(i), size(j))) add(near);
  }

  /// What has no closed form: where it is met, where its height crosses another's, and where it
  /// leaps.
  void scan(std::size_t i) {
    const auto cells = static_cast<std::size_t>(std::ceil(flat_.length / spec_.scan)) + 1;
    const auto share = [&](std::size_t k) {
      return static_cast<double>(k) / static_cast<double>(cells);
    };
    const auto met = [&](double at) { return upper_sheet(spec_.cutters[i], line(at)).has_value(); };
    std::vector<double> z(cells + 1);
    std::vector<bool> meets(cells + 1);
    for (std::size_t k = 0; k <= cells; ++k) {
      z[k] = continued_sheet(spec_.cutters[i], line(share(k)));
      meets[k] = met(share(k));
    }
    for (std::size_t k = 0; k < cells; ++k) {
      if (meets[k] != meets[k + 1])
        add(math::last_true([&](double at) { return met(at) == meets[k]; }, share(k),
                            share(k + 1)));
      else if (meets[k] && std::abs(z[k + 1] - z[k]) > kLeap * size(i))
        add_leap(i, share(k), share(k + 1));
    }
    for (std::size_t j = 0; j < spec_.cutters.size(); ++j)
      if (j != i) scan_pair(i, j, cells);
  }

  void add_leap(std::size_t i, double from, double to) {
    const auto height = [&](double at) { return continued_sheet(spec_.cutters[i], line(at)); };
    double zf = height(from), zt = height(to);
    for (int step = 0; step < 45; ++step) {
      const double mid = 0.5 * (from + to), zm = height(mid);
      const bool left = std::abs(zm - zf) > std::abs(zt - zm);
      (left ? to : from) = mid;
      (left ? zt : zf) = zm;
    }
    if (std::abs(zt - zf) > kHidden * size(i))
      out_.hidden.push_back({i, flat_.from + flat_.length * from});
  }

  void scan_pair(std::size_t i, std::size_t j, std::size_t cells) {
    const auto share = [&](std::size_t k) {
      return static_cast<double>(k) / static_cast<double>(cells);
    };
    const auto g = [&](double at) { return apart(i, j, at); };
    std::vector<double> apart_at(cells + 1);
    for (std::size_t k = 0; k <= cells; ++k) apart_at[k] = g(share(k));
    for (std::size_t k = 0; k < cells; ++k) {
      if ((apart_at[k] > 0.0) != (apart_at[k + 1] > 0.0))
        add(math::sign_change(g, share(k), share(k + 1)));
      if (k == 0) continue;
      // A near miss may cross twice between the places looked at.
      const double side = apart_at[k] > 0.0 ? 1.0 : -1.0;
      const bool one_side = side * apart_at[k - 1] > 0.0 && side * apart_at[k + 1] > 0.0;
      if (!one_side || std::abs(apart_at[k]) > std::abs(apart_at[k - 1]) ||
          std::abs(apart_at[k]) > std::abs(apart_at[k + 1]))
        continue;
      const auto nearest = math::golden_maximum([&](double at) { return -side * g(at); },
                                                share(k - 1), share(k + 1));
      if (nearest.value < 0.0) continue;
      add(math::sign_change(g, share(k - 1), nearest.at));
      add(math::sign_change(g, nearest.at, share(k + 1)));
    }
  }

  const OutlineEventSpec& spec_;
  const section::OutlineSegment& flat_;
  Vector2d way_;
  OutlineEvents out_;
};

}  // namespace

OutlineEvents outline_events(const OutlineEventSpec& spec, const section::OutlineSegment& segment) {
  return segment.is_arc() ? on_arc(spec, segment) : Flat(spec, segment).find();
}

std::array<bool, 4> grazed_faces(const PreparedCutter& cutter, const section::Curve& curve) {
  std::array<bool, 4> out{};
  for (int face = 1; face <= 4; ++face) {
    const double half = curve.half_flat(face);
    if (!(half > 0.0)) continue;
    const auto sides = [&](double along) {
      const auto line = generator_through(curve.at(curve.on_face(face, along)).point);
      return by_kind(cutter, [&](const auto& kind) { return sides_of(kind, line); });
    };
    const auto from = sides(-0.5 * half), to = sides(0.5 * half);
    if (!from) continue;
    // Of the cutter's own width: the height of a side almost along z is far less exact than its
    // distance.
    const double within = kTouch * (curve.reach() - 0.5 * (from->left + from->right));
    const auto along = [&](double Sides::*side) {
      return std::abs((*from).*side) <= within && std::abs((*to).*side) <= within;
    };
    out.at(static_cast<std::size_t>(face - 1)) = along(&Sides::left) || along(&Sides::right);
  }
  return out;
}

bool same_surface(const PreparedCutter& a, const PreparedCutter& b, double wide) {
  for (const double radius : {wide, 2.0 * wide}) {
    const auto one = sheets(a, radius), other = sheets(b, radius);
    const bool same =
        !one.empty() && std::ranges::equal(one, other, [](const Sheets& p, const Sheets& q) {
          const double size = std::max(p.size, q.size);
          return (p.mid - q.mid).bound() <= kSameSurface * size &&
                 (p.square - q.square).bound() <= kSameSurface * size * size;
        });
    if (!same) return false;
  }
  return true;
}

}  // namespace tubecut::joint::detail
