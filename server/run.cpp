#include <fmt/format.h>

#include <cstdio>
#include <fstream>
#include <iostream>
#include <iterator>
#include <optional>
#include <string>

#include "api/api.hpp"
#include "server/app.hpp"
#include "server/identity.hpp"
#include "server/serve.hpp"
#include "server/status.hpp"

namespace tubecut::server {
namespace {

std::optional<std::string> contents(const std::string& file) {
  using Bytes = std::istreambuf_iterator<char>;
  if (file == "-") return std::string(Bytes(std::cin), {});
  std::ifstream in(file, std::ios::binary);
  if (!in) return std::nullopt;
  return std::string(Bytes(in), {});
}

}  // namespace

int run(const Command& command) {
  const auto body = contents(command.file);
  if (!body) {
    fmt::print(stderr, "tubecut-server: cannot read {}\n", command.file);
    return 2;
  }
  const std::string path = "/v1/" + command.endpoint;
  const std::string id = random_id();
  const auto outcome = api::dispatch({.method = "POST",
                                      .path = path,
                                      .query = {},
                                      .accept = "application/json",
                                      .content_type = "application/json",
                                      .body = *body,
                                      .job_id = {},
                                      .request_id = id},
                                     {.stop = {}, .clock = steady_seconds, .status = status_of});
  std::fwrite(outcome.body.data(), 1, outcome.body.size(), stdout);
  return outcome.error ? 1 : 0;
}

}  // namespace tubecut::server
