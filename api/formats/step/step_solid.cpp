#include "api/formats/step/step_solid.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "api/api.hpp"
#include "api/formats/step/step_file.hpp"
#include "api/stop.hpp"
#include "api/verdict.hpp"
#include "core/base/angle.hpp"

namespace tubecut::api {
namespace {

using Id = StepEntities::Id;

constexpr int kKnotDigits = 6;
constexpr int kRadiusDigits = 9;
constexpr double kThin = 3.0;  // mm
/// mm: a cubic that is straight in (phi, z) is ahead of a line's parameter or behind it by at most
/// 0.1 (angle^2 / 48) of its length; up to this distance, the line replaces it
constexpr double kAhead = 1e-4;
constexpr double kRounded = kSplineError / 3.0;  // mm
constexpr double kInLine = 1e-7;                 // of a span's length, off its line
/// mm: distance within which a reader must hold edges to their faces. Open CASCADE computes the
/// curve of an edge on its face as a line if it is straight within this: with 0.0015 mm its volumes
/// were up to 1e-5 off, from 5e-5 to 5e-4 up to 4e-7, and with 2e-5 up to 4e-6 again
constexpr double kClosed = 1e-4;

/// Returns the number of digits: a volume depends on the mean rounding error, relative to the wall.
int digits_for(double wall) { return wall < kThin ? 6 : 5; }

/// Returns multiplicities and knots of a wall's spline from knot to knot: "(4,2,4),(0.,1.,2.)";
/// degree 1 if all knots are full.
std::string knots(const WallSpline& spline, std::size_t from, std::size_t to, int degree = 3) {
  std::string counts = "(" + std::to_string(degree + 1), at = "(0.";
  for (auto i = from + 1; i <= to; ++i) {
    const auto& knot = spline.knots[i];
    counts += "," + std::to_string(i == to ? degree + 1 : knot.full ? degree : degree - 1);
    at += "," + step_real(knot.u - spline.knots[from].u, kKnotDigits);
  }
  return counts + ")," + at + ")";
}

std::string knots_across(const std::string& along) {
  const auto middle = along.find("),(") + 1;
  return along.substr(0, middle) + ",(2,2)" + along.substr(middle) + ",(0.,1.)";
}

/// The faces of one solid, and their colours.
class Printer {
 public:
  Printer(const TubeSolid& solid, StepEntities& entities, Pace& pace)
      : solid_(solid), pace_(pace), entities_(entities) {}

  Id boundary();
  [[nodiscard]] const std::vector<Id>& cut_faces() const { return cut_faces_; }

 private:
  std::vector<Id> points(const TubeSolid::EdgeSpan& span);
  [[nodiscard]] bool has_corner(const TubeSolid::EdgeSpan& span) const;
  [[nodiscard]] bool polygonal(const TubeSolid::EdgeSpan& span) const;
  [[nodiscard]] std::vector<const TubeSolid::Cylinder*> cylinders() const;
  Id on_cylinder(Id curve, const TubeSolid::EdgeSpan& span, const TubeSolid::Cylinder& cylinder);
  Id curve(const TubeSolid::Edge& edge, const TubeSolid::Line&);
  Id curve(const TubeSolid::Edge& edge, const TubeSolid::Arc& arc);
  Id curve(const TubeSolid::Edge& edge, const TubeSolid::EdgeSpan& span);
  Id surface(const TubeSolid::Cylinder& cylinder);
  Id surface(const TubeSolid::Plane& plane);
  Id surface(const TubeSolid::Ruled& ruled);

  const TubeSolid& solid_;
  Pace& pace_;
  StepEntities& entities_;
  std::vector<Id> cut_faces_;
};

std::vector<Id> Printer::points(const TubeSolid::EdgeSpan& span) {
  const auto& spline = solid_.walls[span.wall];
  std::vector<Id> out;
  for (auto i = spline.knots[span.from].control; i <= spline.knots[span.to].control; ++i) {
    pace_.tick();
    out.push_back(entities_.point(spline.points[span.edge][i]));
  }
  return out;
}

Id Printer::curve(const TubeSolid::Edge&, const TubeSolid::EdgeSpan& span) {
  return entities_.add("B_SPLINE_CURVE_WITH_KNOTS('',3," + step_refs(points(span)) +
                       ",.UNSPECIFIED.,.F.,.F.," +
                       knots(solid_.walls[span.wall], span.from, span.to) + ",.UNSPECIFIED.)");
}

/// Whether a smooth curve through its knots would cut a corner within it by more than kRounded.
bool Printer::has_corner(const TubeSolid::EdgeSpan& span) const {
  const auto& spline = solid_.walls[span.wall];
  const auto& points = spline.points[span.edge];
  for (auto i = span.from + 1; i < span.to; ++i) {
    const auto& knot = spline.knots[i];
    if (!knot.full) continue;
    const auto c = knot.control;
    const Eigen::Vector3d before = (points[c] - points[c - 1]).normalized();
    const Eigen::Vector3d after = (points[c + 1] - points[c]).normalized();
    const double shorter = std::min(knot.u - spline.knots[i - 1].u, spline.knots[i + 1].u - knot.u);
    if (before.cross(after).norm() * shorter > 8.0 * kRounded || before.dot(after) < 0.0)
      return true;
  }
  return false;
}

/// Returns the cylinder of each edge; nullptr if the edge is within a cut.
std::vector<const TubeSolid::Cylinder*> Printer::cylinders() const {
  std::vector<const TubeSolid::Cylinder*> out(solid_.edges.size(), nullptr);
  for (const auto& face : solid_.faces) {
    const auto* cylinder = std::get_if<TubeSolid::Cylinder>(&face.surface);
    if (cylinder == nullptr) continue;
    for (const auto& loop : face.loops)
      for (const auto& use : loop) out[use.first] = cylinder;
  }
  return out;
}

/// Whether a span is straight in (phi, z) from knot to knot, by its parameter too.
bool Printer::polygonal(const TubeSolid::EdgeSpan& span) const {
  const auto& spline = solid_.walls[span.wall];
  const auto& flat = spline.flat[span.edge];
  const auto& points = spline.points[span.edge];
  for (auto i = span.from; i < span.to; ++i) {
    const auto &a = spline.knots[i], &b = spline.knots[i + 1];
    const double angle = flat[b.control].x() - flat[a.control].x();
    const double length = (points[b.control] - points[a.control]).norm();
    if (!b.full || angle * angle * length > 480.0 * kAhead) return false;
    const Eigen::Vector2d along = flat[b.control] - flat[a.control];
    for (const auto at : {a.control + 1, a.control + 2}) {
      const Eigen::Vector2d d = flat[at] - flat[a.control];
      if (std::abs(d.x() * along.y() - d.y() * along.x()) > kInLine * along.squaredNorm())
        return false;
    }
  }
  return true;
}

/// Prints the curve together with its (angle, height) on the cylinder, because readers that compute
/// those themselves put a smooth curve through its corners.
Id Printer::on_cylinder(Id curve, const TubeSolid::EdgeSpan& span,
                        const TubeSolid::Cylinder& cylinder) {
  const auto& spline = solid_.walls[span.wall];
  const auto& flat = spline.flat[span.edge];
  const bool lines = polygonal(span);
  const auto first = spline.knots[span.from].control, last = spline.knots[span.to].control;
  const double middle = 0.5 * (flat[first].x() + flat[last].x()) - cylinder.begins;
  const double begins = cylinder.begins + kTwoPi * std::floor(middle / kTwoPi);
  std::vector<Id> points;
  for (auto i = first; i <= last; i += lines ? 3 : 1) {
    pace_.tick();
    points.push_back(entities_.point(Eigen::Vector2d(flat[i].x() - begins, flat[i].y())));
  }
  const auto line =
      entities_.add(std::string("B_SPLINE_CURVE_WITH_KNOTS('',") + (lines ? "1" : "3") + "," +
                    step_refs(points) + ",.UNSPECIFIED.,.F.,.F.," +
                    knots(spline, span.from, span.to, lines ? 1 : 3) + ",.UNSPECIFIED.)");
  const auto context = entities_.shared(
      "(GEOMETRIC_REPRESENTATION_CONTEXT(2)PARAMETRIC_REPRESENTATION_CONTEXT()"
      "REPRESENTATION_CONTEXT('',''))");
  const auto held = entities_.add("DEFINITIONAL_REPRESENTATION(''," + step_refs({line}) + "," +
                                  step_ref(context) + ")");
  const auto pcurve =
      entities_.add("PCURVE(''," + step_ref(surface(cylinder)) + "," + step_ref(held) + ")");
  return entities_.add("SURFACE_CURVE(''," + step_ref(curve) + "," + step_refs({pcurve}) +
                       ",.CURVE_3D.)");
}

Id Printer::curve(const TubeSolid::Edge& edge, const TubeSolid::Line&) {
  const auto& from = solid_.vertices[edge.from];
  const Eigen::Vector3d along = (solid_.vertices[edge.to] - from).normalized();
  const auto vector =
      entities_.shared("VECTOR(''," + step_ref(entities_.direction(along)) + ",1.)");
  return entities_.add("LINE(''," + step_ref(entities_.point(from)) + "," + step_ref(vector) + ")");
}

Id Printer::curve(const TubeSolid::Edge&, const TubeSolid::Arc& arc) {
  return entities_.shared("CIRCLE(''," + step_ref(entities_.placement({0, 0, arc.z})) + "," +
                          step_real(arc.radius, kRadiusDigits) + ")");
}

Id Printer::surface(const TubeSolid::Cylinder& cylinder) {
  return entities_.shared("CYLINDRICAL_SURFACE(''," +
                          step_ref(entities_.placement({0, 0, 0}, cylinder.begins)) + "," +
                          step_real(cylinder.radius, kRadiusDigits) + ")");
}

Id Printer::surface(const TubeSolid::Plane& plane) {
  return entities_.shared("PLANE(''," + step_ref(entities_.placement({0, 0, plane.z})) + ")");
}

Id Printer::surface(const TubeSolid::Ruled& ruled) {
  TubeSolid::EdgeSpan span{ruled.wall, ruled.edge, ruled.from, ruled.to};
  const auto inner = points(span);
  ++span.edge;
  const auto outer = points(span);
  std::string grid = "(";
  for (std::size_t i = 0; i < inner.size(); ++i)
    grid += (i > 0 ? "," : "") + step_refs({inner[i], outer[i]});
  return entities_.add(
      "B_SPLINE_SURFACE_WITH_KNOTS('',3,1," + grid + "),.UNSPECIFIED.,.F.,.F.,.F.," +
      knots_across(knots(solid_.walls[ruled.wall], ruled.from, ruled.to)) + ",.UNSPECIFIED.)");
}

Id Printer::boundary() {
  std::vector<Id> vertices, edges, faces;
  for (const auto& p : solid_.vertices)
    vertices.push_back(entities_.add("VERTEX_POINT(''," + step_ref(entities_.point(p)) + ")"));
  const auto on = cylinders();
  for (std::size_t i = 0; i < solid_.edges.size(); ++i) {
    const auto& edge = solid_.edges[i];
    auto along = std::visit([&](const auto& of) { return curve(edge, of); }, edge.curve);
    const auto* span = std::get_if<TubeSolid::EdgeSpan>(&edge.curve);
    if (span != nullptr && on[i] != nullptr && has_corner(*span))
      along = on_cylinder(along, *span, *on[i]);
    edges.push_back(entities_.add("EDGE_CURVE(''," + step_ref(vertices[edge.from]) + "," +
                                  step_ref(vertices[edge.to]) + "," + step_ref(along) + ",.T.)"));
  }
  for (const auto& face : solid_.faces) {
    const auto bounds = entities_.bounds(face.loops, edges);
    const auto under = std::visit([&](const auto& of) { return surface(of); }, face.surface);
    faces.push_back(entities_.add("ADVANCED_FACE(" + step_string(face.name) + "," +
                                  step_refs(bounds) + "," + step_ref(under) + "," +
                                  step_logical(face.same) + ")"));
    if (face.cut) cut_faces_.push_back(faces.back());
  }
  const auto shell = entities_.add("CLOSED_SHELL(''," + step_refs(faces) + ")");
  return entities_.add("MANIFOLD_SOLID_BREP(''," + step_ref(shell) + ")");
}

Id add_units(StepEntities& e) {
  const auto mm = e.add("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))");
  const auto rad = e.add("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))");
  const auto sr = e.add("(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())");
  const auto within =
      e.add("UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(" + step_real(kClosed, kKnotDigits) +
            ")," + step_ref(mm) + ",'distance_accuracy_value','of edges to their faces')");
  return e.add("(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT(" +
               step_refs({within}) + ")GLOBAL_UNIT_ASSIGNED_CONTEXT(" + step_refs({mm, rad, sr}) +
               ")REPRESENTATION_CONTEXT('',''))");
}

/// The header's texts: job, reference, hashes, verdict. 256 characters are the most one may have.
std::string description(const Caption& caption, std::string_view what) {
  std::vector<std::string> lines{
      engine() + ", numerics " + std::to_string(numerics()) + ", " + std::string(what) +
          ", mm; edges and cut faces within " + step_real(kSplineError, kKnotDigits) + " mm",
      "input_sha256: " + caption.input_sha256, "result_sha256: " + caption.result_sha256};
  for (const auto& [key, text] : caption.reference) lines.push_back(key + ": " + text);
  for (const auto& line : verdict_lines(caption.verdict)) lines.push_back(line);
  std::string out;
  for (const auto& line : lines) out += (out.empty() ? "" : ",\n") + step_string(line);
  return out;
}

}  // namespace

StepFile::StepFile(double thinnest, const Caption& caption)
    : caption_(caption), pace_(), entities_(digits_for(thinnest)) {}

/// Its definition.
StepFile::Id StepFile::add_product(const Product& product) {
  auto& e = entities_;
  const auto application =
      e.shared("APPLICATION_CONTEXT('core data for automotive mechanical design processes')");
  e.shared("APPLICATION_PROTOCOL_DEFINITION('international standard','automotive_design',2001," +
           step_ref(application) + ")");
  const auto context = e.shared("PRODUCT_CONTEXT(''," + step_ref(application) + ",'mechanical')");
  const auto one = e.add("PRODUCT(" + step_string(product.id) + "," + step_string(product.name) +
                         ",''," + step_refs({context}) + ")");
  e.add("PRODUCT_RELATED_PRODUCT_CATEGORY('part',$," + step_refs({one}) + ")");
  const auto formation = e.add("PRODUCT_DEFINITION_FORMATION(" + step_string(product.revision) +
                               ",''," + step_ref(one) + ")");
  const auto design = e.shared("PRODUCT_DEFINITION_CONTEXT('part definition'," +
                               step_ref(application) + ",'design')");
  return e.add("PRODUCT_DEFINITION('design',''," + step_ref(formation) + "," + step_ref(design) +
               ")");
}

StepFile::Id StepFile::style(const std::array<double, 3>& rgb) {
  std::string colour = "COLOUR_RGB(''";
  for (const double share : rgb) colour += "," + step_real(share, 3);
  auto last = entities_.add(colour + ")");
  for (const auto* wrap : {"FILL_AREA_STYLE_COLOUR('',#)", "FILL_AREA_STYLE('',(#))",
                           "SURFACE_STYLE_FILL_AREA(#)", "SURFACE_SIDE_STYLE('',(#))",
                           "SURFACE_STYLE_USAGE(.BOTH.,#)", "PRESENTATION_STYLE_ASSIGNMENT((#))"}) {
    std::string entity(wrap);
    last = entities_.add(entity.replace(entity.find('#'), 1, step_ref(last)));
  }
  return last;
}

void StepFile::colour(Id brep, const std::vector<Id>& cut_faces) {
  std::vector<Id> styled;
  const auto paint = [&](const std::vector<Id>& items, Id with) {
    for (const auto item : items)
      styled.push_back(
          entities_.add("STYLED_ITEM(''," + step_refs({with}) + "," + step_ref(item) + ")"));
  };
  paint({brep}, style({0.62, 0.65, 0.68}));
  paint(cut_faces, style({0.86, 0.45, 0.16}));
  entities_.add("MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION(''," + step_refs(styled) +
                "," + step_ref(context_) + ")");
}

StepFile::Shape StepFile::add_solid(const Product& product,
                                    const std::function<std::pair<Id, std::vector<Id>>()>& print) {
  auto& e = entities_;
  Shape out{.definition = add_product(product)};
  const auto shape = e.add("PRODUCT_DEFINITION_SHAPE('',''," + step_ref(out.definition) + ")");
  if (context_ == 0) context_ = add_units(e);
  const auto [brep, cut_faces] = print();
  out.axes = e.placement({0, 0, 0});
  out.representation = e.add("ADVANCED_BREP_SHAPE_REPRESENTATION(''," +
                             step_refs({out.axes, brep}) + "," + step_ref(context_) + ")");
  e.add("SHAPE_DEFINITION_REPRESENTATION(" + step_ref(shape) + "," + step_ref(out.representation) +
        ")");
  colour(brep, cut_faces);
  return out;
}

StepFile::Shape StepFile::solid(const TubeSolid& solid, const Product& product) {
  return add_solid(product, [&] {
    Printer printer(solid, entities_, pace_);
    const auto brep = printer.boundary();
    return std::pair{brep, printer.cut_faces()};
  });
}

void StepFile::assembly(const Product& product, const std::vector<Placed>& parts) {
  auto& e = entities_;
  const auto definition = add_product(product);
  const auto shape = e.add("PRODUCT_DEFINITION_SHAPE('',''," + step_ref(definition) + ")");
  if (context_ == 0) context_ = add_units(e);
  std::vector<Id> places{e.placement({0, 0, 0})};
  for (const auto& part : parts) {
    pace_.tick();
    // In separate statements, because within one expression each compiler numbers them in its own
    // order.
    const auto x = e.direction(part.rows.row(0)), z = e.direction(part.rows.row(2));
    const auto at = e.point(Eigen::Vector3d(part.origin));
    places.push_back(e.add("AXIS2_PLACEMENT_3D(''," + step_ref(at) + "," + step_ref(z) + "," +
                           step_ref(x) + ")"));
  }
  const auto representation =
      e.add("SHAPE_REPRESENTATION(''," + step_refs(places) + "," + step_ref(context_) + ")");
  e.add("SHAPE_DEFINITION_REPRESENTATION(" + step_ref(shape) + "," + step_ref(representation) +
        ")");
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto& [of, name, origin, rows] = parts[i];
    const auto moved = e.add("ITEM_DEFINED_TRANSFORMATION('',''," + step_ref(of.axes) + "," +
                             step_ref(places[i + 1]) + ")");
    const auto how =
        e.add("(REPRESENTATION_RELATIONSHIP('',''," + step_ref(of.representation) + "," +
              step_ref(representation) + ")REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION(" +
              step_ref(moved) + ")SHAPE_REPRESENTATION_RELATIONSHIP())");
    const auto use = e.add("NEXT_ASSEMBLY_USAGE_OCCURRENCE(" + step_string(std::to_string(i + 1)) +
                           "," + step_string(name) + ",''," + step_ref(definition) + "," +
                           step_ref(of.definition) + ",$)");
    const auto there = e.add("PRODUCT_DEFINITION_SHAPE('',''," + step_ref(use) + ")");
    e.add("CONTEXT_DEPENDENT_SHAPE_REPRESENTATION(" + step_ref(how) + "," + step_ref(there) + ")");
  }
}

std::string StepFile::print(const Product& product, std::string_view what) const {
  // No clock: the same request gives the same bytes, so the time stamp is empty.
  return "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((" + description(caption_, what) +
         "),'2;1');\n" + "FILE_NAME(" + step_string(product.id) + ",'',(''),(''),'tubecut " +
         std::string(version()) + "','tubecut','');\n" +
         "FILE_SCHEMA(('AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }'));\nENDSEC;\nDATA;\n" +
         entities_.text() + "ENDSEC;\nEND-ISO-10303-21;\n";
}

std::string print_step(const TubeSolid& solid, const Product& product, const Caption& caption) {
  StepFile file(solid.wall, caption);
  file.solid(solid, product);
  return file.print(product, "one closed solid");
}

}  // namespace tubecut::api
