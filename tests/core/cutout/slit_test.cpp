#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/base/stop.hpp"
#include "core/cutout/cutout.hpp"
#include "core/math/cylinder.hpp"
#include "core/part/part.hpp"
#include "core/part/section/section_part.hpp"
#include "core/torch/torch_program.hpp"
#include "tests/core/cutout/square_ends.hpp"

/// Slits: what one pass of the beam takes, and the torch's way along it.
namespace tubecut::testing {
namespace {

using namespace cutout;

Spec slit_of(double length, double kerf, double turn = 0.0) {
  Spec out{.id = "s", .shape = Slit{.length = length, .width = kerf}};
  out.turn = turn;
  out.at = {.z = 200.0, .phi = 0.7};
  return out;
}

const joint::Target kSlitTube{.outer_radius = 30.15, .wall = 4.0, .length = 400.0};

TEST(Slit, OnAFlatTakesALineGrownByHalfTheBeam) {
  const section::Section tube{100, 60, 5, 10, 5};
  for (const double turn : {0.0, 0.5, 2.4}) {
    auto spec = slit_of(24.0, 1.5, turn);
    spec.at.face = 1;
    const Ground ground{
        .tube = {.outer_radius = 50, .wall = 5}, .section = section::Wall(tube), .kerf = 1.5};
    const auto layout = lay({spec}, ground).value();
    EXPECT_NEAR(layout.moulds[0].taken.outer_area, 24.0 * 1.5 + 0.25 * kPi * 1.5 * 1.5, 1e-9);
    EXPECT_NEAR(layout.moulds[0].taken.volume, 5.0 * layout.moulds[0].taken.outer_area, 1e-9);
    for (const auto& check : verify(layout, ground)) EXPECT_LE(check.value, check.limit);
  }
}

/// Along a tube all walls of a slit are the straight one: a slot as long as the line and the kerf.
TEST(Slit, AlongATubeIsTheStraightSlotOfItsSize) {
  Spec slot = slit_of(30.0, 1.2);
  slot.shape = Slot{31.2, 1.2};
  slot.tilt = bevel::Tilt::free;
  const Ground ground{.tube = kSlitTube, .kerf = 1.2};
  const auto wanted = lay({slot}, {.tube = kSlitTube, .kerf = 1.0}).value();
  for (const auto wall : {Wall::normal, Wall::through, Wall::developed})
    for (const auto tilt : {bevel::Tilt::axial, bevel::Tilt::free, bevel::Tilt::none}) {
      auto spec = slit_of(30.0, 1.2, wall == Wall::normal ? kPi : 0.0);
      spec.wall = wall;
      spec.tilt = tilt;
      const auto made = lay({spec}, ground).value();
      EXPECT_EQ(made.instances.size(), wall == Wall::through ? 2u : 1u);
      EXPECT_NEAR(made.moulds[0].taken.volume, wanted.moulds[0].taken.volume, 1e-9);
      for (const double a : made.moulds[0].rows.a) EXPECT_NEAR(a, 0.0, 1e-12);
      for (const auto& check : verify(made, ground)) EXPECT_LE(check.value, check.limit);
    }
}

/// Every place of the edge is half a kerf from the torch's axis in space, which keeps the anchor's
/// direction.
TEST(Slit, ItsEdgeIsHalfABeamFromTheTorch) {
  std::mt19937 random(3);
  for (int i = 0; i < 30; ++i) {
    const double kerf = 0.3 + 0.1 * static_cast<double>(random() % 12);
    auto spec = slit_of(5.0 + static_cast<double>(random() % 30), kerf,
                        0.1 * static_cast<double>(random() % 60));
    spec.tilt = bevel::Tilt::free;
    spec.wall = Wall::through;
    const Ground ground{.tube = kSlitTube, .kerf = kerf};
    const auto layout = lay({spec}, ground).value();
    for (const auto& check : verify(layout, ground))
      EXPECT_LE(check.value, check.limit) << check.name;
    for (const auto& mould : layout.moulds) {
      const auto& r = mould.rows;
      for (std::size_t k = 0; k < r.phi.size(); ++k)
        for (const bool outer : {true, false}) {
          const double rho = outer ? kSlitTube.outer_radius : kSlitTube.inner_radius();
          const auto edge = math::cylinder_point(rho, outer ? r.phi[k] : r.phi_inner[k], r.z[k]);
          const auto axis = math::cylinder_point(rho, outer ? r.torch_phi[k] : r.torch_phi_inner[k],
                                                 r.torch_z[k]);
          EXPECT_NEAR((edge - axis).tail<2>().norm(), 0.5 * kerf, 1e-9);
        }
    }
  }
}

TEST(Slit, IsRefusedAtItsOwnFields) {
  const auto refused = [](const Spec& spec, double kerf = 1.5) {
    const auto made = lay({spec}, {.tube = kSlitTube, .kerf = kerf});
    return made ? std::string("made") : made.error().issues.front().member;
  };
  EXPECT_EQ(refused(slit_of(20.0, 0.0), 0.0), "cutouts/0/shape");
  EXPECT_EQ(refused(slit_of(20.0, 1.5, 0.3)), "cutouts/0/shape/angle");
  auto leaning = slit_of(20.0, 1.5, 0.3);
  leaning.tilt = bevel::Tilt::free;
  EXPECT_EQ(refused(leaning), "made");
  leaning.wall = Wall::developed;
  EXPECT_EQ(refused(leaning), "cutouts/0/shape/angle");
}

/// From its pierce the torch goes over the whole line, without leads, and ends there.
TEST(Slit, TheTorchGoesFromItsPierceToAnEnd) {
  for (const auto pierce : {Slit::Pierce::middle, Slit::Pierce::end}) {
    part::PartSpec spec{.target = kSlitTube};
    testing::make_ends_square(spec);
    spec.start.cut.target = spec.finish.cut.target = spec.target;
    spec.cutouts.all = {slit_of(20.0, 1.5)};
    std::get<Slit>(spec.cutouts.all[0].shape).pierce = pierce;
    spec.cutouts.kerf = 1.5;
    const auto made = part::part(spec).value();
    for (const auto& check : part::verify(spec, made))
      EXPECT_LE(check.value, check.limit) << check.name;
    const auto cuts = torch::torch_cuts(spec, made);
    torch::Setup setup;
    setup.lead = motion::Lead{};
    const auto program = torch::program_cut(cuts[0], setup, false).value();
    ASSERT_EQ(program.size(), 1u);
    const auto& points = program[0].way.points.points;
    EXPECT_NEAR(points.front().z, pierce == Slit::Pierce::middle ? 200.0 : 190.0, 1e-9);
    EXPECT_NEAR(points.back().z, 210.0, 1e-9);
    double least = 1e9;
    for (const auto& p : points) {
      least = std::min(least, p.z);
      EXPECT_NEAR(p.phi, 0.7, 1e-12);
    }
    EXPECT_NEAR(least, 190.0, 1e-9);
  }
}

/// A wrong refusal of what the part was cut by made a 500 of an answer that was over its budget.
TEST(Slit, RowsOfAStoppedJobAreCancelled) {
  const Ground ground{.tube = kSlitTube, .section = {}, .kerf = 1.5};
  auto round = slit_of(24.0, 1.5);
  round.shape = Circle{.diameter = 20.0};
  for (const auto& spec : {slit_of(24.0, 1.5), round}) {
    const auto layout = lay({spec}, ground).value();
    const auto& mould = layout.moulds[0];
    ASSERT_TRUE(rows(mould, {.kerf = 1.5, .tolerance = 0.01}));
    std::stop_source job;
    const StopScope scope(job.get_token());
    job.request_stop();
    const auto stopped_rows = rows(mould, {.kerf = 1.5, .tolerance = 0.01});
    ASSERT_FALSE(stopped_rows);
    EXPECT_EQ(stopped_rows.error().issues.front().code, ErrorCode::cancelled);
  }
}

}  // namespace
}  // namespace tubecut::testing
