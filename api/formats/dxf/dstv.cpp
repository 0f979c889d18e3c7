#include "api/formats/dxf/dstv.hpp"

#include <algorithm>
#include <cmath>

#include "api/catalog/post.hpp"
#include "api/formats/drawing/development.hpp"
#include "api/formats/drawing/part_edges.hpp"
#include "api/formats/drawing/part_marks.hpp"
#include "api/formats/mesh/cut_solid.hpp"
#include "api/formats/numbers.hpp"
#include "api/formats/text.hpp"
#include "api/stop.hpp"
#include "api/verdict.hpp"
#include "api/wire/cutout_names.hpp"
#include "api/wire/words.hpp"

namespace tubecut::api {
namespace {

constexpr double kOneBevel = 0.01 * kRadPerDeg;  // within it a bevel is constant
constexpr double kSteel = 7850.0;                // kg/m3

std::string field(double value, int digits = 3) {
  auto text = fixed(value, digits);
  return std::string(text.size() < 12 ? 12 - text.size() : 1, ' ') + text;
}

/// Returns the height in the file, in which x goes to the right: seen from outside, phi grows
/// downwards.
double up(double radius, double phi) { return radius * (kTwoPi - phi); }

std::string comment(const std::string& text) { return "** " + text + "\r\n"; }
std::string line(const std::string& text) { return "  " + text + "\r\n"; }

std::string reference(const Caption& caption, std::string_view name) {
  for (const auto& [key, text] : caption.reference)
    if (key == name) return dstv_text(text);
  return "-";
}

struct Lengths {
  double low = 0.0;  // z of x = 0
  double over_long = 0.0, over_short = 0.0, work_point = 0.0;
  double saw = 0.0;      // from the start of the torch line
  bool assumed = false;  // nobody gave the far end
};

Lengths lengths_of(const bevel::TableSpec& spec, const bevel::Table& t,
                   const std::stop_token& stop) {
  const auto [li, hi] = std::ranges::minmax(t.z_inner);
  const auto [lo, ho] = std::ranges::minmax(t.z_outer);
  const double far = spec.target.length.value_or(cut_solid(spec, t, Smoothed::after, stop).far);
  const double low = std::min(li, lo);
  const double torch = std::min(std::ranges::min(t.torch_inner), std::ranges::min(t.torch_outer));
  return {.low = low,
          .over_long = far - low,
          .over_short = far - std::max(hi, ho),
          .work_point = far,
          .saw = far - std::min(low, torch),
          .assumed = !spec.target.length};
}

Lengths lengths_of(const part::Part& p) {
  const auto& s = p.start.table;
  const auto& f = p.finish.table;
  const double from =
      std::min({0.0, std::ranges::min(s.torch_inner), std::ranges::min(s.torch_outer)});
  const double to = std::max(
      {p.lengths.longest, std::ranges::max(f.torch_inner), std::ranges::max(f.torch_outer)});
  return {.over_long = p.lengths.longest,
          .over_short = p.lengths.shortest,
          .work_point = p.lengths.work_point,
          .saw = to - from};
}

std::string comments(const Lengths& l, bool constant, const Caption& c) {
  std::string out =
      comment(job_line(
          {.reference = {}, .input_sha256 = c.input_sha256, .result_sha256 = {}, .view = {}})) +
      comment("unit mm, deg; x along the tube from the long point of the cut, y round it") +
      comment("RO = round tube, developed as seen from outside: x to the right, y up") +
      comment("y = outer radius * angle, angle = 360 deg - phi") +
      comment("bevel angles: positive where the outer edge lies further towards +x");
  for (const auto& [name, text] : c.reference)
    out += comment(called(name, Term::field) + ": " + dstv_text(text) +
                   std::string(spelling_note(text)));
  for (const auto& text : verdict_lines(c.verdict, {.width = 76, .plain = true}))
    out += comment(dstv_text(degrees_spelled(text)));
  out += comment("length over the long point " + mm(l.over_long)) +
         comment("length over the short point " + mm(l.over_short)) +
         comment("length from the work point " + mm(l.work_point)) +
         comment("length to saw, including the cut of the torch line " + mm(l.saw));
  if (l.assumed) out += comment("no length was given: the far end is assumed");
  if (!constant)
    out += comment("the bevel varies; sidecar " + c.input_sha256.substr(0, 16) +
                   ".csv = the csv format of the same request, angles of the same sign");
  return out;
}

/// `name`: name of the piece if the reference has no name.
std::string header(const joint::Target& target, double density, const Lengths& l, const Caption& c,
                   std::string_view name = {}) {
  const double ro = target.outer_radius, ri = target.inner_radius();
  const double diameter = 2.0 * ro;
  const double kg_per_m = kPi * (ro * ro - ri * ri) * density * 1e-6;
  const auto given = reference(c, "part");
  const auto part = given == "-" ? dstv_text(name) : given;
  const auto quantity = reference(c, "quantity");
  std::string out = line(reference(c, "order")) + line(reference(c, "drawing")) + line("1") +
                    line(part) + line(reference(c, "material")) +
                    line(quantity == "-" ? "1" : quantity) +
                    line("ROHR" + fixed(diameter, 1) + "x" + fixed(target.wall, 1)) + line("RO");
  out += field(l.over_long) + "," + field(l.saw) + "\r\n";
  for (const double v : {diameter, diameter, target.wall, target.wall, 0.0, kg_per_m,
                         kTwoPi * ro * 1e-3, 0.0, 0.0, 0.0, 0.0})
    out += field(v) + "\r\n";
  return out + line("-") + line("-") + line("-") + line("-");
}

/// Returns a point of a contour; the reference edge "u" only for the first of the block.
std::string point(double x, double y, double bevel, bool first) {
  return std::string("  ") + (first ? "v" : " ") + field(x) + (first ? "u" : " ") + field(y) +
         field(0.0) + field(bevel) + field(0.0) + field(0.0) + field(0.0) + "\r\n";
}

std::string contour(const CutOutline& cut, const Lengths& l, double bevel_deg,
                    const std::stop_token& stop) {
  const auto& c = cut.outer;
  std::string out = "AK\r\n";
  for (std::size_t i = 0; i < c.phi.size(); ++i) {
    append(out, point(c.z[i] - l.low, up(c.radius, c.phi[i]), bevel_deg, i == 0), stop);
  }
  const double around = up(c.radius, 0.0), end = l.over_long;
  out += point(end, 0.0, 0.0, false) + point(end, around, 0.0, false);
  return out + point(c.z.front() - l.low, around, 0.0, false);  // closed
}

constexpr const char* kSidecar =
    "columns of the B lines: phi deg, outer edge x and y mm, inner edge x and y mm, bevel angle "
    "deg";
constexpr const char* kTilted =
    "columns of the B lines of a hole: also its tilt across deg, positive towards growing phi, -y";

std::string sidecar(double phi, double phi_inner, double x, double x_inner, double b,
                    const joint::Target& target, std::optional<double> a = {}) {
  return comment("B" + field(phi * kDegPerRad, 6) + field(x, 4) +
                 field(up(target.outer_radius, phi), 4) + field(x_inner, 4) +
                 field(up(target.inner_radius(), phi_inner), 4) + field(b * kDegPerRad, 4) +
                 (a ? field(*a * kDegPerRad, 4) : ""));
}

std::string sidecar(const joint::Target& target, const bevel::Table& t, double low,
                    const std::stop_token& stop) {
  std::string out;
  for (std::size_t i = 0; i < t.phi.size(); ++i) {
    append(out, sidecar(t.phi[i], t.phi[i], t.z_outer[i] - low, t.z_inner[i] - low, t.b[i], target),
           stop);
  }
  return out;
}

std::string sidecar(const joint::Target& target, const bevel::Hole& h,
                    const std::stop_token& stop) {
  std::string out;
  for (std::size_t i = 0; i < h.phi.size(); ++i) {
    append(out, sidecar(h.phi[i], h.phi_inner[i], h.z[i], h.z_inner[i], h.b[i], target, h.a[i]),
           stop);
  }
  return out;
}

/// Returns the bevel in degrees if the whole cut has the same.
std::optional<double> one_bevel(const std::vector<double>& b) {
  const auto [least, most] = std::ranges::minmax(b);
  if (most - least > kOneBevel) return std::nullopt;
  return (least + most) / 2.0 * kDegPerRad;
}

/// The outside with both ends: down the start's cut, and up along the finish's.
std::string outside(const CutOutline& start, const CutOutline& finish, double start_deg,
                    double finish_deg, const std::stop_token& stop) {
  std::string out = "AK\r\n";
  const auto& s = start.outer;
  const auto& f = finish.outer;
  for (std::size_t i = 0; i < s.phi.size(); ++i) {
    append(out,
           point(s.z[i], up(s.radius, s.phi[i]), i + 1 < s.phi.size() ? start_deg : 0.0, i == 0),
           stop);
  }
  for (std::size_t i = f.phi.size(); i-- > 0;) {
    append(out, point(f.z[i], up(f.radius, f.phi[i]), i > 0 ? finish_deg : 0.0, false), stop);
  }
  return out + point(s.z.front(), up(s.radius, 0.0), 0.0, false);  // closed
}

std::string opening(const CutOutline& hole, double bevel_deg, const std::stop_token& stop) {
  const auto& c = hole.outer;
  std::string out = "IK\r\n";
  for (std::size_t i = 0; i <= c.phi.size(); ++i) {
    const auto k = i % c.phi.size();
    append(out, point(c.z[k], up(c.radius, c.phi[k]), i < c.phi.size() ? bevel_deg : 0.0, i == 0),
           stop);
  }
  return out;
}

std::string wall_words(cutout::Lay lay) {
  switch (lay) {
    case cutout::Lay::developed:
      return "square to the tube";
    case cutout::Lay::prism:
      return "its walls parallel";
    case cutout::Lay::bored:
      return "square to the tube, a straight tool passes";
  }
  return {};
}

/// A circle that goes straight through as a bore where a drill makes it; else its outer edge.
std::string cutout_block(const part::PartSpec& spec, const part::Part& part, std::size_t index,
                         const CutOutline& cut, const std::stop_token& stop) {
  constexpr double kLargestBore = 200.0;  // mm
  const auto& one = part.cutouts.instances[index];
  const auto& mould = part.cutouts.mould_of(one);
  const auto& asked = spec.cutouts.all[one.asked];
  const auto* circle = std::get_if<cutout::Circle>(&asked.shape);
  auto out = comment("cut-out " + dstv_text(cut.label) + ", " + wall_words(mould.laying.lay()));
  if (circle == nullptr || asked.wall == cutout::Wall::developed || circle->diameter > kLargestBore)
    return out + opening(cut, 0.0, stop);
  const double middle = turned_from(0.0, one.phi + mould.laying.phase(0.0));
  return out + "BO\r\n  v" + field(one.z) + "u" + field(up(spec.target.outer_radius, middle)) +
         field(circle->diameter) + field(0.0) + "\r\n";
}

}  // namespace

std::string print_dstv(const bevel::TableSpec& spec, const bevel::Table& t,
                       const Caption& caption) {
  const auto lengths = lengths_of(spec, t, caption.stop);
  const auto bevel = one_bevel(t.b);
  return "ST\r\n" + comments(lengths, bevel.has_value(), caption) +
         header(spec.target, kSteel, lengths, caption) +
         contour(developed(spec, t).cuts.front(), lengths, bevel.value_or(0.0), caption.stop) +
         comment(kSidecar) + sidecar(spec.target, t, lengths.low, caption.stop) + "EN\r\n";
}

std::string print_dstv(const part::PartSpec& spec, const part::Part& part, const Caption& caption) {
  const auto lengths = lengths_of(part);
  const auto cuts = developed(spec, part).cuts;
  const auto start = one_bevel(part.start.table.b), finish = one_bevel(part.finish.table.b);
  bool constant = start && finish;
  std::string openings, tables, marks;
  for (const auto& step : part.sequence) {
    if (step.what == part::Step::What::hole) {
      const auto& hole = part.holes[step.index].hole;
      auto bevel = one_bevel(hole.b);
      if (one_bevel(hole.a).value_or(1.0) != 0.0) bevel.reset();  // tilted across too
      constant = constant && bevel;
      const auto& cut = cuts[2 + step.index];
      append(openings, opening(cut, bevel.value_or(0.0), caption.stop), caption.stop);
      tables += comment(cut.name + " is " + dstv_text(cut.label)) + comment("cut " + cut.name);
      append(tables, sidecar(spec.target, hole, caption.stop), caption.stop);
    } else if (step.what == part::Step::What::cutout) {
      const auto& cut = cuts[2 + part.holes.size() + step.index];
      append(openings, cutout_block(spec, part, step.index, cut, caption.stop), caption.stop);
    } else if (step.what == part::Step::What::mark) {
      marks += comment(dstv_text(mark_by_hand(part.marks[step.index], Post{})));
    } else {
      const bool at_start = step.what == part::Step::What::start;
      const auto& table = at_start ? part.start.table : part.finish.table;
      tables += comment(at_start ? "cut start" : "cut finish");
      append(tables, sidecar(spec.target, table, 0.0, caption.stop), caption.stop);
    }
  }
  auto out =
      "ST\r\n" + comments(lengths, constant, caption) +
      comment("AK: the tube itself, kept within; IK: an opening of it, kept outside") +
      (part.cutouts.empty()
           ? ""
           : comment("BO: a bore along the tube's radius, its diameter, depth 0 = this wall")) +
      comment("a hole across phi = 0 is one contour: its y leaves the girth") + marks +
      header(spec.target, spec.density, lengths, caption, spec.name);
  append(out, outside(cuts[0], cuts[1], start.value_or(0.0), finish.value_or(0.0), caption.stop),
         caption.stop);
  append(out, openings, caption.stop);
  out += comment(kSidecar) + comment(kTilted);
  append(out, tables, caption.stop);
  return out += "EN\r\n";
}

}  // namespace tubecut::api
