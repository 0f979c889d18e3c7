#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/base/elementary.hpp"
#include "core/math/quadrature.hpp"
#include "core/math/rotation.hpp"
#include "core/part/hole_volume.hpp"
#include "core/part/part.hpp"

namespace tubecut::part {
namespace {

using Eigen::Vector3d;

constexpr double kPlaced = 1e-9;  // mm
constexpr double kVolume = 1e-9;  // of itself

Vector3d at(double radius, double phi, double z) {
  const auto turn = elementary::sincos(phi);
  return {radius * turn.cos, radius * turn.sin, z};
}

void see(double& worst, double value) { worst = value > worst || value != value ? value : worst; }

/// The worst of each name, by how near it comes to its limit.
class Worst {
 public:
  void see(const std::vector<Check>& checks, const std::string& prefix) {
    for (auto check : checks) {
      check.name = prefix + check.name;
      const auto [place, fresh] = places_.emplace(check.name, checks_.size());
      if (fresh)
        checks_.push_back(std::move(check));
      else if (!(check.value * checks_[place->second].limit <=
                 checks_[place->second].value * check.limit))
        checks_[place->second] = std::move(check);
    }
  }
  std::vector<Check> take() { return std::move(checks_); }

 private:
  std::map<std::string, std::size_t> places_;
  std::vector<Check> checks_;
};

/// From the part's frame to the end's own: a shift, and at the finish half a turn about x.
struct Place {
  Eigen::Matrix3d turn;
  Vector3d shift;
  Vector3d operator()(const Vector3d& p) const { return turn * p + shift; }
};

/// Every row of the part's table holds the same points as the end's own.
double misplaced(const End& end, bool finish, const Place& place) {
  const auto& target = end.spec.target;
  const auto n = end.own.phi.size();
  if (end.table.phi.size() != n) return 1.0;
  double worst = 0.0;
  const auto row = [&](std::size_t k, std::size_t i) {
    const auto& a = end.table;
    const auto& b = end.own;
    double off = 0.0;
    const auto pair = [&](double radius, double z, double own) {
      see(off, (place(at(radius, a.phi[k], z)) - at(radius, b.phi[i], own)).norm());
    };
    pair(target.inner_radius(), a.z_inner[k], b.z_inner[i]);
    pair(target.outer_radius, a.z_outer[k], b.z_outer[i]);
    pair(target.inner_radius(), a.torch_inner[k], b.torch_inner[i]);
    pair(target.outer_radius, a.torch_outer[k], b.torch_outer[i]);
    // The beam's direction, turned as the points are.
    const Vector3d radial = at(1.0, a.phi[k], 0.0), own = at(1.0, b.phi[i], 0.0);
    const auto beam = elementary::sincos(a.b[k]);
    const auto beam_own = elementary::sincos(b.b[i]);
    see(off, (place.turn * (beam.cos * radial + beam.sin * Vector3d::UnitZ()) -
              (beam_own.cos * own + beam_own.sin * Vector3d::UnitZ()))
                 .norm());
    return off;
  };
  const auto zeros = static_cast<std::size_t>(std::ranges::count(end.own.phi, 0.0));
  for (std::size_t k = 0; k < n; ++k) {
    const auto i = !finish ? k : k < zeros ? zeros - 1 - k : n - 1 - (k - zeros);
    see(worst, row(k, i));
  }
  return worst;
}

double misplaced(const bevel::Hole& placed, const bevel::Hole& own, double dz) {
  double worst = 0.0;
  for (std::size_t i = 0; i < own.phi.size(); ++i) {
    see(worst, std::abs(placed.phi.at(i) - own.phi[i]));
    see(worst, std::abs(placed.z.at(i) - dz - own.z[i]));
    see(worst, std::abs(placed.z_inner.at(i) - dz - own.z_inner[i]));
    see(worst, std::abs(placed.torch_z.at(i) - dz - own.torch_z[i]));
    see(worst, std::abs(placed.torch_z_inner.at(i) - dz - own.torch_z_inner[i]));
  }
  return worst;
}

/// A part's volume by the divergence theorem with the field (0, 0, z): the two cut faces alone,
/// each row's sector by Simpson across the wall.
double ruled(const bevel::Table& t, const joint::Target& target, double face) {
  double sum = 0.0;
  for (std::size_t i = 0; i < t.phi.size(); ++i) {
    const auto j = (i + 1) % t.phi.size();
    const double step = t.phi[j] - t.phi[i] + (j == 0 ? kTwoPi : 0.0);
    const auto part = [&](double from, double to, double z_from, double z_to) {
      const double middle = 0.5 * (from + to);
      return (to - from) / 6.0 * (from * z_from + 4.0 * middle * 0.5 * (z_from + z_to) + to * z_to);
    };
    const auto mean = [&](const std::vector<double>& z) { return 0.5 * (z[i] + z[j]); };
    const double inner = target.inner_radius(), edge = inner + face;
    if (t.z_face.empty())
      sum += step * part(inner, target.outer_radius, mean(t.z_inner), mean(t.z_outer));
    else
      sum += step * (part(inner, edge, mean(t.z_inner), mean(t.z_face)) +
                     part(edge, target.outer_radius, mean(t.z_face), mean(t.z_outer)));
  }
  return sum;
}

/// A hole's plug by the same theorem: only its own wall counts, ring by ring. A straight line
/// passes the radius rho acos(p / rho) round from its foot, p from the axis.
double hole_by_rings(const bevel::Hole& h, const joint::Target& target) {
  const double inner = target.inner_radius(), outer = target.outer_radius;
  const auto n = h.phi.size();
  std::vector<double> foot(n), nearest(n), way(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Vector3d a = at(inner, h.phi_inner[i], 0.0), b = at(outer, h.phi[i], 0.0);
    const double turn = a.cross(b).z();
    way[i] = (b - a).norm();
    nearest[i] = std::abs(turn) / way[i];
    foot[i] =
        h.phi_inner[i] - std::copysign(elementary::acos(std::min(1.0, nearest[i] / inner)), turn);
    if (turn < 0.0) nearest[i] = -nearest[i];
  }
  const auto rule = math::gauss_legendre(10);
  double sum = 0.0;
  for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
    const double rho = inner + 0.5 * (1.0 + rule.nodes[k]) * target.wall;
    const auto phi = [&](std::size_t i) {
      const double p = std::abs(nearest[i]);
      return foot[i] + std::copysign(elementary::acos(std::min(1.0, p / rho)), nearest[i]);
    };
    const auto z = [&](std::size_t i) {
      const double p = nearest[i] * nearest[i];
      const double s = (std::sqrt(rho * rho - p) - std::sqrt(inner * inner - p)) / way[i];
      return h.z_inner[i] + s * (h.z[i] - h.z_inner[i]);
    };
    double twice = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      const auto j = (i + 1) % n;
      twice += (phi(j) - phi(i)) * (z(i) + z(j));
    }
    sum += 0.5 * rule.weights[k] * target.wall * rho * 0.5 * std::abs(twice);
  }
  return sum;
}

double volume_off(const PartSpec& spec, const Part& p) {
  double volume = ruled(p.finish.table, spec.target, p.finish.spec.root_face) -
                  ruled(p.start.table, spec.target, p.start.spec.root_face);
  std::set<const bevel::Hole*> crowded;
  for (const auto& crowd : crowds(p)) {
    volume -= crowd_volume(spec.target, p, crowd, Strips::around);
    crowded.insert(crowd.holes.begin(), crowd.holes.end());
  }
  for (const auto& [hole, asked] : p.holes)
    if (!crowded.contains(&hole)) volume -= hole_by_rings(hole, spec.target);
  return std::abs(p.lengths.mass / (spec.density * 1e-9) - volume) / std::abs(volume);
}

/// Outside length at the four quarters, from the answer's own rows by a search of its own.
double quarter_off(const Part& p, const CheckDimension& d, double phi) {
  const auto height = [&](const bevel::Table& t, bool high) {
    double best = 0.0;
    bool met = false;
    for (std::size_t i = 0; i < t.phi.size(); ++i) {
      const auto j = (i + 1) % t.phi.size();
      const double to = t.phi[j] + (j == 0 ? kTwoPi : 0.0);
      for (const double here : {phi, phi + kTwoPi}) {
        if (here < t.phi[i] || here > to) continue;
        const double span = to - t.phi[i];
        const double z =
            span > 0.0 ? t.z_outer[i] + (here - t.phi[i]) / span * (t.z_outer[j] - t.z_outer[i])
                       : t.z_outer[i];
        best = !met ? z : high ? std::max(best, z) : std::min(best, z);
        met = true;
      }
    }
    return best;
  };
  return std::abs(height(p.finish.table, false) - height(p.start.table, true) - d.value);
}

double dimensions_off(const PartSpec& spec, const Part& p) {
  double worst = 0.0;
  for (const auto& d : p.check_dimensions) {
    if (d.name == "girth") see(worst, std::abs(d.value - kPi * 2.0 * spec.target.outer_radius));
    for (int k = 0; k < 4; ++k)
      if (d.name == "length_at_" + std::to_string(90 * k))
        see(worst, quarter_off(p, d, 0.5 * kPi * k));
  }
  return worst;
}

}  // namespace

std::vector<Check> verify(const PartSpec& spec, const Part& part) {
  Worst all;
  all.see(bevel::verify(part.start.spec, part.start.own), "");
  all.see(bevel::verify(part.finish.spec, part.finish.own), "");
  for (std::size_t i = 0; i < part.hole_cuts.size(); ++i)
    all.see(bevel::verify(part.hole_specs[i], part.hole_cuts[i]), "hole_");
  auto out = all.take();
  const Vector3d start = spec.start_frame.rows * (part.frame.origin - spec.start_frame.origin);
  const double length = *spec.target.length;
  Eigen::Matrix3d over = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
  const double scale = spec.target.outer_radius + length;
  double placed = 0.0;
  see(placed, misplaced(part.start, false, {Eigen::Matrix3d::Identity(), start}));
  see(placed, misplaced(part.finish, true, {over, {0.0, 0.0, length - start.z()}}));
  for (const auto& hole : part.holes) {
    const auto& cut = part.hole_cuts[hole.asked];
    const auto& own = cut.holes[hole.hole.far && cut.holes.size() > 1 ? 1 : 0];
    see(placed, misplaced(hole.hole, own, -start.z()));
  }
  out.push_back({"placed", placed, kPlaced * std::max(1.0, 1e-3 * scale), "mm"});
  out.push_back({"volume", volume_off(spec, part), kVolume, ""});
  out.push_back({"check_dimensions", dimensions_off(spec, part),
                 kPlaced * std::max(1.0, 1e-3 * scale), "mm"});
  return out;
}

}  // namespace tubecut::part
