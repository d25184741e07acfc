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
/// The deepest contact is named in the Report if it is deeper than this share of half of a body's thickness in so many frames one after
/// another: impacts are over sooner.
constexpr float deep_share = 0.2f;
constexpr int frames_of_rest = 6;
/// Contacts are found again in a frame if a body has turned by more than this since they were found [rad].
constexpr float far_turned = 0.2f;
/// The same if two bodies, of which some bounce, have moved against each other by more than this share of half of the smaller one's
/// thickness: the direction of an impact is that of the place where they meet.
constexpr float far_moved = 0.1f;
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

/// Reads the part of a contact that manifold_of needs into the cache.
void fetch(const BodyContact& contact) {
  const char* const first = reinterpret_cast<const char*>(&contact.count);
  for (std::size_t byte = 0; byte < sizeof(BodyContact) - offsetof(BodyContact, count); byte += 64)
    __builtin_prefetch(first + byte);
}

}  // namespace

BodySolver::BodySolver(const Model& model, const std::vector<int>* objects, BodyMeshes& meshes)
    : bodies_(model, objects, meshes), finder_(bodies_.take_parts()), motions_(bodies_) {
  if (!has_bodies()) return;
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
}

void BodySolver::make_manifolds(const Substep& s) {
  Executor& executor = s.context.executor;
  const Stopwatch stopwatch(executor.timings(), "bodies: manifolds");
  const std::vector<std::pair<int, int>>& bodies_of = finder_.bodies();
  colours_.colour(bodies_of, is_fixed_);
  const auto prefetch = [&](int i) { fetch(contacts_[at(i)]); };
  blocks_.fill(executor, colours_, is_fixed_, prefetch, [&](int i) {
    const auto& [a, b] = bodies_of[at(i)];
    return manifold_of(contacts_[at(i)], a, b, bodies_.material(s.model, a, b), s.h);
  });
  blocks_.prepare(executor, s.kernels.manifolds, motions_.all());
}

void BodySolver::begin_frame(Substep& s) {
  bodies_.begin_frame(s);
  sleep_.begin_frame(s, s.state.body_contacts);
  read_states(s);
  find_contacts(s);
  motions_.begin_frame(s);
  pushes_are_known_ = false;
  last_h_ = s.h;
  make_manifolds(s);
  points_.begin_frame(s);
  shares_.clear();
}

/// True if bodies with a contact have turned far since it was found, or, if some bounce, moved far. Along planes and meshes,
/// whose size has no end, that is no matter.
bool BodySolver::have_moved_far() const {
  const auto turned = [&](int body) { return body < bodies_.dynamic() && motions_.turned(body) > far_turned; };
  const std::vector<BodyMotion>& all = motions_.all();
  const bool bounces = blocks_.bounces();
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    const auto& [a, b] = finder_.bodies()[i];
    if (turned(a) || turned(b)) return true;
    if (!bounces || std::max(finder_.size_of_body(a), finder_.size_of_body(b)) > 1e29f) continue;
    const float far = far_moved * std::min(finder_.size_of_body(a), finder_.size_of_body(b));
    if (length_squared(all[at(b)].displacement - all[at(a)].displacement) > far * far) return true;
  }
  return false;
}

void BodySolver::renew_contacts(Substep& s) {
  if (s.number == 0 || contacts_.empty() || !have_moved_far()) return;
  take_impulses(s);
  bodies_.begin_frame(s);
  read_states(s);
  update_contacts(s, contacts_);
  motions_.begin_frame(s);
  pushes_are_known_ = false;
  make_manifolds(s);
}

void BodySolver::read_states(const Substep& s) {
  states_.clear();
  is_fixed_.clear();
  for (int place = 0; place < static_cast<int>(bodies_.places().size()); ++place) {
    states_.push_back(bodies_.state_at_start(s, place));
    is_fixed_.push_back(states_.back().is_fixed ? 1 : 0);
  }
}

void BodySolver::update_contacts(Substep& s, const std::vector<BodyContact>& before) {
  const double left = time_left(s);
  const float gravity = static_cast<float>(left) * length(s.model.gravity);
  finder_.update(
      s.context.executor, states_, static_cast<float>(left), gravity,
      [&](int a, int b) { return bodies_.meet(s.model, a, b); }, before, contacts_);
}

/// Contacts with a body that sleeps wake it, and are found once more with those of its island.
void BodySolver::find_contacts_beside_sleepers(Substep& s) {
  for (bool goes_on = true; goes_on;) {
    for (std::size_t place = at(bodies_.dynamic()); place < states_.size() && sleep_.any(); ++place)
      if (moves(states_[place])) states_[place].is_fixed = false;  // so that pairs with bodies that sleep are found
    update_contacts(s, before_);
    goes_on = sleep_.wake_touched(s, finder_.bodies(), before_);
    if (goes_on) read_states(s);
  }
  sleep_.keep_contacts(s.part == nullptr, before_);
}

void BodySolver::find_contacts(Substep& s) {
  const bool is_alone = s.part == nullptr;  // else other groups read the State's contacts at the same time
  if (sleep_.any()) {
    if (is_alone) {
      before_.swap(s.state.body_contacts);
      s.state.body_contacts.clear();
    } else {
      before_ = s.state.body_contacts;
    }
    find_contacts_beside_sleepers(s);
  } else {
    if (is_alone) {
      contacts_.swap(s.state.body_contacts);
      s.state.body_contacts.clear();
    }
    update_contacts(s, is_alone ? contacts_ : s.state.body_contacts);
  }
  if (finder_.left_out() > 0)
    s.report.warnings.push_back(std::to_string(finder_.left_out()) +
                                " pairs of bodies that overlap are left to later frames, because each body has " +
                                std::to_string(BodyPairs::most_of_crowded) + " others in its place");
  warn_of_overlap(s);
}

/// Warns of bodies that are pressed into one another.
void BodySolver::warn_of_overlap(Substep& s) {
  const BodyOverlap deepest = finder_.deepest();
  const bool goes_on = deepest.a == deepest_.a && deepest.b == deepest_.b;
  deepest_ = deepest;
  deep_frames_ = deepest.share < deep_share ? 0 : goes_on ? deep_frames_ + 1 : 1;
  if (deep_frames_ < frames_of_rest) return;
  const auto name = [&](int place) { return bodies_.name(s.model, place); };
  s.report.warnings.push_back(
      name(deepest.a) + " and " + name(deepest.b) + " overlap by " + std::to_string(deepest.depth) +
      " m: what lies on them is too heavy for " + std::to_string(s.planned) +
      " substeps; contacts give way by 1.04 h^2 F / m, so twice the substeps bear four times the weight");
}

/// Gathers the prediction at the start of a substep, which begins with the impulses of the last one. What these do is known from it, but in
/// the first one of a frame.
void BodySolver::start_substep(const Substep& s) {
  Executor& executor = s.context.executor;
  const ManifoldKernels& kernels = s.kernels.manifolds;
  const float share = s.h / last_h_;
  if (last_h_ != s.h) blocks_.scale_impulses(executor, share);
  last_h_ = s.h;
  motions_.load_predicted(s, bodies_, true, pushes_are_known_ ? share : 0);
  if (!pushes_are_known_) blocks_.warm_start(executor, kernels, motions_.all());
  pushes_are_known_ = true;
  if (!blocks_.bounces()) return;
  const Vec3f fall = s.model.gravity * s.h;
  motions_.change_once([&] {
    bool goes_on = true;
    for (int round = 0; goes_on && round < most_rounds_of_impacts; ++round)
      goes_on = blocks_.bounce(executor, kernels, motions_.all(), s.h, fall);
  });
}

void BodySolver::collide(Substep& s) {
  if (!points_.has_any()) return;
  motions_.begin_substep(s);
  points_.detect(s);
  points_.find_loads(s, motions_.present(), true);
}

void BodySolver::project(Substep& s, bool is_first) {
  if (contacts_.empty() && !points_.has_any()) return;
  Executor& executor = s.context.executor;
  const Stopwatch stopwatch(executor.timings(), "solve: bodies");
  if (is_first) {
    start_substep(s);
  } else {
    motions_.load_predicted(s, bodies_, false, 0);
  }
  if (!contacts_.empty()) {
    blocks_.position_pass(executor, s.kernels.manifolds, motions_.all(), s.h, {});
    motions_.store_predicted(s);
  }
  points_.project(s, motions_.present());
}

void BodySolver::hold_bodies(Substep& s) {
  if (!points_.has_any()) return;
  points_.hold_bodies(s, motions_.present());
  if (s.is_last()) points_.warn_of_overlaps(s, s.report.warnings);
}

void BodySolver::respond(Substep& s, FunctionRef<Vec3f(int object)> gravity) {
  if (contacts_.empty() && !points_.has_any()) return;
  Executor& executor = s.context.executor;
  const Stopwatch stopwatch(executor.timings(), "respond: bodies");
  motions_.load_velocities(s, gravity);
  if (!contacts_.empty()) {
    blocks_.velocity_pass(executor, s.kernels.manifolds, motions_.all(), s.h);
    motions_.store_velocities(s);
  }
  points_.respond(s, motions_.present(), gravity);
  points_.keep_poses(s);
}

const BodyIslands& BodySolver::find_islands(const Substep& s) {
  pressing_.clear();
  blocks_.for_pressing(colours_, [&](int i) { pressing_.push_back(finder_.bodies()[at(i)]); });
  islands_.find(s, bodies_, {pressing_, states_, points_});
  return islands_;
}

void BodySolver::take_impulses(const Substep& s) {
  const auto prefetch = [&](int i) { __builtin_prefetch(&contacts_[at(i)].impulse, 1); };
  blocks_.take(s.context.executor, colours_, prefetch,
               [&](int i, const Manifold& m) { keep_impulses(m, s.h, contacts_[at(i)]); });
}

void BodySolver::end_frame(Substep& s) {
  take_impulses(s);
  if (!s.context.sleep.on) return;
  std::vector<int> pressed;
  for (const Contact& contact : point_contacts())
    if (contact.push > 0) pressed.push_back(body_of(contact));
  s.report.sleeping_bodies = sleep_.end_frame(s, {finder_.bodies(), states_, pressed});
  sleep_.add_kept_contacts(contacts_);
}

void BodySolver::log_contacts(const Substep& s, ContactLog& log) {
  take_impulses(s);
  const auto add = [&](const BodyContact& c, const Vec3d& centre_b) {
    const double impulse = static_cast<double>((c.impulse[0] + c.impulse[1]) + (c.impulse[2] + c.impulse[3]));
    if (impulse > 0) add_push({c.a.owner, c.b.owner, impulse, -c.normal, centre_b + convert<double>(c.arm_b)}, log);
  };
  for (const int i : colours_.order()) {
    const std::size_t b = at(finder_.bodies()[at(i)].second);
    add(contacts_[at(i)], states_[b].pose.position + convert<double>(motions_.all()[b].displacement));
  }
  for (const BodyContact& c : sleep_.kept_contacts()) add(c, states_[at(sleep_.body_of(c.b))].pose.position);
  points_.impulses().log_contacts(s, points_.solids(), log);
  finish_substep(log);
}

int BodySolver::contacts_that_press() const { return points_.impulses().contacts_that_press() + blocks_.pressing(); }

}  // namespace pliant
