#pragma once

#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "api/endpoint.hpp"
#include "api/verdict.hpp"
#include "api/wire/problem.hpp"
#include "api/wire/sha256.hpp"
#include "api/wire/text_encoding.hpp"
#include "api/wire/writer.hpp"
#include "api/worked.hpp"

namespace tubecut::api {

/// The formats of an endpoint without their types.
template <class E>
std::span<const FormatName> format_names() {
  static const auto names = [] {
    std::vector<FormatName> list;
    for (const auto& format : E::formats())
      list.push_back({format.name, format.media, format.views, format.options, format.needs_speed,
                      format.machine});
    return list;
  }();
  return names;
}

/// Returns an answer as a document. Reads from `caption` the request's values: reference, view,
/// options and stop. If the part must not be cut, a name cannot be spelled, or an option is not
/// supported, returns a problem.
template <class E>
tl::expected<std::string, Problem> print_document(const typename E::Spec& spec,
                                                  const typename E::Out& out,
                                                  const FormatName& name, Caption caption,
                                                  const Answer& answer) {
  if (auto refused = refuse_to_cut(answer.verdict, name, caption.options))
    return tl::unexpected(*std::move(refused));
  caption.input_sha256 = answer.input_sha256;
  caption.result_sha256 = answer.result_sha256;
  caption.verdict = answer.verdict;
  caption.request = &answer.request;
  try {
    for (const auto& format : E::formats())
      if (format.name == name.name) return format.print(spec, out, caption);
  } catch (const Unspellable& met) {
    return tl::unexpected(unspellable_problem(met, name, caption.reference, answer.request));
  } catch (const UnfitOption& met) {
    return tl::unexpected(field_problem({{.code = ErrorCode::unsupported_combination,
                                          .pointer = "?" + std::string(met.name),
                                          .hint = met.hint}}));
  }
  throw std::logic_error("a format that the endpoint does not have");
}

/// The one pipeline. An endpoint `E` plugs in:
///   using Spec, Out;
///   static Spec decode(Reader&);
///     types, units, ranges
///   static Result<Spec> resolve(Spec);
///     optional: checks of the input that only core can make
///   static Result<Out> compute(const Spec&);  pure core call
///   static std::vector<Check> verify(const Spec&, const Out&);
///     the verification
///     if a job has many pieces, compute, verify and encode take `const ParallelFor&` last
///   static std::vector<Warning> warnings(const Spec&, const Out&);
///   static std::vector<Measure> measure(const Spec&, const Out&);
///   static void encode(const Spec&, const Out&, Writer&);  members of `result`
///   static void encode_beside(const Spec&, const Out&, Writer&);
///     optional: members next to `result`, not covered by its hash
///   static std::string lines(const Spec&);
///     optional: the remaining requests, as lines of a batch
///   static const std::vector<Format<Spec, Out>>& formats();
///   kId, kPath, kMaxBody, kBudgetS, kAccepts, kChecks
template <class E>
Reply run(Reader& in, Run& run) {
  auto made = worked<E>(in, run);
  if (!made) return std::move(made).error();
  auto& answer = made->answer;
  if (run.format == nullptr) {
    Writer writer(1 << 16, run.encoding);
    made->encode(writer, run.parallel_for);
    if (run.encoding == Encoding::json) answer.result_sha256 = writer.sha256();
    answer.result = writer.take();
  }
  if (answer.result_sha256.empty()) answer.result_sha256 = made->hashed(run.parallel_for);
  if (run.format != nullptr) {
    auto text =
        print_document<E>(made->spec, made->out, *run.format, std::move(run.caption), answer);
    if (!text) return std::move(text).error();
    answer.text = *std::move(text);
  }
  run.stage("encode");
  auto reply = std::move(answer);
  if constexpr (requires { E::lines(made->spec); }) reply.lines = E::lines(made->spec);
  if constexpr (requires(Writer & w) { E::encode_beside(made->spec, made->out, w); })
    reply.beside = [kept = std::make_shared<const Worked<E>>(*std::move(made))](Writer& w) {
      E::encode_beside(kept->spec, kept->out, w);
    };
  return reply;
}

template <class E>
Endpoint endpoint() {
  return {.id = E::kId,
          .path = E::kPath,
          .max_body = E::kMaxBody,
          .budget_s = E::kBudgetS,
          .handle = &run<E>,
          .formats = format_names<E>(),
          .accepts = E::kAccepts,
          .checks = E::kChecks};
}

}  // namespace tubecut::api
