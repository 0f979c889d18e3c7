#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/base/elementary.hpp"
#include "core/base/error.hpp"
#include "core/base/stop.hpp"
#include "core/groove/machine_space.hpp"
#include "core/groove/mill_limits.hpp"
#include "core/groove/mill_path.hpp"
#include "core/groove/surface.hpp"
#include "core/math/rotation.hpp"

namespace tubecut::groove {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Running maximum.
struct MaxResidual {
  double value = 0.0;
  void add(double deviation) { worsen(value, deviation); }
};

class Verifier {
 public:
  Verifier(const MillPathSpec& spec, const MillPath& path, const JointGeometry& joint)
      : spec_(spec), path_(path), joint_(joint), machine_(spec) {}

  std::vector<Check> run() {
    const std::size_t n = path_.positions.size();
    for (std::size_t i = 0; i < n && !stopped(); ++i) {
      const MillPosition& p = path_.positions[i];
      start_on_ruling(p);
      contacts(p, machine_.before(p), p.before);
      contacts(p, p.at, p.after);
      summary(p);
      if (p.optimised) optimum(p);
      between(i);
    }
    whole_round();
    return {{"initial_on_ruling", start_.value, placing_limit(spec_, joint_.sin_a), "mm"},
            {"contact_gap", gap_.value, kContactLimit, "mm"},
            {"contact_least", least_.value, kContactLimit, "mm"},
            {"cut_figures", figures_.value, kContactLimit, "mm"},
            {"certificate", certificate_.value, kCertificateLimit, "mm"},
            {"axis_sag", sag_.value, kSagLimit, "mm"},
            {"swept", swept_.value, kSweptLimit, "mm"},
            {"root_face", root_.value, kSweptLimit, "mm"}};
  }

 private:
  [[nodiscard]] Vector3d work_point(double omega, double v) const {
    const auto found = section(joint_, Angle::rad(omega));
    if (!found) return Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
    return surface_point(joint_, *found, v);
  }
  [[nodiscard]] Vector3d root_point(double omega, double level) const {
    return work_point(omega, 0.0) - Vector3d(0.0, 0.0, level * joint_.root_height);
  }
  [[nodiscard]] Vector3d placed(const Vector3d& p, Angle c) const {
    return machine_.table(c) * p + machine_.lift();
  }

  /// Checks that without its increments the tool lies along the ruling, its edge at the requested
  /// distance from curve 3.
  void start_on_ruling(const MillPosition& p) {
    const AxisPosition at = machine_.before(p);
    const Tool tool = machine_.tool(at);
    const Matrix3d table = machine_.table(at.c);
    for (const double v : {0.0, 0.5, 1.0})
      start_.add(std::abs(flank_distance(spec_.mill, tool,
                                         table * work_point(p.omega.rad(), v) + machine_.lift())));
    const Vector3d root = placed(work_point(p.omega.rad(), 0.0), at.c);
    const double generatrix = spec_.mill.length / elementary::cos(spec_.mill.half_angle.rad());
    const double along =
        spec_.setup.direction > 0 ? spec_.setup.overrun : generatrix - spec_.setup.overrun;
    const double r = spec_.mill.tip_radius, sin_k = elementary::sin(spec_.mill.half_angle.rad());
    start_.add(std::abs((root - tool.tip).norm() -
                        std::sqrt(along * along + r * r + 2.0 * along * r * sin_k)));
  }

  /// Checks that every reported gap is the distance of its ruling, and that no adjacent or further
  /// ruling is deeper.
  void contacts(const MillPosition& p, const AxisPosition& at, const ContactLine& line) {
    constexpr double kBeside = 1e-7;  // rad; d'' h^2 / 2 stays below 1e-11 mm
    const Tool tool = machine_.tool(at);
    const Matrix3d table = machine_.table(at.c);
    const auto distance = [&](const Vector3d& point) {
      return flank_distance(spec_.mill, tool, table * point + machine_.lift());
    };
    const auto level = [&line](std::size_t i) { return double(i) / double(line.gap.size() - 1); };
    for (std::size_t i = 0; i < line.gap.size(); ++i) {
      const double omega = p.omega.rad() + line.offset[i];
      gap_.add(std::abs(distance(work_point(omega, level(i))) - line.gap[i]));
      if (!p.optimised) continue;
      for (const double beside : {-kBeside, kBeside})
        least_.add(line.gap[i] - distance(work_point(omega + beside, level(i))));
    }
    if (!p.optimised) return;
    for (const double part : {-1.0, -0.5, -0.25, 0.25, 0.5, 1.0}) {
      const double omega = p.omega.rad() + part * spec_.check.window.rad();
      const Vector3d root = work_point(omega, 0.0), edge = work_point(omega, 1.0);
      for (std::size_t i = 0; i < line.gap.size(); ++i)
        least_.add(line.gap[i] - distance(root + level(i) * (edge - root)));
    }
  }

  /// Checks the figures of a position against its gaps.
  void summary(const MillPosition& p) {
    for (const ContactLine* line : {&p.before, &p.after}) {
      const auto [low, high] = std::minmax_element(line->gap.begin(), line->gap.end());
      figures_.add(std::abs(line->over - worst_of({0.0, -*low})));
      figures_.add(std::abs(line->under - worst_of({0.0, *high})));
      figures_.add(std::abs(line->largest - worst_of({-*low, *high})));
    }
    const bool qualified =
        p.after.over < spec_.check.qualify && p.after.under < spec_.check.qualify;
    if (qualified != p.qualified) figures_.add(1.0);
  }

  /// Weak duality: with weights that no increment can change, sum lam g / sum |lam| bounds every
  /// position from below. Slopes come from differences of the apex-angle distance at the touched
  /// points.
  void optimum(const MillPosition& p) {
    // After two steps, the error of a slope is rounding: about 1e-9 of it.
    const double step = 5e-5 * (spec_.mill.tip_radius + 0.1 * spec_.mill.length);
    const double reach = spec_.mill.length + spec_.mill.tip_radius +
                         (spec_.optimise.hold == Hold::pivot ? spec_.setup.pivot_length : 0.0);
    std::array<Eigen::Vector2d, 3> slope;
    Vector3d gaps;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto i = std::size_t(p.reference[k]);
      const double v = double(i) / double(p.after.gap.size() - 1);
      const Vector3d point = placed(work_point(p.omega.rad() + p.after.offset[i], v), p.at.c);
      gaps[Eigen::Index(k)] = p.after.gap[i] - p.bias;
      slope[k] = slopes(p, step, reach, point);
    }
    const auto cross = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
      return a.x() * b.y() - a.y() * b.x();
    };
    const Vector3d lam(cross(slope[1], slope[2]), cross(slope[2], slope[0]),
                       cross(slope[0], slope[1]));
    double worst = 0.0;
    for (const double g : p.after.gap) worsen(worst, std::abs(g - p.bias));
    const double proven = worst - std::abs(lam.dot(gaps)) / lam.lpNorm<1>();
    const double own = kSlopeError * worst;
    certificate_.add(std::abs(worst_of({0.0, proven}) - p.certificate) - own);
    if (spec_.optimise.method == Method::chebyshev) certificate_.add(proven - own);
  }

  /// Computes the slopes of a point's distance by z and by B times `reach`: central differences
  /// over a step and over half of it, so that the flank's third derivative cancels, which is large
  /// for long tools with small tips.
  [[nodiscard]] Eigen::Vector2d slopes(const MillPosition& p, double step, double reach,
                                       const Vector3d& point) const {
    const auto over = [&](double h) {
      const double b = h / reach;
      return Eigen::Vector2d((shifted(p, h, 0.0, point) - shifted(p, -h, 0.0, point)) / (2.0 * h),
                             (shifted(p, 0.0, b, point) - shifted(p, 0.0, -b, point)) / (2.0 * h));
    };
    const Eigen::Vector2d whole = over(step), half = over(0.5 * step);
    return half + (half - whole) / 3.0;
  }

  /// Returns the distance of a point in machine space after a further increment.
  [[nodiscard]] double shifted(const MillPosition& p, double dz, double db,
                               const Vector3d& point) const {
    AxisPosition at = p.at;
    at.b = at.b + Angle::rad(db);
    at.z += dz;
    Tool tool = machine_.tool(at);
    if (spec_.optimise.hold == Hold::tip)
      tool.tip = machine_.tool(p.at).tip + Vector3d(0.0, 0.0, dz);
    return flank_distance(spec_.mill, tool, point);
  }

  /// Checks the tool midway between two positions against the tool on the ruling there.
  void between(std::size_t i) {
    const MillPosition &a = around(i), &b = around(i + 1);
    const double turn = kTwoPi * std::floor((b.at.b.rad() - a.at.b.rad()) / kTwoPi + 0.5);
    AxisPosition half;
    half.x = 0.5 * (a.at.x + b.at.x);
    half.z = 0.5 * (a.at.z + b.at.z);
    half.b = Angle::rad(0.5 * (a.at.b.rad() + b.at.b.rad() - turn));
    const double omega = 0.5 * (omega_at(i) + omega_at(i + 1));
    const Tool linear = machine_.tool(half), exact = on_ruling(omega, half_increment(i, omega));
    sag_.add((linear.tip - exact.tip).norm());
    sag_.add(
        (linear.tip + spec_.mill.length * linear.axis - exact.tip - spec_.mill.length * exact.axis)
            .norm());
  }

  [[nodiscard]] const MillPosition& around(std::size_t i) const {
    return path_.positions[i % path_.positions.size()];
  }
  [[nodiscard]] double omega_at(std::size_t i) const {
    return around(i).omega.rad() + kTwoPi * double(i / path_.positions.size());
  }

  /// Returns the increments between positions i and i + 1: through four neighbours if they are
  /// smooth, else through two.
  [[nodiscard]] Increment half_increment(std::size_t i, double omega) const {
    const std::size_t n = path_.positions.size();
    if (spec_.optimise.method != Method::chebyshev || n < 4)
      return {0.5 * (around(i).by.dz + around(i + 1).by.dz),
              0.5 * (around(i).by.db + around(i + 1).by.db)};
    Increment out;
    for (std::size_t k = i + n - 1; k <= i + n + 2; ++k) {
      double share = 1.0;
      for (std::size_t m = i + n - 1; m <= i + n + 2; ++m)
        if (m != k) share *= (omega + kTwoPi - omega_at(m)) / (omega_at(k) - omega_at(m));
      out.dz += share * around(k).by.dz;
      out.db += share * around(k).by.db;
    }
    return out;
  }

  /// Returns a tool on the ruling, found by rotating the ruling itself about the seam's tangent
  /// plane, with the increment added.
  [[nodiscard]] Tool on_ruling(double omega, Increment by) const {
    const double sg = spec_.setup.mount == Mount::end_up ? -1.0 : 1.0;
    const Matrix3d table = machine_.table(spec_.setup.c_zero - Angle::rad(sg * omega));
    const Vector3d root = table * work_point(omega, 0.0) + machine_.lift(),
                   edge = table * work_point(omega, 1.0) + machine_.lift();
    const double dir = spec_.setup.direction;
    const Vector3d along = dir * (edge - root).normalized();
    const double kappa = spec_.mill.half_angle.rad();
    const Vector3d axis = math::turn_about_y(sg * dir * kappa) * along,
                   across = math::turn_about_y(0.5 * sg * dir * kPi) * axis;
    const double before = dir > 0
                              ? spec_.setup.overrun
                              : spec_.mill.length / elementary::cos(kappa) - spec_.setup.overrun;
    Tool out{root - before * along + spec_.mill.tip_radius * across, axis};
    const Vector3d turned = math::turn_about_y(by.db) * axis;
    if (spec_.optimise.hold == Hold::pivot) out.tip += spec_.setup.pivot_length * (axis - turned);
    out.tip.z() += by.dz;
    out.axis = turned;
    return out;
  }

  /// Finds the smallest distance of a workpiece point over the motion near `station`: by ternary
  /// search in its segment between two blocks and in the previous one, because the motion has a
  /// corner at every block.
  template <class Distance>
  [[nodiscard]] double least_near(const Vector3d& point, double station, Distance distance) const {
    const auto at = [&](double t) {
      const Block block = block_at(blocks_, t);
      const double sg = spec_.setup.mount == Mount::end_up ? -1.0 : 1.0;
      const AxisPosition axes{spec_.setup.c_zero - Angle::rad(sg * block.omega), block.x, block.z,
                              Angle::rad(block.b)};
      return distance(spec_.mill, machine_.tool(axes), placed(point, axes.c));
    };
    const auto least_from = [&at](double low) {
      double high = low + 1.0;
      for (int i = 0; i < 40; ++i) {
        const double third = (high - low) / 3.0;
        at(low + third) < at(high - third) ? high -= third : low += third;
      }
      return at(0.5 * (low + high));
    };
    const double first = std::floor(station);
    return std::min(least_from(first - 1.0), least_from(first));
  }

  /// Recomputes reported extremes at their positions, and checks that no sampled point exceeds
  /// them.
  void whole_round() {
    for (const MillPosition& p : path_.positions) {
      blocks_.push_back({p.omega.rad(), p.at.x, p.at.z, p.at.b.rad()});
      const Matrix3d back = machine_.table(p.at.c).transpose();
      const Tool tool = machine_.tool(p.at);
      tools_.push_back({back * (tool.tip - machine_.lift()), back * tool.axis});
    }
    const Swept& s = path_.swept;
    for (const Extreme* e : {&s.flank_min, &s.flank_max})
      swept_.add(std::abs(
          least_near(work_point(e->omega.rad(), e->level), e->station, flank_distance) - e->value));
    const Extreme &stock = s.stock_left_max, &root = s.root_face_min;
    swept_.add(std::abs(
        least_near(work_point(stock.omega.rad(), stock.level), stock.station, solid_distance) -
        stock.value));
    root_.add(std::abs(
        least_near(root_point(root.omega.rad(), root.level), root.station, solid_distance) -
        root.value));
    constexpr int kRulings = 24;
    const int last = spec_.check.points - 1;
    for (int k = 0; k < 3 * kRulings && !stopped(); ++k) {
      const double omega = kTwoPi * (k / 3) / kRulings;
      const double v =
          double(k % 3 * last / 2) / last;  // first, a middle and the last of the points
      const double e = sampled(work_point(omega, v), omega, flank_distance);
      swept_.add(s.flank_min.value - e);
      swept_.add(e - s.flank_max.value);
      root_.add(root.value - sampled(root_point(omega, 0.5 * (k % 3)), omega, solid_distance));
    }
  }

  /// Returns the smallest distance over all blocks within a quarter turn, with the tools moved to
  /// the workpiece, then between blocks.
  template <class Distance>
  [[nodiscard]] double sampled(const Vector3d& point, double omega, Distance distance) const {
    double best = std::numeric_limits<double>::infinity(), station = 0.0;
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      const double apart = omega - blocks_[i].omega;
      if (std::abs(apart - kTwoPi * std::floor(apart / kTwoPi + 0.5)) > 0.25 * kTwoPi) continue;
      const double d = distance(spec_.mill, tools_[i], point);
      if (d >= best) continue;
      best = d;
      station = double(i);
    }
    return std::min(best, least_near(point, station, distance));
  }

  const MillPathSpec& spec_;
  const MillPath& path_;
  const JointGeometry& joint_;
  Machine machine_;
  std::vector<Block> blocks_;
  std::vector<Tool> tools_;  // at the blocks, in the workpiece's frame
  MaxResidual start_, gap_, least_, figures_, certificate_, sag_, swept_, root_;
};

}  // namespace

std::vector<Check> verify(const MillPathSpec& spec, const MillPath& path) {
  const auto joint = joint_geometry(spec.groove);
  if (!joint || path.positions.empty()) return {{"joint", 1.0, 0.0, ""}};
  return Verifier{spec, path, *joint}.run();
}

}  // namespace tubecut::groove
