#include <algorithm>
#include <cmath>

#include "core/base/elementary.hpp"
#include "core/bevel/section/section_rows.hpp"
#include "core/bevel/table/required.hpp"
#include "core/bevel/table/stated.hpp"

namespace tubecut::bevel::detail {
namespace {

constexpr double kOff = 1e-4;          // rad, of the place where a kink's side is looked at
constexpr double kSilhouette = 1e-12;  // axial part of a normal that is none
constexpr double kUndefined = 1e-4;    // radial and axial parts of a normal that give no angle

bool is_set_in(const TableSpec& spec, std::size_t partner) {
  const auto& stated = stated_joint(spec, partner);
  return stated && stated->kind == joint::JointKind::set_in;
}

/// The partner's normal seen in the root surface's own frame, and that frame's lean against the
/// row's: n_root = cos n + sin t.
struct RootNormal {
  Eigen::Vector3d normal;
  double slope;  // dz along the root's own outline
  double cos, sin;
};
RootNormal root_normal(const SectionSetup& g, const SectionRow& row, std::size_t cutter,
                       double offset) {
  auto own = g.root_station(row.at);
  if (offset != 0.0) own = g.root().curve.at(own.s + offset);
  // Concentric corners have one normal, where the bore has no corner radius too.
  if (!g.root_outside() && g.wall.concentric()) {
    own.normal = row.at.normal;
    own.nu = row.at.nu;
  }
  const auto hit = g.root().hit(cutter, own);
  const auto& n = row.at.normal;
  return {hit.normal, hit.z_dphi, n.dot(own.normal),
          n.x() * own.normal.y() - n.y() * own.normal.x()};
}

/// B of the groove's surface, which holds the root's tangent and makes the groove's angle with the
/// partner, in the plane of the row's normal.
void lean(const RootNormal& at, bool square, Angles& out) {
  const auto turn = elementary::sincos(out.gamma), rule = elementary::sincos(out.groove);
  const auto& n = at.normal;
  const Eigen::Vector3d along(turn.cos * n.z() + turn.sin * n.y(), -turn.sin * n.x(),
                              -turn.cos * n.x());
  const Eigen::Vector3d m = rule.cos * n - rule.sin * along;
  out.flush = elementary::atan2(-(at.cos * n.x() - at.sin * n.y()), n.z());
  if (!square) out.b = elementary::atan2(-(at.cos * m.x() - at.sin * m.y()), m.z());
}

double input_of(const TableSpec& spec, const SectionPoint& p) {
  const bool square = std::holds_alternative<SquareCut>(spec.groove);
  const bool floored =
      spec.contact == Contact::inner || (spec.contact == Contact::automatic && !square);
  return floored ? std::min(std::max(p.raw, p.required), spec.torch.max.rad()) : p.raw;
}

SectionPoint point(const SectionSetup& g, const SectionRow& row, std::size_t cutter,
                   double offset) {
  const bool square = std::holds_alternative<SquareCut>(g.spec.groove);
  const bool set_in = is_set_in(g.spec, cutter) && !g.spec.untilted;
  const auto at = root_normal(g, row, cutter, offset);
  SectionPoint out;
  // The dihedral counts from the row's own outside, gamma along the root.
  const auto& n = at.normal;
  out.angles =
      (set_in ? g.flush : g.rule)
          .angles({at.cos * n.x() - at.sin * n.y(), at.sin * n.x() + at.cos * n.y(), n.z()});
  const bool grazes = std::abs(n.z()) <= kSilhouette;
  if (grazes && std::isfinite(at.slope))
    out.angles.gamma = -elementary::atan(at.slope);
  else if (at.sin != 0.0)
    out.angles.gamma = elementary::atan2(n.y(), n.z());
  if (grazes || at.sin != 0.0) lean(at, square && !set_in, out.angles);
  out.raw = std::clamp(out.angles.b, g.spec.torch.min.rad(), g.spec.torch.max.rad());
  const auto view = local_view(g, row.at, row.across.wall);
  const double f = g.spec.root_face;
  if (f > 0.0) {
    const double edge = view.wall.inner + f;
    out.face = std::max(
        0.0, required_bevel(view.cutters, {view.wall.inner, edge}, view.inner, row.bore_z));
    const double slope = elementary::tan(std::min(out.face, g.spec.torch.max.rad()));
    out.required =
        required_bevel(view.cutters, {edge, view.wall.outer},
                       {edge, view.inner.cos_phi, view.inner.sin_phi}, row.bore_z + f * slope);
  } else {
    out.required = required_bevel(view.cutters, view.wall, view.inner, row.bore_z);
  }
  out.input = input_of(g.spec, out);
  return out;
}

/// Returns true if the partner's normal lies along the girth, as where a generator runs within a
/// flat side: rounding alone would give its angles and what it requires, and the limits near
/// hold.
bool undefined(const SectionSetup& g, const SectionRow& row, std::size_t cutter) {
  const auto at = root_normal(g, row, cutter, 0.0);
  const double radial = at.cos * at.normal.x() - at.sin * at.normal.y();
  return elementary::hypot(radial, at.normal.z()) < kUndefined;
}

/// A jump's row, moved to its own side.
SectionRow moved(const SectionSetup& g, SectionRow row, double offset) {
  row.at = g.wall.outer().at(row.at.s + row.side * offset);
  row.across = g.wall.across(row.at);
  row.z = g.root().height(row.before, g.root_station(row.at));
  row.bore_z = g.root_outside() ? joint::contact_at(g.inner, row.across.bore).z : row.z;
  return row;
}

}  // namespace

void fill_row(const SectionSetup& g, SectionRow& row) {
  row.bore_z = g.root_outside() ? joint::contact_at(g.inner, row.across.bore).z : row.z;
  row.cutter = row.before;
  const double offset = kOff * std::max(g.root().curve.corner(), 1.0);
  if (!row.corner || row.jump) {
    const bool off = row.jump && (undefined(g, row, row.before) || undefined(g, row, row.other));
    row.point = point(g, off ? moved(g, row, offset) : row, row.before, 0.0);
    return;
  }
  // The side of an event with the larger input counts; a kink's sides are those next to it.
  const bool kink = row.before == row.after;
  const auto side = [&](std::size_t cutter, double way) {
    return point(g, row, cutter, kink || undefined(g, row, cutter) ? way * offset : 0.0);
  };
  const auto first = side(row.before, -1.0), second = side(row.after, 1.0);
  row.point = first.input >= second.input ? first : second;
  row.cutter = first.input >= second.input ? row.before : row.after;
}

}  // namespace tubecut::bevel::detail
