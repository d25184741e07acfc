#include "crew.h"

#include <nanobind/nanobind.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace pliant::python {

namespace {

namespace nb = nanobind;

/// The work of one call.
class Job {
 public:
  Job(int n, const std::function<void(int)>& work) : n_(n), work_(work) {}

  /// What each thread does: one item after another.
  void run() {
    for (int i = next_++; i < n_ && !ended_; i = next_++) {
      try {
        work_(i);
      } catch (...) {
        keep(i, std::current_exception());
      }
    }
  }

  void end() { ended_ = true; }
  std::exception_ptr failure() const { return failure_; }

 private:
  void keep(int i, std::exception_ptr failure) {
    const std::lock_guard lock(mutex_);
    if (failure_ != nullptr && i > failed_) return;
    failure_ = std::move(failure);
    failed_ = i;
    ended_ = true;
  }

  const int n_;
  const std::function<void(int)>& work_;
  std::atomic<int> next_{0};
  std::atomic<bool> ended_{false};
  std::mutex mutex_;
  int failed_ = 0;
  std::exception_ptr failure_;
};

}  // namespace

struct Crew::Threads {
  explicit Threads(int count) {
    all.reserve(static_cast<std::size_t>(count));
    try {
      for (int t = 0; t < count; ++t) all.emplace_back([this] { serve(); });
    } catch (...) {  // the system has no more threads
      end();
      throw;
    }
  }

  ~Threads() { end(); }

  void end() {
    {
      const std::lock_guard lock(mutex);
      is_over = true;
    }
    woken.notify_all();
    for (std::thread& thread : all) thread.join();
  }

  /// What each thread does: one job after another.
  void serve() {
    std::unique_lock lock(mutex);
    for (std::int64_t served = 0;; served = jobs) {
      woken.wait(lock, [&] { return is_over || jobs != served; });
      if (is_over) return;
      Job& present = *job;
      lock.unlock();
      present.run();
      lock.lock();
      if (--busy == 0) all_done.notify_one();
    }
  }

  void begin(Job& next) {
    const std::lock_guard lock(mutex);
    job = &next;
    busy = static_cast<int>(all.size());
    ++jobs;
    woken.notify_all();
  }

  /// True if all threads have ended the job within a time.
  bool wait(std::chrono::milliseconds time) {
    std::unique_lock lock(mutex);
    return all_done.wait_for(lock, time, [&] { return busy == 0; });
  }

  const pid_t process = ::getpid();
  std::mutex mutex;
  std::condition_variable woken, all_done;
  Job* job = nullptr;
  std::int64_t jobs = 0;  ///< so far
  int busy = 0;           ///< threads that have not ended the job
  bool is_over = false;
  std::vector<std::thread> all;
};

Crew::Crew(int threads)
    : most_(threads == 0 ? static_cast<int>(std::max(1u, std::thread::hardware_concurrency())) : threads) {}

Crew::~Crew() {
  if (threads_ != nullptr && threads_->process != ::getpid()) (void)threads_.release();  // a fork has left them behind
}

Crew::Threads& Crew::ready(int count) {
  if (threads_ != nullptr && threads_->process != ::getpid()) (void)threads_.release();
  if (threads_ == nullptr) threads_ = std::make_unique<Threads>(std::min(most_, count));
  return *threads_;
}

void Crew::run(int n, const std::function<void(int)>& work, const std::function<void()>& stop) {
  if (n < 1) return;
  Threads& threads = ready(n);
  Job job(n, work);
  bool interrupted = false;
  threads.begin(job);
  constexpr std::chrono::milliseconds interval{20};
  for (bool done = false; !done;) {
    {
      const nb::gil_scoped_release release;
      done = threads.wait(interval);
    }
    if (done || interrupted || PyErr_CheckSignals() == 0) continue;
    interrupted = true;
    job.end();
    stop();
  }
  if (interrupted) throw nb::python_error();
  if (job.failure() != nullptr) std::rethrow_exception(job.failure());
}

}  // namespace pliant::python
