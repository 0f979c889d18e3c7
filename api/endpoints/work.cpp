#include "api/endpoints/work.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <type_traits>
#include <variant>

#include "core/base/angle.hpp"
#include "core/bevel/beam/beam.hpp"

namespace tubecut::api {
namespace {

constexpr double kLeastNodes = 36.0;  // of a curve sampled by a tolerance
constexpr double kNodes = 2.8;        // times sqrt(radius / tolerance), of joints of all kinds
constexpr double kCutLength = 1.3;    // of a cut, in its tube's girths
constexpr double kBetweenCuts = 5.0;  // s, from one cut of a part to the next
constexpr double kSpacing = 0.1;      // mm between the knots of a path
constexpr double kSquarePair = 0.1;   // of a pair's price: nothing leans beside it
constexpr double kMotions = 2.5;      // a cycle's whole motion, in times of its work feed
constexpr double kUntiltedTables =
    1.2;  // tables: its own, which nothing smooths, and a flush one's

/// Points of one curve round a tube.
double points_of(const joint::Sampling& sampling, double radius) {
  auto out = static_cast<double>(sampling.uniform_points);
  if (sampling.tolerance)
    out += kLeastNodes + kNodes * std::sqrt(radius / sampling.tolerance->value);
  return std::min(out, static_cast<double>(sampling.max_nodes));
}

/// What a partner costs beside the joint itself: one case for every kind.
struct CostOf {
  using Some = std::optional<Cost>;

  Some operator()(const joint::TubeCutter&) const { return {}; }
  Some operator()(const joint::AxisTube&) const { return {}; }
  Some operator()(const joint::PlaneCutter&) const { return {}; }
  Some operator()(const joint::RectangularTubeCutter&) const { return Cost::rectangular_tube; }
  Some operator()(const joint::ConeCutter&) const { return {}; }
  Some operator()(const joint::ElbowCutter&) const { return Cost::elbow; }
};

void add_partners(const std::vector<joint::Partner>& partners, Work& work) {
  for (const auto& partner : partners)
    if (const auto cost = joint::by_kind(partner, CostOf{})) work.add(*cost);
}

/// What a path is long: the planner has less to do where it is straight on the tube laid flat and
/// its bevel stays.
struct PathLength {
  double bent = 0.0, straight = 0.0;  // mm

  [[nodiscard]] double whole() const { return bent + straight; }
};

PathLength length_of(const motion::CutPath& contour) {
  constexpr double kSameSlope = 1e-6;  // more than printing in nine digits turns
  PathLength out;
  const auto n = std::min({contour.phi.size(), contour.z.size(), contour.b.size()});
  double before = 0.0;
  for (std::size_t i = 1; i < n; ++i) {
    const double turned = contour.radius() * (contour.phi[i] - contour.phi[i - 1]);
    const double along = contour.z[i] - contour.z[i - 1];
    const double slope = turned != 0.0 ? along / turned : 0.0;
    const bool straight = turned != 0.0 && contour.b[i] == contour.b[i - 1] &&
                          (i == 1 || std::abs(slope - before) <= kSameSlope);
    (straight ? out.straight : out.bent) += std::sqrt(turned * turned + along * along);
    before = slope;
  }
  return out;
}

/// The table of a cut as far as it is known before its node is resolved.
bevel::TableSpec stated(const BevelTableRequest& cut) {
  auto out = static_cast<const bevel::TableSpec&>(cut);
  out.target = cut.source.target;
  out.partners = cut.source.partners;
  if (const auto& of = cut.source.node)
    out.target.outer_radius = of->node.members[of->member].outer_radius;
  return out;
}

/// Both ends and all holes.
PathLength length_of(const PartRequest& part) {
  PathLength out{.bent = 2.0 * kCutLength * kTwoPi * part.part.target.outer_radius};
  for (const auto& one : part.part.holes) {
    const double radius = std::visit([](const auto& tube) { return tube.radius; }, one.hole.branch);
    const double sides = one.hole.kind == bevel::JointKind::through ? 2.0 : 1.0;
    out.bent += sides * kCutLength * kTwoPi * radius;
  }
  return out;
}

PathLength length_of(const CutSource& cut) {
  return std::visit(
      [](const auto& of) -> PathLength {
        using Of = std::decay_t<decltype(of)>;
        if constexpr (std::is_same_v<Of, BevelTableRequest>)
          return {.bent = kCutLength * kTwoPi * stated(of).target.outer_radius};
        if constexpr (std::is_same_v<Of, groove::MillPathSpec>)
          return {.bent = kCutLength * kPi * of.groove.branch.outer_diameter};
        if constexpr (std::is_same_v<Of, motion::CutPath>) return length_of(of);
        if constexpr (std::is_same_v<Of, motion::AxisColumns>)
          return {.bent = of.length.empty() ? 0.0 : std::abs(of.length.back() - of.length.front())};
        if constexpr (std::is_same_v<Of, PartRequest>) return length_of(of);
      },
      cut);
}

/// How many cuts of a part have tabs.
double held(const torch::Tabs& tabs, double holes) {
  switch (tabs.of) {
    case torch::Tabs::Of::last:
      return 1.0;
    case torch::Tabs::Of::ends:
      return 2.0;
    case torch::Tabs::Of::holes:
      return holes;
    case torch::Tabs::Of::all:
      return 2.0 + holes;
  }
  return 0.0;
}

/// How many schedules there are in one: of cuts, or stretches of them, and strokes of marks.
double cuts_of(const ScheduleRequest& request) {
  const auto* const part = std::get_if<PartRequest>(&request.cut);
  if (part == nullptr) return 1.0;
  const auto holes = static_cast<double>(part->part.holes.size());
  double out = 2.0 + holes;
  if (const auto& tabs = request.setup.tabs) out += held(*tabs, holes) * (tabs->count - 1.0);
  if (request.marks) out += 1.0 + 2.0 * static_cast<double>(part->part.partners.size());
  return out;
}

/// mm/s
double mean_speed(const motion::Speed& speed) {
  const auto* const table = std::get_if<motion::SpeedTable>(&speed);
  if (table == nullptr) return std::get<double>(speed);
  double sum = 0.0;
  for (const auto& pair : table->pairs) sum += pair.second;
  return table->pairs.empty() ? 0.0 : sum / static_cast<double>(table->pairs.size());
}

/// s
double work_feed_of(const cutoff::Cut& cut) {
  const auto* const window = std::get_if<cutoff::FeedWindow>(&cut.range);
  if (window != nullptr) return (window->end_feed - window->start_feed) / cut.feed;
  const auto& by = std::get<cutoff::CutDistances>(cut.range);
  return (by.slowdown + by.wall + by.overcut) / cut.feed;
}

void add_curves(double points, double cutters, Work& work) {
  work.add(Cost::curve_point, points);
  work.add(Cost::curve_point_of_cutter, points * cutters);
  work.add(Cost::curve_cutter, cutters);
}

/// Its bevel is 0 all round and nothing is to be smoothed.
bool is_square(const bevel::TableSpec& spec) {
  if (spec.partners.size() != 1) return false;
  const auto* const plane = std::get_if<joint::PlaneCutter>(&spec.partners.front());
  return plane != nullptr && plane->normal.x() == 0.0 && plane->normal.y() == 0.0;
}

void add_table(const bevel::TableSpec& spec, double radius, double cutters, Work& work) {
  const double points = points_of(spec.sampling, radius);
  const double tables = spec.untilted ? kUntiltedTables : 1.0;
  const double pairs = tables * bevel::kerf_pairs(points, spec.kerf, radius);
  if (is_square(spec)) {
    work.add(Cost::square_table, tables);
    work.add(Cost::square_table_point, tables * points);
    work.add(Cost::beam_pair, kSquarePair * pairs);
    return;
  }
  work.add(Cost::table, tables);
  work.add(Cost::table_point, tables * points);
  work.add(Cost::table_point_of_cutter, tables * points * cutters);
  if (spec.kerf > 0.0) work.add(Cost::table_with_kerf, tables);
  work.add(Cost::beam_pair, pairs);
}

/// Sections of the groove, and of the survey round it.
void add_sections(const groove::GrooveSpec& spec, Work& work) {
  work.add(Cost::groove);
  work.add(Cost::groove_section, spec.sections);
  if (spec.area_in == groove::AreaIn::normal) work.add(Cost::normal_area);
}

}  // namespace

void add_work(const joint::IntersectionSpec& spec, Work& work) {
  const double walls = spec.surfaces == joint::Surfaces::both ? 2.0 : 1.0;
  add_curves(walls * points_of(spec.sampling, spec.target.outer_radius),
             static_cast<double>(spec.partners.size()), work);
  add_partners(spec.partners, work);
}

void add_work(const bevel::TableSpec& spec, Work& work) {
  const auto cutters = static_cast<double>(spec.partners.size());
  add_table(spec, spec.target.outer_radius, cutters, work);
  add_partners(spec.partners, work);
}

void add_work(const bevel::HoleSpec& spec, Work& work) {
  const double sides = spec.kind == bevel::JointKind::through ? 2.0 : 1.0;
  const double points = points_of(spec.sampling, spec.chord.outer_radius);
  const double radius = std::visit([](const auto& tube) { return tube.radius; }, spec.branch);
  work.add(Cost::hole_point, sides * points);
  work.add(Cost::beam_pair, sides * bevel::kerf_pairs(points, spec.kerf, radius));
}

void add_work(const PartRequest& spec, Work& work) {
  for (const auto* end : {&spec.part.start, &spec.part.finish}) add_work(end->cut, work);
  for (const auto& one : spec.part.holes) add_work(one.hole, work);
}

void add_work(const joint::NodeSpec& node, const joint::Nodes& solved,
              const joint::Sampling* profiles, const bevel::TableSpec* tables, Work& work) {
  work.add(Cost::member, static_cast<double>(node.members.size()));
  for (const auto& end : solved.ends) {
    const auto cutters = static_cast<double>(end.cut_by.size());
    const double radius = node.members[end.member].outer_radius;
    work.add(Cost::near_pair, cutters * (cutters - 1.0) / 4.0);  // half of them see the other half
    if (end.cut_by.empty()) continue;
    if (profiles != nullptr) {
      add_curves(2.0 * points_of(*profiles, radius), cutters, work);
    }
    if (tables != nullptr) add_table(*tables, radius, cutters, work);
  }
}

void add_work(const groove::GrooveSpec& spec, Work& work) { add_sections(spec, work); }

void add_work(const groove::MillPathSpec& spec, Work& work) {
  const double n = spec.positions;
  const auto each = groove::gap_work(spec.check);
  add_sections(spec.groove, work);
  work.add(Cost::mill_path);
  work.add(Cost::mill_position, n);
  work.add(Cost::mill_sample, n * each.samples);
  work.add(Cost::mill_triple, n * each.triples);
  if (spec.optimise.method == groove::Method::annealing)
    work.add(Cost::annealed_sample, n * each.samples);
}

void add_work(const cutoff::FeedCurveSpec& spec, Work& work) {
  const double duration = work_feed_of(spec.cut);
  work.add(Cost::feed_curve);
  if (const auto* const rows = std::get_if<cutoff::TablePoints>(&spec.table))
    work.add(Cost::feed_row, rows->points);
  else
    work.add(Cost::feed_row,
             duration * spec.cut.feed / std::get<cutoff::TableStep>(spec.table).step);
  if (spec.cycle)
    work.add(Cost::feed_sample, (kMotions * duration + spec.cycle->dwell) / spec.cycle->period);
  if (spec.comparison)
    work.add(Cost::feed_degree, 1 + spec.comparison->last_degree - spec.comparison->first_degree);
}

void add_cut_work(const ScheduleRequest& request, Work& work) {
  if (const auto* const table = std::get_if<BevelTableRequest>(&request.cut))
    add_work(stated(*table), work);
  if (const auto* const path = std::get_if<groove::MillPathSpec>(&request.cut))
    add_work(*path, work);
  if (const auto* const contour = std::get_if<motion::CutPath>(&request.cut))
    work.add(Cost::contour_point, static_cast<double>(contour->phi.size()));
  if (const auto* const axes = std::get_if<motion::AxisColumns>(&request.cut))
    work.add(Cost::axis_row, static_cast<double>(axes->length.size()));
  if (const auto* const part = std::get_if<PartRequest>(&request.cut)) add_work(*part, work);
}

void add_schedule_work(const ScheduleRequest& request, Work& work) {
  auto length = length_of(request.cut);
  if (const auto* const part = std::get_if<PartRequest>(&request.cut); part && request.marks)
    length.straight += part->part.target.length.value_or(0.0);
  const double speed = mean_speed(request.motion.speed);
  add_cut_work(request, work);
  work.add(Cost::path, cuts_of(request));
  work.add(Cost::path_knot, length.bent / kSpacing);
  work.add(Cost::straight_knot, length.straight / kSpacing);
  const double between = kBetweenCuts * (cuts_of(request) - 1.0);
  if (speed > 0.0)
    work.add(Cost::period, (length.whole() / speed + between) / request.machine.period);
}

}  // namespace tubecut::api
