#include "core/part/section/section_part.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "core/part/member.hpp"
#include "core/part/part.hpp"

/// Both ends of a tube that is not round: closed forms of planes, the round tube as a limit, and
/// the part begun from its other end.
namespace tubecut::part::section_parts {

using Random = std::mt19937;

constexpr double kWithin = 0.05;  // mm, of the exact curve

double between(Random& random, double from, double to) {
  return std::uniform_real_distribution<double>(from, to)(random);
}

section::Section drawn_section(Random& random) {
  const double height = between(random, 30, 200), width = between(random, 30, 200);
  const double wall = between(random, 2.0, 0.08 * std::min(height, width) + 1.0);
  const auto standard = static_cast<section::Standard>(random() % 3);
  const auto radii = section::corner_radii(standard, wall);
  section::Section out{height, width, wall, radii.outer, radii.inner};
  if (random() % 5 == 0) {
    out.corner = 0.5 * std::min(height, width);
    out.inner_corner = out.corner - wall;
  }
  return out;
}

EndSpec end_by(std::vector<joint::Partner> partners) {
  EndSpec out;
  out.cut.partners = std::move(partners);
  out.cut.groove = bevel::SquareCut{};
  out.cut.contact = bevel::Contact::automatic;
  out.cut.smoothing = bevel::NoSmoothing{};
  out.cut.sampling.tolerance = joint::Tolerance{.value = kWithin};
  return out;
}

joint::PlaneCutter drawn_plane(Random& random, double height) {
  return {.point = {0.0, 0.0, height},
          .normal = {between(random, -0.9, 0.9), between(random, -0.9, 0.9), 1.0}};
}

/// The height of a plane over a place of the section.
double over(const joint::PlaneCutter& plane, const Eigen::Vector2d& at) {
  return plane.point.z() - plane.normal.head<2>().dot(at) / plane.normal.z();
}

SectionPartSpec flush_spec(Random& random) {
  SectionPartSpec out{.section = drawn_section(random), .length = between(random, 900, 2000)};
  for (auto* end : {&out.start, &out.finish}) {
    *end = end_by({drawn_plane(random, between(random, -50, 50))});
    end->cut.groove = bevel::NoGroove{};  // the bevel that lies in the plane
    end->cut.contact = bevel::Contact::inner;
  }
  return out;
}

TEST(SectionParts, OfPlanesHaveClosedForms) {
  Random random(7);
  for (int i = 0; i < 100; ++i) {
    const auto spec = flush_spec(random);
    const auto part = section_part(spec);
    ASSERT_TRUE(part) << part.error().issues.front().hint;
    const auto& start = std::get<joint::PlaneCutter>(spec.start.cut.partners.front());
    const auto& finish = std::get<joint::PlaneCutter>(spec.finish.cut.partners.front());
    const auto outer = spec.section.outer();
    const double steep =
        1.0 + std::max(start.normal.head<2>().norm(), finish.normal.head<2>().norm());
    const auto length_at = [&](double s) {
      const Eigen::Vector2d at = outer.at(s).point, other(at.x(), -at.y());
      return spec.length - over(start, at) - over(finish, other);
    };
    for (int face = 1; face <= 4; ++face) {
      const auto& got = part->faces[static_cast<std::size_t>(face - 1)];
      EXPECT_NEAR(got.length, length_at(outer.on_face(face, 0.0)), 2 * steep * kWithin);
      EXPECT_NEAR(got.corner, length_at(outer.on_corner(face, 0.25 * kPi)), 2 * steep * kWithin);
      const Eigen::Vector2d n = section::Curve::face_normal(face), t(-n.y(), n.x());
      const auto& angle = part->start.faces[static_cast<std::size_t>(face - 1)].angle;
      const double flat = 2 * outer.half_flat(face);
      ASSERT_EQ(angle.has_value(), flat > 0);
      if (angle) {
        EXPECT_NEAR(*angle, std::atan(-start.normal.head<2>().dot(t) / start.normal.z()),
                    2 * steep * kWithin / flat);
      }
    }
    // The area times the length on the axis, whatever the tilts.
    const double volume =
        section::area(spec.section) * (spec.length - over(start, {0, 0}) - over(finish, {0, 0}));
    EXPECT_NEAR(part->lengths.volume / volume, 1.0, 2e-4);
    EXPECT_NEAR(part->lengths.mass, part->lengths.volume * 7.85e-6, 1e-9);
  }
}

TEST(SectionParts, AreVerified) {
  Random random(11);
  int cut = 0;
  for (int i = 0; i < 24; ++i) {
    SectionPartSpec spec{.section = drawn_section(random), .length = 1500};
    const double reach = spec.section.outer().reach();
    for (auto* end : {&spec.start, &spec.finish}) {
      *end = end_by({joint::TubeCutter{.radius = reach + between(random, 5, 60),
                                       .inclination = Angle::deg(between(random, 40, 90)),
                                       .clocking = Angle::deg(between(random, 0, 360))}});
      if (random() % 2 == 0)
        end->cut.partners.emplace_back(drawn_plane(random, between(random, 20, 80)));
      end->cut.kerf = random() % 2 == 0 ? 1.0 : 0.0;
    }
    const auto part = section_part(spec);
    ASSERT_TRUE(part) << part.error().issues.front().hint;
    ++cut;
    for (const auto& check : verify(spec, *part))
      EXPECT_LE(check.value, check.limit) << check.name << " of part " << i;
  }
  EXPECT_EQ(cut, 24);
}

/// One mistake in any number of the part is found by its checks.
TEST(SectionParts, SpoiltAreFound) {
  Random random(13);
  const auto spec = flush_spec(random);
  const auto good = section_part(spec);
  ASSERT_TRUE(good);
  const auto found = [&](const SectionPart& bad) {
    const auto checks = verify(spec, bad);
    return std::ranges::any_of(checks, [](const Check& c) { return !(c.value <= c.limit); });
  };
  ASSERT_FALSE(found(*good));
  auto bad = *good;
  bad.lengths.volume += 1.0;
  EXPECT_TRUE(found(bad));
  bad = *good;
  bad.finish.table.z_outer[5] += 1e-6;
  EXPECT_TRUE(found(bad));
  bad = *good;
  bad.finish.table.b[5] = -bad.finish.table.b[5] + 1e-6;
  EXPECT_TRUE(found(bad));
  bad = *good;
  bad.finish.table = shifted(seen_from_start(section::Wall(spec.section), bad.start.own, 5.0), 1.0);
  EXPECT_TRUE(found(bad));
  bad = *good;
  bad.faces[1].length += 1e-6;
  EXPECT_TRUE(found(bad));
}

TEST(SectionParts, OfRoundSectionsAreRoundParts) {
  Random random(17);
  for (int i = 0; i < 30; ++i) {
    const double radius = between(random, 20, 80), wall = between(random, 2, 5);
    SectionPartSpec spec{.section = {2 * radius, 2 * radius, wall, radius, radius - wall},
                         .length = 1000};
    PartSpec round{.target = {radius, wall, 1000.0}};
    for (const bool finish : {false, true}) {
      auto end = end_by({joint::TubeCutter{.radius = radius * between(random, 1.05, 2),
                                           .inclination = Angle::deg(between(random, 40, 90)),
                                           .clocking = Angle::deg(between(random, 0, 360))}});
      end.cut.sampling.tolerance.reset();
      end.cut.sampling.uniform_points = 360;
      end.cut.target = round.target;
      (finish ? spec.finish : spec.start) = end;
      (finish ? round.finish : round.start) = end;
    }
    const auto got = section_part(spec);
    const auto want = part(round);
    ASSERT_TRUE(got && want);
    EXPECT_NEAR(got->lengths.longest, want->lengths.longest, 1e-9);
    EXPECT_NEAR(got->lengths.shortest, want->lengths.shortest, 1e-9);
    EXPECT_NEAR(got->lengths.blank, want->lengths.blank, 1e-9);
    EXPECT_NEAR(got->lengths.volume / want->lengths.volume, 1.0, 1e-12);
    EXPECT_NEAR(got->lengths.weld, want->lengths.weld, 1e-3);
    EXPECT_NEAR(got->clocking, want->clocking, 1e-12);
    EXPECT_NEAR(got->start.groove_volume, want->start.groove_volume,
                1e-3 * want->start.groove_volume + 1e-6);
    for (std::size_t face = 0; face < 4; ++face) {
      const auto quarter = std::to_string(90 * face);
      const auto& all = want->check_dimensions;
      const auto one = std::ranges::find(all, "length_at_" + quarter, &CheckDimension::name);
      ASSERT_NE(one, all.end());
      EXPECT_NEAR(got->faces[face].length, one->value, 1e-9);
    }
  }
}

/// The same part begun from its other end.
TEST(SectionParts, StartAndFinishMayBeExchanged) {
  Random random(19);
  for (int i = 0; i < 30; ++i) {
    const auto spec = flush_spec(random);
    auto other = spec;
    std::swap(other.start, other.finish);
    const auto a = section_part(spec), b = section_part(other);
    ASSERT_TRUE(a && b);
    EXPECT_NEAR(a->lengths.longest, b->lengths.longest, 1e-9);
    EXPECT_NEAR(a->lengths.volume, b->lengths.volume, 1e-6);
    for (const auto& [one, its] : {std::pair{0, 0}, {1, 3}, {2, 2}, {3, 1}})
      EXPECT_NEAR(a->faces[static_cast<std::size_t>(one)].length,
                  b->faces[static_cast<std::size_t>(its)].length, 1e-9);
  }
}

std::vector<std::string> changed_by(const SectionPart& part, Mistake mistake) {
  std::vector<std::string> out;
  for (const auto& d : part.check_dimensions)
    if (std::ranges::find(d.changes_with, mistake) != d.changes_with.end()) out.push_back(d.name);
  return out;
}

/// A mitre that rises with y: faces 2 and 4 differ, faces 1 and 3 do not.
SectionPart mitred(double height, double width) {
  SectionPartSpec spec{.section = {height, width, 4, 8, 4}, .length = 800};
  spec.start = end_by({joint::PlaneCutter{.point = {0, 0, 0}, .normal = {0, -1, 1}}});
  spec.finish = end_by({joint::PlaneCutter{.point = {0, 0, 0}, .normal = {0, 0, 1}}});
  return section_part(spec).value();
}

TEST(SectionParts, DimensionsRevealMistakes) {
  const auto rectangle = mitred(100, 50), square = mitred(60, 60);
  EXPECT_EQ(changed_by(rectangle, Mistake::swapped),
            (std::vector<std::string>{"height", "width", "start_crown_chord"}));
  EXPECT_TRUE(changed_by(square, Mistake::swapped).empty());
  EXPECT_EQ(changed_by(square, Mistake::height),
            (std::vector<std::string>{"height", "girth", "start_long_girth"}));
  EXPECT_TRUE(changed_by(rectangle, Mistake::quarter_turn).empty());
  const auto turned = changed_by(square, Mistake::quarter_turn);
  for (int face = 1; face <= 4; ++face)
    EXPECT_NE(std::ranges::find(turned, "length_on_face_" + std::to_string(face)), turned.end());
  const auto mirrored = changed_by(rectangle, Mistake::mirror);
  EXPECT_NE(std::ranges::find(mirrored, "length_on_face_2"), mirrored.end());
  EXPECT_EQ(std::ranges::find(mirrored, "length_on_face_1"), mirrored.end());
  EXPECT_EQ(changed_by(square, Mistake::corner),
            (std::vector<std::string>{"girth", "start_long_girth"}));
  EXPECT_FALSE(changed_by(square, Mistake::wall).empty());
}

TEST(SectionParts, WhoseCutsMeetAreRefused) {
  SectionPartSpec spec{.section = {60, 60, 4, 8, 4}, .length = 50};
  for (auto* end : {&spec.start, &spec.finish})
    *end = end_by({joint::PlaneCutter{.point = {0, 0, 20}, .normal = {1, 0, 1}}});
  const auto part = section_part(spec);
  ASSERT_FALSE(part);
  EXPECT_EQ(part.error().issues.front().code, ErrorCode::member_consumed);
}

/// The volume of a square-cut length is its area times that, whatever the radii of the corners: a
/// bore that is far from concentric is looked at closely enough, by the answer and by its check.
TEST(SectionParts, SquareLengthsHaveTheSectionsArea) {
  for (const auto& [corner, inner] : {std::pair{10.5, 0.8},
                                      {12.0, 1.0},
                                      {10.5, 3.0},
                                      {8.0, 8.0},
                                      {7.5, 5.0},
                                      {5.6, 0.6},
                                      {20.0, 12.0}})
    for (const bool by_tolerance : {true, false}) {
      SectionPartSpec spec;
      spec.section = {100, 80, 5, corner, inner};
      if (!section::check(spec.section)) continue;
      spec.length = 1000.0;
      bevel::TableSpec cut;
      cut.groove = bevel::SquareCut{};
      cut.contact = bevel::Contact::automatic;
      cut.smoothing = bevel::NoSmoothing{};
      if (by_tolerance)
        cut.sampling.tolerance = joint::Tolerance{.value = 0.05};
      else
        cut.sampling.uniform_points = 72;
      spec.start = square_end(cut, 0.0);
      spec.finish = square_end(cut, 0.0);
      const auto part = section_part(spec);
      ASSERT_TRUE(part);
      EXPECT_NEAR(part->lengths.volume / (1000.0 * section::area(spec.section)), 1.0, 1e-9)
          << corner << " " << inner;
      for (const auto& check : verify(spec, *part))
        EXPECT_LE(check.value, check.limit) << check.name << " " << corner << " " << inner;
    }
}

}  // namespace tubecut::part::section_parts
