// Measures a World between steps, and describes what falls short.
#include <algorithm>

#include "matter/advice_settings.h"
#include "world/advice.h"
#include "world/groups.h"

namespace pliant {

namespace {

/// Length of an object's substeps in the last step [s]; 1 if it took part in none, because then multipliers are zero.
float h_of(const WorldData& world, int number) {
  return world.workspace.last_h[number] > 0 ? world.workspace.last_h[number] : 1.f;
}

/// True if a figure is of an object's constraint that exists.
bool is_present(const Overstretch& found, const CompiledObject& object) {
  return std::all_of(found.particles.begin(), found.particles.end(),
                     [&](int particle) { return particle >= 0 && particle < object.particles; });
}

std::string of_unknown(const Overstretch& found) {
  return "an object that was removed or edited stretched " + percent(found.largest) + " too far";
}

}  // namespace

/// The overstretch with the slot of its object instead of the number in the model.
Overstretch with_slot(const WorldData& world, Overstretch measured) {
  if (measured.object < 0) return measured;
  const ObjectId id = world.ids.objects.id_of(measured.object);
  measured.object = id.slot;
  measured.generation = id.generation;
  return measured;
}

double Measurements::kinetic_energy() const {
  double energy = 0;
  for (std::size_t i = 0; i < world_->state.positions.size(); ++i) {
    const Record &v = world_->state.velocities[i], &x = world_->state.positions[i];
    if (x.w > 0) energy += 0.5 / x.w * (double(v.x) * v.x + double(v.y) * v.y + double(v.z) * v.z);
  }
  const FrameRecords& frames = world_->state.frames;
  const auto turning = [](float speed, float inverse) { return inverse > 0 ? 0.5 / inverse * speed * speed : 0.0; };
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Record &w = frames.angular_velocities[i], &inverse = frames.inverse_inertias[i];
    energy += turning(w.x, inverse.x) + turning(w.y, inverse.y) + turning(w.z, inverse.z);
  }
  return energy;
}

double Measurements::potential_energy() const {
  double energy = 0;
  const Vec3f& g = world_->model.gravity;
  for (const Record& x : world_->state.positions) {
    if (x.w > 0) energy -= 1.0 / x.w * (double(g.x) * x.x + double(g.y) * x.y + double(g.z) * x.z);
  }
  return energy;
}

std::vector<Residual> Measurements::residuals() const {
  return measure_residuals(world_->model, world_->state, world_->workspace,
                           [&](int object) { return h_of(*world_, object); });
}
Stretch Measurements::stretch() const {
  std::vector<float> ratios;
  return measure_stretch(world_->model, world_->state, ratios);
}
Overstretch Measurements::overstretch() const {
  OverstretchMeter meter;  // of its own and on this thread, because calls may be concurrent
  return with_slot(*world_,
                   meter.measure({world_->model, world_->state, world_->workspace, world_->kernels.lengths}, nullptr));
}

std::string Measurements::describe(const Overstretch& found) const {
  if (found.object < 0) return {};
  const ObjectId id(found.object, found.generation);
  if (!world_->ids.objects.has(id) || !is_present(found, world_->object(id))) return of_unknown(found);
  return words_of(found, world_->object(id));
}

std::string Measurements::advice(const Overstretch& found) const {
  if (is_tolerable(found)) return {};
  const ObjectId id(found.object, found.generation);
  if (!world_->ids.objects.has(id)) return of_unknown(found);
  const int substeps = substeps_of(*world_, world_->number(id));
  const std::string more = substeps > 0 ? "more than " + std::to_string(substeps) + " substeps"
                                        : "a larger \"least_substeps\" or \"most_substeps\"";
  return describe(found) + "; " +
         (world_->open.departs.empty() ? more
                                       : "the default, with no " + world_->open.departs + " in the scene's \"settings\",") +
         " may reduce it: 'pliant check' or advise() finds out";
}

std::string Measurements::advice(const Report& report) const {
  return report.overstretch ? advice(*report.overstretch) : std::string();
}

}  // namespace pliant
