#include "solver/bodies/tie_gaps.h"

#include <algorithm>
#include <cmath>

#include "constraints/registry.h"
#include "solver/visit.h"

namespace pliant {

namespace {

/// The particles of one object, and its frames.
struct ObjectState {
  const CompiledObject& object;
  const Record *positions, *orientations;
};

/// The gap of a tie: the norm of its C, with positions relative to the body's.
double gap_of(const ObjectState& of, const ConstraintDefinition& type, const ConstraintPlace& at,
              const std::int32_t* slots) {
  StencilArrays<double> arrays;
  for (int slot = 0; slot < at.pool.stencil; ++slot) {
    const bool is_frame = slots[slot] >= of.object.particles;
    const Record& r = is_frame ? of.orientations[slots[slot] - of.object.particles] : of.positions[slots[slot]];
    arrays.set_slot(slot, double(r.x), double(r.y), double(r.z), is_frame ? double(r.w) : 0);
  }
  arrays.load_rest(at);
  type.evaluate_double(arrays.slots, arrays.rest, arrays.c, arrays.gradients);
  double squared = 0;
  for (int row = 0; row < type.rows; ++row) squared += arrays.c[row] * arrays.c[row];
  return std::sqrt(squared);
}

/// The index in CompiledBodies::attached of a particle and the body with a frame; -1: none.
int tie_of(const CompiledBodies& bodies, int particle, int frame) {
  const auto& attached = bodies.attached;
  auto at = std::lower_bound(attached.begin(), attached.end(), std::pair{particle, 0});
  for (; at != attached.end() && at->first == particle; ++at)
    if (bodies.bodies[static_cast<std::size_t>(at->second)].frame == frame)
      return static_cast<int>(at - attached.begin());
  return -1;
}

/// The length with which a tie's gap is compared.
double length_of(const ObjectState& of, std::size_t tie) {
  const CompiledBodies& bodies = of.object.bodies;
  if (bodies.edge_lengths[tie] > 0) return bodies.edge_lengths[tie];
  const auto& [particle, body] = bodies.attached[tie];
  const Record &x = of.positions[particle], &c = of.positions[bodies.bodies[static_cast<std::size_t>(body)].particle];
  return length(Vec3d{double(x.x) - double(c.x), double(x.y) - double(c.y), double(x.z) - double(c.z)});
}

void add_ties_of(const ObjectState& of, int number, int type, TieGap& widest) {
  const ConstraintDefinition& definition = constraint_type(type);
  for_constraints(of.object, type, [&](const ConstraintPlace& at, const std::int32_t* slots) {
    if (at.pool.law == Law::pbd || softness(at, 1) > 0) return;
    const double gap = gap_of(of, definition, at, slots);
    if (!(gap > 0)) return;
    const int tie = tie_of(of.object.bodies, slots[2], slots[1] - of.object.particles);
    if (tie < 0) return;
    const double edge = length_of(of, static_cast<std::size_t>(tie));
    if (!(gap * widest.length > widest.gap * edge) && widest.body >= 0) return;
    const int body = of.object.bodies.attached[static_cast<std::size_t>(tie)].second;
    widest = {gap, edge, ObjectId(number, 0), of.object.order[static_cast<std::size_t>(slots[2])], body};
  });
}

}  // namespace

TieGap widest_tie(const Model& model, const State& state) {
  TieGap widest;
  for (std::size_t o = 0; o < model.objects.size(); ++o) {
    if (model.objects[o].bodies.attached.empty()) continue;
    const ObjectState of{model.objects[o], state.positions.data() + model.first[o],
                         state.frames.orientations.data() + model.first_frame[o]};
    for (int type = 0; type < constraint_type_count(); ++type)
      if (constraint_type(type).is_tie) add_ties_of(of, static_cast<int>(o), type, widest);
  }
  return widest;
}

}  // namespace pliant
