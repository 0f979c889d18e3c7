#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "core/bevel/section/section_table.hpp"

namespace tubecut::bevel {

/// The finished surface of a section's cut: between two rows each edge runs straight in (s, z), and
/// at each s the wall is straight from edge to edge.
class SectionSurface {
 public:
  SectionSurface(const section::Wall& wall, const TableSpec& spec, const SectionTable& table)
      : wall_(wall), spec_(spec), table_(table) {}

  /// The edges at a share of the way from row i to the next.
  struct Line {
    section::Station at;
    double wall = 0.0;
    double inner = 0.0, outer = 0.0;  // z
    double face = 0.0;                // z at the land's outer edge; without one that of the bore
    double foot = 0.0;  // z where the bevel's line, straight from row to row, meets the bore

    /// tan B of the torch's axis.
    [[nodiscard]] double slope() const { return (outer - foot) / wall; }
  };
  [[nodiscard]] Line line(std::size_t row, double share) const;
  /// At a place s that lies between row `row` and the next.
  [[nodiscard]] Line line_at(std::size_t row, double s) const;
  /// The row before s ([0, girth)), or the last.
  [[nodiscard]] std::size_t row_before(double s) const;
  /// Returns true if the outside and the bore are flat within `reach` (mm) of a place.
  [[nodiscard]] bool flat_around(const section::Station& at, double reach) const;
  /// Returns how far along s (mm) the metal lies that a beam of this width touches.
  [[nodiscard]] double beam_reach(double kerf) const;
  /// At a depth below the outside, mm.
  [[nodiscard]] double z(const Line& line, double depth) const;
  [[nodiscard]] static Eigen::Vector3d place(const Line& line, double depth, double z) {
    const Eigen::Vector2d p = line.at.point - depth * line.at.normal;
    return {p.x(), p.y(), z};
  }
  [[nodiscard]] double width(std::size_t row) const;
  [[nodiscard]] std::size_t next(std::size_t row) const {
    return row + 1 < table_.at.size() ? row + 1 : 0;
  }
  [[nodiscard]] std::size_t rows() const { return table_.at.size(); }
  /// Calls f(row) for every row within `reach` (mm along s) of the gap after `row`, each once.
  template <class F>
  void rows_near(std::size_t row, double reach, F f) const {
    const auto n = rows();
    const auto before = [n](std::size_t i) { return i == 0 ? n - 1 : i - 1; };
    f(row);
    std::size_t left = n - 1, i = before(row);
    for (double passed = 0.0; left > 0 && passed <= reach; i = before(i)) {
      f(i);
      --left;
      passed += width(i);
    }
    i = next(row);
    for (double passed = 0.0; left > 0 && passed <= reach; i = next(i)) {
      f(i);
      --left;
      passed += width(i);
    }
  }
  [[nodiscard]] double land() const { return spec_.root_face; }
  [[nodiscard]] const section::Wall& wall() const { return wall_; }

 private:
  const section::Wall& wall_;
  const TableSpec& spec_;
  const SectionTable& table_;
};

/// How far below the finished line the axis of a round beam must run at a place between rows so
/// that the beam leaves the finished part untouched, mm along z.
/// Source  docs/theory/sections.md, section 5.
[[nodiscard]] double needed_drop(const SectionSurface& surface, std::size_t row, double share,
                                 double kerf);

/// By how much the finished surface enters a solid: the deepest of the places looked at in the gap
/// after a row, ends included.
[[nodiscard]] SectionTable::Deepest deepest_in_gap(const SectionSurface& surface, std::size_t row,
                                                   const std::vector<joint::Solid>& solids);

}  // namespace tubecut::bevel
