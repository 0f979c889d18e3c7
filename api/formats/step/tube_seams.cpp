#include "api/formats/step/tube_seams.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "api/stop.hpp"
#include "core/base/angle.hpp"
#include "core/math/rotation.hpp"

namespace tubecut::api {
namespace {

constexpr int kSeamPhases = 90;  // that a seam may have
constexpr double kClear = 0.02;  // mm, between a seam and the side of a hole

/// A hole's edge on one cylinder: phi from, to.
struct Spread {
  const WallCurve* curve;
  std::size_t side, edge;
  double from, to;
};

std::vector<Spread> spreads(const std::vector<TubeCut>& cuts) {
  std::vector<Spread> out;
  for (const auto& cut : cuts) {
    if (cut.kind != TubeCut::Kind::hole) continue;
    const auto& curve = std::get<WallCurve>(cut.shape);
    for (const std::size_t side : {0U, 1U}) {
      const auto edge = side == 0 ? 0 : curve.edges() - 1;
      Spread one{&curve, side, edge, std::numeric_limits<double>::infinity(),
                 -std::numeric_limits<double>::infinity()};
      for (std::size_t i = 0; i < curve.rows(); ++i) {
        const double phi = curve.at(edge, {i, 0.0}).x();
        one.from = std::min(one.from, phi);
        one.to = std::max(one.to, phi);
      }
      out.push_back(one);
    }
  }
  return out;
}

/// Returns the phases at which an end's cut runs along a generator.
std::vector<double> jumps(const std::vector<TubeCut>& cuts) {
  std::vector<double> out;
  for (const auto& cut : cuts) {
    const auto* curve = std::get_if<WallCurve>(&cut.shape);
    if (curve == nullptr || cut.kind == TubeCut::Kind::hole) continue;
    for (std::size_t i = 0; i + 1 < curve->rows(); ++i) {
      const double phi = curve->at(0, {i, 0.0}).x();
      if (curve->at(0, {i + 1, 0.0}).x() == phi) out.push_back(phi);
    }
  }
  return out;
}

/// From a phase to another, the nearer way round.
double apart(double a, double b) { return std::abs(math::whole_turn(a - b + kPi) - kPi); }

/// Returns the cost of a generator as a seam; infinite if it cannot be one.
double badness(double phi, const std::array<double, 2>& radius, const std::vector<Spread>& holes,
               const std::vector<double>& jumps) {
  double out = 0.0;
  for (const double jump : jumps)
    if (apart(phi, jump) * radius[1] < kClear) return std::numeric_limits<double>::infinity();
  for (const auto& hole : holes) {
    const double margin = kClear / radius[hole.side];
    if (math::whole_turn(phi - hole.from + margin) > hole.to - hole.from + 2.0 * margin) continue;
    const auto met = hole.curve->crossings(hole.edge, phi).size();
    if (met % 2 != 0) return std::numeric_limits<double>::infinity();
    out += static_cast<double>(met);
    for (const double side : {hole.from, hole.to})
      if (apart(phi, side) < margin) out += 100.0;
  }
  return out;
}

}  // namespace

std::array<double, 2> tube_seams(double inner, double outer, const std::vector<TubeCut>& cuts) {
  const auto holes = spreads(cuts);
  const auto along = jumps(cuts);
  std::vector<double> bad;
  const auto phase = [](int i) { return kTwoPi * i / kSeamPhases; };
  for (int i = 0; i < kSeamPhases; ++i) {
    ask();
    bad.push_back(badness(phase(i), {inner, outer}, holes, along));
  }
  double best = std::numeric_limits<double>::infinity();
  int first = 0, second = kSeamPhases / 2;
  for (int i = 0; i < kSeamPhases; ++i)
    for (int j = i + kSeamPhases / 6; j < kSeamPhases && j - i <= kSeamPhases - kSeamPhases / 6;
         ++j) {
      // Prefers halves of one size at equal cost.
      const double here = bad[static_cast<std::size_t>(i)] + bad[static_cast<std::size_t>(j)] +
                          std::abs(j - i - kSeamPhases / 2) / (4.0 * kSeamPhases);
      if (here < best) {
        best = here;
        first = i;
        second = j;
      }
    }
  return {phase(first), phase(second)};
}

}  // namespace tubecut::api
