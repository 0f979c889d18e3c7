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

FacePlace face_place(const section::Curve& outer, const Anchor& at) {
  if (at.face != 0) return {at.opposite ? opposite(at.face) : at.face, at.offset};
  const auto here = outer.at((at.phi + (at.opposite ? kPi : 0.0)) / kTwoPi * outer.girth());
  // On a corner: its way on the outside, so that it lies beyond the flat.
  if (here.on_corner) return {here.face, outer.half_flat(here.face) + outer.corner() * here.along};
  return {here.face, here.along};
}

double half_flat(const section::Wall& wall, int face) {
  return std::min(wall.outer().half_flat(face), wall.bore().half_flat(face));
}

void put_on_face(const section::Wall& wall, const Anchor& at, const Step& step, bool far,
                 Instance& one) {
  const auto& outer = wall.outer();
  auto [face, offset] = face_place(outer, at);
  if (step.face) face = *step.face;
  offset += step.turn / kTwoPi * outer.girth();
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
    const auto reach = across(layout, one);
    const double half = half_flat(wall, one.face);
    const double beyond = std::max(reach.to - half, -half - reach.from);
    if (beyond <= kOnFlat) continue;
    const auto face = "the flat of face " + std::to_string(one.face);
    Issue out{.code = ErrorCode::out_of_range,
              .hint = one.name + " reaches " + brief(beyond) + " mm beyond " + face +
                      ", which is " + brief(2.0 * half) +
                      " mm wide; no cut-out goes over a corner"};
    if (reach.to - reach.from > 2.0 * half) {
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
