// Figures for the decision in docs/adr/0001: framing a request, and printing an answer by
// cpp-httplib or by hand.

#include <benchmark/benchmark.h>
#include <httplib.h>

#include <string>

#include "server/http/request_reader.hpp"

namespace {

using tubecut::server::RequestReader;

std::string request(bool chunked) {
  const std::string head =
      "POST /v1/bevel-tables HTTP/1.1\r\nHost: localhost:8080\r\nUser-Agent: "
      "curl/7.88.1\r\nAccept: "
      "application/json\r\nContent-Type: application/json\r\nJob-Id: order-17\r\n";
  const std::string body(1000, ' ');
  return chunked ? head + "Transfer-Encoding: chunked\r\n\r\n3e8\r\n" + body + "\r\n0\r\n\r\n"
                 : head + "Content-Length: 1000\r\n\r\n" + body;
}

void frame(benchmark::State& state) {
  const auto bytes = request(state.range(0) != 0);
  for (auto _ : state) {
    RequestReader reader;
    auto taken = reader.take(bytes);
    reader.allow_body(1u << 20);
    taken += reader.take(std::string_view(bytes).substr(taken));
    if (reader.state() != RequestReader::State::whole || taken != bytes.size()) std::abort();
  }
}
BENCHMARK(frame)->ArgName("chunked")->Arg(0)->Arg(1);

class Memory final : public httplib::Stream {
 public:
  explicit Memory(std::string_view in) : in_(in) {}
  bool is_readable() const override { return true; }
  bool is_writable() const override { return true; }
  ssize_t read(char* to, std::size_t size) override {
    const auto n = in_.copy(to, size);
    in_.remove_prefix(n);
    return static_cast<ssize_t>(n);
  }
  ssize_t write(const char* bytes, std::size_t size) override {
    out_.append(bytes, size);
    return static_cast<ssize_t>(size);
  }
  void get_remote_ip_and_port(std::string&, int&) const override {}
  void get_local_ip_and_port(std::string&, int&) const override {}
  socket_t socket() const override { return INVALID_SOCKET; }

 private:
  std::string_view in_;
  std::string out_;
};

struct Library : httplib::Server {
  void run(std::string_view in) {
    Memory stream(in);
    bool closed = false;
    process_request(stream, false, closed, [](httplib::Request&) {});
  }
};

void fill(httplib::Response& out, const std::string& body) {
  out.status = 200;
  out.body = body;
  out.set_header("Content-Type", "application/json; charset=utf-8");
  for (int i = 0; i < 6; ++i) out.set_header("X-" + std::to_string(i), "0123456789abcdef");
}

void library_prints(benchmark::State& state) {
  Library library;
  const std::string body(static_cast<std::size_t>(state.range(0)), '1');
  library.set_pre_routing_handler([&](const httplib::Request&, httplib::Response& out) {
    fill(out, body);
    return httplib::Server::HandlerResponse::Handled;
  });
  for (auto _ : state) library.run("GET / HTTP/1.1\r\n\r\n");
}
BENCHMARK(library_prints)->Arg(200)->Arg(33000);

void library_does_all(benchmark::State& state) {
  Library library;
  const std::string body(200, '1');
  library.Post("/v1/bevel-tables",
               [&](const httplib::Request&, httplib::Response& out) { fill(out, body); });
  const auto bytes = request(false);
  for (auto _ : state) library.run(bytes);
}
BENCHMARK(library_does_all);

void by_hand(benchmark::State& state) {
  const std::string body(static_cast<std::size_t>(state.range(0)), '1');
  for (auto _ : state) {
    std::string out = "HTTP/1.1 200 OK\r\nContent-Length: " + std::to_string(body.size()) + "\r\n";
    for (int i = 0; i < 7; ++i) out += "X-" + std::to_string(i) + ": 0123456789abcdef\r\n";
    out += "\r\n";
    out += body;
    benchmark::DoNotOptimize(out);
  }
}
BENCHMARK(by_hand)->Arg(200)->Arg(33000);

}  // namespace

BENCHMARK_MAIN();
