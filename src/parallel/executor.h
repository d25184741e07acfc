// The engine's parallel loop. Loops of one functor over many items use launch (launch.h).
//
// Every loop has a name and is timed: these names are the phases of a Report. A body must not depend on the thread that
// runs it or on the order, so any number of threads gives the same bits. CMake's PLIANT_THREADS selects oneTBB
// (executor_tbb.cpp) or the calling thread alone (executor_serial.cpp).
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace pliant {

/// A non-owning reference to a callable, which must outlive the call: std::function without its allocation.
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

/// Milliseconds under each name since the last clear, in order of first use.
class Timings {
 public:
  void add(const char* name, double milliseconds);
  void clear();
  struct Entry {
    const char* name;
    double milliseconds;
  };
  const std::vector<Entry>& entries() const { return entries_; }

 private:
  std::vector<Entry> entries_;
};

/// Adds the time from its construction to its destruction to a Timings.
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
  /// `threads` >= 1, or 0 for all hardware threads. The serial backend always has one.
  explicit Executor(int threads);
  ~Executor();
  Executor(Executor&&) noexcept;
  Executor& operator=(Executor&&) noexcept;

  int threads() const { return threads_; }

  /// Runs f inside the thread pool, so that its loops start without waking threads: wrap a whole step in it.
  void enter(FunctionRef<void()> f);

  /// Calls body(i) once for each i in [0, n), timed under `name`. Runs on the calling thread if n or threads is 1.
  void parallel_for(const char* name, int n, FunctionRef<void(int)> body);

  Timings& timings() { return timings_; }

 private:
  struct Arena;
  int threads_;
  std::unique_ptr<Arena> arena_;
  Timings timings_;
};

}  // namespace pliant
