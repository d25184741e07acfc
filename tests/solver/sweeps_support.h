// Scenes and runs that the tests of sweeps share. Tiles are small, so that there are many inter-tile constraints.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "apps/validate/sweep_table.h"
#include "solver/step.h"
#include "solver/step_support.h"
#include "solver/sweeps/chain_kernels.h"
#include "solver/sweeps/sweep.h"
#include "support/kernels.h"

namespace pliant::testing_support {

using validate::Lacks;
using validate::sweep_ways;
using validate::SweepWay;

using Sharing = SweepOptions::Sharing;
using Acceleration = SweepOptions::Acceleration;

/// An uneven moving sheet of n x n particles with every type and law; pinned at one corner if `pinned`.
inline Object mixed_sheet(int n, bool pinned) {
  Object object;
  object.name = "sheet";
  for (int r = 0; r < n; ++r) {
    for (int c = 0; c < n; ++c) {
      object.positions.push_back(
          {static_cast<float>(c) * 0.05f, static_cast<float>((r * c) % 3) * 0.004f, static_cast<float>(r) * 0.05f});
      object.velocities.push_back(
          {0.3f * static_cast<float>((7 * r + 3 * c) % 5), 0.2f * static_cast<float>((r + 2 * c) % 7) - 0.6f, 0});
      object.masses.push_back(0.01f * static_cast<float>(1 + (r + c) % 3));
    }
  }
  const GridStencils grid = grid_stencils(n);
  object.constraints = {{"distance", grid.across, {}, Stiffness::compliance(1e-6f), {}},
                        {"distance", grid.along, {}, Stiffness::rigid(), {}},
                        {"distance", grid.diagonals, {}, Stiffness::compliance(1e-4f, 0.5f), {}},
                        {"dihedral_bending", grid.hinges, {}, Stiffness::compliance(1), {}},
                        {"isometric_bending", grid.hinges, {}, Stiffness::pbd(0.2f), {}}};
  if (pinned) object.pins.push_back({0, {}});
  return object;
}

/// A closed ball under pressure.
inline Object ball(float pressure, const Vec3f& centre) {
  return balloon(2, pressure, Stiffness::compliance(1e-7f), centre);
}

/// A line of 1 kg particles along x. Entry i of `stretch` is the stretch of link i.
inline Object stretched_chain(int links, const std::vector<double>& stretch, const Stiffness& stiffness,
                              bool even_masses = true) {
  Object object;
  object.name = "chain";
  ConstraintGroup group{"distance", {}, {}, stiffness, {}};
  double x = 0;
  for (int i = 0; i <= links; ++i) {
    if (i > 0) x += 0.1 * (1 + stretch[static_cast<std::size_t>(i) - 1]);
    object.positions.push_back({static_cast<float>(x), 0, 0});
    object.masses.push_back(even_masses ? 1.f : 1.f + static_cast<float>(i % 4));
    if (i == 0) continue;
    group.particles.insert(group.particles.end(), {i - 1, i});
    group.rest.push_back(0.1f);
  }
  object.constraints = {group};
  return object;
}

/// Everything on which a run depends.
struct SweepRun {
  Settings settings;
  int largest_tile = 40, frames = 1, threads = 1;
  float dt = 1.f / 60;
  std::string isa = "sequential";
};

inline SweepRun run_of(Sweep sweep, int substeps, int iterations, const SweepOptions& options = {}) {
  SweepRun run;
  run.settings.sweep = sweep;
  run.settings.substeps = substeps;
  run.settings.iterations = iterations;
  run.settings.sweep_options = options;
  return run;
}

struct Outcome {
  Model model;
  State state;
  Workspace workspace;
  std::vector<Report> reports;
};

/// Simulates objects, over a floor if `floor` is true.
inline Outcome run_sweep(const std::vector<Object>& objects, const SweepRun& run, float gravity = 9.81f,
                         bool floor = false) {
  Outcome out;
  const SweepMethod& method = sweep_method(run.settings.sweep);
  out.model.gravity = {0, -gravity, 0};
  if (floor) {
    Collider ground;
    ground.position = {0, -0.003f, 0};
    out.model.colliders = {ground};
  }
  for (const Object& object : objects) {
    CompileOptions options;
    options.passes = run.settings.substeps * run.settings.iterations * method.passes;
    options.largest_tile = run.largest_tile;
    options.sweep = run.settings.sweep;
    options.chain_softness = run.settings.sweep_options.chain_softness;
    options.gravity = gravity;
    options.tethers = run.settings.sweep_options.tethers;
    options.tether_slack = run.settings.sweep_options.tether_slack;
    out.model.add(compile(object, options));
  }
  out.state = initial_state(out.model);
  prepare(out.model, Multipliers::all, out.workspace);
  prepare_sweeps(out.model, run.settings, run.threads, out.workspace);
  Executor executor(run.threads);
  for (int frame = 0; frame < run.frames; ++frame) {
    out.reports.emplace_back();
    step({out.model, out.state, out.workspace, executor, pick_kernels(run.isa), run.settings.substeps,
          run.settings.iterations, run.settings.sweep_options, run.settings.record_residuals},
         static_cast<double>(run.dt), out.reports.back());
  }
  return out;
}

/// The root mean square of the first type's primal residual after each iteration, beginning with the prediction.
inline std::vector<double> residual_curve(const Report& report) {
  std::vector<double> curve;
  for (const IterationResidual& at : report.convergence) curve.push_back(at.primal.at(0).rms);
  return curve;
}

/// The first iteration whose residual is at most a thousandth of the prediction's; -1: none.
inline int iterations_to_a_thousandth(const Report& report) {
  const std::vector<double> curve = residual_curve(report);
  for (std::size_t i = 0; i < curve.size(); ++i) {
    if (curve[i] < 1e-3 * curve[0]) return static_cast<int>(i);
  }
  return -1;
}

}  // namespace pliant::testing_support
