#include "solver/fluids/viscosity_walls.h"

#include "solver/bodies/body_math.h"
#include "solver/bodies/body_solver.h"
#include "solver/substep.h"

namespace pliant {

namespace {

/// How far the point of a collider at a place moves in the substep.
Vec3f motion_of(const MovingCollider& wall, const Vec3f& place) {
  if (!wall.moves) return {};
  return place - to_world(wall.before, to_local(wall.after, place));
}

}  // namespace

void ViscosityWalls::find(Substep& s, const ViscosityLaw& law, const FluidWalls& walls, const FluidBounds& bounds,
                          const Records& places, const std::vector<float>& viscosities, int slots) {
  grips_.clear();
  begin_.assign(1, 0);
  const int groups = (slots + NeighbourLists::lanes - 1) / NeighbourLists::lanes,
            colliders = bounds.number_of_colliders();
  const auto add = [&](int slot, std::int32_t which) {
    const Vec3f place = xyz(places[at(slot)]);
    const MovingCollider& wall = bounds.at(which);
    if (wall.static_friction == 0 && wall.kinetic_friction == 0) return;
    const SurfaceDistance<float> to = distance_to(wall, place);
    if (!(to.distance < law.reach)) return;
    WallGrip grip{slot};
    grip.factor = viscosities[at(slot)] * s.h * grip_of_wall(law, to.distance);
    if (!(grip.factor > 0)) return;
    grip.normal = to.normal;
    if (which < colliders) {
      grip.motion = motion_of(wall, place);
      if (wall.slides()) grip.motion += wall.slide - to.normal * dot(to.normal, wall.slide);
    } else {
      grip.body = s.bodies->solids().body_of_solid()[at(which - colliders)];
      grip.arm = place - FluidBodies::centre_of(s, grip.body);
    }
    grips_.push_back(grip);
  };
  for (int group = 0; group < groups; ++group) {
    const int first = group * NeighbourLists::lanes, last = std::min(first + NeighbourLists::lanes, slots);
    const NearWalls near = walls.near(group);
    for (int slot = near.first == near.last ? last : first; slot < last; ++slot)
      for (const std::int32_t* which = near.first; which != near.last; ++which) add(slot, *which);
    begin_.push_back(grips_.size());
  }
}

GripRange ViscosityWalls::of_group(int group) const {
  return {grips_.data() + begin_[at(group)], grips_.data() + begin_[at(group + 1)]};
}

}  // namespace pliant
