// The device's part of the comparison, as plain functions that the host's compiler can call.
#pragma once

#include <string>
#include <vector>

namespace pliant::cuda {

/// Why there is no device to run on; empty if there is one.
std::string why_no_device();

/// Runs probe number `probe` of AllProbes on `count` inputs, which are contiguous. Throws std::runtime_error if the
/// device reports an error.
std::vector<float> run_on_device(int probe, const std::vector<float>& inputs, int count, int outputs);

}  // namespace pliant::cuda
