// Generates surfaces of scene files in addition to those in pliant/mesh.h.
#include <map>

#include "scene_mesh.h"
#include "scene_values.h"

namespace pliant::scene_file {

TriangleMesh tube_mesh(int columns, int rows, float length, float top_radius, float bottom_radius, int folds,
                       float fold_depth) {
  TriangleMesh mesh;
  mesh.positions.reserve(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  for (int r = 0; r < rows; ++r) {
    const float down = static_cast<float>(r) / static_cast<float>(rows - 1);
    for (int c = 0; c < columns; ++c) {
      const float turn = 360.f * static_cast<float>(c) / static_cast<float>(columns);
      // The wave's phase modulo one turn, so that large angles keep their precision.
      const float phase = 360.f * static_cast<float>(c * folds % columns) / static_cast<float>(columns);
      const float wave = 1 + fold_depth * down * rotated(rotation({0, 1, 0}, phase), {1, 0, 0}).x;
      const float radius = (top_radius + (bottom_radius - top_radius) * down) * wave;
      const Vec3f around = rotated(rotation({0, 1, 0}, turn), {radius, 0, 0});
      mesh.positions.push_back({around.x, -length * down, around.z});
    }
  }
  for (int r = 0; r + 1 < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      const int a = r * columns + c, b = r * columns + (c + 1) % columns;
      const int below_a = a + columns, below_b = b + columns;
      // Diagonals alternate, because a tube with one direction would twist when it stretches.
      if ((r + c) % 2 == 0) {
        mesh.triangles.push_back({a, below_a, below_b});
        mesh.triangles.push_back({a, below_b, b});
      } else {
        mesh.triangles.push_back({a, below_a, b});
        mesh.triangles.push_back({b, below_a, below_b});
      }
    }
  }
  return mesh;
}

TriangleMesh box_mesh(const Vec3f& size, int segments) {
  TriangleMesh mesh;
  std::map<std::array<int, 3>, int>
      numbers;  // index of each lattice point's vertex; sides share the vertices of common edges
  const auto vertex = [&](const std::array<int, 3>& at) {
    const auto [found, is_new] = numbers.try_emplace(at, static_cast<int>(mesh.positions.size()));
    const auto along = [&](int i, float whole) {
      return whole * (static_cast<float>(2 * i - segments) / static_cast<float>(2 * segments));
    };
    if (is_new) mesh.positions.push_back({along(at[0], size.x), along(at[1], size.y), along(at[2], size.z)});
    return found->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const int side : {0, segments}) {
      // The other two axes, ordered so that u x v points outward.
      const std::size_t u = (axis + (side == 0 ? 2 : 1)) % 3, v = (axis + (side == 0 ? 1 : 2)) % 3;
      const auto corner = [&](int i, int k) {
        std::array<int, 3> at{};
        at[axis] = side, at[u] = i, at[v] = k;
        return vertex(at);
      };
      for (int i = 0; i < segments; ++i)
        for (int k = 0; k < segments; ++k) {
          const int a = corner(i, k), b = corner(i + 1, k), c = corner(i + 1, k + 1), d = corner(i, k + 1);
          mesh.triangles.push_back({a, b, c});
          mesh.triangles.push_back({a, c, d});
        }
    }
  }
  return mesh;
}

}  // namespace pliant::scene_file
