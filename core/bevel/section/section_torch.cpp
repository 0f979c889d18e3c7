#include "core/bevel/section/section_torch.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/bevel/beam/beam.hpp"
#include "core/bevel/section/section_beam.hpp"
#include "core/math/mixed.hpp"

namespace tubecut::bevel::detail {
namespace {

constexpr int kParts = 4;               // of a gap between rows
constexpr double kNear[] = {0.5, 1.0};  // of half a kerf, from a row
constexpr double kNearJump[] = {0.5, 0.95, 1.05, 1.4, 1.8, 2.4, 3.2, 4.2, 5.2};
constexpr double kBend = 1e-3;  // mm: a straighter need is not divided
constexpr int kDivisions = 3;   // of an interval, each into halves
constexpr double kStep =
    2e-3;                   // mm: an interval in which the need steps is divided to the shortest
constexpr int kSpared = 6;  // rounds of lowering rows that the beam enters
constexpr double kSampledShares[] = {0.0, 0.04, 0.1, 0.2, 0.35,
                                     0.5, 0.65, 0.8, 0.9, 0.96};  // shares of a gap
constexpr double kEntered = 1e-4;                                 // mm
constexpr double kShortest = 5e-4;   // mm along s: no shorter interval is divided
constexpr double kHighStep = 0.1;    // mm: a higher step of the need is found within kStepPlace
constexpr double kStepPlace = 1e-7;  // mm along s
constexpr double kStepWidth = 1e-3;  // mm along s in which the axis takes a step

/// The drop that a place between two rows needs.
struct Need {
  std::size_t row;
  double share, drop;
};

class Torch {
 public:
  Torch(const SectionSurface& surface, const TableSpec& spec, SectionTable& table)
      : surface_(surface), spec_(spec), table_(table), beside_seams_(table.at.size()) {
    const auto& wall = surface.wall();
    for (const double s : wall.outer().seams()) add_seam(s);
    for (const double s : wall.bore().seams()) add_seam(wall.outside_of(wall.bore().at(s)));
  }

  void lay() {
    const auto n = table_.at.size();
    drop_.assign(n, 0.0);
    if (spec_.kerf > 0.0) {
      for (std::size_t i = 0; i < n && !stopped(); ++i)
        drop_[i] = needed_drop(surface_, i, 0.0, spec_.kerf);
      std::vector<std::vector<Need>> all;
      for (std::size_t i = 0; i < n && !stopped(); ++i)
        if (surface_.width(i) > 0.0) all.push_back(needs(i));
      for (const auto& gap : all) lower(gap);
    }
    write();
    if (spec_.kerf > 0.0) spare();
  }

 private:
  /// Notes the places about an end of a flat or a corner that lies between rows: the rows of a bare
  /// grid do not stand there, and within half a kerf of it the need bends as it does at a row.
  void add_seam(double s) {
    const auto row = surface_.row_before(s);
    const double wide = surface_.width(row), from = s - table_.at[row].s;
    const double at = from < 0.0 ? from + table_.girth : from;
    if (!(at > kNarrow && wide - at > kNarrow)) return;
    for (const double off : {-1.0, -0.5, -0.1, 0.0, 0.1, 0.5, 1.0}) {
      const double share = (at + off * 0.5 * spec_.kerf) / wide;
      if (share > 0.0 && share < 1.0) beside_seams_[row].push_back(share);
    }
  }

  /// Returns true if a beam at this gap reaches a jump, where the need may step.
  [[nodiscard]] bool near_jump(std::size_t row) const {
    bool out = false;
    surface_.rows_near(row, surface_.beam_reach(spec_.kerf),
                       [&](std::size_t i) { out = out || !(surface_.width(i) > 0.0); });
    return out;
  }

  /// The needs of a gap by share, dense where they bend or step. The edges have corners at rows, so
  /// the need changes most within half a kerf of one.
  [[nodiscard]] std::vector<Need> needs(std::size_t row) const {
    const double wide = surface_.width(row), half = 0.5 * spec_.kerf;
    std::vector<double> shares = beside_seams_[row];
    shares.insert(shares.end(), {0.0, 1.0});
    for (int k = 1; k < kParts && wide > kShortest; ++k)
      shares.push_back(static_cast<double>(k) / kParts);
    const bool steps = near_jump(row);
    const std::span<const double> dense =
        steps ? std::span<const double>(kNearJump) : std::span<const double>(kNear);
    for (const double near : dense) {
      const double share = near * half / wide;
      if (share >= 1.0 || wide <= kShortest) break;
      shares.push_back(share);
      shares.push_back(1.0 - share);
    }
    std::ranges::sort(shares);
    std::vector<Need> out{at(row, shares.front())};
    for (std::size_t k = 1; k < shares.size(); ++k)
      divide(out.back(), at(row, shares[k]), kDivisions, out);
    return out;
  }

  /// Appends the needs after `from` up to `to`. Where a jump comes within the beam's reach the need
  /// steps by as much as the jump is high.
  void divide(Need from, Need to, int divisions, std::vector<Need>& out) const {
    const double wide = (to.share - from.share) * surface_.width(from.row);
    const bool steps = std::abs(to.drop - from.drop) > kHighStep && wide > kStepPlace;
    if (wide > kShortest || steps) {
      const auto middle = at(from.row, 0.5 * (from.share + to.share));
      const double bend = std::abs(middle.drop - 0.5 * (from.drop + to.drop));
      if (bend > (divisions > 0 ? kBend : kStep)) {
        divide(from, middle, divisions - 1, out);
        return divide(middle, to, divisions - 1, out);
      }
      out.push_back(middle);
    }
    out.push_back(to);
  }

  [[nodiscard]] Need at(std::size_t row, double share) const {
    return {row, share, needed_drop(surface_, row, share, spec_.kerf)};
  }

  [[nodiscard]] double laid(const Need& at) const {
    return math::mixed(drop_[at.row], drop_[surface_.next(at.row)], at.share);
  }

  /// If the need steps between two neighbours, the larger holds for both.
  void lower(const std::vector<Need>& gap) {
    for (const auto& need : gap) lower(need);
    for (std::size_t k = 1; k < gap.size(); ++k) {
      const auto &a = gap[k - 1], &b = gap[k];
      if (!((b.share - a.share) * surface_.width(a.row) <= kShortest)) continue;
      const double most = std::max(a.drop, b.drop);
      lower(Need{a.row, a.share, most});
      lower(Need{b.row, b.share, most});
    }
  }

  /// Lowers the nearer row most.
  void lower(const Need& at) {
    const double lacks = at.drop - laid(at);
    if (!(lacks > 0.0)) return;
    const double rest = 1.0 - at.share, both = rest * rest + at.share * at.share;
    drop_[at.row] += lacks * rest / both;
    drop_[surface_.next(at.row)] += lacks * at.share / both;
  }

  /// Writes the axis of every row.
  void write() {
    table_.torch_inner.clear();
    table_.torch_outer.clear();
    for (std::size_t i = 0; i < table_.at.size(); ++i) {
      table_.torch_inner.push_back(surface_.line(i, 0.0).foot - drop_[i]);
      table_.torch_outer.push_back(table_.z_outer[i] - drop_[i]);
    }
  }

  /// How deep the beam enters the part, mm; on a flat from the exact need there.
  [[nodiscard]] double entered_at(const SectionSurface::Line& line, const Need& here) const {
    if (!surface_.flat_around(line.at, 0.5 * spec_.kerf))
      return beam_depth(surface_, table_, here.row, here.share, spec_.kerf);
    const double lacks = needed_drop(surface_, here.row, here.share, spec_.kerf) - laid(here);
    return lacks / elementary::hypot(1.0, line.slope());
  }

  /// Lowers the rows where the beam, as a cylinder, still enters the part.
  void spare() {
    auto& out = table_.torch_line;
    for (int round = 0; round < kSpared; ++round) {
      out = {};
      std::vector<Need> entered;
      const auto look = [&](std::size_t row, double share) {
        if (share > 0.0 && !(surface_.width(row) > 0.0)) return;
        const auto line = surface_.line(row, share);
        const Need here{row, share, 0.0};
        const double depth = entered_at(line, here);
        if (depth > kEntered)
          entered.push_back(
              {row, share, laid(here) + depth * elementary::hypot(1.0, line.slope())});
        if (!(depth > out.gouge)) return;
        out.gouge = depth;
        out.gouge_s = line.at.s;
      };
      for (std::size_t i = 0; i < table_.at.size() && !stopped(); ++i) {
        for (const double share : kSampledShares) look(i, share);
        for (const double share : beside_seams_[i]) look(i, share);
      }
      if (entered.empty() || round + 1 == kSpared) return;
      for (const auto& need : entered) lower(need);
      write();
    }
  }

  const SectionSurface& surface_;
  const TableSpec& spec_;
  SectionTable& table_;
  std::vector<double> drop_;
  std::vector<std::vector<double>> beside_seams_;  // shares, by row
};

}  // namespace

std::vector<double> places_where_drop_bends(const SectionSurface& surface, const TableSpec& spec,
                                            const SectionTable& table) {
  std::vector<double> out, drop;
  const auto n = table.at.size();
  for (std::size_t i = 0; i < n && !stopped(); ++i)
    drop.push_back(needed_drop(surface, i, 0.0, spec.kerf));
  for (std::size_t i = 0; i < n && !stopped(); ++i) {
    if (surface.width(i) < kNarrow) continue;
    const double straight = 0.5 * (drop[i] + drop[surface.next(i)]);
    if (std::abs(needed_drop(surface, i, 0.5, spec.kerf) - straight) >
        spec.sampling.tolerance->value)
      out.push_back(surface.line(i, 0.5).at.s);
  }
  return out;
}

std::vector<double> places_of_steps(const SectionSurface& surface, const TableSpec& spec,
                                    const SectionTable& table) {
  std::vector<double> out;
  const double girth = table.girth, reach = surface.beam_reach(spec.kerf);
  const auto turned = [girth](double s) { return s - girth * std::floor(s / girth); };
  for (std::size_t i = 0; i < table.at.size() && !stopped(); ++i) {
    const double step = table.z_outer[surface.next(i)] - table.z_outer[i];
    if (surface.width(i) > kStepWidth || !(std::abs(step) > kHighStep)) continue;
    // Next to the higher row the axis runs past the step's own wall.
    const double way = step > 0.0 ? 1.0 : -1.0;
    const double from = table.at[step > 0.0 ? surface.next(i) : i].s;
    const auto passes = [&](double off) {
      const double s = turned(from + way * off);
      const auto row = surface.row_before(s);
      const double wide = surface.width(row), share = turned(s - table.at[row].s) / wide;
      return wide > 0.0 &&
             needed_drop(surface, row, std::min(share, 1.0), spec.kerf) > 0.5 * std::abs(step);
    };
    double near = 0.0, far = 1.01 * reach;
    if (passes(far)) continue;
    while (far - near > kStepPlace) {
      const double middle = 0.5 * (near + far);
      (passes(middle) ? near : far) = middle;
    }
    out.push_back(turned(from + way * near));
    out.push_back(turned(from + way * (near + kStepWidth)));
  }
  return out;
}

Result<void> lay_torch(const SectionSurface& surface, const TableSpec& spec, SectionTable& table) {
  Torch(surface, spec, table).lay();
  if (stopped()) return fail({.code = ErrorCode::cancelled});
  const auto& beam = table.torch_line;
  if (!(beam.gouge > 0.5 * kGougeLimit)) return {};
  return fail({.code = ErrorCode::out_of_range,
               .member = "kerf",
               .got = spec.kerf,
               .unit = "mm",
               .hint = "a beam as wide would take " + brief(beam.gouge) +
                       " mm from the finished part, at girth " + brief(beam.gouge_s) +
                       " mm: the cut bends tighter there than the kerf"});
}

}  // namespace tubecut::bevel::detail
