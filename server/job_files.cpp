#include "server/job_files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <openssl/sha.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <iterator>
#include <mutex>
#include <thread>
#include <vector>

namespace tubecut::server {
namespace {

bool safe(std::string_view name) {
  return !name.empty() && name.size() <= 128 && name.front() != '.' &&
         std::ranges::all_of(name, [](char c) {
           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                  c == '.' || c == '_' || c == '-';
         });
}

bool append(const std::string& file, std::string_view text) {
  const int descriptor =
      ::open(file.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_NOFOLLOW | O_CLOEXEC, 0640);
  if (descriptor < 0) return false;
  const auto written = ::write(descriptor, text.data(), text.size());
  return ::close(descriptor) == 0 && written == static_cast<ssize_t>(text.size());
}

}  // namespace

std::string file_name_of(std::string_view job) {
  if (safe(job)) return std::string(job);
  std::array<unsigned char, SHA256_DIGEST_LENGTH> digest{};
  const std::vector<unsigned char> bytes(job.begin(), job.end());
  SHA256(bytes.data(), bytes.size(), digest.data());
  std::string out = "id-";
  for (std::size_t i = 0; i < digest.size() / 2; ++i) {
    fmt::format_to(std::back_inserter(out), "{:02x}", digest[i]);
  }
  return out;
}

struct JobFiles::Impl {
  struct Entry {
    std::string day, name, lines;
  };

  void run() {
    std::unique_lock lock(mutex);
    for (;;) {
      some.wait(lock, [this] { return ending || !queue.empty(); });
      if (queue.empty()) return;
      const Entry entry = std::move(queue.front());
      queue.pop_front();
      lock.unlock();
      const std::string day = folder + "/" + entry.day;
      ::mkdir(day.c_str(), 0750);
      if (!append(day + "/" + entry.name + ".jsonl", entry.lines)) ++dropped;
      lock.lock();
    }
  }

  std::string folder;
  std::size_t most = 0;
  std::mutex mutex;
  std::condition_variable some;
  std::deque<Entry> queue;
  bool ending = false;
  std::atomic<std::uint64_t> dropped = 0;
  std::thread thread;
};

JobFiles::JobFiles(std::string folder, std::size_t queue) : x_(std::make_unique<Impl>()) {
  x_->folder = std::move(folder);
  x_->most = queue;
  x_->thread = std::thread([this] { x_->run(); });
}

JobFiles::~JobFiles() {
  {
    const std::lock_guard lock(x_->mutex);
    x_->ending = true;
  }
  x_->some.notify_all();
  x_->thread.join();
}

void JobFiles::write(std::string_view day, std::string_view job, std::string lines) {
  {
    const std::lock_guard lock(x_->mutex);
    if (x_->queue.size() >= x_->most) {
      ++x_->dropped;
      return;
    }
    x_->queue.push_back({std::string(day), file_name_of(job), std::move(lines)});
  }
  x_->some.notify_one();
}

std::uint64_t JobFiles::dropped() const { return x_->dropped; }

}  // namespace tubecut::server
