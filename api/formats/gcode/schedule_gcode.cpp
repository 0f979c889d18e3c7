#include "api/formats/gcode/schedule_gcode.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "api/catalog/posts.hpp"
#include "api/formats/gcode/gcode_header.hpp"
#include "api/formats/numbers.hpp"
#include "api/formats/text.hpp"
#include "api/stop.hpp"

namespace tubecut::api {
namespace {

constexpr double kTolerance = 1.0;  // pulses
constexpr std::string_view kTurning = "ABC", kStraight = "XYZUVW";

/// The slopes of a line from the start of a move that pass all later samples within the tolerance.
struct Cone {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();

  [[nodiscard]] bool holds(double slope) const { return low <= slope && slope <= high; }
  void narrow(double rise, double run, double tolerance) {
    low = std::max(low, (rise - tolerance) / run);
    high = std::min(high, (rise + tolerance) / run);
  }
};

/// Pulses of every axis since the start, period by period.
class Cursor {
 public:
  explicit Cursor(const motion::Schedule& s) : schedule_(s), sums_(s.axes.size(), 0) {}

  void advance() {
    for (std::size_t a = 0; a < sums_.size(); ++a)
      if (!schedule_.axes[a].idle())
        sums_[a] += schedule_.axes[a].counts[static_cast<std::size_t>(period_)];
    ++period_;
  }
  void advance_to(std::int64_t period) {
    while (period_ < period) advance();
  }
  [[nodiscard]] const std::vector<std::int64_t>& sums() const { return sums_; }

 private:
  const motion::Schedule& schedule_;
  std::vector<std::int64_t> sums_;
  std::int64_t period_ = 0;
};

/// One cone an axis.
class Cones {
 public:
  Cones(const std::vector<std::int64_t>& from, std::int64_t period)
      : from_(from), period_(period), all_(from.size()) {}

  [[nodiscard]] bool hold(const std::vector<std::int64_t>& at, std::int64_t period) const {
    for (std::size_t a = 0; a < all_.size(); ++a)
      if (!all_[a].holds(rise(at, a) / run(period))) return false;
    return true;
  }
  void narrow(const std::vector<std::int64_t>& at, std::int64_t period, double tolerance) {
    for (std::size_t a = 0; a < all_.size(); ++a)
      all_[a].narrow(rise(at, a), run(period), tolerance);
  }

 private:
  [[nodiscard]] double rise(const std::vector<std::int64_t>& at, std::size_t a) const {
    return static_cast<double>(at[a] - from_[a]);
  }
  [[nodiscard]] double run(std::int64_t period) const {
    return static_cast<double>(period - period_);
  }

  std::vector<std::int64_t> from_;
  std::int64_t period_;
  std::vector<Cone> all_;
};

/// A machine's axis in the units of a post.
double in_units(const Post& post, motion::AxisUnit unit, double value) {
  return unit == motion::AxisUnit::mm ? post.in_units(value) : value;
}

std::string word(const Post& post, char letter, motion::AxisUnit unit, double value) {
  const bool inch = unit == motion::AxisUnit::mm && post.is_inch();
  return letter + fixed(in_units(post, unit, value), inch ? 8 : 6);
}

std::string words(const motion::Machine& machine, const motion::Schedule& s, const Post& post,
                  const std::vector<char>& letters, const std::vector<std::int64_t>& sums) {
  std::string out;
  for (std::size_t a = 0; a < sums.size(); ++a) {
    const double per_unit = machine.axes[a].pulses_per_axis_unit();
    out +=
        (out.empty() ? "" : " ") + word(post, letters[a], machine.axes[a].unit,
                                        s.axes[a].start + static_cast<double>(sums[a]) / per_unit);
  }
  return out;
}

/// How far all axes go in the post's units, one deg as one unit of length.
double distance(const motion::Machine& machine, const Post& post,
                const std::vector<std::int64_t>& from, const std::vector<std::int64_t>& to) {
  double sum = 0.0;
  for (std::size_t a = 0; a < from.size(); ++a) {
    const double way =
        in_units(post, machine.axes[a].unit,
                 static_cast<double>(to[a] - from[a]) / machine.axes[a].pulses_per_axis_unit());
    sum += way * way;
  }
  return std::sqrt(sum);
}

std::string header(const motion::Machine& machine, const motion::Schedule& s,
                   const std::vector<char>& letters, bool contour, const Caption& caption) {
  const auto& post = post_of(caption.options);
  auto out = gcode_job(caption);
  out += contour ? gcode_torch(caption.options) : post.comment("the tool is not switched here");
  out += post.comment("machine: " + (machine.name.empty() ? "of the request" : machine.name));
  for (std::size_t a = 0; a < letters.size(); ++a)
    out +=
        post.comment(std::string(1, letters[a]) + " = axis " + s.axes[a].name + ", " +
                     std::string(s.axes[a].unit == motion::AxisUnit::mm ? name_of(post.units)
                                                                        : name_of(s.axes[a].unit)));
  return out + post.comment("units " + std::string(name_of(post.units)) + ", deg") +
         post.comment("time " + measure(s.report.time, Unit::s) +
                      " as planned, each move in its own") +
         gcode_hashes(caption);
}

/// A program begins clear of the tube: there first, from wherever the torch is.
std::string lifted(const motion::Machine& machine, const motion::Schedule& s,
                   const std::vector<char>& letters, const Post& post) {
  const auto lift = motion::lift_of(machine);
  if (!lift) return {};
  const auto axis = std::ranges::find(machine.axes, lift->axis, &motion::Axis::name);
  if (axis == machine.axes.end()) return {};
  const auto a = static_cast<std::size_t>(axis - machine.axes.begin());
  return post_line(post.rapid, {{"axes", word(post, letters[a], axis->unit, s.axes[a].start)}});
}

/// Each axis within a move.
std::vector<AxisMove> axis_moves(const motion::Machine& machine, const Post& post,
                                 const std::vector<char>& letters,
                                 const std::vector<std::int64_t>& from,
                                 const std::vector<std::int64_t>& to) {
  std::vector<AxisMove> out;
  for (std::size_t a = 0; a < from.size(); ++a)
    out.push_back({.letter = letters[a],
                   .turns = machine.axes[a].unit == motion::AxisUnit::deg,
                   .way = in_units(post, machine.axes[a].unit,
                                   static_cast<double>(to[a] - from[a]) /
                                       machine.axes[a].pulses_per_axis_unit())});
  return out;
}

/// Returns a straight move to the position in the words, at constant speed in the given time.
std::string timed(const Post& post, const std::string& axes, double way, double seconds,
                  const std::vector<AxisMove>& moves) {
  const double rate = 60.0 / seconds;  // 1/min
  return post_line(post.timed_move, {{"axes", axes},
                                     {"per_minute", fixed(rate, 6)},
                                     {"units_per_minute", post.way_feed(way * rate)},
                                     {"linear_units_per_minute", linear_feed(moves, rate)},
                                     {"axes_feeds", axes_feeds(moves, rate)}});
}

/// A schedule has its machine's own axes: those that turn are in deg.
void refuse_girth(const Post& post) {
  const auto& turn = post.axis(PostRole::turn);
  if (turn && turn->unit != TurnUnit::deg)
    throw UnfitOption{"post", "post " + post.name + " counts the turn in " +
                                  std::string(name_of(turn->unit)) +
                                  ", and a schedule's axes turn in deg: take a post with unit deg, "
                                  "or a program of the part"};
}

/// Returns the switch commands or comments of an event.
std::string told(const motion::Event& event, const std::vector<std::string>& names,
                 const Caption& caption) {
  using enum motion::EventKind;
  const auto& post = post_of(caption.options);
  if (event.what == torch_on && caption.options.torch) return post_lines(post.torch_on);
  if (event.what == torch_off) return post_lines(post.torch_off);
  if (event.what == mark_on)
    return post.comment(names[event.cut]) +
           (caption.options.torch ? post_lines(post.mark_on) : std::string());
  if (event.what == mark_off) return post_lines(post.mark_off);
  if (event.what == rapid_start && !names.empty())
    return post.comment("rapid: " + names[event.cut]);
  if (event.what == cut_start && !names.empty()) return post.comment("cut: " + names[event.cut]);
  return {};
}

}  // namespace

std::vector<char> axis_letters(const std::vector<motion::AxisPulses>& axes) {
  std::vector<char> out(axes.size(), '\0');
  const auto pool = [&](std::size_t a) {
    return axes[a].unit == motion::AxisUnit::deg ? kTurning : kStraight;
  };
  const auto free = [&](char letter) { return std::ranges::find(out, letter) == out.end(); };
  const auto take = [&](std::size_t a, std::string_view letters) {
    for (const char letter : letters)
      if (out[a] == '\0' && free(letter)) out[a] = letter;
  };
  for (std::size_t a = 0; a < axes.size(); ++a)
    if (!axes[a].name.empty() && pool(a).find(axes[a].name.front()) != std::string_view::npos)
      take(a, std::string_view(axes[a].name).substr(0, 1));
  for (std::size_t a = 0; a < axes.size(); ++a) take(a, pool(a));
  for (std::size_t a = 0; a < axes.size(); ++a) take(a, "ABCXYZUVW");  // a fourth that turns
  return out;
}

std::vector<std::int64_t> move_ends(const motion::Schedule& s, double tolerance) {
  Pace pace;
  std::vector<std::int64_t> out{0};
  Cursor at(s);
  auto before = at.sums();
  Cones cones(before, 0);
  for (std::int64_t p = 1; p <= s.periods; ++p) {
    pace.tick();
    at.advance();
    if (!cones.hold(at.sums(), p)) {
      out.push_back(p - 1);
      cones = Cones(before, p - 1);
    }
    cones.narrow(at.sums(), p, tolerance);
    before = at.sums();
    const auto here = [&](const motion::Event& event) { return event.period == p; };
    if (p != s.periods && std::ranges::none_of(s.events, here)) continue;
    out.push_back(p);
    cones = Cones(before, p);
  }
  return out;
}

std::string print_schedule_gcode(const motion::Machine& machine, const motion::ScheduleSpec& spec,
                                 const motion::Schedule& s, const std::vector<std::string>& names,
                                 const Caption& caption) {
  const bool contour = std::holds_alternative<motion::CutPath>(spec.cut);
  if (!contour && caption.options.torch)
    throw UnfitOption{"torch", "a mill path has no torch; omit it"};
  const auto letters = axis_letters(s.axes);
  const auto& post = post_of(caption.options);
  if (post.is_point_pairs())
    throw UnfitOption{"post", "a schedule moves axes, and post " + post.name +
                                  " has no axes: request point pairs of the part or the table"};
  refuse_girth(post);
  if (post.mark_on.empty() &&
      std::ranges::count(s.events, motion::EventKind::mark_on, &motion::Event::what) > 0)
    throw UnfitOption{"post", "post " + post.name + " has no mark_on, by which a tool marks"};
  const bool by_axes = feeds_by_axes(post.timed_move);
  // Only in inverse time does a move of no length take time.
  const bool dwells = !names.empty() || post.timed_move.find("{per_minute}") == std::string::npos;
  Cursor at(s);
  std::string out = post_lines(post.begin) + header(machine, s, letters, contour, caption) +
                    post_lines(post.modes) + (contour ? post_lines(post.tool) : "") +
                    (names.empty() ? "" : lifted(machine, s, letters, post)) +
                    post_line(post.rapid, {{"axes", words(machine, s, post, letters, at.sums())}}) +
                    post_lines(post.cut_begin);
  const auto add = [&](std::string_view lines) { out += lines; };
  std::int64_t from = 0;
  for (const auto end : move_ends(s, kTolerance)) {
    ask();
    const auto before = at.sums();
    at.advance_to(end);
    const double seconds = s.period * static_cast<double>(end - from);
    if (end > from && dwells && before == at.sums())
      add(post_line(post.dwell, {{"seconds", fixed(seconds, 6)}}));
    else if (end > from)
      add(timed(post, words(machine, s, post, letters, at.sums()),
                distance(machine, post, before, at.sums()), seconds,
                by_axes ? axis_moves(machine, post, letters, before, at.sums())
                        : std::vector<AxisMove>{}));
    from = end;
    for (const auto& event : s.events)
      if (event.period == end && contour) add(told(event, names, caption));
  }
  add(post_lines(post.cut_end) + post_lines(post.end));
  return post.numbered(std::move(out));
}

}  // namespace tubecut::api
