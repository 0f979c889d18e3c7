#include "server/http/static_files.hpp"

#include <gtest/gtest.h>

#include <array>
#include <thread>
#include <vector>

#include "server/app.hpp"

namespace tubecut::server {
namespace {

// As Python's gzip.compress makes them.
constexpr std::string_view kPlain{
    "\037\213\010\000\000\000\000\000\002\003\053\310\111\314\314\003\000\317\142\040\031\005\000"
    "\000\000",
    25};
constexpr std::string_view kReference{
    "\037\213\010\000\000\000\000\000\002\003\053\112\115\113\055\112\315\113\116\005\000\023\111"
    "\243\256\011\000\000\000",
    29};
constexpr std::string_view kScript{
    "\037\213\010\000\000\000\000\000\002\003\053\116\056\312\054\050\001\000\072\207\201\034\006"
    "\000\000\000",
    26};

constexpr StaticFile kFiles[] = {{.path = "/",
                                  .content_type = "text/html; charset=utf-8",
                                  .etag = "\"page\"",
                                  .plain = {},
                                  .gzip = kPlain,
                                  .bytes = 5},
                                 {.path = "/docs",
                                  .content_type = "text/html; charset=utf-8",
                                  .etag = "\"docs\"",
                                  .plain = {},
                                  .gzip = kReference,
                                  .bytes = 9},
                                 {.path = "/assets/a-1.js",
                                  .content_type = "text/javascript; charset=utf-8",
                                  .etag = "\"script\"",
                                  .immutable = true,
                                  .plain = {},
                                  .gzip = kScript,
                                  .bytes = 6}};

Request get(std::string target, Headers headers = {}) {
  return {.method = "GET", .target = std::move(target), .headers = std::move(headers), .body = {}};
}

TEST(StaticFiles, ArePackedForThoseWhoTakeIt) {
  const auto plain = static_answer(get("/"), kFiles);
  ASSERT_TRUE(plain);
  EXPECT_EQ(plain->fixed, "plain");
  EXPECT_EQ(header(plain->headers, "Content-Encoding"), "");
  EXPECT_EQ(header(plain->headers, "Vary"), "Accept-Encoding");
  for (const char* accepted : {"gzip", "br, gzip;q=0.5", "gzip, deflate"}) {
    const auto packed = static_answer(get("/", {{"Accept-Encoding", accepted}}), kFiles);
    ASSERT_TRUE(packed);
    EXPECT_EQ(packed->fixed, kPlain) << accepted;
    EXPECT_EQ(header(packed->headers, "Content-Encoding"), "gzip");
  }
  for (const char* refused : {"gzip;q=0", "identity", "gzipped"}) {
    EXPECT_EQ(static_answer(get("/", {{"Accept-Encoding", refused}}), kFiles)->fixed, "plain")
        << refused;
  }
}

TEST(StaticFiles, AreUnpackedOnceHoweverManyAsk) {
  const auto first = static_answer(get("/assets/a-1.js"), kFiles);
  EXPECT_EQ(first->fixed, "script");
  EXPECT_EQ(static_answer(get("/assets/a-1.js"), kFiles)->fixed.data(), first->fixed.data());
  EXPECT_EQ(first->body, "");
}

TEST(StaticFiles, AreUnpackedOnceByClientsThatComeTogether) {
  const StaticFile file{.path = "/",
                        .content_type = "text/plain",
                        .etag = "\"together\"",
                        .plain = {},
                        .gzip = kReference,
                        .bytes = 9};
  std::array<std::string_view, 8> seen;
  {
    std::vector<std::jthread> clients;
    for (auto& one : seen)
      clients.emplace_back([&] { one = static_answer(get("/"), {&file, 1})->fixed; });
  }
  for (const auto one : seen) {
    EXPECT_EQ(one, "reference");
    EXPECT_EQ(one.data(), seen.front().data());
  }
}

TEST(StaticFiles, AreNeverHalf) {
  const auto with = [](std::string_view gzip, std::size_t bytes, std::string_view etag) {
    return StaticFile{.path = "/",
                      .content_type = "text/plain",
                      .etag = etag,
                      .plain = {},
                      .gzip = gzip,
                      .bytes = bytes};
  };
  for (const auto& broken :
       {with(kPlain, 4, "\"longer\""), with(kPlain, 6, "\"shorter\""),
        with(kPlain.substr(0, 20), 5, "\"cut\""), with("no gzip", 5, "\"other\"")})
    EXPECT_THROW(static_answer(get("/"), {&broken, 1}), std::runtime_error) << broken.etag;
}

TEST(StaticFiles, PagesAllowOnlyOwnFilesAndNoInlineCode) {
  const auto page = static_answer(get("/"), kFiles);
  const auto policy = header(page->headers, "Content-Security-Policy");
  EXPECT_NE(policy.find("default-src 'none'"), policy.npos);
  EXPECT_EQ(policy.find("'unsafe-"), policy.npos);
  EXPECT_NE(policy.find("script-src 'self' 'wasm-unsafe-eval';"), policy.npos);
  const auto docs = static_answer(get("/docs/"), kFiles);
  ASSERT_TRUE(docs);
  EXPECT_EQ(docs->fixed, "reference");
  EXPECT_EQ(header(docs->headers, "Content-Security-Policy").find("unsafe-eval"),
            std::string_view::npos);
}

TEST(StaticFiles, AreKeptByName) {
  EXPECT_EQ(header(static_answer(get("/"), kFiles)->headers, "Cache-Control"), "no-cache");
  EXPECT_NE(header(static_answer(get("/assets/a-1.js"), kFiles)->headers, "Cache-Control")
                .find("immutable"),
            std::string_view::npos);
  const auto known = static_answer(get("/", {{"If-None-Match", "\"page\""}}), kFiles);
  EXPECT_EQ(known->status, 304);
  EXPECT_EQ(known->body, "");
  EXPECT_EQ(static_answer(get("/", {{"If-None-Match", "\"old\""}}), kFiles)->status, 200);
}

TEST(StaticFiles, LeaveEverythingElseToTheApi) {
  EXPECT_FALSE(static_answer(get("/v1/version"), kFiles));
  EXPECT_FALSE(static_answer(get("/assets/"), kFiles));
  auto post = get("/");
  post.method = "POST";
  EXPECT_FALSE(static_answer(post, kFiles));
  EXPECT_TRUE(static_answer(get("/?any=query"), kFiles));
}

TEST(StaticFiles, WithoutAConsoleThePageReportsIt) {
  for (const char* path : {"/", "/docs"}) {
    const auto page = static_answer(get(path), {});
    ASSERT_TRUE(page);
    EXPECT_NE(page->fixed.find("without the console"), std::string::npos);
  }
  EXPECT_FALSE(static_answer(get("/assets/a-1.js"), {}));
}

TEST(StaticFiles, AreNoJobs) {
  int jobs = 0;
  AppOptions options;
  options.started = [&] { ++jobs; };
  const App app(std::move(options));
  EXPECT_EQ(app.handle(get("/")).status, 200);
  EXPECT_EQ(jobs, 0);
}

}  // namespace
}  // namespace tubecut::server
