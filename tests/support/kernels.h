// The kernels that this machine can run.
#pragma once

#include <string>
#include <vector>

#include "pliant/error.h"
#include "solver/kernels.h"

namespace pliant::testing_support {

inline const std::vector<std::string>& isa_names() {
  static const std::vector<std::string> names{"x86-64-v2", "x86-64-v3", "x86-64-v4"};
  return names;
}

/// Those of the three builds in lanes that run here; the first one always does on x86.
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

}  // namespace pliant::testing_support
