#include "core/groove/mill_path.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <chrono>
#include <ostream>

#include "core/groove/periodic_spline.hpp"
#include "tests/core/groove/path_cases.hpp"

namespace tubecut::groove {
namespace {

using namespace testing;

struct PathCase {
  const char* name;
  Hold hold;
  double limit;  // |E| of 8.6, mm
};
void PrintTo(const PathCase& c, std::ostream* out) {
  *out << c.name << (c.hold == Hold::tip ? ", tip held" : ", pivot held");
}

constexpr PathCase kPaths[] = {{"A_source_like", Hold::pivot, 0.0022},
                               {"B_near_equal", Hold::tip, 0.0037},
                               {"C_oblique_offset", Hold::pivot, 0.0145},
                               {"C_oblique_offset", Hold::tip, 0.0145}};

class Paths : public ::testing::TestWithParam<PathCase> {
 protected:
  const MillPathSpec spec = path_case(GetParam().name, GetParam().hold);
};
INSTANTIATE_TEST_SUITE_P(Cases, Paths, ::testing::ValuesIn(kPaths));

/// Exact poses with the increments of `at`, a turn in [0, 1), at equally spaced sections.
template <class IncrementAt>
std::vector<Block> exact_sections(const MillPathSpec& spec, int count, IncrementAt at) {
  const JointGeometry joint = *joint_geometry(spec.groove);
  std::vector<Block> out;
  for (int i = 0; i < count; ++i) {
    const Angle omega = Angle::rad(kTwoPi * i / count);
    const ToolPose start = initial_pose(joint, *section(joint, omega), spec.mill, spec.setup);
    const AxisPosition axes = axis_position(
        moved(start, spec.setup, spec.optimise.hold, at(double(i) / count)), spec.setup, omega);
    out.push_back({omega.rad(), axes.x, axes.z, axes.b.rad()});
  }
  return out;
}

/// The tool at equally spaced sections of the linear motion between emitted blocks.
std::vector<Block> linear_sections(const std::vector<Block>& emitted, int count) {
  std::vector<Block> out;
  std::size_t k = 0;
  for (int i = 0; i < count; ++i) {
    const double omega = kTwoPi * i / count;
    while (k + 1 < emitted.size() && emitted[k + 1].omega <= omega) ++k;
    const double next = k + 1 < emitted.size() ? emitted[k + 1].omega : kTwoPi;
    out.push_back(
        block_at(emitted, double(k) + (omega - emitted[k].omega) / (next - emitted[k].omega)));
  }
  return out;
}

TEST_P(Paths, SweptFlankErrorAsSampledAndWithLinearAxes) {
  const auto path = mill_path(spec);
  ASSERT_TRUE(path);
  const JointGeometry joint = *joint_geometry(spec.groove);
  const Cone cone{spec.mill};
  std::vector<double> dz, db;
  for (const auto& p : path->positions)
    if (p.optimised) {
      dz.push_back(p.by.dz);
      db.push_back(p.by.db);
    }
  ASSERT_EQ(dz.size(), 90U);
  const auto sampled = [&](const std::vector<Block>& blocks) {
    return *swept(joint, cone, spec.setup, blocks, Between::nothing, {});
  };
  // As in 8.5 and 8.6: exact poses at 1440 sections, increments linear between 90 optima, rulings
  // every degree.
  const Swept published = sampled(exact_sections(spec, 1440, [&](double turn) {
    const auto i = std::size_t(90 * turn), j = (i + 1) % 90;
    const double t = 90 * turn - double(i);
    return Increment{dz[i] + t * (dz[j] - dz[i]), db[i] + t * (db[j] - db[i])};
  }));
  EXPECT_GE(published.flank_min.value, -GetParam().limit);
  EXPECT_LE(published.flank_max.value, GetParam().limit);
  // The emitted positions interpolate more smoothly; compares their own exact poses with the
  // interpolation by linear axes.
  const PeriodicSpline smooth_z{dz}, smooth_b{db};
  const Swept exact = sampled(exact_sections(spec, 1440, [&](double turn) {
    return Increment{smooth_z(90 * turn), smooth_b(90 * turn)};
  }));
  EXPECT_GE(exact.flank_min.value, -GetParam().limit);
  EXPECT_LE(exact.flank_max.value, GetParam().limit);
  const auto emitted = emitted_blocks(*path);
  const Swept moving = sampled(linear_sections(emitted, 1440));
  EXPECT_NEAR(moving.flank_min.value, exact.flank_min.value, 1e-3);
  EXPECT_NEAR(moving.flank_max.value, exact.flank_max.value, 1e-3);
  // The continuous motion has no cusps between samples.
  EXPECT_GE(path->swept.flank_min.value, -GetParam().limit);
  EXPECT_LE(path->swept.flank_max.value, GetParam().limit);
  std::printf(
      "%s %s, %zu emitted: linear increments [%.5f %.5f], spline [%.5f %.5f], its linear axes "
      "[%.5f %.5f], continuous [%.5f %.5f], optima alone [%.5f %.5f]; stock %.4f root face %.5f\n",
      GetParam().name, GetParam().hold == Hold::tip ? "tip" : "pivot", emitted.size(),
      published.flank_min.value, published.flank_max.value, exact.flank_min.value,
      exact.flank_max.value, moving.flank_min.value, moving.flank_max.value,
      path->swept.flank_min.value, path->swept.flank_max.value,
      path->swept_at_optima.flank_min.value, path->swept_at_optima.flank_max.value,
      path->swept.stock_left_max.value, path->swept.root_face_min.value);
}

TEST_P(Paths, ProofPasses) {
  const auto path = mill_path(spec);
  ASSERT_TRUE(path);
  const auto clock = [] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
  };
  const double begin = clock();
  const auto checks = verify(spec, *path);
  const double seconds = clock() - begin;
  ASSERT_EQ(checks.size(), 8U);
  for (const Check& check : checks) {
    EXPECT_TRUE(check.passed()) << check.name << ' ' << check.value << " > " << check.limit;
    std::printf("%s %.2e (%.0e)  ", check.name.c_str(), check.value, check.limit);
  }
  std::printf("in %.1f ms\n", 1e3 * seconds);
}

/// The tool as rotation matrices in machine space put it, against points of the groove: no formula
/// of the core but the joint's surface, which the golden sections prove.
class PointTest {
 public:
  explicit PointTest(const MillPathSpec& spec)
      : spec_(spec), joint_(*joint_geometry(spec.groove)) {}

  struct Range {
    double min = 1e9, max = -1e9;
  };

  /// Distances of `rulings` x `levels` points to the nearest of `stations` positions of the linear
  /// motion.
  Range run(const std::vector<Block>& emitted, int rulings, int levels, int stations) const {
    std::vector<Placed> tools;
    for (const Block& block : linear_sections(emitted, stations)) tools.push_back(place(block));
    Range out;
    for (int j = 0; j < rulings; ++j) {
      const double omega = kTwoPi * (j + 0.37) / rulings;  // between the rulings the path looked at
      const Section here = *section(joint_, Angle::rad(omega));
      for (int i = 0; i < levels; ++i) {
        const double v = double(i) / (levels - 1), s = joint_.root_radius + v * joint_.groove_width;
        const Eigen::Vector3d p(-s * std::sin(omega), s * std::cos(omega),
                                here.toe.y1 + v * here.height);
        double least = 1e9;
        const int middle = int(omega / kTwoPi * stations),
                  reach = stations / 24;  // 15 deg either side
        for (int k = middle - reach; k <= middle + reach; ++k)
          least = std::min(least, distance(tools[std::size_t((k + stations) % stations)], p));
        out.min = std::min(out.min, least);
        out.max = std::max(out.max, least);
      }
    }
    return out;
  }

 private:
  struct Placed {
    Eigen::Vector3d apex, axis;  // in the workpiece
  };

  [[nodiscard]] Placed place(const Block& block) const {
    using namespace Eigen;
    const bool up = spec_.setup.mount == Mount::end_up;
    const double c = spec_.setup.c_zero.rad() + (up ? block.omega : -block.omega);
    Matrix3d lying;
    if (up)
      lying << 0, 1, 0, 1, 0, 0, 0, 0, -1;
    else
      lying << 0, 1, 0, -1, 0, 0, 0, 0, 1;
    const Matrix3d back =
        (AngleAxisd(c - spec_.setup.c_zero.rad(), Vector3d::UnitZ()).toRotationMatrix() * lying)
            .transpose();
    const Vector3d axis(std::sin(block.b), 0, std::cos(block.b));
    const Vector3d tip =
        Vector3d(block.x, 0, block.z - spec_.setup.z_zero) - spec_.setup.pivot_length * axis;
    const double to_apex = spec_.mill.tip_radius / std::tan(spec_.mill.half_angle.rad());
    return {back * (tip - to_apex * axis), back * axis};
  }

  [[nodiscard]] double distance(const Placed& tool, const Eigen::Vector3d& p) const {
    const Eigen::Vector3d to = p - tool.apex;
    return to.norm() *
           std::sin(std::acos(to.dot(tool.axis) / to.norm()) - spec_.mill.half_angle.rad());
  }

  const MillPathSpec& spec_;
  JointGeometry joint_;
};

// Slopes over one step had the flank's third derivative in them: 4e-7 mm of a certificate.
TEST(MillPathProof, HoldsForALongToolWithASmallTip) {
  auto spec = path_case("C_oblique_offset", Hold::tip);
  spec.mill = {Angle::deg(10.2392578125), 1.1737453362814352, 1000.0};
  spec.positions = 90;
  spec.optimise.method = Method::annealing;
  spec.optimise.seed = 36;
  const auto path = mill_path(spec);
  ASSERT_TRUE(path);
  for (const Check& check : verify(spec, *path))
    EXPECT_TRUE(check.passed()) << check.name << ' ' << check.value << " > " << check.limit;
}

TEST_P(Paths, DensePointsAgainstTheSweptTool) {
  const auto path = mill_path(spec);
  ASSERT_TRUE(path);
  const PointTest test{spec};
  const auto emitted = emitted_blocks(*path);
  // Its own error is the cusp between stations, which falls with their square, and the error
  // between its points: both are measured by halving, and the sum is at most a fifth of the
  // confirmed figure.
  const int stations = 7200;
  const auto fine = test.run(emitted, 288, 11, stations),
             coarse = test.run(emitted, 288, 11, stations / 2),
             sparse = test.run(emitted, 144, 6, stations / 2);
  const double own = (std::abs(fine.max - coarse.max) + std::abs(fine.min - coarse.min)) / 3.0 +
                     std::abs(coarse.max - sparse.max) + std::abs(coarse.min - sparse.min);
  const double figure = std::max(-path->swept.flank_min.value, path->swept.flank_max.value);
  EXPECT_LE(own, figure / 5.0);
  EXPECT_NEAR(fine.min, path->swept.flank_min.value, own);
  EXPECT_NEAR(fine.max, path->swept.flank_max.value, own);
  std::printf("%s: points [%.6f %.6f], path [%.6f %.6f], own error %.6f mm\n", GetParam().name,
              fine.min, fine.max, path->swept.flank_min.value, path->swept.flank_max.value, own);
}

}  // namespace
}  // namespace tubecut::groove
