#include "solver/drivers/held.h"

#include <algorithm>

#include "solver/drivers/driver.h"

namespace pliant {

namespace {

/// The least compliance over h^2 of a spring in a particle's inertia, over the particle's inverse mass: a particle that
/// did not move in the sweep would leave the attachment without a multiplier.
constexpr float least_compliance_of_held = 1e-3f;

/// The share of its inverse mass that the spring of an attachment leaves a particle.
float share_of_mass(const HeldParticle& held, float inverse_mass, float inverse_h2) {
  const float compliance = std::max(held.compliance * inverse_h2, least_compliance_of_held * inverse_mass);
  return compliance / (inverse_mass + compliance);
}

/// Calls body(held particle, its inverse mass) for those in [first, last) that are free to move.
template <class Body>
void for_held(const CompiledObject& object, const SweepArguments& a, int first, int last, const Body& body) {
  const std::vector<HeldParticle>& all = object.held.particles;
  auto held =
      std::lower_bound(all.begin(), all.end(), first, [](const HeldParticle& h, int p) { return h.particle < p; });
  for (; held != all.end() && held->particle < last; ++held)
    if (const float w = a.positions[held->particle].w; w > 0) body(*held, w);
}

/// Moves a particle by a share of its way to its target.
void move_to_target(const HeldParticle& held, float share, const SweepArguments& a) {
  const Record &x = a.positions[held.particle], &target = a.positions[held.target], &of = a.displacements[held.target];
  Record& d = a.displacements[held.particle];
  d = {d.x + share * ((target.x - x.x) + (of.x - d.x)), d.y + share * ((target.y - x.y) + (of.y - d.y)),
       d.z + share * ((target.z - x.z) + (of.z - d.z)), d.w};
}

/// Undoes hold_particles after the sweep of an object, and projects the attachments.
void release_object(const Substep& s, int object) {
  const CompiledObject& of = s.model.objects[object];
  const SweepArguments a = arguments(s, object, true);
  for_held(of, a, 0, of.particles, [&](const HeldParticle& held, float w) {
    move_to_target(held, 1 - 1 / share_of_mass(held, w, a.inverse_h2), a);
  });
  const SweepKernels& kernels = of.sweep == Sweep::sequential ? sweep_kernels_sequential() : s.kernels;
  for (const Tile& tile : of.tiles)
    for (int i = tile.first_segment; i < tile.last_segment; ++i)
      if (const Segment& segment = of.segments[at(i)]; segment.pool == of.held.pool)
        kernels.sweep(of.pools.data(), &segment, &segment + 1, a);
}

}  // namespace

bool sweeps_held(const Substep& s, int object) {
  return !s.model.objects[object].held.particles.empty() && arguments(s, object, true).lead > 0;
}

void hold_particles(const Substep& s, int object, const Tile& tile) {
  const SweepArguments a = arguments(s, object, true);
  for_held(s.model.objects[object], a, tile.first_particle, tile.last_particle, [&](const HeldParticle& held, float w) {
    move_to_target(held, 1 - share_of_mass(held, w, a.inverse_h2), a);
  });
}

HeldMasses::HeldMasses(const Substep& s, int object, int first, int last)
    : positions_(s.state.positions.data() + s.model.first[object]) {
  const SweepArguments a = arguments(s, object, true);
  for_held(s.model.objects[object], a, first, last, [&](const HeldParticle& held, float w) {
    before_.emplace_back(held.particle, w);
    positions_[held.particle].w = w * share_of_mass(held, w, a.inverse_h2);
  });
}

HeldMasses::~HeldMasses() {
  for (const auto& [particle, w] : before_) positions_[particle].w = w;
}

void release_held(Substep& s, const Phase& phase, const Pass& /*pass*/) {
  for_tasks(s, phase, nullptr, 2, [&](const Task& task) {
    if (sweeps_held(s, task.object)) release_object(s, task.object);
  });
}

}  // namespace pliant
