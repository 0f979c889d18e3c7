#pragma once

#include "api/wire/columns.hpp"
#include "core/bevel/hole/hole.hpp"
#include "core/bevel/table/table.hpp"
#include "core/cutoff/feed_curve.hpp"
#include "core/groove/groove.hpp"
#include "core/groove/mill_path.hpp"
#include "core/joint/intersection.hpp"

namespace tubecut::api {

// The tables of answers. Who adds a column here has it in JSON, CBOR and CSV.

/// Rows of a bevel table.
[[nodiscard]] Columns bevel_columns(const bevel::TableSpec& spec, const bevel::Table& table);
/// The names of all there are: a table's points come back as a contour. Of a spec: of those its
/// table has.
[[nodiscard]] const std::vector<std::string>& bevel_column_names();
[[nodiscard]] std::vector<std::string> bevel_column_names(const bevel::TableSpec& spec);
/// Points of one wall's profile.
[[nodiscard]] Columns profile_columns(const joint::Profile& profile,
                                      const joint::Sampling& sampling);
/// Points of a hole's edge; the gaps there; points of the branch's end.
[[nodiscard]] Columns hole_columns(const bevel::HoleSpec& spec, const bevel::Hole& hole);
/// Of a cut-out, in the part's frame.
[[nodiscard]] Columns cutout_columns(const bevel::Hole& rows);
[[nodiscard]] Columns fit_up_columns(const bevel::Hole& hole);
[[nodiscard]] Columns branch_columns(const bevel::HoleSpec& spec, const bevel::BranchEnd& end);

/// Sections of a groove; one of its curves, by section.
[[nodiscard]] Columns section_columns(const groove::Groove& groove);
[[nodiscard]] Columns curve_columns(const groove::Groove& groove,
                                    Eigen::Vector3d groove::CurvePoints::*curve);
/// The four curves and their names.
struct NamedCurve {
  std::string_view name;
  Eigen::Vector3d groove::CurvePoints::*points;
};
inline constexpr NamedCurve kCurves[] = {{"c1", &groove::CurvePoints::c1},
                                         {"c2", &groove::CurvePoints::c2},
                                         {"c3", &groove::CurvePoints::c3},
                                         {"c4", &groove::CurvePoints::c4}};
/// Of the fixed bevel that a groove is compared with, by section.
[[nodiscard]] Columns compare_columns(const groove::Comparison& compare);
[[nodiscard]] Columns position_columns(const groove::MillPath& path);

[[nodiscard]] Columns feed_columns(const cutoff::FeedCurve& curve);

}  // namespace tubecut::api
