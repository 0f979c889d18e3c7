#include "core/plate/plate.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/base/try.hpp"
#include "core/plate/web.hpp"

namespace tubecut::plate {
namespace {

using cutout::Chain;
using cutout::Flat;
using Eigen::Vector3d;

constexpr double kAlike = 1e-9;    // sine of the angle between up and the normal
constexpr double kWritten = 1e-6;  // mm: of a check by points
constexpr int kDepths = 9, kShares = 24;

std::string at_cutout(std::size_t i) { return "cutouts/" + std::to_string(i); }

void too_large(double got, double most, const char* field, const char* hint,
               std::vector<Issue>& out) {
  if (got <= most) return;
  out.push_back({.code = ErrorCode::out_of_range,
                 .member = field,
                 .got = got,
                 .limit = most,
                 .unit = "mm",
                 .hint = hint});
}

/// The shape's chain about its anchor, or what is wrong with it, by its own fields.
struct Drawn {
  Result<Chain> operator()(const cutout::Circle& c) const { return cutout::circle(c.diameter); }
  Result<Chain> operator()(const cutout::Slot& s) const {
    std::vector<Issue> issues;
    too_large(s.width, s.length, "width", "at most the length over all", issues);
    TRY(no_issues(std::move(issues)));
    return cutout::slot(s.length, s.width);
  }
  Result<Chain> operator()(const cutout::Rectangle& r) const {
    std::vector<Issue> issues;
    too_large(r.radius, 0.5 * std::min(r.along, r.round), "corner_radius",
              "at most half of the shorter side", issues);
    TRY(no_issues(std::move(issues)));
    return cutout::rectangle(r.along, r.round, r.radius);
  }
  Result<Chain> operator()(const cutout::Contour& c) const {
    auto out = cutout::drawn(c.start, c.pieces, c.mirrored);
    if (!out && c.of_file)
      for (auto& issue : out.error().issues) issue.member = "dxf";  // it has no pieces to name
    return out;
  }
  Result<Chain> operator()(const cutout::Slit& /*slit*/) const {
    return fail({.code = ErrorCode::unsupported_combination, .hint = "a plate has no slits"});
  }
};

struct Places {
  const Flat& at;

  std::vector<Flat> operator()(const Once& /*once*/) const { return {at}; }
  std::vector<Flat> operator()(const Grid& g) const {
    std::vector<Flat> out;
    for (int row = 0; row < g.rows; ++row)
      for (int column = 0; column < g.columns; ++column)
        out.emplace_back(at + Flat(column * g.column_pitch, row * g.row_pitch));
    return out;
  }
  std::vector<Flat> operator()(const Ring& r) const {
    std::vector<Flat> out;
    for (int i = 0; i < r.count; ++i) {
      const auto [sin, cos] = elementary::sincos(r.angle + kTwoPi * i / r.count);
      out.emplace_back(at + 0.5 * r.diameter * Flat(cos, sin));
    }
    return out;
  }
};

double count_of(const Pattern& pattern) {
  if (const auto* grid = std::get_if<Grid>(&pattern))
    return static_cast<double>(grid->columns) * grid->rows;
  const auto* ring = std::get_if<Ring>(&pattern);
  return ring == nullptr ? 1.0 : ring->count;
}

void add_issues(Error error, std::vector<Issue>& out) {
  for (auto& issue : error.issues) out.push_back(std::move(issue));
}

/// Adds the holes of one opening.
void add_opening(const PlateSpec& spec, std::size_t index, Plate& out, std::vector<Issue>& issues) {
  const auto& one = spec.openings[index];
  auto chain = under(at_cutout(index) + "/shape", std::visit(Drawn{}, one.shape));
  if (!chain) return add_issues(std::move(chain).error(), issues);
  const auto turned = cutout::turned(*std::move(chain), one.turn);
  const auto places = std::visit(Places{one.at}, one.pattern);
  const auto* circle = std::get_if<cutout::Circle>(&one.shape);
  for (std::size_t i = 0; i < places.size(); ++i)
    out.holes.push_back(
        {.name = places.size() == 1 ? one.id : one.id + "." + std::to_string(i + 1),
         .at = at_cutout(index),
         .chain = moved(turned, places[i]),
         .diameter = circle == nullptr ? std::optional<double>() : std::optional(circle->diameter),
         .centre = places[i]});
}

Result<void> add_holes(const PlateSpec& spec, const std::vector<Passing>& passing, Plate& out) {
  double count = static_cast<double>(passing.size());
  for (const auto& one : spec.openings) count += count_of(one.pattern);
  if (count > static_cast<double>(kMostOpenings))
    return fail({.code = ErrorCode::wrong_count,
                 .member = "cutouts",
                 .got = count,
                 .limit = static_cast<double>(kMostOpenings),
                 .hint = "openings of one plate, all of its patterns counted"});
  std::vector<Issue> issues;
  for (std::size_t i = 0; i < spec.openings.size(); ++i) add_opening(spec, i, out, issues);
  for (std::size_t i = 0; i < passing.size(); ++i) {
    auto hole = under(passing[i].at, hole_of(passing[i].passage, out.frame));
    if (!hole) {
      add_issues(std::move(hole).error(), issues);
      continue;
    }
    out.holes.push_back({.name = passing[i].name,
                         .at = passing[i].at,
                         .chain = std::move(hole->chain),
                         .diameter = hole->diameter,
                         .centre = hole->centre,
                         .passing = i,
                         .greatest_gap = hole->greatest_gap});
  }
  return no_issues(std::move(issues));
}

/// Keeps the least web, and finds the openings that leave none.
class Webs {
 public:
  Webs(const PlateSpec& spec, Plate& plate) : spec_(spec), plate_(plate) {}

  void see_outline(const Hole& hole) {
    const double web = gap(hole.chain, plate_.outline);
    if (web == 0.0 || !encloses(plate_.outline, hole.chain.front().from))
      return add(ErrorCode::cutout_off_part, hole,
                 "opening " + hole.name + " does not lie within the outline");
    keep({web, hole.name}, hole, "the outline");
  }

  void see(const Hole& a, const cutout::Bounds& box_a, const Hole& b, const cutout::Bounds& box_b) {
    const double seen = plate_.web ? plate_.web->width : std::numeric_limits<double>::infinity();
    if (box_gap(box_a, box_b) > std::max(seen, spec_.least_web)) return;
    const double web = gap(a.chain, b.chain);
    if (web == 0.0 || encloses(a.chain, b.chain.front().from) ||
        encloses(b.chain, a.chain.front().from))
      return add(ErrorCode::cutouts_cross, b, "openings " + a.name + " and " + b.name);
    keep({web, a.name, b.name}, b, "opening " + a.name);
  }

  [[nodiscard]] std::vector<Issue> take() { return std::move(issues_); }

 private:
  void add(ErrorCode code, const Hole& hole, std::string hint) {
    issues_.push_back({.code = code, .member = hole.at, .hint = std::move(hint)});
  }
  void keep(Web web, const Hole& hole, const std::string& other) {
    if (web.width < spec_.least_web)
      issues_.push_back({.code = ErrorCode::out_of_range,
                         .member = hole.at,
                         .got = web.width,
                         .limit = spec_.least_web,
                         .unit = "mm",
                         .hint = "web between opening " + hole.name + " and " + other});
    if (!plate_.web || web.width < plate_.web->width) plate_.web = std::move(web);
  }

  const PlateSpec& spec_;
  Plate& plate_;
  std::vector<Issue> issues_;
};

/// Finds the least web. Openings further from each other than it are not compared, unless the
/// request states a larger one.
Result<void> add_webs(const PlateSpec& spec, Plate& plate) {
  Webs webs(spec, plate);
  std::vector<cutout::Bounds> boxes;
  for (const auto& hole : plate.holes) {
    webs.see_outline(hole);
    boxes.push_back(cutout::bounds(hole.chain));
  }
  for (std::size_t i = 0; i < plate.holes.size(); ++i) {
    if (stopped()) return fail({.code = ErrorCode::cancelled});
    for (std::size_t k = 0; k < i; ++k)
      webs.see(plate.holes[k], boxes[k], plate.holes[i], boxes[i]);
  }
  return no_issues(webs.take());
}

/// Places along all edges of a chain.
std::vector<Flat> places(const Chain& chain) {
  std::vector<Flat> out;
  for (const auto& s : chain)
    for (int k = 0; k < kShares; ++k) out.push_back(s.at(static_cast<double>(k) / kShares));
  return out;
}

/// By how much the hole's wall is nearer to the tube than the gap, over depths and places.
double too_near(const Passage& passage, const Hole& hole, const joint::MemberFrame& frame) {
  double out = -std::numeric_limits<double>::infinity();
  for (const auto& p : places(hole.chain))
    for (int k = 0; k < kDepths; ++k) {
      const double z =
          passage.from + (passage.to - passage.from) * static_cast<double>(k) / (kDepths - 1);
      const Vector3d local(p.x(), p.y(), z);
      const Vector3d world = frame.origin + frame.rows.transpose() * local;
      worsen(out, passage.gap - off_tube(passage.tube, world));
    }
  return out;
}

/// By how much points of the edges are nearer to each other than the web.
double thinner(const Plate& plate) {
  if (!plate.web) return 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& hole : plate.holes)
    for (const auto& p : places(hole.chain))
      least = std::min(least, cutout::distance(plate.outline, p));
  return plate.web->width - least;
}

}  // namespace

Result<joint::MemberFrame> frame_of(const PlateSpec& spec) {
  for (const auto& [field, v] : {std::pair{"normal", &spec.normal}, {"up", &spec.up}})
    if (!(v->norm() > 0.0))
      return fail({.code = ErrorCode::zero_length,
                   .member = field,
                   .got = 0.0,
                   .limit = 0.0,
                   .hint = "the vector's length must be greater than the limit"});
  const Vector3d n = spec.normal.normalized(), up = spec.up.normalized();
  const Vector3d y = up - up.dot(n) * n;
  if (!(y.norm() > kAlike))
    return fail({.code = ErrorCode::bad_reference_direction,
                 .member = "up",
                 .hint = "it is parallel to the plate's normal"});
  joint::MemberFrame out{.origin = spec.point};
  out.rows.row(0) = y.normalized().cross(n);
  out.rows.row(1) = y.normalized();
  out.rows.row(2) = n;
  return out;
}

Result<Plate> make(const PlateSpec& spec, const std::vector<Passing>& passing) {
  Plate out;
  TRY(out.frame, frame_of(spec));
  TRY(out.outline, under("outline", std::visit(Drawn{}, spec.outline)));
  TRY(add_holes(spec, passing, out));
  TRY(add_webs(spec, out));
  out.area = cutout::area(out.outline);
  for (const auto& hole : out.holes) out.area -= cutout::area(hole.chain);
  out.volume = out.area * spec.thickness;
  return out;
}

std::vector<Check> verify(const PlateSpec& /*spec*/, const std::vector<Passing>& passing,
                          const Plate& plate) {
  double near = -kWritten, web = -kWritten;
  for (const auto& hole : plate.holes)
    if (hole.passing) worsen(near, too_near(passing[*hole.passing].passage, hole, plate.frame));
  worsen(web, thinner(plate));
  return {{"plate_clear", near, kWritten, "mm"}, {"plate_web", web, kWritten, "mm"}};
}

}  // namespace tubecut::plate
