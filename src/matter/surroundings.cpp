#include "matter/surroundings.h"

#include <algorithm>
#include <cmath>

namespace pliant {

namespace {

bool may_meet(const SetMember& other, const Object& object) {
  return (other.groups & object.mask) != 0 && (object.groups & other.mask) != 0;
}

}  // namespace

double magnitude(const Vec3f& gravity) { return std::sqrt(static_cast<double>(length_squared(gravity))); }

Surroundings surroundings_of(const Scene& scene, const Settings& settings) {
  Surroundings found;
  for (const Object& object : scene.objects) found.members.push_back(member_of(object, 0, SubstepRule::any));
  for (const MeshCollider& collider : scene.mesh_colliders) {
    if (collider.as == MeshCollider::As::triangles)
      found.members.push_back(member_of(collider));
    else
      found.other_meshes.push_back({collider.groups, collider.mask});
  }
  found.has_primitives = !scene.colliders.empty();
  found.gravity = magnitude(scene.gravity);
  found.frame_time = static_cast<double>(scene.frame_time);
  found.rule_of = [&scene, of_all = settings.sweep, gravity = found.gravity](std::size_t number) {
    const Object& object = scene.objects[number];
    const Sweep named = object.sweep != Sweep::automatic ? object.sweep : of_all;
    return substep_rule(object, named != Sweep::automatic ? named : Sweep::chains, gravity);
  };
  return found;
}

bool can_touch(const Surroundings& surroundings, const Object& object, std::size_t number) {
  if (object.self_collision) return true;
  const std::vector<SetMember>& members = surroundings.members;
  for (std::size_t other = 0; other < members.size(); ++other) {
    const SetMember& member = members[other];
    const bool touches = member.is_collider || (other != number && object.collides && member.collides);
    if (touches && may_meet(member, object)) return true;
  }
  return false;
}

bool can_meet_collider(const Surroundings& surroundings, const Object& object) {
  if (surroundings.has_primitives) return true;
  const auto meets = [&](const SetMember& mesh) { return may_meet(mesh, object); };
  const auto is_met = [&](const SetMember& member) { return member.is_collider && meets(member); };
  return std::any_of(surroundings.other_meshes.begin(), surroundings.other_meshes.end(), meets) ||
         std::any_of(surroundings.members.begin(), surroundings.members.end(), is_met);
}

int OpenSets::substeps_of(std::size_t number) {
  if (settings_.substeps > 0) return settings_.substeps;
  if (sets_.empty()) find();
  const SetSubsteps& set = sets_[number];
  if (set.substeps == substeps_of_others) return substeps_of_others;  // for which PBD stiffness is converted
  const bool has_bounds = set.by_state && settings_.least_substeps + settings_.most_substeps > 0;
  if (!has_bounds) return substeps_of_volumes;
  const int least = settings_.least_substeps > 0 ? settings_.least_substeps : substeps_of_volumes;
  return settings_.most_substeps > 0 ? std::min(least, settings_.most_substeps) : least;
}

void OpenSets::find() {
  std::vector<SetMember> members = surroundings_.members;
  for (std::size_t i = 0; i < members.size(); ++i)
    if (!members[i].is_collider) members[i].rule = surroundings_.rule_of(i);
  sets_ = substeps_of_sets(members);
}

}  // namespace pliant
