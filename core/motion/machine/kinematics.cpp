#include "core/motion/machine/kinematics.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/elementary.hpp"

namespace tubecut::motion {
namespace {

constexpr std::size_t kPhi = 0, kZ = 1, kB = 2;

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

double dot(const Coordinates& a, const Coordinates& b) {
  double sum = 0.0;
  for (std::size_t c = 0; c < kMostCoordinates; ++c) sum += a[c] * b[c];
  return sum;
}

}  // namespace

double AxisFunction::at(const Coordinates& x) const {
  if (is_linear()) return constant + dot(linear, x);
  const auto [sin, cos] = elementary::sincos(x[kB]);
  return at(Pose{x, sin, cos});
}

double AxisFunction::at(const Pose& pose) const {
  const double q = constant + dot(linear, pose.x);
  if (is_linear()) return q;
  const double tilt = tan_b == 0.0 ? 0.0 : tan_b * pose.sin_b / pose.cos_b;
  return q + (sin_b * pose.sin_b + cos_b * pose.cos_b + tilt);
}

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
  return q;
}

Result<std::vector<AxisFunction>> axis_functions(const ScheduleSpec& spec) {
  if (const auto* const cut_path = std::get_if<CutPath>(&spec.cut)) {
    return std::visit(CutPathAxes{spec.machine, *cut_path}, spec.machine.kinematics);
  }
  return column_axes(spec.machine);
}

std::vector<AxisFunction> speed_functions(const ScheduleSpec& spec) {
  if (const auto* const cut_path = std::get_if<CutPath>(&spec.cut)) {
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
