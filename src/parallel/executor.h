// The engine's parallel loop. Loops of one functor over many items use launch (launch.h).
//
// Every loop has a name under which it is timed; the Report lists these names as phases. A loop body must not depend on
// the thread that runs it or on the order, so any number of threads gives the same bits. CMake's PLIANT_THREADS selects
// oneTBB (executor_tbb.cpp) or the calling thread alone (executor_serial.cpp).
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace pliant {

/// A reference to a callable, which must outlive the reference. Unlike std::function it allocates nothing.
template <class Signature>
class FunctionRef;
template <class Result, class... Arguments>
class FunctionRef<Result(Arguments...)> {
 public:
  template <class F>
  FunctionRef(const F& f)  // NOLINT(google-explicit-constructor): implicit, for temporaries
      : object_(&f), call_([](const void* object, Arguments... arguments) -> Result {
          return (*static_cast<const F*>(object))(arguments...);
        }) {}
  Result operator()(Arguments... arguments) const { return call_(object_, arguments...); }

 private:
  const void* object_;
  Result (*call_)(const void*, Arguments...);
};

/// The time spent under each name since the last clear [ms], in the order of first use.
class Timings {
 public:
  void add(const char* name, double milliseconds);
  void clear();
  /// Adds all times of another one, and sets those to zero.
  void take(Timings& other);
  struct Entry {
    const char* name;
    double milliseconds;
  };
  const std::vector<Entry>& entries() const { return entries_; }

 private:
  std::vector<Entry> entries_;
};

/// Measures the time from its construction to its destruction, and adds it to a Timings; nothing if the name is null.
class Stopwatch {
 public:
  Stopwatch(Timings& timings, const char* name);
  ~Stopwatch();
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  Timings& timings_;
  const char* name_;
  long long start_;
};

class Executor {
 public:
  /// Uses `threads` threads (>= 1), or as many as the hardware has if it is 0. The serial backend always uses one.
  explicit Executor(int threads);
  ~Executor();
  Executor(Executor&&) noexcept;
  Executor& operator=(Executor&&) noexcept;

  int threads() const { return threads_; }

  /// Runs f in the thread pool, so that loops within f start without waking threads. Wrap a whole step in it.
  void enter(FunctionRef<void()> f);

  /// Calls body(i) for each i in [0, n), timed under `name` unless it is null. n = 1 or one thread: the caller does
  /// all.
  void parallel_for(const char* name, int n, FunctionRef<void(int)> body);

  /// Calls body(i, thread) once for each i in [0, n), where bodies contain loops of their own. `thread` is in
  /// [0, threads()), and no two bodies that run at the same time have the same, so it may choose their scratch memory.
  /// Call it within enter(). Loops of different bodies that run at the same time are timed each on its own.
  void side_by_side(int n, FunctionRef<void(int i, int thread)> body);

  /// The timings of the calling thread; after side_by_side the sum over all threads.
  Timings& timings() { return own_timings_ != nullptr ? *own_timings_ : timings_; }

 private:
  struct Arena;
  int threads_;
  std::unique_ptr<Arena> arena_;
  Timings timings_;
  std::vector<Timings> timings_of_threads_;
  static thread_local Timings* own_timings_;  ///< within side_by_side those of the thread; else null
};

}  // namespace pliant
