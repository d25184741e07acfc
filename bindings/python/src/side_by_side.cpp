#include "side_by_side.h"

#include <nanobind/nanobind.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace pliant::python {

namespace {

namespace nb = nanobind;

/// The work that threads share.
class Shared {
 public:
  Shared(int n, const std::function<void(int)>& work) : n_(n), work_(work) {}

  /// What each thread does: one item after another.
  void run() {
    for (int i = next_++; i < n_ && !ended_; i = next_++) {
      try {
        work_(i);
      } catch (...) {
        keep(i, std::current_exception());
      }
    }
    const std::lock_guard lock(mutex_);
    ++done_;
    all_done_.notify_one();
  }

  void end() { ended_ = true; }

  /// True if all threads have ended within a time.
  bool wait(int threads, std::chrono::milliseconds time) {
    std::unique_lock lock(mutex_);
    return all_done_.wait_for(lock, time, [&] { return done_ == threads; });
  }

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
  std::condition_variable all_done_;
  int done_ = 0, failed_ = 0;
  std::exception_ptr failure_;
};

}  // namespace

void side_by_side(int n, int threads, const std::function<void(int)>& work, const std::function<void()>& stop) {
  const int hardware = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  const int count = std::min(threads == 0 ? hardware : threads, n);
  if (count < 1) return;
  Shared shared(n, work);
  bool interrupted = false;
  {
    std::vector<std::jthread> all;
    all.reserve(static_cast<std::size_t>(count));
    for (int t = 0; t < count; ++t) all.emplace_back([&shared] { shared.run(); });
    constexpr std::chrono::milliseconds interval{20};
    for (bool done = false; !done;) {
      {
        const nb::gil_scoped_release release;
        done = shared.wait(count, interval);
      }
      if (done || interrupted || PyErr_CheckSignals() == 0) continue;
      interrupted = true;
      shared.end();
      stop();
    }
  }
  if (interrupted) throw nb::python_error();
  if (shared.failure() != nullptr) std::rethrow_exception(shared.failure());
}

}  // namespace pliant::python
