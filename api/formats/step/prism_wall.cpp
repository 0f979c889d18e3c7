#include "api/formats/step/prism_wall.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace tubecut::api {

using cutout::Flat;
using Eigen::Vector3d;

std::vector<WallStroke> strokes_of(const cutout::Chain& chain, bool reversed) {
  constexpr double kHalfTurn = 3.2;  // rad, slightly more
  std::vector<WallStroke> out;
  for (const auto& s : chain) {
    const int parts = s.arc() ? static_cast<int>(std::ceil(std::abs(s.sweep) / kHalfTurn)) : 1;
    for (int i = 0; i < parts; ++i) {
      WallStroke one{.from = s.at(static_cast<double>(i) / parts),
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
  if (!reversed) return out;
  std::ranges::reverse(out);
  for (auto& one : out) std::swap(one.from, one.to);
  return out;
}

PrismWall::Border PrismWall::add(double depth, const std::string& name) {
  Border out;
  const auto n = strokes_.size();
  const auto first = solid_.vertices.size();
  const Vector3d down = -depth * plane_.normal;
  for (const auto& stroke : strokes_) {
    solid_.vertices.push_back(plane_.at(stroke.from));
    solid_.vertices.push_back(plane_.at(stroke.from) + down);
  }
  const auto above = [&](std::size_t i) { return first + 2 * (i % n); };
  std::vector<std::size_t> sides;
  for (std::size_t i = 0; i < n; ++i)
    sides.push_back(add_edge({.from = above(i), .to = above(i) + 1, .curve = {}}));
  for (std::size_t i = 0; i < n; ++i) {
    const auto& stroke = strokes_[i];
    const auto upper = add_along(stroke, above(i), above(i + 1), Vector3d::Zero());
    const auto lower = add_along(stroke, above(i) + 1, above(i + 1) + 1, down);
    solid_.faces.push_back(
        {.name = name,
         .surface = surface(stroke),
         .same = !stroke.hollow,
         .cut = true,
         .loops = {
             {{upper, false}, {sides[i], true}, {lower, true}, {sides[(i + 1) % n], false}}}});
    out.above.emplace_back(upper, true);
    out.below.emplace_back(lower, false);
  }
  std::ranges::reverse(out.below);
  return out;
}

std::size_t PrismWall::add_edge(Brep::Edge edge) {
  if (edge.curve.empty() && !edge.circle)
    edge.curve = {solid_.vertices[edge.from], solid_.vertices[edge.to]};
  solid_.edges.push_back(std::move(edge));
  return solid_.edges.size() - 1;
}

std::size_t PrismWall::add_along(const WallStroke& stroke, std::size_t from, std::size_t to,
                                 const Vector3d& down) {
  Brep::Edge edge{.from = from, .to = to, .curve = {}};
  if (stroke.radius > 0.0)
    edge.circle =
        Brep::Circle{.centre = plane_.at(stroke.centre) + down,
                     // Around the scrap, so against the normal; around metal, with it.
                     .axis = stroke.hollow ? Vector3d(-plane_.normal) : plane_.normal,
                     .begins = (plane_.at(stroke.from) - plane_.at(stroke.centre)).normalized(),
                     .radius = stroke.radius};
  return add_edge(std::move(edge));
}

decltype(Brep::Face::surface) PrismWall::surface(const WallStroke& stroke) const {
  if (stroke.radius > 0.0)
    return Brep::Bore{.centre = plane_.at(stroke.centre),
                      .axis = plane_.normal,
                      // Its seam lies opposite to the face.
                      .begins = (plane_.at(stroke.centre) - plane_.at(stroke.middle)).normalized(),
                      .radius = stroke.radius};
  // The metal lies to the left of the line.
  const Vector3d along = (plane_.at(stroke.to) - plane_.at(stroke.from)).normalized();
  return Brep::Plane{plane_.at(stroke.from), along.cross(plane_.normal)};
}

}  // namespace tubecut::api
