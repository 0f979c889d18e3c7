#include "api/formats/gcode.hpp"

#include <algorithm>
#include <cmath>

#include "api/formats/development.hpp"
#include "api/formats/text.hpp"
#include "core/base/elementary.hpp"

namespace tubecut::api {
namespace {

constexpr const char* kModes = "G21 G40 G49 G90 G94 G17\nG64 P0.01\n";
constexpr double kSlow = 1e-3;  // mm, least length a node's time is taken from

/// Joint values of one place of the torch.
class Joints {
 public:
  Joints(const TorchPath& path, const FormatOptions& options)
      : path_(path),
        pivot_(options.pivot_length),
        along_(options.axial_z ? 'Z' : 'X'),
        across_(options.axial_z ? 'X' : 'Z') {}

  [[nodiscard]] std::string words(double phi, double z, double b) const {
    const auto [sin, cos] = elementary::sincos(b);
    const double length = pivot_.value_or(0.0);
    std::string out = std::string(1, along_) + fixed(z + length * sin, 5);
    if (pivot_) out += " " + std::string(1, across_) + fixed(path_.outer_radius + length * cos, 5);
    return out + " A" + fixed(phi * kDegPerRad, 7) + " B" + fixed(b * kDegPerRad, 6);
  }
  [[nodiscard]] std::string words(std::size_t i) const {
    return words(path_.phi[i], path_.z[i], path_.b[i]);
  }
  [[nodiscard]] std::string describe() const {
    return std::string("A turns the tube: phi in deg, from x towards y. ") + along_ +
           " goes along it: mm, from the cut into the part";
  }

 private:
  const TorchPath& path_;
  std::optional<double> pivot_;
  char along_, across_;
};

std::string header(const TorchPath& path, const Joints& joints, const Caption& caption) {
  const auto& o = caption.options;
  std::string out = gcode_job(caption);
  out += gcode_comment("tube " + fixed(2.0 * path.outer_radius, 3) + " x " + fixed(path.wall, 3) +
                       " mm") +
         gcode_comment("tool: torch, kerf " + fixed(path.kerf, 3) + " mm, applied to the path") +
         gcode_comment("units mm, deg, mm/min") + gcode_comment(joints.describe()) +
         gcode_comment(
             "B swings the torch in the axial plane, positive: outer edge further into the part");
  out += o.pivot_length
             ? gcode_comment("linear axes are the torch pivot, " + fixed(*o.pivot_length, 3) +
                             " mm from the tip, the one across is its height over the tube axis")
             : gcode_comment(
                   "linear axes are the torch tip on the outer wall: the control must know it");
  out += gcode_comment(o.torch ? "THIS PROGRAM LIGHTS THE TORCH"
                               : "dry run: the torch stays off, ask with torch=on");
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

double step(const TorchPath& p, std::size_t i) {
  const double tip =
      elementary::hypot(p.outer_radius * (p.phi[i] - p.phi[i - 1]), p.z[i] - p.z[i - 1]);
  // A swing at a standing tip takes the time of an arc of the wall.
  return tip > kSlow ? tip : std::max(kSlow, p.wall * std::abs(p.b[i] - p.b[i - 1]));
}

}  // namespace

std::string gcode_comment(const std::string& text) { return "(" + machine_text(text) + ")\n"; }

std::string gcode_job(const Caption& caption) {
  std::string out = gcode_comment("tubecut " + std::string(version())) +
                    gcode_comment("input sha256 " + caption.input_sha256);
  for (const auto& [name, text] : caption.reference)
    out += gcode_comment(std::string(name) + ": " + text);
  return out;
}

TorchWords torch_words(Dialect dialect) {
  if (dialect == Dialect::qtplasmac)
    return {.prepare = "T0 M6\nG43 H0\nM52 P1\n", .on = "M3 $0 S1\n", .off = "M5 $0\n"};
  return {.prepare = "", .on = "M3 S1\n", .off = "M5\n"};
}

TorchPath torch_path(const bevel::TableSpec& spec, const bevel::Table& table) {
  auto torch = developed(spec, table).cuts.front().torch;
  auto swing = table;
  swing.torch_outer = table.b;
  for (auto& b : swing.torch_outer) b = table.inward ? -b : b;
  auto b = developed(spec, swing).cuts.front().torch.z;
  return {.outer_radius = spec.target.outer_radius,
          .wall = spec.target.wall,
          .kerf = spec.kerf,
          .phi = std::move(torch.phi),
          .z = std::move(torch.z),
          .b = std::move(b)};
}

std::string print_gcode(const TorchPath& path, const Caption& caption) {
  const auto& o = caption.options;
  const Joints joints(path, o);
  const auto torch = torch_words(o.dialect);
  const auto run_in = joints.words(path.phi.front(), path.z.front() - o.lead, path.b.front());
  const auto run_out = joints.words(path.phi.back(), path.z.back() - o.lead, path.b.back());
  std::string out = "%\n" + header(path, joints, caption) + modes(caption) + "G0 " + run_in + "\n";
  if (o.torch) out += torch.on;
  out += "G93\n";
  if (o.lead > 0.0) out += timed(joints.words(0), o.lead);
  for (std::size_t i = 1; i < path.phi.size(); ++i) out += timed(joints.words(i), step(path, i));
  if (o.lead > 0.0) out += timed(run_out, o.lead);
  return out + "G94\n" + torch.off + "M2\n%\n";
}

}  // namespace tubecut::api
