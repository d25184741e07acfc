#include "solver/bodies/body_solver.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "collision/proxies/contact_tables.h"
#include "solver/substep.h"

namespace pliant {

namespace {

/// Most rounds in which impacts are passed on from body to body in a substep.
constexpr int most_rounds_of_impacts = 32;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

Vec3f xyz(const Record& r) { return {r.x, r.y, r.z}; }
Quatf quaternion(const Record& r) { return {r.x, r.y, r.z, r.w}; }
Record plus(const Record& r, const Vec3f& v) { return {r.x + v.x, r.y + v.y, r.z + v.z, r.w}; }

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

/// Turns an orientation by a small rotation vector.
void turn(const Vec3f& theta, Record& orientation) {
  const Quatf q = quaternion(orientation), spin = multiply(Quatf{theta.x, theta.y, theta.z, 0}, q);
  const Quatf now = normalise(Quatf{q.x + 0.5f * spin.x, q.y + 0.5f * spin.y, q.z + 0.5f * spin.z, q.w + 0.5f * spin.w});
  orientation = {now.x, now.y, now.z, now.w};
}

ConvexShape shape_of_collider(const Shape& shape, std::vector<Polyhedron>& polyhedra) {
  if (const Box* box = std::get_if<Box>(&shape)) return convex_shape_of(*box, polyhedra);
  if (const Capsule* capsule = std::get_if<Capsule>(&shape)) return convex_shape_of(*capsule, polyhedra);
  if (const Sphere* sphere = std::get_if<Sphere>(&shape)) return convex_shape_of(*sphere, polyhedra);
  return {};
}

}  // namespace

BodySolver::BodySolver(const Model& model, const std::vector<int>* objects) : rules_(contact_rules(model)) {
  std::vector<BodyPart> parts, of_colliders;
  const int count = objects == nullptr ? static_cast<int>(model.objects.size()) : static_cast<int>(objects->size());
  for (int i = 0; i < count; ++i) add_object(model, objects == nullptr ? i : (*objects)[at(i)], parts);
  dynamic_ = static_cast<int>(places_.size());
  if (dynamic_ == 0) return;
  collider_shapes_.reserve(model.colliders.size());  // shapes point into it
  for (int c = static_cast<int>(model.colliders.size()); c-- > 0;) add_collider(model, c, of_colliders);
  of_colliders.insert(of_colliders.end(), parts.begin(), parts.end());  // their owners are below zero
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

bool BodySolver::meet(const Model& model, int a, int b) const {
  const Place &one = places_[at(a)], &other = places_[at(b)];
  if (one.collider >= 0 || other.collider >= 0) return true;
  if (!rules_.meet(one.object, other.object)) return false;
  if (one.object != other.object) return true;
  const std::vector<std::pair<int, int>>& jointed = model.objects[at(one.object)].bodies.jointed;
  const std::pair<int, int> both = std::minmax(one.body, other.body);
  return jointed.empty() || !std::binary_search(jointed.begin(), jointed.end(), both);
}

BodyMaterial BodySolver::material(const Model& model, int a, int b) const {
  const Place &one = places_[at(a)], &other = places_[at(b)];
  if (one.collider < 0 && other.collider < 0) {
    const PairMaterial both = rules_.material(one.object, other.object);
    return {both.static_friction, both.kinetic_friction, both.restitution};
  }
  const CompiledObject& object = model.objects[at(one.collider < 0 ? one.object : other.object)];
  const Collider& collider = model.colliders[at(std::max(one.collider, other.collider))];
  return {std::sqrt(object.static_friction * collider.static_friction),
          std::sqrt(object.kinetic_friction * collider.kinetic_friction),
          std::max(object.restitution, collider.restitution)};
}

BodyState BodySolver::state_at_start(const Substep& s, int body) const {
  const Place& place = places_[at(body)];
  if (place.collider >= 0) {
    const MovingCollider& collider = colliders_at_start_[at(place.collider)];
    const float rate = static_cast<float>(1 / s.dt);
    return {convert<double>(collider.before), (collider.after.position - collider.before.position) * rate,
            turn_between(collider.before.rotation, collider.after.rotation) * rate, true};
  }
  const Record& x = s.state.positions[at(place.particle)];
  const Quatf q = quaternion(s.state.frames.orientations[at(place.frame)]);
  const Vec3f inverse = xyz(s.state.frames.inverse_inertias[at(place.frame)]);
  const bool is_fixed = x.w == 0 && inverse.x == 0 && inverse.y == 0 && inverse.z == 0;
  return {{convert<double>(xyz(x)), convert<double>(q)},
          xyz(s.state.velocities[at(place.particle)]),
          rotate(q, xyz(s.state.frames.angular_velocities[at(place.frame)])),
          is_fixed};
}

void BodySolver::make_manifolds(const Substep& s) {
  manifolds_.clear();
  bounces_ = false;
  const std::vector<BodyPart>& parts = finder_.parts();
  const auto body_of = [&](const ContactPart& id) {
    const auto part = std::lower_bound(parts.begin(), parts.end(), id,
                                       [](const BodyPart& one, const ContactPart& wanted) { return one.id < wanted; });
    return part->body;
  };
  bodies_of_.clear();
  for (const BodyContact& contact : contacts_) bodies_of_.emplace_back(body_of(contact.a), body_of(contact.b));
  colours_.colour(bodies_of_, is_fixed_);
  for (const int i : colours_.order()) {
    const auto& [a, b] = bodies_of_[at(i)];
    manifolds_.push_back(manifold_of(contacts_[at(i)], a, b, material(s.model, a, b), s.h));
    bounces_ = bounces_ || manifolds_.back().restitution > 0;
  }
  blocks_.fill(s.context.executor, manifolds_, colours_, is_fixed_);
  blocks_.prepare(s.context.executor, s.kernels.manifolds, motions_);
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
    if (places_[at(body)].collider >= 0) continue;
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
  last_h_ = s.h;
  make_manifolds(s);
}

void BodySolver::move_with_collider(const Substep& s, int body) {
  const MovingCollider& collider = s.own->colliders[at(places_[at(body)].collider)];
  BodyMotion& motion = motions_[at(body)];
  motion.velocity = (collider.after.position - collider.before.position) * (1 / s.h);
  motion.spin = turn_between(collider.before.rotation, collider.after.rotation) * (1 / s.h);
}

void BodySolver::load_predicted(const Substep& s) {
  const float rate = 1 / s.h;
  for (int body = 0; body < static_cast<int>(places_.size()); ++body) {
    const Place& place = places_[at(body)];
    if (place.collider >= 0) {
      move_with_collider(s, body);
      continue;
    }
    BodyMotion& motion = motions_[at(body)];
    const std::size_t p = at(place.particle), f = at(place.frame);
    motion.velocity = (xyz(s.work.displacements[p]) - xyz(s.state.remainders[p])) * rate;
    motion.spin = (xyz(s.work.frames.predicted[f]) + xyz(s.work.frames.corrections[f])) * rate;
  }
}

void BodySolver::start_substep(const Substep& s) {
  Executor& executor = s.context.executor;
  const ManifoldKernels& kernels = s.kernels.manifolds;
  if (last_h_ != s.h) blocks_.scale_impulses(executor, s.h / last_h_);
  last_h_ = s.h;
  blocks_.warm_start(executor, kernels, motions_);
  const float slow = 2 * s.h * length(s.model.gravity);
  bool goes_on = bounces_;
  for (int round = 0; goes_on && round < most_rounds_of_impacts; ++round)
    goes_on = blocks_.bounce(executor, kernels, motions_, s.h, slow);
}

void BodySolver::project(Substep& s, bool is_first) {
  const Stopwatch stopwatch(s.context.executor.timings(), "solve: bodies");
  load_predicted(s);
  if (manifolds_.empty()) return;
  const std::vector<BodyMotion>& before = keep_motions();
  if (is_first) start_substep(s);
  blocks_.position_pass(s.context.executor, s.kernels.manifolds, motions_, s.h, {});
  for (int body = 0; body < dynamic_; ++body) {
    const Place& place = places_[at(body)];
    const BodyMotion& motion = motions_[at(body)];
    const std::size_t p = at(place.particle), f = at(place.frame);
    const Vec3f moved = (motion.velocity - before[at(body)].velocity) * s.h,
                turned = (motion.spin - before[at(body)].spin) * s.h;
    s.work.displacements[p] = plus(s.work.displacements[p], moved);
    s.work.frames.corrections[f] = plus(s.work.frames.corrections[f], turned);
    turn(turned, s.state.frames.orientations[f]);
  }
}

void BodySolver::load_velocities(const Substep& s, FunctionRef<Vec3f(int object)> gravity) {
  for (int body = 0; body < static_cast<int>(places_.size()); ++body) {
    const Place& place = places_[at(body)];
    BodyMotion& motion = motions_[at(body)];
    if (place.collider >= 0) {
      motion.displacement += motion.velocity * s.h;
      motion.rotation += motion.spin * s.h;
      continue;
    }
    const std::size_t p = at(place.particle), f = at(place.frame);
    const auto& [position, remainder] = starts_[at(body)];
    motion.displacement = (xyz(s.state.positions[p]) - position) + (xyz(s.state.remainders[p]) - remainder);
    motion.rotation += xyz(s.work.frames.predicted[f]) + xyz(s.work.frames.corrections[f]);
    motion.velocity = xyz(s.state.velocities[p]) + (motion.inverse_mass > 0 ? gravity(place.object) : Vec3f{});
    motion.spin = rotate(quaternion(s.state.frames.orientations[f]), xyz(s.state.frames.angular_velocities[f]));
  }
}

void BodySolver::respond(Substep& s, FunctionRef<Vec3f(int object)> gravity) {
  const Stopwatch stopwatch(s.context.executor.timings(), "respond: bodies");
  load_velocities(s, gravity);
  if (manifolds_.empty()) return;
  const std::vector<BodyMotion>& before = keep_motions();
  blocks_.velocity_pass(s.context.executor, s.kernels.manifolds, motions_, s.h);
  for (int body = 0; body < dynamic_; ++body) {
    const Place& place = places_[at(body)];
    const BodyMotion& motion = motions_[at(body)];
    const std::size_t p = at(place.particle), f = at(place.frame);
    s.state.velocities[p] = plus(s.state.velocities[p], motion.velocity - before[at(body)].velocity);
    const Quatf q = quaternion(s.state.frames.orientations[f]);
    const Vec3f spun = rotate(conjugate(q), motion.spin - before[at(body)].spin);
    s.state.frames.angular_velocities[f] = plus(s.state.frames.angular_velocities[f], spun);
  }
}

const std::vector<BodyMotion>& BodySolver::keep_motions() {
  kept_.assign(motions_.begin(), motions_.begin() + dynamic_);
  return kept_;
}

void BodySolver::end_frame(const Substep& s) {
  blocks_.take(s.context.executor, manifolds_);
  for (std::size_t i = 0; i < manifolds_.size(); ++i) keep_impulses(manifolds_[i], s.h, contacts_[at(colours_.order()[i])]);
}

int BodySolver::contacts_that_press() const { return blocks_.pressing(); }

}  // namespace pliant
