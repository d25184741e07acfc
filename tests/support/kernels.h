// The names of the kernels that this machine can run.
#pragma once

#include <string>
#include <vector>

#include "levels/compiled.h"
#include "pliant/error.h"
#include "solver/kernels.h"

namespace pliant::testing_support {

#define PLIANT_LEVEL_NAME(suffix, isa, ...) isa,
/// All names, the narrowest kernels first.
inline const std::vector<std::string>& isa_names() {
  static const std::vector<std::string> names = [] {
    const std::vector<std::string> widest_first{PLIANT_FOR_EACH_COMPILED_LEVEL(PLIANT_LEVEL_NAME, )};
    return std::vector<std::string>(widest_first.rbegin(), widest_first.rend());
  }();
  return names;
}
#undef PLIANT_LEVEL_NAME

/// The names of the SIMD kernels that this machine can run. The first is the narrowest of the build.
inline std::vector<std::string> available_isas() {
  std::vector<std::string> available;
  for (const std::string& name : isa_names()) {
    try {
      pick_kernels(name);
      available.push_back(name);
    } catch (const Error&) {
      continue;
    }
  }
  return available;
}

/// The same and the scalar code: all ways in which a World can run here.
inline std::vector<std::string> available_code_paths() {
  std::vector<std::string> all = available_isas();
  all.push_back("sequential");
  return all;
}

}  // namespace pliant::testing_support
