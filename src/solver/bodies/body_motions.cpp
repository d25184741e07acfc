#include "solver/bodies/body_motions.h"

#include <algorithm>
#include <cstddef>

#include "parallel/ranges.h"
#include "solver/bodies/body_math.h"
#include "solver/frame_formulas.h"
#include "solver/rotation.h"
#include "solver/substep.h"

namespace pliant {

namespace {

constexpr int bodies_a_task = 256;
/// What turns by less in a substep has no gyroscopic torque that impacts would notice: bodies at rest in a pile [rad].
constexpr float hardly_turned = 1e-4f;

/// Calls body(first, last) for ranges of `count` bodies on all threads.
template <class Body>
void for_bodies(const Substep& s, int count, const Body& body) {
  for_ranges(s.context.executor, nullptr, count, bodies_a_task, body);
}

/// Calls body(first, last) for each range of numbers with 1 in `of`.
template <class Body>
void for_runs(const std::vector<char>& of, const Body& body) {
  const auto number = [&](auto place) { return static_cast<int>(place - of.begin()); };
  for (auto first = std::find(of.begin(), of.end(), 1); first != of.end();) {
    const auto last = std::find(first, of.end(), 0);
    body(number(first), number(last));
    first = std::find(last, of.end(), 1);
  }
}

/// Moves with a collider: its velocities in the substep.
void follow(const std::pair<Posed, Posed>& poses, float h, BodyMotion& motion) {
  const auto& [before, after] = poses;
  motion.velocity = convert<float>(after.position - before.position) * (1 / h);
  motion.spin = turn_between(convert<float>(before).rotation, convert<float>(after).rotation) * (1 / h);
}

/// Of the axes about which a body's solids are round, those about which its inertia is, too, and free to turn.
Record round_of_inertia(const Record& inverse, const Record& solids) {
  const auto agree = [](float a, float b) {
    return std::min(a, b) > 0 && std::max(a, b) - std::min(a, b) < 1e-4f * std::max(a, b);
  };
  const bool turns = inverse.x > 0 && inverse.y > 0 && inverse.z > 0;
  return {turns && agree(inverse.y, inverse.z) ? solids.x : 0, turns && agree(inverse.z, inverse.x) ? solids.y : 0,
          turns && agree(inverse.x, inverse.y) ? solids.z : 0, 0};
}

using Seen = motion_formulas::Turned<float>;

Record record_of(const Vec3f& v) { return {v.x, v.y, v.z, 0}; }
bool vanishes(const Vec3f& v) { return v.x == 0 && v.y == 0 && v.z == 0; }

/// How contacts see a body: from where it was at the frame's start.
Seen seen(const Record& at_frame_start, const Record& now, const Record& round) {
  return {quaternion(at_frame_start), quaternion(now), xyz(round)};
}

Vec3f to_contacts(const Seen& body, const Vec3f& spin) { return rotate(body.start, body.from_body(spin)); }
Vec3f to_body(const Seen& body, const Vec3f& spin) { return body.to_body(rotate(conjugate(body.start), spin)); }

/// The angular velocity at the start of a free turn in h that ends with `w`.
Vec3f spin_at_start(const Vec3f& inverse, const Vec3f& round, const Vec3f& w, float h) {
  using namespace motion_formulas;
  const Spinning<float> fast(inverse, round, w, h);
  if (fast.anywhere && fast.applies) return rotate(fast.twist, w);
  return w + gyroscopic_change(gyroscopic_factors(inverse, inertia_of(inverse)), w, -h);
}

}  // namespace

BodyMotions::BodyMotions(const ContactBodies& bodies) : motions_(bodies.places().size()), places_(motions_.size()) {
  for (int i = 0; i < bodies.dynamic(); ++i) {
    const BodyPlace& place = bodies.places()[at(i)];
    particles_.push_back(place.particle);
    frames_.push_back(place.frame);
    const Vec3f round = bodies.round_axes(i);
    round_.push_back({round.x, round.y, round.z, 0});
    if (ranges_.empty() || ranges_.back().object != place.object || i - ranges_.back().first == bodies_a_task)
      ranges_.push_back({place.object, i, i});
    ranges_.back().last = i + 1;
  }
  for (Records* list : {&start_positions_, &start_remainders_, &start_orientations_, &pushed_, &pushed_spin_})
    list->resize(particles_.size());
}

BodyArrays BodyMotions::arrays(const Substep& s, std::vector<BodyMotion>& motions) {
  return {motions.data(),
          particles_.data(),
          frames_.data(),
          start_positions_.data(),
          start_remainders_.data(),
          start_orientations_.data(),
          pushed_.data(),
          pushed_spin_.data(),
          s.state.positions.data(),
          s.state.remainders.data(),
          s.work.displacements.data(),
          s.state.velocities.data(),
          frame_arrays(s)};
}

int BodyMotions::add_fixed(const Vec3f& velocity, const Vec3f& spin, const Vec3f& displacement, const Vec3f& rotation) {
  BodyMotion motion;
  motion.velocity = velocity;
  motion.spin = spin;
  motion.displacement = displacement;
  motion.rotation = rotation;
  motions_.push_back(motion);
  return static_cast<int>(motions_.size()) - 1;
}

void BodyMotions::begin_frame(const Substep& s) {
  motions_.resize(places_);
  std::fill(motions_.begin(), motions_.end(), BodyMotion{});
  for (int i = 0; i < bodies(); ++i) {
    const std::size_t particle = at(particles_[at(i)]);
    start_positions_[at(i)] = s.state.positions[particle];
    start_remainders_[at(i)] = s.state.remainders[particle];
    start_orientations_[at(i)] = s.state.frames.orientations[at(frames_[at(i)])];
    s.work.frames.round[at(frames_[at(i)])] =
        round_of_inertia(s.state.frames.inverse_inertias[at(frames_[at(i)])], round_[at(i)]);
  }
  const BodyArrays all = arrays(s);
  for_bodies(s, bodies(), [&](int first, int last) { s.kernels.motions.load_inertia(all, first, last); });
}

void BodyMotions::begin_substep(const Substep& s) {
  present_.resize(motions_.size());
  const BodyArrays all = arrays(s, present_);
  for_bodies(s, bodies(), [&](int first, int last) { s.kernels.motions.load_inertia(all, first, last); });
}

void BodyMotions::load_predicted(const Substep& s, const ContactBodies& bodies_and_colliders, bool is_first,
                                 float share) {
  for (int i = bodies(); i < static_cast<int>(places_); ++i)
    follow(bodies_and_colliders.poses_of_collider(s, i), s.h, motions_[at(i)]);
  restarts_.clear();
  const BodyArrays all = arrays(s);
  for_bodies(s, bodies(),
             [&](int first, int last) { s.kernels.motions.load_predicted(all, first, last, s.h, is_first, share); });
}

void BodyMotions::store_predicted(const Substep& s) {
  store_turns(s, nullptr);
  const BodyArrays all = arrays(s);
  for_bodies(s, bodies(), [&](int first, int last) { s.kernels.motions.store_predicted(all, first, last, s.h); });
}

void BodyMotions::store_predicted(const Substep& s, const std::vector<char>& of, const Pushes& before) {
  store_turns(s, &of);
  const BodyArrays all = arrays(s);
  for_runs(of, [&](int first, int last) { s.kernels.motions.store_predicted(all, first, last, s.h); });
  restore(before, of, 0);
}

void BodyMotions::reload_predicted(const Substep& s, const std::vector<char>& of, const Pushes& pushes) {
  const BodyArrays all = arrays(s);
  for_runs(of, [&](int first, int last) { s.kernels.motions.load_predicted(all, first, last, s.h, false, 0); });
  restore(pushes, of, 1);
  std::erase_if(restarts_, [&](const Restart& restart) { return of[at(restart.body)] != 0; });
}

/// Puts back what contacts did to the bodies with `value` in `of`.
void BodyMotions::restore(const Pushes& pushes, const std::vector<char>& of, char value) {
  for (std::size_t i = 0; i < of.size(); ++i) {
    if (of[i] != value) continue;
    pushed_[i] = pushes.linear[i];
    pushed_spin_[i] = pushes.angular[i];
  }
}

void BodyMotions::load_velocities(const Substep& s, FunctionRef<Vec3f(int object)> gravity) {
  for (int i = bodies(); i < static_cast<int>(motions_.size()); ++i) {
    BodyMotion& collider = motions_[at(i)];
    collider.displacement += collider.velocity * s.h;
    collider.rotation += collider.spin * s.h;
  }
  const BodyArrays all = arrays(s);
  s.context.executor.parallel_for(nullptr, static_cast<int>(ranges_.size()), [&](int task) {
    const Range& range = ranges_[at(task)];
    s.kernels.motions.load_velocities(all, range.first, range.last, gravity(range.object));
  });
}

void BodyMotions::store_velocities(const Substep& s) {
  const BodyArrays all = arrays(s);
  for_bodies(s, bodies(), [&](int first, int last) { s.kernels.motions.store_velocities(all, first, last); });
}

// ------------------------------------------------------------------------------------------------ impacts
//
// A frame's prediction turns it with the spin of the substep's middle and ends with that of the end, after gyroscopic
// torque. An impulse that is computed with the former and added to the latter changes the energy by impulse times h
// times that torque, of either sign: a tilted box gained 12 % in 20 s. So impacts act on the spin at the start, which
// has the same energy as that of the end, and the free turn begins again.

/// Shows impacts the motion that a body has at the substep's start, without what contacts did in the last one: a bounce
/// off what that leaves would bring energy where the passes take it back. Where other forces than gravity act, what
/// contacts did stays: they press on what lies still by more than a bounce may tell from an impact.
void BodyMotions::show_spin_at_start(const Substep& s, int body) {
  const FrameArrays all = frame_arrays(s);
  const std::size_t frame = at(frames_[at(body)]);
  const bool turns = length_squared(xyz(all.angular_velocities[frame])) * (s.h * s.h) > hardly_turned * hardly_turned;
  if (!turns || !vanishes(xyz(all.corrections[frame]))) return;
  BodyMotion& motion = motions_[at(body)];
  const Vec3f spin =
      spin_at_start(xyz(all.inverse_inertias[frame]), xyz(all.round[frame]), xyz(all.angular_velocities[frame]), s.h);
  const Seen then = seen(start_orientations_[at(body)], all.starts[frame], all.round[frame]);
  if (!changes_velocities(s)) motion.velocity = motion.kept_velocity;
  motion.spin = to_contacts(then, spin);
  restarts_.push_back({body, spin, motion.spin, motion.velocity, {}, {}, {}, false});
}

/// Predicts the free turn of a body with the spin that impacts have left it. Returns false if there were none.
bool BodyMotions::turn_anew(const Substep& s, Restart& restart) {
  BodyMotion& motion = motions_[at(restart.body)];
  Vec3f& before = before_spin_[at(restart.body)];
  motion.velocity = before_velocity_[at(restart.body)] + (motion.velocity - restart.shown_velocity);
  const Vec3f change = motion.spin - restart.shown;
  motion.spin = before;
  if (vanishes(change)) return false;
  const FrameArrays all = frame_arrays(s);
  const std::size_t frame = at(frames_[at(restart.body)]);
  const Record& start = start_orientations_[at(restart.body)];
  const Seen then = seen(start, all.starts[frame], all.round[frame]);
  const auto turn = motion_formulas::free_turn(then.now, xyz(all.inverse_inertias[frame]), then.round,
                                               restart.spin + to_body(then, change), s.h);
  restart.orientation = {turn.orientation.x, turn.orientation.y, turn.orientation.z, turn.orientation.w};
  restart.predicted = record_of(turn.angle);
  restart.spin_after = record_of(turn.spin);
  const Seen now = seen(start, restart.orientation, all.round[frame]);
  const Vec3f predicted = rotate(now.start, now.from_world(turn.angle * (1 / s.h)));
  before = motion.spin = predicted + (before - motion.kept_spin);
  motion.kept_spin = predicted;
  return true;
}

/// Puts the new turns of bodies, or of those with 1 in `of`, into their frames.
void BodyMotions::store_turns(const Substep& s, const std::vector<char>* of) {
  const FrameArrays all = frame_arrays(s);
  for (const Restart& restart : restarts_) {
    if (of != nullptr && (*of)[at(restart.body)] == 0) continue;
    const std::size_t frame = at(frames_[at(restart.body)]);
    all.orientations[frame] = restart.orientation;
    all.predicted[frame] = restart.predicted;
    all.angular_velocities[frame] = restart.spin_after;
  }
  restarts_.clear();
}

void BodyMotions::bounce(const Substep& s, const std::vector<char>& restarts, FunctionRef<void()> impacts) {
  before_velocity_.clear();
  before_spin_.clear();
  restarts_.reserve(at(bodies()));
  for (int i = 0; i < bodies(); ++i) {
    before_velocity_.push_back(motions_[at(i)].velocity);
    before_spin_.push_back(motions_[at(i)].spin);
    if (restarts[at(i)] != 0) show_spin_at_start(s, i);
  }
  impacts();
  for (Restart& restart : restarts_) restart.turns = turn_anew(s, restart);
  std::erase_if(restarts_, [](const Restart& restart) { return !restart.turns; });
  for (int i = 0; i < bodies(); ++i) {
    pushed_[at(i)] = plus(pushed_[at(i)], before_velocity_[at(i)] - motions_[at(i)].velocity);
    const Quatf start = quaternion(start_orientations_[at(i)]);
    pushed_spin_[at(i)] =
        plus(pushed_spin_[at(i)], rotate(conjugate(start), before_spin_[at(i)] - motions_[at(i)].spin));
  }
}

}  // namespace pliant
