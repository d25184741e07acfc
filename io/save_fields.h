// Lists all members of a Scene in one order, for writing, reading and hashing. Each function uses a structured binding,
// which does not compile when the struct gets a member. Then add the member here and increase save_file::version.
//
// An archive is called with members that determine a run's bits; its `aside` is called with the others (colours, threads).
#pragma once

#include <concepts>
#include <type_traits>

#include "pliant/scene.h"
#include "pliant/world.h"

namespace pliant::save_file {

/// A struct that is const for writing, or mutable for reading.
template <class T, class As>
concept Is = std::same_as<std::remove_const_t<T>, As>;

template <class A>
void fields(A& a, Is<Stiffness> auto& of) {
  auto& [kind, value, damping] = of;
  a(kind, value, damping);
}
template <class A>
void fields(A& a, Is<Plasticity> auto& of) {
  auto& [yield, rate, most] = of;
  a(yield, rate, most);
}
template <class A>
void fields(A& a, Is<RestKeyframe> auto& of) {
  auto& [time, factor] = of;
  a(time, factor);
}
template <class A>
void fields(A& a, Is<ConstraintGroup> auto& of) {
  auto& [type, particles, rest, stiffness, compliances, plasticity, keyframes, break_force] = of;
  a(type, particles, rest, stiffness, compliances, plasticity, keyframes, break_force);
}
template <class A>
void fields(A& a, Is<PressureKeyframe> auto& of) {
  auto& [time, pressure] = of;
  a(time, pressure);
}
template <class A>
void fields(A& a, Is<Volume> auto& of) {
  auto& [pressure, stiffness, lift, keyframes, leak] = of;
  a(pressure, stiffness, lift, keyframes, leak);
}
template <class A>
void fields(A& a, Is<Keyframe> auto& of) {
  auto& [time, position, rotation] = of;
  a(time, position, rotation);
}
template <class A>
void fields(A& a, Is<Motion> auto& of) {
  auto& [keyframes, pivot, repeat] = of;
  a(keyframes, pivot, repeat);
}
template <class A>
void fields(A& a, Is<Cluster> auto& of) {
  auto& [particles, rest, mode, share, stiffness, plasticity] = of;
  a(particles, rest, mode, share, stiffness, plasticity);
}
template <class A>
void fields(A& a, Is<Pin> auto& of) {
  auto& [particle, motion] = of;
  a(particle, motion);
}
template <class A>
void fields(A& a, Is<Tearing> auto& of) {
  auto& [stretch] = of;
  a(stretch);
}
template <class A>
void fields(A& a, Is<PlaneCut> auto& of) {
  auto& [start, end, point, normal, along] = of;
  a(start, end, point, normal, along);
}
template <class A>
void fields(A& a, Is<SkinVertex> auto& of) {
  auto& [particles, weights] = of;
  a(particles, weights);
}
template <class A>
void fields(A& a, Is<Skin> auto& of) {
  auto& [vertices, triangles] = of;
  a(vertices, triangles);
}
template <class A>
void fields(A& a, Is<Attachment> auto& of) {
  auto& [particle, target, motion, stiffness] = of;
  a(particle, target, motion, stiffness);
}
template <class A>
void fields(A& a, Is<ObjectFrame> auto& of) {
  auto& [orientation, angular_velocity, inertia] = of;
  a(orientation, angular_velocity, inertia);
}
template <class A>
void fields(A& a, Is<Solid> auto& of) {
  auto& [shape, position, rotation, density] = of;
  a(shape, position, rotation, density);
}
template <class A>
void fields(A& a, Is<ObjectBody> auto& of) {
  auto& [name, particle, frame, solids, origin, axes, surface_velocity] = of;
  a(name, particle, frame, solids, origin, axes, surface_velocity);
}
template <class A>
void fields(A& a, Is<ObjectJointMotor> auto& of) {
  auto& [name, constraint, to_position] = of;
  a(name, constraint, to_position);
}
template <class A>
void fields(A& a, Is<ObjectJoint> auto& of) {
  auto& [name, kind, joint_a, joint_b, anchor, constraints, break_force, break_torque, motors] = of;
  a(name, kind, joint_a, joint_b, anchor, constraints, break_force, break_torque, motors);
}
template <class A>
void fields(A& a, Is<Channel> auto& of) {
  auto& [name, components, values] = of;
  a(name, components, values);
}
template <class A>
void fields(A& a, Is<StateBlock> auto& of) {
  auto& [first, particles, generation] = of;
  a(first, particles, generation);
}
template <class A>
void fields(A& a, Is<HeldPose> auto& of) {
  auto& [is_mesh, slot, generation, position, rotation] = of;
  a(is_mesh, slot, generation, position, rotation);
}
template <class A>
void fields(A& a, Is<WorldLayout::Slot> auto& of) {
  auto& [number, generation] = of;
  a(number, generation);
}
template <class A>
void fields(A& a, Is<KeptSchedule::Colour> auto& of) {
  auto& [type, law, tile, runs, is_added, constraints] = of;
  a(type, law, tile, runs, is_added, constraints);
}
template <class A>
void fields(A& a, Is<KeptSchedule::Fan> auto& of) {
  auto& [edge_a, edge_b, ring_size, count, ring, tetrahedra] = of;
  a(edge_a, edge_b, ring_size, count, ring, tetrahedra);
}
template <class A>
void fields(A& a, Is<KeptSchedule> auto& of) {
  auto& [order, tile_ends, first_added, colours, fans] = of;
  a(order, tile_ends, first_added, colours, fans);
}
template <class A>
void fields(A& a, Is<WorldLayout> auto& of) {
  auto& [objects, colliders, mesh_colliders, blocks, first_frames, sweeps, schedules, sweep_is_open, substeps_are_open] =
      of;
  a(objects, colliders, mesh_colliders, blocks, first_frames, sweeps, schedules, sweep_is_open, substeps_are_open);
}
template <class A>
void fields(A& a, Is<Fluid> auto& of) {
  auto& [spacing, density, speed_of_sound, viscosity, surface_tension, contact_angle, vorticity, clarity] = of;
  a(spacing, density, speed_of_sound, viscosity, surface_tension, contact_angle, vorticity);
  a.aside(clarity);
}
template <class A>
void fields(A& a, Is<Grains> auto& of) {
  auto& [radius, density, friction, cohesion, mass_scaling] = of;
  a(radius, density, friction, cohesion, mass_scaling);
}
template <class A>
void fields(A& a, Is<Absorbency> auto& of) {
  auto& [capacity, uptake, wicking, rise, runoff, seepage, drag] = of;
  a(capacity, uptake, wicking, rise, runoff, seepage, drag);
}
template <class A>
void fields(A& a, Is<Region> auto& of) {
  auto& [centre, half_size, radius] = of;
  a(centre, half_size, radius);
}
template <class A>
void fields(A& a, Is<GasHeater> auto& of) {
  auto& [region, temperature, rate] = of;
  a(region, temperature, rate);
}
template <class A>
void fields(A& a, Is<Gas> auto& of) {
  auto& [temperature, ambient_temperature, ambient_density, cooling_time, diffusivity, drag, vorticity, heaters] = of;
  a(temperature, ambient_temperature, ambient_density, cooling_time, diffusivity, drag, vorticity, heaters);
}
template <class A>
void fields(A& a, Is<Tracers> auto& of) {
  auto& [source, rate, lifetime, start, end, radius, opacity] = of;
  a(source, rate, lifetime, start, end);
  a.aside(radius);
  a.aside(opacity);
}
template <class A>
void fields(A& a, Is<Emitter> auto& of) {
  auto& [name, position, direction, across, radius, width, height, speed, flow, start, end, motion] = of;
  a(name, position, direction, across, radius, width, height, speed, flow, start, end, motion);
}
template <class A>
void fields(A& a, Is<Drain> auto& of) {
  auto& [name, shape, position, rotation] = of;
  a(name, shape, position, rotation);
}
template <class A>
void fields(A& a, Is<Flow> auto& of) {
  auto& [emitters, drains, lifetime, spare, open] = of;
  a(emitters, drains, lifetime, spare, open);
}
template <class A>
void fields(A& a, Is<Object> auto& of) {
  auto& [name, positions, velocities, masses, frames, bodies, constraints, joints, triangles, volume, fluid, grains,
         clusters, gas, tracers, absorbency, flow, pins, attachments, tearing, cuts, skin, thickness, self_collision,
         collides, groups, mask, static_friction, kinetic_friction, restitution, rolling_friction, spinning_friction, drag,
         lift, sweep, damping, colour] = of;
  a(name, positions, velocities, masses, frames, bodies, constraints, joints, triangles, volume, fluid, grains, clusters,
    gas, tracers, absorbency, flow, pins, attachments, tearing, cuts, thickness, self_collision, collides, groups, mask,
    static_friction, kinetic_friction, restitution, rolling_friction, spinning_friction, drag, lift, sweep, damping);
  a.aside(skin, colour);
}
template <class A>
void fields(A&, Is<Plane> auto&) {}
template <class A>
void fields(A& a, Is<Sphere> auto& of) {
  auto& [radius] = of;
  a(radius);
}
template <class A>
void fields(A& a, Is<Capsule> auto& of) {
  auto& [radius, half_length] = of;
  a(radius, half_length);
}
template <class A>
void fields(A& a, Is<Box> auto& of) {
  auto& [half_extents] = of;
  a(half_extents);
}
template <class A>
void fields(A& a, Is<Cylinder> auto& of) {
  auto& [radius, half_length] = of;
  a(radius, half_length);
}
template <class A>
void fields(A& a, Is<Cone> auto& of) {
  auto& [radius, half_length] = of;
  a(radius, half_length);
}
template <class A>
void fields(A& a, Is<Hull> auto& of) {
  auto& [points, margin] = of;
  a(points, margin);
}
template <class A>
void fields(A& a, Is<Collider> auto& of) {
  auto& [name, shape, position, rotation, motion, thickness, static_friction, kinetic_friction, restitution,
         rolling_friction, spinning_friction, surface_velocity, colour] = of;
  a(name, shape, position, rotation, motion, thickness, static_friction, kinetic_friction, restitution, rolling_friction,
    spinning_friction, surface_velocity);
  a.aside(colour);
}
template <class A>
void fields(A& a, Is<TriangleMesh> auto& of) {
  auto& [positions, triangles] = of;
  a(positions, triangles);
}
template <class A>
void fields(A& a, Is<MeshFrame> auto& of) {
  auto& [time, positions] = of;
  a(time, positions);
}
template <class A>
void fields(A& a, Is<DistanceField> auto& of) {
  auto& [low, spacing, nodes, distances] = of;
  a(low, spacing, nodes, distances);
}
template <class A>
void fields(A& a, Is<MeshCollider> auto& of) {
  auto& [name, mesh, motion, frames, repeat_frames, as, grid_spacing, field, thickness, static_friction, kinetic_friction,
         restitution, rolling_friction, spinning_friction, groups, mask, surface_velocity, colour] = of;
  a(name, mesh, motion, frames, repeat_frames, as, grid_spacing);
  a.aside(field);
  a(thickness, static_friction, kinetic_friction, restitution, rolling_friction, spinning_friction, groups, mask,
    surface_velocity);
  a.aside(colour);
}
template <class A>
void fields(A& a, Is<PairProperties> auto& of) {
  auto& [first, second, thickness, static_friction, kinetic_friction, restitution] = of;
  a(first, second, thickness, static_friction, kinetic_friction, restitution);
}
template <class A>
void fields(A& a, Is<Wind> auto& of) {
  auto& [velocity, gust, gust_period, air_density] = of;
  a(velocity, gust, gust_period, air_density);
}
template <class A>
void fields(A& a, Is<SweepOptions> auto& of) {
  auto& [relaxation, sharing, acceleration, plain_iterations, spectral_radius, tethers, tether_slack, chain_softness,
         most_overstretch, multigrid_cycles] = of;
  a(relaxation, sharing, acceleration, plain_iterations, spectral_radius, tethers, tether_slack, chain_softness,
    most_overstretch, multigrid_cycles);
}
template <class A>
void fields(A& a, Is<SleepOptions> auto& of) {
  auto& [on, speed, spin, time] = of;
  a(on, speed, spin, time);
}
template <class A>
void fields(A& a, Is<Settings> auto& of) {
  auto& [substeps, iterations, tolerance, threads, sweep, sweep_options, contact_filter, most_substeps, least_substeps,
         initial_intersections, integrator, untangling_speed, sleep, separate_phases, measure, record_residuals,
         record_multipliers, isa] = of;
  a(substeps, iterations, tolerance);
  a.aside(threads);
  a(sweep, sweep_options, contact_filter, most_substeps, least_substeps, initial_intersections, integrator,
    untangling_speed, sleep);
  a.aside(separate_phases, measure, record_residuals, record_multipliers, isa);
}
/// Force fields are functions, so only their number is stored, by the caller of `fields`. Settings have a block of
/// their own.
template <class A>
void fields(A& a, Is<Scene> auto& of) {
  [[maybe_unused]] auto& [gravity, wind, forces, settings, frame_time, frames, objects, colliders, mesh_colliders, pairs] =
      of;
  a(gravity, wind, frame_time);
  a.aside(frames);
  a(objects, colliders, mesh_colliders, pairs);
}

/// The last value of an enumeration, so that a reader can reject larger ones.
constexpr int last_value(Cluster::Mode) { return static_cast<int>(Cluster::Mode::quadratic); }
constexpr int last_value(Stiffness::Kind) { return static_cast<int>(Stiffness::Kind::pbd); }
constexpr int last_value(MeshCollider::As) { return static_cast<int>(MeshCollider::As::heightfield); }
constexpr int last_value(Sweep) { return static_cast<int>(Sweep::tethered_chains); }
constexpr int last_value(SweepOptions::Sharing) { return static_cast<int>(SweepOptions::Sharing::average); }
constexpr int last_value(SweepOptions::Acceleration) { return static_cast<int>(SweepOptions::Acceleration::chebyshev); }
constexpr int last_value(Settings::Integrator) { return static_cast<int>(Settings::Integrator::energy); }
constexpr int last_value(Settings::Intersections) { return static_cast<int>(Settings::Intersections::refuse); }

}  // namespace pliant::save_file
