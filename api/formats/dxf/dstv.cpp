#include "api/formats/dxf/dstv.hpp"

#include <algorithm>
#include <cmath>

#include "api/catalog/post.hpp"
#include "api/formats/drawing/development.hpp"
#include "api/formats/drawing/part_edges.hpp"
#include "api/formats/drawing/part_marks.hpp"
#include "api/formats/dxf/dstv_stated.hpp"
#include "api/formats/dxf/dstv_text.hpp"
#include "api/formats/mesh/cut_solid.hpp"
#include "api/formats/numbers.hpp"
#include "api/formats/text.hpp"
#include "api/stop.hpp"
#include "api/wire/cutout_names.hpp"

namespace tubecut::api {
namespace {

constexpr double kSteel = 7850.0;  // kg/m3

/// Returns the height in the file, in which x goes to the right: seen from outside, phi grows
/// downwards.
double up(double radius, double phi) { return radius * (kTwoPi - phi); }

DstvLengths lengths_of(const bevel::TableSpec& spec, const bevel::Table& t) {
  const auto [li, hi] = std::ranges::minmax(t.z_inner);
  const auto [lo, ho] = std::ranges::minmax(t.z_outer);
  const double far = spec.target.length.value_or(cut_solid(spec, t, Smoothed::after).far);
  const double low = std::min(li, lo);
  const double torch = std::min(std::ranges::min(t.torch_inner), std::ranges::min(t.torch_outer));
  return {.low = low,
          .over_long = far - low,
          .over_short = far - std::max(hi, ho),
          .work_point = far,
          .saw = far - std::min(low, torch),
          .assumed = !spec.target.length};
}

/// A round tube, its steel of this density.
DstvProfile profile_of(const joint::Target& target, double density) {
  const double ro = target.outer_radius, ri = target.inner_radius();
  return {.name = "ROHR" + fixed(2.0 * ro, 1) + "x" + fixed(target.wall, 1),
          .code = "RO",
          .height = 2.0 * ro,
          .width = 2.0 * ro,
          .wall = target.wall,
          .kg_per_m = kPi * (ro * ro - ri * ri) * density * 1e-6,
          .girth = kTwoPi * ro};
}

const std::vector<std::string> kFrame{
    "unit mm, deg; x along the tube from the long point of the cut, y round it",
    "RO = round tube, developed as seen from outside: x to the right, y up",
    "y = outer radius * angle, angle = 360 deg - phi"};

std::string contour(const CutOutline& cut, const DstvLengths& l, double bevel_deg) {
  const auto& c = cut.outer;
  std::string out = "AK\r\n";
  for (std::size_t i = 0; i < c.phi.size(); ++i) {
    out += dstv_point("v", c.z[i] - l.low, up(c.radius, c.phi[i]), bevel_deg, i == 0);
  }
  const double around = up(c.radius, 0.0), end = l.over_long;
  out += dstv_point("v", end, 0.0, 0.0, false) + dstv_point("v", end, around, 0.0, false);
  return out + dstv_point("v", c.z.front() - l.low, around, 0.0, false);  // closed
}

constexpr const char* kSidecar =
    "columns of the B lines: phi deg, outer edge x and y mm, inner edge x and y mm, bevel angle "
    "deg";
constexpr const char* kTilted =
    "columns of the B lines of a hole: also its tilt across deg, positive towards growing phi, -y";

std::string sidecar(double phi, double phi_inner, double x, double x_inner, double b,
                    const joint::Target& target, std::optional<double> a = {}) {
  return dstv_comment("B" + dstv_field(phi * kDegPerRad, 6) + dstv_field(x, 4) +
                      dstv_field(up(target.outer_radius, phi), 4) + dstv_field(x_inner, 4) +
                      dstv_field(up(target.inner_radius(), phi_inner), 4) +
                      dstv_field(b * kDegPerRad, 4) + (a ? dstv_field(*a * kDegPerRad, 4) : ""));
}

std::string sidecar(const joint::Target& target, const bevel::Table& t, double low) {
  std::string out;
  for (std::size_t i = 0; i < t.phi.size(); ++i) {
    out += sidecar(t.phi[i], t.phi[i], t.z_outer[i] - low, t.z_inner[i] - low, t.b[i], target);
  }
  return out;
}

std::string sidecar(const joint::Target& target, const bevel::Hole& h) {
  std::string out;
  for (std::size_t i = 0; i < h.phi.size(); ++i) {
    out += sidecar(h.phi[i], h.phi_inner[i], h.z[i], h.z_inner[i], h.b[i], target, h.a[i]);
  }
  return out;
}

/// The outside with both ends: down the start's cut, and up along the finish's.
std::string outside(const CutOutline& start, const CutOutline& finish, double start_deg,
                    double finish_deg) {
  std::string out = "AK\r\n";
  const auto& s = start.outer;
  const auto& f = finish.outer;
  for (std::size_t i = 0; i < s.phi.size(); ++i) {
    out += dstv_point("v", s.z[i], up(s.radius, s.phi[i]), i + 1 < s.phi.size() ? start_deg : 0.0,
                      i == 0);
  }
  for (std::size_t i = f.phi.size(); i-- > 0;) {
    out += dstv_point("v", f.z[i], up(f.radius, f.phi[i]), i > 0 ? finish_deg : 0.0, false);
  }
  return out + dstv_point("v", s.z.front(), up(s.radius, 0.0), 0.0, false);  // closed
}

std::string opening(const CutOutline& hole, double bevel_deg) {
  const auto& c = hole.outer;
  std::string out = "IK\r\n";
  for (std::size_t i = 0; i <= c.phi.size(); ++i) {
    const auto k = i % c.phi.size();
    out +=
        dstv_point("v", c.z[k], up(c.radius, c.phi[k]), i < c.phi.size() ? bevel_deg : 0.0, i == 0);
  }
  return out;
}

/// A circle that goes straight through as a bore where a drill makes it; else its outer edge.
std::string cutout_block(const part::PartSpec& spec, const part::Part& part, std::size_t index,
                         const CutOutline& cut) {
  const auto& one = part.cutouts.instances[index];
  const auto& mould = part.cutouts.mould_of(one);
  const auto& asked = spec.cutouts.all[one.asked];
  if (mould.cone) return dstv_countersink(one.name, *mould.cone);
  auto out = dstv_cutout_title(cut.label, mould.laying.lay());
  const double anchor = up(spec.target.outer_radius, turned_from(0.0, one.phi));
  if (!mould.laying.far()) out += dstv_shape(asked, one.z, anchor);
  const auto diameter = dstv_bore_diameter(asked);
  if (!diameter || asked.wall == cutout::Wall::developed) return out + opening(cut, 0.0);
  const double middle = turned_from(0.0, one.phi + mould.laying.phase(0.0));
  return out + dstv_bore("v", one.z, up(spec.target.outer_radius, middle), *diameter);
}

}  // namespace

std::string print_dstv(const bevel::TableSpec& spec, const bevel::Table& t,
                       const Caption& caption) {
  const auto lengths = lengths_of(spec, t);
  const auto bevel = one_bevel(t.b);
  return "ST\r\n" + dstv_comments(lengths, kFrame, bevel.has_value(), caption) +
         dstv_header(profile_of(spec.target, kSteel), lengths, caption) +
         contour(developed(spec, t).cuts.front(), lengths, bevel.value_or(0.0)) +
         dstv_comment(kSidecar) + sidecar(spec.target, t, lengths.low) + "EN\r\n";
}

std::string print_dstv(const part::PartSpec& spec, const part::Part& part, const Caption& caption) {
  const auto lengths = lengths_of_part(part);
  const auto cuts = developed(spec, part).cuts;
  const auto start = one_bevel(part.start.table.b), finish = one_bevel(part.finish.table.b);
  bool constant = start && finish;
  std::string openings, texts, tables, marks;
  for (const auto& step : part.sequence) {
    if (step.what == part::Step::What::hole) {
      const auto& hole = part.holes[step.index].hole;
      auto bevel = one_bevel(hole.b);
      if (one_bevel(hole.a).value_or(1.0) != 0.0) bevel.reset();  // tilted across too
      constant = constant && bevel;
      const auto& cut = cuts[2 + step.index];
      openings += opening(cut, bevel.value_or(0.0));
      tables +=
          dstv_comment(cut.name + " is " + dstv_text(cut.label)) + dstv_comment("cut " + cut.name);
      tables += sidecar(spec.target, hole);
    } else if (step.what == part::Step::What::cutout) {
      const auto& cut = cuts[2 + part.holes.size() + step.index];
      openings += cutout_block(spec, part, step.index, cut);
    } else if (step.what == part::Step::What::mark) {
      const auto& mark = part.marks[step.index];
      if (mark.lettering)
        texts += dstv_lettering(*mark.lettering, "v",
                                up(spec.target.outer_radius, turned_from(0.0, mark.phi)), true);
      else
        marks += dstv_comment(dstv_text(mark_by_hand(mark, Post{})));
    } else {
      const bool at_start = step.what == part::Step::What::start;
      const auto& table = at_start ? part.start.table : part.finish.table;
      tables += dstv_comment(at_start ? "cut start" : "cut finish");
      tables += sidecar(spec.target, table, 0.0);
    }
  }
  auto out = "ST\r\n" + dstv_comments(lengths, kFrame, constant, caption) +
             dstv_comment("AK: the tube itself, kept within; IK: an opening of it, kept outside") +
             (part.cutouts.empty()
                  ? ""
                  : dstv_comment(
                        "BO: a bore along the tube's radius, its diameter, depth 0 = this wall")) +
             (texts.empty() ? "" : dstv_comment(kTextColumns)) +
             dstv_comment("a hole across phi = 0 is one contour: its y leaves the girth") +
             dstv_ends(spec, part) + marks +
             dstv_header(profile_of(spec.target, spec.density), lengths, caption, spec.name);
  out += outside(cuts[0], cuts[1], start.value_or(0.0), finish.value_or(0.0));
  out += openings;
  out += texts;
  out += dstv_comment(kSidecar) + dstv_comment(kTilted);
  out += tables;
  return out += "EN\r\n";
}

}  // namespace tubecut::api
