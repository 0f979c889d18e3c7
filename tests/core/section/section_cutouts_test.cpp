#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/cutout/rows.hpp"
#include "core/part/section/section_part.hpp"
#include "tests/core/cutout/square_ends.hpp"
#include "tests/core/section/golden_ends.hpp"

/// Cut-outs on the flats of tubes that are not round: an independent program, closed forms, and the
/// same part drawn in another way.
namespace tubecut::testing {
namespace {

using namespace cutout;
using api::Json;
using Random = std::mt19937;

section::Section drawn_section(Random& random) { return testing::drawn_section(random, 200, 2.0); }

/// A part with square ends: z counts from the start.
part::SectionPartSpec plain_part(const section::Section& section, std::vector<Spec> cutouts) {
  part::SectionPartSpec out{.section = section, .length = 1000.0};
  testing::make_ends_square(out);
  out.cutouts.all = std::move(cutouts);
  out.cutouts.kerf = 1.5;
  return out;
}

Shape drawn_shape(Random& random) {
  const double size = between(random, 6.0, 16.0);
  switch (random() % 3) {
    case 0:
      return Circle{size};
    case 1:
      return Slot{size + between(random, 0.0, 4.0), size};
    default:
      return Rectangle{size, between(random, 6.0, 16.0), between(random, 0.8, 3.0)};
  }
}

double area_of(const Shape& shape) {
  if (const auto* c = std::get_if<Circle>(&shape)) return 0.25 * kPi * c->diameter * c->diameter;
  if (const auto* s = std::get_if<Slot>(&shape))
    return 0.25 * kPi * s->width * s->width + s->width * (s->length - s->width);
  const auto& r = std::get<Rectangle>(shape);
  return r.along * r.round - (4.0 - kPi) * r.radius * r.radius;
}

/// One on each of some faces, 100 mm apart.
std::vector<Spec> drawn_cutouts(Random& random, const section::Section& section) {
  std::vector<Spec> out;
  for (int i = 0; i < 4; ++i) {
    Spec one{.id = "c" + std::to_string(i), .shape = drawn_shape(random)};
    one.turn = between(random, -3.0, 3.0);
    one.at.face = static_cast<int>(random() % 4) + 1;
    const double room = section.outer().half_flat(one.at.face) - section.wall - 15.0;
    one.at.offset = room > 0.0 ? between(random, -room, room) : 0.0;
    one.at.z = 100.0 + 150.0 * i;
    one.wall = random() % 2 == 0 ? Wall::normal : Wall::through;
    out.push_back(std::move(one));
  }
  return out;
}

void expect_passed(const std::vector<Check>& checks) {
  for (const auto& check : checks) EXPECT_LE(check.value, check.limit) << check.name;
}

TEST(SectionCutouts, OnAFlatAreThoseOfAnIndependentProgram) {
  const auto all = golden("cutouts.json");
  int made = 0;
  for (const auto& one : *at(all, "cutouts").as<Json::Array>()) {
    if (*at(one, "section/round").as<bool>()) continue;
    const auto section = golden_section(at(one, "section"));
    Spec spec{.id = text(one, "name"), .shape = Circle{20.0}};
    if (text(one, "shape/kind") == "circle") spec.shape = Circle{number(one, "shape/diameter_mm")};
    if (text(one, "shape/kind") == "slot")
      spec.shape = Slot{number(one, "shape/length_mm"), number(one, "shape/width_mm")};
    if (text(one, "shape/kind") == "rectangle")
      spec.shape = Rectangle{number(one, "shape/along_mm"), number(one, "shape/round_mm"),
                             number(one, "shape/corner_radius_mm")};
    spec.turn = number(one, "angle_deg") * kRadPerDeg;
    spec.at.z = number(one, "at/z_mm");
    spec.at.phi = number(one, "at/s_mm") / section.outer().girth() * kTwoPi;
    spec.wall = text(one, "wall") == "through" ? Wall::through : Wall::normal;
    const section::Wall wall(section);
    const auto layout = lay({spec}, {.tube = {.wall = section.wall}, .section = wall});
    ASSERT_TRUE(layout);
    const bool far = text(one, "side") == "far";
    const auto& instance = layout->instances[far ? 1 : 0];
    const auto& mould = layout->mould_of(instance);
    if (mould.laying.over() != nullptr) continue;  // corner_cutouts_test.cpp
    ++made;
    const auto& local = *at(one, "local").as<Json::Array>();
    for (std::size_t i = 0; i < local.size(); ++i)
      for (const bool outer : {true, false}) {
        const auto& curve = outer ? wall.outer() : wall.bore();
        const double b = number(local[i], "1");
        const double s = curve.on_face(instance.face, instance.offset + (far ? -b : b));
        const auto p = curve.at(s).point;
        const auto& wanted = (*at(one, outer ? "outer" : "inner").as<Json::Array>())[i];
        EXPECT_NEAR(p.x(), number(wanted, "0"), 1e-9) << spec.id;
        EXPECT_NEAR(p.y(), number(wanted, "1"), 1e-9) << spec.id;
        EXPECT_NEAR(instance.z + number(local[i], "0"), number(wanted, "2"), 1e-9);
        EXPECT_LT(distance(mould.chain, {number(local[i], "0"), b}), 1e-9);
      }
    EXPECT_NEAR(mould.taken.outer_area / number(one, "area_outer"), 1.0, 1e-9);
    EXPECT_NEAR(mould.taken.inner_area / number(one, "area_inner"), 1.0, 1e-9);
    EXPECT_NEAR(mould.taken.volume / number(one, "volume"), 1.0, 1e-9);
  }
  EXPECT_EQ(made, 2);
}

TEST(SectionCutouts, TheWebRoundACornerIsThatOfAnIndependentProgram) {
  const auto all = golden("cutouts.json");
  int seen = 0;
  for (const auto& one : *at(all, "webs").as<Json::Array>()) {
    if (*at(one, "section/round").as<bool>()) continue;
    ++seen;
    const auto section = golden_section(at(one, "section"));
    std::vector<Spec> specs;
    for (const char* name : {"a", "b"}) {
      Spec spec{.id = name, .shape = Circle{number(at(one, name), "d")}};
      spec.at.z = number(at(one, name), "z");
      spec.at.phi = number(at(one, name), "s") / section.outer().girth() * kTwoPi;
      specs.push_back(spec);
    }
    const auto part = part::section_part(plain_part(section, specs));
    ASSERT_TRUE(part);
    // The bore's corner is shorter.
    EXPECT_NEAR(part->cutout_report.between->width, number(one, "web_inner"), 2e-3);
    EXPECT_LT(number(one, "web_inner"), number(one, "web_outer"));
  }
  EXPECT_EQ(seen, 1);
}

TEST(SectionCutouts, RepeatedOnFacesLieWhereAnIndependentProgramPutsThem) {
  const auto all = golden("cutouts.json");
  int seen = 0;
  for (const auto& one : *at(all, "patterns").as<Json::Array>()) {
    if (text(one, "name") != "per_face") continue;
    ++seen;
    const auto section = golden_section(at(one, "section"));
    Spec spec{.id = "p", .shape = Circle{10.0}};
    spec.at.z = number(one, "at/z_mm");
    spec.at.face = 1;
    spec.at.offset = number(one, "at/offset_mm");
    spec.pattern = Faces{.faces = {1, 2, 4}, .each = Once{}};
    const auto layout =
        lay({spec}, {.tube = {.wall = section.wall}, .section = section::Wall(section)});
    ASSERT_TRUE(layout);
    const auto& anchors = *at(one, "anchors").as<Json::Array>();
    ASSERT_EQ(layout->instances.size(), anchors.size());
    for (std::size_t i = 0; i < anchors.size(); ++i) {
      const auto& made = layout->instances[i];
      EXPECT_EQ(made.name, text(anchors[i], "0"));
      EXPECT_NEAR(made.z, number(anchors[i], "1"), 1e-9);
      EXPECT_NEAR(section.outer().on_face(made.face, made.offset), number(anchors[i], "2"), 1e-9);
    }
  }
  EXPECT_EQ(seen, 1);
}

TEST(SectionCutouts, TakeTheirAreaTimesTheWall) {
  Random random(5);
  for (int i = 0; i < 60; ++i) {
    const auto section = drawn_section(random);
    const auto spec = plain_part(section, drawn_cutouts(random, section));
    const auto made = part::section_part(spec);
    ASSERT_TRUE(made) << made.error().issues.front().hint;
    expect_passed(part::verify(spec, *made));
    double taken = 0.0;
    for (const auto& one : spec.cutouts.all)
      taken += area_of(one.shape) * section.wall * (one.wall == Wall::through ? 2.0 : 1.0);
    const double whole = section::area(section) * spec.length;
    EXPECT_NEAR(made->lengths.volume / (whole - taken), 1.0, 1e-12);
    // The least section, by the strips of one height.
    const auto& net = made->cutout_report.net;
    double removed = 0.0;
    for (const auto& one : made->cutouts.instances) {
      const auto& mould = made->cutouts.mould_of(one);
      for (const auto& [from, to] : stretches(mould.chain, net.z - one.z))
        removed += (to - from) * section.wall;
    }
    EXPECT_NEAR(net.area, section::area(section) - removed, 1e-9);
  }
}

/// A bolt through both walls: the far side lies straight across.
TEST(SectionCutouts, ThroughBothWallsAreStraightAcross) {
  Random random(6);
  for (int i = 0; i < 40; ++i) {
    const auto section = drawn_section(random);
    auto cutouts = drawn_cutouts(random, section);
    for (auto& one : cutouts) one.wall = Wall::through;
    const auto made = part::section_part(plain_part(section, cutouts));
    ASSERT_TRUE(made);
    const auto& all = made->cutouts.instances;
    ASSERT_EQ(all.size(), 8u);
    const auto outer = section.outer();
    for (std::size_t k = 0; k < all.size(); k += 2) {
      const auto near = placed(made->cutouts, all[k]), far = placed(made->cutouts, all[k + 1]);
      const auto across = section::Curve::face_normal(all[k].face);
      ASSERT_EQ(near.phi.size(), far.phi.size());
      for (std::size_t row = 0; row < near.phi.size(); ++row) {
        const auto p = outer.at(near.phi[row] / kTwoPi * outer.girth()).point;
        const auto q = outer.at(far.phi[row] / kTwoPi * outer.girth()).point;
        const double apart = 2.0 * outer.face_distance(all[k].face);
        EXPECT_LT((p - q - apart * across).norm(), 1e-9);
        EXPECT_EQ(near.z[row], far.z[row]);
      }
    }
  }
}

/// A half turn about z: each face has the number of its opposite one.
TEST(SectionCutouts, AHalfTurnExchangesFacesOnly) {
  Random random(7);
  for (int i = 0; i < 20; ++i) {
    const auto section = drawn_section(random);
    auto spec = plain_part(section, drawn_cutouts(random, section));
    const auto one = part::section_part(spec);
    for (auto& cutout : spec.cutouts.all) cutout.at.opposite = true;
    const auto other = part::section_part(spec);
    ASSERT_TRUE(one && other);
    EXPECT_NEAR(one->lengths.volume, other->lengths.volume, 1e-6);
    EXPECT_NEAR(one->cutout_report.to_end->width, other->cutout_report.to_end->width, 1e-9);
    EXPECT_NEAR(one->cutout_report.between->width, other->cutout_report.between->width, 1e-6);
    for (std::size_t k = 0; k < one->cutouts.instances.size(); ++k) {
      EXPECT_EQ((one->cutouts.instances[k].face + 1) % 4 + 1, other->cutouts.instances[k].face);
      EXPECT_EQ(one->cutouts.instances[k].offset, other->cutouts.instances[k].offset);
    }
  }
}

TEST(SectionCutouts, ThatGoOverNoCornerAreRefusedBeyondTheFlatOfOneWall) {
  // EN 10210: the corner of the bore begins further in than that outside.
  const section::Section section{100.0, 60.0, 5.0, 7.5, 5.0};
  const double half = std::min(section.outer().half_flat(1), section.bore().half_flat(1));
  const auto error_of = [&](const Spec& spec) {
    const auto made = part::section_part(plain_part(section, {spec}));
    return made ? Issue{.member = "none"} : made.error().issues.front();
  };
  Spec spec{.id = "a", .shape = Circle{10.0}, .at = {.z = 100.0, .face = 1, .offset = half - 5.0}};
  spec.on_one_flat = true;
  EXPECT_EQ(error_of(spec).member, "none");
  spec.at.offset += 1e-6;
  EXPECT_EQ(error_of(spec).member, "cutouts/0/at/offset");
  spec.shape = Circle{2.0 * half + 0.1};
  EXPECT_EQ(error_of(spec).member, "cutouts/0/shape");
  spec.shape = Circle{10.0};
  spec.at = {.z = 100.0,
             .phi = section.outer().on_corner(1, 0.7) / section.outer().girth() * kTwoPi};
  EXPECT_EQ(error_of(spec).member, "cutouts/0/at/girth");
  spec.at = {.z = 100.0, .face = 2};
  spec.pattern = Linear{.count = 9, .turn = 12.0 / section.outer().girth() * kTwoPi};
  EXPECT_EQ(error_of(spec).member, "cutouts/0/pattern");
  spec.pattern = Faces{.faces = {1, 3}, .each = Once{}};
  EXPECT_EQ(error_of(spec).member, "cutouts/0/pattern/faces");
}

}  // namespace
}  // namespace tubecut::testing
