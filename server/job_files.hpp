#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace tubecut::server {

/// One file per job, `<folder>/<day>/<job>.jsonl`, written by a thread of its own: a slow disk
/// blocks no job. The queue is bounded; what does not fit is dropped and counted.
class JobFiles {
 public:
  explicit JobFiles(std::string folder, std::size_t queue = 1024);
  ~JobFiles();  // writes what is queued, for a second at most
  JobFiles(const JobFiles&) = delete;
  JobFiles& operator=(const JobFiles&) = delete;

  /// Appends lines to the file of that job on that day ("2024-03-01").
  void write(std::string_view day, std::string_view job, std::string lines);

  /// Files not written: the queue was full or the disk refused.
  [[nodiscard]] std::uint64_t dropped() const;

 private:
  struct Impl;
  std::shared_ptr<Impl> x_;  // the thread's too: it may hang in a write
};

/// The name of a job's file without its ending: the id where it is safe as a file's name, else
/// "id-" and the first half of its SHA-256 in hex.
[[nodiscard]] std::string file_name_of(std::string_view job);

}  // namespace tubecut::server
