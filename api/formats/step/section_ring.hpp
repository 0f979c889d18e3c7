#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/bevel/section/section_surface.hpp"

/// For section_solid only.
namespace tubecut::api {

/// Lengths and heights so near are one, mm.
inline constexpr double kSamePlace = 1e-9;

/// One row across the wall, from the outside in: two places, or three with a land.
struct Across {
  double s = 0.0;
  std::vector<Eigen::Vector3d> points;
  std::vector<section::Station> stations;  // of the outside and the bore
};

/// The rows of one end, with the ends of all flats among them, and arcs divided into pieces of at
/// most 0.2 rad; a row that is in line with its neighbours on a flat is left out.
class SectionRing {
 public:
  /// `seams`: s of the ends of flats, of the outside and the bore, ascending.
  SectionRing(const section::Wall& wall, const bevel::TableSpec& spec,
              const bevel::SectionTable& table, const std::vector<double>& seams);

  [[nodiscard]] const std::vector<Across>& rows() const { return rows_; }
  [[nodiscard]] std::size_t next(std::size_t i) const { return i + 1 < rows_.size() ? i + 1 : 0; }
  /// Returns true if the cut is one plane square to the axis.
  [[nodiscard]] bool square() const;

 private:
  [[nodiscard]] Across between(double s) const;
  [[nodiscard]] Across across(const bevel::SectionSurface::Line& line) const;
  void leave_out_rows_again();
  void divide_arcs(double girth);
  void leave_out_rows_in_line(const std::vector<double>& seams);

  const section::Wall& wall_;
  bevel::SectionSurface surface_;
  double land_;
  std::vector<Across> rows_;
};

}  // namespace tubecut::api
