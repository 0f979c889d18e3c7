#include "api/wire/format_choice.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <optional>

#include "api/batch.hpp"
#include "api/catalog/posts.hpp"
#include "api/catalog/process.hpp"
#include "api/wire/header_list.hpp"

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

/// Returns the reason why no format matches: if given by name, a parameter is wrong; if by Accept,
/// the call is.
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

/// Returns the format that determines the options: a bundle takes the options of its files.
FormatName as_asked(FormatName format, const Query& query) {
  if (!format.is_bundle()) return format;
  format.needs_speed = std::ranges::any_of(query.options.files, &BundleFile::needs_speed);
  if (!format.needs_speed) format.options = {kFilesOption};
  return format;
}

/// Returns the values that a program along torch lines lacks, or has but cannot use.
std::vector<FieldIssue> program_issues(const std::string& format, const FormatOptions& o) {
  struct Rule {
    std::string_view name, unit;
    bool given, of_table, wanted, fits;
    std::string_view why;
  };
  const auto& of_control = post_of(o).of_control;
  const bool by_control = of_control.has_value(), pairs = post_of(o).is_point_pairs();
  const bool lit = o.torch, by_us = lit && !by_control;
  const bool table = o.process != nullptr,
             pivot_of_table = table && o.process->pivot_length && !pairs;
  const bool led = o.lead ? *o.lead > 0.0 : table;
  const bool has_pivot = o.pivot_length || pivot_of_table;
  constexpr std::string_view kLit = "required if torch=on";
  const std::string control = "the control has it: " + of_control.value_or("");
  constexpr std::string_view kOfLead = "goes with lead_mm", kOfPivot = "goes with pivot_length_mm";
  const std::string_view height = by_control ? std::string_view(control) : kOfPivot;
  const bool heights = !by_control && (has_pivot || lit || pairs);
  constexpr std::string_view kOfAxes = "point pairs move no axis";
  const std::array rules{
      Rule{"speed_mm_min", "mm_min", o.speed.has_value(), table, true, true,
           "needs the torch's speed on the outer wall"},
      Rule{"lead_mm", "mm", led, false, lit, true,
           "a pierce on the finished edge scraps it; above 0"},
      Rule{"pivot_length_mm", "mm", has_pivot, false, by_us && !pairs, !pairs,
           pairs ? kOfAxes : "if the torch is lit, the program must contain the tip's height"},
      Rule{"pierce_height_mm", "mm", o.pierce_height.has_value(), table, by_us, heights,
           by_us ? kLit : height},
      Rule{"pierce_delay_s", "s", o.pierce_delay.has_value(), table, by_us, !by_control,
           by_control ? std::string_view(control) : kLit},
      Rule{"cut_height_mm", "mm", o.cut_height.has_value(), table, by_us, heights,
           by_us ? kLit : height},
      Rule{"clearance_mm", "mm", o.clearance.has_value(), false, false, has_pivot && !pairs,
           pairs ? kOfAxes : kOfPivot},
      Rule{"axial", "", o.axial_z, false, false, !pairs, kOfAxes},
      Rule{"mark_speed_mm_min", "mm_min", o.mark_speed.has_value(), false, false, o.marks,
           "goes with marks=on"},
      Rule{"overcut_mm", "mm", o.overcut.has_value(), false, false, led, kOfLead},
      Rule{"pierce_b_deg", "deg", o.pierce_bevel.has_value(), false, false, led, kOfLead}};
  std::vector<FieldIssue> out;
  for (const auto& rule : rules) {
    const bool missing = rule.wanted && !rule.given && !rule.of_table;
    if (!missing && (!rule.given || rule.fits)) continue;
    out.push_back({.code = missing ? ErrorCode::missing_field : ErrorCode::unsupported_combination,
                   .pointer = "?" + std::string(rule.name),
                   .unit = std::string(rule.unit),
                   .hint = format + ": " + std::string(rule.why)});
  }
  return out;
}

/// A machine and a material name rows of a process table together.
void expect_pair(const Query& query, std::vector<FieldIssue>& issues) {
  const auto given = [&](std::string_view name) {
    return std::ranges::any_of(query.given, [&](const auto& one) { return one.first == name; });
  };
  for (const auto& [has, lacks] : {std::pair{"machine", "material"}, {"material", "machine"}})
    if (given(has) && !given(lacks))
      issues.push_back({.code = ErrorCode::missing_field,
                        .pointer = std::string("?") + lacks,
                        .hint = "machine and material name rows of a process table together"});
}

/// Returns the reason why the answer cannot be printed as requested; nothing if it can. JSON and
/// CBOR have no options.
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
  if (format.needs_speed) {
    expect_pair(query, issues);
    if (issues.empty()) issues = program_issues(name, query.options);
  }
  if (!issues.empty()) return query_problem(std::move(issues));
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
