#include <cmath>
#include <random>
#include <utility>

#include "core/base/try.hpp"
#include "core/groove/mill_parts.hpp"

namespace tubecut::groove {
namespace {

ContactLine line_of(const Gap& gap) {
  ContactLine out;
  for (const Contact& contact : gap.contacts) {
    out.gap.push_back(contact.gap);
    out.offset.push_back(contact.delta);
  }
  out.over = gap.over;
  out.under = gap.under;
  out.largest = gap.largest;
  return out;
}

/// Returns a generator for one position, so that the order and number of positions do not matter.
std::mt19937_64 generator(std::uint64_t seed, int index) {
  return std::mt19937_64{seed * 0x9E3779B97F4A7C15ULL + std::uint64_t(index)};
}

tl::expected<Optimum, ErrorCode> improve(const Shop& shop, const Task& task, Gap initial,
                                         int index) {
  const Optimise& how = shop.spec.optimise;
  if (how.method == Method::chebyshev) return chebyshev(task, how.bias, std::move(initial));
  if (how.method == Method::none) return certified(task, {}, 0.0, 1, std::move(initial));
  auto random = generator(how.seed, index);
  return annealing(task, random);
}

PeriodicSpline spline_of(const std::vector<MillPosition>& optima, double Increment::*part) {
  std::vector<double> values;
  for (const MillPosition& p : optima) values.push_back(p.by.*part);
  return PeriodicSpline{std::move(values)};
}

std::vector<Increment> increments_of(const std::vector<MillPosition>& optima) {
  std::vector<Increment> out;
  for (const MillPosition& p : optima) out.push_back(p.by);
  return out;
}

const char* blamed(ErrorCode code) {
  switch (code) {
    case ErrorCode::window:
      return "check/window";
    case ErrorCode::contact:
      return "check/pitch";
    case ErrorCode::z_ineffective:
      return "setup/mount";
    case ErrorCode::no_p2:
    case ErrorCode::p2_ambiguous:
      return "groove/branch/wall";
    default:
      return "";
  }
}

}  // namespace

double nearest_turn(double angle, double to) {
  return angle - kTwoPi * std::floor((angle - to) / kTwoPi + 0.5);
}

tl::expected<MillPosition, ErrorCode> position(const Shop& shop, double station,
                                               std::optional<Increment> given) {
  const MillPathSpec& spec = shop.spec;
  const Angle omega = Angle::rad(shop.omega(station));
  TRY(const auto here, section(shop.joint, omega));
  TRY(const auto near, neighbourhood(shop.joint, omega, spec.check));
  const Task task{near, shop.cone, spec.setup,
                  initial_pose(shop.joint, here, spec.mill, spec.setup), spec.optimise.hold};
  TRY(auto initial, gap(near, shop.cone, task.start));
  MillPosition out;
  out.omega = omega;
  out.before = line_of(initial);
  out.grid_before = grid_figures(near, shop.cone, task.start);
  out.optimised = !given;
  Optimum best;
  if (given) {
    TRY(auto seen, gap(near, shop.cone, moved(task.start, spec.setup, task.hold, *given)));
    best = certified(task, *given, 0.0, 0, std::move(seen));
  } else {
    TRY(best, improve(shop, task, std::move(initial), int(station)));
  }
  const ToolPose pose = moved(task.start, spec.setup, task.hold, best.by);
  out.at = axis_position(pose, spec.setup, omega);
  out.by = best.by;
  out.after = line_of(best.gap);
  out.grid = grid_figures(near, shop.cone, pose);
  out.certificate = best.certificate;
  out.bias = best.bias;
  out.reference = best.reference;
  out.evaluations = best.evaluations;
  out.qualified = best.gap.qualified(spec.check.qualify);
  return out;
}

Increments::Increments(const std::vector<MillPosition>& optima, Method method)
    : smooth_(method == Method::chebyshev),
      optima_(increments_of(optima)),
      dz_(spline_of(optima, &Increment::dz)),
      db_(spline_of(optima, &Increment::db)) {}

Increment Increments::at(double station) const {
  if (smooth_) return {dz_(station), db_(station)};
  const auto i = std::size_t(station), n = optima_.size();
  const double t = station - double(i);
  const Increment &a = optima_[i % n], &b = optima_[(i + 1) % n];
  return {a.dz + t * (b.dz - a.dz), a.db + t * (b.db - a.db)};
}

tl::unexpected<Error> failed(ErrorCode code, double omega) {
  if (code == ErrorCode::cancelled) return fail({.code = code});
  return fail({.code = code,
               .member = blamed(code),
               .got = omega * kDegPerRad,
               .unit = "deg",
               .hint = "at this omega"});
}

}  // namespace tubecut::groove
