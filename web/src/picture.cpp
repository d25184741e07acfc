// What pictures in a browser need of a World: surfaces, lines, poses, and what they are to look like.
#include <nlohmann/json.hpp>

#include "io/write_frames.h"
#include "memory.h"
#include "object_use.h"
#include "pliant/edit.h"
#include "pliant/soft_body.h"
#include "pliant/surface.h"
#include "pliant_web.h"

namespace pliant::c {

namespace {

using nlohmann::json;

json list_of(const Vec3f& v) { return {v.x, v.y, v.z}; }

/// How an object is drawn.
const char* kind_of(const Object& object, const output::FrameObject& shape) {
  if (!shape.has_matter()) return "none";
  if (object.tracers) return "smoke";
  if (object.gas) return "none";
  if (object.fluid) return "liquid";
  if (!shape.triangles.empty()) return "surface";
  return shape.lines.empty() ? "balls" : "lines";
}

json bodies_of(const Object& object, const output::FrameObject& shape) {
  json bodies = json::array();
  for (std::size_t b = 0; b < object.bodies.size(); ++b)
    bodies.push_back({{"name", object.bodies[b].name},
                      {"solid", shape.bodies[b].solid},
                      {"particle", object.bodies[b].particle},
                      {"fixed", !std::isfinite(object.masses[static_cast<std::size_t>(object.bodies[b].particle)])}});
  return bodies;
}

json part_of(const Object& object, ObjectId id) {
  const output::FrameObject shape = output::describe(object);
  return {{"name", object.name},
          {"id", {PLIANT_OBJECT, id.slot, id.generation}},
          {"kind", kind_of(object, shape)},
          {"colour", list_of(object.colour)},
          {"radius", object.fluid     ? 0.5f * object.fluid->spacing
                     : object.tracers ? object.tracers->radius
                                      : object.thickness},
          {"changes", comes_apart(object)},
          {"flows", object.flow.is_used()},
          {"solids", shape.solids.size()},
          {"bodies", bodies_of(object, shape)}};
}

json shape_of(const Shape& shape) {
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return {{"kind", "sphere"}, {"radius", sphere->radius}};
  if (const auto* box = std::get_if<Box>(&shape))
    return {{"kind", "box"}, {"half_extents", list_of(box->half_extents)}};
  if (const auto* capsule = std::get_if<Capsule>(&shape))
    return {{"kind", "capsule"}, {"radius", capsule->radius}, {"half_length", capsule->half_length}};
  return {{"kind", "plane"}};
}

template <class Id>
json collider_of(const std::string& name, const Vec3f& colour, int kind, Id id) {
  return {{"name", name}, {"id", {kind, id.slot, id.generation}}, {"colour", list_of(colour)}};
}

json parts_of(const World& world) {
  const Scene scene = world.description();
  json objects = json::array(), colliders = json::array(), mesh_colliders = json::array();
  for (const ObjectId id : world.objects()) objects.push_back(part_of(world.object(id).description(), id));
  for (std::size_t i = 0; i < scene.colliders.size(); ++i) {
    const Collider& collider = scene.colliders[i];
    json made = collider_of(collider.name, collider.colour, PLIANT_COLLIDER, world.colliders()[i]);
    made["shape"] = shape_of(collider.shape);
    made["is_keyframed"] = collider.motion.moves();
    colliders.push_back(std::move(made));
  }
  for (std::size_t i = 0; i < scene.mesh_colliders.size(); ++i) {
    const MeshCollider& collider = scene.mesh_colliders[i];
    mesh_colliders.push_back(
        collider_of(collider.name, collider.colour, PLIANT_MESH_COLLIDER, world.mesh_colliders()[i]));
  }
  return {{"objects", objects}, {"colliders", colliders}, {"mesh_colliders", mesh_colliders}};
}

/// Keeps a surface until the next one, and gives it to the caller.
void give_surface(std::vector<Vec3f> positions, std::vector<std::array<int, 3>> triangles, pliant_web_mesh* into) {
  static TriangleMesh kept;
  static std::vector<Vec3f> normals;
  require(into, "mesh");
  kept.positions = std::move(positions);
  kept.triangles = std::move(triangles);
  normals = output::vertex_normals(kept.positions, kept.triangles);
  *into = {.positions = reinterpret_cast<const float*>(kept.positions.data()),
           .normals = reinterpret_cast<const float*>(normals.data()),
           .count = kept.positions.size(),
           .triangles = reinterpret_cast<const std::int32_t*>(kept.triangles.data()),
           .triangle_count = kept.triangles.size()};
}

[[noreturn]] void refuse_index(const char* what, std::int32_t index, std::size_t count) {
  throw StatusError(PLIANT_NOT_FOUND, "there is no " + std::string(what) + " " + std::to_string(index),
                    "there are " + std::to_string(count) + ", and the first one is 0");
}

}  // namespace

}  // namespace pliant::c

using namespace pliant;
using namespace pliant::c;

pliant_status pliant_web_parts(const pliant_world* world, char* into, size_t capacity, size_t* length) {
  return guarded([&] { give_text(parts_of(at(world)->world).dump(), {into, capacity, length}); });
}

pliant_status pliant_web_surface(const pliant_world* world, pliant_id object, pliant_web_mesh* mesh) {
  return guarded([&] {
    const ObjectUse use(world, object);
    const Object& description = use.object().description();
    std::vector<Vec3f> positions = use.object().positions();
    if (!description.skin) return give_surface(std::move(positions), description.triangles, mesh);
    give_surface(skinned(*description.skin, positions), description.skin->triangles, mesh);
  });
}

pliant_status pliant_web_solid(const pliant_world* world, pliant_id object, int32_t solid, pliant_web_mesh* mesh) {
  return guarded([&] {
    const ObjectUse use(world, object);
    const output::FrameObject shape = output::describe(use.object().description());
    if (solid < 0 || static_cast<std::size_t>(solid) >= shape.solids.size())
      refuse_index("solid", solid, shape.solids.size());
    const TriangleMesh& found = shape.solids[static_cast<std::size_t>(solid)];
    give_surface(found.positions, found.triangles, mesh);
  });
}

pliant_status pliant_web_mesh_collider(const pliant_world* world, pliant_id collider, pliant_web_mesh* mesh) {
  return guarded([&] {
    const World& of = at(world)->world;
    const MeshColliderId id = mesh_collider_id(of, collider);
    const std::vector<MeshColliderId> ids = of.mesh_colliders();
    const auto index = std::find(ids.begin(), ids.end(), id) - ids.begin();
    give_surface(of.mesh_collider(id).positions(),
                 of.description().mesh_colliders[static_cast<std::size_t>(index)].mesh.triangles, mesh);
  });
}

pliant_status pliant_web_liquid(const pliant_world* world, pliant_id object, pliant_web_mesh* mesh) {
  return guarded([&] {
    const ObjectUse use(world, object);
    const Object& description = use.object().description();
    if (!description.fluid) throw StatusError(PLIANT_REFUSED, "the object is no liquid");
    TriangleMesh surface = liquid_surface(use.object().present_positions(), {.spacing = description.fluid->spacing});
    give_surface(std::move(surface.positions), std::move(surface.triangles), mesh);
  });
}

pliant_status pliant_web_lines(const pliant_world* world, pliant_id object, int32_t* into, size_t capacity,
                               size_t* count) {
  return guarded([&] {
    const ObjectUse use(world, object);
    std::vector<std::int32_t> pairs;
    for (const std::vector<int>& line : output::describe(use.object().description()).lines) {
      pairs.reserve(pairs.size() + 2 * line.size());
      for (std::size_t i = 0; i + 1 < line.size(); ++i) pairs.insert(pairs.end(), {line[i], line[i + 1]});
    }
    give_list<std::int32_t>(pairs, {into, capacity, count}, "ends of lines");
  });
}

pliant_status pliant_web_poses(const pliant_world* world, pliant_id object, float* into, size_t capacity,
                               size_t* count) {
  return guarded([&] {
    const ObjectUse use(world, object);
    const auto motions = output::body_motions(use.object().description(), use.object());
    if (!tell<float>({into, capacity, count}, motions.size(), "poses")) return;
    for (const auto& [pose, velocity, angular_velocity] : motions)
      for (const float x : {pose.position.x, pose.position.y, pose.position.z, pose.rotation.x, pose.rotation.y,
                            pose.rotation.z, pose.rotation.w})
        *into++ = x;
  });
}

pliant_status pliant_web_inverse_masses(const pliant_world* world, pliant_id object, float* into, size_t capacity,
                                        size_t* count) {
  return guarded([&] {
    const ObjectUse use(world, object);
    const auto records = use.object().positions_in_storage_order();
    const auto order = use.object().storage_order();
    const auto particles = static_cast<std::size_t>(use.object().particle_count());
    if (!tell<float>({into, capacity, count}, particles, "particles")) return;
    for (std::size_t i = 0; i < records.size(); ++i)
      if (static_cast<std::size_t>(order[i]) < particles) into[order[i]] = records[i].w;
  });
}

pliant_status pliant_web_set_pulls(pliant_world* world, pliant_id object, const int32_t* particles, const float* places,
                                   const float* frequencies, size_t count) {
  return guarded([&] {
    const ObjectUse use(world, object);
    require(frequencies, "frequencies");
    use.object().set_pulls(integers(particles, count, "particles"), points(places, count, "places"),
                           {frequencies, count});
  });
}
