#include "solver/stages/stages.h"

namespace pliant {

namespace {

/// Finds contacts of edges and triangles with primitive colliders.
void collide_with_shapes(Substep& s) {
  ShapeContacts& shapes = s.work.shape_contacts;
  shapes.contacts().clear();
  if (s.work.colliders.empty()) return;
  const auto particles_of = [&](int task) { return particles(s, task); };
  const auto bounds_of = [&](int task) -> const PointBounds& { return s.work.tiles[task].bounds; };
  shapes.detect(s.context.executor,
                {s.model, s.work.colliders, particles_of, bounds_of, s.part == nullptr ? nullptr : &s.part->tiles});
  s.work.shape_contact_solver.begin(s.kernels.contacts, shapes.contacts(), 0, s.state.positions.data(),
                                    s.state.positions.size());
}

}  // namespace

void collide(Substep& s) {
  collide_with_shapes(s);
  if (!s.has_pairs()) return;
  s.pairs->detect(s.context.executor, all_particles(s));
  s.work.contact_solver.begin(s.kernels.contacts, s.pairs->contacts(), s.pairs->static_contacts(), s.state.positions.data(),
                              s.state.positions.size());
}

}  // namespace pliant
