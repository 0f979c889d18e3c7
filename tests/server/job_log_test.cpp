#include "server/observe/job_log.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>

#include "api/api.hpp"
#include "api/wire/json.hpp"
#include "server/observe/json_line.hpp"

namespace tubecut::server {
namespace {

using std::chrono::milliseconds;
using std::chrono::system_clock;

JobRecord hostile() {
  JobRecord job;
  job.facts.id = "J\"1\\";
  job.facts.endpoint = "bevel-tables";
  job.facts.input_sha256 = "ab";
  job.facts.result_sha256 = "cd";
  job.facts.verdict = "review";
  job.facts.warnings = {"cutter_missed", "ghost_contact"};
  job.facts.reference = {{"part", "Tr\xc3\xa4ger"}, {"order", "a\nb\x1b[2J"}};
  job.facts.stages = {{"parse", 0.0012345}, {"compute", 0.1}};
  job.method = "POST";
  job.replica = "cut-1";
  job.request_id = "r";
  job.failure = "bad byte \xff \xc3";
  job.status = 500;
  job.seconds = 0.25;
  return job;
}

TEST(JobLine, IsOneLineOfStrictJsonForAnyContent) {
  const auto line = job_line(hostile(), system_clock::time_point(milliseconds(1709294400123)));
  EXPECT_EQ(line.find('\n'), line.npos);
  EXPECT_EQ(line.find('\x1b'), line.npos);
  const auto json = api::parse(line);
  ASSERT_TRUE(json) << json.error().reason << line;
  EXPECT_EQ(*json->find("ts"), api::Json("2024-03-01T12:00:00.123Z"));
  EXPECT_EQ(*json->find("level"), api::Json("error"));
  EXPECT_EQ(*json->find("event"), api::Json("job"));
  EXPECT_EQ(*json->find("job"), api::Json("J\"1\\"));
  EXPECT_EQ(*json->find("status"), api::Json(500.0));
  EXPECT_EQ(*json->find("input_sha256"), api::Json("ab"));
  EXPECT_EQ(*json->find("result_sha256"), api::Json("cd"));
  EXPECT_EQ(*json->find("engine"), api::Json(api::engine()));
  EXPECT_EQ(*json->find("numerics"), api::Json(static_cast<double>(api::numerics())));
  EXPECT_EQ(*json->find("replica"), api::Json("cut-1"));
  EXPECT_EQ(*json->find("stages_ms")->find("parse"), api::Json(1.234));
  EXPECT_EQ(*json->find("total_ms"), api::Json(250.0));
  EXPECT_EQ(json->find("warnings")->as<api::Json::Array>()->size(), 2U);
  EXPECT_EQ(*json->find("reference")->find("part"), api::Json("Tr\xc3\xa4ger"));
  EXPECT_EQ(*json->find("reference")->find("order"), api::Json("a\nb\x1b[2J"));
}

TEST(JobLine, SurvivesEveryByte) {
  for (int byte = 0; byte < 256; ++byte) {
    const std::string text(2, static_cast<char>(byte));
    EXPECT_TRUE(api::parse(JsonLine{}.text("x", text).done())) << byte;
  }
}

/// The line of any job is bounded, still JSON, and reports the omitted texts.
TEST(JobLine, LengthIsBounded) {
  for (const auto* piece : {"a_warning_of_some_length", "\x01\x02", "\xc3\xa4", "\"\\"}) {
    JobRecord job = hostile();
    std::string long_text;
    while (long_text.size() < 300'000) long_text += piece;
    job.failure = job.traceparent = long_text;
    job.facts.warnings.assign(20'000, std::string(piece));
    for (int i = 0; i < 50; ++i) job.facts.reference.emplace_back(std::to_string(i), long_text);
    const auto line = job_line(job, system_clock::now());
    EXPECT_LE(line.size(), kLongestLine);
    const auto json = api::parse(line);
    ASSERT_TRUE(json) << json.error().reason;
    EXPECT_GT(*json->find("left_out")->as<double>(), 10'000.0);
    EXPECT_EQ(*json->find("status"), api::Json(500.0));
  }
  EXPECT_EQ(job_line(hostile(), system_clock::now()).find("left_out"), std::string::npos);
}

TEST(ReadyLine, IsExact) {
  EXPECT_EQ(ready_line(8080, 9090, "0.1.0"),
            R"({"event":"ready","port":8080,"admin_port":9090,"version":"0.1.0"})");
}

TEST(JobLog, KeepsOrderAndNeverBlocksOnAReaderThatStopped) {
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe(ends.data()), 0);
  {
    JobLog log(32, "info", ends[1]);
    log.write("first");
    const std::string line(200, 'x');
    while (log.flush(milliseconds(100))) {  // until the pipe is full
      for (int i = 0; i < 30; ++i) log.write(line);
    }
    for (int i = 0; i < 1000; ++i) log.write(line);  // returns though nobody reads
    EXPECT_GT(log.dropped(), 900U);
    std::array<char, 5> first{};
    ASSERT_EQ(read(ends[0], first.data(), first.size()), 5);
    EXPECT_EQ(std::string(first.data(), 5), "first");
    std::string rest;
    std::array<char, 65536> some{};
    while (!log.flush(milliseconds(0))) {  // reading continues: the rest comes, with the number of
                                           // lost lines
      const auto n = read(ends[0], some.data(), some.size());
      if (n > 0) rest.append(some.data(), static_cast<std::size_t>(n));
    }
    if (rest.find("log_dropped") == rest.npos) {
      const auto n = read(ends[0], some.data(), some.size());
      rest.append(some.data(), static_cast<std::size_t>(n));
    }
    EXPECT_NE(rest.find(R"("event":"log_dropped","count":)"), rest.npos);
  }
  close(ends[0]);
  close(ends[1]);
}

/// A reader that has stopped costs 4 MiB of lines, however long and however many they may be.
TEST(JobLog, IsBoundedInBytes) {
  signal(SIGPIPE, SIG_IGN);
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe(ends.data()), 0);
  JobLog log(1'000'000, "info", ends[1]);
  const std::string line(kLongestLine, 'x');
  for (int i = 0; i < 1000; ++i) log.write(line);  // 16 MB
  EXPECT_GE(log.dropped(), 1000U - (4u << 20) / kLongestLine - 8);
  EXPECT_LT(log.dropped(), 1000U - (3u << 20) / kLongestLine);
  close(ends[0]);
}

TEST(JobLog, EndsWithoutAReader) {
  signal(SIGPIPE, SIG_IGN);  // as the service does
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe(ends.data()), 0);
  {
    JobLog log(32, "info", ends[1]);
    for (int i = 0; i < 1000; ++i) log.write(std::string(200, 'x'));
  }
  SUCCEED();
  close(ends[0]);  // the thread left behind sees a closed pipe now
}

TEST(JobLog, OmitsOnlyJobsBelowItsLevel) {
  const auto written = [](const std::string& least) {
    std::array<int, 2> ends{};
    EXPECT_EQ(pipe(ends.data()), 0);
    JobLog log(32, least, ends[1]);
    for (const int status : {200, 304, 400, 499, 500, 504}) {
      log.write_job(status, std::to_string(status));
    }
    log.write("stopping");
    EXPECT_TRUE(log.flush(milliseconds(5000)));
    EXPECT_EQ(log.dropped(), 0U);
    std::array<char, 256> some{};
    const auto n = read(ends[0], some.data(), some.size());
    close(ends[0]);
    close(ends[1]);
    return std::string(some.data(), static_cast<std::size_t>(n));
  };
  EXPECT_EQ(written("info"), "200\n304\n400\n499\n500\n504\nstopping\n");
  EXPECT_EQ(written("warning"), "400\n499\n500\n504\nstopping\n");
  EXPECT_EQ(written("error"), "500\n504\nstopping\n");
}

TEST(JobLog, CountsDroppedLines) {
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe(ends.data()), 0);
  signal(SIGPIPE, SIG_IGN);
  close(ends[0]);
  JobLog log(32, "info", ends[1]);
  log.write("lost");
  EXPECT_TRUE(log.flush(milliseconds(5000)));
  EXPECT_EQ(log.dropped(), 1U);
  close(ends[1]);
}

}  // namespace
}  // namespace tubecut::server
