#include "server/jobs/slots.hpp"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <exception>
#include <utility>

namespace tubecut::server {
namespace {

/// Computing gives way to reading, refusing and sending, which take microseconds. Linux keeps the
/// nice value per thread.
constexpr int kNice = 5;
constexpr int kLaneNice =
    1;  // of the threads that do quick jobs alone: beside long ones they come first

/// A job expected to take no longer is quick, where its body is small too: a plain bevel table is,
/// with its torch line some 20 ms.
constexpr double kQuick = 0.04;
constexpr std::size_t kQuickBytes = 64u << 10;
/// One takes the lane when it has waited so long: while slots come free, nothing runs beside them.
constexpr double kLaneAfter = 0.005;
/// One that has had so much CPU in the lane, or has it for so long, is not quick.
constexpr double kOutgrown = 0.1;
constexpr double kHeld = 0.4;
constexpr int kLane = 1;
/// Jobs beyond the slots that may have outgrown the lane at a time.
constexpr int kSpare = 1;
/// Until the first of a kind is done. One that may take more than so much CPU is not tried.
constexpr std::chrono::seconds kTried{5};
constexpr double kUnknown = 0.005;
/// Weight of the last job in its kind's mean. What takes long is believed sooner: the lane is not
/// for a kind of which some are long.
constexpr double kRise = 0.2;
constexpr double kFall = 0.05;

/// Clients whose means are kept.
constexpr std::size_t kClients = 4096;

void step_back(int by) {
  const auto thread = static_cast<id_t>(::syscall(SYS_gettid));
  static_cast<void>(::setpriority(PRIO_PROCESS, thread, ::getpriority(PRIO_PROCESS, thread) + by));
}

double cpu_s(const Job& job) { return std::chrono::duration<double>(used(job)).count(); }

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

std::chrono::nanoseconds used(const Job& job) {
  return job.cpu.used() + std::chrono::nanoseconds(job.helped_ns);
}

Slots::Slots(int count, std::size_t queue, Step work, Step done)
    : work_(std::move(work)),
      done_(std::move(done)),
      count_(std::max(1, count)),
      most_(queue + static_cast<std::size_t>(count_)),
      helpers_(static_cast<std::size_t>(count_) - 1, [] { step_back(kNice); }) {
  helpers_.allow(count_);
  const auto all = threads(count_);
  running_.reserve(all);
  while (threads_.size() < all)
    threads_.emplace_back([this, lane = threads_.size() < kLane] { run(lane); });
}

std::size_t Slots::threads(int slots) {
  return static_cast<std::size_t>(std::max(1, slots) + kLane + kSpare);
}

void Slots::join() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
    any_.wake_all();
    quick_.wake_all();
  }
  for (auto& thread : threads_) {
    if (thread.joinable()) thread.join();
  }
  helpers_.join();
}

/// What the client's jobs of the kind take: others' long ones do not make its own long. One who has
/// asked for none yet is believed to ask for what is quick, where others' jobs of the kind tell.
const double* Slots::mean_of(const Job& job) const {
  const auto all = means_.find(job.kind);
  if (all == means_.end()) return nullptr;
  const auto client = of_clients_.find(job.claim.client);
  if (client == of_clients_.end()) return &kUnknown;
  const auto own = client->second.find(job.kind);
  return own == client->second.end() ? &kUnknown : &own->second;
}

void Slots::estimate(Job& job) const {
  const double* const mean = mean_of(job);
  const bool known = mean != nullptr;
  job.claim.expected_s = known ? *mean : kUnknown;
  const bool bodiless = job.request.body.empty();
  const bool short_budget = job.budget.cpu > kTried.zero() && job.budget.cpu <= kTried;
  job.claim.trial = mean == &kUnknown || (!known && !bodiless);
  job.claim.quick = job.request.line == 0 && job.claim.expected_s <= kQuick &&
                    job.request.body.size() <= kQuickBytes && (known || bodiless || short_budget);
}

double Slots::expected_wait(Job& job) const {
  const std::lock_guard lock(mutex_);
  estimate(job);
  double slots = queue_.before(job.claim, false);
  double lane = queue_.before(job.claim, true);
  const double now = now_s();
  for (const auto& running : running_) {
    const double left = std::max(0.0, running->began_s + running->claim.expected_s - now);
    (running->in_lane ? lane : slots) += left;
  }
  const double wait = in_slots_ < count_ ? 0.0 : slots / count_;
  return job.claim.quick ? std::min(wait, lane / kLane) : wait;
}

std::chrono::nanoseconds Slots::cpu(const Job& job) const {
  const std::lock_guard lock(mutex_);  // a thread whose job runs lives
  return used(job);
}

Slots::Offer Slots::offer(const std::shared_ptr<Job>& job) {
  Offer out{.taken = true};
  std::unique_lock lock(mutex_);
  estimate(*job);
  job->claim.since = now_s();
  const auto most = most_ + (job->claim.quick ? kLane : 0);
  if (queue_.size() + running_.size() >= most) {
    out.displaced = queue_.give_way(job->claim);
    if (!out.displaced) return {};
  }
  queue_.push(job);
  waiting_ = queue_.size();
  tell_helpers();
  auto* const called = call_one(job->claim.quick);
  lock.unlock();  // who is woken would at once wait for the mutex
  if (called != nullptr) called->wake_one();
  return out;
}

bool Slots::waits(const Job& job) const {
  const std::lock_guard lock(mutex_);
  return job.began_s == 0.0;
}

bool Slots::withdraw(const std::shared_ptr<Job>& job) {
  const std::lock_guard lock(mutex_);
  const bool waited = queue_.remove(job);
  waiting_ = queue_.size();
  tell_helpers();
  return waited;
}

void Slots::look(Job& job) {
  Sleepers* called = nullptr;
  {
    const std::lock_guard lock(mutex_);
    const bool waits = job.began_s == 0.0 && job.claim.quick && in_lane_ < kLane;
    const bool outgrown = job.in_lane && (cpu_s(job) > kOutgrown || now_s() - job.began_s > kHeld);
    if (!waits && (!outgrown || !has_spare())) return;
    if (outgrown) leave_lane(job);
    called = call_any(true);  // for the one place in the lane
  }
  if (called != nullptr) called->wake_one();
}

/// Calls a thread for a job that has come, where a slot is free that nobody is on the way to: to
/// wake more took longer than a short job. A quick one's own thread comes before long jobs'.
/// Returns whom to `wake_one`, best without the mutex, which is held here.
Sleepers* Slots::call_one(bool quick) {
  if (in_slots_ + back_ + any_.called() + quick_.called() >= count_) return nullptr;
  return call_any(quick);
}

Sleepers* Slots::call_any(bool quick) {
  if (quick && quick_.call()) return &quick_;
  return any_.call() ? &any_ : nullptr;
}

void Slots::leave_lane(Job& job) {
  learn(job, std::max(cpu_s(job), kOutgrown));
  queue_.slow(job.kind, job.claim.client);
  job.in_lane = false;
  --in_lane_;
  ++in_slots_;
  tell_helpers();
}

/// Slots that nobody uses or waits for are theirs.
void Slots::tell_helpers() {
  helpers_.allow(queue_.size() > 0 ? 0 : std::max(0, count_ - in_slots_));
}

/// Whether a job that outgrows the lane can make room in it.
bool Slots::has_spare() const { return in_slots_ < count_ + kSpare; }

/// The job whose turn it is, if there is a place for it. The thread of quick jobs has a slot only
/// while it is a quick one's turn: else a long job would wait behind quick ones that come for ever.
std::shared_ptr<Job> Slots::next(bool quick_only) {
  bool slot = in_slots_ < count_;
  if (slot && quick_only) {
    const Claim* const turn = queue_.next();
    slot = turn != nullptr && turn->quick;
  }
  if (!slot && in_lane_ >= kLane) return nullptr;
  auto job = slot ? queue_.pop() : queue_.pop_quick(now_s() - kLaneAfter, has_spare());
  if (!job) return nullptr;
  job->in_lane = !slot;
  ++(slot ? in_slots_ : in_lane_);
  job->began_s = now_s();
  job->cpu = CpuClock::of_this_thread();
  running_.push_back(job);
  waiting_ = queue_.size();
  busy_ = static_cast<int>(running_.size());
  tell_helpers();
  return job;
}

void Slots::learn(const Job& job, double took) {
  const auto teach = [&](Means& means) {
    const auto [mean, first] = means.try_emplace(job.kind, took);
    if (!first) mean->second += (took > mean->second ? kRise : kFall) * (took - mean->second);
  };
  try {
    teach(means_);
    if (of_clients_.size() >= kClients && !of_clients_.contains(job.claim.client))
      of_clients_.clear();  // they teach it again
    teach(of_clients_[job.claim.client]);
  } catch (const std::exception&) {  // no memory: the next one teaches it
  }
}

/// `own`: CPU of the job's thread.
void Slots::finish(Job& job, std::chrono::nanoseconds own) {
  const double took = now_s() - job.began_s;
  job.cpu.stop(own);
  --(job.in_lane ? in_lane_ : in_slots_);
  queue_.done(
      job.claim,
      took + std::chrono::duration<double>(std::chrono::nanoseconds(job.helped_ns)).count());
  learn(job, cpu_s(job));  // not what others made it wait
  std::erase_if(running_, [&job](const auto& one) { return one.get() == &job; });
  busy_ = static_cast<int>(running_.size());
  tell_helpers();
}

void Slots::run(bool quick_only) {
  step_back(quick_only ? kLaneNice : kNice);
  std::unique_lock lock(mutex_);
  std::shared_ptr<Job> done;  // to be handed over, once the next one is found or there is none
  for (;;) {
    auto job = ending_ ? nullptr : next(quick_only);
    auto* const called =  // it left a slot free
        quick_only && !ending_ && queue_.size() > 0 ? call_one(false) : nullptr;
    if (called != nullptr) called->wake_one();
    if (!job && !done) {
      if (ending_) return;
      (quick_only ? quick_ : any_).sleep(lock);
      continue;
    }
    const bool looks_again = !job;
    if (looks_again) ++back_;
    lock.unlock();
    if (done) done_(std::exchange(done, nullptr));
    std::chrono::nanoseconds own{0};
    if (job) {
      CpuLimit limit(job->all_cpu, job->budget.cpu, job->cpu);
      work_(job);
      own = limit.end();
    }
    lock.lock();
    if (looks_again) --back_;
    if (job) finish(*job, own);  // before its answer is out: who gets it finds the slot free
    done = std::move(job);
  }
}

}  // namespace tubecut::server
