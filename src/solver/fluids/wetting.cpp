#include "solver/fluids/wetting.h"

#include <algorithm>

#include "core/at.h"
#include "solver/bodies/body_math.h"
#include "solver/bodies/body_solver.h"
#include "solver/fluids/fluid_bodies.h"
#include "solver/substep.h"

namespace pliant {

namespace {

/// Calls body(group, first slot, last slot) for the groups of a task.
template <class Body>
void for_groups_of(const NeighbourLists& lists, int task, const Body& body) {
  const int first = task * NeighbourLists::groups_in_a_task;
  const int last = std::min(first + NeighbourLists::groups_in_a_task, lists.groups());
  for (int group = first; group < last; ++group) {
    const int slot = group * NeighbourLists::lanes;
    body(group, slot, std::min(slot + NeighbourLists::lanes, lists.slots()));
  }
}

}  // namespace

void FluidWetting::add(const Fluid& fluid, int particles) {
  const bool wets = fluid.surface_tension > 0 && fluid.contact_angle < 180;
  has_any_ = has_any_ || wets;
  of_point_.resize(of_point_.size() + at(particles),
                   wets ? wetting_law(fluid.spacing, fluid.contact_angle) : WettingLaw{});
}

void FluidWetting::clear() {
  has_any_ = false;
  of_point_.clear();
}

void FluidWetting::find(Substep& s, int object, const NeighbourLists& lists, const Records& by_point, float reach) {
  object_ = object;
  reach_ = reach;
  const std::vector<std::int32_t>& order = lists.order().points();
  const std::size_t padded = at(lists.nobody()) + NeighbourLists::lanes;
  found_at_.resize(padded);
  of_slot_.resize(order.size());
  counts_.assign(padded, 0);
  pulls_.resize(at(lists.tasks()));
  for (std::size_t slot = 0; slot < order.size(); ++slot) {
    found_at_[slot] = by_point[at(order[slot])];
    of_slot_[slot] = of_point_[at(order[slot])];
  }
  walls_.find(s.context.executor, s.model.objects[at(object)], lists, found_at_, FluidBodies::bounds(s, object), reach,
              reach / 2);
}

void FluidWetting::measure(Substep& s, const NeighbourLists& lists, const Records& places) {
  const FluidBounds bounds = FluidBodies::bounds(s, object_);
  s.context.executor.parallel_for("surface tension: walls", lists.tasks(), [&](int task) {
    std::vector<WallPull>& pulls = pulls_[at(task)];
    pulls.clear();
    for_groups_of(lists, task, [&](int group, int first, int last) {
      const NearWalls near = walls_.near(group);
      for (int slot = first; slot < last && near.first != near.last; ++slot)
        measure_slot(bounds, near, places[at(slot)], slot, pulls);
    });
  });
}

void FluidWetting::measure_slot(const FluidBounds& bounds, const NearWalls& near, const Record& place, int slot,
                                std::vector<WallPull>& to) {
  float shares[most_walls];
  const std::size_t begin = to.size();
  int count = 0;
  for (const std::int32_t* wall = near.first; wall != near.last && count < most_walls; ++wall) {
    const SurfaceDistance<float> from = distance_to(bounds.at(*wall), xyz(place));
    if (!(from.distance < reach_)) continue;
    const double t = static_cast<double>(std::max(from.distance, 0.f) / reach_);
    shares[count++] = static_cast<float>(std::max(share_beyond_plane(t), 0.0));
    to.push_back({slot, *wall, from.normal * (static_cast<float>(slope_beyond_plane(t)) / reach_), {}});
  }
  float left = 1;
  for (int i = 0; i < count; ++i) {
    left *= 1 - shares[i];
    for (int other = 0; other < count; ++other)
      if (other != i) to[begin + at(i)].gradient = to[begin + at(i)].gradient * (1 - shares[other]);
  }
  counts_[at(slot)] = of_slot_[at(slot)].count * (1 - left);
}

void FluidWetting::pull(Substep& s, const NeighbourLists& lists, const Records& lacking,
                        const std::vector<float>& tensions, Records& forces) {
  s.context.executor.parallel_for("surface tension: walls", lists.tasks(), [&](int task) {
    for (WallPull& pull : pulls_[at(task)]) {
      const WettingLaw& law = of_slot_[at(pull.slot)];
      const float size = lacking[at(pull.slot)].w * law.count + tensions[at(pull.slot)] * law.energy;
      pull.force = pull.gradient * size;
      forces[at(pull.slot)] = plus(forces[at(pull.slot)], pull.force);
    }
  });
  const FluidBounds bounds = FluidBodies::bounds(s, object_);
  if (bounds.number_of_solids() > 0) pull_bodies(s, bounds.number_of_colliders(), lacking);
}

void FluidWetting::pull_bodies(Substep& s, int colliders, const Records& places) {
  moved_.assign(s.bodies->touched_bodies().size(), {});
  turned_.assign(moved_.size(), {});
  for (const std::vector<WallPull>& pulls : pulls_)
    for (const WallPull& pull : pulls) {
      if (pull.wall < colliders) continue;
      const int body = s.bodies->solids().body_of_solid()[at(pull.wall - colliders)];
      const Vec3f impulse = pull.force * -(s.h * s.h);
      moved_[at(body)] += impulse;
      turned_[at(body)] += cross(xyz(places[at(pull.slot)]) - FluidBodies::centre_of(s, body), impulse);
    }
  for (std::size_t body = 0; body < moved_.size(); ++body) {
    if (moved_[body] == Vec3f{} && turned_[body] == Vec3f{}) continue;
    const TouchedBody& of = s.bodies->touched_bodies()[body];
    const BodyMotion& motion = s.bodies->present_motions()[body];
    Record& d = s.work.displacements[at(of.particle)];
    d = plus(d, moved_[body] * motion.inverse_mass);
    const Vec3f turn = times(motion.inverse_inertia, turned_[body]);
    if (turn == Vec3f{}) continue;
    Record& corrections = s.work.frames.corrections[at(of.frame)];
    corrections = plus(corrections, turn);
    rotate_by(turn, s.state.frames.orientations[at(of.frame)]);
  }
}

}  // namespace pliant
