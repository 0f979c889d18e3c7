// Reads cases (compare.py writes them) and lets Open CASCADE cut filleted boxes by solids: a line
// for each case and kind of comparison with the points compared and the largest deviation in mm.
#include <BRepAlgoAPI_Section.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepExtrema_DistShapeShape.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRep_Tool.hxx>
#include <IntCurvesFace_ShapeIntersector.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <cmath>
#include <cstdio>
#include <gp_Ax2.hxx>
#include <gp_Lin.hxx>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/peers/worst.hpp"

namespace {

constexpr double kReach = 3'000.0;   // mm, of solids along their axes
constexpr double kTolerance = 1e-9;  // of a line and a face, mm
constexpr double kSteep = 0.05;      // sine between line and surface below which z is not compared
constexpr double kAside = 1e-4;      // mm, of two neighbouring lines that tell the slope

/// A box about the axis of `frame`, its edges along the axis rounded.
TopoDS_Shape filleted(const gp_Ax2& frame, double height, double width, double radius) {
  gp_Ax2 corner = frame;
  corner.Translate(-0.5 * height * gp_Vec(frame.XDirection()) -
                   0.5 * width * gp_Vec(frame.YDirection()) - kReach * gp_Vec(frame.Direction()));
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(corner, height, width, 2.0 * kReach).Shape();
  BRepFilletAPI_MakeFillet rounding(box);
  for (TopExp_Explorer at(box, TopAbs_EDGE); at.More(); at.Next()) {
    const TopoDS_Edge edge = TopoDS::Edge(at.Current());
    double from = 0.0, to = 0.0;
    const auto line = BRep_Tool::Curve(edge, from, to);
    const gp_Vec along(line->Value(from), line->Value(to));
    if (along.IsParallel(frame.Direction(), 1e-9)) rounding.Add(radius, edge);
  }
  return rounding.Shape();
}

gp_Pnt read_point() {
  double x = 0.0, y = 0.0, z = 0.0;
  std::cin >> x >> y >> z;
  return {x, y, z};
}

gp_Ax2 begin_of(const gp_Pnt& point, const gp_Dir& direction) {
  return {point.Translated(-kReach * gp_Vec(direction)), direction};
}

TopoDS_Shape read_partner() {
  std::string kind;
  std::cin >> kind;
  const gp_Pnt point = read_point();
  const gp_Dir direction(gp_Vec(gp_Pnt(), read_point()));
  if (kind == "tube") {
    double radius = 0.0;
    std::cin >> radius;
    return BRepPrimAPI_MakeCylinder(begin_of(point, direction), radius, 2.0 * kReach).Shape();
  }
  if (kind == "plane") {  // its metal is on the side that the normal comes from
    const gp_Ax2 frame(point, direction.Reversed());
    gp_Ax2 corner = frame;
    corner.Translate(-kReach * (gp_Vec(frame.XDirection()) + gp_Vec(frame.YDirection())));
    return BRepPrimAPI_MakeBox(corner, 2.0 * kReach, 2.0 * kReach, 2.0 * kReach).Shape();
  }
  if (kind == "cone") {
    double radius = 0.0, half = 0.0, most = 0.0;
    std::cin >> radius >> half >> most;  // most: how far its two ends lie
    const double slope = std::tan(half);
    const double low = std::min(most, 0.999 * radius / std::abs(slope));
    const double from = slope > 0.0 ? -low : -most, to = slope > 0.0 ? most : low;
    return BRepPrimAPI_MakeCone(gp_Ax2(point.Translated(from * gp_Vec(direction)), direction),
                                radius + from * slope, radius + to * slope, to - from)
        .Shape();
  }
  if (kind != "box") throw std::runtime_error("no such kind: " + kind);
  const gp_Vec up(gp_Pnt(), read_point());
  double height = 0.0, width = 0.0, corner = 0.0;
  std::cin >> height >> width >> corner;
  const gp_Vec across = gp_Vec(direction).Crossed(up);
  return filleted(gp_Ax2(point, direction, gp_Dir(across.Crossed(direction))), height, width,
                  corner);
}

/// The highest place where a line along z leaves any of the solids.
class Lines {
 public:
  explicit Lines(const std::vector<TopoDS_Shape>& solids) : faces_(solids.size()) {
    for (std::size_t i = 0; i < solids.size(); ++i) faces_[i].Load(solids[i], kTolerance);
  }
  std::optional<double> highest(double x, double y) {
    std::optional<double> out;
    for (auto& one : faces_) {
      one.Perform(gp_Lin(gp_Pnt(x, y, 0.0), gp::DZ()), -kReach, kReach);
      for (int i = 1; one.IsDone() && i <= one.NbPnt(); ++i)
        if (const double z = one.Pnt(i).Z(); !out || z > *out) out = z;
    }
    return out;
  }

 private:
  std::vector<IntCurvesFace_ShapeIntersector> faces_;
};

struct Point {
  gp_Pnt at;
  std::size_t cutter;
};

/// One surface: its filleted box and the answered points.
void compare(const std::vector<TopoDS_Shape>& partners, Lines& lines, Worst& steep, Worst& curve) {
  double height = 0.0, width = 0.0, corner = 0.0;
  std::size_t n = 0;
  std::cin >> height >> width >> corner >> n;
  std::vector<Point> points(n);
  for (auto& p : points) {
    p.at = read_point();
    std::cin >> p.cutter;
  }
  for (const auto& p : points) {
    const auto here = lines.highest(p.at.X(), p.at.Y());
    const auto next = lines.highest(p.at.X() + kAside, p.at.Y()),
               other = lines.highest(p.at.X(), p.at.Y() + kAside);
    if (!here || !next || !other) continue;
    const double slope = std::hypot(*next - *here, *other - *here) / kAside;
    if (slope < 1.0 / kSteep) steep.see(std::abs(*here - p.at.Z()));
  }
  const auto target = filleted(gp_Ax2(gp::Origin(), gp::DZ(), gp::DX()), height, width, corner);
  for (std::size_t k = 0; k < partners.size(); ++k) {
    std::vector<gp_Pnt> of;
    for (const auto& p : points)
      if (p.cutter == k) of.push_back(p.at);
    if (of.empty()) continue;
    BRepAlgoAPI_Section section(target, partners[k]);
    for (const auto& p : of) {
      const BRepExtrema_DistShapeShape way(BRepBuilderAPI_MakeVertex(p).Vertex(), section.Shape());
      curve.see(way.IsDone() ? way.Value() : INFINITY);
    }
  }
}

}  // namespace

int main() {
  for (std::size_t count = 0; std::cin >> count;) {
    std::vector<TopoDS_Shape> partners;
    for (std::size_t i = 0; i < count; ++i) partners.push_back(read_partner());
    Lines lines(partners);
    Worst steep, curve;
    for (int surface = 0; surface < 2; ++surface) compare(partners, lines, steep, curve);
    std::printf("line %ld %.17g\ncurve %ld %.17g\n", steep.points, steep.deviation, curve.points,
                curve.deviation);
  }
}
