// Saves and loads a State, or a whole World, as one file. Part of the library pliant_io.
//
// Both are exact: after loading, the next step gives the same bits as without saving. Files are written atomically, so the
// previous one survives a crash, a full disk or a kill at any time. They carry a format version and a SHA-256 checksum.
// docs/reference/save-format.md describes the format.
#pragma once

#include <string>

#include "pliant/scene.h"
#include "pliant/world.h"

namespace pliant {

/// Identifies the input that determines a run's bits: two SHA-256 hashes of 64 hexadecimal digits.
///
/// Data without effect on bits are excluded: colours, the number of frames, threads, the instruction set, measuring and
/// recording, and distance grids, which follow from their meshes. Of force fields only the number counts.
struct Fingerprint {
  std::string scene;     ///< gravity, wind, frame time, objects, colliders, pairs
  std::string settings;  ///< those that affect bits, after chosen_settings; `tiled` and `sequential` are equal
};

/// The fingerprint of a scene.
Fingerprint fingerprint(const Scene& scene);

/// Writes a State. Throws an Error that names the path on failure; an existing file then stays unchanged.
void save(const std::string& path, const State& state);

/// Writes a State with the fingerprint of its World's scene.
void save(const std::string& path, const State& state, const Fingerprint& of);
inline void save(const std::string& path, const State& state, const Scene& scene) { save(path, state, fingerprint(scene)); }

/// Reads a State for World::restore. Throws an Error with the path and the reason if the file is missing, not regular,
/// empty, of another format or version, of the wrong length, or damaged.
State load_state(const std::string& path);

/// The same. Throws an Error also if the file has another fingerprint.
State load_state(const std::string& path, const Fingerprint& of);
inline State load_state(const std::string& path, const Scene& scene) { return load_state(path, fingerprint(scene)); }

/// Writes a World: a scene of its current contents, its settings, ids and State. Without additions
/// and removals that is its original scene; otherwise one with the existing objects in the order of
/// World::objects(), colliders() and mesh_colliders(). Throws an Error if the scene has force fields,
/// which are functions, or does not match the World's objects by number, names and particles.
void save(const std::string& path, const World& world, const Scene& scene);

/// A loaded World, and its scene with the World's settings.
struct LoadedWorld {
  Scene scene;
  World world;
};

/// Reads a World in which all ids stay valid. Throws as load_state does.
LoadedWorld load_world(const std::string& path);

}  // namespace pliant
