#include "core/bevel/swing_rows.hpp"

#include <cmath>

namespace tubecut::bevel {
namespace {

constexpr double kTurn = 0.25;     // of the largest slope, at one row
constexpr double kNarrow = 0.125;  // of K/A: no segment shorter than this is halved

struct Segment {
  double length = 0.0;  // along the smoother's path, mm
  double slope = 0.0;   // of B, rad/mm
  double middle = 0.0;  // phase
  bool divisible = false;
};

std::vector<Segment> segments(const Table& t, bool along_length) {
  const auto& s = along_length ? t.length : t.developed;
  const double period = along_length ? t.length_total : t.developed_total;
  std::vector<Segment> out(s.size());
  for (std::size_t i = 0; i < s.size(); ++i) {
    const auto j = (i + 1) % s.size();
    const double step = t.phi[j] - t.phi[i] + (j == 0 ? kTwoPi : 0.0);
    const double middle = t.phi[i] + 0.5 * step;
    out[i].length = s[j] - s[i] + (j == 0 ? period : 0.0);
    out[i].slope = out[i].length > 0.0 ? (t.b[j] - t.b[i]) / out[i].length : 0.0;
    out[i].middle = middle < kTwoPi ? middle : middle - kTwoPi;
    out[i].divisible = step > 0.0;  // a jump is all at one phase
  }
  return out;
}

}  // namespace

std::vector<double> swing_rows(const TableSpec& spec, const Table& table) {
  const auto* envelope = std::get_if<EnvelopeSmoothing>(&spec.smoothing);
  if (envelope == nullptr || !spec.sampling.tolerance) return {};
  const double slope = envelope->limits.slope;
  const double narrow = kNarrow * slope / envelope->limits.curvature;
  const auto all = segments(table, envelope->along == Along::length);
  std::vector<bool> halve(all.size(), false);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto j = (i + 1) % all.size();
    if (std::abs(all[j].slope - all[i].slope) <= kTurn * slope) continue;
    halve[i] = halve[j] = true;
  }
  std::vector<double> out;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (halve[i] && all[i].divisible && all[i].length > 2.0 * narrow) out.push_back(all[i].middle);
  return out;
}

}  // namespace tubecut::bevel
