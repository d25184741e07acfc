// What a State and a World are in a file (include/pliant/save.h).
#include "pliant/save.h"

#include <fmt/format.h>

#include <cstring>
#include <utility>

#include "core/sha256.h"
#include "io/save_archive.h"
#include "io/save_file.h"
#include "pliant/error.h"

namespace pliant {

namespace {

using namespace save_file;

// ---------------------------------------------------------------- a State

/// The names of a State's columns in a file.
constexpr std::string_view time_block = "state.time", frame_block = "state.frame", blocks_block = "state.blocks",
                           positions_block = "state.positions", remainders_block = "state.remainders",
                           velocities_block = "state.velocities", poses_block = "state.held_poses";
constexpr std::string_view fingerprint_blocks[] = {"fingerprint.scene", "fingerprint.settings"};
constexpr std::string_view scene_block = "scene", settings_block = "settings";

static_assert(sizeof(Record) == 16);

/// Columns of structs, number after number: a double holds each of them exactly.
struct Flat {
  std::vector<std::int64_t> blocks;
  std::vector<double> poses;
};
constexpr std::size_t numbers_of_block = 3, numbers_of_pose = 10;

Flat flatten(const State& state) {
  Flat flat;
  for (const auto& [first, particles, generation] : state.blocks)
    flat.blocks.insert(flat.blocks.end(), {first, particles, generation});
  for (const auto& [is_mesh, slot, generation, p, q] : state.held_poses) {
    const double kind = is_mesh ? 1 : 0, slot_number = slot, generation_number = generation;
    flat.poses.insert(flat.poses.end(), {kind, slot_number, generation_number, p.x, p.y, p.z, q.x, q.y, q.z, q.w});
  }
  return flat;
}

/// Takes the State apart by a structured binding, so that a new column that is not written does not compile.
std::vector<Block> blocks_of(const State& state, const Flat& flat) {
  const auto& [time, frame, state_blocks, positions, remainders, velocities, held_poses] = state;
  const auto records = [](std::string_view name, const Records& column) {
    return Block{name, Type::record, sizeof(Record), column.size(), column.data()};
  };
  return {{time_block, Type::float64, sizeof time, 1, &time},
          {frame_block, Type::int64, sizeof frame, 1, &frame},
          {blocks_block, Type::int64, sizeof(std::int64_t), flat.blocks.size(), flat.blocks.data()},
          {poses_block, Type::float64, sizeof(double), flat.poses.size(), flat.poses.data()},
          records(positions_block, positions),
          records(remainders_block, remainders),
          records(velocities_block, velocities)};
}

void read(const Contents& from, std::string_view name, Records& column) {
  const Block& block = from.block(name, Type::record, sizeof(Record));
  column.resize(block.count);
  if (block.count > 0) std::memcpy(column.data(), block.data, block.count * sizeof(Record));
}

template <class T>
void read(const Contents& from, std::string_view name, Type type, T& value) {
  const Block& block = from.block(name, type, sizeof value);
  if (block.count != 1) from.fail(fmt::format("is malformed: it has {} of '{}'", block.count, name), "use an earlier file");
  std::memcpy(&value, block.data, sizeof value);
}

template <class T>
std::vector<T> read_all(const Contents& from, std::string_view name, Type type, std::size_t multiple) {
  const Block& block = from.block(name, type, sizeof(T));
  if (block.count % multiple != 0) from.fail(fmt::format("is malformed: '{}' breaks off", name), "use an earlier file");
  std::vector<T> values(block.count);
  if (block.count > 0) std::memcpy(values.data(), block.data, block.count * sizeof(T));
  return values;
}

void read(const Contents& from, std::vector<StateBlock>& blocks) {
  const auto flat = read_all<std::int64_t>(from, blocks_block, Type::int64, numbers_of_block);
  for (std::size_t i = 0; i < flat.size(); i += numbers_of_block)
    blocks.push_back({static_cast<int>(flat[i]), static_cast<int>(flat[i + 1]), static_cast<int>(flat[i + 2])});
}

void read(const Contents& from, std::vector<HeldPose>& poses) {
  const auto flat = read_all<double>(from, poses_block, Type::float64, numbers_of_pose);
  for (std::size_t i = 0; i < flat.size(); i += numbers_of_pose) {
    const auto number = [&](std::size_t at) { return static_cast<float>(flat[i + at]); };
    poses.push_back({flat[i] != 0,
                     static_cast<int>(flat[i + 1]),
                     static_cast<int>(flat[i + 2]),
                     {number(3), number(4), number(5)},
                     {number(6), number(7), number(8), number(9)}});
  }
}

State state_in(const Contents& from) {
  State state;
  auto& [time, frame, blocks, positions, remainders, velocities, held_poses] = state;
  read(from, time_block, Type::float64, time);
  read(from, frame_block, Type::int64, frame);
  read(from, blocks);
  read(from, held_poses);
  read(from, positions_block, positions);
  read(from, remainders_block, remainders);
  read(from, velocities_block, velocities);
  if (remainders.size() != positions.size() || velocities.size() != positions.size())
    from.fail("is malformed: its positions, remainders and velocities differ in number", "use an earlier file");
  return state;
}

Contents state_file(const std::string& path) {
  Contents contents(path, Content::state);
  contents.refuse_unknown({time_block, frame_block, blocks_block, poses_block, positions_block, remainders_block,
                           velocities_block, fingerprint_blocks[0], fingerprint_blocks[1]});
  return contents;
}

// ---------------------------------------------------------------- a Scene

template <class T>
std::string bytes_of(const T& of) {
  std::string bytes;
  Output out([&](const void* data, std::size_t size) { bytes.append(static_cast<const char*>(data), size); }, Take::all);
  out(of);
  return bytes;
}

template <class T>
T read_bytes(const Contents& from, std::string_view name) {
  T of;
  Input in(from.text(name));
  in(of);
  if (!in.complete()) from.fail(fmt::format("is malformed: its block '{}' does not read", name), "use an earlier file");
  return of;
}

template <class T, class... More>
std::string hash_of(const T& of, const More&... more) {
  Sha256 sha;
  Output out([&](const void* data, std::size_t size) { sha.add(data, size); }, Take::deciding);
  out(of, more...);
  return sha.finish();
}

void refuse_other_scene(const World& world, const Scene& scene) {
  const auto refuse = [](const Location& where, const std::string& problem) {
    throw Error(where, problem, "give save() the scene that the World was made from");
  };
  const auto objects = static_cast<int>(scene.objects.size());
  if (world.object_count() != objects)
    refuse({}, fmt::format("the World has {} objects and the scene {}", world.object_count(), objects));
  for (int o = 0; o < objects; ++o) {
    const Object& object = scene.objects[static_cast<std::size_t>(o)];
    const ObjectInfo info = world.info(o);
    Location where;
    where.object = object.name;
    if (info.name != object.name) refuse(where, "is called '" + info.name + "' in the World");
    if (static_cast<std::size_t>(info.particles) != object.positions.size())
      refuse(where, fmt::format("has {} particles, and {} in the World", object.positions.size(), info.particles));
  }
}

void refuse_force_fields(const Scene& scene) {
  if (scene.forces.empty()) return;
  throw Error({}, "the scene has force fields, which are functions and cannot be saved",
              "save the State alone, and make the World from the scene in code");
}

}  // namespace

// ---------------------------------------------------------------- for users

Fingerprint fingerprint(const Scene& scene) {
  Settings settings = chosen_settings(scene);
  if (settings.sweep == Sweep::sequential) settings.sweep = Sweep::tiled;
  return {hash_of(scene, static_cast<std::uint64_t>(scene.forces.size())), hash_of(settings)};
}

void save(const std::string& path, const State& state) {
  const Flat flat = flatten(state);
  write(path, Content::state, blocks_of(state, flat));
}

void save(const std::string& path, const State& state, const Fingerprint& of) {
  const Flat flat = flatten(state);
  std::vector<Block> blocks = blocks_of(state, flat);
  blocks.push_back({fingerprint_blocks[0], Type::bytes, 1, of.scene.size(), of.scene.data()});
  blocks.push_back({fingerprint_blocks[1], Type::bytes, 1, of.settings.size(), of.settings.data()});
  write(path, Content::state, blocks);
}

State load_state(const std::string& path) { return state_in(state_file(path)); }

State load_state(const std::string& path, const Fingerprint& of) {
  const Contents contents = state_file(path);
  if (!contents.has(fingerprint_blocks[0]) || !contents.has(fingerprint_blocks[1]))
    contents.fail("does not say which scene it was saved with", "save it with its scene, or load it without one");
  if (contents.text(fingerprint_blocks[0]) != of.scene)
    contents.fail("was saved with another scene, or this one has changed since", "use the scene that it was saved with");
  if (contents.text(fingerprint_blocks[1]) != of.settings) {
    contents.fail("was saved with other settings of this scene: substeps, iterations, the sweep or contact settings differ",
                  "use the settings that it was saved with");
  }
  return state_in(contents);
}

void save(const std::string& path, const World& world, const Scene& scene) {
  refuse_other_scene(world, scene);
  refuse_force_fields(scene);
  Settings settings = world.settings();
  settings.isa.clear();  // another machine may not have it, and the bits are the same
  const std::string scene_bytes = bytes_of(scene), settings_bytes = bytes_of(settings);
  const Flat flat = flatten(world.state());
  std::vector<Block> blocks = blocks_of(world.state(), flat);
  blocks.push_back({scene_block, Type::bytes, 1, scene_bytes.size(), scene_bytes.data()});
  blocks.push_back({settings_block, Type::bytes, 1, settings_bytes.size(), settings_bytes.data()});
  write(path, Content::world, blocks);
}

LoadedWorld load_world(const std::string& path) {
  const Contents contents(path, Content::world);
  contents.refuse_unknown({time_block, frame_block, blocks_block, poses_block, positions_block, remainders_block,
                           velocities_block, scene_block, settings_block});
  Scene scene = read_bytes<Scene>(contents, scene_block);
  scene.settings = read_bytes<Settings>(contents, settings_block);
  const State state = state_in(contents);
  try {
    World world(scene);
    world.restore(state);
    return {std::move(scene), std::move(world)};
  } catch (const Error& error) {
    Location where = error.where();
    where.file = path;
    throw Error(where, error.problem(), "the file is malformed; use an earlier one");
  }
}

}  // namespace pliant
