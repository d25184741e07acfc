// A reference from Python to an object of a World.
#pragma once

#include "bindings.h"
#include "pliant/edit.h"

namespace pliant::python {

struct ObjectRef {
  SharedWorld world;
  ObjectId id;

  ObjectView view() const { return std::as_const(world->idle()).object(id); }
  ObjectHandle handle() const { return world->idle().object(id); }
  std::size_t particles() const;
  std::string name() const;
};

}  // namespace pliant::python
