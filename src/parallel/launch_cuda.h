// launch on a CUDA device, for units compiled by nvcc: the functor is a
// kernel body, one thread per item. Its pointers must refer to device memory.
#pragma once

#include <cuda_runtime.h>

#include <type_traits>

namespace pliant {

/// The CUDA stream on which kernels run; the default stream unless set.
struct CudaBackend {
  cudaStream_t stream = nullptr;
};

template <class Functor>
__global__ void launch_kernel(Functor functor, int n) {
  const int i = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  if (i < n) functor(i);
}

/// Starts the kernel and returns at once. The next cudaGetLastError reports launch errors.
template <class Functor>
void launch(CudaBackend& device, const char*, int n, const Functor& functor) {
  static_assert(std::is_trivially_copyable_v<Functor>, "a functor is copied to a device as bytes");
  constexpr int threads = 128;
  if (n > 0) launch_kernel<<<(n - 1) / threads + 1, threads, 0, device.stream>>>(functor, n);
}

}  // namespace pliant
