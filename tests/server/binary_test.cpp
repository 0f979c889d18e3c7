#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <thread>

#include "api/wire/json.hpp"
#include "tests/server/client.hpp"
#include "tests/support/golden.hpp"

namespace tubecut::test {
namespace {

/// The real program on free ports.
struct Service {
  Program program;
  std::string ready;
  std::string capacity;
  int port = 0;
  int admin_port = 0;

  explicit Service(std::vector<std::string> more = {}, const char* binary = TUBECUT_BINARY)
      : program(words(std::move(more), binary)) {
    ready = program.line();
    capacity = program.line();
    const auto json = api::parse(ready);
    if (!json) return;
    port = static_cast<int>(*json->find("port")->as<double>());
    admin_port = static_cast<int>(*json->find("admin_port")->as<double>());
  }

  static std::vector<std::string> words(std::vector<std::string> more, const char* binary) {
    std::vector<std::string> all = {binary, "--port", "0", "--admin-port", "0"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
};

Answer ask(int port, const std::string& bytes) {
  Client client(port);
  client.send(bytes);
  return client.receive();
}

int readiness(int admin_port) { return ask(admin_port, get("/readyz")).status; }

void await_ready(const Service& service) {
  while (readiness(service.admin_port) != 200) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

TEST(Binary, FirstPrintsItsAddress) {
  const Service service;
  EXPECT_EQ(service.ready, "{\"event\":\"ready\",\"port\":" + std::to_string(service.port) +
                               ",\"admin_port\":" + std::to_string(service.admin_port) +
                               ",\"version\":\"0.1.0\"}");
  await_ready(service);
  EXPECT_EQ(ask(service.admin_port, get("/livez")).status, 200);
  EXPECT_NE(ask(service.admin_port, get("/metrics")).body.find("tubecut_ready 1\n"),
            std::string::npos);
  EXPECT_EQ(ask(service.port, get("/livez")).status, 404);
}

/// A page under a foreign name reaches neither port of a service that requires no key.
TEST(Binary, AnswersOnItsOwnMachineToNoForeignName) {
  const auto as = [](std::string request, const std::string& host) {
    const std::string own = "Host: localhost";
    const auto at = request.find(own);
    EXPECT_NE(at, std::string::npos);
    return request.replace(at, own.size(), "Host: " + host);
  };
  const Service service;
  await_ready(service);
  for (const auto& [host, status] :
       {std::pair("127.0.0.1:8080", 200), std::pair("evil.example", 400)}) {
    EXPECT_EQ(ask(service.port, as(get("/v1/version"), host)).status, status) << host;
    EXPECT_EQ(ask(service.admin_port, as(get("/metrics"), host)).status, status) << host;
  }
  const Service named({"--hosts", "cell-3.plant.example"});
  await_ready(named);
  EXPECT_EQ(ask(named.port, as(get("/v1/version"), "cell-3.plant.example")).status, 200);
  EXPECT_EQ(ask(named.admin_port, as(get("/metrics"), "cell-3.plant.example")).status, 200);
}

TEST(Binary, LogsEachJobUnderItsId) {
  Service service;
  const auto answer =
      ask(service.port, post("/v1/bevel-tables", "{not json", "Job-Id: order-17\r\n"));
  EXPECT_EQ(answer.header("Job-Id"), "order-17");
  EXPECT_EQ(answer.header("Content-Type"), "application/problem+json");
  EXPECT_EQ(ask(service.port, get("/v1/version")).status, 200);  // no job, no line
  EXPECT_EQ(ask(service.port, post("/v1/nowhere", "{}", "Idempotency-Key: k\r\n")).status, 404);
  for (const auto* id : {"order-17", "k"}) {
    const std::string line = service.program.line();
    const auto json = api::parse(line);
    ASSERT_TRUE(json) << line;
    EXPECT_EQ(*json->find("event"), api::Json("job"));
    EXPECT_EQ(*json->find("job"), api::Json(id));
    EXPECT_NE(json->find("stages_ms"), nullptr);
  }
}

TEST(Binary, AnswersAcceptedWorkAndEndsCleanly) {
  for (const int signal : {SIGTERM, SIGINT}) {
    Service service;
    std::vector<std::unique_ptr<Client>> clients;
    const std::string request = post("/v1/nowhere", "{\"a\": 1}");
    for (int i = 0; i < 20; ++i) {
      clients.push_back(std::make_unique<Client>(service.port));
      clients.back()->send(request.substr(0, request.size() - 3));
    }
    await_ready(service);
    service.program.signal(signal);
    // Accepted or still in the kernel's queue when the signal came; it is drained either way.
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    for (auto& client : clients) client->send(request.substr(request.size() - 3));
    for (auto& client : clients) {
      const auto answer = client->receive();
      EXPECT_EQ(answer.status, 404);
      EXPECT_EQ(answer.header("Connection"), "close");
    }
    EXPECT_EQ(service.program.exit_code(), 0);
  }
}

TEST(Binary, TurnsReadinessOffFirst) {
  Service service({"--drain-delay-s", "0.3"});
  await_ready(service);
  service.program.signal(SIGTERM);
  int status = 200;
  for (int i = 0; i < 1000 && status == 200; ++i) status = readiness(service.admin_port);
  EXPECT_EQ(status, 503);
  EXPECT_EQ(ask(service.port, get("/v1/version")).status, 200);  // still taken
  EXPECT_EQ(service.program.exit_code(), 0);
}

TEST(Binary, EndsAtOnceOnASecondSignal) {
  Service service({"--drain-delay-s", "60"});
  await_ready(service);
  service.program.signal(SIGTERM);
  while (readiness(service.admin_port) == 200) {
  }
  service.program.signal(SIGTERM);
  EXPECT_EQ(service.program.exit_code(), 128 + SIGTERM);
}

TEST(Binary, AnswersWithoutAReaderOfItsLog) {
  Service service({"--log-queue", "16"});
  Client client(service.port);
  for (int i = 0; i < 2000; ++i) {  // lines of some 300 bytes: several times the capacity of the
                                    // pipe
    client.send(post("/v1/nowhere", "{}"));
    ASSERT_EQ(client.receive().status, 404) << i;
  }
  const auto metrics = ask(service.admin_port, get("/metrics")).body;
  EXPECT_EQ(metrics.find("tubecut_log_lines_dropped_total 0\n"), std::string::npos);
  service.program.signal(SIGTERM);
  EXPECT_EQ(service.program.exit_code(), 0);
}

/// 20 MB leave 16 MiB for jobs, so 104 857 bytes for a body, and half for the lines of a batch.
TEST(Binary, AcceptsBodiesThatFitInMemory) {
  Service service({"--memory-bytes", "20000000"});
  const std::string fits(104'000, ' ');
  const std::string too_large(106'000, ' ');
  const std::string chunks = "Transfer-Encoding: chunked\r\nContent-Type: application/json\r\n";
  EXPECT_EQ(ask(service.port, post("/v1/nodes", fits)).status, 400);
  EXPECT_EQ(ask(service.port, post("/v1/nodes", too_large)).status, 413);
  const std::string head = "POST /v1/nodes HTTP/1.1\r\nHost: localhost\r\n" + chunks + "\r\n";
  EXPECT_EQ(ask(service.port, head + "19e10\r\n" + too_large + "\r\n0\r\n\r\n").status, 413);
  EXPECT_EQ(
      ask(service.port,
          "POST /v1/batches HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/x-ndjson\r\n"
          "Content-Length: 3000000\r\n\r\n" +
              std::string(3'000'000, ' '))
          .status,
      200);
}

TEST(Binary, RefusesToStartInTheOpenOrWithoutItsFolder) {
  using Words = std::vector<std::string>;
  for (const auto& words :
       {Words{"--host", "0.0.0.0"}, Words{"--admin-host", "0.0.0.0"},
        Words{"--log-directory", "/nowhere"}, Words{"--log-directory", TUBECUT_BINARY}}) {
    EXPECT_EQ(Program(Service::words(words, TUBECUT_BINARY)).exit_code(), 78) << words.back();
  }
  EXPECT_EQ(Program({TUBECUT_BINARY, "--port", "9090", "--admin-port", "9090", "--print-config"})
                .exit_code(),
            2);
}

TEST(Binary, RefusesAPortThatIsTaken) {
  const Service service;
  Program second({TUBECUT_BINARY, "--port", std::to_string(service.port), "--admin-port", "0"});
  EXPECT_EQ(second.exit_code(), 1);
}

TEST(Binary, ChecksItsOwnReadiness) {
  Service service;
  await_ready(service);
  const std::vector<std::string> health = {TUBECUT_BINARY, "--admin-port",
                                           std::to_string(service.admin_port), "health"};
  EXPECT_EQ(Program(health).exit_code(), 0);
  EXPECT_EQ(Program({TUBECUT_BINARY, "health", "--admin-port", std::to_string(service.admin_port)})
                .exit_code(),
            0);
  service.program.signal(SIGTERM);
  EXPECT_EQ(service.program.exit_code(), 0);
  EXPECT_EQ(Program(health).exit_code(), 1);
}

TEST(Binary, RunsOneRequestWithoutAServer) {
  const std::string file = ::testing::TempDir() + "tubecut_run_test.json";
  std::ofstream(file) << "{not json";
  Program program({TUBECUT_BINARY, "run", "--endpoint", "bevel-tables", file});
  EXPECT_EQ(program.exit_code(), 1);
  std::ofstream(file) << R"({"target": {"outer_diameter_mm": 70, "wall_mm": 5}, "cutters":
      [{"kind": "tube", "outer_diameter_mm": 110, "inclination_deg": 60}], "root_surface": "inner", "groove": {"rule": "half_dihedral"},
      "contact": "inner", "kerf_mm": 0, "smoothing": {"method": "none"}})";
  const auto in_format = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {TUBECUT_BINARY, "run", "--endpoint", "bevel-tables"});
    words.push_back(file);
    return Program(words).exit_code();
  };
  EXPECT_EQ(in_format({"--format", "gcode", "--option", "speed_mm_min=600", "--option", "torch=on",
                       "--option", "dialect=qtplasmac", "--option", "lead_mm=3"}),
            0);
  EXPECT_EQ(in_format({"--format", "gcode"}), 1);  // a speed is wanted
  EXPECT_EQ(in_format({"--option", "torch=on"}), 2);
  EXPECT_EQ(Program({TUBECUT_BINARY, "run", "--format", "svg", file}).exit_code(), 2);
}

TEST(Binary, RunsABatchWithoutAServer) {
  const std::string file =
      ::testing::TempDir() + "tubecut_batch_" + std::to_string(getpid()) + ".ndjson";
  std::ofstream(file) << R"({"id": "a", "endpoint": "nodes", "body": {}})"
                      << "\n\n"
                      << "not a job\n"
                      << R"({"id": "b", "endpoint": "no-such", "body": {}})";
  Program program({TUBECUT_BINARY, "run", file});
  std::map<std::string, double> statuses;
  api::Json summary;
  for (std::string line = program.line(); !line.empty(); line = program.line()) {
    const auto json = api::parse(line);
    ASSERT_TRUE(json) << line;
    if (const auto* last = json->find("summary")) {
      summary = *last;
      break;
    }
    const auto* id = json->find("id")->as<std::string>();
    statuses[id != nullptr ? *id : ""] = *json->find("status")->as<double>();
  }
  EXPECT_EQ(statuses, (std::map<std::string, double>{{"a", 422}, {"", 400}, {"b", 422}}));
  EXPECT_EQ(summary, *api::parse(R"({"items":3,"answered":0,"refused":3,"unanswered":0})"));
  EXPECT_EQ(program.exit_code(), 1);
}

TEST(Binary, ReportsItsResources) {
  const Service service({"--slots", "3", "--queue", "5"});
  const auto json = api::parse(service.capacity);
  ASSERT_TRUE(json) << service.capacity;
  EXPECT_EQ(*json->find("slots"), api::Json(3.0));
  EXPECT_EQ(*json->find("slots_from"), api::Json("option"));
  EXPECT_GT(*json->find("memory_bytes")->as<double>(), 1e7);
  await_ready(service);
  const auto metrics = ask(service.admin_port, get("/metrics")).body;
  EXPECT_NE(metrics.find("tubecut_slots 3\n"), std::string::npos);
}

TEST(Binary, ClosesIdleConnectionsBeforeItRunsOutOfDescriptors) {
  Program program(
      {"/bin/sh", "-c", "ulimit -n 200; exec " TUBECUT_BINARY " --port 0 --admin-port 0"});
  const auto ready = api::parse(program.line());
  const auto capacity = api::parse(program.line());
  ASSERT_TRUE(ready && capacity);
  EXPECT_EQ(*capacity->find("connections"), api::Json(100.0));
  const auto port = static_cast<int>(*ready->find("port")->as<double>());
  std::vector<std::unique_ptr<Client>> idle;
  for (int i = 0; i < 300; ++i) {
    idle.push_back(std::make_unique<Client>(port));
    if (i % 50 != 49) continue;
    EXPECT_EQ(ask(port, get("/v1/version")).status, 200) << i;
  }
  EXPECT_TRUE(idle.front()->at_end());
}

TEST(Binary, ProbesAnswerBesideHalfSentHeads) {
  const Service service;
  std::vector<std::unique_ptr<Client>> half;
  for (int i = 0; i < 200; ++i) {
    half.push_back(std::make_unique<Client>(service.admin_port));
    half.back()->send("GET /livez HTTP/1.1\r\nHost: loc");
  }
  EXPECT_EQ(ask(service.admin_port, get("/livez")).status, 200);
  EXPECT_EQ(ask(service.admin_port, get("/metrics")).status, 200);
  Client& last = *half.back();  // which still has the time to send the rest of its head
  last.send("alhost\r\n\r\n");
  EXPECT_EQ(last.receive().status, 200);
}

TEST(Binary, ListensForProbesOnLoopbackUnlessToldOtherwise) {
  const Service service({"--host", "0.0.0.0", "--open"});
  EXPECT_EQ(ask(service.admin_port, get("/livez")).status, 200);
  Client foreign(service.admin_port);  // by a name that only a port on loopback refuses
  foreign.send("GET /livez HTTP/1.1\r\nHost: cell-3.plant.example\r\n\r\n");
  EXPECT_EQ(foreign.receive().status, 400);
}

TEST(Binary, IsNotOpenByAccident) {
  Program shy({TUBECUT_BINARY, "--host", "0.0.0.0", "--port", "0", "--admin-port", "0"});
  EXPECT_EQ(shy.exit_code(), 78);
  const std::string command = TUBECUT_BINARY " --host 127.0.0.1 --admin-host 0.0.0.0 2>&1";
  Program admin({"/bin/sh", "-c", command});
  std::string said;
  for (std::string line = admin.line(); !line.empty(); line = admin.line()) said += line + '\n';
  EXPECT_EQ(admin.exit_code(), 78);
  EXPECT_NE(said.find("tubecut-server --admin-host 127.0.0.1\n"), said.npos) << said;
  EXPECT_EQ(said.find(" --host"), said.npos) << said;
  const Service open({"--host", "0.0.0.0", "--open"});
  EXPECT_NE(open.port, 0);
  Program keyless({TUBECUT_BINARY, "--keys", "/nowhere/keys", "--port", "0", "--admin-port", "0"});
  EXPECT_EQ(keyless.exit_code(), 78);
  Program folder({TUBECUT_BINARY, "--keys", "/tmp", "--port", "0", "--admin-port", "0"});
  EXPECT_EQ(folder.exit_code(), 78);
}

/// A key, and its line of a file of keys.
std::pair<std::string, std::string> new_key(const char* name) {
  Program program({TUBECUT_BINARY, "new-key", name});
  static_cast<void>(program.line());
  const auto key = program.line();
  static_cast<void>(program.line());
  return std::pair(key, program.line());
}

TEST(Binary, RequiresKeysAndReloadsThem) {
  const auto first = new_key("mes");
  const auto second = new_key("cell");
  const std::string file = ::testing::TempDir() + "tubecut_binary_keys";
  std::ofstream(file) << first.second << "\n";
  Service service({"--keys", file});
  await_ready(service);
  const auto status = [&](const std::string& key) {
    return ask(service.port, get("/v1/version", "Authorization: Bearer " + key + "\r\n")).status;
  };
  EXPECT_EQ(ask(service.port, get("/v1/version")).status, 401);
  EXPECT_EQ(status(first.first), 200);
  EXPECT_EQ(status(second.first), 401);
  const auto job =
      ask(service.port, post("/v1/nowhere", "{}", "X-Api-Key: " + first.first + "\r\n"));
  EXPECT_EQ(job.status, 404);
  std::string line = service.program.line();
  EXPECT_NE(line.find(R"("identity":"mes")"), std::string::npos) << line;
  EXPECT_EQ(line.find(first.first), std::string::npos);
  std::ofstream(file) << second.second << "\n";
  service.program.signal(SIGHUP);
  line = service.program.line();
  EXPECT_NE(line.find("keys_reloaded"), std::string::npos) << line;
  EXPECT_EQ(status(first.first), 401);
  EXPECT_EQ(status(second.first), 200);
}

/// Files only of accepted jobs of a key: not of refused ones, nor of those without a key.
TEST(Binary, KeepsAFilePerAcceptedJobOfAKey) {
  const std::string folder = ::testing::TempDir() + "tubecut_binary_jobs";
  ASSERT_EQ(std::system(("rm -rf " + folder + " && mkdir " + folder).c_str()), 0);
  EXPECT_EQ(Program({TUBECUT_BINARY, "--port", "0", "--admin-port", "0", "--log-directory", folder})
                .exit_code(),
            78);
  const auto key = new_key("mes");
  const std::string keys = ::testing::TempDir() + "tubecut_binary_jobs_keys";
  std::ofstream(keys) << key.second << "\n";
  Service service({"--log-directory", folder, "--keys", keys});
  await_ready(service);
  const std::string trace = "00-0af7651916cd43dd8448eb211c80319c-b7ad6b7169203331-01";
  const auto status = [&](const std::string& id, const std::string& body, const std::string& more) {
    return ask(service.port, post("/v1/feed-curves", body,
                                  "Job-Id: " + id + "\r\ntraceparent: " + trace + "\r\n" + more))
        .status;
  };
  const std::string body = tubecut::testing::read_project_file(
      "examples/feed-curves/calibrated-from-one-measurement.json");
  const std::string with_key = "X-Api-Key: " + key.first + "\r\n";
  EXPECT_EQ(status("order-17", body, with_key), 200);
  EXPECT_EQ(status("refused", "{}", with_key), 422);
  EXPECT_EQ(status("unread", "{not json", with_key), 400);
  EXPECT_EQ(status("order-17", body, ""), 401);
  service.program.signal(SIGTERM);
  EXPECT_EQ(service.program.exit_code(), 0);
  std::string text;
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    ++files;
    EXPECT_EQ(entry.path().filename(), "mes~order-17.jsonl");
    std::ifstream in(entry.path());
    text.assign(std::istreambuf_iterator<char>(in), {});
  }
  EXPECT_EQ(files, 1);
  for (const auto* event : {"received", "read", "started", "decoded", "sent", "job"}) {
    const auto named = "\"event\":\"" + std::string(event) + "\"";
    const auto first = text.find(named);
    EXPECT_NE(first, std::string::npos) << event << text;
    EXPECT_EQ(text.find(named, first + 1), std::string::npos) << "a stranger's too: " << text;
  }
  EXPECT_NE(text.find(trace), std::string::npos);
  EXPECT_EQ(text.find("arm_mm"), std::string::npos);
}

TEST(Binary, PassesItsSelftest) {
  Program program({TUBECUT_BINARY, "selftest"});
  std::string last;
  for (std::string line = program.line(); !line.empty(); line = program.line()) last = line;
  EXPECT_NE(last.find(" 0 differ"), std::string::npos) << last;
  EXPECT_EQ(program.exit_code(), 0);
}

// The same program with one known answer more, which no job gives.
TEST(Binary, IsNeverReadyWhenAnAnswerDiffers) {
  Service differs({}, TUBECUT_DIFFERING_BINARY);
  EXPECT_EQ(differs.ready, "");
  EXPECT_EQ(differs.program.exit_code(), 1);
  Program selftest({TUBECUT_DIFFERING_BINARY, "selftest"});
  std::string last;
  for (std::string line = selftest.line(); !line.empty(); line = selftest.line()) last = line;
  EXPECT_NE(last.find(" 1 differ"), std::string::npos) << last;
  EXPECT_EQ(selftest.exit_code(), 1);
}

}  // namespace
}  // namespace tubecut::test
