// Notes in the Report what momentum the guards of energy take (guard_energy.cpp, guard_bodies.cpp).
//
// Corrections of constraints and contacts add up to nothing, so a share of all of them takes nothing from a group. What
// is taken is of corrections from outside, and of islands whose corrections have different shares.
#include "math/vector.h"
#include "solver/bodies/body_solver.h"
#include "solver/stages/energy_share.h"
#include "solver/stages/stages.h"

namespace pliant {

namespace {

Vec3d vector_of(const Record& r) { return {double(r.x), double(r.y), double(r.z)}; }

/// The momentum of the corrections of particles [first, last) of an object [kg m/s].
Vec3d momentum_of_corrections(const Substep& s, const AdvanceArguments& a, int first, int last,
                              const PredictedGravity& gravity) {
  Vec3d sum{};
  for (int i = first; i < last; ++i) {
    const double w = double(a.positions[i].w);
    if (!(w > 0)) continue;
    const Vec3d moved = vector_of(a.displacements[i]) - vector_of(a.remainders[i]);
    sum += (moved * (1 / double(s.h)) - (vector_of(a.velocities[i]) + gravity.begun)) * (1 / w);
  }
  return sum;
}

}  // namespace

void note_guards(Substep& s) {
  const VelocityShares* const shares = s.bodies == nullptr ? nullptr : &s.bodies->velocity_shares();
  if (s.velocity_share == 1 && (shares == nullptr || shares->are_one())) return;
  Vec3d lost{};
  for_each_tile(s, [&](int task) {
    const int object = s.model.tiles()[at(task)].object;
    const AdvanceArguments a = particles(s, task);
    const PredictedGravity gravity(s, object);
    const auto add = [&](int first, int last, float share) {
      const double left_out = 1 - double(s.velocity_share * share);
      if (left_out > 0) lost += momentum_of_corrections(s, a, first, last, gravity) * left_out;
    };
    if (shares == nullptr) return add(a.first, a.last, 1);
    shares->for_particles(s.model, object, a.first, a.last, add);
  });
  s.report.lost_momentum.guards += length(lost);
}

}  // namespace pliant
