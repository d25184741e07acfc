// Rigid bodies in USD: a prim for each, below that of its object, with time samples of its translation and orientation.
// Bodies of equal solids inherit one mesh.
#pragma once

#include <string>
#include <vector>

#include "output_file.h"
#include "write_bodies.h"
#include "write_frames.h"

namespace pliant::output {

/// The bodies of one object.
class UsdaBodies {
 public:
  explicit UsdaBodies(const FrameObject& object) : object_(object), poses_(object.bodies.size()) {}

  /// Adds a frame; `time` is its time code.
  void add(const std::string& time, const std::vector<BodyMotion>& frame);
  void write(OutputFile& file, const std::string& name) const;

 private:
  void write_solid(OutputFile& file, const std::string& name, const ShadedMesh& mesh) const;
  void write_body(OutputFile& file, std::size_t body, const std::string& name, const std::string& solid) const;

  FrameObject object_;
  std::vector<std::string> times_;
  std::vector<std::vector<RigidPose>> poses_;  ///< for each body, its pose in each frame
};

}  // namespace pliant::output
