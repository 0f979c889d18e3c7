#include "core/bevel/table.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/elementary.hpp"
#include "core/bevel/kerf.hpp"
#include "core/bevel/required.hpp"
#include "core/bevel/swing_rows.hpp"

namespace tubecut::bevel {
namespace {

constexpr double kBelow = 1e-9 * kRadPerDeg;  // what counts as falling below, rad

/// What is needed at every node, computed once.
struct Ground {
  const TableSpec& spec;
  std::vector<joint::Cutter> cutters;
  joint::Contour root;
  std::optional<joint::Contour> inner;  // when the root is on the outer surface
  std::vector<joint::Event> other_events;
  Wall wall;
  Rule rule;

  [[nodiscard]] const joint::Contour& inner_contour() const { return inner ? *inner : root; }
};

Result<void> check(const TableSpec& spec) {
  if (!(spec.root_face >= 0.0 && spec.root_face < spec.target.wall))
    return fail({.code = ErrorCode::out_of_range,
                 .member = "root_face",
                 .got = spec.root_face,
                 .limit = spec.target.wall,
                 .unit = "mm",
                 .hint = "must be less than the wall"});
  if (spec.root_face > 0.0 && spec.contact != Contact::inner)
    return fail({.code = ErrorCode::unsupported_combination,
                 .member = "root_face",
                 .hint = "a root face goes with contact inner"});
  const auto* zoned = std::get_if<ZonedGroove>(&spec.groove);
  if (zoned == nullptr) return {};
  auto ok = check_zones(*zoned);
  if (!ok)
    for (auto& issue : ok.error().issues) issue.member = "groove/" + issue.member;
  return ok;
}

Result<Ground> ground(const TableSpec& spec) {
  if (auto ok = check(spec); !ok) return tl::unexpected(ok.error());
  auto cutters = grown_partners(spec);
  if (!cutters) return tl::unexpected(cutters.error());
  const Wall wall{spec.target.inner_radius(), spec.target.outer_radius};
  const bool outer = spec.root_surface == RootSurface::outer;
  auto root = joint::trace(*cutters, outer ? wall.outer : wall.inner);
  if (!root) return tl::unexpected(root.error());
  Ground out{.spec = spec,
             .cutters = *std::move(cutters),
             .root = *std::move(root),
             .inner = {},
             .other_events = {},
             .wall = wall,
             .rule = Rule(spec.groove, spec.dihedral)};
  out.other_events = joint::divide(out.root.cutters, outer ? wall.inner : wall.outer).events;
  if (outer) {
    auto inner = joint::trace(out.cutters, wall.inner);
    if (!inner) return tl::unexpected(inner.error());
    out.inner = *std::move(inner);
  }
  return out;
}

/// One side of one node before smoothing. Angles in rad.
struct Point {
  std::size_t cutter = 0;
  Angles angles;
  double raw = 0.0;       // rule within the torch range
  double required = 0.0;  // least B with which no partner enters the wall
  double input = 0.0;     // of the smoother
  double face = 0.0;      // elevation of the land
};

/// What the smoother starts from.
double input_of(const TableSpec& spec, const Point& p) {
  if (spec.contact == Contact::inner) return std::max(p.raw, p.required);
  const bool floored =
      spec.contact == Contact::automatic && !std::holds_alternative<SquareCut>(spec.groove);
  return floored ? std::min(std::max(p.raw, p.required), spec.torch.max.rad()) : p.raw;
}

/// With a land: its elevation, and the least B from its outer edge.
void stand_on_face(const Ground& g, double phi, double z, Point& out) {
  const double edge = g.wall.inner + g.spec.root_face;
  const double least = required_bevel(g.root.cutters, {g.wall.inner, edge},
                                      joint::generator_at(g.wall.inner, phi), z);
  out.face = std::max(0.0, least);
  const double slope = elementary::tan(std::min(out.face, g.spec.torch.max.rad()));
  out.required = required_bevel(g.root.cutters, {edge, g.wall.outer},
                                joint::generator_at(edge, phi), z + g.spec.root_face * slope);
}

Point point(const Ground& g, double phi, const joint::Hit& hit, std::size_t cutter, double root_z) {
  const auto line = joint::generator_at(g.root.radius, phi);
  Point out{.cutter = cutter};
  const bool published = g.spec.dihedral == Dihedral::as_published;
  out.angles =
      g.rule.angles(published ? joint::published_normal(g.root.cutters[cutter], line) : hit.normal);
  const auto& torch = g.spec.torch;
  out.raw = std::clamp(out.angles.b, torch.min.rad(), torch.max.rad());
  const double z = g.inner ? joint::contact_at(*g.inner, phi).z : root_z;
  if (g.spec.root_face > 0.0)
    stand_on_face(g, phi, z, out);
  else
    out.required =
        required_bevel(g.root.cutters, g.wall, joint::generator_at(g.wall.inner, phi), z);
  out.input = input_of(g.spec, out);
  return out;
}

/// The side of a node with the larger input: at an event the larger one-sided value counts.
Point larger(const Ground& g, const joint::Node& node) {
  const auto sides = joint::hits_at(g.root, node);
  auto before = point(g, node.phi, sides.before, node.before, node.z);
  if (node.kind == joint::NodeKind::smooth || node.kind == joint::NodeKind::jump) return before;
  auto after = point(g, node.phi, sides.after, node.after, node.z);
  return before.input >= after.input ? before : after;
}

bool jump_pair(const std::vector<joint::Node>& nodes, std::size_t i) {
  return i + 1 < nodes.size() && nodes[i].kind == joint::NodeKind::jump &&
         nodes[i + 1].kind == joint::NodeKind::jump && nodes[i].phi == nodes[i + 1].phi;
}

/// Runs of nodes (cyclic) that satisfy `holds`, as phi intervals; one that crosses 0 ends above 2
/// pi.
template <class F>
std::vector<std::pair<double, double>> runs(const std::vector<joint::Node>& nodes, F holds) {
  std::vector<std::pair<double, double>> out;
  bool inside = false;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!holds(i)) {
      inside = false;
      continue;
    }
    if (!inside) out.emplace_back(nodes[i].phi, nodes[i].phi);
    out.back().second = nodes[i].phi;
    inside = true;
  }
  if (out.size() > 1 && holds(0) && holds(nodes.size() - 1)) {
    out.back().second = out.front().second + kTwoPi;
    out.erase(out.begin());
  }
  return out;
}

Intervals degrees(std::vector<std::pair<double, double>> intervals) {
  for (auto& [from, to] : intervals) {
    from *= kDegPerRad;
    to *= kDegPerRad;
  }
  return intervals;
}

/// The smoother's path: each phi once; along the true length both nodes of a jump stay.
struct Path {
  AngleProfile profile;
  std::vector<std::size_t> entry;  // of each node
  std::vector<std::size_t> node;   // first node of each entry
};

Path path(const Ground& g, const joint::Samples& samples, const std::vector<Point>& points) {
  const auto* envelope = std::get_if<EnvelopeSmoothing>(&g.spec.smoothing);
  const bool along_length = envelope != nullptr && envelope->along == Along::length;
  Path out;
  out.profile.period = along_length ? samples.true_length : samples.developed_length;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool second = i > 0 && jump_pair(samples.nodes, i - 1);
    const bool first = jump_pair(samples.nodes, i);
    double input = points[i].input;
    if (first) input = std::max(input, points[i + 1].input);
    if (second) input = std::max(input, points[i - 1].input);
    if (!second || along_length) {
      const auto& node = samples.nodes[i];
      out.profile.s.push_back(along_length ? node.length : g.root.radius * node.phi);
      out.profile.b.push_back(input);
      out.node.push_back(i);
    }
    out.entry.push_back(out.profile.s.size() - 1);
  }
  return out;
}

std::vector<std::size_t> junction_steps(const Ground& g, std::size_t n) {
  std::vector<std::size_t> out;
  for (const auto& event : g.root.events)
    out.push_back(
        std::min(n - 1, static_cast<std::size_t>(event.phi / kTwoPi * static_cast<double>(n))));
  return out;
}

Result<std::vector<double>> smooth_hermite(const Ground& g, const joint::Samples& samples,
                                           const Path& p, const HermiteSmoothing& method,
                                           Table& out, const std::stop_token& stop) {
  if (g.spec.sampling.tolerance)
    return fail({.code = ErrorCode::sampling_not_uniform,
                 .member = "sampling/tolerance",
                 .got = g.spec.sampling.tolerance->value,
                 .limit = "uniform_points alone",
                 .unit = "mm"});
  auto smoothed = hermite(p.profile,
                          {.limit = g.spec.mutation_limit.rad(),
                           .transition = method.transition_points,
                           .junctions = junction_steps(g, p.profile.s.size())},
                          stop);
  if (!smoothed) {
    auto error = smoothed.error();
    for (auto& issue : error.issues) issue.member = "smoothing/transition_points";
    return tl::unexpected(std::move(error));
  }
  for (const auto& w : smoothed->windows)
    out.windows.push_back({.phi = samples.nodes[w.index].phi,
                           .step = w.step,
                           .kept_before = w.kept == HermiteWindow::Kept::before,
                           .from = samples.nodes[w.from].phi,
                           .to = samples.nodes[w.to].phi,
                           .slope_start = w.slope_start,
                           .slope_end = w.slope_end});
  return std::move(smoothed->b);
}

Result<std::vector<double>> smooth(const Ground& g, const joint::Samples& samples, const Path& p,
                                   Table& out, const std::stop_token& stop) {
  if (const auto* method = std::get_if<HermiteSmoothing>(&g.spec.smoothing))
    return smooth_hermite(g, samples, p, *method, out, stop);
  if (const auto* method = std::get_if<EnvelopeSmoothing>(&g.spec.smoothing))
    return envelope(
        p.profile,
        {.limits = method->limits, .highest = g.spec.torch.max.rad(), .refine = method->refine},
        stop);
  return p.profile.b;
}

/// B required beyond the torch: an error, with the root gap that lifting the cut would open.
Result<void> check_torch(const Ground& g, const joint::Samples& samples,
                         const std::vector<Point>& points) {
  if (g.spec.contact != Contact::inner) return {};
  const double max = g.spec.torch.max.rad();
  const auto beyond = [&](std::size_t i) {
    return std::max(points[i].required, points[i].face) > max + kBelow;
  };
  auto intervals = runs(samples.nodes, beyond);
  if (intervals.empty()) return {};
  const double slope = elementary::tan(max);
  double gap = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (beyond(i))
      gap = std::max(gap, lift(g.root.cutters, g.wall,
                               joint::generator_at(g.wall.inner, samples.nodes[i].phi), slope) -
                              samples.nodes[i].z);
  return fail({.code = ErrorCode::torch_range,
               .member = "torch/max",
               .got = degrees(std::move(intervals)),
               .limit = g.spec.torch.max.deg(),
               .unit = "deg",
               .hint = "contact auto would open the root by up to " + brief(gap) + " mm"});
}

/// What the smoothing left below what it was given. Only the published one may.
Result<void> check_smoothed(const Ground& g, const joint::Samples& samples,
                            const std::vector<Point>& points, Table& out) {
  const auto beyond = runs(samples.nodes, [&](std::size_t i) {
    return out.b[i] > g.spec.torch.max.rad() + kBelow || out.b[i] < g.spec.torch.min.rad() - kBelow;
  });
  if (!beyond.empty())
    return fail({.code = ErrorCode::torch_range,
                 .member = "torch/max",
                 .got = degrees(beyond),
                 .limit = g.spec.torch.max.deg(),
                 .unit = "deg",
                 .hint = "the smoothed bevel leaves the torch's range"});
  const auto enters = runs(samples.nodes, [&](std::size_t i) {
    return g.spec.contact == Contact::inner && out.b[i] < points[i].required - kBelow;
  });
  if (!enters.empty())
    return fail(
        {.code = ErrorCode::smoothing_enters,
         .member = "smoothing/method",
         .got = degrees(enters),
         .limit = "b_required_deg",
         .unit = "deg",
         .hint = "at these phi the smoothed bevel lies below what keeps partners out of the wall"});
  double worst = 0.0, at = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double below = points[i].input - out.b[i];
    if (below <= kBelow) continue;
    ++count;
    if (below > worst) {
      worst = below;
      at = samples.nodes[i].phi;
    }
  }
  if (count > 0)
    out.warnings.push_back({.code = WarningCode::smoothed_below_raw,
                            .member = "smoothing/method",
                            .detail = "by up to " + brief(worst * kDegPerRad) + " deg at phi " +
                                      brief(at * kDegPerRad) + " deg, at " + std::to_string(count) +
                                      " points"});
  return {};
}

void note_torch_binds(const Ground& g, const joint::Samples& samples,
                      const std::vector<Point>& points, Table& out) {
  const bool lifted = g.spec.contact == Contact::automatic;
  const auto lost = [&](std::size_t i) {
    const double rule = std::abs(points[i].angles.b - points[i].raw);
    return lifted ? std::max(rule, points[i].required - g.spec.torch.max.rad()) : rule;
  };
  for (const auto& [from, to] :
       runs(samples.nodes, [&](std::size_t i) { return lost(i) > kBelow; })) {
    Table::Binding binding{.from = from, .to = to, .groove_lost = 0.0, .root_gap = 0.0};
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double phi = samples.nodes[i].phi;
      if (!((phi >= from && phi <= to) || phi + kTwoPi <= to)) continue;
      binding.groove_lost = std::max(binding.groove_lost, lost(i));
      binding.root_gap = std::max(binding.root_gap, out.gap[i]);
    }
    out.torch_binds.push_back(binding);
    out.warnings.push_back(
        {.code = WarningCode::torch_range_binds,
         .member = "torch",
         .detail = "phi " + brief(from * kDegPerRad) + " to " + brief(to * kDegPerRad) +
                   " deg, up to " + brief(binding.groove_lost * kDegPerRad) +
                   " deg of groove lost" +
                   (lifted ? ", root open up to " + brief(binding.root_gap) + " mm" : "")});
  }
}

/// On a bare grid events lie between nodes: by how much the straight line between them falls short.
void note_events_between(const Ground& g, Table& out) {
  const auto n = out.phi.size();
  const double step = kTwoPi / static_cast<double>(n);
  double worst = 0.0, at = 0.0;
  const auto see = [&](double phi, double input) {
    const auto i = std::min(n - 1, static_cast<std::size_t>(phi / step));
    const double t = phi / step - static_cast<double>(i);
    const double line = (1.0 - t) * out.b[i] + t * out.b[(i + 1) % n];
    if (input - line > worst) {
      worst = input - line;
      at = phi;
    }
  };
  for (const auto& event : g.root.events)
    for (const bool before : {true, false}) {
      const auto cutter = before ? event.from : event.to;
      const auto line = joint::generator_at(g.root.radius, event.phi);
      const auto side = before ? joint::Side::before : joint::Side::after;
      const auto hit = event.kind == joint::EventKind::kink
                           ? joint::hit_at_corner(g.root.cutters[cutter], line, side)
                           : joint::continued_hit(g.root.cutters[cutter], line);
      see(event.phi, point(g, event.phi, hit, cutter, before ? event.z_from : event.z_to).input);
    }
  for (const auto& event : g.other_events) {
    const auto contact = joint::contact_at(g.root, event.phi);
    const auto line = joint::generator_at(g.root.radius, event.phi);
    const auto hit = joint::continued_hit(g.root.cutters[contact.cutter], line);
    see(event.phi, point(g, event.phi, hit, contact.cutter, contact.z).input);
  }
  out.warnings.push_back({.code = WarningCode::events_between_nodes,
                          .member = "sampling/uniform_points",
                          .detail = "largest shortfall of B between nodes " +
                                    brief(worst * kDegPerRad) + " deg at phi " +
                                    brief(at * kDegPerRad) + " deg"});
}

void fill_angles(const joint::Samples& samples, const std::vector<Point>& points, double rho,
                 Table& out) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& [cutter, angles, raw, required, input, face] = points[i];
    out.phi.push_back(samples.nodes[i].phi);
    out.developed.push_back(rho * samples.nodes[i].phi);
    out.length.push_back(samples.nodes[i].length);
    out.cutter.push_back(cutter);
    out.dihedral.push_back(angles.dihedral);
    out.groove.push_back(angles.groove);
    out.tau.push_back(angles.tau);
    out.gamma.push_back(angles.gamma);
    out.flush.push_back(angles.flush);
    out.b_raw.push_back(raw);
    out.b_required.push_back(required);
  }
}

/// Height at which a cut of this slope just touches, at one node. A partner that is lost here at
/// its silhouette, all across the wall, does not hold the lower of the jump's two nodes.
double lift_at(const Ground& g, const std::vector<joint::Node>& nodes, std::size_t i,
               double slope) {
  const auto line = joint::generator_at(g.wall.inner, nodes[i].phi);
  const bool first = jump_pair(nodes, i);
  const auto pair = first ? i + 1 : i - 1;
  const bool lower =
      nodes[i].kind == joint::NodeKind::jump && pair < nodes.size() && nodes[i].z < nodes[pair].z;
  if (!lower) return lift(g.root.cutters, g.wall, line, slope);
  constexpr double kBeside = 1e-9;  // rad
  const double beside = nodes[i].phi + (first ? -kBeside : kBeside);
  const auto& lost = g.root.cutters[first ? nodes[pair].after : nodes[pair].before];
  for (const double rho : {g.wall.inner, g.wall.outer})
    if (joint::upper_sheet(lost, joint::generator_at(rho, beside)))
      return lift(g.root.cutters, g.wall, line, slope);
  auto others = g.root.cutters;
  others.erase(others.begin() + (&lost - g.root.cutters.data()));
  return lift(others, g.wall, line, slope);
}

/// Finished surface, root opening, metal in the beam and the torch's own line.
void fill_surfaces(const Ground& g, const joint::Samples& samples, const std::vector<Point>& points,
                   Table& out) {
  const double t = g.spec.target.wall, f = g.spec.root_face;
  const auto drop = kerf_drops(g.root, samples, out.b, out.gamma, g.spec.kerf);
  for (std::size_t i = 0; i < out.b.size(); ++i) {
    const double slope = (out.inward ? -1.0 : 1.0) * elementary::tan(out.b[i]);
    const bool outer = g.inner.has_value();
    const bool lifted = g.spec.contact == Contact::automatic;
    double z = samples.nodes[i].z;  // of the root surface
    if (lifted) z = std::max(z, lift_at(g, samples.nodes, i, slope));
    double foot = outer ? z - t * slope : z;  // where the bevel's line meets the inner wall
    out.z_inner.push_back(foot);
    if (f > 0.0) {
      out.b_face.push_back(points[i].face);
      out.z_face.push_back(z + f * elementary::tan(points[i].face));
      foot = out.z_face[i] - f * slope;
    }
    out.z_outer.push_back(outer ? z : foot + t * slope);
    out.gap.push_back(outer    ? out.z_inner[i] - joint::contact_at(*g.inner, out.phi[i]).z
                      : lifted ? z - samples.nodes[i].z
                               : 0.0);
    out.beam.push_back(t / elementary::cos(out.b[i]));
    out.torch_inner.push_back(foot - drop[i]);
    out.torch_outer.push_back(out.z_outer[i] - drop[i]);
  }
}

/// Contact outer: does the cut stay clear of every partner across the wall?
Result<void> check_clearance(const Ground& g, const joint::Samples& samples, const Table& out) {
  if (g.spec.contact != Contact::outer) return {};
  constexpr double kEnters = 1e-9;  // of the radius
  std::vector<double> depth;
  for (std::size_t i = 0; i < out.b.size(); ++i)
    depth.push_back(lift_at(g, samples.nodes, i, elementary::tan(out.b[i])) - out.z_inner[i]);
  auto intervals =
      runs(samples.nodes, [&](std::size_t i) { return depth[i] > kEnters * g.wall.outer; });
  if (intervals.empty()) return {};
  return fail({.code = ErrorCode::cut_enters,
               .member = "contact",
               .got = degrees(std::move(intervals)),
               .limit = 0.0,
               .unit = "deg",
               .hint = "by up to " + shown(*std::ranges::max_element(depth)) +
                       " mm along the axis; contact auto lifts the cut clear"});
}

/// The zone of every row; a dihedral the table does not have is an error.
Result<void> fill_zones(const TableSpec& spec, const joint::Samples& samples, Table& out) {
  const auto* zoned = std::get_if<ZonedGroove>(&spec.groove);
  if (zoned == nullptr) return {};
  const Zones zones(*zoned);
  for (const double dihedral : out.dihedral) out.zone.push_back(zones.at(dihedral).zone);
  auto missing =
      runs(samples.nodes, [&](std::size_t i) { return !zones.at(out.dihedral[i]).inside; });
  if (missing.empty()) return {};
  const auto [low, high] = std::ranges::minmax(out.dihedral);
  return fail({.code = ErrorCode::out_of_range,
               .member = "groove/zones",
               .got = degrees(std::move(missing)),
               .unit = "deg",
               .hint = "no zone for the dihedral there; this joint has " + shown(low * kDegPerRad) +
                       " to " + shown(high * kDegPerRad) + " deg"});
}

void note_root_opens(const TableSpec& spec, Table& out) {
  if (spec.contact != Contact::automatic && spec.contact != Contact::outer) return;
  constexpr double kOpen = 1e-3;  // mm
  const auto widest = std::ranges::max_element(out.gap);
  if (widest == out.gap.end() || *widest <= kOpen) return;
  const auto at = static_cast<std::size_t>(widest - out.gap.begin());
  out.warnings.push_back({.code = WarningCode::root_opens,
                          .member = "contact",
                          .detail = "by up to " + shown(*widest) + " mm, at phi " +
                                    shown(out.phi[at] * kDegPerRad) + " deg"});
}

/// Phases between rows where the cut, straight from row to row, would enter a partner by more
/// than `tolerance` normal to the cut: the contours of the walls do not tell where it curves.
std::vector<double> shortfalls(const Ground& g, const Table& t, double tolerance) {
  constexpr double kNarrow = 1e-4;  // mm, developed: no finer
  std::vector<double> out;
  for (std::size_t i = 0; i < t.phi.size(); ++i) {
    const auto j = (i + 1) % t.phi.size();
    const double step = t.phi[j] - t.phi[i] + (j == 0 ? kTwoPi : 0.0);
    const double along = g.wall.inner * step;
    if (along < kNarrow) continue;
    const double rise = t.z_inner[j] - t.z_inner[i];
    bool enters = false;
    for (const double u : {0.25, 0.5, 0.75}) {
      const double phi = t.phi[i] + u * step;
      const double low = t.z_inner[i] + u * rise;
      const double high = t.z_outer[i] + u * (t.z_outer[j] - t.z_outer[i]);
      const double needed = lift(g.root.cutters, g.wall, joint::generator_at(g.wall.inner, phi),
                                 (high - low) / g.spec.target.wall);
      enters = enters || (needed - low) * along > tolerance * elementary::hypot(along, rise);
    }
    for (const double u : {0.25, 0.5, 0.75})
      if (const double phi = t.phi[i] + u * step; enters)
        out.push_back(phi < kTwoPi ? phi : phi - kTwoPi);
  }
  return out;
}

/// The table with rows at the phases `also` besides those of the sampling.
Result<Table> build(const Ground& g, const std::vector<double>& also, const std::stop_token& stop) {
  const auto& spec = g.spec;
  const auto samples = joint::sample(g.root, spec.sampling, also, stop);
  if (!samples) return tl::unexpected(samples.error());

  std::vector<Point> points;
  points.reserve(samples->nodes.size());
  for (const auto& node : samples->nodes) {
    if (stop.stop_requested()) return fail({.code = ErrorCode::cancelled});
    points.push_back(larger(g, node));
  }
  if (auto ok = check_torch(g, *samples, points); !ok) return tl::unexpected(ok.error());

  Table out;
  out.inward = spec.dihedral != Dihedral::weld_side;
  out.inner_events = g.inner_contour().events;
  out.outer_events = g.inner ? g.root.events : g.other_events;
  out.length_total = samples->true_length;
  out.developed_total = samples->developed_length;
  out.warnings = joint::partner_warnings(g.root);
  fill_angles(*samples, points, g.root.radius, out);
  if (auto ok = fill_zones(spec, *samples, out); !ok) return tl::unexpected(ok.error());

  const auto p = path(g, *samples, points);
  for (const auto& m : mutations(p.profile.b, spec.mutation_limit.rad()))
    out.mutations.push_back({.phi = samples->nodes[p.node[m.index]].phi, .step = m.step});
  auto smoothed = smooth(g, *samples, p, out, stop);
  if (!smoothed) return tl::unexpected(smoothed.error());
  for (const auto entry : p.entry) out.b.push_back((*smoothed)[entry]);
  if (auto ok = check_smoothed(g, *samples, points, out); !ok) return tl::unexpected(ok.error());

  fill_surfaces(g, *samples, points, out);
  if (auto ok = check_clearance(g, *samples, out); !ok) return tl::unexpected(ok.error());
  for (const auto* z : {&out.z_inner, &out.z_outer})
    if (auto ok = joint::check_length(spec.target, *z); !ok) return tl::unexpected(ok.error());
  note_torch_binds(g, *samples, points, out);
  note_root_opens(spec, out);
  if (!spec.sampling.tolerance) note_events_between(g, out);
  return out;
}

}  // namespace

Result<std::vector<joint::Cutter>> grown_partners(const TableSpec& spec) {
  auto cutters = joint::resolve(spec.partners);
  const double by = spec.coating + spec.root_gap;
  if (!cutters || by == 0.0) return cutters;
  for (auto& cutter : *cutters) {
    if (auto* tube = std::get_if<joint::TubeCutter>(&cutter)) {
      tube->radius += by;
    } else if (auto* plane = std::get_if<joint::PlaneCutter>(&cutter)) {
      const double up = plane->normal.z() < 0.0 ? -1.0 : 1.0;
      plane->point += up * by * plane->normal.normalized();
    } else if (auto* box = std::get_if<joint::BoxCutter>(&cutter)) {
      box->width += 2.0 * by;
      box->height += 2.0 * by;
      box->corner += by;
    } else if (auto* cone = std::get_if<joint::ConeCutter>(&cutter)) {
      cone->radius += by / elementary::cos(cone->half_angle.rad());
    } else if (auto* elbow = std::get_if<joint::ElbowCutter>(&cutter)) {
      elbow->radius += by;
    }
  }
  return cutters;
}

Result<Table> table(const TableSpec& spec, const std::stop_token& stop) {
  constexpr int kRounds = 6;  // each divides a shortfall by sixteen where the cut is smooth
  const auto grounded = ground(spec);
  if (!grounded) return tl::unexpected(grounded.error());
  const auto& g = *grounded;
  std::vector<double> also;
  for (const auto& event : g.other_events) also.push_back(event.phi);
  auto out = build(g, also, stop);
  for (int round = 0; out && round < kRounds; ++round) {
    const auto more = swing_rows(spec, *out);
    if (more.empty()) break;
    also.insert(also.end(), more.begin(), more.end());
    out = build(g, also, stop);
  }
  const bool held = spec.contact == Contact::inner || spec.contact == Contact::automatic;
  if (!held || !spec.sampling.tolerance || spec.root_face > 0.0) return out;
  // On the inner wall the sampling itself uses the whole tolerance.
  const double share = spec.contact == Contact::inner ? 1.0 : 0.5;
  for (int round = 0; out && round < kRounds; ++round) {
    const auto more = shortfalls(g, *out, share * spec.sampling.tolerance->value);
    if (more.empty()) break;
    also.insert(also.end(), more.begin(), more.end());
    out = build(g, also, stop);
  }
  return out;
}

}  // namespace tubecut::bevel
