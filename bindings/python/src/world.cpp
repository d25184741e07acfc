// pliant.World: what is in it, and what is recorded and measured (stepping.cpp steps it).

#include "world.h"
#include "colliders.h"
#include "forces.h"
#include "object.h"
#include "pliant/describe.h"
#include "pliant/error.h"

namespace pliant::python {

namespace {

nb::list names_in(const std::map<ObjectId, std::string>& names) {
  nb::list list;
  for (const auto& [id, name] : names) list.append(name);
  return list;
}

nb::list collider_names(const Names& names) {
  nb::list list;
  for (const auto& [id, name] : names.colliders) list.append(name);
  for (const auto& [id, name] : names.mesh_colliders) list.append(name);
  return list;
}

ObjectRef object_named(const WorldRef& self, const std::string& name) { return {self.world, self.world->object(name)}; }
ColliderRef collider_named(const WorldRef& self, const std::string& name) {
  return {self.world, self.world->collider(name), name};
}
MeshColliderRef mesh_collider_named(const WorldRef& self, const std::string& name) {
  return {self.world, self.world->mesh_collider(name), name};
}

ObjectRef add_object(const WorldRef& self, const nb::kwargs& members) {
  const Description one = described("objects", members, names_in(self.world->names()->objects), nb::list());
  return {self.world, self.world->add(one.scene().objects.front())};
}

nb::object add_collider(const WorldRef& self, const nb::kwargs& members) {
  const Description one = described("colliders", members, nb::list(), collider_names(*self.world->names()));
  const Scene& scene = one.scene();
  if (!scene.colliders.empty())
    return nb::cast(ColliderRef{self.world, self.world->add(scene.colliders.front()), scene.colliders.front().name});
  const MeshCollider& mesh = scene.mesh_colliders.front();
  return nb::cast(MeshColliderRef{self.world, self.world->add(mesh), mesh.name});
}

void remove_thing(const WorldRef& self, nb::handle thing) {
  if (nb::isinstance<nb::str>(thing)) return self.world->remove(self.world->object(nb::cast<std::string>(thing)));
  if (nb::isinstance<ObjectRef>(thing)) return self.world->remove(id_here(self, nb::cast<const ObjectRef&>(thing)));
  if (nb::isinstance<ColliderRef>(thing)) return self.world->remove(id_here(self, nb::cast<const ColliderRef&>(thing)));
  if (nb::isinstance<MeshColliderRef>(thing))
    return self.world->remove(id_here(self, nb::cast<const MeshColliderRef&>(thing)));
  throw wrong_type("thing", thing, "an Object, a Collider, a MeshCollider, or the name of an object");
}

nb::list contact_events(const WorldRef& self) {
  static const nb::object* type = new nb::object(python_part("pliant._types", "ContactEvent"));
  static constexpr const char* changes[] = {"begin", "persist", "end"};
  nb::list list;
  const Names& names = *self.world->names();
  for (const ContactEvent& event : self.world->recording().contact_events())
    list.append((*type)(changes[static_cast<int>(event.change)], names.of(event.first), names.of(event.second),
                        event.contacts, event.impulse, tuple_of(event.position), tuple_of(event.normal),
                        nb::make_tuple(event.push.x, event.push.y, event.push.z)));
  return list;
}

/// The name of a body, or "" where it is none.
std::string body_name(const OwnedWorld& owned, const TouchSide& side) {
  const ObjectId id{side.thing.slot, side.thing.generation};
  if (side.body < 0 || !owned.names()->objects.contains(id)) return {};
  const Object& object = owned.described(id);
  const auto index = static_cast<std::size_t>(side.body);
  return index < object.bodies.size() ? object.bodies[index].name : std::string{};
}

nb::list body_touches(const WorldRef& self) {
  static const nb::object* type = new nb::object(python_part("pliant._types", "BodyTouch"));
  nb::list list;
  const Names& names = *self.world->names();
  for (const BodyTouch& touch : self.world->recording().body_touches())
    list.append((*type)(names.of(touch.first.thing), body_name(*self.world, touch.first), names.of(touch.second.thing),
                        body_name(*self.world, touch.second), touch.contacts, touch.impulse, tuple_of(touch.position),
                        nb::make_tuple(touch.push.x, touch.push.y, touch.push.z)));
  return list;
}

std::string world_repr(const WorldRef& self) {
  const World& world = self.world->idle();
  return "<pliant.World: frame " + std::to_string(world.state().frame) + ", " + std::to_string(world.object_count()) +
         " objects, " + std::to_string(world.state().positions.size()) + " particles>";
}

void bind_contents(nb::class_<WorldRef>& c) {
  c.def("__getitem__", &object_named, nb::arg("name"), nb::sig("def __getitem__(self, name: str, /) -> Object"),
        "The object of that name. Raises KeyError if there is none.")
      .def(
          "__contains__",
          [](const WorldRef& self, nb::handle name) {
            for (const auto& [id, one] : self.world->names()->objects)
              if (nb::str(one.c_str()).equal(name)) return true;
            return false;
          },
          nb::arg("name"), nb::sig("def __contains__(self, name: object, /) -> bool"),
          "True if there is an object of that name.")
      .def(
          "__iter__", [](const WorldRef& self) { return nb::iter(names_in(self.world->names()->objects)); },
          nb::sig("def __iter__(self) -> collections.abc.Iterator[str]"), "Iterates over the names of the objects.")
      .def(
          "__len__", [](const WorldRef& self) { return self.world->names()->objects.size(); }, "Number of objects.")
      .def_prop_ro(
          "objects",
          [](const WorldRef& self) {
            std::vector<ObjectRef> all;
            for (const auto& [id, name] : self.world->names()->objects) all.push_back({self.world, id});
            return all;
          },
          "The objects, by slot.")
      .def_prop_ro(
          "colliders",
          [](const WorldRef& self) {
            std::vector<ColliderRef> all;
            for (const auto& [id, name] : self.world->names()->colliders) all.push_back({self.world, id, name});
            return all;
          },
          "The primitive colliders.")
      .def_prop_ro(
          "mesh_colliders",
          [](const WorldRef& self) {
            std::vector<MeshColliderRef> all;
            for (const auto& [id, name] : self.world->names()->mesh_colliders) all.push_back({self.world, id, name});
            return all;
          },
          "The mesh colliders.")
      .def("collider", &collider_named, nb::arg("name"),
           "The primitive collider of that name. Raises KeyError if there is none.")
      .def("mesh_collider", &mesh_collider_named, nb::arg("name"),
           "The mesh collider of that name. Raises KeyError if there is none.")
      .def("add", &add_object, nb::arg("members"), nb::sig("def add(self, **members: typing.Any) -> Object"),
           "Adds an object at the present time, described as in Scene.add(). Raises Error if it cannot be simulated.")
      .def("add_collider", &add_collider, nb::arg("members"),
           nb::sig("def add_collider(self, **members: typing.Any) -> Collider | MeshCollider"),
           "Adds a collider, described as in Scene.add_collider().")
      .def("remove", &remove_thing, nb::arg("thing"),
           nb::sig("def remove(self, thing: Object | Collider | MeshCollider | str) -> None"),
           "Removes an object or collider; a name is that of an object.")
      .def(
          "record_contact_events", [](const WorldRef& self, bool on) { self.world->record_contacts(on); },
          nb::arg("on") = true, "Starts or ends the recording of contact events; off at first.")
      .def("contact_events", &contact_events, nb::sig("def contact_events(self) -> list[pliant._types.ContactEvent]"),
           "The contact events of the last step. Raises Error unless record_contact_events() is on.");
}

void bind_recording(nb::class_<WorldRef>& c) {
  c.def("body_touches", &body_touches, nb::sig("def body_touches(self) -> list[pliant._types.BodyTouch]"),
        "What each rigid body touched in the last step, and how hard. Raises Error unless record_contact_events() is "
        "on.")
      .def(
          "record_joint_loads", [](const WorldRef& self, bool on) { self.world->idle().record_joint_loads(on); },
          nb::arg("on") = true,
          "Starts or ends the recording of mean loads of joints, for Object.mean_joint_load(); off at first.")
      .def(
          "describe", [](const WorldRef& self) { return describe(self.world->idle()); },
          "Time, sweep, substeps, threads and a line for each object, for people to read.");
}

void bind_measures(nb::class_<WorldRef>& c) {
  c.def_prop_ro(
       "time", [](const WorldRef& self) { return self.world->idle().state().time; }, "Simulated time [s].")
      .def_prop_ro(
          "frame", [](const WorldRef& self) { return self.world->idle().state().frame; }, "Number of complete frames.")
      .def_prop_ro(
          "frame_time", [](const WorldRef& self) { return self.world->frame_time(); }, "Duration of a frame [s].")
      .def_prop_ro(
          "threads", [](const WorldRef& self) { return self.world->idle().threads(); }, "Number of threads.")
      .def_prop_ro(
          "isa", [](const WorldRef& self) { return self.world->idle().isa(); },
          "Instruction set in use, as \"x86-64-v4\"; it changes no bits.")
      .def(
          "kinetic_energy", [](const WorldRef& self) { return self.world->idle().measure().kinetic_energy(); },
          "Kinetic energy of all dynamic particles [J].")
      .def(
          "potential_energy", [](const WorldRef& self) { return self.world->idle().measure().potential_energy(); },
          "Gravitational energy of all dynamic particles [J]; heights are relative to the origin.")
      .def(
          "advice",
          [](const WorldRef& self, const NamedReport& report) {
            return self.world->idle().measure().advice(report.report);
          },
          nb::arg("report"), "Where the solve of a frame fell short, by how much, and what to do; empty if it did not.")
      .def("__repr__", &world_repr);
}

}  // namespace

Description described(const char* list, const nb::dict& members, const nb::list& taken_objects,
                      const nb::list& taken_colliders) {
  const nb::object make = python_part("pliant._scene", "one_thing");
  return nb::cast<Description>(make(list, members, taken_objects, taken_colliders));
}

void bind_world(nb::module_& m) {
  static PyType_Slot slots[] = {{Py_tp_setattro, reinterpret_cast<void*>(refuse_attribute)},
                                {Py_tp_traverse, reinterpret_cast<void*>(traverse_world<WorldRef>)},
                                {0, nullptr}};
  nb::class_<WorldRef> c(
      m, "World", nb::type_slots(slots),
      "A simulation to step, read and control: a scene that was compiled, and its State.\n\nWorld(scene) takes a "
      "Scene, a "
      "dict "
      "of the scene format, or the path of a scene file, and raises Error if it cannot be simulated. `threads`: 0 for "
      "all "
      "of the "
      "machine; None: as the scene says. The bits do not depend on it. `forces`: a function of ForceArrays, called "
      "once "
      "for "
      "each object and substep, or a dict of functions by name of object. A World without forces can be pickled.");
  c.def(
      "__init__",
      [](WorldRef* self, nb::handle scene, std::optional<int> threads, nb::handle forces) {
        PythonForces made;
        const std::shared_ptr<const SceneFile> file = with_forces(description_of(scene).file, forces, made);
        WorldRef ref{make_world(file, threads)};
        ref.world->own_forces(std::move(made));
        new (self) WorldRef(std::move(ref));
      },
      nb::arg("scene"), nb::arg("threads") = nb::none(), nb::arg("forces") = nb::none(),
      nb::sig(
          "def __init__(self, scene: pliant._scene.SceneLike, threads: int | None = None, forces: pliant._types.Forces "
          "| None "
          "= None) -> None"),
      "Makes a World.");
  bind_stepping(m, c);
  bind_contents(c);
  bind_recording(c);
  bind_measures(c);
  bind_editing(c);
  bind_gauge_reading(c);
  bind_saving(c);
}

}  // namespace pliant::python
