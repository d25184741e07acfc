// Which instruction set this machine has.
#include <string_view>

#include "pliant/error.h"
#include "solver/kernels.h"
#include "solver/sweeps/multigrid_kernels.h"

namespace pliant {

namespace {

bool runs_v2() { return __builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("popcnt"); }
bool runs_v3() {
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi") &&
         __builtin_cpu_supports("bmi2");
}
bool runs_v4() {
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512cd") &&
         __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
}

}  // namespace

const Kernels& pick_kernels(const std::string& isa) {
  struct Choice {
    const Kernels& (*kernels)();
    bool (*runs)();
  };
  static constexpr Choice choices[] = {{kernels_v4, runs_v4}, {kernels_v3, runs_v3}, {kernels_v2, runs_v2}};
  if (isa == kernels_sequential().isa) return kernels_sequential();
  for (const Choice& choice : choices) {
    if (isa == choice.kernels().isa && !choice.runs()) {
      throw Error({}, "this machine can't run the code path '" + isa + "'", "leave settings.isa empty");
    }
    if ((isa.empty() || isa == choice.kernels().isa) && choice.runs()) return choice.kernels();
  }
  if (!isa.empty())
    throw Error({}, "unknown code path '" + isa + "'", "use x86-64-v2, x86-64-v3, x86-64-v4, sequential or leave it empty");
  return kernels_sequential();
}

const MultigridKernels& multigrid_kernels(const char* isa) {
  if (isa == std::string_view(kernels_v4().isa)) return multigrid_kernels_v4();
  if (isa == std::string_view(kernels_v3().isa)) return multigrid_kernels_v3();
  return multigrid_kernels_v2();
}

}  // namespace pliant
