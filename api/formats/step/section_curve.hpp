#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "api/formats/step/brep.hpp"
#include "core/section/section.hpp"

/// Edges and faces between rows of a section's walls, of its ends and of its cut-outs.
namespace tubecut::api {

/// Returns the angle from one direction to another, the short way.
[[nodiscard]] double turned(const section::Station& from, const section::Station& to);

/// Returns the curve from p to q on a surface of this radius, by the normals at both: a line, or a
/// cubic that is straight in (angle, z).
[[nodiscard]] Brep::Points curve_between(const Eigen::Vector3d& p, const Eigen::Vector3d& q,
                                         const section::Station& from, const section::Station& to,
                                         double radius);
/// Returns a line as a cubic; a cubic as it is.
[[nodiscard]] Brep::Points as_cubic(const Brep::Points& curve);

/// Returns the plane of a polygon, its normal by the right hand; nothing if it is not flat.
[[nodiscard]] std::optional<Brep::Plane> plane_of(const std::vector<Eigen::Vector3d>& corners);

}  // namespace tubecut::api
