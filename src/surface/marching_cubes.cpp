// Marching cubes by rows of eight nodes, of which a byte says which are inside.
//
// Each crossed edge of the grid belongs to the block of its first node, and is a vertex of the mesh. Vertices of a block are numbered by
// axis, row and place in the row, so a count of bits finds the vertex of an edge, and blocks are independent of each other.
#include "surface/marching_cubes.h"

#include <algorithm>
#include <bit>
#include <cstdint>

#include "surface/cube_cases.h"

namespace pliant::surface {

namespace {

constexpr float least_share = 0.02f;  ///< of an edge between a vertex and a node, so that no triangle has two equal corners

/// The block itself and its seven neighbours above; bit a of the index means one block up along axis a. -1 where there is none.
using Neighbours = std::array<int, 8>;

/// One bit for each node of a row: bit x for node x.
using RowBits = std::uint8_t;

/// The crossed edges of a block.
struct BlockEdges {
  std::array<std::array<RowBits, block_rows>, 3> crossed{};       ///< by axis and row: edges that start at these nodes
  std::array<std::array<std::uint16_t, block_rows>, 3> before{};  ///< vertices of the block before those of the row
  int first_vertex = 0, vertices = 0;
  int first_triangle = 0, triangles = 0;
};

struct Workspace {
  const Field& field;
  std::vector<std::array<RowBits, block_rows>> inside;
  std::vector<Neighbours> neighbours;
  std::vector<BlockEdges> edges;
};

std::size_t index(int i) { return static_cast<std::size_t>(i); }

std::array<RowBits, block_rows> inside_of(const Field& field, int block) {
  std::array<RowBits, block_rows> rows{};
  const int place = field.stored[index(block)];
  if (place < 0) rows.fill(0xff);
  if (place < 0) return rows;
  const BlockValues& values = field.values[index(place)];
  for (int row = 0; row < block_rows; ++row) {
    unsigned bits = 0;
    for (int x = 0; x < block_side; ++x) bits |= (values[index(row * block_side + x)] > surface_level ? 1U : 0U) << x;
    rows[index(row)] = static_cast<RowBits>(bits);
  }
  return rows;
}

Neighbours neighbours_of(const Field& field, int block) {
  const Cell c = cell_of(field.keys[index(block)]);
  Neighbours found{};
  for (int n = 0; n < 8; ++n)
    found[index(n)] = field.table.find(key_of({c.x + (n & 1), c.y + (n >> 1 & 1), c.z + (n >> 2 & 1)}));
  return found;
}

/// A row of nodes by the block that has it, as an index into Neighbours without x, and its number there.
struct RowPlace {
  int neighbour, row;
};

/// The row at (y, z), where 8 means the first of the block above.
RowPlace row_at(int y, int z) {
  return {(y / block_side) << 1 | (z / block_side) << 2, (z % block_side) * block_side + y % block_side};
}

/// Nine bits: a row of nodes, and the next node along x.
unsigned row_bits(const Workspace& w, int block, int y, int z) {
  const RowPlace at = row_at(y, z);
  const Neighbours& neighbours = w.neighbours[index(block)];
  const int own = neighbours[index(at.neighbour)], beyond = neighbours[index(at.neighbour | 1)];
  const unsigned bits = own < 0 ? 0U : w.inside[index(own)][index(at.row)];
  const unsigned next = beyond < 0 ? 0U : w.inside[index(beyond)][index(at.row)] & 1U;
  return bits | next << block_side;
}

/// The bits of the four rows around the cells (x, y, z), at y, y + 1 of z, then of z + 1.
using CellRows = std::array<unsigned, 4>;

CellRows rows_at(const Workspace& w, int block, int y, int z) {
  return {row_bits(w, block, y, z), row_bits(w, block, y + 1, z), row_bits(w, block, y, z + 1),
          row_bits(w, block, y + 1, z + 1)};
}

/// The case of the cell at x.
unsigned case_at(const CellRows& rows, int x) {
  unsigned inside = 0;
  for (unsigned r = 0; r < 4; ++r) inside |= (rows[r] >> x & 3U) << (2 * r);
  return inside;
}

/// The cells of a row whose corners are not all on one side.
unsigned mixed_cells(const CellRows& rows) {
  const unsigned any = rows[0] | rows[1] | rows[2] | rows[3], all = rows[0] & rows[1] & rows[2] & rows[3];
  return ((any | any >> 1) & ~(all & all >> 1)) & 0xffU;
}

/// Finds and counts the vertices and triangles of a block.
void count(Workspace& w, int block) {
  BlockEdges& edges = w.edges[index(block)];
  const std::array<CubeCase, 256>& cases = cube_cases();
  for (int row = 0; row < block_rows; ++row) {
    const CellRows rows = rows_at(w, block, row % block_side, row / block_side);
    const std::array<unsigned, 3> ends{rows[0] >> 1, rows[1], rows[2]};
    for (std::size_t axis = 0; axis < 3; ++axis)
      edges.crossed[axis][index(row)] = static_cast<RowBits>((rows[0] ^ ends[axis]) & 0xffU);
    for (unsigned mixed = mixed_cells(rows); mixed != 0; mixed &= mixed - 1)
      edges.triangles += cases[case_at(rows, std::countr_zero(mixed))].count;
  }
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t row = 0; row < block_rows; ++row) {
      edges.before[axis][row] = static_cast<std::uint16_t>(edges.vertices);
      edges.vertices += std::popcount(edges.crossed[axis][row]);
    }
}

/// The vertex on the edge along `axis` that starts at a node, which may lie in a block above.
int vertex_at(const Workspace& w, int block, int axis, const Cell& node) {
  const RowPlace at = row_at(node.y, node.z);
  const int owner = w.neighbours[index(block)][index(at.neighbour | node.x / block_side)];
  const BlockEdges& edges = w.edges[index(owner)];
  const unsigned below = edges.crossed[index(axis)][index(at.row)] & ((1U << (node.x % block_side)) - 1);
  return edges.first_vertex + edges.before[index(axis)][index(at.row)] + std::popcount(below);
}

void add_triangles(const Workspace& w, int block, TriangleMesh& mesh) {
  const std::array<CubeCase, 256>& cases = cube_cases();
  auto next = mesh.triangles.begin() + w.edges[index(block)].first_triangle;
  for (int row = 0; row < block_rows; ++row) {
    const int y = row % block_side, z = row / block_side;
    const CellRows rows = rows_at(w, block, y, z);
    for (unsigned mixed = mixed_cells(rows); mixed != 0; mixed &= mixed - 1) {
      const int x = std::countr_zero(mixed);
      const auto vertex = [&](int edge) {
        const int start = edge_start(edge);
        return vertex_at(w, block, edge >> 2, {x + (start & 1), y + (start >> 1 & 1), z + (start >> 2)});
      };
      const CubeCase& of = cases[case_at(rows, x)];
      for (int t = 0; t < of.count; ++t) {
        const auto& edges = of.triangles[index(t)];
        *next++ = {vertex(edges[0]), vertex(edges[1]), vertex(edges[2])};
      }
    }
  }
}

/// The value at a node of the block or of one above; 0 where there is no block.
float value_at(const Workspace& w, int block, const Cell& node) {
  const RowPlace at = row_at(node.y, node.z);
  const int owner = w.neighbours[index(block)][index(at.neighbour | node.x / block_side)];
  return owner < 0 ? 0 : w.field.at(owner, at.row * block_side + node.x % block_side);
}

void add_vertices(const Workspace& w, int block, TriangleMesh& mesh) {
  const Cell corner = cell_of(w.field.keys[index(block)]);
  const double cell = static_cast<double>(w.field.cell);
  const auto place = [&](int at, int node, float share) {
    return static_cast<float>((static_cast<double>(at * block_side + node) + static_cast<double>(share)) * cell);
  };
  auto next = mesh.positions.begin() + w.edges[index(block)].first_vertex;
  for (int axis = 0; axis < 3; ++axis)
    for (int row = 0; row < block_rows; ++row)
      for (unsigned bits = w.edges[index(block)].crossed[index(axis)][index(row)]; bits != 0; bits &= bits - 1) {
        const Cell node{std::countr_zero(bits), row % block_side, row / block_side};
        const std::array<int, 3> step{axis == 0, axis == 1, axis == 2};
        const float from = value_at(w, block, node);
        const float to = value_at(w, block, {node.x + step[0], node.y + step[1], node.z + step[2]});
        const float share = std::clamp((surface_level - from) / (to - from), least_share, 1 - least_share);
        const auto shift = [&](std::size_t a) { return step[a] != 0 ? share : 0.f; };
        *next++ = {place(corner.x, node.x, shift(0)), place(corner.y, node.y, shift(1)), place(corner.z, node.z, shift(2))};
      }
}

/// Sums the counts of the blocks, and makes room for all vertices and triangles.
TriangleMesh make_room(Workspace& w) {
  int vertices = 0, triangles = 0;
  for (BlockEdges& edges : w.edges) {
    edges.first_vertex = vertices;
    edges.first_triangle = triangles;
    vertices += edges.vertices;
    triangles += edges.triangles;
  }
  return {std::vector<Vec3f>(index(vertices)), std::vector<std::array<int, 3>>(index(triangles))};
}

}  // namespace

TriangleMesh marching_cubes(const Field& field, Executor& executor) {
  const std::size_t blocks = field.keys.size();
  Workspace w{field, std::vector<std::array<RowBits, block_rows>>(blocks), std::vector<Neighbours>(blocks),
              std::vector<BlockEdges>(blocks)};
  executor.parallel_for("surface: inside", field.size(), [&](int block) {
    w.inside[index(block)] = inside_of(field, block);
    w.neighbours[index(block)] = neighbours_of(field, block);
  });
  executor.parallel_for("surface: count", field.size(), [&](int block) { count(w, block); });
  TriangleMesh mesh = make_room(w);
  executor.parallel_for("surface: triangles", field.size(), [&](int block) {
    if (w.edges[index(block)].vertices > 0) add_vertices(w, block, mesh);
    if (w.edges[index(block)].triangles > 0) add_triangles(w, block, mesh);
  });
  return mesh;
}

}  // namespace pliant::surface
