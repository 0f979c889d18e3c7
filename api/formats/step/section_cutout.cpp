#include "api/formats/step/section_cutout.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "api/formats/step/prism_wall.hpp"

namespace tubecut::api {
namespace {

using cutout::Flat;
using Eigen::Vector3d;

StrokePlane plane_of(const section::Wall& wall, const cutout::Instance& one, bool far) {
  const auto n = section::Curve::face_normal(one.face);
  const Vector3d normal(n.x(), n.y(), 0.0), round(-n.y(), n.x(), 0.0);
  return {.anchor = wall.outer().face_distance(one.face) * normal + one.offset * round +
                    one.z * Vector3d::UnitZ(),
          .x = Vector3d::UnitZ(),
          .y = far ? Vector3d(-round) : round,
          .normal = normal};
}

class Adder {
 public:
  Adder(const section::Wall& wall, const cutout::Layout& layout, const cutout::Instance& one,
        Brep& solid)
      // Mirrored, the chain runs the other way round.
      : wall_(strokes_of(layout.mould_of(one).chain, layout.mould_of(one).laying.far()),
              plane_of(wall, one, layout.mould_of(one).laying.far()), solid),
        solid_(solid) {}

  CutoutBorder add(int face, double depth, const std::string& name) {
    auto border = wall_.add(depth, name);
    return {.face = face, .outside = std::move(border.above), .bore = std::move(border.below)};
  }

  /// The strokes are those of its circle outside.
  CutoutBorder add_cone(int face, const std::string& name, const cutout::Cone& cone,
                        const cutout::Laying& laying) {
    struct Level {
      double radius, depth;
      std::vector<std::size_t> circle = {};  // its edges
      std::size_t first = 0;                 // of its vertices
    };
    const double wall = laying.wall();
    std::vector<Level> levels{{0.5 * cone.diameter, 0.0}};
    if (cutout::cone_wall(laying, cone) == cutout::ConeWall::landed && cone.depth() < wall)
      levels.push_back({0.5 * cone.hole, cone.depth()});
    levels.push_back(
        {std::max(0.5 * cone.hole, cutout::cone_radius(laying, cone, 0.0, false)), wall});
    const auto n = wall_.strokes().size();
    for (auto& level : levels) {
      const Vector3d down = -level.depth * normal();
      const double share = level.radius / (0.5 * cone.diameter);
      level.first = solid_.vertices.size();
      for (const auto& stroke : wall_.strokes())
        solid_.vertices.push_back(at(share * stroke.from) + down);
      for (std::size_t i = 0; i < n; ++i) {
        auto stroke = wall_.strokes()[i];
        stroke.from *= share;
        stroke.radius = level.radius;
        level.circle.push_back(
            wall_.add_along(stroke, level.first + i, level.first + (i + 1) % n, down));
      }
    }
    CutoutBorder out{.face = face, .outside = {}, .bore = {}};
    for (std::size_t k = 0; k + 1 < levels.size(); ++k) {
      const auto &upper = levels[k], &lower = levels[k + 1];
      std::vector<std::size_t> sides;
      for (std::size_t i = 0; i < n; ++i)
        sides.push_back(
            wall_.add_edge({.from = upper.first + i, .to = lower.first + i, .curve = {}}));
      for (std::size_t i = 0; i < n; ++i) {
        auto stroke = wall_.strokes()[i];
        stroke.radius = lower.radius;
        const Brep::Cone side{.centre = wall_.plane().anchor - lower.depth * normal(),
                              .axis = normal(),
                              .begins = (at(stroke.centre) - at(stroke.middle)).normalized(),
                              .radius = lower.radius,
                              .half = cone.half};
        Brep::Face wall_face{.name = name,
                             .surface = wall_.surface(stroke),
                             .same = false,
                             .cut = true,
                             .loops = {{{upper.circle[i], false},
                                        {sides[i], true},
                                        {lower.circle[i], true},
                                        {sides[(i + 1) % n], false}}}};
        if (k == 0) wall_face.surface = side;
        solid_.faces.push_back(std::move(wall_face));
      }
    }
    for (std::size_t i = 0; i < n; ++i) {
      out.outside.emplace_back(levels.front().circle[i], true);
      out.bore.emplace_back(levels.back().circle[i], false);
    }
    std::ranges::reverse(out.bore);
    return out;
  }

 private:
  [[nodiscard]] Vector3d at(const Flat& p) const { return wall_.plane().at(p); }
  [[nodiscard]] const Vector3d& normal() const { return wall_.plane().normal; }

  PrismWall wall_;
  Brep& solid_;
};

}  // namespace

CutoutBorder add_cutout(const section::Wall& wall, const cutout::Layout& layout,
                        const cutout::Instance& one, const std::string& name, Brep& solid) {
  const auto& mould = layout.mould_of(one);
  if (mould.cone)
    return Adder(wall, layout, one, solid).add_cone(one.face, name, *mould.cone, mould.laying);
  return Adder(wall, layout, one, solid).add(one.face, wall.section().wall, name);
}

}  // namespace tubecut::api
