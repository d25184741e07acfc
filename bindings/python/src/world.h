// What Python's World is: a shared OwnedWorld.
#pragma once

#include "bindings.h"

namespace pliant::python {

struct WorldRef {
  SharedWorld world;
};

/// World.save, load, writer (files.cpp).
void bind_saving(nb::class_<WorldRef>& c);

}  // namespace pliant::python
