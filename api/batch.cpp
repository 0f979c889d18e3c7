#include "api/batch.hpp"

#include <openssl/evp.h>

#include <algorithm>
#include <utility>

#include "api/catalog/post.hpp"
#include "api/endpoint.hpp"
#include "api/limits.hpp"
#include "api/wire/json.hpp"
#include "api/wire/json_number.hpp"
#include "api/wire/problem.hpp"
#include "api/wire/reader.hpp"
#include "api/wire/shown_text.hpp"
#include "api/wire/text_encoding.hpp"
#include "api/wire/writer.hpp"

namespace tubecut::api {
namespace {

constexpr std::size_t kLongestId = 256;  // any text of a request, of 64 characters

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
  if (text != nullptr && text->size() <= kLongestId && shows_something(*text)) return *text;
  in.issue({.code = field == nullptr  ? ErrorCode::missing_field
                    : text == nullptr ? ErrorCode::wrong_type
                                      : ErrorCode::bad_text,
            .pointer = "id",
            .limit = Json{static_cast<double>(kLongestId)},
            .hint = "a text of 1 to that many bytes with a visible character"},
           field);
  return {};
}

/// Reads the endpoint's path; empty if there is an issue.
std::string read_endpoint(Reader& in) {
  const auto list = one_of(endpoints(), &Endpoint::id);
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

/// Reads the body unchanged, because its endpoint checks its content.
std::string read_body(Reader& in) {
  in.note("body");
  const Json* body = in.find("body");
  if (body == nullptr) {
    in.issue({.code = ErrorCode::missing_field, .pointer = "body"});
    return {};
  }
  return dump(*body);
}

/// Returns a number as printed, a text unchanged, true and false; nothing for other types.
std::optional<std::string> option_text(const Json& value) {
  if (const auto* text = value.as<std::string>()) return *text;
  if (value.as<double>() != nullptr || value.as<bool>() != nullptr) return dump(value);
  return std::nullopt;
}

/// Reads `format` and `options`; the endpoint checks their values.
std::string read_query(Reader& in) {
  const auto format = in.optional_text("format").value_or("");
  std::vector<std::pair<std::string, std::string>> options;
  in.note("options");
  if (const Json* given = in.find("options")) {
    const auto* members = given->as<Json::Object>();
    if (members == nullptr)
      in.issue({.code = ErrorCode::wrong_type,
                .pointer = "options",
                .hint = "an object of the format's options is required"},
               given);
    for (const auto& [name, value] : members != nullptr ? *members : Json::Object{}) {
      if (auto text = option_text(value))
        options.emplace_back(name, *std::move(text));
      else
        in.issue({.code = ErrorCode::wrong_type,
                  .pointer = "options/" + name,
                  .hint = "a number, a text, true or false is required"},
                 &value);
    }
  }
  return format_query(format, options);
}

std::string escaped(std::string_view text) {
  static constexpr char kHex[] = "0123456789ABCDEF";
  std::string out;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
                       std::string_view("-._~").find(c) != std::string_view::npos;
    if (plain)
      out += c;
    else
      (out += '%').append({kHex[byte >> 4U], kHex[byte & 15U]});
  }
  return out;
}

std::string base64(std::string_view bytes) {
  std::string out((bytes.size() + 2) / 3 * 4, '\0');
  EVP_EncodeBlock(reinterpret_cast<unsigned char*>(out.data()),
                  reinterpret_cast<const unsigned char*>(bytes.data()),
                  static_cast<int>(bytes.size()));
  return out;
}

void read_line(BatchLine& out, std::string_view text, std::string_view request_id,
               const Context& context) {
  // One deeper than a body may be.
  const auto json = parse(text, {.depth = static_cast<std::size_t>(limit::nesting_max) + 1});
  if (!json) {
    if (auto issue = number_issue(text)) {
      refuse(out, field_problem({*std::move(issue)}), request_id, context);
      return;
    }
    refuse(out,
           {.code = ErrorCode::unreadable_json,
            .detail = json.error().reason + " at byte " + std::to_string(json.error().offset) +
                      " of the line"},
           request_id, context);
    return;
  }
  Reader in(*json);
  out.id = read_id(in);
  out.path = read_endpoint(in);
  out.query = read_query(in);
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

std::string format_query(std::string_view format,
                         const std::vector<std::pair<std::string, std::string>>& options) {
  std::string out = format.empty() ? "" : "format=" + escaped(format);
  for (const auto& [name, value] : options)
    out += (out.empty() ? "" : "&") + escaped(name) + "=" + escaped(value);
  return out;
}

std::string print_batch_line(const BatchLine& line, std::size_t number, const BatchAnswer& answer) {
  auto content = answer.content;
  // A program that is JSON is a document, not an answer.
  const bool json = answer.media.find("json") != std::string_view::npos &&
                    !answer.media.starts_with(kPointPairsMedia);
  while (json && content.ends_with('\n')) content.remove_suffix(1);
  Writer out(content.size() + line.id.size() + 64);
  out.object([&](Writer& w) {
    w.field("id", line.id.empty() ? Json{} : Json{line.id});
    w.field("line", static_cast<double>(number));
    w.field("status", answer.status);
    if (!answer.verdict.empty())
      w.field("verdict", answer.verdict.substr(0, answer.verdict.find(';')));
    if (json) return w.raw("body", content);
    w.field("media", answer.media);
    if (is_utf8(content))
      w.field("document", content);
    else
      w.field("document_base64", base64(content));
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
