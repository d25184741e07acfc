// An object of a World during a call.
#pragma once

#include "pliant/object.h"
#include "world_handle.h"

namespace pliant::c {

/// Holds the World while one of its objects is used. Throws a StatusError if the handle or id is stale.
class ObjectUse {
 public:
  ObjectUse(const pliant_world* world, pliant_id id)
      : world_(at(world)), handle_(world_->world.object(object_id(world_->world, id))) {}
  ObjectHandle& object() const { return handle_; }
  const WorldHandle& world() const { return *world_; }

 private:
  std::shared_ptr<WorldHandle> world_;
  mutable ObjectHandle handle_;
};

}  // namespace pliant::c
