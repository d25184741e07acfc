#include "solver/bodies/body_solver.h"
#include "solver/fluids/fluid_solver.h"
#include "solver/grains/grain_solver.h"
#include "solver/stages/stages.h"

namespace pliant {

namespace {

/// Finds contacts of edges and triangles with primitive colliders.
void collide_with_shapes(Substep& s) {
  std::vector<Contact>& found = s.own->shape_contacts;
  found.clear();
  if (s.own->colliders.empty()) return;
  const auto particles_of = [&](int task) { return particles(s, task); };
  const auto bounds_of = [&](int task) -> const PointBounds& { return s.work.tiles[task].bounds; };
  s.work.shape_contacts.detect(
      s.context.executor,
      {s.model, s.own->colliders, particles_of, bounds_of, s.part == nullptr ? nullptr : &s.part->tiles}, found);
  s.own->shape_contact_solver.begin(s.kernels.contacts, found, 0, s.state.positions.data(), s.state.positions.size());
}

}  // namespace

void collide(Substep& s) {
  collide_with_shapes(s);
  if (s.bodies != nullptr) s.bodies->collide(s);
  if (s.fluids != nullptr) s.fluids->collide(s);
  if (s.grains != nullptr) s.grains->collide(s);
  if (!s.has_pairs()) return;
  s.pairs->detect(s.context.executor, all_particles(s));
  s.own->contact_solver.begin(s.kernels.contacts, s.pairs->contacts(), s.pairs->static_contacts(), s.state.positions.data(),
                              s.state.positions.size());
}

}  // namespace pliant
