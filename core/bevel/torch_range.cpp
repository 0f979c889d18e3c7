#include <algorithm>
#include <cmath>

#include "core/base/elementary.hpp"
#include "core/bevel/required.hpp"
#include "core/bevel/table_parts.hpp"

// The torch's range in a bevel table: refused where the cut must not be opened, refused after
// smoothing, and noted where the groove or the root gives way.
namespace tubecut::bevel::detail {

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

void note_torch_binds(const TableSetup& g, const Rows& rows, Table& out) {
  const auto& samples = rows.samples;
  const auto& points = rows.points;
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

}  // namespace tubecut::bevel::detail
