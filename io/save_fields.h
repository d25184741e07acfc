// Lists all members of a Scene in one order, for writing, reading and hashing. Each function uses a structured binding,
// which does not compile when the struct gets a member. Then add the member here and increase save_file::version.
//
// An archive is called with members that determine a run's bits; its `aside` is called with the others (colours,
// threads). Both also get the names of the members, as "kind, value, damping".
#pragma once

#include <array>
#include <concepts>
#include <type_traits>

#include "pliant/scene.h"
#include "pliant/world.h"

namespace pliant::save_file {

#define PLIANT_FIELDS(archive, ...) archive(#__VA_ARGS__, __VA_ARGS__)

/// A struct that is const for writing, or mutable for reading.
template <class T, class As>
concept Is = std::same_as<std::remove_const_t<T>, As>;

template <class A>
void fields(A& a, Is<Stiffness> auto& of) {
  auto& [kind, value, damping] = of;
  PLIANT_FIELDS(a, kind, value, damping);
}
template <class A>
void fields(A& a, Is<Plasticity> auto& of) {
  auto& [yield, rate, most] = of;
  PLIANT_FIELDS(a, yield, rate, most);
}
template <class A>
void fields(A& a, Is<RestKeyframe> auto& of) {
  auto& [time, factor] = of;
  PLIANT_FIELDS(a, time, factor);
}
template <class A>
void fields(A& a, Is<ConstraintGroup> auto& of) {
  auto& [type, particles, rest, stiffness, compliances, plasticity, keyframes, break_force] = of;
  PLIANT_FIELDS(a, type, particles, rest, stiffness, compliances, plasticity, keyframes, break_force);
}
template <class A>
void fields(A& a, Is<PressureKeyframe> auto& of) {
  auto& [time, pressure] = of;
  PLIANT_FIELDS(a, time, pressure);
}
template <class A>
void fields(A& a, Is<Volume> auto& of) {
  auto& [pressure, stiffness, lift, keyframes, leak] = of;
  PLIANT_FIELDS(a, pressure, stiffness, lift, keyframes, leak);
}
template <class A>
void fields(A& a, Is<Keyframe> auto& of) {
  auto& [time, position, rotation] = of;
  PLIANT_FIELDS(a, time, position, rotation);
}
template <class A>
void fields(A& a, Is<Motion> auto& of) {
  auto& [keyframes, pivot, repeat] = of;
  PLIANT_FIELDS(a, keyframes, pivot, repeat);
}
template <class A>
void fields(A& a, Is<Cluster> auto& of) {
  auto& [particles, rest, mode, share, stiffness, plasticity] = of;
  PLIANT_FIELDS(a, particles, rest, mode, share, stiffness, plasticity);
}
template <class A>
void fields(A& a, Is<Pin> auto& of) {
  auto& [particle, motion] = of;
  PLIANT_FIELDS(a, particle, motion);
}
template <class A>
void fields(A& a, Is<Tearing> auto& of) {
  auto& [stretch] = of;
  PLIANT_FIELDS(a, stretch);
}
template <class A>
void fields(A& a, Is<PlaneCut> auto& of) {
  auto& [start, end, point, normal, along] = of;
  PLIANT_FIELDS(a, start, end, point, normal, along);
}
template <class A>
void fields(A& a, Is<SkinVertex> auto& of) {
  auto& [particles, weights] = of;
  PLIANT_FIELDS(a, particles, weights);
}
template <class A>
void fields(A& a, Is<Skin> auto& of) {
  auto& [vertices, triangles] = of;
  PLIANT_FIELDS(a, vertices, triangles);
}
template <class A>
void fields(A& a, Is<Attachment> auto& of) {
  auto& [particle, target, motion, stiffness] = of;
  PLIANT_FIELDS(a, particle, target, motion, stiffness);
}
template <class A>
void fields(A& a, Is<ObjectFrame> auto& of) {
  auto& [orientation, angular_velocity, inertia] = of;
  PLIANT_FIELDS(a, orientation, angular_velocity, inertia);
}
template <class A>
void fields(A& a, Is<Solid> auto& of) {
  auto& [shape, position, rotation, density] = of;
  PLIANT_FIELDS(a, shape, position, rotation, density);
}
template <class A>
void fields(A& a, Is<ObjectBody> auto& of) {
  auto& [name, particle, frame, solids, origin, axes, surface_velocity] = of;
  PLIANT_FIELDS(a, name, particle, frame, solids, origin, axes, surface_velocity);
}
template <class A>
void fields(A& a, Is<MotorKeyframe> auto& of) {
  auto& [time, target] = of;
  PLIANT_FIELDS(a, time, target);
}
template <class A>
void fields(A& a, Is<ObjectJointMotor> auto& of) {
  auto& [name, constraint, to_position, is_torque, keyframes] = of;
  PLIANT_FIELDS(a, name, constraint, to_position, is_torque, keyframes);
}
template <class A>
void fields(A& a, Is<ObjectJoint> auto& of) {
  auto& [name, kind, joint_a, joint_b, anchor, constraints, break_force, break_torque, motors, anchor_a, axes_a,
         axes_b] = of;
  PLIANT_FIELDS(a, name, kind, joint_a, joint_b, anchor, constraints, break_force, break_torque, motors, anchor_a,
                axes_a, axes_b);
}
template <class A>
void fields(A& a, Is<Channel> auto& of) {
  auto& [name, components, values] = of;
  PLIANT_FIELDS(a, name, components, values);
}
template <class A>
void fields(A& a, Is<StateBlock> auto& of) {
  auto& [first, particles, generation] = of;
  PLIANT_FIELDS(a, first, particles, generation);
}
template <class A>
void fields(A& a, Is<HeldPose> auto& of) {
  auto& [is_mesh, slot, generation, position, rotation] = of;
  PLIANT_FIELDS(a, is_mesh, slot, generation, position, rotation);
}
template <class A>
void fields(A& a, Is<WorldLayout::Slot> auto& of) {
  auto& [number, generation] = of;
  PLIANT_FIELDS(a, number, generation);
}
template <class A>
void fields(A& a, Is<KeptSchedule::Colour> auto& of) {
  auto& [type, law, tile, runs, is_added, constraints] = of;
  PLIANT_FIELDS(a, type, law, tile, runs, is_added, constraints);
}
template <class A>
void fields(A& a, Is<KeptSchedule::Fan> auto& of) {
  auto& [edge_a, edge_b, ring_size, count, ring, tetrahedra] = of;
  PLIANT_FIELDS(a, edge_a, edge_b, ring_size, count, ring, tetrahedra);
}
template <class A>
void fields(A& a, Is<KeptSchedule> auto& of) {
  auto& [order, tile_ends, first_added, colours, fans] = of;
  PLIANT_FIELDS(a, order, tile_ends, first_added, colours, fans);
}
template <class A>
void fields(A& a, Is<WorldLayout> auto& of) {
  auto& [objects, colliders, mesh_colliders, blocks, first_frames, sweeps, schedules, sweep_is_open,
         substeps_are_open] = of;
  PLIANT_FIELDS(a, objects, colliders, mesh_colliders, blocks, first_frames, sweeps, schedules, sweep_is_open,
                substeps_are_open);
}
template <class A>
void fields(A& a, Is<Fluid> auto& of) {
  auto& [spacing, density, speed_of_sound, viscosity, surface_tension, contact_angle, vorticity, clarity] = of;
  PLIANT_FIELDS(a, spacing, density, speed_of_sound, viscosity, surface_tension, contact_angle, vorticity);
  PLIANT_FIELDS(a.aside, clarity);
}
template <class A>
void fields(A& a, Is<Grains> auto& of) {
  auto& [radius, density, friction, cohesion, mass_scaling] = of;
  PLIANT_FIELDS(a, radius, density, friction, cohesion, mass_scaling);
}
template <class A>
void fields(A& a, Is<Absorbency> auto& of) {
  auto& [capacity, uptake, wicking, rise, runoff, seepage, drag] = of;
  PLIANT_FIELDS(a, capacity, uptake, wicking, rise, runoff, seepage, drag);
}
template <class A>
void fields(A& a, Is<Region> auto& of) {
  auto& [centre, half_size, radius] = of;
  PLIANT_FIELDS(a, centre, half_size, radius);
}
template <class A>
void fields(A& a, Is<GasHeater> auto& of) {
  auto& [region, temperature, rate] = of;
  PLIANT_FIELDS(a, region, temperature, rate);
}
template <class A>
void fields(A& a, Is<Gas> auto& of) {
  auto& [temperature, ambient_temperature, ambient_density, cooling_time, diffusivity, drag, vorticity, heaters] = of;
  PLIANT_FIELDS(a, temperature, ambient_temperature, ambient_density, cooling_time, diffusivity, drag, vorticity,
                heaters);
}
template <class A>
void fields(A& a, Is<Tracers> auto& of) {
  auto& [source, rate, lifetime, start, end, radius, opacity] = of;
  PLIANT_FIELDS(a, source, rate, lifetime, start, end);
  PLIANT_FIELDS(a.aside, radius);
  PLIANT_FIELDS(a.aside, opacity);
}
template <class A>
void fields(A& a, Is<Emitter> auto& of) {
  auto& [name, position, direction, across, radius, width, height, speed, flow, start, end, motion] = of;
  PLIANT_FIELDS(a, name, position, direction, across, radius, width, height, speed, flow, start, end, motion);
}
template <class A>
void fields(A& a, Is<Drain> auto& of) {
  auto& [name, shape, position, rotation] = of;
  PLIANT_FIELDS(a, name, shape, position, rotation);
}
template <class A>
void fields(A& a, Is<Flow> auto& of) {
  auto& [emitters, drains, lifetime, spare, open] = of;
  PLIANT_FIELDS(a, emitters, drains, lifetime, spare, open);
}
template <class A>
void fields(A& a, Is<Object> auto& of) {
  auto& [name, positions, velocities, masses, frames, bodies, constraints, joints, triangles, volume, fluid, grains,
         clusters, gas, tracers, absorbency, flow, pins, attachments, tearing, cuts, skin, thickness, self_collision,
         collides, groups, mask, static_friction, kinetic_friction, restitution, rolling_friction, spinning_friction,
         drag, lift, sweep, damping, colour, clarity] = of;
  PLIANT_FIELDS(a, name, positions, velocities, masses, frames, bodies, constraints, joints, triangles, volume, fluid,
                grains, clusters, gas, tracers, absorbency, flow, pins, attachments, tearing, cuts, thickness,
                self_collision, collides, groups, mask, static_friction, kinetic_friction, restitution,
                rolling_friction, spinning_friction, drag, lift, sweep, damping);
  PLIANT_FIELDS(a.aside, skin, colour, clarity);
}
template <class A>
void fields(A&, Is<Plane> auto&) {}
template <class A>
void fields(A& a, Is<Sphere> auto& of) {
  auto& [radius] = of;
  PLIANT_FIELDS(a, radius);
}
template <class A>
void fields(A& a, Is<Capsule> auto& of) {
  auto& [radius, half_length] = of;
  PLIANT_FIELDS(a, radius, half_length);
}
template <class A>
void fields(A& a, Is<Box> auto& of) {
  auto& [half_extents] = of;
  PLIANT_FIELDS(a, half_extents);
}
template <class A>
void fields(A& a, Is<Cylinder> auto& of) {
  auto& [radius, half_length] = of;
  PLIANT_FIELDS(a, radius, half_length);
}
template <class A>
void fields(A& a, Is<Cone> auto& of) {
  auto& [radius, half_length] = of;
  PLIANT_FIELDS(a, radius, half_length);
}
template <class A>
void fields(A& a, Is<Hull> auto& of) {
  auto& [points, margin] = of;
  PLIANT_FIELDS(a, points, margin);
}
template <class A>
void fields(A& a, Is<Collider> auto& of) {
  auto& [name, shape, position, rotation, motion, thickness, static_friction, kinetic_friction, restitution,
         rolling_friction, spinning_friction, surface_velocity, colour] = of;
  PLIANT_FIELDS(a, name, shape, position, rotation, motion, thickness, static_friction, kinetic_friction, restitution,
                rolling_friction, spinning_friction, surface_velocity);
  PLIANT_FIELDS(a.aside, colour);
}
template <class A>
void fields(A& a, Is<TriangleMesh> auto& of) {
  auto& [positions, triangles] = of;
  PLIANT_FIELDS(a, positions, triangles);
}
template <class A>
void fields(A& a, Is<MeshFrame> auto& of) {
  auto& [time, positions] = of;
  PLIANT_FIELDS(a, time, positions);
}
template <class A>
void fields(A& a, Is<DistanceField> auto& of) {
  auto& [low, spacing, nodes, distances] = of;
  PLIANT_FIELDS(a, low, spacing, nodes, distances);
}
template <class A>
void fields(A& a, Is<MeshCollider> auto& of) {
  auto& [name, mesh, motion, frames, repeat_frames, as, grid_spacing, field, thickness, static_friction,
         kinetic_friction, restitution, rolling_friction, spinning_friction, groups, mask, surface_velocity, colour] =
      of;
  PLIANT_FIELDS(a, name, mesh, motion, frames, repeat_frames, as, grid_spacing);
  PLIANT_FIELDS(a.aside, field);
  PLIANT_FIELDS(a, thickness, static_friction, kinetic_friction, restitution, rolling_friction, spinning_friction,
                groups, mask, surface_velocity);
  PLIANT_FIELDS(a.aside, colour);
}
template <class A>
void fields(A& a, Is<PairProperties> auto& of) {
  auto& [first, second, thickness, static_friction, kinetic_friction, restitution] = of;
  PLIANT_FIELDS(a, first, second, thickness, static_friction, kinetic_friction, restitution);
}
template <class A>
void fields(A& a, Is<Wind> auto& of) {
  auto& [velocity, gust, gust_period, air_density] = of;
  PLIANT_FIELDS(a, velocity, gust, gust_period, air_density);
}
template <class A>
void fields(A& a, Is<SweepOptions> auto& of) {
  auto& [relaxation, sharing, acceleration, plain_iterations, spectral_radius, tethers, tether_slack, chain_softness,
         most_overstretch, multigrid_cycles] = of;
  PLIANT_FIELDS(a, relaxation, sharing, acceleration, plain_iterations, spectral_radius, tethers, tether_slack,
                chain_softness, most_overstretch, multigrid_cycles);
}
template <class A>
void fields(A& a, Is<SleepOptions> auto& of) {
  auto& [on, speed, spin, time] = of;
  PLIANT_FIELDS(a, on, speed, spin, time);
}
template <class A>
void fields(A& a, Is<Settings> auto& of) {
  auto& [substeps, iterations, tolerance, threads, sweep, sweep_options, contact_filter, most_substeps, least_substeps,
         initial_intersections, integrator, untangling_speed, sleep, separate_phases, measure, record_residuals,
         record_multipliers, isa] = of;
  PLIANT_FIELDS(a, substeps, iterations, tolerance);
  PLIANT_FIELDS(a.aside, threads);
  PLIANT_FIELDS(a, sweep, sweep_options, contact_filter, most_substeps, least_substeps, initial_intersections,
                integrator, untangling_speed, sleep);
  PLIANT_FIELDS(a.aside, separate_phases, measure, record_residuals, record_multipliers, isa);
}
/// Force fields are functions, so only their number is stored, by the caller of `fields`. Settings have a block of
/// their own.
template <class A>
void fields(A& a, Is<Scene> auto& of) {
  [[maybe_unused]] auto& [gravity, wind, forces, settings, frame_time, frames, objects, colliders, mesh_colliders,
                          pairs] = of;
  PLIANT_FIELDS(a, gravity, wind, frame_time);
  PLIANT_FIELDS(a.aside, frames);
  PLIANT_FIELDS(a, objects, colliders, mesh_colliders, pairs);
}

/// The words of an enumeration, by value, for text; a reader of bytes rejects larger values.
constexpr std::array<const char*, 3> words(Cluster::Mode) { return {"rigid", "linear", "quadratic"}; }
constexpr std::array<const char*, 2> words(Stiffness::Kind) { return {"compliance", "pbd"}; }
constexpr std::array<const char*, 3> words(MeshCollider::As) { return {"triangles", "distance_grid", "heightfield"}; }
constexpr std::array<const char*, 2> words(SweepOptions::Sharing) { return {"split", "average"}; }
constexpr std::array<const char*, 2> words(SweepOptions::Acceleration) { return {"none", "chebyshev"}; }
constexpr std::array<const char*, 2> words(Settings::Integrator) { return {"pbd", "energy"}; }
constexpr std::array<const char*, 3> words(Settings::Intersections) { return {"leave", "untangle", "refuse"}; }
constexpr std::array<const char*, 9> words(Sweep) {
  return {"automatic", "tiled",  "sequential", "symmetric",      "jacobi",
          "natural",   "chains", "multigrid",  "tethered_chains"};
}

/// The words of the alternatives of a variant.
inline std::array<const char*, 4> words(const Shape&) { return {"plane", "sphere", "capsule", "box"}; }
inline std::array<const char*, 6> words(const SolidShape&) {
  return {"sphere", "capsule", "box", "cylinder", "cone", "hull"};
}

}  // namespace pliant::save_file
