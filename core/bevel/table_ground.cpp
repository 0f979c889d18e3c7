#include <algorithm>

#include "core/base/elementary.hpp"
#include "core/bevel/table_parts.hpp"

namespace tubecut::bevel::detail {
namespace {

Result<void> check(const TableSpec& spec) {
  if (!(spec.root_face >= 0.0 && spec.root_face < spec.target.wall))
    return fail({.code = ErrorCode::out_of_range,
                 .member = "root_face",
                 .got = spec.root_face,
                 .limit = spec.target.wall,
                 .unit = "mm",
                 .hint = "must be less than the wall"});
  if (spec.root_face > 0.0 && spec.contact != Contact::inner)
    return fail({.code = ErrorCode::unsupported_combination,
                 .member = "root_face",
                 .hint = "a root face goes with contact inner"});
  return check_groove(spec.groove);
}

/// What the smoother starts from.
double input_of(const TableSpec& spec, const Point& p) {
  if (spec.contact == Contact::inner) return std::max(p.raw, p.required);
  const bool floored =
      spec.contact == Contact::automatic && !std::holds_alternative<SquareCut>(spec.groove);
  return floored ? std::min(std::max(p.raw, p.required), spec.torch.max.rad()) : p.raw;
}

/// With a land: its elevation, and the least B from its outer edge.
void stand_on_face(const Ground& g, double phi, double z, Point& out) {
  const double edge = g.wall.inner + g.spec.root_face;
  const double least = required_bevel(g.root.cutters, {g.wall.inner, edge},
                                      joint::generator_at(g.wall.inner, phi), z);
  out.face = std::max(0.0, least);
  const double slope = elementary::tan(std::min(out.face, g.spec.torch.max.rad()));
  out.required = required_bevel(g.root.cutters, {edge, g.wall.outer},
                                joint::generator_at(edge, phi), z + g.spec.root_face * slope);
}

/// The side of a node with the larger input: at an event the larger one-sided value counts.
Point larger(const Ground& g, const joint::Node& node) {
  const auto sides = joint::hits_at(g.root, node);
  auto before = point(g, node.phi, sides.before, node.before, node.z);
  if (node.kind == joint::NodeKind::smooth || node.kind == joint::NodeKind::jump) return before;
  auto after = point(g, node.phi, sides.after, node.after, node.z);
  return before.input >= after.input ? before : after;
}

}  // namespace

Result<Ground> ground(const TableSpec& spec) {
  if (auto ok = check(spec); !ok) return tl::unexpected(ok.error());
  auto cutters = grown_partners(spec);
  if (!cutters) return tl::unexpected(cutters.error());
  const Wall wall{spec.target.inner_radius(), spec.target.outer_radius};
  const bool outer = spec.root_surface == RootSurface::outer;
  auto root = joint::trace(*cutters, outer ? wall.outer : wall.inner);
  if (!root) return tl::unexpected(root.error());
  Ground out{.spec = spec,
             .cutters = *std::move(cutters),
             .root = *std::move(root),
             .inner = {},
             .other_events = {},
             .wall = wall,
             .rule = Rule(spec.groove, spec.dihedral)};
  out.other_events = joint::divide(out.root.cutters, outer ? wall.inner : wall.outer).events;
  if (outer) {
    auto inner = joint::trace(out.cutters, wall.inner);
    if (!inner) return tl::unexpected(inner.error());
    out.inner = *std::move(inner);
  }
  return out;
}

Point point(const Ground& g, double phi, const joint::Hit& hit, std::size_t cutter, double root_z) {
  const auto line = joint::generator_at(g.root.radius, phi);
  Point out{.cutter = cutter};
  const bool published = g.spec.dihedral == Dihedral::as_published;
  out.angles =
      g.rule.angles(published ? joint::published_normal(g.root.cutters[cutter], line) : hit.normal);
  const auto& torch = g.spec.torch;
  out.raw = std::clamp(out.angles.b, torch.min.rad(), torch.max.rad());
  const double z = g.inner ? joint::contact_at(*g.inner, phi).z : root_z;
  if (g.spec.root_face > 0.0)
    stand_on_face(g, phi, z, out);
  else
    out.required =
        required_bevel(g.root.cutters, g.wall, joint::generator_at(g.wall.inner, phi), z);
  out.input = input_of(g.spec, out);
  return out;
}

bool Rows::jump_pair(std::size_t i) const {
  const auto& nodes = samples.nodes;
  return i + 1 < nodes.size() && nodes[i].kind == joint::NodeKind::jump &&
         nodes[i + 1].kind == joint::NodeKind::jump && nodes[i].phi == nodes[i + 1].phi;
}

Result<Rows> rows(const Ground& g, const std::vector<double>& also, const std::stop_token& stop) {
  auto samples = joint::sample(g.root, g.spec.sampling, also, stop);
  if (!samples) return tl::unexpected(samples.error());
  Rows out{.samples = *std::move(samples), .points = {}};
  out.points.reserve(out.samples.nodes.size());
  for (const auto& node : out.samples.nodes) {
    if (stop.stop_requested()) return fail({.code = ErrorCode::cancelled});
    out.points.push_back(larger(g, node));
  }
  return out;
}

Intervals degrees(std::vector<std::pair<double, double>> intervals) {
  for (auto& [from, to] : intervals) {
    from *= kDegPerRad;
    to *= kDegPerRad;
  }
  return intervals;
}
}  // namespace tubecut::bevel::detail

namespace tubecut::bevel {

Result<void> check_groove(const GrooveRule& groove) {
  const auto* zoned = std::get_if<ZonedGroove>(&groove);
  if (zoned == nullptr) return {};
  auto ok = check_zones(*zoned);
  if (!ok)
    for (auto& issue : ok.error().issues) issue.member = "groove/" + issue.member;
  return ok;
}

Result<std::vector<joint::Cutter>> grown_partners(const TableSpec& spec) {
  auto cutters = joint::resolve(spec.partners);
  const double by = spec.coating + spec.root_gap;
  if (!cutters || by == 0.0) return cutters;
  for (auto& cutter : *cutters) {
    if (auto* tube = std::get_if<joint::TubeCutter>(&cutter)) {
      tube->radius += by;
    } else if (auto* plane = std::get_if<joint::PlaneCutter>(&cutter)) {
      const double up = plane->normal.z() < 0.0 ? -1.0 : 1.0;
      plane->point += up * by * plane->normal.normalized();
    } else if (auto* box = std::get_if<joint::BoxCutter>(&cutter)) {
      box->width += 2.0 * by;
      box->height += 2.0 * by;
      box->corner += by;
    } else if (auto* cone = std::get_if<joint::ConeCutter>(&cutter)) {
      cone->radius += by / elementary::cos(cone->half_angle.rad());
    } else if (auto* elbow = std::get_if<joint::ElbowCutter>(&cutter)) {
      elbow->radius += by;
    }
  }
  return cutters;
}

}  // namespace tubecut::bevel
