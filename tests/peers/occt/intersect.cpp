// Reads cases (compare.py writes them) and lets Open CASCADE cut: a line for each kind of
// comparison with the points compared and the largest deviation in mm. With `--time TOLERANCE` only
// its curves, made to that tolerance in mm: a line with the time in ms, the points compared and the
// largest deviation.
#include <GeomAPI_IntCS.hxx>
#include <GeomAPI_IntSS.hxx>
#include <GeomAPI_ProjectPointOnCurve.hxx>
#include <Geom_ConicalSurface.hxx>
#include <Geom_Curve.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_Line.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <gp_Ax3.hxx>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "tests/peers/worst.hpp"

namespace {

constexpr double kSteep = 0.05;      // sine between line and surface below which z is not compared
constexpr double kTolerance = 1e-7;  // of the curves that are compared, mm
constexpr double kReach = 20'000.0;  // mm, of the trimmed surfaces along their axes
constexpr double kNearApex = 1e-3;   // mm, where the trimmed cone begins

struct Partner {
  Handle(Geom_Surface) whole, trimmed;
  gp_Ax1 axis;                 // of a cone: towards its opening
  std::optional<gp_Pnt> apex;  // of a cone
};

Partner read_partner() {
  std::string kind;
  double radius = 0.0, half = 0.0, p[3], d[3];
  std::cin >> kind >> radius >> half >> p[0] >> p[1] >> p[2] >> d[0] >> d[1] >> d[2];
  gp_Dir direction(d[0], d[1], d[2]);
  if (half < 0.0) direction.Reverse();
  const gp_Ax3 frame(gp_Pnt(p[0], p[1], p[2]), direction);
  if (kind == "tube") {
    Handle(Geom_Surface) tube = new Geom_CylindricalSurface(frame, radius);
    return {tube,
            new Geom_RectangularTrimmedSurface(tube, -kReach, kReach, Standard_False),
            frame.Axis(),
            {}};
  }
  Handle(Geom_ConicalSurface) cone = new Geom_ConicalSurface(frame, std::abs(half), radius);
  const double from_apex = radius / std::sin(std::abs(half));
  return {cone,
          new Geom_RectangularTrimmedSurface(cone, kNearApex - from_apex, kReach, Standard_False),
          frame.Axis(), cone->Cone().Apex()};
}

bool on_the_nappe(const Partner& partner, const gp_Pnt& p) {
  return !partner.apex || gp_Vec(*partner.apex, p).Dot(gp_Vec(partner.axis.Direction())) > 0.0;
}

struct Point {
  double phi, z;
  std::size_t cutter;
  [[nodiscard]] gp_Pnt at(double rho) const {
    return {rho * std::cos(phi), rho * std::sin(phi), z};
  }
};

/// The highest place where the generator meets any partner, with the sine of its angle there.
struct Met {
  double z, sine;
};
std::optional<Met> highest(const std::vector<Partner>& partners, double rho, double phi) {
  Handle(Geom_Line) line =
      new Geom_Line(gp_Pnt(rho * std::cos(phi), rho * std::sin(phi), 0.0), gp::DZ());
  std::optional<Met> out;
  for (const auto& partner : partners) {
    const GeomAPI_IntCS met(line, partner.whole);
    for (int i = 1; met.IsDone() && i <= met.NbPoints(); ++i) {
      if (!on_the_nappe(partner, met.Point(i)) || (out && met.Point(i).Z() <= out->z)) continue;
      double u = 0.0, v = 0.0, w = 0.0;
      met.Parameters(i, u, v, w);
      gp_Pnt p;
      gp_Vec du, dv;
      partner.whole->D1(u, v, p, du, dv);
      out = Met{met.Point(i).Z(), std::abs(du.Crossed(dv).Normalized().Z())};
    }
  }
  return out;
}

struct Comparison {
  Worst generator, grazing, curve;
};

void compare_generators(const std::vector<Partner>& partners, double rho,
                        const std::vector<Point>& points, Comparison& out) {
  for (const auto& point : points) {
    const auto met = highest(partners, rho, point.phi);
    const double apart = met ? std::abs(met->z - point.z) : INFINITY;
    if (met && met->sine < kSteep)
      out.grazing.see(apart * met->sine);
    else
      out.generator.see(apart);
  }
}

Handle(Geom_Surface) target_of(double rho) {
  Handle(Geom_Surface) round = new Geom_CylindricalSurface(gp_Ax3(gp::XOY()), rho);
  return new Geom_RectangularTrimmedSurface(round, -kReach, kReach, Standard_False);
}

void compare_curves(const std::vector<Partner>& partners, double rho,
                    const std::vector<Point>& points, double tolerance, Comparison& out) {
  const auto target = target_of(rho);
  for (std::size_t k = 0; k < partners.size(); ++k) {
    if (std::ranges::none_of(points, [&](const Point& p) { return p.cutter == k; })) continue;
    GeomAPI_IntSS met(target, partners[k].trimmed, tolerance);
    for (const auto& point : points) {
      if (point.cutter != k) continue;
      double nearest = INFINITY;
      for (int i = 1; met.IsDone() && i <= met.NbLines(); ++i) {
        const auto curve = met.Line(i);
        for (const double end : {curve->FirstParameter(), curve->LastParameter()})
          if (std::abs(end) < Precision::Infinite())
            nearest = std::min(nearest, curve->Value(end).Distance(point.at(rho)));
        const GeomAPI_ProjectPointOnCurve foot(point.at(rho), curve);
        if (foot.NbPoints() > 0) nearest = std::min(nearest, foot.LowerDistance());
      }
      out.curve.see(nearest);
    }
  }
}

void report(const char* name, const Worst& worst) {
  std::printf("%s %ld %.17g\n", name, worst.points, worst.deviation);
}

struct Case {
  std::vector<Partner> partners;
  std::vector<std::pair<double, std::vector<Point>>> surfaces;  // radius, and the answered points
};

bool read(Case& out) {
  std::size_t partners = 0, surfaces = 0;
  if (!(std::cin >> partners)) return false;
  out = {};
  for (std::size_t i = 0; i < partners; ++i) out.partners.push_back(read_partner());
  std::cin >> surfaces;
  for (std::size_t i = 0; i < surfaces; ++i) {
    double rho = 0.0;
    std::size_t n = 0;
    std::cin >> rho >> n;
    std::vector<Point> points(n);
    for (auto& p : points) std::cin >> p.phi >> p.z >> p.cutter;
    out.surfaces.emplace_back(rho, std::move(points));
  }
  return true;
}

void compare(const Case& of) {
  Comparison out;
  for (const auto& [rho, points] : of.surfaces) {
    compare_generators(of.partners, rho, points, out);
    compare_curves(of.partners, rho, points, kTolerance, out);
  }
  report("generator", out.generator);
  report("grazing", out.grazing);
  report("curve", out.curve);
}

/// Every surface with every partner: the minimum work of their cut.
void time(const Case& of, double tolerance) {
  constexpr int kRounds = 9;
  std::vector<double> ms;
  for (int i = 0; i < kRounds; ++i) {
    const auto begun = std::chrono::steady_clock::now();
    for (const auto& [rho, points] : of.surfaces)
      for (const auto& partner : of.partners)
        const GeomAPI_IntSS met(target_of(rho), partner.trimmed, tolerance);
    ms.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begun)
                     .count());
  }
  std::ranges::sort(ms);
  Comparison out;
  for (const auto& [rho, points] : of.surfaces)
    compare_curves(of.partners, rho, points, tolerance, out);
  std::printf("%.6f %ld %.17g\n", ms[kRounds / 2], out.curve.points, out.curve.deviation);
}

}  // namespace

int main(int argc, char** argv) {
  const bool timed = argc == 3 && std::string(argv[1]) == "--time";
  for (Case one; read(one);) {
    if (timed)
      time(one, std::stod(argv[2]));
    else
      compare(one);
  }
}
