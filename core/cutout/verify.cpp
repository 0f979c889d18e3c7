#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/base/elementary.hpp"
#include "core/bevel/beam/beam.hpp"
#include "core/cutout/cone_verify.hpp"
#include "core/cutout/cutout.hpp"
#include "core/math/cylinder.hpp"
#include "core/math/quadrature.hpp"

namespace tubecut::cutout {
namespace {

using Eigen::Vector3d;
using math::cylinder_point;

constexpr double kOnChain = 1e-9;   // mm
constexpr double kVolume = 1e-9;    // of itself
constexpr double kApart = 0.05;     // mm between the places of a wall that the beam is held against
constexpr int kMostPlaces = 2'000;  // of them
constexpr double kFineFrom = 0.7;
constexpr int kRings = 16, kGauss = 8, kPieces = 4;

/// A point of the tube about its anchor: on a flat, x is the depth below the outside.
Vector3d in_space(const Laying& laying, bool outer, double phi, double z) {
  const double rho = outer ? laying.outer() : laying.inner();
  if (laying.lay() != Lay::flat) return cylinder_point(rho, phi, z);
  return {outer ? 0.0 : -laying.wall(), rho * (laying.far() ? kPi - phi : phi), z};
}

/// How far a row's two points in space are off the chain, by their coordinates about the anchor.
double off_chain(const Mould& mould, std::size_t row) {
  const auto& laying = mould.laying;
  const auto& rows = mould.rows;
  const auto outer = in_space(laying, true, rows.phi[row], rows.z[row]);
  const auto inner = in_space(laying, false, rows.phi_inner[row], rows.z_inner[row]);
  if (mould.cone)
    return worst_of({off_cone(laying, *mould.cone, outer), off_cone(laying, *mould.cone, inner)});
  const auto off = [&](double a, double b) { return distance(mould.chain, {a, b}); };
  const double wall = inner.head<2>().normalized().dot(
      Eigen::Vector2d(-outer.y(), outer.x()));  // 0 where it is square
  if (laying.parallel()) return worst_of({off(outer.z(), outer.y()), off(inner.z(), inner.y())});
  if (laying.lay() == Lay::bored) return worst_of({off(inner.z(), inner.y()), std::abs(wall)});
  return worst_of(
      {off(outer.z(), laying.outer() * elementary::atan2(outer.y(), outer.x())), std::abs(wall)});
}

/// How far an instance's rows are off the places, by the section's own outlines, where the face's
/// plane and the anchor say that they lie.
double off_face(const Layout& layout, const Instance& one, const section::Wall& wall) {
  const auto rows = placed(layout, one);
  const auto& mould = layout.mould_of(one);
  const auto n = section::Curve::face_normal(one.face);
  const Eigen::Vector2d t(-n.y(), n.x());
  double worst = 0.0;
  for (std::size_t i = 0; i < rows.phi.size(); ++i)
    for (const bool outer : {true, false}) {
      const auto& curve = outer ? wall.outer() : wall.bore();
      const double phi = outer ? rows.phi[i] : rows.phi_inner[i];
      const auto p = curve.at(phi / kTwoPi * curve.girth()).point;
      const double depth = outer ? 0.0 : wall.section().wall;
      const double b = (p.dot(t) - one.offset) * (mould.laying.far() ? -1.0 : 1.0);
      const double a = (outer ? rows.z[i] : rows.z_inner[i]) - one.z;
      worsen(worst, std::abs(wall.outer().face_distance(one.face) - depth - p.dot(n)));
      worsen(worst, mould.cone ? off_cone(mould.laying, *mould.cone, {-depth, b, a})
                               : distance(mould.chain, {a, b}));
    }
  return worst;
}

/// A place of a mould over corners, by the section's own outlines: `phase` from its anchor.
Vector3d on_section(const Mould& mould, bool outer, double phase, double z) {
  const auto& over = *mould.laying.over();
  const auto& curve = outer ? over.wall().outer() : over.wall().bore();
  const double rho = outer ? mould.laying.outer() : mould.laying.inner();
  const double from =
      (outer ? over.anchor().s : over.anchor().s_bore) - (mould.laying.far() ? kPi * rho : 0.0);
  const auto p = curve.at(from + rho * phase).point;
  return {p.x(), p.y(), z};
}

/// How far the rows of a mould over corners are off: a prism's along the anchor's normal from its
/// chain, else square to the outside.
double off_over(const Mould& mould) {
  const auto& laying = mould.laying;
  const auto& over = *laying.over();
  const auto& rows = mould.rows;
  const auto from = over.wall().outer().at(over.s_of_spec());
  double worst = 0.0;
  for (std::size_t i = 0; i < rows.phi.size(); ++i) {
    const auto outer = on_section(mould, true, rows.phi[i], rows.z[i]);
    const auto inner = on_section(mould, false, rows.phi_inner[i], rows.z_inner[i]);
    const auto off = [&](const Vector3d& p) {
      return distance(mould.chain, {p.z(), (p.head<2>() - from.point).dot(from.tangent())});
    };
    const double s = over.anchor().s + laying.outer() * (rows.phi[i] - (laying.far() ? kPi : 0.0));
    const Eigen::Vector2d n = over.wall().outer().at(s).normal;
    const Eigen::Vector2d line = (outer - inner).head<2>();
    const double leans = line.x() * n.y() - line.y() * n.x();
    if (laying.lay() == Lay::prism) worsen(worst, worst_of({off(outer), off(inner)}));
    if (laying.lay() == Lay::bored) worsen(worst, worst_of({off(inner), std::abs(leans)}));
    if (laying.lay() == Lay::developed) {
      const double b = over.sense() * (s - over.anchor().s);
      worsen(worst, worst_of({distance(mould.chain, {rows.z[i], b}), std::abs(leans)}));
    }
  }
  return worst;
}

/// Places of the finished edge on both walls and between them.
std::vector<Vector3d> wall_places(const Mould& mould) {
  double length = 0.0;
  for (const auto& s : mould.chain) length += s.length();
  const double apart = std::max(kApart, length / kMostPlaces);
  if (mould.cone) return cone_places(mould.laying, *mould.cone, apart);
  std::vector<Vector3d> out;
  for (const auto& s : mould.chain) {
    const int parts = std::max(1, static_cast<int>(std::ceil(s.length() / apart)));
    for (int i = 0; i < parts; ++i) {
      const auto p = s.at(static_cast<double>(i) / parts);
      for (const double share : {0.0, 0.5, 1.0}) {
        if (const auto* over = mould.laying.over()) {
          const auto at = over->at(p.y());
          const Eigen::Vector2d q = at.bore.point + share * (at.outer.point - at.bore.point);
          out.emplace_back(q.x(), q.y(), p.x());
          continue;
        }
        const double rho =
            mould.laying.inner() + share * (mould.laying.outer() - mould.laying.inner());
        if (mould.laying.lay() == Lay::flat)
          out.emplace_back((share - 1.0) * mould.laying.wall(), p.y(), p.x());
        else
          out.push_back(
              cylinder_point(rho, mould.laying.phase(mould.laying.turn(p.y(), rho)), p.x()));
      }
    }
  }
  return out;
}

/// How far a beam of the kerf's width reaches into the part, mm; at the rows and half way between.
double gouge(const Mould& mould, double kerf) {
  const auto places = wall_places(mould);
  const auto& r = mould.rows;
  // A warning says what the spent beam of a cone does beyond its axis.
  const bool this_side = mould.cone && is_spent_on_wall(mould.laying, *mould.cone, kerf);
  double worst = 0.0;
  for (std::size_t i = 0; i < r.phi.size(); ++i)
    for (const double share : {0.0, 0.5}) {
      const auto j = (i + 1) % r.phi.size();
      const auto mixed = [&](const std::vector<double>& of) {
        return (1.0 - share) * of[i] + share * of[j];
      };
      const auto place = [&](bool outer, double phi, double z) {
        return mould.laying.over() != nullptr ? on_section(mould, outer, phi, z)
                                              : in_space(mould.laying, outer, phi, z);
      };
      const auto from = place(false, mixed(r.torch_phi_inner), mixed(r.torch_z_inner));
      const auto head = place(true, mixed(r.torch_phi), mixed(r.torch_z));
      const Vector3d way = (head - from).normalized();
      double nearest = 0.25 * kerf * kerf;
      for (const auto& p : places) {
        if (this_side && p.tail<2>().dot(head.tail<2>()) < 0.0) continue;
        const Vector3d off = p - from;
        const double along = off.dot(way);
        // The edge on the opposite side of the tube; over corners, where the beam is spent.
        if (along < -(mould.laying.over() != nullptr ? kerf : mould.laying.inner())) continue;
        nearest = std::min(nearest, off.squaredNorm() - along * along);
      }
      worsen(worst, 0.5 * kerf - std::sqrt(std::max(0.0, nearest)));
    }
  return worst;
}

/// The enclosed area by the integral of a db.
double around_flat(const Chain& chain, const math::GaussRule& rule) {
  double sum = 0.0;
  for (const auto& s : chain) {
    const int pieces = kPieces * (1 + static_cast<int>(12.0 * std::abs(s.sweep) / kTwoPi));
    for (int piece = 0; piece < pieces; ++piece)
      for (std::size_t g = 0; g < rule.nodes.size(); ++g) {
        const double share = (piece + 0.5 * (1.0 + rule.nodes[g])) / pieces;
        sum += 0.5 * rule.weights[g] / pieces * s.length() * s.along(share).y() * s.at(share).x();
      }
  }
  return std::abs(sum);
}

/// The volume by the wall's depth at each b.
double over_by_depths(const Mould& mould, const math::GaussRule& rule) {
  const auto& over = *mould.laying.over();
  double sum = 0.0;
  for (const auto& s : divided(mould.chain, over.breaks())) {
    const auto shares = cells(s);
    for (std::size_t i = 0; i + 1 < shares.size(); ++i)
      for (std::size_t g = 0; g < rule.nodes.size(); ++g) {
        const double part = shares[i + 1] - shares[i];
        const double share = shares[i] + 0.5 * (1.0 + rule.nodes[g]) * part;
        const auto p = s.at(share);
        sum += 0.5 * rule.weights[g] * part * s.length() * s.along(share).y() * p.x() *
               over.depth(p.y());
      }
  }
  return std::abs(sum);
}

}  // namespace

double volume_by_rings(const Mould& mould) {
  if (mould.cone) return cone_by_rings(mould.laying, *mould.cone);
  static const auto kAcross = math::gauss_legendre(kRings), kAlong = math::gauss_legendre(kGauss);
  const double inner = mould.laying.inner(), outer = mould.laying.outer();
  if (mould.laying.over() != nullptr) return over_by_depths(mould, kAlong);
  if (mould.laying.lay() == Lay::flat)
    return around_flat(mould.chain, kAlong) * mould.laying.wall();
  std::vector<std::vector<double>> pieces;
  double most = 0.0;
  for (const auto& s : mould.chain) {
    const int count = kPieces * (1 + static_cast<int>(12.0 * std::abs(s.sweep) / kTwoPi));
    auto& shares = pieces.emplace_back(shares_towards(s, count, kFineFrom * inner));
    if (shares.empty())
      for (int i = 0; i <= count; ++i) shares.push_back(static_cast<double>(i) / count);
    most = std::max(most, reach_across(s));
  }
  // The way round has a square root's bend where a radius equals |b|, so the rings are counted by
  // the square of the distance from there.
  const double bend = std::min(most, inner);
  const double least = std::sqrt(inner - bend), span = std::sqrt(outer - bend) - least;
  double sum = 0.0;
  for (std::size_t k = 0; k < kAcross.nodes.size(); ++k) {
    const double v = least + 0.5 * (1.0 + kAcross.nodes[k]) * span, rho = bend + v * v;
    double ring = 0.0;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const auto& s = mould.chain[i];
      for (std::size_t piece = 0; piece + 1 < pieces[i].size(); ++piece) {
        const double from = pieces[i][piece], part = pieces[i][piece + 1] - from;
        for (std::size_t g = 0; g < kAlong.nodes.size(); ++g) {
          const double share = from + 0.5 * (1.0 + kAlong.nodes[g]) * part;
          ring += 0.5 * kAlong.weights[g] * part * s.length() * s.along(share).x() *
                  mould.laying.turn(s.at(share).y(), rho);
        }
      }
    }
    sum += kAcross.weights[k] * v * span * rho * std::abs(ring);
  }
  return sum;
}

double volume_by_rings(const Layout& layout) {
  std::vector<double> each;
  for (const auto& mould : layout.moulds) each.push_back(volume_by_rings(mould));
  double sum = 0.0;
  for (const auto& one : layout.instances) sum += each[one.mould];
  return sum;
}

std::vector<Check> verify(const Layout& layout, const Ground& ground) {
  double edge = 0.0, deepest = 0.0, volume = 0.0;
  for (const auto& one : layout.instances)
    if (ground.section && layout.mould_of(one).laying.over() == nullptr)
      worsen(edge, off_face(layout, one, *ground.section));
  for (const auto& mould : layout.moulds) {
    if (mould.laying.over() != nullptr) worsen(edge, off_over(mould));
    for (std::size_t i = 0; i < mould.rows.phi.size() && mould.laying.over() == nullptr; ++i)
      worsen(edge, off_chain(mould, i));
    if (ground.kerf > 0.0) worsen(deepest, gouge(mould, ground.kerf));
    worsen(volume, std::abs(mould.taken.volume / volume_by_rings(mould) - 1.0));
  }
  return {{"cutout_edge", edge, kOnChain, "mm"},
          {"cutout_gouge", deepest, bevel::kGougeLimit, "mm"},
          {"cutout_volume", volume, kVolume, ""}};
}

}  // namespace tubecut::cutout
