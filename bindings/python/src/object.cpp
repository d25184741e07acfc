// pliant.Object: reads and controls an object of a World between steps.
#include <nanobind/ndarray.h>

#include <limits>

#include "arrays.h"
#include "object.h"
#include "pliant/error.h"

namespace pliant::python {

namespace {

std::vector<Vec3f> read_all(const ObjectRef& self, std::vector<Vec3f> (ObjectView::*read)() const) {
  return (self.view().*read)();
}

nb::object positions(const ObjectRef& self, nb::handle out) {
  const ObjectView view = self.view();
  return filled_vectors(out, self.particles(), [&](std::span<Vec3f> into) { view.read_positions(into); });
}

nb::object velocities(const ObjectRef& self, nb::handle out) {
  const ObjectView view = self.view();
  return filled_vectors(out, self.particles(), [&](std::span<Vec3f> into) { view.read_velocities(into); });
}

/// Keeps a World alive, and where it is, for a view of its records.
struct ViewToken {
  explicit ViewToken(SharedWorld of) : world(std::move(of)) { ++world->views; }
  ~ViewToken() { --world->views; }
  ViewToken(const ViewToken&) = delete;
  ViewToken& operator=(const ViewToken&) = delete;
  SharedWorld world;
};

nb::object records(const ObjectRef& self, std::span<const Record> (ObjectView::*read)() const) {
  const std::span<const Record> all = (self.view().*read)();
  if (self.world->comes_apart())
    throw Error({.object = self.name()}, "records move in memory, because an object tears, is cut or can break",
                "read positions()");
  auto* token = new ViewToken(self.world);
  const nb::capsule owner(token, [](void* p) noexcept { delete static_cast<ViewToken*>(p); });
  const std::size_t shape[2] = {all.size(), 4};
  return nb::cast(
      nb::ndarray<nb::numpy, const float, nb::ndim<2>>(all.empty() ? nullptr : &all.front().x, 2, shape, owner));
}

nb::tuple mesh(const ObjectRef& self) {
  const TriangleMesh mesh = self.view().mesh();
  const int* triangles = mesh.triangles.empty() ? nullptr : mesh.triangles.front().data();
  return nb::make_tuple(vectors(mesh.positions), int_rows(triangles, mesh.triangles.size(), 3));
}

nb::object channel(const ObjectRef& self, const std::string& name) {
  const std::vector<float> values = self.view().channel(name);
  if (values.empty())
    throw Error({.object = self.name()}, "has no channel '" + name + "'",
                "gases have \"temperature\", wet cloth \"water\"");
  return float_rows(values.data(), values.size(), 0);
}

nb::dict constraints(const ObjectRef& self) {
  nb::dict dict;
  for (const auto& [type, count] : self.view().info().constraints) dict[type.c_str()] = count;
  return dict;
}

nb::object multipliers(const ObjectRef& self, const std::string& type) {
  const std::map<std::string, int> known = [&] {
    const auto found = self.view().info().constraints;
    return std::map<std::string, int>(found.begin(), found.end());
  }();
  if (!known.contains(type)) {
    std::string names;
    for (const auto& [name, count] : known) names += (names.empty() ? "'" : ", '") + name + "'";
    throw Error({.object = self.name()}, "has no constraints of the type '" + type + "'",
                names.empty() ? "it has none" : "it has " + names);
  }
  const std::vector<float> all = self.view().multipliers(type);
  return float_rows(all.data(), all.size(), 0);
}

nb::object orientations(const ObjectRef& self) {
  const std::vector<Quatf> all = self.view().orientations();
  return float_rows(reinterpret_cast<const float*>(all.data()), all.size(), 4);
}

float float_from(nb::handle given, const char* what) { return static_cast<float>(number_from(given, what)); }

/// The name of a joint that was given by name or index.
std::string joint_name(const ObjectRef& self, nb::handle joint) {
  if (nb::isinstance<nb::str>(joint)) return nb::cast<std::string>(joint);
  const auto index = static_cast<std::size_t>(joint_index(self.view(), joint));
  const std::vector<ObjectJoint>& joints = self.world->described(self.id).joints;
  if (index < joints.size()) return joints[index].name;
  throw Error({.object = self.name(), .element = "joint " + nb::cast<std::string>(nb::str(joint))},
              "does not exist; there are " + std::to_string(joints.size()) + " joints", "indices count from 0");
}

void set_motor(const ObjectRef& self, nb::handle joint, nb::handle target, nb::handle most, const std::string& motor) {
  MotorCommand command;
  command.target = float_from(target, "target");
  if (!most.is_none()) command.most = float_from(most, "most");
  command.motor = motor;
  self.handle().set_motor(joint_name(self, joint), command);
}

int joint_of(const ObjectRef& self, nb::handle joint) { return joint_index(self.view(), joint); }

nb::object load_object(const JointLoad& load) {
  return python_part("pliant._types", "Load")(tuple_of(load.force), tuple_of(load.torque));
}

nb::object joint_state(const ObjectRef& self, nb::handle joint) {
  const JointState state = self.view().joint_state(joint_of(self, joint));
  return python_part("pliant._types", "JointState")(tuple_of(state.displacement), tuple_of(state.rotation),
                                                    tuple_of(state.velocity), tuple_of(state.angular_velocity));
}

std::string object_repr(const ObjectRef& self) {
  if (!self.world->idle().has(self.id)) return "<pliant.Object: removed>";
  return "<pliant.Object '" + self.name() + "': " + std::to_string(self.particles()) + " particles>";
}

void bind_reading(nb::class_<ObjectRef>& c) {
  c.def("positions", &positions, nb::arg("out") = nb::none(),
        nb::sig("def positions(self, out: pliant._types.FloatArray | None = None) -> pliant._types.FloatArray"),
        "Positions of the particles in the order of the mesh [m], shape (particles, 3).\n\n`out`: a C-contiguous "
        "float32 "
        "array to fill; "
        "other arrays raise Error.")
      .def("velocities", &velocities, nb::arg("out") = nb::none(),
           nb::sig("def velocities(self, out: pliant._types.FloatArray | None = None) -> pliant._types.FloatArray"),
           "Velocities of the particles in the order of the mesh [m/s], shape (particles, 3). `out` as in positions().")
      .def(
          "records", [](const ObjectRef& o) { return records(o, &ObjectView::positions_in_storage_order); },
          nb::sig("def records(self) -> pliant._types.FloatArray"),
          "A read-only view, without a copy, of x, y, z [m] and inverse mass [1/kg] of each particle in storage order: "
          "record i is "
          "particle storage_order()[i]. It keeps its World alive, and shows another state after each step. While it "
          "lives, "
          "nothing can be "
          "added to, removed from, edited or restored in the World. Indices from `particles` on are targets of "
          "attachments.")
      .def(
          "velocity_records", [](const ObjectRef& o) { return records(o, &ObjectView::velocities_in_storage_order); },
          nb::sig("def velocity_records(self) -> pliant._types.FloatArray"),
          "The same for velocities [m/s]; the fourth number is zero.")
      .def(
          "storage_order", [](const ObjectRef& o) { return integers(o.view().storage_order()); },
          nb::sig("def storage_order(self) -> pliant._types.IntArray"), "The particle of each record.")
      .def("mesh", &mesh, nb::sig("def mesh(self) -> pliant._types.Mesh"),
           "The surface at its present positions: (vertices [m], triangles).")
      .def("orientations", &orientations, nb::sig("def orientations(self) -> pliant._types.FloatArray"),
           "Orientations of bodies and rods as unit quaternions (x, y, z, w), shape (frames, 4).")
      .def(
          "angular_velocities",
          [](const ObjectRef& o) { return vectors(read_all(o, &ObjectView::angular_velocities)); },
          nb::sig("def angular_velocities(self) -> pliant._types.FloatArray"),
          "Their angular velocities in world axes [rad/s], shape (frames, 3).")
      .def("channel", &channel, nb::arg("name"), nb::sig("def channel(self, name: str) -> pliant._types.FloatArray"),
           "A value for each particle, as \"temperature\" [K] of a gas. Raises Error if there is none of that name.")
      .def(
          "present", [](const ObjectRef& o) { return integers(o.view().present()); },
          nb::sig("def present(self) -> pliant._types.IntArray"),
          "The particles that are there: all, unless particles of the object are emitted, drained or expire.")
      .def(
          "enclosed_volume", [](const ObjectRef& o) { return o.view().enclosed_volume(); },
          "Volume that its triangles enclose [m^3].")
      .def("multipliers", &multipliers, nb::arg("type"),
           nb::sig("def multipliers(self, type: str) -> pliant._types.FloatArray"),
           "Multipliers of the last substep of the constraints of a type, as \"distance\", in the order of their "
           "groups. Those of distances with compliance are always stored, others if settings.record_multipliers is "
           "set; what is not stored gives an empty array. A multiplier over the square of the substep [s^2] is the "
           "force along the gradient. Raises Error if it has no constraints of the type: `constraints` lists them.");
}

void bind_joints(nb::class_<ObjectRef>& c) {
  c.def(
       "pose",
       [](const ObjectRef& o, nb::handle body) {
         return with_body(body, [&](const auto& b) { return pose_object(o.view().pose(b)); });
       },
       nb::arg("body") = 0, nb::sig("def pose(self, body: int | str = 0) -> pliant._types.Pose"),
       "Pose of a rigid body, by index or name: position [m] and rotation (x, y, z, w) of the frame in which it was "
       "described.")
      .def(
          "body_is_asleep", [](const ObjectRef& o, int body) { return o.view().body_is_asleep(body); }, nb::arg("body"),
          "True if the rigid body of this index sleeps.")
      .def("joint_state", &joint_state, nb::arg("joint"),
           nb::sig("def joint_state(self, joint: int | str) -> pliant._types.JointState"),
           "Angles, displacements and speeds of a joint, by index or name, as they are now.")
      .def(
          "joint_load",
          [](const ObjectRef& o, nb::handle joint) { return load_object(o.view().joint_load(joint_of(o, joint))); },
          nb::arg("joint"), nb::sig("def joint_load(self, joint: int | str) -> pliant._types.Load"),
          "(force [N], torque [N m]) that a joint carried in the last substep, in world axes; zero if it is broken. It "
          "oscillates "
          "from substep to substep: see mean_joint_load().")
      .def(
          "mean_joint_load",
          [](const ObjectRef& o, nb::handle joint) {
            return load_object(o.view().mean_joint_load(joint_of(o, joint)));
          },
          nb::arg("joint"), nb::sig("def mean_joint_load(self, joint: int | str) -> pliant._types.Load"),
          "Its mean over the last frame. Raises Error unless World.record_joint_loads() is on.")
      .def(
          "joint_is_broken",
          [](const ObjectRef& o, nb::handle joint) { return o.view().joint_is_broken(joint_of(o, joint)); },
          nb::arg("joint"), nb::sig("def joint_is_broken(self, joint: int | str) -> bool"),
          "True if a joint has broken.");
}

void bind_control_of_bodies(nb::class_<ObjectRef>& c) {
  c.def(
       "set_pose",
       [](const ObjectRef& o, nb::handle body, nb::handle position, nb::handle rotation) {
         const RigidPose pose = pose_from(position, rotation);
         with_body(body, [&](const auto& b) { o.handle().set_pose(b, pose); });
       },
       nb::arg("body"), nb::arg("position"), nb::arg("rotation") = nb::make_tuple(0, 0, 0, 1),
       nb::sig("def set_pose(self, body: int | str, position: pliant._types.VectorLike, rotation: "
               "pliant._types.VectorLike = (0, 0, 0, 1)) -> None"),
       "Moves a kinematic body, by index or name, to a pose that it reaches at the end of the next step [m].")
      .def(
          "set_surface_velocity",
          [](const ObjectRef& o, nb::handle body, nb::handle velocity) {
            const Vec3f v = vector_from(velocity, "velocity");
            with_body(body, [&](const auto& b) { o.handle().set_surface_velocity(b, v); });
          },
          nb::arg("body"), nb::arg("velocity"),
          nb::sig("def set_surface_velocity(self, body: int | str, velocity: pliant._types.VectorLike) -> None"),
          "Gives the surface of a body a velocity along itself, as a conveyor belt has, in the body's frame [m/s].")
      .def("set_motor", &set_motor, nb::arg("joint"), nb::arg("target"), nb::arg("most") = nb::none(),
           nb::arg("motor") = "",
           nb::sig("def set_motor(self, joint: int | str, target: float, most: float | None = None, motor: str = '') "
                   "-> None"),
           "Gives the motor of a joint a new target: an angle [rad], displacement [m] or speed [rad/s or m/s], as its "
           "kind "
           "says. `most`: "
           "greatest torque [N m] or force [N]; None: as before. `motor`: its name if the joint has several.")
      .def(
          "set_rest_factor",
          [](const ObjectRef& o, int group, nb::handle factor) {
            o.handle().set_rest_factor(group, float_from(factor, "factor"));
          },
          nb::arg("group"), nb::arg("factor"), nb::sig("def set_rest_factor(self, group: int, factor: float) -> None"),
          "Multiplies rest lengths or volumes of a group of constraints by a factor >= 0, as a muscle's activation "
          "does.");
}

void bind_control(nb::class_<ObjectRef>& c) {
  c.def(
       "set_targets",
       [](const ObjectRef& o, nb::handle particles, nb::handle positions) {
         const Numbers which(particles, 'i', 0, "particles"), to(positions, 'f', 3, "positions");
         o.handle().set_targets(which.integers(), to.vectors());
       },
       nb::arg("particles"), nb::arg("positions"),
       nb::sig(
           "def set_targets(self, particles: pliant._types.IntsLike, positions: pliant._types.VectorsLike) -> None"),
       "Moves pinned particles at constant velocity to `positions` [m], which they reach at the end of the next step.")
      .def(
          "set_attachment_targets",
          [](const ObjectRef& o, nb::handle attachments, nb::handle positions) {
            const Numbers which(attachments, 'i', 0, "attachments"), to(positions, 'f', 3, "positions");
            o.handle().set_attachment_targets(which.integers(), to.vectors());
          },
          nb::arg("attachments"), nb::arg("positions"),
          nb::sig("def set_attachment_targets(self, attachments: pliant._types.IntsLike, positions: "
                  "pliant._types.VectorsLike) -> None"),
          "Moves the targets of attachments, by index, in the same way [m].")
      .def(
          "set_velocities",
          [](const ObjectRef& o, nb::handle velocities) {
            o.handle().set_velocities(Numbers(velocities, 'f', 3, "velocities").vectors());
          },
          nb::arg("velocities"), nb::sig("def set_velocities(self, velocities: pliant._types.VectorsLike) -> None"),
          "Sets the velocity of each particle [m/s], shape (particles, 3); pinned ones are skipped.")
      .def(
          "add_impulses",
          [](const ObjectRef& o, nb::handle impulses) {
            o.handle().add_impulses(Numbers(impulses, 'f', 3, "impulses").vectors());
          },
          nb::arg("impulses"), nb::sig("def add_impulses(self, impulses: pliant._types.VectorsLike) -> None"),
          "Adds an impulse to each particle [N s], shape (particles, 3): velocity += impulse / mass.")
      .def(
          "set_forces",
          [](const ObjectRef& o, nb::handle forces) {
            o.handle().set_forces(Numbers(forces, 'f', 3, "forces").vectors());
          },
          nb::arg("forces"), nb::sig("def set_forces(self, forces: pliant._types.VectorsLike) -> None"),
          "Applies a constant force to each particle during the next step [N], shape (particles, 3). Replaces those of "
          "an "
          "earlier call.")
      .def(
          "teleport",
          [](const ObjectRef& o, nb::handle position, nb::handle rotation) {
            o.handle().teleport(pose_from(position, rotation));
          },
          nb::arg("position") = nb::make_tuple(0, 0, 0), nb::arg("rotation") = nb::make_tuple(0, 0, 0, 1),
          nb::sig(
              "def teleport(self, position: pliant._types.VectorLike = (0, 0, 0), rotation: pliant._types.VectorLike = "
              "(0, 0, 0, 1)) -> None"),
          "Moves the whole object at once: each point is rotated about the origin by `rotation` (x, y, z, w), then "
          "moved "
          "by `position` "
          "[m]. Raises Error if a pin or attachment with keyframes would stay behind.");
}

}  // namespace

std::size_t ObjectRef::particles() const { return static_cast<std::size_t>(view().particle_count()); }
std::string ObjectRef::name() const { return view().name(); }

int joint_index(const ObjectView& view, nb::handle joint) {
  if (nb::isinstance<nb::str>(joint)) return view.joint_index(nb::cast<std::string>(joint));
  int index = 0;
  if (PyBool_Check(joint.ptr()) != 0 || !nb::try_cast(joint, index))
    throw wrong_type("joint", joint, "the name of a joint, or its index");
  return index;
}

void bind_object(nb::module_& m) {
  nb::class_<ObjectRef> c(
      m, "Object", nb::type_slots(collected_slots<ObjectRef>()),
      "An object of a World, to read and control between steps: world[\"name\"]. It keeps its World "
      "alive. All functions raise "
      "Error after it was removed, and while the World steps in another thread.");
  c.def_prop_ro("name", &ObjectRef::name, "Its name.")
      .def_prop_ro("particles", &ObjectRef::particles, "Number of its particles.")
      .def_prop_ro(
          "substeps", [](const ObjectRef& o) { return o.view().info().substeps; },
          "Substeps a frame; 0: they follow the state.")
      .def_prop_ro("constraints", &constraints, nb::sig("def constraints(self) -> dict[str, int]"),
                   "Number of its constraints of each type.")
      .def_prop_ro(
          "exists", [](const ObjectRef& o) { return o.world->idle().has(o.id); }, "False after it was removed.")
      .def("__len__", &ObjectRef::particles, "Number of its particles.")
      .def("__repr__", &object_repr);
  bind_reading(c);
  bind_joints(c);
  bind_control(c);
  bind_control_of_bodies(c);
}

}  // namespace pliant::python
