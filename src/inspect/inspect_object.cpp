// Errors in an object for which a World rejects it: inconsistent sizes, indices out of range, invalid numbers.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "constraints/registry.h"
#include "inspect/problems.h"
#include "math/vector.h"
#include "matter/break_constraints.h"
#include "pliant/error.h"
#include "topology/boundary.h"
#include "topology/edges.h"

namespace pliant {

namespace {

bool has_particle(const Object& object, int particle) {
  return particle >= 0 && particle < static_cast<int>(object.positions.size());
}

std::string of(std::size_t count) { return std::to_string(count); }

// ------------------------------------------------------------------------------------------------ particles

void check_positions(Problems& problems, const Object& object) {
  if (object.positions.empty()) problems.grave("", "has no particles", "add some, or leave the object out");
  if (object.positions.size() > std::numeric_limits<int>::max() / 4)
    problems.grave("", "has " + of(object.positions.size()) + " particles", "split it: the limit is 536870911");
  Tally infinite, far;
  for (std::size_t i = 0; i < object.positions.size(); ++i) {
    const Vec3f& p = object.positions[i];
    if (is_place(p)) continue;
    (is_finite(p) ? far : infinite).add(static_cast<std::int64_t>(i));
  }
  problems.grave(infinite, "particle", "has a position that is not finite", "give finite coordinates in metres");
  problems.grave(far, "particle", "is more than 1e9 m away", "scale the scene to metres, near the origin");
}

void check_velocities(Problems& problems, const Object& object) {
  if (object.velocities.empty()) return;
  if (object.velocities.size() != object.positions.size())
    problems.grave("velocities", of(object.velocities.size()) + " for " + of(object.positions.size()) + " particles",
                   "give one per particle, or none");
  Tally bad;
  for (std::size_t i = 0; i < object.velocities.size(); ++i)
    if (!is_place(object.velocities[i])) bad.add(static_cast<std::int64_t>(i));
  problems.grave(bad, "particle", "has a velocity that is not finite or beyond 1e9 m/s", "give a velocity in m/s");
}

void check_masses(Problems& problems, const Object& object) {
  if (object.masses.size() != object.positions.size())
    problems.grave("masses", of(object.masses.size()) + " for " + of(object.positions.size()) + " particles",
                   "give one per particle; infinity for a fixed one");
  Tally none, extreme;
  for (std::size_t i = 0; i < object.masses.size(); ++i) {
    const float mass = object.masses[i];
    if (!(mass > 0))
      none.add(static_cast<std::int64_t>(i));
    else if (!std::isinf(mass) && (mass > largest_quantity || mass < 1 / largest_quantity))
      extreme.add(static_cast<std::int64_t>(i));
  }
  problems.grave(none, "particle", "has a mass that is not above 0",
                 "give more than 0 kg, or infinity for a fixed one");
  problems.grave(extreme, "particle", "has a mass outside 1e-20 to 1e20 kg",
                 "give masses in kg, or infinity for a fixed one");
}

void check_frames(Problems& problems, const Object& object) {
  Tally crooked, spinning, inertia;
  for (std::size_t i = 0; i < object.frames.size(); ++i) {
    const ObjectFrame& frame = object.frames[i];
    const Quatf& q = frame.orientation;
    const float length = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
    if (!(length > 0.9f && length < 1.1f)) crooked.add(static_cast<std::int64_t>(i));
    if (!is_finite(frame.angular_velocity)) spinning.add(static_cast<std::int64_t>(i));
    const auto is_inertia = [](float value) {
      return value > 0 && (std::isinf(value) || (value <= largest_quantity && value >= 1 / largest_quantity));
    };
    if (!is_inertia(frame.inertia.x) || !is_inertia(frame.inertia.y) || !is_inertia(frame.inertia.z))
      inertia.add(static_cast<std::int64_t>(i));
  }
  problems.grave(crooked, "frame", "has an orientation that is no unit quaternion",
                 "give x, y, z, w with squares that sum to 1");
  problems.grave(spinning, "frame", "has an angular velocity that is not finite", "give radians a second");
  const auto small = [&](const ObjectBody& body) { return body.frame == inertia.first; };
  const auto body = std::find_if(object.bodies.begin(), object.bodies.end(), small);
  if (body == object.bodies.end() || inertia.count == 0)
    return problems.grave(inertia, "frame", "has an inertia outside 1e-20 to 1e20 kg m^2",
                          "give all three above 0, or infinity");
  const Vec3f& moments = object.frames[static_cast<std::size_t>(inertia.first)].inertia;
  problems.grave("body " + std::to_string(body - object.bodies.begin()) + " '" + body->name + "'" +
                     (inertia.count > 1 ? " and " + std::to_string(inertia.count - 1) + " more" : ""),
                 "has moments of inertia of " + words(moments.x) + ", " + words(moments.y) + " and " +
                     words(moments.z) + " kg m^2, outside 1e-20 to 1e20",
                 "make it larger, or check that its sizes are in metres");
}

// ------------------------------------------------------------------------------------------------ constraints

const ConstraintType* find_type(const std::string& name) {
  for (const ConstraintType& type : constraint_types())
    if (type.name == name) return &type;
  return nullptr;
}

void check_stencils(Problems& problems, const Object& object, const ConstraintGroup& group, const ConstraintType& type,
                    const std::string& kind) {
  const std::size_t size = type.slots.size();
  Tally outside, no_frame, repeated;
  for (std::size_t c = 0; c < group.particles.size() / size; ++c) {
    const int* stencil = &group.particles[c * size];
    bool known = true, framed = true, distinct = true;
    for (std::size_t i = 0; i < size; ++i) {
      if (type.slots[i] == SlotKind::frame)
        framed = framed && stencil[i] >= 0 && static_cast<std::size_t>(stencil[i]) < object.frames.size();
      else
        known = known && has_particle(object, stencil[i]);
      for (std::size_t j = 0; j < i; ++j)
        distinct = distinct && (type.slots[i] != type.slots[j] || stencil[i] != stencil[j]);
    }
    if (!framed) no_frame.add(static_cast<std::int64_t>(c));
    if (!known) outside.add(static_cast<std::int64_t>(c));
    if (!distinct) repeated.add(static_cast<std::int64_t>(c));
  }
  problems.grave(outside, kind, "uses a particle that does not exist; there are " + of(object.positions.size()),
                 "indices count from 0");
  problems.grave(no_frame, kind, "uses a frame that does not exist; there are " + of(object.frames.size()),
                 "indices count from 0");
  problems.grave(repeated, kind, "uses a particle twice", "use different particles, or remove it");
}

void check_rest(Problems& problems, const ConstraintGroup& group, const ConstraintType& type, std::size_t count,
                const std::string& kind) {
  const std::size_t fields = type.rest_fields.size();
  if (group.rest.empty()) {
    if (fields > 0 && count > 0 && constraint_type(find_constraint_type(type.name)).measure == nullptr)
      problems.grave("rest of " + group.type + " constraints", "cannot be measured by this constraint type",
                     "give `rest`");
    return;
  }
  if (group.rest.size() != count * fields) {
    problems.grave("rest of " + group.type + " constraints",
                   of(group.rest.size()) + " values where " + of(count * fields) + " are needed",
                   "give rest data for all constraints, or none to have them measured");
    return;
  }
  Tally bad;
  for (std::size_t i = 0; i < group.rest.size(); ++i) {
    const bool is_length = type.rest_fields[i % fields] == "rest_length";
    if (!std::isfinite(group.rest[i]) || (is_length && group.rest[i] < 0))
      bad.add(static_cast<std::int64_t>(i / fields));
  }
  problems.grave(bad, kind, "has rest data that is not finite, or a negative length",
                 "leave `rest` empty to have it measured from the positions");
}

void check_compliances(Problems& problems, const ConstraintGroup& group, std::size_t count, const std::string& kind) {
  if (group.compliances.empty()) return;
  if (group.stiffness.kind == Stiffness::Kind::pbd)
    problems.grave("compliances of " + group.type + " constraints", "cannot be combined with a PBD stiffness",
                   "give only one of the two");
  if (group.compliances.size() != count)
    problems.grave("compliances of " + group.type + " constraints",
                   of(group.compliances.size()) + " for " + of(count) + " constraints",
                   "give one per constraint, or none");
  Tally bad;
  for (std::size_t i = 0; i < group.compliances.size(); ++i)
    if (!(group.compliances[i] >= 0 && group.compliances[i] <= largest_quantity)) bad.add(static_cast<std::int64_t>(i));
  problems.grave(bad, kind, "has a compliance outside 0 to 1e20",
                 "0 is rigid; remove constraints that should have no effect");
}

void check_plasticity(Problems& problems, const ConstraintGroup& group, const std::string& element) {
  if (!group.plasticity) return;
  const Plasticity& p = *group.plasticity;
  if (constraint_type(find_constraint_type(group.type)).flow == nullptr)
    problems.grave(element, "have a plasticity, but constraints of this type have none", "leave it out");
  if (is_hinge(group.type) && p.yield > 3.1416f)
    problems.doubtful(element, "yield at more than half a turn, so never", "give the angle in radians");
  if (p.most == 0) problems.doubtful(element, "have a plasticity with a `most` of 0, so nothing flows", "leave it out");
  if (!is_sound(p))
    problems.grave(element, "have a plasticity with a number below 0 or not finite", "give numbers of 0 or more");
}

void check_keyframes(Problems& problems, const ConstraintGroup& group, const std::string& element) {
  if (group.keyframes.empty()) return;
  if (!constraint_type(find_constraint_type(group.type)).rest_scales)
    problems.grave(element, "have keyframes, but constraints of this type have no size at rest",
                   "give keyframes to distance, distance_limit, tetrahedron_volume or fibre constraints");
  if (group.plasticity)
    problems.grave(element, "have both keyframes and a plasticity, which both change the rest data", "choose one");
  for (std::size_t i = 0; i < group.keyframes.size(); ++i) {
    const RestKeyframe& key = group.keyframes[i];
    if (!std::isfinite(key.time) || !(key.factor >= 0) || !(key.factor <= 1e6f))
      problems.grave(element, "have a keyframe with a time that is not finite or a factor outside 0 to 1e6",
                     "give finite numbers");
    else if (i > 0 && !(key.time > group.keyframes[i - 1].time))
      problems.grave(element, "have keyframe " + of(i) + " at a time that is not after the one before",
                     "sort them by time");
  }
}

void check_break_force(Problems& problems, const ConstraintGroup& group, const std::string& element) {
  if (group.break_force == 0) return;
  if (!(group.break_force > 0 && group.break_force <= 1e30f))
    problems.grave(element, "have a break_force of " + words(static_cast<double>(group.break_force)),
                   "give more than 0 N, or 0 for those that hold");
  if (!breaks_by_force(group.type))
    problems.grave(element, "have a break_force, but their type tells no force",
                   "give it to distance, distance_limit, point_on_triangle or point_in_tetrahedron constraints");
  const bool yields = group.stiffness.kind == Stiffness::Kind::compliance &&
                      (group.compliances.empty() ? group.stiffness.value > 0
                                                 : std::all_of(group.compliances.begin(), group.compliances.end(),
                                                               [](float compliance) { return compliance > 0; }));
  if (!yields)
    problems.grave(element, "have a break_force but no compliance, by which the force would be known",
                   "give a compliance in m/N, as 1e-5");
}

void check_group(Problems& problems, const Object& object, const ConstraintGroup& group) {
  const ConstraintType* type = find_type(group.type);
  if (type == nullptr) {
    problems.grave("constraints", "there is no type '" + group.type + "'", "use one of " + constraint_type_names());
    return;
  }
  const auto size = static_cast<std::size_t>(type->stencil_size);
  if (group.particles.size() % size != 0) {
    problems.grave(group.type + " constraints",
                   of(group.particles.size()) + " particles do not divide into stencils of " + of(size),
                   "give " + of(size) + " particles a constraint");
    return;
  }
  const std::string kind = group.type + " constraint";
  const std::size_t count = group.particles.size() / size;
  check_stencils(problems, object, group, *type, kind);
  check_rest(problems, group, *type, count, kind);
  check_stiffness(problems, group.type + " constraints", group.stiffness);
  check_compliances(problems, group, count, kind);
  check_plasticity(problems, group, group.type + " constraints");
  check_keyframes(problems, group, group.type + " constraints");
  check_break_force(problems, group, group.type + " constraints");
}

// ------------------------------------------------------------------------------------------------ surface and volume

bool check_triangles(Problems& problems, const Object& object) {
  Tally outside, repeated;
  for (std::size_t t = 0; t < object.triangles.size(); ++t) {
    const auto [a, b, c] = object.triangles[t];
    if (!has_particle(object, a) || !has_particle(object, b) || !has_particle(object, c))
      outside.add(static_cast<std::int64_t>(t));
    if (a == b || b == c || c == a) repeated.add(static_cast<std::int64_t>(t));
  }
  problems.grave(outside, "triangle", "uses a particle that does not exist; there are " + of(object.positions.size()),
                 "indices count from 0");
  problems.grave(repeated, "triangle", "uses a particle twice", "remove the triangle");
  return outside.count == 0 && repeated.count == 0;
}

double enclosed(const Object& object) {
  double six_volumes = 0;
  const auto at = [&](int particle) {
    const Vec3f offset = object.positions[static_cast<std::size_t>(particle)] - object.positions[0];
    return Vec3d{offset.x, offset.y, offset.z};
  };
  for (const auto& t : object.triangles) six_volumes += dot(cross(at(t[0]), at(t[1])), at(t[2]));
  return six_volumes / 6;
}

void check_closed(Problems& problems, const Object& object) {
  if (object.triangles.empty()) {
    problems.grave("volume", "needs triangles that enclose a volume", "give the object a closed surface");
    return;
  }
  for (const Edge& edge : find_edges(object.triangles, static_cast<int>(object.positions.size()))) {
    const std::string name = "edge " + std::to_string(edge.a) + "-" + std::to_string(edge.b);
    if (!edge.is_inner())
      return problems.grave(name,
                            "has " + std::to_string(edge.triangle_count) + " triangles where a closed surface has 2",
                            "close the surface, or remove the volume");
    if (!edge.is_wound_consistently())
      return problems.grave(name, "joins triangles of opposite winding", "flip one of them; make_cloth does so itself");
  }
  if (enclosed(object) == 0)
    problems.grave("volume", "is 0 at rest", "remove the volume, or start from a shape with volume");
}

void check_pressures(Problems& problems, const Volume& volume) {
  for (std::size_t i = 0; i < volume.keyframes.size(); ++i) {
    const std::string element = "volume, keyframe " + std::to_string(i);
    require_range(problems, element + ", time", static_cast<double>(volume.keyframes[i].time), 0, largest_place);
    require_range(problems, element + ", pressure", static_cast<double>(volume.keyframes[i].pressure), 0,
                  largest_place);
    if (i > 0 && !(volume.keyframes[i].time > volume.keyframes[i - 1].time))
      problems.grave(element, "is not after the previous one", "give times that increase");
  }
  require_range(problems, "volume, leak", static_cast<double>(volume.leak), 0, 1000);
}

void check_volume(Problems& problems, const Object& object, bool triangles_are_sound) {
  if (!object.volume) return;
  require_range(problems, "volume, pressure", object.volume->pressure, 0, largest_place);
  check_pressures(problems, *object.volume);
  check_stiffness(problems, "volume", object.volume->stiffness);
  require_range(problems, "volume, lift", object.volume->lift, -1e6, 1e6);
  if (triangles_are_sound) check_closed(problems, object);
}

// ------------------------------------------------------------------------------------------------ control

void check_control(Problems& problems, const Object& object) {
  Tally pins, attachments;
  for (std::size_t i = 0; i < object.pins.size(); ++i) {
    if (!has_particle(object, object.pins[i].particle)) pins.add(static_cast<std::int64_t>(i));
    check_motion(problems, "pin " + of(i), object.pins[i].motion);
  }
  for (std::size_t i = 0; i < object.attachments.size(); ++i) {
    const Attachment& attachment = object.attachments[i];
    const std::string name = "attachment " + of(i);
    if (!has_particle(object, attachment.particle)) attachments.add(static_cast<std::int64_t>(i));
    require_place(problems, name + ", target", attachment.target);
    check_motion(problems, name, attachment.motion);
    check_stiffness(problems, name, attachment.stiffness);
  }
  const std::string missing = "names a particle that does not exist; there are " + of(object.positions.size());
  problems.grave(pins, "pin", missing, "indices count from 0");
  problems.grave(attachments, "attachment", missing, "indices count from 0");
}

}  // namespace

void check_fluid(Problems& problems, const Object& object) {
  constexpr double least = 1e-9;  // spacing [m] and density [kg/m^3]: their powers must be floats
  if (!object.fluid) return;
  require_range(problems, "fluid, spacing", object.fluid->spacing, least, largest_place);
  require_range(problems, "fluid, density", object.fluid->density, least, 1e12);
  require_range(problems, "fluid, speed_of_sound", object.fluid->speed_of_sound, 0, largest_place);
  require_range(problems, "fluid, viscosity", object.fluid->viscosity, 0, 1e6);
  require_range(problems, "fluid, surface_tension", object.fluid->surface_tension, 0, 1e6);
  require_range(problems, "fluid, contact_angle", object.fluid->contact_angle, 0, 180);
  require_range(problems, "fluid, vorticity", object.fluid->vorticity, 0, 1e6);
  require_range(problems, "fluid, clarity", object.fluid->clarity, 0, largest_place);
  if (object.gas && object.fluid->vorticity > 0)
    problems.grave("fluid, vorticity", "is given for a gas", "give gas.vorticity instead");
}

void check_grains(Problems& problems, const Object& object) {
  constexpr double least = 1e-9;  // radius [m] and density [kg/m^3]: their powers must be floats
  if (!object.grains) return;
  require_range(problems, "grains, radius", object.grains->radius, least, largest_place);
  require_range(problems, "grains, mass_scaling", static_cast<double>(object.grains->mass_scaling), 0, 1000);
  require_range(problems, "grains, density", object.grains->density, least, 1e12);
  require_range(problems, "grains, friction", object.grains->friction, 0, 1000);
  require_range(problems, "grains, cohesion", object.grains->cohesion, 0, 1e9);
  if (object.fluid)
    problems.grave("grains", "are a liquid too", "give grains or fluid, in two objects if both are wanted");
}

void check_region(Problems& problems, const std::string& what, const Region& region) {
  for (const float size : {region.half_size.x, region.half_size.y, region.half_size.z, region.radius})
    require_range(problems, what, size, 0, largest_place);
  for (const float place : {region.centre.x, region.centre.y, region.centre.z})
    require_range(problems, what, place, -largest_place, largest_place);
}

void check_gas(Problems& problems, const Object& object) {
  constexpr double least = 1e-3, hottest = 1e9, most = 1e12;  // temperatures [K]
  if (!object.gas) return;
  const Gas& gas = *object.gas;
  if (!object.fluid) problems.grave("gas", "has no fluid", "set Object::fluid too, as make_gas does");
  require_range(problems, "gas, temperature", gas.temperature, least, hottest);
  require_range(problems, "gas, ambient_temperature", gas.ambient_temperature, least, hottest);
  require_range(problems, "gas, ambient_density", gas.ambient_density, 0, most);
  require_range(problems, "gas, cooling_time", gas.cooling_time, 0, most);
  require_range(problems, "gas, diffusivity", gas.diffusivity, 0, most);
  require_range(problems, "gas, drag", gas.drag, 0, most);
  require_range(problems, "gas, vorticity", gas.vorticity, 0, most);
  for (const GasHeater& heater : gas.heaters) {
    check_region(problems, "gas, heater, region", heater.region);
    require_range(problems, "gas, heater, temperature", heater.temperature, least, hottest);
    require_range(problems, "gas, heater, rate", heater.rate, 0, most);
  }
}

void check_tracers(Problems& problems, const Object& object) {
  constexpr double most = 1e9;
  if (!object.tracers) return;
  const Tracers& tracers = *object.tracers;
  if (object.fluid || object.grains || !object.triangles.empty() || !object.constraints.empty() ||
      !object.bodies.empty())
    problems.grave("tracers", "are a liquid, grains, a surface or constrained too",
                   "give tracers an object of their own");
  if (!object.clusters.empty() || !object.pins.empty() || !object.attachments.empty() ||
      std::any_of(object.masses.begin(), object.masses.end(), [](float m) { return std::isinf(m); }))
    problems.grave("tracers", "have clusters, pins, attachments or infinite masses",
                   "leave these out: tracers follow gases");
  check_region(problems, "tracers, source", tracers.source);
  require_range(problems, "tracers, rate", tracers.rate, 1e-9, most);
  require_range(problems, "tracers, lifetime", tracers.lifetime, 1e-9, most);
  require_range(problems, "tracers, start", tracers.start, -most, most);
  require_range(problems, "tracers, end", tracers.end, -most, most);
  require_range(problems, "tracers, radius", tracers.radius, 1e-9, largest_place);
  require_range(problems, "tracers, opacity", tracers.opacity, 0, 0.999);
}

namespace {

bool is_direction(const Vec3f& v) { return is_place(v) && length_squared(v) > 1e-12f; }

/// The places of a layer and the speed of layers, about: an opening may be far too large to list its places.
void check_layer(Problems& problems, const std::string& name, const Emitter& emitter, const Object& object) {
  constexpr double pi = 3.14159265, fastest = 1e4;
  const double apart = static_cast<double>(object.grains ? 2.2f * object.grains->radius : object.fluid->spacing);
  const double radius = static_cast<double>(emitter.radius),
               area = radius > 0 ? pi * radius * radius
                                 : static_cast<double>(emitter.width) * static_cast<double>(emitter.height);
  const double places = std::max(area / (apart * apart), 1.0), most = static_cast<double>(object.positions.size());
  if (!(places <= 2 * most + 16))
    problems.grave(name + ", opening",
                   "has room for about " + words(places) + " particles beside one another, more than the " +
                       of(object.positions.size()) + " of the object",
                   "make it smaller, the particles larger, or the capacity larger");
  else if (!(static_cast<double>(emitter.flow) / (places * apart * apart) <= fastest))
    problems.grave(name + ", flow", "needs more than 10000 m/s through this opening",
                   "make the opening larger or the flow smaller");
}

void check_emitter(Problems& problems, const std::string& name, const Emitter& emitter, const Object& object) {
  require_place(problems, name + ", position", emitter.position);
  require_place(problems, name + ", across", emitter.across);
  if (!is_direction(emitter.direction))
    problems.grave(name + ", direction", "has no length, or is not finite", "give a direction such as (0, -1, 0)");
  for (const float size : {emitter.radius, emitter.width, emitter.height})
    require_range(problems, name + ", opening", size, 0, largest_place);
  if ((emitter.radius > 0) == (emitter.width > 0 && emitter.height > 0))
    problems.grave(name, "is neither a disc nor a rectangle, or both", "give a radius, or a width and a height");
  require_range(problems, name + ", speed", emitter.speed, 0, 1e4);
  require_range(problems, name + ", flow", emitter.flow, 0, 1e6);
  if ((emitter.speed > 0) == (emitter.flow > 0))
    problems.grave(name, "has neither a speed nor a flow, or both", "give one of them");
  if (!(emitter.end >= emitter.start) || !(std::abs(emitter.start) <= 3e38f))
    problems.grave(name, "ends before it starts", "give a start, and an end that is later");
  check_motion(problems, name, emitter.motion);
  check_layer(problems, name, emitter, object);
}

}  // namespace

void check_flow(Problems& problems, const Object& object) {
  const Flow& flow = object.flow;
  if (!flow.is_used()) return;
  if (!object.fluid && !object.grains)
    return problems.grave("flow", "is of an object that is neither a liquid nor grains", "leave it out");
  if (flow.spare < 0 || static_cast<std::size_t>(flow.spare) > object.positions.size())
    problems.grave("flow", "has " + std::to_string(flow.spare) + " spare particles of " + of(object.positions.size()),
                   "give the number of the last particles that are not there at the start");
  if (object.gas) problems.grave("flow", "is of a gas, whose particles cannot come and go yet", "leave it out");
  if (!object.pins.empty() || !object.attachments.empty() || !object.constraints.empty() || !object.clusters.empty())
    problems.grave(
        "flow", "is of an object with pins, attachments, constraints or clusters, whose particles cannot come and go",
        "leave these out");
  require_range(problems, "flow, lifetime", flow.lifetime, 0, largest_place);
  for (std::size_t i = 0; i < flow.emitters.size(); ++i)
    check_emitter(problems, "emitter " + of(i), flow.emitters[i], object);
  for (std::size_t i = 0; i < flow.drains.size(); ++i) {
    require_place(problems, "drain " + of(i) + ", position", flow.drains[i].position);
    const Quatf& q = flow.drains[i].rotation;
    if (!(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w > 0))
      problems.grave("drain " + of(i) + ", rotation", "is zero or not finite", "give a quaternion");
  }
}

void check_object(Problems& problems, const Object& object) {
  check_positions(problems, object);
  check_velocities(problems, object);
  check_masses(problems, object);
  check_frames(problems, object);
  check_bodies(problems, object);
  for (const ConstraintGroup& group : object.constraints) check_group(problems, object, group);
  const bool sound = check_triangles(problems, object);
  check_volume(problems, object, sound);
  check_clusters(problems, object);
  check_control(problems, object);
  check_tears(problems, object);
  check_absorbency(problems, object);
  require_range(problems, "thickness", object.thickness, 0, largest_place);
  check_fluid(problems, object);
  check_flow(problems, object);
  check_grains(problems, object);
  check_gas(problems, object);
  check_tracers(problems, object);
  check_friction(problems, object.static_friction, object.kinetic_friction, object.restitution);
  check_rolling(problems, object.rolling_friction, object.spinning_friction);
  require_range(problems, "drag", object.drag, 0, largest_place);
  require_range(problems, "lift", object.lift, 0, largest_place);
  require_range(problems, "damping", object.damping, 0, largest_place);
  require_range(problems, "clarity", object.clarity, 0, largest_place);
  if (!is_finite(object.colour)) problems.grave("colour", "is not finite", "give red, green and blue from 0 to 1");
}

}  // namespace pliant
