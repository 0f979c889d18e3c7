#include "api/formats/dstv.hpp"

#include <algorithm>
#include <cmath>

#include "api/formats/cut_solid.hpp"
#include "api/formats/development.hpp"
#include "api/formats/text.hpp"

namespace tubecut::api {
namespace {

constexpr double kOneBevel = 0.01 * kRadPerDeg;  // within it a bevel is constant
constexpr double kDensity = 7.85e-6;             // kg/mm3, steel

std::string field(double value, int digits = 3) {
  auto text = fixed(value, digits);
  return std::string(text.size() < 12 ? 12 - text.size() : 1, ' ') + text;
}

std::string comment(const std::string& text) { return "** " + text + "\r\n"; }
std::string line(const std::string& text) { return "  " + text + "\r\n"; }

std::string reference(const Caption& caption, std::string_view name) {
  for (const auto& [key, text] : caption.reference)
    if (key == name) return machine_text(text);
  return "-";
}

struct Lengths {
  double low = 0.0, high = 0.0;  // z of the finished cut, both walls
  double far = 0.0;
  double saw = 0.0;  // from the lowest point of the torch line
};

Lengths lengths_of(const bevel::TableSpec& spec, const bevel::Table& t) {
  const auto [li, hi] = std::ranges::minmax(t.z_inner);
  const auto [lo, ho] = std::ranges::minmax(t.z_outer);
  Lengths out{.low = std::min(li, lo), .high = std::max(hi, ho)};
  out.far = spec.target.length.value_or(cut_solid(spec, t, Smoothed::after).far);
  const double torch = std::min(std::ranges::min(t.torch_inner), std::ranges::min(t.torch_outer));
  out.saw = out.far - std::min(out.low, torch);
  return out;
}

std::string comments(const bevel::TableSpec& spec, const Lengths& l, bool constant,
                     const Caption& c) {
  std::string out =
      comment(job_line(
          {.reference = {}, .input_sha256 = c.input_sha256, .result_sha256 = {}, .view = {}})) +
      comment("unit mm, deg; x from the long point of the cut, y = outer radius * phi");
  for (const auto& [name, text] : c.reference)
    out += comment(std::string(name) + ": " + machine_text(text));
  out += comment("length over the long point " + fixed(l.far - l.low, 3)) +
         comment("length over the short point " + fixed(l.far - l.high, 3)) +
         comment("length from the work point " + fixed(l.far, 3));
  if (!spec.target.length) out += comment("the request gives no length_mm: the far end is assumed");
  if (!constant)
    out += comment("the bevel varies; sidecar " + c.input_sha256.substr(0, 16) +
                   ".csv = the csv format of the same request");
  return out;
}

std::string header(const bevel::TableSpec& spec, const Lengths& l, const Caption& c) {
  const double ro = spec.target.outer_radius, ri = spec.target.inner_radius();
  const double diameter = 2.0 * ro;
  const double kg_per_m = kPi * (ro * ro - ri * ri) * kDensity * 1e3;
  auto part = reference(c, "part");
  std::string out = line(reference(c, "order")) + line(reference(c, "drawing")) + line("1") +
                    line(part) + line("-") + line("1") +
                    line("ROHR" + fixed(diameter, 1) + "x" + fixed(spec.target.wall, 1)) +
                    line("RO");
  out += field(l.far - l.low) + "," + field(l.saw) + "\r\n";
  for (const double v : {diameter, diameter, spec.target.wall, spec.target.wall, 0.0, kg_per_m,
                         kTwoPi * ro * 1e-3, 0.0, 0.0, 0.0, 0.0})
    out += field(v) + "\r\n";
  return out + line("-") + line("-") + line("-") + line("-");
}

/// A point of a contour; the reference edge "u" only where it is the first of the block.
std::string point(double x, double y, double bevel, bool first) {
  return std::string("  ") + (first ? "v" : " ") + field(x) + (first ? "u" : " ") + field(y) +
         field(0.0) + field(bevel) + field(0.0) + field(0.0) + field(0.0) + "\r\n";
}

std::string contour(const CutOutline& cut, const Lengths& l, double bevel_deg) {
  const auto& c = cut.outer;
  std::string out = "AK\r\n";
  for (std::size_t i = 0; i < c.phi.size(); ++i)
    out += point(c.z[i] - l.low, c.radius * c.phi[i], bevel_deg, i == 0);
  const double around = c.radius * kTwoPi, end = l.far - l.low;
  out += point(end, around, 0.0, false) + point(end, 0.0, 0.0, false);
  return out + point(c.z.front() - l.low, 0.0, 0.0, false);  // closed
}

std::string sidecar(const bevel::TableSpec& spec, const bevel::Table& t, const Lengths& l) {
  std::string out = comment("phi_deg, x_outer_mm, y_outer_mm, x_inner_mm, y_inner_mm, b_deg");
  for (std::size_t i = 0; i < t.phi.size(); ++i)
    out += comment("B" + field(t.phi[i] * kDegPerRad, 6) + field(t.z_outer[i] - l.low, 4) +
                   field(spec.target.outer_radius * t.phi[i], 4) + field(t.z_inner[i] - l.low, 4) +
                   field(spec.target.inner_radius() * t.phi[i], 4) +
                   field((t.inward ? -1.0 : 1.0) * t.b[i] * kDegPerRad, 4));
  return out;
}

}  // namespace

std::string print_dstv(const bevel::TableSpec& spec, const bevel::Table& t,
                       const Caption& caption) {
  const auto lengths = lengths_of(spec, t);
  const auto [least, most] = std::ranges::minmax(t.b);
  const bool constant = most - least <= kOneBevel;
  const double bevel = (t.inward ? -1.0 : 1.0) * (least + most) / 2.0 * kDegPerRad;
  return "ST\r\n" + comments(spec, lengths, constant, caption) + header(spec, lengths, caption) +
         contour(developed(spec, t).cuts.front(), lengths, constant ? bevel : 0.0) +
         sidecar(spec, t, lengths) + "EN\r\n";
}

}  // namespace tubecut::api
