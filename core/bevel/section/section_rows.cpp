#include "core/bevel/section/section_rows.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/angle.hpp"
#include "core/base/try.hpp"
#include "core/bevel/beam/torch_line.hpp"
#include "core/bevel/table/required.hpp"
#include "core/bevel/table/stated.hpp"
#include "core/joint/section/section_length.hpp"

namespace tubecut::bevel::detail {
namespace {

using section::Station;

constexpr double kSamePlace = 1e-9;  // mm: two stops so near are one
constexpr double kSameRow = 1e-6;    // mm
constexpr double kOffJump = 1e-4;    // mm
constexpr double kWidestTurn = 10.0 * kRadPerDeg;
constexpr double kWidestShare = 1.0 / 36.0;
constexpr int kProbes = 7, kHalvings = 40;

/// Refuses options that are not available for a section.
Result<void> check(const section::Section& section, const TableSpec& spec) {
  const auto refused = [](std::string member, std::string hint) {
    return fail({.code = ErrorCode::unsupported_combination,
                 .member = std::move(member),
                 .hint = std::move(hint)});
  };
  if (spec.dihedral != Dihedral::weld_side)
    return refused("dihedral", "inside and as_published require a round target");
  if (std::holds_alternative<HermiteSmoothing>(spec.smoothing))
    return refused("smoothing/method", "hermite requires a round target");
  if (const auto* zoned = std::get_if<ZonedGroove>(&spec.groove); zoned && zoned->has_root_gaps())
    return refused("groove/zones", "root gaps of zones require a round target");
  if (spec.root_face > 0.0 && spec.contact != Contact::inner)
    return refused("root_face", "a root face requires contact inner");
  const bool reached = spec.torch.min.rad() <= 0.0 && spec.torch.max.rad() >= 0.0;
  if (spec.untilted && !reached)
    return refused("torch", "an untilted head requires B = 0 within its range");
  if (!(spec.root_face >= 0.0 && spec.root_face < section.wall))
    return fail({.code = ErrorCode::out_of_range,
                 .member = "root_face",
                 .got = spec.root_face,
                 .limit = section.wall,
                 .unit = "mm",
                 .hint = "must be less than the wall"});
  TRY(check_kerf(spec.kerf));
  if (!(spec.kerf <= section.corner))
    return fail(
        {.code = ErrorCode::out_of_range,
         .member = "kerf",
         .got = spec.kerf,
         .limit = section.corner,
         .unit = "mm",
         .hint = "at most the corner radius outside: a wider beam reaches around the corner"});
  TRY(check_stated(spec));
  return check_groove(spec.groove);
}

/// Makes the rows of one table.
class Maker {
 public:
  explicit Maker(const SectionSetup& g)
      : g_(g), outline_(g.wall.outer()), girth_(outline_.girth()) {
    events_from(g.inner, false);
    events_from(g.outer, true);
    for (const double s : outline_.seams()) stops_.push_back(s);
    for (const double s : g.wall.bore().seams())
      stops_.push_back(g.wall.outside_of(g.wall.bore().at(s)));
  }

  Result<std::vector<SectionRow>> make(std::span<const double> also) {
    const auto& sampling = g_.spec.sampling;
    if (!sampling.tolerance) {
      add_grid(sampling.uniform_points);
    } else {
      stops_.insert(stops_.end(), also.begin(), also.end());
      for (std::size_t i = 0; i < sampling.uniform_points; ++i)
        stops_.push_back(girth_ * static_cast<double>(i) /
                         static_cast<double>(sampling.uniform_points));
      tidy_stops();
      for (std::size_t k = 0; k < stops_.size(); ++k) {
        add_stop(stops_[k]);
        const double to = k + 1 < stops_.size() ? stops_[k + 1] : stops_[0] + girth_;
        refine(stops_[k], to);
        if (rows_.size() > sampling.max_nodes) break;
      }
      std::ranges::stable_sort(rows_, {}, [](const SectionRow& r) { return r.at.s; });
    }
    if (rows_.size() > sampling.max_nodes)
      return fail({.code = ErrorCode::too_many_nodes,
                   .member = "sampling",
                   .got = static_cast<double>(rows_.size()),
                   .limit = static_cast<double>(sampling.max_nodes)});
    return std::move(rows_);
  }

 private:
  struct RootEvent {
    double s;  // outside
    const joint::SectionEvent* event;
  };
  /// Not the datum's far side, where the root's own place is 0 already.
  [[nodiscard]] double turned(double s) const {
    const double out = s - girth_ * std::floor(s / girth_);
    return out < girth_ - kSamePlace ? out : 0.0;
  }
  [[nodiscard]] double distance(double a, double b) const {
    const double d = std::abs(turned(a) - turned(b));
    return std::min(d, girth_ - d);
  }

  void events_from(const joint::SectionContour& contour, bool outer) {
    for (const auto& event : contour.events) {
      const double s = outer ? event.s : g_.wall.outside_of(contour.curve.at(event.s));
      stops_.push_back(s);
      const bool of_root = outer == g_.root_outside();
      // Where the other edge steps alone, the cut is as before on one side and as after on the
      // other.
      if (!of_root && event.kind == joint::SectionEventKind::jump)
        stops_.insert(stops_.end(), {s - kOffJump, s + kOffJump});
      if (of_root && event.kind != joint::SectionEventKind::seam)
        root_events_.push_back({turned(s), &event});
    }
  }

  void tidy_stops() {
    for (double& s : stops_) s = turned(s);
    std::ranges::sort(stops_);
    std::vector<double> kept;
    for (const double s : stops_) {
      const auto near = [&](double other) { return distance(s, other) <= kSamePlace; };
      if (kept.empty() || (!near(kept.back()) && !near(kept.front()))) kept.push_back(s);
    }
    stops_ = std::move(kept);
    if (stops_.empty()) stops_.push_back(0.0);
  }

  [[nodiscard]] const joint::SectionEvent* event_at(double s) const {
    for (const auto& one : root_events_)
      if (distance(one.s, s) <= kSamePlace) return one.event;
    return nullptr;
  }

  [[nodiscard]] SectionRow row_at(double s, std::size_t cutter) const {
    SectionRow row{.at = outline_.at(turned(s)), .across = {}, .point = {}};
    row.across = g_.wall.across(row.at);
    row.before = row.after = cutter;
    row.z = g_.root().height(cutter, g_.root_station(row.at));
    return row;
  }

  void add_stop(double s) {
    const auto* event = event_at(s);
    auto row = row_at(s, joint::contact_at(g_.root(), g_.root_station(outline_.at(s))).cutter);
    if (event == nullptr) return rows_.push_back(row);
    row.corner = true;
    row.before = event->from;
    row.after = event->to;
    row.z = event->z_from;
    if (event->kind != joint::SectionEventKind::jump) return rows_.push_back(row);
    row.jump = true;
    row.after = event->from;
    row.other = event->to;
    row.side = -1.0;
    rows_.push_back(row);
    row.z = event->z_to;
    row.before = row.after = event->to;
    row.other = event->from;
    row.side = 1.0;
    rows_.push_back(row);
  }

  void add_grid(std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) {
      const double s = girth_ * static_cast<double>(i) / static_cast<double>(n);
      const auto contact = joint::contact_at(g_.root(), g_.root_station(outline_.at(s)));
      auto row = row_at(s, contact.cutter);
      row.z = contact.z;
      const auto* event = event_at(s);
      if (event != nullptr && event->kind != joint::SectionEventKind::jump) {
        row.corner = true;
        row.before = event->from;
        row.after = event->to;
      }
      rows_.push_back(row);
    }
  }

  [[nodiscard]] Eigen::Vector3d placed(double s, std::size_t cutter) const {
    const auto outside = outline_.at(s);
    const auto own = g_.root_station(outside);
    const double z = g_.root().height(cutter, own);
    if (g_.spec.sampling.tolerance->metric == joint::Metric::developed) {
      const double girth = g_.root().curve.girth();
      // Along the stretch, over the datum too.
      const double turns = std::floor(s / girth_);
      return {own.s + turns * girth, z, 0.0};
    }
    return {own.point.x(), own.point.y(), z};
  }

  void refine(double from, double to) {
    const double middle = 0.5 * (from + to);
    const auto own = g_.root_station(outline_.at(middle));
    const auto cutter = joint::contact_at(g_.root(), own).cutter;
    const double curvature = outline_.at(middle).curvature;
    const double widest = curvature > 0.0 ? kWidestTurn / curvature : kWidestShare * girth_;
    const int parts = std::max(1, static_cast<int>(std::ceil((to - from) / widest - 1e-9)));
    double left = from;
    for (int k = 1; k <= parts; ++k) {
      const double right = k == parts ? to : from + (to - from) * k / parts;
      halve(cutter, left, right, kHalvings);
      if (k < parts) rows_.push_back(row_at(right, cutter));
      left = right;
    }
  }

  [[nodiscard]] bool straight(std::size_t cutter, double a, double b) const {
    const Eigen::Vector3d from = placed(a, cutter);
    const Eigen::Vector3d way = placed(b, cutter) - from;
    const double length = way.norm();
    if (!(length > 0.0)) return true;
    const Eigen::Vector3d along = way / length;
    for (int k = 1; k <= kProbes; ++k) {
      const Eigen::Vector3d to = placed(a + (b - a) * k / (kProbes + 1), cutter) - from;
      if ((to - to.dot(along) * along).norm() > g_.spec.sampling.tolerance->value) return false;
    }
    return true;
  }

  void halve(std::size_t cutter, double a, double b, int halvings) {
    if (halvings == 0 || b - a < kSameRow || rows_.size() > g_.spec.sampling.max_nodes ||
        straight(cutter, a, b))
      return;
    const double mid = 0.5 * (a + b);
    halve(cutter, a, mid, halvings - 1);
    rows_.push_back(row_at(mid, cutter));
    halve(cutter, mid, b, halvings - 1);
  }

  const SectionSetup& g_;
  const section::Curve& outline_;
  double girth_;
  std::vector<double> stops_;
  std::vector<RootEvent> root_events_;
  std::vector<SectionRow> rows_;
};

}  // namespace

LocalView local_view(const SectionSetup& g, const Station& at, double wall) {
  const double radius = g.wall.outer().reach();
  return {joint::seen_from(g.inner.cutters, at.point - radius * at.normal),
          {radius - wall, radius},
          {radius - wall, at.normal.x(), at.normal.y()}};
}

Result<SectionSetup> set_up(const section::Section& section, const TableSpec& spec) {
  TRY(check(section, spec));
  TRY(auto cutters, grown_partners(spec));
  section::Wall wall(section);
  TRY(auto inner, joint::trace(cutters, wall.bore()));
  // With its root on the bore the wall may pass its partners outside, as far as that is open.
  const bool outside = spec.root_surface == RootSurface::outer;
  TRY(auto outer,
      outside ? joint::trace(cutters, wall.outer()) : joint::trace_met(cutters, wall.outer()));
  SectionSetup out{.spec = spec,
                   .wall = wall,
                   .cutters = std::move(cutters),
                   .solids = {},
                   .inner = std::move(inner),
                   .outer = std::move(outer),
                   .rule = Rule(spec.groove, spec.dihedral),
                   .flush = Rule(NoGroove{}, spec.dihedral)};
  for (const auto& cutter : out.cutters) out.solids.emplace_back(cutter);
  return out;
}

Result<SectionRows> section_rows(const SectionSetup& g, std::span<const double> also) {
  SectionRows out;
  TRY(out.rows, Maker(g).make(also));
  std::vector<double> places;
  for (auto& row : out.rows) {
    fill_row(g, row);
    places.push_back(g.root_station(row.at).s);
  }
  const auto lengths = joint::lengths_along(g.root(), places);
  for (std::size_t i = 0; i < out.rows.size(); ++i) out.rows[i].length = lengths[i];
  out.true_length = lengths.back();
  return out;
}

}  // namespace tubecut::bevel::detail
