#include "api/formats/gcode/gcode.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "api/catalog/posts.hpp"
#include "api/formats/drawing/point_pairs.hpp"
#include "api/formats/gcode/gcode_header.hpp"
#include "api/formats/gcode/section_moves.hpp"
#include "api/formats/gcode/torch_joints.hpp"
#include "api/formats/gcode/torch_moves.hpp"
#include "api/formats/gcode/torch_process.hpp"
#include "api/formats/numbers.hpp"
#include "api/formats/text.hpp"
#include "api/stop.hpp"
#include "api/wire/motion_names.hpp"
#include "core/base/elementary.hpp"
#include "core/torch/stretches.hpp"
#include "core/torch/torch_program.hpp"

namespace tubecut::api {
namespace {

constexpr double kSlow = 1e-3;    // mm, least length a node's time is taken from
constexpr double kSag = 0.019;    // mm, of one move; below 0.02 with the rounding of its words
constexpr double kMostSag = 0.1;  // mm; more is a fault of ours

TorchPlace place(const motion::CutPoint& p, const torch::TorchCut& cut) {
  return {p.phi, p.z, p.b, p.a, cut.on_flat, cut.path.still};
}

torch::Setup setup_of(const FormatOptions& o) {
  torch::Setup out{.pierce_height = o.pierce_height};
  const auto deg = [](const std::optional<double>& v) {
    return v ? std::optional(Angle::deg(*v)) : std::nullopt;
  };
  if (const double lead = o.lead.value_or(0.0); lead > 0.0) {
    out.lead = {.radius = lead, .pierce_b = deg(o.pierce_bevel)};
    if (o.overcut) out.lead->overcut = *o.overcut;
  }
  out.start = deg(o.start);
  out.clearance = o.clearance.value_or(out.clearance);
  out.cut_height = o.cut_height.value_or(0.0);
  out.pierce_delay = o.pierce_delay.value_or(0.0);
  out.tabs = o.tabs;
  return out;
}

/// Adds positions if a move of all axes would sag.
void refine(const motion::CutWithLead& way, const torch::TorchCut& cut, const TorchReach& reach,
            const std::optional<SectionTurn>& turn, Straightness& told, TorchCutPlaces& out) {
  const auto& points = way.points;
  out.places = {place(points.front(), cut)};
  for (std::size_t i = 1; i < points.size(); ++i) {
    ask();
    auto at = place(points[i - 1], cut);
    const auto next_row = place(points[i], cut);
    const auto moves = turn ? turn->moves(reach, at, next_row, kSag, told.sag)
                            : straight_moves(reach, at, next_row, kSag);
    told.inserted += moves.size() - 1;
    for (const auto& next : moves) {
      if (!turn) told.sag = std::max(told.sag, sag(reach, at, next));
      out.places.push_back(at = next);
    }
    if (i == way.cut_first) out.cut_first = out.places.size() - 1;
    if (i == way.cut_last) out.cut_last = out.places.size() - 1;
  }
}

std::string at_most(const Issue& issue) {
  const auto* const limit = std::get_if<double>(&issue.limit);
  return limit == nullptr ? "" : ", at most " + fixed(*limit, 0) + " have room";
}

[[noreturn]] void refuse(const torch::TorchCut& cut, const FormatOptions& options,
                         const Error& error) {
  const auto& issue = error.issues.front();
  const std::string of = cut.name.empty() ? "the cut" : "cut " + cut.name;
  if (issue.member.starts_with("tabs"))
    throw UnfitOption{issue.code == ErrorCode::out_of_range ? "tabs" : "tab_mm",
                      of + ": " + issue.hint + at_most(issue)};
  const bool blocked = issue.code == ErrorCode::lead_blocked;
  const std::string why =
      blocked ? "an arc of " + fixed(torch::kShortestLead, 0) + " mm or more would enter the part"
      : issue.hint.empty() ? std::string(info(issue.code).meaning)
                           : issue.hint;
  throw UnfitOption{options.start && !blocked ? "start_deg" : "lead_mm", of + ": " + why};
}

/// Returns the radius of the leads, or the way from the middle of the scrap onto the cut; mm.
double lead_of(const torch::TorchWay& way, double outer_radius) {
  return way.radius > 0.0 ? way.radius : torch::from_edge(way.points, outer_radius);
}

std::vector<TorchCutPlaces> ways_of(const TorchJob& job, const Caption& caption,
                                    Straightness& moves) {
  const auto& o = caption.options;
  const TorchReach reach{
      .outer_radius = job.outer_radius,
      .inner_radius = job.outer_radius - job.wall,
      .pivot = o.pivot_length ? *o.pivot_length + o.cut_height.value_or(0.0) : 0.0};
  const auto turn = job.section ? std::optional<SectionTurn>(*job.section) : std::nullopt;
  std::vector<TorchCutPlaces> out;
  for (const auto& cut : job.cuts) {
    const auto laid = torch::program_cut(cut, setup_of(o), &cut == &job.cuts.back(), {});
    ask();
    if (!laid) refuse(cut, o, laid.error());
    for (const auto& each : *laid) {
      const auto& way = each.way;
      if (!cut.mark && !cut.open && lead_of(way, job.outer_radius) < job.shortest_lead)
        throw UnfitOption{"lead_mm", (cut.name.empty() ? "the cut" : "cut " + cut.name) +
                                         ": the scrap has no room for the shortest lead of the "
                                         "machine's table, " +
                                         mm(job.shortest_lead) + "; lead_mm states another"};
      out.push_back({.name = each.cut.name,
                     .places = {},
                     .kerf = cut.kerf,
                     .radius = way.radius,
                     .mark = cut.mark,
                     .open = cut.open});
      refine(way.points, cut, reach, turn, moves, out.back());
    }
  }
  // A program that strays is worse than none.
  if (moves.sag > kMostSag)
    throw std::runtime_error("the moves of a program stray by " + fixed(moves.sag, 3) + " mm");
  return out;
}

std::string modes(const Caption& caption) {
  const auto& post = post_of(caption.options);
  const auto speed = post.speed_word(*caption.options.speed);
  return post_lines(post.speed, {{"speed_mm_min", speed}, {"speed", speed}}) +
         post_lines(post.modes) + post_lines(post.tool);
}

/// A move in the time that the tool needs along `length` of the outer wall; a mark's has its own
/// speed. `distance`: of all axes together, as they are written.
std::string timed(const std::string& words, double length, double distance,
                  const std::vector<AxisMove>& moves, bool mark, const FormatOptions& o) {
  const double speed = mark ? o.mark_speed.value_or(*o.speed) : *o.speed;
  const double rate = speed / std::max(length, kSlow);  // 1/min
  const auto& post = post_of(o);
  const auto way = post.length_word(std::max(length, kSlow));
  return post_line(mark ? post.timed_move : post.cut_move,
                   {{"axes", words},
                    {"length_mm", way},
                    {"length", way},
                    {"per_minute", fixed(rate, 6)},
                    {"units_per_minute", post.way_feed(distance * rate)},
                    {"linear_units_per_minute", linear_feed(moves, rate)},
                    {"axes_feeds", axes_feeds(moves, rate)}});
}

/// Returns the move between two cuts; empty if the control moves the tip.
std::string retract(const TorchJoints& joints, const Post& post) {
  return joints.has_pivot() ? post_line(post.rapid, {{"axes", joints.clear_height()}}) : "";
}

/// From the retract before one cut to the one behind it.
void print_cut(const TorchJob& job, const TorchCutPlaces& way, const TorchJoints& joints,
               const Caption& caption, std::string& out) {
  const auto& o = caption.options;
  const auto& post = post_of(o);
  const auto& first = way.places.front();
  const double off = o.cut_height.value_or(0.0);
  const double above = way.mark ? off : o.pierce_height.value_or(off);
  const auto add = [&](std::string_view lines) { out += lines; };
  const auto rapid = [&](const std::string& words) {
    add(post_line(post.rapid, {{"axes", words}}));
  };
  add(cut_title(way, joints, o) + retract(joints, post));
  if (joints.has_pivot()) {
    rapid(joints.level_words(first, above));
    rapid(joints.height(first, above));
  } else {
    rapid(joints.words(first, 0.0));
  }
  if (o.torch) add(post_lines(way.mark ? post.mark_on : post.torch_on));
  if (o.pierce_delay && !way.mark)
    add(post_line(post.dwell, {{"seconds", fixed(*o.pierce_delay, 3)}}));
  add(post_lines(post.cut_begin));
  const bool by_axes = feeds_by_axes(way.mark ? post.timed_move : post.cut_move);
  const auto go = [&](const TorchPlace& from, double from_off, const TorchPlace& to,
                      double length) {
    add(timed(joints.words(to, off), length, joints.distance(from, from_off, to, off),
              by_axes ? joints.moves(from, from_off, to, off) : std::vector<AxisMove>{}, way.mark,
              o));
  };
  if (above != off) go(first, above, first, std::abs(above - off));
  for (std::size_t i = 1; i < way.places.size(); ++i) {
    ask();
    go(way.places[i - 1], off, way.places[i], way_between(job, way.places[i - 1], way.places[i]));
  }
  add(post_lines(post.cut_end) + post_lines(way.mark ? post.mark_off : post.torch_off));
}

TorchJoints::Leaning leaning(const TorchJob& job) {
  TorchJoints::Leaning out;
  for (const auto& cut : job.cuts) {
    out.along = out.along || std::ranges::any_of(cut.path.b, [](double b) { return b != 0.0; });
    out.across = out.across || !cut.path.a.empty();
  }
  return out;
}

/// Writes the head's lines on tabs, or the reason why a program has no tabs.
void tell_tabs(TorchJob& job, const FormatOptions& o) {
  if (!o.tabs) return;
  std::size_t held = 0;
  for (const auto& cut : job.cuts) held += torch::holds(*o.tabs, cut, &cut == &job.cuts.back());
  if (held == 0)
    throw UnfitOption{"tabs_of",
                      "no cut of this program is one of its " + std::string(name_of(o.tabs->of))};
  if (std::ranges::any_of(job.cuts, &torch::TorchCut::of_land))
    throw UnfitOption{"tabs", "the pass of a land and the bevel's would each leave its own"};
  job.process.push_back("tabs: " + std::to_string(o.tabs->count) + " of " +
                        post_of(o).length(o.tabs->width) + " and more on both walls in each of " +
                        std::to_string(held) + (held == 1 ? " cut" : " cuts") +
                        ", each come onto square and without overcut: break them off, then dress "
                        "the edge");
}

void tell_marks(TorchJob& job, const FormatOptions& o) {
  if (!o.marks) return;
  const auto strokes = std::ranges::count(job.cuts, true, &torch::TorchCut::mark);
  if (strokes == 0) throw UnfitOption{"marks", "only a part has marks"};
  job.process.push_back("marks: " + std::to_string(strokes) +
                        (strokes == 1 ? " stroke" : " strokes") + " at the cutting height, feed " +
                        post_of(o).speed_text(o.mark_speed.value_or(*o.speed)) +
                        (o.torch ? "" : ", the tool stays off"));
}

/// A bevel on a land does not cut the land, so a program that lights the torch must confirm this.
/// Its head states it.
void tell_lands(TorchJob& job, const FormatOptions& o) {
  for (const auto& cut : job.cuts) {
    if (cut.land == 0.0) continue;
    const auto of = cut.name.empty() ? std::string("the cut") : "cut " + cut.name;
    refuse_land(of, cut.land, o);
    if (o.passes == Passes::bevel)
      job.process.push_back(of + ": ONLY THE BEVEL, its land of " + post_of(o).length(cut.land) +
                            " is left to a pass before it");
  }
  if (std::ranges::any_of(job.cuts, &torch::TorchCut::of_land))
    job.process.emplace_back(
        "lands: a pass of their own before the bevel, which takes the scrap off: the bevel's "
        "starts "
        "beside the metal");
}

}  // namespace

void refuse_land(const std::string& of, double land, const FormatOptions& o) {
  if (land > 0.0 && o.torch && o.passes == Passes::unsaid)
    throw UnfitOption{"passes", of + " has a land of " + mm(land) +
                                    " at its root, which the bevel's pass does not cut: "
                                    "passes=both cuts it first, where the part is still held; "
                                    "passes=bevel if it is cut otherwise"};
}

const std::vector<std::string_view>& gcode_options() {
  static const std::vector<std::string_view> kOptions{
      "speed_mm_min",     "post",           "dialect",          "torch",        "axial",
      "lead_mm",          "overcut_mm",     "start_deg",        "pierce_b_deg", "pivot_length_mm",
      "pierce_height_mm", "pierce_delay_s", "cut_height_mm",    "clearance_mm", "acknowledge",
      "machine",          "material",       "passes",           "tabs",         "tab_mm",
      "tabs_of",          "marks",          "mark_speed_mm_min"};
  return kOptions;
}

std::string print_gcode(TorchJob job, Caption caption) {
  tell_lands(job, caption.options);
  tell_tabs(job, caption.options);
  take_process(job, caption.options);
  tell_marks(job, caption.options);
  const auto& post = post_of(caption.options);
  Straightness moves;
  if (post.is_point_pairs() && job.section)
    throw UnfitOption{"post", "point pairs are of round targets: take a post with axes"};
  if (post.is_point_pairs())
    return print_point_pairs(job, ways_of(job, caption, moves), moves, caption);
  const TorchJoints joints(job.outer_radius, job.section, leaning(job), caption.options);
  const auto ways = ways_of(job, caption, moves);
  std::string out =
      post_lines(post.begin) + program_header(job, ways, joints, moves, caption) + modes(caption);
  for (const auto& way : ways) print_cut(job, way, joints, caption, out);
  out += retract(joints, post) + post_lines(post.end);
  return post.numbered(std::move(out));
}

}  // namespace tubecut::api
