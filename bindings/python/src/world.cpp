// pliant.World: made from a scene, stepped without the GIL.

#include <chrono>
#include <cmath>

#include "arrays.h"
#include "colliders.h"
#include "forces.h"
#include "object.h"
#include "pliant/describe.h"
#include "pliant/error.h"
#include "pliant/save.h"
#include "world.h"

namespace pliant::python {

namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// A step that took longer is ended by Ctrl-C before it is complete [ms].
constexpr double long_step = 20;

float valid_dt(const OwnedWorld& owned, nb::handle dt) {
  if (dt.is_none()) return owned.frame_time();
  double value = 0;
  if (PyBool_Check(dt.ptr()) != 0 || !nb::try_cast(dt, value)) throw nb::type_error("dt is no number");
  if (!(static_cast<float>(value) > 0) || !std::isfinite(static_cast<float>(value)))
    throw Error({}, "dt is " + nb::cast<std::string>(nb::repr(dt)) + " s", "pass a finite number of float32 above 0");
  return static_cast<float>(value);
}

/// The number of frames to run: that of the caller, or the scene's own.
int valid_frames(const OwnedWorld& owned, std::optional<int> frames) {
  const int count = frames.value_or(owned.file().scene.frames);
  if (count < 1) throw Error({}, "frames is " + std::to_string(count), "run 1 or more");
  return count;
}

/// Runs frames without the GIL; looks for signals every few milliseconds.
NamedReport run(OwnedWorld& owned, int frames) {
  Stepping stepping(owned);
  const StopOnInterrupt guard(owned.stop, true);
  NamedReport result{{}, owned.names()};
  auto looked = Clock::now();
  for (int done = 0; done < frames && result.report.ok() && !result.report.stopped;) {
    {
      const nb::gil_scoped_release release;
      do {
        result.report = advance(stepping.world(), owned.frame_time());
        ++done;
      } while (done < frames && result.report.ok() && !result.report.stopped && milliseconds_since(looked) < long_step);
    }
    looked = Clock::now();
    owned.answer(result.report);
    if (PyErr_CheckSignals() != 0) throw nb::python_error();
  }
  owned.last_milliseconds = result.report.milliseconds;
  return result;
}

NamedReport step_once(const WorldRef& self, nb::handle dt) { return step(*self.world, valid_dt(*self.world, dt)); }

/// Iterates over frames: each next() steps once.
struct Frames {
  SharedWorld owned;
  int left = 0;
};

NamedReport next_frame(Frames& frames) {
  if (frames.left <= 0) throw nb::stop_iteration();
  --frames.left;
  NamedReport report = step(*frames.owned, frames.owned->frame_time());
  if (!report.report.ok() || report.report.stopped) frames.left = 0;
  return report;
}

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

/// A scene with one thing, which is to be added to this World.
Description described(const char* list, const WorldRef& self, const nb::kwargs& members) {
  const nb::object make = python_part("pliant._scene", "one_thing");
  return nb::cast<Description>(
      make(list, members, names_in(self.world->names()->objects), collider_names(*self.world->names())));
}

ObjectRef add_object(const WorldRef& self, const nb::kwargs& members) {
  const Description one = described("objects", self, members);
  return {self.world, self.world->add(one.scene().objects.front())};
}

nb::object add_collider(const WorldRef& self, const nb::kwargs& members) {
  const Description one = described("colliders", self, members);
  const Scene& scene = one.scene();
  if (!scene.colliders.empty())
    return nb::cast(ColliderRef{self.world, self.world->add(scene.colliders.front()), scene.colliders.front().name});
  const MeshCollider& mesh = scene.mesh_colliders.front();
  return nb::cast(MeshColliderRef{self.world, self.world->add(mesh), mesh.name});
}

/// Throws an Error if a thing is of another World.
template <class Ref>
auto id_here(const WorldRef& self, const Ref& thing) {
  if (thing.world != self.world) throw Error({}, "this is of another World", "remove it from its own");
  return thing.id;
}

void remove_thing(const WorldRef& self, nb::handle thing) {
  if (nb::isinstance<nb::str>(thing)) return self.world->remove(self.world->object(nb::cast<std::string>(thing)));
  if (nb::isinstance<ObjectRef>(thing)) return self.world->remove(id_here(self, nb::cast<const ObjectRef&>(thing)));
  if (nb::isinstance<ColliderRef>(thing)) return self.world->remove(id_here(self, nb::cast<const ColliderRef&>(thing)));
  if (nb::isinstance<MeshColliderRef>(thing))
    return self.world->remove(id_here(self, nb::cast<const MeshColliderRef&>(thing)));
  throw nb::type_error("remove an Object, a Collider, a MeshCollider, or the name of an object");
}

nb::list contact_events(const WorldRef& self) {
  static const nb::object* type = new nb::object(python_part("pliant._types", "ContactEvent"));
  static constexpr const char* changes[] = {"begin", "persist", "end"};
  nb::list list;
  const Names& names = *self.world->names();
  for (const ContactEvent& event : self.world->idle().contact_events())
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
  for (const BodyTouch& touch : self.world->idle().body_touches())
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

void bind_stepping(nb::class_<WorldRef>& c) {
  c.def("step", &step_once, nb::arg("dt") = nb::none(), nb::sig("def step(self, dt: float | None = None) -> Report"),
        "Advances by one frame of `dt` seconds; None: the scene's frame_time. Never raises for what happens in it: see "
        "Report.ok. Raises Error if dt is too short for its substeps. Keep dt constant. Other Python threads run "
        "meanwhile. Ctrl-C ends a long step within a substep; the frame then does not "
        "count.")
      .def(
          "run",
          [](const WorldRef& self, std::optional<int> frames) {
            return run(*self.world, valid_frames(*self.world, frames));
          },
          nb::arg("frames") = nb::none(), nb::sig("def run(self, frames: int | None = None) -> Report"),
          "Runs frames, the scene's own number if None, and returns the last Report. Ends early where Report.ok is false.")
      .def(
          "frames",
          [](const WorldRef& self, std::optional<int> count) {
            return Frames{self.world, valid_frames(*self.world, count)};
          },
          nb::arg("count") = nb::none(),
          nb::sig("def frames(self, count: int | None = None) -> collections.abc.Iterator[Report]"),
          "Iterates over frames: each steps once and gives its Report. None: the scene's own number. Ends after a Report "
          "that is not ok.")
      .def(
          "stop", [](const WorldRef& self) { self.world->ask_to_stop(); },
          "Ends a step that runs in another thread within a substep: its Report has `stopped`. If none runs, the next one "
          "ends before it begins. A Report that has `stopped` ends the effect.")
      .def(
          "forget_forces", [](const WorldRef& self) { self.world->forget_forces(); },
          "Forgets the functions of `forces`; later steps are without them. Needed only where such a function refers both "
          "to this World and to an Object or other part of it: Python cannot collect that cycle.")
      .def(
          "state", [](const WorldRef& self) { return self.world->idle().state(); }, "A copy of the State.")
      .def(
          "restore", [](const WorldRef& self, const State& state) { self.world->changing("restored").restore(state); },
          nb::arg("state"), "Restores a State of this World. Raises Error if it does not fit.")
      .def(
          "state_hash", [](const WorldRef& self) { return self.world->idle().state_hash(); },
          "The SHA-256 hash of the State: the same on every machine and by any number of threads.");
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
          "record_contact_events", [](const WorldRef& self, bool on) { self.world->idle().record_contact_events(on); },
          nb::arg("on") = true, "Starts or ends the recording of contact events; off at first.")
      .def("contact_events", &contact_events, nb::sig("def contact_events(self) -> list[pliant._types.ContactEvent]"),
           "The contact events of the last step, if they are recorded.");
}

void bind_recording(nb::class_<WorldRef>& c) {
  c.def("body_touches", &body_touches, nb::sig("def body_touches(self) -> list[pliant._types.BodyTouch]"),
        "What each rigid body touched in the last step, and how hard, if contact events are recorded.")
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

OwnedWorld::OwnedWorld(std::shared_ptr<const SceneFile> file, World made)
    : world_(std::move(made)), file_(std::move(file)) {
  world_.stop_when(&stop);
  const Scene& scene = file_->scene;
  auto names = std::make_shared<Names>();
  const auto remember = [](const auto& ids, const auto& described, auto& names_of, auto& kept) {
    for (std::size_t i = 0; i < ids.size(); ++i) {
      names_of[ids[i]] = described[i].name;
      // The id of what comes from a Scene is its index; after loading it need not be.
      if (ids[i].slot != static_cast<int>(i) || ids[i].generation != 0) kept.emplace(ids[i], described[i]);
    }
  };
  remember(world_.objects(), scene.objects, names->objects, objects_);
  remember(world_.colliders(), scene.colliders, names->colliders, colliders_);
  remember(world_.mesh_colliders(), scene.mesh_colliders, names->mesh_colliders, mesh_colliders_);
  names_ = std::move(names);
}

World& OwnedWorld::idle() {
  if (is_stepping_)
    throw Error({}, "this World is stepping, in another thread or around this call", "wait until its step has ended");
  return world_;
}

World& OwnedWorld::changing(const char* what) {
  World& world = idle();
  if (views > 0)
    throw Error(
        {},
        "a World cannot be " + std::string(what) + " while " + std::to_string(views) + " views of its records are alive",
        "delete what records() returned first, or read positions()");
  return world;
}

namespace {

template <class Id>
Id find(const std::map<Id, std::string>& names, const std::string& name, const char* kind) {
  std::string all;
  for (const auto& [id, one] : names) {
    if (one == name) return id;
    all += (all.empty() ? "'" : ", '") + one + "'";
  }
  throw nb::key_error(("there is no " + std::string(kind) + " '" + name + "'; " +
                       (all.empty() ? "the World has none" : "the World has " + all))
                          .c_str());
}

}  // namespace

ObjectId OwnedWorld::object(const std::string& name) const { return find(names_->objects, name, "object"); }
ColliderId OwnedWorld::collider(const std::string& name) const { return find(names_->colliders, name, "collider"); }
MeshColliderId OwnedWorld::mesh_collider(const std::string& name) const {
  return find(names_->mesh_colliders, name, "mesh collider");
}

namespace {

template <class Id, class Thing>
Id add_to(World& world, const Thing& thing, std::map<Id, Thing>& kept, std::map<Id, std::string> Names::*of,
          std::shared_ptr<const Names>& names) {
  Id id;
  {
    const nb::gil_scoped_release release;
    id = world.add(thing);
  }
  kept.emplace(id, thing);
  auto changed = std::make_shared<Names>(*names);
  ((*changed).*of)[id] = thing.name;
  names = std::move(changed);
  return id;
}

template <class Id, class Thing>
void remove_from(World& world, Id id, std::map<Id, Thing>& kept, std::map<Id, std::string> Names::*of,
                 std::shared_ptr<const Names>& names) {
  world.remove(id);
  kept.erase(id);
  auto changed = std::make_shared<Names>(*names);
  ((*changed).*of).erase(id);
  names = std::move(changed);
}

}  // namespace

ObjectId OwnedWorld::add(const Object& object) {
  changing("changed");
  const Stepping guard(*this);
  return add_to(world_, object, objects_, &Names::objects, names_);
}
ColliderId OwnedWorld::add(const Collider& collider) {
  changing("changed");
  const Stepping guard(*this);
  return add_to(world_, collider, colliders_, &Names::colliders, names_);
}
MeshColliderId OwnedWorld::add(const MeshCollider& collider) {
  changing("changed");
  const Stepping guard(*this);
  return add_to(world_, collider, mesh_colliders_, &Names::mesh_colliders, names_);
}
void OwnedWorld::remove(ObjectId id) { remove_from(changing("changed"), id, objects_, &Names::objects, names_); }
void OwnedWorld::remove(ColliderId id) { remove_from(changing("changed"), id, colliders_, &Names::colliders, names_); }
void OwnedWorld::remove(MeshColliderId id) {
  remove_from(changing("changed"), id, mesh_colliders_, &Names::mesh_colliders, names_);
}

const Object& OwnedWorld::described(ObjectId id) const {
  const auto found = objects_.find(id);
  if (found != objects_.end()) return found->second;
  const std::vector<Object>& all = file_->scene.objects;
  if (id.generation != 0 || id.slot < 0 || static_cast<std::size_t>(id.slot) >= all.size())
    throw Error({}, "the object was removed", "use one of World.objects");
  return all[static_cast<std::size_t>(id.slot)];
}

bool OwnedWorld::comes_apart() const {
  for (const auto& [id, name] : names_->objects)
    if (pliant::comes_apart(described(id))) return true;
  return false;
}

Scene OwnedWorld::present() const {
  Scene scene = file_->scene;
  std::vector<Object> objects;
  objects.reserve(names_->objects.size());
  for (const ObjectId id : world_.objects()) {
    const Object& object = described(id);
    objects.push_back(pliant::comes_apart(object) ? world_.object(id).description() : object);
  }
  const auto present_of = [](const auto& ids, const auto& kept, const auto& of_scene) {
    std::remove_cvref_t<decltype(of_scene)> present;
    present.reserve(ids.size());
    for (const auto& id : ids) {
      const auto found = kept.find(id);
      present.push_back(found != kept.end() ? found->second : of_scene[static_cast<std::size_t>(id.slot)]);
    }
    return present;
  };
  scene.objects = std::move(objects);
  scene.colliders = present_of(world_.colliders(), colliders_, file_->scene.colliders);
  scene.mesh_colliders = present_of(world_.mesh_colliders(), mesh_colliders_, file_->scene.mesh_colliders);
  return scene;
}

Stepping::Stepping(OwnedWorld& owned) : owned_(owned) {
  owned.idle();
  owned_.is_stepping_ = true;
  owned_.stop = owned_.is_asked_to_stop_;
}

void OwnedWorld::ask_to_stop() { stop = is_asked_to_stop_ = true; }

void OwnedWorld::answer(const Report& report) {
  if (report.stopped) stop = is_asked_to_stop_ = false;
}

void OwnedWorld::forget_forces() {
  idle();
  std::vector<nb::object> forgotten;  // what their end calls may use this World
  forgotten.reserve(forces.size());
  for (const std::shared_ptr<PythonForce>& force : forces) forgotten.push_back(std::move(force->function));
}

Report advance(World& world, float dt) {
  const std::int64_t before = world.state().frame;
  Report report = world.step(dt);
  if (report.ok() && !report.stopped && world.state().frame == before)
    throw Error({}, report.explain(), "pass a longer one");
  return report;
}

NamedReport step(OwnedWorld& owned, float dt) {
  NamedReport result{{}, owned.names()};
  Stepping stepping(owned);
  {
    const StopOnInterrupt guard(owned.stop, owned.last_milliseconds > long_step);
    const nb::gil_scoped_release release;
    result.report = advance(stepping.world(), dt);
  }
  owned.answer(result.report);
  owned.last_milliseconds = result.report.milliseconds;
  if (result.report.stopped && PyErr_CheckSignals() != 0) throw nb::python_error();
  return result;
}

SharedWorld make_world(const std::shared_ptr<const SceneFile>& file, std::optional<int> threads) {
  Settings settings = file->scene.settings;
  if (threads && (*threads < 0 || *threads > 1024))
    throw Error({}, "threads is " + std::to_string(*threads), "pass 0, for all of the machine, to 1024");
  if (threads) settings.threads = *threads;
  const nb::gil_scoped_release release;
  return std::make_shared<OwnedWorld>(file, World(file->scene, settings));
}

int traverse(const SharedWorld& world, visitproc visit, void* arg) {
  if (world == nullptr || world.use_count() != 1) return 0;
  for (const std::shared_ptr<PythonForce>& force : world->forces) Py_VISIT(force->function.ptr());
  return 0;
}

void clear(const SharedWorld& world) {
  if (world == nullptr || world.use_count() != 1) return;
  for (const std::shared_ptr<PythonForce>& force : world->forces) force->function.reset();
}

void bind_world(nb::module_& m) {
  nb::class_<Frames>(m, "_Frames")
      .def("__iter__", [](nb::handle self) { return nb::borrow(self); })
      .def("__next__", &next_frame);
  nb::class_<WorldRef> c(
      m, "World", nb::type_slots(collected_slots<WorldRef>()),
      "A simulation to step, read and control: a scene that was compiled, and its State.\n\nWorld(scene) takes a Scene, a "
      "dict "
      "of the scene format, or the path of a scene file, and raises Error if it cannot be simulated. `threads`: 0 for all "
      "of the "
      "machine; None: as the scene says. The bits do not depend on it. `forces`: a function of ForceArrays, called once "
      "for "
      "each object and substep, or a dict of functions by name of object. A World without forces can be pickled.");
  c.def(
      "__init__",
      [](WorldRef* self, nb::handle scene, std::optional<int> threads, nb::handle forces) {
        PythonForces made;
        const std::shared_ptr<const SceneFile> file = with_forces(description_of(scene).file, forces, made);
        WorldRef ref{make_world(file, threads)};
        ref.world->forces = std::move(made);
        new (self) WorldRef(std::move(ref));
      },
      nb::arg("scene"), nb::arg("threads") = nb::none(), nb::arg("forces") = nb::none(),
      nb::sig("def __init__(self, scene: pliant._scene.SceneLike, threads: int | None = None, forces: pliant._types.Forces "
              "| None "
              "= None) -> None"),
      "Makes a World.");
  bind_stepping(c);
  bind_contents(c);
  bind_recording(c);
  bind_measures(c);
  bind_saving(c);
}

}  // namespace pliant::python
