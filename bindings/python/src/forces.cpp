// Forces that Python computes on arrays, once a substep and object.
#include "forces.h"

#include <algorithm>
#include <cstring>

#include "arrays.h"
#include "pliant/error.h"

namespace pliant::python {

namespace {

/// The last copy of a force goes where nobody has the GIL.
std::shared_ptr<PythonForce> shared(PythonForce force) {
  return {new PythonForce(std::move(force)), [](PythonForce* last) {
            if (Py_IsInitialized() == 0) return;  // the interpreter has taken the objects along
            const nb::gil_scoped_acquire acquire;
            delete last;
          }};
}

void copy_in(std::span<const Vec3f> from, nb::handle array) {
  const std::size_t shape[2] = {from.size(), 3};
  const Output to(array, shape);
  std::copy(from.begin(), from.end(), to.vectors().begin());
}

void copy_in(std::span<const float> from, nb::handle array) {
  const std::size_t shape[1] = {from.size()};
  const Output to(array, shape);
  std::copy(from.begin(), from.end(), to.floats());
}

/// The arrays of an object of so many particles; made again where an edit has changed the number.
nb::object arrays_for(PythonForce& force, const ForceField::Arrays& given) {
  const nb::str name(std::string(given.object).c_str());
  const std::size_t n = given.positions.size();
  if (force.arrays.contains(name) && nb::len(nb::object(force.arrays[name].attr("masses"))) == n)
    return force.arrays[name];
  const std::size_t shape[2] = {n, 3}, one[1] = {n};
  const nb::object made = python_part("pliant._types", "ForceArrays")(name, new_floats(shape), new_floats(shape),
                                                                      new_floats(one), new_floats(shape));
  force.arrays[name] = made;
  return made;
}

std::string name_of(nb::handle function) {
  const nb::object name = nb::getattr(function, "__qualname__", nb::none());
  return nb::cast<std::string>(nb::str(name.is_none() ? nb::repr(function) : name));
}

/// A function that returns forces would change nothing: it must fill the array.
void require_nothing(nb::handle returned, nb::handle function) {
  if (returned.is_none()) return;
  const auto type = nb::cast<std::string>(nb::object(returned.type().attr("__name__")));
  throw nb::type_error(("the force function '" + name_of(function) + "' returned a value of type " + type +
                        "; fill the array instead, as by arrays.forces[:] = ..., and return nothing")
                           .c_str());
}

/// Calls Python with the GIL. An exception of it passes through World::step as it is.
void call(PythonForce& force, const ForceField::Arrays& given) {
  const nb::gil_scoped_acquire acquire;
  if (!force.function.is_valid()) return;
  if (!force.only.is_none() && nb::cast<std::string>(force.only) != given.object) return;
  const nb::object arrays = arrays_for(force, given);
  copy_in(given.positions, arrays.attr("positions"));
  copy_in(given.velocities, arrays.attr("velocities"));
  copy_in(given.masses, arrays.attr("masses"));  // an object of this name may have been replaced
  copy_in(given.forces, arrays.attr("forces"));
  arrays.attr("time") = given.time;
  const nb::object own = arrays.attr("forces");
  require_nothing(force.function(arrays), force.function);
  const Numbers result(arrays.attr("forces"), 'f', 3, "forces");
  if (result.rows() != given.forces.size())
    throw Error({.object = std::string(given.object)}, "forces has another number of rows than there are particles",
                "fill arrays.forces[:] in place");
  const std::span<const Vec3f> all = result.vectors();
  std::copy(all.begin(), all.end(), given.forces.begin());
  arrays.attr("forces") = own;  // a function may have put an array of its own there
}

ForceField field_of(nb::handle function, nb::handle only, PythonForces& made) {
  if (PyCallable_Check(function.ptr()) == 0) throw wrong_type("a force", function, "a function of pliant.ForceArrays");
  const std::shared_ptr<PythonForce> force = shared({nb::borrow(function), nb::borrow(only), nb::dict()});
  made.push_back(force);
  return ForceField::on_arrays([force](const ForceField::Arrays& arrays) { call(*force, arrays); });
}

void require_object(const Scene& scene, const std::string& name) {
  const bool has =
      std::any_of(scene.objects.begin(), scene.objects.end(), [&](const Object& o) { return o.name == name; });
  if (!has)
    throw Error({}, "forces are given for '" + name + "', which is no object of the scene",
                "use the name of an object");
}

}  // namespace

std::shared_ptr<const SceneFile> with_forces(const std::shared_ptr<const SceneFile>& file, nb::handle forces,
                                             PythonForces& made) {
  if (forces.is_none()) return file;
  auto changed = std::make_shared<SceneFile>(*file);
  if (!nb::isinstance<nb::dict>(forces)) {
    changed->scene.forces.push_back(field_of(forces, nb::none(), made));
    return changed;
  }
  for (const auto& [name, function] : nb::borrow<nb::dict>(forces)) {
    if (!nb::isinstance<nb::str>(name)) throw wrong_type("a name in forces", name, "the name of an object, as str");
    require_object(changed->scene, nb::cast<std::string>(name));
    changed->scene.forces.push_back(field_of(function, name, made));
  }
  return changed;
}

}  // namespace pliant::python
