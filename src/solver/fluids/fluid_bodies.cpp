#include "solver/fluids/fluid_bodies.h"

#include "solver/bodies/body_math.h"
#include "solver/bodies/body_solver.h"
#include "solver/substep.h"

namespace pliant {

namespace {

int body_of(const Substep& s, const NearSolid& near) { return s.bodies->solids().body_of_solid()[at(near.solid)]; }

}  // namespace

Vec3f FluidBodies::centre_of(const Substep& s, int body) {
  const TouchedBody& of = s.bodies->touched_bodies()[at(body)];
  return xyz(s.state.positions[at(of.particle)]) + xyz(s.work.displacements[at(of.particle)]);
}

FluidBounds FluidBodies::bounds(const Substep& s, int object) {
  FluidBounds all{&s.own->colliders, nullptr, {}};
  if (s.bodies == nullptr || s.bodies->solids().empty()) return all;
  const BodySolids& solids = s.bodies->solids();
  all.solids = &solids.moving();
  for (int solid = 0; solid < all.number_of_solids(); ++solid)
    all.meets.push_back(solids.meets_object(object, solid) ? 1 : 0);
  return all;
}

void FluidBodies::count(const Substep& s, const FluidWalls& walls) {
  if (walls.near_solids().empty()) return;
  touched_.assign(s.bodies->touched_bodies().size(), 0);
  for (const NearSolid& near : walls.near_solids()) touched_[at(body_of(s, near))] += near.touched;
}

void FluidBodies::add_squares(const Substep& s, const FluidWalls& walls, const Records& places, float mass, int group,
                              std::vector<float>& squares) const {
  const std::size_t first = at(group) * NeighbourLists::lanes;
  std::fill_n(squares.begin() + static_cast<std::ptrdiff_t>(first), NeighbourLists::lanes, 0.f);
  for (int i = walls.first_solid(group); i < walls.first_solid(group + 1); ++i) {
    const NearSolid& near = walls.near_solids()[at(i)];
    const int body = body_of(s, near);
    const BodyMotion& motion = s.bodies->present_motions()[at(body)];
    const Vec3f centre = centre_of(s, body);
    const float share = mass * static_cast<float>(touched_[at(body)]);
    for (std::size_t lane = 0; lane < NeighbourLists::lanes; ++lane) {
      const Vec3f& g = near.gradient[lane];
      const Vec3f turn = cross(xyz(places[first + lane]) - centre, g);
      squares[first + lane] +=
          share * (motion.inverse_mass * dot(g, g) + dot(turn, times(motion.inverse_inertia, turn)));
    }
  }
}

void FluidBodies::push(Substep& s, const FluidWalls& walls, const Records& weighted,
                       const std::vector<float>& lightness, float mass) {
  if (walls.near_solids().empty()) return;
  moved_.assign(touched_.size(), {});
  turned_.assign(touched_.size(), {});
  for (const NearSolid& near : walls.near_solids()) {
    if (near.touched == 0) continue;
    const int body = body_of(s, near);
    const Vec3f centre = centre_of(s, body);
    Vec3f force{}, torque{};
    for (std::size_t lane = 0; lane < NeighbourLists::lanes; ++lane) {
      const std::size_t slot = at(near.group) * NeighbourLists::lanes + lane;
      const bool is_fixed = !lightness.empty() && lightness[slot] == 0;
      if (is_fixed || near.gradient[lane] == Vec3f{}) continue;
      const Vec3f push = near.gradient[lane] * (-mass * weighted[slot].w);
      force += push;
      torque += cross(xyz(weighted[slot]) - centre, push);
    }
    const BodyMotion& motion = s.bodies->present_motions()[at(body)];
    moved_[at(body)] += force * motion.inverse_mass;
    turned_[at(body)] += times(motion.inverse_inertia, torque);
  }
  for (std::size_t body = 0; body < touched_.size(); ++body) {
    if (touched_[body] == 0) continue;
    const TouchedBody& of = s.bodies->touched_bodies()[body];
    Record& d = s.work.displacements[at(of.particle)];
    d = plus(d, moved_[body]);
    if (turned_[body] == Vec3f{}) continue;
    Record& corrections = s.work.frames.corrections[at(of.frame)];
    corrections = plus(corrections, turned_[body]);
    rotate_by(turned_[body], s.state.frames.orientations[at(of.frame)]);
  }
}

}  // namespace pliant
