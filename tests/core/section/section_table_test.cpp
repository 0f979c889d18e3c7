#include "core/bevel/section/section_table.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/bevel/section/section_rows.hpp"
#include "core/bevel/section/section_surface.hpp"
#include "core/bevel/table/required.hpp"
#include "tests/core/section/golden_ends.hpp"

namespace tubecut::bevel {
namespace {

using testing::golden_column;
using testing::GoldenEnd;

TableSpec spec_of(const std::vector<joint::Partner>& partners) {
  TableSpec out;
  out.partners = partners;
  out.groove = HalfDihedral{};
  out.smoothing = NoSmoothing{};
  out.sampling.tolerance = joint::Tolerance{.value = 0.05};
  return out;
}

bool near_event(const SectionTable& table, double s) {
  for (std::size_t i = 0; i < table.at.size(); ++i)
    if (table.corner[i] && std::abs(table.at[i].s - s) < 1e-6) return true;
  return false;
}

/// The row of a table at s: the nearest.
std::size_t row_at(const SectionTable& table, double s) {
  std::size_t best = 0;
  for (std::size_t i = 0; i < table.at.size(); ++i)
    if (std::abs(table.at[i].s - s) < std::abs(table.at[best].s - s)) best = i;
  return best;
}

void expect_rows(const GoldenEnd& end) {
  auto spec = spec_of(end.partners);
  if (testing::text(*end.json, "root") == "outer") {
    spec.root_surface = RootSurface::outer;
    spec.contact = Contact::none;
  }
  const auto& rows = testing::at(*end.json, "rows");
  const auto s = testing::numbers(rows, "s");
  const auto g = detail::set_up(end.section, spec);
  ASSERT_TRUE(g);
  const auto made = detail::section_rows(*g, s);
  ASSERT_TRUE(made);
  const auto dihedral = golden_column(rows, "dihedral_deg"),
             gamma = golden_column(rows, "gamma_deg"), groove = golden_column(rows, "groove_deg"),
             flush = golden_column(rows, "flush_deg"), rule = golden_column(rows, "b_rule_deg"),
             none = std::vector<double>(s.size(), std::nan(""));
  const bool inside = spec.root_surface == RootSurface::inner;  // golden has these from the bore
  const auto required = inside ? golden_column(rows, "b_required_deg") : none,
             lifted = inside ? golden_column(rows, "lift_square") : none;
  int seen = 0;
  for (const auto& row : made->rows)
    for (std::size_t i = 0; i < s.size(); ++i) {
      if (std::abs(row.at.s - s[i]) > 1e-9 || row.corner) continue;
      ++seen;
      const auto& a = row.point.angles;
      EXPECT_NEAR(a.dihedral * kDegPerRad, dihedral[i], 2e-9) << s[i];
      EXPECT_NEAR(a.groove * kDegPerRad, groove[i], 2e-9) << s[i];
      if (!std::isnan(rule[i]) && std::abs(dihedral[i] - 180.0) > 1e-6) {
        EXPECT_NEAR(a.gamma * kDegPerRad, gamma[i], 2e-9) << s[i];
        EXPECT_NEAR(a.flush * kDegPerRad, flush[i], 2e-9) << s[i];
        EXPECT_NEAR(a.b * kDegPerRad, rule[i], 1e-8) << s[i];
      }
      if (!std::isnan(required[i])) {
        EXPECT_NEAR(row.point.required * kDegPerRad, required[i], 2e-6) << s[i];
      }
      if (!std::isnan(lifted[i])) {
        const auto view = detail::local_view(*g, row.at, row.across.wall);
        EXPECT_NEAR(lift(view.cutters, view.wall, view.inner, 0.0), lifted[i], 2e-9) << s[i];
      }
    }
  EXPECT_GT(seen, 20);
}

TEST(SectionTable, AnglesRequiredBevelAndLiftAreGolden) {
  const auto golden = testing::golden("sections.json");
  for (const auto& end : testing::golden_ends(golden)) {
    if (end.name == "shs_open") continue;
    SCOPED_TRACE(end.name);
    expect_rows(end);
  }
}

TEST(SectionTable, DropOfTheTorchIsGolden) {
  const auto golden = testing::golden("sections.json");
  for (const auto& end : testing::golden_ends(golden)) {
    const auto* torch = testing::at(golden, "torch").find(end.name);
    if (torch == nullptr) continue;
    SCOPED_TRACE(end.name);
    auto spec = spec_of(end.partners);
    spec.sampling.tolerance = joint::Tolerance{.value = 1e-4};
    spec.sampling.uniform_points = 4000;  // golden has the exact surface, outside too
    const auto table = section_table(end.section, spec);
    ASSERT_TRUE(table) << table.error().issues.front().hint;
    const section::Wall wall(end.section);
    const SectionSurface surface(wall, spec, *table);
    const auto s = testing::numbers(*torch, "s"), drop = testing::numbers(*torch, "drop");
    const double kerf = testing::number(*torch, "kerf");
    for (std::size_t i = 0; i < s.size(); ++i) {
      const auto row = surface.row_before(s[i]);
      const double wide = surface.width(row);
      const double share = wide > 0.0 ? (s[i] - table->at[row].s) / wide : 0.0;
      EXPECT_NEAR(needed_drop(surface, row, share, kerf), drop[i], 5e-4) << s[i];
    }
  }
}

TEST(SectionTable, EnvelopeIsGolden) {
  const auto golden = testing::golden("sections.json");
  for (const auto& one : *testing::at(golden, "smoothing").as<api::Json::Array>()) {
    std::vector<joint::Partner> partners;
    for (const auto& partner : *testing::at(one, "partners").as<api::Json::Array>())
      partners.push_back(testing::golden_partner(partner));
    auto spec = spec_of(partners);
    spec.sampling.tolerance.reset();
    spec.sampling.uniform_points = 360;
    spec.smoothing = EnvelopeSmoothing{
        .limits = {5.0 * kRadPerDeg, 1.0 * kRadPerDeg}, .along = Along::developed, .refine = false};
    const auto table = section_table(testing::golden_section(testing::at(one, "section")), spec);
    ASSERT_TRUE(table) << table.error().issues.front().hint;
    const auto b = testing::numbers(one, "b_envelope_deg");
    ASSERT_EQ(table->b.size(), b.size());
    for (std::size_t i = 0; i < b.size(); ++i)
      EXPECT_NEAR(table->b[i] * kDegPerRad, b[i], 1e-6) << i;
  }
}

/// Whatever the groove and the contact, the other proof holds.
TEST(SectionTable, RandomEndsProveThemselves) {
  std::mt19937_64 random(520);
  const auto any = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (int k = 0; k < 24; ++k) {
    section::Section section{.height = any(40, 120), .width = any(40, 120), .wall = any(2, 6)};
    const auto radii = section::corner_radii(
        k % 2 == 0 ? section::Standard::en_10210 : section::Standard::en_10219, section.wall);
    section.corner = radii.outer;
    section.inner_corner = radii.inner;
    std::vector<joint::Partner> partners{joint::TubeCutter{.radius = any(95, 160),
                                                           .inclination = Angle::deg(any(50, 130)),
                                                           .clocking = Angle::deg(any(0, 360)),
                                                           .offset = any(-5, 5),
                                                           .height = 0.0}};
    if (k % 3 == 1)
      partners.emplace_back(joint::PlaneCutter{.point = {0, 0, any(60, 90)},
                                               .normal = {any(-0.5, 0.5), any(-0.5, 0.5), 1.0}});
    auto spec = spec_of(partners);
    spec.torch = {Angle::deg(-80), Angle::deg(80)};
    spec.kerf = k % 2 == 0 ? 1.5 : 0.0;
    if (k % 4 == 0) spec.contact = Contact::automatic;
    if (k % 4 == 2)
      spec.smoothing = EnvelopeSmoothing{.limits = {5.0 * kRadPerDeg, 1.0 * kRadPerDeg}};
    if (k % 4 == 3) {
      spec.contact = Contact::automatic;
      spec.groove = SquareCut{};
      spec.untilted = true;
    }
    const auto table = section_table(section, spec);
    ASSERT_TRUE(table) << k << table.error().issues.front().hint;
    for (const auto& check : verify(section, spec, *table))
      EXPECT_TRUE(check.passed()) << k << " " << check.name << " " << check.value << " > "
                                  << check.limit;
    if (spec.untilted) {
      for (std::size_t i = 0; i < table->at.size(); ++i) {
        EXPECT_EQ(table->b[i], 0.0);
        EXPECT_GE(table->gaps.square.inner[i], -1e-6);
        EXPECT_GE(table->gaps.square.outer[i], -1e-6);
      }
    }
  }
}

/// A bare grid has no rows at the ends of flats, where the need of the beam bends.
TEST(SectionTable, BareGridsProveThemselves) {
  const section::Section tube{
      .height = 100, .width = 100, .wall = 5, .corner = 7.5, .inner_corner = 5};
  joint::RectangularTubeCutter box;
  box.width = box.height = 120.0;
  box.corner = 10.0;
  box.up = {0, 1, 0};
  box.direction = {0.966, 0, -0.258};
  for (const double lean : {118.55, 60.0, 75.0})
    for (const double kerf : {0.2, 0.3, 1.0, 2.0})
      for (const std::size_t points : {84U, 88U, 90U, 91U, 95U, 180U}) {
        auto spec = spec_of({joint::TubeCutter{100, Angle::deg(lean), Angle::deg(180), 0, 0}, box});
        spec.groove = NoGroove{};
        spec.kerf = kerf;
        spec.smoothing = EnvelopeSmoothing{.limits = {2 * kRadPerDeg, 0.5 * kRadPerDeg}};
        spec.sampling = {.uniform_points = points, .tolerance = std::nullopt};
        const auto table = section_table(tube, spec);
        ASSERT_TRUE(table);
        for (const auto& check : verify(tube, spec, *table))
          EXPECT_LE(check.value, check.limit)
              << check.name << " " << lean << " " << kerf << " " << points;
      }
}

/// The groove of one face turns into that of the next inside the corner: at the ends of flats, of
/// the outside and of the bore, neither B nor any angle has a step.
TEST(SectionTable, AnglesAreContinuousAtSeams) {
  constexpr double kBeside = 1e-6;  // mm
  const auto golden = testing::golden("sections.json");
  int seen = 0;
  for (const auto& end : testing::golden_ends(golden)) {
    if (end.name == "shs_open") continue;
    SCOPED_TRACE(end.name);
    const auto spec = spec_of(end.partners);
    const auto g = detail::set_up(end.section, spec);
    ASSERT_TRUE(g);
    auto seams = g->wall.outer().seams();
    for (const double s : g->wall.bore().seams())
      seams.push_back(g->wall.outside_of(g->wall.bore().at(s)));
    std::vector<double> also;
    for (const double s : seams) {
      also.push_back(s - kBeside);
      also.push_back(s + kBeside);
    }
    const auto made = detail::section_rows(*g, also);
    ASSERT_TRUE(made);
    for (const double s : seams) {
      const detail::SectionRow *before = nullptr, *after = nullptr;
      bool corner = false;
      for (const auto& row : made->rows) {
        if (std::abs(row.at.s - (s - kBeside)) < 1e-9) before = &row;
        if (std::abs(row.at.s - (s + kBeside)) < 1e-9) after = &row;
        corner = corner || (row.corner && std::abs(row.at.s - s) < 1e-3);
      }
      if (corner) continue;
      ASSERT_TRUE(before != nullptr && after != nullptr) << s;
      const auto &a = before->point.angles, &b = after->point.angles;
      if (std::max(a.dihedral, b.dihedral) > 179.0 * kRadPerDeg) continue;  // along a silhouette
      ++seen;
      EXPECT_NEAR(a.dihedral, b.dihedral, 1e-5) << s;
      EXPECT_NEAR(a.gamma, b.gamma, 1e-5) << s;
      EXPECT_NEAR(a.b, b.b, 1e-5) << s;
      EXPECT_NEAR(before->across.wall, after->across.wall, 1e-5) << s;
    }
  }
  EXPECT_GT(seen, 100);
}

/// A mitre of 90 deg: flush B is -45, 0, 45, 0 deg on the faces, whatever the corners.
TEST(SectionTable, MitreHasItsAngles) {
  const section::Section square{
      .height = 100, .width = 100, .wall = 5, .corner = 10, .inner_corner = 5};
  auto spec = spec_of({joint::PlaneCutter{.point = {0, 0, 0}, .normal = {1, 0, 1}}});
  spec.groove = NoGroove{};
  const auto table = section_table(square, spec);
  ASSERT_TRUE(table);
  const double want[] = {-45.0, 0.0, 45.0, 0.0};
  for (std::size_t i = 0; i < table->at.size(); ++i)
    if (!table->at[i].on_corner && !near_event(*table, table->at[i].s)) {
      EXPECT_NEAR(table->b[i] * kDegPerRad, want[table->at[i].face - 1], 1e-9);
    }
  EXPECT_NEAR(table->z_outer[row_at(*table, 0.0)], -50.0, 1e-9);
}

/// Of an untilted beam on the flats of a mitre: half its width times the secant of the cut, however
/// long the row before is.
TEST(SectionTable, DropOnAMitresFlatsIsThatOfAPlane) {
  const section::Section section{60, 40, 3, 6, 3};
  for (const double rise : {1.0, 0.4, -1.7})
    for (const double kerf : {0.05, 0.2, 0.3, 0.45, 1.0})
      for (const double tolerance : {0.0025, 0.01, 0.05}) {
        auto spec = spec_of({joint::PlaneCutter{{0, 0, 0}, {-rise, 0, 1}}});
        spec.groove = SquareCut{};
        spec.contact = Contact::automatic;
        spec.untilted = true;
        spec.kerf = kerf;
        spec.sampling = {.uniform_points = 64, .tolerance = joint::Tolerance{.value = tolerance}};
        const auto table = section_table(section, spec);
        ASSERT_TRUE(table);
        for (const auto& check : verify(section, spec, *table))
          EXPECT_LE(check.value, check.limit) << check.name << " " << kerf << " " << tolerance;
        for (std::size_t i = 0; i < table->at.size(); ++i) {
          const auto& at = table->at[i];
          const bool sloped = at.face == 2 || at.face == 4;  // along x
          if (at.on_corner || !sloped || std::abs(at.along) + 0.5 * kerf > 24.0) continue;
          EXPECT_GE(table->z_outer[i] - table->torch_outer[i],
                    0.5 * kerf * std::hypot(1.0, rise) - 1e-9)
              << rise << " " << kerf << " " << tolerance << " " << at.s;
        }
      }
}

/// A row that rounding lays a hair before the datum is the datum's: as a row of its own it had the
/// length of the row before it, and smoothing along the length refused it.
TEST(SectionTable, TheDatumIsOneRow) {
  const section::Section tube{
      .height = 123.9, .width = 120.8, .wall = 4.9, .corner = 9.8, .inner_corner = 4.9};
  for (const double tolerance : {0.03, 0.04, 0.05, 0.06, 0.07, 0.08, 0.1, 0.15})
    for (const double gap : {0.0, 1.0, 2.0}) {
      auto spec = spec_of({joint::TubeCutter{182.7, Angle::deg(82.4), Angle::deg(333), 12.3, 0}});
      spec.sampling.tolerance->value = tolerance;
      spec.groove = NoGroove{};
      spec.kerf = 1.5;
      spec.root_gap = gap;
      spec.smoothing =
          EnvelopeSmoothing{.limits = {.slope = 0.8 * 45 / 19.6 * kRadPerDeg,
                                       .curvature = 0.8 * 300 / (19.6 * 19.6) * kRadPerDeg},
                            .along = Along::length};
      const auto table = section_table(tube, spec);
      ASSERT_TRUE(table) << tolerance << " " << gap;
      for (std::size_t i = 1; i < table->at.size(); ++i)
        EXPECT_GT(table->length[i], table->length[i - 1]) << tolerance << " row " << i;
    }
}

/// Beside an arc the wall of a flat may be thinner than itself by a rounding; its edge on the bore
/// counts for the beam none the less.
TEST(SectionTable, FlatOvalEndsProveThemselves) {
  std::mt19937 random(53);
  const auto drawn = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  int made = 0;
  for (int k = 0; k < 60; ++k) {
    const double height = std::round(10 * drawn(40, 60)) / 10;
    const double wall = std::round(10 * drawn(2, 6)) / 10;
    const section::Section tube{.height = height,
                                .width = std::round(10 * drawn(80, 120)) / 10,
                                .wall = wall,
                                .corner = 0.5 * height,
                                .inner_corner = 0.5 * height - wall};
    auto spec = spec_of({joint::TubeCutter{drawn(100, 160), Angle::deg(drawn(45, 135)),
                                           Angle::deg(drawn(0, 360)), drawn(-10, 10), 0}});
    spec.kerf = 1.5;
    const auto table = section_table(tube, spec);
    if (!table) continue;
    ++made;
    for (const auto& check : verify(tube, spec, *table))
      EXPECT_LE(check.value, check.limit) << check.name << " of " << k;
  }
  EXPECT_GT(made, 40);
}

}  // namespace
}  // namespace tubecut::bevel
