#include <gtest/gtest.h>

#include "tests/core/groove/path_cases.hpp"

namespace tubecut::groove {
namespace {

using namespace testing;

MillPathSpec random_path(RandomJoints& random, int i) {
  MillPathSpec out;
  out.groove = random.next();
  if (i % 3 == 0) out.groove.area_in = AreaIn::normal;
  const double branch = 0.5 * out.groove.branch.outer_diameter;
  const auto shape = groove(out.groove);
  const double rise = shape ? shape->height_max : branch;
  out.mill = {Angle::deg(random.uniform(0, 30)), random.uniform(0.05, 0.3) * branch,
              random.uniform(1, 2) * std::hypot(branch, rise)};
  out.setup.mount = i % 2 == 0 ? Mount::end_up : Mount::end_down;
  out.setup.pivot_length = random.uniform(0, 300);
  out.setup.direction = i % 7 == 0 ? -1 : 1;
  out.setup.overrun = i % 5 == 0 ? 1.0 : 0.0;
  out.optimise.hold = i % 4 == 0 ? Hold::pivot : Hold::tip;
  out.optimise.bias = i % 3 == 1 ? Bias::no_overcut : Bias::centred;
  out.positions = int(random.uniform(4, 24));
  out.check.points = int(random.uniform(3, 16));
  return out;
}

TEST(RandomPaths, AreProvenOrRefused) {
  RandomJoints random{99};
  int proven = 0;
  for (int i = 0; i < 14; ++i) {
    const MillPathSpec spec = random_path(random, i);
    const auto path = mill_path(spec);
    if (!path) {
      EXPECT_NE(path.error().code(), ErrorCode::not_converged) << i;
      EXPECT_NE(path.error().code(), ErrorCode::contact) << i;
      continue;
    }
    ++proven;
    for (const Check& check : verify(spec, *path))
      EXPECT_TRUE(check.passed()) << i << ' ' << check.name << ' ' << check.value << " > "
                                  << check.limit;
  }
  EXPECT_GE(proven, 10);
}

}  // namespace
}  // namespace tubecut::groove
