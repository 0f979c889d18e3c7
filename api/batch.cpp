#include <algorithm>
#include <utility>

#include "api/api.hpp"
#include "api/endpoint.hpp"
#include "api/json.hpp"
#include "api/limits.hpp"
#include "api/problem.hpp"
#include "api/reader.hpp"
#include "api/writer.hpp"

namespace tubecut::api {
namespace {

constexpr std::size_t kLongestId = 128;

void refuse(BatchLine& line, const Problem& problem, std::string_view request_id,
            const Context& context) {
  line.error = info(problem.code).kind;
  line.code = info(problem.code).code;
  line.problem =
      print(problem, request_id, context.status != nullptr ? context.status(*line.error) : 0);
}

/// Any text: it is the caller's, and only goes back.
std::string read_id(Reader& in) {
  in.note("id");
  const Json* field = in.find("id");
  const auto* text = field != nullptr ? field->as<std::string>() : nullptr;
  if (text != nullptr && !text->empty() && text->size() <= kLongestId) return *text;
  in.issue({.code = field == nullptr  ? ErrorCode::missing_field
                    : text == nullptr ? ErrorCode::wrong_type
                                      : ErrorCode::bad_text,
            .pointer = "id",
            .limit = Json{static_cast<double>(kLongestId)},
            .hint = "a text of 1 to that many bytes"},
           field);
  return {};
}

/// The endpoint's path; empty beside an issue.
std::string read_endpoint(Reader& in) {
  std::string list;
  for (const auto& endpoint : endpoints())
    list += (list.empty() ? "" : "|") + std::string(endpoint.id);
  const auto id = in.text("endpoint");
  const auto found =
      std::ranges::find_if(endpoints(), [&](const Endpoint& e) { return e.id == id; });
  if (found != endpoints().end()) return std::string(found->path);
  if (in.understood("endpoint"))
    in.issue({.code = ErrorCode::bad_choice,
              .pointer = "endpoint",
              .limit = Json{list},
              .hint = "one of " + list},
             in.find("endpoint"));
  return {};
}

/// The body as the endpoint takes it: what is wrong within is the endpoint's to say.
std::string read_body(Reader& in) {
  in.note("body");
  const Json* body = in.find("body");
  if (body == nullptr) {
    in.issue({.code = ErrorCode::missing_field, .pointer = "body"});
    return {};
  }
  return dump(*body, in.stop());
}

void read_line(BatchLine& out, std::string_view text, std::string_view request_id,
               const Context& context) {
  // One deeper than a body may be.
  const auto json = parse(
      text, {.depth = static_cast<std::size_t>(limit::nesting_max) + 1, .stop = context.stop});
  if (!json) {
    refuse(out,
           {.code = ErrorCode::unreadable_json,
            .detail = json.error().reason + " at byte " + std::to_string(json.error().offset) +
                      " of the line"},
           request_id, context);
    return;
  }
  Reader in(*json);
  in.set_stop(context.stop);
  out.id = read_id(in);
  out.path = read_endpoint(in);
  out.body = read_body(in);
  if (auto issues = in.finish_root(); !issues.empty())
    refuse(out, field_problem(std::move(issues)), request_id, context);
}

}  // namespace

BatchLine read_batch_line(std::string_view text, std::string_view request_id,
                          const Context& context) {
  BatchLine out;
  try {
    read_line(out, text, request_id, context);
  } catch (const Stopped&) {
    refuse(out, {.code = ErrorCode::over_budget, .detail = {}, .issues = {}}, request_id, context);
  }
  return out;
}

std::string print_batch_line(const BatchLine& line, std::size_t number, int status,
                             std::string_view answer, std::string_view verdict) {
  while (answer.ends_with('\n')) answer.remove_suffix(1);
  Writer out(answer.size() + line.id.size() + 64);
  out.object([&](Writer& w) {
    w.field("id", line.id.empty() ? Json{} : Json{line.id});
    w.field("line", static_cast<double>(number));
    w.field("status", status);
    if (!verdict.empty()) w.field("verdict", verdict.substr(0, verdict.find(';')));
    w.raw("body", answer);
  });
  return out.take() + "\n";
}

std::string print_batch_summary(const BatchSummary& summary) {
  Writer out;
  out.object([&](Writer& w) {
    w.object("summary", [&](Writer& o) {
      o.field("items", static_cast<double>(summary.items));
      o.field("answered", static_cast<double>(summary.answered));
      o.field("refused", static_cast<double>(summary.refused));
      o.field("unanswered",
              static_cast<double>(summary.items - summary.answered - summary.refused));
    });
  });
  return out.take() + "\n";
}

}  // namespace tubecut::api
