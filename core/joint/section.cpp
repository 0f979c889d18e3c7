#include "core/joint/section.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/elementary.hpp"
#include "core/base/try.hpp"
#include "core/math/search.hpp"

namespace tubecut::joint {
namespace {

using Eigen::Vector2d;

constexpr int kParts = 64;  // of each side and corner, before any deviation is measured
constexpr int kProbes = 7;
constexpr int kHalvings = 30;

/// Highest hit around a section.
class Around {
 public:
  Around(std::vector<PreparedCutter> cutters, const RectangularSection& section, double tolerance)
      : cutters_(std::move(cutters)), section_(section), tolerance_(tolerance) {}

  [[nodiscard]] std::optional<SectionNode> at(double s) const {
    const auto generator = section_.at(s);
    std::optional<SectionNode> best;
    for (std::size_t i = 0; i < cutters_.size(); ++i) {
      const auto one = hit(cutters_[i], generator);
      if (one && (!best || one->z > best->hit.z)) best = SectionNode{s, generator, i, *one};
    }
    return best;
  }

  /// Nodes from `from` up to, not including, `to`.
  void walk(double from, double to) {
    for (int k = 0; k < kParts; ++k) {
      const double a = from + (to - from) * k / kParts;
      const double b = from + (to - from) * (k + 1) / kParts;
      const auto left = at(a), right = at(b);
      if (!left || !right) {
        if (open.empty() || open.back().second < a) open.emplace_back(a, b);
        open.back().second = b;
        continue;
      }
      nodes.push_back(*left);
      if (left->cutter == right->cutter) {
        halve(*left, *right, kHalvings);
        continue;
      }
      const double change = math::last_true(
          [&](double s) {
            const auto node = at(s);
            return node && node->cutter == left->cutter;
          },
          a, b);
      if (const auto node = at(change)) {
        halve(*left, *node, kHalvings);
        nodes.push_back(*node);
        halve(*node, *right, kHalvings);
      }
    }
  }

  std::vector<SectionNode> nodes;
  Intervals open;

 private:
  void halve(const SectionNode& a, const SectionNode& b, int halvings) {
    if (halvings == 0 || straight(a, b)) return;
    const auto mid = at(0.5 * (a.s + b.s));
    if (!mid) return;
    halve(a, *mid, halvings - 1);
    nodes.push_back(*mid);
    halve(*mid, b, halvings - 1);
  }

  [[nodiscard]] bool straight(const SectionNode& a, const SectionNode& b) const {
    const Vector2d from(a.s, a.hit.z);
    const Vector2d along = (Vector2d(b.s, b.hit.z) - from).normalized();
    for (int k = 1; k <= kProbes; ++k) {
      const auto node = at(a.s + (b.s - a.s) * k / (kProbes + 1));
      if (!node) return true;
      const Vector2d to = Vector2d(node->s, node->hit.z) - from;
      if (std::abs(along.x() * to.y() - along.y() * to.x()) > tolerance_) return false;
    }
    return true;
  }

  std::vector<PreparedCutter> cutters_;
  const RectangularSection& section_;
  double tolerance_;
};

}  // namespace

std::optional<Hit> hit(const PreparedCutter& cutter, const SectionPoint& generator) {
  const double rho = elementary::hypot(generator.at.x(), generator.at.y());
  const Vector2d radial = rho > 0.0 ? Vector2d(generator.at / rho) : generator.normal;
  auto out = hit(cutter, Generator{rho, radial.x(), radial.y()});
  if (!out) return out;
  const Vector2d flat =
      out->normal.x() * radial + out->normal.y() * Vector2d(-radial.y(), radial.x());
  out->normal.head<2>() = Vector2d(flat.dot(generator.normal), flat.dot(generator.tangent()));
  out->z_dphi = -out->normal.y() / out->normal.z();
  out->z_dphi2 = 0.0;
  return out;
}

double RectangularSection::perimeter() const {
  return 2.0 * (width + height - 4.0 * corner) + kTwoPi * corner;
}

std::vector<double> RectangularSection::seams() const {
  const double turn = 0.5 * kPi * corner;
  const double flat_x = width - 2.0 * corner, flat_y = height - 2.0 * corner;
  std::vector<double> out{0.5 * flat_y};
  for (const double step : {turn, flat_x, turn, flat_y, turn, flat_x, turn})
    out.push_back(out.back() + step);
  return out;
}

// A quarter: half a side, a corner, half the next side; each quarter is the one before turned.
SectionPoint RectangularSection::at(double s) const {
  double along = width - 2.0 * corner, across = height - 2.0 * corner;
  Vector2d normal = Vector2d::UnitX();
  double reach = 0.5 * width;  // from the middle to this side
  s += 0.5 * across;
  if (s >= perimeter()) s -= perimeter();
  for (int side = 0; side < 4; ++side) {
    const Vector2d tangent(-normal.y(), normal.x());
    if (s <= across) return {reach * normal + (s - 0.5 * across) * tangent, normal};
    s -= across;
    const double turn = 0.5 * kPi * corner;
    if (s < turn || side == 3) {
      const auto at = elementary::sincos(s / corner);
      const Vector2d n = at.cos * normal + at.sin * tangent;
      return {(reach - corner) * normal + 0.5 * across * tangent + corner * n, n};
    }
    s -= turn;
    reach = 0.5 * across + corner;
    std::swap(along, across);
    normal = tangent;
  }
  return {};
}

RectangularSection RectangularSection::inset(double depth) const {
  return {width - 2.0 * depth, height - 2.0 * depth, corner - depth};
}

Result<std::vector<SectionNode>> section_contour(std::span<const Cutter> cutters,
                                                 const RectangularSection& section,
                                                 double tolerance) {
  const double widest = 0.5 * std::min(section.width, section.height);
  if (!(section.corner > 0.0) || section.corner > widest)
    return fail({.code = ErrorCode::out_of_range,
                 .member = "section/corner",
                 .got = section.corner,
                 .limit = widest,
                 .unit = "mm"});
  if (!(tolerance > 0.0))
    return fail({.code = ErrorCode::out_of_range,
                 .member = "tolerance",
                 .got = tolerance,
                 .limit = 0.0,
                 .unit = "mm"});
  std::vector<PreparedCutter> prepared;
  for (std::size_t i = 0; i < cutters.size(); ++i) {
    TRY(auto one, under("cutters/" + std::to_string(i), prepare(cutters[i])));
    prepared.push_back(std::move(one));
  }
  Around around(std::move(prepared), section, tolerance);
  const auto seams = section.seams();
  double from = 0.0;
  for (const double to : seams) {
    if (to > from) around.walk(from, to);
    from = to;
  }
  around.walk(from, section.perimeter());
  if (around.open.empty()) return std::move(around.nodes);
  return fail({.code = ErrorCode::open_profile,
               .member = "cutters",
               .got = std::move(around.open),
               .limit = "a partner all around",
               .unit = "mm"});
}

}  // namespace tubecut::joint
