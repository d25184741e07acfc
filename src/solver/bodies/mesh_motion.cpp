#include "solver/bodies/mesh_motion.h"

#include <array>
#include <cstddef>

#include "core/at.h"
#include "geometry/triangle.h"

namespace pliant {

namespace {

/// Triangles within this distance of a contact's point, beyond the mesh's thickness, are compared [m].
constexpr float search_radius = 1e-3f;
/// Points whose moments of inertia in their plane have a smaller ratio lie on a line.
constexpr double least_width = 1e-6;

/// Finds the triangle of a mesh that is nearest to a point, and its velocity there.
class VelocityOnMesh {
 public:
  VelocityOnMesh(const BodyMesh& mesh, const std::vector<Triangle>& triangles, const std::vector<Vec3f>& velocities)
      : mesh_(mesh), triangles_(triangles), velocities_(velocities) {}

  /// `near_by` is the triangle that counts where none is found.
  Vec3d at_point(const Vec3f& point, int near_by) {
    const float margin = search_radius + static_cast<float>(mesh_.thickness());
    mesh_.find(BoxBounds{point, point}.grown(margin), found_);
    if (found_.empty()) found_.push_back(near_by);
    ClosestOnTriangle<double> best{};
    int nearest = -1;
    for (const int triangle : found_) {
      const auto& corners = mesh_.face(triangle).corners;
      const auto closest = closest_on_triangle(convert<double>(point), corners[0], corners[1], corners[2]);
      if (nearest >= 0 && !(closest.distance_squared < best.distance_squared)) continue;
      best = closest;
      nearest = triangle;
    }
    const Triangle& of = triangles_[at(nearest)];
    const auto velocity = [&](std::size_t corner) { return convert<double>(velocities_[at(of[corner])]); };
    return velocity(0) * best.weights.x + velocity(1) * best.weights.y + velocity(2) * best.weights.z;
  }

 private:
  const BodyMesh& mesh_;
  const std::vector<Triangle>& triangles_;
  const std::vector<Vec3f>& velocities_;
  std::vector<int> found_;
};

/// A point of a contact in its plane, against the mean of all points, with its velocity along tangents and normal.
struct PlanePoint {
  double x = 0, y = 0;
  Vec3d velocity{};
};

/// The spin about tangents and normal that fits the velocities of points about their mean: by least squares, and of all
/// that fit the least.
Vec3d spin_of(const std::array<PlanePoint, 4>& points, std::size_t count) {
  double xx = 0, yy = 0, xy = 0, along_x = 0, along_y = 0, about = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto& [x, y, v] = points[i];
    xx += x * x, yy += y * y, xy += x * y;
    along_x += x * v.z, along_y += y * v.z;
    about += x * v.y - y * v.x;
  }
  const double sum = xx + yy, determinant = xx * yy - xy * xy;
  if (!(sum > 0)) return {};
  const bool is_line = !(determinant > least_width * sum * sum);
  const double slope_x = is_line ? along_x / sum : (yy * along_x - xy * along_y) / determinant;
  const double slope_y = is_line ? along_y / sum : (xx * along_y - xy * along_x) / determinant;
  return {slope_y, -slope_x, about / sum};
}

}  // namespace

SurfaceMotion motion_of_mesh(const BodyContact& contact, const BodyMesh& mesh, const std::vector<Triangle>& triangles,
                             const std::vector<Vec3f>& velocities) {
  VelocityOnMesh on_mesh(mesh, triangles, velocities);
  const Vec3d first = convert<double>(contact.tangent1), second = convert<double>(contact.tangent2),
              normal = convert<double>(contact.normal);
  const auto count = at(contact.count);
  std::array<PlanePoint, 4> points{};
  PlanePoint mean;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3d v = on_mesh.at_point(contact.anchor_a[i], contact.a.piece);
    points[i] = {static_cast<double>(contact.x[i]),
                 static_cast<double>(contact.y[i]),
                 {dot(v, first), dot(v, second), dot(v, normal)}};
    mean.x += points[i].x / contact.count;
    mean.y += points[i].y / contact.count;
    mean.velocity += points[i].velocity * (1. / contact.count);
  }
  for (std::size_t i = 0; i < count; ++i) {
    points[i].x -= mean.x;
    points[i].y -= mean.y;
    points[i].velocity -= mean.velocity;
  }
  const auto in_world = [&](const Vec3d& v) { return first * v.x + second * v.y + normal * v.z; };
  const Vec3d spin = spin_of(points, count), velocity = mean.velocity - cross(spin, Vec3d{mean.x, mean.y, 0});
  return {convert<float>(in_world(velocity)), convert<float>(in_world(spin))};
}

}  // namespace pliant
