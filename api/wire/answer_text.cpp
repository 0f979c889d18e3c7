#include "api/wire/answer_text.hpp"

#include "api/api.hpp"

namespace tubecut::api {
namespace {

void write_checks(Writer& w, const std::vector<Check>& checks) {
  w.object("verification", [&](Writer& v) {
    v.field("passed", true);  // a check that fails never gets here
    v.array("checks", checks, [](Writer& each, const Check& check) {
      each.object([&](Writer& o) {
        o.field("name", check.name);
        o.field("value", check.value);
        o.field("limit", check.limit);
        o.field("unit", check.unit);
      });
    });
  });
}

}  // namespace

std::string own_job_id(const Answer& answer) { return answer.input_sha256.substr(0, 16); }

void write_head(Writer& w, std::string_view endpoint, std::string_view job_id, const Answer& answer,
                const Json& echo) {
  w.object("job", [&](Writer& o) {
    o.field("id", job_id);
    o.field("endpoint", endpoint);
    o.field("engine", engine());
    o.field("numerics", numerics());
    o.field("input_sha256", answer.input_sha256);
    o.field("result_sha256", answer.result_sha256);
  });
  w.field("request", echo);
}

void write_judgement(Writer& w, const Answer& answer, const Json& echo) {
  write_checks(w, answer.checks);
  w.object("verdict", [&](Writer& o) {
    o.field("status", answer.verdict.status);
    o.column("reasons", answer.verdict.reasons);
  });
  write_warnings(w, answer.warnings,
                 [&](const std::string& member) { return pointer_of(member, echo); });
}

}  // namespace tubecut::api
