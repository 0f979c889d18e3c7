#include "core/bevel/table/gap_map.hpp"

#include <algorithm>
#include <limits>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/bevel/table/table_parts.hpp"
#include "core/joint/solid.hpp"
#include "core/math/mixed.hpp"

namespace tubecut::bevel {
namespace {

constexpr double kSamePhase = 1e-9;  // rad

/// The heights of a table at a phase that is a row of it, or between two. If two rows have this
/// phase, the one before the jump, or after it if `after` is set.
class Heights {
 public:
  explicit Heights(const Table& table) : table_(table) {}

  struct At {
    double inner, outer;
  };
  [[nodiscard]] At at(double phi, bool after) const {
    const auto& p = table_.phi;
    const auto n = p.size();
    const auto from = index(std::ranges::lower_bound(p, phi - kSamePhase));
    const auto to = index(std::ranges::upper_bound(p, phi + kSamePhase));
    if (from < to) return row(after ? to - 1 : from);
    const auto low = (from + n - 1) % n, high = from % n;
    const double start = p[low] - (from == 0 ? kTwoPi : 0.0);
    const double end = p[high] + (from == n ? kTwoPi : 0.0);
    const double t = (phi - start) / (end - start);
    const auto a = row(low), b = row(high);
    return {math::mixed(a.inner, b.inner, t), math::mixed(a.outer, b.outer, t)};
  }

 private:
  [[nodiscard]] std::size_t index(std::vector<double>::const_iterator at) const {
    return static_cast<std::size_t>(at - table_.phi.begin());
  }
  [[nodiscard]] At row(std::size_t i) const { return {table_.z_inner[i], table_.z_outer[i]}; }

  const Table& table_;
};

double nearest(const std::vector<joint::Solid>& solids, const Eigen::Vector3d& point) {
  double out = std::numeric_limits<double>::infinity();
  for (const auto& solid : solids) out = std::min(out, solid.distance(point));
  return out;
}

}  // namespace

GreatestGap greatest(const EdgeGaps& gaps) {
  GreatestGap out{.gap = -std::numeric_limits<double>::infinity()};
  for (const bool outer : {false, true}) {
    const auto& column = outer ? gaps.outer : gaps.inner;
    const auto most = std::ranges::max_element(column);
    if (most == column.end() || *most <= out.gap) continue;
    out = {*most, static_cast<std::size_t>(most - column.begin()), outer};
  }
  return out;
}

namespace detail {

TableSpec flush_of(const TableSpec& spec) {
  auto out = spec;
  out.untilted = false;
  out.groove = NoGroove{};
  out.contact = Contact::automatic;
  out.root_surface = RootSurface::inner;
  out.dihedral = Dihedral::weld_side;
  out.kerf = 0.0;
  out.smoothing = NoSmoothing{};
  out.sampling.max_nodes *= 2;  // its own rows are added to those of the square cut
  return out;
}

GapMap gap_map(const TableSetup& g, const Table& cut, const Table& flush) {
  GapMap out;
  const Heights bevel(flush);
  const auto see = [&](double phi, double inner, double outer, EdgeGaps& to) {
    const auto turn = elementary::sincos(phi);
    const auto at = [&](double radius, double z) {
      return nearest(g.solids, {radius * turn.cos, radius * turn.sin, z});
    };
    to.inner.push_back(at(g.wall.inner, inner));
    to.outer.push_back(at(g.wall.outer, outer));
  };
  for (std::size_t i = 0; i < cut.phi.size() && !stopped(); ++i) {
    const bool second = i > 0 && cut.phi[i - 1] == cut.phi[i];
    const auto other = bevel.at(cut.phi[i], second);
    see(cut.phi[i], cut.z_inner[i], cut.z_outer[i], out.square);
    see(cut.phi[i], other.inner, other.outer, out.bevelled);
  }
  return out;
}

}  // namespace detail
}  // namespace tubecut::bevel
