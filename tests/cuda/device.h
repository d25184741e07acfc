// The device's side of the comparison, as plain functions that the host's compiler can call.
#pragma once

#include <string>
#include <vector>

namespace pliant::cuda {

/// Why there is no device to run on; empty where there is one.
std::string why_no_device();

/// Runs probe number `probe` of AllProbes over `count` inputs that lie one after the other. Throws std::runtime_error where
/// the device refuses.
std::vector<float> run_on_device(int probe, const std::vector<float>& inputs, int count, int outputs);

}  // namespace pliant::cuda
