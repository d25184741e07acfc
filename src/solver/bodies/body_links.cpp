#include "solver/bodies/body_links.h"

#include <algorithm>
#include <cstddef>
#include <iterator>

#include "constraints/registry.h"
#include "model/compiled_joints.h"
#include "solver/bodies/body_math.h"
#include "solver/visit.h"

namespace pliant {

namespace {

/// The joint, and whether it is a motor of it, of each constraint of an object: [pool][16 batch + lane].
class JointsOfConstraints {
 public:
  struct Entry {
    int joint = -1;
    bool is_motor = false;
  };

  explicit JointsOfConstraints(const CompiledObject& object) : of_pool_(object.pools.size()) {
    for (std::size_t j = 0; j < object.joints.size(); ++j) {
      const CompiledJoint& joint = object.joints[j];
      for (const CompiledJoint::Part& part : joint.parts) entry(object, part).joint = static_cast<int>(j);
      for (const CompiledJoint::Motor& motor : joint.motors) entry(object, joint.parts[motor.part]).is_motor = true;
    }
  }

  Entry at_place(const ConstraintPlace& place) const {
    const std::vector<Entry>& entries = of_pool_[at(place.pool_number)];
    return entries.empty() ? Entry{} : entries[index(place.batch, place.lane)];
  }

 private:
  static std::size_t index(std::int64_t batch, int lane) {
    return static_cast<std::size_t>(batch * batch_width + lane);
  }

  Entry& entry(const CompiledObject& object, const CompiledJoint::Part& part) {
    std::vector<Entry>& entries = of_pool_[at(part.pool)];
    entries.resize(static_cast<std::size_t>(object.pools[at(part.pool)].batches) * batch_width);
    return entries[index(part.batch, part.lane)];
  }

  std::vector<std::vector<Entry>> of_pool_;
};

/// True if a constraint may do work: a motor, or a constraint that gives way and so stores energy. Friction in a joint
/// only takes energy.
bool does_work(const ConstraintPlace& place, const JointsOfConstraints::Entry& entry) {
  if (constraint_type(place.pool.type).acts_on_motion) return entry.is_motor || entry.joint < 0;
  const float response = place.value(place.pool.fields);
  return place.pool.law == Law::pbd ? response < 1 : response > 0;
}

/// The links of an object without its number.
void add_links_of(const CompiledObject& object, int first_body, int points, std::vector<BodyLink>& links) {
  std::vector<int> node(at(object.particles) + object.frames.size(), -1);  // of each slot; frames come after particles
  std::fill_n(node.begin(), object.particles, points);
  for (std::size_t b = 0; b < object.bodies.bodies.size(); ++b) {
    const CompiledBodies::Body& body = object.bodies.bodies[b];
    node[at(body.particle)] = node[at(object.particles + body.frame)] = first_body + static_cast<int>(b);
  }
  const JointsOfConstraints joints(object);
  const auto visit = [&](const ConstraintPlace& place, const std::int32_t* slots) {
    int first = -1;
    for (int slot = 0; slot < place.pool.stencil; ++slot) {
      const int other = node[at(slots[slot])];
      if (first < 0) first = other;
      if (other < 0 || other == first) continue;
      const JointsOfConstraints::Entry entry = joints.at_place(place);
      links.push_back({first, other, 0, entry.joint, does_work(place, entry)});
    }
  };
  for (const Segment& segment : object.segments) for_segment(object, segment, visit);
}

}  // namespace

void add_links(const Model& model, int number, int first_body, int points, std::vector<BodyLink>& links) {
  const std::size_t before = links.size();
  add_links_of(model.objects[at(number)], first_body, points, links);
  for (std::size_t i = before; i < links.size(); ++i) links[i].object = number;
}

namespace {

/// True if the bodies of a joint overlap where they are built to meet: segments of a rod, by their caps.
bool overlaps(const CompiledObject& object, int joint) {
  const CompiledJoint::Part& part = object.joints[static_cast<std::size_t>(joint)].parts.front();
  return constraint_type(object.pools[static_cast<std::size_t>(part.pool)].type).name == "rod_joint";
}

}  // namespace

std::vector<std::pair<int, int>> pairs_without_joint(const CompiledObject& object, const std::vector<int>& broken) {
  const auto points = static_cast<int>(object.bodies.bodies.size());
  std::vector<BodyLink> links;
  if (!broken.empty()) add_links_of(object, 0, points, links);
  std::vector<std::pair<int, int>> joined, freed, left;
  for (const BodyLink& link : links) {
    if (link.a == points || link.b == points) continue;
    const bool is_broken = link.joint >= 0 && std::binary_search(broken.begin(), broken.end(), link.joint);
    (is_broken && !overlaps(object, link.joint) ? freed : joined).emplace_back(std::minmax(link.a, link.b));
  }
  std::sort(joined.begin(), joined.end());
  std::sort(freed.begin(), freed.end());
  freed.erase(std::unique(freed.begin(), freed.end()), freed.end());
  std::set_difference(freed.begin(), freed.end(), joined.begin(), joined.end(), std::back_inserter(left));
  return left;
}

}  // namespace pliant
