#pragma once

#include <atomic>
#include <cstddef>
#include <string>
#include <utility>

namespace tubecut::server {

/// Frees a text's memory. `text = {}` would assign an empty list and keep the bytes.
inline void give_back(std::string& text) { std::string().swap(text); }

/// A bound on bytes, and the number in use, counted by the shares that hold them. From any thread.
class MemoryBound {
 public:
  /// 0: no bound. Bytes in use here count for `whole` too.
  explicit MemoryBound(std::size_t most, MemoryBound* whole = nullptr)
      : most_(most), whole_(whole) {}
  MemoryBound(const MemoryBound&) = delete;
  MemoryBound& operator=(const MemoryBound&) = delete;

  [[nodiscard]] std::size_t used() const { return used_; }
  [[nodiscard]] std::size_t most() const { return most_; }
  /// Returns whether this number of bytes is free.
  [[nodiscard]] bool has(std::size_t bytes) const { return most_ == 0 || used_ + bytes <= most_; }

 private:
  friend class MemoryShare;
  /// Takes this number of bytes if they are free, also when other threads take some at the same
  /// time.
  [[nodiscard]] bool take(std::size_t bytes) {
    change(bytes);
    if (has(0)) return true;
    change(-bytes);
    return false;
  }
  void change(std::size_t by) {  // modulo 2^64: less is right too
    used_ += by;
    if (whole_ != nullptr) whole_->change(by);
  }

  std::atomic<std::size_t> used_ = 0;
  std::size_t most_;
  MemoryBound* whole_;
};

/// Bytes of a bound, given back at the end of its life.
class MemoryShare {
 public:
  MemoryShare() = default;
  explicit MemoryShare(MemoryBound& of, std::size_t bytes = 0) : of_(&of) { resize(bytes); }
  MemoryShare(MemoryShare&& other) noexcept
      : of_(std::exchange(other.of_, nullptr)), bytes_(std::exchange(other.bytes_, 0)) {}
  MemoryShare& operator=(MemoryShare&& other) noexcept {
    std::swap(of_, other.of_);
    std::swap(bytes_, other.bytes_);
    return *this;
  }
  ~MemoryShare() { resize(0); }

  [[nodiscard]] std::size_t bytes() const { return bytes_; }
  void resize(std::size_t bytes) {
    if (of_ != nullptr) of_->change(bytes - bytes_);
    bytes_ = bytes;
  }
  /// Takes this number of bytes more. If they are not free, returns false and takes nothing.
  [[nodiscard]] bool grow(std::size_t by) {
    if (of_ != nullptr && !of_->take(by)) return false;
    bytes_ += by;
    return true;
  }

 private:
  MemoryBound* of_ = nullptr;
  std::size_t bytes_ = 0;
};

}  // namespace tubecut::server
