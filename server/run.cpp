#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <mutex>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "api/api.hpp"
#include "api/batch.hpp"
#include "server/app.hpp"
#include "server/identity.hpp"
#include "server/jobs/capacity.hpp"
#include "server/serve.hpp"
#include "server/status.hpp"

namespace tubecut::server {
namespace {

int run_one(std::istream& in, const Command& command) {
  const std::string body(std::istreambuf_iterator<char>(in), {});
  const std::string path = "/v1/" + command.endpoint;
  std::vector<std::pair<std::string, std::string>> options;
  for (const auto& option : command.options) {
    const auto equals = std::min(option.find('='), option.size());
    options.emplace_back(option.substr(0, equals),
                         option.substr(std::min(equals + 1, option.size())));
  }
  const std::string query = api::format_query(command.format, options);
  const std::string id = random_id();
  const auto outcome = api::dispatch({.method = "POST",
                                      .path = path,
                                      .query = query,
                                      .accept = "application/json",
                                      .content_type = "application/json",
                                      .body = body,
                                      .job_id = {},
                                      .request_id = id},
                                     {.clock = steady_seconds, .status = status_of});
  std::fwrite(outcome.body.data(), 1, outcome.body.size(), stdout);
  return outcome.error ? 1 : 0;
}

/// The lines of a batch, read as they are wanted and answered by as many threads as a service here
/// would have slots.
class Lines {
 public:
  /// `size`: of the file in bytes; 0 if unknown.
  Lines(std::istream& in, std::uintmax_t size) : in_(in), size_(size), app_({}), id_(random_id()) {}

  BatchCount run() {
    {
      std::vector<std::jthread> threads;
      for (int i = 0; i < std::max(1, capacity().slots); ++i)
        threads.emplace_back([this] { work(); });
    }
    const auto last = app_.summary({}, count_).body;
    std::fwrite(last.data(), 1, last.size(), stdout);
    if (watched_) std::fputc('\n', stderr);
    return count_;
  }

 private:
  void work() {
    for (;;) {
      Request request{.headers = {{"X-Request-Id", id_}}};
      {
        const std::lock_guard lock(mutex_);
        do {
          if (!std::getline(in_, request.body)) return;
          taken_ += request.body.size() + 1;
        } while (request.body.find_first_not_of(" \t\r") == std::string::npos);
        request.line = ++count_.items;
      }
      const BatchReply reply = app_.line(request);
      const std::lock_guard lock(mutex_);
      ++(reply.refused ? count_.refused : count_.answered);
      std::fwrite(reply.text.data(), 1, reply.text.size(), stdout);
      if (watched_) show();
    }
  }

  /// How many lines there are is not known before the end; how many bytes, of a file, is.
  void show() const {
    constexpr std::size_t kWidth = 40;
    const double share =
        size_ == 0 ? 0.0 : std::min(1.0, static_cast<double>(taken_) / static_cast<double>(size_));
    const auto full = static_cast<std::size_t>(share * kWidth);
    if (size_ > 0)
      fmt::print(stderr, "\r[{:#>{}}{:->{}}] {:3.0f} %", "", full, "", kWidth - full,
                 100.0 * share);
    fmt::print(stderr, "{}{} done, {} refused", size_ > 0 ? "  " : "\r",
               count_.answered + count_.refused, count_.refused);
  }

  std::istream& in_;
  std::uintmax_t size_;
  std::uintmax_t taken_ = 0;
  App app_;
  std::string id_;
  bool watched_ = isatty(STDERR_FILENO) == 1;
  std::mutex mutex_;
  BatchCount count_;
};

int run_batch(std::istream& in, std::uintmax_t size) {
  const auto count = Lines(in, size).run();
  if (count.answered == 0 && count.refused > 0)
    fmt::print(
        stderr,
        "tubecut-server: no line is a job {{\"id\", \"endpoint\", \"body\"}}; for a file that is "
        "one request give its --endpoint\n");
  return count.refused > 0 ? 1 : 0;
}

}  // namespace

int run(const Command& command) {
  std::ifstream file;
  if (command.file != "-") {
    file.open(command.file, std::ios::binary);
    if (!file) {
      fmt::print(stderr, "tubecut-server: cannot read {}\n", command.file);
      return 2;
    }
  }
  std::istream& in = command.file == "-" ? std::cin : file;
  std::error_code unknown;
  const auto size = std::filesystem::file_size(command.file, unknown);
  return command.endpoint.empty() ? run_batch(in, unknown ? 0 : size) : run_one(in, command);
}

}  // namespace tubecut::server
