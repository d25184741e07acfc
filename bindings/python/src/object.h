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

/// The index of a joint that is given by index or name.
int joint_index(const ObjectView& view, nb::handle joint);

/// Calls `function` with the index or the name of a body.
template <class Function>
auto with_body(nb::handle body, const Function& function) {
  if (nb::isinstance<nb::str>(body)) return function(nb::cast<std::string>(body));
  int index = 0;
  if (PyBool_Check(body.ptr()) != 0 || !nb::try_cast(body, index))
    throw wrong_type("body", body, "the name of a body, or its index");
  return function(index);
}

}  // namespace pliant::python
