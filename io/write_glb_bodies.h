// Rigid bodies in glTF: each is a node below that of its object, with an animation of its translation and rotation.
// Bodies of equal solids share a mesh, so files are small.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "glb_document.h"
#include "output_file.h"
#include "write_bodies.h"
#include "write_frames.h"

namespace pliant::output {

/// The bodies of one object. The functions that write data must be called in the order of those that reserve it.
class GlbBodies {
 public:
  explicit GlbBodies(const FrameObject& object);

  void add(const std::vector<BodyMotion>& frame);
  std::uint64_t estimated_size() const;

  /// Adds meshes and nodes. Returns the index of the object's node.
  int add_nodes(Document& document);
  /// Adds a sampler and a channel for each translation and rotation that changes; `input` is the accessor of the times.
  void add_channels(Document& document, int input, json& samplers, json& channels) const;

  void write_meshes(OutputFile& file) const;
  void write_tracks(OutputFile& file) const;

 private:
  /// The poses of one body over all frames.
  struct Track {
    std::vector<Vec3f> translations;
    std::vector<std::array<float, 4>> rotations;  ///< x, y, z, w of unit quaternions
    int node = 0;

    bool moves() const;
    bool turns() const;
  };

  int add_mesh(Document& document, const ShadedMesh& mesh, int material) const;

  FrameObject object_;
  std::vector<ShadedMesh> meshes_;
  std::vector<Track> tracks_;
};

}  // namespace pliant::output
