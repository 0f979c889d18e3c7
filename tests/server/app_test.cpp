#include "server/app.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <stop_token>
#include <thread>

#include "api/wire/json.hpp"
#include "server/identity.hpp"
#include "server/status.hpp"

namespace tubecut::server {
namespace {

/// An api with preset answers that records its calls.
struct Fake {
  api::Outcome outcome{
      .error = {}, .content_type = "application/json", .body = "{}", .headers = {}, .job = {}};
  std::vector<std::string> methods;
  std::vector<std::string> job_ids;
  std::vector<std::string> targets;
  std::vector<JobRecord> records;

  App app(AppOptions options = {}) {
    options.dispatch = [this](const api::Call& call, const api::Context&) {
      methods.emplace_back(call.method);
      job_ids.push_back(call.job_id);
      targets.push_back(std::string(call.path) + "|" + std::string(call.query));
      return outcome;
    };
    options.finished = [this](const JobRecord& record) { records.push_back(record); };
    return App(options);
  }
};

Request request(Headers headers = {}) {
  return {
      .method = "POST", .target = "/v1/bevel-tables", .headers = std::move(headers), .body = "{}"};
}

std::string member(const Response& response, std::string_view name) {
  const auto document = api::parse(response.body);
  if (!document || document->find(name) == nullptr) return {};
  const auto* text = document->find(name)->as<std::string>();
  return text == nullptr ? std::string{} : *text;
}

TEST(Status, IsOnePerKindAsInTheContract) {
  const std::vector<std::pair<ErrorKind, int>> contract = {{ErrorKind::unreadable, 400},
                                                           {ErrorKind::unauthorized, 401},
                                                           {ErrorKind::forbidden, 403},
                                                           {ErrorKind::not_found, 404},
                                                           {ErrorKind::method_not_allowed, 405},
                                                           {ErrorKind::not_acceptable, 406},
                                                           {ErrorKind::conflict, 409},
                                                           {ErrorKind::too_large, 413},
                                                           {ErrorKind::unsupported_media, 415},
                                                           {ErrorKind::invalid, 422},
                                                           {ErrorKind::no_solution, 422},
                                                           {ErrorKind::overloaded, 429},
                                                           {ErrorKind::internal, 500},
                                                           {ErrorKind::unavailable, 503},
                                                           {ErrorKind::timeout, 504}};
  EXPECT_EQ(contract.size(), static_cast<std::size_t>(ErrorKind::timeout) + 1);
  Fake fake;
  for (const auto& row : contract) {
    fake.outcome.error = row.first;
    const auto response = fake.app().handle(request());
    EXPECT_EQ(response.status, row.second);
    EXPECT_EQ(header(response.headers, "Retry-After").empty(),
              row.second != 429 && row.second != 503);
  }
}

TEST(App, PassesTheCallOnAsSent) {
  Fake fake;
  auto asked = request();
  asked.target = "/v1/bevel-tables?validate_only=true&format=csv";
  EXPECT_EQ(fake.app().handle(asked).status, 200);
  EXPECT_EQ(fake.targets.front(), "/v1/bevel-tables|validate_only=true&format=csv");
  EXPECT_EQ(fake.methods.front(), "POST");
}

TEST(App, EchoesTheClientsNamesAndUsesThem) {
  Fake fake;
  const std::string trace = "00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01";
  const auto response = fake.app().handle(request({{"job-id", "J 17/a"},
                                                   {"IDEMPOTENCY-KEY", "k1"},
                                                   {"x-request-id", "r1"},
                                                   {"TraceParent", trace}}));
  EXPECT_EQ(header(response.headers, "Job-Id"), "J 17/a");
  EXPECT_EQ(header(response.headers, "Idempotency-Key"), "k1");
  EXPECT_EQ(header(response.headers, "X-Request-Id"), "r1");
  EXPECT_EQ(header(response.headers, "traceparent"), trace);
  EXPECT_EQ(fake.job_ids.front(), "J 17/a");
  EXPECT_EQ(fake.records.front().request_id, "r1");

  EXPECT_EQ(fake.app().handle(request({{"Idempotency-Key", "k2"}})).status, 200);
  EXPECT_EQ(fake.job_ids.back(), "k2");
}

TEST(App, RefusesJobNamesThatItCannotKeep) {
  for (const auto* name : {"Job-Id", "Idempotency-Key"}) {
    for (const std::string bad :
         {"", " a", "a ", "a\r\nSet-Cookie: x", "\x7f", "\xc3\xa4", "a\tb"}) {
      Fake fake;
      const auto response = fake.app().handle(request({{name, bad}}));
      EXPECT_EQ(response.status, 400) << name << " " << bad;
      EXPECT_EQ(member(response, "code"), "bad_request");
      EXPECT_TRUE(header(response.headers, name).empty());
      EXPECT_TRUE(fake.methods.empty());
    }
    Fake fake;
    EXPECT_EQ(fake.app().handle(request({{name, std::string(128, 'x')}})).status, 200);
    EXPECT_EQ(fake.app().handle(request({{name, std::string(129, 'x')}})).status, 400);
    EXPECT_EQ(fake.app().handle(request({{name, "a"}, {name, "b"}})).status, 400);
  }
}

TEST(App, OmitsInvalidTraces) {
  Fake fake;
  const auto response = fake.app().handle(
      request({{"X-Request-Id", "a\nb"},
               {"traceparent", "00-00000000000000000000000000000000-00f067aa0ba902b7-01"}}));
  EXPECT_EQ(response.status, 200);
  EXPECT_EQ(header(response.headers, "X-Request-Id").size(), 32U);
  EXPECT_TRUE(header(response.headers, "traceparent").empty());
}

TEST(App, GivesEveryRequestItsOwnId) {
  Fake fake;
  const App app = fake.app();
  std::vector<std::string> ids;
  for (int i = 0; i < 1000; ++i)
    ids.emplace_back(header(app.handle(request()).headers, "X-Request-Id"));
  std::ranges::sort(ids);
  EXPECT_EQ(std::ranges::adjacent_find(ids), ids.end());
}

TEST(App, ReportsStageTimesAndReplica) {
  Fake fake;
  fake.outcome.job.stages = {{"parse", 0.0005}, {"compute", 0.00125}};
  const auto response = fake.app({.replica = "cell-3"}).handle(request());
  const auto timing = header(response.headers, "Server-Timing");
  EXPECT_EQ(timing.substr(0, timing.find("cpu")), "parse;dur=0.500, compute;dur=1.250, ");
  EXPECT_NE(timing.find("cpu;dur="), timing.npos);
  EXPECT_EQ(header(response.headers, "Tubecut-Replica"), "cell-3");
}

TEST(App, ClassifiesJobsByEndpointAndSize) {
  auto asked = request();
  const auto is_short = [&](std::string target, std::size_t bytes) {
    asked.target = std::move(target);
    asked.body.assign(bytes, ' ');
    return App::is_short(asked);
  };
  for (const auto* path : {"/v1/bevel-tables?format=csv", "/v1/holes", "/v1/intersections",
                           "/v1/feed-curves", "/v1/grooves", "/v1/replays"}) {
    EXPECT_TRUE(is_short(path, 64 << 10)) << path;
    EXPECT_FALSE(is_short(path, (64 << 10) + 1)) << path;
  }
  EXPECT_TRUE(is_short("/v1/parts", 4 << 10));
  EXPECT_FALSE(is_short("/v1/parts", (4 << 10) + 1));
  for (const auto* path : {"/v1/frames", "/v1/nodes", "/v1/mill-paths", "/v1/pulse-schedules"})
    EXPECT_FALSE(is_short(path, 2)) << path;
  asked.line = 1;
  EXPECT_FALSE(is_short("/v1/bevel-tables", 2));
  EXPECT_TRUE(App::is_short({.method = "GET", .target = "/v1/tubes"}));
}

TEST(App, NamesTheCharsetToPreventCompression) {
  Fake fake;
  EXPECT_EQ(fake.app().handle(request()).content_type, "application/json; charset=utf-8");
  fake.outcome.content_type = "application/cbor";
  EXPECT_EQ(fake.app().handle(request()).content_type, "application/cbor");
}

TEST(App, AnswersHeadAsGet) {
  Fake fake;
  auto asked = request();
  asked.method = "HEAD";
  fake.outcome.headers = {{"Allow", "GET"}};
  const auto response = fake.app().handle(asked);
  EXPECT_EQ(fake.methods.front(), "GET");
  EXPECT_EQ(response.body, "{}");  // the transport leaves the bytes out and keeps their length
  EXPECT_EQ(header(response.headers, "Allow"), "GET, HEAD");
}

TEST(App, DoesNotSendTheTextOfAnException) {
  Fake fake;
  AppOptions options;
  options.dispatch = [](const api::Call&, const api::Context&) -> api::Outcome {
    throw std::runtime_error("secret of /etc/x");
  };
  std::vector<JobRecord> records;
  options.finished = [&](const JobRecord& record) { records.push_back(record); };
  const auto response = App(options).handle(request({{"X-Request-Id", "r9"}}));
  EXPECT_EQ(response.status, 500);
  EXPECT_EQ(response.content_type, "application/problem+json");
  EXPECT_EQ(member(response, "code"), "internal_error");
  EXPECT_EQ(member(response, "request_id"), "r9");
  EXPECT_EQ(response.body.find("secret"), std::string::npos);
  for (const auto& [name, value] : response.headers)
    EXPECT_EQ(value.find("secret"), value.npos) << name;
  EXPECT_EQ(records.at(0).failure, "secret of /etc/x");

  options.dispatch = [](const api::Call&, const api::Context&) -> api::Outcome { throw 7; };
  EXPECT_EQ(App(options).handle(request()).status, 500);
}

TEST(App, TurnsAwayBeforeTheApi) {
  Fake fake;
  const App app = fake.app({.max_target_bytes = 100, .max_body_bytes = 10});
  const auto code = [&](const Request& asked) { return member(app.handle(asked), "code"); };
  auto asked = request();
  asked.target = "/" + std::string(100, 'a');
  EXPECT_EQ(code(asked), "bad_request");
  asked.target = "/a\x01";
  EXPECT_EQ(code(asked), "bad_request");
  asked = request();
  asked.body = std::string(11, ' ');
  EXPECT_EQ(code(asked), "body_too_large");
  EXPECT_EQ(code(request({{"Content-Encoding", "gzip"}})), "unsupported_encoding");
  asked = request();
  asked.refusal = Refusal{ErrorCode::overloaded, "full"};
  EXPECT_EQ(code(asked), "overloaded");
  EXPECT_TRUE(fake.methods.empty());
  EXPECT_EQ(fake.records.size(), 5U);
  EXPECT_EQ(app.handle(request({{"Content-Encoding", "identity"}})).status, 200);
}

TEST(App, NamesTheEndpointOfARefusal) {
  Fake fake;
  const App app = fake.app({.max_body_bytes = 1});
  const auto endpoint = [&](Request asked) {
    asked.body = "{}";
    static_cast<void>(app.handle(asked));
    return fake.records.back().facts.endpoint;
  };
  EXPECT_EQ(endpoint(request()), "bevel-tables");
  Request turned_away = request();
  turned_away.refusal = Refusal{ErrorCode::overloaded, "All slots and the queue are full."};
  EXPECT_EQ(endpoint(turned_away), "bevel-tables");
  Request batch = request();
  batch.target = "/v1/batches?x";
  EXPECT_EQ(endpoint(batch), "batches");
  Request elsewhere = request();
  elsewhere.target = "/v1/bevel-tables/x";
  EXPECT_EQ(endpoint(elsewhere), "");
}

TEST(App, NamesTheSameClientForABatchAndItsLines) {
  Fake fake;
  const App app = fake.app({.trusted_proxies = {"10.0.0.0/8"}});
  Request line{.method = "POST",
               .target = "/v1/batches",
               .headers = {{"X-Forwarded-For", "6.6.6.6"}, {"X-Forwarded-For", "10.9.9.9"}},
               .body = R"({"id": "a", "endpoint": "bevel-tables", "body": {}})",
               .peer = "10.0.0.1",
               .line = 1};
  EXPECT_FALSE(app.line(line).refused);
  const auto of_line = fake.records.back().client;
  static_cast<void>(app.summary(line, {}));
  EXPECT_EQ(of_line, fake.records.back().client);
  line.headers.pop_back();
  EXPECT_FALSE(app.line(line).refused);
  EXPECT_EQ(fake.records.back().client, "6.6.6.6");
}

TEST(App, RefusesALineThatIsNotRead) {
  Fake fake;
  const App app = fake.app();
  const auto reply = app.line({.method = "POST",
                               .target = "/v1/batches",
                               .refusal = Refusal{ErrorCode::body_too_large, "No room."},
                               .line = 7});
  EXPECT_TRUE(reply.refused);
  const auto json = api::parse(reply.text);
  ASSERT_TRUE(json) << reply.text;
  EXPECT_EQ(*json->find("line"), api::Json(7.0));
  EXPECT_EQ(*json->find("status"), api::Json(413.0));
}

/// A job has the same hash of its input, answered, refused by core or over its budget; a body that
/// is not understood has that of its bytes.
TEST(App, RecordsTheRequestForEveryOutcome) {
  std::vector<JobRecord> records;
  AppOptions options;
  options.replica = "cut-1";
  options.finished = [&](const JobRecord& record) { records.push_back(record); };
  const App app(std::move(options));
  const auto status = [&](std::string_view body, std::stop_token stop = {}) {
    auto asked = request({{"Content-Type", "application/json"}});
    asked.body = body;
    asked.stop = std::move(stop);
    return app.handle(asked).status;
  };
  const auto late = [&](std::string_view body) {  // long understood, and not near its end
    std::stop_source source;
    const std::jthread ends([&source] {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      source.request_stop();
    });
    return status(body, source.get_token());
  };
  const std::string target =
      R"({"target": {"outer_diameter_mm": 70, "wall_mm": 5}, "root_surface": "inner", "groove": {"rule": "half_dihedral"},
      "contact": "inner", "kerf_mm": 0, "smoothing": {"method": "none"}, "cutters": [)";
  const std::string cut =
      target + R"({"kind": "tube", "outer_diameter_mm": 110, "inclination_deg": 60}])";
  ASSERT_EQ(status(cut + "}"), 200);
  const auto asked = records.back().facts.input_sha256;
  EXPECT_EQ(asked.size(), 64U);
  EXPECT_EQ(records.back().facts.result_sha256.size(), 64U);
  EXPECT_EQ(records.back().replica, "cut-1");
  // Seconds of work: every two points within the kerf.
  auto wide = cut;
  wide.replace(wide.find("\"kerf_mm\": 0"), 12, "\"kerf_mm\": 2.5");
  const std::string fine = wide + R"(, "sampling": {"uniform_points": 20000}})";
  EXPECT_EQ(late(fine), 504);
  EXPECT_EQ(records.back().facts.input_sha256.size(), 64U);
  EXPECT_NE(records.back().facts.input_sha256, asked);
  // A thinner tube far to the side misses.
  EXPECT_EQ(status(target + R"({"kind": "tube", "outer_diameter_mm": 30, "inclination_deg": 60,
                                "offset_mm": 500}]})"),
            422);
  EXPECT_EQ(records.back().facts.input_sha256.size(), 64U);
  EXPECT_TRUE(records.back().facts.body_sha256.empty());
  EXPECT_EQ(status(R"({"reference": {"order": "4711"}, "cutters": []})"), 422);
  EXPECT_EQ(records.back().facts.reference.at(0).second, "4711");
  EXPECT_EQ(
      late(wide + R"(, "reference": {"order": "4711"}, "sampling": {"uniform_points": 20000}})"),
      504);
  EXPECT_EQ(records.back().facts.reference.at(0).second, "4711");
  for (const auto* body : {"{", "{}"}) {
    EXPECT_GE(status(body), 400);
    EXPECT_TRUE(records.back().facts.input_sha256.empty());
    EXPECT_EQ(records.back().facts.body_sha256.size(), 64U);
  }
}

TEST(App, AnswersALineInTheFormatItNames) {
  const App app{AppOptions{}};
  const auto answer = [&](const std::string& more) {
    const Request line{.method = "POST",
                       .target = "/v1/batches",
                       .body = R"({"id": "a", "endpoint": "bevel-tables", "body": {"target":
        {"outer_diameter_mm": 70, "wall_mm": 5}, "cutters": [{"kind": "tube", "outer_diameter_mm": 110,
        "inclination_deg": 60}], "root_surface": "inner", "groove": {"rule": "half_dihedral"},
      "contact": "inner", "kerf_mm": 0, "smoothing": {"method": "none"}})" +
                               more + "}",
                       .line = 1};
    return *api::parse(app.line(line).text);
  };
  const auto text = [](const api::Json& json, const char* name) {
    const auto* member = json.find(name);
    const auto* value = member != nullptr ? member->as<std::string>() : nullptr;
    return value != nullptr ? *value : std::string{};
  };
  const auto program = answer(
      R"(, "format": "gcode", "options": {"speed_mm_min": 600, "torch": "on", "dialect": "qtplasmac", "lead_mm": 3})");
  EXPECT_EQ(text(program, "media"), "text/x-gcode");
  EXPECT_NE(text(program, "document").find("\nM3"), std::string::npos);
  EXPECT_EQ(program.find("body"), nullptr);
  const auto solid = answer(R"(, "format": "glb")");
  EXPECT_EQ(text(solid, "document_base64").substr(0, 5), "Z2xUR");  // "glTF"
  EXPECT_NE(answer(R"(, "format": "json")").find("body"), nullptr);
  EXPECT_EQ(text(*answer(R"(, "format": "gcode", "options": {"speed": 600})").find("body"), "code"),
            "bad_request");
  EXPECT_EQ(*answer(R"(, "options": {"view": []})").find("status"), api::Json(422.0));
}

TEST(App, PublishesTheLimitsThatItEnforces) {
  const auto limits = [](AppOptions options) {
    const auto page = App(std::move(options)).handle({.method = "GET", .target = "/v1/limits"});
    const auto document = api::parse(page.body);
    const auto* all = document ? document->find("limits") : nullptr;
    if (all == nullptr) return std::pair(0.0, 0.0);
    return std::pair(*all->find("body_max_bytes")->as<double>(),
                     *all->find("body_large_max_bytes")->as<double>());
  };
  EXPECT_EQ(limits({}), std::pair(1048576.0, 8388608.0));
  EXPECT_EQ(limits({.max_job_body_bytes = 2831155}), std::pair(1048576.0, 2831155.0));
  EXPECT_EQ(limits({.max_body_bytes = 300, .max_job_body_bytes = 2831155}),
            std::pair(300.0, 300.0));
}

TEST(App, CallsAStopAStop) {
  Fake fake;
  fake.outcome.error = ErrorKind::timeout;
  std::stop_source stop;
  const App app = fake.app({.stop = stop.get_token()});
  EXPECT_EQ(app.handle(request()).status, 504);
  stop.request_stop();
  EXPECT_EQ(app.handle(request()).status, 503);
}

TEST(App, AnswersTheRealApi) {
  const App app{AppOptions{}};
  const auto version = app.handle({.method = "GET", .target = "/v1/version"});
  EXPECT_EQ(version.status, 200);
  EXPECT_EQ(member(version, "version"), api::version());
  const auto unknown = app.handle({.method = "GET", .target = "/nowhere"});
  EXPECT_EQ(unknown.status, 404);
  EXPECT_EQ(unknown.content_type, "application/problem+json");
  EXPECT_EQ(member(unknown, "request_id"), header(unknown.headers, "X-Request-Id"));
}

TEST(App, LetsAClientLowerItsBudgetOnly) {
  Fake fake;
  AppOptions options;
  options.budget = std::chrono::milliseconds(2000);
  const App app = fake.app(options);
  const auto budget = [&](const char* text) {
    return app.budget(request({{"tubecut-budget-ms", text}})).cpu.count();
  };
  EXPECT_EQ(app.budget(request()).cpu.count(), 2000);
  EXPECT_EQ(budget("1"), 1);
  EXPECT_EQ(budget("250"), 250);
  EXPECT_EQ(budget("2001"), 2000);
  for (const auto* wrong : {"0", "-1", "1.5", "x", "", "+5", "5 ", "3600001", "1e3"}) {
    EXPECT_EQ(app.handle(request({{"Tubecut-Budget-Ms", wrong}})).status, 400) << wrong;
  }
  EXPECT_EQ(
      app.handle(request({{std::string(kBudgetHeader), "5"}, {"tubecut-budget-ms", "6"}})).status,
      400);
}

TEST(App, BoundsTheWallByTheCpu) {
  const App app{AppOptions{}};
  for (const auto* endpoint : {"/v1/intersections", "/v1/mill-paths", "/v1/limits"}) {
    Request asked = request();
    asked.target = endpoint;
    const auto own = app.budget(asked);
    EXPECT_EQ(own.cpu.count(), std::llround(1e3 * api::budget_s(endpoint, {}))) << endpoint;
    EXPECT_GE(own.wall, 3 * own.cpu) << endpoint;
    asked.headers = {{std::string(kBudgetHeader), "100"}};
    EXPECT_EQ(app.budget(asked).wall * own.cpu.count(), own.wall * 100) << endpoint;
  }
}

TEST(App, AnswersOnlyToItsNamesIfTheyAreSet) {
  Fake fake;
  AppOptions options;
  options.hosts = {"cell-3.plant.example"};
  const App app = fake.app(options);
  const auto status = [](const App& of, const char* host) {
    return of.handle(request({{"Host", host}})).status;
  };
  for (const auto* own : {"localhost", "LOCALHOST:8080", "127.0.0.1:8080", "127.9.9.9", "[::1]:80",
                          "cell-3.plant.example:8443", "Cell-3.Plant.Example"})
    EXPECT_EQ(status(app, own), 200) << own;
  for (const auto* foreign : {"evil.example", "localhost.evil.example:8080",
                              "127.0.0.1.evil.example", "192.168.1.7", "[::2]"})
    EXPECT_EQ(status(app, foreign), 400) << foreign;
  EXPECT_EQ(status(fake.app({}), "evil.example"), 200);
}

TEST(App, AnswersOtherOriginsOnlyIfAllowed) {
  Fake fake;
  AppOptions options;
  options.cors_origins = {"https://plant.example"};
  const App app = fake.app(options);
  const auto from = [](const char* origin) { return request({{"Origin", origin}}); };
  const auto good = app.handle(from("https://plant.example"));
  EXPECT_EQ(header(good.headers, "Access-Control-Allow-Origin"), "https://plant.example");
  EXPECT_EQ(header(good.headers, "Vary"), "Origin");
  const auto evil = app.handle(from("https://evil.example"));
  EXPECT_TRUE(header(evil.headers, "Access-Control-Allow-Origin").empty());
  auto question = from("https://plant.example");
  question.method = "OPTIONS";
  question.headers.emplace_back("Access-Control-Request-Method", "POST");
  const auto calls = fake.methods.size();
  EXPECT_EQ(app.handle(question).status, 204);
  EXPECT_EQ(fake.methods.size(), calls);
  EXPECT_TRUE(header(fake.app().handle(from("https://plant.example")).headers,
                     "Access-Control-Allow-Origin")
                  .empty());
}

TEST(App, RecordsAJobAfterItIsSent) {
  Fake fake;
  std::vector<JobRecord> left;
  AppOptions options;
  options.sent = [&](const JobRecord& record) { left.push_back(record); };
  const App app = fake.app(options);
  auto asked = request();
  asked.reports_sending = true;
  const auto response = app.handle(asked);
  EXPECT_EQ(fake.records.size(), 1U);
  EXPECT_TRUE(left.empty());
  response.sent(true);
  ASSERT_EQ(left.size(), 1U);
  EXPECT_GE(left[0].sent, left[0].begun);
  app.handle(asked).sent(false);
  EXPECT_EQ(left.back().sent, 0.0);
}

}  // namespace
}  // namespace tubecut::server
