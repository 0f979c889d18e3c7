#pragma once

#include <Eigen/Core>
#include <vector>

#include "api/wire/writer.hpp"

namespace tubecut::api {

inline std::vector<double> components(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

/// Members of a frame: its origin, mm, and its axes, which are the rows.
inline void write_place(const Eigen::Vector3d& origin, const Eigen::Matrix3d& rows, Writer& w) {
  w.column("origin_mm", components(origin));
  w.column("x", components(rows.row(0)));
  w.column("y", components(rows.row(1)));
  w.column("z", components(rows.row(2)));
}

}  // namespace tubecut::api
