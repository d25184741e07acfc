// Saves and loads a State, or a whole World, as one file. It is part of the library pliant_io.
//
// Saving is exact: after loading, the next step gives the same bits as without saving. What was set for the next step
// alone (forces, targets and poses) and what is recorded are not saved. Files are written atomically, so
// the previous one survives a crash, a full disk or a kill. They have a format version and a SHA-256 checksum.
// docs/reference/save-format.md describes the format.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "pliant/scene.h"
#include "pliant/world.h"

namespace pliant {

/// Identifies what determines the bits of a run: two SHA-256 hashes, each as 64 hexadecimal digits.
///
/// It excludes data that change no bits: colours, number of frames, threads, instruction set, measuring and recording,
/// and distance grids, which follow from their meshes. Of force fields only the number counts. What edits left of
/// schedules is in WorldLayout.
struct Fingerprint {
  std::string scene;     ///< hash of gravity, wind, frame time, objects, colliders and pairs
  std::string settings;  ///< hash of chosen_settings that change bits; `tiled` and `sequential` are equal
};

/// Computes the fingerprint of a scene.
Fingerprint fingerprint(const Scene& scene);

/// Writes a State. If that fails, an existing file stays unchanged, and the Error names the path.
void save(const std::string& path, const State& state);

/// Writes a State with the fingerprint of its World's scene.
void save(const std::string& path, const State& state, const Fingerprint& of);
inline void save(const std::string& path, const State& state, const Scene& scene) {
  save(path, state, fingerprint(scene));
}

/// Reads a State for World::restore. Throws an Error with the path and the reason if the file is missing, not regular,
/// empty, of another format or version, of the wrong length, or damaged.
State load_state(const std::string& path);

/// Reads a State. Also throws an Error if the file has a fingerprint other than `of`.
State load_state(const std::string& path, const Fingerprint& of);
inline State load_state(const std::string& path, const Scene& scene) { return load_state(path, fingerprint(scene)); }

/// The present contents of a World that was made from `scene`: objects that come apart (Object::tearing, cuts,
/// break_force) as they are now, by ObjectView::description(). Throws an Error if objects were added or removed.
Scene present_scene(const World& world, Scene scene);

/// Writes a World: a scene that describes its present contents, its settings, ids and State. Pass the original scene,
/// by present_scene where objects come apart, if nothing was added or removed; otherwise one with the present objects
/// in the order of World::objects(), colliders() and mesh_colliders(). Throws an Error if the scene has force fields,
/// which are functions, or if numbers, names or particles of its objects differ from the World's.
void save(const std::string& path, const World& world, const Scene& scene);

/// Writes a World with the fingerprint of the scene that it was made from.
void save(const std::string& path, const World& world, const Scene& scene, const Fingerprint& of);

/// Writes a World that was made with KeepDescription, as it is. Throws an Error if it was not.
void save(const std::string& path, const World& world);

/// A World that was loaded, and the scene that it was saved with; its settings are the World's.
struct LoadedWorld {
  Scene scene;
  World world;
};

/// Reads a World. All ids that were valid when it was saved are valid in it. Throws as load_state does.
/// The World keeps its description, so that it can be saved again.
LoadedWorld load_world(const std::string& path);

/// Reads a World that was made from a scene of this fingerprint; throws an Error if it was not, or if the file does not
/// say so. Its settings are `settings`, which may differ from the saved ones in what changes no bits, such as threads.
LoadedWorld load_world(const std::string& path, const Fingerprint& of, const Settings& settings);

// ---- The same in memory: the bytes of such a file, for databases, networks and other languages.

std::vector<std::byte> save_bytes(const State& state);
std::vector<std::byte> save_bytes(const State& state, const Fingerprint& of);
std::vector<std::byte> save_bytes(const World& world, const Scene& scene);
std::vector<std::byte> save_bytes(const World& world);

/// Reads what save_bytes returned, or save() wrote. Throws an Error as load_state does, which names `name` instead of a
/// path.
State load_state_bytes(std::span<const std::byte> bytes, const std::string& name = "bytes");
State load_state_bytes(std::span<const std::byte> bytes, const Fingerprint& of, const std::string& name = "bytes");
LoadedWorld load_world_bytes(std::span<const std::byte> bytes, const std::string& name = "bytes");

}  // namespace pliant
