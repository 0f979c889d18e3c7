#include "core/bevel/section/section_table.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/base/try.hpp"
#include "core/bevel/section/section_gaps.hpp"
#include "core/bevel/section/section_rows.hpp"
#include "core/bevel/section/section_surface.hpp"
#include "core/bevel/section/section_torch.hpp"
#include "core/bevel/table/required.hpp"
#include "core/bevel/table/root_opens.hpp"
#include "core/joint/section/section_intersection.hpp"

namespace tubecut::bevel {
namespace {

using detail::SectionRow;
using detail::SectionRows;
using detail::SectionSetup;

constexpr double kBelow = 1e-9 * kRadPerDeg;  // what counts as falling below, rad
constexpr double kRowBend = 0.25;             // of K, at one row
constexpr double kMinStretch = 0.125;         // of K/A: no shorter one is halved
constexpr int kSwingRounds = 6, kTorchRounds = 3, kPartnerRounds = 8;

/// Makes one table.
class Maker {
 public:
  explicit Maker(const SectionSetup& g)
      : g_(g), spec_(g.spec), girth_(g.wall.outer().girth()), surface_(g.wall, g.spec, out_) {}

  Result<SectionTable> make(std::vector<double> also) {
    TRY(make_rows(std::move(also)));
    const bool by_tolerance = spec_.sampling.tolerance.has_value();
    for (int round = 0; by_tolerance && round < kSwingRounds; ++round) {
      auto more = places_where_b_turns();
      if (more.empty()) break;
      TRY(make_rows(std::move(more)));
    }
    if (stopped()) return fail({.code = ErrorCode::cancelled});
    TRY(make_surface());
    for (int round = 0; by_tolerance && spec_.kerf > 0.0 && round < kTorchRounds; ++round) {
      auto more = detail::places_where_drop_bends(surface_, spec_, out_);
      if (round == 0)
        for (const double s : detail::places_of_steps(surface_, spec_, out_)) more.push_back(s);
      if (more.empty()) break;
      TRY(make_rows(std::move(more)));
      TRY(make_surface());
    }
    for (int round = 0; promises_no_penetration(spec_) && round < kPartnerRounds; ++round) {
      auto more = places_that_enter();
      if (more.empty()) break;
      TRY(make_rows(std::move(more)));
      TRY(make_surface());
    }
    if (stopped()) return fail({.code = ErrorCode::cancelled});
    note();
    TRY(detail::lay_torch(surface_, spec_, out_));
    return std::move(out_);
  }

 private:
  Result<void> make_rows(std::vector<double> more) {
    also_.insert(also_.end(), more.begin(), more.end());
    TRY(rows_, detail::section_rows(g_, also_));
    out_ = {};
    fill_angles();
    TRY(fill_zones());
    TRY(check_required());
    return smooth();
  }

  template <class F>
  [[nodiscard]] auto each(F value) const {
    std::vector<decltype(value(rows_.rows.front()))> out;
    out.reserve(rows_.rows.size());
    for (const auto& row : rows_.rows) out.push_back(value(row));
    return out;
  }

  void fill_angles() {
    using Row = const SectionRow&;
    const double share = g_.root().curve.girth() / girth_;
    out_.girth = girth_;
    out_.at = each([](Row r) { return r.at; });
    out_.wall = each([](Row r) { return r.across.wall; });
    out_.developed = each([&](Row r) { return r.at.s * share; });
    out_.length = each([](Row r) { return r.length; });
    out_.cutter = each([](Row r) { return r.cutter; });
    out_.dihedral = each([](Row r) { return r.point.angles.dihedral; });
    out_.groove = each([](Row r) { return r.point.angles.groove; });
    out_.gamma = each([](Row r) { return r.point.angles.gamma; });
    out_.flush = each([](Row r) { return r.point.angles.flush; });
    out_.b_raw = each([](Row r) { return r.point.raw; });
    out_.b_required = each([](Row r) { return r.point.required; });
    out_.corner = each([](Row r) { return r.corner; });
    out_.inner_events = g_.inner.events;
    out_.outer_events = g_.outer.events;
    out_.length_total = rows_.true_length;
    out_.developed_total = g_.root().curve.girth();
    out_.warnings = joint::partner_warnings(g_.root());
  }

  /// Runs of rows (cyclic) that satisfy `holds`, as intervals of s.
  template <class F>
  [[nodiscard]] Intervals runs(F holds) const {
    Intervals out;
    const auto n = out_.at.size();
    bool inside = false;
    for (std::size_t i = 0; i < n; ++i) {
      if (!holds(i)) {
        inside = false;
        continue;
      }
      if (!inside) out.emplace_back(out_.at[i].s, out_.at[i].s);
      out.back().second = out_.at[i].s;
      inside = true;
    }
    if (out.size() > 1 && holds(0) && holds(n - 1)) {
      out.back().second = out.front().second + girth_;
      out.erase(out.begin());
    }
    return out;
  }

  Result<void> fill_zones() {
    const auto* zoned = std::get_if<ZonedGroove>(&spec_.groove);
    if (zoned == nullptr) return {};
    const Zones zones(*zoned);
    for (const double dihedral : out_.dihedral) out_.zone.push_back(zones.at(dihedral).zone);
    auto missing = runs([&](std::size_t i) { return !zones.at(out_.dihedral[i]).inside; });
    if (missing.empty()) return {};
    const auto [low, high] = std::ranges::minmax(out_.dihedral);
    return fail(
        {.code = ErrorCode::out_of_range,
         .member = "groove/zones",
         .got = std::move(missing),
         .unit = "mm",
         .hint = "no zone for the dihedral at these places along the girth; this joint has " +
                 brief(low * kDegPerRad) + " to " + brief(high * kDegPerRad) + " deg"});
  }

  [[nodiscard]] double lift_at(std::size_t i, double slope) const {
    const auto& row = rows_.rows[i];
    auto view = detail::local_view(g_, row.at, row.across.wall);
    drop_lost(i, view);
    return lift(view.cutters, view.wall, view.inner, slope);
  }

  /// A partner that is lost here at its silhouette, all across the wall, does not hold the lower of
  /// the jump's two rows.
  void drop_lost(std::size_t i, detail::LocalView& view) const {
    const bool first = rows_.jump_pair(i);
    const auto pair = first ? i + 1 : i - 1;
    const bool lower =
        rows_.rows[i].jump && pair < rows_.rows.size() && rows_.rows[i].z < rows_.rows[pair].z;
    if (!lower) return;
    const auto lost = first ? rows_.rows[pair].after : rows_.rows[pair].before;
    const double beside = 1e-9 * girth_ * (first ? -1.0 : 1.0);
    const auto at = g_.wall.outer().at(rows_.rows[i].at.s + beside);
    for (const auto& place : {at.point, g_.wall.across(at).bore.point})
      if (joint::upper_sheet(g_.inner.cutters[lost], joint::generator_through(place))) return;
    view.cutters.erase(view.cutters.begin() + static_cast<std::ptrdiff_t>(lost));
  }

  Result<void> check_required() {
    if (spec_.contact != Contact::inner) return {};
    const double max = spec_.torch.max.rad();
    const auto beyond = [&](std::size_t i) {
      const auto& p = rows_.rows[i].point;
      return std::max(p.required, p.face) > max + kBelow;
    };
    auto intervals = runs(beyond);
    if (intervals.empty()) return {};
    const double slope = elementary::tan(max);
    double gap = 0.0;
    for (std::size_t i = 0; i < rows_.rows.size(); ++i)
      if (beyond(i)) gap = std::max(gap, lift_at(i, slope) - rows_.rows[i].bore_z);
    return fail({.code = ErrorCode::torch_range,
                 .member = "torch/max",
                 .got = std::move(intervals),
                 .limit = spec_.torch.max.deg(),
                 .unit = "mm",
                 .hint = "at these places along the girth a partner needs more than the torch's "
                         "range; contact auto would open the root by up to " +
                         brief(gap) + " mm"});
  }

  // ---- smoothing

  Result<void> smooth() {
    const auto* method = std::get_if<EnvelopeSmoothing>(&spec_.smoothing);
    const bool along_length = method != nullptr && method->along == Along::length;
    AngleProfile path{
        .s = {}, .b = {}, .period = along_length ? out_.length_total : out_.developed_total};
    std::vector<std::size_t> entry, first_row;
    const auto& rows = rows_.rows;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const bool second = i > 0 && rows_.jump_pair(i - 1), first = rows_.jump_pair(i);
      double input = rows[i].point.input;
      if (first) input = std::max(input, rows[i + 1].point.input);
      if (second) input = std::max(input, rows[i - 1].point.input);
      if (!second || along_length) {
        path.s.push_back(along_length ? out_.length[i] : out_.developed[i]);
        path.b.push_back(input);
        first_row.push_back(i);
      }
      entry.push_back(path.s.size() - 1);
    }
    for (const auto& m : mutations(path.b, spec_.mutation_limit.rad()))
      out_.mutations.push_back({.s = rows[first_row[m.index]].at.s, .step = m.step});
    auto smoothed = path.b;
    if (method != nullptr) {
      TRY(auto found, envelope(path, {.limits = method->limits,
                                      .highest = spec_.torch.max.rad(),
                                      .refine = method->refine}));
      smoothed = std::move(found.b);
      out_.multipliers = std::move(found.multipliers);
    }
    // Without smoothing each of a jump's two rows keeps its own side's.
    for (std::size_t i = 0; i < rows.size(); ++i)
      out_.b.push_back(method != nullptr ? smoothed[entry[i]] : rows[i].point.input);
    return {};
  }

  [[nodiscard]] double next_s(const std::vector<double>& s, std::size_t i, double period) const {
    return i + 1 < s.size() ? s[i + 1] : s.front() + period;
  }

  [[nodiscard]] double middle(std::size_t i) const {
    const double s = out_.at[i].s + 0.5 * surface_.width(i);
    return s < girth_ ? s : s - girth_;
  }

  [[nodiscard]] std::vector<double> places_where_b_turns() const {
    const auto* method = std::get_if<EnvelopeSmoothing>(&spec_.smoothing);
    if (method == nullptr) return {};
    const bool along_length = method->along == Along::length;
    const auto& s = along_length ? out_.length : out_.developed;
    const double period = along_length ? out_.length_total : out_.developed_total;
    const double narrow = kMinStretch * method->limits.slope / method->limits.curvature;
    const auto n = s.size();
    std::vector<double> length(n), slope(n, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
      length[i] = next_s(s, i, period) - s[i];
      if (length[i] > 0.0) slope[i] = (out_.b[(i + 1) % n] - out_.b[i]) / length[i];
    }
    std::vector<bool> halve(n, false);
    for (std::size_t i = 0; i < n; ++i) {
      const auto j = (i + 1) % n;
      if (std::abs(slope[j] - slope[i]) > kRowBend * method->limits.slope)
        halve[i] = halve[j] = true;
    }
    std::vector<double> out;
    for (std::size_t i = 0; i < n; ++i)
      if (halve[i] && length[i] > 2.0 * narrow && surface_.width(i) > detail::kNarrow)
        out.push_back(middle(i));
    return out;
  }

  // ---- the finished surface

  Result<void> make_surface() {
    const double f = spec_.root_face;
    const bool outer = g_.root_outside(), lifted = spec_.contact == Contact::automatic;
    for (auto* column :
         {&out_.z_inner, &out_.z_outer, &out_.z_face, &out_.b_face, &out_.gap, &out_.beam})
      column->clear();
    for (std::size_t i = 0; i < rows_.rows.size(); ++i) {
      const auto& row = rows_.rows[i];
      const double t = row.across.wall, slope = elementary::tan(out_.b[i]);
      double z = row.z;  // of the root
      if (lifted) z = std::max(z, lift_at(i, slope));
      double foot = outer ? z - t * slope : z;  // where the bevel's line meets the bore
      out_.z_inner.push_back(foot);
      if (f > 0.0) {
        out_.b_face.push_back(row.point.face);
        out_.z_face.push_back(z + f * elementary::tan(row.point.face));
        foot = out_.z_face[i] - f * slope;
      }
      out_.z_outer.push_back(outer ? z : foot + t * slope);
      out_.gap.push_back(outer ? out_.z_inner[i] - row.bore_z : lifted ? z - row.z : 0.0);
      out_.beam.push_back(t / elementary::cos(out_.b[i]));
    }
    TRY(check_clearance());
    for (const auto* z : {&out_.z_inner, &out_.z_outer}) TRY(joint::check_length(spec_.target, *z));
    return {};
  }

  Result<void> check_clearance() const {
    if (spec_.contact != Contact::outer) return {};
    std::vector<double> depth;
    for (std::size_t i = 0; i < out_.b.size(); ++i)
      depth.push_back(lift_at(i, elementary::tan(out_.b[i])) - out_.z_inner[i]);
    auto intervals = runs([&](std::size_t i) { return depth[i] > 1e-9 * g_.wall.outer().reach(); });
    if (intervals.empty()) return {};
    return fail({.code = ErrorCode::cut_enters,
                 .member = "contact",
                 .got = std::move(intervals),
                 .limit = 0.0,
                 .unit = "mm",
                 .hint = "at these places along the girth by up to " +
                         brief(*std::ranges::max_element(depth)) +
                         " mm along the axis; contact auto lifts the cut clear"});
  }

  [[nodiscard]] std::vector<double> places_that_enter() const {
    std::vector<double> out;
    for (std::size_t i = 0; i < out_.at.size(); ++i) {
      const double wide = surface_.width(i);
      if (wide < detail::kNarrow) continue;
      if (deepest_in_gap(surface_, i, g_.solids).depth <= spec_.sampling.tolerance->value) continue;
      for (const double share : {0.25, 0.5, 0.75}) {
        const double s = out_.at[i].s + share * wide;
        out.push_back(s < girth_ ? s : s - girth_);
      }
    }
    return out;
  }

  // ---- figures and warnings

  void note() {
    const auto open = detail::root_openings(g_, surface_, out_);
    note_torch_binds(open);
    detail::note_overhang(g_, out_);
    for (std::size_t i = 0; i < out_.at.size(); ++i) {
      const auto in = deepest_in_gap(surface_, i, g_.solids);
      if (i == 0 || in.depth > out_.penetration.depth) out_.penetration = in;
    }
    out_.penetration.depth = std::max(0.0, out_.penetration.depth);
    if (!promises_no_penetration(spec_) && out_.penetration.depth > penetration_limit(spec_))
      out_.warnings.push_back({.code = WarningCode::enters_partner,
                               .member = "sampling",
                               .detail = "by up to " + brief(out_.penetration.depth) +
                                         " mm at girth " + brief(out_.penetration.s) + " mm"});
    const auto place = [&](std::size_t i) { return "girth " + brief(out_.at[i].s) + " mm"; };
    if (auto opens = root_opens(spec_, open, place)) out_.warnings.push_back(*std::move(opens));
    if (!spec_.sampling.tolerance && !(out_.inner_events.empty() && out_.outer_events.empty()))
      out_.warnings.push_back({.code = WarningCode::events_between_nodes,
                               .member = "sampling/uniform_points",
                               .detail = "events and the ends of flats lie between the rows"});
  }

  void note_torch_binds(const std::vector<double>& open) {
    const bool lifted =
        spec_.contact == Contact::automatic && !std::holds_alternative<SquareCut>(spec_.groove);
    const auto lost = [&](std::size_t i) {
      const auto& p = rows_.rows[i].point;
      const double rule = std::abs(p.angles.b - p.raw);
      return lifted ? std::max(rule, p.required - spec_.torch.max.rad()) : rule;
    };
    for (const auto& [from, to] : runs([&](std::size_t i) { return lost(i) > kBelow; })) {
      SectionTable::Binding one{.from = from, .to = to, .groove_lost = 0.0, .root_gap = 0.0};
      for (std::size_t i = 0; i < out_.at.size(); ++i) {
        const double s = out_.at[i].s;
        if (!((s >= from && s <= to) || s + girth_ <= to)) continue;
        one.groove_lost = std::max(one.groove_lost, lost(i));
        one.root_gap = std::max(one.root_gap, open[i]);
      }
      out_.torch_binds.push_back(one);
      out_.warnings.push_back(
          {.code = WarningCode::torch_range_binds,
           .member = "torch",
           .detail = "girth " + brief(from) + " to " + brief(to) + " mm, up to " +
                     brief(one.groove_lost * kDegPerRad) + " deg of groove lost" +
                     (lifted ? ", root open up to " + brief(one.root_gap) + " mm" : "")});
    }
  }

  const SectionSetup& g_;
  const TableSpec& spec_;
  double girth_;
  SectionTable out_;
  SectionSurface surface_;
  SectionRows rows_;
  std::vector<double> also_;
};

}  // namespace

Result<SectionTable> section_table(const section::Section& section, const TableSpec& spec) {
  TRY(const auto g, detail::set_up(section, spec));
  TRY(auto out, Maker(g).make({}));
  if (!spec.untilted) return out;
  const auto bevelled = detail::flush_spec(spec);
  TRY(const auto other, detail::set_up(section, bevelled));
  std::vector<double> places;
  for (const auto& at : out.at) places.push_back(at.s);
  TRY(const auto flush, Maker(other).make(std::move(places)));
  out.gaps.square = detail::edge_gaps(g, spec, out, out);
  out.gaps.bevelled = detail::edge_gaps(g, bevelled, flush, out);
  return out;
}

}  // namespace tubecut::bevel
