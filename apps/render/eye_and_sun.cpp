#include "eye_and_sun.h"

#include <algorithm>
#include <cmath>

namespace pliant::render {

Eye make_eye(const Camera& camera, int width, int height, const Extent& extent) {
  Eye eye{.camera = camera, .frame = view_frame(camera.target - camera.eye), .view_projection = {}};
  eye.half_height = std::tan(std::clamp(camera.field_of_view, 5.f, 120.f) * degree / 2);
  eye.half_width = eye.half_height * static_cast<float>(width) / static_cast<float>(height);
  const float size = std::max(extent.radius, 1e-4f);
  const float distance = dot(eye.frame.back, camera.eye - extent.centre);
  eye.near = 0.05f * size;  // less than the distance of objects, because the ground comes nearer
  // A camera may be told to look at something nearby.
  if (const float gap = length(camera.target - camera.eye); gap > 0) eye.near = std::min(eye.near, gap / 2);
  eye.far = std::max(distance, 0.f) + 40 * size;
  eye.view_projection =
      perspective(eye.half_width, eye.half_height, eye.near, eye.far) * view_matrix(eye.frame, camera.eye);
  return eye;
}

namespace {

/// The direction to the sun: behind the viewer to the left, so that folds cast short shadows to the right.
Vec3f sun_direction(const ViewFrame& view) {
  const Vec3f level_back = unit({view.back.x, 0, view.back.z}, {0, 0, 1});
  const Vec3f level_right{level_back.z, 0, -level_back.x};
  return unit(Vec3f{0, 1.15f, 0} + level_back * 0.38f - level_right * 1.0f);
}

/// The part of a box within `reach` of a centre along each axis; all of it if there is none.
Bounds near_part(const Bounds& box, const Vec3f& centre, float reach) {
  Bounds result = box;
  for (float Vec3f::*const axis : {&Vec3f::x, &Vec3f::y, &Vec3f::z}) {
    result.low.*axis = std::max(box.low.*axis, centre.*axis - reach);
    result.high.*axis = std::min(box.high.*axis, centre.*axis + reach);
    if (result.low.*axis > result.high.*axis) return box;
  }
  return result;
}

}  // namespace

Sun make_sun(const ViewFrame& view, const std::vector<Geometry>& geometries, const Extent& extent) {
  constexpr float angular_radius = 0.03f;  // radius of the sun [rad], seven times the real one, as through thin cloud
  constexpr float farthest = 4;            // radii of the extent: what flew farther away would make all shadows coarse
  Sun sun{.direction = sun_direction(view), .clip = {}};
  const ViewFrame frame = view_frame(-sun.direction);
  Bounds box;
  for (const Geometry& geometry : geometries) {
    if (geometry.material == Material::ground) continue;
    for (const auto& [x, y, z, scale] : geometry.places)
      box.include(Vec3f{dot(frame.right, {x, y, z}), dot(frame.up, {x, y, z}), dot(frame.back, {x, y, z})}, scale);
    if (!geometry.places.empty()) continue;
    for (const Vertex& v : geometry.vertices)
      box.include(Vec3f{dot(frame.right, v.position), dot(frame.up, v.position), dot(frame.back, v.position)});
  }
  if (box.empty()) box.include(Vec3f{}, 1);
  const Vec3f centre{dot(frame.right, extent.centre), dot(frame.up, extent.centre), dot(frame.back, extent.centre)};
  box = near_part(box, centre, farthest * extent.radius);
  const float margin = 0.04f * std::max(box.radius(), 1e-4f);
  // The shadow map extends far along the rays, so that it contains the ground with its shadows.
  const Vec3f low = box.low - Vec3f{margin, margin, 150 * margin}, high = box.high + Vec3f{margin, margin, margin};
  sun.clip = orthographic(low, high) * view_matrix(frame, {});
  sun.depth = high.z - low.z;
  sun.softness = angular_radius * (high.z - low.z) / std::max(high.x - low.x, high.y - low.y);
  return sun;
}

}  // namespace pliant::render
