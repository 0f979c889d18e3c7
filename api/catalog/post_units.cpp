#include "api/catalog/post_units.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>

namespace tubecut::api {
namespace {

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_'; }
bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

/// Returns the end mark of a run that begins here and contains no words; empty if no run begins.
/// `;` has no end.
struct Quoted {
  std::string_view begin, end;
};

/// The line with blanks in place of comments, texts, names and values.
std::string words_only(std::string_view line, std::string_view comment_begin,
                       std::string_view comment_end) {
  const std::array<Quoted, 6> kinds{
      {{comment_begin, comment_end}, {"(", ")"}, {";", ""}, {"\"", "\""}, {"<", ">"}, {"{", "}"}}};
  std::string out(line);
  for (std::size_t at = 0; at < line.size();) {
    const auto kind = std::ranges::find_if(kinds, [&](const Quoted& q) {
      return !q.begin.empty() && line.substr(at).starts_with(q.begin);
    });
    if (kind == kinds.end()) {
      ++at;
      continue;
    }
    auto end = line.size();
    if (!kind->end.empty())
      if (const auto found = line.find(kind->end, at + kind->begin.size());
          found != std::string_view::npos)
        end = found + kind->end.size();
    std::fill(out.begin() + static_cast<std::ptrdiff_t>(at),
              out.begin() + static_cast<std::ptrdiff_t>(end), ' ');
    at = end;
  }
  std::ranges::transform(out, out.begin(), [](char c) {
    return static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  });
  return out;
}

std::optional<PostUnits> units_of(double code) {
  if (code == 20.0 || code == 70.0 || code == 700.0) return PostUnits::inch;
  if (code == 21.0 || code == 71.0 || code == 710.0) return PostUnits::mm;
  return std::nullopt;
}

/// "BEGIN PGM NAME INCH".
std::optional<UnitWord> program_begin(std::string_view words) {
  const auto from = words.find("BEGIN PGM");
  if (from == std::string_view::npos) return std::nullopt;
  words = words.substr(0, words.find_last_not_of(' ') + 1);
  if (words.ends_with(" INCH")) return UnitWord{"INCH", PostUnits::inch};
  if (words.ends_with(" MM")) return UnitWord{"MM", PostUnits::mm};
  return std::nullopt;
}

}  // namespace

std::optional<UnitWord> other_units(std::string_view line, std::string_view comment_begin,
                                    std::string_view comment_end, PostUnits units) {
  const auto words = words_only(line, comment_begin, comment_end);
  if (auto begin = program_begin(words); begin && begin->units != units) return begin;
  for (auto at = words.find('G'); at != std::string::npos; at = words.find('G', at + 1)) {
    if (at > 0 && is_letter(words[at - 1])) continue;
    const auto from = words.find_first_not_of(' ', at + 1);
    if (from == std::string::npos || !is_digit(words[from])) continue;
    double code = 0.0;
    std::from_chars(words.data() + from, words.data() + words.size(), code,
                    std::chars_format::fixed);
    if (const auto found = units_of(code); found && *found != units)
      return UnitWord{"G" + std::to_string(static_cast<int>(code)), *found};
  }
  return std::nullopt;
}

}  // namespace tubecut::api
