#include "core/bevel/table/zones.hpp"

#include <algorithm>

namespace tubecut::bevel {
namespace {

constexpr double kRound = 1e-12;  // rad: a dihedral of 180 deg through an arc tangent

std::vector<std::size_t> ascending(const ZonedGroove& table) {
  std::vector<std::size_t> order(table.zones.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
    return table.zones[a].dihedral_from < table.zones[b].dihedral_from;
  });
  return order;
}

}  // namespace

Zones::Zones(const ZonedGroove& table) {
  for (const auto i : ascending(table)) {
    const auto& zone = table.zones[i];
    rows_.push_back({zone.dihedral_from.rad(), zone.dihedral_to.rad(), zone.groove_from.rad(),
                     zone.groove_to.rad(), zone.root_gap.value_or(0.0), i, 0.0, 0.0});
  }
  for (std::size_t i = 0; i + 1 < rows_.size(); ++i) {
    rows_[i].band_from = rows_[i + 1].from - table.overlap.rad() / 2.0;
    rows_[i].band_to = rows_[i].to + table.overlap.rad() / 2.0;
  }
}

Zones::At Zones::at(double dihedral) const {
  if (rows_.empty()) return {};
  const auto held = [&](const Row& row) {
    const double share = std::clamp((dihedral - row.from) / (row.to - row.from), 0.0, 1.0);
    return row.groove_from + share * (row.groove_to - row.groove_from);
  };
  const bool inside =
      dihedral >= rows_.front().from - kRound && dihedral <= rows_.back().to + kRound;
  std::size_t k = 0;
  while (k + 1 < rows_.size() && dihedral >= rows_[k].band_to) ++k;
  const auto& row = rows_[k];
  if (k + 1 == rows_.size() || dihedral < row.band_from)
    return {held(row), row.root_gap, row.index, inside};
  const double share = (dihedral - row.band_from) / (row.band_to - row.band_from);
  const auto& next = rows_[k + 1];
  return {(1.0 - share) * held(row) + share * held(next),
          (1.0 - share) * row.root_gap + share * next.root_gap,
          share < 0.5 ? row.index : next.index, inside};
}

double Zones::least_gap() const {
  return rows_.empty() ? 0.0 : std::ranges::min(rows_, {}, &Row::root_gap).root_gap;
}
double Zones::greatest_gap() const {
  return rows_.empty() ? 0.0 : std::ranges::max(rows_, {}, &Row::root_gap).root_gap;
}

namespace {

/// Checks that all zones have a root gap or none has, and that it changes over a band from one to
/// the next.
Result<void> check_root_gaps(const ZonedGroove& table, const std::vector<std::size_t>& order) {
  const auto bad = [&](ErrorCode code, std::size_t i, std::string hint) {
    return fail({.code = code,
                 .member = "zones/" + std::to_string(i) +
                           (table.zones[i].root_gap ? "/root_gap" : ""),  // or the zone lacks it
                 .hint = std::move(hint)});
  };
  for (std::size_t k = 0; k < order.size(); ++k) {
    const auto& zone = table.zones[order[k]];
    const auto& first = table.zones.front();
    if (zone.root_gap.has_value() != first.root_gap.has_value())
      return bad(ErrorCode::unsupported_combination, order[k],
                 "give every zone a root gap, or omit it in all zones; without it the joint's own "
                 "applies");
    if (k == 0 || !zone.root_gap) continue;
    const auto& last = table.zones[order[k - 1]];
    const Angle band = last.dihedral_to - zone.dihedral_from + table.overlap;
    if (*zone.root_gap != *last.root_gap && band < kLeastGapBand)
      return bad(ErrorCode::out_of_range, order[k],
                 "the root would step from " + brief(*last.root_gap) + " to " +
                     brief(*zone.root_gap) + " mm: let zones " + last.id + " and " + zone.id +
                     " overlap by " + brief(kLeastGapBand.deg()) + " deg or more");
  }
  return {};
}

}  // namespace

Result<void> check_zones(const ZonedGroove& table) {
  if (table.zones.empty()) return fail({.code = ErrorCode::wrong_count, .member = "zones"});
  const auto bad = [](std::size_t i, std::string hint) {
    return fail({.code = ErrorCode::out_of_range,
                 .member = "zones/" + std::to_string(i) + "/dihedral",
                 .hint = std::move(hint)});
  };
  const auto order = ascending(table);
  double band_to = -1.0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const auto& zone = table.zones[order[k]];
    if (!(zone.dihedral_from < zone.dihedral_to)) return bad(order[k], "from less to greater");
    if (k == 0) continue;
    const auto& last = table.zones[order[k - 1]];
    if (zone.dihedral_from > last.dihedral_to)
      return bad(order[k], "a gap lies between this zone and " + last.id);
    const double from = zone.dihedral_from.rad() - table.overlap.rad() / 2.0;
    if (from < band_to)
      return bad(order[k], "its transition meets that of " + last.id + " and the zone before");
    band_to = last.dihedral_to.rad() + table.overlap.rad() / 2.0;
    if (zone.dihedral_to.rad() < band_to) return bad(order[k], "it ends within its own transition");
  }
  return check_root_gaps(table, order);
}

}  // namespace tubecut::bevel
