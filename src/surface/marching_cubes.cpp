// Marching cubes by bricks of 4 x 4 x 4 nodes, of which a word of 64 bits says which are inside.
//
// Each crossed edge of the grid belongs to the brick of its first node, and is a vertex of the mesh. Vertices of a
// brick are numbered by axis and node, so a count of bits finds the vertex of an edge, and blocks are independent of
// each other.
#include "surface/marching_cubes.h"

#include <algorithm>
#include <bit>

#include "core/at.h"
#include "parallel/ranges.h"
#include "surface/brick_grid.h"
#include "surface/cube_cases.h"

namespace pliant::surface {

namespace {

/// Of an edge between a vertex and a node, so that no triangle has two equal corners.
constexpr float least_share = 0.02f;

/// The crossed edges of a brick, by axis, and the number of the first vertex of each axis.
struct BrickEdges {
  std::array<NodeSet, 3> crossed;
  std::array<int, 3> first;
};

/// The vertices and triangles of a block, and those of the blocks before.
struct BlockCounts {
  int vertices = 0, triangles = 0;
  int first_vertex = 0, first_triangle = 0;
};

struct Workspace {
  const Field& field;
  std::vector<Neighbours> neighbours;
  std::vector<BlockCounts> counts;
  std::unique_ptr<BrickEdges[]> edges;  ///< of blocks that have some
  LinkedMesh mesh;
};

NodeSet inside_of(const Field& field, int brick) {
  return brick < 0 ? 0 : field.blocks[at(brick / block_bricks)].inside[at(brick % block_bricks)];
}

const float* values_of(const Field& field, int brick) {
  return brick < 0 ? empty_brick() : field.blocks[at(brick / block_bricks)].values[at(brick % block_bricks)];
}

/// True if all nodes of a block, and those above it, are on one side.
bool is_uniform(const Workspace& w, int block) {
  NodeSet any = 0, all = ~NodeSet{0};
  for (const int neighbour : w.neighbours[at(block)]) {
    if (neighbour < 0) all = 0;
    if (neighbour < 0) continue;
    for (const NodeSet inside : w.field.blocks[at(neighbour)].inside) any |= inside, all &= inside;
  }
  return any == 0 || all == ~NodeSet{0};
}

CornerSets corners_of(const Workspace& w, const AroundBrick<int>& around) {
  AroundBrick<NodeSet> inside;
  for (std::size_t n = 0; n < 8; ++n) inside[n] = inside_of(w.field, around[n]);
  return corner_sets(inside);
}

/// Finds and counts the vertices and triangles of a block.
void count(Workspace& w, int block) {
  if (is_uniform(w, block)) return;
  const std::array<CubeCase, 256>& cases = cube_cases();
  const BrickGrid grid = bricks_above(w.neighbours[at(block)]);
  BlockCounts counts;
  for (int brick = 0; brick < block_bricks; ++brick) {
    const CornerSets c = corners_of(w, around_brick(grid, brick));
    BrickEdges& edges = w.edges[at(block_bricks * block + brick)];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      edges.crossed[axis] = c[0] ^ c[std::size_t{1} << axis];
      edges.first[axis] = counts.vertices;
      counts.vertices += size_of(edges.crossed[axis]);
    }
    for (NodeSet mixed = mixed_cells(c); mixed != 0; mixed &= mixed - 1)
      counts.triangles += cases[case_of(c, std::countr_zero(mixed))].count;
  }
  w.counts[at(block)] = counts;
}

/// Places the vertices of a brick's edges along an axis.
void add_vertices(const Workspace& w, const AroundBrick<int>& around, int axis, const Cell& corner,
                  const BrickEdges& edges) {
  const double cell = static_cast<double>(w.field.cell);
  const float *const own = values_of(w.field, around[0]), *const above =
                                                              values_of(w.field, around[std::size_t{1} << axis]);
  const int stride = 1 << (2 * axis), last = 3 * stride;  // of nodes along the axis
  Vertex* to = &w.mesh.vertices[at(edges.first[at(axis)])];
  for (NodeSet bits = edges.crossed[at(axis)]; bits != 0; bits &= bits - 1) {
    const int node = std::countr_zero(bits);
    const float from = own[node];
    const float next = (node & last) == last ? above[node - last] : own[node + stride];
    const float share = std::clamp((surface_level - from) / (next - from), least_share, 1 - least_share);
    std::array<double, 3> place{static_cast<double>(corner.x + (node & 3)),
                                static_cast<double>(corner.y + (node >> 2 & 3)),
                                static_cast<double>(corner.z + (node >> 4))};
    place[at(axis)] += static_cast<double>(share);
    *to++ = {static_cast<float>(place[0] * cell), static_cast<float>(place[1] * cell),
             static_cast<float>(place[2] * cell), 0};
  }
}

/// Numbers the vertices of a block in the whole mesh, and places them.
void add_vertices(Workspace& w, int block) {
  const Cell cell = cell_of(w.field.keys[at(block)]);
  const BrickGrid grid = bricks_above(w.neighbours[at(block)]);
  for (int brick = 0; brick < block_bricks; ++brick) {
    BrickEdges& edges = w.edges[at(block_bricks * block + brick)];
    const AroundBrick<int> around = around_brick(grid, brick);
    const Cell corner{block_side * cell.x + brick_side * (brick & 1),
                      block_side * cell.y + brick_side * (brick >> 1 & 1),
                      block_side * cell.z + brick_side * (brick >> 2)};
    for (int axis = 0; axis < 3; ++axis) {
      edges.first[at(axis)] += w.counts[at(block)].first_vertex;
      if (edges.crossed[at(axis)] != 0) add_vertices(w, around, axis, corner, edges);
    }
  }
}

/// Where a corner of a cell is: the brick, as an index into AroundBrick, and the nodes below it there.
struct CornerPlace {
  NodeSet below;
  int brick;
};

using CornerPlaces = std::array<std::array<CornerPlace, 8>, brick_nodes>;

/// By cell and corner.
constexpr CornerPlaces make_corner_places() {
  CornerPlaces places{};
  for (int cell = 0; cell < brick_nodes; ++cell)
    for (int corner = 0; corner < 8; ++corner) {
      const int x = (cell & 3) + (corner & 1), y = (cell >> 2 & 3) + (corner >> 1 & 1), z = (cell >> 4) + (corner >> 2);
      const int node = (x & 3) | (y & 3) << 2 | (z & 3) << 4;
      places[static_cast<std::size_t>(cell)][static_cast<std::size_t>(corner)] = {
          (NodeSet{1} << node) - 1, x >> 2 | (y >> 2) << 1 | (z >> 2) << 2};
    }
  return places;
}

/// The triangles of a brick's cells, written one behind another, and the links along their faces.
void add_triangles(const Workspace& w, const AroundBrick<int>& around, const CornerSets& corners, NodeSet mixed,
                   std::array<int, 3>*& to) {
  static constexpr CornerPlaces corner_places = make_corner_places();
  const std::array<CubeCase, 256>& cases = cube_cases();
  AroundBrick<const BrickEdges*> edges;
  for (std::size_t n = 0; n < 8; ++n) edges[n] = around[n] < 0 ? nullptr : &w.edges[at(around[n])];
  for (; mixed != 0; mixed &= mixed - 1) {
    const int cell = std::countr_zero(mixed);
    const CubeCase& of = cases[case_of(corners, cell)];
    std::array<int, 12> vertex;
    for (std::size_t i = 0; i < of.crossed_count; ++i) {
      const int edge = of.crossed[i];
      const std::size_t axis = at(edge >> 2);
      const CornerPlace& start = corner_places[at(cell)][at(edge_start(edge))];
      const BrickEdges& owner = *edges[at(start.brick)];
      vertex[at(edge)] = owner.first[axis] + size_of(owner.crossed[axis] & start.below);
    }
    for (std::size_t i = 0; i < of.crossed_count; ++i) {
      const std::size_t edge = of.crossed[i];
      w.mesh.links[at(vertex[edge])][edge & 3] = vertex[of.next[edge]];
    }
    for (std::size_t t = 0; t < of.count; ++t) {
      const auto& triangle = of.triangles[t];
      *to++ = {vertex[triangle[0]], vertex[triangle[1]], vertex[triangle[2]]};
    }
  }
}

void add_triangles(Workspace& w, int block) {
  const BrickGrid grid = bricks_above(w.neighbours[at(block)]);
  std::array<int, 3>* next = w.mesh.triangles.data() + w.counts[at(block)].first_triangle;
  for (int brick = 0; brick < block_bricks; ++brick) {
    const AroundBrick<int> around = around_brick(grid, brick);
    const CornerSets corners = corners_of(w, around);
    const NodeSet mixed = mixed_cells(corners);
    if (mixed != 0) add_triangles(w, around, corners, mixed, next);
  }
}

/// Sums the counts of the blocks, and makes room for all vertices and triangles.
void make_room(Workspace& w) {
  int vertices = 0, triangles = 0;
  for (BlockCounts& counts : w.counts) {
    counts.first_vertex = vertices;
    counts.first_triangle = triangles;
    vertices += counts.vertices;
    triangles += counts.triangles;
  }
  w.mesh.size = vertices;
  w.mesh.vertices = std::unique_ptr<Vertex[]>(new Vertex[at(vertices)]);
  w.mesh.links = std::unique_ptr<Links[]>(new Links[at(vertices)]);
  w.mesh.triangles.resize(at(triangles));
}

}  // namespace

LinkedMesh marching_cubes(const Field& field, Executor& executor) {
  constexpr int blocks_at_a_time = 32;
  const int blocks = field.size();
  Workspace w{field,
              find_neighbours(field, executor),
              std::vector<BlockCounts>(at(blocks)),
              std::unique_ptr<BrickEdges[]>(new BrickEdges[at(block_bricks * blocks)]),
              {}};
  for_items(executor, "surface: count", blocks, blocks_at_a_time, [&](int block) { count(w, block); });
  make_room(w);
  for_items(executor, "surface: vertices", blocks, blocks_at_a_time, [&](int block) {
    if (w.counts[at(block)].vertices > 0) add_vertices(w, block);
  });
  for_items(executor, "surface: triangles", blocks, blocks_at_a_time, [&](int block) {
    if (w.counts[at(block)].triangles > 0) add_triangles(w, block);
  });
  return std::move(w.mesh);
}

}  // namespace pliant::surface
