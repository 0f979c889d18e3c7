#include "core/motion/machine/kinematics.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/elementary.hpp"
#include "core/base/try.hpp"

namespace tubecut::motion {
namespace {

constexpr std::size_t kPhi = 0, kZ = 1, kB = 2, kPx = 3, kPy = 4;
constexpr double kUpright = 1e-9;  // rad; a smaller B is none

AxisFunction linear(double phi, double z, double b, double constant = 0.0) {
  AxisFunction f;
  f.constant = constant;
  f.linear[kPhi] = phi;
  f.linear[kZ] = z;
  f.linear[kB] = b;
  return f;
}

AxisFunction coordinate(std::size_t c, double k = 1.0) {
  AxisFunction f;
  f.linear[c] = k;
  return f;
}

struct CutPathAxes {
  const Machine& machine;
  const CutPath& cut_path;

  Result<std::vector<AxisFunction>> operator()(const FiveAxisCutter& cutter) const {
    std::vector<AxisFunction> out;
    for (const Axis& axis : machine.axes) out.push_back(of(cutter, axis.name));
    return out;
  }
  Result<std::vector<AxisFunction>> operator()(const Crawler& crawler) const {
    std::vector<AxisFunction> out;
    for (const Axis& axis : machine.axes) out.push_back(of(crawler, axis.name));
    return out;
  }
  Result<std::vector<AxisFunction>> operator()(const ConeMill&) const {
    return fail({ErrorCode::unsupported_combination,
                 "machine",
                 {},
                 {},
                 {},
                 "a cone mill takes a mill path"});
  }
  Result<std::vector<AxisFunction>> operator()(const Generic& generic) const {
    if (generic.maps.size() != machine.axes.size()) {
      return fail({ErrorCode::unsupported_combination,
                   "machine/maps",
                   {},
                   {},
                   {},
                   "a contour needs a map for every axis"});
    }
    std::vector<AxisFunction> out;
    for (const LinearMap& map : generic.maps) {
      out.push_back(linear(map.k_phi * kDegPerRad, map.k_z, map.k_b * kDegPerRad, map.k_0));
    }
    return out;
  }
  Result<std::vector<AxisFunction>> operator()(const TubeTable& table) const {
    const bool swings = std::ranges::count(machine.axes, "B", &Axis::name) > 0;
    double most = 0.0;
    for (const double b : cut_path.b) most = std::max(most, std::abs(b));
    if (!swings && most > kUpright) {
      return fail({ErrorCode::unsupported_combination, "machine/axes", most * kDegPerRad, 0.0,
                   "deg", "the cut swings the torch by up to this B, and there is no axis B"});
    }
    std::vector<AxisFunction> out;
    for (const Axis& axis : machine.axes) out.push_back(of(table, axis.name));
    return out;
  }

 private:
  [[nodiscard]] double past_radius() const { return cut_path.outer_radius - cut_path.radius(); }

  [[nodiscard]] AxisFunction of(const FiveAxisCutter& cutter, const std::string& name) const {
    const double length = cutter.pivot_length + cutter.standoff;
    if (name == "C") return linear(kDegPerRad, 0.0, 0.0);
    if (name == "B") return linear(0.0, 0.0, kDegPerRad);
    AxisFunction f;
    if (name == "Y") {
      f = linear(0.0, 1.0, 0.0);
      f.sin_b = -machine.sigma() * length;
      f.tan_b = -machine.sigma() * past_radius();
    } else if (name == "Z1") {
      f.constant = cut_path.outer_radius + cutter.z2_share * length;
      f.cos_b = (1.0 - cutter.z2_share) * length;
    } else if (cutter.z2_share > 0.0) {
      f.constant = -cutter.z2_share * length;
      f.cos_b = cutter.z2_share * length;
    }
    return f;
  }

  [[nodiscard]] AxisFunction of(const TubeTable& table, const std::string& name) const {
    const double length = table.pivot_length + table.standoff;
    if (name == "A") return linear(-kDegPerRad, 0.0, 0.0);
    if (name == "B") return linear(0.0, 0.0, kDegPerRad);
    AxisFunction f;
    if (name == "X") {
      f.across = cut_path.section ? 1.0 : 0.0;
    } else if (name == "Y") {
      f = linear(0.0, 1.0, 0.0);
      f.sin_b = -machine.sigma() * length;
      f.tan_b = -machine.sigma() * past_radius();
    } else {
      f.out = cut_path.section ? 1.0 : 0.0;
      f.constant = cut_path.section ? 0.0 : cut_path.outer_radius;
      f.cos_b = length;
    }
    return f;
  }

  [[nodiscard]] AxisFunction of(const Crawler& crawler, const std::string& name) const {
    if (name == "S") return linear(cut_path.outer_radius + crawler.wheel_offset, 0.0, 0.0);
    if (name == "B") return linear(0.0, 0.0, kDegPerRad);
    const bool pivot = crawler.swing_center == SwingCenter::pivot;
    AxisFunction f = linear(0.0, 1.0, 0.0);
    f.tan_b = -machine.sigma() * (past_radius() + (pivot ? crawler.pivot_length : 0.0));
    return f;
  }
};

Result<std::vector<AxisFunction>> column_axes(const Machine& machine) {
  const bool takes = std::holds_alternative<ConeMill>(machine.kinematics) ||
                     std::holds_alternative<Generic>(machine.kinematics);
  if (!takes) {
    return fail({ErrorCode::unsupported_combination,
                 "machine",
                 {},
                 {},
                 {},
                 "axis columns need a cone mill or a generic machine"});
  }
  std::vector<AxisFunction> out;
  for (std::size_t a = 0; a < machine.axes.size(); ++a) out.push_back(coordinate(a));
  return out;
}

std::vector<AxisFunction> mill_tip(const AxisColumns& cut, const Machine& machine) {
  std::vector<AxisFunction> out;
  for (std::size_t a = 0; a < machine.axes.size(); ++a) {
    const std::string& name = machine.axes[a].name;
    if (name == "C") out.push_back(coordinate(a, cut.tip_radius * kRadPerDeg));
    if (name == "X" || name == "Z") out.push_back(coordinate(a));
  }
  return out;
}

/// Checks that the machine keeps the normal of a section up, at a speed along its outside.
Result<void> check_section(const ScheduleSpec& spec) {
  if (!crosses(spec.machine)) {
    const std::string name =
        spec.machine.name.empty() ? std::string(type_name(spec.machine)) : spec.machine.name;
    return fail({ErrorCode::unsupported_combination, "machine", name, std::string(TubeTable::kName),
                 std::string{},
                 "the target is not round, and machine " + name +
                     " has no axis across the tube: take a machine of type tube_table"});
  }
  if (spec.motion.speed_on != Surface::outer) {
    return fail({ErrorCode::unsupported_combination, "motion/speed_on", "inner", "outer",
                 std::string{}, "the speed on a bore requires a round target"});
  }
  return {};
}

double dot(const Coordinates& a, const Coordinates& b) {
  double sum = 0.0;
  for (std::size_t c = 0; c < kMostCoordinates; ++c) sum += a[c] * b[c];
  return sum;
}

}  // namespace

double AxisFunction::at(const Coordinates& x) const {
  if (is_linear()) return constant + dot(linear, x);
  const auto [sin, cos] = elementary::sincos(x[kB]);
  if (!turns()) return at(Pose{x, sin, cos});
  const auto up = elementary::sincos(x[kPhi]);
  return at(Pose{x, sin, cos, up.sin, up.cos});
}

double AxisFunction::at(const Pose& pose) const {
  const double q = constant + dot(linear, pose.x);
  if (is_linear()) return q;
  const double tilt = tan_b == 0.0 ? 0.0 : tan_b * pose.sin_b / pose.cos_b;
  const double bent = q + (sin_b * pose.sin_b + cos_b * pose.cos_b + tilt);
  if (!turns()) return bent;
  const double x = pose.x[kPx], y = pose.x[kPy];
  return bent +
         (across * (y * pose.cos_up - x * pose.sin_up) + out * (x * pose.cos_up + y * pose.sin_up));
}

namespace {

/// The tip's height p . n and its place across p . t, or one of their derivatives.
struct Upright {
  double out = 0.0, across = 0.0;
};

Upright upright(const Jet& jet, const Coordinates& x) {
  return {x[kPx] * jet.cos_up + x[kPy] * jet.sin_up, x[kPy] * jet.cos_up - x[kPx] * jet.sin_up};
}

/// Computes the three derivatives of p . n and p . t: those of p as they stand, and the turn of n
/// and t, n' = x_0' t and t' = -x_0' n.
std::array<Upright, 3> upright_derivatives(const Jet& jet) {
  const auto p = upright(jet, jet.value), p1 = upright(jet, jet.first);
  const auto p2 = upright(jet, jet.second), p3 = upright(jet, jet.third);
  const double a1 = jet.first[kPhi], a2 = jet.second[kPhi], a3 = jet.third[kPhi];
  const double square = a1 * a1;
  return {{{p1.out + a1 * p.across, p1.across - a1 * p.out},
           {p2.out + 2.0 * a1 * p1.across + a2 * p.across - square * p.out,
            p2.across - 2.0 * a1 * p1.out - a2 * p.out - square * p.across},
           {p3.out + 3.0 * (a1 * p2.across + a2 * p1.across - square * p1.out) + a3 * p.across -
                3.0 * a1 * a2 * p.out - square * a1 * p.across,
            p3.across - 3.0 * (a1 * p2.out + a2 * p1.out + square * p1.across) - a3 * p.out -
                3.0 * a1 * a2 * p.across + square * a1 * p.out}}};
}

}  // namespace

std::array<double, 3> AxisFunction::derivatives(const Jet& jet) const {
  std::array<double, 3> q{dot(linear, jet.first), dot(linear, jet.second), dot(linear, jet.third)};
  if (is_linear()) return q;
  const double sin = jet.sin_b, cos = jet.cos_b;
  const double tan = sin / cos, sec2 = 1.0 / (cos * cos);
  const double f1 = sin_b * cos - cos_b * sin + tan_b * sec2;
  const double f2 = -sin_b * sin - cos_b * cos + tan_b * 2.0 * sec2 * tan;
  const double f3 =
      -sin_b * cos + cos_b * sin + tan_b * (2.0 * sec2 * sec2 + 4.0 * sec2 * tan * tan);
  const double b1 = jet.first[kB], b2 = jet.second[kB], b3 = jet.third[kB];
  q[0] += f1 * b1;
  q[1] += f2 * b1 * b1 + f1 * b2;
  q[2] += f3 * b1 * b1 * b1 + 3.0 * f2 * b1 * b2 + f1 * b3;
  if (!turns()) return q;
  const auto moved = upright_derivatives(jet);
  for (std::size_t k = 0; k < q.size(); ++k) q[k] += out * moved[k].out + across * moved[k].across;
  return q;
}

Result<std::vector<AxisFunction>> axis_functions(const ScheduleSpec& spec) {
  if (const auto* const cut_path = std::get_if<CutPath>(&spec.cut)) {
    if (cut_path->section) TRY(check_section(spec));
    return std::visit(CutPathAxes{spec.machine, *cut_path}, spec.machine.kinematics);
  }
  return column_axes(spec.machine);
}

std::vector<AxisFunction> speed_functions(const ScheduleSpec& spec) {
  if (const auto* const cut_path = std::get_if<CutPath>(&spec.cut)) {
    if (cut_path->section) return {coordinate(kPx), coordinate(kPy), coordinate(kZ)};
    const double rho =
        spec.motion.speed_on == Surface::outer ? cut_path->outer_radius : cut_path->inner_radius();
    AxisFunction along = linear(0.0, 1.0, 0.0);
    along.tan_b = -spec.machine.sigma() * (rho - cut_path->radius());
    return {linear(rho, 0.0, 0.0), along};
  }
  const auto& columns = std::get<AxisColumns>(spec.cut);
  if (std::holds_alternative<ConeMill>(spec.machine.kinematics) && columns.length.empty()) {
    return mill_tip(columns, spec.machine);
  }
  return {coordinate(spec.machine.axes.size())};
}

Result<double> standoff_growth(const ScheduleSpec& spec, const Program& program) {
  const auto* const crawler = std::get_if<Crawler>(&spec.machine.kinematics);
  if (crawler == nullptr || crawler->swing_center != SwingCenter::pivot) return 0.0;
  double largest = 0.0;
  double at_phi = 0.0;
  for (std::size_t i = 0; i < program.size(); ++i) {
    const double cos = elementary::cos(program.x[kB][i]);
    const double growth = crawler->pivot_length / cos - crawler->pivot_length;
    if (growth > largest) at_phi = program.x[kPhi][i];
    largest = std::max(largest, growth);
  }
  if (crawler->standoff_max && largest > *crawler->standoff_max) {
    return fail({ErrorCode::standoff_too_large, "machine/standoff_max", largest,
                 *crawler->standoff_max, "mm", "at phi " + brief(at_phi * kDegPerRad) + " deg"});
  }
  return largest;
}

}  // namespace tubecut::motion
