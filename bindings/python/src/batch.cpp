// pliant.Batch: many worlds stepped on all threads, one thread each.
#include <algorithm>
#include <cmath>
#include <deque>

#include "batch.h"
#include "crew.h"
#include "pliant/error.h"
#include "world.h"

namespace pliant::python {

namespace {

struct Batch {
  std::shared_ptr<const Worlds> worlds;
  std::unique_ptr<Crew> crew;
};

std::shared_ptr<const Worlds> make_worlds(const std::vector<Description>& descriptions, int n, Crew& crew) {
  std::vector<std::unique_ptr<OwnedWorld>> made(static_cast<std::size_t>(n));
  const auto make = [&](int i) {
    const Description& one = descriptions[descriptions.size() == 1 ? 0 : static_cast<std::size_t>(i)];
    Settings settings = one.scene().settings;
    settings.threads = 1;
    made[static_cast<std::size_t>(i)] = std::make_unique<OwnedWorld>(one.file, World(one.scene(), settings));
  };
  crew.run(n, make, [] {});
  auto worlds = std::make_shared<Worlds>();
  worlds->reserve(made.size());
  for (std::unique_ptr<OwnedWorld>& world : made) worlds->emplace_back(std::move(world));
  return worlds;
}

Batch make_batch(nb::handle scene, int n, nb::handle vary, int threads) {
  if (n < 1 || n > 1000000) throw Error({}, "a batch of " + std::to_string(n) + " worlds", "make 1 to 1 000 000");
  if (threads < 0 || threads > 1024)
    throw Error({}, "threads is " + std::to_string(threads), "pass 0, for all of the machine, to 1024");
  const nb::object variants = python_part("pliant._scene", "variants")(scene, n, vary);
  const auto descriptions = nb::cast<std::vector<Description>>(variants);
  auto crew = std::make_unique<Crew>(threads);
  auto worlds = make_worlds(descriptions, n, *crew);
  return {std::move(worlds), std::move(crew)};
}

/// Marks all worlds as stepping; none if one is already.
std::deque<Stepping> mark_all(const Worlds& worlds) {
  std::deque<Stepping> all;  // marks do not move
  for (const SharedWorld& world : worlds) all.emplace_back(*world);
  return all;
}

nb::list run(const Batch& self, std::optional<float> dt, int frames) {
  const Worlds& worlds = *self.worlds;
  std::deque<Stepping> stepping = mark_all(worlds);
  std::vector<NamedReport> reports;
  reports.reserve(worlds.size());
  for (const SharedWorld& world : worlds) reports.push_back({{}, world->names()});
  const auto work = [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    Report& report = reports[at].report;
    for (int frame = 0; frame < frames && report.ok() && !report.stopped; ++frame)
      report = stepping[at].advance(dt.value_or(worlds[at]->frame_time()));
  };
  self.crew->run(static_cast<int>(worlds.size()), work, [&] {
    for (const SharedWorld& world : worlds) world->stop = true;
  });
  for (std::size_t i = 0; i < worlds.size(); ++i) worlds[i]->answer(reports[i].report);
  nb::list list;
  for (NamedReport& report : reports) list.append(nb::cast(std::move(report)));
  return list;
}

nb::list step_batch(const Batch& self, nb::handle dt) {
  return run(self, dt.is_none() ? std::optional<float>{} : time_step_from(dt), 1);
}

nb::list run_frames(const Batch& self, nb::handle given) {
  std::optional<int> frames;
  if (PyBool_Check(given.ptr()) != 0 || !nb::try_cast(given, frames))
    throw wrong_type("frames", given, "an int, or None");
  const int count = frames.value_or(self.worlds->front()->file().scene.frames);
  if (count < 1) throw Error({}, "frames is " + std::to_string(count), "run 1 or more");
  return run(self, {}, count);
}

std::vector<State> states(const Batch& self) {
  std::vector<State> all;
  all.reserve(self.worlds->size());
  for (const SharedWorld& world : *self.worlds) all.push_back(world->idle().state());
  return all;
}

/// Restores of(i) in each world. If one does not fit, all have what they had before, but what was set for the next
/// step.
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
    throw wrong_type("state", given, "a State, or a list of one for each world");
  if (all.size() != self.worlds->size())
    throw Error({}, "there are " + std::to_string(all.size()) + " states",
                "pass one for each of " + std::to_string(self.worlds->size()) + " worlds");
  restore_each(*self.worlds, [&](std::size_t i) -> const State& { return *all[i]; });
}

}  // namespace

void bind_batch(nb::module_& m) {
  bind_batch_object(m);
  static PyType_Slot slots[] = {{Py_tp_setattro, reinterpret_cast<void*>(refuse_attribute)}, {0, nullptr}};
  nb::class_<Batch>(
      m, "Batch", nb::type_slots(slots),
      "Many worlds of a scene that step side by side, each on one thread, with the bits that it has "
      "alone.\n\nBatch(scene, n) makes n equal worlds. `vary`: values of members that differ, {JSON "
      "pointer: n values}, or a function (scene, i) that changes a copy of the scene for world i and returns nothing. "
      "`threads`: how many worlds step at once; 0: as many as the machine has threads.")
      .def(
          "__init__",
          [](Batch* self, nb::handle scene, int n, nb::handle vary, int threads) {
            new (self) Batch(make_batch(scene, n, vary, threads));
          },
          nb::arg("scene"), nb::arg("n"), nb::arg("vary") = nb::none(), nb::arg("threads") = 0,
          nb::sig("def __init__(self, scene: pliant._scene.SceneLike, n: int, vary: pliant._scene.Vary | None = None, "
                  "threads: int = 0) -> None"),
          "Makes the worlds, side by side.")
      .def("step", &step_batch, nb::arg("dt") = nb::none(),
           nb::sig("def step(self, dt: float | None = None) -> list[Report]"),
           "Advances all worlds by one frame of `dt` seconds; None: the scene's. Returns the Report of each. After "
           "Ctrl-C the worlds may be at different frames: restore states() that you kept.")
      .def("run", &run_frames, nb::arg("frames") = nb::none(),
           nb::sig("def run(self, frames: int | None = None) -> list[Report]"),
           "Runs frames in all worlds, the scene's own number if None, and returns the last Report of each. A world "
           "ends early where its Report is not ok.")
      .def("states", &states, "The State of each world.")
      .def("restore", &restore, nb::arg("state"), nb::sig("def restore(self, state: State | list[State]) -> None"),
           "Restores one State in all worlds, or a list of one for each. If one does not fit, raises Error, and all "
           "have the State that they had; forces, targets and poses that were set for the next step may then be gone.")
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
      .def(
          "record_joint_loads",
          [](const Batch& self, bool on) {
            for (const SharedWorld& world : *self.worlds) world->idle().record_joint_loads(on);
          },
          nb::arg("on") = true, "World.record_joint_loads() of each world, for BatchObject.mean_joint_loads().")
      .def(
          "record_contact_events",
          [](const Batch& self, bool on) {
            for (const SharedWorld& world : *self.worlds) world->record_contacts(on);
          },
          nb::arg("on") = true, "World.record_contact_events() of each world; batch.worlds have the events.")
      .def(
          "__getitem__", [](const Batch& self, const std::string& name) { return batch_object(self.worlds, name); },
          nb::arg("name"), nb::sig("def __getitem__(self, name: str, /) -> BatchObject"),
          "The objects of that name in all worlds. Raises KeyError if a world has none, Error if their numbers of "
          "particles differ.")
      .def(
          "__len__", [](const Batch& self) { return self.worlds->size(); }, "Number of worlds.")
      .def("__repr__",
           [](const Batch& self) { return "<pliant.Batch of " + std::to_string(self.worlds->size()) + " worlds>"; });
}

}  // namespace pliant::python
