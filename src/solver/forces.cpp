#include "solver/forces.h"

#include <algorithm>

#include "math/functions.h"
#include "math/quat.h"
#include "math/record.h"
#include "math/vector.h"
#include "parallel/ranges.h"
#include "solver/air.h"

namespace pliant {

namespace {

void push(Record& velocity, const Vec3f& change) {
  velocity = {velocity.x + change.x, velocity.y + change.y, velocity.z + change.z, 0};
}

/// The wind on an object's bodies that are a single capsule, as the segments of rods are. Caps do not count, since
/// those of segments overlap.
void apply_air_to_capsules(const Model& model, int o, const Vec3f& air, const Vec3f& gravity, float h, State& state,
                           Executor& executor) {
  const CompiledObject& object = model.objects[o];
  const std::vector<CompiledSolid>& solids = object.bodies.solids;
  const Record* positions = state.positions.data() + model.first[o];
  Record* velocities = state.velocities.data() + model.first[o];
  const Record* orientations = state.frames.orientations.data() + model.first_frame[o];
  const auto is_of = [&](std::size_t i, int body) { return i < solids.size() && solids[i].body == body; };
  executor.parallel_for("forces: air", static_cast<int>(solids.size()), [&](int number) {
    const auto i = static_cast<std::size_t>(number);
    const CompiledSolid& solid = solids[i];
    const bool is_alone = !is_of(i + 1, solid.body) && (i == 0 || !is_of(i - 1, solid.body));
    if (solid.shape.kind != ConvexShape::Kind::segment || !is_alone) return;
    const CompiledBodies::Body& body = object.bodies.bodies[static_cast<std::size_t>(solid.body)];
    const Record& x = positions[body.particle];
    if (x.w == 0) return;
    Record& v = velocities[body.particle];
    const Record& q = orientations[body.frame];
    const Vec3f along = rotate(Quatf{q.x, q.y, q.z, q.w}, rotate(convert<float>(solid.pose.rotation), Vec3f{0, 1, 0}));
    const Vec3f force = air_force_on_cylinder(air - (xyz(v) + gravity), along, 2 * solid.shape.half_length,
                                              solid.shape.radius, model.wind.air_density, object.drag, 2 * h * x.w);
    push(v, force * (h * x.w));
  });
}

constexpr int air_range = 1024;  ///< triangles or particles in a task
static_assert(air_range % air_batch == 0);

void apply_air(const Model& model, const AirKernels& kernels, State& state, Workspace& workspace, Executor& executor,
               double time, float h, FunctionRef<Vec3f(int)> gravity, EachObject each) {
  const Vec3f air = wind_at(model.wind, time);
  each([&](int o) {
    const CompiledObject& object = model.objects[o];
    const Surface& surface = object.surface;
    const int triangles = static_cast<int>(surface.triangles.size());
    Records& forces = workspace.triangle_forces[o];
    forces.resize((surface.triangles.size() + air_batch - 1) / air_batch * air_batch);
    const AirArguments arguments{triangles > 0 ? surface.triangles.front().data() : nullptr,
                                 surface.corner_begin.data(),
                                 surface.corners.data(),
                                 state.positions.data() + model.first[o],
                                 state.velocities.data() + model.first[o],
                                 forces.data(),
                                 air,
                                 gravity(o),
                                 h,
                                 model.wind.air_density,
                                 object.drag,
                                 object.lift};
    for_ranges(executor, "forces: air", triangles, air_range,
               [&](int first, int last) { kernels.find_forces(arguments, first, last); });
    for_ranges(executor, "forces: air", object.particles, air_range,
               [&](int first, int last) { kernels.apply(arguments, first, last); });
    apply_air_to_capsules(model, o, air, arguments.gravity, h, state, executor);
  });
}

/// A non-finite force that was skipped: the index of its force field, and the user's index of the particle.
struct LeftOut {
  int particle = -1, field = -1;
};

/// Fields one after another in Model::forces, all of which take one particle.
struct FieldRun {
  std::size_t first = 0, last = 0;
};

/// What a field acts on: the particles of an object, and the part of gravity that velocities do not include yet.
struct FieldTarget {
  const CompiledObject& object;
  const Record* positions;
  Record* velocities;
  Vec3f gravity;
  double time;
  float h;
};

/// Applies fields in turn to one particle; each sees the velocity that earlier ones left. Returns the first non-finite
/// force.
LeftOut apply_fields(const Model& model, FieldRun run, const FieldTarget& to, int i, int user) {
  LeftOut first;
  const Record& x = to.positions[i];
  Record& v = to.velocities[i];
  if (x.w == 0) return first;
  for (std::size_t f = run.first; f < run.last; ++f) {
    const Vec3f force = model.forces[f](xyz(x), xyz(v) + to.gravity, 1 / x.w, static_cast<float>(to.time));
    if (is_finite(force)) {
      push(v, force * (to.h * x.w));
    } else if (first.field < 0) {
      first = {user, static_cast<int>(f)};
    }
  }
  return first;
}

/// Applies a field to all particles of an object at once.
LeftOut apply_array_field(const Model& model, int field, const FieldTarget& to) {
  const auto count = static_cast<std::size_t>(to.object.user_particles);
  std::vector<Vec3f> positions(count), velocities(count), forces(count);
  std::vector<float> masses(count);
  for (std::size_t user = 0; user < count; ++user) {
    const int i = to.object.place[user];
    positions[user] = xyz(to.positions[i]);
    velocities[user] = xyz(to.velocities[i]) + to.gravity;
    masses[user] = 1 / to.positions[i].w;
  }
  model.forces[static_cast<std::size_t>(field)].array_function(
      {to.object.name, positions, velocities, masses, to.time, forces});
  LeftOut first;
  for (std::size_t user = 0; user < count; ++user) {
    const int i = to.object.place[user];
    const float w = to.positions[i].w;
    if (w == 0) continue;
    if (is_finite(forces[user]))
      push(to.velocities[i], forces[user] * (to.h * w));
    else if (first.field < 0)
      first = {static_cast<int>(user), field};
  }
  return first;
}

void warn_of(const LeftOut& force, const CompiledObject& object, std::vector<std::string>& warnings) {
  if (force.field < 0 || !warnings.empty()) return;
  warnings.push_back("force field " + std::to_string(force.field) + " is not finite at particle " +
                     std::to_string(force.particle) + " of object '" + object.name + "' and was skipped there");
}

/// Applies fields to an object's particles in the user's order, on one thread.
LeftOut apply_in_order(const Model& model, FieldRun run, const FieldTarget& to) {
  LeftOut first;
  for (int user = 0; user < to.object.user_particles; ++user) {
    const LeftOut one = apply_fields(model, run, to, to.object.place[user], user);
    if (first.field < 0) first = one;
  }
  return first;
}

/// Applies fields to an object's particles tile by tile, on all threads. Particles are independent, so bits are the
/// same.
LeftOut apply_by_tiles(const Model& model, FieldRun run, const FieldTarget& to, Executor& executor) {
  const CompiledObject& object = to.object;
  std::vector<LeftOut> of_tiles(object.tiles.size());
  executor.parallel_for("forces: fields", static_cast<int>(object.tiles.size()), [&](int tile) {
    for (int i = object.tiles[tile].first_particle; i < object.tiles[tile].last_particle; ++i) {
      const int user = object.order[i];
      if (user >= object.user_particles) continue;
      const LeftOut one = apply_fields(model, run, to, i, user);
      LeftOut& first = of_tiles[tile];
      if (one.field >= 0 && (first.field < 0 || one.particle < first.particle)) first = one;
    }
  });
  LeftOut first;
  for (const LeftOut& one : of_tiles)
    if (one.field >= 0 && (first.field < 0 || one.particle < first.particle)) first = one;
  return first;
}

/// Applies all fields to an object: those for single particles that follow one another together.
void apply_fields(const Model& model, const FieldTarget& to, bool on_all_threads, Executor& executor,
                  std::vector<std::string>& warnings) {
  for (FieldRun run; run.first < model.forces.size(); run.first = run.last) {
    run.last = run.first;
    while (run.last < model.forces.size() && !model.forces[run.last].array_function) ++run.last;
    if (run.last == run.first) {
      Stopwatch watch(executor.timings(), "forces: fields");
      warn_of(apply_array_field(model, static_cast<int>(run.last++), to), to.object, warnings);
    } else if (on_all_threads) {
      warn_of(apply_by_tiles(model, run, to, executor), to.object, warnings);
    } else {
      Stopwatch watch(executor.timings(), "forces: fields");
      warn_of(apply_in_order(model, run, to), to.object, warnings);
    }
  }
}

void apply_fields(const Model& model, State& state, Executor& executor, double time, float h,
                  FunctionRef<Vec3f(int)> gravity, EachObject each, std::vector<std::string>& warnings) {
  const bool on_all_threads = std::all_of(model.forces.begin(), model.forces.end(),
                                          [](const ForceField& field) { return field.on_all_threads; });
  each([&](int o) {
    const CompiledObject& object = model.objects[o];
    if (object.is_collider) return;
    apply_fields(model,
                 {object, state.positions.data() + model.first[o], state.velocities.data() + model.first[o], gravity(o),
                  time, h},
                 on_all_threads, executor, warnings);
  });
}

/// The velocity after a substep of h under the pull, by the implicit Euler method: v + h (omega^2 (place - x - h v') -
/// 2 omega v') = v'.
Vec3f pulled(const Pull& pull, const Vec3f& x, const Vec3f& v, float h) {
  const float turn = h * pull.frequency, kept = 1 / (1 + turn);
  return v * (kept * kept) + (pull.place - x) * ((turn * kept) * (pull.frequency * kept));
}

/// Applies the forces and pulls that the user set for this frame.
void apply_given(const Model& model, const Control& control, State& state, Executor& executor, float h,
                 FunctionRef<bool(int)> takes_part) {
  for (const auto& [o, given] : control.objects) {
    if (!takes_part(o)) continue;
    const CompiledObject& object = model.objects[o];
    const Record* positions = state.positions.data() + model.first[o];
    Record* velocities = state.velocities.data() + model.first[o];
    for (const Pull& pull : given.pulls) {
      const Record& x = positions[pull.particle];
      Record& v = velocities[pull.particle];
      if (x.w > 0) push(v, pulled(pull, xyz(x), xyz(v), h) - xyz(v));
    }
    if (given.forces.empty()) continue;
    const std::vector<Vec3f>& forces = given.forces;
    executor.parallel_for("forces: given", static_cast<int>(object.tiles.size()), [&](int tile) {
      for (int i = object.tiles[tile].first_particle; i < object.tiles[tile].last_particle; ++i)
        if (positions[i].w > 0) push(velocities[i], forces[i] * (h * positions[i].w));
    });
  }
}

}  // namespace

bool has_forces(const Model& model, const Control& control) {
  return model.wind.air_density > 0 || !model.forces.empty() || control.has_forces();
}

Vec3f wind_at(const Wind& wind, double time) {
  if (wind.gust == 0) return wind.velocity;
  const double phase = time / wind.gust_period;
  const double turn =
      phase - __builtin_floor(phase);  // floor, because no integer type holds every phase; turn in [0, 1)
  return wind.velocity * (1 + wind.gust * static_cast<float>(sin(turn * 6.283185307179586)));
}

void apply_forces(const Model& model, const Kernels& kernels, State& state, Workspace& workspace, Executor& executor,
                  double time, float h, FunctionRef<Vec3f(int)> gravity, EachObject each,
                  FunctionRef<bool(int)> takes_part, std::vector<std::string>& warnings) {
  if (model.wind.air_density > 0) apply_air(model, kernels.air, state, workspace, executor, time, h, gravity, each);
  if (!model.forces.empty()) apply_fields(model, state, executor, time, h, gravity, each, warnings);
  if (workspace.control.has_forces()) apply_given(model, workspace.control, state, executor, h, takes_part);
}

}  // namespace pliant
