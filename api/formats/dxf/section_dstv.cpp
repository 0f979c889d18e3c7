#include "api/formats/dxf/section_dstv.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "api/catalog/post.hpp"
#include "api/formats/drawing/development.hpp"
#include "api/formats/drawing/part_edges.hpp"
#include "api/formats/drawing/part_marks.hpp"
#include "api/formats/dxf/dstv_stated.hpp"
#include "api/formats/dxf/dstv_text.hpp"
#include "api/formats/numbers.hpp"
#include "api/formats/text.hpp"
#include "api/stop.hpp"
#include "api/wire/format.hpp"
#include "core/base/angle.hpp"

namespace tubecut::api {
namespace {

/// How a face of the part lies in the file.
struct NcFace {
  int face;
  const char* name;
  bool across_height;  // y counts along the section's height
  bool clockwise;      // how its outline runs
};
constexpr std::array kFaces{NcFace{2, "v", true, false}, NcFace{1, "o", false, true},
                            NcFace{3, "u", false, false}, NcFace{4, "h", true, true}};

struct NcPoint {
  double x = 0.0, y = 0.0;
  double b = 0.0;
};

/// The rows of an end on a face and both of its corners, y ascending, from side to side of the
/// sharp rectangle.
std::vector<NcPoint> edge_on(const section::Curve& outer, const NcFace& face,
                             const bevel::SectionTable& t) {
  const auto edge = part::edge_over_girth(t, t.z_outer);
  const double half = outer.face_distance(face.across_height ? 1 : 2), girth = outer.girth();
  const auto normal = section::Curve::face_normal(face.face);
  const auto height = [&](const Eigen::Vector2d& p) {
    return half + (face.across_height ? p.x() : p.y());
  };
  std::vector<NcPoint> out;
  const Eigen::Vector2d round(-normal.y(), normal.x());
  const bool falls = (face.across_height ? round.x() : round.y()) < 0.0;
  const auto z = [&](double s) { return edge.at(s / girth * kTwoPi).high; };
  for (std::size_t i = 0; i < t.at.size(); ++i)
    if (t.at[i].normal.dot(normal) > 1e-9)
      out.push_back({t.z_outer[i], height(t.at[i].point), t.b[i]});
  if (falls) std::ranges::reverse(out);  // two rows at one place stay in the order of the line
  const int before = face.face == 1 ? 4 : face.face - 1;
  for (const double s : {outer.on_corner(before, 0.0), outer.on_corner(face.face, 0.5 * kPi)})
    out.push_back({z(s), height(outer.at(s).point), out.empty() ? 0.0 : out.front().b});
  std::ranges::stable_sort(out, {}, &NcPoint::y);
  const auto same = [](const NcPoint& a, const NcPoint& b) { return a.x == b.x && a.y == b.y; };
  out.erase(std::unique(out.begin(), out.end(), same), out.end());
  return out;
}

std::optional<double> bevel_of(const std::vector<NcPoint>& points) {
  std::vector<double> b;
  for (const auto& one : points) b.push_back(one.b);
  return one_bevel(b);
}

/// One face's outline: up along one end, down along the other, closed.
std::string outline(const section::Curve& outer, const NcFace& face,
                    const part::SectionPart& part) {
  auto start = edge_on(outer, face, part.start.table);
  auto finish = edge_on(outer, face, part.finish.table);
  const double start_b = bevel_of(start).value_or(0.0), finish_b = bevel_of(finish).value_or(0.0);
  // Counter-clockwise, x to the right: the finish upwards, then the start downwards.
  std::ranges::reverse(start);
  std::vector<std::pair<NcPoint, double>> all;
  for (std::size_t i = 0; i < finish.size(); ++i)
    all.emplace_back(finish[i], i + 1 < finish.size() ? finish_b : 0.0);
  for (std::size_t i = 0; i < start.size(); ++i)
    all.emplace_back(start[i], i + 1 < start.size() ? start_b : 0.0);
  all.emplace_back(finish.front(), 0.0);
  if (face.clockwise) {
    std::ranges::reverse(all);
    // A value belongs to the way that begins at its point.
    for (std::size_t i = 0; i + 1 < all.size(); ++i) all[i].second = all[i + 1].second;
    all.back().second = 0.0;
  }
  std::string out = "AK\r\n";
  for (std::size_t i = 0; i < all.size(); ++i)
    out += dstv_point(face.name, all[i].first.x, all[i].first.y, all[i].second, i == 0);
  return out;
}

/// A circle as a bore; else the edge, run against the outline of its face.
std::string cutout_block(const part::SectionPartSpec& spec, const part::SectionPart& part,
                         std::size_t index) {
  const auto& layout = part.cutouts;
  const auto& one = layout.instances[index];
  const auto& asked = spec.cutouts.all[one.asked];
  const auto& face = *std::ranges::find(kFaces, one.face, &NcFace::face);
  const auto outer = spec.section.outer();
  const double half = outer.face_distance(face.across_height ? 1 : 2);
  const auto point = [&](double phi, double z) {
    const auto p = outer.at(phi / kTwoPi * outer.girth()).point;
    return NcPoint{z, half + (face.across_height ? p.x() : p.y())};
  };
  if (const auto& cone = layout.mould_of(one).cone) return dstv_countersink(one.name, *cone);
  auto out = dstv_cutout_title(cutout_tag(layout, index), layout.mould_of(one).laying.lay());
  const auto& laying = layout.mould_of(one).laying;
  const auto at = point(one.phi + laying.phase(0.0), one.z);
  if (!laying.far()) out += dstv_shape(asked, at.x, at.y);
  if (const auto diameter = dstv_bore_diameter(asked))
    return out + dstv_bore(face.name, at.x, at.y, *diameter);
  const auto rows = cutout::placed(layout, one);
  std::vector<NcPoint> line;
  double twice = 0.0;
  for (std::size_t i = 0; i < rows.phi.size(); ++i) {
    line.push_back(point(rows.phi[i], rows.z[i]));
    if (i > 0) twice += line[i - 1].x * line[i].y - line[i].x * line[i - 1].y;
  }
  twice += line.back().x * line.front().y - line.front().x * line.back().y;
  if ((twice > 0.0) != face.clockwise) std::ranges::reverse(line);
  line.push_back(line.front());
  out += "IK\r\n";
  for (std::size_t i = 0; i < line.size(); ++i)
    out += dstv_point(face.name, line[i].x, line[i].y, 0.0, i == 0);
  return out;
}

/// A block lies on one face, and its corners are not developed: a part without the opening would be
/// wrong, and one cut in two at the edge of a face is read as two openings.
void refuse_over_corners(const cutout::Layout& layout) {
  for (std::size_t i = 0; i < layout.instances.size(); ++i)
    if (layout.mould_of(layout.instances[i]).laying.over() != nullptr)
      throw UnfitOption{"format", "nc1 states each opening on one face, and cut-out " +
                                      cutout_tag(layout, i) +
                                      " goes over a corner: take step, dxf or gcode"};
}

std::string text_block(const section::Curve& outer, const cutout::Lettering& text) {
  const auto& face = *std::ranges::find(kFaces, text.face, &NcFace::face);
  const auto p = outer.at(text.s).point;
  const double y =
      outer.face_distance(face.across_height ? 1 : 2) + (face.across_height ? p.x() : p.y());
  return dstv_lettering(text, face.name, y, !face.clockwise);
}

std::string bevels(const part::SectionEnd& end, const char* name) {
  std::string out = dstv_comment(std::string("cut ") + name);
  const auto& t = end.table;
  for (std::size_t i = 0; i < t.at.size(); ++i)
    out += dstv_comment("B" + dstv_field(t.at[i].s, 4) + dstv_field(t.z_outer[i], 4) +
                        dstv_field(t.z_inner[i], 4) + dstv_field(t.b[i] * kDegPerRad, 4));
  return out;
}

DstvProfile profile_of(const part::SectionPartSpec& spec) {
  const auto& s = spec.section;
  const bool oval = s.height != s.width && 2.0 * s.corner == std::min(s.height, s.width);
  return {.name = std::string(oval                  ? "OVAL"
                              : s.height == s.width ? "SHS"
                                                    : "RHS") +
                  fixed(s.height, 1) + "x" + fixed(s.width, 1) + "x" + fixed(s.wall, 1),
          .code = "M",
          .height = s.height,
          .width = s.width,
          .wall = s.wall,
          .radius = s.corner,
          .kg_per_m = section::area(s) * spec.density * 1e-6,
          .girth = s.outer().girth()};
}

std::string cut_angles(const part::SectionPart& part) {
  std::string out;
  for (const auto* end : {&part.start, &part.finish}) {
    std::string text = end == &part.start ? "start" : "finish";
    for (const auto& face : kFaces)
      if (const auto& angle = end->faces[static_cast<std::size_t>(face.face - 1)].angle)
        text += std::string(", ") + face.name + " " + fixed(*angle * kDegPerRad, 3);
    out += dstv_comment("angle of the cut across each face, deg: " + text);
  }
  return out;
}

}  // namespace

std::string print_dstv(const part::SectionPartSpec& spec, const part::SectionPart& part,
                       const Caption& caption) {
  refuse_over_corners(part.cutouts);
  const auto outer = spec.section.outer();
  static const std::vector<std::string> kFrame{
      "unit mm, deg; x along the tube from the long point of the start",
      "M = rectangular tube; outlines on the sharp rectangle, corners are not developed",
      "face 1 (up) is o, face 2 is v, face 3 is u, face 4 is h; AK is the outer edge",
      "v, h: y from face 3 to face 1; h as seen through the tube from v",
      "o, u: y from face 4 to face 2; check their sense on your machine before the first part"};
  bool constant = true;
  std::string outlines;
  for (const auto& face : kFaces) {
    for (const auto* end : {&part.start, &part.finish})
      constant = constant && bevel_of(edge_on(outer, face, end->table)).has_value();
    outlines += outline(outer, face, part);
  }
  std::string marks, texts;
  for (const auto& step : part.sequence)
    if (step.what == part::Step::What::cutout) {
      outlines += cutout_block(spec, part, step.index);
    } else if (step.what == part::Step::What::mark) {
      const auto& mark = part.marks[step.index];
      if (mark.lettering) {
        texts += text_block(outer, *mark.lettering);
        continue;
      }
      marks += dstv_comment("mark \"" + dstv_text(mark.text) + "\" on the middle of face 1, x " +
                            fixed(mark.z_from, 3) +
                            (mark.z_to > mark.z_from ? " to " + fixed(mark.z_to, 3) : ""));
    }
  if (!part.cutouts.empty())
    marks += dstv_comment(
        "BO: a bore square to its face, its diameter, depth 0 = this wall; IK: the edge of an "
        "opening");
  if (!texts.empty()) marks += dstv_comment(kTextColumns);
  const auto lengths = lengths_of_part(part);
  auto out = "ST\r\n" + dstv_comments(lengths, kFrame, constant, caption) + cut_angles(part) +
             dstv_ends(spec, part) + dstv_corners(spec.section) + marks +
             dstv_header(profile_of(spec), lengths, caption, spec.name);
  out += outlines;
  out += texts;
  out += dstv_comment(
      "columns of the B lines: girth mm, outer edge x mm, inner edge x mm, bevel "
      "angle deg");
  out += bevels(part.start, "start");
  out += bevels(part.finish, "finish");
  return out += "EN\r\n";
}

}  // namespace tubecut::api
