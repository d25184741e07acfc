// Warnings about the rods of an object: contact that yields to what they carry.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "inspect/problems.h"

namespace pliant {

namespace {

/// Contact gives way by this times h^2 F / m (docs/guide/bodies.md).
constexpr double give = 1.04;
/// Of the radius, up to which a cable that is loaded over an edge stays outside it: a drum of 0.1 m lost its cable at
/// 1.0 and not at 0.75.
constexpr double most_give = 0.6;

/// The segments of an object's rods, and what else hangs on them.
struct Load {
  double least = 0;  ///< of the segments, mass times radius; 0: there are none [kg m]
  double mass = 0;   ///< of all other bodies [kg]
};

/// The frames that rod joints act on.
std::vector<bool> frames_of_rods(const Object& object) {
  std::vector<bool> found(object.frames.size(), false);
  for (const ConstraintGroup& group : object.constraints) {
    if (group.type != "rod_joint") continue;
    for (std::size_t i = 1; i < group.particles.size(); i += 2) {
      const auto frame = static_cast<std::size_t>(group.particles[i]);
      if (frame < found.size()) found[frame] = true;
    }
  }
  return found;
}

bool is_pinned(const Object& object, int particle) {
  return std::any_of(object.pins.begin(), object.pins.end(), [&](const Pin& pin) { return pin.particle == particle; });
}

Load load_of(const Object& object) {
  const std::vector<bool> is_of_rod = frames_of_rods(object);
  Load load;
  for (const ObjectBody& body : object.bodies) {
    const double mass = static_cast<double>(object.masses[static_cast<std::size_t>(body.particle)]);
    const auto* capsule = body.solids.size() == 1 ? std::get_if<Capsule>(&body.solids[0].shape) : nullptr;
    if (is_of_rod[static_cast<std::size_t>(body.frame)] && capsule != nullptr) {
      const double yields = mass * static_cast<double>(capsule->radius);
      load.least = load.least == 0 ? yields : std::min(load.least, yields);
    } else if (std::isfinite(mass) && !is_pinned(object, body.particle)) {
      load.mass += mass;
    }
  }
  return load;
}

}  // namespace

void doubt_substeps_of_rods(Problems& problems, const Scene& scene) {
  const std::vector<int> all = chosen_substeps(scene);
  const double gravity = std::sqrt(static_cast<double>(length_squared(scene.gravity)));
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    const Object& object = scene.objects[o];
    if (all[o] <= 0 || !(object.collides || object.self_collision)) continue;
    const Load load = load_of(object);
    if (!(load.least > 0) || !(load.mass > 0)) continue;
    const double needed =
        static_cast<double>(scene.frame_time) * std::sqrt(give * gravity * load.mass / (most_give * load.least));
    if (needed <= all[o]) continue;
    problems.doubtful(
        "settings, substeps",
        "are " + std::to_string(all[o]) + ": the rods of '" + object.name + "' carry up to " + words(load.mass) +
            " kg, and where they bend around something the load can press them into it by more than their radius",
        "give " + std::to_string(std::llround(std::ceil(std::min(needed, 1e4)))) +
            ", or set \"collides\" and \"self_collision\" to false if they touch nothing");
  }
}

}  // namespace pliant
