#include <algorithm>

#include "core/base/try.hpp"
#include "core/bevel/table_parts.hpp"

namespace tubecut::bevel::detail {
namespace {

/// The smoother's path: each phi once; along the true length both nodes of a jump stay.
struct Path {
  AngleProfile profile;
  std::vector<std::size_t> entry;  // of each node
  std::vector<std::size_t> node;   // first node of each entry
};

Path path(const TableSetup& g, const Rows& rows) {
  const auto& samples = rows.samples;
  const auto& points = rows.points;
  const auto* envelope = std::get_if<EnvelopeSmoothing>(&g.spec.smoothing);
  const bool along_length = envelope != nullptr && envelope->along == Along::length;
  Path out;
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

Result<std::vector<double>> smooth(const TableSetup& g, const joint::Samples& samples,
                                   const Path& p, Table& out, const std::stop_token& stop) {
  if (const auto* method = std::get_if<HermiteSmoothing>(&g.spec.smoothing))
    return smooth_hermite(g, samples, p, *method, out, stop);
  if (const auto* method = std::get_if<EnvelopeSmoothing>(&g.spec.smoothing)) {
    TRY(auto smoothed, envelope(p.profile, envelope_of(g.spec, *method), stop));
    out.multipliers = std::move(smoothed.multipliers);
    return std::move(smoothed.b);
  }
  return p.profile.b;
}

/// What the smoothing left below what it was given. Only the published one may.
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

}  // namespace

EnvelopeSpec envelope_of(const TableSpec& spec, const EnvelopeSmoothing& method) {
  return {.limits = method.limits, .highest = spec.torch.max.rad(), .refine = method.refine};
}

Result<void> fill_smoothed(const TableSetup& g, const Rows& rows, Table& out,
                           const std::stop_token& stop) {
  const auto p = path(g, rows);
  for (const auto& m : mutations(p.profile.b, g.spec.mutation_limit.rad()))
    out.mutations.push_back({.phi = rows.samples.nodes[p.node[m.index]].phi, .step = m.step});
  TRY(auto smoothed, smooth(g, rows.samples, p, out, stop));
  for (const auto entry : p.entry) out.b.push_back((smoothed)[entry]);
  return check_smoothed(g, rows, out);
}
}  // namespace tubecut::bevel::detail
