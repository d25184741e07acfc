// Finds a position of the camera from which everything is visible.
#include <algorithm>
#include <cmath>

#include "geometry.h"
#include "matrix.h"
#include "render.h"

namespace pliant::render {

namespace {
constexpr float used_share = 0.86f;  // share of the picture's width and height that the scene fills

/// The extreme lines of sight in one direction of the picture. A point (x, z) is visible if |x - eye_x| <= (eye_z - z)
/// * slope, so the nearest eye that sees all points follows from the largest x + z slope and the largest -x + z slope.
struct Side {
  float slope = 1, largest_plus = -1e30f, largest_minus = -1e30f;

  void include(float x, float z) {
    largest_plus = std::max(largest_plus, x + z * slope);
    largest_minus = std::max(largest_minus, -x + z * slope);
  }
  float eye() const { return (largest_plus - largest_minus) / 2; }
  float distance() const { return (largest_plus + largest_minus) / (2 * slope); }
};

/// The camera that shows all, in the direction of `frame`.
Camera fit_camera(const std::vector<RenderScene>& scenes, int width, int height, const ViewFrame& frame,
                  float field_of_view) {
  Camera camera;
  camera.field_of_view = field_of_view;
  const float tangent = std::tan(camera.field_of_view * degree / 2) * used_share;
  Side across{.slope = tangent * static_cast<float>(width) / static_cast<float>(height)}, upright{.slope = tangent};
  Bounds all;
  for (const RenderScene& scene : scenes) {
    for (const Vec3f& point : points_of_interest(scene)) {
      all.include(point);
      const float z = dot(frame.back, point);
      across.include(dot(frame.right, point), z);
      upright.include(dot(frame.up, point), z);
    }
  }
  if (all.empty() || all.radius() < 1e-6f) {
    const Vec3f centre = all.empty() ? Vec3f{0, 0.5f, 0} : all.centre();
    return {centre + frame.back * 3.f, centre, camera.field_of_view};
  }
  const float middle = dot(frame.back, all.centre());
  const float eye_z = std::max({across.distance(), upright.distance(), middle + all.radius() * 0.5f});
  const auto at = [&](float z) { return frame.right * across.eye() + frame.up * upright.eye() + frame.back * z; };
  camera.eye = at(eye_z);
  camera.target = at(std::min(middle, eye_z - 1e-3f * all.radius()));
  return camera;
}

/// What the camera shows by itself.
Bounds shown_by_itself(const std::vector<RenderScene>& scenes) {
  Bounds all;
  for (const RenderScene& scene : scenes) all.include(bounds(points_of_interest(scene)));
  return all;
}

/// The camera's place about its target as angles and a distance, where a position is given and they are not.
SceneCamera with_angles(SceneCamera options, const std::vector<RenderScene>& scenes) {
  if (!options.position) return options;
  const Bounds shown = shown_by_itself(scenes);
  if (!options.look_at) options.look_at = shown.empty() ? Vec3f{} : shown.centre();
  const Vec3f away = *options.position - *options.look_at;
  const float least = shown.empty() ? 0 : 1e-6f * shown.radius();  // else no direction follows from the position
  if (!(length(away) > least)) return options;
  if (!options.azimuth) options.azimuth = std::atan2(away.x, away.z) / degree;
  if (!options.elevation) options.elevation = std::asin(std::clamp(away.y / length(away), -1.f, 1.f)) / degree;
  if (!options.distance) options.distance = length(away);
  return options;
}

}  // namespace

SceneCamera merged(const SceneCamera& wanted, const SceneCamera& otherwise) {
  const auto either = [](const auto& one, const auto& other) { return one ? one : other; };
  return {.azimuth = either(wanted.azimuth, otherwise.azimuth),
          .elevation = either(wanted.elevation, otherwise.elevation),
          .field_of_view = either(wanted.field_of_view, otherwise.field_of_view),
          .look_at = either(wanted.look_at, otherwise.look_at),
          .distance = either(wanted.distance, otherwise.distance),
          .position = either(wanted.position, otherwise.position)};
}

Camera frame_camera(const std::vector<RenderScene>& scenes, int width, int height, const SceneCamera& wanted) {
  const SceneCamera options = with_angles(wanted, scenes);
  const float a = options.azimuth.value_or(28) * degree;
  const float e = std::clamp(options.elevation.value_or(18), -89.99f, 89.99f) * degree;
  const ViewFrame frame = view_frame(Vec3f{-std::sin(a) * std::cos(e), -std::sin(e), -std::cos(a) * std::cos(e)});
  Camera camera = fit_camera(scenes, width, height, frame, options.field_of_view.value_or(30));
  if (!options.look_at && !options.distance) return camera;
  const float distance = options.distance.value_or(length(camera.eye - camera.target));
  camera.target = options.look_at.value_or(camera.target);
  camera.eye = camera.target + frame.back * distance;
  return camera;
}

}  // namespace pliant::render
