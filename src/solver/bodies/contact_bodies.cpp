#include "solver/bodies/contact_bodies.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "collision/proxies/contact_tables.h"
#include "math/motion.h"
#include "model/surface_velocity.h"
#include "solver/bodies/body_math.h"
#include "solver/substep.h"

namespace pliant {

namespace {

std::pair<Posed, Posed> poses_between(const MovingCollider& collider) {
  return {convert<double>(collider.before), convert<double>(collider.after)};
}

ConvexShape shape_of_collider(const Shape& shape, std::vector<Polyhedron>& polyhedra) {
  if (const Box* box = std::get_if<Box>(&shape)) return convex_shape_of(*box, polyhedra);
  if (const Capsule* capsule = std::get_if<Capsule>(&shape)) return convex_shape_of(*capsule, polyhedra);
  if (const Sphere* sphere = std::get_if<Sphere>(&shape)) return convex_shape_of(*sphere, polyhedra);
  return {};
}

/// A spin without what is about round axes, which moves no surface.
Vec3f without(const Vec3f& round, const Vec3f& spin) {
  return {spin.x * (1 - round.x), spin.y * (1 - round.y), spin.z * (1 - round.z)};
}

/// One for each axis along which a polyhedron is so slender that a turn about that moves its surface by nothing that
/// counts. Contacts that turned with it about that axis would see its turn about others in a wrong direction.
Vec3f slender_axes_of(const CompiledSolid& solid) {
  constexpr float slender = 2e-3f;  // width over length
  Vec3f along{}, across{};          // squares
  for (const Vec3f& corner : solid.shape.polyhedron->corners) {
    const Vec3f p = to_world(convert<float>(solid.pose), corner);
    const Vec3f squares{p.x * p.x, p.y * p.y, p.z * p.z};
    along = max(along, squares);
    across = max(across, Vec3f{squares.y + squares.z, squares.z + squares.x, squares.x + squares.y});
  }
  const auto is_slender = [](float width, float length) { return width < slender * slender * length ? 1.f : 0.f; };
  return {is_slender(across.x, along.x), is_slender(across.y, along.y), is_slender(across.z, along.z)};
}

/// One for each axis of its body about which a solid is round, else zero.
Vec3f round_axes_of(const CompiledSolid& solid) {
  constexpr double straight = 1e-5;
  const Vec3d centre = solid.pose.position;
  const bool is_ball = solid.shape.kind == ConvexShape::Kind::point;
  if (solid.shape.kind == ConvexShape::Kind::polyhedron) return slender_axes_of(solid);
  const double size = static_cast<double>(solid.shape.radius + solid.shape.core_radius);
  if (is_ball && length(centre) < straight * size) return {1, 1, 1};
  const Vec3d along = is_ball ? centre * (1 / length(centre)) : rotate(solid.pose.rotation, Vec3d{0, 1, 0});
  if (!(length(cross(along, centre)) < straight * size)) return {};
  const auto round = [&](double part) { return std::fabs(part) > 1 - straight * straight ? 1.f : 0.f; };
  return {round(along.x), round(along.y), round(along.z)};
}

}  // namespace

namespace {

/// Where the vertices of a mesh collider are now, and at the frame's end: by its keyframes, or where the user moves
/// them [m].
struct VertexPaths {
  std::vector<Vec3d> now, end;
};

VertexPaths vertex_paths(const Substep& s, int number) {
  const CompiledObject& object = s.model.objects[at(number)];
  const double end = s.frame_start + s.dt;
  const PoseDrive* const drive = s.work.control.mesh(number);
  const CarrierPose pose =
      drive != nullptr ? CarrierPose(object.carrier, end, drive->at(end)) : CarrierPose(object.carrier, end);
  const bool is_carried = drive != nullptr || object.carrier.moves();
  VertexPaths paths;
  paths.now.reserve(at(object.particles));
  paths.end.reserve(at(object.particles));
  for (int i = 0; i < object.particles; ++i) {
    const std::size_t particle = at(s.model.first[at(number)] + i);
    paths.now.push_back(convert<double>(xyz(s.state.positions[particle])) +
                        convert<double>(xyz(s.state.remainders[particle])));
    paths.end.push_back(is_carried ? pose.place(i) : paths.now.back());
  }
  if (const ObjectControl* const control = s.work.control.object(number))
    for (const Target& target : control->targets) paths.end[at(target.particle)] = target.to;
  return paths;
}

void set_velocities(const VertexPaths& paths, double dt, BodyMeshes::Entry& entry) {
  entry.velocities.clear();
  entry.velocities.reserve(paths.now.size());
  Vec3d sum{};
  for (std::size_t i = 0; i < paths.now.size(); ++i) {
    const Vec3d velocity = (paths.end[i] - paths.now[i]) * (1 / dt);
    entry.velocities.push_back(convert<float>(velocity));
    sum += velocity;
  }
  entry.velocity = convert<float>(sum * (1 / static_cast<double>(paths.now.size())));
  entry.deforming = 0;
  for (const Vec3f& velocity : entry.velocities)
    entry.deforming = std::max(entry.deforming, length(velocity - entry.velocity));
}

}  // namespace

ContactBodies::ContactBodies(const Model& model, const std::vector<int>* objects, BodyMeshes& meshes)
    : rules_(contact_rules(model)), meshes_(&meshes) {
  std::vector<BodyPart> of_bodies;
  const int count = objects == nullptr ? static_cast<int>(model.objects.size()) : static_cast<int>(objects->size());
  for (int i = 0; i < count; ++i) add_object(model, objects == nullptr ? i : (*objects)[at(i)], of_bodies);
  dynamic_ = static_cast<int>(places_.size());
  if (dynamic_ == 0) return;
  collider_shapes_.reserve(model.colliders.size());  // shapes point into it
  for (int c = static_cast<int>(model.colliders.size()); c-- > 0;) add_collider(model, c);
  for (int o = 0; o < static_cast<int>(model.objects.size()); ++o)
    if (model.objects[at(o)].is_collider && model.objects[at(o)].particles > 0) add_mesh(model, o);
  parts_.insert(parts_.end(), of_bodies.begin(), of_bodies.end());
}

void ContactBodies::add_object(const Model& model, int object, std::vector<BodyPart>& parts) {
  const CompiledObject& from = model.objects[at(object)];
  const int first = static_cast<int>(places_.size());
  const int family = rules_.meet(object, object) ? -1 : object;
  std::size_t next_driven = 0;  // in the order of bodies
  for (std::size_t b = 0; b < from.bodies.bodies.size(); ++b) {
    const auto& [particle, frame] = from.bodies.bodies[b];
    places_.push_back(
        {object, static_cast<int>(b), model.first[at(object)] + particle, model.first_frame[at(object)] + frame});
    round_.push_back({});
    const bool is_driven = next_driven < from.bodies.driven.size() && from.bodies.driven[next_driven].frame == frame;
    driven_.push_back(is_driven ? static_cast<int>(next_driven++) : -1);
  }
  std::vector<char> has_solid(from.bodies.bodies.size(), 0);
  for (int i = 0; i < static_cast<int>(from.bodies.solids.size()); ++i) {
    const CompiledSolid& solid = from.bodies.solids[at(i)];
    parts.push_back({{object, i, 0}, first + solid.body, solid.shape, false, solid.pose, nullptr, family});
    Vec3f& round = round_[at(first + solid.body)];
    round = has_solid[at(solid.body)] == 0 ? round_axes_of(solid) : min(round, round_axes_of(solid));
    has_solid[at(solid.body)] = 1;
  }
}

void ContactBodies::add_collider(const Model& model, int collider) {
  const Shape& shape = model.colliders[at(collider)].shape;
  parts_.push_back({{-1 - collider, 0, 0},
                    static_cast<int>(places_.size()),
                    shape_of_collider(shape, collider_shapes_),
                    std::holds_alternative<Plane>(shape),
                    {}});
  BodyPlace place;
  place.collider = collider;
  places_.push_back(place);
}

void ContactBodies::add_mesh(const Model& model, int object) {
  const CompiledObject& from = model.objects[at(object)];
  const auto field = std::find_if(model.fields.begin(), model.fields.end(),
                                  [&](const FieldCollider& one) { return one.object == object; });
  const bool is_terrain = field != model.fields.end() && field->field->is_ground();
  BodyMeshes::Entry& entry = meshes_->of_object[object];
  if (entry.mesh == nullptr || entry.generation != model.generation[at(object)])
    entry = {
        model.generation[at(object)], false,
        std::make_unique<BodyMesh>(from.carrier.rest, from.surface.triangles,
                                   is_terrain ? BodyMesh::Kind::terrain : BodyMesh::Kind::surface, from.thickness)};
  BodyPlace place;
  place.object = object;
  place.mesh = entry.mesh.get();
  parts_.push_back({{object, 0, 0}, static_cast<int>(places_.size()), {}, false, {}, place.mesh});
  places_.push_back(place);
}

std::string ContactBodies::name(const Model& model, int index) const {
  const BodyPlace& place = places_[at(index)];
  if (place.collider >= 0) return "'" + model.colliders[at(place.collider)].name + "'";
  const std::string object = "'" + model.objects[at(place.object)].name + "'";
  return place.is_body()
             ? words_of_body(model.objects[at(place.object)].bodies, place.body, model.objects[at(place.object)].name)
             : object;
}

bool ContactBodies::meet(const Substep& s, int a, int b) const {
  const BodyPlace &one = places_[at(a)], &other = places_[at(b)];
  if (!one.is_body() && !other.is_body()) return false;
  if (one.collider >= 0 || other.collider >= 0) return true;
  if (!one.is_body() || !other.is_body())
    return meets_mesh(s.model, one.is_body() ? one : other, one.is_body() ? other : one);
  if (!rules_.meet(one.object, other.object)) return false;
  if (one.object != other.object) return true;
  const std::pair<int, int> both = std::minmax(one.body, other.body);
  const auto has = [&](const std::vector<std::pair<int, int>>& pairs) {
    return !pairs.empty() && std::binary_search(pairs.begin(), pairs.end(), both);
  };
  return !has(s.model.objects[at(one.object)].bodies.jointed) || has(s.work.joints[at(one.object)].freed);
}

bool ContactBodies::meets_mesh(const Model& model, const BodyPlace& body, const BodyPlace& mesh) const {
  const CompiledObject &object = model.objects[at(body.object)], &collider = model.objects[at(mesh.object)];
  const auto field = std::find_if(model.fields.begin(), model.fields.end(),
                                  [&](const FieldCollider& one) { return one.object == mesh.object; });
  const bool has_field = field != model.fields.end();
  const std::uint32_t groups = has_field ? field->groups : collider.groups,
                      mask = has_field ? field->mask : collider.mask;
  return (object.groups & mask) != 0 && (groups & object.mask) != 0;
}

/// True if a vertex of a mesh is not where the mesh's pose puts it, so that the user or frames have moved it.
bool ContactBodies::is_deformed(const Substep& s, const BodyPlace& place) const {
  const CompiledObject& object = s.model.objects[at(place.object)];
  if (object.groups == 0) return false;  // terrain or a grid, which is rigid
  const ObjectControl* control = s.work.control.object(place.object);
  if (object.carrier.deforms() || (control != nullptr && !control->targets.empty())) return true;
  const Posed pose = rigid_poses(s, place, s.frame_start, s.frame_start).first;
  for (int i = 0; i < object.particles; ++i) {
    const Vec3d expected = to_world(pose, convert<double>(object.carrier.rest[at(i)]));
    const Vec3d there = convert<double>(xyz(s.state.positions[at(s.model.first[at(place.object)] + i)]));
    if (length(there - expected) > 1e-5 * (1 + length(expected))) return true;
  }
  return false;
}

void ContactBodies::move_vertices(const Substep& s, const BodyPlace& place) {
  const CompiledObject& object = s.model.objects[at(place.object)];
  BodyMeshes::Entry& entry = meshes_->of_object.at(place.object);
  const bool was_deformed = std::exchange(entry.is_deformed, is_deformed(s, place));
  if (!entry.is_deformed) {
    if (was_deformed) entry.mesh->move(object.carrier.rest);
    return;
  }
  std::vector<Vec3f> positions;
  positions.reserve(at(object.particles));
  for (int i = 0; i < object.particles; ++i)
    positions.push_back(xyz(s.state.positions[at(s.model.first[at(place.object)] + i)]));
  entry.mesh->move(positions);
  set_velocities(vertex_paths(s, place.object), s.dt, entry);
}

SurfaceMotion ContactBodies::motion_of_surface(const Model& model, int place, const BodyContact& contact) const {
  const int object = places_[at(place)].object;
  const BodyMeshes::Entry& entry = meshes_->of_object.at(object);
  return motion_of_mesh(contact, *entry.mesh, model.objects[at(object)].surface.triangles, entry.velocities);
}

std::pair<Posed, Posed> ContactBodies::rigid_poses(const Substep& s, const BodyPlace& place, double before,
                                                   double after) const {
  const PoseDrive* drive = s.work.control.mesh(place.object);
  const Motion& motion = s.model.objects[at(place.object)].carrier.motion;
  if (drive != nullptr) return {drive->at(before), drive->at(after)};
  return {pose_at(motion, before), pose_at(motion, after)};
}

std::pair<Posed, Posed> ContactBodies::poses_of_mesh(const Substep& s, const BodyPlace& place, double before,
                                                     double after) const {
  if (meshes_->of_object.at(place.object).is_deformed) return {};
  return rigid_poses(s, place, before, after);
}

/// Greatest torques against rolling and spinning of one side, per normal force [m].
std::pair<float, float> ContactBodies::rolling(const Model& model, const BodyPlace& place) const {
  if (place.collider < 0) {
    const CompiledObject& object = model.objects[at(place.object)];
    return {object.rolling_friction, object.spinning_friction};
  }
  const Collider& collider = model.colliders[at(place.collider)];
  return {collider.rolling_friction, collider.spinning_friction};
}

BodyMaterial ContactBodies::material(const Model& model, int a, int b) const {
  BodyMaterial material = sliding(model, a, b);
  const auto [roll_a, spin_a] = rolling(model, places_[at(a)]);
  const auto [roll_b, spin_b] = rolling(model, places_[at(b)]);
  material.rolling_friction = std::max(roll_a, roll_b);
  material.spinning_friction = std::max(spin_a, spin_b);
  return material;
}

BodyMaterial ContactBodies::sliding(const Model& model, int a, int b) const {
  const BodyPlace &one = places_[at(a)], &other = places_[at(b)];
  if (one.collider < 0 && other.collider < 0) {  // rules_ has mesh colliders too
    const PairMaterial both = rules_.material(one.object, other.object);
    return {both.static_friction, both.kinetic_friction, both.restitution};
  }
  const CompiledObject& object = model.objects[at(one.collider < 0 ? one.object : other.object)];
  const Collider& collider = model.colliders[at(std::max(one.collider, other.collider))];
  return {std::sqrt(object.static_friction * collider.static_friction),
          std::sqrt(object.kinetic_friction * collider.kinetic_friction),
          std::max(object.restitution, collider.restitution)};
}

BodyState ContactBodies::collider_at_start(const Substep& s, const BodyPlace& place) {
  // Within a frame they stay where they were at its start: other groups that run at the same time touch the mesh, too.
  if (place.mesh != nullptr && s.number == 0) move_vertices(s, place);
  if (place.mesh != nullptr && meshes_->of_object.at(place.object).is_deformed) return deformed_at_start(s, place);
  const auto [before, after] = place.mesh == nullptr
                                   ? poses_between(colliders_at_start_[at(place.collider)])
                                   : poses_of_mesh(s, place, time_of(s, s.number), s.frame_start + s.dt);
  const Posef start = convert<float>(before), end = convert<float>(after);
  const float rate = static_cast<float>(1 / time_left(s));
  BodyState state{before, convert<float>(after.position - before.position) * rate,
                  turn_between(start.rotation, end.rotation) * rate, true};
  state.surface_velocity =
      place.mesh == nullptr
          ? rotate(start.rotation, surface_velocity_of_collider(s.model, s.work.control, place.collider))
          : surface_velocity_of_mesh(s.model, s.work.control, place.object, time_of(s, s.number));
  return state;
}

/// A mesh that deforms moves as its vertices do on the mean, and each of them may depart from that.
BodyState ContactBodies::deformed_at_start(const Substep& s, const BodyPlace& place) const {
  const BodyMeshes::Entry& entry = meshes_->of_object.at(place.object);
  const double elapsed = time_of(s, s.number) - s.frame_start;
  BodyState state;
  state.pose.position = convert<double>(entry.velocity) * elapsed;
  state.velocity = entry.velocity;
  state.is_fixed = state.deforms = true;
  state.deforming = entry.deforming;
  state.surface_velocity = surface_velocity_of_mesh(s.model, s.work.control, place.object, time_of(s, s.number));
  return state;
}

void ContactBodies::begin_frame(const Substep& s) {
  move_colliders(s.model, s.work.control, time_of(s, s.number), s.frame_start + s.dt, colliders_at_start_);
}

std::pair<Posed, Posed> ContactBodies::poses_of_collider(const Substep& s, int index) const {
  const BodyPlace& place = places_[at(index)];
  return place.mesh == nullptr ? poses_between(s.own->colliders[at(place.collider)])
                               : poses_of_mesh(s, place, time_of(s, s.number), s.time_after);
}

/// Gives a body that follows keyframes the mean velocities of the rest of the frame, as colliders have them.
void ContactBodies::drive(const Substep& s, int body, BodyState& state) const {
  const BodyPlace& place = places_[at(body)];
  const CompiledObject& object = s.model.objects[at(place.object)];
  const DrivenFrame& driven = object.bodies.driven[at(driven_[at(body)])];
  const int particle = place.particle - s.model.first[at(place.object)];
  const auto after = std::upper_bound(object.kinematics.begin(), object.kinematics.end(), particle,
                                      [](int wanted, const Kinematic& one) { return wanted < one.particle; });
  const auto path = after - 1;  // of two pins the later one, and a driven body has one
  const Posed now = pose_at(driven.motion, time_of(s, s.number)), end = pose_at(driven.motion, s.frame_start + s.dt);
  const Vec3d rest = convert<double>(path->rest);
  const auto rate = static_cast<float>(1 / time_left(s));
  state.velocity = convert<float>(to_world(end, rest) - to_world(now, rest)) * rate;
  state.spin = turn_between(convert<float>(now.rotation), convert<float>(end.rotation)) * rate;
}

/// Does the same for a body for which the user has set a pose.
void ContactBodies::drive_to_target(const Substep& s, const BodyPlace& place, BodyState& state) {
  const ObjectControl* const control = s.work.control.object(place.object);
  if (control == nullptr) return;
  const TurnTarget* const turn = control->turn(place.frame - s.model.first_frame[at(place.object)]);
  const Target* const target = control->target(place.particle - s.model.first[at(place.object)]);
  if (turn == nullptr || target == nullptr) return;
  const auto rate = static_cast<float>(1 / time_left(s));
  state.velocity = convert<float>(target->to - state.pose.position) * rate;
  state.spin = turn_between(convert<float>(state.pose.rotation), convert<float>(turn->to)) * rate;
}

BodyState ContactBodies::state_at_start(const Substep& s, int index) {
  const BodyPlace& place_of = places_[at(index)];
  if (!place_of.is_body()) return collider_at_start(s, place_of);
  const Record& x = s.state.positions[at(place_of.particle)];
  const Quatf q = quaternion(s.state.frames.orientations[at(place_of.frame)]);
  const Vec3f inverse = xyz(s.state.frames.inverse_inertias[at(place_of.frame)]);
  const bool is_fixed = x.w == 0 && inverse.x == 0 && inverse.y == 0 && inverse.z == 0;
  const Vec3f spin = xyz(s.state.frames.angular_velocities[at(place_of.frame)]);
  BodyState state{
      {convert<double>(xyz(x)), convert<double>(q)},
      xyz(s.state.velocities[at(place_of.particle)]),
      rotate(q, is_fixed ? spin : without(round_[at(index)], spin)),  // a fixed disc carries what lies on it round
      is_fixed};
  if (driven_[at(index)] >= 0) drive(s, index, state);
  drive_to_target(s, place_of, state);
  const Vec3f sliding = surface_velocity_of_body(s.model, s.work.control, place_of.object, place_of.body);
  if (sliding != Vec3f{}) state.surface_velocity = rotate(q, sliding);
  return state;
}

}  // namespace pliant
