#pragma once

#include <cstddef>
#include <functional>
#include <new>

namespace tubecut::server {

/// A job needs more memory than there is for it.
struct NoRoom : std::bad_alloc {
  explicit NoRoom(bool ever) : ever_fits(ever) {}
  [[nodiscard]] const char* what() const noexcept override { return "no memory for the job"; }
  bool ever_fits;  // it is in use now; false: the whole of it would not be enough
};

/// The memory that this thread takes for one job, counted to the byte in operator new. If the job
/// needs more than it was given, it requests more; if that fails, operator new throws NoRoom, so no
/// job takes memory that is not reserved for it. Counts only in programs that link counted_new.cpp.
class JobMemory {
 public:
  enum class Grant { given, in_use, never };
  /// Grants this number of bytes more, or returns the reason for the refusal.
  using Grow = std::function<Grant(std::size_t bytes)>;

  /// `given`: initial bytes. One object at a time per thread.
  JobMemory(std::size_t given, Grow grow);
  ~JobMemory();
  JobMemory(const JobMemory&) = delete;
  JobMemory& operator=(const JobMemory&) = delete;

  /// Peak of the bytes held until now.
  [[nodiscard]] std::size_t peak() const { return peak_; }

  /// The same for the job of this thread; 0 without a job.
  [[nodiscard]] static std::size_t peak_here();

  /// Memory that another thread has taken for the job, and its grant, which now pass to this
  /// thread's job.
  struct Taken {
    std::size_t given = 0, live = 0;
  };
  [[nodiscard]] Taken taken() const { return {given_, live_}; }
  static void take_over(const Taken& taken);

  /// For operator new and delete: the thread's job takes or frees a block. Freeing other threads'
  /// blocks does not count against them.
  static void take(std::size_t bytes);
  static void give(std::size_t bytes) noexcept;

 private:
  void ask(std::size_t bytes);

  std::size_t given_;
  std::size_t live_ = 0;
  std::size_t peak_ = 0;
  Grow grow_;
  bool asking_ = false;  // memory taken while requesting does not count for the job
};

}  // namespace tubecut::server
