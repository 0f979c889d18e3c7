#include "api/formats/gcode.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "api/formats/bevel_table_formats.hpp"
#include "api/formats/text.hpp"
#include "api/formats/torch_moves.hpp"
#include "api/stop.hpp"
#include "api/verdict.hpp"
#include "api/wire_names.hpp"
#include "core/base/elementary.hpp"

namespace tubecut::api {
namespace {

constexpr const char* kModes = "G21 G40 G49 G90 G94 G17\nG64 P0.01\n";
constexpr double kClearance = 50.0;  // mm, of the tip over the tube between two cuts
constexpr double kSlow = 1e-3;       // mm, least length a node's time is taken from
constexpr double kSag = 0.019;       // mm, of one move; below 0.02 with the rounding of its words

/// Joint values of one place of the torch.
class Joints {
 public:
  Joints(const TorchJob& job, const FormatOptions& options)
      : radius_(job.outer_radius),
        pivot_(options.pivot_length),
        clearance_(options.clearance.value_or(kClearance)),
        along_(options.axial_z ? 'Z' : 'X'),
        across_(options.axial_z ? 'X' : 'Z'),
        tilts_(std::ranges::any_of(job.cuts, [](const auto& cut) { return !cut.path.a.empty(); })) {
  }

  /// Of the tip this far off the wall along its own axis.
  [[nodiscard]] std::string words(const TorchPlace& at, double off) const {
    return travel(at, off) + (pivot_ ? " " + height(at, off) : "") + angles(at);
  }
  /// The same without the height.
  [[nodiscard]] std::string level_words(const TorchPlace& at, double off) const {
    return travel(at, off) + angles(at);
  }
  [[nodiscard]] std::string height(const TorchPlace& at, double off) const {
    return std::string(1, across_) + fixed(radius_ + arm(at, off).out, 5);
  }
  /// Where the axis along the tube is.
  [[nodiscard]] double along(const TorchPlace& at, double off) const {
    return at.z + arm(at, off).along;
  }
  [[nodiscard]] std::string describe() const {
    return std::string("A turns the tube: phi in deg, from x towards y. ") + along_ +
           " goes along it: mm, +z of the result";
  }
  [[nodiscard]] char axis() const { return along_; }
  [[nodiscard]] bool tilts() const { return tilts_; }
  [[nodiscard]] bool has_pivot() const { return pivot_.has_value(); }
  [[nodiscard]] double clearance() const { return clearance_; }
  /// A rapid to the pivot's height between two cuts, its tip clear of the tube whichever way it
  /// swings; nothing where the control moves the tip.
  [[nodiscard]] std::string retract() const {
    if (!pivot_) return {};
    return "G0 " + std::string(1, across_) + fixed(radius_ + *pivot_ + clearance_, 5) + "\n";
  }

 private:
  /// From the wall to what the linear axes carry: outwards, along and round.
  struct Arm {
    double out, along, round;
  };
  [[nodiscard]] Arm arm(const TorchPlace& at, double off) const {
    if (!pivot_) return {0.0, 0.0, 0.0};
    // The torch's line: 1 outwards, tan a round, tan b along.
    const double round = elementary::tan(at.a), rise = elementary::tan(at.b);
    const double out = (*pivot_ + off) / std::sqrt(1.0 + round * round + rise * rise);
    return {out, out * rise, out * round};
  }
  [[nodiscard]] std::string travel(const TorchPlace& at, double off) const {
    std::string text = std::string(1, along_) + fixed(along(at, off), 5);
    // Growing phi runs to -Y with the tube along X, to +Y with it along Z.
    if (pivot_ && tilts_)
      text += " Y" + fixed((along_ == 'Z' ? 1.0 : -1.0) * arm(at, off).round, 5);
    return text;
  }
  [[nodiscard]] std::string angles(const TorchPlace& at) const {
    const auto text = " A" + fixed(at.phi * kDegPerRad, 7) + " B" + fixed(at.b * kDegPerRad, 6);
    return tilts_ ? text + " C" + fixed(at.a * kDegPerRad, 6) : text;
  }

  double radius_;
  std::optional<double> pivot_;
  double clearance_;
  char along_, across_;
  bool tilts_;
};

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
std::string extent(const TorchJob& job, const std::vector<Way>& ways, const Joints& joints,
                   const FormatOptions& o) {
  const double off = o.cut_height.value_or(0.0);
  double least = joints.along(ways.front().places.front(), off), most = least, length = 0.0;
  for (const auto& way : ways)
    for (std::size_t i = 0; i < way.places.size(); ++i) {
      const double at = joints.along(way.places[i], off);
      least = std::min(least, at);
      most = std::max(most, at);
      if (i > 0) length += step(job, way.places[i - 1], way.places[i]);
    }
  const std::string axis(1, joints.axis());
  const double pierces = o.pierce_delay.value_or(0.0) * static_cast<double>(ways.size());
  return gcode_comment(axis + " from " + fixed(least, 2) + " to " + fixed(most, 2) +
                       " mm while cutting, " + axis + "0 is z 0 of the result, A0 its phi 0") +
         gcode_comment(std::to_string(ways.size()) + (ways.size() == 1 ? " cut, " : " cuts, ") +
                       fixed(length, 1) + " mm in " + fixed(60.0 * length / *o.speed + pierces, 1) +
                       " s at the speed below, delays of the pierce with it, rapids not");
}

std::string how_it_starts(const FormatOptions& o) {
  const std::string height = fixed(o.cut_height.value_or(0.0), 3);
  std::string out;
  if (o.pivot_length)
    out +=
        gcode_comment("pierce " + fixed(o.pierce_height.value_or(o.cut_height.value_or(0.0)), 3) +
                      " mm off the wall, delay " + fixed(o.pierce_delay.value_or(0.0), 3) +
                      " s, cut " + height + " mm off it along the torch");
  else
    out += gcode_comment(o.dialect == Dialect::qtplasmac
                             ? "heights and delay of the pierce: QtPlasmaC's, of its material file"
                             : "heights and the lift between cuts: the control's");
  if (o.lead > 0.0)
    out += gcode_comment("leads: arcs of 60 deg on the scrap side, radius " + fixed(o.lead, 3) +
                         " mm, overcut " + fixed(o.overcut.value_or(motion::Lead{}.overcut), 3) +
                         " mm, clear of the part");
  if (!o.start && o.lead > 0.0)
    out += gcode_comment("each cut starts at its least bevel that is " +
                         fixed(motion::kFromJunction, 0) +
                         " mm and more off its junctions and off A0, the seam");
  return out;
}

std::string header(const TorchJob& job, const std::vector<Way>& ways, const Joints& joints,
                   const Straightness& moves, const Caption& caption) {
  const auto& o = caption.options;
  std::string out = gcode_job(caption);
  out += gcode_comment("tube " + fixed(2.0 * job.outer_radius, 3) + " x " + fixed(job.wall, 3) +
                       " mm") +
         gcode_comment("tool: torch, kerf " + kerfs(ways) + " mm, applied to the path") +
         gcode_comment("units mm, deg, mm/min") + gcode_comment(joints.describe()) +
         extent(job, ways, joints, o) +
         gcode_comment(
             "B swings the torch in the axial plane, positive: outer edge towards +z, "
             "b_sign: " +
             std::string(kBSignInPart));
  if (joints.has_pivot())
    out += gcode_comment("between cuts the torch is lifted " + fixed(joints.clearance(), 0) +
                         " mm clear of the tube");
  else if (ways.size() > 1)
    out += gcode_comment(
        "between cuts the control must lift the torch: after each that ends, "
        "before the rapid to the next");
  if (joints.tilts() && o.pivot_length)
    out += gcode_comment(
        std::string("Y: the pivot across, growing phi is ").append(o.axial_z ? "+Y" : "-Y"));
  if (joints.tilts())
    out += gcode_comment(
        "C tilts it across, positive: outer edge towards growing phi, tan B and "
        "tan C are each over the way outwards");
  out += o.pivot_length
             ? gcode_comment("linear axes are the torch pivot, " + fixed(*o.pivot_length, 3) +
                             " mm from the tip, the one across is its height over the tube axis")
             : gcode_comment(
                   "linear axes are the torch tip on the outer wall: the control must know it");
  out += how_it_starts(o);
  out += gcode_comment("moves: tip and both edges within " + fixed(moves.sag, 4) +
                       " mm of straight lines between the rows, blocks inserted for it: " +
                       std::to_string(moves.inserted));
  out += gcode_comment(o.torch ? "THIS PROGRAM LIGHTS THE TORCH"
                               : "dry run: the torch stays off, ask with torch=on");
  for (const auto& remark : job.remarks) out += gcode_comment(remark);
  return out;
}

std::string modes(const Caption& caption) {
  return "#<speed_mm_min> = " + fixed(*caption.options.speed, 3) + "\n" + kModes +
         torch_words(caption.options.dialect).prepare;
}

/// A move at the surface speed; G93's F is one over its minutes.
std::string timed(const std::string& words, double length) {
  return "G1 " + words + " F[#<speed_mm_min> / " + fixed(std::max(length, kSlow), 6) + "]\n";
}

/// What is said of a cut before its blocks.
std::string title(const Way& way, const FormatOptions& o) {
  std::string out;
  if (!way.name.empty()) out += gcode_comment("cut: " + way.name);
  if (o.lead > 0.0 || o.start)
    out += gcode_comment("starts at A" + fixed(way.start.phi * kDegPerRad, 3) + ", z " +
                         fixed(way.start.z, 3) + " mm, B" + fixed(way.start.b * kDegPerRad, 3));
  if (way.radius < o.lead)
    out +=
        gcode_comment("leads of " + fixed(way.radius, 3) + " mm: the scrap has no room for more");
  return out;
}

/// From the retract before one cut to the one behind it.
std::string print_cut(const TorchJob& job, const Way& way, const Joints& joints,
                      const Caption& caption) {
  const auto& o = caption.options;
  const auto words = torch_words(o.dialect);
  const auto& first = way.places.front();
  const double off = o.cut_height.value_or(0.0), above = o.pierce_height.value_or(off);
  std::string out = title(way, o) + joints.retract();
  if (joints.has_pivot())
    out += "G0 " + joints.level_words(first, above) + "\nG0 " + joints.height(first, above) + "\n";
  else
    out += "G0 " + joints.words(first, 0.0) + "\n";
  if (o.torch) out += words.on;
  if (o.pierce_delay) out += "G4 P" + fixed(*o.pierce_delay, 3) + "\n";
  out += "G93\n";
  if (above != off) out += timed(joints.words(first, off), std::abs(above - off));
  for (std::size_t i = 1; i < way.places.size(); ++i) {
    ask(caption.stop);
    out += timed(joints.words(way.places[i], off), step(job, way.places[i - 1], way.places[i]));
  }
  return out + "G94\n" + words.off;
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

std::string gcode_comment(const std::string& text) { return "(" + gcode_text(text) + ")\n"; }

std::string gcode_job(const Caption& caption) {
  std::string out = gcode_comment("tubecut " + std::string(version())) +
                    gcode_comment("input sha256 " + caption.input_sha256);
  for (const auto& [name, text] : caption.reference)
    out += gcode_comment(std::string(name) + ": " + text);
  for (const auto& line : verdict_lines(caption.verdict)) out += gcode_comment(line);
  return out;
}

const std::vector<std::string_view>& gcode_options() {
  static const std::vector<std::string_view> kOptions{
      "speed_mm_min",   "dialect",       "torch",        "axial",           "lead_mm",
      "overcut_mm",     "start_deg",     "pierce_b_deg", "pivot_length_mm", "pierce_height_mm",
      "pierce_delay_s", "cut_height_mm", "clearance_mm", "acknowledge"};
  return kOptions;
}

TorchWords torch_words(Dialect dialect) {
  if (dialect == Dialect::qtplasmac)
    return {.prepare = "T0 M6\nG43 H0\nM52 P1\n", .on = "M3 $0 S1\n", .off = "M5 $0\n"};
  return {.prepare = "", .on = "M3 S1\n", .off = "M5\n"};
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
  const Joints joints(job, caption.options);
  Straightness moves;
  const auto ways = ways_of(job, caption, moves);
  std::string out = "%\n" + header(job, ways, joints, moves, caption) + modes(caption);
  for (const auto& way : ways) out += print_cut(job, way, joints, caption);
  return out + joints.retract() + "M2\n%\n";
}

}  // namespace tubecut::api
