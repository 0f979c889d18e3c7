#include <cmath>

#include "core/base/elementary.hpp"
#include "core/bevel/table/table_parts.hpp"
#include "core/bevel/table/zone_gaps.hpp"
#include "core/math/mixed.hpp"

namespace tubecut::bevel::detail {
namespace {

/// Returns the height of the raised root at a phase.
double root_at(const TableSetup& g, double phi) {
  const auto line = joint::generator_at(g.root.radius, phi);
  return stood_at(g, line, joint::continued_hit(g.root.cutters.front(), line)).hit.z;
}

}  // namespace

const ZonedGroove* zones_with_gaps(const TableSpec& spec) {
  const auto* zoned = std::get_if<ZonedGroove>(&spec.groove);
  return zoned != nullptr && zoned->has_root_gaps() ? zoned : nullptr;
}

/// Zones with root gaps require a single partner, the root inside, and no other gap.
Result<void> check_gaps(const TableSpec& spec) {
  if (zones_with_gaps(spec) == nullptr) return {};
  const auto refused = [](std::string member, std::string hint) {
    return fail({.code = ErrorCode::unsupported_combination,
                 .member = std::move(member),
                 .hint = std::move(hint)});
  };
  if (spec.root_gap > 0.0)
    return refused("root_gap", "the groove's zones name the root gap: leave it out");
  if (spec.partners.size() != 1)
    return refused("groove/zones", "root gaps of zones go with an end that one partner cuts");
  if (spec.root_surface != RootSurface::inner || spec.dihedral != Dihedral::weld_side)
    return refused("root_surface", "root gaps of zones go with the root inside");
  if (spec.contact != Contact::inner && spec.contact != Contact::automatic)
    return refused("contact", "root gaps of zones go with contact inner or auto");
  const auto& stated = stated_joint(spec, 0);
  if (!stated) return {};
  if (stated->kind == joint::JointKind::mitre)
    return refused("groove/zones", "the two faces of a mitre have one gap all round");
  if (stated->gap > 0.0)
    return fail({.code = ErrorCode::joint_contradicts,
                 .member = "groove/zones",
                 .got = stated->gap,
                 .limit = 0.0,
                 .unit = "mm",
                 .hint = "the zones name the root gap; state the joint without a gap"});
  return {};
}

Stood stood_at(const TableSetup& g, const joint::Generator& line, const joint::Hit& least) {
  const auto at = [&](double more) {
    Stood out{more, grown_for(g, more), {}};
    out.hit = joint::continued_hit(out.partner, line);
    return out;
  };
  // The gap that the zone requests there beyond the smallest one.
  const double bottom = g.gaps->least_gap();
  const auto lacks = [&](const joint::Hit& hit, double more) {
    return g.gaps->at(g.rule.angles(hit.normal).dihedral).root_gap - bottom - more;
  };
  double low = 0.0, high = g.gaps->greatest_gap() - bottom;
  double at_low = lacks(least, 0.0);
  if (!(at_low > 0.0)) return {0.0, g.root.cutters.front(), least};
  auto out = at(high);
  double at_high = lacks(out.hit, high);
  constexpr int kSteps = 60;        // at worst by bisection
  constexpr double kThere = 1e-12;  // mm
  for (int k = 0; k < kSteps && at_high < -kThere && high - low > kThere; ++k) {
    const double chord = low + (high - low) * at_low / (at_low - at_high);
    const double middle = k % 3 == 2 ? 0.5 * (low + high) : chord;
    auto next = at(middle);
    const double value = lacks(next.hit, middle);
    if (value > 0.0) {
      low = middle;
      at_low = value;
      if (value <= kThere) return next;
    } else {
      high = middle;
      at_high = value;
      out = std::move(next);
    }
  }
  return out;
}

void measure_root(const TableSetup& g, Rows& rows) {
  constexpr int kPlaces = 4;
  auto& nodes = rows.samples.nodes;
  double length = 0.0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto j = (i + 1) % nodes.size();
    const double step = nodes[j].phi - nodes[i].phi + (j == 0 ? kTwoPi : 0.0);
    const double chord = 2.0 * g.root.radius * elementary::sin(0.5 * step / kPlaces);
    double z = nodes[i].z + rows.points[i].raised;
    nodes[i].length = length;
    for (int k = 1; k <= kPlaces; ++k) {
      const double next = k == kPlaces ? nodes[j].z + rows.points[j].raised
                                       : root_at(g, nodes[i].phi + step * k / kPlaces);
      length += elementary::hypot(chord, next - z);
      z = next;
    }
  }
  rows.samples.true_length = length;
}

joint::PreparedCutter grown_for(const TableSetup& g, double more) {
  // If a cutter can be prepared, a thicker one can be too.
  return joint::prepare(joint::grown(g.cutters.front(), more)).value();
}

std::vector<double> rows_where_gap_turns(const TableSetup& g, const Rows& rows) {
  std::vector<double> out;
  if (!g.gaps || !g.spec.sampling.tolerance) return out;
  constexpr double kNarrow = 1e-4;  // mm, developed: minimum
  const auto& nodes = rows.samples.nodes;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto j = (i + 1) % nodes.size();
    const double step = nodes[j].phi - nodes[i].phi + (j == 0 ? kTwoPi : 0.0);
    if (g.root.radius * step < kNarrow) continue;
    const double from = nodes[i].z + rows.points[i].raised;
    const double to = nodes[j].z + rows.points[j].raised;
    for (const double share : {0.25, 0.5, 0.75}) {
      const double phi = nodes[i].phi + share * step;
      if (std::abs(root_at(g, phi) - math::mixed(from, to, share)) <=
          g.spec.sampling.tolerance->value)
        continue;
      const double middle = nodes[i].phi + 0.5 * step;
      out.push_back(middle < kTwoPi ? middle : middle - kTwoPi);
      break;
    }
  }
  return out;
}

}  // namespace tubecut::bevel::detail

namespace tubecut::bevel {

std::vector<double> root_gaps(const TableSpec& spec, const Table& table) {
  std::vector<double> out;
  const auto* zoned = detail::zones_with_gaps(spec);
  if (zoned == nullptr) return out;
  const Zones zones(*zoned);
  for (const double dihedral : table.dihedral) out.push_back(zones.at(dihedral).root_gap);
  return out;
}

}  // namespace tubecut::bevel
