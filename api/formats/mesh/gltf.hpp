#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "api/wire/format.hpp"

namespace tubecut::api {

/// A triangle mesh with a colour per vertex. Lengths in mm.
struct Mesh {
  std::string name;
  std::vector<Eigen::Vector3d> positions;
  std::vector<Eigen::Vector3f> colors;  // linear RGB, 0..1, one per position
  std::vector<std::uint32_t> indices;   // three a triangle, counter-clockwise seen from outside
  float opacity = 1.0F;

  /// Reserves memory for this number of positions, because moving many as they grow takes long.
  void reserve(std::size_t count) {
    positions.reserve(count);
    colors.reserve(count);
  }
};

/// Returns glTF 2.0 binary (.glb), one node per mesh, in metres as the format requires; the viewer
/// computes flat normals. Verdict, reasons and warnings are in the asset's extras.
[[nodiscard]] std::string print_gltf(const std::vector<Mesh>& meshes, const Caption& caption);

/// A colour of -1..1: blue (below), grey (0), red (above).
[[nodiscard]] Eigen::Vector3f diverging(double value);

/// A closed band of `rings` rows of `across` points each, row by row, as triangles.
[[nodiscard]] std::vector<std::uint32_t> band_triangles(std::size_t rings, std::size_t across);

}  // namespace tubecut::api
