#include "core/torch/stretches.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/base/try.hpp"
#include "core/motion/path/chords.hpp"
#include "core/motion/path/stretch.hpp"

namespace tubecut::torch {
namespace {

constexpr double kStep = 0.05;   // mm, between two gaps in the search
constexpr double kExact = 1e-7;  // mm, accuracy of a gap
constexpr double kMove = 1.0;    // mm, between two tab positions in the search
constexpr double kNear = 4.0;    // widths along a path: points beyond are not next to a tab

constexpr double kWidest =
    8.0;  // of the requested width: beyond it, the lead-in and no bevel is the reason

using Points = std::vector<motion::CutPoint>;

/// Between two lengths along the whole cut, mm.
struct LengthRange {
  double from = 0.0, to = 0.0;
};

/// A path on both walls, the inner first.
using Walls = std::array<motion::Chords, 2>;

Walls on_walls(const motion::PartBorder& border, const Points& way) {
  const auto on = [&](double rho) {
    std::vector<motion::Flat> line(way.size());
    std::ranges::transform(way, line.begin(),
                           [&](const auto& point) { return motion::on_wall(border, point, rho); });
    return motion::Chords(std::move(line));
  };
  return {on(border.inner_radius), on(border.outer_radius)};
}

/// Returns the smallest distance of one path's points to the other path, on the same wall, mm.
double distance(const Walls& from, const Walls& to) {
  double out = 1e300;
  for (std::size_t wall = 0; wall < from.size(); ++wall)
    for (const auto& point : from[wall].points) {
      if (stopped()) return out;  // because an iteration covers all of the other path
      out = motion::nearer(out, point, to[wall]);
    }
  return out;
}

/// The same in both directions.
double apart(const Walls& one, const Walls& other) {
  return std::min(distance(one, other), distance(other, one));
}

/// Returns the length of a path before its cut begins, mm.
double way_in(const TorchWay& way, double radius) {
  const auto& points = way.points.points;
  const auto first = static_cast<std::ptrdiff_t>(way.points.cut_first);
  const motion::Track track{.points = {points.begin(), points.begin() + first + 1},
                            .radius = radius};
  return motion::lengths_along(track).back();
}

Points turned(Points points, double by) {
  for (auto& p : points) p.phi += by;
  return points;
}

/// Returns where tabs end: evenly, moved off corners if there is room; the last before the start.
std::vector<double> tab_ends(const motion::Track& whole, const std::vector<double>& length,
                             int count, double gap) {
  const auto corner = motion::from_corner(whole);
  std::vector<double> corners;
  for (std::size_t i = 0; i < corner.size(); ++i)
    if (corner[i] == 0.0) corners.push_back(length[i]);
  const double each = length.back() / count;
  const auto free = [&](double end) {
    const auto next = std::ranges::upper_bound(corners, end - 2.0 * gap);
    return next == corners.end() || *next >= end + gap;
  };
  std::vector<double> out;
  for (int k = 1; k < count; ++k) {
    double end = each * k;
    for (double off = kMove; !free(end) && off <= each / 4.0; off += kMove)
      for (const double to : {each * k - off, each * k + off})
        if (!free(end) && free(to)) end = to;
    out.push_back(end);
  }
  out.push_back(length.back());
  return out;
}

class TabbedWays {
 public:
  /// `more`: of each tab, mm.
  TabbedWays(motion::Track whole, motion::PartBorder border, const TorchCut& cut, const Tabs& tabs,
             std::vector<double> more)
      : whole_(std::move(whole)),
        length_(motion::lengths_along(whole_)),
        border_(std::move(border)),
        least_(tabs.width + cut.kerf),
        more_(std::move(more)) {
    more_.resize(static_cast<std::size_t>(tabs.count), 0.0);
  }

  /// Halves the lead, down to kShortestLead, until it leaves the tabs that hold the scrap intact,
  /// because in a small hole it reaches far across.
  Result<std::vector<TorchWay>> run(std::optional<motion::Lead> lead, int count) {
    while (true) {
      auto out = ways(lead, count);
      const bool narrow = !out && out.error().issues.front().member == "tabs/width_mm";
      if (!narrow || !lead || lead->radius < 2.0 * kShortestLead) return out;
      lead->radius /= 2.0;
    }
  }

 private:
  Result<std::vector<TorchWay>> ways(const std::optional<motion::Lead>& lead, int count) {
    const double all = length_.back();
    if (2.0 * count * least_ > all)
      return fail({ErrorCode::out_of_range, "tabs/count", static_cast<double>(count),
                   std::floor(all / (2.0 * least_)), "",
                   "tabs and their kerfs take more than half of the cut"});
    const auto ends = tab_ends(whole_, length_, count, least_);
    std::vector<TorchWay> out;
    double from = 0.0;
    for (const double end : ends) {
      TRY(auto way, way_along({from, end - least_}, lead));
      out.push_back(std::move(way));
      from = end;
    }
    for (std::size_t k = 0; k < out.size(); ++k) {
      const double begin = k == 0 ? 0.0 : ends[k - 1];
      const bool last = k + 1 == out.size();
      TRY(const auto gap, gap_before({begin, ends[k]}, least_ + more_[k], out[last ? 0 : k + 1],
                                     last ? kTwoPi * whole_.turns : 0.0));
      end_at({begin, ends[k] - gap}, out[k]);
    }
    return out;
  }

  /// Returns the segment with its lead-in, as long as the scrap permits.
  Result<TorchWay> way_along(const LengthRange& s, const std::optional<motion::Lead>& asked) {
    const auto track = motion::stretch_of(whole_, length_, s.from, s.to);
    if (!asked) return TorchWay{{track.points, 0, track.points.size() - 1, true}, 0.0};
    auto lead = *asked;
    lead.shape = motion::Lead::Shape::square;
    TRY(auto way, way_with_lead(border_, track, lead));
    way.points.stretch = true;
    return way;
  }

  /// Returns how long before its end the tab begins, mm: first from the cut's end only, which is
  /// usually the nearest, then from everything near it. `least`: from axis to axis.
  Result<double> gap_before(const LengthRange& s, double least, const TorchWay& after,
                            double turn) {
    const double along = kNear * least + way_in(after, whole_.radius);
    const auto near =
        on_walls(border_, turned(near_end(after.points.points, whole_.radius, along, false), turn));
    const auto end_is_off = [&](double gap) {
      const auto end = on_walls(border_, {motion::at_length(whole_, length_, s.to - gap)});
      return distance(end, near) >= least;
    };
    const auto all_is_off = [&](double gap) {
      const auto points = motion::stretch_of(whole_, length_, s.from, s.to - gap).points;
      const auto end = near_end(points, whole_.radius, kNear * least, true);
      return apart(on_walls(border_, end), near) >= least - kExact;
    };
    const double most = std::min(kWidest * least, 0.5 * (s.to - s.from));
    double gap = least;
    while (gap <= most && !end_is_off(gap)) gap += kStep;
    if (gap <= most) gap = least_gap(std::max(least, gap - kStep), gap, end_is_off);
    while (gap <= most && !stopped() && !all_is_off(gap)) gap += kStep;
    if (stopped()) return fail({.code = ErrorCode::cancelled});
    if (gap > most)
      return fail({.code = ErrorCode::lead_blocked,
                   .member = "tabs/width_mm",
                   .hint = "no way onto the cut leaves a tab of this width"});
    return gap;
  }

  template <class Enough>
  static double least_gap(double low, double high, const Enough& enough) {
    if (enough(low)) return low;
    while (high - low > kExact) {
      const double middle = 0.5 * (low + high);
      (enough(middle) ? high : low) = middle;
    }
    return high;
  }

  /// Keeps the lead-in and changes the end of the segment.
  void end_at(const LengthRange& s, TorchWay& way) const {
    auto& points = way.points;
    const auto track = motion::stretch_of(whole_, length_, s.from, s.to);
    const bool corner = points.points[points.cut_first].corner;
    points.points.resize(points.cut_first);
    points.points.insert(points.points.end(), track.points.begin(), track.points.end());
    points.points[points.cut_first].corner = corner;
    points.cut_last = points.points.size() - 1;
  }

  motion::Track whole_;
  std::vector<double> length_;  // mm along it, of its points
  motion::PartBorder border_;
  double least_;  // mm, from axis to axis of the torch
  std::vector<double> more_;
};

}  // namespace

bool holds(const Tabs& tabs, const TorchCut& cut, bool last) {
  if (cut.mark || cut.open) return false;
  const bool hole = cut.path.scrap == motion::Scrap::inside;
  switch (tabs.of) {
    case Tabs::Of::last:
      return last;
    case Tabs::Of::ends:
      return !hole;
    case Tabs::Of::holes:
      return hole;
    case Tabs::Of::all:
      return true;
  }
  return false;
}

Result<std::vector<TorchWay>> ways_between_tabs(const TorchCut& cut, const Approach& approach,
                                                const Tabs& tabs, const std::vector<double>& more) {
  const auto path = motion::without_repeats(cut.path);
  TRY(auto whole, motion::track(path));
  TRY(auto from, motion::directed(std::move(whole), motion::Direction::as_given, approach.start));
  TRY(auto border, torch_border(cut));
  return TabbedWays(std::move(from), std::move(border), cut, tabs, more)
      .run(approach.lead, tabs.count);
}

BesideTab beside_tab(const TorchCut& cut, const Tabs& tabs, const TorchWay& before,
                     const TorchWay& after) {
  const double radius = cut.path.radius(), near = kNear * (tabs.width + cut.kerf);
  const auto& ended = before.points.points;
  const auto first = static_cast<std::ptrdiff_t>(before.points.cut_first);
  const motion::Track track{.points = {ended.begin() + first, ended.end()}, .radius = radius};
  return {std::min(near, motion::lengths_along(track).back()), near + way_in(after, radius)};
}

Points near_end(const Points& way, double radius, double length, bool end) {
  Points out;
  double gone = 0.0;
  for (std::size_t k = 0; k < way.size() && gone <= length; ++k) {
    const auto& p = way[end ? way.size() - 1 - k : k];
    if (!out.empty())
      gone += elementary::hypot(radius * (p.phi - out.back().phi), p.z - out.back().z);
    out.push_back(p);
  }
  return out;
}

double metal_between(const motion::PartBorder& border, double kerf, const Points& end,
                     const Points& start) {
  const double turn = kTwoPi * std::floor((end.front().phi - start.front().phi) / kTwoPi + 0.5);
  return apart(on_walls(border, end), on_walls(border, turned(start, turn))) - kerf;
}

double metal_between(const motion::PartBorder& border, const TorchCut& cut, const Tabs& tabs,
                     const TorchWay& before, const TorchWay& after) {
  const auto beside = beside_tab(cut, tabs, before, after);
  const double radius = cut.path.radius();
  return metal_between(border, cut.kerf, near_end(before.points.points, radius, beside.end, true),
                       near_end(after.points.points, radius, beside.start, false));
}

}  // namespace tubecut::torch
