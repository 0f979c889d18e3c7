#pragma once

#include <coroutine>
#include <exception>
#include <optional>
#include <utility>

namespace tubecut::server {

class Chain;

/// The common part of all tasks' promises.
struct TaskPromise {
  /// Back to whoever awaits the task.
  struct Return {
    [[nodiscard]] bool await_ready() const noexcept { return false; }
    template <class Promise>
    void await_suspend(std::coroutine_handle<Promise> done) const noexcept;
    void await_resume() const noexcept {}
  };

  [[nodiscard]] std::suspend_always initial_suspend() const noexcept { return {}; }
  [[nodiscard]] Return final_suspend() const noexcept { return {}; }
  void unhandled_exception() noexcept { failure = std::current_exception(); }
  void rethrow() const {
    if (failure) std::rethrow_exception(failure);
  }

  Chain* chain = nullptr;
  std::coroutine_handle<> caller = nullptr;
  std::exception_ptr failure = nullptr;
};

template <class T>
struct TaskResult : TaskPromise {
  void return_value(T result) { value = std::move(result); }
  T take() {
    rethrow();
    return *std::move(value);
  }
  std::optional<T> value;
};

template <>
struct TaskResult<void> : TaskPromise {
  void return_void() const noexcept {}
  void take() const { rethrow(); }
};

/// A coroutine that begins when it is awaited. Its exceptions go to its caller.
template <class T>
class [[nodiscard]] Task {
 public:
  struct promise_type : TaskResult<T> {  // NOLINT(readability-identifier-naming): the language's
    Task get_return_object() {
      return Task(std::coroutine_handle<promise_type>::from_promise(*this));
    }
  };

  Task() = default;
  Task(Task&& other) noexcept : coroutine_(std::exchange(other.coroutine_, nullptr)) {}
  Task& operator=(Task&& other) noexcept {
    std::swap(coroutine_, other.coroutine_);
    return *this;
  }
  ~Task() {
    if (coroutine_) coroutine_.destroy();
  }

  [[nodiscard]] bool await_ready() const noexcept { return false; }
  template <class Promise>
  void await_suspend(std::coroutine_handle<Promise> caller) const noexcept;
  T await_resume() const { return coroutine_.promise().take(); }

 private:
  friend class Chain;
  explicit Task(std::coroutine_handle<promise_type> coroutine) : coroutine_(coroutine) {}

  std::coroutine_handle<promise_type> coroutine_ = nullptr;
};

/// Tasks of which each awaits the next. Only `run` resumes them, one at a time: no call nests
/// deeper than one coroutine, however many end without a pause. (A compiler turns the tail calls of
/// symmetric transfer into jumps only when it optimises.)
class Chain {
 public:
  void begin(Task<void> first) {
    first_ = std::move(first);
    first_.coroutine_.promise().chain = this;
    top_ = first_.coroutine_;
  }

  /// On to the next pause, or to the end.
  void run() {
    paused_ = false;
    while (top_ && !paused_) top_.resume();
  }

  /// The first task has ended.
  [[nodiscard]] bool ended() const { return !top_; }

  /// Unwinds every task at its current point.
  void drop() {
    top_ = nullptr;
    first_ = {};
  }

  /// Awaited: `run` returns, and its next call goes on here.
  struct Pause {
    [[nodiscard]] bool await_ready() const noexcept { return false; }
    template <class Promise>
    void await_suspend(std::coroutine_handle<Promise> here) const noexcept {
      here.promise().chain->paused_ = true;
    }
    void await_resume() const noexcept {}
  };

 private:
  friend struct TaskPromise::Return;
  template <class T>
  friend class Task;

  Task<void> first_;
  std::coroutine_handle<> top_ = nullptr;
  bool paused_ = false;
};

template <class Promise>
void TaskPromise::Return::await_suspend(std::coroutine_handle<Promise> done) const noexcept {
  done.promise().chain->top_ = done.promise().caller;
}

template <class T>
template <class Promise>
void Task<T>::await_suspend(std::coroutine_handle<Promise> caller) const noexcept {
  auto& mine = coroutine_.promise();
  mine.chain = caller.promise().chain;
  mine.caller = caller;
  mine.chain->top_ = coroutine_;
}

}  // namespace tubecut::server
