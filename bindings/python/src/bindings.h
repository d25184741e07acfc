// What the files of the Python module share. Every function here is called with the GIL unless it says otherwise.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pliant/io.h"
#include "pliant/world.h"

namespace pliant::python {

namespace nb = nanobind;

struct PythonForce;

/// A scene that C++ has read: what World and Batch are made from.
struct Description {
  std::shared_ptr<const SceneFile> file;
  const Scene& scene() const { return file->scene; }
};

/// Names of the objects, colliders and mesh colliders of a World by slot; shared by its Reports.
struct Names {
  std::map<ObjectId, std::string> objects;
  std::map<ColliderId, std::string> colliders;
  std::map<MeshColliderId, std::string> mesh_colliders;
  std::string of(ObjectId id) const;
  std::string of(const Thing& thing) const;
};

/// A World, what saving it needs, and what keeps Python from using it at the wrong time.
class OwnedWorld {
 public:
  OwnedWorld(std::shared_ptr<const SceneFile> file, World made);
  OwnedWorld(const OwnedWorld&) = delete;
  OwnedWorld& operator=(const OwnedWorld&) = delete;

  /// The World, for use between steps. Throws an Error while a step runs, in a callback or in another thread.
  World& idle();
  /// The same for what may move its particles in memory. Also throws an Error while views of records are alive.
  World& changing(const char* what);

  /// The id of an object of that name. Throws nb::key_error with what there is.
  ObjectId object(const std::string& name) const;
  ColliderId collider(const std::string& name) const;
  MeshColliderId mesh_collider(const std::string& name) const;
  const std::shared_ptr<const Names>& names() const { return names_; }

  ObjectId add(const Object& object);
  ColliderId add(const Collider& collider);
  MeshColliderId add(const MeshCollider& collider);
  void remove(ObjectId id);
  void remove(ColliderId id);
  void remove(MeshColliderId id);
  /// World::edit. The object keeps its name. Throws an Error unless changes(id) is `made_after`.
  std::vector<int> edit(ObjectId id, const Edit& edit, std::int64_t made_after);
  /// How often an object was edited or tore: an Edit from before would undo that. Joints that broke stay broken.
  std::int64_t changes(ObjectId id) const;

  /// The description of an object, as it was added or edited. Throws an Error if there is none of that id.
  const Object& described(ObjectId id) const;
  /// The same as it is now, if it comes apart.
  const Object& present(ObjectId id) const;
  /// True if an object tears, is cut or can break: then all particles can move in memory.
  bool comes_apart() const;
  /// The Scene that describes what is there now, for saving.
  Scene present() const;

  const SceneFile& file() const { return *file_; }
  const std::shared_ptr<const SceneFile>& shared_file() const { return file_; }
  float frame_time() const { return file_->scene.frame_time; }

  /// Ends the step that runs, and the next one if none does, as World.stop() says.
  void ask_to_stop();
  /// Ends the effect of ask_to_stop() if the Report says that a step was stopped.
  void answer(const Report& report);
  /// Forgets the functions of forces, which then do nothing.
  void forget_forces();
  /// Takes the functions of forces on, as the World's own.
  void own_forces(std::vector<std::shared_ptr<PythonForce>> forces);

  /// Read by the World after each substep. Set by Ctrl-C while a step runs, and by ask_to_stop().
  std::atomic<bool> stop{false};
  double last_milliseconds = 1e9;  ///< of the last step; large before the first
  int views = 0;                   ///< of records that are alive
  bool records_contacts = false;   ///< contact events, for messages

  /// Starts or ends the recording of contact events.
  void record_contacts(bool on);
  /// The World. Throws an Error unless contact events are recorded: an empty list would look as if nothing touched.
  World& recording();

 private:
  friend class Stepping;
  friend struct Core;
  World world_;
  std::shared_ptr<const SceneFile> file_;
  std::shared_ptr<const Names> names_;
  bool is_stepping_ = false;
  bool is_asked_to_stop_ = false;  ///< by World.stop(), which no Report has answered
  std::vector<std::shared_ptr<PythonForce>> forces_;
  std::map<ObjectId, std::int64_t> changes_;
  State before_;  ///< the State before the present step, if there are force functions
  /// Descriptions whose index in the scene is not their id.
  std::map<ObjectId, Object> objects_;
  std::map<ColliderId, Collider> colliders_;
  std::map<MeshColliderId, MeshCollider> mesh_colliders_;
};

/// A reference to a World. All references go through one Python object, which owns it: so Python's garbage collector
/// knows them all, and ends a World whose force functions refer to it. Made, copied and destroyed with the GIL.
class SharedWorld {
 public:
  SharedWorld() = default;
  explicit SharedWorld(std::unique_ptr<OwnedWorld> owned);
  OwnedWorld& operator*() const { return *owned_; }
  OwnedWorld* operator->() const { return owned_; }
  bool operator==(const SharedWorld& other) const { return owned_ == other.owned_; }
  /// The Python object, for the garbage collector.
  nb::handle core() const { return core_; }

 private:
  nb::object core_;
  OwnedWorld* owned_ = nullptr;
};

/// Marks a World as stepping from construction to destruction; both with the GIL.
class Stepping {
 public:
  /// Throws an Error if it steps already.
  explicit Stepping(OwnedWorld& owned);
  ~Stepping() { owned_.is_stepping_ = false; }
  Stepping(const Stepping&) = delete;
  Stepping& operator=(const Stepping&) = delete;
  /// Steps, without the GIL. Throws an Error if nothing moved because dt is too short. Where a force raises an
  /// exception, the World goes back to the State before this step, and the exception passes on.
  Report advance(float dt);

 private:
  OwnedWorld& owned_;
};

/// While it lives in the main thread, Ctrl-C also sets `flag`, so that a World ends its step within a substep.
class StopOnInterrupt {
 public:
  StopOnInterrupt(std::atomic<bool>& flag, bool wanted);
  ~StopOnInterrupt();
  StopOnInterrupt(const StopOnInterrupt&) = delete;
  StopOnInterrupt& operator=(const StopOnInterrupt&) = delete;

 private:
  bool installed_ = false;
};

/// A Report with the names that its ids had.
struct NamedReport {
  Report report;
  std::shared_ptr<const Names> names;
};

/// Advances by one frame without the GIL. Throws what Stepping::advance() does, and nb::python_error if a signal's
/// handler raised, as that of Ctrl-C does.
NamedReport step(OwnedWorld& owned, float dt);

/// A time step that was given [s]. Throws wrong_type(), or an Error unless it is finite and above 0.
float time_step_from(nb::handle dt);

/// Makes a World without the GIL. No threads: the scene's number.
SharedWorld make_world(const std::shared_ptr<const SceneFile>& file, std::optional<int> threads);

/// tp_setattro of all classes: no attribute can be set, and the message says what to do instead.
int refuse_attribute(PyObject* self, PyObject* name, PyObject* value);

/// tp_init of classes that functions alone make: says which one.
int refuse_construction(PyObject* self, PyObject* args, PyObject* keywords);

/// The type slots of a class that refers to no World, and which functions alone make.
inline PyType_Slot* plain_slots() {
  static PyType_Slot slots[] = {{Py_tp_setattro, reinterpret_cast<void*>(refuse_attribute)},
                                {Py_tp_init, reinterpret_cast<void*>(refuse_construction)},
                                {0, nullptr}};
  return slots;
}

/// tp_traverse of a class whose member `world` is a SharedWorld. The cycles that need an end all contain the World's
/// own object, which ends them: this needs no tp_clear.
template <class Ref>
int traverse_world(PyObject* self, visitproc visit, void* arg) {
  Py_VISIT(Py_TYPE(self));
  if (nb::inst_ready(self)) Py_VISIT(nb::inst_ptr<Ref>(self)->world.core().ptr());
  return 0;
}

/// The type slots of such a class, which functions alone make.
template <class Ref>
PyType_Slot* collected_slots() {
  static PyType_Slot slots[] = {{Py_tp_setattro, reinterpret_cast<void*>(refuse_attribute)},
                                {Py_tp_init, reinterpret_cast<void*>(refuse_construction)},
                                {Py_tp_traverse, reinterpret_cast<void*>(traverse_world<Ref>)},
                                {0, nullptr}};
  return slots;
}

/// A TypeError: what was given, of which type, and what is expected.
nb::builtin_exception wrong_type(const std::string& what, nb::handle given, const char* expected);
/// A finite or infinite number that was given. Throws wrong_type().
double number_from(nb::handle given, const char* what);
/// A value as Python shows it, for messages.
std::string repr_of(nb::handle given);

/// The Description of what a caller gave as a scene: a Scene, a mapping, or a path.
Description description_of(nb::handle scene);

/// A class or function of the package's own Python modules.
nb::object python_part(const char* module, const char* name);

/// (position, rotation) as pliant.Pose.
nb::object pose_object(const RigidPose& pose);
RigidPose pose_from(nb::handle position, nb::handle rotation);
nb::tuple tuple_of(const Vec3f& v);

/// Where a call or type says no more than C++ types, Python says which argument is wrong. Call it last.
void explain_calls(nb::module_& m);

void bind_errors(nb::module_& m);
void bind_scene(nb::module_& m);
void bind_state(nb::module_& m);
void bind_report(nb::module_& m);
void bind_object(nb::module_& m);
void bind_colliders(nb::module_& m);
void bind_core(nb::module_& m);
void bind_world(nb::module_& m);
void bind_edit(nb::module_& m);
void bind_gauges(nb::module_& m);
void bind_files(nb::module_& m);
void bind_batch(nb::module_& m);

}  // namespace pliant::python
