// Runs functors of the engine one after another by launch, for any backend.
#pragma once

#include <cstdint>
#include <vector>

#include "solver/air.h"
#include "solver/points.h"

namespace pliant::cuda {

/// The arrays on which the functors work: pointers into the memory of the backend.
struct LaunchView {
  Record *positions, *displacements, *remainders, *velocities;
  int particles;
  const int *triangles, *corner_begin, *corners;
  int triangle_count;
  Record* forces;
  unsigned char* nonfinite;
};

/// The arrays in host memory.
struct LaunchCase {
  std::vector<Record> positions, displacements, remainders, velocities;
  std::vector<int> triangles, corner_begin, corners;
  std::vector<Record> forces;
  std::vector<unsigned char> nonfinite;

  LaunchView view() {
    return {positions.data(),
            displacements.data(),
            remainders.data(),
            velocities.data(),
            static_cast<int>(positions.size()),
            triangles.data(),
            corner_begin.data(),
            corners.data(),
            static_cast<int>(triangles.size() / 3),
            forces.data(),
            nonfinite.data()};
  }
};

template <class Backend>
void launch_all(Backend& backend, const LaunchView& v) {
  AdvanceArguments a;
  a.positions = v.positions;
  a.displacements = v.displacements;
  a.remainders = v.remainders;
  a.velocities = v.velocities;
  a.h = 1.f / 600;
  a.inverse_h = 600;
  a.velocity_kept = 0.99f;
  a.gravity_finished = a.gravity_begun = {0, -0.05f, 0};
  launch(backend, "find", v.particles, FindNonfinite{v.displacements, v.nonfinite});
  launch(backend, "update", v.particles, UpdatePoint{a});
  const AirArguments air{
      v.triangles, v.corner_begin, v.corners, v.positions, v.velocities, v.forces, {3, 0.5f, -1}, {0, -0.05f, 0},
      a.h,         1.2f,           1,         0.5f};
  launch(backend, "air", v.triangle_count, AirOnTriangle{air});
  launch(backend, "air", v.particles, AirOnParticle{air});
  launch(backend, "predict", v.particles, PredictPoint{a});
}

/// Runs launch_all on a device, on a copy in its memory, and copies the results back. Throws std::runtime_error if the
/// device reports an error.
void launch_all_on_device(LaunchCase& on_host);

}  // namespace pliant::cuda
