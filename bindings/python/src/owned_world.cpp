// A World as Python has it: its names and descriptions, and what Python's garbage collector must know.

#include "forces.h"
#include "pliant/error.h"
#include "pliant/save.h"
#include "world.h"

namespace pliant::python {

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

void OwnedWorld::record_contacts(bool on) {
  idle().record_contact_events(on);
  records_contacts = on;
}

World& OwnedWorld::recording() {
  World& world = idle();
  if (!records_contacts)
    throw Error({}, "contact events are not recorded",
                "call record_contact_events() before the step; loaded and copied Worlds do not record them");
  return world;
}

World& OwnedWorld::idle() {
  if (is_stepping_)
    throw Error({}, "this World is stepping, in another thread or around this call", "wait until its step has ended");
  return world_;
}

World& OwnedWorld::changing(const char* what) {
  World& world = idle();
  if (views > 0)
    throw Error({},
                "a World cannot be " + std::string(what) + " while " + std::to_string(views) +
                    (views == 1 ? " view of its records is alive" : " views of its records are alive"),
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

std::int64_t OwnedWorld::changes(ObjectId id) const {
  const auto found = changes_.find(id);
  return found == changes_.end() ? 0 : found->second;
}

std::vector<int> OwnedWorld::edit(ObjectId id, const Edit& edit, std::int64_t made_after) {
  changing("edited");
  if (world_.has(id) && changes(id) != made_after)
    throw Error({.object = edit.object.name}, "was edited or torn after this Edit was made",
                "make another by World.edit()");
  const Stepping guard(*this);
  std::vector<int> news;
  {
    const nb::gil_scoped_release release;
    news = world_.edit(id, edit);
  }
  objects_.insert_or_assign(id, edit.object);
  ++changes_[id];
  return news;
}

const Object& OwnedWorld::described(ObjectId id) const {
  const auto found = objects_.find(id);
  if (found != objects_.end()) return found->second;
  const std::vector<Object>& all = file_->scene.objects;
  if (id.generation != 0 || id.slot < 0 || static_cast<std::size_t>(id.slot) >= all.size())
    throw Error({}, "the object was removed", "use one of World.objects");
  return all[static_cast<std::size_t>(id.slot)];
}

const Object& OwnedWorld::present(ObjectId id) const {
  const Object& known = described(id);
  return pliant::comes_apart(known) ? world_.object(id).description() : known;
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
  for (const ObjectId id : world_.objects()) objects.push_back(present(id));
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

void OwnedWorld::own_forces(std::vector<std::shared_ptr<PythonForce>> forces) { forces_ = std::move(forces); }

void OwnedWorld::forget_forces() {
  idle();
  before_ = {};
  const auto forgotten = std::exchange(forces_, {});  // what their end calls may use this World
  std::vector<nb::object> functions;
  functions.reserve(forgotten.size());
  for (const std::shared_ptr<PythonForce>& force : forgotten) functions.push_back(std::move(force->function));
}

SharedWorld::SharedWorld(std::unique_ptr<OwnedWorld> owned) : owned_(owned.get()) {
  core_ = nb::cast(owned.release(), nb::rv_policy::take_ownership);
}

SharedWorld make_world(const std::shared_ptr<const SceneFile>& file, std::optional<int> threads) {
  Settings settings = file->scene.settings;
  if (threads && (*threads < 0 || *threads > 1024))
    throw Error({}, "threads is " + std::to_string(*threads), "pass 0, for all of the machine, to 1024");
  if (threads) settings.threads = *threads;
  std::unique_ptr<OwnedWorld> made;
  {
    const nb::gil_scoped_release release;
    made = std::make_unique<OwnedWorld>(file, World(file->scene, settings));
  }
  return SharedWorld(std::move(made));
}

/// What Python's garbage collector calls for the object that owns a World.
struct Core {
  static int traverse(PyObject* self, visitproc visit, void* arg) {
    Py_VISIT(Py_TYPE(self));
    if (!nb::inst_ready(self)) return 0;
    for (const std::shared_ptr<PythonForce>& force : nb::inst_ptr<OwnedWorld>(self)->forces_) {
      Py_VISIT(force->function.ptr());
      Py_VISIT(force->arrays.ptr());
    }
    return 0;
  }
  static int clear(PyObject* self) {
    if (nb::inst_ready(self)) nb::inst_ptr<OwnedWorld>(self)->forget_forces();
    return 0;
  }
};

void bind_core(nb::module_& m) {
  static PyType_Slot slots[] = {{Py_tp_traverse, reinterpret_cast<void*>(Core::traverse)},
                                {Py_tp_clear, reinterpret_cast<void*>(Core::clear)},
                                {0, nullptr}};
  nb::class_<OwnedWorld>(m, "_Core", nb::type_slots(slots), "Owns a World to which World, Object and the like refer.");
}

}  // namespace pliant::python
