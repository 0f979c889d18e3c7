#include "api/wire/problem.hpp"

#include <algorithm>
#include <cmath>

#include "api/stop.hpp"
#include "api/suspicion.hpp"
#include "api/wire/warning_names.hpp"
#include "api/wire/writer.hpp"
#include "core/base/angle.hpp"

namespace tubecut::api {
namespace {

Json shown(const Shown& shown) {
  if (const auto* d = std::get_if<double>(&shown))
    return std::isfinite(*d) ? Json{*d} : Json{"not a finite number"};
  if (const auto* s = std::get_if<std::string>(&shown)) return Json{*s};
  if (const auto* intervals = std::get_if<Intervals>(&shown)) {
    Json::Array list;
    for (const auto& [from, to] : *intervals)
      list.push_back(Json{Json::Array{Json{from}, Json{to}}});
    return Json{std::move(list)};
  }
  return Json{};
}

/// The member's name on the wire: itself, or itself with a unit.
const Json::Member* wire_member(const Json::Object& object, std::string_view name) {
  for (const auto& member : object)
    if (member.first == name) return &member;
  for (const auto& member : object) {
    const auto unit = unit_of(member.first);
    if (!unit.empty() && member.first.size() == name.size() + 1 + unit.size() &&
        member.first.starts_with(name))
      return &member;
  }
  return nullptr;
}

bool holds_members(const Json& json) {
  return json.as<Json::Object>() != nullptr || json.as<Json::Array>() != nullptr;
}

/// Returns the first issue in words: the field, the error, and a valid value.
std::string sentence(const std::vector<FieldIssue>& issues) {
  const auto& first = issues.front();
  std::string out = (first.pointer.empty() ? "the request" : first.pointer) + ": ";
  out += info(first.code).meaning;
  if (!first.hint.empty()) {
    out.back() = ';';
    out += " " + first.hint;
  }
  if (issues.size() > 1) out += " (and " + std::to_string(issues.size() - 1) + " more)";
  return out;
}

/// Converts to the unit of the field, with the digits that a client sends, because core reports
/// angles in degrees.
FieldIssue in_own_unit(FieldIssue issue) {
  if (issue.unit != "deg" || unit_of(issue.pointer) != "rad") return issue;
  constexpr double kDigits = 1e12;
  for (auto* value : {&issue.got, &issue.limit})
    if (const auto* deg = value->as<double>())
      *value = Json{std::round(*deg * kRadPerDeg * kDigits) / kDigits};
  issue.unit = "rad";
  return issue;
}

}  // namespace

bool retryable(ErrorKind kind) {
  return kind == ErrorKind::overloaded || kind == ErrorKind::unavailable;
}

std::string pointer_of(std::string_view member, const Json& request) {
  std::string pointer;
  const Json* here = &request;
  while (!member.empty()) {
    const auto slash = member.find('/');
    const auto step = member.substr(0, slash);
    member = slash == std::string_view::npos ? std::string_view{} : member.substr(slash + 1);
    const Json* next = nullptr;
    std::string name(step);
    if (const auto* object = here->as<Json::Object>()) {
      if (const auto* found = wire_member(*object, step)) {
        name = found->first;
        next = &found->second;
      }
    } else if (const auto* array = here->as<Json::Array>()) {
      std::size_t index = 0;
      for (const char c : step) index = index * 10 + static_cast<std::size_t>(c - '0');
      if (index < array->size()) next = &(*array)[index];
    }
    pointer += "/" + name;
    if (next == nullptr || !holds_members(*next)) break;  // a missing value has no members
    here = next;
  }
  return pointer;
}

FieldIssue field_issue(Issue issue, std::string pointer) {
  return {.code = issue.code,
          .pointer = std::move(pointer),
          .got = shown(issue.got),
          .limit = shown(issue.limit),
          .unit = std::move(issue.unit),
          .hint = std::move(issue.hint)};
}

Problem field_problem(std::vector<FieldIssue> issues) {
  Problem out{.code = ErrorCode::invalid_request, .detail = {}, .issues = std::move(issues)};
  const auto& first = out.issues.front();
  const bool alike = std::all_of(out.issues.begin(), out.issues.end(),
                                 [&](const FieldIssue& issue) { return issue.code == first.code; });
  if (alike) out.code = first.code;
  out.detail = sentence(out.issues);
  return out;
}

Problem unspellable_problem(const Unspellable& met, const FormatName& format,
                            const std::vector<std::pair<std::string, std::string>>& reference,
                            const Json& request) {
  std::vector<FieldIssue> issues;
  const auto see = [&](const std::string& text, const std::string& pointer) {
    if (in_ascii(text)) return;
    issues.push_back({.code = ErrorCode::bad_text,
                      .pointer = pointer,
                      .got = Json{text},
                      .hint = std::string(format.name) +
                              " is ASCII and has no spelling for some of its letters; svg, dxf, "
                              "csv and json take them"});
  };
  for (const auto& [name, text] : reference) see(text, "/reference/" + name);
  const auto walk = [&](const auto& self, const Json& json, const std::string& pointer) -> void {
    if (const auto* text = json.as<std::string>()) {
      if (met.text.find(*text) != std::string::npos) see(*text, pointer);
    } else if (const auto* array = json.as<Json::Array>()) {
      for (std::size_t i = 0; i < array->size(); ++i)
        self(self, (*array)[i], pointer + "/" + std::to_string(i));
    } else if (const auto* object = json.as<Json::Object>()) {
      for (const auto& [name, member] : *object) self(self, member, pointer + "/" + name);
    }
  };
  walk(walk, request, "");
  return field_problem(std::move(issues));
}

Problem core_problem(const Error& error, const Json& request) {
  Problem out{.code = error.code(), .detail = {}, .issues = {}};
  for (const auto& issue : error.issues)
    out.issues.push_back(in_own_unit({.code = issue.code,
                                      .pointer = pointer_of(issue.member, request),
                                      .got = shown(issue.got),
                                      .limit = shown(issue.limit),
                                      .unit = issue.unit,
                                      .hint = issue.hint}));
  out.detail = sentence(out.issues);
  return out;
}

std::vector<std::string> filled_in(const Json& body, const Json& request) {
  std::vector<std::string> out;
  Pace pace;
  const auto walk = [&](const auto& self, const Json& given, const Json& understood,
                        const std::string& pointer) -> void {
    if (const auto* object = understood.as<Json::Object>()) {
      for (const Json::Member& entry : *object) {
        const auto& [name, member] = entry;
        if (!holds_members(member)) continue;
        if (const Json* const own = given.find(name))
          self(self, *own, member, pointer + "/" + name);
        else
          out.push_back(pointer + "/" + name);
      }
    } else if (const auto* array = understood.as<Json::Array>()) {
      const auto* const own = given.as<Json::Array>();
      for (std::size_t i = 0; own != nullptr && i < std::min(own->size(), array->size()); ++i) {
        pace.tick();
        if ((*array)[i].as<Json::Object>() != nullptr)
          self(self, (*own)[i], (*array)[i], pointer + "/" + std::to_string(i));
      }
    }
  };
  walk(walk, body, request, "");
  return out;
}

Problem pointing_no_further(Problem problem, const std::vector<std::string>& places) {
  for (auto& issue : problem.issues)
    for (const auto& place : places)
      if (issue.pointer.starts_with(place + "/")) issue.pointer = place;
  problem.detail = sentence(problem.issues);
  return problem;
}

void keep_worst(std::vector<Check>& worst, const std::vector<Check>& checks) {
  for (const auto& check : checks) {
    const auto known = std::ranges::find(worst, check.name, &Check::name);
    if (known == worst.end())
      worst.push_back(check);
    else if (!(check.value * known->limit <= known->value * check.limit))
      *known = check;
  }
}

std::optional<Problem> failed_check(const std::vector<Check>& checks) {
  for (const auto& check : checks)
    if (!check.passed())
      return Problem{.code = ErrorCode::verification_failed,
                     .detail = "check " + check.name + " failed",
                     .issues = {{.code = ErrorCode::verification_failed,
                                 .pointer = "",
                                 .got = Json{check.name},
                                 .limit = Json{check.limit},
                                 .unit = check.unit,
                                 .hint = {}}}};
  return std::nullopt;
}

Problem with_suspicions(Problem problem, const Json& request) {
  problem.suspicions = unit_suspicions(request);
  for (auto& suspicion : problem.suspicions)
    suspicion.member = pointer_of(suspicion.member, request);
  return problem;
}

void write_warnings(Writer& w, const std::vector<Warning>& warnings,
                    const std::function<std::string(const std::string&)>& pointer) {
  w.array("warnings", warnings, [&](Writer& each, const Warning& warning) {
    const auto& about = info(warning.code);
    each.object([&](Writer& o) {
      o.field("code", about.code);
      o.field("severity", name_of(about.severity));
      o.field("pointer", pointer(warning.member));
      o.field("detail", warning.detail.empty() ? std::string(about.meaning) : warning.detail);
      o.field("action", about.action);
    });
  });
}

void write_issues(Writer& w, const std::vector<FieldIssue>& issues) {
  w.array("errors", issues, [](Writer& each, const FieldIssue& issue) {
    each.object([&](Writer& o) {
      o.field("code", info(issue.code).code);
      o.field("pointer", issue.pointer);
      o.field("got", issue.got);
      o.field("limit", issue.limit);
      o.field("unit", issue.unit);
      o.field("hint", issue.hint);
    });
  });
}

std::string print(const Problem& problem, std::string_view request_id, int status) {
  const auto& about = info(problem.code);
  Writer out;
  out.object([&](Writer& w) {
    w.field("type", "/v1/errors#" + std::string(about.code));
    w.field("title", about.meaning);
    w.field("status", status);
    w.field("code", about.code);
    w.field("detail", problem.detail.empty() ? about.meaning : std::string_view(problem.detail));
    w.field("request_id", request_id);
    w.field("retryable", retryable(about.kind));
    w.field("action", about.action);
    write_issues(w, problem.issues);
    if (!problem.suspicions.empty())
      write_warnings(w, problem.suspicions, [](const std::string& pointer) { return pointer; });
  });
  return out.take();
}

}  // namespace tubecut::api
