#include "core/cutout/rows.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "core/base/elementary.hpp"
#include "core/base/try.hpp"
#include "core/cutout/axis_line.hpp"
#include "core/cutout/cone.hpp"
#include "core/cutout/cutout.hpp"

namespace tubecut::cutout {
namespace {

constexpr double kSmooth = 1e-7;  // rad, between two segments that are one line
constexpr double kLeft = 1e-4;    // mm, of metal in a hollow corner that counts as smooth
constexpr double kBulge = 0.004;  // mm, of a chord of the torch's line into the part
constexpr double kFarTurn = 1e3;  // mm: more than any tolerance
constexpr int kDeepest = 12;      // halvings of a segment
constexpr double kEighth = 0.25 * kPi;
constexpr double kSame = 1e-7;    // mm, between two places of the axis
constexpr double kOnSeam = 1e-6;  // mm

/// The rows of a segment.
struct Run {
  std::vector<AxisRow> rows;
  Flat first_normal, last_normal;
  Flat first_along, last_along;
  bool lost = false;  // the beam does not reach into it
  std::size_t piece = 0;
};

class Maker {
 public:
  Maker(const Laying& laying, const Chain& chain, const Cutting& cutting)
      : laying_(laying),
        chain_(laying.over() != nullptr ? divided(chain, laying.over()->breaks()) : chain),
        cutting_(cutting) {}

  Result<std::vector<AxisRow>> make();

 private:
  [[nodiscard]] Flat plane(const Flat& p) const {
    if (laying_.lay() != Lay::bored) return p;
    return {p.x(), laying_.outer() * laying_.turn(p.y(), laying_.outer())};
  }
  [[nodiscard]] bool over_square() const {
    return laying_.over() != nullptr && !laying_.parallel() && cutting_.kerf > 0.0;
  }
  /// Towards the part, in the plane of the offset; over corners, where the beam touches.
  [[nodiscard]] Flat normal(const Segment& s, double share) const {
    const auto along = s.along(share);
    const auto p = s.at(share);
    if (laying_.over() == nullptr || laying_.parallel())
      return Flat(along.y() * (laying_.parallel() ? 1.0 : laying_.stretch(p.y())), -along.x())
          .normalized();
    const Flat here(p.x(), inside(s, p.y()));
    const Flat m = Flat(along.y() * laying_.stretch(here.y()), -along.x()).normalized();
    return over_square() ? laying_.over()->contact(plane(here).y(), m, cutting_.kerf) : m;
  }
  /// The torch's axis for a place of the edge with such a normal.
  [[nodiscard]] Flat axis(const Flat& edge, const Flat& normal) const {
    const Flat at = plane(edge);
    if (!over_square()) return at + kerf_offset(laying_, cutting_.kerf, normal);
    const double half = 0.5 * cutting_.kerf;
    return {at.x() - half * normal.x(), laying_.over()->axis(at.y(), half * normal.y())};
  }
  [[nodiscard]] Flat on_wall(const Flat& p, double rho) const {
    return {p.x(), rho * laying_.turn(p.y(), rho)};
  }
  /// The least radius of a hollow for the beam along an arc over corners.
  [[nodiscard]] double least_of(const Segment& s) const;
  /// How far the torch's line and the edges, over corners, bend off the straight way.
  [[nodiscard]] double torch_off(const Segment& s, double from, double to) const;
  /// Whether either surface turns by more than 10 deg.
  [[nodiscard]] bool turns_far(const Segment& s, double from, double to) const;
  void halve(const Segment& s, double from, double to, double within, int depth,
             std::vector<double>& out) const;
  [[nodiscard]] std::vector<double> shares(const Segment& s) const;
  [[nodiscard]] Run run(const Segment& s) const;
  [[nodiscard]] bool bends_at_seam(const Run& before, const Run& after) const;
  Result<void> join(Run& before, Run& after) const;
  void round_corner(Run& before, const Run& after) const;

  const Laying& laying_;
  Chain chain_;
  const Cutting& cutting_;
};

double Maker::least_of(const Segment& s) const {
  constexpr int kPlaces = 16;
  double out = 0.0;
  for (int i = 0; i <= kPlaces; ++i) {
    const double b = inside(s, s.at(static_cast<double>(i) / kPlaces).y());
    out = std::max(out, least_radius(laying_, cutting_.kerf, b));
  }
  return out;
}

bool Maker::turns_far(const Segment& s, double from, double to) const {
  constexpr double kMost = 10.0001 * kRadPerDeg;
  const auto a = laying_.over()->at(inside(s, s.at(from).y()));
  const auto b = laying_.over()->at(inside(s, s.at(to).y()));
  return std::abs(std::remainder(b.outer.nu - a.outer.nu, kTwoPi)) > kMost ||
         std::abs(std::remainder(b.bore.nu - a.bore.nu, kTwoPi)) > kMost;
}

double Maker::torch_off(const Segment& s, double from, double to) const {
  double off = 0.0;
  for (const double rho : {laying_.outer(), laying_.inner()}) {
    // A prism's torch runs straight in the local plane, a square one's on the developed outside.
    const auto at = [&](double share) {
      const Flat p = axis(s.at(share), normal(s, share));
      return laying_.parallel() ? on_wall(p, rho) : p;
    };
    const Flat a = at(from), way = at(to) - a;
    const double length = way.norm();
    for (const double part : {0.25, 0.5, 0.75})
      if (length > 0.0)
        off = std::max(off, std::abs(cross(way, at(from + part * (to - from)) - a)) / length);
    if (!laying_.parallel()) break;
  }
  return off;
}

void Maker::halve(const Segment& s, double from, double to, double within, int depth,
                  std::vector<double>& out) const {
  double off = 0.0;
  for (const double rho : {laying_.outer(), laying_.inner()}) {
    const Flat a = on_wall(s.at(from), rho), way = on_wall(s.at(to), rho) - a;
    const double length = way.norm();
    for (const double part : {0.25, 0.5, 0.75}) {
      const Flat p = on_wall(s.at(from + part * (to - from)), rho) - a;
      if (length > 0.0) off = std::max(off, std::abs(cross(way, p)) / length);
    }
  }
  if (laying_.over() != nullptr)
    off = std::max(off, turns_far(s, from, to) ? kFarTurn : torch_off(s, from, to));
  if (off <= within || depth == kDeepest) return out.push_back(to);
  const double middle = 0.5 * (from + to);
  halve(s, from, middle, within, depth + 1, out);
  halve(s, middle, to, within, depth + 1, out);
}

std::vector<double> Maker::shares(const Segment& s) const {
  std::vector<double> out{0.0};
  const int parts =
      s.arc() ? std::max(1, static_cast<int>(std::ceil(std::abs(s.sweep) / kEighth - 1e-9))) : 1;
  const double within =
      s.arc() && s.hollow() ? cutting_.tolerance : std::min(cutting_.tolerance, kBulge);
  for (int i = 0; i < parts; ++i)
    halve(s, static_cast<double>(i) / parts, static_cast<double>(i + 1) / parts, within, 0, out);
  return out;
}

Run Maker::run(const Segment& s) const {
  Run out{.rows = {},
          .first_normal = normal(s, 0.0),
          .last_normal = normal(s, 1.0),
          .first_along = s.along(0.0),
          .last_along = s.along(1.0),
          .piece = s.piece};
  for (const double share : shares(s)) {
    const auto p = s.at(share);
    out.rows.push_back({p, axis(p, normal(s, share))});
  }
  if (!s.arc() || !s.hollow()) return out;
  double most = 0.0;
  for (const auto& row : out.rows) most = std::max(most, std::abs(row.edge.y()));
  const double least =
      laying_.over() != nullptr ? least_of(s) : least_radius(laying_, cutting_.kerf, most);
  out.lost = s.radius < least * (1.0 - 1e-9);
  return out;
}

/// The axis goes round a corner of the part that reaches into the scrap.
void Maker::round_corner(Run& before, const Run& after) const {
  const auto &from = before.last_normal, &to = after.first_normal;
  const double angle = elementary::atan2(cross(from, to), from.dot(to));
  const double step =
      2.0 * elementary::acos(1.0 - std::min(1.0, kBulge / std::max(kBulge, cutting_.kerf)));
  const int parts = std::max(1, static_cast<int>(std::ceil(std::abs(angle) / step)));
  const Flat edge = before.rows.back().edge;
  for (int i = 1; i < parts; ++i) {
    const auto [sin, cos] = elementary::sincos(angle * i / parts);
    const Flat m(cos * from.x() - sin * from.y(), sin * from.x() + cos * from.y());
    before.rows.push_back({edge, axis(edge, m)});
  }
}

/// Returns true if an edge bends only because it crosses a seam: on the bore, or on the outside by
/// so little that the beam leaves no more than the tolerance.
bool Maker::bends_at_seam(const Run& before, const Run& after) const {
  if (laying_.over() == nullptr || laying_.parallel()) return false;
  if (std::abs(cross(before.last_along, after.first_along)) < kSmooth) return true;
  const double b = after.rows.front().edge.y();
  const auto on_seam = [&](double seam) { return std::abs(b - seam) < kOnSeam; };
  const double turn = std::min(1.0, before.last_normal.dot(after.first_normal));
  const double left = 0.5 * cutting_.kerf * (std::sqrt(2.0 / (1.0 + turn)) - 1.0);
  return turn > 0.0 && left <= cutting_.tolerance &&
         std::ranges::any_of(laying_.over()->breaks(), on_seam);
}

/// Two runs that follow each other, without those lost between them.
Result<void> Maker::join(Run& before, Run& after) const {
  const double angle = elementary::atan2(cross(before.last_normal, after.first_normal),
                                         before.last_normal.dot(after.first_normal));
  if (cutting_.kerf == 0.0 || std::abs(angle) < kSmooth) return {};
  if (angle < 0.0) {
    round_corner(before, after);
    return {};
  }
  // Coordinates of a drawing are rounded, so that its tangent pieces meet at a small angle.
  const bool smooth =
      bends_at_seam(before, after) || 0.5 * cutting_.kerf * (1.0 - elementary::cos(angle)) <= kLeft;
  if (!cutting_.as_cut && !smooth)
    return fail({.code = ErrorCode::out_of_range,
                 .member = "pieces/" + std::to_string(before.piece),
                 .got = 0.0,
                 .limit = least_radius(laying_, cutting_.kerf, before.rows.back().edge.y()),
                 .unit = "mm",
                 .hint = "round the corner at its end by an arc of this radius, or accept what the "
                         "beam leaves: corners as_cut"});
  const auto met = crossing(before.rows, after.rows);
  if (!met && (smooth || over_square())) return {};
  if (!met)
    return fail({.code = ErrorCode::out_of_range,
                 .hint = "beside a corner the contour is narrower than the kerf"});
  for (std::size_t i = met->last + 1; i < before.rows.size(); ++i) before.rows[i].torch = met->at;
  for (std::size_t i = 0; i < met->first; ++i) after.rows[i].torch = met->at;
  return {};
}

Result<std::vector<AxisRow>> Maker::make() {
  std::vector<Run> runs;
  std::vector<std::size_t> live;
  for (const auto& s : chain_) {
    runs.push_back(run(s));
    auto& last = runs.back();
    if (last.lost && !cutting_.as_cut)
      return fail(
          {.code = ErrorCode::out_of_range,
           .member = "pieces/" + std::to_string(last.piece),
           .got = s.radius,
           .limit = laying_.over() != nullptr
                        ? least_of(s)
                        : least_radius(laying_, cutting_.kerf,
                                       std::max(std::abs(s.from.y()), std::abs(s.to.y()))),
           .unit = "mm",
           .hint =
               "a hollow tighter than the beam: its least radius is half the kerf, and more where "
               "the wall bends, because the beam, square to it, takes more of the bore; corners "
               "as_cut accepts it"});
    if (!last.lost) live.push_back(runs.size() - 1);
  }
  if (live.empty())
    return fail({.code = ErrorCode::out_of_range, .hint = "it is narrower than the kerf"});
  for (std::size_t i = 0; i < live.size() && runs.size() > 1; ++i)
    TRY(join(runs[live[i]], runs[live[(i + 1) % live.size()]]));
  std::vector<AxisRow> out;
  auto at = runs[live.back()].rows.back().torch;  // the axis waits there where the beam cannot go
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (runs[i].lost)
      for (auto& row : runs[i].rows) row.torch = at;
    else
      at = runs[i].rows.back().torch;
    out.insert(out.end(), runs[i].rows.begin(), runs[i].rows.end() - 1);
    // A corner keeps both its places; where the line goes on, the next run begins with the same.
    const auto& next = runs[(i + 1) % runs.size()];
    if ((runs[i].rows.back().torch - next.rows.front().torch).norm() > kSame && !next.lost)
      out.push_back(runs[i].rows.back());
  }
  if (over_square() && !check_line(out)) turn_in_hollows(cutting_.kerf, out);
  return out;
}

}  // namespace

double least_radius(const Laying& laying, double kerf, double b) {
  if (laying.parallel()) return 0.5 * kerf;
  if (const auto* over = laying.over()) {
    const auto rates = over->rates(b);
    const double ratio = rates.outer / rates.bore;
    return 0.5 * kerf * (laying.lay() == Lay::developed ? ratio * ratio : rates.bore);
  }
  const double ratio = laying.outer() / laying.inner();
  if (laying.lay() == Lay::developed) return 0.5 * kerf * ratio * ratio;
  return 0.5 * kerf * laying.stretch(b) / ratio;
}

Flat kerf_offset(const Laying& laying, double kerf, const Flat& m) {
  const double half = 0.5 * kerf;
  if (laying.parallel() || kerf == 0.0) return -half * m;
  const double outer = laying.outer(), inner = laying.inner(), eps = half / inner;
  const double x = inner * m.x(), y = outer * m.y();
  const double sum = x * x + y * y;  // Q = y^2/x^2, each term times x^2/sum
  const double share = y * y / sum;
  const double root = std::sqrt(std::max(0.0, 1.0 - 4.0 * eps * eps * share * (x * x / sum)));
  const double part = 2.0 * share / (1.0 + root);
  return {-std::copysign(half * std::sqrt(std::max(0.0, 1.0 - part)), m.x()),
          -std::copysign(outer * elementary::asin(eps * std::sqrt(part)), m.y())};
}

Result<bevel::Hole> rows(const Laying& laying, const Chain& chain, const Cutting& cutting) {
  TRY(const auto made, Maker(laying, chain, cutting).make());
  TRY(check_line(made));
  bevel::Hole out{.far = laying.far()};
  const bool prism = laying.lay() == Lay::prism;
  const double outer = laying.outer(), inner = laying.inner();
  for (const auto& [edge, torch] : made) {
    out.phi.push_back(laying.phase(laying.turn(edge.y(), outer)));
    out.phi_inner.push_back(laying.phase(laying.turn(edge.y(), inner)));
    out.z.push_back(edge.x());
    out.a.push_back(laying.lean(torch.y()));
    out.torch_phi.push_back(
        laying.phase(prism ? laying.turn(torch.y(), outer) : torch.y() / outer));
    // The axis of a beam that is square to the wall, or along the prism.
    out.torch_phi_inner.push_back(
        laying.phase(prism ? laying.turn(torch.y(), inner) : laying.square_on_bore(torch.y())));
    out.torch_z.push_back(torch.x());
  }
  out.z_inner = out.z;
  out.torch_z_inner = out.torch_z;
  out.b.assign(out.phi.size(), 0.0);
  measure_edge(outer, out);
  return out;
}

Result<bevel::Hole> slit_rows(const Laying& laying, const Chain& chain, const SlitLine& line,
                              const Cutting& cutting) {
  auto edge_only = cutting;
  edge_only.kerf = 0.0;
  TRY(auto out, rows(laying, chain, edge_only));
  for (std::size_t i = 0; i < out.z.size(); ++i) {
    // The torch's place is the edge's yet, from which its own in the plane follows.
    const double turn = laying.phase(out.torch_phi[i]);
    const double b = laying.outer() * (laying.lay() == Lay::prism ? elementary::sin(turn) : turn);
    const auto at = line.nearest({out.torch_z[i], b});
    const double outer = laying.turn(at.y(), laying.outer());
    out.torch_phi[i] = laying.phase(outer);
    out.torch_phi_inner[i] = laying.phase(laying.turn(at.y(), laying.inner()));
    out.torch_z[i] = out.torch_z_inner[i] = at.x();
    if (laying.lay() == Lay::prism) out.a[i] = laying.far() ? outer : -outer;
  }
  return out;
}

Result<bevel::Hole> rows(const Mould& mould, const Cutting& cutting) {
  if (mould.slit) return slit_rows(mould.laying, mould.chain, mould.slit->line, cutting);
  if (mould.cone) return cone_rows(mould.laying, *mould.cone, cutting);
  return rows(mould.laying, mould.chain, cutting);
}

void measure_edge(double outer, bevel::Hole& rows) {
  rows.length_total = 0.0;
  for (std::size_t i = 0; i < rows.phi.size(); ++i) {
    const auto j = (i + 1) % rows.phi.size();
    rows.developed.push_back(rows.length_total);
    rows.length_total +=
        elementary::hypot(outer * (rows.phi[j] - rows.phi[i]), rows.z[j] - rows.z[i]);
  }
}

}  // namespace tubecut::cutout
