// Generates a rabbit of balls and cones, for scenes that need a closed mesh without a file.
//
// Surface nets (Gibson 1998): each grid cell that the surface crosses gets a vertex, the mean of the crossings on its
// edges; each grid edge that crosses the surface joins its four cells. The result is closed by construction, and free
// of the slivers of marching cubes. It uses only +, -, *, / and sqrt, so it has the same bits everywhere.
#include <cmath>
#include <map>

#include "scene_mesh.h"

namespace pliant::scene_file {

namespace {

/// A round cone: its radius is a at `from`, b at `to`, and linear between.
struct Part {
  Vec3f from, to;
  float from_radius, to_radius;
};

/// The parts of the rabbit, in units of its height; ears and legs are mirrored.
const std::vector<Part>& parts() {
  static const std::vector<Part> result = [] {
    std::vector<Part> all{{{0, 0.24f, -0.10f}, {0, 0.27f, 0.06f}, 0.23f, 0.19f},     // trunk
                          {{0, 0.54f, 0.15f}, {0, 0.52f, 0.23f}, 0.125f, 0.09f},     // head
                          {{0, 0.40f, 0.08f}, {0, 0.50f, 0.13f}, 0.12f, 0.10f},      // neck
                          {{0, 0.17f, -0.36f}, {0, 0.18f, -0.35f}, 0.075f, 0.07f}};  // tail
    for (const float side : {-1.f, 1.f}) {
      all.push_back({{side * 0.055f, 0.60f, 0.13f}, {side * 0.12f, 0.95f, 0.03f}, 0.05f, 0.05f});  // ear
      all.push_back({{side * 0.14f, 0.14f, -0.14f}, {side * 0.16f, 0.06f, 0.00f}, 0.15f, 0.07f});  // hind leg
      all.push_back({{side * 0.09f, 0.24f, 0.14f}, {side * 0.12f, 0.06f, 0.24f}, 0.08f, 0.06f});   // fore leg
    }
    return all;
  }();
  return result;
}

float distance_to(const Part& part, const Vec3f& p) {
  const Vec3f axis = part.to - part.from;
  float share = dot(p - part.from, axis) / length_squared(axis);
  share = share < 0 ? 0 : share > 1 ? 1 : share;
  return std::sqrt(length_squared(p - (part.from + share * axis))) -
         (part.from_radius + share * (part.to_radius - part.from_radius));
}

/// The smooth union of two distances, with a fillet of about this width.
float joined(float a, float b) {
  constexpr float width = 0.08f;
  const float apart = a > b ? a - b : b - a, near = width > apart ? width - apart : 0;
  return (a < b ? a : b) - near * near / (4 * width);
}

float rabbit(const Vec3f& p) {
  float distance = 10;
  for (const Part& part : parts()) distance = joined(distance, distance_to(part, p));
  return distance;
}

class Net {
 public:
  Net(int cells, float shift) : size_(1.f / static_cast<float>(cells)), shift_(shift) {
    for (int axis = 0; axis < 3; ++axis) counts_[axis] = static_cast<int>(sides[axis] / size_) + 4;
    values_.resize(static_cast<std::size_t>(counts_[0]) * counts_[1] * counts_[2]);
    each([&](int x, int y, int z) { values_[at(x, y, z)] = rabbit(node(x, y, z)); });
  }

  TriangleMesh mesh() {
    each([&](int x, int y, int z) {
      const int place[3] = {x, y, z};
      for (int axis = 0; axis < 3; ++axis) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        if (place[axis] + 1 >= counts_[axis] || place[u] == 0 || place[v] == 0) continue;
        join(place, axis, u, v);
      }
    });
    return std::move(mesh_);
  }

 private:
  static constexpr float sides[3] = {0.75f, 1.1f, 1.05f};

  template <class Visit>
  void each(Visit visit) const {
    for (int z = 0; z < counts_[2]; ++z)
      for (int y = 0; y < counts_[1]; ++y)
        for (int x = 0; x < counts_[0]; ++x) visit(x, y, z);
  }
  std::size_t at(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * counts_[1] + static_cast<std::size_t>(y)) * counts_[0] +
           static_cast<std::size_t>(x);
  }
  Vec3f node(int x, int y, int z) const {
    return Vec3f{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)} * size_ -
           Vec3f{0.375f + 0.31f * shift_ * size_, 0.05f + shift_ * size_, 0.55f + 0.73f * shift_ * size_};
  }

  /// Adds the two triangles of a grid edge that crosses the surface. They join the vertices of its four cells.
  void join(const int (&from)[3], int axis, int u, int v) {
    int to[3] = {from[0], from[1], from[2]};
    ++to[axis];
    const bool inside = values_[at(from[0], from[1], from[2])] < 0;
    if (inside == (values_[at(to[0], to[1], to[2])] < 0)) return;
    int corner[4];
    for (int k = 0; k < 4; ++k) {
      int cell[3] = {from[0], from[1], from[2]};
      cell[u] -= k == 0 || k == 3 ? 1 : 0;
      cell[v] -= k < 2 ? 1 : 0;
      corner[k] = vertex(cell);
    }
    if (!inside) std::swap(corner[1], corner[3]);
    mesh_.triangles.push_back({corner[0], corner[1], corner[2]});
    mesh_.triangles.push_back({corner[0], corner[2], corner[3]});
  }

  /// The vertex of a cell: the mean of the crossings on its twelve edges.
  int vertex(const int (&cell)[3]) {
    const auto [found, is_new] =
        numbers_.try_emplace(at(cell[0], cell[1], cell[2]), static_cast<int>(mesh_.positions.size()));
    if (!is_new) return found->second;
    Vec3f sum{};
    int crossings = 0;
    for (int a = 0; a < 8; ++a)
      for (int bit = 1; bit < 8; bit *= 2) {
        if ((a & bit) != 0) continue;
        const auto corner = [&](int i) {
          return std::array{cell[0] + (i & 1), cell[1] + (i >> 1 & 1), cell[2] + (i >> 2)};
        };
        const auto p = corner(a), q = corner(a | bit);
        const float from = values_[at(p[0], p[1], p[2])], to = values_[at(q[0], q[1], q[2])];
        if ((from < 0) == (to < 0)) continue;
        const Vec3f start = node(p[0], p[1], p[2]), end = node(q[0], q[1], q[2]);
        sum += start + (from / (from - to)) * (end - start);
        ++crossings;
      }
    mesh_.positions.push_back(sum * (1.f / static_cast<float>(crossings)));
    return found->second;
  }

  float size_, shift_;  ///< size of a cell [m]; offset of the grid in cells
  int counts_[3] = {};
  std::vector<float> values_;
  std::map<std::size_t, int> numbers_;
  TriangleMesh mesh_;
};

/// True if every edge has exactly two triangles. It has not if two sheets pass through one cell.
bool is_manifold(const TriangleMesh& mesh) {
  std::map<std::pair<int, int>, int> sides;
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      if (++sides[{t[k], t[(k + 1) % 3]}] > 1) return false;
  return true;
}

}  // namespace

TriangleMesh rabbit_mesh(float height, int cells) {
  constexpr int attempts = 32;  // each with a different offset of the grid
  TriangleMesh mesh;
  for (int attempt = 0; attempt < attempts; ++attempt) {
    mesh = Net(cells, static_cast<float>(attempt) / attempts).mesh();
    if (is_manifold(mesh)) break;
  }
  float low = mesh.positions.front().y, high = low;
  for (const Vec3f& p : mesh.positions) {
    low = p.y < low ? p.y : low;
    high = p.y > high ? p.y : high;
  }
  for (Vec3f& p : mesh.positions) p = (p - Vec3f{0, low, 0}) * (height / (high - low));
  return mesh;
}

}  // namespace pliant::scene_file
