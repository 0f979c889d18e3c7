#include "server/observe/job_files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <openssl/sha.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <filesystem>
#include <iterator>
#include <map>
#include <mutex>
#include <optional>
#include <system_error>
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

/// A file only: a pipe of that name would wait for its reader.
bool append(const std::string& file, std::string_view text, int more) {
  const int descriptor =
      ::open(file.c_str(), O_WRONLY | O_APPEND | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC | more, 0640);
  if (descriptor < 0) return false;
  struct stat about = {};
  const bool regular = ::fstat(descriptor, &about) == 0 && S_ISREG(about.st_mode);
  const auto written = regular ? ::write(descriptor, text.data(), text.size()) : -1;
  return ::close(descriptor) == 0 && written == static_cast<ssize_t>(text.size());
}

/// The identity in a file's name.
std::string identity_of(std::string_view name) {
  return std::string(name.substr(0, name.find('~')));
}

/// The folder of one day and what it holds; another replica's part of it is seen when it is opened.
class Day {
 public:
  Day(const std::string& folder, const std::string& day) : path_(folder + "/" + day) {
    ::mkdir(path_.c_str(), 0750);
    std::error_code unknown;
    for (const auto& entry : std::filesystem::directory_iterator(path_, unknown)) {
      const auto size = entry.file_size(unknown);
      count(identity_of(entry.path().filename().string()), 1, unknown ? 0 : size);
    }
  }

  [[nodiscard]] bool append(const std::string& name, std::string_view text,
                            const DayBounds& bounds) {
    const auto file = path_ + "/" + name + ".jsonl";
    struct stat about = {};
    const bool there = ::lstat(file.c_str(), &about) == 0;
    const auto own = identity_of(name);
    const Held more{there ? 0U : 1U, text.size()};
    const Held of_key{bounds.key_files > 0 ? bounds.key_files : bounds.files / 2,
                      bounds.key_bytes > 0 ? bounds.key_bytes : bounds.bytes / 2};
    if (!fits(all_, more, {bounds.files, bounds.bytes}) || !fits(of_[own], more, of_key))
      return false;
    if (!server::append(file, text, there ? 0 : O_CREAT)) return false;
    count(own, more.files, more.bytes);
    return true;
  }

 private:
  struct Held {
    std::size_t files = 0;
    std::size_t bytes = 0;
  };

  [[nodiscard]] static bool fits(const Held& held, const Held& more, const Held& most) {
    return held.files + more.files <= most.files && more.bytes <= most.bytes &&
           held.bytes <= most.bytes - more.bytes;
  }
  void count(const std::string& identity, std::size_t files, std::size_t bytes) {
    for (auto* held : {&all_, &of_[identity]}) {
      held->files += files;
      held->bytes += bytes;
    }
  }

  std::string path_;
  Held all_;
  std::map<std::string, Held> of_;  // each key's jobs
};

/// A folder that does not answer must not keep the process from ending.
constexpr auto kPatience = std::chrono::seconds(1);
constexpr auto kTellAgain = std::chrono::minutes(1);

}  // namespace

std::string file_name_of(std::string_view identity, std::string_view job) {
  std::string out = std::string(identity) + "~";
  if (safe(job)) return out.append(job);
  std::array<unsigned char, SHA256_DIGEST_LENGTH> digest{};
  const std::vector<unsigned char> bytes(job.begin(), job.end());
  SHA256(bytes.data(), bytes.size(), digest.data());
  out += "id-";
  for (std::size_t i = 0; i < digest.size() / 2; ++i) {
    fmt::format_to(std::back_inserter(out), "{:02x}", digest[i]);
  }
  return out;
}

struct JobFiles::Impl {
  struct Entry {
    std::string day, name, lines;
    [[nodiscard]] std::size_t bytes() const {
      return sizeof(Entry) + day.size() + name.size() + lines.size();
    }
  };

  void run() {
    std::unique_lock lock(mutex);
    for (;;) {
      some.wait(lock, [this] { return ending || !queue.empty(); });
      if (queue.empty()) break;
      const Entry entry = std::move(queue.front());
      queue.pop_front();
      held -= entry.bytes();
      lock.unlock();
      if (!day || last != entry.day) day.emplace(folder, last = entry.day);
      if (!day->append(entry.name, entry.lines, bounds)) lose(identity_of(entry.name));
      lock.lock();
    }
    ended = true;
    done.notify_all();
  }

  /// From any thread.
  void lose(const std::string& identity) {
    ++dropped;
    if (!lost) return;
    const auto now = std::chrono::steady_clock::now();
    {
      const std::lock_guard lock(telling);
      const auto [at, first] = told.try_emplace(identity, now);
      if (!first && now - at->second < kTellAgain) return;
      at->second = now;
    }
    lost(identity);
  }

  std::string folder;
  DayBounds bounds;
  std::function<void(const std::string& identity)> lost;
  std::mutex telling;
  std::map<std::string, std::chrono::steady_clock::time_point> told;  // keys whose loss was told
  std::string last;                                                   // day
  std::optional<Day> day;  // its folder; the thread's alone
  std::size_t most = 0;    // bytes of the queue
  std::size_t held = 0;    // of them
  std::mutex mutex;
  std::condition_variable some;
  std::condition_variable done;
  std::deque<Entry> queue;
  bool ending = false;
  bool ended = false;
  std::atomic<std::uint64_t> dropped = 0;
};

JobFiles::JobFiles(std::string folder, DayBounds bounds, std::size_t queue_bytes,
                   std::function<void(const std::string& identity)> lost)
    : x_(std::make_shared<Impl>()) {
  x_->folder = std::move(folder);
  x_->bounds = bounds;
  x_->most = queue_bytes;
  x_->lost = std::move(lost);
  std::thread([x = x_] { x->run(); }).detach();
}

JobFiles::~JobFiles() {
  std::unique_lock lock(x_->mutex);
  x_->ending = true;
  x_->some.notify_all();
  x_->done.wait_for(lock, kPatience, [this] { return x_->ended; });
}

void JobFiles::write(std::string_view day, std::string_view identity, std::string_view job,
                     std::string lines) {
  Impl::Entry entry{std::string(day), file_name_of(identity, job), std::move(lines)};
  bool fits = false;
  {
    const std::lock_guard lock(x_->mutex);
    fits = entry.bytes() <= x_->most - x_->held;
    if (fits) {
      x_->held += entry.bytes();
      x_->queue.push_back(std::move(entry));
    }
  }
  if (!fits) return x_->lose(std::string(identity));
  x_->some.notify_one();
}

std::uint64_t JobFiles::dropped() const { return x_->dropped; }

}  // namespace tubecut::server
