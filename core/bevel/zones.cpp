#include "core/bevel/zones.hpp"

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
                     zone.groove_to.rad(), i, 0.0, 0.0});
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
  if (k + 1 == rows_.size() || dihedral < row.band_from) return {held(row), row.index, inside};
  const double share = (dihedral - row.band_from) / (row.band_to - row.band_from);
  const auto& next = rows_[k + 1];
  return {(1.0 - share) * held(row) + share * held(next), share < 0.5 ? row.index : next.index,
          inside};
}

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
  return {};
}

}  // namespace tubecut::bevel
