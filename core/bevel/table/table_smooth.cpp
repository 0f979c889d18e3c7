#include <algorithm>
#include <cmath>

#include "core/base/elementary.hpp"
#include "core/base/try.hpp"
#include "core/bevel/table/required.hpp"
#include "core/bevel/table/table_parts.hpp"

namespace tubecut::bevel::detail {
namespace {

/// The smoother's path: each phi once; along the true length both nodes of a jump stay.
struct ArcPath {
  AngleProfile profile;
  std::vector<std::size_t> entry;  // of each node
  std::vector<std::size_t> node;   // first node of each entry
};

ArcPath path(const TableSetup& g, const Rows& rows) {
  const auto& samples = rows.samples;
  const auto& points = rows.points;
  const auto* envelope = std::get_if<EnvelopeSmoothing>(&g.spec.smoothing);
  const bool along_length = envelope != nullptr && envelope->along == Along::length;
  ArcPath out;
  out.profile.period = along_length ? samples.true_length : samples.developed_length;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool second = i > 0 && rows.jump_pair(i - 1);
    const bool first = rows.jump_pair(i);
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

std::vector<std::size_t> junction_steps(const TableSetup& g, std::size_t n) {
  std::vector<std::size_t> out;
  for (const auto& event : g.root.events)
    out.push_back(
        std::min(n - 1, static_cast<std::size_t>(event.phi / kTwoPi * static_cast<double>(n))));
  return out;
}

Result<std::vector<double>> smooth_hermite(const TableSetup& g, const joint::Samples& samples,
                                           const ArcPath& p, const HermiteSmoothing& method,
                                           Table& out) {
  if (g.spec.sampling.tolerance)
    return fail({.code = ErrorCode::sampling_not_uniform,
                 .member = "sampling/tolerance",
                 .got = g.spec.sampling.tolerance->value,
                 .limit = "uniform_points alone",
                 .unit = "mm"});
  auto smoothed = hermite(p.profile, {.limit = g.spec.mutation_limit.rad(),
                                      .transition = method.transition_points,
                                      .junctions = junction_steps(g, p.profile.s.size())});
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

Result<std::vector<double>> smooth(const TableSetup& g, const joint::Samples& samples,
                                   const ArcPath& p, Table& out) {
  if (const auto* method = std::get_if<HermiteSmoothing>(&g.spec.smoothing))
    return smooth_hermite(g, samples, p, *method, out);
  if (const auto* method = std::get_if<EnvelopeSmoothing>(&g.spec.smoothing)) {
    TRY(auto smoothed, envelope(p.profile, envelope_of(g.spec, *method)));
    out.multipliers = std::move(smoothed.multipliers);
    return std::move(smoothed.b);
  }
  return p.profile.b;
}

/// If the smoothed B is beyond the torch, returns an error with its phases.
Result<void> check_smoothed_in_torch_range(const TableSetup& g, const Rows& rows,
                                           const std::vector<double>& b) {
  const auto& samples = rows.samples;
  const auto beyond = runs(samples.nodes, [&](std::size_t i) {
    return b[i] > g.spec.torch.max.rad() + kBelow || b[i] < g.spec.torch.min.rad() - kBelow;
  });
  if (!beyond.empty())
    return fail({.code = ErrorCode::torch_range,
                 .member = "torch/max",
                 .got = degrees(beyond),
                 .limit = g.spec.torch.max.deg(),
                 .unit = "deg",
                 .hint = "the smoothed bevel leaves the torch's range"});
  return {};
}

/// Checks whether the smoothing is below its input; only the published one may be.
Result<void> check_smoothed(const TableSetup& g, const Rows& rows, Table& out) {
  const auto& samples = rows.samples;
  const auto& points = rows.points;
  TRY(check_smoothed_in_torch_range(g, rows, out.b));
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
         .hint = "at these phi the smoothed bevel is too small to keep partners out of the wall"});
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

constexpr double kRowBend = 0.25;      // of K, at one row
constexpr double kMinSegment = 0.125;  // of K/A: shorter segments are not halved

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

Result<void> check_required_in_torch_range(const TableSetup& g, const Rows& rows) {
  const auto& samples = rows.samples;
  const auto& points = rows.points;
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

void note_torch_binds(const TableSetup& g, const Rows& rows, Table& out) {
  const auto& samples = rows.samples;
  const auto& points = rows.points;
  const bool lifted =
      g.spec.contact == Contact::automatic &&
      !std::holds_alternative<SquareCut>(g.spec.groove);  // else B is lifted nowhere
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

EnvelopeSpec envelope_of(const TableSpec& spec, const EnvelopeSmoothing& method) {
  return {.limits = method.limits, .highest = spec.torch.max.rad(), .refine = method.refine};
}

Result<void> fill_smoothed(const TableSetup& g, const Rows& rows, Table& out) {
  const auto p = path(g, rows);
  for (const auto& m : mutations(p.profile.b, g.spec.mutation_limit.rad()))
    out.mutations.push_back({.phi = rows.samples.nodes[p.node[m.index]].phi, .step = m.step});
  TRY(auto smoothed, smooth(g, rows.samples, p, out));
  for (const auto entry : p.entry) out.b.push_back(smoothed[entry]);
  return check_smoothed(g, rows, out);
}

std::vector<double> rows_where_b_turns(const TableSpec& spec, const Table& table) {
  const auto* envelope = std::get_if<EnvelopeSmoothing>(&spec.smoothing);
  if (envelope == nullptr || !spec.sampling.tolerance) return {};
  const double slope = envelope->limits.slope;
  const double narrow = kMinSegment * slope / envelope->limits.curvature;
  const auto all = segments(table, envelope->along == Along::length);
  std::vector<bool> halve(all.size(), false);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto j = (i + 1) % all.size();
    if (std::abs(all[j].slope - all[i].slope) <= kRowBend * slope) continue;
    halve[i] = halve[j] = true;
  }
  std::vector<double> out;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (halve[i] && all[i].divisible && all[i].length > 2.0 * narrow) out.push_back(all[i].middle);
  return out;
}

}  // namespace tubecut::bevel::detail
