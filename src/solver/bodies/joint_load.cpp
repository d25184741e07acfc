#include "solver/bodies/joint_load.h"

#include <algorithm>

#include "constraints/registry.h"
#include "math/quat.h"
#include "solver/bodies/body_links.h"
#include "solver/bodies/joint_forest.h"
#include "solver/substep.h"
#include "solver/visit.h"

namespace pliant {

namespace {

Vec3f xyz(const Record& r) { return {r.x, r.y, r.z}; }

/// Adds what one constraint does to body b: gradients times lambda / h^2.
void add_part(const LoadView& view, const CompiledJoint& joint, const ConstraintPlace& at, const std::int32_t* number,
              StencilArrays<float>& arrays, ReactionLoad& load) {
  const auto& multipliers = view.multipliers[static_cast<std::size_t>(at.pool_number)];
  if (multipliers.empty()) return;
  const auto moved = [&](std::int32_t n) { return view.displacements == nullptr ? Vec3f{} : xyz(view.displacements[n]); };
  int origin = -1;
  for (int slot = 0; slot < at.pool.stencil; ++slot) {
    const std::int32_t n = number[slot];
    if (n >= view.object.particles) {
      const Record& q = view.orientations[n - view.object.particles];
      arrays.set_slot(slot, q.x, q.y, q.z, q.w);
      continue;
    }
    if (origin < 0) origin = n;
    const Vec3f x = (xyz(view.positions[n]) - xyz(view.positions[origin])) + (moved(n) - moved(origin));
    arrays.set_slot(slot, x.x, x.y, x.z, 0);
  }
  arrays.load_rest(at);
  constraint_type(at.pool.type).evaluate(arrays.slots, arrays.rest, arrays.c, arrays.gradients);
  const float inverse_h2 = 1 / (view.h * view.h);
  for (int row = 0; row < at.pool.components; ++row) {
    const float force = multipliers[static_cast<std::size_t>(at.multiplier_place(row))] * inverse_h2;
    for (int slot = 0; slot < at.pool.stencil; ++slot) {
      if (number[slot] == joint.point) load.force += arrays.gradient(at.pool, row, slot) * force;
      if (number[slot] == view.object.particles + joint.frame) load.torque += arrays.gradient(at.pool, row, slot) * force;
    }
  }
}

}  // namespace

ReactionLoad load_of(const LoadView& view, const CompiledJoint& joint) {
  ReactionLoad load;
  StencilArrays<float> arrays;
  if (!(view.h > 0) || view.multipliers.empty()) return load;
  for (const CompiledJoint::Part& part : joint.parts) {
    const Pool& pool = view.object.pools[static_cast<std::size_t>(part.pool)];
    add_part(view, joint, {pool, part.pool, part.batch, part.lane}, part.slots.data(), arrays, load);
  }
  const Record& q = view.orientations[joint.frame];
  const Vec3f arm = rotate(Quatf{q.x, q.y, q.z, q.w}, joint.anchor);
  load.torque = load.torque - cross(arm, load.force);
  return load;
}

void set_broken(const CompiledObject& object, const std::vector<int>& joints, ObjectJoints& into) {
  into.broken = joints;
  into.freed = pairs_without_joint(object, joints);
  into.is_broken.assign(joints.empty() ? 0 : object.pools.size(), {});
  for (const int j : joints)
    for (const CompiledJoint::Part& part : object.joints[static_cast<std::size_t>(j)].parts) {
      auto& marks = into.is_broken[static_cast<std::size_t>(part.pool)];
      marks.resize(static_cast<std::size_t>(object.pools[static_cast<std::size_t>(part.pool)].batches) * batch_width);
      marks[static_cast<std::size_t>(part.batch * batch_width + part.lane)] = 1;
    }
  prepare_joints(object, into);
}

void break_joints(Substep& s) {
  for_objects(s, [&](int o) {
    const CompiledObject& object = s.model.objects[static_cast<std::size_t>(o)];
    ObjectJoints& joints = s.work.joints[static_cast<std::size_t>(o)];
    std::vector<int> broken;
    for (std::size_t j = 0; j < object.joints.size(); ++j) {
      const CompiledJoint& joint = object.joints[j];
      if (!joint.may_break() || std::binary_search(joints.broken.begin(), joints.broken.end(), static_cast<int>(j)))
        continue;
      const SweepArguments a = arguments(s, o, false);
      const FrameArguments f = frame_arguments(s, o);
      const ReactionLoad load = load_of(
          {object, a.positions, a.displacements, f.orientations, s.work.multipliers[static_cast<std::size_t>(o)], s.h},
          joint);
      const auto exceeds = [](const Vec3f& value, float most) {
        return most > 0 && !(length_squared(value) <= most * most);
      };
      if (!exceeds(load.force, joint.break_force) && !exceeds(load.torque, joint.break_torque)) continue;
      broken.push_back(static_cast<int>(j));
      s.report.broken_joints.push_back(
          {ObjectId{o}, static_cast<int>(j), joint.name});  // World replaces the number by the id
    }
    if (broken.empty()) return;
    broken.insert(broken.end(), joints.broken.begin(), joints.broken.end());
    std::sort(broken.begin(), broken.end());
    set_broken(object, broken, joints);
  });
}

}  // namespace pliant
