#include "api/catalog/post.hpp"

#include <algorithm>
#include <cmath>

#include "api/formats/numbers.hpp"
#include "api/formats/text.hpp"
#include "api/limits.hpp"
#include "api/stop.hpp"
#include "api/wire/file_name.hpp"
#include "api/wire/text_encoding.hpp"

namespace tubecut::api {
namespace {

constexpr std::size_t kLongestLine = 120;
constexpr CountRange kSomeLines{.min = 0, .max = 20};

using Names = std::initializer_list<std::string_view>;

/// Seven digits, three of them behind the point at least; never 0, which controls refuse.
std::string feed_word(double feed) {
  constexpr double kLeast = 1e-6;
  int decimals = 3;
  for (double v = std::max(feed, kLeast); v < 1e3 && decimals < 9; v *= 10.0) ++decimals;
  return fixed(std::max(feed, kLeast), decimals);
}

/// Returns the number with `decimals` decimals and no trailing zeros.
std::string inches(double value, int decimals) {
  auto out = fixed(value, decimals);
  out.erase(out.find_last_not_of('0') + 1);
  if (out.back() == '.') out.pop_back();
  return out;
}

/// From a brace to the next that closes one.
struct Slot {
  std::size_t begin, end;  // of the braces
  std::string_view name;
};
std::optional<Slot> next_slot(std::string_view line, std::size_t from) {
  const auto begin = line.find('{', from), end = line.find('}', begin);
  if (end == std::string_view::npos) return std::nullopt;
  return Slot{begin, end, line.substr(begin + 1, end - begin - 1)};
}

/// Checks a line of a program and reports errors at its pointer.
void check_line(Reader& in, const std::string& pointer, const std::string& line,
                const Names& names) {
  std::size_t braces = 0;
  std::vector<std::string_view> seen;
  for (auto slot = next_slot(line, 0); slot; slot = next_slot(line, slot->end + 1)) {
    braces += 2;
    // A block as long as its values are, each once: a program's bytes go by its places.
    if (std::ranges::find(seen, slot->name) != seen.end())
      in.issue({.code = ErrorCode::duplicate_id,
                .pointer = pointer,
                .got = Json{std::string(slot->name)},
                .hint = "a line has each value once"});
    seen.push_back(slot->name);
    if (std::ranges::find(names, slot->name) == names.end())
      in.issue({.code = ErrorCode::bad_choice,
                .pointer = pointer,
                .got = Json{std::string(slot->name)},
                .limit = Json{one_of(names)},
                .hint = names.size() == 0 ? "this line has no values"
                                          : "values of this line: " + one_of(names)});
  }
  const auto brace = [](char c) { return c == '{' || c == '}'; };
  const bool open = static_cast<std::size_t>(std::ranges::count_if(line, brace)) != braces;
  if (open || in_ascii(line) != line)
    in.issue({.code = ErrorCode::bad_text,
              .pointer = pointer,
              .got = Json{line},
              .hint = open ? "unmatched brace" : "only printable ASCII characters"});
}

Post::Lines read_lines(Reader& in, std::string_view name, const Names& names = {}) {
  auto out = in.text_column(name, kSomeLines, kLongestLine);
  for (std::size_t i = 0; i < out.size(); ++i)
    check_line(in, std::string(name) + "/" + std::to_string(i), out[i], names);
  return out;
}

/// Absent they are not echoed: the document stays as it was sent.
Post::Lines read_optional_lines(Reader& in, std::string_view name) {
  in.note(name);
  return in.has(name) ? read_lines(in, name) : Post::Lines{};
}

/// One that must have a value out of each of these groups.
std::string read_line(Reader& in, std::string_view name, const Names& names,
                      std::initializer_list<Names> needed) {
  auto out = in.text(name, kLongestLine);
  if (!in.understood(name)) return out;
  check_line(in, std::string(name), out, names);
  for (const auto& group : needed) {
    const bool has = std::ranges::any_of(group, [&](std::string_view value) {
      return out.find("{" + std::string(value) + "}") != std::string::npos;
    });
    if (!has)
      in.issue({.code = ErrorCode::bad_text,
                .pointer = std::string(name),
                .got = Json{out},
                .limit = Json{one_of(group)},
                .hint = "the line needs a value between braces: " + one_of(group)});
  }
  return out;
}

/// Reads the end of a comment, which must not be possible in the output of gcode_text.
std::string read_comment_end(Reader& in) {
  in.note("comment_end");
  if (!in.has("comment_end")) return {};
  auto out = in.ascii_text("comment_end", 4);
  const auto kept = [](char c) { return gcode_text(std::string(1, c)) == std::string(1, c); };
  if (!std::ranges::any_of(out, kept)) return out;
  in.issue(
      {.code = ErrorCode::bad_text,
       .pointer = "comment_end",
       .hint = "a sign that texts cannot contain: not a letter, digit, blank or one of +-_.,:=/#"},
      in.find("comment_end"));
  return {};
}

/// Absent it is not echoed: the document stays as it was sent.
PostKind read_kind(Reader& in) {
  static constexpr std::array kKinds{Option<PostKind>{"blocks", PostKind::blocks},
                                     Option<PostKind>{"point_pairs", PostKind::point_pairs}};
  in.note("kind");
  return in.has("kind") ? in.choice("kind", kKinds) : PostKind::blocks;
}

/// Values and signs that every file system takes in a name.
std::optional<std::string> read_file_name(Reader& in) {
  auto out = in.optional_text("file_name", kLongestLine);
  if (!out || !in.understood("file_name")) return std::nullopt;
  check_line(in, "file_name", *out,
             {"part", "revision", "order", "drawing", "reference", "cut", "input"});
  std::size_t from = 0;
  const auto sound = [](std::string_view text) { return in_file_name(text) == text; };
  bool all = !out->starts_with('.') && !out->starts_with('-');
  for (auto slot = next_slot(*out, 0); slot; slot = next_slot(*out, from)) {
    all = all && sound(std::string_view(*out).substr(from, slot->begin - from));
    from = slot->end + 1;
  }
  if (!all || !sound(std::string_view(*out).substr(from)))
    in.issue(
        {.code = ErrorCode::bad_text,
         .pointer = "file_name",
         .hint = "letters, digits, values and the signs . _ -, of which the last and the first "
                 "begin no name"},
        in.find("file_name"));
  return out;
}

/// Reads the units, with millimetres as default; if absent, they are not echoed, so the document
/// stays as it was sent.
PostUnits read_units(Reader& in) {
  in.note("units");
  return in.has("units") ? in.choice("units", PostUnits::mm) : PostUnits::mm;
}

/// A word that makes the control count in other units than the numbers have.
void check_units(Reader& in, const Post& post, const std::string& pointer,
                 const std::string& line) {
  const auto word = other_units(line, post.comment_begin, post.comment_end, post.units);
  if (!word) return;
  const std::string theirs(name_of(word->units)), ours(name_of(post.units));
  in.issue({.code = ErrorCode::unsupported_combination,
            .pointer = pointer,
            .got = Json{line},
            .limit = Json{ours},
            .hint = word->word + " makes the control count " + theirs +
                    ", and the numbers of this post are " + ours + ": " +
                    (in.has("units") ? "take the word out, or state units: " : "state units: ") +
                    theirs});
}

void check_units(Reader& in, const Post& p) {
  const std::pair<const char*, const Post::Lines*> all[] = {{"begin", &p.begin},
                                                            {"speed", &p.speed},
                                                            {"modes", &p.modes},
                                                            {"tool", &p.tool},
                                                            {"torch_on", &p.torch_on},
                                                            {"torch_off", &p.torch_off},
                                                            {"mark_on", &p.mark_on},
                                                            {"mark_off", &p.mark_off},
                                                            {"cut_begin", &p.cut_begin},
                                                            {"cut_end", &p.cut_end},
                                                            {"end", &p.end}};
  for (const auto& [name, lines] : all)
    for (std::size_t i = 0; i < lines->size(); ++i)
      check_units(in, p, std::string(name) + "/" + std::to_string(i), (*lines)[i]);
  const std::pair<const char*, const std::string*> single[] = {{"rapid", &p.rapid},
                                                               {"dwell", &p.dwell},
                                                               {"cut_move", &p.cut_move},
                                                               {"timed_move", &p.timed_move}};
  for (const auto& [name, line] : single) check_units(in, p, name, *line);
}

}  // namespace

std::string Post::length_number(double mm) const {
  return is_inch() ? inches(mm / kMmPerInch, 4) : number(mm, Unit::mm);
}

std::string Post::length(double mm) const {
  return length_number(mm) + (is_inch() ? " in" : " mm");
}

std::string Post::speed_text(double mm_min) const {
  return is_inch() ? inches(mm_min / kMmPerInch, 2) + " in/min" : measure(mm_min, Unit::mm_min);
}

std::string Post::bound(double mm) const {
  const double steps = is_inch() ? 1e5 : 1e3;
  return fixed(std::ceil(in_units(mm) * steps) / steps, is_inch() ? 5 : 3) +
         (is_inch() ? " in" : " mm");
}

std::string Post::speed_word(double mm_min) const {
  return fixed(in_units(mm_min), is_inch() ? 5 : 3);
}

std::string Post::length_word(double mm) const { return fixed(in_units(mm), is_inch() ? 8 : 6); }

std::string Post::way_feed(double units_per_minute) const {
  constexpr double kLeast = 1e-3;  // mm/min
  return fixed(std::max(units_per_minute, in_units(kLeast)), is_inch() ? 5 : 3);
}

std::string Post::comment(std::string_view text) const {
  auto out = gcode_text(text);
  if (comment_upper_case)
    for (auto& c : out)
      if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return comment_begin + out + comment_end + "\n";
}

std::string Post::numbered(std::string program) const {
  if (block_numbers == 0) return program;
  std::string out;
  std::size_t unnumbered = begin.size();
  int number = 0;
  for (std::size_t from = 0; from < program.size();) {
    const auto next = program.find('\n', from) + 1;
    const auto line = std::string_view(program).substr(from, next - from);
    from = next;
    if (unnumbered > 0)
      --unnumbered;
    else if (!line.starts_with(comment_begin) && line != "%\n")
      out += "N" + std::to_string(number += block_numbers) + " ";
    out += line;
  }
  return out;
}

bool feeds_by_axes(std::string_view line) {
  return line.find("{linear_units_per_minute}") != std::string_view::npos ||
         line.find("{axes_feeds}") != std::string_view::npos;
}

std::string linear_feed(const std::vector<AxisMove>& axes, double per_minute) {
  double straight = 0.0, turned = 0.0;
  for (const auto& axis : axes) (axis.turns ? turned : straight) += axis.way * axis.way;
  return feed_word(std::sqrt(straight > 0.0 ? straight : turned) * per_minute);
}

std::string axes_feeds(const std::vector<AxisMove>& axes, double per_minute) {
  std::string out;
  for (const auto& axis : axes)
    if (axis.way != 0.0)
      out += (out.empty() ? "F" : " F") + std::string(1, axis.letter) +
             feed_word(std::abs(axis.way) * per_minute);
  return out;
}

std::string post_line(std::string_view line, const PostValues& values) {
  std::string out;
  std::size_t from = 0;
  for (auto slot = next_slot(line, 0); slot; slot = next_slot(line, from)) {
    out += line.substr(from, slot->begin - from);
    for (const auto& [name, value] : values)
      if (name == slot->name) out += value;
    from = slot->end + 1;
  }
  out += line.substr(from);
  return out + "\n";
}

std::string post_lines(const Post::Lines& lines, const PostValues& values) {
  std::string out;
  for (const auto& line : lines) out += post_line(line, values);
  return out;
}

Post decode_post(Reader& in) {
  Post out;
  out.name = in.ascii_text("name", 64);
  out.kind = read_kind(in);
  out.file_name = read_file_name(in);
  in.text("what", kLongestLine);
  in.text_column("checked_with", kSomeLines, kLongestLine);
  in.text_column("not_checked", kSomeLines, kLongestLine);
  if (out.is_point_pairs()) return out;
  out.units = read_units(in);
  if (auto whose = in.optional_text("pierce_by_control", kLongestLine)) out.of_control = *whose;
  out.comment_begin = in.ascii_text("comment_begin", 4);
  out.comment_end = read_comment_end(in);
  out.comment_upper_case = in.flag("comment_upper_case", false);
  out.block_numbers = in.integer("block_numbers", 0, 1'000, 0);
  out.begin = read_lines(in, "begin");
  out.speed = read_lines(in, "speed", {"speed_mm_min", "speed"});
  out.modes = read_lines(in, "modes");
  out.tool = read_lines(in, "tool");
  out.torch_on = read_lines(in, "torch_on");
  out.torch_off = read_lines(in, "torch_off");
  out.mark_on = read_optional_lines(in, "mark_on");
  out.mark_off = read_optional_lines(in, "mark_off");
  if (out.mark_on.empty() != out.mark_off.empty())
    in.issue({.code = ErrorCode::missing_field,
              .pointer = out.mark_on.empty() ? "mark_on" : "mark_off",
              .hint = "mark_on and mark_off require each other"},
             nullptr);
  out.cut_begin = read_lines(in, "cut_begin");
  out.cut_end = read_lines(in, "cut_end");
  out.end = read_lines(in, "end");
  out.rapid = read_line(in, "rapid", {"axes"}, {{"axes"}});
  out.dwell = read_line(in, "dwell", {"seconds"}, {{"seconds"}});
  out.cut_move = read_line(in, "cut_move",
                           {"axes", "length_mm", "length", "per_minute", "units_per_minute",
                            "linear_units_per_minute", "axes_feeds"},
                           {{"axes"},
                            {"length_mm", "length", "per_minute", "units_per_minute",
                             "linear_units_per_minute", "axes_feeds"}});
  out.timed_move = read_line(
      in, "timed_move",
      {"axes", "per_minute", "units_per_minute", "linear_units_per_minute", "axes_feeds"},
      {{"axes"}, {"per_minute", "units_per_minute", "linear_units_per_minute", "axes_feeds"}});
  in.object("axes", [&](Reader& axes) {
    out.axes = decode_post_axes(axes, out.units);
    return 0;
  });
  check_units(in, out);
  return out;
}

}  // namespace tubecut::api
