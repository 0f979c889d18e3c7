#include "core/torch/marks.hpp"

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

#include "core/motion/path/upright.hpp"

namespace tubecut::torch {
namespace {

/// A point on the outer wall, rad and mm.
struct MarkPoint {
  double phi = 0.0, z = 0.0;
};

/// Returns true if all points of a path lie on one flat of its section.
bool is_on_flat(const motion::CutPath& path) {
  if (!path.section) return false;
  const auto outer = path.section->outer();
  const auto s = [&](double phi) { return path.outer_radius * phi; };
  const auto middle = outer.at(s(path.phi.front()));
  if (middle.on_corner) return false;
  const double half = outer.half_flat(middle.face);
  return std::ranges::all_of(path.phi, [&](double phi) {
    const double along = middle.along + s(phi) - s(path.phi.front());
    return along >= -half && along <= half;
  });
}

/// Draws strokes on the outside of one tube.
class MarkStrokes {
 public:
  /// `tube`: a path on its outside, without points.
  explicit MarkStrokes(motion::CutPath tube) : tube_(std::move(tube)) { tube_.closed = false; }

  /// Adds a straight stroke from one point to the other, through their middle.
  void add(std::string name, MarkPoint from, MarkPoint to) {
    add(std::move(name), std::vector<MarkPoint>{from, middle(from, to), to});
  }

  void add(std::string name, const std::vector<MarkPoint>& points, bool sharp = false) {
    TorchCut out{.name = std::move(name), .path = tube_, .mark = true};
    for (const auto& p : points) {
      out.path.phi.push_back(p.phi);
      out.path.z.push_back(p.z);
      out.path.b.push_back(0.0);
    }
    // Letters turn sharply; no curve goes through their points.
    if (sharp) out.path.corner = std::vector<bool>(points.size(), true);
    out.on_flat = is_on_flat(out.path);
    if (out.on_flat) out.path.still = motion::normal_of_first(out.path);
    all_.push_back(std::move(out));
  }

  /// Adds the strokes of a text; one of two points goes through their middle.
  void add(const cutout::Lettering& text) {
    for (std::size_t i = 0; i < text.strokes.size(); ++i) {
      std::vector<MarkPoint> points;
      for (const auto& p : text.strokes[i]) points.push_back({p.y() / tube_.outer_radius, p.x()});
      const bool straight = points.size() == 2;
      if (straight) points.insert(points.begin() + 1, middle(points[0], points[1]));
      add(stroke_name(text, i), points, !straight);
    }
  }

  template <class Mark>
  void add_line_or_cross(const std::string& name, const Mark& mark, double phi) {
    if (mark.z_to > mark.z_from) return add(name, {phi, mark.z_from}, {phi, mark.z_to});
    const double round = kCrossArm / tube_.outer_radius;
    add(name + ", along", {phi, mark.z_from - kCrossArm}, {phi, mark.z_from + kCrossArm});
    add(name + ", round", {phi - round, mark.z_from}, {phi + round, mark.z_from});
  }

  /// Returns them with the cuts after them.
  [[nodiscard]] std::vector<TorchCut> before(std::vector<TorchCut> cuts) && {
    std::ranges::move(cuts, std::back_inserter(all_));
    return std::move(all_);
  }

 private:
  static MarkPoint middle(MarkPoint from, MarkPoint to) {
    return {0.5 * (from.phi + to.phi), 0.5 * (from.z + to.z)};
  }

  motion::CutPath tube_;
  std::vector<TorchCut> all_;
};

/// `phi_of`: of a mark on this part.
template <class Part, class Phi>
std::vector<TorchCut> marked(motion::CutPath tube, const Part& part, const Phi& phi_of,
                             std::vector<TorchCut> cuts) {
  using Kind = part::Mark::Kind;
  MarkStrokes out(std::move(tube));
  for (const auto& step : part.sequence) {
    if (step.what != part::Step::What::mark) continue;
    const auto& mark = part.marks[step.index];
    if (mark.kind == Kind::part_mark) continue;
    if (mark.lettering)
      out.add(*mark.lettering);
    else
      out.add_line_or_cross(mark.kind == Kind::datum_line ? std::string("mark of the datum line")
                                                          : "mark of partner " + mark.text,
                            mark, phi_of(mark));
  }
  return std::move(out).before(std::move(cuts));
}

}  // namespace

std::string stroke_name(const cutout::Lettering& text, std::size_t stroke) {
  return "mark of text " + text.spec.id + ", stroke " + std::to_string(stroke + 1);
}

std::vector<TorchCut> with_marks(const part::PartSpec& spec, const part::Part& part,
                                 std::vector<TorchCut> cuts) {
  const motion::CutPath tube{.outer_radius = spec.target.outer_radius, .wall = spec.target.wall};
  return marked(
      tube, part, [](const part::Mark& mark) { return mark.phi; }, std::move(cuts));
}

std::vector<TorchCut> with_marks(const part::SectionPartSpec& spec, const part::SectionPart& part,
                                 std::vector<TorchCut> cuts) {
  const auto tube = motion::around(spec.section);
  return marked(
      tube, part, [&](const part::SectionMark& mark) { return mark.s / tube.outer_radius; },
      std::move(cuts));
}

}  // namespace tubecut::torch
