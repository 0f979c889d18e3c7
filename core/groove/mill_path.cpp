#include "core/groove/mill_path.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "core/base/stop.hpp"
#include "core/base/try.hpp"
#include "core/groove/mill_parts.hpp"
#include "core/groove/survey.hpp"

namespace tubecut::groove {
namespace {

std::vector<Issue> check_issues(const MillPathSpec& spec) {
  std::vector<Issue> issues;
  const auto refuse = [&issues](ErrorCode code, const char* member, double got, double limit,
                                const char* unit) {
    issues.push_back({.code = code, .member = member, .got = got, .limit = limit, .unit = unit});
  };
  const GapCheck& check = spec.check;
  if (check.points < 3) refuse(ErrorCode::sampling, "check/points", check.points, 3, "");
  if (check.points > kMaxPoints)
    refuse(ErrorCode::sampling, "check/points", check.points, kMaxPoints, "");
  const double window = check.window.deg(), pitch = check.pitch.deg();
  if (!(window > 0.0 && check.window <= Angle::deg(90)))
    refuse(ErrorCode::sampling, "check/window", window, 90.0, "deg");
  if (!(pitch > 0.0 && check.pitch <= check.window))
    refuse(ErrorCode::sampling, "check/pitch", pitch, window, "deg");
  if (!(check.qualify > 0.0 && std::isfinite(check.qualify)))
    refuse(ErrorCode::out_of_range, "check/qualify", check.qualify, 0.0, "mm");
  if (spec.positions < kMinPositions)
    refuse(ErrorCode::out_of_range, "positions", spec.positions, kMinPositions, "");
  if (spec.positions > kMaxPositions)
    refuse(ErrorCode::out_of_range, "positions", spec.positions, kMaxPositions, "");
  else if (issues.empty())
    if (const int most = most_positions(check, spec.optimise.method); spec.positions > most)
      issues.push_back(
          {.code = ErrorCode::out_of_range,
           .member = "positions",
           .got = double(spec.positions),
           .limit = double(most),
           .hint =
               "the largest number for the check's points, pitch and window" +
               std::string(spec.optimise.method == Method::annealing ? " with annealing" : "")});
  if (spec.optimise.hold != Hold::tip && spec.optimise.hold != Hold::pivot)
    refuse(ErrorCode::setup, "optimise/hold", double(spec.optimise.hold), 1.0, "");
  return issues;
}

void unwind(std::vector<MillPosition>& positions) {
  for (std::size_t i = 1; i < positions.size(); ++i)
    positions[i].at.b =
        Angle::rad(nearest_turn(positions[i].at.b.rad(), positions[i - 1].at.b.rad()));
}

std::vector<Block> blocks_of(const std::vector<MillPosition>& positions, bool optima_only) {
  std::vector<Block> out;
  for (const MillPosition& p : positions)
    if (p.optimised || !optima_only) out.push_back({p.omega.rad(), p.at.x, p.at.z, p.at.b.rad()});
  return out;
}

std::optional<Issue> travel_issue(const Travel& travel, const MillPosition& p) {
  const auto beyond = [&p](const char* member, const std::optional<Range>& range, double value,
                           const char* unit) -> std::optional<Issue> {
    if (!range || (value >= range->min && value <= range->max)) return std::nullopt;
    return Issue{.code = ErrorCode::travel,
                 .member = member,
                 .got = value,
                 .limit = value < range->min ? range->min : range->max,
                 .unit = unit,
                 .hint = "at omega " + degrees_text(p.omega)};
  };
  if (auto issue = beyond("setup/travel/x", travel.x, p.at.x, "mm")) return issue;
  if (auto issue = beyond("setup/travel/z", travel.z, p.at.z, "mm")) return issue;
  return beyond("setup/travel/b", travel.b_deg, p.at.b.deg(), "deg");
}

std::vector<Warning> path_warnings(const MillPathSpec& spec, const MillPath& path) {
  std::vector<Warning> out;
  const Extreme& root = path.swept.root_face_min;
  if (root.value < kRootFaceCut)
    out.push_back({WarningCode::root_face_cut, "optimise/hold",
                   brief(-root.value) + " mm deep at omega " + degrees_text(root.omega)});
  const auto outside = [&](const MillPosition& p) { return p.after.largest >= spec.check.qualify; };
  const auto count = std::count_if(path.positions.begin(), path.positions.end(), outside);
  if (count > 0) {
    const auto first = std::find_if(path.positions.begin(), path.positions.end(), outside);
    out.push_back({WarningCode::window_not_reached, "check/qualify",
                   std::to_string(count) + " of " + std::to_string(path.positions.size()) +
                       " positions, first at omega " + degrees_text(first->omega)});
  }
  return out;
}

Result<std::vector<MillPosition>> optima_of(const Shop& shop) {
  std::vector<MillPosition> out;
  out.reserve(std::size_t(shop.spec.positions));  // because growth would move all 20 000 at once
  for (int i = 0; i < shop.spec.positions; ++i) {
    if (stopped()) return fail({.code = ErrorCode::cancelled});
    auto found = position(shop, i, std::nullopt);
    if (!found) return failed(found.error(), shop.omega(i));
    out.push_back(std::move(*found));
  }
  return out;
}

Result<std::vector<MillPosition>> emitted(const Shop& shop, std::vector<MillPosition> optima) {
  const Increments increments{optima, shop.spec.optimise.method};
  TRY(const auto stations, emitted_stations(shop, increments));
  std::vector<MillPosition> out;
  out.reserve(stations.size());
  for (const double station : stations) {
    if (stopped()) return fail({.code = ErrorCode::cancelled});
    if (station == std::floor(station)) {
      out.push_back(optima[std::size_t(station)]);
      continue;
    }
    auto between = position(shop, station, increments.at(station));
    if (!between) return failed(between.error(), shop.omega(station));
    out.push_back(std::move(*between));
  }
  unwind(out);
  return out;
}

int most_within(double bound, double each) {
  return int(std::clamp(std::floor(bound / each), 0.0, double(kMaxPositions)));
}

}  // namespace

GapWork gap_work(const GapCheck& check) {
  const double n = check.points;
  return {.samples = n * double(2 * ruling_reach(check) + 1),
          .triples = n * (n - 1.0) * (n - 2.0) / 6.0};
}

int most_emitted(const GapCheck& check) {
  const GapWork work = gap_work(check);
  return std::min(most_within(kMaxSamples, work.samples), most_within(kMaxTriples, work.triples));
}

int most_positions(const GapCheck& check, Method method) {
  const int most = most_emitted(check);
  if (method != Method::annealing) return most;
  return std::min(most, most_within(kMaxAnnealedSamples, gap_work(check).samples));
}

Result<MillPath> mill_path(const MillPathSpec& spec) {
  TRY(const auto joint, under("groove", joint_geometry(spec.groove)));
  TRY(no_issues(check_issues(spec)));
  TRY(auto whole, under("groove", survey(joint, 0.0)));
  TRY(check_tool(joint, whole, spec.mill, spec.setup));
  const Shop shop{spec, joint, Cone{spec.mill}};
  TRY(auto optima, optima_of(shop));
  MillPath out;
  TRY(out.positions, emitted(shop, std::move(optima)));
  for (const MillPosition& p : out.positions)
    if (auto issue = travel_issue(spec.setup.travel, p)) return fail(std::move(*issue));
  const SweptPoints points{.per_ruling = spec.check.points};
  for (const bool optima_only : {false, true}) {
    auto figures = swept(shop.joint, shop.cone, spec.setup, blocks_of(out.positions, optima_only),
                         Between::linear, points);
    if (!figures) return failed(figures.error(), 0.0);
    (optima_only ? out.swept_at_optima : out.swept) = *figures;
  }
  out.qualified = out.swept.root_face_min.value >= kRootFaceReject &&
                  std::all_of(out.positions.begin(), out.positions.end(),
                              [](const MillPosition& p) { return p.qualified; });
  out.warnings = under("groove", std::move(whole.warnings));
  for (Warning& warning : path_warnings(spec, out)) out.warnings.push_back(std::move(warning));
  return out;
}

}  // namespace tubecut::groove
