// Worlds: making, stepping, measuring, saving.
#include <cstddef>

#include "memory.h"
#include "pliant/describe.h"
#include "pliant/save.h"
#include "scene_handle.h"
#include "world_handle.h"

namespace pliant::c {

namespace {

std::shared_ptr<WorldHandle> loaded(LoadedWorld&& from) {
  return std::make_shared<WorldHandle>(std::move(from.world), from.scene.frame_time, from.scene.frames);
}

/// Puts a World into the table, and lets pliant_world_stop stop it.
void give_world(std::shared_ptr<WorldHandle> made, pliant_world** into) {
  WorldHandle& world = *made;
  pliant_world* handle = nullptr;
  give_handle(std::move(made), &handle);
  world.world.stop_when(find(handle, Kind::world).stop);
  *into = handle;
}

/// Marks a World as being in a step, or in a run of steps.
class Stepping {
 public:
  explicit Stepping(WorldHandle& world) : world_(world) {
    if (world.is_stepping.exchange(true))
      throw StatusError(PLIANT_BUSY, "the World is in a step", "call again after it");
  }
  ~Stepping() { world_.is_stepping.store(false); }
  Stepping(const Stepping&) = delete;
  Stepping& operator=(const Stepping&) = delete;

 private:
  WorldHandle& world_;
};

/// Steps a World that is marked. Throws a StatusError if the step did not complete its frame.
void step(WorldHandle& world, float dt) {
  const std::int64_t frame = world.world.state().frame;
  world.report = world.world.step(dt);
  if (!world.report.ok())
    throw StatusError(PLIANT_NOT_FINITE, world.report.explain(), "restore an earlier state, and mend what is said");
  if (world.report.stopped)
    throw StatusError(PLIANT_STOPPED, "the step was stopped", "call pliant_world_stop with 0 to go on");
  if (world.world.state().frame == frame) throw StatusError(PLIANT_REFUSED, world.report.explain());
}

const NamedNumber<const Measurements&> measures[] = {
    {"kinetic_energy", [](const Measurements& of) { return of.kinetic_energy(); }},
    {"potential_energy", [](const Measurements& of) { return of.potential_energy(); }},
    {"stretch.mean", [](const Measurements& of) { return of.stretch().mean; }},
    {"stretch.p99", [](const Measurements& of) { return of.stretch().p99; }},
    {"stretch.largest", [](const Measurements& of) { return of.stretch().largest; }},
    {"overstretch.p99", [](const Measurements& of) { return of.overstretch().p99; }},
    {"overstretch.largest", [](const Measurements& of) { return of.overstretch().largest; }},
    {"tetrahedra.inverted", [](const Measurements& of) { return static_cast<double>(of.tetrahedra().inverted); }},
    {"tetrahedra.least_ratio", [](const Measurements& of) { return of.tetrahedra().least_ratio; }},
    {"tetrahedra.volume_ratio", [](const Measurements& of) { return of.tetrahedra().volume_ratio; }},
};

}  // namespace

}  // namespace pliant::c

using namespace pliant;
using namespace pliant::c;

pliant_status pliant_world_create(const pliant_scene* scene, int32_t threads, pliant_world** world) {
  return guarded([&] {
    const auto from = at(scene);
    require(world, "world");
    if (threads < 0 || threads > 1024)
      throw StatusError(PLIANT_REFUSED, "'threads' is " + std::to_string(threads), "give 0 to 1024");
    const int own = from->scene.settings.threads;
    if (threads > 0) from->scene.settings.threads = threads;
    try {
      auto made = std::make_shared<WorldHandle>(World(from->scene, KeepDescription{}), from->scene.frame_time,
                                                from->scene.frames);
      made->folder = from->folder;
      from->scene.settings.threads = own;
      give_world(std::move(made), world);
    } catch (...) {
      from->scene.settings.threads = own;
      throw;
    }
  });
}

pliant_status pliant_world_free(pliant_world* world) {
  return guarded([&] {
    if (world == nullptr) return;
    if (at<pliant_world>(world)->is_stepping)
      throw StatusError(PLIANT_BUSY, "the World is in a step", "free it after the step");
    take(world, Kind::world);
  });
}

pliant_status pliant_world_step(pliant_world* world, float dt) {
  return guarded([&] {
    const auto of = at(world);
    const Stepping stepping(*of);
    step(*of, dt == 0 ? of->frame_time : dt);
  });
}

pliant_status pliant_world_run(pliant_world* world, int64_t frames, int64_t* done) {
  return guarded([&] {
    const auto of = at(world);
    if (frames < 0) throw StatusError(PLIANT_REFUSED, "'frames' is " + std::to_string(frames), "give 0 or more");
    if (done != nullptr) *done = 0;
    const Stepping stepping(*of);
    for (std::int64_t i = 0; i < frames; ++i) {
      step(*of, of->frame_time);
      if (done != nullptr) ++*done;
    }
  });
}

pliant_status pliant_world_stop(pliant_world* world, int32_t stop) {
  if (world == nullptr) return PLIANT_NULL;
  std::atomic<bool>* flag = stop_flag(world);
  if (flag == nullptr) return PLIANT_STALE;
  flag->store(stop != 0);
  return PLIANT_OK;
}

pliant_status pliant_world_get_info(const pliant_world* world, pliant_world_info* info) {
  return guarded([&] {
    const auto handle = at(world);
    const World& of = handle->world;
    pliant_world_info facts{};
    facts.time = of.state().time;
    facts.frame = of.state().frame;
    facts.frame_time = handle->frame_time;
    facts.frames = handle->frames;
    facts.objects = of.object_count();
    facts.colliders = static_cast<std::int64_t>(of.colliders().size());
    facts.mesh_colliders = static_cast<std::int64_t>(of.mesh_colliders().size());
    facts.threads = of.threads();
    give(facts, info, "info");
  });
}

pliant_status pliant_world_hash(const pliant_world* world, char* into, size_t capacity, size_t* length) {
  return guarded([&] { give_text(at(world)->world.state_hash(), {into, capacity, length}); });
}

pliant_status pliant_world_describe(const pliant_world* world, char* into, size_t capacity, size_t* length) {
  return guarded([&] { give_text(describe(at(world)->world), {into, capacity, length}); });
}

pliant_status pliant_world_measure(const pliant_world* world, const char* name, double* value) {
  return guarded([&] {
    const auto of = at(world);
    require(name, "name");
    require(value, "value");
    const auto* measure = find_number(measures, name);
    if (measure == nullptr)
      throw StatusError(PLIANT_NOT_FOUND, std::string("there is no measure '") + name + "'",
                        "the comment on pliant_world_measure lists them");
    *value = measure->value(of->world.measure());
  });
}

pliant_status pliant_world_scene(const pliant_world* world, pliant_scene** scene) {
  return guarded([&] {
    const auto of = at(world);
    require(scene, "scene");
    auto made = std::make_shared<SceneHandle>();
    made->scene = of->world.description();
    made->forces = made->scene.forces;
    made->folder = of->folder;
    give_handle(std::move(made), scene);
  });
}

pliant_status pliant_world_save(const pliant_world* world, const char* path) {
  return guarded([&] {
    const auto of = at(world);
    require(path, "path");
    save(path, of->world);
  });
}

pliant_status pliant_world_load(const char* path, pliant_world** world) {
  return guarded([&] {
    require(path, "path");
    require(world, "world");
    give_world(loaded(load_world(path)), world);
  });
}

pliant_status pliant_world_bytes(const pliant_world* world, void* into, size_t capacity, size_t* count) {
  return guarded([&] {
    const std::vector<std::byte> bytes = save_bytes(at(world)->world);
    give_list<std::byte>(bytes, {static_cast<std::byte*>(into), capacity, count}, "bytes");
  });
}

pliant_status pliant_world_from_bytes(const void* bytes, size_t count, pliant_world** world) {
  return guarded([&] {
    require(bytes, "bytes");
    require(world, "world");
    give_world(loaded(load_world_bytes({static_cast<const std::byte*>(bytes), count})), world);
  });
}
