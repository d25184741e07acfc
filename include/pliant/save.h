// Saving and loading: a State, or a whole World, as one file. Part of the library pliant_io.
//
// Both are exact: the next step of what was loaded gives the same bits as if nothing had been saved. A file appears under its
// name only when it is complete, so the one before it survives a crash, a full disk or a kill at any moment. It carries a
// format version and a SHA-256 checksum. docs/reference/save-format.md describes the format.
#pragma once

#include <string>

#include "pliant/scene.h"
#include "pliant/world.h"

namespace pliant {

/// What decides the bits of a run, as two SHA-256 hashes of 64 hexadecimal digits.
///
/// Left out is what changes no bit: colours, the number of frames, threads, the instruction set, what is measured or recorded,
/// and the distance grids of mesh colliders, which follow from the meshes. Of force fields only the number counts.
struct Fingerprint {
  std::string scene;     ///< gravity, wind, frame time, objects, colliders, pairs
  std::string settings;  ///< those that change bits, after chosen_settings; `tiled` and `sequential` count as one
};

/// The fingerprint of a scene.
Fingerprint fingerprint(const Scene& scene);

/// Writes a State. Throws Error naming the path where it cannot be written; the file there before then stays as it was.
void save(const std::string& path, const State& state);

/// Writes a State with the fingerprint of the scene whose World it is of.
void save(const std::string& path, const State& state, const Fingerprint& of);
inline void save(const std::string& path, const State& state, const Scene& scene) { save(path, state, fingerprint(scene)); }

/// Reads a State, for World::restore. Throws Error with the path and the reason where the file is missing, no regular file,
/// empty, of another format or version, shorter or longer than it says, or damaged.
State load_state(const std::string& path);

/// The same. Throws Error too where the file does not carry this fingerprint.
State load_state(const std::string& path, const Fingerprint& of);
inline State load_state(const std::string& path, const Scene& scene) { return load_state(path, fingerprint(scene)); }

/// Writes a World: a scene of what it holds now, its settings, its ids and its State. Where nothing came or went that is the scene
/// that it was made from; else one with the descriptions of what exists, in the order of World::objects(), colliders() and
/// mesh_colliders(). Throws Error where the scene has force fields, which are functions and cannot be written, or is not this
/// World's by number, names and particles of its objects.
void save(const std::string& path, const World& world, const Scene& scene);

/// A World as loaded, and its scene, whose settings are the World's.
struct LoadedWorld {
  Scene scene;
  World world;
};

/// Reads a World, in which the same ids name the same things. Throws Error as load_state does.
LoadedWorld load_world(const std::string& path);

}  // namespace pliant
