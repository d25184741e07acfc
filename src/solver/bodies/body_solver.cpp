#include "solver/bodies/body_solver.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>

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

}  // namespace

BodySolver::BodySolver(const Model& model, const std::vector<int>* objects, BodyMeshes& meshes)
    : bodies_(model, objects, meshes), finder_(bodies_.take_parts()) {
  if (!has_bodies()) return;
  std::vector<TouchedBody> touched;
  for (int i = 0; i < bodies_.dynamic(); ++i) {
    const BodyPlace& place = bodies_.places()[at(i)];
    touched.push_back({place.object, place.body, place.particle, place.frame});
  }
  std::vector<int> all(model.objects.size());
  std::iota(all.begin(), all.end(), 0);
  points_ = BodyPoints(model, objects == nullptr ? all : *objects, touched, bodies_.rules());
}

void BodySolver::make_manifolds(const Substep& s) {
  Executor& executor = s.context.executor;
  const Stopwatch stopwatch(executor.timings(), "bodies: manifolds");
  bodies_of_.resize(contacts_.size());
  for_each(executor, contacts_.size(), [&](int i) {
    bodies_of_[at(i)] = {bodies_.place_of(contacts_[at(i)].a), bodies_.place_of(contacts_[at(i)].b)};
  });
  colours_.colour(bodies_of_, is_fixed_);
  blocks_.fill(executor, colours_, is_fixed_, [&](int i) {
    const auto& [a, b] = bodies_of_[at(i)];
    return manifold_of(contacts_[at(i)], a, b, bodies_.material(s.model, a, b), s.h);
  });
  blocks_.prepare(executor, s.kernels.manifolds, motions_);
}

void BodySolver::begin_frame(Substep& s) {
  bodies_.begin_frame(s);
  states_.clear();
  starts_.clear();
  is_fixed_.clear();
  motions_.assign(bodies_.places().size(), {});
  const float gravity = static_cast<float>(s.dt) * length(s.model.gravity);
  for (int body = 0; body < static_cast<int>(bodies_.places().size()); ++body) {
    states_.push_back(bodies_.state_at_start(s, body));
    is_fixed_.push_back(states_.back().is_fixed ? 1 : 0);
    if (!bodies_.places()[at(body)].is_body()) continue;
    BodyMotion& motion = motions_[at(body)];
    const std::size_t particle = at(bodies_.places()[at(body)].particle);
    starts_.push_back({xyz(s.state.positions[particle]), xyz(s.state.remainders[particle])});
    motion.inverse_mass = s.state.positions[particle].w;
    const std::size_t frame = at(bodies_.places()[at(body)].frame);
    motion.inverse_inertia =
        world_inertia(quaternion(s.state.frames.orientations[frame]), xyz(s.state.frames.inverse_inertias[frame]));
  }
  finder_.update(
      s.context.executor, states_, static_cast<float>(s.dt), gravity,
      [&](int a, int b) { return bodies_.meet(s.model, a, b); }, s.state.body_contacts, contacts_);
  if (finder_.left_out() > 0)
    s.report.warnings.push_back(std::to_string(finder_.left_out()) +
                                " pairs of bodies that overlap are left to later frames, because each body has " +
                                std::to_string(BodyContacts::most_of_crowded) + " others in its place");
  last_h_ = s.h;
  make_manifolds(s);
  points_.keep_poses(s);
}

void BodySolver::move_with_collider(const Substep& s, int body) {
  const auto [before, after] = bodies_.poses_of_collider(s, body);
  BodyMotion& motion = motions_[at(body)];
  motion.velocity = convert<float>(after.position - before.position) * (1 / s.h);
  motion.spin = turn_between(convert<float>(before).rotation, convert<float>(after).rotation) * (1 / s.h);
}

void BodySolver::load_predicted(const Substep& s, int body) {
  const BodyPlace& place = bodies_.places()[at(body)];
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
  const BodyPlace& place = bodies_.places()[at(body)];
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
  for_each(executor, bodies_.places().size(), [&](int body) { load_predicted(s, body); });
  if (!contacts_.empty()) {
    keep_motions();
    if (is_first) start_substep(s);
    blocks_.position_pass(executor, s.kernels.manifolds, motions_, s.h, {});
    for_each(executor, kept_.size(), [&](int body) { store_predicted(s, body); });
  }
  points_.project(s, motions_);
}

void BodySolver::load_velocities(const Substep& s, FunctionRef<Vec3f(int object)> gravity, int body) {
  const BodyPlace& place = bodies_.places()[at(body)];
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
  const BodyPlace& place = bodies_.places()[at(body)];
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
  for_each(executor, bodies_.places().size(), [&](int body) { load_velocities(s, gravity, body); });
  if (!contacts_.empty()) {
    keep_motions();
    blocks_.velocity_pass(executor, s.kernels.manifolds, motions_, s.h);
    for_each(executor, kept_.size(), [&](int body) { store_velocities(s, body); });
  }
  points_.respond(s, motions_, gravity);
  points_.keep_poses(s);
}

void BodySolver::keep_motions() {
  kept_.resize(at(bodies_.dynamic()));
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
