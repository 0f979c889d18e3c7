#include "server/http/transport.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <latch>

#include "server/admin_port.hpp"
#include "server/jobs/job_memory.hpp"
#include "tests/server/client.hpp"

namespace tubecut::server {
namespace {

using namespace std::chrono_literals;
using test::Client;
using test::get;
using test::post;

/// Answers "METHOD target body" and how many letters; a refusal's text with status 400.
Response echo(const Request& request) {
  if (request.refusal)
    return {.status = 400, .content_type = "text/plain", .body = request.refusal->detail};
  return {.status = 200,
          .content_type = "text/plain",
          .headers = {{"X-Peer", request.peer}},
          .body = request.method + " " + request.target + " " + request.body};
}

/// A port with that handler, served until the end of the test.
class Port {
 public:
  explicit Port(std::function<Response(const Request&)> handle = echo,
                const TransportOptions& options = {})
      : Port({.handle = std::move(handle),
              .screen = [](const Request&) { return std::optional<Refusal>{}; },
              .max_body = [](std::string_view) { return std::size_t{1000}; }},
             options) {}
  Port(Service service, const TransportOptions& options)
      : transport_(Transport::open(options, std::move(service)).value()),
        served_(std::async(std::launch::async, [this] { return transport_.serve(); })) {
    while (!transport_.serving()) std::this_thread::sleep_for(1ms);
  }
  ~Port() {
    if (served_.valid()) stop();
  }
  Port(const Port&) = delete;
  Port& operator=(const Port&) = delete;

  [[nodiscard]] int number() const { return transport_.port(); }
  void drain() { transport_.drain(5s); }
  bool join() { return served_.get(); }
  bool stop() {
    drain();
    return join();
  }

 private:
  Transport transport_;
  std::future<bool> served_;
};

std::string one(const Port& port, std::string_view bytes) {
  Client client(port.number());
  client.send(bytes);
  return client.receive().body;
}

TEST(Transport, AnswersOneAfterAnotherOnOneConnection) {
  const Port port;
  Client client(port.number());
  for (int i = 0; i < 20; ++i) {
    client.send(post("/a?b=c%20d", std::to_string(i)));
    EXPECT_EQ(client.receive().body, "POST /a?b=c%20d " + std::to_string(i));
  }
  client.send(get("/x", "REMOTE_ADDR: 6.6.6.6\r\nX-Forwarded-For: 6.6.6.6\r\n"));
  EXPECT_EQ(client.receive().header("X-Peer"), "127.0.0.1");
}

TEST(Transport, AnswersPipelinedRequestsInOrder) {
  const Port port;
  Client client(port.number());
  client.send(post("/1", "one") + get("/2") + post("/3", "three") +
              "POST /4 HTTP/1.1\r\nHost: x\r\n\r\n" + get("/5"));
  for (const auto* body : {"POST /1 one", "GET /2 ", "POST /3 three", "POST /4 ", "GET /5 "}) {
    EXPECT_EQ(client.receive().body, body);
  }
}

TEST(Transport, ReadsChunkedBodies) {
  const Port port;
  Client client(port.number());
  client.send(
      "POST /c HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: "
      "chunked\r\n\r\n3\r\nabc\r\n2\r\nde\r\n0\r\n\r\n");
  EXPECT_EQ(client.receive().body, "POST /c abcde");
  client.send(get("/next"));
  EXPECT_EQ(client.receive().body, "GET /next ");
}

TEST(Transport, SendsTheHeadOnlyToHead) {
  const Port port;
  Client client(port.number());
  client.send("HEAD /h HTTP/1.1\r\nHost: x\r\n\r\n" + get("/g"));
  const auto head = client.receive(true);
  EXPECT_EQ(head.header("Content-Length"), "8");  // "HEAD /h "
  EXPECT_EQ(client.receive().body, "GET /g ");
}

TEST(Transport, NeitherCompressesNorCutsRanges) {
  const Port port;
  Client client(port.number());
  client.send(get("/r", "Accept-Encoding: br, gzip\r\nRange: bytes=0-1,3-4\r\n"));
  const auto answer = client.receive();
  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(answer.body, "GET /r ");
  EXPECT_TRUE(answer.header("Content-Encoding").empty());
}

TEST(Transport, WaitsForExpectContinue) {
  const Port port;
  Client client(port.number());
  client.send("POST /e HTTP/1.1\r\nHost: x\r\nExpect: 100-continue\r\nContent-Length: 2\r\n\r\n");
  EXPECT_EQ(client.receive(true).status, 100);
  client.send("ok");
  EXPECT_EQ(client.receive().body, "POST /e ok");
  client.send(
      "POST /e HTTP/1.1\r\nHost: x\r\nExpect: 100-continue\r\nContent-Length: 2000\r\n\r\n");
  EXPECT_EQ(client.receive().status, 400);
  EXPECT_TRUE(client.at_end());
}

TEST(Transport, RefusesAndClosesUnreadRequests) {
  const Port port;
  const std::string head = "POST /b HTTP/1.1\r\nHost: x\r\n";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {head + "Content-Length: 3\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n", "another length"},
      {head + "Content-Length: 3\r\nContent-Length: 3\r\n\r\nabc", "more than once"},
      {head + "Content-Length: 3\r\nContent-Length: 4\r\n\r\nabcd", "another length"},
      {head + "Content-Length: -3\r\n\r\nabc", "whole number"},
      {head + "Content-Length: 99999999999999999999\r\n\r\nabc", "whole number"},
      {head + "Transfer-Encoding: gzip, chunked\r\n\r\n0\r\n\r\n", "not chunked"},
      {head + "Host: y\r\nContent-Length: 0\r\n\r\n", "Host"},
      {head + "Content-Length: 1001\r\n\r\n" + std::string(1001, 'x'), "larger than 1000"},
      {head + "Transfer-Encoding: chunked\r\n\r\n" + "3e9\r\n" + std::string(1001, 'x'),
       "larger than 1000"},
      {head + "Transfer-Encoding: chunked\r\n\r\nzz\r\nabc\r\n0\r\n\r\n",
       "chunks of the body are malformed"},
      {"nonsense\r\n\r\n", "malformed"},
      {"GET / HTTP/1.1\r\n" + std::string(40000, 'a') + ": b\r\n\r\n", "longer than 16384"},
      {"GET /" + std::string(9000, 'a') + " HTTP/1.1\r\n\r\n", "Host is missing"}};
  for (const auto& [bytes, text] : cases) {
    Client client(port.number());
    client.send(bytes + get("/smuggled"));
    const auto answer = client.receive();
    EXPECT_EQ(answer.status, 400) << text;
    EXPECT_NE(answer.body.find(text), std::string::npos) << text << ": " << answer.body;
    EXPECT_EQ(answer.header("Connection"), "close") << text;
    EXPECT_TRUE(client.at_end()) << text;
  }
  EXPECT_EQ(one(port, get("/alive")), "GET /alive ");
}

TEST(Transport, HoldsNoThreadForASlowClient) {
  TransportOptions options;
  options.slots = 1;
  options.idle = options.head = options.body = 100ms;
  const Port port(echo, options);
  Client idle(port.number());
  Client slow(port.number());
  slow.send("GET /slow HTTP/1.1\r\n");
  Client body(port.number());
  body.send("POST /b HTTP/1.1\r\nHost: x\r\nContent-Length: 5\r\n\r\nab");
  EXPECT_EQ(one(port, get("/good")), "GET /good ");
  EXPECT_TRUE(idle.at_end());
  EXPECT_EQ(slow.receive().status, 400);
  EXPECT_EQ(body.receive().status, 400);
}

TEST(Transport, DropsEmptyLinesBehindABodyInSilence) {
  TransportOptions options;
  options.head = 100ms;
  const Port port(echo, options);
  Client client(port.number());
  client.send(post("/b", "x") + "\r\n");
  EXPECT_EQ(client.receive().status, 200);
  EXPECT_TRUE(client.at_end());  // no answer to a request that nobody sent
}

TEST(Transport, LetsAClientReadWhyItsLargeBodyIsRefused) {
  const Port port;
  for (const std::size_t bytes : {std::size_t{2} << 20, std::size_t{40} << 20}) {
    Client client(port.number());
    client.send("POST /b HTTP/1.1\r\nHost: x\r\nContent-Length: " + std::to_string(bytes) +
                "\r\n\r\n");
    const std::string part(1 << 20, 'x');
    for (std::size_t sent = 0; sent < bytes; sent += part.size()) client.send(part);
    EXPECT_EQ(client.receive().status, 400) << bytes;
    EXPECT_TRUE(client.at_end());
  }
}

TEST(Transport, ClosesSlowReadersBeforeItRefusesOthers) {
  TransportOptions options;
  options.memory = 1;  // the least there is: 16 MiB
  options.write = 60s;
  const Port port(
      [](const Request& request) {
        auto answer = echo(request);
        if (request.target == "/big") answer.body.assign(std::size_t{12} << 20, 'x');
        return answer;
      },
      options);
  std::vector<std::unique_ptr<Client>> takers;
  for (int i = 0; i < 3; ++i) {
    takers.push_back(std::make_unique<Client>(port.number()));
    takers.back()->send(get("/big"));
  }
  std::string got;
  for (int i = 0; i < 200 && got != "POST /good x"; ++i) {
    std::this_thread::sleep_for(100ms);
    Client good(port.number());
    good.send(post("/good", "x"));
    got = good.receive().body;
  }
  EXPECT_EQ(got, "POST /good x");
}

TEST(Transport, HasItsSlotFreeBeforeTheAnswerIsOut) {
  TransportOptions options;
  options.queue = 0;
  const Port port(echo, options);
  Client client(port.number());
  for (int i = 0; i < 500; ++i) {
    client.send(get("/one"));
    ASSERT_EQ(client.receive().body, "GET /one ") << i;
  }
}

TEST(Transport, LetsAHalfClosedClientReadAllOfItsAnswer) {
  const Port port([](const Request& request) {
    std::this_thread::sleep_for(50ms);  // the client is done sending by then
    auto answer = echo(request);
    answer.body.assign(std::size_t{500'000}, 'x');
    return answer;
  });
  std::string behind;
  while (behind.size() < 100000) behind += get("/behind");
  Client client(port.number());
  client.send(get("/big", "Connection: close\r\n") + behind);
  client.half_close();
  std::this_thread::sleep_for(200ms);
  EXPECT_EQ(client.receive().body.size(), std::size_t{500'000});
  EXPECT_TRUE(client.at_end());
}

TEST(Transport, AnswersAcceptedWorkWithAnyBytesAfterIt) {
  TransportOptions options;
  options.memory = 1;  // the least there is: 16 MiB
  options.queue = 300;
  std::promise<void> go;
  const auto gate = go.get_future().share();
  const Port port(
      [&](const Request& request) {
        gate.wait();
        return echo(request);
      },
      options);
  std::string behind;
  while (behind.size() < 70000) behind += get("/behind");
  std::vector<std::unique_ptr<Client>> clients;
  for (int i = 0; i < 200; ++i) {  // 13 MB behind them, where 8 MiB may be on their way
    clients.push_back(std::make_unique<Client>(port.number()));
    clients.back()->send(post("/job", std::to_string(i)) + behind);
  }
  go.set_value();
  for (int i = 0; i < 200; ++i) {
    EXPECT_EQ(clients[static_cast<std::size_t>(i)]->receive().body,
              "POST /job " + std::to_string(i));
  }
}

TEST(Transport, ShowsNoTextOfAnException) {
  const Port port([](const Request&) -> Response { throw std::runtime_error("secret"); });
  Client client(port.number());
  client.send(get("/"));
  const auto answer = client.receive();
  EXPECT_EQ(answer.status, 500);
  EXPECT_EQ((answer.head + answer.body).find("secret"), std::string::npos);
}

TEST(Transport, AnswersAcceptedWorkWhileDraining) {
  constexpr int kJobs = 20;
  std::latch begun(kJobs);
  std::promise<void> go;
  const auto gate = go.get_future().share();
  TransportOptions options;
  options.slots = kJobs;
  Port port(
      [&](const Request& request) {
        begun.count_down();
        gate.wait();
        return echo(request);
      },
      options);
  std::vector<std::unique_ptr<Client>> clients;
  for (int i = 0; i < kJobs; ++i) {
    clients.push_back(std::make_unique<Client>(port.number()));
    clients.back()->send(post("/job", std::to_string(i)));
  }
  begun.wait();
  Client idle(port.number());
  Client half(port.number());
  half.send("POST /half HTTP/1.1\r\nHost: x\r\nContent-Length: 4\r\n\r\nab");
  std::this_thread::sleep_for(50ms);  // until both are accepted
  port.drain();
  EXPECT_TRUE(idle.at_end());
  EXPECT_THROW(Client late(port.number()), std::runtime_error);
  go.set_value();
  half.send("cd");
  EXPECT_EQ(half.receive().body, "POST /half abcd");
  for (int i = 0; i < kJobs; ++i) {
    const auto answer = clients[static_cast<std::size_t>(i)]->receive();
    EXPECT_EQ(answer.body, "POST /job " + std::to_string(i));
    EXPECT_EQ(answer.header("Connection"), "close");
  }
  EXPECT_TRUE(port.join());
}

Service service_of(std::function<Response(const Request&)> handle) {
  return {.handle = std::move(handle),
          .screen = [](const Request&) { return std::optional<Refusal>{}; },
          .max_body = [](std::string_view) { return std::size_t{1000}; },
          .is_short = [](const Request& request) { return request.target != "/long"; },
          .budget = [](const Request&) { return Budget{.cpu = std::chrono::milliseconds(5000)}; }};
}

/// The long ones are of the same client.
TEST(Transport, AnswersShortJobsWhileLongOnesHoldEverySlot) {
  std::promise<void> go;
  const auto gate = go.get_future().share();
  TransportOptions options;
  options.slots = 1;
  const Port port(service_of([&](const Request& request) {
                    if (!request.refusal && request.target == "/long") gate.wait();
                    return echo(request);
                  }),
                  options);
  std::vector<std::unique_ptr<Client>> hogs;
  for (int i = 0; i < 8; ++i) {
    hogs.push_back(std::make_unique<Client>(port.number()));
    hogs.back()->send(get("/long"));
  }
  std::this_thread::sleep_for(100ms);
  int answered = 0;
  for (int i = 0; i < 50; ++i)
    answered += one(port, post("/short", "1")) == "POST /short 1" ? 1 : 0;
  go.set_value();
  EXPECT_EQ(answered, 50);
  EXPECT_EQ(hogs.front()->receive().status, 200);
}

/// A job that waits for half of its budget is refused, but past long jobs cause no refusals.
TEST(Transport, RefusesJobsThatWaitTooLongOnlyWhileLongOnesRun) {
  std::promise<void> go;
  const auto gate = go.get_future().share();
  std::atomic<bool> begun = false;
  auto service = service_of([&](const Request& request) {
    if (request.refusal) return echo(request);
    begun = true;
    gate.wait();
    return echo(request);
  });
  service.budget = [](const Request&) { return Budget{.cpu = 400ms}; };
  TransportOptions options;
  options.slots = 1;
  const Port port(std::move(service), options);
  Client first(port.number()), second(port.number());
  first.send(get("/long"));
  while (!begun) std::this_thread::sleep_for(1ms);
  const auto sent = std::chrono::steady_clock::now();
  second.send(get("/long"));
  EXPECT_NE(second.receive().body.find("half of the job's budget"), std::string::npos);
  EXPECT_GE(std::chrono::steady_clock::now() - sent, 200ms);
  go.set_value();
  EXPECT_EQ(first.receive().body, "GET /long ");
  for (int i = 0; i < 20; ++i) ASSERT_EQ(one(port, get("/long")), "GET /long ") << i;
}

Response until_stopped(const Request& request, bool busy, std::chrono::milliseconds at_most) {
  const auto begun = std::chrono::steady_clock::now();
  while (!request.stop.stop_requested() && std::chrono::steady_clock::now() - begun < at_most) {
    if (!busy) std::this_thread::sleep_for(1ms);
  }
  return {.body = request.stop.stop_requested() ? "stopped" : "whole"};
}

/// One that is kept from the CPU is not over its budget, but for the wall's bound.
TEST(Transport, CountsAJobsOwnCpu) {
  Service service = service_of([](const Request& request) {
    if (request.target == "/busy") return until_stopped(request, true, 10s);
    return until_stopped(request, false, request.target == "/kept" ? 300ms : 10s);
  });
  service.budget = [](const Request&) { return Budget{.cpu = 100ms, .wall = 600ms}; };
  const Port port(std::move(service), TransportOptions{});
  for (const auto& [path, answer, least, most] :
       {std::tuple("/kept", "whole", 300ms, 590ms), std::tuple("/busy", "stopped", 100ms, 590ms),
        std::tuple("/idle", "stopped", 600ms, 2000ms)}) {
    const auto begun = std::chrono::steady_clock::now();
    EXPECT_EQ(one(port, get(path)), answer) << path;
    const auto took = std::chrono::steady_clock::now() - begun;
    EXPECT_GE(took, least) << path;
    EXPECT_LT(took, most) << path;
  }
}

/// As many silent sockets as there may be, begun or not: a newcomer is answered all the same.
TEST(Transport, AnswersNewClientsDespiteSilentSockets) {
  TransportOptions options;
  options.connections = 32;
  options.idle = options.head = 60s;
  const Port port(echo, options);
  std::vector<std::unique_ptr<Client>> silent;
  for (int i = 0; i < 40; ++i) {
    silent.push_back(std::make_unique<Client>(port.number()));
    if (i % 2 == 0) silent.back()->send("GET /silent HTTP/1.1\r\n");
  }
  std::this_thread::sleep_for(200ms);
  for (int i = 0; i < 64; ++i) ASSERT_EQ(one(port, get("/good")), "GET /good ") << i;
}

TEST(Transport, KeepsConnectionsFreeDespiteABusyAddress) {
  TransportOptions options;
  options.connections = 32;
  options.per_client = 4;
  options.idle = 60s;
  const Port port(echo, options);
  std::vector<std::unique_ptr<Client>> many;
  for (int i = 0; i < 10; ++i) many.push_back(std::make_unique<Client>(port.number()));
  std::this_thread::sleep_for(100ms);
  for (int i = 0; i < 6; ++i) EXPECT_TRUE(many[static_cast<std::size_t>(i)]->at_end()) << i;
  many.back()->send(get("/good"));
  EXPECT_EQ(many.back()->receive().body, "GET /good ");
}

/// Behind a proxy all come from one address: a key has its share of the connections all the same.
TEST(Transport, KeepsConnectionsFreeDespiteABusyKey) {
  auto service = service_of(echo);
  service.client = [](const Request& request) {
    return std::string(header(request.headers, "Who"));
  };
  service.is_shared = [](const std::string&) { return true; };
  TransportOptions options;
  options.connections = 32;
  options.per_client = 4;
  const Port port(std::move(service), options);
  std::vector<std::unique_ptr<Client>> many;
  const auto ask = [&](const char* who) {
    many.push_back(std::make_unique<Client>(port.number()));
    many.back()->send(get("/good", std::string("Who: ") + who + "\r\n"));
    return many.back()->receive().body;
  };
  for (int i = 0; i < 4; ++i) EXPECT_EQ(ask("mes"), "GET /good ") << i;
  for (int i = 0; i < 3; ++i)
    EXPECT_EQ(ask("mes"), "Too many connections of this client are open.") << i;
  EXPECT_EQ(ask("cell"), "GET /good ");
  many.erase(many.begin());  // one of the four leaves
  std::this_thread::sleep_for(100ms);
  EXPECT_EQ(ask("mes"), "GET /good ");
}

TEST(Transport, TakesAPortOnce) {
  const Port port;
  TransportOptions same;
  same.port = port.number();
  const auto second = Transport::open(same, {});
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().find(std::to_string(port.number())), std::string::npos);
}

TEST(Probe, ReturnsTheStatusOrNothing) {
  int number = 0;
  {
    const Port port;
    number = port.number();
    EXPECT_EQ(probe("127.0.0.1", number, "/readyz", 2s), 200);
  }
  EXPECT_EQ(probe("127.0.0.1", number, "/readyz", 2s), std::nullopt);
}

}  // namespace
}  // namespace tubecut::server
