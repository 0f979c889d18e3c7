#include "core/joint/event_phases.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/joint/trig_roots.hpp"
#include "core/math/rotation.hpp"
#include "core/math/search.hpp"

namespace tubecut::joint::detail {
namespace {

constexpr double kSameCurve = 1e-13;  // relative; rounding of two descriptions of one curve
constexpr std::array kBrackets = {1e-9, 1e-7, 1e-5, 1e-4, 1e-3};  // rad
constexpr std::size_t kScanSteps = 1440;
constexpr double kLeap = 0.02;  // relative; a larger difference between scanned phases is checked
constexpr double kJump = 1e-4;  // relative; impossible for a continuous curve within 1e-15 rad
constexpr double kTouching = 1e-6;     // relative; kept without a sign change
constexpr double kHair = 1e-9;         // relative; rounding
constexpr double kSameHeight = 1e-12;  // relative; rounding of a scanned height
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
// A block of the scan is processed whole if few cutters may be on top there, else in parts.
constexpr std::size_t kBlock = 32, kParts = 4, kFew = 3;

bool same_piece(const Sheets& a, const Sheets& b) {
  const double size = std::max(a.size, b.size);
  return (a.mid - b.mid).bound() <= kSameCurve * size &&
         (a.square - b.square).bound() <= kSameCurve * size * size;
}

bool same_curve(const std::vector<Sheets>& a, const std::vector<Sheets>& b) {
  return !a.empty() && std::ranges::equal(a, b, same_piece);
}

/// Finds phases near every solution of mid_i +- sqrt(square_i) = mid_j +- sqrt(square_j). In this
/// form (of (Q_i + Q_j - D^2)^2 - 4 Q_i Q_j) nearly equal curves lose no digits.
RootPhases crossings(const Sheets& a, const Sheets& b) {
  const auto apart = a.mid - b.mid;
  if (!a.curved && !b.curved) return root_phases(apart);
  const auto apart2 = apart * apart;
  if (!b.curved) return root_phases(apart2 - a.square);
  if (!a.curved) return root_phases(apart2 - b.square);
  const auto unlike = a.square - b.square;
  return root_phases(unlike * unlike - 2.0 * (apart2 * (a.square + b.square)) + apart2 * apart2);
}

/// Returns the generator rotated by at most kBrackets' last, by series with an error of 1e-21.
Generator turned_little(const Generator& line, double by) {
  const double square = by * by;
  const double cos = 1.0 - square * (0.5 - square / 24.0);
  const double sin = by * (1.0 - square * (1.0 / 6.0 - square / 120.0));
  return {line.radius, line.cos_phi * cos - line.sin_phi * sin,
          line.sin_phi * cos + line.cos_phi * sin};
}

/// Secant steps with Illinois weights, a bisection every third step: at most 3 * 53 steps.
template <class G>
double close_bracket(const G& g, double a, double ga, double b, double gb) {
  constexpr double kNarrow = 2.3e-16;
  for (int step = 0; step < 160 && std::abs(b - a) > kNarrow * std::max(1.0, std::abs(b)); ++step) {
    double phi = step % 3 == 2 ? a + 0.5 * (b - a) : b - gb * ((b - a) / (gb - ga));
    if (!(phi > std::min(a, b) && phi < std::max(a, b))) phi = a + 0.5 * (b - a);
    const double at = g(phi);
    if (at == 0.0) return phi;
    if ((at < 0.0) != (gb < 0.0)) {
      a = b;
      ga = gb;
    } else {
      ga *= 0.5;
    }
    b = phi;
    gb = at;
  }
  return b;
}

double phase_of(std::size_t k) { return kTwoPi * static_cast<double>(k) / kScanSteps; }

}  // namespace

double phase_distance(double a, double b) {
  const double d = std::abs(a - b);
  return std::min(d, kTwoPi - d);
}

EventPhases::EventPhases(std::span<const PreparedCutter> cutters, double rho)
    : cutters_(cutters), rho_(rho) {
  for (const auto& cutter : cutters)
    sheets_.push_back(stopped() ? std::vector<Sheets>{} : sheets(cutter, rho));
  for (std::size_t i = 0; i < cutters.size() && !stopped(); ++i) {
    met_.push_back(met(cutters[i], rho));
    if (met_[i] != Met::never && !repeats_an_earlier(i)) active_.push_back(i);
  }
  sizes_.resize(cutters.size());
  for (const auto i : active_) {
    if (stopped()) return;
    sizes_[i] = rounding_size(cutters[i], rho);
    add_own(i);
  }
  for (std::size_t a = 0; a < active_.size(); ++a)
    for (std::size_t b = a + 1; b < active_.size() && !stopped(); ++b)
      add_pair(active_[a], active_[b]);
  add_scanned();
  merge();
}

bool EventPhases::repeats_an_earlier(std::size_t i) const {
  return std::ranges::any_of(active_,
                             [&](std::size_t j) { return same_curve(sheets_[j], sheets_[i]); });
}

void EventPhases::add_own(std::size_t i) {
  for (const double phi : silhouettes(cutters_[i], rho_)) phases_.push_back(math::whole_turn(phi));
  for (const double phi : joint::kinks(cutters_[i], rho_)) {
    kinks_.push_back({math::whole_turn(phi), i});
    phases_.push_back(kinks_.back().phi);
  }
}

double EventPhases::apart(std::size_t i, std::size_t j, double phi) const {
  return apart(i, j, generator_at(rho_, phi));
}

double EventPhases::apart(std::size_t i, std::size_t j, const Generator& line) const {
  return continued_sheet(cutters_[i], line) - continued_sheet(cutters_[j], line);
}

void EventPhases::add_pair(std::size_t i, std::size_t j) {
  const double size = std::max(size_of(i), size_of(j));
  for (const auto& a : sheets_[i])
    for (const auto& b : sheets_[j])
      for (const auto& near : crossings(a, b)) {
        const auto line = generator_at(rho_, near.phi);
        if (near.sharp && passed_over(i, j, line)) continue;
        if (const auto phi = polish(i, j, near.phi, line)) {
          phases_.push_back(math::whole_turn(*phi));
        } else if (std::abs(apart(i, j, line)) < kTouching * size) {
          phases_.push_back(math::whole_turn(near.phi));
        }
      }
}

/// Returns true if the two differ here, or lie below a third, by more than the change of any sheet
/// within 1e-6 rad. A sheet mid + sqrt(square) changes by at most the root of the change of its
/// square.
bool EventPhases::passed_over(std::size_t i, std::size_t j, const Generator& line) const {
  constexpr double kFar = 0.01;  // relative
  const double z = continued_sheet(cutters_[i], line);
  const double beside = kFar * std::max(size_of(i), size_of(j));
  if (std::abs(z - continued_sheet(cutters_[j], line)) > beside) return true;
  return std::ranges::any_of(active_, [&](std::size_t k) {
    if (k == i || k == j || scanned(k)) return false;
    const auto above = upper_sheet(cutters_[k], line);
    const double margin = kFar * size_of(k);
    if (!above || !(*above > z + beside + margin)) return false;
    return met_[k] == Met::always || *above > silhouette_height(cutters_[k], line) + margin;
  });
}

/// Returns the height at a phase of the scan, continued beyond the silhouettes.
double EventPhases::scanned_height(std::size_t i, std::size_t k) {
  auto& heights = scans_.try_emplace(i, kScanSteps, kUnknown).first->second;
  double& z = heights[k % kScanSteps];
  if (std::isnan(z)) z = continued_sheet(cutters_[i], generator_at(rho_, phase_of(k % kScanSteps)));
  return z;
}

bool EventPhases::same_height(std::size_t i, std::size_t j, std::size_t k) {
  const double size = std::max(size_of(i), size_of(j));
  return std::abs(scanned_height(i, k) - scanned_height(j, k)) <= kSameHeight * size;
}

/// Crossings without a closed form are searched between the phases of a scan, where the cutter can
/// be on top.
void EventPhases::add_scanned() {
  if (active_.size() < 2) return;
  if (!std::ranges::any_of(active_, [&](std::size_t i) { return scanned(i); })) return;
  for (std::size_t k = 0; k < kScanSteps; k += kBlock) add_cells(k, k + kBlock, active_);
}

/// Processes cells `from` to `to`, in parts if many cutters may be on top.
void EventPhases::add_cells(std::size_t from, std::size_t to, std::vector<std::size_t> cutters) {
  if (stopped()) return;
  cutters = on_top(from, to, cutters);
  if (cutters.size() < 2) return;
  const std::size_t part = (to - from) / kParts;
  if (cutters.size() > kFew && part > 0) {
    for (std::size_t k = from; k < to; k += part) add_cells(k, k + part, cutters);
    return;
  }
  for (std::size_t k = from; k < to; ++k) add_cell(k, cutters);
}

/// Returns the cutters that may hold the profile between the scan phases `from` and `to` + 1. Every
/// generator there is within `off` of the middle one.
std::vector<std::size_t> EventPhases::on_top(std::size_t from, std::size_t to,
                                             const std::vector<std::size_t>& cutters) const {
  const double half = 0.5 * (phase_of(to + 1) - phase_of(from));
  const auto line = generator_at(rho_, phase_of(from) + half);
  const double off = rho_ * half * (1.0 + kHair);
  double least = -kInfinity;
  std::vector<double> most;
  for (const auto i : cutters) {
    const auto heights = heights_near(cutters_[i], line, off);
    most.push_back(heights.most);
    least = std::max(least, heights.least);
  }
  std::vector<std::size_t> out;
  for (std::size_t c = 0; c < cutters.size(); ++c)
    if (most[c] > -kInfinity && most[c] >= least - kHair * size_of(cutters[c]))
      out.push_back(cutters[c]);
  return out;
}

/// Of cutters with equal heights on both sides of a cell, keeps only the first, because bends of
/// one tube share a leg.
std::vector<std::size_t> EventPhases::unlike(std::size_t k,
                                             const std::vector<std::size_t>& cutters) {
  std::vector<std::size_t> out;
  for (const auto j : cutters) {
    const bool like = std::ranges::any_of(
        out, [&](std::size_t i) { return same_height(i, j, k) && same_height(i, j, k + 1); });
    if (!like) out.push_back(j);
  }
  return out;
}

void EventPhases::add_cell(std::size_t k, const std::vector<std::size_t>& cutters) {
  const auto some = unlike(k, cutters);
  for (std::size_t a = 0; a < some.size(); ++a)
    for (std::size_t b = a + 1; b < some.size() && !stopped(); ++b)
      if (scanned(some[a]) || scanned(some[b])) add_in_cell(some[a], some[b], k);
}

/// Finds sign changes of z_i - z_j between neighbouring phases, on both sides of a near miss, and
/// where curves that coincided separate.
void EventPhases::add_in_cell(std::size_t i, std::size_t j, std::size_t k) {
  const auto g = [&](std::size_t at) { return scanned_height(i, at) - scanned_height(j, at); };
  const auto same = [&](std::size_t at) { return same_height(i, j, at); };
  if (same(k) && same(k + kScanSteps - 1)) return add_border(i, j, phase_of(k), phase_of(k + 1));
  if (same(k + 1) && same(k + 2)) return add_border(i, j, phase_of(k + 1), phase_of(k));
  const auto close = [&](double from, double gf, double to, double gt) {
    if ((gf <= 0.0) != (gt <= 0.0))
      phases_.push_back(math::whole_turn(
          close_bracket([&](double phi) { return apart(i, j, phi); }, from, gf, to, gt)));
  };
  close(phase_of(k), g(k), phase_of(k + 1), g(k + 1));
  const double side = g(k + 1) <= 0.0 ? -1.0 : 1.0;
  const bool turns = side * g(k + 1) <= std::min(side * g(k), side * g(k + 2));
  if (!turns || side * g(k) < 0.0 || side * g(k + 2) < 0.0) return;
  const auto nearest = math::golden_maximum([&](double phi) { return -side * apart(i, j, phi); },
                                            phase_of(k), phase_of(k + 2));
  close(phase_of(k), g(k), nearest.at, -side * nearest.value);
  close(nearest.at, -side * nearest.value, phase_of(k + 2), g(k + 2));
}

void EventPhases::add_border(std::size_t i, std::size_t j, double inside, double outside) {
  const double size = std::max(size_of(i), size_of(j));
  const auto same = [&](double share) {
    return std::abs(apart(i, j, inside + share * (outside - inside))) <= kSameHeight * size;
  };
  phases_.push_back(
      math::whole_turn(inside + math::last_true(same, 0.0, 1.0) * (outside - inside)));
}

std::optional<double> EventPhases::hidden_at(std::size_t i) {
  const auto z = [&](std::size_t k) { return scanned_height(i, k); };
  const double size = size_of(i);
  for (std::size_t k = 0; k < kScanSteps; ++k) {
    if (!(std::abs(z(k + 1) - z(k)) > kLeap * size)) continue;
    double from = phase_of(k), to = phase_of(k + 1), zf = z(k), zt = z(k + 1);
    for (int step = 0; step < 45; ++step) {
      const double mid = 0.5 * (from + to);
      const double zm = continued_sheet(cutters_[i], generator_at(rho_, mid));
      const bool left = std::abs(zm - zf) > std::abs(zt - zm);
      (left ? to : from) = mid;
      (left ? zt : zf) = zm;
    }
    const bool met = upper_sheet(cutters_[i], generator_at(rho_, from)) &&
                     upper_sheet(cutters_[i], generator_at(rho_, to));
    if (met && std::abs(zt - zf) > kJump * size) return math::whole_turn(from);
  }
  return std::nullopt;
}

/// Finds the narrowest bracket around `near` in which z_i - z_j changes sign, and closes it.
std::optional<double> EventPhases::polish(std::size_t i, std::size_t j, double near,
                                          const Generator& line) const {
  const auto g = [&](double off) { return apart(i, j, turned_little(line, off)); };
  for (const double reach : kBrackets) {
    const double ga = g(-reach), gb = g(reach);
    if ((ga <= 0.0) != (gb <= 0.0)) return near + close_bracket(g, -reach, ga, reach, gb);
  }
  return std::nullopt;
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
