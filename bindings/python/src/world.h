// What Python's World is: a shared OwnedWorld.
#pragma once

#include "bindings.h"
#include "pliant/error.h"

namespace pliant::python {

struct WorldRef {
  SharedWorld world;
};

/// A scene with one thing, which is to have a name of its own among `taken`.
Description described(const char* list, const nb::dict& members, const nb::list& taken_objects,
                      const nb::list& taken_colliders);

/// The id of a thing. Throws an Error if it is of another World.
template <class Ref>
auto id_here(const WorldRef& self, const Ref& thing) {
  if (!(thing.world == self.world)) throw Error({}, "this is of another World", "pass one of this World");
  return thing.id;
}

/// World.step, run, frames, state and the like (stepping.cpp).
void bind_stepping(nb::module_& m, nb::class_<WorldRef>& c);
/// World.edit (edit.cpp), World.gauges (gauges.cpp).
void bind_editing(nb::class_<WorldRef>& c);
void bind_gauge_reading(nb::class_<WorldRef>& c);
/// World.save, load, writer (files.cpp).
void bind_saving(nb::class_<WorldRef>& c);

}  // namespace pliant::python
