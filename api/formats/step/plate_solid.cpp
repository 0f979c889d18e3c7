#include "api/formats/step/plate_solid.hpp"

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "api/formats/step/prism_wall.hpp"
#include "api/formats/text.hpp"

namespace tubecut::api {
namespace {

using Eigen::Vector3d;

/// The chain of an outline encloses metal, that of a hole scrap.
std::vector<WallStroke> outline_strokes(const cutout::Chain& outline) {
  auto out = strokes_of(outline, false);
  for (auto& stroke : out) stroke.hollow = stroke.radius > 0.0 && !stroke.hollow;
  return out;
}

}  // namespace

Brep plate_solid(const PlateDrawing& plate) {
  const StrokePlane plane{Vector3d::Zero(), Vector3d::UnitX(), Vector3d::UnitY(),
                          Vector3d::UnitZ()};
  Brep out{.wall = plate.thickness};
  Brep::Face face{.name = "face", .surface = Brep::Plane{plane.anchor, plane.normal}};
  Brep::Face back{
      .name = "back",
      .surface = Brep::Plane{plane.anchor - plate.thickness * plane.normal, -plane.normal}};
  const auto add = [&](std::vector<WallStroke> strokes, const std::string& name) {
    auto border = PrismWall(std::move(strokes), plane, out).add(plate.thickness, name);
    face.loops.push_back(std::move(border.above));
    back.loops.push_back(std::move(border.below));
  };
  add(outline_strokes(plate.outline), "outline");
  for (const auto& hole : plate.holes) add(strokes_of(hole.chain, true), "hole " + hole.name);
  out.faces.push_back(std::move(face));
  out.faces.push_back(std::move(back));
  return out;
}

Product product_of(const PlateDrawing& plate, const Caption& caption) {
  auto out = product_of("", plate.name, caption);
  out.name = "plate " + fixed(plate.thickness, 3) + " mm";
  return out;
}

std::string print_plate_step(const PlateDrawing& plate, const Caption& caption) {
  return print_step(plate_solid(plate), product_of(plate, caption), caption);
}

}  // namespace tubecut::api
