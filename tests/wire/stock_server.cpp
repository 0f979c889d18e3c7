// What the wire suite prevents: the same paths on cpp-httplib as it comes, with nothing of ours
// before it. Prints the ready line of the service, so that the runners start either.

#include <httplib.h>

#include <cstdio>

int main() {
  httplib::Server server;
  server.set_payload_max_length(1u << 20);
  const auto answer = [](const httplib::Request&, httplib::Response& out) {
    out.set_content("{}", "application/json");
  };
  server.Get("/v1/version", answer);
  server.Get("/readyz", answer);
  server.Post("/v1/intersections", answer);
  const int port = server.bind_to_any_port("127.0.0.1");
  std::printf("{\"event\":\"ready\",\"port\":%d,\"admin_port\":%d,\"version\":\"stock\"}\n", port,
              port);
  std::fflush(stdout);
  return server.listen_after_bind() ? 0 : 1;
}
