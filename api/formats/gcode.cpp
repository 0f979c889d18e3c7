#include "api/formats/gcode.hpp"

#include <algorithm>
#include <cmath>

#include "api/formats/bevel_table_formats.hpp"
#include "api/formats/development.hpp"
#include "api/formats/text.hpp"
#include "api/formats/torch_moves.hpp"
#include "api/stop.hpp"
#include "api/verdict.hpp"
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
        along_(options.axial_z ? 'Z' : 'X'),
        across_(options.axial_z ? 'X' : 'Z'),
        tilts_(std::ranges::any_of(job.cuts, [](const auto& cut) { return !cut.a.empty(); })) {}

  enum class Height { with, without };
  [[nodiscard]] std::string words(const TorchPlace& at, Height height = Height::with) const {
    const double length = pivot_.value_or(0.0);
    // The torch's line: 1 outwards, tan a round, tan b along.
    const double round = elementary::tan(at.a), rise = elementary::tan(at.b);
    const double out = length / std::sqrt(1.0 + round * round + rise * rise);
    std::string text = std::string(1, along_) + fixed(at.z + out * rise, 5);
    // Growing phi runs to -Y with the tube along X, to +Y with it along Z.
    if (pivot_ && tilts_) text += " Y" + fixed((along_ == 'Z' ? 1.0 : -1.0) * out * round, 5);
    if (pivot_ && height == Height::with)
      text += " " + std::string(1, across_) + fixed(radius_ + out, 5);
    text += " A" + fixed(at.phi * kDegPerRad, 7) + " B" + fixed(at.b * kDegPerRad, 6);
    return tilts_ ? text + " C" + fixed(at.a * kDegPerRad, 6) : text;
  }
  [[nodiscard]] std::string describe() const {
    return std::string("A turns the tube: phi in deg, from x towards y. ") + along_ +
           " goes along it: mm, +z of the result";
  }
  [[nodiscard]] bool tilts() const { return tilts_; }
  /// The pivot's height while the torch goes from one cut to the next: its tip clear of the tube
  /// whichever way it swings.
  [[nodiscard]] std::optional<std::string> lifted() const {
    if (!pivot_) return std::nullopt;
    return std::string(1, across_) + fixed(radius_ + *pivot_ + kClearance, 5);
  }

 private:
  double radius_;
  std::optional<double> pivot_;
  char along_, across_;
  bool tilts_;
};

TorchPlace place(const TorchPath& p, std::size_t i) {
  return {p.phi[i], p.z[i], p.b[i], p.a.empty() ? 0.0 : p.a[i]};
}

void append(TorchPath& path, const TorchPlace& at) {
  path.phi.push_back(at.phi);
  path.z.push_back(at.z);
  path.b.push_back(at.b);
  path.a.push_back(at.a);
}

/// How moves between the nodes keep to the lines between them.
struct Straightness {
  double sag = 0.0;  // mm, a bound over all moves
  std::size_t inserted = 0;
};

/// The same path with nodes between its nodes where a move of all axes would sag.
TorchPath refined(const TorchPath& path, const TorchReach& reach, const std::stop_token& stop,
                  Straightness& told) {
  TorchPath out{.name = path.name,
                .phi = {},
                .z = {},
                .b = {},
                .scrap = path.scrap,
                .room = path.room,
                .kerf = path.kerf};
  append(out, place(path, 0));
  for (std::size_t i = 1; i < path.phi.size(); ++i) {
    ask(stop);
    auto at = place(path, i - 1);
    const auto moves = straight_moves(reach, at, place(path, i), kSag);
    told.inserted += moves.size() - 1;
    for (const auto& next : moves) {
      told.sag = std::max(told.sag, sag(reach, at, next));
      append(out, at = next);
    }
  }
  if (path.a.empty()) out.a.clear();
  return out;
}

/// One for all cuts, or each in their order.
std::string kerfs(const TorchJob& job) {
  const double first = job.cuts.front().kerf;
  std::string out = fixed(first, 3);
  if (std::ranges::all_of(job.cuts, [&](const TorchPath& cut) { return cut.kerf == first; }))
    return out;
  for (std::size_t i = 1; i < job.cuts.size(); ++i) out += ", " + fixed(job.cuts[i].kerf, 3);
  return out;
}

std::string header(const TorchJob& job, const Joints& joints, const Straightness& moves,
                   const Caption& caption) {
  const auto& o = caption.options;
  std::string out = gcode_job(caption);
  out += gcode_comment("tube " + fixed(2.0 * job.outer_radius, 3) + " x " + fixed(job.wall, 3) +
                       " mm") +
         gcode_comment("tool: torch, kerf " + kerfs(job) + " mm, applied to the path") +
         gcode_comment("units mm, deg, mm/min") + gcode_comment(joints.describe()) +
         gcode_comment(
             "B swings the torch in the axial plane, positive: outer edge towards +z, "
             "b_sign: " +
             std::string(kBSignInPart));
  if (job.cuts.size() > 1)
    out += gcode_comment(
        o.pivot_length
            ? "between cuts the torch is lifted " + fixed(kClearance, 0) + " mm clear of the tube"
            : "between cuts the control must lift the torch: after each that ends, "
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

double step(const TorchJob& job, const TorchPath& p, std::size_t i) {
  const double tip =
      elementary::hypot(job.outer_radius * (p.phi[i] - p.phi[i - 1]), p.z[i] - p.z[i - 1]);
  // A swing at a standing tip takes the time of an arc of the wall.
  const double tilt = p.a.empty() ? 0.0 : p.a[i] - p.a[i - 1];
  return tip > kSlow ? tip
                     : std::max(kSlow, job.wall * elementary::hypot(p.b[i] - p.b[i - 1], tilt));
}

/// From the run-in to the run-out of one cut.
std::string print_cut(const TorchJob& job, const TorchPath& path, const Joints& joints,
                      const TorchWords& torch, const Caption& caption) {
  const auto& o = caption.options;
  const double lead = std::min(o.lead, path.room);
  const auto aside = [&](std::size_t i) {
    auto at = place(path, i);
    at.phi += lead * path.scrap.x() / job.outer_radius;
    at.z += lead * path.scrap.y();
    return at;
  };
  std::string out;
  if (!path.name.empty()) out += gcode_comment("cut: " + path.name);
  if (lead < o.lead)
    out += gcode_comment("run-in and run-out " + fixed(lead, 3) +
                         " mm: half the way to the middle of the hole");
  const auto lifted = joints.lifted();
  if (job.cuts.size() > 1 && lifted)
    out += "G0 " + *lifted + "\nG0 " + joints.words(aside(0), Joints::Height::without) + "\n";
  out += "G0 " + joints.words(aside(0)) + "\n";
  if (o.torch) out += torch.on;
  out += "G93\n";
  if (lead > 0.0) out += timed(joints.words(place(path, 0)), lead);
  for (std::size_t i = 1; i < path.phi.size(); ++i) {
    ask(caption.stop);
    out += timed(joints.words(place(path, i)), step(job, path, i));
  }
  if (lead > 0.0) out += timed(joints.words(aside(path.phi.size() - 1)), lead);
  return out + "G94\n" + torch.off;
}

TorchPath hole_path(const bevel::HoleSpec& spec, const bevel::Hole& hole, std::string name) {
  TorchPath out{.name = std::move(name),
                .phi = hole.torch_phi,
                .z = hole.torch_z,
                .b = hole.b,
                .kerf = spec.kerf};
  if (std::ranges::any_of(hole.a, [](double a) { return a != 0.0; })) out.a = hole.a;
  for (auto* column : {&out.phi, &out.z, &out.b, &out.a})
    if (!column->empty()) column->push_back(column->front());
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  const auto at = [&](std::size_t i) {
    return Eigen::Vector2d{spec.chord.outer_radius * hole.torch_phi[i], hole.torch_z[i]};
  };
  for (std::size_t i = 0; i < hole.torch_phi.size(); ++i) middle += at(i);
  middle /= static_cast<double>(hole.torch_phi.size());
  out.scrap = (middle - at(0)).normalized();
  out.room = 0.5 * (middle - at(0)).norm();
  return out;
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
      "speed_mm_min", "dialect", "torch", "axial", "lead_mm", "pivot_length_mm", "acknowledge"};
  return kOptions;
}

TorchWords torch_words(Dialect dialect) {
  if (dialect == Dialect::qtplasmac)
    return {.prepare = "T0 M6\nG43 H0\nM52 P1\n", .on = "M3 $0 S1\n", .off = "M5 $0\n"};
  return {.prepare = "", .on = "M3 S1\n", .off = "M5\n"};
}

TorchPath torch_path(const bevel::TableSpec& spec, const bevel::Table& table) {
  auto torch = developed(spec, table).cuts.front().torch;
  auto swing = table;  // tan B is straight between rows, as both edges are
  for (std::size_t i = 0; i < table.b.size(); ++i)
    swing.torch_outer[i] = elementary::tan(table.b[i]);
  auto b = developed(spec, swing).cuts.front().torch.z;
  for (auto& each : b) each = elementary::atan(each);
  return {.name = {},
          .phi = std::move(torch.phi),
          .z = std::move(torch.z),
          .b = std::move(b),
          .kerf = spec.kerf};
}

TorchJob torch_job(const bevel::TableSpec& spec, const bevel::Table& table) {
  return {.outer_radius = spec.target.outer_radius,
          .wall = spec.target.wall,
          .cuts = {torch_path(spec, table)}};
}

TorchJob torch_job(const part::PartSpec& spec, const part::Part& part) {
  TorchJob out{.outer_radius = spec.target.outer_radius, .wall = spec.target.wall};
  for (const auto& step : part.sequence) {
    if (step.what == part::Step::What::mark) {
      out.remarks.push_back(remark(part.marks[step.index]));
    } else if (step.what == part::Step::What::hole) {
      const auto& hole = part.holes[step.index];
      const auto& branch = spec.holes[hole.asked].name;
      out.cuts.push_back(hole_path(
          spec.holes[hole.asked].hole, hole.hole,
          "hole " + std::to_string(step.index) + (branch.empty() ? "" : " for " + branch)));
    } else {
      const bool finish = step.what == part::Step::What::finish;
      const auto& end = finish ? part.finish : part.start;
      out.cuts.push_back(torch_path(end.spec, end.table));
      out.cuts.back().name = finish ? "finish" : "start";
      if (finish) out.cuts.back().scrap = {0.0, 1.0};
    }
  }
  return out;
}

std::string print_gcode(const TorchJob& asked, const Caption& caption) {
  auto job = asked;
  const TorchReach reach{.outer_radius = job.outer_radius,
                         .inner_radius = job.outer_radius - job.wall,
                         .pivot = caption.options.pivot_length.value_or(0.0)};
  Straightness moves;
  for (auto& cut : job.cuts) cut = refined(cut, reach, caption.stop, moves);
  const Joints joints(job, caption.options);
  const auto torch = torch_words(caption.options.dialect);
  std::string out = "%\n" + header(job, joints, moves, caption) + modes(caption);
  for (const auto& cut : job.cuts) out += print_cut(job, cut, joints, torch, caption);
  if (const auto lifted = joints.lifted(); lifted && job.cuts.size() > 1)
    out += "G0 " + *lifted + "\n";
  return out + "M2\n%\n";
}

}  // namespace tubecut::api
