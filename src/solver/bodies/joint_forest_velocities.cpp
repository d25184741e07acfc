// Rigid joints of trees hold velocities too where a body on a bearing that stands still turns by radians in a substep
// (RATTLE; Andersen 1983).
//
// A body that turns by radians is predicted as a free top. What a joint should have taken from its angular momentum
// then comes back turned, and a disc on a hinge gains speed. Where bodies turn less, the next solve of positions does
// the same by nearly the same gradients. Bearings that move are left out: a wheel on a light, free frame swings
// (nutates) faster than substeps can follow, and holding velocities would make it grow.
//
// Multipliers of velocities are no part of Report's joint loads.
#include "constraints/registry.h"
#include "math/quat.h"
#include "solver/bodies/body_math.h"
#include "solver/bodies/joint_forest_work.h"
#include "solver/stages/stages.h"
#include "solver/substep_law.h"

namespace pliant {

namespace {

/// From this angle in a substep on [rad].
constexpr float fast_angle = 1;

/// Velocities of an object's points and frames, and what gravity has yet to add to those of points.
struct Velocities {
  Record *points, *frames;
  Vec3f missing;

  /// Of a slot of a joint: the velocity of a point, or the angular velocity of a frame in world axes.
  Vec3f of(const JointWork& work, const JointForest::Joint& joint, int slot) const {
    const std::int32_t n = joint.slots[static_cast<std::size_t>(slot)];
    if (slot % 2 == 1) return rotate(quaternion(work.frames.orientations[n]), xyz(frames[n]));
    return work.points.positions[n].w > 0 ? xyz(points[n]) + missing : xyz(points[n]);
  }
};

/// True if a point and a frame neither move nor can.
bool stands_still(const Substep& s, int object, std::int32_t point, std::int32_t frame) {
  const auto p = static_cast<std::size_t>(s.model.first[object]) + static_cast<std::size_t>(point);
  const auto f = static_cast<std::size_t>(s.model.first_frame[object]) + static_cast<std::size_t>(frame);
  return s.state.positions[p].w == 0 && xyz(s.state.velocities[p]) == Vec3f{} &&
         xyz(s.state.frames.angular_velocities[f]) == Vec3f{} && xyz(s.state.frames.inverse_inertias[f]) == Vec3f{};
}

/// True if a body turns fast on a joint with what stands still.
bool is_fast(const Substep& s, int object, const JointForest& forest) {
  const Record* spins = s.state.frames.angular_velocities.data() + s.model.first_frame[object];
  const float most = fast_angle * fast_angle / (s.h * s.h);
  for (std::size_t j = 0; j < forest.joints.size(); ++j) {
    const JointForest::Joint& joint = forest.joints[j];
    const JointEnds& ends = forest.ends[j];
    if (!joint.in_tree || (ends.a >= 0) == (ends.b >= 0)) continue;
    const std::size_t own = ends.a >= 0 ? 0 : 2, other = 2 - own;
    if (length_squared(xyz(spins[joint.slots[own + 1]])) > most &&
        stands_still(s, object, joint.slots[other], joint.slots[other + 1]))
      return true;
  }
  return false;
}

/// The rows of a joint at present, whose values are their rates of change. A joint with compliance has none.
void fill_rates(JointWork& work, const Velocities& velocities, std::size_t j) {
  const JointForest::Joint& joint = work.forest.joints[j];
  JointRows& rows = work.forest.rows[j];
  rows.rows = 0;
  const ConstraintPlace at = place_of(work, joint.parts.front());
  const ConstraintDefinition& type = constraint_type(at.pool.type);
  if (!joint.in_tree || at.value(at.pool.fields) > 0 || type.acts_on_motion) return;
  work.arrays.load_rest(at);
  load_slots(work, joint, work.points.remainders, work.frames.orientations);
  evaluate(work, type);
  rows.rows = at.pool.components;
  for (int r = 0; r < at.pool.components; ++r) {
    const auto row = static_cast<std::size_t>(r);
    rows.of_a[row] = {work.arrays.gradient(at.pool, r, 0), work.arrays.gradient(at.pool, r, 1)};
    rows.of_b[row] = {work.arrays.gradient(at.pool, r, 2), work.arrays.gradient(at.pool, r, 3)};
    rows.compliance[row] = 0;
    rows.value[row] = 0;
    for (int slot = 0; slot < 4; ++slot)
      rows.value[row] += dot(work.arrays.gradient(at.pool, r, slot), velocities.of(work, joint, slot));
  }
}

/// Takes the rates of change of rigid joints from the velocities of their bodies.
void hold(JointWork& work, const Velocities& velocities) {
  JointForest& forest = work.forest;
  fill_masses(work);
  forest.rows.resize(forest.joints.size());
  for (std::size_t j = 0; j < forest.joints.size(); ++j) fill_rates(work, velocities, j);
  forest.tree->solve(forest.masses, forest.rows, forest.corrections);
  for (std::size_t i = 0; i < forest.bodies.size(); ++i) {
    const JointForest::Body& body = forest.bodies[i];
    const BodyCorrection& change = forest.corrections[i];
    if (work.points.positions[body.point].w > 0)
      velocities.points[body.point] = plus(velocities.points[body.point], change.displacement);
    const Quatf q = quaternion(work.frames.orientations[body.frame]);
    velocities.frames[body.frame] = plus(velocities.frames[body.frame], rotate(conjugate(q), change.rotation));
  }
}

}  // namespace

bool has_fast_joints(Substep& s) {
  bool any = false;
  for_objects(s, [&](int o) {
    for (JointForest& forest : s.work.joints[static_cast<std::size_t>(o)].forests) {
      forest.is_fast = is_fast(s, o, forest);
      any = any || forest.is_fast;
    }
  });
  return any;
}

void hold_joint_velocities(Substep& s) {
  const bool is_settled = s.is_last() || ends_quarter(s);
  for_trees(s, false, Bundled::included, [&](JointWork& work) {
    if (!work.forest.is_fast) return;
    const Vec3f missing = is_settled ? Vec3f{} : gravity_for(s, s.work.gravity[work.number].settled);
    hold(work, {s.state.velocities.data() + s.model.first[work.number],
                s.state.frames.angular_velocities.data() + s.model.first_frame[work.number], missing});
  });
}

}  // namespace pliant
