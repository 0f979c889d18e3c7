#include "core/part/cutout_webs.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "core/base/try.hpp"
#include "core/cutout/rows.hpp"
#include "core/math/rotation.hpp"
#include "core/part/net_section.hpp"
#include "core/part/wall_line.hpp"

namespace tubecut::part {
namespace {

using cutout::Instance;

constexpr double kFine = 1e-3;       // mm, of a chord off its edge
constexpr double kNoWeb = 0.01;      // mm: no kerf leaves a web so thin
constexpr double kSamePlace = 1e-9;  // mm, between differences of anchors that count as one

/// One opening on one developed wall: a line that others may share, and where it lies.
struct Opening {
  std::size_t line = 0;
  WallPoint at = WallPoint::Zero();
  std::size_t index = 0;  // of the instances, or of the holes
  bool hole = false;
  double z_from = 0.0, z_to = 0.0;
};

/// One of the two walls, developed, with all its openings in the order of their least z.
struct DevelopedWall {
  double radius = 0.0;
  bool outer = false;
  std::vector<WallLine> lines;  // of the moulds, then of the holes
  std::vector<Opening> openings;

  [[nodiscard]] EdgePoint place(const WallPoint& p) const {
    return {math::whole_turn(p.x() / radius), p.y()};
  }
};

WallLine line_of(const bevel::Hole& rows, double radius, bool outer) {
  const auto& phi = outer ? rows.phi : rows.phi_inner;
  const auto& z = outer ? rows.z : rows.z_inner;
  std::vector<WallPoint> out;
  for (std::size_t i = 0; i < phi.size(); ++i) out.emplace_back(radius * phi[i], z[i]);
  return {std::move(out), true};
}

/// The moulds' rows as near to each other as webs are exact.
Result<std::vector<bevel::Hole>> fine_rows(const cutout::Layout& layout) {
  std::vector<bevel::Hole> out;
  for (const auto& mould : layout.moulds) {
    TRY(auto rows, cutout::rows(mould, {.tolerance = kFine}));
    out.push_back(std::move(rows));
  }
  return out;
}

/// One wall of a part, with the edges that end it.
struct PartWall {
  double radius = 0.0;  // of a section, that of the circle of its girth
  bool outer = false;
  Edge start, finish;
};

/// What the openings of a round part and of another have in common.
struct WallsOfPart {
  const CutoutSpecs& specs;
  const cutout::Layout& layout;
  std::vector<const bevel::Hole*> holes;
  std::vector<std::string> hole_names;
  std::array<PartWall, 2> walls;
  double gross = 0.0;  // mm^2, of the tube's section
};

DevelopedWall developed(const WallsOfPart& part, const PartWall& wall,
                        const std::vector<bevel::Hole>& moulds) {
  DevelopedWall out{.radius = wall.radius, .outer = wall.outer, .lines = {}, .openings = {}};
  for (const auto& rows : moulds) out.lines.push_back(line_of(rows, out.radius, out.outer));
  for (const auto* hole : part.holes) out.lines.push_back(line_of(*hole, out.radius, out.outer));
  const auto add = [&](Opening one) {
    const auto& box = out.lines[one.line].box();
    one.z_from = one.at.y() + box.least.y();
    one.z_to = one.at.y() + box.most.y();
    out.openings.push_back(one);
  };
  const auto& all = part.layout.instances;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].sunk) continue;  // its cone has its edges
    const double phi = out.outer ? all[i].phi : all[i].phi_inner;
    add({.line = all[i].mould, .at = {out.radius * phi, all[i].z}, .index = i});
  }
  for (std::size_t i = 0; i < part.holes.size(); ++i)
    add({.line = moulds.size() + i, .index = i, .hole = true});
  std::ranges::stable_sort(out.openings, {}, &Opening::z_from);
  return out;
}

/// An end's edge on one wall, once round and as far again to both sides.
struct EndLine {
  Edge edge;
  WallLine line;
  double lowest, highest;
  bool finish;
};

EndLine end_line(const Edge& edge, const DevelopedWall& wall, bool finish) {
  std::vector<WallPoint> points;
  for (const double turn : {-kTwoPi, 0.0, kTwoPi})
    for (std::size_t i = 0; i < edge.z.size(); ++i)
      points.emplace_back(wall.radius * (edge.phi[i] + turn), edge.z[i]);
  const double low = edge.lowest(), high = edge.highest();
  return {edge, WallLine(std::move(points), false), low, high, finish};
}

class CutoutSearch {
 public:
  explicit CutoutSearch(const WallsOfPart& part) : part_(part) {}

  void on(const DevelopedWall& wall, const PartWall& ends) {
    between(wall);
    const auto start = end_line(ends.start, wall, false),
               finish = end_line(ends.finish, wall, true);
    to_end(wall, start, finish);
    to_end(wall, finish, start);
    to_seam(wall);
  }
  Result<CutoutReport> finished() {
    std::vector<Issue> issues;
    for (const auto& [asked, beyond] : off_) issues.push_back(off_part(asked, beyond));
    for (const auto& [asked, pair] : crossing_)
      if (!off_.contains(asked)) issues.push_back(crossing(asked, pair));
    if (!issues.empty()) return tl::unexpected(Error{std::move(issues)});
    out_.net = least_section(part_.gross, part_.layout);
    return out_;
  }

 private:
  /// How far the first of a spec's cut-outs reaches beyond a cut, the one furthest in its order.
  struct Beyond {
    std::size_t instance = 0;
    double by = 0.0;  // mm
    bool finish = false;
    double room = 0.0;  // to the opposite end's cut, mm
  };
  struct Pair {
    std::size_t instance = 0;
    Opening other;
  };
  using Difference = std::tuple<std::size_t, std::size_t, long long, long long>;

  [[nodiscard]] const Instance& instance(std::size_t i) const { return part_.layout.instances[i]; }

  void keep(const WallWay& way, const DevelopedWall& wall, CutoutWeb web,
            std::optional<CutoutWeb>& best) const {
    if (best && best->width <= way.length) return;
    web.width = way.length;
    web.radius = wall.radius;
    web.from = wall.place(way.from);
    web.to = wall.place(way.to);
    best = web;
  }

  void between(const DevelopedWall& wall) {
    known_.clear();
    const auto& all = wall.openings;
    double tallest = 0.0;
    for (const auto& one : all) tallest = std::max(tallest, one.z_to - one.z_from);
    for (std::size_t i = 0; i < all.size(); ++i)
      for (std::size_t j = i + 1; j < all.size(); ++j) {
        const double best = out_.between ? out_.between->width : kFar;
        if (all[j].z_from - all[i].z_to > best) {
          if (all[j].z_from - all[i].z_from - tallest > best) break;
          continue;
        }
        if (!all[i].hole || !all[j].hole) see(wall, all[i], all[j]);
      }
  }

  void see(const DevelopedWall& wall, const Opening& a, const Opening& b) {
    const double girth = kTwoPi * wall.radius;
    for (int turn = -2; turn <= 2; ++turn) {
      const double best = out_.between ? out_.between->width : kFar;
      const WallPoint shift = b.at - a.at + WallPoint(turn * girth, 0.0);
      if (wall.lines[a.line].box().apart(wall.lines[b.line].box(), shift) > best) continue;
      auto way = way_between(wall, a, b, shift);
      if (way.length <= kNoWeb) note_crossing(a, b);
      way.from += a.at;
      way.to += a.at;
      const bool first = !a.hole && (b.hole || a.index <= b.index);
      const auto& one = first ? a : b;
      const auto& other = first ? b : a;
      if (!first) std::swap(way.from, way.to);
      keep(way, wall,
           {.cutout = one.index,
            .beside = other.hole ? CutoutWeb::Beside::hole : CutoutWeb::Beside::cutout,
            .other = other.index},
           out_.between);
    }
  }

  /// From one line to another as it lies from it; pairs that lie alike have one way.
  WallWay way_between(const DevelopedWall& wall, const Opening& a, const Opening& b,
                      const WallPoint& shift) {
    const Difference key{a.line, b.line, std::llround(shift.x() / kSamePlace),
                         std::llround(shift.y() / kSamePlace)};
    if (const auto found = known_.find(key); found != known_.end()) return found->second;
    const auto &one = wall.lines[a.line], &other = wall.lines[b.line];
    WallWay way;
    if (nested(one, other, shift))
      way = {0.0, one.points().front(), one.points().front()};
    else
      one.shorten(other, shift, way);
    known_.emplace(key, way);
    return way;
  }

  void note_crossing(const Opening& a, const Opening& b) {
    const bool later = b.hole || (!a.hole && a.index > b.index);
    const auto& one = later ? a : b;
    const auto& other = later ? b : a;
    const auto [at, fresh] =
        crossing_.try_emplace(instance(one.index).asked, Pair{one.index, other});
    if (!fresh && one.index < at->second.instance) at->second = {one.index, other};
  }

  void to_end(const DevelopedWall& wall, const EndLine& end, const EndLine& opposite) {
    for (const auto& one : wall.openings) {
      if (one.hole) continue;
      const double free = end.finish ? end.lowest - one.z_to : one.z_from - end.highest;
      const double best = out_.to_end ? out_.to_end->width : kFar;
      if (free > best) continue;
      if (free <= 0.0 && note_beyond(wall, one, end, opposite)) continue;
      WallWay way;
      wall.lines[one.line].shorten(end.line, -one.at, way);
      way.from += one.at;
      way.to += one.at;
      keep(way, wall,
           {.cutout = one.index,
            .beside = end.finish ? CutoutWeb::Beside::finish : CutoutWeb::Beside::start},
           out_.to_end);
    }
  }

  /// Returns how far an opening lies beyond an end's cut, mm; negative if it lies before it.
  static double beyond(const DevelopedWall& wall, const Opening& one, const EndLine& end) {
    double by = -kFar;
    for (const WallPoint& point : wall.lines[one.line].points()) {
      const WallPoint p = point + one.at;
      const auto there = end.edge.at(p.x() / wall.radius);
      by = std::max(by, end.finish ? p.y() - there.low : there.high - p.y());
    }
    return by;
  }

  bool note_beyond(const DevelopedWall& wall, const Opening& one, const EndLine& end,
                   const EndLine& opposite) {
    const double by = beyond(wall, one, end);
    if (by < 0.0) return false;
    const auto asked = instance(one.index).asked;
    const Beyond here{one.index, by, end.finish, -beyond(wall, one, opposite)};
    const auto [at, fresh] = off_.try_emplace(asked, here);
    if (!fresh && (one.index < at->second.instance ||
                   (one.index == at->second.instance && by > at->second.by)))
      at->second = here;
    return true;
  }

  void to_seam(const DevelopedWall& wall) {
    const double girth = kTwoPi * wall.radius;
    for (const auto& one : wall.openings) {
      if (one.hole) continue;
      const auto& box = wall.lines[one.line].box();
      const double least = one.at.x() + box.least.x(), most = one.at.x() + box.most.x();
      const double next = girth * std::ceil(least / girth);
      const double way = next <= most ? 0.0 : std::min(next - most, least - (next - girth));
      if (!out_.to_seam || way < out_.to_seam->girth) out_.to_seam = {way, one.index};
    }
  }

  [[nodiscard]] Issue off_part(std::size_t asked, const Beyond& beyond) const {
    const auto& spec = part_.specs.all[asked];
    const std::string end(joint::end_name(beyond.finish));
    Issue out{.code = ErrorCode::cutout_off_part,
              .member = cutout::path_of(asked),
              .hint = instance(beyond.instance).name +
                      (beyond.by < kFine ? std::string(" touches")
                                         : " reaches " + brief(beyond.by) + " mm beyond") +
                      " the cut at the " + end};
    if (beyond.by + 2.0 * kFine > beyond.room) {
      out.member += "/shape";
      out.hint += ", and " +
                  (beyond.room > 0.0 ? "lies " + brief(beyond.room) + " mm before" : "beyond") +
                  " that at the other end: it does not fit between them";
      return out;
    }
    if (cutout::count_of(spec.pattern) > 1) {
      if (beyond.finish && spec.at.from == cutout::Anchor::From::finish)
        out.hint += "; a pitch counts towards the finish, so from there it is negative";
      out.member += "/pattern";
      out.got = instance(beyond.instance).name;
      return out;
    }
    const bool from_there = (spec.at.from == cutout::Anchor::From::finish) == beyond.finish;
    out.member += "/at/z";
    out.got = spec.at.z;
    out.limit = spec.at.z + (from_there ? 1.0 : -1.0) * (beyond.by + kFine);
    out.unit = "mm";
    return out;
  }

  [[nodiscard]] Issue crossing(std::size_t asked, const Pair& pair) const {
    Issue out{.code = ErrorCode::cutouts_cross, .member = cutout::path_of(asked)};
    const auto& own = instance(pair.instance).name;
    if (pair.other.hole) {
      out.hint = own + " meets " + part_.hole_names[pair.other.index];
      return out;
    }
    const auto& other = instance(pair.other.index);
    if (other.asked == asked) out.member += own == other.name ? "/shape" : "/pattern";
    out.hint = own == other.name ? own + " meets its own far side" : own + " meets " + other.name;
    return out;
  }

  const WallsOfPart& part_;
  CutoutReport out_;
  std::map<Difference, WallWay> known_;
  std::map<std::size_t, Beyond> off_;
  std::map<std::size_t, Pair> crossing_;
};

Result<CutoutReport> search(const WallsOfPart& part) {
  CutoutSearch search(part);
  TRY(const auto moulds, fine_rows(part.layout));
  for (const auto& wall : part.walls) search.on(developed(part, wall, moulds), wall);
  return search.finished();
}

/// The edge of the bore over the share of its own girth.
Edge bore_edge(const section::Wall& wall, const bevel::SectionTable& t) {
  Edge out{.phi = {}, .z = t.z_inner};
  for (const auto& at : t.at)
    out.phi.push_back(wall.across(at).bore.s / wall.bore().girth() * kTwoPi);
  // The first row may lie just before the datum, by rounding.
  if (out.phi.size() > 1 && out.phi.front() > out.phi[1]) out.phi.front() -= kTwoPi;
  return out;
}

}  // namespace

std::string name_of(const HoleSpec& hole) {
  return hole.name.empty() ? "holes/" + std::to_string(hole.asked) : "the hole for " + hole.name;
}

Result<CutoutReport> check_cutouts(const PartSpec& spec, const Part& part) {
  const auto wall = [&](bool outer) {
    const auto edge = [&](const bevel::Table& t) {
      return Edge{t.phi, outer ? t.z_outer : t.z_inner};
    };
    return PartWall{outer ? spec.target.outer_radius : spec.target.inner_radius(), outer,
                    edge(part.start.table), edge(part.finish.table)};
  };
  const double outer = spec.target.outer_radius, inner = spec.target.inner_radius();
  WallsOfPart walls{spec.cutouts, part.cutouts, {}, {}, {wall(true), wall(false)}};
  walls.gross = kPi * (outer * outer - inner * inner);
  for (const auto& placed : part.holes) {
    walls.holes.push_back(&placed.hole);
    walls.hole_names.push_back(name_of(spec.holes[placed.asked]));
  }
  return search(walls);
}

Result<CutoutReport> check_cutouts(const SectionPartSpec& spec, const SectionPart& part) {
  const section::Wall wall(spec.section);
  const auto &start = part.start.table, &finish = part.finish.table;
  return search(
      {spec.cutouts,
       part.cutouts,
       {},
       {},
       {PartWall{wall.outer().girth() / kTwoPi, true, edge_over_girth(start, start.z_outer),
                 edge_over_girth(finish, finish.z_outer)},
        PartWall{wall.bore().girth() / kTwoPi, false, bore_edge(wall, start),
                 bore_edge(wall, finish)}},
       section::area(spec.section)});
}

}  // namespace tubecut::part
