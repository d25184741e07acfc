// Reads objects and colliders between steps.
#include <algorithm>

#include "constraints/registry.h"
#include "pliant/error.h"
#include "world/control.h"
#include "world/groups.h"

namespace pliant {

namespace {

/// Where a State keeps a particle of an object that a user has given this number.
std::size_t particle_of(const WorldData& world, int number, int user) {
  const std::int64_t particle = world.model.first[number] + world.model.objects[number].place[user];
  return static_cast<std::size_t>(particle);
}

/// Converts an array from storage order to the user's order, for an object or a mesh collider.
std::vector<Vec3f> in_given_order(const WorldData& world, int number, const Records& records) {
  const CompiledObject& from = world.model.objects[number];
  std::vector<Vec3f> out(from.user_particles);
  for (int user = 0; user < from.user_particles; ++user) {
    const Record& r = records[particle_of(world, number, user)];
    out[user] = {r.x, r.y, r.z};
  }
  return out;
}

void read(const CompiledObject& from, const Record* records, std::span<Vec3f> into) {
  if (into.size() != static_cast<std::size_t>(from.user_particles)) {
    throw Error(
        {.object = from.name},
        "has " + std::to_string(from.user_particles) + " particles, but there is room for " +
            std::to_string(into.size()),
        "give room for " + std::to_string(from.user_particles) + " points; a point of three numbers counts as one");
  }
  for (int user = 0; user < from.user_particles; ++user) {
    const Record& r = records[from.place[user]];
    into[user] = {r.x, r.y, r.z};
  }
}

const Record* positions_of(const WorldData& world, ObjectId id) {
  return world.state.positions.data() + world.model.first[world.number(id)];
}
const Record* velocities_of(const WorldData& world, ObjectId id) {
  return world.state.velocities.data() + world.model.first[world.number(id)];
}

}  // namespace

ObjectInfo ObjectView::info() const {
  const CompiledObject& from = read_->object(id_);
  ObjectInfo info{from.name, from.user_particles, {}, substeps_of(*read_, read_->number(id_))};
  for (int type = 0; type < constraint_type_count(); ++type) {
    std::int64_t count = 0;
    for (const Pool& pool : from.pools) count += pool.type == type ? pool.constraints : 0;
    if (count > 0) info.constraints.emplace_back(constraint_type(type).name, count);
  }
  if (from.has_volume) info.constraints.emplace_back("volume", 1);
  return info;
}

const std::string& ObjectView::name() const { return read_->object(id_).name; }
int ObjectView::particle_count() const { return read_->object(id_).user_particles; }

std::vector<Vec3f> ObjectView::positions() const {
  return in_given_order(*read_, read_->number(id_), read_->state.positions);
}
std::vector<Vec3f> ObjectView::velocities() const {
  return in_given_order(*read_, read_->number(id_), read_->state.velocities);
}

std::vector<float> ObjectView::channel(const std::string& name) const {
  const int number = read_->number(id_);
  const CompiledObject& object = read_->model.objects[number];
  for (const Channel& channel : read_->state.channels) {
    if (channel.name != name || channel.components != 1) continue;
    std::vector<float> out(static_cast<std::size_t>(object.user_particles));
    for (int user = 0; user < object.user_particles; ++user)
      out[user] = channel.values[particle_of(*read_, number, user)];
    return out;
  }
  return {};
}

std::vector<int> ObjectView::present() const {
  const int number = read_->number(id_);
  const CompiledObject& from = read_->model.objects[number];
  std::vector<int> out;
  for (int user = 0; user < from.user_particles; ++user)
    if (is_there(read_->state, particle_of(*read_, number, user))) out.push_back(user);
  return out;
}

std::vector<Vec3f> ObjectView::present_positions() const {
  std::vector<Vec3f> all = positions();
  if (!flows()) return all;
  std::vector<Vec3f> out;
  for (const int i : present()) out.push_back(all[static_cast<std::size_t>(i)]);
  return out;
}

bool ObjectView::flows() const { return read_->object(id_).flow.is_used(); }

std::vector<double> ObjectView::ages() const {
  const int number = read_->number(id_);
  const CompiledObject& from = read_->model.objects[number];
  std::vector<double> out(static_cast<std::size_t>(from.user_particles), read_->state.time);
  for (int user = 0; user < from.user_particles; ++user) {
    const std::size_t particle = particle_of(*read_, number, user);
    if (!read_->state.births.empty())
      out[user] = is_there(read_->state, particle) ? read_->state.time - read_->state.births[particle] : -1;
  }
  return out;
}

void ObjectView::read_positions(std::span<Vec3f> into) const {
  read(read_->object(id_), positions_of(*read_, id_), into);
}
void ObjectView::read_velocities(std::span<Vec3f> into) const {
  read(read_->object(id_), velocities_of(*read_, id_), into);
}
void MeshColliderView::read_positions(std::span<Vec3f> into) const {
  const int number = read_->ids.mesh_colliders.number(id_);
  read(read_->model.objects[number], read_->state.positions.data() + read_->model.first[number], into);
}

std::span<const Record> ObjectView::positions_in_storage_order() const {
  return {positions_of(*read_, id_), static_cast<std::size_t>(read_->object(id_).particles)};
}
std::span<const Record> ObjectView::velocities_in_storage_order() const {
  return {velocities_of(*read_, id_), static_cast<std::size_t>(read_->object(id_).particles)};
}
std::span<const int> ObjectView::storage_order() const { return read_->object(id_).order; }

std::vector<Quatf> ObjectView::orientations() const {
  const int number = read_->number(id_);
  std::vector<Quatf> out;
  for (int i = read_->model.first_frame[number]; i < read_->model.end_of_frames(number); ++i) {
    const Record& q = read_->state.frames.orientations[i];
    out.push_back({q.x, q.y, q.z, q.w});
  }
  return out;
}

std::vector<Vec3f> ObjectView::angular_velocities() const {
  std::vector<Vec3f> out;
  const std::vector<Quatf> rotation = orientations();
  const int first = read_->model.first_frame[read_->number(id_)];
  for (std::size_t i = 0; i < rotation.size(); ++i) {
    const Record& w = read_->state.frames.angular_velocities[first + i];
    out.push_back(rotate(rotation[i], Vec3f{w.x, w.y, w.z}));
  }
  return out;
}

TriangleMesh ObjectView::mesh() const {
  TriangleMesh mesh{positions(), {}};
  const CompiledObject& from = read_->object(id_);
  for (const auto& t : from.surface.triangles)
    mesh.triangles.push_back({from.order[t[0]], from.order[t[1]], from.order[t[2]]});
  return mesh;
}

RigidPose ColliderView::pose() const {
  const auto pose = convert<float>(pose_now(*read_, id_));
  return {pose.position, pose.rotation};
}

const std::string& ColliderView::name() const { return read_->collider(id_).name; }

const std::string& MeshColliderView::name() const {
  return read_->model.objects[read_->ids.mesh_colliders.number(id_)].name;
}
int MeshColliderView::vertex_count() const {
  return read_->model.objects[read_->ids.mesh_colliders.number(id_)].user_particles;
}

std::vector<Vec3f> MeshColliderView::positions() const {
  return in_given_order(*read_, read_->ids.mesh_colliders.number(id_), read_->state.positions);
}

std::vector<float> ObjectView::multipliers(const std::string& type) const {
  const int number = read_->number(id_);
  const CompiledObject& from = read_->model.objects[number];
  std::vector<float> out;
  if (type == "volume" && from.has_volume) return {static_cast<float>(read_->workspace.volume_multipliers[number])};
  if (read_->workspace.multipliers[number].empty()) return out;
  for (std::size_t p = 0; p < from.pools.size(); ++p) {
    const Pool& pool = from.pools[p];
    const bool is_kept = read_->workspace.pointers_before_last[number][p] != nullptr;  // not for the estimates alone
    if (type != constraint_types()[pool.type].name || !is_kept) continue;
    for (std::size_t lane = 0; lane < pool.origin.size(); ++lane) {
      if (pool.origin[lane] < 0) continue;
      const std::size_t first = static_cast<std::size_t>(pool.origin[lane]) * pool.components;
      if (out.size() < first + pool.components) out.resize(first + pool.components, 0.f);
      for (int row = 0; row < pool.components; ++row)
        out[first + row] = read_->workspace.multipliers[number][p][multiplier_index(
            pool, static_cast<std::int64_t>(lane) / batch_width, static_cast<int>(lane % batch_width), row)];
    }
  }
  return out;
}

const CompiledBodies::Body& body_of(const CompiledObject& object, int body) {
  if (body < 0 || static_cast<std::size_t>(body) >= object.bodies.bodies.size())
    throw Error({.object = object.name, .element = "body " + std::to_string(body)},
                "does not exist; there are " + std::to_string(object.bodies.bodies.size()) + " bodies",
                "indices count from 0");
  return object.bodies.bodies[static_cast<std::size_t>(body)];
}

int body_of_name(const CompiledObject& object, const std::string& name) {
  const std::vector<CompiledBodies::Label>& labels = object.bodies.labels;
  const auto has_name = [&](const CompiledBodies::Label& label) { return label.name == name; };
  const auto count = std::count_if(labels.begin(), labels.end(), has_name);
  if (count != 1)
    throw Error({.object = object.name, .element = "body '" + name + "'"},
                count == 0 ? "does not exist" : "is the name of " + std::to_string(count) + " bodies",
                count == 0 ? "use the name of one of its bodies" : "use the index, or give each body its own name");
  return static_cast<int>(std::find_if(labels.begin(), labels.end(), has_name) - labels.begin());
}

RigidPose ObjectView::pose(int body) const {
  const int number = read_->number(id_);
  const CompiledObject& from = read_->model.objects[number];
  const CompiledBodies::Body& place = body_of(from, body);
  const Posed& described = from.bodies.labels[static_cast<std::size_t>(body)].described;
  const Record& x = read_->state.positions[read_->model.first[number] + place.particle];
  const Record& q = read_->state.frames.orientations[read_->model.first_frame[number] + place.frame];
  const Posed axes{convert<double>(Vec3f{x.x, x.y, x.z}), normalise(convert<double>(Quatf{q.x, q.y, q.z, q.w}))};
  return {convert<float>(to_world(axes, described.position)),
          convert<float>(normalise(multiply(axes.rotation, described.rotation)))};
}

RigidPose ObjectView::pose(const std::string& body) const { return pose(body_of_name(read_->object(id_), body)); }

bool ObjectView::body_is_asleep(int body) const {
  const int number = read_->number(id_);
  const CompiledObject& from = read_->model.objects[number];
  const int number_of_frame = read_->model.first_frame[number] + body_of(from, body).frame;
  const auto frame = static_cast<std::size_t>(number_of_frame);
  return frame < read_->state.rest_times.size() && read_->state.rest_times[frame] == asleep;
}

double ObjectView::enclosed_volume() const { return measure_volume(read_->object(id_), positions_of(*read_, id_)); }

}  // namespace pliant
