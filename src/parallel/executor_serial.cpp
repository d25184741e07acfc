// The parallel loop on the calling thread alone: for platforms without oneTBB (WebAssembly), and programs that must not
// start threads. The bits are the same as with any number of threads.
#include "parallel/executor.h"

namespace pliant {

struct Executor::Arena {};

/// Always one thread.
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
