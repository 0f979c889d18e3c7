#include <algorithm>
#include <functional>

#include "api/api.hpp"
#include "api/batch.hpp"
#include "api/catalog/catalogue.hpp"
#include "api/endpoint.hpp"
#include "api/limits.hpp"
#include "api/wire/answer_text.hpp"
#include "api/wire/common_fields.hpp"
#include "api/wire/file_name.hpp"
#include "api/wire/format_choice.hpp"
#include "api/wire/json_number.hpp"
#include "api/wire/query.hpp"
#include "core/base/stop.hpp"

namespace tubecut::api {
namespace {

constexpr std::string_view kProblemMedia = "application/problem+json";

std::string got_type(const std::string& media) { return "got \"" + media + "\", accepted: "; }

/// One answer or problem, with the data to print it.
class CallRun {
 public:
  CallRun(const Call& call, const Context& context) : call_(call), context_(context) {
    lap();
    begun_ = mark_;
  }

  Outcome refuse(const Problem& problem, std::string allow = {}) {
    const StopScope written(std::stop_token{});  // because a cancelled job is answered too
    const auto kind = info(problem.code).kind;
    out_.error = kind;
    out_.content_type = kProblemMedia;
    out_.job.error_code = info(problem.code).code;
    if (out_.job.input_sha256.empty() && !out_.job.endpoint.empty() && !call_.body.empty())
      out_.job.body_sha256 = sha256(call_.body);
    const int status = context_.status != nullptr ? context_.status(kind) : 0;
    out_.body = print(problem, call_.request_id, status);
    if (!allow.empty()) out_.headers.emplace_back("Allow", std::move(allow));
    return std::move(out_);
  }
  Outcome refuse(ErrorCode code, std::string detail = {}) {
    return refuse(Problem{.code = code, .detail = std::move(detail), .issues = {}});
  }
  Outcome page(const Page& page, const Context& context) {
    out_.content_type = page.content_type;
    out_.body = page.print(context);
    return std::move(out_);
  }
  Outcome compute(const Endpoint& endpoint);

 private:
  Outcome work(const Endpoint& endpoint);
  Outcome answer(const Endpoint& endpoint, const CommonFields& common, Answer answer,
                 const FormatChoice& choice, const Query& query);
  void judged(const Answer& answer) {
    out_.job.verdict = answer.verdict.status;
    out_.job.reasons = answer.verdict.reasons;
    for (const auto& warning : answer.warnings)
      out_.job.warnings.emplace_back(info(warning.code).code);
  }
  void lap(std::string_view stage = {}) {
    if (!context_.clock) return;
    const double now = context_.clock();
    if (!stage.empty()) out_.job.stages.push_back({stage, now - mark_});
    mark_ = now;
  }

  const Call& call_;
  const Context& context_;
  Outcome out_;
  double begun_ = 0.0;
  double mark_ = 0.0;
};

Outcome CallRun::compute(const Endpoint& endpoint) {
  try {
    return work(endpoint);
  } catch (const Stopped&) {
    out_ = {.error = {},
            .content_type = {},
            .body = {},
            .headers = {},
            .job = {.endpoint = std::string(endpoint.id),
                    .input_sha256 = std::move(out_.job.input_sha256),
                    .reference = std::move(out_.job.reference),
                    .stages = std::move(out_.job.stages)}};
    return refuse(ErrorCode::over_budget);
  }
}

Outcome CallRun::work(const Endpoint& endpoint) {
  out_.job.endpoint = endpoint.id;
  auto asked = parse_query(call_.query);
  if (!asked.issues.empty()) return refuse(query_problem(std::move(asked.issues)));
  const auto& query = asked.query;
  const auto media = media_of(call_.content_type);
  if (media != kJsonMedia)
    return refuse(ErrorCode::unsupported_media_type, got_type(media) + std::string(kJsonMedia));
  const auto choice = choose_format(query, call_.accept, endpoint);
  if (!choice) return refuse(choice.error());
  if (call_.body.size() > endpoint.max_body)
    return refuse(ErrorCode::body_too_large,
                  "the limit is " + std::to_string(endpoint.max_body) + " bytes");
  auto body = parse(call_.body, {.depth = static_cast<std::size_t>(limit::nesting_max)});
  lap("parse");
  if (!body)
    if (auto issue = number_issue(call_.body)) return refuse(field_problem({*std::move(issue)}));
  if (!body)
    return refuse(ErrorCode::unreadable_json,
                  body.error().reason + " at byte " + std::to_string(body.error().offset));
  Reader in(*body);
  in.set_binary(choice->encoding == Encoding::cbor);
  const auto common = read_common_fields(in, endpoint.accepts);
  out_.job.reference = common.reference;  // a refused job is looked for by its order too
  if (common.numerics && *common.numerics != numerics())
    return refuse(Problem{
        .code = ErrorCode::numerics_mismatch,
        .detail = "/numerics: this engine's numerics version is " + std::to_string(numerics()),
        .issues = {{.code = ErrorCode::numerics_mismatch,
                    .pointer = "/numerics",
                    .got = Json{static_cast<double>(*common.numerics)},
                    .limit = Json{static_cast<double>(numerics())},
                    .unit = {},
                    .hint = {}}}});
  Run run{
      .encoding = choice->encoding,
      .format = choice->format,
      .caption = {.reference = common.reference,
                  .input_sha256 = {},
                  .result_sha256 = {},
                  .view = std::string(query.view),
                  .options = query.options},
      .accepted = common.accept,
      .stage = [this](std::string_view stage) { lap(stage); },
      .understood = [this](std::string_view input_sha256) { out_.job.input_sha256 = input_sha256; },
      .judged = [this](const Answer& answer) { judged(answer); },
      .forget_body = [&body] { *body = Json{}; },
      .parallel_for = context_.parallel_for};
  const bool begins = choice->by_lines && !query.validate_only;
  auto reply = begins ? endpoint.begin(in, run) : endpoint.handle(in, run);
  if (auto* problem = std::get_if<Problem>(&reply)) {
    return problem->code == ErrorCode::cancelled ? refuse(ErrorCode::over_budget)
                                                 : refuse(*problem);
  }
  return answer(endpoint, common, std::move(std::get<Answer>(reply)), *choice, query);
}

/// Writes the events until now, in time since the request's first byte.
void write_events(Writer& w, const Context& context, double begun,
                  const std::vector<Stage>& stages) {
  double at = context.clock && context.received > 0.0 ? begun - context.received : 0.0;
  std::vector<std::pair<std::string_view, double>> events = {{"received", 0.0}, {"started", at}};
  for (const auto& stage : stages) events.emplace_back(event_of(stage.name), at += stage.seconds);
  w.array("log", events, [](Writer& each, const auto& event) {
    each.object([&](Writer& o) {
      o.field("event", event.first);
      o.field("at_ms", event.second * 1e3);
    });
  });
}

Outcome CallRun::answer(const Endpoint& endpoint, const CommonFields& common, Answer answer,
                        const FormatChoice& choice, const Query& query) {
  auto& job = out_.job;
  job.input_sha256 = answer.input_sha256;
  job.id = call_.job_id.empty() ? own_job_id(answer) : call_.job_id;
  const auto& verdict = answer.verdict;
  if (answer.lines.empty())  // else it is that of its lines too
    out_.headers.emplace_back(kVerdictHeader, verdict_header(verdict));
  job.result_sha256 = answer.result_sha256;
  out_.headers.emplace_back("Tubecut-Input-Sha256", job.input_sha256);
  out_.headers.emplace_back("Tubecut-Result-Sha256", job.result_sha256);
  if (choice.format != nullptr && !query.validate_only) {
    const auto file = program_file(*choice.format, query.options, endpoint.id, common.reference,
                                   job.input_sha256);
    out_.content_type = file.media;
    if (!file.name.empty())
      out_.headers.emplace_back("Content-Disposition",
                                "attachment; filename=\"" + file.name + "\"");
    out_.body = std::move(answer.text);
    return std::move(out_);
  }
  Json& echo = answer.request;
  auto& members = *echo.as<Json::Object>();
  if (!common.reference.empty()) members.emplace_back("reference", common.reference_echo);
  if (common.inline_log) members.emplace_back("log", Json{"inline"});
  const bool cbor = choice.encoding == Encoding::cbor;
  Writer out(answer.result.size() + call_.body.size() + 4096, choice.encoding);
  out.object([&](Writer& w) {
    write_head(w, endpoint.id, job.id, answer, echo);
    if (!query.validate_only) {
      w.raw("result", answer.result);
      if (answer.beside) answer.beside(w);
    }
    write_judgement(w, answer, echo);
    if (common.inline_log) write_events(w, context_, begun_, job.stages);
  });
  out_.content_type = cbor ? kCborMedia : kJsonMedia;
  out_.body = out.take();
  if (answer.lines.empty()) return std::move(out_);
  out_.content_type = kLinesMedia;
  out_.body += '\n';
  out_.lines = std::move(answer.lines);
  return std::move(out_);
}

}  // namespace

Outcome dispatch(const Call& call, const Context& context) {
  CallRun job(call, context);
  for (const auto& endpoint : endpoints()) {
    if (endpoint.path != call.path) continue;
    if (call.method != "POST")
      return job.refuse(Problem{.code = ErrorCode::method_not_allowed, .detail = {}, .issues = {}},
                        "POST");
    return job.compute(endpoint);
  }
  if (call.path == kBatchesPath)
    return call.method == "POST"
               ? job.refuse(ErrorCode::unsupported_media_type,
                            got_type(media_of(call.content_type)) + "application/x-ndjson")
               : job.refuse(
                     Problem{.code = ErrorCode::method_not_allowed, .detail = {}, .issues = {}},
                     "POST");
  const auto* page = find_page(call.path);
  if (page == nullptr) return job.refuse(ErrorCode::not_found);
  if (call.method != "GET" && call.method != "HEAD")
    return job.refuse(Problem{.code = ErrorCode::method_not_allowed, .detail = {}, .issues = {}},
                      "GET, HEAD");
  if (auto issues = refuse_parameters(call.query); !issues.empty())
    return job.refuse(query_problem(std::move(issues)));
  return job.page(*page, context);
}

Outcome problem(ErrorCode code, std::string_view detail, std::string_view request_id,
                const Context& context, std::string_view pointer) {
  const Call call{.method = {},
                  .path = {},
                  .query = {},
                  .accept = {},
                  .content_type = {},
                  .body = {},
                  .job_id = {},
                  .request_id = std::string(request_id)};
  Problem out{.code = code, .detail = std::string(detail), .issues = {}};
  if (!pointer.empty())
    out.issues = {{.code = code, .pointer = std::string(pointer), .hint = out.detail}};
  return CallRun(call, context).refuse(out);
}

std::string_view event_of(std::string_view stage) {
  static constexpr std::pair<std::string_view, std::string_view> kEvents[] = {
      {"parse", "decoded"},
      {"decode", "validated"},
      {"compute", "computed"},
      {"verify", "verified"},
      {"encode", "encoded"}};
  for (const auto& [name, event] : kEvents)
    if (name == stage) return event;
  return stage;
}

std::string job_line(const Caption& caption) {
  std::string out =
      "tubecut " + std::string(version()) + ", input " + caption.input_sha256.substr(0, 16);
  for (const auto& [name, text] : caption.reference) out += ", " + name + " " + text;
  return out;
}

}  // namespace tubecut::api
