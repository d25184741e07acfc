// The parallel loop on the calling thread, for platforms without oneTBB (WebAssembly) and for programs that must not
// start threads. The bits are those of any number of threads.
#include "parallel/executor.h"

namespace pliant {

struct Executor::Arena {};

/// The number of threads is ignored: there is always one.
Executor::Executor(int) : threads_(1) {}
Executor::~Executor() = default;
Executor::Executor(Executor&&) noexcept = default;
Executor& Executor::operator=(Executor&&) noexcept = default;

void Executor::enter(FunctionRef<void()> f) { f(); }

void Executor::parallel_for(const char* name, int n, FunctionRef<void(int)> body) {
  Stopwatch watch(timings_, name);
  for (int i = 0; i < n; ++i) body(i);
}

void Executor::side_by_side(int n, FunctionRef<void(int, int)> body) {
  for (int i = 0; i < n; ++i) body(i, 0);
}

}  // namespace pliant
