#include "api/wire/text_encoding.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "api/wire/shown_text.hpp"

namespace tubecut::api {
namespace {

/// Controls and formats of Unicode's plane 0 (Cc, Cf, Zl, Zp), and non-characters; the same as in
/// the contract's pattern of a text.
constexpr std::pair<char32_t, char32_t> kUnseen[] = {
    {0x00, 0x1F},     {0x7F, 0x9F},     {0xAD, 0xAD},     {0x61C, 0x61C},   {0x180E, 0x180E},
    {0x200B, 0x200F}, {0x2028, 0x202E}, {0x2060, 0x206F}, {0xFEFF, 0xFEFF}, {0xFFF9, 0xFFFF}};

/// Invisible characters with or without width: blanks (Zs), fillers, selectors and tags. Those of
/// plane 0 are the same as in the contract's pattern of a text.
constexpr std::pair<char32_t, char32_t> kBlank[] = {
    {0x20, 0x20},       {0xA0, 0xA0},       {0x34F, 0x34F},     {0x115F, 0x1160},  {0x1680, 0x1680},
    {0x17B4, 0x17B5},   {0x180B, 0x180F},   {0x2000, 0x200A},   {0x202F, 0x202F},  {0x205F, 0x205F},
    {0x2800, 0x2800},   {0x3000, 0x3000},   {0x3164, 0x3164},   {0xFE00, 0xFE0F},  {0xFFA0, 0xFFA0},
    {0x1BCA0, 0x1BCA3}, {0x1D159, 0x1D159}, {0x1D173, 0x1D17A}, {0xE0000, 0xE0FFF}};

bool is_in(std::span<const std::pair<char32_t, char32_t>> ranges, char32_t c) {
  return std::ranges::any_of(
      ranges, [c](const auto& range) { return c >= range.first && c <= range.second; });
}

/// U+00C0 to U+017F without their marks, one letter each.
constexpr std::string_view kBase =
    "AAAAAAACEEEEIIIIDNOOOOOxOUUUUYTsaaaaaaaceeeeiiiidnooooo/ouuuuyty"
    "AaAaAaCcCcCcCcDdDdEeEeEeEeEeGgGgGgGgHhHhIiIiIiIiIiIiJjKkkLlLlLlLlLlNnNnNnnNnOoOoOoOo"
    "RrRrRrSsSsSsSsTtTtTtUuUuUuUuUuUuWwYyYZzZzZzs";
constexpr char32_t kFirstBase = 0xC0;
static_assert(kBase.size() == 0x180 - 0xC0);

constexpr std::pair<char32_t, std::string_view> kSpelled[] = {
    {0xA0, " "},    {0xB0, "deg"},  {0xB1, "+-"},    {0xB2, "2"},     {0xB3, "3"},
    {0xB5, "u"},    {0xB7, "."},    {0xC4, "Ae"},    {0xC6, "Ae"},    {0xD6, "Oe"},
    {0xDC, "Ue"},   {0xDE, "Th"},   {0xDF, "ss"},    {0xE4, "ae"},    {0xE6, "ae"},
    {0xF6, "oe"},   {0xFC, "ue"},   {0xFE, "th"},    {0x132, "IJ"},   {0x133, "ij"},
    {0x152, "Oe"},  {0x153, "oe"},  {0x2010, "-"},   {0x2011, "-"},   {0x2012, "-"},
    {0x2013, "-"},  {0x2014, "-"},  {0x2018, "'"},   {0x2019, "'"},   {0x201C, "\""},
    {0x201D, "\""}, {0x201E, "\""}, {0x2026, "..."}, {0x20AC, "EUR"}, {0x2116, "No"},
    {0x2212, "-"},  {0x2300, "dia"}};

}  // namespace

std::optional<char32_t> take_character(std::string_view& text) {
  const auto byte = [&text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const auto lead = byte(0);
  const std::size_t length = lead < 0x80 ? 1 : lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if ((lead >= 0x80 && lead < 0xC2) || lead > 0xF4 || text.size() < length) return std::nullopt;
  char32_t out = length == 1 ? lead : lead & (0x7FU >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return std::nullopt;
    out = (out << 6U) | (byte(i) & 0x3FU);
  }
  constexpr std::array<char32_t, 5> kLeast{0, 0, 0x80, 0x800, 0x10000};
  if (out < kLeast[length] || out > 0x10FFFF || (out >= 0xD800 && out <= 0xDFFF))
    return std::nullopt;
  text.remove_prefix(length);
  return out;
}

bool is_utf8(std::string_view text) {
  while (!text.empty())
    if (!take_character(text)) return false;
  return true;
}

bool is_visible(std::string_view text, std::size_t longest) {
  std::size_t count = 0;
  while (!text.empty() && count <= longest) {
    const auto c = take_character(text);
    if (!c || is_in(kUnseen, *c)) return false;
    ++count;
  }
  return count >= 1 && count <= longest;
}

bool shows_something(std::string_view text) {
  while (!text.empty()) {
    const auto c = take_character(text);
    if (c && !is_in(kUnseen, *c) && !is_in(kBlank, *c)) return true;
    if (!c) return false;
  }
  return false;
}

std::optional<std::string> in_ascii(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const auto c = take_character(text);
    if (!c) return std::nullopt;
    const auto* const spelled =
        std::ranges::find(kSpelled, *c, [](const auto& row) { return row.first; });
    if (*c < 0x80)
      out += *c >= 0x20 && *c < 0x7F ? static_cast<char>(*c) : '_';
    else if (spelled != std::end(kSpelled))
      out += spelled->second;
    else if (*c >= kFirstBase && *c - kFirstBase < kBase.size())
      out += kBase[*c - kFirstBase];
    else
      return std::nullopt;
  }
  return out;
}

}  // namespace tubecut::api
