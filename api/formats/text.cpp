#include "api/formats/text.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>

#include "api/wire/text_encoding.hpp"

namespace tubecut::api {
namespace {

bool beyond_ascii(char c) { return static_cast<unsigned char>(c) >= 0x80; }
bool printable(char c) { return (c >= 0x20 && c < 0x7f) || beyond_ascii(c); }

/// Keeps letters, digits and signs without a meaning in comments of any control or compiler.
std::string in_a_comment(std::string_view text) {
  constexpr std::string_view kKept = "+-_.,:=/# ";
  const auto ascii = in_ascii(text);
  if (!ascii) throw Unspellable{std::string(text)};
  std::string out;
  for (const char c : *ascii) {
    const bool alphanumeric =
        (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
    out += alphanumeric || kKept.find(c) != std::string_view::npos ? c : '_';
  }
  return out;
}

std::string with_note(std::string_view text) {
  return in_a_comment(text) + std::string(spelling_note(text));
}

std::string hex(std::uint32_t value, int digits) {
  static constexpr char kHex[] = "0123456789ABCDEF";
  std::string out;
  for (int shift = 4 * (digits - 1); shift >= 0; shift -= 4) out += kHex[(value >> shift) & 15U];
  return out;
}

std::string utf16_escape(std::uint32_t unit) { return "\\U+" + hex(unit, 4); }

/// Every character by `spell(its first byte, its code point)`.
template <class Spell>
std::string spelled(std::string_view text, Spell spell) {
  std::string out;
  while (!text.empty()) {
    const char first = text.front();
    const auto c = take_character(text);
    if (!c) throw Unspellable{std::string(text)};
    out += spell(first, *c);
  }
  return out;
}

}  // namespace

std::string fixed(double value, int digits) {
  char text[512];
  std::string out{
      text, std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, digits).ptr};
  const bool zero = out.find_first_not_of("-0.") == std::string::npos;
  return zero && out.front() == '-' ? out.substr(1) : out;
}

std::string_view spelling_note(std::string_view text) {
  return std::ranges::any_of(text, beyond_ascii) ? ", spelled in ASCII" : "";
}

std::string xml_text(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else if (c == '\'')
      out += "&#39;";
    else
      out += printable(c) ? c : '_';
  }
  return out;
}

std::string dxf_text(std::string_view text) {
  return spelled(text, [](char first, std::uint32_t c) -> std::string {
    const std::uint32_t above = c - 0x10000;
    if (first == '%') return "%%%";
    if (first == '\\') return utf16_escape(c);
    if (first == '^') return "^ ";
    if (c >= 0x10000)
      return utf16_escape(0xD800 + (above >> 10U)) + utf16_escape(0xDC00 + (above & 0x3FFU));
    if (c >= 0x80) return utf16_escape(c);
    return {printable(first) ? first : '_'};
  });
}

std::string step_text(std::string_view text) {
  return spelled(text, [](char first, std::uint32_t c) -> std::string {
    if (first == '\'' || first == '\\') return {first, first};
    if (c >= 0x10000) return "\\X4\\" + hex(c, 8) + "\\X0\\";
    if (c >= 0x80) return "\\X2\\" + hex(c, 4) + "\\X0\\";
    return {printable(first) ? first : '_'};
  });
}

std::string gcode_text(std::string_view text) { return with_note(text); }

std::string dstv_text(std::string_view text) {
  const bool blank = text.find_first_not_of(' ') == std::string_view::npos;
  return blank ? "-" : in_a_comment(text);
}

std::string structured_text_text(std::string_view text) { return with_note(text); }

std::string csv_text(std::string_view text) {
  constexpr std::string_view kComputes = "=+-@'", kSeparates = ",;|", kPassedOver = " \"";
  const auto is = [](std::string_view set, char c) {
    return set.find(c) != std::string_view::npos;
  };
  std::string out;
  bool begins = true;
  for (const char c : text) {
    if (begins && is(kComputes, c)) out += '\'';
    if (c == '"') out += '"';
    out += printable(c) ? c : '_';
    begins = is(kSeparates, c) || (begins && is(kPassedOver, c));
  }
  return out.find_first_of(",;|\"") == std::string::npos ? out : '"' + out + '"';
}

}  // namespace tubecut::api
