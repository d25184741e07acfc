// Runs functors of the engine as kernels in device memory.
#include "parallel/launch_cuda.h"

#include <stdexcept>

#include "launch_case.h"

namespace pliant::cuda {

namespace {

void require(cudaError_t status) {
  if (status != cudaSuccess) throw std::runtime_error(cudaGetErrorString(status));
}

/// A copy of a vector on the device.
template <class T>
class Copy {
 public:
  explicit Copy(std::vector<T>& of) : host_(of) {
    require(cudaMalloc(&data, bytes()));
    require(cudaMemcpy(data, of.data(), bytes(), cudaMemcpyHostToDevice));
  }
  ~Copy() { cudaFree(data); }
  Copy(const Copy&) = delete;
  Copy& operator=(const Copy&) = delete;
  void bring_back() { require(cudaMemcpy(host_.data(), data, bytes(), cudaMemcpyDeviceToHost)); }

  T* data = nullptr;

 private:
  std::size_t bytes() const { return host_.size() * sizeof(T); }
  std::vector<T>& host_;
};

}  // namespace

void launch_all_on_device(LaunchCase& c) {
  Copy<Record> positions(c.positions), displacements(c.displacements), remainders(c.remainders),
      velocities(c.velocities);
  Copy<int> triangles(c.triangles), corner_begin(c.corner_begin), corners(c.corners);
  Copy<Record> forces(c.forces);
  Copy<unsigned char> nonfinite(c.nonfinite);
  LaunchView view = c.view();
  view.positions = positions.data;
  view.displacements = displacements.data;
  view.remainders = remainders.data;
  view.velocities = velocities.data;
  view.triangles = triangles.data;
  view.corner_begin = corner_begin.data;
  view.corners = corners.data;
  view.forces = forces.data;
  view.nonfinite = nonfinite.data;
  CudaBackend device;
  launch_all(device, view);
  require(cudaGetLastError());
  require(cudaDeviceSynchronize());
  for (Copy<Record>* copy : {&positions, &displacements, &remainders, &velocities}) copy->bring_back();
  forces.bring_back();
  nonfinite.bring_back();
}

}  // namespace pliant::cuda
