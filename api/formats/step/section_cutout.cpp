#include "api/formats/step/section_cutout.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

namespace tubecut::api {
namespace {

using cutout::Flat;
using Eigen::Vector3d;

/// A line or an arc of at most half a turn, with the metal to its left as seen from outside.
struct Stroke {
  Flat from, to;
  Flat centre = Flat::Zero(), middle = Flat::Zero();  // of an arc
  double radius = 0.0;                                // 0 of a line
  bool hollow = false;
};

std::vector<Stroke> strokes_of(const cutout::Chain& chain, bool far) {
  constexpr double kHalfTurn = 3.2;  // rad, slightly more
  std::vector<Stroke> out;
  for (const auto& s : chain) {
    const int parts = s.arc() ? static_cast<int>(std::ceil(std::abs(s.sweep) / kHalfTurn)) : 1;
    for (int i = 0; i < parts; ++i) {
      Stroke one{.from = s.at(static_cast<double>(i) / parts),
                 .to = s.at(static_cast<double>(i + 1) / parts)};
      if (s.arc()) {
        one.centre = s.centre;
        one.middle = s.at((i + 0.5) / parts);
        one.radius = s.radius;
        one.hollow = s.hollow();
      }
      out.push_back(one);
    }
  }
  if (!far) return out;
  // Mirrored, the chain runs the other way round.
  std::ranges::reverse(out);
  for (auto& one : out) std::swap(one.from, one.to);
  return out;
}

class Adder {
 public:
  Adder(const section::Wall& wall, const cutout::Layout& layout, const cutout::Instance& one,
        Brep& solid)
      : strokes_(strokes_of(layout.mould_of(one).chain, layout.mould_of(one).laying.far())),
        solid_(solid) {
    const auto n = section::Curve::face_normal(one.face);
    normal_ = {n.x(), n.y(), 0.0};
    round_ = {-n.y(), n.x(), 0.0};
    anchor_ = wall.outer().face_distance(one.face) * normal_ + one.offset * round_ +
              one.z * Vector3d::UnitZ();
    inwards_ = -wall.section().wall * normal_;
    if (layout.mould_of(one).laying.far()) round_ = -round_;
  }

  CutoutBorder add(int face, const std::string& name) {
    CutoutBorder out{.face = face, .outside = {}, .bore = {}};
    const auto n = strokes_.size();
    const auto first = solid_.vertices.size();
    for (const auto& stroke : strokes_) {
      solid_.vertices.push_back(at(stroke.from));
      solid_.vertices.push_back(at(stroke.from) + inwards_);
    }
    const auto outside = [&](std::size_t i) { return first + 2 * (i % n); };
    std::vector<std::size_t> sides;
    for (std::size_t i = 0; i < n; ++i)
      sides.push_back(add_edge({.from = outside(i), .to = outside(i) + 1, .curve = {}}));
    for (std::size_t i = 0; i < n; ++i) {
      const auto& stroke = strokes_[i];
      const auto upper = add_along(stroke, outside(i), outside(i + 1), Vector3d::Zero());
      const auto lower = add_along(stroke, outside(i) + 1, outside(i + 1) + 1, inwards_);
      solid_.faces.push_back(
          {.name = name,
           .surface = surface(stroke),
           .same = !stroke.hollow,
           .cut = true,
           .loops = {
               {{upper, false}, {sides[i], true}, {lower, true}, {sides[(i + 1) % n], false}}}});
      out.outside.emplace_back(upper, true);
      out.bore.emplace_back(lower, false);
    }
    std::ranges::reverse(out.bore);
    return out;
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
    const auto n = strokes_.size();
    for (auto& level : levels) {
      const Vector3d down = level.depth / wall * inwards_;
      const double share = level.radius / (0.5 * cone.diameter);
      level.first = solid_.vertices.size();
      for (const auto& stroke : strokes_) solid_.vertices.push_back(at(share * stroke.from) + down);
      for (std::size_t i = 0; i < n; ++i) {
        auto stroke = strokes_[i];
        stroke.from *= share;
        stroke.radius = level.radius;
        level.circle.push_back(add_along(stroke, level.first + i, level.first + (i + 1) % n, down));
      }
    }
    CutoutBorder out{.face = face, .outside = {}, .bore = {}};
    for (std::size_t k = 0; k + 1 < levels.size(); ++k) {
      const auto &upper = levels[k], &lower = levels[k + 1];
      std::vector<std::size_t> sides;
      for (std::size_t i = 0; i < n; ++i)
        sides.push_back(add_edge({.from = upper.first + i, .to = lower.first + i, .curve = {}}));
      for (std::size_t i = 0; i < n; ++i) {
        auto stroke = strokes_[i];
        stroke.radius = lower.radius;
        const Brep::Cone side{.centre = anchor_ + lower.depth / wall * inwards_,
                              .axis = normal_,
                              .begins = (at(stroke.centre) - at(stroke.middle)).normalized(),
                              .radius = lower.radius,
                              .half = cone.half};
        Brep::Face wall_face{.name = name,
                             .surface = surface(stroke),
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
  [[nodiscard]] Vector3d at(const Flat& p) const {
    return anchor_ + p.y() * round_ + p.x() * Vector3d::UnitZ();
  }
  std::size_t add_edge(Brep::Edge edge) {
    if (edge.curve.empty() && !edge.circle)
      edge.curve = {solid_.vertices[edge.from], solid_.vertices[edge.to]};
    solid_.edges.push_back(std::move(edge));
    return solid_.edges.size() - 1;
  }
  std::size_t add_along(const Stroke& stroke, std::size_t from, std::size_t to,
                        const Vector3d& depth) {
    Brep::Edge edge{.from = from, .to = to, .curve = {}};
    if (stroke.radius > 0.0)
      edge.circle = Brep::Circle{.centre = at(stroke.centre) + depth,
                                 // Around the scrap, so against the normal; around metal, with it.
                                 .axis = stroke.hollow ? Vector3d(-normal_) : normal_,
                                 .begins = (at(stroke.from) - at(stroke.centre)).normalized(),
                                 .radius = stroke.radius};
    return add_edge(std::move(edge));
  }
  [[nodiscard]] decltype(Brep::Face::surface) surface(const Stroke& stroke) const {
    if (stroke.radius > 0.0)
      return Brep::Bore{.centre = at(stroke.centre),
                        .axis = normal_,
                        // Its seam lies opposite to the face.
                        .begins = (at(stroke.centre) - at(stroke.middle)).normalized(),
                        .radius = stroke.radius};
    // The metal lies to the left of the line.
    const Vector3d along = (at(stroke.to) - at(stroke.from)).normalized();
    return Brep::Plane{at(stroke.from), along.cross(normal_)};
  }

  std::vector<Stroke> strokes_;
  Brep& solid_;
  Vector3d normal_, round_, anchor_, inwards_;
};

}  // namespace

CutoutBorder add_cutout(const section::Wall& wall, const cutout::Layout& layout,
                        const cutout::Instance& one, const std::string& name, Brep& solid) {
  const auto& mould = layout.mould_of(one);
  if (mould.cone)
    return Adder(wall, layout, one, solid).add_cone(one.face, name, *mould.cone, mould.laying);
  return Adder(wall, layout, one, solid).add(one.face, name);
}

}  // namespace tubecut::api
