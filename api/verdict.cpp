#include "api/verdict.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "api/wire/field_names.hpp"
#include "api/wire/format.hpp"
#include "api/wire/problem.hpp"
#include "api/wire/words.hpp"

namespace tubecut::api {
namespace {

void add_once(std::vector<std::string>& to, const std::string& text) {
  if (std::ranges::find(to, text) == to.end()) to.push_back(text);
}

std::string joined(const std::vector<std::string>& texts) {
  std::string out;
  for (const auto& text : texts) out += (out.empty() ? "" : ", ") + text;
  return out;
}

/// As the option `acknowledge` takes them.
std::string listed(const std::vector<std::string>& codes) {
  std::string out;
  for (const auto& code : codes) out += (out.empty() ? "" : ",") + code;
  return out;
}

std::vector<std::string> each_once(const std::vector<std::string>& texts) {
  std::vector<std::string> out;
  for (const auto& text : texts) add_once(out, text);
  return out;
}

std::vector<std::string> without(const std::vector<std::string>& texts,
                                 const std::vector<std::string>& others) {
  std::vector<std::string> out;
  for (const auto& text : each_once(texts))
    if (std::ranges::find(others, text) == others.end()) out.push_back(text);
  return out;
}

/// Returns whether a limit of this name is a minimum.
bool is_least(std::string_view name) { return name.starts_with("min_"); }

constexpr std::string_view kAbove = " > ", kBelow = " < ";

bool of_a_limit(const std::string& reason) {
  return reason.find(kAbove) != std::string::npos || reason.find(kBelow) != std::string::npos;
}

/// Without the signs, which comments of machine files cannot hold.
std::string in_words(std::string reason) {
  for (const auto& [sign, word] : {std::pair{kAbove, " above "}, std::pair{kBelow, " below "}})
    for (auto at = reason.find(sign); at != std::string::npos; at = reason.find(sign))
      reason.replace(at, sign.size(), word);
  return reason;
}

/// Broken at blanks, a word too long for a line anywhere.
void add_wrapped(std::string_view text, std::size_t width, std::vector<std::string>& out) {
  std::string_view indent;
  while (!text.empty()) {
    const auto room = width - indent.size();
    auto end = text.size() <= room ? text.size() : text.rfind(' ', room);
    if (end == std::string_view::npos || end == 0) end = room;
    while (end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U)
      --end;  // not within a character
    out.push_back(std::string(indent) + std::string(text.substr(0, end)));
    text.remove_prefix(end);
    if (text.starts_with(' ')) text.remove_prefix(1);
    indent = "... ";  // no line begins with a client's word: (LOGOPEN, acts in RS-274
  }
}

}  // namespace

Verdict judge(const std::vector<Warning>& warnings, const Json& request,
              const std::vector<Measure>& measures, const std::vector<Measure>& accepted) {
  Verdict out;
  for (const auto& warning : warnings) {
    const auto& about = info(warning.code);
    if (about.severity != Severity::cut) continue;
    out.status = "review";
    add_once(out.reasons, std::string(about.code));
    add_once(out.codes, std::string(about.code));
    const auto pointer = pointer_of(warning.member, request);
    out.warnings.push_back(std::string(about.code) + (pointer.empty() ? "" : " at " + pointer) +
                           ": " +
                           (warning.detail.empty() ? std::string(about.meaning) : warning.detail));
  }
  for (const auto& bound : accepted)
    for (const auto& measure : measures) {
      const bool least = is_least(bound.name);
      const double rest = measure.value - bound.value;
      // Because 5 mm, computed, may be 4.999999999999999 mm.
      const double rounding = 1e-9 * (1.0 + std::abs(bound.value));
      if (measure.name != bound.name || (least ? rest >= -rounding : rest <= rounding)) continue;
      out.status = "reject";
      add_once(out.reasons, std::string(bound.name) + ": " + brief(measure.value) +
                                std::string(least ? kBelow : kAbove) + brief(bound.value));
      out.excess.push_back({bound.name, measure.value, bound.value});
    }
  return out;
}

std::vector<std::string> verdict_lines(const Verdict& verdict, VerdictRoom room) {
  std::vector<std::string> out;
  const auto add = [&](const std::string& line) {
    add_wrapped(room.plain ? in_plain_words(line) : line, room.width, out);
  };
  add("verdict: " + std::string(verdict.status));
  if (!verdict.reasons.empty()) add("reasons: " + in_words(joined(each_once(verdict.reasons))));
  const auto shown = std::min(verdict.warnings.size(), room.warnings);
  for (std::size_t i = 0; i < shown; ++i) add("warning: " + verdict.warnings[i]);
  if (const auto more = verdict.warnings.size() - shown; more > 0)
    add("and " + std::to_string(more) + " more warnings of severity cut, all in the JSON");
  return out;
}

std::string verdict_in_short(const Verdict& verdict) {
  auto reasons = each_once(verdict.reasons);
  std::ranges::stable_partition(reasons, [](const std::string& reason) {
    return of_a_limit(reason);  // the reasons for rejection come first
  });
  const std::string out(verdict.status);
  return reasons.empty() ? out : out + ": " + in_words(joined(reasons));
}

std::optional<Problem> refuse_to_cut(const Verdict& verdict, const FormatName& format,
                                     const FormatOptions& options) {
  const std::string comparison(info(WarningCode::comparison_only).code);
  if (format.machine && std::ranges::find(verdict.codes, comparison) != verdict.codes.end())
    return Problem{.code = ErrorCode::comparison_only,
                   .detail = "a machine would run a file of format " + std::string(format.name),
                   .issues = {}};
  if (!options.torch || format.is_bundle()) return std::nullopt;  // each part separately
  if (verdict.status == "reject") {
    Problem out{.code = ErrorCode::rejected,
                .detail = "The verdict is reject: " + joined(each_once(verdict.reasons)),
                .issues = {}};
    for (const auto& [name, value, limit] : verdict.excess)
      out.issues.push_back(
          {.code = ErrorCode::rejected,
           .pointer = "/accept/" + std::string(name),
           .got = Json{value},
           .limit = Json{limit},
           .unit = std::string(unit_of(name)),
           .hint = is_least(name) ? "the answer is below the limit that the request accepts"
                                  : "the answer is above the limit that the request accepts"});
    return out;
  }
  const auto missing = without(verdict.codes, options.acknowledged);
  const auto unknown = without(options.acknowledged, verdict.codes);
  if (missing.empty() && unknown.empty()) return std::nullopt;
  std::string detail = "The verdict is " + std::string(verdict.status);
  if (!missing.empty()) detail += "; not acknowledged: " + joined(missing);
  if (!unknown.empty())
    detail += "; acknowledged, but no warning of this answer: " + joined(unknown);
  return Problem{
      .code = ErrorCode::not_acknowledged,
      .detail = std::move(detail),
      .issues = {{.code = ErrorCode::not_acknowledged,
                  .pointer = "?acknowledge",
                  .got = Json{listed(options.acknowledged)},
                  .limit = Json{listed(verdict.codes)},
                  .hint = verdict.codes.empty() ? "omit it: there is nothing to acknowledge"
                                                : "check each warning, then add acknowledge=" +
                                                      listed(verdict.codes)}}};
}

std::string verdict_header(const Verdict& verdict) {
  std::string out(verdict.status);
  if (!verdict.reasons.empty()) out += ";reasons=\"" + joined(each_once(verdict.reasons)) + "\"";
  return out;
}

}  // namespace tubecut::api
