#include "solver/bodies/joint_load.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "constraints/registry.h"
#include "constraints/rod_joint.h"
#include "math/disjoint_sets.h"
#include "math/quat.h"
#include "math/record.h"
#include "solver/bodies/body_links.h"
#include "solver/bodies/joint_forest.h"
#include "solver/joint_load_sums.h"
#include "solver/substep.h"
#include "solver/visit.h"

namespace pliant {

namespace {

/// Adds what one constraint does to body b: gradients times lambda / h^2.
void add_part(const LoadView& view, const CompiledJoint& joint, const ConstraintPlace& at, const std::int32_t* number,
              StencilArrays<float>& arrays, ReactionLoad& load) {
  const auto& multipliers = view.multipliers[static_cast<std::size_t>(at.pool_number)];
  if (multipliers.empty()) return;
  const auto moved = [&](std::int32_t n) {
    return view.displacements == nullptr ? Vec3f{} : xyz(view.displacements[n]);
  };
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
      if (number[slot] == view.object.particles + joint.frame)
        load.torque += arrays.gradient(at.pool, row, slot) * force;
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

namespace {

/// A joint that carries more than it can.
struct Overload {
  int joint = 0;
  float share = 0;  ///< the greater one of force and torque over their limits
};

/// An object after the solve of a substep.
LoadView view_of(const Substep& s, int o) {
  const SweepArguments a = arguments(s, o, false);
  return {
      s.model.objects[static_cast<std::size_t>(o)],    a.positions, a.displacements, frame_arguments(s, o).orientations,
      s.work.multipliers[static_cast<std::size_t>(o)], s.h};
}

/// The joints of an object that carry more than they can, ascending.
std::vector<Overload> find_overloads(const Substep& s, int o) {
  const CompiledObject& object = s.model.objects[static_cast<std::size_t>(o)];
  const std::vector<int>& broken = s.work.joints[static_cast<std::size_t>(o)].broken;
  const LoadView view = view_of(s, o);
  const auto share = [](const Vec3f& value, float most) { return most > 0 ? length(value) / most : 0; };
  std::vector<Overload> found;
  for (int j = 0; j < static_cast<int>(object.joints.size()); ++j) {
    const CompiledJoint& joint = object.joints[static_cast<std::size_t>(j)];
    if (!joint.may_break() || std::binary_search(broken.begin(), broken.end(), j)) continue;
    const ReactionLoad load = load_of(view, joint);
    const float of_force = share(load.force, joint.break_force), of_torque = share(load.torque, joint.break_torque);
    if (!(of_force <= 1 && of_torque <= 1)) found.push_back({j, max(of_force, of_torque)});
  }
  return found;
}

/// The frames of the bodies of a joint between segments of a rod: add_rod numbers them one after another, but not what
/// holds an end. Equal numbers for other joints.
std::pair<int, int> segments_of(const CompiledObject& object, const CompiledJoint& joint) {
  for (const CompiledJoint::Part& part : joint.parts) {
    const Pool& pool = object.pools[static_cast<std::size_t>(part.pool)];
    if (std::string_view(constraint_type(pool.type).name) != RodJointRows::name) continue;
    const int a = part.slots[1] - object.particles, b = part.slots[3] - object.particles;
    if (a + 1 == b) return {a, b};
  }
  return {joint.frame, joint.frame};
}

/// For each frame of an object the lowest frame of the same rod, as far as it is whole; -1: it is not of a segment of a
/// rod.
std::vector<int> rods_of(const CompiledObject& object, const std::vector<int>& broken) {
  DisjointSets rods(object.frames.size());
  std::vector<int> found(object.frames.size(), -1);
  for (int j = 0; j < static_cast<int>(object.joints.size()); ++j) {
    const auto [a, b] = segments_of(object, object.joints[static_cast<std::size_t>(j)]);
    if (a == b) continue;
    const auto first = static_cast<std::size_t>(a), second = static_cast<std::size_t>(b);
    found[first] = found[second] = 0;
    if (!std::binary_search(broken.begin(), broken.end(), j)) rods.join(first, second);
  }
  for (std::size_t i = 0; i < found.size(); ++i)
    if (found[i] == 0) found[i] = static_cast<int>(rods.root(i));
  return found;
}

/// Of each rod, with the joints that hold its ends, keeps the joint with the greatest share, the first of equal ones:
/// they bear one load in series, so the one that breaks relieves the others.
void keep_one_of_each_rod(const CompiledObject& object, const std::vector<int>& broken, std::vector<Overload>& joints) {
  const std::vector<int> rods = rods_of(object, broken);
  const auto rod_of = [&](const Overload& one) {
    return rods[static_cast<std::size_t>(object.joints[static_cast<std::size_t>(one.joint)].frame)];
  };
  std::vector<Overload> greatest(object.frames.size(), {-1, 0});  // by rod
  for (const Overload& one : joints) {
    if (rod_of(one) < 0) continue;
    Overload& of_rod = greatest[static_cast<std::size_t>(rod_of(one))];
    if (of_rod.joint < 0 || one.share > of_rod.share) of_rod = one;
  }
  std::erase_if(joints, [&](const Overload& one) {
    return rod_of(one) >= 0 && greatest[static_cast<std::size_t>(rod_of(one))].joint != one.joint;
  });
}

}  // namespace

void add_joint_loads(const Substep& s) {
  for_objects(s, [&](int o) {
    const CompiledObject& object = s.model.objects[static_cast<std::size_t>(o)];
    JointLoadSums& sums = s.work.joint_loads[static_cast<std::size_t>(o)];
    if (object.joints.empty()) return;
    if (sums.is_complete || sums.forces.size() != object.joints.size())
      sums = {std::vector<Vec3d>(object.joints.size()), std::vector<Vec3d>(object.joints.size()), 0, false};
    const std::vector<int>& broken = s.work.joints[static_cast<std::size_t>(o)].broken;
    const LoadView view = view_of(s, o);
    for (std::size_t j = 0; j < object.joints.size(); ++j) {
      if (std::binary_search(broken.begin(), broken.end(), static_cast<int>(j))) continue;
      const ReactionLoad load = load_of(view, object.joints[j]);
      sums.forces[j] += convert<double>(load.force) * static_cast<double>(s.h);
      sums.torques[j] += convert<double>(load.torque) * static_cast<double>(s.h);
    }
    sums.time += static_cast<double>(s.h);
  });
}

void break_joints(Substep& s) {
  for_objects(s, [&](int o) {
    const CompiledObject& object = s.model.objects[static_cast<std::size_t>(o)];
    ObjectJoints& joints = s.work.joints[static_cast<std::size_t>(o)];
    std::vector<Overload> overloads = find_overloads(s, o);
    if (overloads.empty()) return;
    if (overloads.size() > 1) keep_one_of_each_rod(object, joints.broken, overloads);
    std::vector<int> broken = joints.broken;
    for (const Overload& one : overloads) {
      broken.push_back(one.joint);
      const std::string& name = object.joints[static_cast<std::size_t>(one.joint)].name;
      s.report.broken_joints.push_back({ObjectId{o}, one.joint, name});  // World replaces the number by the id
    }
    std::sort(broken.begin(), broken.end());
    set_broken(object, broken, joints);
  });
}

}  // namespace pliant
