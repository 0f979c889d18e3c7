#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "core/base/elementary.hpp"
#include "core/base/error.hpp"
#include "core/base/stop.hpp"
#include "core/groove/groove.hpp"
#include "core/groove/groove_limits.hpp"
#include "core/groove/normal_area.hpp"
#include "core/groove/survey.hpp"
#include "core/math/rotation.hpp"

namespace tubecut::groove {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Running maximum of deviations to either side.
class Worst {
 public:
  void add(double deviation) { worsen(value_, std::abs(deviation)); }
  [[nodiscard]] double value() const { return value_; }

 private:
  double value_ = 0.0;
};

Vector3d in_space(Angle omega, const Vector2d& point) {
  return math::turn_about_z(omega.rad()) * Vector3d(0.0, point.x(), point.y());
}

/// The chord as a line in space; all its quantities are computed by vectors.
struct ChordAxis {
  Vector3d point;
  Vector3d along;
  double radius;

  explicit ChordAxis(const GrooveSpec& spec)
      : point(spec.eccentricity, 0.0, 0.0),
        along(0.0, elementary::sin(spec.inclination.rad()),
              elementary::cos(spec.inclination.rad())),
        radius(0.5 * spec.chord.outer_diameter) {}

  [[nodiscard]] double off_surface(const Vector3d& p) const {
    return along.cross(p - point).norm() - radius;
  }
  [[nodiscard]] Vector3d normal(const Vector3d& p) const {
    return (p - point) - along * along.dot(p - point);
  }
};

/// Integrals over the filler region by Green's theorem, the chord's arc by Gauss-Legendre over its
/// circle angle.
struct Region {
  double area = 0.0;    // of the region P1 P2 P3, its side P1 P2 along the chord
  double moment = 0.0;  // about the branch axis
};

class RegionIntegral {
 public:
  RegionIntegral(const GrooveSpec& spec, Angle omega)
      : radius_(0.5 * spec.chord.outer_diameter),
        eccentricity_(spec.eccentricity),
        omega_(elementary::sincos(omega.rad())),
        tilt_(elementary::sincos(spec.inclination.rad())) {
    if (std::abs(omega_.sin) < 1e-15 * std::max(1.0, omega.rad())) omega_.sin = 0.0;
  }

  [[nodiscard]] Region over(const Vector2d& p1, const Vector2d& p2, const Vector2d& p3) const {
    Region out;
    add_line(p2 - p1, p3 - p1, p1.x(), out);
    add_line(p3 - p1, Vector2d::Zero(), p1.x(), out);
    omega_.sin == 0.0 ? add_line(Vector2d::Zero(), p2 - p1, p1.x(), out) : add_arc(p1, p2, out);
    return out;
  }

 private:
  // All coordinates are relative to P1, so that a distant origin costs no digits: area = closed
  // integral of -z dx, moment of -z (x1 + x) dx.
  static void add_line(const Vector2d& from, const Vector2d& to, double x1, Region& out) {
    const double dx = to.x() - from.x(), mean = 0.5 * (from.y() + to.y());
    out.area -= mean * dx;
    const double first =
        (from.x() * (2.0 * from.y() + to.y()) + to.x() * (from.y() + 2.0 * to.y())) / 6.0;
    out.moment -= (x1 * mean + first) * dx;
  }

  void add_arc(const Vector2d& p1, const Vector2d& p2, Region& out) const {
    const double t1 = p1.x() * omega_.sin + eccentricity_;
    const double q1 = std::sqrt(radius_ * radius_ - t1 * t1);
    const double q2 =
        q1 + (p2.y() - p1.y()) * tilt_.sin - (p2.x() - p1.x()) * omega_.cos * tilt_.cos;
    const double dt = (p2.x() - p1.x()) * omega_.sin;
    const double end = elementary::atan2(dt * q1 - t1 * (q2 - q1), t1 * (t1 + dt) + q1 * q2);
    static constexpr std::array<double, 3> kNode = {0.0, 0.53846931010568309104,
                                                    0.90617984593866399280};
    static constexpr std::array<double, 3> kWeight = {
        0.56888888888888888889, 0.47862867049936646804, 0.23692688505618908751};
    constexpr int kPanels = 4;
    for (int panel = 0; panel < kPanels; ++panel)
      for (int k = -2; k <= 2; ++k) {
        const auto i = std::size_t(std::abs(k));
        const double node = std::copysign(kNode[i], k);
        const double psi = end * (panel + 0.5 + 0.5 * node) / kPanels;
        add_node(psi, 0.5 * end / kPanels * kWeight[i], t1, q1, p1.x(), out);
      }
  }

  void add_node(double psi, double weight, double t1, double q1, double x1, Region& out) const {
    const auto half = elementary::sincos(0.5 * psi);
    const double chord = 2.0 * half.sin;
    const double x = chord * (q1 * half.cos - t1 * half.sin) / omega_.sin;
    const double z =
        (x * omega_.cos * tilt_.cos - chord * (t1 * half.cos + q1 * half.sin)) / tilt_.sin;
    const auto [s, c] = elementary::sincos(psi);
    const double dx = (q1 * c - t1 * s) / omega_.sin * weight;
    out.area -= z * dx;
    out.moment -= z * (x1 + x) * dx;
  }

  double radius_, eccentricity_;
  elementary::SinCos omega_, tilt_;
};

constexpr int kNormalStations = 50;  // only two of them are knots of the factor

struct SectionDeviations {
  Worst on_chord, width, area, sum, curves, twist, compare;
};

double curve_deviation(const GrooveSpec& spec, const GrooveSection& s) {
  const double inner = 0.5 * spec.branch.outer_diameter - spec.branch.wall;
  const double bottom = s.root_z - spec.root_face.height;
  Worst worst;
  worst.add((s.curves.c1 - in_space(s.omega, {inner, bottom})).norm());
  worst.add((s.curves.c2 - in_space(s.omega, {inner + spec.root_face.width, bottom})).norm());
  worst.add((s.curves.c3 - in_space(s.omega, s.p1)).norm());
  worst.add((s.curves.c4 - in_space(s.omega, s.p3)).norm());
  worst.add(s.p3.x() - 0.5 * spec.branch.outer_diameter);
  worst.add(s.p3.y() - s.p1.y() - s.height);
  worst.add(s.root_z - s.p1.y());
  return worst.value();
}

/// Computes the twist from normals by central differences of points in space.
double twist_by_points(const JointGeometry& joint, Angle omega, Angle step) {
  const auto before = section(joint, omega - step), after = section(joint, omega + step);
  if (!before || !after) return std::numeric_limits<double>::quiet_NaN();
  const auto normal = [&](double v) -> Vector3d {
    const Vector3d along = surface_point(joint, *after, v) - surface_point(joint, *before, v);
    const Vector3d up = surface_point(joint, *after, 1.0) + surface_point(joint, *before, 1.0) -
                        surface_point(joint, *after, 0.0) - surface_point(joint, *before, 0.0);
    return along.cross(up).normalized();
  };
  const auto across = [&](const Section& at) -> Vector3d {
    return surface_point(joint, at, 1.0) - surface_point(joint, at, 0.0);
  };
  const Vector3d root = surface_point(joint, *after, 0.0) - surface_point(joint, *before, 0.0);
  const double side =
      root.dot((across(*after) + across(*before)).cross(across(*after) - across(*before)));
  const Vector3d low = normal(0.0), high = normal(1.0);
  return std::copysign(elementary::atan2(low.cross(high).norm(), low.dot(high)), side);
}

/// Uses two steps of the differences, so that the error's first term cancels.
double twist_by_points(const JointGeometry& joint, Angle omega) {
  const double gap = 1.0 - (joint.root_radius + std::abs(joint.eccentricity)) / joint.chord_radius;
  const double step = std::clamp(3e-4 * std::sqrt(gap), 1e-8, 1e-4);
  const double wide = twist_by_points(joint, omega, Angle::rad(2.0 * step));
  return (4.0 * twist_by_points(joint, omega, Angle::rad(step)) - wide) / 3.0;
}

void add_section(const GrooveSpec& spec, const Groove& groove, const JointGeometry& joint,
                 std::size_t index, SectionDeviations& worst) {
  const GrooveSection& s = groove.sections[index];
  const ChordAxis chord{spec};
  worst.on_chord.add(chord.off_surface(s.curves.c3));
  worst.on_chord.add(chord.off_surface(in_space(s.omega, s.p2)));
  worst.width.add((s.p2 - s.p1).norm() - 2.0 * (spec.branch.wall - spec.root_face.width));
  const RegionIntegral integral{spec, s.omega};
  const double asked = groove.area * axial_factor(joint, direction(s.omega));
  worst.area.add(integral.over(s.p1, s.p2, s.p3).area - asked);
  worst.area.add(s.areas.d - asked);
  worst.sum.add(s.areas.a + s.areas.b + s.areas.c + s.areas.d - s.areas.e);
  worst.curves.add(curve_deviation(spec, s));
  worst.twist.add(s.ruling.twist.rad() - twist_by_points(joint, s.omega));
  if (!groove.compare) return;
  const Vector2d edge = {s.p3.x(), s.p1.y() + groove.compare->height};
  worst.compare.add(integral.over(s.p1, s.p2, edge).area - groove.compare->filler_area[index]);
}

/// Returns the largest of a figure over the stations of the survey.
template <class Figure>
double largest_of_round(const Figure& figure) {
  double out = -std::numeric_limits<double>::infinity();
  for (int i = 0; i < kSurveySections; ++i)
    worsen(out, figure(Angle::rad(kTwoPi * i / kSurveySections)));
  return out;
}

struct RoundDeviations {
  double volume = 0.0, fixed_volume = 0.0, length = 0.0;
};

/// Checks the figures of a whole revolution, between the sections of the survey.
RoundDeviations round_figures(const GrooveSpec& spec, const Groove& groove,
                              const JointGeometry& joint) {
  RoundDeviations out;
  const double step = kTwoPi / kSurveySections;
  std::optional<Vector3d> last;
  for (int i = 0; i <= kSurveySections; ++i) {
    const Angle omega = Angle::rad(step * (i + 0.5));
    const auto found = section(joint, omega);
    if (!found) return {.volume = std::numeric_limits<double>::quiet_NaN()};
    const Vector2d p1 = {found->toe.x1, found->toe.y1}, p2 = {found->toe.x2, found->toe.y2};
    const Vector3d root = in_space(omega, p1);
    if (last) out.length += (root - *last).norm();
    last = root;
    if (i == kSurveySections) break;
    const RegionIntegral integral{spec, omega};
    out.volume += step * integral.over(p1, p2, {joint.branch_radius, found->y3}).moment;
    if (groove.compare)
      out.fixed_volume +=
          step *
          integral.over(p1, p2, {joint.branch_radius, p1.y() + groove.compare->height}).moment;
  }
  return out;
}

/// Returns the filler area at which the height vanishes in one section.
double flat_area(const GrooveSpec& spec, const JointGeometry& joint, const Section& at) {
  const Vector2d p1 = {at.toe.x1, at.toe.y1}, p2 = {at.toe.x2, at.toe.y2};
  const RegionIntegral integral{spec, at.omega};
  const double flat = integral.over(p1, p2, {joint.branch_radius, p1.y()}).area;
  return flat / axial_factor(joint, at.dir);
}

struct Extremes {
  double lowest, highest, least_area;
};

Extremes extremes_of_round(const GrooveSpec& spec, const JointGeometry& joint) {
  const auto of = [&joint](const auto& figure) {
    return largest_of_round([&](Angle omega) {
      const auto found = section(joint, omega);
      return found ? figure(*found) : std::numeric_limits<double>::quiet_NaN();
    });
  };
  return {-of([](const Section& s) { return -s.height; }),
          of([](const Section& s) { return s.height; }),
          of([&](const Section& s) { return flat_area(spec, joint, s); })};
}

}  // namespace

std::vector<Check> verify(const GrooveSpec& spec, const Groove& groove) {
  const auto joint = joint_geometry(spec);
  if (!joint) return {{"joint", 1.0, 0.0, ""}};
  SectionDeviations worst;
  for (std::size_t i = 0; i < groove.sections.size() && !stopped(); ++i)
    add_section(spec, groove, *joint, i, worst);
  const RoundDeviations round = round_figures(spec, groove, *joint);
  const GrooveLimits limit = groove_limits(*joint);
  const auto ratio = [](double a, double b) { return std::abs(a / b - 1.0); };
  const Extremes extreme = extremes_of_round(spec, *joint);
  Worst heights;
  heights.add(groove.height_min / extreme.lowest - 1.0);
  heights.add(groove.height_max / extreme.highest - 1.0);
  std::vector<Check> out = {
      {"on_chord", worst.on_chord.value(), limit.on_chord, "mm"},
      {"weld_width", worst.width.value(), limit.weld_width, "mm"},
      {"filler_area", worst.area.value(), limit.area, "mm2"},
      {"area_sum", worst.sum.value(), limit.area, "mm2"},
      {"curves", worst.curves.value(), limit.curves, "mm"},
      {"twist", worst.twist.value() * kDegPerRad, kTwistLimitDeg, "deg"},
      {"heights", heights.value(), kHeightLimit, "ratio"},
      {"least_area", std::abs(groove.least_area - extreme.least_area) / groove.area,
       kLeastAreaLimit, "ratio"},
      {"filler_volume", ratio(groove.filler_volume, round.volume), kVolumeLimit, "ratio"},
      {"weld_length", ratio(groove.weld_length, round.length), kLengthLimit, "ratio"},
  };
  if (spec.area_in == AreaIn::normal)
    out.push_back({"normal_area", normal_area_off(*joint, groove.area, kNormalStations),
                   kNormalAreaLimit, "ratio"});
  if (groove.compare) {
    out.push_back({"compare_area", worst.compare.value(), limit.area, "mm2"});
    out.push_back({"compare_volume",
                   std::abs(groove.compare->filler_volume - round.fixed_volume) / round.volume,
                   kVolumeLimit, "ratio"});
  }
  return out;
}

}  // namespace tubecut::groove
