#include "api/formats/step/section_solid.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "api/formats/drawing/part_edges.hpp"
#include "api/formats/step/section_curve.hpp"
#include "api/formats/step/section_cutout.hpp"
#include "api/formats/step/section_over.hpp"
#include "api/formats/step/section_ring.hpp"
#include "api/stop.hpp"
#include "api/wire/format.hpp"
#include "core/base/angle.hpp"
#include "core/base/elementary.hpp"

namespace tubecut::api {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using section::Station;

constexpr double kLeastRadius = 1e-3;  // mm, of a corner

class Builder {
 public:
  Builder(const part::SectionPartSpec& spec, const part::SectionPart& part)
      : wall_(spec.section), part_(part) {
    out_.wall = spec.section.wall;
    for (const bool outer : {true, false}) {
      const auto& curve = outer ? wall_.outer() : wall_.bore();
      auto& seams = seams_[outer ? 0 : 1];
      auto places = curve.seams();
      if (places.empty()) places = {0.0, 0.5 * curve.girth()};
      for (const double s : places) seams.push_back(outer ? s : wall_.outside_of(curve.at(s)));
      std::ranges::sort(seams);
      all_seams_.insert(all_seams_.end(), seams.begin(), seams.end());
    }
    std::ranges::sort(all_seams_);
    const auto again = std::ranges::unique(
        all_seams_, [](double a, double b) { return b - a <= kSamePlace; });  // concentric corners
    all_seams_.erase(again.begin(), again.end());
  }

  Brep build() {
    for (const bool finish : {false, true}) {
      ask();
      const auto& end = finish ? part_.finish : part_.start;
      const SectionRing ring(wall_, end.spec, end.table, all_seams_);
      add_cut(ring, finish, finish ? cuts_[1] : cuts_[0]);
    }
    const auto& layout = part_.cutouts;
    for (std::size_t i = 0; i < layout.instances.size(); ++i) {
      ask();
      if (layout.instances[i].sunk) continue;
      const auto name = "cut-out " + cutout_tag(layout, i);
      if (layout.mould_of(layout.instances[i]).laying.over() != nullptr) {
        const auto over = add_over_cutout(wall_, layout, layout.instances[i], name, out_);
        over_[0].push_back(over.outside);
        over_[1].push_back(over.bore);
        over_names_ = over_names_.empty() ? name : over_names_ + ", " + name;
        continue;
      }
      cutouts_.push_back(add_cutout(wall_, layout, layout.instances[i], name, out_));
    }
    for (const bool outer : {true, false}) {
      ask();
      add_wall(outer);
    }
    return std::move(out_);
  }

 private:
  /// Edges of a cut: along each curve from row to row, and across the wall, from the outside in.
  struct Cut {
    std::vector<double> s;                           // of each row
    std::vector<std::vector<std::size_t>> vertices;  // of each curve, outside first
    // Empty between two rows at one place.
    std::vector<std::vector<std::optional<std::size_t>>> along, across;
    std::vector<Station> outside, bore;
  };

  std::size_t add_edge(std::size_t from, std::size_t to, Brep::Points curve) {
    out_.edges.push_back({from, to, std::move(curve)});
    return out_.edges.size() - 1;
  }

  /// Returns the curve from one row to the next on the outside or the bore: a line, or a cubic that
  /// is straight in (angle, z).
  [[nodiscard]] Brep::Points curve(const Across& a, const Across& b, std::size_t k) const {
    const bool outer = k == 0;
    const auto& line = outer ? wall_.outer() : wall_.bore();
    const auto& from = outer ? a.stations.front() : a.stations.back();
    const auto& to = outer ? b.stations.front() : b.stations.back();
    const auto &p = a.points[k], &q = b.points[k];
    const bool inside = k > 0 && k + 1 < a.points.size();  // of the land's edge
    const double radius = inside ? land_radius(p, q, turned(from, to)) : line.corner();
    return curve_between(p, q, from, to, radius);
  }
  /// Of the arc through two points on which the normal turns by an angle.
  [[nodiscard]] static double land_radius(const Vector3d& p, const Vector3d& q, double angle) {
    return (q - p).head<2>().norm() / (2.0 * elementary::sin(0.5 * std::abs(angle)));
  }

  void add_cut(const SectionRing& ring, bool finish, Cut& cut) {
    const auto& rows = ring.rows();
    const auto curves = rows.front().points.size();
    cut.vertices.assign(curves, {});
    cut.along.assign(curves, {});
    cut.across.assign(curves - 1, {});
    add_vertices(rows, curves, cut);
    const bool square = ring.square();
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const auto j = ring.next(i);
      for (std::size_t k = 0; k < curves; ++k) {
        const auto a = cut.vertices[k][i], b = cut.vertices[k][j];
        const bool unused = square && k > 0 && k + 1 < curves;
        cut.along[k].push_back(a == b || unused
                                   ? std::nullopt
                                   : std::optional(add_edge(a, b, curve(rows[i], rows[j], k))));
      }
      for (std::size_t k = 0; k + 1 < curves && !square; ++k) {
        const auto a = cut.vertices[k][i], b = cut.vertices[k + 1][i];
        cut.across[k].push_back(add_edge(a, b, {rows[i].points[k], rows[i].points[k + 1]}));
      }
    }
    if (square) return add_square(finish, cut);
    for (std::size_t i = 0; i < rows.size(); ++i)
      for (std::size_t k = 0; k + 1 < curves; ++k)
        add_patch(rows[i], rows[ring.next(i)], i, ring.next(i), k, finish, cut);
  }

  void add_vertices(const std::vector<Across>& rows, std::size_t curves, Cut& cut) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      cut.s.push_back(rows[i].s);
      cut.outside.push_back(rows[i].stations.front());
      cut.bore.push_back(rows[i].stations.back());
      for (std::size_t k = 0; k < curves; ++k) {
        const bool again =
            i > 0 && (rows[i].points[k] - rows[i - 1].points[k]).norm() <= kSamePlace;
        if (!again) out_.vertices.push_back(rows[i].points[k]);
        cut.vertices[k].push_back(again ? cut.vertices[k].back() : out_.vertices.size() - 1);
      }
    }
  }

  [[nodiscard]] static std::string name_of(bool finish) {
    return std::string(joint::end_name(finish));
  }

  void add_square(bool finish, const Cut& cut) {
    Brep::Face face{.name = name_of(finish),
                    .surface = Brep::Plane{out_.vertices[cut.vertices[0][0]],
                                           Vector3d(0.0, 0.0, finish ? 1.0 : -1.0)},
                    .cut = true,
                    .loops = {}};
    for (const auto* along : {&cut.along.front(), &cut.along.back()}) {
      Brep::Loop loop;
      for (const auto& edge : *along)
        if (edge) loop.emplace_back(*edge, (along == &cut.along.front()) == finish);
      if (!loop.empty() && !loop.front().second) std::ranges::reverse(loop);
      face.loops.push_back(std::move(loop));
    }
    out_.faces.push_back(std::move(face));
  }

  /// The face of one gap, from curve k to the next one in.
  void add_patch(const Across& a, const Across& b, std::size_t i, std::size_t j, std::size_t k,
                 bool finish, const Cut& cut) {
    Brep::Loop loop;
    const auto& outer = cut.along[k][i];
    const auto& inner = cut.along[k + 1][i];
    if (!outer && !inner) return;  // one row twice
    if (outer) loop.emplace_back(*outer, false);
    loop.emplace_back(*cut.across[k][i], true);
    if (inner) loop.emplace_back(*inner, true);
    loop.emplace_back(*cut.across[k][j], false);
    if (finish) {
      std::ranges::reverse(loop);
      for (auto& use : loop) use.second = !use.second;
    }
    Brep::Face face{.name = name_of(finish), .surface = {}, .cut = true, .loops = {loop}};
    const std::vector<Vector3d> corners{b.points[k], a.points[k], a.points[k + 1], b.points[k + 1]};
    const bool straight = (!outer || out_.edges[*outer].curve.size() == 2) &&
                          (!inner || out_.edges[*inner].curve.size() == 2);
    if (auto plane = straight ? plane_of(corners) : std::nullopt) {
      if (finish) plane->normal = -plane->normal;
      face.surface = *plane;
    } else {
      // From s to s, and from the bore outwards: against the metal at the start.
      face.surface = Brep::Patch{cubic(a.points[k + 1], b.points[k + 1], inner),
                                 cubic(a.points[k], b.points[k], outer)};
      face.same = !finish;
    }
    out_.faces.push_back(std::move(face));
  }
  [[nodiscard]] Brep::Points cubic(const Vector3d& p, const Vector3d& q,
                                   const std::optional<std::size_t>& edge) const {
    return as_cubic(edge ? out_.edges[*edge].curve : Brep::Points{p, q});
  }

  /// The row where the faces on both sides of a seam part: of a jump there, the one with less
  /// metal.
  [[nodiscard]] std::size_t row_at(const Cut& cut, std::size_t k, double s, bool finish) const {
    std::optional<std::size_t> best;
    const double girth = wall_.outer().girth();
    for (std::size_t i = 0; i < cut.s.size(); ++i) {
      if (std::abs(std::remainder(cut.s[i] - s, girth)) > 2.0 * kSamePlace) continue;
      const auto z = [&](std::size_t row) { return out_.vertices[cut.vertices[k][row]].z(); };
      if (!best || (finish ? z(i) < z(*best) : z(i) > z(*best))) best = i;
    }
    return best.value();
  }

  /// Appends the edges of a cut between two rows, ascending.
  static void append(const Cut& cut, std::size_t k, std::size_t from, std::size_t to,
                     Brep::Loop& out) {
    const auto n = cut.s.size();
    for (auto i = from; i != to; i = i + 1 < n ? i + 1 : 0)
      if (const auto& edge = cut.along[k][i]) out.emplace_back(*edge, true);
  }

  void add_wall(bool outer) {
    const auto& seams = seams_[outer ? 0 : 1];
    const auto& curve = outer ? wall_.outer() : wall_.bore();
    const SeamPieces pieces(curve, over_[outer ? 0 : 1], over_names_);
    const auto own = [&](double s) { return outer ? s : wall_.across(wall_.outer().at(s)).bore.s; };
    std::vector<std::array<std::size_t, 2>> rows;  // of each seam, at both ends
    std::vector<std::vector<std::size_t>> sides;   // the edges there, from start to finish
    for (const double s : seams) {
      std::array<std::size_t, 2> at{}, vertex{};
      for (const bool finish : {false, true}) {
        const auto& cut = cuts_[finish ? 1 : 0];
        const auto k = outer ? 0 : cut.along.size() - 1;
        at[finish ? 1 : 0] = row_at(cut, k, s, finish);
        vertex[finish ? 1 : 0] = cut.vertices[k][at[finish ? 1 : 0]];
      }
      rows.push_back(at);
      sides.push_back(pieces.add(own(s), vertex[0], vertex[1], out_));
    }
    for (std::size_t i = 0; i < seams.size(); ++i) {
      const auto j = (i + 1) % seams.size();
      const double girth = wall_.outer().girth();
      double middle = 0.5 * (seams[i] + seams[j] + (j == 0 ? girth : 0.0));
      if (middle >= girth) middle -= girth;
      const auto station = wall_.outer().at(middle);
      Strip strip{.from = own(seams[i]), .to = own(seams[j]), .across = station.tangent()};
      if (strip.to <= strip.from) strip.to += curve.girth();
      append(cuts_[0], outer ? 0 : cuts_[0].along.size() - 1, rows[i][0], rows[j][0], strip.low);
      append(cuts_[1], outer ? 0 : cuts_[1].along.size() - 1, rows[i][1], rows[j][1], strip.high);
      add_faces(outer, station, pieces.faces_of(strip, sides[i], sides[j], out_), strip.across);
    }
  }

  /// Adds the faces of a strip; a cut-out on a flat lies in one of them.
  void add_faces(bool outer, const Station& station, std::vector<std::vector<Brep::Loop>> faces,
                 const Vector2d& across) {
    std::vector<Brep::Face> made;
    for (auto& loops : faces) {
      if (!outer)
        for (auto& loop : loops) {
          std::ranges::reverse(loop);
          for (auto& use : loop) use.second = !use.second;
        }
      auto& face = made.emplace_back(wall_face(outer, station, std::move(loops.front())));
      for (std::size_t i = 1; i < loops.size(); ++i) face.loops.push_back(std::move(loops[i]));
    }
    if (!station.on_corner) add_borders(outer, station.face, across, made);
    for (auto& face : made) out_.faces.push_back(std::move(face));
  }

  void add_borders(bool outer, int number, const Vector2d& across,
                   std::vector<Brep::Face>& faces) const {
    for (const auto& cutout : cutouts_) {
      if (cutout.face != number) continue;
      const auto& loop = outer ? cutout.outside : cutout.bore;
      auto* in = &faces.front();
      for (auto& face : faces)
        if (faces.size() > 1 && goes_round(face.loops.front(), across, loop, out_)) in = &face;
      in->loops.push_back(loop);
    }
  }

  [[nodiscard]] Brep::Face wall_face(bool outer, const Station& outside, Brep::Loop loop) const {
    const auto at = outer ? outside : wall_.across(outside).bore;
    const auto& curve = outer ? wall_.outer() : wall_.bore();
    Brep::Face face{.name = outer ? "outside" : "bore", .surface = {}, .loops = {std::move(loop)}};
    const Vector3d place(at.point.x(), at.point.y(), 0.0);
    if (at.curvature > 0.0) {
      const Vector2d centre = at.point - at.normal * curve.corner();
      face.surface =
          Brep::Cylinder{centre, curve.corner(), elementary::atan2(-at.normal.y(), -at.normal.x())};
      face.same = outer;
    } else {
      const double sign = outer ? 1.0 : -1.0;
      face.surface = Brep::Plane{place, sign * Vector3d(at.normal.x(), at.normal.y(), 0.0)};
    }
    return face;
  }

  section::Wall wall_;
  const part::SectionPart& part_;
  std::array<std::vector<double>, 2>
      seams_;  // outer s where faces of the outside and the bore meet
  std::vector<double> all_seams_;
  std::array<Cut, 2> cuts_;
  std::vector<CutoutBorder> cutouts_;
  std::array<std::vector<OverBorder>, 2> over_;  // outside, bore
  std::string over_names_;
  Brep out_;
};

}  // namespace

Brep section_solid(const part::SectionPartSpec& spec, const part::SectionPart& part) {
  if (!(std::min(spec.section.corner, spec.section.inner_corner) >= kLeastRadius))
    throw UnfitOption{"format", "step prints no corner without a radius, outside or of the bore"};
  return Builder(spec, part).build();
}

}  // namespace tubecut::api
