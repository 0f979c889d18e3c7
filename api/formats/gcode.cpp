#include "api/formats/gcode.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "api/formats/bevel_table_formats.hpp"
#include "api/formats/text.hpp"
#include "api/formats/torch_joints.hpp"
#include "api/formats/torch_moves.hpp"
#include "api/posts.hpp"
#include "api/stop.hpp"
#include "api/verdict.hpp"
#include "api/wire_names.hpp"
#include "core/base/elementary.hpp"

namespace tubecut::api {
namespace {

constexpr double kSlow = 1e-3;  // mm, least length a node's time is taken from
constexpr double kSag = 0.019;  // mm, of one move; below 0.02 with the rounding of its words

/// One cut as it is printed.
struct Way {
  std::string name;
  std::vector<TorchPlace> places;  // from the pierce on
  double kerf = 0.0;
  double radius = 0.0;    // of its leads
  TorchPlace start = {};  // where the cut begins
};

TorchPlace place(const motion::CutPoint& p) { return {p.phi, p.z, p.b, p.a}; }

/// A hole reaches few angles, so that its start is found.
torch::Approach approach(const torch::TorchCut& cut, const FormatOptions& o) {
  torch::Approach out;
  const auto deg = [](const std::optional<double>& v) {
    return v ? std::optional(Angle::deg(*v)) : std::nullopt;
  };
  if (o.lead > 0.0) {
    out.lead = {.radius = o.lead, .pierce_b = deg(o.pierce_bevel)};
    if (o.overcut) out.lead->overcut = *o.overcut;
    out.start = {.at = motion::Start::At::automatic, .seam = Angle{}};
  }
  if (o.start && cut.path.scrap != motion::Scrap::inside)
    out.start = {.at = motion::Start::At::phi, .phi = Angle::deg(*o.start)};
  return out;
}

/// How moves between the nodes keep to the lines between them.
struct Straightness {
  double sag = 0.0;  // mm, a bound over all moves
  std::size_t inserted = 0;
};

/// The same places with more between them where a move of all axes would sag.
std::vector<TorchPlace> refined(const std::vector<motion::CutPoint>& points,
                                const TorchReach& reach, const std::stop_token& stop,
                                Straightness& told) {
  std::vector<TorchPlace> out{place(points.front())};
  for (std::size_t i = 1; i < points.size(); ++i) {
    ask(stop);
    auto at = place(points[i - 1]);
    const auto moves = straight_moves(reach, at, place(points[i]), kSag);
    told.inserted += moves.size() - 1;
    for (const auto& next : moves) {
      told.sag = std::max(told.sag, sag(reach, at, next));
      out.push_back(at = next);
    }
  }
  return out;
}

[[noreturn]] void refuse(const torch::TorchCut& cut, const FormatOptions& options,
                         const Error& error) {
  const auto& issue = error.issues.front();
  const std::string of = cut.name.empty() ? "the cut" : "cut " + cut.name;
  const bool blocked = issue.code == ErrorCode::lead_blocked;
  const std::string why =
      blocked ? "an arc of " + fixed(torch::kShortestLead, 0) + " mm or more would enter the part"
              : std::string(info(issue.code).code) + " " + issue.hint;
  throw UnfitOption{options.start && !blocked ? "start_deg" : "lead_mm", of + ": " + why};
}

std::vector<Way> ways_of(const TorchJob& job, const Caption& caption, Straightness& moves) {
  const auto& o = caption.options;
  const TorchReach reach{
      .outer_radius = job.outer_radius,
      .inner_radius = job.outer_radius - job.wall,
      .pivot = o.pivot_length ? *o.pivot_length + o.cut_height.value_or(0.0) : 0.0};
  std::vector<Way> out;
  for (const auto& cut : job.cuts) {
    const auto way = torch::torch_way(cut, approach(cut, o), caption.stop);
    ask(caption.stop);
    if (!way) refuse(cut, o, way.error());
    const auto& points = way->points.points;
    out.push_back({.name = cut.name,
                   .places = refined(points, reach, caption.stop, moves),
                   .kerf = cut.kerf,
                   .radius = way->radius,
                   .start = place(points[way->points.cut_first])});
  }
  return out;
}

/// One for all cuts, or each in their order.
std::string kerfs(const std::vector<Way>& ways) {
  const double first = ways.front().kerf;
  std::string out = fixed(first, 3);
  if (std::ranges::all_of(ways, [&](const Way& way) { return way.kerf == first; })) return out;
  for (std::size_t i = 1; i < ways.size(); ++i) out += ", " + fixed(ways[i].kerf, 3);
  return out;
}

double step(const TorchJob& job, const TorchPlace& from, const TorchPlace& to) {
  const double tip = elementary::hypot(job.outer_radius * (to.phi - from.phi), to.z - from.z);
  // A swing at a standing tip takes the time of an arc of the wall.
  return tip > kSlow ? tip
                     : std::max(kSlow, job.wall * elementary::hypot(to.b - from.b, to.a - from.a));
}

/// Where the axis along the tube goes, and how long the torch burns.
std::string extent(const TorchJob& job, const std::vector<Way>& ways, const TorchJoints& joints,
                   const FormatOptions& o) {
  const auto& post = post_of(o);
  const double off = o.cut_height.value_or(0.0);
  const auto along = [&](const TorchPlace& at) {
    return joints.along().counted(joints.along_at(at, off));
  };
  double least = along(ways.front().places.front()), most = least, length = 0.0;
  for (const auto& way : ways)
    for (std::size_t i = 0; i < way.places.size(); ++i) {
      const double at = along(way.places[i]);
      least = std::min(least, at);
      most = std::max(most, at);
      if (i > 0) length += step(job, way.places[i - 1], way.places[i]);
    }
  const double pierces = o.pierce_delay.value_or(0.0) * static_cast<double>(ways.size());
  return post.comment(std::string(1, joints.along().letter) + " from " + fixed(least, 2) + " to " +
                      fixed(most, 2) + " mm while cutting, " + joints.along().zero() +
                      " is z 0 of the result, " + joints.turn().zero() + " its phi 0") +
         post.comment(std::to_string(ways.size()) + (ways.size() == 1 ? " cut, " : " cuts, ") +
                      fixed(length, 1) + " mm in " + fixed(60.0 * length / *o.speed + pierces, 1) +
                      " s at the speed below, delays of the pierce with it, rapids not");
}

std::string how_it_starts(const TorchJoints& joints, const FormatOptions& o) {
  const auto& post = post_of(o);
  const std::string height = fixed(o.cut_height.value_or(0.0), 3);
  std::string out;
  if (o.pivot_length)
    out += post.comment("pierce " + fixed(o.pierce_height.value_or(o.cut_height.value_or(0.0)), 3) +
                        " mm off the wall, delay " + fixed(o.pierce_delay.value_or(0.0), 3) +
                        " s, cut " + height + " mm off it along the torch");
  else
    out += post.comment(post.of_control ? "heights and delay of the pierce: " + *post.of_control
                                        : "heights and the lift between cuts: the control's");
  if (o.lead > 0.0)
    out += post.comment("leads: arcs of 60 deg on the scrap side, radius " + fixed(o.lead, 3) +
                        " mm, overcut " + fixed(o.overcut.value_or(motion::Lead{}.overcut), 3) +
                        " mm, clear of the part");
  if (!o.start && o.lead > 0.0)
    out += post.comment(
        "each cut starts at its least bevel that is " + fixed(motion::kFromJunction, 0) +
        " mm and more off its junctions and off " + joints.turn().zero() + ", the seam");
  return out;
}

/// Which way an axis counts, as far as it is not the plain one.
std::string sense(const PostAxis& axis) { return axis.reversed ? "negative" : "positive"; }

std::string axes(const TorchJoints& joints, const FormatOptions& o) {
  const auto& post = post_of(o);
  const auto name = [](const PostAxis& axis) { return std::string(1, axis.letter); };
  std::string out = post.comment(name(joints.swing()) + " swings the torch in the axial plane, " +
                                 sense(joints.swing()) +
                                 ": outer edge towards +z, b_sign: " + std::string(kBSignInPart));
  if (joints.has_pivot())
    out += post.comment("between cuts the torch is lifted " + fixed(joints.clearance(), 0) +
                        " mm clear of the tube");
  return out;
}

std::string linear_axes(const TorchJoints& joints, const FormatOptions& o) {
  const auto& post = post_of(o);
  std::string out;
  if (joints.tilts() && o.pivot_length)
    out += post.comment(std::string(1, joints.across().letter) +
                        ": the pivot across, growing phi is " + (joints.phi_to_plus() ? "+" : "-") +
                        joints.across().letter);
  if (joints.tilts())
    out += post.comment(std::string(1, joints.tilt().letter) + " tilts it across, " +
                        sense(joints.tilt()) + ": outer edge towards growing phi, tan " +
                        joints.swing().letter + " and tan " + joints.tilt().letter +
                        " are each over the way outwards");
  return out + post.comment(
                   o.pivot_length
                       ? "linear axes are the torch pivot, " + fixed(*o.pivot_length, 3) +
                             " mm from the tip, the one across is its height over the tube axis"
                       : "linear axes are the torch tip on the outer wall: the control must know "
                         "it");
}

std::string header(const TorchJob& job, const std::vector<Way>& ways, const TorchJoints& joints,
                   const Straightness& moves, const Caption& caption) {
  const auto& o = caption.options;
  const auto& post = post_of(o);
  const auto& turn = joints.turn();
  std::string out = gcode_job(caption);
  out += post.comment("tube " + fixed(2.0 * job.outer_radius, 3) + " x " + fixed(job.wall, 3) +
                      " mm") +
         post.comment("tool: torch, kerf " + kerfs(ways) + " mm, applied to the path") +
         post.comment("units mm, deg, mm/min") +
         post.comment(
             std::string(1, turn.letter) + " turns the tube: " + (turn.reversed ? "-phi" : "phi") +
             " in deg, from x towards y. " + joints.along().letter + " goes along it: mm, " +
             (joints.along().reversed ? "-z" : "+z") + " of the result") +
         extent(job, ways, joints, o) + axes(joints, o);
  if (!joints.has_pivot() && ways.size() > 1)
    out += post.comment(
        "between cuts the control must lift the torch: after each that ends, "
        "before the rapid to the next");
  out += linear_axes(joints, o) + how_it_starts(joints, o);
  out += post.comment("moves: tip and both edges within " + fixed(moves.sag, 4) +
                      " mm of straight lines between the rows, blocks inserted for it: " +
                      std::to_string(moves.inserted));
  out += post.comment(o.torch ? "THIS PROGRAM LIGHTS THE TORCH"
                              : "dry run: the torch stays off, ask with torch=on");
  for (const auto& remark : job.remarks) out += post.comment(remark);
  return out;
}

std::string modes(const Caption& caption) {
  const auto& post = post_of(caption.options);
  return post_lines(post.speed, {{"speed_mm_min", fixed(*caption.options.speed, 3)}}) +
         post_lines(post.modes) + post_lines(post.tool);
}

/// A move in the time that the torch needs along `length` of the outer wall. `distance`: of all
/// axes.
std::string timed(const std::string& words, double length, double distance,
                  const FormatOptions& o) {
  const double rate = *o.speed / std::max(length, kSlow);  // 1/min
  return post_line(post_of(o).cut_move,
                   {{"axes", words},
                    {"length_mm", fixed(std::max(length, kSlow), 6)},
                    {"per_minute", fixed(rate, 6)},
                    {"units_per_minute", fixed(std::max(distance * rate, kSlow), 3)}});
}

/// What is said of a cut before its blocks.
std::string title(const Way& way, const TorchJoints& joints, const FormatOptions& o) {
  const auto& post = post_of(o);
  std::string out;
  if (!way.name.empty()) out += post.comment("cut: " + way.name);
  const auto at = [](const PostAxis& axis, double angle) {
    return axis.letter + fixed(axis.counted(angle * kDegPerRad), 3);
  };
  if (o.lead > 0.0 || o.start)
    out += post.comment("starts at " + at(joints.turn(), way.start.phi) + ", z " +
                        fixed(way.start.z, 3) + " mm, " + at(joints.swing(), way.start.b));
  if (way.radius < o.lead)
    out += post.comment("leads of " + fixed(way.radius, 3) + " mm: the scrap has no room for more");
  return out;
}

/// Between two cuts; nothing where the control moves the tip.
std::string retract(const TorchJoints& joints, const Post& post) {
  return joints.has_pivot() ? post_line(post.rapid, {{"axes", joints.clear_height()}}) : "";
}

/// From the retract before one cut to the one behind it.
std::string print_cut(const TorchJob& job, const Way& way, const TorchJoints& joints,
                      const Caption& caption) {
  const auto& o = caption.options;
  const auto& post = post_of(o);
  const auto& first = way.places.front();
  const double off = o.cut_height.value_or(0.0), above = o.pierce_height.value_or(off);
  std::string out = title(way, joints, o) + retract(joints, post);
  const auto rapid = [&](const std::string& words) {
    out += post_line(post.rapid, {{"axes", words}});
  };
  if (joints.has_pivot()) {
    rapid(joints.level_words(first, above));
    rapid(joints.height(first, above));
  } else {
    rapid(joints.words(first, 0.0));
  }
  if (o.torch) out += post_lines(post.torch_on);
  if (o.pierce_delay) out += post_line(post.dwell, {{"seconds", fixed(*o.pierce_delay, 3)}});
  out += post_lines(post.cut_begin);
  const auto go = [&](const TorchPlace& from, double from_off, const TorchPlace& to,
                      double length) {
    out += timed(joints.words(to, off), length, joints.distance(from, from_off, to, off), o);
  };
  if (above != off) go(first, above, first, std::abs(above - off));
  for (std::size_t i = 1; i < way.places.size(); ++i) {
    ask(caption.stop);
    go(way.places[i - 1], off, way.places[i], step(job, way.places[i - 1], way.places[i]));
  }
  return out + post_lines(post.cut_end) + post_lines(post.torch_off);
}

std::string remark(const part::Mark& mark) {
  const char* kind = mark.kind == part::Mark::Kind::datum_line ? "datum line"
                     : mark.kind == part::Mark::Kind::partner  ? "partner"
                                                               : "part mark";
  return std::string("mark by hand: ") + kind + " " + mark.text + " at A" +
         fixed(mark.phi * kDegPerRad, 3) + " from " + fixed(mark.z_from, 2) + " to " +
         fixed(mark.z_to, 2) + " mm";
}

}  // namespace

std::string gcode_job(const Caption& caption) {
  const auto& post = post_of(caption.options);
  std::string out = post.comment("tubecut " + std::string(version())) +
                    post.comment("input sha256 " + caption.input_sha256);
  for (const auto& [name, text] : caption.reference)
    out += post.comment(std::string(name) + ": " + text);
  for (const auto& line : verdict_lines(caption.verdict)) out += post.comment(line);
  return out;
}

const std::vector<std::string_view>& gcode_options() {
  static const std::vector<std::string_view> kOptions{
      "speed_mm_min",     "post",           "dialect",       "torch",        "axial",
      "lead_mm",          "overcut_mm",     "start_deg",     "pierce_b_deg", "pivot_length_mm",
      "pierce_height_mm", "pierce_delay_s", "cut_height_mm", "clearance_mm", "acknowledge"};
  return kOptions;
}

TorchJob torch_job(const bevel::TableSpec& spec, const bevel::Table& table) {
  return {.outer_radius = spec.target.outer_radius,
          .wall = spec.target.wall,
          .cuts = {torch::torch_cut(spec, table)}};
}

TorchJob torch_job(const part::PartSpec& spec, const part::Part& part) {
  TorchJob out{.outer_radius = spec.target.outer_radius,
               .wall = spec.target.wall,
               .cuts = torch::torch_cuts(spec, part)};
  out.remarks.push_back("blank " + fixed(part.lengths.blank, 2) + " mm, finished part " +
                        fixed(part.lengths.longest, 2) + " mm tip to tip from z 0 on");
  for (const auto& step : part.sequence)
    if (step.what == part::Step::What::mark) out.remarks.push_back(remark(part.marks[step.index]));
  return out;
}

std::string print_gcode(const TorchJob& job, const Caption& caption) {
  const auto& post = post_of(caption.options);
  const bool tilts =
      std::ranges::any_of(job.cuts, [](const auto& cut) { return !cut.path.a.empty(); });
  const TorchJoints joints(job.outer_radius, tilts, caption.options);
  Straightness moves;
  const auto ways = ways_of(job, caption, moves);
  std::string out =
      post_lines(post.begin) + header(job, ways, joints, moves, caption) + modes(caption);
  for (const auto& way : ways) out += print_cut(job, way, joints, caption);
  return post.numbered(out + retract(joints, post) + post_lines(post.end));
}

}  // namespace tubecut::api
