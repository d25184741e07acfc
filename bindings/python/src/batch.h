// What the files of pliant.Batch share.
#pragma once

#include <cmath>

#include "object.h"

namespace pliant::python {

using Worlds = std::vector<SharedWorld>;

/// The objects of one name in all worlds.
struct BatchObject {
  std::shared_ptr<const Worlds> worlds;
  std::vector<ObjectId> ids;
  std::string name;
  std::size_t particles = 0;

  std::size_t size() const { return ids.size(); }
  ObjectView view(std::size_t i) const { return std::as_const(world(i)).object(ids[i]); }
  ObjectHandle handle(std::size_t i) const { return world(i).object(ids[i]); }
  /// The description in a world, as it is now.
  const Object& present(std::size_t i) const { return (*worlds)[i]->present(ids[i]); }
  /// The handles in all worlds. Throws an Error if a world is stepping or has removed its object.
  std::vector<ObjectHandle> handles() const;

 private:
  World& world(std::size_t i) const;
};

/// The objects of that name. Throws nb::key_error if a world has none, an Error if their numbers of particles differ.
BatchObject batch_object(const std::shared_ptr<const Worlds>& worlds, const std::string& name);

/// True where a World accepts targets and poses of bodies: setters look first, so that they change all worlds or none.
inline bool is_near_origin(const Vec3f& p) {
  return std::fabs(p.x) <= 1e9f && std::fabs(p.y) <= 1e9f && std::fabs(p.z) <= 1e9f;
}

void bind_batch_object(nb::module_& m);
/// BatchObject.poses, set_pose, set_motor, joint_states and the like (batch_joints.cpp).
void bind_batch_joints(nb::class_<BatchObject>& c);

}  // namespace pliant::python
