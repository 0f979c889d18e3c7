#include "api/formats/gcode/gcode_header.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "api/api.hpp"
#include "api/catalog/post.hpp"
#include "api/catalog/posts.hpp"
#include "api/formats/numbers.hpp"
#include "api/formats/text.hpp"
#include "api/verdict.hpp"
#include "api/wire/words.hpp"
#include "core/base/angle.hpp"
#include "core/base/elementary.hpp"

namespace tubecut::api {
namespace {

constexpr double kSlow = 1e-3;  // mm, least length a move's time is taken from

std::string letter(const PostAxis& axis) { return std::string(1, axis.letter); }
/// "+X", or "-X" of an axis that counts against the way.
std::string towards(const PostAxis& axis) { return (axis.reversed ? "-" : "+") + letter(axis); }
std::string growing(const PostAxis& axis) {
  return (axis.reversed ? "falling " : "growing ") + letter(axis);
}

/// Returns the unit of a rotation that is not an angle.
std::string turn_word(const PostAxis& turn) {
  switch (turn.unit) {
    case TurnUnit::deg:
      return "deg";
    case TurnUnit::mm_girth:
      return "mm of circumference";
    case TurnUnit::inch_girth:
      return "inch of circumference";
    case TurnUnit::revolution:
      return "revolutions";
  }
  return "";
}

/// How far a turn of the tube is on such an axis.
std::string turn_unit(const PostAxis& turn, double outer_radius, const Post& post) {
  if (!turn.is_girth()) return letter(turn) + " counts revolutions of the tube";
  const double diameter = turn.diameter.value_or(2.0 * outer_radius);
  constexpr double kTurn = 360.0;  // deg
  return letter(turn) + " counts " + turn_word(turn) + " of a diameter of " +
         post.length(diameter) + ", a turn is " + fixed(kTurn * turn.scale, turn.decimals);
}

/// Returns one kerf for all cuts, or each in their order; a mark has no kerf.
std::string kerfs(const std::vector<TorchCutPlaces>& cuts, const Post& post) {
  std::vector<double> all;
  for (const auto& cut : cuts)
    if (!cut.mark) all.push_back(cut.kerf);
  if (std::ranges::count(all, all.front()) == std::ssize(all)) return post.length(all.front());
  std::string out;
  for (std::size_t i = 0; i + 1 < all.size(); ++i) out += post.length_number(all[i]) + ", ";
  return out + post.length(all.back()) + " in the order of the cuts";
}

/// The values derived only from the positions.
struct Extent {
  double least = 0.0, most = 0.0;  // of the axis along the tube, mm
  double length = 0.0;             // of all cuts with their leads and ways down, mm
  std::size_t pierces = 0;
};

/// `down`: from the height of the pierce to that of the cut, mm.
Extent extent(const TorchJob& job, const std::vector<TorchCutPlaces>& cuts,
              const TorchJoints& joints, double off, double down) {
  const auto along = [&](const TorchPlace& at) {
    return joints.along().counted(joints.along_at(at, off)) / joints.along().scale;
  };
  Extent out;
  out.least = out.most = along(cuts.front().places.front());
  for (const auto& cut : cuts) {
    if (!cut.mark) {
      ++out.pierces;
      out.length += down;
    }
    for (std::size_t i = 0; i < cut.places.size(); ++i) {
      const double at = along(cut.places[i]);
      out.least = std::min(out.least, at);
      out.most = std::max(out.most, at);
      if (i > 0 && !cut.mark) out.length += way_between(job, cut.places[i - 1], cut.places[i]);
    }
  }
  return out;
}

using Lines = std::vector<std::string>;

std::string tube_line(const TorchJob& job, const Post& post) {
  const auto& s = job.section;
  if (!s)
    return "tube " + post.length_number(2.0 * job.outer_radius) + " x " + post.length(job.wall);
  return "tube " + post.length_number(s->height) + " x " + post.length_number(s->width) + " x " +
         post.length(s->wall) + ", corners " + post.length(s->corner) + " outside";
}

/// "units mm, deg, mm/min".
std::string units_line(const Post& post, const PostAxis& turn) {
  const std::string units(name_of(post.units));
  return "units " + units + ", deg, " + units + "/min" +
         (turn.unit == TurnUnit::deg ? "" : ", " + letter(turn) + " in " + turn_word(turn));
}

/// Adds the zeros and the directions of the axes.
void add_axes(const TorchJob& job, const TorchJoints& joints, const FormatOptions& o, Lines& out) {
  const auto& post = post_of(o);
  const auto& turn = joints.turn();
  const auto x = letter(joints.along());
  out.push_back(joints.along().zero() + ": " + job.zero + ", " + towards(joints.along()) + ": " +
                job.onward);
  // The generator of phi lies under the torch at A = phi, so that the tube turns against phi.
  out.push_back(turn.zero() + ": " + job.line + " under the torch, " + growing(turn) +
                " turns the tube counter-clockwise, seen from " + job.seen_from);
  if (turn.unit != TurnUnit::deg) out.push_back(turn_unit(turn, job.outer_radius, post));
  if (joints.has_swing())
    out.push_back(joints.swing().zero() + ": the torch square to the tube, " +
                  growing(joints.swing()) + " leans its upper end towards " +
                  towards(joints.along()) + ", the outer edge then lies further that way");
  if (joints.tilts())
    out.push_back(joints.tilt().zero() + ": not tilted across, " + growing(joints.tilt()) +
                  " leans its upper end across" +
                  (joints.has_pivot()
                       ? std::string(", towards ") + (joints.phi_to_plus() ? "+" : "-") +
                             letter(joints.across())
                       : std::string(", towards growing ") + letter(turn)) +
                  ", tangents of " + letter(joints.swing()) + " and " + letter(joints.tilt()) +
                  " are each over the way outwards");
  if (joints.follows())
    out.push_back(letter(turn) + " keeps the normal of the wall up, " + letter(joints.across()) +
                  " and " + letter(joints.out()) + " follow the wall, " + joints.across().zero() +
                  ": over the axis of the tube, face 2 lies to " +
                  (joints.phi_to_plus() ? "+" : "-") + letter(joints.across()));
  const bool crosses = joints.tilts() || joints.follows();
  const auto carried = x + (crosses ? ", " + letter(joints.across()) : "") + " and " +
                       letter(joints.out()) + " carry the ";
  if (o.pivot_length)
    out.push_back(carried +
                  (*o.pivot_length > 0.0
                       ? "pivot of the torch, " + post.length(*o.pivot_length) + " from its tip, "
                       : std::string("tip of the torch, ")) +
                  joints.out().zero() + ": the axis of the tube");
  else
    out.push_back(x + " carries the tip of the torch on the outer wall: the control must know it");
}

void add_starts(const TorchJoints& joints, const FormatOptions& o, Lines& out) {
  const auto& post = post_of(o);
  const double cut = o.cut_height.value_or(0.0);
  if (post.of_control)
    out.push_back("heights and delay of the pierce: " + *post.of_control);
  else if (o.pivot_length)
    out.push_back("pierce " + post.length(o.pierce_height.value_or(cut)) + " off the wall, delay " +
                  measure(o.pierce_delay.value_or(0.0), Unit::s) + ", cut " + post.length(cut) +
                  " off it along the torch");
  else
    out.emplace_back("heights and the lift between cuts are of the control");
  if (o.lead.value_or(0.0) > 0.0) {
    out.push_back("leads: arcs of 60 deg on the scrap side, radius " + post.length(*o.lead) +
                  ", overcut " + post.length(o.overcut.value_or(motion::Lead{}.overcut)) +
                  ", clear of the part");
    if (!o.start)
      out.push_back((joints.follows() ? "the cut starts on a flat at its least bevel that is "
                                      : "each cut starts at its least bevel that is ") +
                    post.length(motion::kFromJunction) + " and more off its junctions and off " +
                    joints.turn().zero());
  }
}

void add_order(const std::vector<TorchCutPlaces>& cuts, Lines& out) {
  if (cuts.front().name.empty()) return;
  std::string line = "order of cuts:";
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    const auto next =
        " " + std::to_string(i + 1) + " " + cuts[i].name + (i + 1 < cuts.size() ? "," : "");
    if (line.size() + next.size() > 100) {
      out.push_back(std::move(line));
      line = "...";
    }
    line += next;
  }
  out.push_back(std::move(line));
}

}  // namespace

double way_between(const TorchJob& job, const TorchPlace& from, const TorchPlace& to) {
  const double tip = elementary::hypot(job.outer_radius * (to.phi - from.phi), to.z - from.z);
  return tip > kSlow ? tip
                     : std::max(kSlow, job.wall * elementary::hypot(to.b - from.b, to.a - from.a));
}

std::string gcode_job(const Caption& caption) {
  const auto& post = post_of(caption.options);
  auto out =
      post.comment(engine() + ", numerics " + std::to_string(numerics()) + ", post " + post.name);
  for (const auto& [name, text] : caption.reference)
    out += post.comment(called(name, Term::field) + ": " + text);
  for (const auto& line : verdict_lines(caption.verdict, {.plain = true}))
    out += post.comment(degrees_spelled(line));
  return out;
}

std::string gcode_torch(const FormatOptions& options) {
  return post_of(options).comment(options.torch
                                      ? "THIS PROGRAM LIGHTS THE TORCH"
                                      : "dry run: the torch stays off, torch=on lights it");
}

std::string gcode_hashes(const Caption& caption) {
  const auto& post = post_of(caption.options);
  return post.comment("input sha256 " + caption.input_sha256) +
         post.comment("result sha256 " + caption.result_sha256);
}

std::string program_header(const TorchJob& job, const std::vector<TorchCutPlaces>& cuts,
                           const TorchJoints& joints, const Straightness& moves,
                           const Caption& caption) {
  const auto& o = caption.options;
  const auto& post = post_of(o);
  const double height = o.cut_height.value_or(0.0);
  const double down = std::abs(o.pierce_height.value_or(height) - height);
  const auto found = extent(job, cuts, joints, height, down);
  const double pierces = o.pierce_delay.value_or(0.0) * static_cast<double>(found.pierces);
  Lines lines{tube_line(job, post)};
  lines.insert(lines.end(), job.lengths.begin(), job.lengths.end());
  lines.push_back(units_line(post, joints.turn()));
  add_axes(job, joints, o, lines);
  lines.push_back(letter(joints.along()) + " from " + post.length_number(found.least) + " to " +
                  post.length(found.most) + " while cutting");
  lines.push_back("tool: torch, kerf " + kerfs(cuts, post) + ", applied to the path");
  lines.push_back("feed " + post.speed_text(*o.speed) + " on the outer wall");
  lines.insert(lines.end(), job.process.begin(), job.process.end());
  add_starts(joints, o, lines);
  if (joints.has_pivot())
    lines.push_back("between cuts the torch is lifted " + post.length(joints.clearance()) +
                    " clear of the tube");
  else if (cuts.size() > 1)
    lines.emplace_back(
        "between cuts the control must lift the torch: after each that ends, before the rapid to "
        "the next");
  lines.push_back(std::to_string(found.pierces) + (found.pierces == 1 ? " cut, " : " cuts, ") +
                  post.length(found.length) + " in " +
                  measure(60.0 * found.length / *o.speed + pierces, Unit::s) +
                  " with the way down and the delay of each pierce, without rapids");
  add_order(cuts, lines);
  lines.push_back("moves: tip and both edges within " +
                  post.bound(moves.sag + joints.rounding(job.wall)) +
                  " of straight lines between the rows, blocks inserted for it: " +
                  std::to_string(moves.inserted));
  lines.insert(lines.end(), job.by_hand.begin(), job.by_hand.end());
  auto out = gcode_job(caption) + gcode_torch(o);
  for (const auto& line : lines) out += post.comment(line);
  return out + gcode_hashes(caption);
}

std::string cut_title(const TorchCutPlaces& cut, const TorchJoints& joints,
                      const FormatOptions& o) {
  const auto& post = post_of(o);
  std::string out;
  if (cut.mark) return post.comment(cut.name);
  if (!cut.name.empty()) out += post.comment("cut: " + cut.name);
  if (o.lead.value_or(0.0) > 0.0 || o.start)
    out += post.comment(
        "starts at " + joints.turn().shown(joints.turn_at(cut.start())) + ", " +
        (joints.has_swing() ? joints.swing().shown(cut.start().b * kDegPerRad) + ", " : "") +
        post.length(cut.start().z) + " from " + joints.along().zero());
  if (cut.open) {
    if (o.lead) out += post.comment("a slit has no leads: the torch goes over it from its pierce");
  } else if (cut.radius < o.lead.value_or(0.0)) {
    out += post.comment(
        cut.radius > 0.0
            ? "leads of " + post.length(cut.radius) + ": the scrap has no room for more"
            : "from the middle of the scrap, which has no room for leads along the cut");
  }
  return out;
}

}  // namespace tubecut::api
