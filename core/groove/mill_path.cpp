#include "core/groove/mill_path.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "core/base/elementary.hpp"
#include "core/groove/periodic_spline.hpp"
#include "core/groove/survey.hpp"

namespace tubecut::groove {
namespace {

/// What every position needs; values, made once.
struct Shop {
  const MillPathSpec& spec;
  Joint joint;
  Cone cone;

  [[nodiscard]] double omega(double station) const { return kTwoPi * station / spec.positions; }
};

std::vector<Issue> check_issues(const MillPathSpec& spec) {
  std::vector<Issue> issues;
  const auto refuse = [&issues](ErrorCode code, const char* member, double got, double limit, const char* unit) {
    issues.push_back({.code = code, .member = member, .got = got, .limit = limit, .unit = unit});
  };
  const GapCheck& check = spec.check;
  if (check.points < 3) refuse(ErrorCode::sampling, "check/points", check.points, 3, "");
  if (check.points > kMaxPoints) refuse(ErrorCode::sampling, "check/points", check.points, kMaxPoints, "");
  const double window = check.window.deg(), pitch = check.pitch.deg();
  if (!(window > 0.0 && check.window <= Angle::deg(90))) refuse(ErrorCode::sampling, "check/window", window, 90.0, "deg");
  if (!(pitch > 0.0 && check.pitch <= check.window)) refuse(ErrorCode::sampling, "check/pitch", pitch, window, "deg");
  if (!(check.qualify > 0.0 && std::isfinite(check.qualify))) refuse(ErrorCode::out_of_range, "check/qualify", check.qualify, 0.0, "mm");
  if (spec.positions < kMinPositions) refuse(ErrorCode::out_of_range, "positions", spec.positions, kMinPositions, "");
  if (spec.positions > kMaxPositions) refuse(ErrorCode::out_of_range, "positions", spec.positions, kMaxPositions, "");
  if (spec.optimise.hold != Hold::tip && spec.optimise.hold != Hold::pivot)
    refuse(ErrorCode::setup, "optimise/hold", double(spec.optimise.hold), 1.0, "");
  return issues;
}

const char* blamed(ErrorCode code) {
  switch (code) {
    case ErrorCode::window: return "check/window";
    case ErrorCode::contact: return "check/pitch";
    case ErrorCode::z_ineffective: return "setup/mount";
    case ErrorCode::no_p2:
    case ErrorCode::p2_ambiguous: return "groove/branch/wall";
    default: return "";
  }
}

tl::unexpected<Error> failed(ErrorCode code, double omega) {
  if (code == ErrorCode::cancelled) return fail({.code = code});
  return fail({.code = code, .member = blamed(code), .got = omega * kDegPerRad, .unit = "deg", .hint = "at this omega"});
}

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

/// Every position has a generator of its own, so that their order and number do not matter.
std::mt19937_64 generator(std::uint64_t seed, int index) {
  return std::mt19937_64{seed * 0x9E3779B97F4A7C15ULL + std::uint64_t(index)};
}

tl::expected<Optimum, ErrorCode> improve(const Shop& shop, const Task& task, Gap initial, int index, std::stop_token stop) {
  const Optimise& how = shop.spec.optimise;
  if (how.method == Method::chebyshev) return chebyshev(task, how.bias, std::move(initial));
  if (how.method == Method::none) return certified(task, {}, 0.0, 1, std::move(initial));
  auto random = generator(how.seed, index);
  return annealing(task, random, stop);
}

/// A position and all that is said about it; `given` between optima.
tl::expected<MillPosition, ErrorCode> position(const Shop& shop, double station, std::optional<Increment> given, std::stop_token stop) {
  const MillPathSpec& spec = shop.spec;
  const Angle omega = Angle::rad(shop.omega(station));
  const auto near = neighbourhood(shop.joint, omega, spec.check);
  const auto here = section(shop.joint, omega);
  if (!near || !here) return tl::unexpected(here ? near.error() : here.error());
  const Task task{*near, shop.cone, spec.setup, initial_pose(shop.joint, *here, spec.mill, spec.setup), spec.optimise.hold};
  auto initial = gap(*near, shop.cone, task.start);
  if (!initial) return tl::unexpected(initial.error());
  MillPosition out;
  out.omega = omega;
  out.before = line_of(*initial);
  out.grid_before = grid_figures(*near, shop.cone, task.start);
  out.optimised = !given;
  tl::expected<Optimum, ErrorCode> best = Optimum{};
  if (given) {
    auto seen = gap(*near, shop.cone, moved(task.start, spec.setup, task.hold, *given));
    if (!seen) return tl::unexpected(seen.error());
    best = certified(task, *given, 0.0, 0, std::move(*seen));
  } else {
    best = improve(shop, task, std::move(*initial), int(station), stop);
  }
  if (!best) return tl::unexpected(best.error());
  const ToolPose pose = moved(task.start, spec.setup, task.hold, best->by);
  out.at = axis_position(pose, spec.setup, omega);
  out.by = best->by;
  out.after = line_of(best->gap);
  out.grid = grid_figures(*near, shop.cone, pose);
  out.certificate = best->certificate;
  out.bias = best->bias;
  out.reference = best->reference;
  out.evaluations = best->evaluations;
  out.qualified = best->gap.qualified(spec.check.qualify);
  return out;
}

/// Increments between the optima: smooth where the optima are, broken lines where they are noise.
class Increments {
 public:
  Increments(const std::vector<MillPosition>& optima, Method method)
      : smooth_(method == Method::chebyshev), optima_(optima), dz_(pick(&Increment::dz)), db_(pick(&Increment::db)) {}

  [[nodiscard]] Increment at(double station) const {
    if (smooth_) return {dz_(station), db_(station)};
    const auto i = std::size_t(station), n = optima_.size();
    const double t = station - double(i);
    const Increment &a = optima_[i % n].by, &b = optima_[(i + 1) % n].by;
    return {a.dz + t * (b.dz - a.dz), a.db + t * (b.db - a.db)};
  }

 private:
  [[nodiscard]] PeriodicSpline pick(double Increment::* part) const {
    std::vector<double> values;
    for (const MillPosition& p : optima_) values.push_back(p.by.*part);
    return PeriodicSpline{std::move(values)};
  }

  bool smooth_;
  const std::vector<MillPosition>& optima_;
  PeriodicSpline dz_, db_;
};

double nearest_turn(double angle, double to) { return angle - kTwoPi * std::floor((angle - to) / kTwoPi + 0.5); }

/// Exact poses between optima.
class Route {
 public:
  Route(const Shop& shop, const Increments& increments) : shop_(shop), increments_(increments) {}

  /// Stations to emit: the optima, and between each two as many equal parts as keep the sag small.
  [[nodiscard]] Result<std::vector<double>> stations(std::stop_token stop) const {
    std::vector<double> out;
    for (int i = 0; i < shop_.spec.positions; ++i) {
      if (stop.stop_requested()) return fail({.code = ErrorCode::cancelled});
      const auto count = parts(i);
      if (!count) return failed(count.error(), shop_.omega(i));
      for (int k = 0; k < *count; ++k) out.push_back(i + double(k) / *count);
      if (out.size() > std::size_t(kMaxPositions))
        return fail({.code = ErrorCode::too_many_nodes, .member = "setup/pivot_length", .got = double(out.size()), .limit = double(kMaxPositions),
                     .hint = "positions that keep the axes' sag below 0.001 mm"});
    }
    return out;
  }

 private:
  struct Exact {
    ToolPose pose;
    Block block;
  };

  [[nodiscard]] tl::expected<Exact, ErrorCode> exact(double station) const {
    const MillPathSpec& spec = shop_.spec;
    const Angle omega = Angle::rad(shop_.omega(station));
    const auto here = section(shop_.joint, omega);
    if (!here) return tl::unexpected(here.error());
    const ToolPose pose = moved(initial_pose(shop_.joint, *here, spec.mill, spec.setup), spec.setup, spec.optimise.hold, increments_.at(station));
    const AxisPosition at = axis_position(pose, spec.setup, omega);
    return Exact{pose, {omega.rad(), at.x, at.z, at.b.rad()}};
  }

  /// How far the tool's ends and the axes are off at the middle of a linear move.
  [[nodiscard]] double sag(const Exact& a, const Exact& middle, const Exact& b) const {
    const Block half{0.0, 0.5 * (a.block.x + b.block.x), 0.5 * (a.block.z + b.block.z), 0.5 * (a.block.b + nearest_turn(b.block.b, a.block.b))};
    const ToolPose linear = pose_of(half, shop_.spec.setup);
    const Eigen::Vector2d tip = linear.tip - middle.pose.tip;
    const Eigen::Vector2d back = tip + shop_.cone.length * (linear.axis - middle.pose.axis);
    return std::max({tip.norm(), back.norm(), std::abs(half.x - middle.block.x), std::abs(half.z - middle.block.z)});
  }

  [[nodiscard]] tl::expected<double, ErrorCode> worst_sag(int interval, int count) const {
    double out = 0.0;
    auto from = exact(interval);
    for (int k = 0; k < count; ++k) {
      const auto middle = exact(interval + (k + 0.5) / count), to = exact(interval + (k + 1.0) / count);
      if (!from || !middle || !to) return tl::unexpected(ErrorCode::no_p2);
      out = std::max(out, sag(*from, *middle, *to));
      from = to;
    }
    return out;
  }

  [[nodiscard]] tl::expected<int, ErrorCode> parts(int interval) const {
    int count = 1;
    while (count <= kMaxPositions) {  // grows by one at least
      const auto worst = worst_sag(interval, count);
      if (!worst) return tl::unexpected(worst.error());
      if (*worst <= kAxisSag) return count;
      count = std::max(count + 1, int(std::ceil(count * std::sqrt(std::min(*worst / kAxisSag, 1e8)))));
    }
    return count;
  }

  const Shop& shop_;
  const Increments& increments_;
};

void unwind(std::vector<MillPosition>& positions) {
  for (std::size_t i = 1; i < positions.size(); ++i)
    positions[i].at.b = Angle::rad(nearest_turn(positions[i].at.b.rad(), positions[i - 1].at.b.rad()));
}

std::vector<Block> blocks_of(const std::vector<MillPosition>& positions, bool optima_only) {
  std::vector<Block> out;
  for (const MillPosition& p : positions)
    if (p.optimised || !optima_only) out.push_back({p.omega.rad(), p.at.x, p.at.z, p.at.b.rad()});
  return out;
}

std::optional<Issue> travel_issue(const Travel& travel, const MillPosition& p) {
  const auto beyond = [&p](const char* member, const std::optional<Range>& range, double value, const char* unit) -> std::optional<Issue> {
    if (!range || (value >= range->min && value <= range->max)) return std::nullopt;
    return Issue{.code = ErrorCode::travel, .member = member, .got = value, .limit = value < range->min ? range->min : range->max, .unit = unit,
                 .hint = "at omega " + degrees_text(p.omega)};
  };
  if (auto issue = beyond("setup/travel/x", travel.x, p.at.x, "mm")) return issue;
  if (auto issue = beyond("setup/travel/z", travel.z, p.at.z, "mm")) return issue;
  return beyond("setup/travel/b", travel.b_deg, p.at.b.deg(), "deg");
}

std::vector<Warning> path_warnings(const MillPathSpec& spec, const MillPath& path) {
  std::vector<Warning> out;
  const Extreme& root = path.swept.root_face_min;
  if (root.value < kRootFaceCut)
    out.push_back({WarningCode::root_face_cut, "optimise/hold", number_text(-root.value) + " mm deep at omega " + degrees_text(root.omega)});
  const auto outside = [&](const MillPosition& p) { return p.after.largest >= spec.check.qualify; };
  const auto count = std::count_if(path.positions.begin(), path.positions.end(), outside);
  if (count > 0) {
    const auto first = std::find_if(path.positions.begin(), path.positions.end(), outside);
    out.push_back({WarningCode::window_not_reached, "check/qualify",
                   std::to_string(count) + " of " + std::to_string(path.positions.size()) + " positions, first at omega " + degrees_text(first->omega)});
  }
  return out;
}

/// Errors of the nested groove under its own member.
Error nested(Error error) {
  for (Issue& issue : error.issues) issue.member.insert(0, "groove/");
  return error;
}

tl::expected<std::vector<MillPosition>, Error> optima_of(const Shop& shop, std::stop_token stop) {
  std::vector<MillPosition> out;
  for (int i = 0; i < shop.spec.positions; ++i) {
    if (stop.stop_requested()) return fail({.code = ErrorCode::cancelled});
    auto found = position(shop, i, std::nullopt, stop);
    if (!found) return failed(found.error(), shop.omega(i));
    out.push_back(std::move(*found));
  }
  return out;
}

tl::expected<std::vector<MillPosition>, Error> emitted(const Shop& shop, std::vector<MillPosition> optima, std::stop_token stop) {
  const Increments increments{optima, shop.spec.optimise.method};
  const auto stations = Route{shop, increments}.stations(stop);
  if (!stations) return tl::unexpected(stations.error());
  std::vector<MillPosition> out;
  for (const double station : *stations) {
    if (stop.stop_requested()) return fail({.code = ErrorCode::cancelled});
    if (station == std::floor(station)) {
      out.push_back(optima[std::size_t(station)]);
      continue;
    }
    auto between = position(shop, station, increments.at(station), stop);
    if (!between) return failed(between.error(), shop.omega(station));
    out.push_back(std::move(*between));
  }
  unwind(out);
  return out;
}

}  // namespace

Result<MillPath> mill_path(const MillPathSpec& spec, std::stop_token stop) {
  const auto joint = joint_of(spec.groove);
  if (!joint) return tl::unexpected(nested(joint.error()));
  if (auto issues = check_issues(spec); !issues.empty()) return tl::unexpected(Error{std::move(issues)});
  auto whole = survey(*joint, 0.0, stop);
  if (!whole) return tl::unexpected(nested(whole.error()));
  if (auto fault = tool_fault(*joint, *whole, spec.mill, spec.setup)) return tl::unexpected(std::move(*fault));
  const Shop shop{spec, *joint, Cone{spec.mill}};
  auto optima = optima_of(shop, stop);
  if (!optima) return tl::unexpected(optima.error());
  auto positions = emitted(shop, std::move(*optima), stop);
  if (!positions) return tl::unexpected(positions.error());
  MillPath out;
  out.positions = std::move(*positions);
  for (const MillPosition& p : out.positions)
    if (auto issue = travel_issue(spec.setup.travel, p)) return fail(std::move(*issue));
  const SweptPoints points{.per_ruling = spec.check.points};
  for (const bool optima_only : {false, true}) {
    auto figures = swept(shop.joint, shop.cone, spec.setup, blocks_of(out.positions, optima_only), Between::linear, points, stop);
    if (!figures) return failed(figures.error(), 0.0);
    (optima_only ? out.swept_at_optima : out.swept) = *figures;
  }
  out.qualified = out.swept.root_face_min.value >= kRootFaceReject &&
                  std::all_of(out.positions.begin(), out.positions.end(), [](const MillPosition& p) { return p.qualified; });
  out.warnings = std::move(whole->warnings);
  for (Warning& warning : out.warnings) warning.member.insert(0, "groove/");
  for (Warning& warning : path_warnings(spec, out)) out.warnings.push_back(std::move(warning));
  return out;
}

}  // namespace tubecut::groove
