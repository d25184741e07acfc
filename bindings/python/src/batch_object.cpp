// pliant.BatchObject: the particles of the objects of one name in all worlds, as arrays.
#include <algorithm>
#include <cmath>

#include "arrays.h"
#include "batch.h"
#include "pliant/error.h"

namespace pliant::python {

World& BatchObject::world(std::size_t i) const {
  World& found = (*worlds)[i]->idle();
  if (!found.has(ids[i]))
    throw Error({.object = name}, "was removed from world " + std::to_string(i) + " of the Batch",
                "read the objects of batch.worlds one by one");
  return found;
}

std::vector<ObjectHandle> BatchObject::handles() const {
  std::vector<ObjectHandle> all;
  all.reserve(size());
  for (std::size_t i = 0; i < size(); ++i) all.push_back(handle(i));
  return all;
}

BatchObject batch_object(const std::shared_ptr<const Worlds>& worlds, const std::string& name) {
  BatchObject object{worlds, {}, name, 0};
  object.ids.reserve(worlds->size());
  for (std::size_t i = 0; i < worlds->size(); ++i) {
    object.ids.push_back((*worlds)[i]->object(name));
    const auto particles = static_cast<std::size_t>(object.view(i).particle_count());
    if (i > 0 && particles != object.particles)
      throw Error({.object = name},
                  "has " + std::to_string(object.particles) + " particles in world 0, but " +
                      std::to_string(particles) + " in world " + std::to_string(i),
                  "read the objects of batch.worlds one by one");
    object.particles = particles;
  }
  return object;
}

namespace {

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
    const auto is_finite = [](const Vec3f& v) {
      return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
    };
    const auto bad = std::find_if_not(all.begin(), all.end(), is_finite);
    if (bad == all.end()) return;
    const auto at = static_cast<std::size_t>(bad - all.begin());
    throw Error(
        {.object = object, .element = "row " + std::to_string(at % n_) + " of world " + std::to_string(at / n_)},
        std::string(what) + " are not finite", "give finite numbers");
  }
  /// Throws an Error unless all are where a World accepts targets.
  void require_near(const std::string& object, const char* what) const {
    const std::span<const Vec3f> all = numbers_.vectors();
    const auto far = std::find_if_not(all.begin(), all.end(), is_near_origin);
    if (far == all.end()) return;
    const auto at = static_cast<std::size_t>(far - all.begin());
    throw Error(
        {.object = object, .element = "row " + std::to_string(at % n_) + " of world " + std::to_string(at / n_)},
        std::string(what) + " are more than 1e9 m from the origin", "give metres");
  }
  /// Also unless there is one for each particle.
  void require_each(const BatchObject& of, const char* what) const {
    require_finite(of.name, what);
    for (std::size_t i = 0; i < of.size(); ++i)
      if (const auto particles = static_cast<std::size_t>(of.view(i).particle_count()); particles != n_)
        throw Error({.object = of.name},
                    what + (" are " + std::to_string(n_)) + " for " + std::to_string(particles) +
                        " particles of world " + std::to_string(i),
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

/// True if an object accepts targets of these particles: those of finite mass that no pin holds are dynamic.
bool has_pins(const Object& object, std::span<const int> particles) {
  std::vector<bool> is_held(object.positions.size());
  for (std::size_t p = 0; p < object.masses.size(); ++p) is_held[p] = !std::isfinite(object.masses[p]);
  for (const Pin& pin : object.pins) is_held[static_cast<std::size_t>(pin.particle)] = true;
  return std::all_of(particles.begin(), particles.end(), [&](int p) {
    return p >= 0 && static_cast<std::size_t>(p) < is_held.size() && is_held[static_cast<std::size_t>(p)];
  });
}

bool has_attachments(const Object& object, std::span<const int> attachments) {
  return std::all_of(attachments.begin(), attachments.end(),
                     [&](int a) { return a >= 0 && static_cast<std::size_t>(a) < object.attachments.size(); });
}

using Accepts = bool (*)(const Object&, std::span<const int>);

/// Worlds that refuse come first: they say what is wrong before another one is changed.
auto writer_of_some(WriteSome write, Accepts accepts, const char* which) {
  return [write, accepts, which](const BatchObject& self, nb::handle indices, nb::handle positions) {
    const Numbers some(indices, 'i', 0, which);
    const VectorsOfWorlds vectors(positions, self.size(), "positions");
    vectors.require_finite(self.name, "positions");
    vectors.require_near(self.name, "positions");
    std::vector<ObjectHandle> handles = self.handles();
    for (std::size_t i = 0; i < self.size(); ++i)
      if (!accepts(self.present(i), some.integers())) (handles[i].*write)(some.integers(), vectors.of(i));
    for (std::size_t i = 0; i < self.size(); ++i) (handles[i].*write)(some.integers(), vectors.of(i));
  };
}

}  // namespace

void bind_batch_object(nb::module_& m) {
  nb::class_<BatchObject> c(m, "BatchObject", nb::type_slots(plain_slots()),
                            "The objects of one name in all worlds of a Batch: batch[\"name\"]. Arrays have the shape "
                            "(worlds, n, 3). What is not finite or of a wrong shape raises Error, and changes no "
                            "world.");
  c.def_ro("name", &BatchObject::name, "Their name.")
      .def_ro("particles", &BatchObject::particles, "Number of particles of each.")
      .def("__len__", &BatchObject::size, "Number of worlds.")
      .def(
          "positions",
          [](const BatchObject& self, nb::handle out) {
            return read_all(self, out,
                            [](const ObjectView& view, std::span<Vec3f> into) { view.read_positions(into); });
          },
          nb::arg("out") = nb::none(),
          nb::sig("def positions(self, out: pliant._types.FloatArray | None = None) -> pliant._types.FloatArray"),
          "Positions in all worlds [m], shape (worlds, particles, 3). `out`: a C-contiguous float32 array to fill.")
      .def(
          "velocities",
          [](const BatchObject& self, nb::handle out) {
            return read_all(self, out,
                            [](const ObjectView& view, std::span<Vec3f> into) { view.read_velocities(into); });
          },
          nb::arg("out") = nb::none(),
          nb::sig("def velocities(self, out: pliant._types.FloatArray | None = None) -> pliant._types.FloatArray"),
          "Velocities in all worlds [m/s], shape (worlds, particles, 3).")
      .def("set_velocities", writer(&ObjectHandle::set_velocities, "velocities"), nb::arg("velocities"),
           nb::sig("def set_velocities(self, velocities: pliant._types.AnyArray) -> None"),
           "As Object.set_velocities() [m/s].")
      .def("add_impulses", &add_impulses, nb::arg("impulses"),
           nb::sig("def add_impulses(self, impulses: pliant._types.AnyArray) -> None"),
           "As Object.add_impulses() [N s].")
      .def("set_forces", writer(&ObjectHandle::set_forces, "forces"), nb::arg("forces"),
           nb::sig("def set_forces(self, forces: pliant._types.AnyArray) -> None"), "As Object.set_forces() [N].")
      .def("set_targets", writer_of_some(&ObjectHandle::set_targets, &has_pins, "particles"), nb::arg("particles"),
           nb::arg("positions"),
           nb::sig(
               "def set_targets(self, particles: pliant._types.IntsLike, positions: pliant._types.AnyArray) -> None"),
           "As Object.set_targets(): the same particles in all worlds, positions of shape (worlds, n, 3) [m].")
      .def("set_attachment_targets",
           writer_of_some(&ObjectHandle::set_attachment_targets, &has_attachments, "attachments"),
           nb::arg("attachments"), nb::arg("positions"),
           nb::sig("def set_attachment_targets(self, attachments: pliant._types.IntsLike, positions: "
                   "pliant._types.AnyArray) -> None"),
           "As Object.set_attachment_targets(), positions of shape (worlds, n, 3) [m].")
      .def("__repr__", [](const BatchObject& self) {
        return "<pliant.BatchObject '" + self.name + "': " + std::to_string(self.size()) + " worlds, " +
               std::to_string(self.particles) + " particles>";
      });
  bind_batch_joints(c);
}

}  // namespace pliant::python
