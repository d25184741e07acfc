// Reads a World between steps.
#include <algorithm>

#include "constraints/registry.h"
#include "matter/advice_settings.h"
#include "pliant/error.h"
#include "world/advice.h"
#include "world/implementation.h"

namespace pliant {

std::vector<Vec3f> World::Implementation::in_given_order(int number, const Records& records) const {
  const CompiledObject& from = model.objects[number];
  std::vector<Vec3f> out(from.user_particles);
  for (int user = 0; user < from.user_particles; ++user) {
    const Record& r = records[static_cast<std::size_t>(model.first[number]) + from.place[user]];
    out[user] = {r.x, r.y, r.z};
  }
  return out;
}

/// The overstretch with the slot of its object instead of the number in the model.
Overstretch World::Implementation::with_slot(Overstretch measured) const {
  if (measured.object < 0) return measured;
  const ObjectId id = object_ids.id_of(measured.object);
  measured.object = id.slot;
  measured.generation = id.generation;
  return measured;
}

ObjectInfo World::info(ObjectId object) const {
  const CompiledObject& from = self_->object(object);
  ObjectInfo info{from.name, from.user_particles, {}, self_->substeps_of(self_->number(object))};
  for (int type = 0; type < constraint_type_count(); ++type) {
    std::int64_t count = 0;
    for (const Pool& pool : from.pools) count += pool.type == type ? pool.constraints : 0;
    if (count > 0) info.constraints.emplace_back(constraint_type(type).name, count);
  }
  if (from.has_volume) info.constraints.emplace_back("volume", 1);
  return info;
}

std::vector<Vec3f> World::positions(ObjectId object) const {
  return self_->in_given_order(self_->number(object), self_->state.positions);
}
std::vector<Vec3f> World::velocities(ObjectId object) const {
  return self_->in_given_order(self_->number(object), self_->state.velocities);
}

namespace {

void read(const CompiledObject& from, const Record* records, std::span<Vec3f> into) {
  if (into.size() != static_cast<std::size_t>(from.user_particles)) {
    throw Error({.object = from.name},
                "has " + std::to_string(from.user_particles) + " particles, but the span has room for " +
                    std::to_string(into.size()),
                "give a span of that size");
  }
  for (int user = 0; user < from.user_particles; ++user) {
    const Record& r = records[from.place[user]];
    into[user] = {r.x, r.y, r.z};
  }
}

}  // namespace

void World::read_positions(ObjectId object, std::span<Vec3f> into) const {
  read(self_->object(object), self_->positions_of(object), into);
}
void World::read_velocities(ObjectId object, std::span<Vec3f> into) const {
  read(self_->object(object), self_->state.velocities.data() + self_->model.first[self_->number(object)], into);
}
void World::read_mesh_collider_positions(MeshColliderId collider, std::span<Vec3f> into) const {
  const int number = self_->mesh_collider_ids.number(collider);
  read(self_->model.objects[number], self_->state.positions.data() + self_->model.first[number], into);
}

std::span<const Record> World::positions_in_storage_order(ObjectId object) const {
  return {self_->positions_of(object), static_cast<std::size_t>(self_->object(object).particles)};
}
std::span<const Record> World::velocities_in_storage_order(ObjectId object) const {
  return {self_->state.velocities.data() + self_->model.first[self_->number(object)],
          static_cast<std::size_t>(self_->object(object).particles)};
}
std::span<const int> World::storage_order(ObjectId object) const { return self_->object(object).order; }

std::vector<Quatf> World::orientations(ObjectId object) const {
  const int number = self_->number(object);
  std::vector<Quatf> out;
  for (int i = self_->model.first_frame[number]; i < self_->model.end_of_frames(number); ++i) {
    const Record& q = self_->state.frames.orientations[i];
    out.push_back({q.x, q.y, q.z, q.w});
  }
  return out;
}

std::vector<Vec3f> World::angular_velocities(ObjectId object) const {
  std::vector<Vec3f> out;
  const std::vector<Quatf> rotation = orientations(object);
  const int first = self_->model.first_frame[self_->number(object)];
  for (std::size_t i = 0; i < rotation.size(); ++i) {
    const Record& w = self_->state.frames.angular_velocities[first + i];
    out.push_back(rotate(rotation[i], Vec3f{w.x, w.y, w.z}));
  }
  return out;
}

TriangleMesh World::mesh(ObjectId object) const {
  TriangleMesh mesh{positions(object), {}};
  const CompiledObject& from = self_->object(object);
  for (const auto& t : from.surface.triangles)
    mesh.triangles.push_back({from.order[t[0]], from.order[t[1]], from.order[t[2]]});
  return mesh;
}

Vec3f World::collider_position(ColliderId collider) const { return convert<float>(self_->pose_now(collider)).position; }
Quatf World::collider_rotation(ColliderId collider) const { return convert<float>(self_->pose_now(collider)).rotation; }

std::vector<Vec3f> World::mesh_collider_positions(MeshColliderId collider) const {
  return self_->in_given_order(self_->mesh_collider_ids.number(collider), self_->state.positions);
}

std::vector<float> World::multipliers(ObjectId object, const std::string& type) const {
  const int number = self_->number(object);
  const CompiledObject& from = self_->model.objects[number];
  std::vector<float> out;
  if (type == "volume" && from.has_volume) return {static_cast<float>(self_->workspace.volume_multipliers[number])};
  if (self_->workspace.multipliers[number].empty()) return out;
  for (std::size_t p = 0; p < from.pools.size(); ++p) {
    const Pool& pool = from.pools[p];
    if (type != constraint_types()[pool.type].name || self_->workspace.multipliers[number][p].empty()) continue;
    for (std::size_t lane = 0; lane < pool.origin.size(); ++lane) {
      if (pool.origin[lane] < 0) continue;
      const std::size_t first = static_cast<std::size_t>(pool.origin[lane]) * pool.components;
      if (out.size() < first + pool.components) out.resize(first + pool.components, 0.f);
      for (int row = 0; row < pool.components; ++row)
        out[first + row] = self_->workspace.multipliers[number][p][multiplier_index(
            pool, static_cast<std::int64_t>(lane) / batch_width, static_cast<int>(lane % batch_width), row)];
    }
  }
  return out;
}

double World::kinetic_energy() const {
  double energy = 0;
  for (std::size_t i = 0; i < self_->state.positions.size(); ++i) {
    const Record &v = self_->state.velocities[i], &x = self_->state.positions[i];
    if (x.w > 0) energy += 0.5 / x.w * (double(v.x) * v.x + double(v.y) * v.y + double(v.z) * v.z);
  }
  const FrameRecords& frames = self_->state.frames;
  const auto turning = [](float speed, float inverse) { return inverse > 0 ? 0.5 / inverse * speed * speed : 0.0; };
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Record &w = frames.angular_velocities[i], &inverse = frames.inverse_inertias[i];
    energy += turning(w.x, inverse.x) + turning(w.y, inverse.y) + turning(w.z, inverse.z);
  }
  return energy;
}

double World::potential_energy() const {
  double energy = 0;
  const Vec3f& g = self_->model.gravity;
  for (const Record& x : self_->state.positions) {
    if (x.w > 0) energy -= 1.0 / x.w * (double(g.x) * x.x + double(g.y) * x.y + double(g.z) * x.z);
  }
  return energy;
}

std::vector<Residual> World::residuals() const {
  return measure_residuals(self_->model, self_->state, self_->workspace, [&](int object) { return self_->h_of(object); });
}
Stretch World::stretch() const {
  std::vector<float> ratios;
  return measure_stretch(self_->model, self_->state, ratios);
}
Overstretch World::overstretch() const {
  OverstretchMeter meter;  // of its own and on this thread, because calls may be concurrent
  return self_->with_slot(meter.measure({self_->model, self_->state, self_->workspace, self_->kernels.lengths}, nullptr));
}

namespace {

/// True if a figure is of an object's constraint that exists.
bool is_present(const Overstretch& found, const CompiledObject& object) {
  return std::all_of(found.particles.begin(), found.particles.end(),
                     [&](int particle) { return particle >= 0 && particle < object.particles; });
}

std::string of_unknown(const Overstretch& found) {
  return "an object that was removed or edited stretched " + percent(found.largest) + " too far";
}

}  // namespace

std::string World::describe(const Overstretch& found) const {
  if (found.object < 0) return {};
  const ObjectId id(found.object, found.generation);
  if (!has(id) || !is_present(found, self_->object(id))) return of_unknown(found);
  return words_of(found, self_->object(id));
}

std::string World::advice(const Overstretch& found) const {
  if (is_tolerable(found)) return {};
  const ObjectId id(found.object, found.generation);
  if (!has(id)) return of_unknown(found);
  const int substeps = self_->substeps_of(self_->number(id));
  const std::string more = substeps > 0 ? "more than " + std::to_string(substeps) + " substeps"
                                        : "a larger \"least_substeps\" or \"most_substeps\"";
  return describe(found) + "; " +
         (self_->departs.empty() ? more : "the default, with no " + self_->departs + " in the scene's \"settings\",") +
         " may reduce it: 'pliant check' or advise() finds out";
}

std::string World::advice(const Report& report) const {
  return report.overstretch ? advice(*report.overstretch) : std::string();
}

double World::enclosed_volume(ObjectId object) const {
  return measure_volume(self_->object(object), self_->positions_of(object));
}

}  // namespace pliant
