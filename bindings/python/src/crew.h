// Threads that work on many worlds, while the caller looks for Ctrl-C.
#pragma once

#include <functional>
#include <memory>

namespace pliant::python {

/// Threads that are there for the next call: new ones would cost more than the step of a small world. They start with
/// the first call. After a fork the child starts its own.
class Crew {
 public:
  /// At most so many threads; 0: all of the machine.
  explicit Crew(int threads);
  ~Crew();
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  /// Calls work(i) for each i in [0, n), without the GIL; one call at a time. The caller's thread waits, and lets
  /// Python's handlers of signals run every few milliseconds: if one raises, calls `stop`, and throws nb::python_error
  /// once all threads have ended. Of exceptions of `work` rethrows that of the smallest i.
  void run(int n, const std::function<void(int)>& work, const std::function<void()>& stop);

 private:
  struct Threads;
  Threads& ready(int count);

  int most_;
  std::unique_ptr<Threads> threads_;
};

}  // namespace pliant::python
