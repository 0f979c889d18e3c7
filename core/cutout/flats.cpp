#include "core/cutout/flats.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/angle.hpp"

namespace tubecut::cutout {
namespace {

constexpr double kOnFlat = 1e-9;  // mm, by rounding

int opposite(int face) { return (face + 1) % 4 + 1; }

/// Returns the anchor's share of a girth, rad; the far side's is half a turn further.
double share_of(const section::Curve& curve, int face, double offset, bool far) {
  return curve.on_face(face, offset) / curve.girth() * kTwoPi - (far ? kPi : 0.0);
}

/// How far an instance reaches across its face, mm from the middle.
struct Across {
  double from, to;
};
Across across(const Layout& layout, const Instance& one) {
  const auto& mould = layout.mould_of(one);
  const auto box = bounds(mould.chain);
  const bool far = mould.laying.far();  // its b runs against s
  return {one.offset + (far ? -box.most.y() : box.least.y()),
          one.offset + (far ? -box.least.y() : box.most.y())};
}

}  // namespace

namespace {

/// On a corner: its way on the outside, so that it lies beyond the flat; `back`: beyond the one
/// that follows as s grows.
FacePlace place_at(const section::Station& here, const section::Curve& outer, bool back = false) {
  if (!here.on_corner) return {here.face, here.along};
  if (!back) return {here.face, outer.half_flat(here.face) + outer.corner() * here.along};
  const int next = here.face % 4 + 1;
  return {next, -outer.half_flat(next) - outer.corner() * (0.5 * kPi - here.along)};
}

/// What does not go over a corner.
const char* kind_of(const Spec& spec) {
  if (spec.countersink) return "countersink";
  return std::holds_alternative<Slit>(spec.shape) ? "slit" : "hole of this kind";
}

}  // namespace

FacePlace face_place(const section::Curve& outer, const Anchor& at) {
  if (at.face != 0) return {at.opposite ? opposite(at.face) : at.face, at.offset};
  return place_at(outer.at((at.phi + (at.opposite ? kPi : 0.0)) / kTwoPi * outer.girth()), outer);
}

double half_flat(const section::Wall& wall, int face) {
  return std::min(wall.outer().half_flat(face), wall.bore().half_flat(face));
}

FacePlace step_place(const section::Curve& outer, const Anchor& at, const Step& step) {
  auto [face, offset] = face_place(outer, at);
  if (step.face) face = *step.face;
  offset += step.turn / kTwoPi * outer.girth();
  // A step may leave its face; on a corner it lies beyond the flat that it comes from.
  if (std::abs(offset) > outer.half_flat(face) && step.turn != 0.0)
    return place_at(outer.at(outer.on_face(face, offset)), outer, step.turn < 0.0);
  return {face, offset};
}

std::optional<double> over_corner(const section::Wall& wall, const Spec& spec, const Step& step,
                                  const Chain& chain) {
  const bool slit = std::holds_alternative<Slit>(spec.shape);
  if (slit || spec.countersink || spec.on_one_flat) return {};
  const auto [face, offset] = step_place(wall.outer(), spec.at, step);
  const auto box = bounds(chain);
  const double half = half_flat(wall, face);
  const double beyond = std::max(offset + box.most.y() - half, -half - offset - box.least.y());
  if (beyond <= kOnFlat) return {};
  return wall.outer().at(wall.outer().on_face(face, offset)).s;
}

void put_over_corner(const section::Wall& wall, const SectionLay& over, bool far, Instance& one) {
  const auto& anchor = over.anchor();
  const auto at = place_at(anchor.outer, wall.outer());
  one.face = at.face;
  one.offset = at.offset;
  one.phi = anchor.s / wall.outer().girth() * kTwoPi - (far ? kPi : 0.0);
  one.phi_inner = anchor.s_bore / wall.bore().girth() * kTwoPi - (far ? kPi : 0.0);
}

void put_on_face(const section::Wall& wall, const Anchor& at, const Step& step, bool far,
                 Instance& one) {
  const auto& outer = wall.outer();
  const auto [face, offset] = step_place(outer, at, step);
  one.face = far ? opposite(face) : face;
  one.offset = far ? -offset : offset;
  one.phi = share_of(outer, one.face, one.offset, far);
  one.phi_inner = share_of(wall.bore(), one.face, one.offset, far);
}

std::optional<Issue> beyond_flat(const Spec& spec, const Layout& layout, std::size_t first,
                                 const section::Wall& wall) {
  if (const auto* faces = std::get_if<Faces>(&spec.pattern)) {
    if (std::ranges::find(faces->faces, face_place(wall.outer(), spec.at).face) ==
        faces->faces.end())
      return Issue{.code = ErrorCode::unsupported_combination,
                   .member = "pattern/faces",
                   .hint = "the face of the cut-out itself is one of them"};
  }
  const bool by_face = spec.at.face != 0;
  for (auto i = first; i < layout.instances.size(); ++i) {
    const auto& one = layout.instances[i];
    if (layout.mould_of(one).laying.over() != nullptr) continue;
    const auto reach = across(layout, one);
    const double half = half_flat(wall, one.face);
    const double beyond = std::max(reach.to - half, -half - reach.from);
    if (beyond <= kOnFlat) continue;
    const auto face = "the flat of face " + std::to_string(one.face);
    Issue out{.code = ErrorCode::out_of_range,
              .hint = one.name + " reaches " + brief(beyond) + " mm beyond " + face +
                      ", which is " + brief(2.0 * half) + " mm wide; no " + kind_of(spec) +
                      " goes over a corner"};
    // Where the anchor's own has its room, the shape fits.
    const bool own = one.name == layout.instances[first].name;
    if (own && reach.to - reach.from > 2.0 * half) {
      out.member = layout.mould_of(one).cone ? "countersink/diameter" : "shape";
      out.got = reach.to - reach.from;
      out.limit = 2.0 * half;
      out.unit = "mm";
    } else if (count_of(spec.pattern) > 1) {
      out.member = "pattern";
      out.got = one.name;
    } else {
      out.member = by_face ? "at/offset" : "at/girth";
      const double wanted = reach.to > half ? one.offset - beyond : one.offset + beyond;
      out.got = by_face ? one.offset : wall.outer().on_face(one.face, one.offset);
      out.limit = by_face ? wanted : wall.outer().on_face(one.face, wanted);
      out.unit = "mm";
    }
    return out;
  }
  return {};
}

}  // namespace tubecut::cutout
