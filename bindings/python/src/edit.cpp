// pliant.Edit: changes of an object of a World, made together.

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <span>

#include "arrays.h"
#include "object.h"
#include "pliant/edit.h"
#include "pliant/error.h"
#include "pliant/soft_body.h"
#include "world.h"

namespace pliant::python {

namespace {

/// An object's changed description, until it replaces the one in the World.
struct EditRef {
  SharedWorld world;
  ObjectId id;
  Edit edit;
  std::int64_t changes = 0;  ///< OwnedWorld::changes() of the object when the Edit was made
  bool is_applied = false;
  bool is_applying = false;  ///< in another thread, which reads `edit` without the GIL

  /// The description, to change or apply. Call it after all that can run Python, which may apply the Edit.
  Object& object() {
    if (is_applying)
      throw Error({.object = edit.object.name}, "this Edit is being applied in another thread",
                  "make another by World.edit() once that has ended");
    if (is_applied) throw Error({.object = edit.object.name}, "this Edit was applied", "make another by World.edit()");
    return edit.object;
  }
};

EditRef edit_of(const WorldRef& self, nb::handle thing) {
  ObjectId id;
  if (nb::isinstance<nb::str>(thing))
    id = self.world->object(nb::cast<std::string>(thing));
  else if (const ObjectRef* object = nullptr; nb::try_cast(thing, object) && object != nullptr)
    id = id_here(self, *object);
  else
    throw wrong_type("object", thing, "an Object of this World, or its name");
  (void)std::as_const(self.world->idle()).object(id).name();  // throws if it was removed
  return {self.world, id, unchanged(self.world->present(id)), self.world->changes(id)};
}

/// Makes another edit after the present one.
void follow(EditRef& self, Edit next) {
  for (int& from : next.from)
    if (from >= 0) from = self.edit.from[static_cast<std::size_t>(from)];
  self.edit = std::move(next);
}

void require_particles(const Object& object, std::span<const int> particles) {
  for (const int particle : particles)
    if (particle < 0 || static_cast<std::size_t>(particle) >= object.positions.size())
      throw Error({.object = object.name, .element = "particle " + std::to_string(particle)}, "does not exist",
                  "it has " + std::to_string(object.positions.size()) + " particles, and indices count from 0");
}

void pin(EditRef& self, nb::handle particles) {
  const Numbers which(particles, 'i', 0, "particles");
  Object& object = self.object();
  require_particles(object, which.integers());
  std::set<int> held;
  for (const Pin& one : object.pins) held.insert(one.particle);
  for (const int particle : which.integers())
    if (held.insert(particle).second) object.pins.push_back({particle, {}});
}

/// Removes what holds some particles. None: all.
template <class Held>
void let_go(EditRef& self, std::vector<Held> Object::*holds, nb::handle particles, const char* what) {
  if (particles.is_none()) return (self.object().*holds).clear();
  const Numbers which(particles, 'i', 0, "particles");
  Object& object = self.object();
  std::vector<Held>& all = object.*holds;
  require_particles(object, which.integers());
  std::set<int> held;
  for (const Held& one : all) held.insert(one.particle);
  for (const int particle : which.integers())
    if (!held.contains(particle))
      throw Error({.object = object.name, .element = "particle " + std::to_string(particle)},
                  std::string("has no ") + what, "name particles that have one");
  const std::set<int> gone(which.integers().begin(), which.integers().end());
  std::erase_if(all, [&](const Held& one) { return gone.contains(one.particle); });
}

void attach(EditRef& self, nb::handle particles, nb::handle targets, nb::handle compliance, nb::handle damping) {
  const Numbers which(particles, 'i', 0, "particles"), to(targets, 'f', 3, "targets");
  const auto stiffness = Stiffness::compliance(static_cast<float>(number_from(compliance, "compliance")),
                                               static_cast<float>(number_from(damping, "damping")));
  Object& object = self.object();
  require_particles(object, which.integers());
  if (which.rows() != to.rows())
    throw Error({.object = object.name},
                std::to_string(to.rows()) + " targets are given for " + std::to_string(which.rows()) + " particles",
                "give one for each");
  for (std::size_t i = 0; i < which.rows(); ++i)
    object.attachments.push_back({which.integers()[i], to.vectors()[i], {}, stiffness});
}

/// The groups of a type of constraints. Throws an Error with the types that there are.
std::vector<ConstraintGroup*> groups_of(Object& object, const std::string& type) {
  std::vector<ConstraintGroup*> found;
  std::set<std::string> types;
  for (ConstraintGroup& group : object.constraints) {
    types.insert(group.type);
    if (group.type == type) found.push_back(&group);
  }
  if (!found.empty()) return found;
  std::string all;
  for (const std::string& one : types) all += (all.empty() ? "'" : ", '") + one + "'";
  throw Error({.object = object.name}, "has no constraints of the type '" + type + "'",
              all.empty() ? "it has none at all" : "it has " + all);
}

void scale_stiffness(EditRef& self, const std::string& type, nb::handle factor) {
  const double by = number_from(factor, "factor");
  if (!(by > 0) || !std::isfinite(by)) throw Error({}, "factor is " + repr_of(factor), "give a finite number above 0");
  for (ConstraintGroup* group : groups_of(self.object(), type)) {
    if (group->stiffness.kind == Stiffness::Kind::pbd)
      throw Error({.object = self.edit.object.name}, "has constraints of the type '" + type + "' with a PBD stiffness",
                  "give them a compliance by describe(), or by set_compliance()");
    group->stiffness.value = static_cast<float>(group->stiffness.value / by);
    for (float& compliance : group->compliances) compliance = static_cast<float>(compliance / by);
  }
}

void set_compliance(EditRef& self, const std::string& type, nb::handle compliance, nb::handle damping) {
  const auto value = static_cast<float>(number_from(compliance, "compliance"));
  if (!(value >= 0) || !std::isfinite(value))
    throw Error({}, "compliance is " + repr_of(compliance), "give 0, for rigid, or a finite number above");
  std::optional<float> beta;
  if (!damping.is_none()) beta = static_cast<float>(number_from(damping, "damping"));
  for (ConstraintGroup* group : groups_of(self.object(), type)) {
    group->stiffness = Stiffness::compliance(value, beta.value_or(group->stiffness.damping));
    group->compliances.clear();
  }
}

void set_masses(EditRef& self, nb::handle masses) {
  const Numbers given(masses, 'f', 0, "masses");
  Object& object = self.object();
  if (given.rows() != object.positions.size())
    throw Error({.object = object.name},
                std::to_string(given.rows()) + " masses are given for " + std::to_string(object.positions.size()) +
                    " particles",
                "give one for each");
  const std::span<const float> all(given.floats(), given.rows());
  const auto bad = std::find_if_not(all.begin(), all.end(), [](float mass) { return mass > 0; });
  if (bad != all.end())
    throw Error({.object = object.name, .element = "particle " + std::to_string(bad - all.begin())},
                "has the mass " + repr_of(nb::float_(static_cast<double>(*bad))) + " kg",
                "give a number above 0; infinity fixes the particle");
  object.masses.assign(all.begin(), all.end());
}

void describe(EditRef& self, const nb::kwargs& members) {
  const std::string name = self.object().name;
  if (members.contains("name"))
    throw Error({.object = name}, "is given a name", "an object keeps the name that it has");
  nb::dict all;
  all["name"] = name;
  all.update(members);
  const Description one = described("objects", all, nb::list(), nb::list());
  Object object = one.scene().objects.front();
  Object& now = self.object();
  if (object.positions.size() != now.positions.size())
    throw Error({.object = name},
                "has " + std::to_string(now.positions.size()) + " particles, and the description " +
                    std::to_string(object.positions.size()),
                "remove the object, and add another");
  now = std::move(object);
}

/// Marks an Edit while World::edit reads it without the GIL: from construction to destruction, both with the GIL.
class Applying {
 public:
  explicit Applying(EditRef& edit) : edit_(edit) { edit_.is_applying = true; }
  ~Applying() { edit_.is_applying = false; }
  Applying(const Applying&) = delete;
  Applying& operator=(const Applying&) = delete;

 private:
  EditRef& edit_;
};

nb::object apply(EditRef& self) {
  (void)self.object();
  std::vector<int> news;
  {
    const Applying mark(self);
    news = self.world->edit(self.id, self.edit, self.changes);
  }
  self.is_applied = true;
  return integers(news);
}

template <class Held>
nb::object held_particles(const std::vector<Held>& all) {
  std::vector<int> particles;
  particles.reserve(all.size());
  for (const Held& one : all) particles.push_back(one.particle);
  return integers(particles);
}

/// A change by a function of pliant/edit.h that takes indices.
auto changed_by(Edit (*change)(const Object&, std::span<const int>), const char* what) {
  return [change, what](EditRef& self, nb::handle indices) {
    const Numbers numbers(indices, 'i', 0, what);
    follow(self, change(self.object(), numbers.integers()));
  };
}

void bind_facts(nb::class_<EditRef>& c) {
  c.def_prop_ro(
       "name", [](const EditRef& e) { return e.edit.object.name; }, "Name of the object.")
      .def_prop_ro(
          "particles", [](const EditRef& e) { return e.edit.object.positions.size(); }, "Number of particles now.")
      .def_prop_ro(
          "origins", [](const EditRef& e) { return integers(e.edit.from); },
          nb::sig("def origins(self) -> pliant._types.IntArray"),
          "For each particle now, the particle of the World from which it comes.")
      .def_prop_ro(
          "triangles",
          [](const EditRef& e) {
            const auto& all = e.edit.object.triangles;
            return int_rows(all.empty() ? nullptr : all.front().data(), all.size(), 3);
          },
          nb::sig("def triangles(self) -> pliant._types.IntArray"), "The triangles now, shape (n, 3).")
      .def_prop_ro(
          "tetrahedra",
          [](const EditRef& e) {
            const auto all = tetrahedra_of(e.edit.object);
            return int_rows(all.empty() ? nullptr : all.front().data(), all.size(), 4);
          },
          nb::sig("def tetrahedra(self) -> pliant._types.IntArray"), "The tetrahedra of a soft body now, shape (n, 4).")
      .def_prop_ro(
          "pins", [](const EditRef& e) { return held_particles(e.edit.object.pins); },
          nb::sig("def pins(self) -> pliant._types.IntArray"), "The pinned particles now.")
      .def_prop_ro(
          "attachments", [](const EditRef& e) { return held_particles(e.edit.object.attachments); },
          nb::sig("def attachments(self) -> pliant._types.IntArray"), "The particle of each attachment now.")
      .def_prop_ro(
          "masses",
          [](const EditRef& e) { return float_rows(e.edit.object.masses.data(), e.edit.object.masses.size(), 0); },
          nb::sig("def masses(self) -> pliant._types.FloatArray"), "Masses now [kg], without what pins do.");
}

void bind_holds(nb::class_<EditRef>& c) {
  c.def("pin", &pin, nb::arg("particles"), nb::sig("def pin(self, particles: pliant._types.IntsLike) -> None"),
        "Pins particles where they are: they become kinematic, and Object.set_targets() moves them. Those that are "
        "pinned stay so.")
      .def(
          "unpin", [](EditRef& e, nb::handle which) { let_go(e, &Object::pins, which, "pin"); },
          nb::arg("particles") = nb::none(),
          nb::sig("def unpin(self, particles: pliant._types.IntsLike | None = None) -> None"),
          "Lets pinned particles go; None: all. Raises Error if one is not pinned.")
      .def(
          "attach", &attach, nb::arg("particles"), nb::arg("targets"), nb::arg("compliance") = 0,
          nb::arg("damping") = 0,
          nb::sig("def attach(self, particles: pliant._types.IntsLike, targets: pliant._types.VectorsLike, compliance: "
                  "float = 0, damping: float = 0) -> None"),
          "Attaches particles to targets [m], shape (n, 3), by springs of a compliance [m/N]; 0: rigidly. `damping` [N "
          "s/m] is of a spring. The new attachments follow those that there are; Object.set_attachment_targets() moves "
          "the targets.")
      .def(
          "detach", [](EditRef& e, nb::handle which) { let_go(e, &Object::attachments, which, "attachment"); },
          nb::arg("particles") = nb::none(),
          nb::sig("def detach(self, particles: pliant._types.IntsLike | None = None) -> None"),
          "Removes the attachments of particles; None: all. Raises Error if one has none.");
}

void bind_cuts(nb::class_<EditRef>& c) {
  c.def("cut", changed_by(&cut, "path"), nb::arg("path"),
        nb::sig("def cut(self, path: pliant._types.IntsLike) -> None"),
        "Cuts a surface along a path of particles, each joined to the next by an edge. Particles inside the path and "
        "at ends on the border are split; the copies follow all others. Mass and momentum are conserved.")
      .def("remove_triangles", changed_by(&remove_triangles, "triangles"), nb::arg("triangles"),
           nb::sig("def remove_triangles(self, triangles: pliant._types.IntsLike) -> None"),
           "Removes triangles of a surface, by index, and the constraints that only they had.")
      .def("part_triangles", changed_by(&part_triangles, "part"), nb::arg("part"),
           nb::sig("def part_triangles(self, part: pliant._types.IntsLike) -> None"),
           "Parts a surface along edges: triangles of different `part` come apart, one number for each triangle.")
      .def("remove_tetrahedra", changed_by(&remove_tetrahedra, "tetrahedra"), nb::arg("tetrahedra"),
           nb::sig("def remove_tetrahedra(self, tetrahedra: pliant._types.IntsLike) -> None"),
           "Removes tetrahedra of a soft body, by index, with their mass.")
      .def("part_tetrahedra", changed_by(&part_tetrahedra, "part"), nb::arg("part"),
           nb::sig("def part_tetrahedra(self, part: pliant._types.IntsLike) -> None"),
           "Parts a soft body along faces: tetrahedra of different `part` come apart, one number for each.");
}

void bind_matter(nb::class_<EditRef>& c) {
  c.def("scale_stiffness", &scale_stiffness, nb::arg("type"), nb::arg("factor"),
        nb::sig("def scale_stiffness(self, type: str, factor: float) -> None"),
        "Multiplies the stiffness of all constraints of a type, as \"distance\" (Object.constraints lists them), by a "
        "factor > 0. What is rigid stays rigid.")
      .def("set_compliance", &set_compliance, nb::arg("type"), nb::arg("compliance"), nb::arg("damping") = nb::none(),
           nb::sig("def set_compliance(self, type: str, compliance: float, damping: float | None = None) -> None"),
           "Gives all constraints of a type one compliance >= 0, in the unit that docs/reference/constraints.md has "
           "for the type; 0: rigid. `damping`: None: as before.")
      .def("set_masses", &set_masses, nb::arg("masses"),
           nb::sig("def set_masses(self, masses: pliant._types.VectorLike) -> None"),
           "Sets the mass of each particle, > 0 [kg]; infinity: fixed. Velocities stay.")
      .def("describe", &describe, nb::arg("members"), nb::sig("def describe(self, **members: typing.Any) -> None"),
           "Replaces the description by one as of Scene.add(), with another material, thickness or pins, for example. "
           "It must have as many particles in the same order: each keeps position and velocity. What earlier calls "
           "changed is replaced.")
      .def("apply", &apply, nb::sig("def apply(self) -> pliant._types.IntArray"),
           "Makes the changes in the World, once. Returns for each old particle its first new index, or -1 where it is "
           "gone. If the description cannot be simulated, or the object was edited or torn since World.edit(), raises "
           "Error "
           "and changes nothing. The end of a `with` block calls it.");
}

}  // namespace

void bind_edit(nb::module_& m) {
  nb::class_<EditRef> c(m, "Edit", nb::type_slots(collected_slots<EditRef>()),
                        "Changes of an object of a World, made together by apply() or at the end of a `with` block: "
                        "World.edit() returns one. Particles keep position and velocity exactly, and the object its "
                        "name and id. Indices are those after earlier calls.");
  bind_facts(c);
  bind_holds(c);
  bind_cuts(c);
  bind_matter(c);
  c.def(
       "__enter__", [](nb::handle self) { return nb::borrow(self); }, nb::sig("def __enter__(self) -> Edit"), "Itself.")
      .def(
          "__exit__",
          [](EditRef& self, nb::handle type, nb::handle /*value*/, nb::handle /*trace*/) {
            if (type.is_none() && !self.is_applied) apply(self);
          },
          nb::arg("type").none(), nb::arg("value").none(), nb::arg("trace").none(),
          nb::sig("def __exit__(self, type: type[BaseException] | None, value: BaseException | None, trace: "
                  "types.TracebackType | None) -> None"),
          "Applies the changes, unless an exception ended the block or apply() was called.")
      .def("__repr__", [](const EditRef& e) {
        return "<pliant.Edit of '" + e.edit.object.name + "': " + std::to_string(e.edit.object.positions.size()) +
               " particles" + (e.is_applied ? ", applied>" : ">");
      });
}

void bind_editing(nb::class_<WorldRef>& c) {
  c.def("edit", &edit_of, nb::arg("object"), nb::sig("def edit(self, object: Object | str) -> Edit"),
        "An Edit of an object, which changes nothing yet: pins, attachments, cuts, stiffness, masses or the whole "
        "description. Raises KeyError if there is no object of that name.");
}

}  // namespace pliant::python
