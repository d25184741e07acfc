// Bodies and joints of the objects of a Batch, as arrays: poses, motors, states and loads of joints.
#include <algorithm>
#include <cmath>

#include "arrays.h"
#include "batch.h"
#include "pliant/error.h"

namespace pliant::python {

namespace {

/// Bodies or joints that a caller names: one, or a list of them.
struct Which {
  std::vector<nb::object> all;
  bool is_list = false;
};

Which which_of(nb::handle given, const char* what) {
  int index = 0;
  if (nb::isinstance<nb::str>(given) || (PyBool_Check(given.ptr()) == 0 && nb::try_cast(given, index)))
    return {{nb::borrow(given)}, false};
  Which which{{}, true};
  if (PySequence_Check(given.ptr()) == 0 || nb::isinstance<nb::bytes>(given) || nb::isinstance<nb::dict>(given))
    throw wrong_type(what, given, "a name, an index, or a list of them");
  const auto count = PySequence_Size(given.ptr());
  if (count < 0) throw nb::python_error();
  which.all.reserve(static_cast<std::size_t>(count));
  for (const nb::handle one : given) which.all.push_back(nb::borrow(one));
  return which;
}

/// A new array of shape (worlds, columns), or (worlds, things, columns) for a list of things.
class Table {
 public:
  Table(std::size_t worlds, const Which& which, std::size_t columns) {
    const std::size_t flat[2] = {worlds, columns}, deep[3] = {worlds, which.all.size(), columns};
    const std::span<const std::size_t> shape = which.is_list ? std::span<const std::size_t>(deep) : flat;
    array_ = new_floats(shape);
    to_ = Output(array_, shape).floats();
  }
  void add(const Vec3f& v) {
    for (const float value : {v.x, v.y, v.z}) *to_++ = value;
  }
  void add(const Quatf& q) {
    for (const float value : {q.x, q.y, q.z, q.w}) *to_++ = value;
  }
  const nb::object& array() const { return array_; }

 private:
  nb::object array_;
  float* to_ = nullptr;
};

/// Motors refuse targets above it: joint::no_limit of the engine.
constexpr float largest_target = 1e30f;

/// Calls body(view, thing) for each world and thing.
template <class Body>
void for_each(const BatchObject& self, const Which& which, const Body& body) {
  for (std::size_t i = 0; i < self.size(); ++i) {
    const ObjectView view = self.view(i);
    for (const nb::object& thing : which.all) body(view, thing);
  }
}

nb::tuple poses(const BatchObject& self, nb::handle body) {
  const Which which = which_of(body, "body");
  Table positions(self.size(), which, 3), rotations(self.size(), which, 4);
  for_each(self, which, [&](const ObjectView& view, nb::handle one) {
    const RigidPose pose = with_body(one, [&](const auto& b) { return view.pose(b); });
    positions.add(pose.position);
    rotations.add(pose.rotation);
  });
  return nb::make_tuple(positions.array(), rotations.array());
}

nb::object joint_states(const BatchObject& self, nb::handle joint) {
  const Which which = which_of(joint, "joint");
  const std::size_t n = self.size();
  Table displacement(n, which, 3), rotation(n, which, 3), velocity(n, which, 3), angular_velocity(n, which, 3);
  for_each(self, which, [&](const ObjectView& view, nb::handle one) {
    const JointState state = view.joint_state(joint_index(view, one));
    displacement.add(state.displacement);
    rotation.add(state.rotation);
    velocity.add(state.velocity);
    angular_velocity.add(state.angular_velocity);
  });
  return python_part("pliant._types", "JointStates")(displacement.array(), rotation.array(), velocity.array(),
                                                     angular_velocity.array());
}

/// joint_loads or mean_joint_loads.
auto loads(JointLoad (ObjectView::*read)(int) const) {
  return [read](const BatchObject& self, nb::handle joint) {
    const Which which = which_of(joint, "joint");
    Table force(self.size(), which, 3), torque(self.size(), which, 3);
    for_each(self, which, [&](const ObjectView& view, nb::handle one) {
      const JointLoad load = (view.*read)(joint_index(view, one));
      force.add(load.force);
      torque.add(load.torque);
    });
    return python_part("pliant._types", "Loads")(force.array(), torque.array());
  };
}

/// Numbers that were given for each world and thing, or one number for all.
std::vector<float> spread(nb::handle given, std::size_t worlds, const Which& which, const char* what) {
  const std::size_t count = worlds * which.all.size();
  double one = 0;
  if (PyBool_Check(given.ptr()) == 0 && PyObject_Size(given.ptr()) < 0) {  // of no length: a number
    PyErr_Clear();
    if (nb::try_cast(given, one)) return std::vector<float>(count, static_cast<float>(one));
  }
  const Numbers numbers(given, 'f', which.is_list ? static_cast<int>(which.all.size()) : 0, what);
  if (numbers.rows() != worlds)
    throw Error({}, std::string(what) + " has " + std::to_string(numbers.rows()) + " rows",
                "pass one for each of " + std::to_string(worlds) + " worlds, or one number for all");
  return {numbers.floats(), numbers.floats() + count};
}

/// Throws an Error unless a predicate holds for all numbers.
template <class Predicate>
void require_all(const BatchObject& self, const std::vector<float>& numbers, const char* what, const Predicate& holds,
                 const char* advice) {
  const auto bad = std::find_if_not(numbers.begin(), numbers.end(), holds);
  if (bad == numbers.end()) return;
  const auto world = static_cast<std::size_t>(bad - numbers.begin()) / (numbers.size() / self.size());
  throw Error({.object = self.name},
              std::string(what) + " of world " + std::to_string(world) + " is " +
                  (std::isfinite(*bad) ? repr_of(nb::float_(static_cast<double>(*bad))) : "not finite"),
              advice);
}

/// True if an object has a motor that accepts a command.
bool has_motor(const Object& object, const std::string& joint, const MotorCommand& command) {
  const auto found = std::find_if(object.joints.begin(), object.joints.end(),
                                  [&](const ObjectJoint& one) { return one.name == joint; });
  if (found == object.joints.end()) return false;
  const std::vector<ObjectJointMotor>& motors = found->motors;
  const auto motor = command.motor.empty() && motors.size() == 1
                         ? motors.begin()
                         : std::find_if(motors.begin(), motors.end(),
                                        [&](const ObjectJointMotor& one) { return one.name == command.motor; });
  if (motor == motors.end() || (motor->is_torque && command.most)) return false;
  return std::fabs(command.target) <= largest_target;
}

void set_motor(const BatchObject& self, nb::handle joint, nb::handle targets, nb::handle most,
               const std::string& motor) {
  const Which which = which_of(joint, "joint");
  if (which.all.empty()) throw Error({}, "joint is an empty list", "name one joint or more");
  std::vector<std::string> names;
  names.reserve(which.all.size());
  for (const nb::object& one : which.all) {
    if (!nb::isinstance<nb::str>(one)) throw wrong_type("joint", one, "the name of a joint, or a list of names");
    names.push_back(nb::cast<std::string>(one));
  }
  const std::vector<float> to = spread(targets, self.size(), which, "targets");
  const std::vector<float> at_most = most.is_none() ? std::vector<float>{} : spread(most, self.size(), which, "most");
  require_all(
      self, to, "the target", [](float t) { return std::isfinite(t); }, "give finite numbers");
  require_all(
      self, at_most, "most", [](float m) { return m > 0; }, "give numbers above 0");
  const auto command = [&](std::size_t i, std::size_t k) {
    const std::size_t at = i * names.size() + k;
    return MotorCommand{to[at], at_most.empty() ? std::optional<float>{} : at_most[at], motor};
  };
  std::vector<ObjectHandle> handles = self.handles();
  for (std::size_t i = 0; i < handles.size(); ++i)  // what refuses says so before another motor is changed
    for (std::size_t k = 0; k < names.size(); ++k)
      if (!has_motor(self.present(i), names[k], command(i, k))) handles[i].set_motor(names[k], command(i, k));
  for (std::size_t i = 0; i < handles.size(); ++i)
    for (std::size_t k = 0; k < names.size(); ++k) handles[i].set_motor(names[k], command(i, k));
}

/// The rows of an array of shape (worlds, columns), or (columns,) for all worlds.
nb::object rows_of_worlds(nb::handle given, std::size_t worlds, std::size_t columns, const char* what) {
  nb::object array;
  try {
    array = nb::module_::import_("numpy").attr("asarray")(given);
  } catch (nb::python_error&) {
    throw Error({}, std::string(what) + " are no array of numbers", "pass a numpy array");
  }
  const std::string shape = nb::cast<std::string>(nb::str(nb::object(array.attr("shape"))));
  const nb::tuple wanted = nb::make_tuple(worlds, columns), one = nb::make_tuple(columns);
  if (array.attr("shape").equal(one)) return nb::module_::import_("numpy").attr("broadcast_to")(array, wanted);
  if (array.attr("shape").equal(wanted)) return array;
  throw Error({}, std::string(what) + " have the shape " + shape,
              "pass " + nb::cast<std::string>(nb::str(wanted)) + ", or " + nb::cast<std::string>(nb::str(one)) +
                  " for all worlds");
}

/// Throws an Error unless a body is kinematic in all worlds, so that set_pose() moves it in all or none.
void require_kinematic(const BatchObject& self, nb::handle body) {
  for (std::size_t i = 0; i < self.size(); ++i) {
    (void)with_body(body, [&](const auto& b) { return self.view(i).pose(b); });
    const Object& object = self.present(i);
    for (std::size_t b = 0; b < object.bodies.size(); ++b) {
      const bool is_it = nb::isinstance<nb::str>(body) ? nb::str(object.bodies[b].name.c_str()).equal(body)
                                                       : nb::cast<std::size_t>(body) == b;
      const auto particle = static_cast<std::size_t>(object.bodies[b].particle);
      const bool is_pinned = std::any_of(object.pins.begin(), object.pins.end(),
                                         [&](const Pin& pin) { return pin.particle == object.bodies[b].particle; });
      if (is_it && !is_pinned && std::isfinite(object.masses[particle]))
        throw Error({.object = self.name, .element = "body " + nb::cast<std::string>(nb::str(body))},
                    "is dynamic in world " + std::to_string(i), "make it kinematic: \"kinematic\": true in the scene");
    }
  }
}

void set_pose(const BatchObject& self, nb::handle body, nb::handle positions, nb::handle rotations) {
  const std::size_t n = self.size();
  const Numbers to(rows_of_worlds(positions, n, 3, "positions"), 'f', 3, "positions");
  const Numbers turned(rows_of_worlds(rotations, n, 4, "rotations"), 'f', 4, "rotations");
  const std::span<const Vec3f> at = to.vectors();
  const auto is_finite = [](float f) { return std::isfinite(f); };
  for (std::size_t i = 0; i < n; ++i) {
    const float* q = turned.floats() + 4 * i;
    const std::string element = "world " + std::to_string(i);
    if (!is_finite(at[i].x) || !is_finite(at[i].y) || !is_finite(at[i].z) || !std::all_of(q, q + 4, is_finite))
      throw Error({.object = self.name, .element = element}, "the pose is not finite", "give finite numbers");
    if (!is_near_origin(at[i]))
      throw Error({.object = self.name, .element = element}, "the pose is more than 1e9 m from the origin",
                  "give metres");
    const float square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];  // as World::set_pose refuses it
    if (!(square > 1e-30f) || !std::isfinite(square))
      throw Error({.object = self.name, .element = element},
                  square > 1 ? "the rotation is too large" : "the rotation is zero",
                  "give a unit quaternion such as (0, 0, 0, 1)");
  }
  require_kinematic(self, body);
  std::vector<ObjectHandle> handles = self.handles();
  for (std::size_t i = 0; i < n; ++i) {
    const float* q = turned.floats() + 4 * i;
    with_body(body, [&](const auto& b) { handles[i].set_pose(b, {at[i], {q[0], q[1], q[2], q[3]}}); });
  }
}

}  // namespace

void bind_batch_joints(nb::class_<BatchObject>& c) {
  c.def("poses", &poses, nb::arg("body") = 0,
        nb::sig("def poses(self, body: int | str | collections.abc.Sequence[int | str] = 0) -> "
                "tuple[pliant._types.FloatArray, pliant._types.FloatArray]"),
        "Poses of a rigid body: positions [m], shape (worlds, 3), and rotations (x, y, z, w), shape (worlds, 4). Of a "
        "list of k bodies: (worlds, k, 3) and (worlds, k, 4).")
      .def("set_pose", &set_pose, nb::arg("body"), nb::arg("positions"),
           nb::arg("rotations") = nb::make_tuple(0, 0, 0, 1),
           nb::sig(
               "def set_pose(self, body: int | str, positions: pliant._types.VectorLike | pliant._types.VectorsLike, "
               "rotations: pliant._types.VectorLike | pliant._types.VectorsLike = (0, 0, 0, 1)) -> None"),
           "As Object.set_pose(): positions of shape (worlds, 3) [m] and rotations of shape (worlds, 4), or one for "
           "all worlds.")
      .def("set_motor", &set_motor, nb::arg("joint"), nb::arg("targets"), nb::arg("most") = nb::none(),
           nb::arg("motor") = "",
           nb::sig(
               "def set_motor(self, joint: str | collections.abc.Sequence[str], targets: float | "
               "pliant._types.VectorLike | "
               "pliant._types.VectorsLike, most: float | pliant._types.VectorLike | pliant._types.VectorsLike | None = "
               "None, motor: str = '') -> None"),
           "As Object.set_motor(), with a target for each world, shape (worlds,), or one for all. Of a list of k "
           "joints: shape (worlds, k), or one for all. `most` likewise.")
      .def("joint_states", &joint_states, nb::arg("joint"),
           nb::sig("def joint_states(self, joint: int | str | collections.abc.Sequence[int | str]) -> "
                   "pliant._types.JointStates"),
           "Object.joint_state() in all worlds: arrays of shape (worlds, 3), or (worlds, k, 3) of a list of k joints.")
      .def("joint_loads", loads(&ObjectView::joint_load), nb::arg("joint"),
           nb::sig(
               "def joint_loads(self, joint: int | str | collections.abc.Sequence[int | str]) -> pliant._types.Loads"),
           "Object.joint_load() in all worlds: arrays of shape (worlds, 3), or (worlds, k, 3) of a list of k joints.")
      .def("mean_joint_loads", loads(&ObjectView::mean_joint_load), nb::arg("joint"),
           nb::sig("def mean_joint_loads(self, joint: int | str | collections.abc.Sequence[int | str]) -> "
                   "pliant._types.Loads"),
           "Object.mean_joint_load() likewise. Raises Error unless Batch.record_joint_loads() is on.");
}

}  // namespace pliant::python
