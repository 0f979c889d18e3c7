#pragma once

#include <cstddef>
#include <stop_token>
#include <utility>

namespace tubecut {

namespace detail {
inline constinit thread_local const std::stop_token* job_stop = nullptr;
}

/// While it lives, this thread works at the job that `stop` cancels. Scopes nest: the inner one
/// holds. The work itself takes no token, because every function would have to pass it on.
///
///     std::stop_source job;
///     const StopScope scope(job.get_token());
///     const auto table = bevel::table(spec);  // soon after job.request_stop(): incomplete
///     if (stopped()) return;                  // so nobody reads it
class StopScope {
 public:
  explicit StopScope(std::stop_token stop)
      : stop_(std::move(stop)), outer_(std::exchange(detail::job_stop, &stop_)) {}
  StopScope(const StopScope&) = delete;
  StopScope& operator=(const StopScope&) = delete;
  ~StopScope() { detail::job_stop = outer_; }

 private:
  std::stop_token stop_;
  const std::stop_token* outer_;
};

/// Returns true once the job of this thread is cancelled. A loop that may take more than some
/// 50 ms checks it. Without a scope, nothing cancels the work.
[[nodiscard]] inline bool stopped() {
  return detail::job_stop != nullptr && detail::job_stop->stop_requested();
}

/// Checks for cancellation in every 1024th iteration, for loops whose iterations take much less
/// than a microsecond. `iteration` counts from 0, so a loop that follows a cancelled one does
/// nothing.
[[nodiscard]] inline bool stops(std::size_t iteration) {
  return iteration % 1024 == 0 && stopped();
}

}  // namespace tubecut
