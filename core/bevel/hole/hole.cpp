#include "core/bevel/hole/hole.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/base/try.hpp"
#include "core/bevel/beam/beam.hpp"
#include "core/bevel/beam/torch_line.hpp"
#include "core/bevel/hole/hole_cause.hpp"
#include "core/bevel/hole/hole_end.hpp"
#include "core/bevel/hole/hole_fit.hpp"
#include "core/bevel/hole/hole_slice.hpp"
#include "core/bevel/hole/hole_wall.hpp"
#include "core/joint/length.hpp"
#include "core/joint/placement.hpp"
#include "core/math/polygon.hpp"

namespace tubecut::bevel {
namespace {

using Eigen::Vector3d;

constexpr int kCells = 36;  // before any deviation is measured: 10 deg
constexpr int kProbes = 7;
constexpr int kHalvings = 20;
constexpr double kCrossed = 1e-9;               // of a hole's area, that rounding leaves
constexpr double kShallow = 1e-9 * kRadPerDeg;  // rad; a larger loss of the groove is reported

double wrapped(double phi) { return phi - kTwoPi * std::floor(phi / kTwoPi); }

/// One node: its phase on the branch and its wall line.
struct Node {
  double phase = 0.0;
  WallLine line;
};

/// Bisects the branch's phases until both edges are straight within the tolerance.
class Refiner {
 public:
  Refiner(const HoleSpec& spec, const WallLines& walls) : spec_(spec), walls_(walls) {}

  std::vector<Node> uniform(std::size_t n) const {
    std::vector<Node> out;
    out.reserve(n);
    for (std::size_t i = 0; i < n && !stopped(); ++i)
      out.push_back(at(kTwoPi * static_cast<double>(i) / static_cast<double>(n)));
    return out;
  }

  std::vector<Node> adaptive() const {
    std::vector<Node> all{at(0.0)};
    for (int k = 1; k <= kCells; ++k) {
      const Node to = k == kCells ? closing(all.front()) : at(kTwoPi * k / kCells);
      halve(Node(all.back()), to, kHalvings, all);
      if (k < kCells) all.push_back(to);
    }
    return all;
  }

  /// Adds a node in the middle of each flagged gap.
  std::vector<Node> halved(const std::vector<Node>& nodes, const std::vector<bool>& gaps) const {
    std::vector<Node> out;
    for (std::size_t i = 0; i < nodes.size() && !stopped(); ++i) {
      out.push_back(nodes[i]);
      const double next = i + 1 < nodes.size() ? nodes[i + 1].phase : kTwoPi + nodes.front().phase;
      if (gaps[i]) out.push_back(at(0.5 * (nodes[i].phase + next)));
    }
    return out;
  }

  /// Adds the uniform phases that are not yet nodes.
  std::vector<Node> with(std::vector<Node> nodes, std::size_t n) const {
    const auto old = nodes.size();
    for (auto& node : uniform(n)) {
      const auto next = std::lower_bound(
          nodes.begin(), nodes.begin() + static_cast<std::ptrdiff_t>(old), node.phase - 1e-9,
          [](const Node& a, double phase) { return a.phase < phase; });
      const bool taken = next != nodes.begin() + static_cast<std::ptrdiff_t>(old) &&
                         next->phase < node.phase + 1e-9;
      if (!taken) nodes.push_back(std::move(node));
    }
    std::ranges::stable_sort(nodes, {}, &Node::phase);
    return nodes;
  }

 private:
  Node at(double phase) const { return {phase, walls_.at(phase)}; }
  static Node closing(const Node& first) { return {kTwoPi, first.line}; }

  [[nodiscard]] Vector3d placed(const Vector3d& p, double radius) const {
    if (spec_.sampling.tolerance->metric == joint::Metric::chord) return p;
    return {radius * walls_.phi(p), p.z(), 0.0};
  }

  [[nodiscard]] double deviation(const Vector3d& a, const Vector3d& b, const Vector3d& p) const {
    const Vector3d along = (b - a).normalized();
    const Vector3d to = p - a;
    return (to - to.dot(along) * along).norm();
  }

  [[nodiscard]] bool straight(const Node& a, const Node& b) const {
    const double ro = spec_.chord.outer_radius;
    const double ri = spec_.chord.inner_radius();
    for (int k = 1; k <= kProbes; ++k) {
      const auto mid = walls_.at(a.phase + (b.phase - a.phase) * k / (kProbes + 1));
      const double off = std::max(
          deviation(placed(a.line.outer, ro), placed(b.line.outer, ro), placed(mid.outer, ro)),
          deviation(placed(a.line.inner, ri), placed(b.line.inner, ri), placed(mid.inner, ri)));
      if (off > spec_.sampling.tolerance->value) return false;
    }
    return true;
  }

  void halve(const Node& a, const Node& b, int halvings, std::vector<Node>& out) const {
    if (halvings == 0 || out.size() > spec_.sampling.max_nodes || stopped() || straight(a, b))
      return;
    const Node mid = at(0.5 * (a.phase + b.phase));
    halve(a, mid, halvings - 1, out);
    out.push_back(mid);
    halve(mid, b, halvings - 1, out);
  }

  const HoleSpec& spec_;
  const WallLines& walls_;
};

Result<void> check_count(const HoleSpec& spec, const std::vector<Node>& nodes) {
  if (stopped()) return fail({.code = ErrorCode::cancelled});
  if (nodes.size() > spec.sampling.max_nodes)
    return fail({.code = ErrorCode::too_many_nodes,
                 .member = "sampling",
                 .got = static_cast<double>(nodes.size()),
                 .limit = static_cast<double>(spec.sampling.max_nodes)});
  return {};
}

Result<std::vector<Node>> sample(const HoleSpec& spec, const Refiner& refiner) {
  const auto& s = spec.sampling;
  if (s.tolerance ? !(s.tolerance->value > 0.0) : s.uniform_points == 0)
    return fail({.code = ErrorCode::out_of_range, .member = "sampling"});
  auto nodes = s.tolerance ? refiner.with(refiner.adaptive(), s.uniform_points)
                           : refiner.uniform(s.uniform_points);
  TRY(check_count(spec, nodes));
  return nodes;
}

/// Returns runs of nodes that satisfy `holds`, as intervals of the branch's phase in deg.
template <class F>
Intervals runs(const std::vector<Node>& nodes, F holds) {
  Intervals out;
  bool inside = false;
  for (const auto& node : nodes) {
    const bool now = holds(node.line);
    const double phi = node.phase * kDegPerRad;
    if (now && !inside) out.emplace_back(phi, phi);
    if (now) out.back().second = phi;
    inside = now;
  }
  return out;
}

Result<void> check_lines(const HoleSpec& spec, const std::vector<Node>& nodes) {
  auto open = runs(nodes, [](const WallLine& w) { return w.misses_bore; });
  if (!open.empty())
    return fail({.code = ErrorCode::open_profile,
                 .member = "branch",
                 .got = std::move(open),
                 .limit = "a wall that reaches the bore",
                 .unit = "deg",
                 .hint = "the hole's wall does not reach the chord's bore here"});
  auto beyond = runs(nodes, [](const WallLine& w) { return w.beyond_torch; });
  if (beyond.empty()) return {};
  double needs = 0.0;
  for (const auto& node : nodes)
    if (node.line.beyond_torch && std::abs(node.line.needs) > std::abs(needs))
      needs = node.line.needs;
  return fail(beyond_torch(spec, std::move(beyond), needs));
}

/// Rejects walls whose lines cross: the other edge turns back there, and no cut makes such a wall,
/// even without kerf.
Result<void> check_edges(const HoleSpec& spec, const std::vector<Node>& nodes, const Hole& hole) {
  const bool crosses = std::ranges::any_of(std::array{0.0, 0.5, 1.0}, [&](double u) {
    const auto polygon = slice(spec.chord, hole, u, 0.0);
    return math::crossed_area(polygon) > kCrossed * math::area(polygon);
  });
  if (stopped()) return fail({.code = ErrorCode::cancelled});
  if (!crosses) return {};
  Intervals back;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto &a = nodes[i].line, &b = nodes[(i + 1) % nodes.size()].line;
    if (!((b.outer - a.outer).dot(b.inner - a.inner) < 0.0)) continue;
    const double from = nodes[i].phase * kDegPerRad;
    const double to = i + 1 < nodes.size() ? nodes[i + 1].phase * kDegPerRad : 360.0;
    if (!back.empty() && back.back().second == from)
      back.back().second = to;
    else
      back.emplace_back(from, to);
  }
  return fail({.code = ErrorCode::edge_crosses,
               .member = "branch",
               .got = std::move(back),
               .limit = "an edge that does not cross itself",
               .unit = "deg",
               .hint = "the cut lines cross inside the chord's wall here"});
}

void note_lost(const HoleSpec& spec, const std::vector<Node>& nodes, std::vector<Warning>& out) {
  const bool on = spec.kind == JointKind::set_on;
  for (const auto& [from, to] : runs(nodes, [](const WallLine& w) { return w.lost > kShallow; })) {
    double worst = 0.0;
    for (const auto& node : nodes)
      if (node.phase * kDegPerRad >= from && node.phase * kDegPerRad <= to)
        worst = std::max(worst, node.line.lost);
    out.push_back(
        {.code = WarningCode::torch_range_binds,
         .member = "torch",
         .detail = "branch phase " + shown(from) + " to " + shown(to) + " deg, up to " +
                   shown(worst * kDegPerRad) +
                   (on ? " deg short of the branch's direction" : " deg of groove lost")});
  }
}

Hole tabulate(const HoleSpec& spec, const WallLines& walls, const std::vector<Node>& nodes,
              bool far) {
  Hole out{.far = far};
  for (auto* column : {&out.branch_phi, &out.phi, &out.z, &out.developed, &out.phi_inner,
                       &out.z_inner, &out.dihedral, &out.groove, &out.b, &out.a, &out.beam,
                       &out.torch_phi, &out.torch_z, &out.torch_phi_inner, &out.torch_z_inner})
    column->reserve(nodes.size());
  for (const auto& [phase, w] : nodes) {
    // The far side's branch frame is mirrored: its phase runs in reverse.
    out.branch_phi.push_back(far ? wrapped(kPi - phase) : phase);
    out.phi.push_back(walls.phi(w.outer));
    out.z.push_back(w.outer.z());
    out.developed.push_back(spec.chord.outer_radius * out.phi.back());
    out.phi_inner.push_back(walls.phi(w.inner));
    out.z_inner.push_back(w.inner.z());
    out.dihedral.push_back(w.dihedral);
    out.groove.push_back(w.groove);
    out.b.push_back(w.b);
    out.a.push_back(w.a);
    out.beam.push_back((w.torch_outer - w.torch_inner).norm());
    out.torch_phi.push_back(walls.phi(w.torch_outer));
    out.torch_z.push_back(w.torch_outer.z());
    out.torch_phi_inner.push_back(walls.phi(w.torch_inner));
    out.torch_z_inner.push_back(w.torch_inner.z());
  }
  return out;
}

/// Moves the torch half a kerf off the wall, and further if a beam of that width would remove metal
/// from it: next to its own line, where the wall turns, and between nodes.
Hole cleared(const HoleSpec& spec, const WallLines& walls, std::vector<Node>& nodes, bool far) {
  auto out = tabulate(spec, walls, nodes, far);
  if (spec.kerf == 0.0) return out;
  const auto moved = [&](const Further& further) {
    bool any = false;
    for (std::size_t i = 0; i < nodes.size() && !stopped(); ++i) {
      if (further[i] == 0.0) continue;
      nodes[i].line = walls.at(nodes[i].phase, 0.5 * spec.kerf + further[i]);
      any = true;
    }
    if (any) out = tabulate(spec, walls, nodes, far);
    return beam_cut(spec, out);
  };
  const auto proof = clear_torch(nodes.size(), moved);
  out.torch_line = proof;
  return out;
}

/// Returns the gaps between nodes in which the wall that faces the other member is too near to it.
Result<std::vector<bool>> too_near(const HoleSpec& spec, const joint::TubeCutter& branch,
                                   const Hole& hole) {
  if (spec.kind != JointKind::set_on) return too_near_between(spec, branch, hole);
  TRY(const auto end, branch_end(spec, branch, hole.branch_phi));
  return too_near_between(spec, branch, end);
}

/// Adds nodes until the gap is kept between nodes too. This is needed because edges within the
/// tolerance of their curves at probes do not guarantee it, and the branch's end has the hole's
/// nodes.
Result<void> keep_gap(const HoleSpec& spec, const joint::TubeCutter& branch, const Refiner& refiner,
                      const WallLines& walls, bool far, std::vector<Node>& nodes) {
  if (!spec.sampling.tolerance) return {};
  for (int k = 0; k < kHalvings; ++k) {
    TRY(const auto gaps, too_near(spec, branch, tabulate(spec, walls, nodes, far)));
    if (stopped()) return fail({.code = ErrorCode::cancelled});
    if (std::ranges::none_of(gaps, std::identity())) return {};
    nodes = refiner.halved(nodes, gaps);
    TRY(check_count(spec, nodes));
  }
  return {};
}

void fill_lengths(const joint::Contour& root, const std::vector<Node>& nodes, Hole& out) {
  std::vector<double> phases;
  for (const auto& node : nodes) phases.push_back(node.phase);
  out.length = joint::lengths_along(root, phases);
  out.length_total = out.length.back();
  out.length.pop_back();
}

Result<Hole> one_hole(const HoleSpec& spec, const joint::TubeCutter& branch, bool far,
                      std::vector<Warning>& warnings) {
  const bool on = spec.kind == JointKind::set_on;
  const double rho = on ? branch.radius - spec.branch_wall : branch.radius + spec.gap;
  TRY(check_kerf(spec.kerf));
  if (!(0.5 * spec.kerf < rho))
    return fail({ErrorCode::out_of_range, "kerf", spec.kerf, 2.0 * rho, "mm", {}});
  TRY(const auto root,
      joint_curve(branch, on ? spec.chord.outer_radius : spec.chord.inner_radius(), rho));
  const WallLines walls(spec, branch, rho, root.cutters.front());
  const Refiner refiner(spec, walls);
  TRY(auto nodes, sample(spec, refiner));
  TRY(check_lines(spec, nodes));
  TRY(keep_gap(spec, branch, refiner, walls, far, nodes));
  TRY(check_lines(spec, nodes));
  TRY(check_edges(spec, nodes, tabulate(spec, walls, nodes, far)));
  auto out = cleared(spec, walls, nodes, far);
  if (stopped()) return fail({.code = ErrorCode::cancelled});
  TRY(check_lines(spec, nodes));
  TRY(check_spared(beam_cut(spec, out), out.torch_line));
  fill_lengths(root, nodes, out);
  if (!root.near_parallel.empty() && !far)
    warnings.push_back({.code = WarningCode::near_parallel, .member = "branch"});
  note_lost(spec, nodes, warnings);
  return out;
}

/// Computes one hole. If the kerf is too wide, returns the first cause.
Result<Hole> hole_or_cause(const HoleSpec& spec, const joint::TubeCutter& branch, bool far,
                           std::vector<Warning>& warnings) {
  auto out = one_hole(spec, branch, far, warnings);
  const bool wide = !out && out.error().code() == ErrorCode::out_of_range &&
                    out.error().issues.front().member == "kerf" &&
                    0.5 * spec.kerf < branch.radius - spec.branch_wall;
  if (!wide) return out;
  auto narrow = spec;
  narrow.kerf = 0.0;
  std::vector<Warning> none;
  const auto lines = one_hole(narrow, branch, far, none);
  if (stopped()) return fail({.code = ErrorCode::cancelled});
  const double lean = lines ? furthest_lean(*lines) : 0.0;
  if (!(lean > kSteepLean)) return out;
  auto cause = first_cause(spec, lean, [&](const HoleSpec& changed) {
    if (stopped()) return false;
    const auto cut = one_hole(changed, branch, far, none);
    if (!cut || changed.kind == JointKind::through) return cut.has_value();
    return branch_end(changed, branch, cut->branch_phi).has_value();
  });
  if (stopped()) return fail({.code = ErrorCode::cancelled});
  if (cause) return fail(*std::move(cause));
  return out;
}

}  // namespace

Result<joint::TubeCutter> branch_tube(const BranchPlacement& branch) {
  if (const auto* tube = std::get_if<joint::TubeCutter>(&branch)) return *tube;
  return under("branch", std::get<joint::AxisTube>(branch).tube());
}

Result<HoleCut> hole(const HoleSpec& asked) {
  if (asked.kind == JointKind::mitre)
    return fail({.code = ErrorCode::unsupported_combination, .member = "joint/kind"});
  TRY(const auto branch, branch_tube(asked.branch));
  HoleSpec spec = asked;
  spec.sampling.max_nodes = std::min(spec.sampling.max_nodes, most_rows(spec.kerf, branch.radius));
  HoleCut out;
  TRY(auto near, hole_or_cause(spec, branch, false, out.warnings));
  out.holes.push_back(std::move(near));
  if (spec.kind == JointKind::through) {
    TRY(auto far, hole_or_cause(spec, reversed(branch), true, out.warnings));
    out.holes.push_back(std::move(far));
  } else {
    TRY(auto end, branch_end(spec, branch, out.holes.front().branch_phi));
    out.branch = std::move(end);
  }
  note_overhang(spec, branch, out.warnings);
  for (auto& one : out.holes) one.fit = fit_up(spec, branch, out, one);
  if (stopped()) return fail({.code = ErrorCode::cancelled});
  note_nearest(spec, out);
  return out;
}

}  // namespace tubecut::bevel
