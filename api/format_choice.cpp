#include "api/format_choice.hpp"

#include <algorithm>
#include <functional>
#include <optional>

#include "api/batch.hpp"
#include "api/header_list.hpp"

namespace tubecut::api {
namespace {

std::optional<FormatChoice> choice_by(std::string_view word, std::span<const FormatName> formats,
                                      bool by_name) {
  if (word == (by_name ? "json" : kJsonMedia)) return FormatChoice{};
  if (word == (by_name ? "cbor" : kCborMedia)) return FormatChoice{.encoding = Encoding::cbor};
  if (!by_name && (word == "*/*" || word == "application/*")) return FormatChoice{};
  for (const auto& format : formats)
    if (word == (by_name ? format.name : format.media)) return FormatChoice{.format = &format};
  return std::nullopt;
}

std::optional<FormatChoice> choose(const Query& query, std::string_view accept,
                                   const Endpoint& endpoint) {
  const auto formats = endpoint.formats;
  if (!query.format.empty()) return choice_by(query.format, formats, true);
  if (accept.empty()) return FormatChoice{};
  auto asked = header_list(accept);
  std::ranges::stable_sort(asked, std::greater{}, &ListElement::quality);
  for (const auto& type : asked) {
    if (type.quality == 0.0) break;
    const auto media = media_of(type.name);
    if (endpoint.begin != nullptr && media == kLinesMedia) return FormatChoice{.by_lines = true};
    if (auto found = choice_by(media, formats, false)) return found;
  }
  return std::nullopt;
}

std::string listed(const std::vector<std::string_view>& names) {
  std::string out;
  for (const auto name : names) out += (out.empty() ? "" : ", ") + std::string(name);
  return out.empty() ? "none" : out;
}

/// Why none of the formats was meant: by its name a parameter is wrong, by Accept the call is.
Problem no_format(const Query& query, const Endpoint& endpoint) {
  const auto formats = endpoint.formats;
  std::string out = "offered: application/json (json), application/cbor (cbor)";
  for (const auto& format : formats)
    out += ", " + std::string(format.media) + " (" + std::string(format.name) + ")";
  if (endpoint.begin != nullptr) out += ", " + std::string(kLinesMedia) + " (by Accept alone)";
  if (query.format.empty()) return {.code = ErrorCode::not_acceptable, .detail = out, .issues = {}};
  std::vector<std::string_view> names{"json", "cbor"};
  for (const auto& format : formats) names.push_back(format.name);
  return query_problem({{.code = ErrorCode::bad_choice,
                         .pointer = "?format",
                         .got = Json{query.format},
                         .limit = Json{listed(names)},
                         .hint = std::move(out)}},
                       ErrorCode::not_acceptable);
}

bool has(const std::vector<std::string_view>& all, std::string_view one) {
  return std::ranges::find(all, one) != all.end();
}

/// A bundle is asked what the files in it ask.
FormatName as_asked(FormatName format, const Query& query) {
  if (!format.is_bundle()) return format;
  format.needs_speed = std::ranges::any_of(query.options.files, &BundleFile::needs_speed);
  if (!format.needs_speed) format.options = {kFilesOption};
  return format;
}

/// Why the answer cannot be printed as asked; nothing when it can. JSON and CBOR have no options.
std::optional<Problem> format_problem(const Query& query, const FormatName* chosen) {
  const auto format = chosen != nullptr ? as_asked(*chosen, query)
                                        : FormatName{.name = "json", .media = kJsonMedia};
  const std::string name(format.name);
  std::vector<FieldIssue> issues;
  for (const auto& [option, value] : query.given)
    if (!has(format.options, option))
      issues.push_back(
          {.code = ErrorCode::unsupported_combination,
           .pointer = "?" + option,
           .got = value,
           .limit = Json{listed(format.options)},
           .hint = "no option of format " + name + "; its options: " + listed(format.options)});
  if (!issues.empty()) return query_problem(std::move(issues));
  if (!query.view.empty() && !has(format.views, query.view))
    return query_problem({{.code = ErrorCode::bad_choice,
                           .pointer = "?view",
                           .got = Json{query.view},
                           .limit = Json{listed(format.views)},
                           .hint = "views of " + name + " offered: " + listed(format.views)}},
                         ErrorCode::not_acceptable);
  if (format.needs_speed && !query.options.speed)
    return query_problem({{.code = ErrorCode::missing_field,
                           .pointer = "?speed_mm_min",
                           .unit = "mm_min",
                           .hint = name + " needs the torch's speed on the outer wall"}});
  return std::nullopt;
}

}  // namespace

std::string media_of(std::string_view header) {
  auto media = std::string(header.substr(0, header.find(';')));
  std::erase_if(media, [](char c) { return c == ' ' || c == '\t'; });
  for (auto& c : media)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return media;
}

tl::expected<FormatChoice, Problem> choose_format(const Query& query, std::string_view accept,
                                                  const Endpoint& endpoint) {
  const auto choice = choose(query, accept, endpoint);
  if (!choice) return tl::unexpected(no_format(query, endpoint));
  if (auto problem = format_problem(query, choice->format)) return tl::unexpected(*problem);
  return *choice;
}

Problem query_problem(std::vector<FieldIssue> issues, ErrorCode code) {
  auto out = field_problem(std::move(issues));
  out.code = code;
  return out;
}

}  // namespace tubecut::api
