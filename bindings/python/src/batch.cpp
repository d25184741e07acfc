// pliant.Batch: many worlds stepped on all threads, one thread each.
#include <algorithm>
#include <cmath>

#include "arrays.h"
#include "object.h"
#include "pliant/error.h"
#include "side_by_side.h"
#include "world.h"

namespace pliant::python {

namespace {

using Worlds = std::vector<SharedWorld>;

struct Batch {
  std::shared_ptr<const Worlds> worlds;
  int threads = 0;
};

/// The objects of one name in all worlds.
struct BatchObject {
  std::shared_ptr<const Worlds> worlds;
  std::vector<ObjectId> ids;
  std::string name;
  std::size_t particles = 0;

  std::size_t size() const { return ids.size(); }
  ObjectView view(std::size_t i) const { return std::as_const((*worlds)[i]->idle()).object(ids[i]); }
  ObjectHandle handle(std::size_t i) const { return (*worlds)[i]->idle().object(ids[i]); }
  /// The handles in all worlds. Throws an Error if a world is stepping or has removed its object.
  std::vector<ObjectHandle> handles() const {
    std::vector<ObjectHandle> all;
    all.reserve(size());
    for (std::size_t i = 0; i < size(); ++i) all.push_back(handle(i));
    return all;
  }
};

std::shared_ptr<const Worlds> make_worlds(const std::vector<Description>& descriptions, int n, int threads) {
  auto worlds = std::make_shared<Worlds>(static_cast<std::size_t>(n));
  const auto make = [&](int i) {
    const Description& one = descriptions[descriptions.size() == 1 ? 0 : static_cast<std::size_t>(i)];
    Settings settings = one.scene().settings;
    settings.threads = 1;
    (*worlds)[static_cast<std::size_t>(i)] = std::make_shared<OwnedWorld>(one.file, World(one.scene(), settings));
  };
  side_by_side(n, threads, make, [] {});
  return worlds;
}

Batch make_batch(nb::handle scene, int n, nb::handle vary, int threads) {
  if (n < 1 || n > 1000000) throw Error({}, "a batch of " + std::to_string(n) + " worlds", "make 1 to 1 000 000");
  if (threads < 0 || threads > 1024)
    throw Error({}, "threads is " + std::to_string(threads), "pass 0, for all of the machine, to 1024");
  const nb::object variants = python_part("pliant._scene", "variants")(scene, n, vary);
  return {make_worlds(nb::cast<std::vector<Description>>(variants), n, threads), threads};
}

/// Marks all worlds as stepping; none if one is already.
std::vector<std::unique_ptr<Stepping>> mark_all(const Worlds& worlds) {
  std::vector<std::unique_ptr<Stepping>> all;
  all.reserve(worlds.size());
  for (const SharedWorld& world : worlds) all.push_back(std::make_unique<Stepping>(*world));
  return all;
}

nb::list run(const Batch& self, std::optional<float> dt, int frames) {
  const Worlds& worlds = *self.worlds;
  const auto stepping = mark_all(worlds);
  std::vector<NamedReport> reports;
  reports.reserve(worlds.size());
  for (const SharedWorld& world : worlds) reports.push_back({{}, world->names()});
  const auto work = [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    Report& report = reports[at].report;
    for (int frame = 0; frame < frames && report.ok() && !report.stopped; ++frame)
      report = advance(stepping[at]->world(), dt.value_or(worlds[at]->frame_time()));
  };
  side_by_side(static_cast<int>(worlds.size()), self.threads, work, [&] {
    for (const SharedWorld& world : worlds) world->stop = true;
  });
  for (std::size_t i = 0; i < worlds.size(); ++i) worlds[i]->answer(reports[i].report);
  nb::list list;
  for (NamedReport& report : reports) list.append(nb::cast(std::move(report)));
  return list;
}

nb::list step_batch(const Batch& self, std::optional<double> dt) {
  if (!dt) return run(self, {}, 1);
  const auto seconds = static_cast<float>(*dt);
  if (!(seconds > 0) || !std::isfinite(seconds))
    throw Error({}, "dt is " + std::to_string(*dt) + " s", "pass a finite number of float32 above 0");
  return run(self, seconds, 1);
}

nb::list run_frames(const Batch& self, std::optional<int> frames) {
  const int count = frames.value_or(self.worlds->front()->file().scene.frames);
  if (count < 1) throw Error({}, "frames is " + std::to_string(count), "run 1 or more");
  return run(self, {}, count);
}

BatchObject object_named(const Batch& self, const std::string& name) {
  BatchObject object{self.worlds, {}, name, 0};
  object.ids.reserve(self.worlds->size());
  for (std::size_t i = 0; i < self.worlds->size(); ++i) {
    object.ids.push_back((*self.worlds)[i]->object(name));
    const auto particles = static_cast<std::size_t>(object.view(i).particle_count());
    if (i > 0 && particles != object.particles)
      throw Error({.object = name},
                  "has " + std::to_string(object.particles) + " particles in world 0, but " + std::to_string(particles) +
                      " in world " + std::to_string(i),
                  "read the objects of batch.worlds one by one");
    object.particles = particles;
  }
  return object;
}

template <class Read>
nb::object read_all(const BatchObject& self, nb::handle out, const Read& read) {
  const std::size_t shape[3] = {self.size(), self.particles, 3};
  nb::object array = out.is_none() ? new_floats(shape) : nb::borrow(out);
  const Output output(array, shape);
  const std::span<Vec3f> all = output.vectors();
  for (std::size_t i = 0; i < self.size(); ++i) read(self.view(i), all.subspan(i * self.particles, self.particles));
  return array;
}

/// Vectors for each world: an array of shape (worlds, n, 3).
class VectorsOfWorlds {
 public:
  VectorsOfWorlds(nb::handle given, std::size_t worlds, const char* what)
      : numbers_(flat(given, worlds, what), 'f', 3, what) {
    n_ = numbers_.rows() / worlds;
  }
  std::span<const Vec3f> of(std::size_t world) const { return numbers_.vectors().subspan(world * n_, n_); }
  /// Throws an Error unless all are finite, so that a setter changes all worlds or none.
  void require_finite(const std::string& object, const char* what) const {
    const std::span<const Vec3f> all = numbers_.vectors();
    const auto is_finite = [](const Vec3f& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); };
    const auto bad = std::find_if_not(all.begin(), all.end(), is_finite);
    if (bad == all.end()) return;
    const auto at = static_cast<std::size_t>(bad - all.begin());
    throw Error({.object = object, .element = "row " + std::to_string(at % n_) + " of world " + std::to_string(at / n_)},
                std::string(what) + " are not finite", "give finite numbers");
  }
  /// Also unless there is one for each particle.
  void require_each(const BatchObject& of, const char* what) const {
    require_finite(of.name, what);
    for (std::size_t i = 0; i < of.size(); ++i)
      if (const auto particles = static_cast<std::size_t>(of.view(i).particle_count()); particles != n_)
        throw Error({.object = of.name},
                    what + (" are " + std::to_string(n_)) + " for " + std::to_string(particles) + " particles of world " +
                        std::to_string(i),
                    "give one per particle");
  }

 private:
  static nb::object flat(nb::handle given, std::size_t worlds, const char* what) {
    nb::object array;
    try {
      array = nb::module_::import_("numpy").attr("asarray")(given);
    } catch (nb::python_error&) {
      throw Error({}, std::string(what) + " are no array of numbers", "pass a numpy array");
    }
    const nb::tuple shape = nb::cast<nb::tuple>(nb::object(array.attr("shape")));
    if (shape.size() != 3 || nb::cast<std::size_t>(shape[0]) != worlds || nb::cast<int>(shape[2]) != 3)
      throw Error({}, std::string(what) + " have the shape " + nb::cast<std::string>(nb::str(shape)),
                  "pass (" + std::to_string(worlds) + ", n, 3)");
    return array.attr("reshape")(nb::make_tuple(-1, 3));
  }

  Numbers numbers_;
  std::size_t n_ = 0;
};

using Write = void (ObjectHandle::*)(std::span<const Vec3f>);

/// Calls a function of each handle with its part of an array.
auto writer(Write write, const char* what) {
  return [write, what](const BatchObject& self, nb::handle given) {
    const VectorsOfWorlds vectors(given, self.size(), what);
    vectors.require_each(self, what);
    std::vector<ObjectHandle> handles = self.handles();
    for (std::size_t i = 0; i < self.size(); ++i) (handles[i].*write)(vectors.of(i));
  };
}

/// Adds to all or none: a sum of a velocity and an impulse may be too large for a float.
void add_impulses(const BatchObject& self, nb::handle given) {
  const VectorsOfWorlds vectors(given, self.size(), "impulses");
  vectors.require_each(self, "impulses");
  std::vector<ObjectHandle> handles = self.handles();
  std::vector<std::vector<Vec3f>> before;
  before.reserve(self.size());
  for (std::size_t i = 0; i < self.size(); ++i) before.push_back(self.view(i).velocities());
  std::size_t i = 0;
  try {
    for (; i < self.size(); ++i) handles[i].add_impulses(vectors.of(i));
  } catch (...) {
    while (i-- > 0) handles[i].set_velocities(before[i]);
    throw;
  }
}

using WriteSome = void (ObjectHandle::*)(std::span<const int>, std::span<const Vec3f>);

auto writer_of_some(WriteSome write, const char* which) {
  return [write, which](const BatchObject& self, nb::handle indices, nb::handle positions) {
    const Numbers some(indices, 'i', 0, which);
    const VectorsOfWorlds vectors(positions, self.size(), "positions");
    vectors.require_finite(self.name, "positions");
    std::vector<ObjectHandle> handles = self.handles();
    for (std::size_t i = 0; i < self.size(); ++i) (handles[i].*write)(some.integers(), vectors.of(i));
  };
}

void set_motor(const BatchObject& self, const std::string& joint, nb::handle targets, std::optional<float> most,
               const std::string& motor) {
  const Numbers all(targets, 'f', 0, "targets");
  if (all.rows() != self.size())
    throw Error({}, "there are " + std::to_string(all.rows()) + " targets",
                "pass one for each of " + std::to_string(self.size()) + " worlds");
  for (std::size_t i = 0; i < self.size(); ++i)
    if (!std::isfinite(all.floats()[i]))
      throw Error({.object = self.name}, "the target of world " + std::to_string(i) + " is not finite",
                  "give finite numbers");
  std::vector<ObjectHandle> handles = self.handles();
  for (std::size_t i = 0; i < self.size(); ++i) handles[i].set_motor(joint, {all.floats()[i], most, motor});
}

nb::tuple poses(const BatchObject& self, nb::handle body) {
  std::vector<Vec3f> positions;
  std::vector<Quatf> rotations;
  positions.reserve(self.size());
  rotations.reserve(self.size());
  for (std::size_t i = 0; i < self.size(); ++i) {
    const RigidPose pose = with_body(body, [&](const auto& b) { return self.view(i).pose(b); });
    positions.push_back(pose.position);
    rotations.push_back(pose.rotation);
  }
  return nb::make_tuple(vectors(positions), float_rows(&rotations.front().x, rotations.size(), 4));
}

std::vector<State> states(const Batch& self) {
  std::vector<State> all;
  all.reserve(self.worlds->size());
  for (const SharedWorld& world : *self.worlds) all.push_back(world->idle().state());
  return all;
}

/// Restores of(i) in each world. If one does not fit, all have what they had before.
template <class Of>
void restore_each(const Worlds& worlds, const Of& of) {
  std::vector<State> before;
  before.reserve(worlds.size());
  for (const SharedWorld& world : worlds) before.push_back(world->changing("restored").state());
  std::size_t i = 0;
  try {
    for (; i < worlds.size(); ++i) worlds[i]->idle().restore(of(i));
  } catch (...) {
    while (i-- > 0) worlds[i]->idle().restore(before[i]);
    throw;
  }
}

void restore(const Batch& self, nb::handle given) {
  const State* one = nullptr;
  if (nb::try_cast(given, one) && one != nullptr)
    return restore_each(*self.worlds, [&](std::size_t /*world*/) -> const State& { return *one; });
  std::vector<const State*> all;
  if (!nb::try_cast(given, all) || std::find(all.begin(), all.end(), nullptr) != all.end())
    throw nb::type_error("restore a State, or a list of them");
  if (all.size() != self.worlds->size())
    throw Error({}, "there are " + std::to_string(all.size()) + " states",
                "pass one for each of " + std::to_string(self.worlds->size()) + " worlds");
  restore_each(*self.worlds, [&](std::size_t i) -> const State& { return *all[i]; });
}

void bind_batch_object(nb::module_& m) {
  nb::class_<BatchObject>(m, "BatchObject",
                          "The objects of one name in all worlds of a Batch: batch[\"name\"]. Arrays have the shape "
                          "(worlds, n, 3). What is not "
                          "finite or of a wrong shape raises Error, and changes no world.")
      .def_ro("name", &BatchObject::name, "Their name.")
      .def_ro("particles", &BatchObject::particles, "Number of particles of each.")
      .def("__len__", &BatchObject::size, "Number of worlds.")
      .def(
          "positions",
          [](const BatchObject& self, nb::handle out) {
            return read_all(self, out, [](const ObjectView& view, std::span<Vec3f> into) { view.read_positions(into); });
          },
          nb::arg("out") = nb::none(),
          nb::sig("def positions(self, out: pliant._types.FloatArray | None = None) -> pliant._types.FloatArray"),
          "Positions in all worlds [m], shape (worlds, particles, 3). `out`: a C-contiguous float32 array to fill.")
      .def(
          "velocities",
          [](const BatchObject& self, nb::handle out) {
            return read_all(self, out, [](const ObjectView& view, std::span<Vec3f> into) { view.read_velocities(into); });
          },
          nb::arg("out") = nb::none(),
          nb::sig("def velocities(self, out: pliant._types.FloatArray | None = None) -> pliant._types.FloatArray"),
          "Velocities in all worlds [m/s], shape (worlds, particles, 3).")
      .def("poses", &poses, nb::arg("body") = 0,
           nb::sig("def poses(self, body: int | str = 0) -> tuple[pliant._types.FloatArray, pliant._types.FloatArray]"),
           "Poses of a rigid body: positions [m], shape (worlds, 3), and rotations (x, y, z, w), shape (worlds, 4).")
      .def("set_velocities", writer(&ObjectHandle::set_velocities, "velocities"), nb::arg("velocities"),
           nb::sig("def set_velocities(self, velocities: pliant._types.AnyArray) -> None"),
           "As Object.set_velocities() [m/s].")
      .def("add_impulses", &add_impulses, nb::arg("impulses"),
           nb::sig("def add_impulses(self, impulses: pliant._types.AnyArray) -> None"), "As Object.add_impulses() [N s].")
      .def("set_forces", writer(&ObjectHandle::set_forces, "forces"), nb::arg("forces"),
           nb::sig("def set_forces(self, forces: pliant._types.AnyArray) -> None"), "As Object.set_forces() [N].")
      .def("set_targets", writer_of_some(&ObjectHandle::set_targets, "particles"), nb::arg("particles"),
           nb::arg("positions"),
           nb::sig("def set_targets(self, particles: pliant._types.IntsLike, positions: pliant._types.AnyArray) -> None"),
           "As Object.set_targets(): the same particles in all worlds, positions of shape (worlds, n, 3) [m].")
      .def(
          "set_attachment_targets", writer_of_some(&ObjectHandle::set_attachment_targets, "attachments"),
          nb::arg("attachments"), nb::arg("positions"),
          nb::sig(
              "def set_attachment_targets(self, attachments: pliant._types.IntsLike, positions: pliant._types.AnyArray) -> "
              "None"),
          "As Object.set_attachment_targets(), positions of shape (worlds, n, 3) [m].")
      .def("set_motor", &set_motor, nb::arg("joint"), nb::arg("targets"), nb::arg("most") = nb::none(),
           nb::arg("motor") = "",
           nb::sig(
               "def set_motor(self, joint: str, targets: typing.Any, most: float | None = None, motor: str = '') -> None"),
           "As Object.set_motor(), with a target for each world.")
      .def("__repr__", [](const BatchObject& self) {
        return "<pliant.BatchObject '" + self.name + "': " + std::to_string(self.size()) + " worlds, " +
               std::to_string(self.particles) + " particles>";
      });
}

}  // namespace

void bind_batch(nb::module_& m) {
  bind_batch_object(m);
  nb::class_<Batch>(m, "Batch",
                    "Many worlds of a scene that step side by side, each on one thread, with the bits that it has "
                    "alone.\n\nBatch(scene, n) "
                    "makes n equal worlds. `vary`: values of members that differ, {JSON pointer: n values}, or a function "
                    "(scene, i) that "
                    "changes a copy of the scene for world i. `threads`: how many worlds step at once; 0: as many as the "
                    "machine has threads.")
      .def(
          "__init__",
          [](Batch* self, nb::handle scene, int n, nb::handle vary, int threads) {
            new (self) Batch(make_batch(scene, n, vary, threads));
          },
          nb::arg("scene"), nb::arg("n"), nb::arg("vary") = nb::none(), nb::arg("threads") = 0,
          nb::sig("def __init__(self, scene: pliant._scene.SceneLike, n: int, vary: pliant._scene.Vary | None = None, "
                  "threads: int = "
                  "0) -> None"),
          "Makes the worlds, side by side.")
      .def("step", &step_batch, nb::arg("dt") = nb::none(),
           nb::sig("def step(self, dt: float | None = None) -> list[Report]"),
           "Advances all worlds by one frame of `dt` seconds; None: the scene's. Returns the Report of each. After Ctrl-C "
           "the "
           "worlds may be at different frames: restore states() that you kept.")
      .def("run", &run_frames, nb::arg("frames") = nb::none(),
           nb::sig("def run(self, frames: int | None = None) -> list[Report]"),
           "Runs frames in all worlds, the scene's own number if None, and returns the last Report of each. A world ends "
           "early where "
           "its Report is not ok.")
      .def("states", &states, "The State of each world.")
      .def("restore", &restore, nb::arg("state"), nb::sig("def restore(self, state: State | list[State]) -> None"),
           "Restores one State in all worlds, or a list of one for each. If one does not fit, raises Error and changes "
           "none.")
      .def(
          "state_hashes",
          [](const Batch& self) {
            std::vector<std::string> hashes;
            hashes.reserve(self.worlds->size());
            for (const SharedWorld& world : *self.worlds) hashes.push_back(world->idle().state_hash());
            return hashes;
          },
          "World.state_hash() of each world.")
      .def_prop_ro(
          "worlds",
          [](const Batch& self) {
            std::vector<WorldRef> all;
            all.reserve(self.worlds->size());
            for (const SharedWorld& world : *self.worlds) all.push_back({world});
            return all;
          },
          "The worlds, to read and control one by one.")
      .def("__getitem__", &object_named, nb::arg("name"), nb::sig("def __getitem__(self, name: str, /) -> BatchObject"),
           "The objects of that name in all worlds. Raises KeyError if a world has none, Error if their numbers of "
           "particles differ.")
      .def(
          "__len__", [](const Batch& self) { return self.worlds->size(); }, "Number of worlds.")
      .def("__repr__",
           [](const Batch& self) { return "<pliant.Batch of " + std::to_string(self.worlds->size()) + " worlds>"; });
}

}  // namespace pliant::python
