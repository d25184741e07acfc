#include "solver/free_objects.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "collision/narrow/contact.h"
#include "core/islands.h"
#include "math/functions.h"
#include "solver/bodies/body_math.h"
#include "solver/bodies/body_solver.h"
#include "solver/substep.h"

namespace pliant {

namespace {

/// Islands of objects that touch, and which of the objects something fixed acts on.
class TouchingObjects {
 public:
  explicit TouchingObjects(const Substep& s) : s_(s), is_held_(s.model.objects.size(), 1) {
    islands_.reset(static_cast<int>(is_held_.size()));
    for_objects(s, [&](int object) { is_held_[at(object)] = 0; });
  }

  void hold(int object) { is_held_[at(object)] = 1; }
  void touch_colliders() {
    for_each_tile(s_, [&](int task) {
      if (!s_.work.tiles[at(task)].contacts.empty()) hold(s_.model.tiles()[at(task)].object);
    });
    for (const Contact& contact : s_.own->shape_contacts) hold(s_.model.object_of(contact.point[0]));
  }
  void touch(const std::vector<Contact>& surfaces) {
    for (const Contact& contact : surfaces)
      for (std::size_t i = 1; i < contact.point.size(); ++i)
        if (contact.weight[i] != 0)
          islands_.unite(s_.model.object_of(contact.point[0]), s_.model.object_of(contact.point[i]));
  }
  void touch(BodySolver& bodies) {
    for (const BodyContact& contact : bodies.contacts())
      for (const int owner : {contact.a.owner, contact.b.owner})
        if (owner >= 0) hold(owner);
    for (const Contact& contact : bodies.point_contacts())
      islands_.unite(s_.model.object_of(contact.point[0]), bodies.touched_bodies()[at(bodies.body_of(contact))].object);
  }

  /// [object] the first of its island, or -1 if one of the island is held.
  std::vector<int> groups() {
    std::vector<char> is_held(is_held_.size(), 0);
    for (int object = 0; object < islands_.size(); ++object)
      if (is_held_[at(object)] != 0) is_held[at(islands_.find(object))] = 1;
    // Reads all their particles, so only where nothing else holds them.
    for (int object = 0; object < islands_.size(); ++object)
      if (char& held = is_held[at(islands_.find(object))]; held == 0) held = static_cast<char>(has_fixed(object));
    std::vector<int> group;
    group.reserve(is_held.size());
    for (int object = 0; object < islands_.size(); ++object) {
      const int first = islands_.find(object);
      group.push_back(is_held[at(first)] != 0 ? -1 : first);
    }
    return group;
  }

 private:
  bool has_fixed(int object) const {
    const AdvanceArguments a = object_particles(s_, object);
    return s_.model.objects[at(object)].is_collider ||
           std::any_of(a.positions + a.first, a.positions + a.last, [](const Record& x) { return !(x.w > 0); });
  }

  const Substep& s_;
  Islands islands_;
  std::vector<char> is_held_;  ///< [object]
};

/// The distance of two boxes along the axis on which they are farthest apart [m].
float distance(const PointBounds& a, const BoundingBox<float>& b) {
  const Vec3f apart = max(xyz(a.low) - b.high, b.low - xyz(a.high));
  return max(max(apart.x, apart.y), apart.z);
}

/// How high a box lies above a half-space y <= 0 [m].
float height(const PointBounds& box, const Pose<float>& pose) {
  float lowest = 1e30f;
  for (int corner = 0; corner < 8; ++corner)
    lowest = min(lowest,
                 to_local(pose, {(corner & 1) != 0 ? box.high.x : box.low.x, (corner & 2) != 0 ? box.high.y : box.low.y,
                                 (corner & 4) != 0 ? box.high.z : box.low.z})
                     .y);
  return lowest;
}

}  // namespace

float distance_from_solid(const CompiledObject& object, const PointBounds& box, const MovingCollider& solid) {
  if (solid.field != nullptr && ((object.groups & solid.mask) == 0 || (solid.groups & object.mask) == 0)) return 1e30f;
  if (solid.field == nullptr && solid.shape.kind == ShapeKind::plane)
    return min(height(box, solid.before), height(box, solid.after)) - solid.thickness;
  return distance(box, solid.swept);
}

namespace {

/// Calls near(solid, group, room) for the solids of rigid bodies of other groups than that of a tile's free object.
/// `group`: that of the solid, -1 if something fixed acts on it. `room`: its distance from the surfaces of the
/// particles [m].
template <class Near>
void for_solids_of_others(const Substep& s, int task, const FreeBodies& free, const Near& near) {
  if (s.bodies == nullptr) return;
  const CompiledObject& object = object_of(s, task);
  const BodySolids& solids = s.bodies->solids();
  const int group = free[at(s.model.tiles()[at(task)].object)].group;
  for (std::size_t i = 0; i < solids.moving().size(); ++i) {
    const FreeBody& other = free[at(solids.bodies()[at(solids.body_of_solid()[i])].object)];
    const MovingCollider& solid = solids.moving()[i];
    if (other.group != group)
      near(solid, other.group,
           distance_from_solid(object, s.work.tiles[at(task)].bounds, solid) - thickness_of(object, solid));
  }
}

template <class Body>
void for_free_tiles(const Substep& s, const FreeBodies& free, const Body& body) {
  for_each_tile(s, [&](int task) {
    if (free[at(s.model.tiles()[at(task)].object)].group >= 0) body(task);
  });
}

/// Unites free groups whose rigid bodies are nearer than twice their step. If both have a velocity in common, the body
/// would leave the frame of the other group no room (FreeBody::room).
void unite_near(const Substep& s, FreeBodies& free) {
  Islands groups;
  groups.reset(static_cast<int>(free.size()));
  for_free_tiles(s, free, [&](int task) {
    const int group = free[at(s.model.tiles()[at(task)].object)].group;
    for_solids_of_others(s, task, free, [&](const MovingCollider& solid, int other, float room) {
      const float moved = length(solid.after.position - solid.before.position);
      if (other >= 0 && room < 2 * moved) groups.unite(group, other);
    });
  });
  for (FreeBody& of : free)
    if (of.group >= 0) of.group = groups.find(of.group);
}

/// Where a tile has less room to colliders, or to rigid bodies of other groups, than the free object, takes that.
void take_room(const Substep& s, int task, FreeBodies& free) {
  const PointBounds& box = s.work.tiles[at(task)].bounds;
  const CompiledObject& object = object_of(s, task);
  FreeBody& of = free[at(s.model.tiles()[at(task)].object)];
  for (const MovingCollider& collider : s.own->colliders)
    of.room = min(of.room, distance_from_solid(object, box, collider) - object.thickness);
  for_solids_of_others(s, task, free, [&](const MovingCollider&, int, float room) { of.room = min(of.room, room); });
}

FreeBodies find_free_objects(Substep& s) {
  TouchingObjects touching(s);
  touching.touch_colliders();
  if (s.has_pairs()) touching.touch(s.pairs->contacts());
  if (s.bodies != nullptr) touching.touch(*s.bodies);
  const std::vector<int> groups = touching.groups();
  FreeBodies free;
  free.reserve(groups.size());
  for (const int group : groups) free.push_back({group, 1e30f});
  unite_near(s, free);
  for_free_tiles(s, free, [&](int task) { take_room(s, task, free); });
  return free;
}

}  // namespace

const FreeBodies& free_objects(Substep& s) {
  if (!s.own->free_is_known) s.own->free = find_free_objects(s);
  s.own->free_is_known = true;
  return s.own->free;
}

bool is_free(Substep& s, int object) { return free_objects(s)[at(object)].group >= 0; }

void take_from_velocities(Substep& s) {
  for (const auto& [particle, d] : s.own->without_velocity) {
    Record& r = s.state.remainders[at(particle)];
    r = {r.x + d.x, r.y + d.y, r.z + d.z, r.w};
  }
  s.own->without_velocity.clear();
}

}  // namespace pliant
