// Fills the grid row by row: distances by the mesh's BVH, signs by exact winding numbers. A sign is computed only near
// the surface: if a node is farther from it than one spacing, the next node is on the same side.
#include "collision/fields/distance_grid.h"

#include <string>

#include "pliant/error.h"

namespace pliant {

namespace {

constexpr double most_nodes = 1 << 27;

void require_sizes(float spacing, float padding) {
  if (!(spacing > 0) || !(spacing < 1e15f) || !(padding >= 0) || !(padding < 1e15f))
    throw Error({},
                "a grid with " + std::to_string(spacing) + " m between nodes and a padding of " +
                    std::to_string(padding) + " m is impossible",
                "choose a spacing above 0 and a padding of at least 0");
}

}  // namespace

void require_closed(const std::vector<Triangle>& triangles, int vertices) {
  if (triangles.empty()) throw Error({}, "a mesh without triangles has no inside", "give a closed triangle mesh");
  for (const Edge& edge : find_edges(triangles, vertices))
    if (edge.triangle_count != 2)
      throw Error(
          Location{.element = "edge " + std::to_string(edge.a) + "-" + std::to_string(edge.b)},
          "it has " + std::to_string(edge.triangle_count) + (edge.triangle_count == 1 ? " triangle" : " triangles") +
              ", so the mesh is not closed",
          "close the mesh, because only a closed one has an inside; open ones can be mesh colliders of triangles, "
          "or as the "
          "solid 'hull' the convex hull of a body");
}

namespace {

std::size_t at(const DistanceField& field, int x, int y, int z) {
  return (static_cast<std::size_t>(z) * static_cast<std::size_t>(field.nodes[1]) + static_cast<std::size_t>(y)) *
             static_cast<std::size_t>(field.nodes[0]) +
         static_cast<std::size_t>(x);
}

Vec3f node(const DistanceField& field, int x, int y, int z) {
  return field.low + Vec3f{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)} * field.spacing;
}

BoxBounds bounds_of(const DistanceField& field) {
  return {field.low, node(field, field.nodes[0] - 1, field.nodes[1] - 1, field.nodes[2] - 1)};
}

void measure_row(const MeshQuery& mesh, int row, DistanceField& field) {
  const int y = row % field.nodes[1], z = row / field.nodes[1];
  bool inside = false;
  float last = 0;
  for (int x = 0; x < field.nodes[0]; ++x) {
    const Vec3f p = node(field, x, y, z);
    // The distance grows by at most the spacing from one node to the next, which limits the search.
    const float limit = x == 0 ? 3e38f : 1.0001f * last + 1.01f * field.spacing;
    const float distance = mesh.closest(p, limit).distance;
    const bool may_differ = x == 0 || !(last > 1.01f * field.spacing);
    if (may_differ) inside = mesh.is_inside(p);
    field.distances[at(field, x, y, z)] = inside ? -distance : distance;
    last = distance;
  }
}

}  // namespace

DistanceGrid::DistanceGrid(const MeshQuery& mesh, float spacing, float padding, Executor& executor) {
  require_sizes(spacing, padding);
  require_closed(mesh.triangles(), static_cast<int>(mesh.positions().size()));
  const BoxBounds box = mesh.bounds().grown(padding);
  const Vec3d size = convert<double>(box.high) - convert<double>(box.low);
  const double cells[3] = {size.x / static_cast<double>(spacing), size.y / static_cast<double>(spacing),
                           size.z / static_cast<double>(spacing)};
  if ((cells[0] + 2) * (cells[1] + 2) * (cells[2] + 2) > most_nodes)
    throw Error({}, "a grid with a spacing of " + std::to_string(spacing) + " m would have more than 2^27 nodes",
                "choose a larger spacing");
  auto field = std::make_shared<DistanceField>();
  field->low = box.low;
  field->spacing = spacing;
  for (std::size_t axis = 0; axis < 3; ++axis) field->nodes[axis] = static_cast<int>(cells[axis]) + 2;
  field->distances.resize(at(*field, 0, 0, field->nodes[2]));
  executor.parallel_for("measure distances", field->nodes[1] * field->nodes[2],
                        [&](int row) { measure_row(mesh, row, *field); });
  bounds_ = bounds_of(*field);
  field_ = std::move(field);
}

DistanceGrid::DistanceGrid(std::shared_ptr<const DistanceField> field) : field_(std::move(field)) {
  const DistanceField& f = *field_;
  const bool sizes = f.nodes[0] >= 2 && f.nodes[1] >= 2 && f.nodes[2] >= 2 && f.spacing > 0 && f.spacing < 1e15f;
  if (!sizes || double(f.nodes[0]) * f.nodes[1] * f.nodes[2] > most_nodes ||
      f.distances.size() != at(f, 0, 0, f.nodes[2]))
    throw Error({}, "the distance field is incomplete", "use the result of measure_distances");
  for (const float distance : f.distances)
    if (!(abs(distance) < 1e15f))
      throw Error({}, "the distance field has values that are not finite", "measure it again");
  bounds_ = bounds_of(f);
}

namespace {

/// A coordinate in units of cells: the cell's index, and the fraction within the cell.
struct Place {
  int cell;
  float share;
};

Place place_in(float x, int node_count) {
  const float held = clamp(x, 0.f, static_cast<float>(node_count - 1));
  const int cell = static_cast<int>(min(held, static_cast<float>(node_count - 2)));
  return {cell, held - static_cast<float>(cell)};
}

float mix(float a, float b, float share) { return a + (b - a) * share; }

}  // namespace

SurfaceDistance<float> DistanceGrid::sample(const Vec3f& p) const {
  const Vec3f held = min(max(p, bounds_.low), bounds_.high), away = p - held;
  const Vec3f local = held - bounds_.low;
  const DistanceField& f = *field_;
  const Place x = place_in(local.x / f.spacing, f.nodes[0]), y = place_in(local.y / f.spacing, f.nodes[1]),
              z = place_in(local.z / f.spacing, f.nodes[2]);
  float d[2][2][2];
  for (int i = 0; i < 8; ++i)
    d[i >> 2][i >> 1 & 1][i & 1] = f.distances[at(f, x.cell + (i & 1), y.cell + (i >> 1 & 1), z.cell + (i >> 2))];
  float along_x[2][2], slope_x[2][2];
  for (int k = 0; k < 2; ++k)
    for (int j = 0; j < 2; ++j) {
      along_x[k][j] = mix(d[k][j][0], d[k][j][1], x.share);
      slope_x[k][j] = d[k][j][1] - d[k][j][0];
    }
  const float near = mix(along_x[0][0], along_x[0][1], y.share), far = mix(along_x[1][0], along_x[1][1], y.share);
  const Vec3f slope{
      mix(mix(slope_x[0][0], slope_x[0][1], y.share), mix(slope_x[1][0], slope_x[1][1], y.share), z.share),
      mix(along_x[0][1] - along_x[0][0], along_x[1][1] - along_x[1][0], z.share), far - near};
  const float distance = mix(near, far, z.share), beyond = length(away);
  const Vec3f normal = unit_or(slope * (1 / f.spacing), Vec3f{0, 1, 0});
  if (!(beyond > 0)) return {distance, normal};
  return {distance + beyond, unit_or(normal * max(distance, 0.f) + away, Vec3f{0, 1, 0})};
}

}  // namespace pliant
