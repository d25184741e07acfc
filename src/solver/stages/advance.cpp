// Update and predict: the stages that move particles.
//
// The end of a substep and the start of the next access the same particles, and the particles of a tile fit a core's
// cache. So if nothing between them reads all velocities (external forces, contacts between surfaces), `update` is
// deferred, and the next `predict` does both in one pass over each tile, with its contacts and usually its first sweep.
// The bits are the same.
#include <algorithm>

#include "math/motion.h"
#include "solver/bodies/body_solver.h"
#include "solver/bodies/joint_forest.h"
#include "solver/collider_depenetration.h"
#include "solver/contact_kernels.h"
#include "solver/drivers/lanes.h"
#include "solver/forces.h"
#include "solver/rotation.h"
#include "solver/stages/stages.h"
#include "solver/substep_law.h"

namespace pliant {

namespace {

/// True if the update puts all of this frame's gravity so far into the velocities.
bool settles(const Substep& s) { return s.is_last() || ends_quarter(s); }

/// True if a stage between update and predict reads velocities, or if phases are timed separately; then update is not
/// deferred. Nor is it where a share of the corrections becomes velocity, because the pass of both knows one h.
bool velocities_are_read(const Substep& s) {
  return settles(s) || s.is_guarded || s.has_pairs() || (s.systems != nullptr && !s.systems->empty()) ||
         !s.ways_out.empty() || !s.own->shape_contacts.empty() || has_forces(s.model, s.work.control) ||
         s.context.separate_phases;
}

/// Moves a kinematic particle to its position at the substep's end.
void move_to(const Vec3d& target, int particle, const AdvanceArguments& a) {
  const Record &x = a.positions[particle], &r = a.remainders[particle];
  Record &d = a.displacements[particle], &v = a.velocities[particle];
  d = {static_cast<float>(target.x - x.x), static_cast<float>(target.y - x.y), static_cast<float>(target.z - x.z), 0};
  v = {(d.x - r.x) * a.inverse_h, (d.y - r.y) * a.inverse_h, (d.z - r.z) * a.inverse_h, 0};
}

/// Moves particles to targets of the user, linearly over the frame. Call it after keyframes, which targets override.
void move_to_targets(const Substep& s, const std::vector<Target>& targets, const AdvanceArguments& a) {
  const double share = static_cast<double>(s.number + 1) / s.planned;
  auto target = std::lower_bound(targets.begin(), targets.end(), a.first,
                                 [](const Target& t, int first) { return t.particle < first; });
  for (; target != targets.end() && target->particle < a.last; ++target)
    move_to(s.is_last() ? target->to : target->from + (target->to - target->from) * share, target->particle, a);
}

/// Moves all kinematic particles of a tile to their positions at the substep's end.
void move_kinematics(const Substep& s, int task, const AdvanceArguments& a) {
  const CompiledObject& object = object_of(s, task);
  const int number = s.model.tiles()[task].object;
  if (const PoseDrive* drive = s.work.control.mesh(number); drive != nullptr || object.carrier.moves()) {
    const CarrierPose pose = drive != nullptr ? CarrierPose(object.carrier, s.time_after, drive->at(s.time_after))
                                              : CarrierPose(object.carrier, s.time_after);
    for (int i = a.first; i < a.last; ++i) move_to(pose.place(i), i, a);
  }
  auto kinematic = std::lower_bound(object.kinematics.begin(), object.kinematics.end(), a.first,
                                    [](const Kinematic& k, int first) { return k.particle < first; });
  for (; kinematic != object.kinematics.end() && kinematic->particle < a.last; ++kinematic) {
    const Vec3<double> target = to_world(pose_at(kinematic->motion, s.time_after), convert<double>(kinematic->rest));
    move_to(target, kinematic->particle, a);
  }
  if (const ObjectControl* control = s.work.control.object(number)) move_to_targets(s, control->targets, a);
}

bool is_finite(const Substep& s, int task) {
  const AdvanceArguments a = particles(s, task);
  return s.kernels.all_finite(a.displacements, a.first, a.last);
}

/// Updates positions, and velocities by the shares of the corrections that become velocity.
void update_particles(const Substep& s, int object, AdvanceArguments a) {
  const float inverse_h = a.inverse_h;
  const auto update = [&](int first, int last, float share) {
    a.first = first;
    a.last = last;
    a.inverse_h = inverse_h * (s.velocity_share * share);  // of the corrections alone: the kernel predicts with h
    s.kernels.update(a);
  };
  if (s.bodies == nullptr) return update(a.first, a.last, 1);
  s.bodies->velocity_shares().for_particles(s.model, object, a.first, a.last, update);
}

/// Ends a tile's substep: updates velocities and positions, and applies restitution at colliders.
void update_tile(const Substep& s, int task, bool ends_frame) {
  AdvanceArguments a = particles(s, task);
  const Vec3f settled = gravity_for(s, s.work.gravity[s.model.tiles()[task].object].settled);
  if (ends_frame) a.gravity_settled = settled;
  update_particles(s, s.model.tiles()[task].object, a);
  const std::vector<Contact>& contacts = s.work.tiles[task].contacts;
  if (!contacts.empty()) respond(contacts, ends_frame ? Vec3f{} : settled, a);
}

/// Starts a tile's substep. `move` is the kernel predict, or advance, which also makes the update of the last substep.
void predict_tile(const Substep& s, int task, void (*move)(const AdvanceArguments&, PointBounds*)) {
  const CompiledObject& object = object_of(s, task);
  const AdvanceArguments a = particles(s, task);
  TileScratch& scratch = s.work.tiles[task];
  scratch.contacts.clear();
  scratch.bounds = {};
  PointBounds* bounds = s.own->colliders.empty() && s.bodies == nullptr ? nullptr : &scratch.bounds;
  move(a, bounds);
  move_kinematics(s, task, a);
  if (bounds == nullptr) return;
  find_contacts({object, a, *bounds, s.own->colliders, s.kernels.find_near, s.kernels.contacts.make_point_contacts},
                scratch.near, scratch.contacts);
  follow_ways_out(s, task, scratch.contacts);
}

/// Ends one substep of a tile and starts the next. Returns false, and changes nothing, if a displacement is not finite.
bool advance_tile(const Substep& s, int task) {
  TileScratch& scratch = s.work.tiles[task];
  scratch.finite = is_finite(s, task);
  if (!scratch.finite) return false;
  const bool in_one_pass = scratch.contacts.empty();
  if (!in_one_pass) update_tile(s, task, false);
  predict_tile(s, task, in_one_pass ? s.kernels.advance : s.kernels.predict);
  return true;
}

/// True if every tile and every frame is finite. Otherwise it notes that the group failed in substep `substep`.
bool all_finite(Substep& s, int substep) {
  bool is_finite = s.frames_are_finite;
  for_each_tile(s, [&](int task) { is_finite = is_finite && s.work.tiles[task].finite; });
  if (!is_finite) s.failed_in = substep;
  return is_finite;
}

}  // namespace

bool predict(Substep& s) {
  predict_frames(s);
  const bool sweeps_at_once = s.sweeps_on_entry && !s.context.separate_phases;
  const auto sweep_first = [&](int task) {
    if (sweep_method(object_of(s, task).sweep).begins_on_entry) project_tile(s, task, true, Order::forward);
  };
  for_tiles(s, s.update_is_due || sweeps_at_once ? "solve: tiles" : "predict", [&](int task) {
    if (!s.update_is_due) predict_tile(s, task, s.kernels.predict);
    if (s.update_is_due && !advance_tile(s, task)) return;
    if (sweeps_at_once) sweep_first(task);
  });
  if (s.sweeps_on_entry && !sweeps_at_once) for_tiles(s, "solve: tiles", sweep_first);  // tiles were entered already
  s.update_is_due = false;
  return all_finite(s, s.made - 1);
}

bool update(Substep& s) {
  update_frames(s);
  for_objects(s, [&](int object) { s.work.gravity[object].next(s.h); });
  const bool has_fast = has_fast_joints(s);
  s.update_is_due = !velocities_are_read(s) && !has_fast;
  if (s.update_is_due) return true;
  const auto find_non_finite = [&](int task) { s.work.tiles[task].finite = is_finite(s, task); };
  if (s.context.separate_phases) for_tiles(s, "find non-finite values", find_non_finite);
  for_tiles(s, "update", [&](int task) {
    if (!s.context.separate_phases) find_non_finite(task);
    if (s.work.tiles[task].finite) update_tile(s, task, settles(s));
  });
  const bool is_finite_now = all_finite(s, s.made);
  if (has_fast && is_finite_now) hold_joint_velocities(s);
  return is_finite_now;
}

}  // namespace pliant
