#include "api/formats/gcode_header.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "api/api.hpp"
#include "api/formats/numbers.hpp"
#include "api/formats/text.hpp"
#include "api/post.hpp"
#include "api/posts.hpp"
#include "api/verdict.hpp"
#include "api/words.hpp"
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

/// One for all cuts, or each in their order; a mark has none.
std::string kerfs(const std::vector<TorchCutPlaces>& cuts) {
  std::vector<double> all;
  for (const auto& cut : cuts)
    if (!cut.mark) all.push_back(cut.kerf);
  auto out = number(all.front(), Unit::mm);
  if (std::ranges::count(all, all.front()) == std::ssize(all)) return out + " mm";
  for (std::size_t i = 1; i < all.size(); ++i) out += ", " + number(all[i], Unit::mm);
  return out + " mm in the order of the cuts";
}

/// What is read of the places alone.
struct Extent {
  double least = 0.0, most = 0.0;  // of the axis along the tube
  double length = 0.0;             // of all cuts with their leads, mm
  std::size_t pierces = 0;
};

Extent extent(const TorchJob& job, const std::vector<TorchCutPlaces>& cuts,
              const TorchJoints& joints, double off) {
  const auto along = [&](const TorchPlace& at) {
    return joints.along().counted(joints.along_at(at, off));
  };
  Extent out;
  out.least = out.most = along(cuts.front().places.front());
  for (const auto& cut : cuts) {
    if (!cut.mark) ++out.pierces;
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

/// Where the axes' zeros are, and which way they go.
void add_axes(const TorchJob& job, const TorchJoints& joints, const FormatOptions& o, Lines& out) {
  const auto& turn = joints.turn();
  const auto x = letter(joints.along());
  out.push_back(joints.along().zero() + ": " + job.zero + ", " + towards(joints.along()) + ": " +
                job.onward);
  // The generator of phi lies under the torch at A = phi, so that the tube turns against phi.
  out.push_back(turn.zero() + ": " + job.line + " under the torch, " + growing(turn) +
                " turns the tube counter-clockwise, seen from " + job.seen_from);
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
  const auto carried = x + (joints.tilts() ? ", " + letter(joints.across()) : "") + " and " +
                       letter(joints.out()) + " carry the ";
  if (o.pivot_length)
    out.push_back(carried +
                  (*o.pivot_length > 0.0
                       ? "pivot of the torch, " + mm(*o.pivot_length) + " from its tip, "
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
    out.push_back("pierce " + mm(o.pierce_height.value_or(cut)) + " off the wall, delay " +
                  measure(o.pierce_delay.value_or(0.0), Unit::s) + ", cut " + mm(cut) +
                  " off it along the torch");
  else
    out.emplace_back("heights and the lift between cuts are of the control");
  if (o.lead.value_or(0.0) > 0.0) {
    out.push_back("leads: arcs of 60 deg on the scrap side, radius " + mm(*o.lead) + ", overcut " +
                  mm(o.overcut.value_or(motion::Lead{}.overcut)) + ", clear of the part");
    if (!o.start)
      out.push_back("each cut starts at its least bevel that is " + mm(motion::kFromJunction) +
                    " and more off its junctions and off " + joints.turn().zero());
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
  auto out = post.comment("tubecut " + std::string(version()) + ", post " + post.name);
  for (const auto& [name, text] : caption.reference)
    out += post.comment(called(name, Term::field) + ": " + text);
  for (const auto& line : verdict_lines(caption.verdict, {.plain = true}))
    out += post.comment(degrees_spelled(line));
  return out;
}

std::string gcode_torch(const FormatOptions& options) {
  return post_of(options).comment(options.torch
                                      ? "THIS PROGRAM LIGHTS THE TORCH"
                                      : "dry run: the torch stays off, ask with torch=on");
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
  const auto found = extent(job, cuts, joints, o.cut_height.value_or(0.0));
  const double pierces = o.pierce_delay.value_or(0.0) * static_cast<double>(found.pierces);
  Lines lines{"tube " + number(2.0 * job.outer_radius, Unit::mm) + " x " + mm(job.wall)};
  lines.insert(lines.end(), job.lengths.begin(), job.lengths.end());
  lines.push_back("units mm, deg, mm/min");
  add_axes(job, joints, o, lines);
  lines.push_back(letter(joints.along()) + " from " + number(found.least, Unit::mm) + " to " +
                  mm(found.most) + " while cutting");
  lines.push_back("tool: torch, kerf " + kerfs(cuts) + ", applied to the path");
  lines.push_back("feed " + measure(*o.speed, Unit::mm_min) + " on the outer wall");
  lines.insert(lines.end(), job.process.begin(), job.process.end());
  add_starts(joints, o, lines);
  if (joints.has_pivot())
    lines.push_back("between cuts the torch is lifted " + mm(joints.clearance()) +
                    " clear of the tube");
  else if (cuts.size() > 1)
    lines.emplace_back(
        "between cuts the control must lift the torch: after each that ends, before the rapid to "
        "the next");
  lines.push_back(std::to_string(found.pierces) + (found.pierces == 1 ? " cut, " : " cuts, ") +
                  mm(found.length) + " in " +
                  measure(60.0 * found.length / *o.speed + pierces, Unit::s) +
                  " with the delays of the pierce, without rapids");
  add_order(cuts, lines);
  lines.push_back("moves: tip and both edges within " + fixed(std::ceil(moves.sag * 1e3) / 1e3, 3) +
                  " mm of straight lines between the rows, blocks inserted for it: " +
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
  const auto at = [](const PostAxis& axis, double deg) {
    return letter(axis) + " " + fixed(axis.counted(deg), 3);
  };
  if (o.lead.value_or(0.0) > 0.0 || o.start)
    out += post.comment(
        "starts at " + at(joints.turn(), cut.start().phi * kDegPerRad) + ", " +
        (joints.has_swing() ? at(joints.swing(), cut.start().b * kDegPerRad) + ", " : "") +
        mm(cut.start().z) + " from " + joints.along().zero());
  if (cut.radius < o.lead.value_or(0.0))
    out += post.comment("leads of " + mm(cut.radius) + ": the scrap has no room for more");
  return out;
}

}  // namespace tubecut::api
