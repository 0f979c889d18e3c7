#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "api/wire/format.hpp"
#include "core/bevel/section/section_table.hpp"
#include "core/bevel/table/table.hpp"
#include "core/section/section.hpp"

namespace tubecut::api {

/// Facets stay this near to the walls, mm; stated in the files.
inline constexpr double kFacetError = 0.01;

enum class Smoothed { before, after };

/// A kept tube end between its cut and a square far end, as a closed row of rings: each ring the
/// section of the wall at one phi, from the inner edge along the cut to the outer edge, up the
/// outer wall, across the far end. Frame of the table; mm.
struct CutSolid {
  std::vector<std::vector<Eigen::Vector3d>> rings;  // all of one size; the last meets the first
  std::size_t cut_points = 2;                       // of a ring, on the cut
  double far = 0.0;                                 // z of the far end
};

/// z of the far end: half a diameter above the highest point of the cut, before smoothing or after,
/// at most the target's length.
[[nodiscard]] double far_end(const bevel::TableSpec& spec, const bevel::Table& table);

/// `before`: the cut as it would be unsmoothed, on the same root.
[[nodiscard]] CutSolid cut_solid(const bevel::TableSpec& spec, const bevel::Table& table,
                                 Smoothed which);

/// The same of a section: a ring stands on each row, and on arcs so many more that facets stay
/// within kFacetError.
[[nodiscard]] CutSolid cut_solid(const section::Section& section, const bevel::TableSpec& spec,
                                 const bevel::SectionTable& table, Smoothed which);

/// Triangles of the closed surface, counter-clockwise seen from outside, on single-precision points
/// (equal ones merged), because STL has no other.
struct TriangleMesh {
  std::vector<std::array<float, 3>> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};
[[nodiscard]] TriangleMesh closed_mesh(const CutSolid& solid);

/// Return binary STL and glTF of a solid; see `print_cut_stl` and `print_cut_gltf`. `b_shares`: of
/// each ring, B as a fraction of 60 deg.
struct ColouredSolid {
  CutSolid solid;
  std::vector<double> b_shares;
};
[[nodiscard]] std::string print_stl(const CutSolid& solid, const Caption& caption);
[[nodiscard]] std::string print_gltf(const ColouredSolid& before, const ColouredSolid& after,
                                     const Caption& caption);

/// Returns binary STL, mm. The 80 bytes of its header state the unit, the facet error and the job.
[[nodiscard]] std::string print_cut_stl(const bevel::TableSpec& spec, const bevel::Table& table,
                                        const Caption& caption);
/// glTF, nodes `before` and `after`; the cut's surface coloured by B.
[[nodiscard]] std::string print_cut_gltf(const bevel::TableSpec& spec, const bevel::Table& table,
                                         const Caption& caption);

}  // namespace tubecut::api
