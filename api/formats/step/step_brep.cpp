#include <cmath>
#include <string>
#include <string_view>
#include <utility>

#include "api/formats/step/brep.hpp"
#include "api/formats/step/step_solid.hpp"

namespace tubecut::api {
namespace {

using Id = StepEntities::Id;

constexpr int kRadiusDigits = 9;
constexpr std::string_view kCubic = "(4,4),(0.,1.)";

class Printer {
 public:
  Printer(const Brep& solid, StepEntities& entities, Pace& pace)
      : solid_(solid), entities_(entities), pace_(pace) {}

  Id boundary() {
    std::vector<Id> vertices, edges, faces;
    for (const auto& p : solid_.vertices)
      vertices.push_back(entities_.add("VERTEX_POINT(''," + step_ref(entities_.point(p)) + ")"));
    for (const auto& edge : solid_.edges) {
      pace_.tick();
      const auto along = edge.circle ? circle(*edge.circle) : curve(edge.curve);
      edges.push_back(entities_.add("EDGE_CURVE(''," + step_ref(vertices[edge.from]) + "," +
                                    step_ref(vertices[edge.to]) + "," + step_ref(along) + ",.T.)"));
    }
    for (const auto& face : solid_.faces) {
      pace_.tick();
      faces.push_back(print(face, edges));
      if (face.cut) cut_faces_.push_back(faces.back());
    }
    const auto shell = entities_.add("CLOSED_SHELL(''," + step_refs(faces) + ")");
    return entities_.add("MANIFOLD_SOLID_BREP(''," + step_ref(shell) + ")");
  }
  [[nodiscard]] const std::vector<Id>& cut_faces() const { return cut_faces_; }

 private:
  Id print(const Brep::Face& face, const std::vector<Id>& edges) {
    const auto bounds = entities_.bounds(face.loops, edges);
    const auto under = std::visit([&](const auto& of) { return surface(of); }, face.surface);
    return entities_.add("ADVANCED_FACE(" + step_string(face.name) + "," + step_refs(bounds) + "," +
                         step_ref(under) + "," + step_logical(face.same) + ")");
  }

  std::vector<Id> points(const Brep::Points& all) {
    std::vector<Id> out;
    for (const auto& p : all) out.push_back(entities_.point(p));
    return out;
  }

  Id curve(const Brep::Points& of) {
    if (of.size() == 4)
      return entities_.add("B_SPLINE_CURVE_WITH_KNOTS('',3," + step_refs(points(of)) +
                           ",.UNSPECIFIED.,.F.,.F.," + std::string(kCubic) + ",.UNSPECIFIED.)");
    const Eigen::Vector3d along = (of[1] - of[0]).normalized();
    const auto vector =
        entities_.shared("VECTOR(''," + step_ref(entities_.direction(along)) + ",1.)");
    return entities_.add("LINE(''," + step_ref(entities_.point(of[0])) + "," + step_ref(vector) +
                         ")");
  }

  Id axes(const Eigen::Vector3d& origin, const Eigen::Vector3d& z, const Eigen::Vector3d& x) {
    const auto at = entities_.point(origin), up = entities_.direction(z),
               side = entities_.direction(x);
    return entities_.shared("AXIS2_PLACEMENT_3D(''," + step_ref(at) + "," + step_ref(up) + "," +
                            step_ref(side) + ")");
  }

  Id circle(const Brep::Circle& of) {
    return entities_.add("CIRCLE(''," + step_ref(axes(of.centre, of.axis, of.begins)) + "," +
                         step_real(of.radius, kRadiusDigits) + ")");
  }

  Id surface(const Brep::Bore& of) {
    return entities_.shared("CYLINDRICAL_SURFACE(''," +
                            step_ref(axes(of.centre, of.axis, of.begins)) + "," +
                            step_real(of.radius, kRadiusDigits) + ")");
  }
  Id surface(const Brep::Cone& of) {
    return entities_.shared("CONICAL_SURFACE(''," + step_ref(axes(of.centre, of.axis, of.begins)) +
                            "," + step_real(of.radius, kRadiusDigits) + "," +
                            step_real(of.half, kRadiusDigits) + ")");
  }
  Id surface(const Brep::Plane& plane) {
    Eigen::Vector3d across = Eigen::Vector3d::Unit(0);
    if (std::abs(plane.normal.x()) > 0.9) across = Eigen::Vector3d::Unit(1);
    const Eigen::Vector3d x = (across - across.dot(plane.normal) * plane.normal).normalized();
    return entities_.shared("PLANE(''," + step_ref(axes(plane.point, plane.normal, x)) + ")");
  }
  Id surface(const Brep::Cylinder& of) {
    const Eigen::Vector3d centre(of.centre.x(), of.centre.y(), 0.0);
    return entities_.shared("CYLINDRICAL_SURFACE(''," +
                            step_ref(entities_.placement(centre, of.begins)) + "," +
                            step_real(of.radius, kRadiusDigits) + ")");
  }
  Id surface(const Brep::Patch& patch) {
    std::string grid = "(";
    for (std::size_t i = 0; i < patch.inner.size(); ++i) {
      const auto inner = entities_.point(patch.inner[i]), outer = entities_.point(patch.outer[i]);
      grid += (i > 0 ? "," : "") + step_refs({inner, outer});
    }
    return entities_.add("B_SPLINE_SURFACE_WITH_KNOTS('',3,1," + grid +
                         "),.UNSPECIFIED.,.F.,.F.,.F.,(4,4),(2,2),(0.,1.),(0.,1.),.UNSPECIFIED.)");
  }

  const Brep& solid_;
  StepEntities& entities_;
  Pace& pace_;
  std::vector<Id> cut_faces_;
};

}  // namespace

StepFile::Shape StepFile::solid(const Brep& solid, const Product& product) {
  return add_solid(product, [&] {
    Printer printer(solid, entities_, pace_);
    const auto brep = printer.boundary();
    return std::pair{brep, printer.cut_faces()};
  });
}

std::string print_step(const Brep& solid, const Product& product, const Caption& caption) {
  StepFile file(solid.wall, caption);
  file.solid(solid, product);
  return file.print(product, "one closed solid");
}

}  // namespace tubecut::api
