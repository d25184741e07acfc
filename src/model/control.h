// User-driven motion in the next frame, in addition to keyframes.
#pragma once

#include <map>
#include <vector>

#include "math/quat.h"
#include "pliant/vec3.h"

namespace pliant {

/// A rigid motion between two poses, or a held pose.
struct PoseDrive {
  Posed from, to;
  double start = 0, end = 0;  ///< [s]; equal: held at `to`
  bool moves() const { return end > start; }
  Posed at(double time) const;
};

/// A particle of infinite mass that moves between two positions.
struct Target {
  int particle = 0;  ///< in storage order
  Vec3d from, to;    ///< at the frame's start and end [m]
};

struct ObjectControl {
  std::vector<Target> targets;  ///< targets in ascending order of particles
  std::vector<Vec3f> forces;    ///< in storage order [N]; empty: none
};

/// The user's control data of one frame.
struct Control {
  std::map<int, PoseDrive> colliders;    ///< by index in Model::colliders
  std::map<int, PoseDrive> meshes;       ///< by index of the mesh collider in Model::objects
  std::map<int, ObjectControl> objects;  ///< by index in Model::objects

  const PoseDrive* collider(int number) const { return find(colliders, number); }
  const PoseDrive* mesh(int number) const { return find(meshes, number); }
  const ObjectControl* object(int number) const { return find(objects, number); }
  bool has_forces() const;

 private:
  template <class T>
  static const T* find(const std::map<int, T>& all, int number) {
    const auto at = all.empty() ? all.end() : all.find(number);
    return at == all.end() ? nullptr : &at->second;
  }
};

}  // namespace pliant
