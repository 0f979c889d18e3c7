#include "server/jobs/job_memory.hpp"

#include <algorithm>

namespace tubecut::server {
namespace {

/// Bytes requested at a time, because each request touches the port's memory.
constexpr std::size_t kStep = 1u << 20;

thread_local JobMemory* t_job = nullptr;  // NOLINT: operator new has no other way to know

}  // namespace

JobMemory::JobMemory(std::size_t given, Grow grow) : given_(given), grow_(std::move(grow)) {
  t_job = this;
}

JobMemory::~JobMemory() { t_job = nullptr; }

std::size_t JobMemory::peak_here() { return t_job != nullptr ? t_job->peak_ : 0; }

void JobMemory::take(std::size_t bytes) {
  if (t_job != nullptr && !t_job->asking_) t_job->ask(bytes);
}

void JobMemory::give(std::size_t bytes) noexcept {
  if (t_job != nullptr && !t_job->asking_) t_job->live_ -= std::min(t_job->live_, bytes);
}

void JobMemory::take_over(const Taken& taken) {
  if (t_job == nullptr) return;
  t_job->given_ += taken.given;
  t_job->live_ += taken.live;
  t_job->peak_ = std::max(t_job->peak_, t_job->live_);
}

void JobMemory::ask(std::size_t bytes) {
  const std::size_t held = live_ + bytes;
  if (held > given_) {
    const std::size_t least = held - given_, most = std::max(least, kStep);
    asking_ = true;
    std::size_t more = most;
    Grant grant = grow_(more);
    if (grant != Grant::given && least < most) grant = grow_(more = least);
    asking_ = false;
    if (grant != Grant::given) throw NoRoom(grant == Grant::in_use);
    given_ += more;
  }
  live_ = held;
  peak_ = std::max(peak_, held);
}

}  // namespace tubecut::server
