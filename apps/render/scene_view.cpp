// Makes a RenderScene of a Scene and its World.
#include <algorithm>
#include <cmath>
#include <iterator>

#include "geometry.h"
#include "io/write_frames.h"
#include "matrix.h"
#include "render.h"

namespace pliant::render {

namespace {

/// The lowest height that an object can reach: a hanging one can swing down by its size, a falling one lands on something.
float lowest(const Object& object) {
  Bounds all, held;
  for (std::size_t i = 0; i < object.positions.size(); ++i) {
    all.include(object.positions[i]);
    if (i < object.masses.size() && !std::isfinite(object.masses[i])) held.include(object.positions[i]);
  }
  for (const Pin& pin : object.pins)
    if (pin.particle >= 0 && pin.particle < static_cast<int>(object.positions.size()))
      held.include(object.positions[pin.particle]);
  for (const Attachment& attachment : object.attachments) held.include(attachment.target);
  if (all.empty()) return 0;
  return held.empty() ? all.low.y : std::min(all.low.y, held.low.y - 2 * all.radius());
}

/// The height of the ground: that of the lowest horizontal plane, otherwise 0, or less if the scene extends below. It
/// depends on the Scene alone, so it is constant in a movie.
float ground_height(const Scene& scene, const std::vector<RenderCollider>& at_rest) {
  bool level = false, tilted = false;
  float plane = 0, low = 0;
  for (const RenderCollider& collider : at_rest) {
    if (is_level_plane(collider)) {
      plane = level ? std::min(plane, collider.position.y) : collider.position.y;
      level = true;
    } else if (std::holds_alternative<Plane>(collider.shape)) {
      tilted = true;
    }
  }
  if (level) return plane;
  Bounds all;
  for (const Object& object : scene.objects) {
    low = std::min(low, lowest(object));
    for (const Vec3f& position : object.positions) all.include(position);
  }
  for (const Vec3f& point :
       points_of_interest({.meshes = {}, .tubes = {}, .colliders = at_rest, .ground = {}, .camera = {}, .extent = {}}))
    low = std::min(low, point.y);
  for (const MeshCollider& collider : scene.mesh_colliders)
    for (const Vec3f& position : collider.mesh.positions) low = std::min(low, position.y);
  if (tilted && !all.empty()) low = std::min(low, all.low.y - all.radius());
  return low < 0 ? low - 0.02f * all.radius() : 0;
}

/// Draws particles that are much heavier than others as balls, with a volume in proportion to their mass. A ball of
/// equal mass would have twice the line's thickness.
void add_weights(RenderScene& result, const Object& object, const std::vector<Vec3f>& positions) {
  constexpr float much = 2.5f;  // more than the ratio between particles in the middle and at the end of a rope
  std::vector<float> masses;
  std::copy_if(object.masses.begin(), object.masses.end(), std::back_inserter(masses),
               [](float mass) { return std::isfinite(mass); });
  if (masses.empty()) return;
  const auto middle = masses.begin() + static_cast<std::ptrdiff_t>(masses.size() / 2);
  std::nth_element(masses.begin(), middle, masses.end());
  const float usual = *middle;
  for (std::size_t i = 0; i < object.masses.size(); ++i) {
    const float mass = object.masses[i];
    if (!std::isfinite(mass) || mass < much * usual) continue;
    const float radius = 2 * object.thickness * std::min(std::cbrt(mass / usual), 10.f);
    result.tubes.push_back({.points = {positions[i]}, .radius = radius, .colour = object.colour});
  }
}

void add_object(RenderScene& result, const Object& object, std::vector<Vec3f> positions) {
  const output::FrameObject shape = output::describe(object);
  if (!shape.triangles.empty()) {
    result.meshes.push_back({std::move(positions), shape.triangles, shape.colour, false});
    return;
  }
  for (const auto& line : shape.lines) {
    RenderTube tube{.points = {}, .radius = object.thickness, .colour = shape.colour};
    for (const int i : line) tube.points.push_back(positions[i]);
    result.tubes.push_back(std::move(tube));
  }
  if (!shape.lines.empty()) return add_weights(result, object, positions);
  for (const Vec3f& position : positions)
    result.tubes.push_back({.points = {position}, .radius = object.thickness, .colour = shape.colour});
}

}  // namespace

RenderScene make_render_scene(const Scene& scene, const World& world) {
  RenderScene result;
  std::vector<RenderCollider> at_rest;
  for (std::size_t i = 0; i < scene.colliders.size(); ++i) {
    const Collider& collider = scene.colliders[i];
    const int index = static_cast<int>(i);
    at_rest.push_back({collider.shape, collider.position, collider.rotation, collider.colour});
    result.colliders.push_back(
        {collider.shape, world.collider(index).pose().position, world.collider(index).pose().rotation, collider.colour});
  }
  result.ground = ground_height(scene, at_rest);
  for (std::size_t i = 0; i < scene.objects.size(); ++i)
    add_object(result, scene.objects[i], world.object(static_cast<int>(i)).positions());
  for (std::size_t i = 0; i < scene.mesh_colliders.size(); ++i) {
    const MeshCollider& collider = scene.mesh_colliders[i];
    result.meshes.push_back(
        {world.mesh_collider(static_cast<int>(i)).positions(), collider.mesh.triangles, collider.colour, true});
  }
  return result;
}

}  // namespace pliant::render
