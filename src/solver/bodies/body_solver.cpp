#include "solver/bodies/body_solver.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>

#include "collision/proxies/contact_tables.h"
#include "math/motion.h"
#include "solver/bodies/body_math.h"
#include "solver/substep.h"

namespace pliant {

namespace {

using namespace bodies;

/// Most rounds in which impacts are passed on from body to body in a substep.
constexpr int most_rounds_of_impacts = 32;
/// Bodies, or contacts, in a task.
constexpr int a_task = 256;

/// Calls body(i) for each i < count on all threads.
template <class Body>
void for_each(Executor& executor, std::size_t count, const Body& body) {
  const int n = static_cast<int>(count);
  executor.parallel_for(nullptr, (n + a_task - 1) / a_task, [&](int task) {
    for (int i = task * a_task; i < std::min(n, (task + 1) * a_task); ++i) body(i);
  });
}

/// The inverse inertia in world axes of a body with the given principal values.
std::array<float, 6> world_inertia(const Quatf& q, const Vec3f& inverse) {
  const Vec3f x = rotate(q, Vec3f{1, 0, 0}), y = rotate(q, Vec3f{0, 1, 0}), z = rotate(q, Vec3f{0, 0, 1});
  const auto element = [&](float Vec3f::*r, float Vec3f::*c) {
    return inverse.x * (x.*r * x.*c) + inverse.y * (y.*r * y.*c) + inverse.z * (z.*r * z.*c);
  };
  return {element(&Vec3f::x, &Vec3f::x), element(&Vec3f::y, &Vec3f::y), element(&Vec3f::z, &Vec3f::z),
          element(&Vec3f::y, &Vec3f::z), element(&Vec3f::z, &Vec3f::x), element(&Vec3f::x, &Vec3f::y)};
}

/// The rotation vector between two close orientations.
Vec3f turn_between(const Quatf& from, const Quatf& to) {
  const Quatf turn = multiply(to, conjugate(from));
  const float sign = turn.w < 0 ? -2.f : 2.f;
  return {sign * turn.x, sign * turn.y, sign * turn.z};
}

std::pair<Posed, Posed> poses_between(const MovingCollider& collider) {
  return {convert<double>(collider.before), convert<double>(collider.after)};
}

ConvexShape shape_of_collider(const Shape& shape, std::vector<Polyhedron>& polyhedra) {
  if (const Box* box = std::get_if<Box>(&shape)) return convex_shape_of(*box, polyhedra);
  if (const Capsule* capsule = std::get_if<Capsule>(&shape)) return convex_shape_of(*capsule, polyhedra);
  if (const Sphere* sphere = std::get_if<Sphere>(&shape)) return convex_shape_of(*sphere, polyhedra);
  return {};
}

}  // namespace

BodySolver::BodySolver(const Model& model, const std::vector<int>* objects, BodyMeshes& meshes)
    : rules_(contact_rules(model)), meshes_(&meshes) {
  std::vector<BodyPart> parts, of_colliders;
  const int count = objects == nullptr ? static_cast<int>(model.objects.size()) : static_cast<int>(objects->size());
  for (int i = 0; i < count; ++i) add_object(model, objects == nullptr ? i : (*objects)[at(i)], parts);
  dynamic_ = static_cast<int>(places_.size());
  if (dynamic_ == 0) return;
  std::vector<TouchedBody> bodies;
  for (const Place& place : places_) bodies.push_back({place.object, place.body, place.particle, place.frame});
  std::vector<int> all(model.objects.size());
  std::iota(all.begin(), all.end(), 0);
  points_ = BodyPoints(model, objects == nullptr ? all : *objects, bodies, rules_);
  collider_shapes_.reserve(model.colliders.size());  // shapes point into it
  for (int c = static_cast<int>(model.colliders.size()); c-- > 0;) add_collider(model, c, of_colliders);
  for (int o = 0; o < static_cast<int>(model.objects.size()); ++o)
    if (model.objects[at(o)].is_collider && model.objects[at(o)].particles > 0) add_mesh(model, o, meshes, of_colliders);
  of_colliders.insert(of_colliders.end(), parts.begin(), parts.end());
  for (const BodyPart& part : of_colliders) body_of_part_.emplace_back(part.id, part.body);
  std::sort(body_of_part_.begin(), body_of_part_.end());
  first_part_.assign(model.objects.size(), 0);
  for (std::size_t i = body_of_part_.size(); i-- > 0;)
    if (const int owner = body_of_part_[i].first.owner; owner >= 0) first_part_[at(owner)] = i;
  finder_ = BodyContacts(std::move(of_colliders));
}

void BodySolver::add_object(const Model& model, int object, std::vector<BodyPart>& parts) {
  const CompiledObject& from = model.objects[at(object)];
  const int first = static_cast<int>(places_.size());
  for (std::size_t b = 0; b < from.bodies.bodies.size(); ++b) {
    const auto& [particle, frame] = from.bodies.bodies[b];
    places_.push_back(
        {object, static_cast<int>(b), model.first[at(object)] + particle, model.first_frame[at(object)] + frame});
  }
  for (int i = 0; i < static_cast<int>(from.bodies.solids.size()); ++i) {
    const CompiledSolid& solid = from.bodies.solids[at(i)];
    parts.push_back({{object, i, 0}, first + solid.body, solid.shape, false, solid.pose});
  }
}

void BodySolver::add_collider(const Model& model, int collider, std::vector<BodyPart>& parts) {
  const Shape& shape = model.colliders[at(collider)].shape;
  parts.push_back({{-1 - collider, 0, 0},
                   static_cast<int>(places_.size()),
                   shape_of_collider(shape, collider_shapes_),
                   std::holds_alternative<Plane>(shape),
                   {}});
  Place place;
  place.collider = collider;
  places_.push_back(place);
}

void BodySolver::add_mesh(const Model& model, int object, BodyMeshes& meshes, std::vector<BodyPart>& parts) {
  const CompiledObject& from = model.objects[at(object)];
  const auto field = std::find_if(model.fields.begin(), model.fields.end(),
                                  [&](const FieldCollider& one) { return one.object == object; });
  const bool is_terrain = field != model.fields.end() && field->field->is_ground();
  BodyMeshes::Entry& entry = meshes.of_object[object];
  if (entry.mesh == nullptr || entry.generation != model.generation[at(object)])
    entry = {model.generation[at(object)], false,
             std::make_unique<BodyMesh>(from.carrier.rest, from.surface.triangles,
                                        is_terrain ? BodyMesh::Kind::terrain : BodyMesh::Kind::surface, from.thickness)};
  Place place;
  place.object = object;
  place.mesh = entry.mesh.get();
  parts.push_back({{object, 0, 0}, static_cast<int>(places_.size()), {}, false, {}, place.mesh});
  places_.push_back(place);
}

bool BodySolver::meet(const Model& model, int a, int b) const {
  const Place &one = places_[at(a)], &other = places_[at(b)];
  if (one.collider >= 0 || other.collider >= 0) return true;
  if (!one.is_body() || !other.is_body())
    return meets_mesh(model, one.is_body() ? one : other, one.is_body() ? other : one);
  if (!rules_.meet(one.object, other.object)) return false;
  if (one.object != other.object) return true;
  const std::vector<std::pair<int, int>>& jointed = model.objects[at(one.object)].bodies.jointed;
  const std::pair<int, int> both = std::minmax(one.body, other.body);
  return jointed.empty() || !std::binary_search(jointed.begin(), jointed.end(), both);
}

bool BodySolver::meets_mesh(const Model& model, const Place& body, const Place& mesh) const {
  const CompiledObject &object = model.objects[at(body.object)], &collider = model.objects[at(mesh.object)];
  const auto field = std::find_if(model.fields.begin(), model.fields.end(),
                                  [&](const FieldCollider& one) { return one.object == mesh.object; });
  const bool has_field = field != model.fields.end();
  const std::uint32_t groups = has_field ? field->groups : collider.groups, mask = has_field ? field->mask : collider.mask;
  return (object.groups & mask) != 0 && (groups & object.mask) != 0;
}

/// True if a vertex of a mesh is not where the mesh's pose puts it, so that the user or frames have moved it.
bool BodySolver::is_deformed(const Substep& s, const Place& place) const {
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

void BodySolver::move_vertices(const Substep& s, const Place& place) {
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
}

std::pair<Posed, Posed> BodySolver::rigid_poses(const Substep& s, const Place& place, double before, double after) const {
  const PoseDrive* drive = s.work.control.mesh(place.object);
  const Motion& motion = s.model.objects[at(place.object)].carrier.motion;
  if (drive != nullptr) return {drive->at(before), drive->at(after)};
  return {pose_at(motion, before), pose_at(motion, after)};
}

std::pair<Posed, Posed> BodySolver::poses_of_mesh(const Substep& s, const Place& place, double before, double after) const {
  if (meshes_->of_object.at(place.object).is_deformed) return {};
  return rigid_poses(s, place, before, after);
}

BodyMaterial BodySolver::material(const Model& model, int a, int b) const {
  const Place &one = places_[at(a)], &other = places_[at(b)];
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

BodyState BodySolver::collider_at_start(const Substep& s, const Place& place) {
  if (place.mesh != nullptr) move_vertices(s, place);
  const auto [before, after] = place.mesh == nullptr ? poses_between(colliders_at_start_[at(place.collider)])
                                                     : poses_of_mesh(s, place, s.frame_start, s.frame_start + s.dt);
  const Posef start = convert<float>(before), end = convert<float>(after);
  const float rate = static_cast<float>(1 / s.dt);
  return {before, convert<float>(after.position - before.position) * rate,
          turn_between(start.rotation, end.rotation) * rate, true,
          place.mesh != nullptr && meshes_->of_object.at(place.object).is_deformed};
}

BodyState BodySolver::state_at_start(const Substep& s, int body) {
  const Place& place = places_[at(body)];
  if (!place.is_body()) return collider_at_start(s, place);
  const Record& x = s.state.positions[at(place.particle)];
  const Quatf q = quaternion(s.state.frames.orientations[at(place.frame)]);
  const Vec3f inverse = xyz(s.state.frames.inverse_inertias[at(place.frame)]);
  const bool is_fixed = x.w == 0 && inverse.x == 0 && inverse.y == 0 && inverse.z == 0;
  return {{convert<double>(xyz(x)), convert<double>(q)},
          xyz(s.state.velocities[at(place.particle)]),
          rotate(q, xyz(s.state.frames.angular_velocities[at(place.frame)])),
          is_fixed};
}

/// Solids of an object are numbered without gaps, so the place of a part is known; those of colliders are searched for.
int BodySolver::body_of(const ContactPart& part) const {
  const ContactPart solid{part.owner, part.solid, 0};
  if (part.owner >= 0) {
    const std::size_t place = first_part_[at(part.owner)] + at(part.solid);
    if (place < body_of_part_.size() && body_of_part_[place].first == solid) return body_of_part_[place].second;
  }
  return std::lower_bound(body_of_part_.begin(), body_of_part_.end(), std::pair{solid, 0})->second;
}

void BodySolver::make_manifolds(const Substep& s) {
  Executor& executor = s.context.executor;
  const Stopwatch stopwatch(executor.timings(), "bodies: manifolds");
  bodies_of_.resize(contacts_.size());
  for_each(executor, contacts_.size(), [&](int i) {
    bodies_of_[at(i)] = {body_of(contacts_[at(i)].a), body_of(contacts_[at(i)].b)};
  });
  colours_.colour(bodies_of_, is_fixed_);
  blocks_.fill(executor, colours_, is_fixed_, [&](int i) {
    const auto& [a, b] = bodies_of_[at(i)];
    return manifold_of(contacts_[at(i)], a, b, material(s.model, a, b), s.h);
  });
  blocks_.prepare(executor, s.kernels.manifolds, motions_);
}

void BodySolver::begin_frame(Substep& s) {
  move_colliders(s.model, s.work.control, s.frame_start, s.frame_start + s.dt, colliders_at_start_);
  states_.clear();
  starts_.clear();
  is_fixed_.clear();
  motions_.assign(places_.size(), {});
  const float gravity = static_cast<float>(s.dt) * length(s.model.gravity);
  for (int body = 0; body < static_cast<int>(places_.size()); ++body) {
    states_.push_back(state_at_start(s, body));
    is_fixed_.push_back(states_.back().is_fixed ? 1 : 0);
    if (!places_[at(body)].is_body()) continue;
    BodyMotion& motion = motions_[at(body)];
    const std::size_t particle = at(places_[at(body)].particle);
    starts_.push_back({xyz(s.state.positions[particle]), xyz(s.state.remainders[particle])});
    motion.inverse_mass = s.state.positions[particle].w;
    const std::size_t frame = at(places_[at(body)].frame);
    motion.inverse_inertia =
        world_inertia(quaternion(s.state.frames.orientations[frame]), xyz(s.state.frames.inverse_inertias[frame]));
  }
  finder_.update(
      s.context.executor, states_, static_cast<float>(s.dt), gravity, [&](int a, int b) { return meet(s.model, a, b); },
      s.state.body_contacts, contacts_);
  if (finder_.left_out() > 0)
    s.report.warnings.push_back(std::to_string(finder_.left_out()) +
                                " pairs of bodies that overlap are left to later frames, because each body has " +
                                std::to_string(BodyContacts::most_of_crowded) + " others in its place");
  last_h_ = s.h;
  make_manifolds(s);
  points_.keep_poses(s);
}

void BodySolver::move_with_collider(const Substep& s, int body) {
  const Place& place = places_[at(body)];
  const auto [before, after] = place.mesh == nullptr ? poses_between(s.own->colliders[at(place.collider)])
                                                     : poses_of_mesh(s, place, time_of(s, s.number), s.time_after);
  BodyMotion& motion = motions_[at(body)];
  motion.velocity = convert<float>(after.position - before.position) * (1 / s.h);
  motion.spin = turn_between(convert<float>(before).rotation, convert<float>(after).rotation) * (1 / s.h);
}

void BodySolver::load_predicted(const Substep& s, int body) {
  const Place& place = places_[at(body)];
  if (!place.is_body()) return move_with_collider(s, body);
  const float rate = 1 / s.h;
  BodyMotion& motion = motions_[at(body)];
  const std::size_t p = at(place.particle), f = at(place.frame);
  motion.velocity = (xyz(s.work.displacements[p]) - xyz(s.state.remainders[p])) * rate;
  motion.spin = (xyz(s.work.frames.predicted[f]) + xyz(s.work.frames.corrections[f])) * rate;
  // Of the substep, not of the frame: a body that spins fast would lose angular momentum.
  motion.inverse_inertia =
      world_inertia(quaternion(s.state.frames.orientations[f]), xyz(s.state.frames.inverse_inertias[f]));
}

/// Adds what contact has changed to the predicted motion of a body.
void BodySolver::store_predicted(const Substep& s, int body) {
  const Place& place = places_[at(body)];
  const BodyMotion& motion = motions_[at(body)];
  const KeptMotion& before = kept_[at(body)];
  const std::size_t p = at(place.particle), f = at(place.frame);
  const Vec3f moved = (motion.velocity - before.velocity) * s.h, turned = (motion.spin - before.spin) * s.h;
  s.work.displacements[p] = plus(s.work.displacements[p], moved);
  s.work.frames.corrections[f] = plus(s.work.frames.corrections[f], turned);
  turn(turned, s.state.frames.orientations[f]);
}

void BodySolver::start_substep(const Substep& s) {
  Executor& executor = s.context.executor;
  const ManifoldKernels& kernels = s.kernels.manifolds;
  if (last_h_ != s.h) blocks_.scale_impulses(executor, s.h / last_h_);
  last_h_ = s.h;
  blocks_.warm_start(executor, kernels, motions_);
  const float slow = 2 * s.h * length(s.model.gravity);
  bool goes_on = blocks_.bounces();
  for (int round = 0; goes_on && round < most_rounds_of_impacts; ++round)
    goes_on = blocks_.bounce(executor, kernels, motions_, s.h, slow);
}

void BodySolver::collide(Substep& s) {
  if (points_.has_any()) points_.detect(s);
}

void BodySolver::project(Substep& s, bool is_first) {
  Executor& executor = s.context.executor;
  const Stopwatch stopwatch(executor.timings(), "solve: bodies");
  for_each(executor, places_.size(), [&](int body) { load_predicted(s, body); });
  if (!contacts_.empty()) {
    keep_motions();
    if (is_first) start_substep(s);
    blocks_.position_pass(executor, s.kernels.manifolds, motions_, s.h, {});
    for_each(executor, kept_.size(), [&](int body) { store_predicted(s, body); });
  }
  points_.project(s, motions_);
}

void BodySolver::load_velocities(const Substep& s, FunctionRef<Vec3f(int object)> gravity, int body) {
  const Place& place = places_[at(body)];
  BodyMotion& motion = motions_[at(body)];
  if (!place.is_body()) {
    motion.displacement += motion.velocity * s.h;
    motion.rotation += motion.spin * s.h;
    return;
  }
  const std::size_t p = at(place.particle), f = at(place.frame);
  const auto& [position, remainder] = starts_[at(body)];
  motion.displacement = (xyz(s.state.positions[p]) - position) + (xyz(s.state.remainders[p]) - remainder);
  motion.rotation += xyz(s.work.frames.predicted[f]) + xyz(s.work.frames.corrections[f]);
  motion.velocity = xyz(s.state.velocities[p]) + (motion.inverse_mass > 0 ? gravity(place.object) : Vec3f{});
  motion.spin = rotate(quaternion(s.state.frames.orientations[f]), xyz(s.state.frames.angular_velocities[f]));
}

/// Adds what contact has changed to the velocities of a body.
void BodySolver::store_velocities(const Substep& s, int body) {
  const Place& place = places_[at(body)];
  const BodyMotion& motion = motions_[at(body)];
  const KeptMotion& before = kept_[at(body)];
  const std::size_t p = at(place.particle), f = at(place.frame);
  s.state.velocities[p] = plus(s.state.velocities[p], motion.velocity - before.velocity);
  const Quatf q = quaternion(s.state.frames.orientations[f]);
  const Vec3f spun = rotate(conjugate(q), motion.spin - before.spin);
  s.state.frames.angular_velocities[f] = plus(s.state.frames.angular_velocities[f], spun);
}

void BodySolver::respond(Substep& s, FunctionRef<Vec3f(int object)> gravity) {
  Executor& executor = s.context.executor;
  const Stopwatch stopwatch(executor.timings(), "respond: bodies");
  for_each(executor, places_.size(), [&](int body) { load_velocities(s, gravity, body); });
  if (!contacts_.empty()) {
    keep_motions();
    blocks_.velocity_pass(executor, s.kernels.manifolds, motions_, s.h);
    for_each(executor, kept_.size(), [&](int body) { store_velocities(s, body); });
  }
  points_.respond(s, motions_, gravity);
  points_.keep_poses(s);
}

void BodySolver::keep_motions() {
  kept_.resize(at(dynamic_));
  for (std::size_t body = 0; body < kept_.size(); ++body) kept_[body] = {motions_[body].velocity, motions_[body].spin};
}

void BodySolver::end_frame(const Substep& s) {
  blocks_.take(s.context.executor, colours_, [&](int i, const Manifold& m) { keep_impulses(m, s.h, contacts_[at(i)]); });
}

void BodySolver::log_contacts(const Substep& s, ContactLog& log) {
  end_frame(s);
  for (const int i : colours_.order()) {
    const BodyContact& c = contacts_[at(i)];
    const double impulse = static_cast<double>((c.impulse[0] + c.impulse[1]) + (c.impulse[2] + c.impulse[3]));
    if (!(impulse > 0)) continue;
    const std::size_t b = at(bodies_of_[at(i)].second);
    const Vec3d place = states_[b].pose.position + convert<double>(motions_[b].displacement + c.arm_b);
    add_push({c.a.owner, c.b.owner, impulse, -c.normal, place}, log);
  }
  points_.log_contacts(s, log);
  finish_substep(log);
}

int BodySolver::contacts_that_press() const { return points_.contacts_that_press() + blocks_.pressing(); }

}  // namespace pliant
