#pragma once

#include <atomic>
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

/// The memory that this thread takes for one job, counted to the byte wherever operator new asks
/// for some. Beyond what it was given the job asks for more, and where there is none operator new
/// throws NoRoom: no job takes what was not set aside for it. Counted only in programs that link
/// counted_new.cpp.
class JobMemory {
 public:
  enum class Grant { given, in_use, never };
  /// Gives so many bytes more, or says why not.
  using Grow = std::function<Grant(std::size_t bytes)>;

  /// `given`: bytes to begin with. One at a time in a thread. `live`: where other threads read how
  /// many bytes it holds; nullptr: none do.
  JobMemory(std::size_t given, Grow grow, std::atomic<std::size_t>* live = nullptr);
  ~JobMemory();
  JobMemory(const JobMemory&) = delete;
  JobMemory& operator=(const JobMemory&) = delete;

  /// The most bytes at a time so far.
  [[nodiscard]] std::size_t peak() const { return peak_; }

  /// The same of the job that this thread works on; 0: none.
  [[nodiscard]] static std::size_t peak_here();

  /// What another thread has taken for the job, and what it was given for that, is this thread's
  /// job's from now on.
  struct Taken {
    std::size_t given = 0, live = 0;
  };
  [[nodiscard]] Taken taken() const { return {given_, live()}; }
  static void take_over(const Taken& taken);

  /// For operator new and delete: the thread's job takes a block, or gives it back. What it frees
  /// of others' is not held against them.
  static void take(std::size_t bytes);
  static void give(std::size_t bytes) noexcept;

 private:
  void ask(std::size_t bytes);
  /// One thread writes: no other can come between reading and writing.
  void set_live(std::size_t bytes) noexcept { live_->store(bytes, std::memory_order_relaxed); }
  [[nodiscard]] std::size_t live() const noexcept { return live_->load(std::memory_order_relaxed); }

  std::size_t given_;
  std::atomic<std::size_t> own_ = 0;
  std::atomic<std::size_t>* live_;
  std::size_t peak_ = 0;
  Grow grow_;
  bool asking_ = false;  // what asking takes is not the job's
};

}  // namespace tubecut::server
