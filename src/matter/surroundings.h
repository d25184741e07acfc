// What the choice of an object's sweep has to know about the objects and colliders around it.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "model/object_sets.h"
#include "pliant/scene.h"

namespace pliant {

/// The magnitude of a scene's gravity [m/s^2].
double magnitude(const Vec3f& gravity);

struct Surroundings {
  std::vector<SetMember> members;  ///< all objects in order, then the mesh colliders as triangles; `rule` is not used
  std::vector<SetMember> other_meshes;  ///< mesh colliders that only particles touch
  bool has_primitives = false;          ///< true if there are colliders that are no meshes
  double gravity = 0;                   ///< its magnitude [m/s^2]
  double frame_time = 1.0 / 60;         ///< [s]
  /// The rule of a member that is an object, by its number. It is asked only where an inflated object depends on
  /// others.
  std::function<SubstepRule(std::size_t)> rule_of;
};

/// Those of a scene, which must outlive them: where the sweep is left open, rules are those of `chains`.
Surroundings surroundings_of(const Scene& scene, const Settings& settings);

/// True if the surface of the object with this number can touch itself, another object or a mesh collider.
bool can_touch(const Surroundings& surroundings, const Object& object, std::size_t number);

/// True if the object can meet a collider of any kind.
bool can_meet_collider(const Surroundings& surroundings, const Object& object);

/// What the sets of objects demand before a sweep is chosen for their volumes; found when it is asked first.
class OpenSets {
 public:
  /// The arguments must outlive this.
  OpenSets(const Surroundings& surroundings, const Settings& settings)
      : surroundings_(surroundings), settings_(settings) {}

  /// The substeps in which chains would solve the inflated object with this number, or fewer.
  int substeps_of(std::size_t number);

 private:
  void find();

  const Surroundings& surroundings_;
  const Settings& settings_;
  std::vector<SetSubsteps> sets_;
};

/// The sweep of an object that is added to others. It is the last object of `surroundings`; `others` are the sweeps of
/// those before it, `automatic` for those too small for sweeps to differ.
Sweep chosen_sweep(const Object& object, const Surroundings& surroundings, const Settings& settings,
                   const std::vector<Sweep>& others);

}  // namespace pliant
