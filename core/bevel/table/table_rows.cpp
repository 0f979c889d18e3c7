#include <algorithm>
#include <span>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/base/try.hpp"
#include "core/bevel/beam/beam.hpp"
#include "core/bevel/beam/torch_line.hpp"
#include "core/bevel/table/stated.hpp"
#include "core/bevel/table/table_parts.hpp"

namespace tubecut::bevel::detail {
namespace {

bool is_set_in(const std::optional<joint::Joint>& stated) {
  return stated && stated->kind == joint::JointKind::set_in;
}
bool set_in(const TableSpec& spec, std::size_t partner) {
  return is_set_in(stated_joint(spec, partner));
}

}  // namespace

Result<void> check_stated(const TableSpec& spec) {
  for (std::size_t i = 0; i < spec.stated.size(); ++i) {
    if (!spec.stated[i]) continue;
    if (!set_in(spec, i) && spec.root_gap > 0.0 && spec.root_gap != spec.stated[i]->gap)
      return fail({.code = ErrorCode::joint_contradicts,
                   .member = "root_gap",
                   .got = spec.root_gap,
                   .limit = spec.stated[i]->gap,
                   .unit = "mm",
                   .hint = "the members state another gap for this joint"});
    if (set_in(spec, i) && std::holds_alternative<ZonedGroove>(spec.groove))
      return fail({.code = ErrorCode::unsupported_combination,
                   .member = "groove/rule",
                   .got = "zones",
                   .hint = "an end that is set in has no groove there, so no zone"});
  }
  return {};
}

namespace {

/// Checks that B = 0 is requested and within the torch's range.
Result<void> check_untilted(const TableSpec& spec) {
  if (!spec.untilted) return {};
  const bool reached = spec.torch.min.rad() <= 0.0 && spec.torch.max.rad() >= 0.0;
  const bool square = std::holds_alternative<SquareCut>(spec.groove);
  if (reached && square && spec.contact != Contact::inner) return {};
  return fail({.code = ErrorCode::unsupported_combination,
               .member = !square   ? "groove/rule"
                         : reached ? "contact"
                                   : "torch",
               .hint = "an untilted head cuts only B = 0"});
}

Result<void> check(const TableSpec& spec) {
  if (!(spec.root_face >= 0.0 && spec.root_face < spec.target.wall))
    return fail({.code = ErrorCode::out_of_range,
                 .member = "root_face",
                 .got = spec.root_face,
                 .limit = spec.target.wall,
                 .unit = "mm",
                 .hint = "must be less than the wall"});
  TRY(check_kerf(spec.kerf));
  if (!(spec.kerf < spec.target.outer_radius))
    return fail({.code = ErrorCode::out_of_range,
                 .member = "kerf",
                 .got = spec.kerf,
                 .limit = spec.target.outer_radius,
                 .unit = "mm",
                 .hint = "must be less than the tube's radius"});
  if (spec.root_face > 0.0 && spec.contact != Contact::inner)
    return fail({.code = ErrorCode::unsupported_combination,
                 .member = "root_face",
                 .hint = "a root face goes with contact inner"});
  if (auto ok = check_stated(spec); !ok) return ok;
  if (auto ok = check_untilted(spec); !ok) return ok;
  if (auto ok = check_gaps(spec); !ok) return ok;
  return check_groove(spec.groove);
}

/// Returns events that are no rows of the root's own contour: of the other wall, and of the land's
/// edge.
std::vector<double> row_phases(const TableSetup& g) {
  std::vector<double> out;
  for (const auto& event : g.other.events) out.push_back(event.phi);
  if (g.spec.root_face > 0.0)
    for (const auto& event : joint::divide(g.root.cutters, g.wall.inner + g.spec.root_face).events)
      out.push_back(event.phi);
  return out;
}

/// Returns the input of the smoother.
double input_of(const TableSpec& spec, const Point& p) {
  // An angle required beyond the range is rejected, except for rounding: 60 deg of a plane that
  // leans 30.
  if (spec.contact == Contact::inner)
    return std::min(std::max(p.raw, p.required), spec.torch.max.rad());
  const bool floored =
      spec.contact == Contact::automatic && !std::holds_alternative<SquareCut>(spec.groove);
  return floored ? std::min(std::max(p.raw, p.required), spec.torch.max.rad()) : p.raw;
}

/// With a land, computes its elevation, and the smallest B from its outer edge.
void stand_on_face(const TableSetup& g, std::span<const joint::PreparedCutter> partners, double phi,
                   double z, Point& out) {
  const double edge = g.wall.inner + g.spec.root_face;
  const double least =
      required_bevel(partners, {g.wall.inner, edge}, joint::generator_at(g.wall.inner, phi), z);
  out.face = std::max(0.0, least);
  const double slope = elementary::tan(std::min(out.face, g.spec.torch.max.rad()));
  out.required = required_bevel(partners, {edge, g.wall.outer}, joint::generator_at(edge, phi),
                                z + g.spec.root_face * slope);
}

/// Computes the angles where the root is at `z` on the inner wall, clear of these partners.
void fill_point(const TableSetup& g, double phi, std::span<const joint::PreparedCutter> partners,
                const joint::Hit& hit, double z, Point& out) {
  const bool published = g.spec.dihedral == Dihedral::as_published;
  const auto& rule = set_in(g.spec, out.cutter) && !g.spec.untilted ? g.flush : g.rule;
  out.angles =
      rule.angles(published ? joint::published_normal(g.root.cutters[out.cutter],
                                                      joint::generator_at(g.root.radius, phi))
                            : hit.normal);
  out.rates = radius_rates(g.root.cutters[out.cutter], hit.normal);
  const auto& torch = g.spec.torch;
  out.raw = std::clamp(out.angles.b, torch.min.rad(), torch.max.rad());
  if (g.spec.root_face > 0.0)
    stand_on_face(g, partners, phi, z, out);
  else
    out.required = required_bevel(partners, g.wall, joint::generator_at(g.wall.inner, phi), z);
  out.input = input_of(g.spec, out);
}

/// The side of an event with the larger input counts.
Point larger(const TableSetup& g, const joint::Node& node) {
  const auto sides = joint::hits_at(g.root, node);
  const auto before = point(g, node.phi, sides.before, node.before, node.z);
  const auto after = point(g, node.phi, sides.after, node.after, node.z);
  return before.input >= after.input ? before : after;
}

bool one_sided(const joint::Node& node) {
  return node.kind == joint::NodeKind::smooth || node.kind == joint::NodeKind::jump;
}

/// Returns true if the points can be vectorised; they cannot if each row has a rule of its own.
bool alike(const TableSpec& spec) {
  const bool zoned = std::holds_alternative<ZonedGroove>(spec.groove);
  const bool flush = !spec.untilted && std::ranges::any_of(spec.stated, is_set_in);
  return !zoned && !flush && spec.dihedral != Dihedral::as_published && spec.root_face == 0.0;
}

/// Computes `point` for these nodes at once, each by the cutter before it.
void make_alike(const TableSetup& g, std::span<const std::size_t> at, Rows& rows) {
  const auto n = at.size();
  std::vector<double> phi(n), z(n);
  std::vector<std::size_t> cutter(n);
  for (std::size_t i = 0; i < n; ++i) {
    const auto& node = rows.samples.nodes[at[i]];
    phi[i] = node.phi;
    z[i] = node.z;
    cutter[i] = node.before;
  }
  auto stations = joint::stations_at(g.root.radius, phi);
  std::vector<Angles> angles(n);
  const auto normals = joint::normals_at(g.root.cutters, stations, cutter);
  g.rule.angles(normals, angles);
  stations.radius = g.wall.inner;
  if (g.inner) z = joint::contacts_at(*g.inner, stations, phi).z;
  const auto required = required_bevels(g.root.cutters, g.wall, stations, z);
  const double least = g.spec.torch.min.rad(), most = g.spec.torch.max.rad();
  for (std::size_t i = 0; i < n; ++i) {
    auto& out = rows.points[at[i]];
    out = {.cutter = cutter[i],
           .angles = angles[i],
           .rates = radius_rates(g.root.cutters[cutter[i]],
                                 {normals.radial[i], normals.tangential[i], normals.axial[i]}),
           .raw = std::clamp(angles[i].b, least, most),
           .required = required[i]};
    out.input = input_of(g.spec, out);
  }
}

/// Returns the number of rows that `make_alike` computes in 1 ms, or with a rectangular tube in
/// 1.3.
std::size_t rows_between_stop_checks(std::span<const joint::PreparedCutter> cutters) {
  constexpr std::size_t kWithoutElbow = 256, kOfOneElbow = 128;  // searched, row by row
  const auto elbows =
      static_cast<std::size_t>(std::ranges::count_if(cutters, [](const joint::PreparedCutter& c) {
        return std::holds_alternative<joint::PreparedElbow>(c);
      }));
  return elbows == 0 ? kWithoutElbow : std::max<std::size_t>(1, kOfOneElbow / elbows);
}

bool same_place(const joint::Node& a, const joint::Node& b) {
  return a.phi == b.phi && a.z == b.z && a.before == b.before && a.after == b.after &&
         a.kind == b.kind;
}

/// Returns the nodes without a point in `known`; copies the points of the others.
std::vector<std::size_t> take_over(const Rows& known, Rows& rows) {
  const auto& had = known.samples.nodes;
  const auto& nodes = rows.samples.nodes;
  std::vector<std::size_t> out;
  std::size_t k = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    while (k < had.size() && had[k].phi < nodes[i].phi) ++k;
    auto at = k;  // the two nodes of a jump have one phi
    while (at < had.size() && had[at].phi == nodes[i].phi && !same_place(had[at], nodes[i])) ++at;
    if (at < had.size() && same_place(had[at], nodes[i]))
      rows.points[i] = known.points[at];
    else
      out.push_back(i);
  }
  return out;
}

}  // namespace

Result<TableSetup> set_up(const TableSpec& spec) {
  TRY(check(spec));
  TRY(auto cutters, grown_partners(spec));
  const Wall wall{spec.target.inner_radius(), spec.target.outer_radius};
  const bool outer = spec.root_surface == RootSurface::outer;
  TRY(auto root, joint::trace(cutters, outer ? wall.outer : wall.inner));
  TableSetup out{.spec = spec,
                 .cutters = std::move(cutters),
                 .root = std::move(root),
                 .inner = {},
                 .other = {},
                 .row_phases = {},
                 .solids = {},
                 .wall = wall,
                 .rule = Rule(spec.groove, spec.dihedral),
                 .flush = Rule(NoGroove{}, spec.dihedral),
                 .gaps = {}};
  if (const auto* zoned = zones_with_gaps(spec)) out.gaps = Zones(*zoned);
  out.other = joint::divide(out.root.cutters, outer ? wall.inner : wall.outer);
  out.row_phases = row_phases(out);
  if (stopped()) return fail({.code = ErrorCode::cancelled});
  for (const auto& cutter : out.cutters) out.solids.emplace_back(cutter);
  if (outer) {
    TRY(auto inner, joint::trace(out.cutters, wall.inner));
    out.inner = std::move(inner);
  }
  return out;
}

Point point(const TableSetup& g, double phi, const joint::Hit& hit, std::size_t cutter,
            double root_z) {
  const auto line = joint::generator_at(g.root.radius, phi);
  Point out{.cutter = cutter};
  if (g.gaps) {
    const auto stood = stood_at(g, line, hit);
    out.more = stood.more;
    out.raised = stood.more > 0.0 ? stood.hit.z - root_z : 0.0;
    fill_point(g, phi, {&stood.partner, 1}, stood.hit, root_z + out.raised, out);
  } else {
    fill_point(g, phi, g.root.cutters, hit, g.inner ? joint::contact_at(*g.inner, phi).z : root_z,
               out);
  }
  return out;
}

bool Rows::jump_pair(std::size_t i) const {
  const auto& nodes = samples.nodes;
  return i + 1 < nodes.size() && nodes[i].kind == joint::NodeKind::jump &&
         nodes[i + 1].kind == joint::NodeKind::jump && nodes[i].phi == nodes[i + 1].phi;
}

Result<Rows> rows(const TableSetup& g, const std::vector<double>& also, const Rows& known) {
  auto sampling = g.spec.sampling;
  sampling.max_nodes =
      std::min(sampling.max_nodes, most_rows(g.spec.kerf, g.spec.target.outer_radius));
  TRY(auto samples, joint::sample(g.root, sampling, also));
  Rows out{.samples = std::move(samples), .points = {}};
  const auto& nodes = out.samples.nodes;
  out.points.resize(nodes.size());
  const bool at_once = alike(g.spec);
  std::vector<std::size_t> together;
  for (const auto i : take_over(known, out)) {
    if (stopped()) return fail({.code = ErrorCode::cancelled});
    const auto& node = nodes[i];
    if (!one_sided(node))
      out.points[i] = larger(g, node);
    else if (at_once)
      together.push_back(i);
    else
      out.points[i] = point(g, node.phi, joint::hits_at(g.root, node).before, node.before, node.z);
  }
  const auto block_rows = rows_between_stop_checks(g.root.cutters);
  for (std::span<const std::size_t> left = together; !left.empty();) {
    if (stopped()) return fail({.code = ErrorCode::cancelled});
    const auto block = left.first(std::min(block_rows, left.size()));
    make_alike(g, block, out);
    left = left.subspan(block.size());
  }
  if (g.gaps) measure_root(g, out);
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
  return under("groove", check_zones(*zoned));
}

const std::optional<joint::Joint>& stated_joint(const TableSpec& spec, std::size_t i) {
  static const std::optional<joint::Joint> kNobody;
  return i < spec.stated.size() ? spec.stated[i] : kNobody;
}

Result<std::vector<joint::Cutter>> grown_partners(const TableSpec& spec) {
  auto cutters = joint::resolve(spec.partners);
  if (!cutters) return cutters;
  const auto* zoned = detail::zones_with_gaps(spec);
  for (std::size_t i = 0; i < cutters->size(); ++i)
    (*cutters)[i] = joint::grown(
        (*cutters)[i], zoned != nullptr
                           ? spec.coating + Zones(*zoned).least_gap()
                           : joint::seat(stated_joint(spec, i), spec.coating, spec.root_gap));
  return cutters;
}

}  // namespace tubecut::bevel
