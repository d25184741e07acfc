#include "advise/far_pins.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "constraints/registry.h"
#include "math/motion.h"
#include "math/vector.h"
#include "model/attachments.h"
#include "model/object_sets.h"
#include "topology/geodesics.h"
#include "world/advice.h"

namespace pliant {

namespace {

constexpr int nearest_groups = 5;  ///< of pins that each pin is compared with, its own among them

/// A fixed place at time 0 [m], and its motion.
struct Held {
  Vec3f place;
  Motion motion;

  Vec3d at(double time) const { return to_world(pose_at(motion, time), convert<double>(place)); }
};

/// The particles that pins, infinite masses and firm attachments hold.
std::map<int, Held> held_particles(const Object& object, double gravity) {
  std::map<int, Held> held;
  const AttachmentTest test(object, gravity);
  for (const Attachment& attachment : object.attachments)
    if (test.is_firm(attachment)) held[attachment.particle] = {attachment.target, attachment.motion};
  for (std::size_t i = 0; i < object.masses.size(); ++i)
    if (std::isinf(object.masses[i])) held[static_cast<int>(i)] = {object.positions[i], {}};
  for (const Pin& pin : object.pins)
    held[pin.particle] = {object.positions[static_cast<std::size_t>(pin.particle)], pin.motion};
  return held;
}

Distances mesh_of(const Object& object) {
  Distances mesh{static_cast<int>(object.positions.size()), {}, {}, object.triangles};
  for (const ConstraintGroup& group : object.constraints) {
    if (!is_length(group.type)) continue;
    for (std::size_t i = 0; 2 * i + 1 < group.particles.size(); ++i) {
      const int a = group.particles[2 * i], b = group.particles[2 * i + 1];
      const Vec3f along = object.positions[static_cast<std::size_t>(b)] - object.positions[static_cast<std::size_t>(a)];
      mesh.edges.push_back({a, b});
      mesh.lengths.push_back(i < group.rest.size() ? group.rest[i] : length(along));
    }
  }
  return mesh;
}

/// Two held particles, and how far apart they are along the object and in space [m].
struct FarPins {
  int from = -1, to = -1;
  double along = 1, apart = 0;
};

/// The pair that is the farthest apart in proportion to the object between them.
FarPins farthest(const Object& object, double gravity, double time) {
  const std::map<int, Held> held = held_particles(object, gravity);
  FarPins found;
  if (held.size() < 2) return found;
  std::vector<int> sources;
  sources.reserve(held.size());
  for (const auto& one : held) sources.push_back(one.first);
  const std::vector<std::vector<NearSource>> near = nearest_sources(mesh_of(object), sources, nearest_groups);
  for (const int from : sources)
    for (const NearSource& to : near[static_cast<std::size_t>(from)]) {
      if (!(to.distance > 0)) continue;
      const double apart = length(held.at(to.source).at(time) - held.at(from).at(time));
      if (apart * found.along > found.apart * to.distance) found = {from, to.source, to.distance, apart};
    }
  return found;
}

}  // namespace

std::string advice_for_far_pins(const Scene& scene, const Trial& trial) {
  const auto number = static_cast<std::size_t>(trial.worst.object);
  if (trial.worst.object < 0 || number >= scene.objects.size()) return {};
  const Object& object = scene.objects[number];
  const auto gravity = static_cast<double>(length(scene.gravity));
  if (is_meant_to_stretch(object, gravity)) return {};  // other settings may well hold it
  const double time = static_cast<double>(trial.frame) * static_cast<double>(scene.frame_time);
  const FarPins found = farthest(object, gravity, time);
  if (found.from < 0 || found.apart <= (1 + tolerated_p99) * found.along) return {};
  return "no settings keep its lengths: particles " + std::to_string(found.from) + " and " + std::to_string(found.to) +
         ", which are pinned or attached, are " + two_digits(found.apart) +
         " m apart then, and the object between them is only " + two_digits(found.along) +
         " m long; move them less far apart, or give the object a \"stretch\" with compliance";
}

}  // namespace pliant
