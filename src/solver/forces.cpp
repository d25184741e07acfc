#include "solver/forces.h"

#include "math/functions.h"
#include "math/vector.h"
#include "parallel/launch.h"
#include "solver/air.h"

namespace pliant {

namespace {

Vec3f vector_of(const Record& r) { return {r.x, r.y, r.z}; }

void push(Record& velocity, const Vec3f& change) {
  velocity = {velocity.x + change.x, velocity.y + change.y, velocity.z + change.z, 0};
}

void apply_air(const Model& model, State& state, Workspace& workspace, Executor& executor, double time, float h,
               FunctionRef<Vec3f(int)> gravity) {
  const Vec3f air = wind_at(model.wind, time);
  for (std::size_t o = 0; o < model.objects.size(); ++o) {
    const CompiledObject& object = model.objects[o];
    const int triangles = static_cast<int>(object.surface.triangles.size());
    std::vector<Vec3f>& forces = workspace.triangle_forces[o];
    forces.resize(triangles);
    const Vec3f gravity_so_far = gravity(static_cast<int>(o));
    const Record* positions = state.positions.data() + model.first[o];
    Record* velocities = state.velocities.data() + model.first[o];
    const int* corners = triangles > 0 ? object.surface.triangles.front().data() : nullptr;
    launch(executor, "forces: air", triangles,
           AirOnTriangle{corners, positions, velocities, air, gravity_so_far, h, model.wind.air_density, object.drag,
                         object.lift, forces.data()});
    launch(executor, "forces: air", object.particles,
           AirOnParticle{object.surface.corner_begin.data(), object.surface.corners.data(), forces.data(), positions, h,
                         velocities});
  }
}

bool is_finite(const Vec3f& v) { return (v.x - v.x) + (v.y - v.y) + (v.z - v.z) == 0; }

void apply_fields(const Model& model, State& state, double time, float h, FunctionRef<Vec3f(int)> gravity,
                  std::vector<std::string>& warnings) {
  for (std::size_t o = 0; o < model.objects.size(); ++o) {
    const CompiledObject& object = model.objects[o];
    const Vec3f gravity_so_far = gravity(static_cast<int>(o));
    for (int user = 0; user < object.user_particles; ++user) {
      const int i = model.first[o] + object.place[user];
      const Record& x = state.positions[i];
      if (x.w == 0) continue;
      for (std::size_t f = 0; f < model.forces.size(); ++f) {
        const Vec3f force = model.forces[f](vector_of(x), vector_of(state.velocities[i]) + gravity_so_far, 1 / x.w,
                                            static_cast<float>(time));
        if (is_finite(force)) {
          push(state.velocities[i], force * (h * x.w));
        } else if (warnings.empty()) {
          warnings.push_back("force field " + std::to_string(f) + " is not finite at particle " + std::to_string(user) +
                             " of object '" + object.name + "' and was left out there");
        }
      }
    }
  }
}

}  // namespace

bool has_forces(const Model& model) { return model.wind.air_density > 0 || !model.forces.empty(); }

Vec3f wind_at(const Wind& wind, double time) {
  if (wind.gust == 0) return wind.velocity;
  const double phase = time / wind.gust_period;
  const double turn = phase - __builtin_floor(phase);  // no integer holds every phase
  return wind.velocity * (1 + wind.gust * static_cast<float>(sin(turn * 6.283185307179586)));
}

void apply_forces(const Model& model, State& state, Workspace& workspace, Executor& executor, double time, float h,
                  FunctionRef<Vec3f(int)> gravity, std::vector<std::string>& warnings) {
  if (model.wind.air_density > 0) apply_air(model, state, workspace, executor, time, h, gravity);
  if (!model.forces.empty()) {
    Stopwatch watch(executor.timings(), "forces: fields");
    apply_fields(model, state, time, h, gravity, warnings);
  }
}

}  // namespace pliant
