#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace tubecut::server {

/// What one day's folder may hold, and of that what one key's jobs may; beyond it nothing is
/// written.
struct DayBounds {
  std::size_t files = 100'000;
  std::size_t bytes = std::size_t{1} << 30;
  std::size_t key_files = 0;  // 0: half of all
  std::size_t key_bytes = 0;
};

/// One file per job, `<folder>/<day>/<identity>~<job>.jsonl`, written by a thread of its own: a
/// slow disk blocks no job. Queue and folders are bounded by bytes; what does not fit is dropped
/// and counted, and `lost` is told whose it was, once a minute for each key.
class JobFiles {
 public:
  explicit JobFiles(std::string folder, DayBounds bounds = {},
                    std::size_t queue_bytes = std::size_t{4} << 20,
                    std::function<void(const std::string& identity)> lost = {});
  ~JobFiles();  // writes what is queued, for a second at most
  JobFiles(const JobFiles&) = delete;
  JobFiles& operator=(const JobFiles&) = delete;

  /// Appends lines to the file of that job of `identity`, a key's, on that day ("2024-03-01").
  void write(std::string_view day, std::string_view identity, std::string_view job,
             std::string lines);

  /// Entries not written: the queue or the day's folder was full, or the disk refused.
  [[nodiscard]] std::uint64_t dropped() const;

 private:
  struct Impl;
  std::shared_ptr<Impl> x_;  // the thread's too: it may hang in a write
};

/// Returns the name of a job's file without its ending: the identity of its key, a '~', which
/// neither part can contain, so that no id names another key's file, and the id if it is safe as a
/// file name, else "id-" and the first half of its SHA-256 in hex.
[[nodiscard]] std::string file_name_of(std::string_view identity, std::string_view job);

}  // namespace tubecut::server
