#pragma once

#include <string>
#include <utility>
#include <vector>

#include "api/run.hpp"
#include "api/stop.hpp"
#include "api/suspicion.hpp"
#include "api/verdict.hpp"
#include "api/wire/problem.hpp"
#include "api/wire/sha256.hpp"
#include "api/wire/writer.hpp"
#include "core/base/error.hpp"

namespace tubecut::api {

/// A request of endpoint `E` read, computed, verified and classified, but not encoded yet.
template <class E>
struct Worked {
  typename E::Spec spec;
  typename E::Out out;
  Answer answer;

  void encode(Writer& writer, const ParallelFor& parallel_for) const {
    writer.object([&](Writer& w) {
      if constexpr (requires { E::encode(spec, out, w, parallel_for); })
        E::encode(spec, out, w, parallel_for);
      else
        E::encode(spec, out, w);
    });
  }
  [[nodiscard]] std::string hashed(const ParallelFor& parallel_for) const {
    auto writer = Writer::hashing();
    encode(writer, parallel_for);
    return writer.sha256();
  }
};

template <class E>
Result<typename E::Out> computed(const typename E::Spec& spec, const Run& run) {
  if constexpr (requires { E::compute(spec, run.parallel_for); })
    return E::compute(spec, run.parallel_for);
  else
    return E::compute(spec);
}

/// Returns the checks of a result. Throws Stopped if cancelled, because the verification may be
/// incomplete.
template <class E>
std::vector<Check> prove(const typename E::Spec& spec, const typename E::Out& out, const Run& run) {
  std::vector<Check> checks;
  if constexpr (requires { E::verify(spec, out, run.parallel_for); })
    checks = E::verify(spec, out, run.parallel_for);
  else
    checks = E::verify(spec, out);
  ask();
  return checks;
}

/// Reads, computes, proves and judges.
template <class E>
tl::expected<Worked<E>, Problem> worked(Reader& in, Run& run) {
  auto spec = E::decode(in);
  auto issues = in.finish_root();
  Answer answer{.request = Json{in.take_echo()}};
  const auto suspecting = [&](Problem problem) {
    return tl::unexpected(with_suspicions(std::move(problem), answer.request));
  };
  if (!issues.empty()) return suspecting(field_problem(std::move(issues)));
  const auto places = filled_in(in.body(), answer.request);
  const auto of_core = [&](const Error& error) {
    return suspecting(pointing_no_further(core_problem(error, answer.request), places));
  };
  run.forget_body();
  answer.input_sha256 = sha256(dump(answer.request));
  run.understood(answer.input_sha256);
  run.stage("decode");
  if constexpr (requires { E::resolve(spec); }) {
    auto resolved = E::resolve(std::move(spec));
    if (!resolved) {
      ask();
      return of_core(resolved.error());
    }
    spec = *std::move(resolved);
  }
  ask();
  auto out = computed<E>(spec, run);
  run.stage("compute");
  ask();  // a cancelled result may be incomplete
  if (!out) return of_core(out.error());
  answer.checks = prove<E>(spec, *out, run);
  run.stage("verify");
  if (auto failed = failed_check(answer.checks)) return tl::unexpected(*std::move(failed));
  answer.warnings = E::warnings(spec, *out);
  for (auto& warning : unit_suspicions(answer.request))
    answer.warnings.push_back(std::move(warning));
  answer.measures = E::measure(spec, *out);
  answer.verdict = judge(answer.warnings, answer.request, answer.measures, run.accepted);
  run.judged(answer);
  return Worked<E>{std::move(spec), *std::move(out), std::move(answer)};
}

}  // namespace tubecut::api
