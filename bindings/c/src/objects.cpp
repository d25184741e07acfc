// Objects: reading and moving their particles.
#include "memory.h"
#include "object_use.h"

namespace pliant::c {

namespace {

/// Copies triangles of three indices each.
void give_triangles(const std::vector<std::array<int, 3>>& triangles, std::int32_t* into) {
  for (const std::array<int, 3>& triangle : triangles) into = std::copy(triangle.begin(), triangle.end(), into);
}

}  // namespace

}  // namespace pliant::c

using namespace pliant;
using namespace pliant::c;

pliant_status pliant_object_get_info(const pliant_world* world, pliant_id object, pliant_object_info* info) {
  return guarded([&] {
    const ObjectUse use(world, object);
    const Object& description = use.object().description();
    pliant_object_info facts{};
    facts.particles = use.object().particle_count();
    facts.triangles = static_cast<std::int64_t>(description.triangles.size());
    facts.bodies = static_cast<std::int64_t>(description.bodies.size());
    facts.joints = static_cast<std::int64_t>(description.joints.size());
    facts.attachments = static_cast<std::int64_t>(description.attachments.size());
    facts.constraints = static_cast<std::int64_t>(description.constraints.size());
    facts.substeps = use.object().info().substeps;
    facts.is_flow = use.object().flows() ? 1 : 0;
    give(facts, info, "info");
  });
}

pliant_status pliant_object_positions(const pliant_world* world, pliant_id object, float* into, size_t count) {
  return guarded([&] {
    const ObjectUse use(world, object);
    use.object().read_positions(points(into, count, "into"));
  });
}

pliant_status pliant_object_velocities(const pliant_world* world, pliant_id object, float* into, size_t count) {
  return guarded([&] {
    const ObjectUse use(world, object);
    use.object().read_velocities(points(into, count, "into"));
  });
}

pliant_status pliant_object_present(const pliant_world* world, pliant_id object, int32_t* into, size_t capacity,
                                    size_t* count) {
  return guarded([&] {
    const ObjectUse use(world, object);
    give_list<int>(use.object().present(), {into, capacity, count}, "particles");
  });
}

pliant_status pliant_object_channel(const pliant_world* world, pliant_id object, const char* channel, float* into,
                                    size_t capacity, size_t* count) {
  return guarded([&] {
    const ObjectUse use(world, object);
    require(channel, "channel");
    give_list<float>(use.object().channel(channel), {into, capacity, count}, "numbers");
  });
}

pliant_status pliant_object_triangles(const pliant_world* world, pliant_id object, int32_t* into, size_t capacity,
                                      size_t* count) {
  return guarded([&] {
    const ObjectUse use(world, object);
    const std::vector<std::array<int, 3>>& triangles = use.object().description().triangles;
    if (tell<int32_t>({into, capacity, count}, triangles.size(), "triangles")) give_triangles(triangles, into);
  });
}

pliant_status pliant_object_mesh(const pliant_world* world, pliant_id object, float* positions,
                                 size_t position_capacity, size_t* position_count, int32_t* triangles,
                                 size_t triangle_capacity, size_t* triangle_count) {
  return guarded([&] {
    const ObjectUse use(world, object);
    const TriangleMesh mesh = use.object().mesh();
    if (triangle_count != nullptr)
      *triangle_count = mesh.triangles.size();  // told even if the points have too little room
    const bool has_points =
        tell<float>({positions, position_capacity, position_count}, mesh.positions.size(), "points");
    const bool has_triangles =
        tell<int32_t>({triangles, triangle_capacity, triangle_count}, mesh.triangles.size(), "triangles");
    if (has_points) std::copy(mesh.positions.begin(), mesh.positions.end(), reinterpret_cast<Vec3f*>(positions));
    if (has_triangles) give_triangles(mesh.triangles, triangles);
  });
}

pliant_status pliant_object_orientations(const pliant_world* world, pliant_id object, float* into, size_t capacity,
                                         size_t* count) {
  return guarded([&] {
    const ObjectUse use(world, object);
    const std::vector<Quatf> frames = use.object().orientations();
    if (!tell<float>({into, capacity, count}, frames.size(), "orientations")) return;
    for (const Quatf& q : frames) *into++ = q.x, *into++ = q.y, *into++ = q.z, *into++ = q.w;
  });
}

pliant_status pliant_object_angular_velocities(const pliant_world* world, pliant_id object, float* into,
                                               size_t capacity, size_t* count) {
  return guarded([&] {
    const ObjectUse use(world, object);
    const std::vector<Vec3f> spins = use.object().angular_velocities();
    if (!tell<float>({into, capacity, count}, spins.size(), "angular velocities")) return;
    std::copy(spins.begin(), spins.end(), reinterpret_cast<Vec3f*>(into));
  });
}

pliant_status pliant_object_multipliers(const pliant_world* world, pliant_id object, const char* type, float* into,
                                        size_t capacity, size_t* count) {
  return guarded([&] {
    const ObjectUse use(world, object);
    require(type, "type");
    give_list<float>(use.object().multipliers(type), {into, capacity, count}, "multipliers");
  });
}

pliant_status pliant_object_enclosed_volume(const pliant_world* world, pliant_id object, double* volume) {
  return guarded([&] {
    const ObjectUse use(world, object);
    require(volume, "volume");
    *volume = use.object().enclosed_volume();
  });
}

pliant_status pliant_object_set_velocities(pliant_world* world, pliant_id object, const float* velocities,
                                           size_t count) {
  return guarded([&] {
    const ObjectUse use(world, object);
    use.object().set_velocities(points(velocities, count, "velocities"));
  });
}

pliant_status pliant_object_add_impulses(pliant_world* world, pliant_id object, const float* impulses, size_t count) {
  return guarded([&] {
    const ObjectUse use(world, object);
    use.object().add_impulses(points(impulses, count, "impulses"));
  });
}

pliant_status pliant_object_set_forces(pliant_world* world, pliant_id object, const float* forces, size_t count) {
  return guarded([&] {
    const ObjectUse use(world, object);
    use.object().set_forces(points(forces, count, "forces"));
  });
}

pliant_status pliant_object_set_targets(pliant_world* world, pliant_id object, const int32_t* particles,
                                        const float* positions, size_t count) {
  return guarded([&] {
    const ObjectUse use(world, object);
    use.object().set_targets(integers(particles, count, "particles"), points(positions, count, "positions"));
  });
}

pliant_status pliant_object_set_attachment_targets(pliant_world* world, pliant_id object, const int32_t* attachments,
                                                   const float* positions, size_t count) {
  return guarded([&] {
    const ObjectUse use(world, object);
    use.object().set_attachment_targets(integers(attachments, count, "attachments"),
                                        points(positions, count, "positions"));
  });
}

pliant_status pliant_object_teleport(pliant_world* world, pliant_id object, const pliant_pose* by) {
  return guarded([&] {
    const ObjectUse use(world, object);
    use.object().teleport(c::pose_of(by, "by"));
  });
}

pliant_status pliant_object_set_rest_factor(pliant_world* world, pliant_id object, int32_t group, float factor) {
  return guarded([&] {
    const ObjectUse use(world, object);
    use.object().set_rest_factor(group, factor);
  });
}
