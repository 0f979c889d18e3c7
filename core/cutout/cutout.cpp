#include "core/cutout/cutout.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "core/base/elementary.hpp"
#include "core/base/try.hpp"
#include "core/cutout/flats.hpp"
#include "core/cutout/rows.hpp"
#include "core/cutout/sizes.hpp"
#include "core/math/rotation.hpp"

namespace tubecut::cutout {
namespace {

struct Chains {
  Result<Chain> operator()(const Circle& c) const { return circle(c.diameter); }
  Result<Chain> operator()(const Slot& s) const { return slot(s.length, s.width); }
  Result<Chain> operator()(const Rectangle& r) const {
    return rectangle(r.along, r.round, r.radius);
  }
  Result<Chain> operator()(const Slit& s) const { return slit(s.length, s.width); }
  Result<Chain> operator()(const Contour& c) const {
    return under("shape", drawn(c.start, c.pieces, c.mirrored));
  }
};

struct LeastSize {
  std::optional<double> operator()(const Circle& c) const { return c.diameter; }
  std::optional<double> operator()(const Slot& s) const { return s.width; }
  std::optional<double> operator()(const Rectangle& r) const { return std::min(r.along, r.round); }
  std::optional<double> operator()(const Contour&) const { return {}; }
  std::optional<double> operator()(const Slit&) const { return {}; }
};

/// A prism's wall leans across; the torch's range says how far it may.
Result<void> check_lean(const bevel::Hole& rows, const Ground& ground) {
  double most = 0.0;
  for (const double a : rows.a) most = std::max(most, std::abs(a));
  if (most <= ground.most_lean) return {};
  return fail({.code = ErrorCode::torch_range,
               .member = "tilt",
               .got = most * kDegPerRad,
               .limit = ground.most_lean * kDegPerRad,
               .unit = "deg",
               .hint = "the torch would lean so far across; tilt none cuts the wall square"});
}

bool alike(const Segment& a, const Segment& b) {
  return a.from == b.from && a.to == b.to && a.centre == b.centre && a.sweep == b.sweep;
}

Cone cone_of(const Spec& spec) {
  return {.hole = std::get<Circle>(spec.shape).diameter,
          .diameter = spec.countersink->diameter,
          .half = 0.5 * spec.countersink->angle};
}

/// `over`: s of an anchor on a section whose chain leaves its flat.
Laying laying_of(const Spec& spec, const Ground& ground, std::optional<double> over, bool far) {
  if (over) return {*ground.section, *over, lay_of(spec.wall, spec.tilt), far};
  if (ground.section) return {ground.section->section(), far};
  // Along the tube all its walls are one, and check_sizes refuses any other that does not lean.
  if (std::holds_alternative<Slit>(spec.shape)) return {ground.tube, Lay::prism, far};
  return {ground.tube, lay_of(spec.wall, spec.tilt), far};
}

std::optional<Mould::Line> slit_of(const Spec& spec) {
  const auto* one = std::get_if<Slit>(&spec.shape);
  if (one == nullptr) return {};
  return Mould::Line{slit_line(*one, spec.turn), one->pierce};
}

/// Only a contour has pieces to point at; over corners a beam square to the outside needs more room
/// than next to the shape's own anchor.
void point_at_shape(const Spec& spec, std::vector<Issue>& issues) {
  if (std::holds_alternative<Contour>(spec.shape)) return;
  for (auto& issue : issues) {
    issue.member.clear();
    if (issue.code != ErrorCode::out_of_range || issue.limit.index() == 0) continue;
    issue.hint =
        "over a corner the beam is square to the outside and is that much wider next to the "
        "bore, so that its hollows need this radius; make it wider, or cut it by wall normal with "
        "tilt free";
  }
}

/// Finds the mould of one side, or makes it.
Result<std::size_t> mould_of(const Spec& spec, const Chain& chain, const Laying& laying,
                             const Ground& ground, std::vector<Mould>& all) {
  const auto line = slit_of(spec);
  for (std::size_t i = 0; i < all.size(); ++i)
    if (!all[i].cone && all[i].laying.is_like(laying) && all[i].as_cut == spec.as_cut &&
        all[i].slit == line && std::ranges::equal(all[i].chain, chain, alike))
      return i;
  const Cutting cutting{.kerf = ground.kerf, .tolerance = ground.tolerance, .as_cut = spec.as_cut};
  auto found = line ? slit_rows(laying, chain, line->line, cutting) : rows(laying, chain, cutting);
  if (!found && laying.over() != nullptr) point_at_shape(spec, found.error().issues);
  TRY(auto made, under("shape", std::move(found)));
  TRY(check_lean(made, ground));
  all.push_back({.laying = laying,
                 .chain = chain,
                 .as_cut = spec.as_cut,
                 .rows = std::move(made),
                 .taken = taken(laying, chain),
                 .centre = deep_in(spec, chain),
                 .slit = line});
  return all.size() - 1;
}

/// Finds the mould of a cone, or makes it.
Result<std::size_t> cone_mould_of(const Cone& cone, const Laying& laying, const Ground& ground,
                                  std::vector<Mould>& all) {
  if (auto issues =
          check_cone(laying, cone, ground.kerf, std::min(ground.most_lean, ground.most_swing));
      !issues.empty())
    return tl::unexpected(Error{std::move(issues)});
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].cone == cone) return i;
  all.push_back({.laying = laying,
                 .chain = circle(cone.diameter),
                 .rows = cone_rows(laying, cone, {ground.kerf, ground.tolerance}),
                 .taken = cone_taken(laying, cone),
                 .cone = cone});
  return all.size() - 1;
}

/// The moulds of a spec: near side, its cone, far side.
Result<std::vector<std::size_t>> moulds_of(const Spec& spec, const Ground& ground,
                                           std::optional<double> over, std::vector<Mould>& all) {
  const auto near = laying_of(spec, ground, over, false);
  if (auto issues = check_sizes(spec, near, ground.kerf); !issues.empty())
    return tl::unexpected(Error{std::move(issues)});
  TRY(const auto chain, chain_of(spec));
  if (auto issues = check_open(chain, near); !issues.empty())
    return tl::unexpected(Error{std::move(issues)});
  std::vector<std::size_t> out;
  for (const bool far : {false, true}) {
    if (far && spec.wall != Wall::through) continue;
    const auto laying = laying_of(spec, ground, over, far);
    if (auto issues = check_straight_tool(laying); !issues.empty())
      return tl::unexpected(Error{std::move(issues)});
    TRY(const auto found, mould_of(spec, chain, laying, ground, all));
    out.push_back(found);
    if (far || !spec.countersink) continue;
    TRY(const auto cone, cone_mould_of(cone_of(spec), near, ground, all));
    out.push_back(cone);
  }
  return out;
}

/// The same of each of a pattern: on a section, those that leave their flat have moulds of their
/// own anchor.
using MouldsOfStep = std::vector<std::size_t>;
Result<std::vector<MouldsOfStep>> moulds_of_steps(const Spec& spec, const Ground& ground,
                                                  const std::vector<Step>& all,
                                                  std::vector<Mould>& moulds) {
  std::map<std::optional<double>, MouldsOfStep> known;
  const auto chain = chain_of(spec);
  std::vector<MouldsOfStep> out;
  for (const auto& step : all) {
    const auto over =
        ground.section && chain ? over_corner(*ground.section, spec, step, *chain) : std::nullopt;
    auto found = known.find(over);
    if (found == known.end()) {
      TRY(auto made, moulds_of(spec, ground, over, moulds));
      found = known.emplace(over, std::move(made)).first;
    }
    out.push_back(found->second);
  }
  return out;
}

void add_instances(const Spec& spec, const Ground& ground, std::size_t asked,
                   const std::vector<Step>& steps, const std::vector<MouldsOfStep>& moulds,
                   Layout& out) {
  const double z = height_of(spec.at, ground), phi = spec.at.phi + (spec.at.opposite ? kPi : 0.0);
  for (std::size_t i = 0; i < steps.size(); ++i)
    for (const auto mould : moulds[i]) {
      const double here = math::whole_turn(phi + steps[i].turn);
      Instance one{.asked = asked,
                   .name = spec.id + steps[i].suffix,
                   .mould = mould,
                   .phi = here,
                   .phi_inner = here,
                   .z = z + steps[i].along,
                   .sunk = spec.countersink && mould == moulds[i].front()};
      const auto& laying = out.moulds[mould].laying;
      if (laying.over() != nullptr)
        put_over_corner(*ground.section, *laying.over(), laying.far(), one);
      else if (ground.section)
        put_on_face(*ground.section, spec.at, steps[i], laying.far(), one);
      out.instances.push_back(std::move(one));
    }
}

/// If a file states the contour, the request has no piece to point at: points at the text, and
/// states where the piece ends in the drawing.
void point_at_file(const Spec& spec, std::vector<Issue>& issues) {
  constexpr std::string_view kPieces = "shape/pieces/";
  const auto* contour = std::get_if<Contour>(&spec.shape);
  if (contour == nullptr || !contour->of_file) return;
  for (auto& issue : issues) {
    if (!issue.member.starts_with(kPieces)) continue;
    const auto index = std::strtoul(issue.member.c_str() + kPieces.size(), nullptr, 10);
    const auto& end = contour->pieces[std::min<std::size_t>(index, contour->pieces.size() - 1)].to;
    issue.member = "shape/dxf";
    issue.hint += " (the piece of the drawing that ends at " + brief(end.x()) + ", " +
                  brief(end.y()) + " mm)";
  }
}

Issue too_many(std::size_t asked, std::size_t many, std::size_t count) {
  return {.code = ErrorCode::out_of_range,
          .member = many > 1 ? path_of(asked) + "/pattern" : path_of(asked),
          .got = static_cast<double>(count),
          .limit = static_cast<double>(kMostCutouts),
          .hint = "a part has no more cut-outs"};
}

}  // namespace

double height_of(const Anchor& at, const Ground& ground) {
  const bool tip = at.zero == Anchor::Zero::long_point;
  if (at.from == Anchor::From::finish)
    return (tip ? ground.finish_long : ground.finish_work) - at.z;
  return (tip ? ground.start_long : ground.start_work) + at.z;
}

std::string path_of(std::size_t asked) { return "cutouts/" + std::to_string(asked); }

Lay lay_of(Wall wall, bevel::Tilt tilt) {
  if (wall == Wall::developed) return Lay::developed;
  return tilt == bevel::Tilt::free ? Lay::prism : Lay::bored;
}

Result<Chain> chain_of(const Spec& spec) {
  TRY(auto chain, std::visit(Chains{}, spec.shape));
  return turned(std::move(chain), spec.turn);
}

std::optional<double> least_size(const Shape& shape) { return std::visit(LeastSize{}, shape); }

Result<Layout> lay(const std::vector<Spec>& specs, const Ground& ground) {
  Layout out;
  std::vector<Issue> issues;
  std::size_t count = 0, total = 0;
  const auto refuse = [&](std::size_t asked, Error error) {
    point_at_file(specs[asked], error.issues);
    for (auto& issue : under(path_of(asked), std::move(error)).issues)
      issues.push_back(std::move(issue));
  };
  for (std::size_t k = 0; k < specs.size(); ++k) {
    const auto& spec = specs[k];
    const auto many = count_of(spec.pattern);
    if (count + many > kMostCutouts) {
      issues.push_back(too_many(k, many, count + many));
      continue;
    }
    count += many;
    auto all = steps(spec.pattern);
    auto moulds = moulds_of_steps(spec, ground, all ? *all : std::vector<Step>{Step{}}, out.moulds);
    if (!moulds) refuse(k, moulds.error());
    if (!all) refuse(k, all.error());
    if (!moulds || !all) continue;
    const auto first = out.instances.size();
    add_instances(spec, ground, k, *all, *moulds, out);
    for (auto i = first; i < out.instances.size(); ++i)
      total += out.mould_of(out.instances[i]).rows.phi.size();
    if (ground.section)
      if (auto issue = beyond_flat(spec, out, first, *ground.section)) refuse(k, {*issue});
    if (total > kMostRows) {
      refuse(k, {{.code = ErrorCode::out_of_range,
                  .got = static_cast<double>(total),
                  .limit = static_cast<double>(kMostRows),
                  .hint = "the cut-outs have too many points; use a coarser sampling"}});
      break;
    }
  }
  if (!issues.empty()) return tl::unexpected(Error{std::move(issues)});
  return out;
}

std::vector<Warning> cone_warnings(const Layout& layout, double kerf) {
  std::vector<Warning> out;
  std::set<std::size_t> seen;
  for (const auto& one : layout.instances) {
    const auto& mould = layout.mould_of(one);
    if (!mould.cone || !seen.insert(one.asked).second) continue;
    const auto& cone = *mould.cone;
    const auto member = path_of(one.asked) + "/countersink";
    if (is_spent_on_wall(mould.laying, cone, kerf))
      out.push_back({.code = WarningCode::spent_beam,
                     .member = member,
                     .detail = "it leaves the cone at " + brief(cone.half * kDegPerRad) +
                               " deg to the axis, across the hole"});
    if (is_open(mould.laying, cone))
      out.push_back({.code = WarningCode::countersink_open,
                     .member = member,
                     .detail = "there it is " +
                               brief(2.0 * cone_radius(mould.laying, cone, 0.5 * kPi, true)) +
                               " mm wide, and the hole " + brief(cone.hole)});
  }
  return out;
}

std::string title_of(const Layout& layout, const Instance& one) {
  const auto& mould = layout.mould_of(one);
  return one.name + (mould.cone ? " countersink" : mould.laying.far() ? " far" : "");
}

bevel::Hole placed(const Layout& layout, const Instance& one) {
  auto out = layout.mould_of(one).rows;
  for (auto* column : {&out.phi, &out.torch_phi})
    for (double& phi : *column) phi += one.phi;
  for (auto* column : {&out.phi_inner, &out.torch_phi_inner})
    for (double& phi : *column) phi += one.phi_inner;
  for (auto* column : {&out.z, &out.z_inner, &out.torch_z, &out.torch_z_inner})
    for (double& z : *column) z += one.z;
  return out;
}

}  // namespace tubecut::cutout
