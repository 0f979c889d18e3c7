#include "core/joint/event_phases.hpp"

#include <algorithm>
#include <array>

#include "core/base/elementary.hpp"
#include "core/joint/trig_roots.hpp"
#include "core/math/search.hpp"

namespace tubecut::joint::detail {
namespace {

constexpr double kSameCurve = 1e-13;  // relative; rounding of two descriptions of one curve
constexpr std::array kBrackets = {1e-9, 1e-7, 1e-5, 1e-4, 1e-3};  // rad
constexpr std::size_t kScan = 1440;
constexpr double kLeap = 0.02;      // relative; a difference between scanned phases worth a look
constexpr double kJump = 1e-4;      // relative; what a continuous curve cannot do within 1e-15 rad
constexpr double kTouching = 1e-6;  // relative; kept without a sign change
constexpr double kHair = 1e-9;      // relative; an offset that is rounding, as in is_tangent

bool same_piece(const Sheets& a, const Sheets& b) {
  const double size = std::max(a.size, b.size);
  return (a.mid - b.mid).bound() <= kSameCurve * size &&
         (a.square - b.square).bound() <= kSameCurve * size * size;
}

bool same_curve(const std::vector<Sheets>& a, const std::vector<Sheets>& b) {
  return !a.empty() && std::ranges::equal(a, b, same_piece);
}

/// Phases near every solution of mid_i +- sqrt(square_i) = mid_j +- sqrt(square_j). In this form
/// (of (Q_i + Q_j - D^2)^2 - 4 Q_i Q_j) nearly equal curves lose no digits.
std::vector<double> crossings(const Sheets& a, const Sheets& b) {
  const auto apart = a.mid - b.mid;
  if (!a.curved && !b.curved) return root_phases(apart);
  const auto apart2 = apart * apart;
  if (!b.curved) return root_phases(apart2 - a.square);
  if (!a.curved) return root_phases(apart2 - b.square);
  const auto unlike = a.square - b.square;
  return root_phases(unlike * unlike - 2.0 * (apart2 * (a.square + b.square)) + apart2 * apart2);
}

double scanned(std::size_t k) { return kTwoPi * static_cast<double>(k) / kScan; }

}  // namespace

double wrapped(double phi) {
  phi -= kTwoPi * std::floor(phi / kTwoPi);
  return phi < kTwoPi ? phi : 0.0;
}

double phase_distance(double a, double b) {
  const double d = std::abs(a - b);
  return std::min(d, kTwoPi - d);
}

EventPhases::EventPhases(std::span<const Prepared> cutters, double rho)
    : cutters_(cutters), rho_(rho) {
  for (const auto& cutter : cutters) sheets_.push_back(sheets(cutter, rho));
  for (std::size_t i = 0; i < cutters.size(); ++i)
    if (!misses(cutters[i], rho) && !repeats_an_earlier(i)) active_.push_back(i);
  for (const auto i : active_) add_own(i);
  for (std::size_t a = 0; a < active_.size(); ++a)
    for (std::size_t b = a + 1; b < active_.size(); ++b) add_pair(active_[a], active_[b]);
  merge();
}

bool EventPhases::repeats_an_earlier(std::size_t i) const {
  return std::ranges::any_of(active_,
                             [&](std::size_t j) { return same_curve(sheets_[j], sheets_[i]); });
}

void EventPhases::add_own(std::size_t i) {
  const auto* tube = std::get_if<PreparedTube>(&cutters_[i]);
  if (tube == nullptr) {
    for (const double phi : silhouettes(cutters_[i], rho_)) phases_.push_back(wrapped(phi));
    return;
  }
  const double beta = elementary::atan2(tube->sin_clocking, tube->cos_clocking);
  for (const double side : {tube->radius, -tube->radius}) {
    const double u = side - tube->offset;  // X = +-r
    if (!(std::abs(u) <= rho_)) continue;
    const double delta = elementary::atan2(std::sqrt((rho_ - u) * (rho_ + u)), u);
    phases_.push_back(wrapped(beta + delta));
    phases_.push_back(wrapped(beta - delta));
  }
  if (!is_tangent(*tube, rho_)) return;
  const double hair = kHair * tube->radius;  // tubes of one radius are tangent on both sides
  if (tube->offset >= -hair) add_kink(beta, i);
  if (tube->offset <= hair) add_kink(beta + kPi, i);
}

void EventPhases::add_kink(double phi, std::size_t i) {
  kinks_.push_back({wrapped(phi), i});
  phases_.push_back(kinks_.back().phi);
}

double EventPhases::apart(std::size_t i, std::size_t j, double phi) const {
  const auto line = generator_at(rho_, phi);
  return continued_sheet(cutters_[i], line) - continued_sheet(cutters_[j], line);
}

void EventPhases::add_pair(std::size_t i, std::size_t j) {
  if (sheets_[i].empty() || sheets_[j].empty()) return add_scanned_pair(i, j);
  const double size = std::max(size_of(i), size_of(j));
  for (const auto& a : sheets_[i])
    for (const auto& b : sheets_[j])
      for (const double near : crossings(a, b)) {
        if (const auto phi = polish(i, j, near)) {
          phases_.push_back(wrapped(*phi));
        } else if (std::abs(apart(i, j, near)) < kTouching * size) {
          phases_.push_back(wrapped(near));
        }
      }
}

double EventPhases::size_of(std::size_t i) const {
  if (const auto* elbow = std::get_if<PreparedElbow>(&cutters_[i]))
    return (elbow->radius + elbow->bend_radius + rho_) / elbow_sine(*elbow);
  return std::ranges::max(sheets_[i], {}, &Sheets::size).size;
}

/// Heights, continued beyond the silhouettes, at the scan's phases and one beyond.
const std::vector<double>& EventPhases::scan(std::size_t i) {
  auto& heights = scans_[i];
  for (std::size_t k = heights.size(); k <= kScan + 1; ++k)
    heights.push_back(continued_sheet(cutters_[i], generator_at(rho_, scanned(k))));
  return heights;
}

/// Sign changes of z_i - z_j between neighbouring phases, and on both sides of a near miss.
void EventPhases::add_scanned_pair(std::size_t i, std::size_t j) {
  const auto& a = scan(i);
  const auto& b = scan(j);
  const auto g = [&](std::size_t k) { return a[k] - b[k]; };
  const auto close = [&](double from, double gf, double to, double gt) {
    if ((gf <= 0.0) != (gt <= 0.0))
      phases_.push_back(wrapped(close_bracket(i, j, from, gf, to, gt)));
  };
  for (std::size_t k = 0; k < kScan; ++k) {
    close(scanned(k), g(k), scanned(k + 1), g(k + 1));
    const double side = g(k + 1) <= 0.0 ? -1.0 : 1.0;
    const bool turns = side * g(k + 1) <= std::min(side * g(k), side * g(k + 2));
    if (!turns || side * g(k) < 0.0 || side * g(k + 2) < 0.0) continue;
    const auto nearest = math::golden_maximum([&](double phi) { return -side * apart(i, j, phi); },
                                              scanned(k), scanned(k + 2));
    close(scanned(k), g(k), nearest.at, -side * nearest.value);
    close(nearest.at, -side * nearest.value, scanned(k + 2), g(k + 2));
  }
}

std::optional<double> EventPhases::hidden_at(std::size_t i) {
  const auto& z = scan(i);
  const double size = size_of(i);
  for (std::size_t k = 0; k < kScan; ++k) {
    if (!(std::abs(z[k + 1] - z[k]) > kLeap * size)) continue;
    double from = scanned(k), to = scanned(k + 1), zf = z[k], zt = z[k + 1];
    for (int step = 0; step < 45; ++step) {
      const double mid = 0.5 * (from + to);
      const double zm = continued_sheet(cutters_[i], generator_at(rho_, mid));
      const bool left = std::abs(zm - zf) > std::abs(zt - zm);
      (left ? to : from) = mid;
      (left ? zt : zf) = zm;
    }
    const bool met = upper_sheet(cutters_[i], generator_at(rho_, from)) &&
                     upper_sheet(cutters_[i], generator_at(rho_, to));
    if (met && std::abs(zt - zf) > kJump * size) return wrapped(from);
  }
  return std::nullopt;
}

/// The narrowest bracket around `near` in which z_i - z_j changes sign, closed.
std::optional<double> EventPhases::polish(std::size_t i, std::size_t j, double near) const {
  for (const double reach : kBrackets) {
    const double ga = apart(i, j, near - reach);
    const double gb = apart(i, j, near + reach);
    if ((ga <= 0.0) != (gb <= 0.0)) return close_bracket(i, j, near - reach, ga, near + reach, gb);
  }
  return std::nullopt;
}

/// Secant steps with Illinois weights, a halving every third step: at most 3 * 53 steps.
double EventPhases::close_bracket(std::size_t i, std::size_t j, double a, double ga, double b,
                                  double gb) const {
  for (int step = 0; step < 160 && std::abs(b - a) > 2.3e-16 * std::max(1.0, std::abs(b)); ++step) {
    double phi = step % 3 == 2 ? a + 0.5 * (b - a) : b - gb * ((b - a) / (gb - ga));
    if (!(phi > std::min(a, b) && phi < std::max(a, b))) phi = a + 0.5 * (b - a);
    const double g = apart(i, j, phi);
    if (g == 0.0) return phi;
    if ((g < 0.0) != (gb < 0.0)) {
      a = b;
      ga = gb;
    } else {
      ga *= 0.5;
    }
    b = phi;
    gb = g;
  }
  return b;
}

void EventPhases::merge() {
  std::ranges::sort(phases_);
  std::vector<double> kept;
  for (const double phi : phases_)
    if (kept.empty() ||
        (phi - kept.back() > kSamePhase && phase_distance(phi, kept.front()) > kSamePhase))
      kept.push_back(phi);
  phases_ = std::move(kept);
}

}  // namespace tubecut::joint::detail
