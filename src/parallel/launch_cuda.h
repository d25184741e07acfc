// launch on a CUDA device, for units that nvcc compiles: the functor is the body of a kernel, one thread an item. What its pointers
// name must be the device's memory.
#pragma once

#include <cuda_runtime.h>

#include <type_traits>

namespace pliant {

/// A stream of a device; the default stream unless said.
struct CudaBackend {
  cudaStream_t stream = nullptr;
};

template <class Functor>
__global__ void launch_kernel(Functor functor, int n) {
  const int i = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  if (i < n) functor(i);
}

/// Starts the work and returns. What the device refuses is what cudaGetLastError says next.
template <class Functor>
void launch(CudaBackend& device, const char*, int n, const Functor& functor) {
  static_assert(std::is_trivially_copyable_v<Functor>, "a functor is copied to a device as bytes");
  constexpr int threads = 128;
  if (n > 0) launch_kernel<<<(n - 1) / threads + 1, threads, 0, device.stream>>>(functor, n);
}

}  // namespace pliant
