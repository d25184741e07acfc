// Compiles objects with chains and tethers, and prepares one for the middle of a substep.
#pragma once

#include <algorithm>
#include <random>
#include <vector>

#include "model/model.h"
#include "pliant/mesh.h"
#include "solver/sweeps/chain_kernels.h"
#include "support/random.h"
#include "topology/edges.h"

namespace pliant::testing_support {

inline Object line(int links, float compliance, std::mt19937& random) {
  Object object;
  ConstraintGroup group{"distance", {}, {}, Stiffness::compliance(compliance), {}};
  Vec3f at{};
  for (int i = 0; i <= links; ++i) {
    object.positions.push_back(at);
    object.masses.push_back(static_cast<float>(uniform(random, 0.1, 2)));
    at +=
        Vec3f{0.1f, static_cast<float>(uniform(random, -0.02, 0.02)), static_cast<float>(uniform(random, -0.02, 0.02))};
    if (i > 0) group.particles.insert(group.particles.end(), {i - 1, i});
  }
  object.constraints.push_back(group);
  return object;
}

inline Object grid(int columns, int rows, float compliance) {
  const TriangleMesh mesh = grid_mesh(columns, rows, 1, 1);
  Object object;
  object.positions = mesh.positions;
  object.masses.assign(mesh.positions.size(), 0.01f);
  object.triangles = mesh.triangles;
  ConstraintGroup group{"distance", {}, {}, Stiffness::compliance(compliance), {}};
  for (const Edge& edge : find_edges(mesh.triangles, columns * rows))
    group.particles.insert(group.particles.end(), {edge.a, edge.b});
  object.constraints.push_back(group);
  return object;
}

inline CompileOptions chained(float softness, bool tethers = false) {
  CompileOptions options;
  options.sweep = Sweep::chains;
  options.chain_softness = softness;
  options.tethers = tethers;
  return options;
}

/// An object in the middle of a substep.
struct ChainedSubstep {
  CompiledObject object;
  Records positions, displacements;
  AlignedVector<float> multipliers, scratch;
  float h = 1.f / 600;

  ChainedSubstep(const Object& from, const CompileOptions& options) : object(compile(from, options)) {
    positions.assign(object.positions.begin(), object.positions.end());
    displacements.resize(positions.size());
    multipliers.assign(object.pools[0].origin.size(), 0.f);
    int longest = 0;
    for (const ChainBatch& chain : object.chains) longest = std::max(longest, chain.steps);
    scratch.resize(static_cast<std::size_t>(longest) * chain_scratch_floats);
  }
  SweepArguments arguments(bool first) {
    SweepArguments a;
    a.positions = positions.data();
    a.displacements = displacements.data();
    a.h = h;
    a.inverse_h = 1 / h;
    a.inverse_h2 = a.inverse_h * a.inverse_h;
    a.first_pass = first;
    return a;
  }
  void solve(const ChainKernels& kernels, bool first, bool keeps) {
    for (std::size_t c = 0; c < object.chains.size(); ++c) {
      const ChainBatch& chain = object.chains[c];
      kernels.solve_chain(object.pools[chain.pool], &object.segments[chain.first_segment], chain.steps,
                          &object.chain_softness[c * batch_width], keeps ? multipliers.data() : nullptr,
                          arguments(first), scratch.data());
    }
  }
  void hold(const ChainKernels& kernels) {
    Records anchors;
    for (int anchor : object.tethers.anchors) {
      anchors.push_back(positions[anchor]);
      anchors.push_back(displacements[anchor]);
    }
    kernels.hold_tethers(object.tethers, anchors.data(), 0, object.particles, arguments(true));
  }
};

}  // namespace pliant::testing_support
