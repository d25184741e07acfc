// The parallel loop on all threads, by oneTBB.
#include "parallel/executor.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <mutex>
#include <thread>
#include <utility>

#if defined(__SANITIZE_THREAD__)
#include <sanitizer/tsan_interface.h>
#endif

namespace pliant {

namespace {

// Debian's oneTBB is built without the thread sanitizer, which would report every loop as a race. These annotations
// tell it where a loop starts and ends, so that it reports only races between loop bodies.
#if defined(__SANITIZE_THREAD__)
#define PLIANT_UNSEEN_BY_TSAN __attribute__((no_sanitize("thread")))
char handed_out, handed_back;
void hand_over_release(void* tag) { __tsan_release(tag); }
void hand_over_acquire(void* tag) { __tsan_acquire(tag); }
#else
#define PLIANT_UNSEEN_BY_TSAN
constexpr char handed_out = 0, handed_back = 0;
void hand_over_release(const void*) {}
void hand_over_acquire(const void*) {}
#endif

/// Raises oneTBB's limit of threads, which otherwise is the number of hardware threads. If there are several limits the
/// lowest holds, and oneTBB warns on standard error of larger requests. So one limit for the process is only raised,
/// and never released, because no moment at program exit is safe.
void raise_limit(std::size_t threads) {
  static std::mutex mutex;
  static std::size_t limit = std::max(1U, std::thread::hardware_concurrency());
  static tbb::global_control* control = nullptr;
  const std::lock_guard lock(mutex);
  if (threads <= limit) return;
  limit = threads;
  delete control;
  control = new tbb::global_control(tbb::global_control::max_allowed_parallelism, limit);
}

}  // namespace

struct Executor::Arena {
  explicit Arena(int threads) : arena(threads) { raise_limit(static_cast<std::size_t>(threads)); }
  tbb::task_arena arena;
};

Executor::Executor(int threads)
    : threads_(threads > 0 ? threads : std::max(1, tbb::this_task_arena::max_concurrency())),
      arena_(std::make_unique<Arena>(threads_)) {}
Executor::~Executor() = default;
Executor::Executor(Executor&&) noexcept = default;
Executor& Executor::operator=(Executor&&) noexcept = default;

void Executor::enter(FunctionRef<void()> f) {
  if (threads_ == 1) {
    f();
  } else {
    arena_->arena.execute([&] { f(); });
  }
}

namespace {

/// Gives a variable a value until the end of the scope, also if that is left by an exception.
template <class T>
class Restored {
 public:
  Restored(T& variable, T value) : variable_(variable), before_(variable) { variable_ = value; }
  ~Restored() { variable_ = before_; }
  Restored(const Restored&) = delete;
  Restored& operator=(const Restored&) = delete;

 private:
  T& variable_;
  T before_;
};

/// Calls body(i) for each i in [0, n) on the threads of the arena.
template <class Body>
void run_on_all_threads(int n, const Body& body, tbb::task_group_context& context) {
  hand_over_release(&handed_out);
  tbb::parallel_for(
      0, n, 1,
      [&](int i) PLIANT_UNSEEN_BY_TSAN {
        hand_over_acquire(&handed_out);
        body(i);
        hand_over_release(&handed_back);
      },
      tbb::simple_partitioner{}, context);
  hand_over_acquire(&handed_back);
}

}  // namespace

void Executor::parallel_for(const char* name, int n, FunctionRef<void(int)> body) {
  Stopwatch watch(timings(), name);
  if (n <= 1 || threads_ == 1) {
    for (int i = 0; i < n; ++i) body(i);
  } else if (own_timings_ == nullptr) {
    tbb::task_group_context context;
    run_on_all_threads(n, body, context);
  } else {
    // Isolated: a thread that waits for the end of this loop must not start another body of side_by_side meanwhile,
    // which would use the same scratch memory. An exception in another body must not end this loop either.
    tbb::task_group_context context(tbb::task_group_context::isolated);
    tbb::this_task_arena::isolate([&] { run_on_all_threads(n, body, context); });
  }
}

void Executor::side_by_side(int n, FunctionRef<void(int, int)> body) {
  if (n <= 1 || threads_ == 1) {
    for (int i = 0; i < n; ++i) body(i, 0);
    return;
  }
  timings_of_threads_.resize(static_cast<std::size_t>(threads_));
  tbb::task_group_context context;
  const auto run = [&](int i) {
    const int thread = tbb::this_task_arena::current_thread_index();
    const Restored<Timings*> own(own_timings_, &timings_of_threads_[static_cast<std::size_t>(thread)]);
    body(i, thread);
  };
  run_on_all_threads(n, run, context);
  for (Timings& timings : timings_of_threads_) timings_.take(timings);
}

}  // namespace pliant
