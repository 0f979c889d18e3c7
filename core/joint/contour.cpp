#include "core/joint/contour.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/stop.hpp"
#include "core/base/try.hpp"
#include "core/joint/cutters/elbow_leg.hpp"

namespace tubecut::joint {
namespace {

constexpr double kNearParallel = 0.08715574274765817;  // sin 5 deg: below it dz grows as 1/sin a
constexpr double kTie = 1e-12;                         // of radius + |z|, rounding of one height

Result<std::vector<PreparedCutter>> prepare_all(std::span<const Cutter> cutters) {
  std::vector<PreparedCutter> out;
  std::vector<Issue> issues;
  for (std::size_t i = 0; i < cutters.size(); ++i) {
    if (stopped()) return fail({.code = ErrorCode::cancelled});
    auto one = under("cutters/" + std::to_string(i), prepare(cutters[i]));
    if (one) {
      out.push_back(*one);
    } else {
      issues.insert(issues.end(), one.error().issues.begin(), one.error().issues.end());
    }
  }
  TRY(no_issues(std::move(issues)));
  return out;
}

/// Rejects an elbow whose leg goes up along the member, because such a leg never ends and cuts the
/// whole member.
Result<void> check_legs(std::span<const PreparedCutter> cutters, double rho) {
  for (std::size_t i = 0; i < cutters.size(); ++i) {
    const auto* elbow = std::get_if<PreparedElbow>(&cutters[i]);
    if (elbow == nullptr) continue;
    if (const auto sine = endless_leg(*elbow, rho))
      return under(
          "cutters/" + std::to_string(i),
          Result<void>(parallel_axes(
              "", *sine,
              "a straight run of the elbow goes along the kept member and would cut it away "
              "without end; let that run point the other way, or pass clear of the member")));
  }
  return {};
}

}  // namespace

Result<Contour> trace(std::span<const Cutter> cutters, double rho) {
  if (cutters.empty()) return fail({.code = ErrorCode::wrong_count, .member = "cutters"});
  Contour out;
  out.radius = rho;
  TRY(out.cutters, prepare_all(cutters));
  TRY(check_legs(out.cutters, rho));
  for (std::size_t i = 0; i < out.cutters.size(); ++i) {
    if (stopped()) return fail({.code = ErrorCode::cancelled});
    if (met(out.cutters[i], rho) == Met::never) out.missed.push_back(i);
    if (sin_inclination(out.cutters[i]) < kNearParallel) out.near_parallel.push_back(i);
  }
  if (out.missed.size() == out.cutters.size())
    return fail({.code = ErrorCode::no_contact,
                 .member = "cutters",
                 .got = 0.0,
                 .limit = 1.0,
                 .hint = "none of " + std::to_string(cutters.size()) +
                         " partners is met on the surface of radius " + brief(rho) + " mm"});
  auto division = divide(out.cutters, rho);
  if (stopped()) return fail({.code = ErrorCode::cancelled});
  if (!division.open.empty())
    return fail(
        {.code = ErrorCode::open_profile,
         .member = "cutters",
         .got = std::move(division.open),
         .limit = "a partner at every phi",
         .unit = "deg",
         .hint = "at these phi nothing is met on the surface of radius " + brief(rho) + " mm"});
  if (division.hidden)
    return fail(
        {.code = ErrorCode::unsupported_combination,
         .member = "cutters/" + std::to_string(division.hidden->cutter),
         .got = division.hidden->phi * kDegPerRad,
         .limit = "an elbow that does not hide itself",
         .unit = "deg",
         .hint = "the elbow's bend hides a lower part of the same elbow from the target here"});
  out.events = std::move(division.events);
  out.segments = std::move(division.segments);
  return out;
}

const Segment& segment_at(const Contour& contour, double phi) {
  const auto next = std::ranges::upper_bound(contour.segments, phi, {}, &Segment::from);
  return next == contour.segments.begin() ? contour.segments.back() : *(next - 1);
}

Contact contact_at(const Contour& contour, double phi) {
  const auto line = generator_at(contour.radius, phi);
  const auto own = segment_at(contour, phi).cutter;
  const Contact held{continued_sheet(contour.cutters[own], line), own};
  const auto best = highest(contour.cutters, line);
  const double tie = kTie * (contour.radius + std::abs(held.z));
  return best && best->z > held.z + tie ? *best : held;
}

}  // namespace tubecut::joint
