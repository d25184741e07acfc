#include "solver/group_lag.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "collision/broad/bounds.h"
#include "math/functions.h"
#include "solver/bodies/body_math.h"
#include "solver/bodies/body_solver.h"
#include "solver/free_objects.h"
#include "solver/substep.h"

namespace pliant {

namespace {

/// A free group whose centre of mass lags.
struct LaggingGroup {
  std::vector<int> members;  ///< objects, ascending
  Vec3d lost{};              ///< sum of mass times displacement by truncation [kg m]
  double mass = 0;           ///< [kg]
  float extent = 0;          ///< largest coordinate of a particle at the substep's start [m]
  float thickness = 0;       ///< largest of a member [m]
  PointBounds box{};         ///< of its particles and solids on their way
  Vec3f shift{};             ///< by which it is to be moved [m]
};

void add(const BoundingBox<float>& of, PointBounds& box) {
  box = {{min(box.low.x, of.low.x), min(box.low.y, of.low.y), min(box.low.z, of.low.z), 0},
         {max(box.high.x, of.high.x), max(box.high.y, of.high.y), max(box.high.z, of.high.z), 0}};
}

void add_particles(const Substep& s, int object, PointBounds& box) {
  for (int i = s.model.first[at(object)]; i < s.model.end_of(object); ++i) {
    if (!is_there(s.state, at(i))) continue;
    const Vec3f from = xyz(s.state.positions[at(i)]), to = from + xyz(s.work.displacements[at(i)]);
    add({min(from, to), max(from, to)}, box);
  }
}

void add_solids(const Substep& s, int object, PointBounds& box) {
  if (s.bodies == nullptr) return;
  const BodySolids& solids = s.bodies->solids();
  for (std::size_t i = 0; i < solids.moving().size(); ++i)
    if (solids.bodies()[at(solids.body_of_solid()[i])].object == object) add(solids.moving()[i].swept, box);
}

/// Adds an object to a group, without its lag.
void add(const Substep& s, int object, LaggingGroup& group) {
  group.members.push_back(object);
  group.thickness = max(group.thickness, s.model.objects[at(object)].thickness);
  add_particles(s, object, group.box);
  add_solids(s, object, group.box);
  for (int i = s.model.first[at(object)]; i < s.model.end_of(object); ++i) {
    const Record& x = s.state.positions[at(i)];
    if (!is_there(s.state, at(i)) || !(x.w > 0)) continue;
    group.mass += 1 / double(x.w);
    group.extent = max(group.extent, max(max(std::abs(x.x), std::abs(x.y)), std::abs(x.z)));
  }
}

/// The free groups that lag. `number`: [object] of its group; -1: none.
std::vector<LaggingGroup> lagging_groups(Substep& s, std::vector<int>& number) {
  const FreeBodies& free = free_objects(s);
  std::vector<Vec3d> lost(free.size()), lost_of_root(free.size());
  std::vector<int> root(free.size(), -1), of_root(free.size(), -1);
  for_objects(
      s, [&](int o) { root[at(o)] = s.has_pairs() ? s.pairs->group_of(o, free[at(o)].group) : free[at(o)].group; });
  for (const auto& [particle, d] : s.own->without_velocity)
    lost[at(s.model.object_of(particle))] += convert<double>(d) * (1 / double(s.state.positions[at(particle)].w));
  for_objects(s, [&](int o) {
    if (root[at(o)] >= 0) lost_of_root[at(root[at(o)])] += lost[at(o)];
  });
  std::vector<LaggingGroup> groups;
  number.assign(free.size(), -1);
  for_objects(s, [&](int o) {
    if (root[at(o)] < 0 || !(length_squared(lost_of_root[at(root[at(o)])]) > 0)) return;
    int& index = of_root[at(root[at(o)])];
    if (index < 0) {
      index = static_cast<int>(groups.size());
      groups.emplace_back().lost = lost_of_root[at(root[at(o)])];
    }
    number[at(o)] = index;
    add(s, o, groups[at(index)]);
  });
  return groups;
}

/// True if a collider comes within the shift of a group.
bool is_near_collider(const Substep& s, const LaggingGroup& group) {
  const float reach = length(group.shift) + group.thickness;
  return std::any_of(s.own->colliders.begin(), s.own->colliders.end(), [&](const MovingCollider& collider) {
    return std::any_of(group.members.begin(), group.members.end(), [&](int member) {
      return !(distance_from_solid(s.model.objects[at(member)], group.box, collider) > reach);
    });
  });
}

/// True if the masks of a group and of an object let them meet.
bool may_meet(const Substep& s, const LaggingGroup& group, const CompiledObject& other) {
  return std::any_of(group.members.begin(), group.members.end(), [&](int member) {
    const CompiledObject& object = s.model.objects[at(member)];
    return (object.groups & other.mask) != 0 && (other.groups & object.mask) != 0;
  });
}

/// What of an object others may come near; its box is made where it is first asked for.
struct Other {
  const Substep& s;
  int object;
  bool has_surface;  ///< of which the parts are looked at
  bool has_box = false;
  BoxBounds box{};

  /// True if it comes within `reach` [m] of a group in the substep.
  bool comes_near(const LaggingGroup& group, float reach) {
    const BoxBounds of_group{xyz(group.box.low), xyz(group.box.high)};
    if (has_surface && s.pairs->comes_near(object, of_group, reach)) return true;
    if (!has_box) {
      PointBounds made;
      if (!has_surface) add_particles(s, object, made);
      add_solids(s, object, made);
      box = {xyz(made.low), xyz(made.high)};
      has_box = true;
    }
    return overlap(of_group.grown(reach), box);
  }
};

/// Leaves out the shifts of groups that something of another group, or a collider, comes near.
void leave_out_near(const Substep& s, const std::vector<int>& number, std::vector<LaggingGroup>& groups) {
  std::vector<char> is_near;
  is_near.reserve(groups.size());
  for (const LaggingGroup& group : groups) is_near.push_back(static_cast<char>(is_near_collider(s, group)));
  for_objects(s, [&](int o) {
    const CompiledObject& other = s.model.objects[at(o)];
    Other near{s, o, s.has_pairs() && s.pairs->has_surface(o)};
    const float moved = number[at(o)] < 0 ? 0 : length(groups[at(number[at(o)])].shift);
    for (std::size_t g = 0; g < groups.size(); ++g) {
      const LaggingGroup& group = groups[g];
      if (number[at(o)] == static_cast<int>(g) || is_near[g] != 0 || group.shift == Vec3f{}) continue;
      if (!may_meet(s, group, other)) continue;
      const float reach = moved + length(group.shift) + group.thickness + other.thickness;
      is_near[g] = static_cast<char>(near.comes_near(group, reach));
    }
  });
  for (std::size_t g = 0; g < groups.size(); ++g)
    if (is_near[g] != 0) groups[g].shift = {};
}

void move(Substep& s, const LaggingGroup& group) {
  for (const int object : group.members)
    for (int i = s.model.first[at(object)]; i < s.model.end_of(object); ++i) {
      Record &d = s.work.displacements[at(i)], &r = s.state.remainders[at(i)];
      d = plus(d, group.shift);
      r = plus(r, group.shift);
    }
}

}  // namespace

bool move_by_lag(Substep& s) {
  if (s.own->without_velocity.empty()) return false;
  std::vector<int> number;
  std::vector<LaggingGroup> groups = lagging_groups(s, number);
  bool any = false;
  for (LaggingGroup& group : groups) {
    group.shift = rounded_as_positions(convert<float>(group.lost * (-1 / group.mass)), group.extent);
    any = any || group.shift != Vec3f{};
  }
  if (!any) return false;
  leave_out_near(s, number, groups);
  float farthest = 0;
  for (const LaggingGroup& group : groups) {
    if (group.shift == Vec3f{}) continue;
    move(s, group);
    farthest = max(farthest, length(group.shift));
  }
  if (s.bodies != nullptr) s.bodies->note_shift(farthest);
  return farthest > 0;
}

}  // namespace pliant
