#include "core/part/place.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/bevel/table/table_columns.hpp"
#include "core/math/rotation.hpp"
#include "core/part/reversed_rows.hpp"

namespace tubecut::part {
namespace {

double other_way(double phi) { return phi == 0.0 ? 0.0 : kTwoPi - phi; }

std::size_t rows_at_zero(const std::vector<double>& phi) {
  return static_cast<std::size_t>(std::ranges::count(phi, 0.0));
}

/// Returns the phase after which a step comes in the reverse order: that of the next row.
double next_phi(const std::vector<double>& phi, double at) {
  const auto next = std::ranges::upper_bound(phi, at);
  return next == phi.end() ? phi.front() : *next;
}

void mirror_lists(const bevel::Table& in, bevel::Table& out) {
  for (const auto& m : in.mutations)
    out.mutations.push_back({other_way(next_phi(in.phi, m.phi)), m.step});
  std::ranges::stable_sort(out.mutations, {}, &bevel::Table::Step::phi);
  for (const auto& w : in.windows)
    out.windows.push_back({.phi = other_way(next_phi(in.phi, w.phi)),
                           .step = w.step,
                           .kept_before = !w.kept_before,
                           .from = other_way(w.to),
                           .to = other_way(w.from),
                           .slope_start = w.slope_end,
                           .slope_end = w.slope_start});
  for (const auto& b : in.torch_binds) {
    const double from = math::whole_turn(kTwoPi - b.to);
    out.torch_binds.push_back({from, from + (b.to - b.from), b.groove_lost, b.root_gap});
  }
  std::ranges::stable_sort(out.torch_binds, {}, &bevel::Table::Binding::from);
}

}  // namespace

bevel::Table seen_from_start(const bevel::Table& in, double length) {
  const auto zeros = rows_at_zero(in.phi);
  const auto order = reversed_rows(in.phi.size(), zeros);
  bevel::Table out;
  const double rho = in.developed_total / kTwoPi;
  for (const auto i : order) {
    out.phi.push_back(other_way(in.phi[i]));
    out.developed.push_back(rho * out.phi.back());
  }
  out.length = run_back(in.length, in.length_total, zeros, order);
  out.cutter = picked(in.cutter, order);
  out.zone = picked(in.zone, order);
  const auto mirror = [&](bevel::ColumnKind kind, const std::vector<double>& from,
                          std::vector<double>& to) {
    mirror_column(kind, from, order, length, to);
  };
  bevel::each_column(mirror, in, out);
  out.inner_events = in.inner_events;
  out.outer_events = in.outer_events;
  for (auto* events : {&out.inner_events, &out.outer_events})
    mirror_events(*events, length, &joint::Event::phi, other_way);
  mirror_lists(in, out);
  out.torch_line = in.torch_line;
  out.torch_line.gouge_phi = other_way(math::whole_turn(in.torch_line.gouge_phi));
  out.torch_line.left_phi = other_way(math::whole_turn(in.torch_line.left_phi));
  out.length_total = in.length_total;
  out.developed_total = in.developed_total;
  out.penetration = in.penetration;
  out.penetration.phi = other_way(in.penetration.phi);
  out.penetration.z = length - in.penetration.z;
  return out;
}

bevel::Table shifted(bevel::Table table, double dz) {
  const auto move = [dz](bevel::ColumnKind kind, std::vector<double>& column) {
    shift_column(kind, column, dz);
  };
  bevel::each_column(move, table);
  shift_places(table, dz);
  return table;
}

bevel::Hole shifted(bevel::Hole hole, double dz) {
  for (auto column :
       {&bevel::Hole::z, &bevel::Hole::z_inner, &bevel::Hole::torch_z, &bevel::Hole::torch_z_inner})
    for (auto& z : hole.*column) z += dz;
  return hole;
}

double clocking_between(const std::vector<joint::Partner>& start,
                        const std::vector<joint::Partner>& finish) {
  if (start.empty() || finish.empty()) return 0.0;
  const auto a = joint::bearing(start.front());
  const auto b = joint::bearing(finish.front());
  if (!a || !b) return 0.0;
  // The finish's own phi runs in reverse.
  const bool both = a->lean && b->lean;
  const double turn = both ? -*b->lean - *a->lean : -b->perpendicular - a->perpendicular;
  const double period = both ? kTwoPi : kPi;
  const double from = turn - period * std::floor(turn / period);
  return from > 0.5 * period ? from - period : from;
}

}  // namespace tubecut::part
