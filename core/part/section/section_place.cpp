#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/angle.hpp"
#include "core/bevel/section/section_columns.hpp"
#include "core/part/reversed_rows.hpp"
#include "core/part/section/section_part.hpp"

namespace tubecut::part {
namespace {

constexpr double kSame = 1e-9;  // mm: a place at a seam, but for rounding

/// Places of an outline, counted from the other end.
class OtherWay {
 public:
  explicit OtherWay(const section::Curve& curve) : curve_(curve) {}

  /// A place at a seam stays there, because its row belongs to it.
  double operator()(double s) const {
    const double girth = curve_.girth();
    double at = girth - s;
    if (at >= girth - kSame) return 0.0;
    for (const double seam : curve_.seams())
      if (std::abs(seam - at) < kSame) at = seam;
    return at;
  }

 private:
  const section::Curve& curve_;
};

/// Returns the place after which a step comes in the reverse order: that of the next row.
double next_place(const bevel::SectionTable& t, double s) {
  const auto next = std::ranges::upper_bound(t.at, s, {}, &section::Station::s);
  return next == t.at.end() ? t.at.front().s : next->s;
}

void mirror_lists(const bevel::SectionTable& in, const OtherWay& other_way,
                  bevel::SectionTable& out) {
  for (const auto& m : in.mutations)
    out.mutations.push_back({other_way(next_place(in, m.s)), m.step});
  std::ranges::stable_sort(out.mutations, {}, &bevel::SectionTable::Step::s);
  for (const auto& b : in.torch_binds) {
    double from = other_way(b.to > in.girth ? b.to - in.girth : b.to);
    out.torch_binds.push_back({from, from + (b.to - b.from), b.groove_lost, b.root_gap});
  }
  std::ranges::stable_sort(out.torch_binds, {}, &bevel::SectionTable::Binding::from);
}

/// Returns how many rows lie on the datum line; one just before it, by rounding, is the first row.
std::size_t rows_at_datum(const bevel::SectionTable& t) {
  std::size_t out = 0;
  while (out < t.at.size() && (t.at[out].s < kSame || t.at[out].s > t.girth - kSame)) ++out;
  return out;
}

}  // namespace

bevel::SectionTable seen_from_start(const section::Wall& wall, const bevel::SectionTable& in,
                                    double length) {
  const OtherWay other_way(wall.outer()), on_bore(wall.bore());
  const auto zeros = rows_at_datum(in);
  const auto order = reversed_rows(in.at.size(), zeros);
  bevel::SectionTable out;
  for (const auto i : order) out.at.push_back(wall.outer().at(other_way(in.at[i].s)));
  out.developed = run_back(in.developed, in.developed_total, zeros, order);
  out.length = run_back(in.length, in.length_total, zeros, order);
  out.cutter = picked(in.cutter, order);
  out.zone = picked(in.zone, order);
  out.corner = picked(in.corner, order);
  const auto mirror = [&](bevel::ColumnKind kind, const std::vector<double>& from,
                          std::vector<double>& to) {
    mirror_column(kind, from, order, length, to);
  };
  bevel::each_section_column(mirror, in, out);
  out.inner_events = in.inner_events;
  out.outer_events = in.outer_events;
  mirror_events(out.inner_events, length, &joint::SectionEvent::s, on_bore);
  mirror_events(out.outer_events, length, &joint::SectionEvent::s, other_way);
  mirror_lists(in, other_way, out);
  out.length_total = in.length_total;
  out.developed_total = in.developed_total;
  out.girth = in.girth;
  out.penetration = in.penetration;
  out.penetration.s = other_way(in.penetration.s);
  out.penetration.z = length - in.penetration.z;
  out.torch_line = in.torch_line;
  out.torch_line.gouge_s = other_way(in.torch_line.gouge_s);
  return out;
}

bevel::SectionTable shifted(bevel::SectionTable table, double dz) {
  const auto move = [dz](bevel::ColumnKind kind, std::vector<double>& column) {
    shift_column(kind, column, dz);
  };
  bevel::each_section_column(move, table);
  shift_places(table, dz);
  return table;
}

Edge edge_over_girth(const bevel::SectionTable& t, const std::vector<double>& z) {
  Edge out{{}, z};
  for (const auto& at : t.at) out.phi.push_back(at.s / t.girth * kTwoPi);
  // The first row may lie just before the datum line, by rounding.
  if (out.phi.size() > 1 && out.phi.front() > out.phi[1]) out.phi.front() = 0.0;
  return out;
}

}  // namespace tubecut::part
