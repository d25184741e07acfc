// The one parallel loop of the engine. Work that is one text for each of many items goes through launch (launch.h).
//
// Every loop has a name and times itself: a Report's phases are these names. What a body does may not depend on which thread
// runs it or in what order, so that any number of threads gives the same bits. On oneTBB (executor_tbb.cpp), or on the caller's
// thread alone (executor_serial.cpp); CMake's PLIANT_THREADS chooses.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace pliant {

/// A reference to a callable that outlives the call: what std::function would be without its allocation.
template <class Signature>
class FunctionRef;
template <class Result, class... Arguments>
class FunctionRef<Result(Arguments...)> {
 public:
  template <class F>
  FunctionRef(const F& f)  // NOLINT(google-explicit-constructor): meant to be made in passing
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

/// Adds the time from construction to destruction to a Timings.
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
  /// `threads` of at least 1, or 0 for as many as the machine has. The serial backend has one, whatever is asked for.
  explicit Executor(int threads);
  ~Executor();
  Executor(Executor&&) noexcept;
  Executor& operator=(Executor&&) noexcept;

  int threads() const { return threads_; }

  /// Runs f where parallel loops find the threads waiting: wrap a whole step in it.
  void enter(FunctionRef<void()> f);

  /// body(i) for i in [0, n), each once, timed under `name`. Runs on the caller where n is 1 or there is one thread.
  void parallel_for(const char* name, int n, FunctionRef<void(int)> body);

  Timings& timings() { return timings_; }

 private:
  struct Arena;
  int threads_;
  std::unique_ptr<Arena> arena_;
  Timings timings_;
};

}  // namespace pliant
