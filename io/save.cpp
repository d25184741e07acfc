// What a saved State and a saved World contain (include/pliant/save.h).
#include "pliant/save.h"

#include <fmt/format.h>

#include <cstring>
#include <utility>

#include "core/sha256.h"
#include "io/save_archive.h"
#include "io/save_file.h"
#include "pliant/edit.h"
#include "pliant/error.h"

namespace pliant {

namespace {

using namespace save_file;

// ---------------------------------------------------------------- a State

/// Names of the blocks that every saved State has.
constexpr std::string_view time_block = "state.time", frame_block = "state.frame", blocks_block = "state.blocks",
                           positions_block = "state.positions", remainders_block = "state.remainders",
                           velocities_block = "state.velocities";
/// Names of blocks that a saved State has only if it has frames, channels, held poses or substeps.
constexpr std::string_view orientations_block = "state.orientations", spins_block = "state.angular_velocities",
                           inertias_block = "state.inverse_inertias", channels_block = "state.channels",
                           poses_block = "state.held_poses", substeps_block = "state.substeps",
                           contacts_block = "state.body_contacts", breaks_block = "state.broken_joints",
                           motors_block = "state.motors", rest_block = "state.rest_times",
                           grains_block = "state.grain_contacts", births_block = "state.births",
                           emitted_block = "state.emitted", factors_block = "state.rest_factors",
                           flowed_block = "state.flowed", surfaces_block = "state.surface_velocities";
const std::vector<std::string_view> state_blocks{
    time_block,         frame_block,   blocks_block,   positions_block, remainders_block, velocities_block,
    orientations_block, spins_block,   inertias_block, channels_block,  poses_block,      substeps_block,
    contacts_block,     breaks_block,  motors_block,   rest_block,      grains_block,     births_block,
    emitted_block,      factors_block, flowed_block,   surfaces_block};
constexpr std::string_view fingerprint_blocks[] = {"fingerprint.scene", "fingerprint.settings"};
constexpr std::string_view scene_block = "scene", settings_block = "settings", layout_block = "layout";

static_assert(sizeof(Record) == 16);

template <class T>
std::string bytes_of(const T& of) {
  std::string bytes;
  Output out([&](const void* data, std::size_t size) { bytes.append(static_cast<const char*>(data), size); },
             Take::all);
  out("", of);
  return bytes;
}

template <class T>
T read_bytes(const Contents& from, std::string_view name) {
  T of;
  Input in(from.text(name));
  in("", of);
  if (!in.complete())
    from.fail(fmt::format("is malformed: its block '{}' cannot be read", name), "use an earlier file");
  return of;
}

/// Memory for columns that are collected from lists of structs.
struct Columns {
  std::string blocks, channels, held_poses;
};

/// The blocks of a State; `columns` has memory for some. A new member of State is a compile error here until it is
/// written.
std::vector<Block> blocks_of(const State& state, Columns& columns) {
  const auto& [time, frame, object_blocks, positions, remainders, velocities, frames, channels, held_poses, substeps,
               broken_joints, motors, body_contacts, rest_times, grain_contacts, births, emitted, rest_factors, flowed,
               surface_velocities] = state;
  const auto bytes = [](std::string_view name, const std::string& column) {
    return Block{name, Type::bytes, 1, column.size(), column.data()};
  };
  columns = {bytes_of(object_blocks), bytes_of(channels), bytes_of(held_poses)};
  const auto& [orientations, angular_velocities, inverse_inertias] = frames;
  const auto records = [](std::string_view name, const Records& column) {
    return Block{name, Type::record, sizeof(Record), column.size(), column.data()};
  };
  std::vector<Block> blocks{{time_block, Type::float64, sizeof time, 1, &time},
                            {frame_block, Type::int64, sizeof frame, 1, &frame},
                            bytes(blocks_block, columns.blocks),
                            records(positions_block, positions),
                            records(remainders_block, remainders),
                            records(velocities_block, velocities)};
  if (!orientations.empty()) {
    blocks.push_back(records(orientations_block, orientations));
    blocks.push_back(records(spins_block, angular_velocities));
    blocks.push_back(records(inertias_block, inverse_inertias));
  }
  if (!channels.empty()) blocks.push_back(bytes(channels_block, columns.channels));
  if (!held_poses.empty()) blocks.push_back(bytes(poses_block, columns.held_poses));
  if (!substeps.empty())
    blocks.push_back({substeps_block, Type::float32, sizeof(float), substeps.size(), substeps.data()});
  if (!broken_joints.empty())
    blocks.push_back({breaks_block, Type::bytes, 1, broken_joints.size() * sizeof(BrokenJoint), broken_joints.data()});
  if (!motors.empty())
    blocks.push_back({motors_block, Type::bytes, 1, motors.size() * sizeof(MotorSetting), motors.data()});
  if (!body_contacts.empty())
    blocks.push_back(
        {contacts_block, Type::bytes, 1, body_contacts.size() * sizeof(BodyContact), body_contacts.data()});
  if (!rest_times.empty())
    blocks.push_back({rest_block, Type::float32, sizeof(float), rest_times.size(), rest_times.data()});
  if (!grain_contacts.empty())
    blocks.push_back(
        {grains_block, Type::bytes, 1, grain_contacts.size() * sizeof(GrainContact), grain_contacts.data()});
  if (!births.empty()) blocks.push_back({births_block, Type::float64, sizeof(double), births.size(), births.data()});
  if (!emitted.empty())
    blocks.push_back({emitted_block, Type::bytes, 1, emitted.size() * sizeof(EmittedLayers), emitted.data()});
  if (!rest_factors.empty())
    blocks.push_back({factors_block, Type::bytes, 1, rest_factors.size() * sizeof(RestFactor), rest_factors.data()});
  if (!flowed.empty()) blocks.push_back({flowed_block, Type::float32, sizeof(float), flowed.size(), flowed.data()});
  if (!surface_velocities.empty())
    blocks.push_back({surfaces_block, Type::bytes, 1, surface_velocities.size() * sizeof(SurfaceVelocity),
                      surface_velocities.data()});
  return blocks;
}

void read(const Contents& from, std::string_view name, Records& column) {
  const Block& block = from.block(name, Type::record, sizeof(Record));
  column.resize(block.count);
  if (block.count > 0) std::memcpy(column.data(), block.data, block.count * sizeof(Record));
}

void read(const Contents& from, std::string_view name, std::vector<float>& column) {
  const Block& block = from.block(name, Type::float32, sizeof(float));
  column.resize(block.count);
  if (block.count > 0) std::memcpy(column.data(), block.data, block.count * sizeof(float));
}

template <class T>
void read(const Contents& from, std::string_view name, Type type, T& value) {
  const Block& block = from.block(name, type, sizeof value);
  if (block.count != 1)
    from.fail(fmt::format("is malformed: it has {} values in '{}'", block.count, name), "use an earlier file");
  std::memcpy(&value, block.data, sizeof value);
}

/// Reads a list of structs that was written as it is in memory.
template <class T>
void read_list(const Contents& from, std::string_view name, std::vector<T>& list) {
  const std::string_view bytes = from.text(name);
  if (bytes.size() % sizeof(T) != 0)
    from.fail(fmt::format("is malformed: its block '{}' has {} bytes", name, bytes.size()), "use an earlier file");
  list.resize(bytes.size() / sizeof(T));
  std::memcpy(static_cast<void*>(list.data()), bytes.data(), bytes.size());
}

State state_in(const Contents& from) {
  State state;
  auto& [time, frame, blocks, positions, remainders, velocities, frames, channels, held_poses, substeps, broken_joints,
         motors, body_contacts, rest_times, grain_contacts, births, emitted, rest_factors, flowed, surface_velocities] =
      state;
  read(from, time_block, Type::float64, time);
  read(from, frame_block, Type::int64, frame);
  blocks = read_bytes<std::vector<StateBlock>>(from, blocks_block);
  read(from, positions_block, positions);
  read(from, remainders_block, remainders);
  read(from, velocities_block, velocities);
  if (remainders.size() != positions.size() || velocities.size() != positions.size())
    from.fail("is malformed: its positions, remainders and velocities differ in number", "use an earlier file");
  if (from.has(orientations_block)) {
    read(from, orientations_block, frames.orientations);
    read(from, spins_block, frames.angular_velocities);
    read(from, inertias_block, frames.inverse_inertias);
  }
  if (from.has(channels_block)) channels = read_bytes<std::vector<Channel>>(from, channels_block);
  if (from.has(poses_block)) held_poses = read_bytes<std::vector<HeldPose>>(from, poses_block);
  if (from.has(substeps_block)) read(from, substeps_block, substeps);
  if (from.has(breaks_block)) read_list(from, breaks_block, broken_joints);
  if (from.has(motors_block)) read_list(from, motors_block, motors);
  if (from.has(contacts_block)) read_list(from, contacts_block, body_contacts);
  if (from.has(rest_block)) read(from, rest_block, rest_times);
  if (from.has(grains_block)) read_list(from, grains_block, grain_contacts);
  if (from.has(births_block)) {
    const Block& block = from.block(births_block, Type::float64, sizeof(double));
    births.resize(block.count);
    if (block.count > 0) std::memcpy(births.data(), block.data, block.count * sizeof(double));
  }
  if (from.has(emitted_block)) read_list(from, emitted_block, emitted);
  if (from.has(factors_block)) read_list(from, factors_block, rest_factors);
  if (from.has(flowed_block)) read(from, flowed_block, flowed);
  if (from.has(surfaces_block)) read_list(from, surfaces_block, surface_velocities);
  return state;
}

/// The given names, and those of all blocks of a State.
std::vector<std::string_view> with_state_blocks(std::vector<std::string_view> names) {
  names.insert(names.end(), state_blocks.begin(), state_blocks.end());
  return names;
}

/// The contents of a file, or of bytes in memory that `from` names, whose blocks are those of a State.
template <class... From>
Contents state_contents(const From&... from) {
  Contents contents(from..., Content::state);
  contents.refuse_unknown(with_state_blocks({fingerprint_blocks[0], fingerprint_blocks[1]}));
  return contents;
}

// ---------------------------------------------------------------- a Scene

template <class T, class... More>
std::string hash_of(const T& of, const More&... more) {
  Sha256 sha;
  Output out([&](const void* data, std::size_t size) { sha.add(data, size); }, Take::deciding);
  out("", of, more...);
  return sha.finish();
}

std::size_t count_of(const Object& object) {
  std::size_t count = 0;
  for (const ConstraintGroup& group : object.constraints) count += group.particles.size();
  return count;
}

void refuse_other_scene(const World& world, const Scene& scene) {
  const auto refuse = [](const Location& where, const std::string& problem) {
    throw Error(where, problem, "pass a scene of the World's current contents, in the order of its ids");
  };
  const auto require = [&](std::size_t in_world, std::size_t in_scene, const char* what) {
    if (in_world != in_scene) refuse({}, fmt::format("the World has {} {} and the scene {}", in_world, what, in_scene));
  };
  const std::vector<ObjectId> objects = world.objects();
  require(objects.size(), scene.objects.size(), "objects");
  require(world.colliders().size(), scene.colliders.size(), "colliders");
  require(world.mesh_colliders().size(), scene.mesh_colliders.size(), "mesh colliders");
  for (std::size_t o = 0; o < objects.size(); ++o) {
    const Object& object = scene.objects[o];
    const ObjectInfo info = world.object(objects[o]).info();
    Location where;
    where.object = object.name;
    if (info.name != object.name)
      refuse(where, "is '" + object.name + "' in the scene and '" + info.name + "' in the World");
    if (static_cast<std::size_t>(info.particles) != object.positions.size())
      refuse(where, fmt::format("has {} particles, and {} in the World", object.positions.size(), info.particles));
    if (comes_apart(object) && count_of(object) != count_of(world.object(objects[o]).description()))
      refuse(where, "has constraints that have broken in the World");
  }
}

void refuse_force_fields(const Scene& scene) {
  if (scene.forces.empty()) return;
  throw Error({}, "the scene has force fields, which are functions and cannot be saved",
              "save the State alone, and make the World from the scene in code");
}

/// The blocks of a fingerprint.
void add(std::vector<Block>& blocks, const Fingerprint& of) {
  blocks.push_back({fingerprint_blocks[0], Type::bytes, 1, of.scene.size(), of.scene.data()});
  blocks.push_back({fingerprint_blocks[1], Type::bytes, 1, of.settings.size(), of.settings.data()});
}

void require_fingerprint(const Contents& contents, const Fingerprint& of) {
  if (!contents.has(fingerprint_blocks[0]) || !contents.has(fingerprint_blocks[1]))
    contents.fail("does not say which scene it was saved with", "save it with its scene, or load it without one");
  if (contents.text(fingerprint_blocks[0]) != of.scene)
    contents.fail("was saved with another scene, or this scene has changed since",
                  "use the scene that it was saved with");
  if (contents.text(fingerprint_blocks[1]) != of.settings) {
    contents.fail(
        "was saved with other settings of this scene: substeps, iterations, the sweep or contact settings differ",
        "use the settings that it was saved with");
  }
}

// ---------------------------------------------------------------- a World

/// Passes the blocks of a World to `write(content, blocks)`.
template <class Write>
auto save_world(const World& world, const Scene& scene, const Fingerprint* of, Write write) {
  refuse_other_scene(world, scene);
  refuse_force_fields(scene);
  Settings settings = world.settings();
  settings.isa.clear();  // another machine may lack it; all levels give the same bits
  const std::string scene_bytes = bytes_of(scene), settings_bytes = bytes_of(settings),
                    layout_bytes = bytes_of(world.layout());
  Columns columns;
  std::vector<Block> blocks = blocks_of(world.state(), columns);
  blocks.push_back({scene_block, Type::bytes, 1, scene_bytes.size(), scene_bytes.data()});
  blocks.push_back({settings_block, Type::bytes, 1, settings_bytes.size(), settings_bytes.data()});
  blocks.push_back({layout_block, Type::bytes, 1, layout_bytes.size(), layout_bytes.data()});
  if (of != nullptr) add(blocks, *of);
  return write(Content::world, blocks);
}

/// Writes to a file of that path.
auto to_file(const std::string& path) {
  return [&path](Content content, const std::vector<Block>& blocks) { write(path, content, blocks); };
}

template <class... From>
Contents world_contents(const From&... from) {
  Contents contents(from..., Content::world);
  contents.refuse_unknown(
      with_state_blocks({scene_block, settings_block, layout_block, fingerprint_blocks[0], fingerprint_blocks[1]}));
  return contents;
}

/// `keep...` is a KeepDescription or nothing.
template <class... Keep>
LoadedWorld world_in(const std::string& path, const Contents& contents, const Settings& settings, Keep... keep) {
  Scene scene = read_bytes<Scene>(contents, scene_block);
  scene.settings = settings;
  const State state = state_in(contents);
  try {
    World world(scene, read_bytes<WorldLayout>(contents, layout_block), keep...);
    world.restore(state);
    return {std::move(scene), std::move(world)};
  } catch (const Error& error) {
    Location where = error.where();
    where.file = path;
    throw Error(where, error.problem(), "the file is malformed; use an earlier one");
  }
}

}  // namespace

// ---------------------------------------------------------------- public functions

Fingerprint fingerprint(const Scene& scene) {
  Settings settings = chosen_settings(scene);
  if (settings.sweep == Sweep::sequential) settings.sweep = Sweep::tiled;
  return {hash_of(scene, static_cast<std::uint64_t>(scene.forces.size())), hash_of(settings)};
}

void save(const std::string& path, const State& state) {
  Columns columns;
  write(path, Content::state, blocks_of(state, columns));
}

void save(const std::string& path, const State& state, const Fingerprint& of) {
  Columns columns;
  std::vector<Block> blocks = blocks_of(state, columns);
  add(blocks, of);
  write(path, Content::state, blocks);
}

State load_state(const std::string& path) { return state_in(state_contents(path)); }

State load_state(const std::string& path, const Fingerprint& of) {
  const Contents contents = state_contents(path);
  require_fingerprint(contents, of);
  return state_in(contents);
}

Scene present_scene(const World& world, Scene scene) {
  const std::vector<ObjectId> objects = world.objects();
  if (objects.size() != scene.objects.size())
    throw Error({}, fmt::format("the World has {} objects and the scene {}", objects.size(), scene.objects.size()),
                "pass the scene that the World was made from");
  for (std::size_t o = 0; o < objects.size(); ++o)
    if (comes_apart(scene.objects[o])) scene.objects[o] = world.object(objects[o]).description();
  return scene;
}

void save(const std::string& path, const World& world, const Scene& scene) {
  save_world(world, scene, nullptr, to_file(path));
}

void save(const std::string& path, const World& world, const Scene& scene, const Fingerprint& of) {
  save_world(world, scene, &of, to_file(path));
}

void save(const std::string& path, const World& world) { save(path, world, world.description()); }

std::vector<std::byte> save_bytes(const State& state) {
  Columns columns;
  return bytes_of(Content::state, blocks_of(state, columns));
}

std::vector<std::byte> save_bytes(const State& state, const Fingerprint& of) {
  Columns columns;
  std::vector<Block> blocks = blocks_of(state, columns);
  add(blocks, of);
  return bytes_of(Content::state, blocks);
}

std::vector<std::byte> save_bytes(const World& world, const Scene& scene) {
  return save_world(world, scene, nullptr,
                    [](Content content, const std::vector<Block>& blocks) { return bytes_of(content, blocks); });
}

std::vector<std::byte> save_bytes(const World& world) { return save_bytes(world, world.description()); }

State load_state_bytes(std::span<const std::byte> bytes, const std::string& name) {
  return state_in(state_contents(name, bytes));
}

State load_state_bytes(std::span<const std::byte> bytes, const Fingerprint& of, const std::string& name) {
  const Contents contents = state_contents(name, bytes);
  require_fingerprint(contents, of);
  return state_in(contents);
}

LoadedWorld load_world_bytes(std::span<const std::byte> bytes, const std::string& name) {
  const Contents contents = world_contents(name, bytes);
  return world_in(name, contents, read_bytes<Settings>(contents, settings_block), KeepDescription{});
}

LoadedWorld load_world(const std::string& path) {
  const Contents contents = world_contents(path);
  return world_in(path, contents, read_bytes<Settings>(contents, settings_block), KeepDescription{});
}

LoadedWorld load_world(const std::string& path, const Fingerprint& of, const Settings& settings) {
  const Contents contents = world_contents(path);
  require_fingerprint(contents, of);
  return world_in(path, contents, settings);
}

}  // namespace pliant
