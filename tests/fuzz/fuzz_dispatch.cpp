#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <thread>

#include "core/base/stop.hpp"
#include "tests/fuzz/dispatch_bytes.hpp"

namespace {

/// The service ends a job that is over its budget; here it is wider, because every access is
/// checked. If a job continues after the stop, libFuzzer's own timeout finds it.
constexpr std::chrono::seconds kBudget{5};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::stop_source over;
  const std::jthread budget([&over](const std::stop_token& answered) {
    std::mutex mutex;
    std::unique_lock lock(mutex);
    std::condition_variable_any().wait_for(lock, answered, kBudget, [] { return false; });
    over.request_stop();
  });
  const tubecut::StopScope scope(over.get_token());
  tubecut::fuzz::dispatch_bytes({data, size});
  return 0;
}
