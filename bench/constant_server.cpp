// Answers every request with the bytes of one file, on the transport of the service:
// `constant-server FILE [PORT]`. Its first line on stdout names the port. Its throughput, compared
// with the service's, gives the fraction of HTTP in a job.

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "server/http/transport.hpp"

int main(int argc, char** argv) {
  namespace server = tubecut::server;
  std::ifstream file(argc > 1 ? argv[1] : "", std::ios::binary);
  if (!file) {
    fmt::print(stderr, "usage: constant-server FILE [PORT]\n");
    return 2;
  }
  const std::string body{std::istreambuf_iterator<char>(file), {}};
  server::TransportOptions options;
  options.port = argc > 2 ? std::atoi(argv[2]) : 0;
  auto transport = server::Transport::open(
      options, {.handle =
                    [&body](const server::Request&) {
                      return server::Response{.status = 200,
                                              .content_type = "application/json; charset=utf-8",
                                              .headers = {},
                                              .body = body};
                    },
                .screen = [](const server::Request&) { return std::optional<server::Refusal>{}; },
                .max_body = [](std::string_view) { return std::size_t{1} << 20; }});
  if (!transport) {
    fmt::print(stderr, "{}\n", transport.error());
    return 1;
  }
  fmt::print("{{\"event\":\"ready\",\"port\":{}}}\n", transport->port());
  std::fflush(stdout);
  return transport->serve() ? 0 : 1;
}
