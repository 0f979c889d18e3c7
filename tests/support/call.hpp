#pragma once

#include <string>
#include <string_view>

#include "api/api.hpp"
#include "api/wire/json.hpp"
#include "api/wire/writer.hpp"
#include "tests/support/golden.hpp"

namespace tubecut::testing {

struct Posted {
  api::Outcome outcome;
  api::Json body;  // parsed when the answer is JSON
};

/// Posts a body through the api layer, as the server would.
inline Posted post(std::string_view path, std::string_view body, std::string_view query = {},
                   std::string_view accept = {}) {
  const api::Call call{.method = "POST",
                       .path = path,
                       .query = query,
                       .accept = accept,
                       .content_type = "application/json",
                       .body = body,
                       .job_id = {},
                       .request_id = "test"};
  const api::Context context{.clock = {},
                             .status = [](ErrorKind kind) { return 400 + static_cast<int>(kind); }};
  Posted out{api::dispatch(call, context), {}};
  if (auto parsed = api::parse(out.outcome.body)) out.body = *std::move(parsed);
  return out;
}

inline Posted post(std::string_view path, const api::Json& body) {
  return post(path, std::string_view(api::dump(body)));
}

/// A copy of `json` with the member at `path` ("a/b/0") replaced; made when it is absent.
inline api::Json with(api::Json json, std::string_view path, api::Json value) {
  api::Json* here = &json;
  while (true) {
    const auto slash = path.find('/');
    const std::string step(path.substr(0, slash));
    api::Json* next = nullptr;
    if (auto* array = here->as<api::Json::Array>()) {
      next = &array->at(std::stoul(step));
    } else {
      if (*here == api::Json{}) *here = api::Json::Object{};
      auto& object = *here->as<api::Json::Object>();
      for (auto& [name, member] : object)
        if (name == step) next = &member;
      if (next == nullptr) {
        object.emplace_back(step, api::Json{});
        next = &object.back().second;
      }
    }
    if (slash == std::string_view::npos) {
      *next = std::move(value);
      return json;
    }
    here = next;
    path = path.substr(slash + 1);
  }
}

/// A copy without the member at `path`.
inline api::Json without(api::Json json, std::string_view path) {
  const auto slash = path.rfind('/');
  api::Json* here = &json;
  if (slash != std::string_view::npos)
    here = const_cast<api::Json*>(&at(json, path.substr(0, slash)));
  const auto name = slash == std::string_view::npos ? path : path.substr(slash + 1);
  std::erase_if(*here->as<api::Json::Object>(), [&](const auto& m) { return m.first == name; });
  return json;
}

/// The error of an answer at a pointer; nullptr if there is none.
inline const api::Json* error_at(const Posted& answer, std::string_view pointer) {
  const auto* errors = answer.body.find("errors");
  if (errors == nullptr) return nullptr;
  for (const auto& one : *errors->as<api::Json::Array>())
    if (text(one, "pointer") == pointer) return &one;
  return nullptr;
}

/// The request is refused at the pointer with the code, the value and the limit or a hint.
inline void expect_refused(std::string_view path, const api::Json& request,
                           std::string_view pointer, std::string_view code) {
  const auto answer = post(path, request);
  ASSERT_TRUE(answer.outcome.error) << pointer;
  const auto* one = error_at(answer, pointer);
  ASSERT_NE(one, nullptr) << pointer << " " << answer.outcome.body.substr(0, 800);
  EXPECT_EQ(text(*one, "code"), code);
  EXPECT_NE(one->find("got"), nullptr) << pointer;
  EXPECT_TRUE(one->find("limit") != nullptr || one->find("hint") != nullptr) << pointer;
}

inline api::Json example(std::string_view file) {
  return *api::parse(read_project_file("examples/" + std::string(file)));
}

}  // namespace tubecut::testing
