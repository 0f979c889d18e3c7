#include "core/torch/torch_cut.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/base/elementary.hpp"
#include "core/base/try.hpp"
#include "core/bevel/table/land_pass.hpp"
#include "core/motion/path/upright.hpp"
#include "core/part/cut_edges.hpp"
#include "core/part/place.hpp"
#include "core/torch/centre_lead.hpp"

namespace tubecut::torch {
namespace {

constexpr double kSigma = -1.0;  // of TorchCut's B, see motion::PartBorder
constexpr double kTouching =
    0.1;  // mm, maximum of the chords' sag by which a lead may touch the part

motion::CutPath on_tube(const joint::Target& tube, motion::Scrap scrap) {
  return {.outer_radius = tube.outer_radius,
          .wall = tube.wall,
          .surface = motion::Surface::outer,
          .closed = true,
          .scrap = scrap};
}

/// Inserts a point at phi = 0, on the straight lines of both edges across it, where tan B is
/// linear.
void begin_at_seam(motion::CutPath& path) {
  if (path.phi.empty() || !(path.phi.front() > 0.0)) return;
  const double ahead = path.phi.front() + kTwoPi - path.phi.back();
  const double share = ahead > 0.0 ? path.phi.front() / ahead : 0.0;
  const double first = elementary::tan(path.b.front()), last = elementary::tan(path.b.back());
  path.phi.insert(path.phi.begin(), 0.0);
  path.z.insert(path.z.begin(), path.z.front() + share * (path.z.back() - path.z.front()));
  path.b.insert(path.b.begin(), elementary::atan(first + share * (last - first)));
  path.corner.insert(path.corner.begin(), false);
}

TorchCut end_cut(const bevel::TableSpec& spec, const bevel::Table& table, motion::Scrap scrap) {
  TorchCut out{.path = on_tube(spec.target, scrap),
               .kerf = spec.kerf,
               .counted_inward = table.inward,
               .land = table.z_face.empty() ? 0.0 : spec.root_face};
  out.path.phi = table.phi;
  out.path.z = table.torch_outer;
  out.path.b = table.b;
  out.path.corner = corner_rows(table);
  begin_at_seam(out.path);
  return out;
}

TorchCut hole_cut(const bevel::HoleSpec& spec, const bevel::Hole& hole, std::string name) {
  TorchCut out{.name = std::move(name),
               .path = on_tube(spec.chord, motion::Scrap::inside),
               .kerf = spec.kerf};
  out.path.phi = hole.torch_phi;
  out.path.z = hole.torch_z;
  out.path.b = hole.b;
  if (std::ranges::any_of(hole.a, [](double a) { return a != 0.0; })) out.path.a = hole.a;
  for (auto* column : {&out.path.phi, &out.path.z, &out.path.b, &out.path.a})
    if (!column->empty()) column->push_back(column->front());
  return out;
}

/// Gives places that differ by rounding only the same numbers: in a corner of half the kerf the
/// torch is still while the edge's rows go round, and a path must not seem to turn back there.
void stand_still(motion::CutPath& path) {
  constexpr double kRounding = 1e-9;  // mm
  for (std::size_t i = 1; i < path.phi.size(); ++i) {
    const double round = path.outer_radius * (path.phi[i] - path.phi[i - 1]);
    if (elementary::hypot(round, path.z[i] - path.z[i - 1]) > kRounding) continue;
    path.phi[i] = path.phi[i - 1];
    path.z[i] = path.z[i - 1];
  }
}

/// Puts the torch's way along a slit into a path.
void along_slit(const cutout::Mould& mould, const cutout::Instance& one, motion::CutPath& path) {
  constexpr double kApart = 1.0;  // mm
  const auto& laying = mould.laying;
  path.closed = false;
  for (auto* column : {&path.phi, &path.z, &path.b, &path.a}) column->clear();
  bool leans = false;
  for (const auto& p : mould.slit->line.way(mould.slit->pierce, kApart)) {
    const double turn = laying.turn(p.y(), laying.outer());
    path.phi.push_back(one.phi + laying.phase(turn));
    path.z.push_back(one.z + p.x());
    path.b.push_back(0.0);
    const bool prism = laying.lay() == cutout::Lay::prism;
    path.a.push_back(!prism ? 0.0 : laying.far() ? turn : -turn);
    leans = leans || path.a.back() != 0.0;
  }
  if (!leans) path.a.clear();
}

/// Keeps the torch square to the flat of a cut-out of a section; of a prism over its corners it
/// keeps the direction of the walls, because they are parallel.
void keep_direction(const cutout::Laying& laying, const cutout::Instance& one, TorchCut& cut) {
  if (cut.on_flat) {
    cut.path.still = motion::normal_of_first(cut.path);
  } else if (laying.over() != nullptr && laying.lay() == cutout::Lay::prism) {
    const double anchor = one.phi + laying.phase(0.0);
    cut.path.still = motion::normal_at(cut.path.section->outer(), cut.path.outer_radius * anchor) +
                     laying.lean(0.0);
    cut.still_lean = 0.0;
    for (const double a : cut.path.a) cut.still_lean = std::max(*cut.still_lean, std::abs(a));
    cut.path.a.clear();
  }
}

/// `tube`: the path without points.
TorchCut cutout_cut(const cutout::Layout& layout, std::size_t index, double kerf,
                    motion::CutPath tube) {
  const auto& one = layout.instances[index];
  const auto& mould = layout.mould_of(one);
  const auto rows = cutout::placed(layout, one);
  TorchCut out{.name = "cut-out " + cutout::title_of(layout, one),
               .path = std::move(tube),
               .kerf = kerf,
               .on_flat = mould.laying.lay() == cutout::Lay::flat};
  out.path.scrap = motion::Scrap::inside;
  out.path.phi = rows.torch_phi;
  out.path.z = rows.torch_z;
  out.path.b = rows.b;
  if (std::ranges::any_of(rows.a, [](double a) { return a != 0.0; })) out.path.a = rows.a;
  for (auto* column : {&out.path.phi, &out.path.z, &out.path.b, &out.path.a})
    if (!column->empty()) column->push_back(column->front());
  if (mould.slit) {
    out.open = true;
    along_slit(mould, one, out.path);
  }
  keep_direction(mould.laying, one, out);
  if (mould.slit) return out;
  stand_still(out.path);
  const double turn = mould.laying.turn(mould.centre.y(), mould.laying.outer());
  out.centre = {one.phi + mould.laying.phase(turn), one.z + mould.centre.x()};
  return out;
}

/// The points as they stand; of a closed path from the first to the first again.
motion::CutWithLead once_round(const motion::CutPath& path) {
  motion::CutWithLead out;
  for (std::size_t i = 0; i < path.phi.size(); ++i)
    out.points.push_back({.phi = path.phi[i],
                          .z = path.z[i],
                          .b = path.b[i],
                          .a = path.a.empty() ? 0.0 : path.a[i]});
  const double turn = path.scrap == motion::Scrap::inside ? 0.0 : kTwoPi;
  if (path.closed && path.phi.back() != path.phi.front() + turn) {
    out.points.push_back(out.points.front());
    out.points.back().phi += turn;
  }
  out.cut_last = out.points.size() - 1;
  return out;
}

/// Returns the cut with these leads; empty when they or the pierce are too near the part.
Result<std::optional<motion::CutWithLead>> lead_and_pierce(const motion::PartBorder& border,
                                                           const motion::Track& from,
                                                           const motion::Lead& lead) {
  using Found = std::optional<motion::CutWithLead>;
  auto way = motion::clear_lead(border, from, lead, kTouching);
  if (!way && way.error().code() == ErrorCode::lead_blocked) return Found{};
  if (!way) return tl::unexpected<Error>(way.error());
  const double off = -motion::intrusion(border, way->points.front());
  return off < kPierceOff * lead.radius ? Found{} : Found{*std::move(way)};
}

TorchCut part_end(const part::Part& part, bool finish) {
  const auto& end = finish ? part.finish : part.start;
  auto out = end_cut(end.spec, end.table, finish ? motion::Scrap::plus_z : motion::Scrap::minus_z);
  out.name = joint::end_name(finish);
  return out;
}

/// Returns the pass of an end's land in the part's frame.
Result<TorchCut> part_land(const part::PartSpec& spec, const part::Part& part, bool finish) {
  const auto& end = finish ? part.finish : part.start;
  TRY(auto land, bevel::land_pass(end.spec, end.own));
  const auto placed =
      part::shifted(finish ? part::seen_from_start(land, *spec.target.length) : std::move(land),
                    -part::lowest(part.start.own));
  return end_cut(end.spec, placed, finish ? motion::Scrap::plus_z : motion::Scrap::minus_z);
}

/// Inserts the land's pass before the last cut.
void put_before_last(TorchCut land, std::vector<TorchCut>& out) {
  auto& bevel = out.back();
  const std::string of = bevel.name.empty() ? "" : bevel.name + ", ";
  land.name = of + "land";
  land.of_land = true;
  bevel.name = of + "bevel";
  bevel.land = 0.0;
  out.insert(out.end() - 1, std::move(land));
}

}  // namespace

std::vector<bool> corner_rows(const bevel::Table& table) {
  std::vector<bool> out(table.phi.size(), false);
  for (const auto* events : {&table.inner_events, &table.outer_events})
    for (const auto& event : *events)
      for (std::size_t i = 0; i < out.size(); ++i)
        if (table.phi[i] == event.phi) out[i] = true;
  return out;
}

TorchCut torch_cut(const bevel::TableSpec& spec, const bevel::Table& table) {
  return end_cut(spec, table, motion::Scrap::minus_z);
}

TorchCut torch_cut(const section::Section& section, const bevel::TableSpec& spec,
                   const bevel::SectionTable& table) {
  TorchCut out{.path = motion::around(section),
               .kerf = spec.kerf,
               .land = table.z_face.empty() ? 0.0 : spec.root_face};
  for (const auto& at : table.at) out.path.phi.push_back(at.s / out.path.outer_radius);
  out.path.z = table.torch_outer;
  out.path.b = table.b;
  out.path.corner = table.corner;
  // The first row may lie just before the datum, or just behind it, by rounding: a second point
  // there would be the same one after whole turns.
  constexpr double kRounding = 1e-12;  // rad
  auto& phi = out.path.phi;
  if (phi.size() > 1 && (phi.front() > phi[1] || phi.front() < kRounding)) phi.front() = 0.0;
  begin_at_seam(out.path);
  return out;
}

std::vector<TorchCut> torch_cuts(const part::SectionPartSpec& spec, const part::SectionPart& part) {
  using What = part::Step::What;
  std::vector<TorchCut> out;
  for (const auto& step : part.sequence) {
    if (step.what == What::mark) continue;
    if (step.what == What::cutout) {
      out.push_back(
          cutout_cut(part.cutouts, step.index, spec.cutouts.kerf, motion::around(spec.section)));
      continue;
    }
    const bool finish = step.what == What::finish;
    const auto& end = finish ? part.finish : part.start;
    auto cut = torch_cut(spec.section, end.spec, end.table);
    cut.name = joint::end_name(finish);
    cut.path.scrap = finish ? motion::Scrap::plus_z : motion::Scrap::minus_z;
    out.push_back(std::move(cut));
  }
  return out;
}

std::vector<TorchCut> torch_cuts(const part::PartSpec& spec, const part::Part& part) {
  using What = part::Step::What;
  std::vector<TorchCut> out;
  for (const auto& step : part.sequence) {
    if (step.what == What::hole) {
      const auto& hole = part.holes[step.index];
      const auto& branch = spec.holes[hole.asked].name;
      out.push_back(hole_cut(
          spec.holes[hole.asked].hole, hole.hole,
          "hole " + std::to_string(step.index) + (branch.empty() ? "" : " for " + branch)));
    } else if (step.what == What::cutout) {
      out.push_back(cutout_cut(part.cutouts, step.index, spec.cutouts.kerf,
                               on_tube(spec.target, motion::Scrap::inside)));
    } else if (step.what != What::mark) {
      out.push_back(part_end(part, step.what == What::finish));
    }
  }
  return out;
}

Result<std::vector<TorchCut>> torch_passes(const bevel::TableSpec& spec,
                                           const bevel::Table& table) {
  std::vector out{torch_cut(spec, table)};
  if (out.back().land == 0.0) return out;
  TRY(const auto land, bevel::land_pass(spec, table));
  put_before_last(end_cut(spec, land, motion::Scrap::minus_z), out);
  return out;
}

Result<std::vector<TorchCut>> torch_passes(const part::PartSpec& spec, const part::Part& part) {
  auto cuts = torch_cuts(spec, part);
  if (!cuts.empty() && cuts.back().land > 0.0)
    return fail({.code = ErrorCode::unsupported_combination,
                 .member = "root_face",
                 .hint = "the first pass of cut " + cuts.back().name +
                         " cuts the part off, and nothing turns it for the second"});
  std::vector<TorchCut> out;
  for (auto& cut : cuts) {
    const bool has_land = cut.land > 0.0, finish = cut.name == joint::end_name(true);
    out.push_back(std::move(cut));
    if (!has_land) continue;
    TRY(auto land, part_land(spec, part, finish));
    put_before_last(std::move(land), out);
  }
  return out;
}

double from_edge(const motion::CutWithLead& way, double outer_radius) {
  const auto &pierce = way.points.front(), &first = way.points[way.cut_first];
  return elementary::hypot(outer_radius * (first.phi - pierce.phi), first.z - pierce.z);
}

Result<TorchWay> torch_way(const TorchCut& cut, const Approach& approach) {
  const bool as_given = approach.start.at == motion::Start::At::first_point;
  if (cut.open || (!approach.lead && as_given)) return TorchWay{once_round(cut.path), 0.0};
  const auto path = motion::without_repeats(cut.path);
  TRY(auto whole, motion::track(path));
  TRY(const auto from,
      motion::directed(std::move(whole), motion::Direction::as_given, approach.start));
  if (!approach.lead) return TorchWay{{from.points, 0, from.points.size() - 1}, 0.0};
  TRY(const auto border, torch_border(cut));
  auto way = way_with_lead(border, from, *approach.lead);
  const bool as_asked =
      way ? way->radius >= approach.lead->radius : way.error().code() != ErrorCode::lead_blocked;
  if (as_asked || !cut.centre) return way;
  // A pierce in the middle is further from the edge than one before a shorter arc.
  for (const auto how : {CentreWay::half_circle, CentreWay::straight}) {
    TRY(auto from_centre, centre_lead(cut, approach.lead->overcut, how));
    const double touch = motion::lead_touch(border, kTouching);
    bool clear = true;
    for (std::size_t i = 0; i < from_centre.cut_first && clear; ++i)
      clear = motion::intrusion(border, from_centre.points[i]) <= touch;
    if (clear && (!way || from_edge(from_centre, cut.path.outer_radius) >= way->radius))
      return TorchWay{std::move(from_centre), 0.0};
  }
  return way;
}

Result<motion::PartBorder> torch_border(const TorchCut& cut) {
  if (cut.counted_inward)
    return fail({.code = ErrorCode::unsupported_combination,
                 .member = "lead",
                 .hint = "B is counted inward, as published, for comparison"});
  return motion::part_border(motion::without_repeats(cut.path), kSigma);
}

Result<TorchWay> way_with_lead(const motion::PartBorder& border, const motion::Track& from,
                               motion::Lead lead) {
  while (true) {
    TRY(auto way, lead_and_pierce(border, from, lead));
    if (way) return TorchWay{*std::move(way), lead.radius};
    const bool shortest = lead.radius <= kShortestLead;
    lead.radius = std::max(0.5 * lead.radius, kShortestLead);
    if (shortest)
      return fail({.code = ErrorCode::lead_blocked,
                   .member = "lead",
                   .got = lead.radius,
                   .limit = kShortestLead,
                   .unit = "mm"});
  }
}

}  // namespace tubecut::torch
