// The port's thread runs out of memory at every allocation: a connection ends, the process and the
// others continue, and the reserved memory is released.

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <future>
#include <new>
#include <thread>

#include "server/http/transport.hpp"
#include "tests/server/client.hpp"

namespace {

thread_local bool t_is_port = false;
std::atomic<int> g_until_fault = 0;  // allocations of the port's thread until the next fails; 0: no
                                     // allocation fails
std::atomic<int> g_faults = 0;

void* allocate(std::size_t size) {
  if (t_is_port && g_until_fault > 0 && --g_until_fault == 0) {
    ++g_faults;
    throw std::bad_alloc();
  }
  void* const found = std::malloc(size);
  if (found == nullptr) throw std::bad_alloc();
  return found;
}

/// Not inline: gcc 12 would see `free` where it still sees `new`, and calls them mismatched.
[[gnu::noinline]] void release(void* at) noexcept { std::free(at); }

}  // namespace

void* operator new(std::size_t size) { return allocate(size); }
void* operator new[](std::size_t size) { return allocate(size); }
void operator delete(void* at) noexcept { release(at); }
void operator delete[](void* at) noexcept { release(at); }
void operator delete(void* at, std::size_t) noexcept { release(at); }
void operator delete[](void* at, std::size_t) noexcept { release(at); }

namespace tubecut::server {
namespace {

using namespace std::chrono_literals;
using test::Client;
using test::get;
using test::post;

Response echo(const Request& request) {
  return {
      .status = request.refusal ? 400 : 200, .content_type = "text/plain", .body = request.body};
}

Service service() {
  return {.handle = echo,
          .screen = [](const Request&) { return std::optional<Refusal>{}; },
          .max_body = [](std::string_view) { return std::size_t{100'000}; },
          .is_batch = [](const Request& request) { return request.target == "/batch"; },
          .batch_head = [](const Request&) { return Response{.content_type = "text/plain"}; },
          .line = [](const Request& line) { return BatchReply{.text = line.body + "\n"}; },
          .summary = [](const Request&, const BatchCount&) { return Response{.body = "end\n"}; },
          .client =
              [](const Request& request) {
                t_is_port = true;
                return request.peer;
              },
          .budget = [](const Request&) { return Budget{.cpu = std::chrono::milliseconds(5000)}; }};
}

/// Something of everything: answered one after another on one connection.
std::string conversation() {
  const std::string large(20'000, 'x');
  return post("/one", "a") + post("/large", large) +
         "POST /chunked HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: "
         "chunked\r\n\r\n3\r\nabc\r\n0\r\n\r\n" +
         post("/batch", "one\ntwo\n\nthree\n") + get("/last", "Connection: close\r\n");
}

TEST(MemoryFaults, EndOnlyOneConnection) {
  auto transport = Transport::open({.slots = 2}, service()).value();
  auto served = std::async(std::launch::async, [&] { return transport.serve(); });
  while (!transport.serving()) std::this_thread::sleep_for(1ms);
  const auto good = [&] {
    Client client(transport.port());
    client.send(post("/good", "good"));
    return client.receive().body;
  };
  ASSERT_EQ(good(), "good");
  int at = 0;
  for (int passed = 0; passed < 3 && at < 3000;) {
    const int before = g_faults;
    {
      Client client(transport.port());
      g_until_fault = ++at;
      client.send(conversation());
      client.half_close();
      while (client.receive().status != 0) {
      }
      EXPECT_TRUE(client.at_end() || true);
      g_until_fault = 0;
    }
    ASSERT_EQ(good(), "good") << "after the fault of allocation " << at;
    passed = g_faults == before ? passed + 1 : 0;
  }
  EXPECT_GT(g_faults, 50);
  for (int i = 0; i < 500 && transport.stats().connections > 0; ++i)
    std::this_thread::sleep_for(10ms);
  EXPECT_EQ(transport.stats().connections, 0U);
  EXPECT_EQ(transport.stats().memory, 0U);
  transport.drain(1s);
  EXPECT_TRUE(served.get());
}

}  // namespace
}  // namespace tubecut::server
