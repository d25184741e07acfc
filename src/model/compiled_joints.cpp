#include "model/compiled_joints.h"

#include <map>
#include <utility>

#include "constraints/registry.h"
#include "model/compiled_object.h"
#include "pliant/error.h"

namespace pliant {

namespace {

/// Where the constraints of each type are, by their number among the object's constraints of that type.
using Places = std::map<std::pair<int, int>, CompiledJoint::Part>;

void add_places(const Pool& pool, const Segment& segment, Places& places) {
  const std::int32_t* index = pool.indices.data() + segment.index_offset;
  for (int b = 0; b < segment.batches; ++b, index += indices_per_batch(pool, segment)) {
    for (int lane = 0; lane < batch_width; ++lane) {
      if (!lane_is_valid(segment, b, lane)) continue;
      CompiledJoint::Part part{segment.pool, std::int64_t{segment.first_batch} + b, lane, {}};
      for (int slot = 0; slot < pool.stencil; ++slot)
        part.slots[static_cast<std::size_t>(slot)] = particle_of(segment, index, slot, lane);
      places[{pool.type, pool.origin[static_cast<std::size_t>(part.batch * batch_width + lane)]}] = part;
    }
  }
}

Places places_of(const CompiledObject& object) {
  Places places;
  for (const Segment& segment : object.segments) {
    const Pool& pool = object.pools[static_cast<std::size_t>(segment.pool)];
    if (!pool.in_lanes) add_places(pool, segment, places);  // joints have frames
  }
  return places;
}

/// The type of each group, and how many constraints of that type earlier groups have.
std::vector<std::pair<int, int>> first_numbers(const Object& object) {
  std::vector<std::pair<int, int>> first;
  std::map<int, int> counts;
  for (const ConstraintGroup& group : object.constraints) {
    const int type = find_constraint_type(group.type);
    first.emplace_back(type, counts[type]);
    counts[type] += static_cast<int>(group.particles.size() / constraint_type(type).slots.size());
  }
  return first;
}

[[noreturn]] void refuse(const Object& object, const ObjectJoint& joint, const std::string& problem) {
  throw Error({.object = object.name, .element = "joint '" + joint.name + "'"}, problem, "make joints by add_joint");
}

}  // namespace

std::vector<CompiledJoint> compile_joints(const Object& object, const CompiledObject& compiled) {
  std::vector<CompiledJoint> out;
  if (object.joints.empty()) return out;
  const Places places = places_of(compiled);
  const auto first = first_numbers(object);
  for (const ObjectJoint& joint : object.joints) {
    if (joint.b < 0 || static_cast<std::size_t>(joint.b) >= object.bodies.size())
      refuse(object, joint, "has a body that does not exist");
    const ObjectBody& body = object.bodies[static_cast<std::size_t>(joint.b)];
    CompiledJoint made{joint.name,
                       compiled.place[static_cast<std::size_t>(body.particle)],
                       body.frame,
                       joint.anchor,
                       joint.break_force,
                       joint.break_torque,
                       {}};
    for (const auto& [group, index] : joint.constraints) {
      if (group < 0 || static_cast<std::size_t>(group) >= first.size())
        refuse(object, joint, "has a group that does not exist");
      const auto& [type, before] = first[static_cast<std::size_t>(group)];
      const auto found = places.find({type, before + index});
      if (found == places.end()) refuse(object, joint, "has a constraint that does not exist");
      made.parts.push_back(found->second);
    }
    out.push_back(std::move(made));
  }
  return out;
}

}  // namespace pliant
