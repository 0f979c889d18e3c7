#include "tests/core/motion/random_jobs.hpp"

#include <algorithm>
#include <cmath>

namespace tubecut::motion::testing {
namespace {

/// Harmonics that fall off with the square of their order, as those of a real joint do.
void add_waves(Dice& dice, const std::vector<double>& phi, double size, std::vector<double>& out) {
  const int waves = 1 + dice.below(3);
  for (int w = 0; w < waves; ++w) {
    const int order = 1 + dice.below(4);
    const double amplitude = dice.uniform(0.1, 1.0) * size / (order * order);
    const double shift = dice.uniform(0.0, kTwoPi);
    for (std::size_t i = 0; i < phi.size(); ++i)
      out[i] += amplitude * std::cos(order * phi[i] + shift);
  }
}

/// Something over a stretch of points: a step there and back.
void add_step(Dice& dice, double height, std::vector<double>& out) {
  const int n = static_cast<int>(out.size());
  const int from = 1 + dice.below(n - 2);
  const int to = std::min(n - 1, from + 1 + dice.below(n / 3));
  for (int i = from; i < to; ++i) out[static_cast<std::size_t>(i)] += height;
}

void add_square_wave(Dice& dice, double height, std::vector<double>& out) {
  const std::size_t half = 2 + static_cast<std::size_t>(dice.below(12));
  const std::size_t stretch = out.size() / 2;
  for (std::size_t i = 1; i < stretch; ++i) out[i] += (i / half) % 2 == 0 ? 0.0 : height;
}

void add_kinks(Dice& dice, const std::vector<double>& phi, double height,
               std::vector<double>& out) {
  const double shift = dice.uniform(0.0, kPi);
  const int order = 1 + dice.below(3);
  for (std::size_t i = 0; i < phi.size(); ++i) {
    out[i] += height * std::abs(std::sin(order * phi[i] + shift));
  }
}

void spoil(Dice& dice, double radius, CutPath& c) {
  const int kind = dice.below(6);
  const auto jump = [&] { return dice.uniform(-50.0, 50.0) * kRadPerDeg; };
  if (kind == 1 || kind == 5) {
    for (int i = dice.below(4); i >= 0; --i) add_step(dice, jump(), c.b);
  }
  if (kind == 2 || kind == 5) add_step(dice, dice.uniform(-0.5, 0.5) * radius, c.z);
  if (kind == 3 || kind == 5) add_kinks(dice, c.phi, dice.uniform(0.1, 0.6) * radius, c.z);
  if (kind == 4) add_square_wave(dice, 0.5 * jump(), c.b);
  for (double& b : c.b) b = std::clamp(b, -75.0 * kRadPerDeg, 75.0 * kRadPerDeg);
}

CutPath random_contour(Dice& dice) {
  CutPath c;
  c.outer_radius = dice.log_uniform(20.0, 100.0);
  c.wall = dice.below(2) == 0 ? 0.0 : dice.uniform(0.05, 0.2) * c.outer_radius;
  c.surface = dice.below(2) == 0 ? Surface::outer : Surface::inner;
  const int n = 40 + dice.below(461);
  for (int i = 0; i < n; ++i) c.phi.push_back(kTwoPi * i / n);
  c.z.assign(c.phi.size(), 0.0);
  c.b.assign(c.phi.size(), 0.0);
  add_waves(dice, c.phi, 0.8 * c.outer_radius, c.z);
  add_waves(dice, c.phi, 40.0 * kRadPerDeg, c.b);
  spoil(dice, c.outer_radius, c);
  return c;
}

Machine random_machine(Dice& dice) {
  static const std::vector<CatalogueEntry> built_in = catalogue();
  const int kind = dice.below(8);
  Machine m = built_in[kind == 0 ? 1 : kind == 1 ? 3 : 0].machine;
  m.b_positive =
      dice.below(2) == 0 ? BPositive::outer_edge_into_part : BPositive::outer_edge_to_waste;
  m.period = dice.log_uniform(0.0002, 0.010);
  if (auto* const five = std::get_if<FiveAxisCutter>(&m.kinematics)) {
    five->pivot_length = dice.below(4) == 0 ? 0.0 : dice.uniform(0.0, 300.0);
    if (dice.below(4) == 0) five->z2_share = dice.uniform(0.0, 1.0);
  }
  if (auto* const crawler = std::get_if<Crawler>(&m.kinematics)) {
    crawler->pivot_length = dice.uniform(0.0, 40.0);
    if (dice.below(2) == 0) crawler->swing_center = SwingCenter::pivot;
  }
  for (Axis& axis : m.axes) {
    axis.v_max *= dice.log_uniform(0.1, 5.0);
    axis.a_max *= dice.log_uniform(0.1, 5.0);
    *axis.j_max *= dice.log_uniform(0.1, 5.0);
    axis.n_max = static_cast<std::int64_t>(std::ceil(dice.log_uniform(50.0, 2000.0)));
    axis.soft_min.reset();
    axis.soft_max.reset();
  }
  return m;
}

double length(const CutPath& c) {
  double sum = 0.0;
  for (std::size_t i = 1; i < c.phi.size(); ++i) {
    sum += std::hypot(c.outer_radius * (c.phi[i] - c.phi[i - 1]), c.z[i] - c.z[i - 1]);
  }
  return sum;
}

}  // namespace

double Dice::log_uniform(double low, double high) {
  return low * std::exp(uniform(0.0, 1.0) * std::log(high / low));
}

ScheduleSpec random_job(std::uint64_t seed) {
  Dice dice(seed);
  ScheduleSpec spec;
  const CutPath contour = random_contour(dice);
  spec.machine = random_machine(dice);
  // Cutting speeds, but no more than some ten thousand periods of the shortest.
  const double least = length(contour) / (60000.0 * spec.machine.period);
  spec.motion.speed = std::max(dice.log_uniform(2.0, 25.0), least);
  spec.motion.speed_on = dice.below(2) == 0 ? Surface::outer : Surface::inner;
  spec.motion.eps_tip = dice.log_uniform(0.05, 0.3);
  spec.motion.eps_b = Angle::deg(dice.log_uniform(0.2, 1.0));
  spec.cut = contour;
  return spec;
}

}  // namespace tubecut::motion::testing
