#include "api/formats/text.hpp"

#include <charconv>

namespace tubecut::api {
namespace {

bool printable(char c) { return c >= 0x20 && c < 0x7f; }

/// Letters, digits and signs that mean nothing in a comment of any control or compiler.
std::string in_a_comment(std::string_view text) {
  constexpr std::string_view kKept = "+-_.,:=/# ";
  std::string out;
  for (const char c : text) {
    const bool alphanumeric =
        (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
    out += alphanumeric || kKept.find(c) != std::string_view::npos ? c : '_';
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
  std::string out;
  for (const char c : text) {
    if (c == '%')
      out += "%%%";
    else if (c == '\\')
      out += "\\U+005C";
    else if (c == '^')
      out += "^ ";
    else
      out += printable(c) ? c : '_';
  }
  return out;
}

std::string gcode_text(std::string_view text) { return in_a_comment(text); }

std::string dstv_text(std::string_view text) {
  const bool blank = text.find_first_not_of(' ') == std::string_view::npos;
  return blank ? "-" : in_a_comment(text);
}

std::string structured_text_text(std::string_view text) { return in_a_comment(text); }

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
