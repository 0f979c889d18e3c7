#pragma once

#include <array>
#include <initializer_list>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/catalog/post_axis.hpp"
#include "api/catalog/post_units.hpp"
#include "api/wire/reader.hpp"

namespace tubecut::api {

/// What a program is: blocks in a control's words, or the places of both edges as JSON.
enum class PostKind { blocks, point_pairs };
inline constexpr std::string_view kPointPairsMedia = "application/x-point-pairs+json";

/// The words that a control's programs are written in: lines with named values between braces, no
/// more. docs/formats.md, "Posts".
struct Post {
  using Lines = std::vector<std::string>;

  std::string name;
  PostKind kind = PostKind::blocks;
  PostUnits units = PostUnits::mm;
  std::optional<std::string> file_name;  // a line of file_name.hpp's values
  std::string comment_begin, comment_end;
  bool comment_upper_case = false;
  int block_numbers = 0;                  // from one block to the next; 0: none
  std::optional<std::string> of_control;  // whose heights and delay of the pierce are; else ours
  Lines begin, speed, modes, tool, torch_on, torch_off, cut_begin, cut_end, end;
  Lines mark_on, mark_off;  // none: the control has no tool that marks
  std::string rapid, dwell, cut_move, timed_move;
  std::array<std::optional<PostAxis>, kPostRoles.size()> axes;

  [[nodiscard]] const std::optional<PostAxis>& axis(PostRole role) const {
    return axes[static_cast<std::size_t>(role)];
  }
  [[nodiscard]] bool is_point_pairs() const { return kind == PostKind::point_pairs; }
  [[nodiscard]] bool is_inch() const { return units == PostUnits::inch; }

  /// Millimetres in the units of the post.
  [[nodiscard]] double in_units(double mm) const { return is_inch() ? mm / kMmPerInch : mm; }
  /// The same for a person: "12.5" and "12.5 mm", or "0.4921" and "0.4921 in".
  [[nodiscard]] std::string length_number(double mm) const;
  [[nodiscard]] std::string length(double mm) const;
  /// Of mm/min: "600 mm/min", "23.62 in/min".
  [[nodiscard]] std::string speed_text(double mm_min) const;
  /// An upper bound, mm: rounded up in the last decimal, "0.019 mm" or "0.00075 in".
  [[nodiscard]] std::string bound(double mm) const;
  /// Of values of a block, as a control reads them.
  [[nodiscard]] std::string speed_word(double mm_min) const;
  [[nodiscard]] std::string length_word(double mm) const;
  [[nodiscard]] std::string way_feed(double units_per_minute) const;
  /// A comment line; what is a client's passes gcode_text, which leaves nothing that ends one.
  [[nodiscard]] std::string comment(std::string_view text) const;
  /// The blocks of a program numbered, where the post has that: all but comments and `begin`.
  [[nodiscard]] std::string numbered(std::string program, const std::stop_token& stop) const;
};

/// One axis within one move.
struct AxisMove {
  char letter = 'X';
  bool turns = false;
  double way = 0.0;  // as far as its words tell, mm or deg
};

/// Whether a line's values need them.
[[nodiscard]] bool feeds_by_axes(std::string_view line);
/// Feeds of a move that takes so long, 1/min. Of the axes that go straight together, mm/min along
/// their path; where none does, of those that turn, deg/min.
[[nodiscard]] std::string linear_feed(const std::vector<AxisMove>& axes, double per_minute);
/// Of each axis that moves, behind F and its letter: "FX300.000 FA1200.000".
[[nodiscard]] std::string axes_feeds(const std::vector<AxisMove>& axes, double per_minute);

/// Values by name, for one line.
using PostValues = std::initializer_list<std::pair<std::string_view, std::string>>;

/// A line with its values, and its end.
[[nodiscard]] std::string post_line(std::string_view line, const PostValues& values = {});
[[nodiscard]] std::string post_lines(const Post::Lines& lines, const PostValues& values = {});

/// `in` stands on an object in the form of GET /v1/posts. Names in braces that a line does not
/// have, letters twice and values that a line must have are issues at their member.
[[nodiscard]] Post decode_post(Reader& in);

}  // namespace tubecut::api
