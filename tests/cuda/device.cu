// Runs every probe as a kernel, one thread for each input.
#include <cuda_runtime.h>

#include <stdexcept>

#include "device.h"
#include "probe.h"

namespace pliant::cuda {

namespace {

void require(cudaError_t status) {
  if (status != cudaSuccess) throw std::runtime_error(cudaGetErrorString(status));
}

/// Device memory that is freed on every path.
struct Buffer {
  float* data = nullptr;
  explicit Buffer(std::size_t count) { require(cudaMalloc(&data, count * sizeof(float))); }
  ~Buffer() { cudaFree(data); }
  Buffer(const Buffer&) = delete;
  Buffer& operator=(const Buffer&) = delete;
};

template <class Probe>
__global__ void run_probe(const float* in, float* out, int count) {
  const int i = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  if (i < count) Probe::run(in + static_cast<long>(i) * Probe::inputs, out + static_cast<long>(i) * Probe::outputs);
}

template <class... Listed>
void launch(TypeList<Listed...>, int wanted, const float* in, float* out, int count) {
  const int threads = 128, blocks = (count + threads - 1) / threads;
  int index = 0;
  ((index++ == wanted ? run_probe<Listed><<<blocks, threads>>>(in, out, count) : void()), ...);
}

}  // namespace

std::string why_no_device() {
  int devices = 0;
  const cudaError_t status = cudaGetDeviceCount(&devices);
  if (status != cudaSuccess) return cudaGetErrorString(status);
  return devices > 0 ? "" : "no CUDA device";
}

std::vector<float> run_on_device(int probe, const std::vector<float>& inputs, int count, int outputs) {
  const Buffer in(inputs.size());
  std::vector<float> result(static_cast<std::size_t>(count) * static_cast<std::size_t>(outputs));
  const Buffer out(result.size());
  require(cudaMemcpy(in.data, inputs.data(), inputs.size() * sizeof(float), cudaMemcpyHostToDevice));
  launch(AllProbes{}, probe, in.data, out.data, count);
  require(cudaGetLastError());
  require(cudaMemcpy(result.data(), out.data, result.size() * sizeof(float), cudaMemcpyDeviceToHost));
  return result;
}

}  // namespace pliant::cuda
