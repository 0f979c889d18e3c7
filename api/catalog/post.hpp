#pragma once

#include <array>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/catalog/post_axis.hpp"
#include "api/catalog/post_units.hpp"
#include "api/wire/reader.hpp"

namespace tubecut::api {

/// Kind of a program: blocks in a control's syntax, or the positions of both edges as JSON.
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
  int block_numbers = 0;                  // step between blocks; 0: no numbers
  std::optional<std::string> of_control;  // the control that sets heights and delay of the pierce;
                                          // otherwise ours
  Lines begin, speed, modes, tool, torch_on, torch_off, cut_begin, cut_end, end;
  Lines mark_on, mark_off;  // empty: the control has no marking tool
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
  /// Returns a comment line; client text must pass gcode_text, which removes everything that ends
  /// one.
  [[nodiscard]] std::string comment(std::string_view text) const;
  /// Returns the blocks of a program numbered, if the post numbers them: all except comments and
  /// `begin`.
  [[nodiscard]] std::string numbered(std::string program) const;
};

/// One axis within one move.
struct AxisMove {
  char letter = 'X';
  bool turns = false;
  double way = 0.0;  // distance as written in its words, mm or deg
};

/// Whether a line's values need them.
[[nodiscard]] bool feeds_by_axes(std::string_view line);
/// Returns the feed of a move of that time, 1/min: mm/min along the path of the linear axes that
/// move; if no linear axis moves, deg/min of the rotary ones.
[[nodiscard]] std::string linear_feed(const std::vector<AxisMove>& axes, double per_minute);
/// Of each axis that moves, behind F and its letter: "FX300.000 FA1200.000".
[[nodiscard]] std::string axes_feeds(const std::vector<AxisMove>& axes, double per_minute);

/// Values by name, for one line.
using PostValues = std::initializer_list<std::pair<std::string_view, std::string>>;

/// A line with its values, and its end.
[[nodiscard]] std::string post_line(std::string_view line, const PostValues& values = {});
[[nodiscard]] std::string post_lines(const Post::Lines& lines, const PostValues& values = {});

/// Decodes an object in the form of GET /v1/posts at `in`. Unknown names in braces of a line,
/// duplicate letters and missing values of a line are issues at their member.
[[nodiscard]] Post decode_post(Reader& in);

}  // namespace tubecut::api
