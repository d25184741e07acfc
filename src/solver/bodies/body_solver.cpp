#include "solver/bodies/body_solver.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

#include "math/motion.h"
#include "solver/bodies/body_math.h"
#include "solver/bodies/depenetration.h"
#include "solver/bodies/joint_forest.h"
#include "solver/substep.h"
#include "solver/sweeps/sweep.h"

namespace pliant {

namespace {

/// Most rounds in which impacts are passed on from body to body in a substep.
constexpr int most_rounds_of_body_impacts = 32;
/// Where the contacts of the last substep turn a jointed body by more than this in a substep [rad], as where a long
/// chain hits a peg, joints take up only what the position pass leaves of them: the solve of joints is linear. The same
/// as |f| h^2 |r| over the inertia, for which joints have this limit, too (joint_forest_solve.cpp).
constexpr float largest_turn_by_contact = 0.25f;

/// Reads the part of a contact that manifold_of needs into the cache.
void fetch(const BodyContact& contact) {
  const char* const first = reinterpret_cast<const char*>(&contact.count);
  for (std::size_t byte = 0; byte < sizeof(BodyContact) - offsetof(BodyContact, count); byte += 64)
    __builtin_prefetch(first + byte);
}

/// The speed above which a contact slides that begins where bodies are at rest against each other (Manifold::settles),
/// else 0. `fall` is what gravity adds to velocities in a substep [m/s].
float settling_speed(const BodyContact& contact, const Manifold& m, const BodyState& a, const BodyState& b,
                     float fall) {
  constexpr float at_rest = 2, sliding = 0.01f;                                      // times `fall`
  if (contact.substep > 0 || !(m.friction > 0) || slides(a) || slides(b)) return 0;  // a belt sets in motion
  const Vec3f motion = (b.velocity + cross(b.spin, m.arm_b)) - (a.velocity + cross(a.spin, m.arm_a));
  return length_squared(motion) <= (at_rest * fall) * (at_rest * fall) ? sliding * fall : 0;
}

/// The velocity of b against a along the tangents at which their surfaces do not slide over one another.
std::array<float, 2> drift_of(const BodyState& a, const BodyState& b, const Manifold& m) {
  if (!slides(a) && !slides(b)) return {};
  const Vec3f drift = a.surface_velocity - b.surface_velocity;
  return {dot(drift, m.tangent1), dot(drift, m.tangent2)};
}

}  // namespace

BodySolver::BodySolver(const Model& model, const std::vector<int>* objects, BodyMeshes& meshes)
    : bodies_(model, objects, meshes), contacts_(bodies_), motions_(bodies_) {
  if (!has_any()) return;
  std::vector<TouchedBody> touched;
  for (int i = 0; i < bodies_.dynamic(); ++i) {
    const BodyPlace& place = bodies_.places()[at(i)];
    touched.push_back({place.object, place.body, place.particle, place.frame});
  }
  std::vector<int> all(model.objects.size());
  std::iota(all.begin(), all.end(), 0);
  points_ = BodyPoints(model, objects == nullptr ? all : *objects, touched, bodies_.rules());
  islands_ = BodyIslands(model, bodies_);
  sleep_ = BodySleep(model, bodies_, islands_);
  find_tied(model);
  const auto has_particles = [&](int o) {
    const CompiledObject& object = model.objects[at(o)];
    return !object.is_collider && object.particles > static_cast<int>(object.bodies.bodies.size());
  };
  const std::vector<int>& own = objects == nullptr ? all : *objects;
  if (std::any_of(own.begin(), own.end(), has_particles)) pressed_by_ = PressedBy::anything;
}

void BodySolver::find_tied(const Model& model) {
  for (int i = 0; i < bodies_.dynamic(); ++i) {
    const BodyPlace& place = bodies_.places()[at(i)];
    const CompiledObject& object = model.objects[at(place.object)];
    const auto& attached = object.bodies.attached;
    const auto is_of_body = [&](const std::pair<int, int>& tie) { return tie.second == place.body; };
    if (!solves_chains(object.sweep) || std::none_of(attached.begin(), attached.end(), is_of_body)) continue;
    is_tied_.resize(at(bodies_.dynamic()), 0);
    is_tied_[at(i)] = 1;
  }
}

/// Gives each contact with a mesh that deforms a motion of its own, which is that of the mesh where it touches.
void BodySolver::follow_meshes(const Substep& s) {
  const std::vector<BodyState>& states = contacts_.states();
  followed_.clear();
  is_fixed_.assign(contacts_.is_fixed().begin(), contacts_.is_fixed().end());
  if (std::none_of(states.begin() + bodies_.dynamic(), states.end(),
                   [](const BodyState& state) { return state.deforms; }))
    return;
  const auto elapsed = static_cast<float>(time_of(s, s.number) - s.frame_start);
  followed_.assign(contacts_.all().size(), -1);
  for (std::size_t i = 0; i < followed_.size(); ++i) {
    const int mesh = contacts_.bodies()[i].first;
    const BodyState& state = states[at(mesh)];
    if (!state.deforms) continue;
    const SurfaceMotion motion = bodies_.motion_of_surface(s.model, mesh, contacts_.all()[i]);
    if (motion.velocity == Vec3f{} && motion.spin == Vec3f{}) continue;
    followed_[i] = motions_.add_fixed(motion.velocity, motion.spin, (motion.velocity - state.velocity) * elapsed,
                                      motion.spin * elapsed);
  }
  is_fixed_.resize(motions_.all().size(), 1);
}

void BodySolver::make_manifolds(const Substep& s) {
  Executor& executor = s.context.executor;
  const Stopwatch stopwatch(executor.timings(), "bodies: manifolds");
  const std::vector<std::pair<int, int>>& bodies_of = contacts_.bodies();
  colours_.colour(bodies_of, contacts_.is_fixed());
  follow_meshes(s);
  const double left = time_left(s);
  const float fall = s.h * length(s.model.gravity);
  is_separating_.resize(bodies_of.size());
  may_bounce_.resize(bodies_of.size());
  carriers_.begin_frame(bodies_of.size());
  contacts_.count_overlaps(overlaps_);
  const auto prefetch = [&](int i) { fetch(contacts_.all()[at(i)]); };
  blocks_.fill(executor, colours_, is_fixed_, prefetch, [&](int i) {
    const auto& [a, b] = bodies_of[at(i)];
    Manifold m = manifold_of(contacts_.all()[at(i)], a, b, bodies_.material(s.model, a, b), s.h);
    const bool separates = limit_depths(motions_.all()[at(a)], motions_.all()[at(b)], contacts_.size(i),
                                        std::max(overlaps_[at(a)], overlaps_[at(b)]), pressed_by_, s.h, m);
    is_separating_[at(i)] = separates ? 1 : 0;
    may_bounce_[at(i)] = m.restitution > 0 ? 1 : 0;
    m.settles = settling_speed(contacts_.all()[at(i)], m, contacts_.states()[at(a)], contacts_.states()[at(b)], fall);
    turn_arm(contacts_.states()[at(a)], contacts_.states()[at(b)], m.normal, left, m.arm_a);
    turn_arm(contacts_.states()[at(b)], contacts_.states()[at(a)], -m.normal, left, m.arm_b);
    m.drift = drift_of(contacts_.states()[at(a)], contacts_.states()[at(b)], m);
    carriers_.note(i, contacts_.states()[at(a)], contacts_.states()[at(b)], m, left);
    if (!followed_.empty() && followed_[at(i)] >= 0) m.a = followed_[at(i)], m.arm_a = {};
    return m;
  });
  carriers_.list(colours_, bodies_of, contacts_.all());
  blocks_.prepare(executor, s.kernels.manifolds, motions_.all());
  find_bouncing(s);
}

/// Finds the bodies of contacts with restitution that no joint or tie holds.
void BodySolver::find_bouncing(const Substep& s) {
  may_restart_.assign(at(bodies_.dynamic()), 0);
  for (std::size_t i = 0; i < may_bounce_.size(); ++i) {
    const auto& [a, b] = contacts_.bodies()[i];
    for (const int body : {a, b})
      if (may_bounce_[i] != 0 && body < bodies_.dynamic()) may_restart_[at(body)] = 1;
  }
  for (const BodyLink& link : islands_.links()) {
    const std::vector<int>& broken = s.work.joints[at(link.object)].broken;
    if (link.joint >= 0 && std::binary_search(broken.begin(), broken.end(), link.joint)) continue;
    for (const int body : {link.a, link.b})
      if (body < bodies_.dynamic()) may_restart_[at(body)] = 0;
  }
}

void BodySolver::begin_frame(Substep& s) {
  bodies_.begin_frame(s);
  sleep_.begin_frame(s, s.state.body_contacts);
  contacts_.find(s, sleep_);
  motions_.begin_frame(s);
  pushes_are_known_ = false;
  last_h_ = s.h;
  last_substep_ = -1;
  make_manifolds(s);
  contacts_.warn_of_overlaps(s, is_separating_);
  points_.begin_frame(s);
  shares_.clear();
}

void BodySolver::control(Substep& s) {
  if (s.number == 0) return;
  const BodyContacts::Again outdated = contacts_.outdated(motions_, blocks_.bounces());
  if (outdated == BodyContacts::Again::none) return;
  take_impulses(s);
  contacts_.renew(s, motions_, blocks_.bounces(), outdated);
  motions_.begin_frame(s);
  pushes_are_known_ = false;
  make_manifolds(s);
}

/// Gathers the prediction at the start of a substep, which begins with the impulses of the last one. What these do is
/// known from it, but in the first one of a frame.
void BodySolver::start_substep(const Substep& s) {
  Executor& executor = s.context.executor;
  const ManifoldKernels& kernels = s.kernels.manifolds;
  if (last_substep_ != s.number) {
    push_share_ = s.h / last_h_;
    if (last_h_ != s.h) blocks_.scale_impulses(executor, push_share_);
    last_h_ = s.h;
    last_substep_ = s.number;
  }
  motions_.load_predicted(s, bodies_, true, pushes_are_known_ ? push_share_ : 0);
  carriers_.move_contacts(motions_.all(), s.h, blocks_);
  if (!pushes_are_known_) blocks_.warm_start(executor, kernels, motions_.all());
  pushes_are_known_ = true;
  bounced_.clear();
  if (!blocks_.bounces()) return;
  blocks_.clear_bounced();
  const Vec3f fall = s.model.gravity * s.h;
  motions_.bounce(s, may_restart_, [&] {
    bool goes_on = true;
    for (int round = 0; goes_on && round < most_rounds_of_body_impacts; ++round)
      goes_on = blocks_.bounce(executor, kernels, motions_.all(), s.h, fall);
  });
  note_bounces(s);
}

void BodySolver::note_bounces(const Substep& s) {
  if (s.work.contact_log == nullptr) return;
  bounced_.assign(contacts_.all().size(), 0);
  blocks_.for_bounced(colours_, [&](int i, float impulse) { bounced_[at(i)] = impulse; });
}

void BodySolver::collide(Substep& s) {
  if (!points_.has_any()) return;
  motions_.begin_substep(s);
  points_.detect(s);
  points_.find_loads(s, motions_.present(), true);
}

/// Finds the bodies with joints that are solved directly, and tied ones. Returns false if there are none.
bool BodySolver::find_jointed(const Substep& s) {
  bool any = !is_tied_.empty();
  is_jointed_ = is_tied_;
  is_jointed_.resize(at(bodies_.dynamic()), 0);
  for (const BodyLink& link : islands_.links()) {
    const auto& joints = s.work.joints[at(link.object)];
    if (link.joint < 0 || joints.forests.empty()) continue;
    if (std::binary_search(joints.broken.begin(), joints.broken.end(), link.joint)) continue;
    for (const int body : {link.a, link.b})
      if (body < bodies_.dynamic()) is_jointed_[at(body)] = any = true;
  }
  return any;
}

/// Of the islands of jointed and touching bodies, those that have joints, and in which contacts turn no jointed body
/// far.
void BodySolver::find_pressed(const Substep& s) {
  const auto is_free = [&](int place) { return place < bodies_.dynamic() && contacts_.is_fixed()[at(place)] == 0; };
  const auto join = [&](int a, int b) {
    if (is_free(a) && is_free(b)) jointed_islands_.unite(a, b);
  };
  jointed_islands_.reset(bodies_.dynamic());
  for (const auto& [a, b] : contacts_.bodies()) join(a, b);
  for (const BodyLink& link : islands_.links())
    if (link.joint >= 0) join(link.a, link.b);
  std::vector<char> has_joints(is_jointed_.size(), 0), turns_far(is_jointed_.size(), 0);
  for (int i = 0; i < bodies_.dynamic(); ++i) {
    if (is_jointed_[at(i)] == 0 || !is_free(i)) continue;
    const std::size_t island = at(jointed_islands_.find(i));
    has_joints[island] = 1;
    if (motions_.spin_change(i) * s.h > largest_turn_by_contact) turns_far[island] = 1;
  }
  pressed_bodies_.assign(is_jointed_.size(), 0);
  for (int i = 0; i < bodies_.dynamic(); ++i) {
    const std::size_t island = at(jointed_islands_.find(i));
    if (has_joints[island] == 0 || turns_far[island] != 0) continue;
    pressed_bodies_[at(i)] = 1;
    pressed_objects_[at(bodies_.places()[at(i)].object)] = 1;
    is_pressed_ = true;
  }
}

const std::vector<char>& BodySolver::press_joints(Substep& s) {
  pressed_objects_.clear();
  if (contacts_.all().empty() || !find_jointed(s)) return pressed_objects_;
  const Stopwatch stopwatch(s.context.executor.timings(), "solve: bodies");
  const BodyMotions::Pushes before = motions_.pushes();
  const bool are_known = pushes_are_known_;
  start_substep(s);
  pressed_objects_.assign(s.model.objects.size(), 0);
  find_pressed(s);
  motions_.store_predicted(s, pressed_bodies_, before);
  pushes_are_known_ = are_known;
  if (!is_pressed_) pressed_objects_.clear();
  return pressed_objects_;
}

/// True if press_joints has started one of the contact's bodies. The other one is then started, too, or does not move.
bool BodySolver::is_pressed(int contact) const {
  const auto is_started = [&](int place) { return place < bodies_.dynamic() && pressed_bodies_[at(place)] != 0; };
  const auto& [a, b] = contacts_.bodies()[at(contact)];
  return is_started(a) || is_started(b);
}

/// The rest of a substep's start after press_joints: what has moved stays, and the other bodies start as if they were
/// alone.
void BodySolver::start_others(const Substep& s) {
  const BodyMotions::Pushes pressed = motions_.pushes();
  const std::vector<float> bounced = bounced_;
  start_substep(s);
  motions_.reload_predicted(s, pressed_bodies_, pressed);
  for (int i = 0; i < static_cast<int>(bounced.size()); ++i)
    if (is_pressed(i)) bounced_[at(i)] = bounced[at(i)];
}

void BodySolver::project(Substep& s, bool is_first) {
  project_contacts(s, is_first);
  close_joint_trees(s);
}

void BodySolver::project_contacts(Substep& s, bool is_first) {
  if (contacts_.all().empty() && !points_.has_any()) return;
  Executor& executor = s.context.executor;
  const Stopwatch stopwatch(executor.timings(), "solve: bodies");
  if (is_first && std::exchange(is_pressed_, false)) {
    start_others(s);
  } else if (is_first) {
    start_substep(s);
  } else {
    motions_.load_predicted(s, bodies_, false, 0);
  }
  if (!contacts_.all().empty()) {
    blocks_.position_pass(executor, s.kernels.manifolds, motions_.all(), s.h, {});
    motions_.store_predicted(s);
  }
  points_.project(s, motions_.present());
}

void BodySolver::end_filter(Substep& s) {
  if (!points_.has_any()) return;
  points_.hold_bodies(s, motions_.present());
  if (s.is_last()) points_.warn_of_overlaps(s, s.report.warnings);
}

void BodySolver::respond(Substep& s, FunctionRef<Vec3f(int object)> gravity) {
  respond_at_contacts(s, gravity);
  if (s.work.contact_log != nullptr) log_contacts(s, *s.work.contact_log);
}

void BodySolver::respond_at_contacts(Substep& s, FunctionRef<Vec3f(int object)> gravity) {
  if (contacts_.all().empty() && !points_.has_any()) return;
  Executor& executor = s.context.executor;
  const Stopwatch stopwatch(executor.timings(), "respond: bodies");
  motions_.load_velocities(s, gravity);
  if (!contacts_.all().empty()) {
    blocks_.velocity_pass(executor, s.kernels.manifolds, motions_.all(), s.h);
    motions_.store_velocities(s);
  }
  points_.respond(s, motions_.present(), gravity);
  points_.keep_poses(s);
}

const BodyIslands& BodySolver::find_islands(const Substep& s) {
  pressing_.clear();
  blocks_.for_pressing(colours_, [&](int i) { pressing_.push_back(contacts_.bodies()[at(i)]); });
  islands_.find(s, bodies_, {pressing_, contacts_.states(), points_});
  return islands_;
}

void BodySolver::take_impulses(const Substep& s) {
  const auto prefetch = [&](int i) { __builtin_prefetch(&contacts_.all()[at(i)].impulse, 1); };
  blocks_.take(s.context.executor, colours_, prefetch,
               [&](int i, const Manifold& m) { keep_impulses(m, s.h, contacts_.all()[at(i)]); });
}

void BodySolver::end_frame(Substep& s) {
  take_impulses(s);
  if (s.context.sleep.on) put_to_sleep(s);
  std::vector<BodyContact>& all = s.state.body_contacts;
  if (all.empty())
    all.swap(contacts_.all());  // of the first group, usually the only one
  else
    all.insert(all.end(), contacts_.all().begin(), contacts_.all().end());
}

void BodySolver::put_to_sleep(Substep& s) {
  std::vector<int> pressed;
  for (const Contact& contact : point_contacts())
    if (contact.push > 0) pressed.push_back(body_of(contact));
  s.report.sleeping_bodies = sleep_.end_frame(s, {contacts_.bodies(), contacts_.states(), pressed});
  sleep_.add_kept_contacts(contacts_.all());
}

void BodySolver::order(State& state) const {
  std::vector<BodyContact>& all = state.body_contacts;
  if (!std::is_sorted(all.begin(), all.end(), in_order)) std::sort(all.begin(), all.end(), in_order);
}

void BodySolver::count_contacts(Report& report) const {
  const int points = points_.impulses().contacts_that_press();
  report.contacts += points + blocks_.pressing();
  report.pairs.contacts = points;
}

namespace {

/// The index in Object::bodies of a side of a contact; -1 of a collider.
int body_in_object(const Substep& s, const ContactPart& part) {
  if (part.owner < 0) return -1;
  const std::vector<CompiledSolid>& solids = s.model.objects[at(part.owner)].bodies.solids;
  return at(part.solid) < solids.size() ? solids[at(part.solid)].body : -1;
}

}  // namespace

void BodySolver::log_contacts(const Substep& s, ContactLog& log) {
  take_impulses(s);
  const auto add = [&](const BodyContact& c, float bounced, const Vec3d& centre_b) {
    const double pressed = static_cast<double>((c.impulse[0] + c.impulse[1]) + (c.impulse[2] + c.impulse[3]));
    const double impulse = pressed + static_cast<double>(bounced);
    if (impulse > 0)
      add_push({c.a.owner, c.b.owner, impulse, -c.normal, centre_b + convert<double>(c.arm_b), body_in_object(s, c.a),
                body_in_object(s, c.b)},
               log);
  };
  for (const int i : colours_.order()) {
    const std::size_t b = at(contacts_.bodies()[at(i)].second);
    const float bounced = bounced_.empty() ? 0.f : bounced_[at(i)];
    add(contacts_.all()[at(i)], bounced,
        contacts_.states()[b].pose.position + convert<double>(motions_.all()[b].displacement));
  }
  for (const BodyContact& c : sleep_.kept_contacts())
    add(c, 0, contacts_.states()[at(sleep_.body_of(c.b))].pose.position);
  points_.impulses().log_contacts(s, points_.solids(), shares_, log);
  finish_substep(log);
}

}  // namespace pliant
