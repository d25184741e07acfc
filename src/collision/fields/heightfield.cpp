// Queries of a heightfield. They find the range of cells by division and grow it by one cell per side against rounding.
#include "collision/fields/heightfield.h"

#include <algorithm>
#include <string>

#include "pliant/error.h"

namespace pliant {

namespace {

bool positive_and_finite(float x) { return x > 0 && x < 1e15f; }

}  // namespace

Heightfield::Heightfield(int columns, int rows, float cell_width, float cell_depth, const Vec3f& origin,
                         std::vector<float> heights)
    : columns_(columns),
      rows_(rows),
      width_(cell_width),
      depth_(cell_depth),
      origin_(origin),
      heights_(std::move(heights)) {
  const std::string size = std::to_string(columns) + " x " + std::to_string(rows);
  if (columns < 2 || rows < 2 || !positive_and_finite(cell_width) || !positive_and_finite(cell_depth))
    throw Error({}, "a heightfield of " + size + " vertices is impossible, or its cells have no size",
                "give at least 2 x 2 vertices, and cell sizes above 0");
  if (heights_.size() != static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows))
    throw Error({}, "there are " + std::to_string(heights_.size()) + " heights for " + size + " vertices",
                "give one per vertex");
  for (std::size_t i = 0; i < heights_.size(); ++i)
    if (!(abs(heights_[i]) < 1e15f))
      throw Error(Location{.element = "height " + std::to_string(i)}, "it is not finite", "give heights in metres");
  bounds_ = {vertex(0, 0), vertex(rows_ - 1, columns_ - 1)};
  for (const float height : heights_) {
    bounds_.low.y = min(bounds_.low.y, origin_.y + height);
    bounds_.high.y = max(bounds_.high.y, origin_.y + height);
  }
}

bool Heightfield::column(const Vec3f& p, Vec3f& corner, Vec3f& normal) const {
  const float across = (p.x - origin_.x) / width_, along = (p.z - origin_.z) / depth_;
  if (!(across >= 0 && along >= 0 && across <= static_cast<float>(columns_ - 1) &&
        along <= static_cast<float>(rows_ - 1)))
    return false;
  const int c = std::min(static_cast<int>(across), columns_ - 2), r = std::min(static_cast<int>(along), rows_ - 2);
  const bool second = across - static_cast<float>(c) > along - static_cast<float>(r);
  Vec3f t[3];
  corners(2 * (r * (columns_ - 1) + c) + (second ? 1 : 0), t);
  corner = t[0];
  normal = convert<float>(triangle_normal(convert<double>(t[0]), convert<double>(t[1]), convert<double>(t[2])));
  return true;
}

namespace {

[[noreturn]] void fail_not_even(std::size_t vertex) {
  throw Error(
      Location{.element = "vertex " + std::to_string(vertex)},
      "its x and z are not on the regular grid of the first vertices",
      "give an evenly spaced, unrotated grid with rows along z and columns along x, or use the mesh as triangles");
}

}  // namespace

Heightfield heightfield_of(const TriangleMesh& mesh) {
  const std::vector<Vec3f>& p = mesh.positions;
  if (p.size() < 4) fail_not_even(0);
  std::size_t columns = 1;
  while (columns < p.size() && p[columns].x > p[columns - 1].x) ++columns;
  const std::size_t rows = p.size() / columns;
  if (columns < 2 || rows < 2 || rows * columns != p.size()) fail_not_even(columns);
  const float width = (p[columns - 1].x - p[0].x) / static_cast<float>(columns - 1),
              depth = (p.back().z - p[0].z) / static_cast<float>(rows - 1), slack = 1e-3f * min(width, depth);
  std::vector<float> heights;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const std::size_t row = i / columns, column = i % columns;
    const Vec3f even{p[0].x + width * static_cast<float>(column), p[i].y, p[0].z + depth * static_cast<float>(row)};
    if (!(largest(p[i] - even) <= slack)) fail_not_even(i);
    heights.push_back(p[i].y);
  }
  if (mesh.triangles.size() != 2 * (columns - 1) * (rows - 1))
    throw Error({},
                "it has " + std::to_string(mesh.triangles.size()) + " triangles, but a heightfield of " +
                    std::to_string(columns) + " x " + std::to_string(rows) + " vertices has " +
                    std::to_string(2 * (columns - 1) * (rows - 1)),
                "give two triangles per cell, or use the mesh as triangles");
  return {static_cast<int>(columns), static_cast<int>(rows), width, depth, {p[0].x, 0, p[0].z}, std::move(heights)};
}

Vec3f Heightfield::vertex(int row, int column) const {
  const auto i = static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
  return origin_ + Vec3f{static_cast<float>(column) * width_, heights_[i], static_cast<float>(row) * depth_};
}

void Heightfield::corners(int triangle, Vec3f (&to)[3]) const {
  const int cell = triangle / 2, r = cell / (columns_ - 1), c = cell % (columns_ - 1);
  to[0] = vertex(r, c);
  to[1] = triangle % 2 == 0 ? vertex(r + 1, c) : vertex(r + 1, c + 1);
  to[2] = triangle % 2 == 0 ? vertex(r + 1, c + 1) : vertex(r, c + 1);
}

Heightfield::Range Heightfield::cells_between(float low, float high, float origin, float size, int cells) {
  const auto cell = [&](float x) {
    const double place = (static_cast<double>(x) - static_cast<double>(origin)) / static_cast<double>(size);
    return static_cast<int>(clamp(place, -2.0, static_cast<double>(cells) + 2));
  };
  const int first = cell(low) - 1, last = cell(high) + 2;
  return {first < 0 ? 0 : first, last > cells ? cells : last};
}

GroundPoint Heightfield::closest(const Vec3f& p, float limit) const {
  GroundPoint best;
  best.distance = limit;
  query(BoxBounds{p, p}.grown(limit), [&](int triangle) {
    Vec3f t[3];
    corners(triangle, t);
    const Vec3d q = convert<double>(p), a = convert<double>(t[0]), b = convert<double>(t[1]), c = convert<double>(t[2]);
    const auto closest = closest_on_triangle(q, a, b, c);
    const float distance = static_cast<float>(sqrt(closest.distance_squared));
    if (!(distance < best.distance)) return;
    const Vec3d normal = triangle_normal(a, b, c);
    best = {true, triangle, convert<float>(closest.point), convert<float>(normal), distance, !(dot(q - a, normal) < 0)};
  });
  return best;
}

TriangleMesh Heightfield::mesh() const {
  TriangleMesh mesh;
  for (int r = 0; r < rows_; ++r)
    for (int c = 0; c < columns_; ++c) mesh.positions.push_back(vertex(r, c));
  for (int r = 0; r + 1 < rows_; ++r)
    for (int c = 0; c + 1 < columns_; ++c) {
      const int a = r * columns_ + c, b = a + columns_;
      mesh.triangles.push_back({a, b, b + 1});
      mesh.triangles.push_back({a, b + 1, a + 1});
    }
  return mesh;
}

}  // namespace pliant
