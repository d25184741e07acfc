#include "solver/sweeps/record.h"

#include <algorithm>
#include <cmath>

#include "constraints/registry.h"
#include "solver/drivers/contacts.h"
#include "solver/substep.h"
#include "solver/visit.h"
#include "solver/volume.h"

namespace pliant {

namespace {

/// Views of one object's data after one iteration.
struct IterationView {
  const CompiledObject& object;
  SweepArguments arguments;
  const Record* orientations;                            ///< orientations of the object's frames
  const std::vector<AlignedVector<float>>* multipliers;  ///< multipliers of each pool; null: all are still zero
  std::vector<Vec3d>& explained;                         ///< for each particle, the sum of w grad C^T lambda [m]
  std::vector<char>& left_out;  ///< 1 if a constraint without a multiplier acts on the particle
};

/// Loads a constraint's slots in double precision; points are relative to its first point.
void load_slots(const IterationView& view, const Pool& pool, const std::int32_t* particle,
                StencilArrays<double>& arrays) {
  const Record* origin = nullptr;
  for (int slot = 0; slot < pool.stencil; ++slot) {
    if (particle[slot] >= view.object.particles) {
      const Record& q = view.orientations[particle[slot] - view.object.particles];
      arrays.set_slot(slot, double(q.x), double(q.y), double(q.z), double(q.w));
      continue;
    }
    const Record &p = view.arguments.positions[particle[slot]], &d = view.arguments.displacements[particle[slot]];
    if (origin == nullptr) origin = &p;
    arrays.set_slot(slot, double(p.x) - double(origin->x) + double(d.x), double(p.y) - double(origin->y) + double(d.y),
                    double(p.z) - double(origin->z) + double(d.z), 0);
  }
}

/// Adds w grad C^T lambda of one row of C to IterationView::explained; returns the row's residual.
double look_at(const IterationView& view, const ConstraintPlace& at, const std::int32_t* particle,
               const StencilArrays<double>& arrays, int component) {
  const bool has =
      view.multipliers != nullptr && !view.multipliers->empty() && !(*view.multipliers)[at.pool_number].empty();
  const double multiplier =
      has ? static_cast<double>((*view.multipliers)[at.pool_number][at.multiplier_place(component)]) : 0;
  for (int slot = 0; slot < at.pool.stencil; ++slot) {
    if (particle[slot] >= view.object.particles) continue;
    const double w = static_cast<double>(view.arguments.positions[particle[slot]].w);
    view.explained[particle[slot]] += arrays.gradient(at.pool, component, slot) * (w * multiplier);
    if (at.pool.law == Law::pbd) view.left_out[particle[slot]] = 1;
  }
  const double c = arrays.c[component];
  return at.pool.law == Law::pbd ? c : c + softness(at, double(view.arguments.inverse_h2)) * multiplier;
}

void add_constraints(const IterationView& view, int type, ErrorSum& sum) {
  const auto evaluate = constraint_type(type).evaluate_double;
  StencilArrays<double> arrays;
  for_constraints(view.object, type, [&](const ConstraintPlace& at, const std::int32_t* particle) {
    load_slots(view, at.pool, particle, arrays);
    arrays.load_rest(at);
    evaluate(arrays.slots, arrays.rest, arrays.c, arrays.gradients);
    double squared = 0, error = 0;
    for (int component = 0; component < at.pool.components; ++component) {
      error = look_at(view, at, particle, arrays, component);
      squared += error * error;
    }
    sum.add(at.pool.components == 1 ? error : std::sqrt(squared));
  });
}

void add_volume(const IterationView& view, double multiplier, ErrorSum& sum) {
  if (!view.object.has_volume) return;
  Records places(view.arguments.positions, view.arguments.positions + view.object.particles);
  for (int i = 0; i < view.object.particles; ++i) {
    const Record& d = view.arguments.displacements[i];
    places[i] = {places[i].x + d.x, places[i].y + d.y, places[i].z + d.z, places[i].w};
  }
  const bool pbd = view.object.volume.law == Law::pbd;
  const double compliance = pbd ? 0 : double(view.object.volume.response) * double(view.arguments.inverse_h2);
  sum.add(volume_error(view.object, places.data()) + std::min(compliance, 1e30) * multiplier);
  for (int i = 0; i < view.object.particles; ++i) {
    const Vec3f g = volume_gradient(view.object, places.data(), i);
    view.explained[i] += Vec3d{g.x, g.y, g.z} * (static_cast<double>(places[i].w) * multiplier);
    if (pbd) view.left_out[i] = 1;
  }
}

/// Adds the displacements since the prediction minus those that multipliers explain: the dual residual.
void add_unexplained(const IterationView& view, const Record* predicted, ErrorSum& sum) {
  for (int i = 0; i < view.object.particles; ++i) {
    if (!(view.arguments.positions[i].w > 0) || view.left_out[i] != 0) continue;
    const Record &d = view.arguments.displacements[i], &p = predicted[i];
    const Vec3d moved{double(d.x) - double(p.x), double(d.y) - double(p.y), double(d.z) - double(p.z)};
    const Vec3d rest = moved - view.explained[i];
    sum.add(std::sqrt(dot(rest, rest)));
  }
}

void leave_out_contacts(Substep& s, std::vector<std::vector<char>>& left_out) {
  for (std::size_t task = 0; task < s.model.tiles().size(); ++task) {
    for (const Contact& contact : s.work.tiles[task].contacts) {
      if (contact.push > 0) left_out[s.model.tiles()[task].object][contact.point[0]] = 1;
    }
  }
  for_touching_points(s, [&](int particle) {
    const int o = s.model.object_of(particle);
    left_out[o][particle - s.model.first[o]] = 1;
  });
}

}  // namespace

void record_iteration(Substep& s, int iteration) {
  const Model& model = s.model;
  const Workspace& work = s.work;
  const std::size_t objects = model.objects.size();
  std::vector<std::vector<Vec3d>> explained;
  std::vector<std::vector<char>> left_out;
  std::vector<IterationView> views;
  for (const CompiledObject& object : model.objects) {
    explained.emplace_back(object.particles);
    left_out.emplace_back(object.particles, 0);
  }
  leave_out_contacts(s, left_out);
  for (std::size_t o = 0; o < objects; ++o) {
    views.push_back({model.objects[o], arguments(s, static_cast<int>(o), false),
                     s.state.frames.orientations.data() + model.first_frame[o],
                     iteration > 0 ? &work.multipliers[o] : nullptr, explained[o], left_out[o]});
  }
  IterationResidual found;
  found.iteration = iteration;
  for (int type = 0; type < constraint_type_count(); ++type) {
    ErrorSum sum;
    for (const IterationView& view : views) add_constraints(view, type, sum);
    if (sum.count > 0) found.primal.push_back(sum.residual(constraint_type(type).name));
  }
  ErrorSum volumes, dual;
  for (std::size_t o = 0; o < objects; ++o) {
    add_volume(views[o], iteration > 0 ? work.volume_multipliers[o] : 0, volumes);
    add_unexplained(views[o], work.predicted.data() + model.first[o], dual);
  }
  if (volumes.count > 0) found.primal.push_back(volumes.residual("volume"));
  found.dual_rms = dual.rms();
  found.dual_largest = dual.largest;
  s.report.convergence.push_back(std::move(found));
}

void record_prediction(Substep& s) {
  std::copy(s.work.displacements.begin(), s.work.displacements.end(), s.work.predicted.begin());
  record_iteration(s, 0);
}

}  // namespace pliant
