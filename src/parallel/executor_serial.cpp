// The parallel loop on the caller's thread alone: for machines without oneTBB (WebAssembly), or where a program must have no
// threads. Same bits, as on any number of threads.
#include "parallel/executor.h"

namespace pliant {

struct Executor::Arena {};

/// One thread, whatever was asked for.
Executor::Executor(int) : threads_(1) {}
Executor::~Executor() = default;
Executor::Executor(Executor&&) noexcept = default;
Executor& Executor::operator=(Executor&&) noexcept = default;

void Executor::enter(FunctionRef<void()> f) { f(); }

void Executor::parallel_for(const char* name, int n, FunctionRef<void(int)> body) {
  Stopwatch watch(timings_, name);
  for (int i = 0; i < n; ++i) body(i);
}

}  // namespace pliant
