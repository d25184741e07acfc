// What the user sets for the next frame: targets, poses and forces, in addition to keyframes.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "math/quat.h"
#include "pliant/vec3.h"

namespace pliant {

/// A rigid motion between two poses, or a constant pose.
struct PoseDrive {
  Posed from, to;
  double start = 0, end = 0;  ///< times of both poses [s]; equal: the pose is `to`
  bool moves() const { return end > start; }
  Posed at(double time) const;
};

/// A particle of infinite mass that moves between two positions.
struct Target {
  int particle = 0;  ///< index in storage order
  Vec3d from, to;    ///< positions at the frame's start and end [m]
};

/// A frame of infinite inertia that turns between two orientations, along the shorter arc.
struct TurnTarget {
  int frame = 0;  ///< index among the object's frames
  Quatd from, to;
};

/// A spring with critical damping between a particle and a place.
struct Pull {
  int particle = 0;     ///< index in storage order
  Vec3f place{};        ///< [m]
  float frequency = 0;  ///< angular frequency omega [1/s]; its stiffness is m omega^2
};

struct ObjectControl {
  std::vector<Target> targets;    ///< ascending by particle
  std::vector<TurnTarget> turns;  ///< of bodies, whose particles are in `targets`; ascending by frame
  std::vector<Vec3f> forces;      ///< force on each particle in storage order [N]; empty: none
  std::vector<Pull> pulls;        ///< of one particle each

  const Target* target(int particle) const;
  const TurnTarget* turn(int frame) const;
};

/// Surface velocities that the user has set, each in its own frame, of bodies in principal axes [m/s].
struct SurfaceVelocities {
  std::map<std::pair<int, int>, Vec3f> bodies;  ///< key: index in Model::objects, and of the body
  std::map<int, Vec3f> colliders;               ///< key: index in Model::colliders
  std::map<int, Vec3f> meshes;                  ///< key: index of the mesh collider in Model::objects
};

/// All that the user sets for one frame.
struct Control {
  std::map<int, PoseDrive> colliders;    ///< key: index in Model::colliders
  std::map<int, PoseDrive> meshes;       ///< key: index of the mesh collider in Model::objects
  std::map<int, ObjectControl> objects;  ///< key: index in Model::objects
  SurfaceVelocities surfaces;

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
