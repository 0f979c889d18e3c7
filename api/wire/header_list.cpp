#include "api/wire/header_list.hpp"

#include <charconv>

namespace tubecut::api {
namespace {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t";
  const auto begin = text.find_first_not_of(kBlank);
  if (begin == text.npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlank) - begin + 1);
}

/// Returns the text before the next `by`; `text` continues after it.
std::string_view next(std::string_view& text, char by) {
  const auto end = text.find(by);
  const auto piece = trimmed(text.substr(0, end));
  text = end == text.npos ? std::string_view{} : text.substr(end + 1);
  return piece;
}

double quality(std::string_view text) {
  double value = 0.0;
  const auto [end, error] =
      std::from_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed);
  const bool whole = error == std::errc{} && end == text.data() + text.size();
  return whole && value >= 0.0 && value <= 1.0 ? value : 0.0;
}

}  // namespace

std::vector<ListElement> header_list(std::string_view value) {
  std::vector<ListElement> out;
  while (!value.empty()) {
    auto rest = next(value, ',');
    if (rest.empty()) continue;
    ListElement element{.name = next(rest, ';')};
    while (!rest.empty()) {
      const auto parameter = next(rest, ';');
      if (parameter.starts_with("q=") || parameter.starts_with("Q="))
        element.quality = quality(parameter.substr(2));
    }
    out.push_back(element);
  }
  return out;
}

}  // namespace tubecut::api
