#include "core/part/place.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/bevel/table/table_columns.hpp"
#include "core/math/rotation.hpp"
#include "core/part/edge.hpp"

namespace tubecut::part {
namespace {

double other_way(double phi) { return phi == 0.0 ? 0.0 : kTwoPi - phi; }

/// Returns the rows in the order of descending phi, those at phi = 0 first.
std::vector<std::size_t> reversed(const std::vector<double>& phi) {
  const auto zeros = static_cast<std::size_t>(std::ranges::count(phi, 0.0));
  std::vector<std::size_t> out;
  for (std::size_t i = zeros; i-- > 0;) out.push_back(i);
  for (std::size_t i = phi.size(); i-- > zeros;) out.push_back(i);
  return out;
}

template <class T>
std::vector<T> picked(const std::vector<T>& column, const std::vector<std::size_t>& order) {
  std::vector<T> out;
  if (column.empty()) return out;
  out.reserve(order.size());
  for (const auto i : order) out.push_back(column[i]);
  return out;
}

std::vector<double> mirrored(const std::vector<double>& column,
                             const std::vector<std::size_t>& order, double about = 0.0) {
  auto out = picked(column, order);
  for (auto& v : out) v = about - v;
  return out;
}

std::vector<joint::Event> mirrored(std::vector<joint::Event> events, double length) {
  for (auto& e : events) {
    e.phi = other_way(e.phi);
    std::swap(e.from, e.to);
    std::swap(e.z_from, e.z_to);
    e.z_from = length - e.z_from;
    e.z_to = length - e.z_to;
  }
  std::ranges::stable_sort(events, {}, &joint::Event::phi);
  return events;
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
  const auto order = reversed(in.phi);
  bevel::Table out;
  const double rho = in.developed_total / kTwoPi;
  const auto zeros = static_cast<std::size_t>(std::ranges::count(in.phi, 0.0));
  for (std::size_t k = 0; k < order.size(); ++k) {
    const auto i = order[k];
    out.phi.push_back(other_way(in.phi[i]));
    out.developed.push_back(rho * out.phi.back());
    out.length.push_back(k < zeros ? in.length[zeros - 1] - in.length[i]
                                   : in.length_total + (zeros > 0 ? in.length[zeros - 1] : 0.0) -
                                         in.length[i]);
  }
  out.cutter = picked(in.cutter, order);
  out.zone = picked(in.zone, order);
  const auto mirror = [&](bevel::ColumnKind kind, const std::vector<double>& from,
                          std::vector<double>& to) {
    using enum bevel::ColumnKind;
    if (kind == height) to = mirrored(from, order, length);
    if (kind == elevation || kind == rate) to = mirrored(from, order);
    if (kind == plain) to = picked(from, order);
  };
  bevel::each_column(mirror, in, out);
  out.inner_events = mirrored(in.inner_events, length);
  out.outer_events = mirrored(in.outer_events, length);
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

double lowest(const bevel::Table& t) {
  return std::min(std::ranges::min(t.z_inner), std::ranges::min(t.z_outer));
}
double highest(const bevel::Table& t) {
  return std::max(std::ranges::max(t.z_inner), std::ranges::max(t.z_outer));
}

bevel::Table shifted(bevel::Table table, double dz) {
  const auto move = [dz](bevel::ColumnKind kind, std::vector<double>& column) {
    if (kind != bevel::ColumnKind::height) return;
    for (auto& z : column) z += dz;
  };
  bevel::each_column(move, table);
  for (auto* events : {&table.inner_events, &table.outer_events})
    for (auto& e : *events) {
      e.z_from += dz;
      e.z_to += dz;
    }
  table.penetration.z += dz;
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
