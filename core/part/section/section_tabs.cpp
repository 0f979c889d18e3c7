#include "core/part/section/section_tabs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "core/base/rounding.hpp"
#include "core/base/try.hpp"
#include "core/bevel/section/section_columns.hpp"
#include "core/bevel/section/section_surface.hpp"
#include "core/cutout/flats.hpp"
#include "core/math/mixed.hpp"
#include "core/part/worst_checks.hpp"

namespace tubecut::part {
namespace {

using bevel::SectionTable;
using Eigen::Vector2d;

constexpr double kSameStep = 1e-9;  // mm, between places that are one row
constexpr double kBetween = 0.01;   // mm, that the beams next to two tabs lie apart at least

/// A tab on the developed outside of the end's own frame: from place to place.
struct TabStrip {
  double from = 0.0, width = 0.0, length = 0.0;

  /// How far a place lies behind the strip's begin.
  [[nodiscard]] double off(double s, double girth) const {
    return std::remainder(s - from - 0.5 * width, girth) + 0.5 * width;
  }
};

std::string tab_path(std::size_t i) { return "end_tabs/" + std::to_string(i); }

/// The other end counts places the other way.
TabStrip strip_of(const section::Curve& outer, const EndTab& tab, bool finish) {
  const double girth = outer.girth();
  const double middle = outer.on_face(tab.face, tab.offset);
  const double own = finish ? girth - middle : middle;
  const double from = own - 0.5 * tab.width;
  return {from - girth * std::floor(from / girth), tab.width, tab.length};
}

/// Makes the rows of an end with tabs.
class TabRows {
 public:
  TabRows(const section::Wall& wall, const bevel::TableSpec& spec, std::vector<TabStrip> strips,
          const SectionTable& shoulder)
      : outer_(wall.outer()),
        wall_(wall),
        half_(0.5 * spec.kerf),
        strips_(std::move(strips)),
        in_(shoulder),
        surface_(wall, spec, shoulder) {}

  SectionTable make() {
    out_.inner_events = in_.inner_events;
    out_.outer_events = in_.outer_events;
    out_.girth = in_.girth;
    out_.length_total = in_.length_total;
    out_.developed_total = in_.developed_total;
    out_.mutations = in_.mutations;
    out_.torch_binds = in_.torch_binds;
    out_.multipliers = in_.multipliers;
    out_.penetration = in_.penetration;
    out_.torch_line = in_.torch_line;
    out_.warnings = in_.warnings;
    for (const auto& row : rows()) add(row);
    out_.length_total += added_;
    return std::move(out_);
  }

  /// Returns the first strip on which the cut has a corner, the torch's passage included.
  [[nodiscard]] std::optional<std::size_t> bent() const {
    for (std::size_t k = 0; k < strips_.size(); ++k)
      for (std::size_t i = 0; i < in_.at.size(); ++i) {
        const double off = strips_[k].off(in_.at[i].s, in_.girth);
        if (in_.corner[i] && off >= -half_ && off <= strips_[k].width + half_) return k;
      }
    return std::nullopt;
  }

 private:
  /// A row of the shoulder, or a place between two of its rows.
  struct Source {
    std::size_t row = 0;
    double share = 0.0, s = 0.0;
    bool before_first = false;  // it lies before the first row, in the last gap
  };
  /// The strip that ends at a place, just before it or just after it, or none.
  using Level = std::optional<std::size_t>;

  [[nodiscard]] double turned(double s) const {
    const double out = s - in_.girth * std::floor(s / in_.girth);
    return out < in_.girth ? out : 0.0;
  }

  [[nodiscard]] double height(const std::vector<double>& z, double s) const {
    const auto row = surface_.row_before(turned(s));
    const double wide = surface_.width(row);
    double off = turned(s) - in_.at[row].s;
    if (off < 0.0) off += in_.girth;
    return math::mixed(z[row], z[surface_.next(row)], wide > 0.0 ? off / wide : 0.0);
  }

  [[nodiscard]] std::vector<Source> rows() const {
    std::vector<double> places;
    for (const auto& strip : strips_)
      for (const double at : {strip.from - half_, strip.from, strip.from + strip.width,
                              strip.from + strip.width + half_})
        places.push_back(turned(at));
    std::vector<Source> first, out;
    for (std::size_t i = 0; i < in_.at.size(); ++i) {
      out.push_back({i, 0.0, in_.at[i].s});
      std::vector<Source> within;
      const double wide = surface_.width(i);
      for (const double s : places) {
        double off = s - in_.at[i].s;
        if (off < 0.0) off += in_.girth;
        if (!(off > kSameStep && off < wide - kSameStep)) continue;
        within.push_back({i, off / wide, s, s < in_.at[i].s});
      }
      std::ranges::sort(within, {}, &Source::share);
      for (const auto& one : within) (one.before_first ? first : out).push_back(one);
    }
    const auto same = [](const Source& a, const Source& b) {
      return b.share > 0.0 && a.row == b.row && std::abs(a.s - b.s) <= kSameStep;
    };
    first.insert(first.end(), out.begin(), out.end());
    first.erase(std::unique(first.begin(), first.end(), same), first.end());
    return first;
  }

  [[nodiscard]] Level level(double s, double beside, bool after) const {
    for (std::size_t k = 0; k < strips_.size(); ++k) {
      const double off = strips_[k].off(s, in_.girth), end = strips_[k].width + beside;
      const bool in = after ? off >= -beside - kSameStep && off < end - kSameStep
                            : off > -beside + kSameStep && off <= end + kSameStep;
      if (in) return k;
    }
    return std::nullopt;
  }
  [[nodiscard]] double length(const Level& level) const {
    return level ? strips_[*level].length : 0.0;
  }

  void add(const Source& row) {
    const auto finished = level(row.s, 0.0, false), torch = level(row.s, half_, false);
    const auto finished_on = level(row.s, 0.0, true), torch_on = level(row.s, half_, true);
    const bool steps = torch != torch_on;
    put(row, finished, torch, steps);
    if (finished == finished_on && !steps) return;
    added_ += std::abs(length(finished_on) - length(finished));
    put(row, finished_on, torch_on, steps);
  }

  void put(const Source& row, const Level& finished, const Level& torch, bool steps) {
    const auto i = row.row, j = surface_.next(i);
    const double share = row.share;
    const bool last = j == 0;
    const auto station = [&](const std::vector<double>& column, double total) {
      const double to = column[j] + (last ? total : 0.0);
      const double out = share > 0.0 ? math::mixed(column[i], to, share) : column[i];
      return row.before_first ? out - total : out;
    };
    out_.at.push_back(share > 0.0 ? outer_.at(row.s) : in_.at[i]);
    out_.developed.push_back(station(in_.developed, in_.developed_total));
    out_.length.push_back(station(in_.length, in_.length_total) + added_);
    out_.cutter.push_back(in_.cutter[i]);
    if (!in_.zone.empty()) out_.zone.push_back(in_.zone[i]);
    out_.corner.push_back(steps || (share == 0.0 && in_.corner[i]));
    const auto mix = [&](bevel::ColumnKind, const std::vector<double>& from,
                         std::vector<double>& to) {
      if (!from.empty()) to.push_back(share > 0.0 ? math::mixed(from[i], from[j], share) : from[i]);
    };
    bevel::each_section_column(mix, in_, out_);
    if (share > 0.0) out_.wall.back() = wall_.thickness(out_.at.back());
    for (auto* z : {&out_.z_inner, &out_.z_outer, &out_.z_face})
      if (!z->empty()) z->back() -= length(finished);
    for (auto* z : {&out_.torch_inner, &out_.torch_outer}) z->back() -= length(torch);
  }

  const section::Curve& outer_;
  const section::Wall& wall_;
  double half_;
  std::vector<TabStrip> strips_;
  const SectionTable& in_;
  bevel::SectionSurface surface_;
  SectionTable out_;
  double added_ = 0.0;  // to the length of the cut, so far
};

std::vector<TabStrip> strips_of(const TabbedEnd& end) {
  std::vector<TabStrip> out;
  for (const auto& tab : end.tabs) out.push_back(strip_of(end.wall.outer(), tab, end.finish));
  return out;
}

std::vector<Issue> check_strips(const TabbedEnd& end) {
  std::vector<Issue> out;
  const double kerf = end.cut.kerf;
  for (std::size_t i = 0; i < end.tabs.size(); ++i) {
    const auto& tab = end.tabs[i];
    const double most =
        rounded_down(2.0 * (cutout::half_flat(end.wall, tab.face) - std::abs(tab.offset)) - kerf);
    if (!(tab.width <= most))
      out.push_back({.code = ErrorCode::out_of_range,
                     .member = tab_path(i) + "/width",
                     .got = tab.width,
                     .limit = std::max(0.0, most),
                     .unit = "mm",
                     .hint = "the tab, with the beam on both sides, must lie on the flat of face " +
                             std::to_string(tab.face)});
    if (!(tab.length >= kerf))
      out.push_back({.code = ErrorCode::out_of_range,
                     .member = tab_path(i) + "/length",
                     .got = tab.length,
                     .limit = kerf,
                     .unit = "mm",
                     .hint = "the beam leaves a radius of half its width at the tab's foot, more "
                             "than half of so short a side; use a longer tab or a narrower kerf"});
    for (std::size_t k = 0; k < i; ++k) {
      const auto& other = end.tabs[k];
      const double apart = std::abs(tab.offset - other.offset) - 0.5 * (tab.width + other.width);
      if (tab.face != other.face || apart >= kerf + kBetween) continue;
      out.push_back({.code = ErrorCode::out_of_range,
                     .member = tab_path(i) + "/offset",
                     .got = tab.offset,
                     .unit = "mm",
                     .hint = "the beam, " + brief(kerf) +
                             " mm wide, must pass between this tab and " + tab_path(k)});
    }
  }
  return out;
}

// ---- verification

/// A line in (s, z).
struct TabEdge {
  Vector2d from, to;
};

double apart(const Vector2d& p, const TabEdge& edge) {
  const Vector2d way = edge.to - edge.from;
  const double square = way.squaredNorm();
  const double share = square > 0.0 ? std::clamp((p - edge.from).dot(way) / square, 0.0, 1.0) : 0.0;
  return (p - edge.from - share * way).norm();
}

/// The least distance of two polylines that do not cross: from the ends of one's lines to the
/// other.
double apart(const std::vector<TabEdge>& a, const std::vector<TabEdge>& b) {
  double out = std::numeric_limits<double>::infinity();
  for (const auto& one : a)
    for (const auto& other : b) {
      for (const auto& p : {one.from, one.to}) out = std::min(out, apart(p, other));
      for (const auto& p : {other.from, other.to}) out = std::min(out, apart(p, one));
    }
  return out;
}

/// The lines of a table within `reach` of a strip's middle, s counted from there.
std::vector<TabEdge> lines_near(const SectionTable& t, const std::vector<double>& z, double middle,
                                double reach) {
  std::vector<TabEdge> out;
  for (std::size_t i = 0; i < t.at.size(); ++i) {
    const auto j = (i + 1) % t.at.size();
    const double from = std::remainder(t.at[i].s - middle, t.girth);
    const double wide = std::remainder(t.at[j].s - t.at[i].s, t.girth);
    if (from > reach || from + wide < -reach) continue;
    out.push_back({{from, z[i]}, {from + wide, z[j]}});
  }
  return out;
}

/// z of a column at a place, of the shoulder: straight between its rows.
double between_rows(const SectionTable& t, const std::vector<double>& z, double s) {
  for (std::size_t i = 0; i < t.at.size(); ++i) {
    const auto j = (i + 1) % t.at.size();
    double off = s - t.at[i].s, wide = t.at[j].s - t.at[i].s;
    if (off < 0.0) off += t.girth;
    if (wide < 0.0) wide += t.girth;
    if (off <= wide && wide > 0.0) return z[i] + off / wide * (z[j] - z[i]);
  }
  return z.front();
}

double area_under(const SectionTable& t, const std::vector<double>& z) {
  double sum = 0.0;
  for (std::size_t i = 0; i < t.at.size(); ++i) {
    const auto j = (i + 1) % t.at.size();
    double wide = t.at[j].s - t.at[i].s;
    if (wide < 0.0) wide += t.girth;
    sum += 0.5 * wide * (z[i] + z[j]);
  }
  return sum;
}

}  // namespace

Result<void> add_tabs(const TabbedEnd& end, SectionEnd& out) {
  auto issues = check_strips(end);
  if (!std::holds_alternative<bevel::SquareCut>(end.cut.groove))
    issues.push_back({.code = ErrorCode::unsupported_combination,
                      .member = "groove",
                      .hint = "an end with tabs is cut square"});
  if (!issues.empty()) return tl::unexpected(Error{std::move(issues)});
  TabRows rows(end.wall, end.cut, strips_of(end), out.own);
  if (const auto bent = rows.bent())
    return fail({.code = ErrorCode::unsupported_combination,
                 .member = tab_path(*bent),
                 .hint = "the cut has a corner on this tab; move the tab off it"});
  out.shoulder = std::exchange(out.own, rows.make());
  return {};
}

std::vector<Check> verify_tabs(const TabbedEnd& end, const SectionEnd& cut) {
  const auto& wall = end.wall;
  const bool finish = end.finish;
  const auto &own = cut.own, &shoulder = *cut.shoulder;
  const double half = 0.5 * cut.spec.kerf;
  double corners = 0.0, beam = 0.0, area = 0.0, wide = 0.0;
  for (const auto& tab : end.tabs) {
    // The corners in space, from the face alone; the finish sees y reversed.
    Vector2d n = section::Curve::face_normal(tab.face), t(-n.y(), n.x());
    if (finish) {
      n.y() = -n.y();
      t.y() = -t.y();
    }
    const auto strip = strip_of(wall.outer(), tab, finish);
    const double middle = strip.from + 0.5 * strip.width;
    for (const double side : {-0.5, 0.5}) {
      const Vector2d p =
          wall.outer().face_distance(tab.face) * n + (tab.offset + side * tab.width) * t;
      const double s = middle + (finish ? -side : side) * tab.width;
      const double base =
          between_rows(shoulder, shoulder.z_outer, s - own.girth * std::floor(s / own.girth));
      for (const double z : {base, base - tab.length}) {
        double nearest = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < own.at.size(); ++i)
          nearest = std::min(nearest,
                             std::max((own.at[i].point - p).norm(), std::abs(own.z_outer[i] - z)));
        worsen(corners, nearest);
      }
    }
    const double reach = 0.5 * tab.width + 2.0 * half;
    worsen(beam, half - apart(lines_near(own, own.z_outer, middle, reach),
                              lines_near(own, own.torch_outer, middle, reach)));
    // Next to the middle of each side the beam passes by half a kerf, and no more.
    const auto torch = lines_near(own, own.torch_outer, middle, reach);
    for (const double side : {-0.5, 0.5}) {
      const double s = middle + side * tab.width;
      const double z =
          between_rows(shoulder, shoulder.z_outer, s - own.girth * std::floor(s / own.girth)) -
          0.5 * tab.length;
      worsen(beam,
             std::abs(apart(std::vector<TabEdge>{{{side * tab.width, z}, {side * tab.width, z}}},
                            torch) -
                      half));
    }
    area += tab.width * tab.length;
    wide += tab.width;
  }
  double taken = 0.0;
  for (const auto& [with, without] :
       {std::pair{&own.z_outer, &shoulder.z_outer}, std::pair{&own.z_inner, &shoulder.z_inner}})
    worsen(taken, std::abs(area_under(shoulder, *without) - area_under(own, *with) - area) / wide);
  return {{"tab_corners", corners, 1e-6, "mm"},
          {"tab_beam", beam, 0.01, "mm"},
          {"tab_area", taken, 1e-6, "mm"}};
}

}  // namespace tubecut::part
