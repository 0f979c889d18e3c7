#include "core/part/square_holes.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <set>

#include "core/base/try.hpp"
#include "core/cutout/branch_distance.hpp"
#include "core/math/cylinder.hpp"
#include "core/part/cut_edges.hpp"

namespace tubecut::part {
namespace {

using Eigen::Vector3d;

constexpr double kGap = 1e-3;  // mm
constexpr int kDepths = 9;

/// A place of the finished wall in the start's frame, by its share of the girth, rad.
using Placed = std::function<Vector3d(bool outer, double phi, double z)>;

/// How far the walls are beyond the gaps that were requested and answered, mm.
double off_gap(const CutoutSpecs& specs, const cutout::Layout& layout, const Placed& placed) {
  double worst = 0.0;
  for (const auto& one : specs.holes) {
    const auto& branch = one.hole.branch;
    if (branch.kind == joint::JointKind::set_on) continue;  // it is the branch's bore
    const cutout::BranchDistance distance(branch);
    double least = std::numeric_limits<double>::infinity(), most = 0.0;
    for (const auto& instance : layout.instances) {
      if (instance.asked != one.cutout) continue;
      const auto rows = cutout::placed(layout, instance);
      for (std::size_t i = 0; i < rows.phi.size(); ++i) {
        const Vector3d outer = placed(true, rows.phi[i], rows.z[i]);
        const Vector3d inner = placed(false, rows.phi_inner[i], rows.z_inner[i]);
        for (int k = 0; k < kDepths; ++k) {
          const double share = static_cast<double>(k) / (kDepths - 1);
          const double gap = distance(outer + share * (inner - outer));
          least = std::min(least, gap);
          most = std::max(most, gap);
        }
      }
    }
    worsen(worst, branch.gap - least);
    worsen(worst, most - one.greatest_gap);
  }
  return worst;
}

std::vector<Check> check_of(const CutoutSpecs& specs, const cutout::Layout& layout,
                            const Placed& placed) {
  if (specs.holes.empty()) return {};
  return {{"square_hole_gap", off_gap(specs, layout, placed), kGap, "mm"}};
}

}  // namespace

Result<void> add_square_holes(const std::vector<SquareHole>& holes, const joint::Target& tube,
                              const std::optional<section::Section>& section, Angle zero,
                              CutoutSpecs& out) {
  std::optional<section::Wall> wall;
  if (section) wall.emplace(*section);
  std::set<std::string> known;
  for (const auto& one : out.all) known.insert(one.id);
  std::vector<Issue> issues;
  for (const auto& hole : holes) {
    const std::string name = hole.name.empty() ? "hole" : hole.name;
    auto id = name;
    for (int k = 2; known.contains(id) || known.contains(id + ".far"); ++k)
      id = name + "." + std::to_string(k);
    auto made = under("holes/" + std::to_string(hole.asked) + "/branch",
                      cutout::holes_for(hole.branch, id, tube, wall ? &*wall : nullptr, zero));
    if (!made) {
      for (auto& issue : made.error().issues) issues.push_back(issue);
      continue;
    }
    for (auto& each : *made) {
      known.insert(each.spec.id);
      out.holes.push_back({out.all.size(), hole, each.greatest_gap});
      out.all.push_back(std::move(each.spec));
    }
  }
  if (!issues.empty()) return tl::unexpected(Error{std::move(issues)});
  return {};
}

std::vector<Check> verify_square_holes(const PartSpec& spec, const Part& part) {
  const double work = cutout_ground(spec, part).start_work;
  return check_of(spec.cutouts, part.cutouts, [&](bool outer, double phi, double z) {
    const double radius = outer ? spec.target.outer_radius : spec.target.inner_radius();
    return math::cylinder_point(radius, phi + spec.zero.rad(), z - work);
  });
}

std::vector<Check> verify_square_holes(const SectionPartSpec& spec, const SectionPart& part) {
  const double work = cutout_ground(spec, part).start_work;
  const section::Wall wall(spec.section);
  return check_of(spec.cutouts, part.cutouts, [&](bool outer, double phi, double z) {
    const auto& curve = outer ? wall.outer() : wall.bore();
    const auto p = curve.at(phi / kTwoPi * curve.girth()).point;
    return Vector3d(p.x(), p.y(), z - work);
  });
}

}  // namespace tubecut::part
