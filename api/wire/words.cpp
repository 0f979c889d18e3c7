#include "api/wire/words.hpp"

#include <algorithm>
#include <charconv>
#include <tuple>

#include "api/formats/numbers.hpp"

namespace tubecut::api {
namespace {

const Word* row(std::string_view name, Term kind) {
  const auto all = glossary();
  const auto at = std::ranges::lower_bound(all, std::tuple(kind, name), {}, [](const Word& word) {
    return std::tuple(word.kind, word.name);
  });
  return at != all.end() && at->kind == kind && at->name == name ? &*at : nullptr;
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool of_a_name(char c) { return is_letter(c) || is_digit(c) || c == '_'; }

std::string spaced(std::string_view name) {
  std::string out(name);
  std::ranges::replace(out, '_', ' ');
  return out;
}

/// Returns the word of a name of any kind.
std::string name_in_words(std::string_view name) {
  for (const auto kind : {Term::field, Term::value})
    if (const auto* found = row(name, kind)) return std::string(found->called);
  return spaced(name);
}

/// `/cutters/1/wall_mm` is "partners 2, wall", as the console has it.
std::string place_in_words(std::string_view pointer) {
  std::string out, within;
  while (!pointer.empty()) {
    pointer.remove_prefix(1);
    const auto key = pointer.substr(0, pointer.find('/'));
    pointer.remove_prefix(key.size());
    int index = 0;
    if (std::from_chars(key.data(), key.data() + key.size(), index).ptr ==
        key.data() + key.size()) {
      out += " " + std::to_string(index + 1);
      continue;
    }
    const auto* inner = row(within + "." + std::string(key), Term::field);
    const auto word = inner != nullptr ? std::string(inner->called) : called(key, Term::field);
    out += (out.empty() ? "" : ", ") + word;
    within = key;
  }
  return out;
}

/// Removes and returns one unit of the text: a pointer, a name or a number; else a character.
std::string_view take_piece(std::string_view& text) {
  std::size_t end = 1;
  const char first = text.front();
  if (first == '/') {
    while (end < text.size() && (of_a_name(text[end]) || text[end] == '/')) ++end;
  } else if (is_letter(first)) {
    while (end < text.size() && of_a_name(text[end])) ++end;
  } else if (is_digit(first)) {
    while (end < text.size() && (is_digit(text[end]) || text[end] == '.' || text[end] == 'e' ||
                                 ((text[end] == '-' || text[end] == '+') && text[end - 1] == 'e')))
      ++end;
    while (text[end - 1] == '.' || text[end - 1] == 'e') --end;
  }
  const auto piece = text.substr(0, end);
  text.remove_prefix(end);
  return piece;
}

bool begins_with_unit(std::string_view text, std::string_view unit) {
  return text.starts_with(unit) && (text.size() == unit.size() || !of_a_name(text[unit.size()]));
}

/// Returns the number `digits`, with its unit if that follows (it is removed too), or if a name
/// before it sets `unit`.
std::string number_in_words(std::string_view digits, std::string_view& rest, Unit unit) {
  double value = 0.0;
  const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (read.ptr != digits.data() + digits.size()) return std::string(digits);
  if (begins_with_unit(rest, " deg")) {
    rest.remove_prefix(4);
    return measure(value, Unit::deg);
  }
  if (unit != Unit::none) return measure(value, unit);
  if (digits.find('.') == std::string_view::npos && digits.find('e') == std::string_view::npos)
    return std::string(digits);
  return number(value, begins_with_unit(rest, " mm") ? Unit::mm : Unit::none);
}

}  // namespace

std::string called(std::string_view name, Term kind) {
  const auto* found = row(name, kind);
  return found != nullptr ? std::string(found->called) : spaced(name);
}

std::string in_plain_words(std::string_view sentence) {
  std::string out;
  bool within = false;  // inside a word that is not a wire name
  Unit unit = Unit::none;
  while (!sentence.empty()) {
    const auto piece = take_piece(sentence);
    const char first = piece.front();
    if (within)
      out += piece;
    else if (first == '/' && piece.size() > 1 && is_letter(piece[1]))
      out += place_in_words(piece);
    else if (is_letter(first) && piece.find('_') != std::string_view::npos)
      out += name_in_words(piece), unit = unit_named(piece);
    else if (is_digit(first))
      out += number_in_words(piece, sentence, unit);
    else if (piece == "deg")
      out += "°";
    else
      out += piece;
    if (first == ',' || first == ';') unit = Unit::none;
    within = of_a_name(out.back()) || out.back() == '.';
  }
  return out;
}

}  // namespace tubecut::api
