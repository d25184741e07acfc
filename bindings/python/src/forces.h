// Forces that Python computes on arrays.
#pragma once

#include <memory>
#include <vector>

#include "bindings.h"

namespace pliant::python {

/// A callable, and the arrays that it gets for each object: our own, so that what a function keeps of them never
/// dangles.
struct PythonForce {
  nb::object function;  ///< null once Python's garbage collector has taken it
  nb::object only;      ///< name of the object; None: all
  nb::dict arrays;      ///< pliant.ForceArrays by name of object
};
using PythonForces = std::vector<std::shared_ptr<PythonForce>>;

/// The scene with forces that call Python: a callable for all objects, or a dict of callables by name of object. None:
/// the scene itself. Throws nb::type_error, or an Error if an object does not exist.
std::shared_ptr<const SceneFile> with_forces(const std::shared_ptr<const SceneFile>& file, nb::handle forces,
                                             PythonForces& made);

}  // namespace pliant::python
