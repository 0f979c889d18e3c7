#include "api/formats/text.hpp"

#include <charconv>

namespace tubecut::api {
namespace {

bool printable(char c) { return c >= 0x20 && c < 0x7f; }

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

std::string machine_text(std::string_view text) {
  constexpr std::string_view kKept = "+-_.,:=/# ";
  std::string out;
  for (const char c : text) {
    const bool alphanumeric =
        (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
    out += alphanumeric || kKept.find(c) != std::string_view::npos ? c : '_';
  }
  return out;
}

}  // namespace tubecut::api
