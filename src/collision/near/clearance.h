// Lower bound of the distance of two pieces of a surface from vertex distances alone; mesh neighbours are excluded.
//
// For a point p of one primitive and q of another, with weights a over corners x and b over corners y,
//
//   |p - q|^2  =  sum a_i b_j |x_i - y_j|^2  -  sum_{i<k} a_i a_k |x_i - x_k|^2  -  sum_{j<k} b_j b_k |y_j - y_k|^2.
//
// The first sum is at least the least squared distance of two corners. Each other sum is at most a quarter of an edge's
// squared length, or a third of a triangle's longest squared side. Two primitives without a common vertex or a
// connecting edge have no adjacent corners; in flat cloth their nearest corners are the two opposite an edge. So unless
// cloth bends sharply or touches itself, few vertex distances prove that no two primitives are near. This takes a
// thirteenth of the box tests and needs no paths.
#pragma once

#include <array>
#include <vector>

#include "collision/broad/bounds.h"
#include "collision/proxies/body_blocks.h"
#include "collision/proxies/pair_kernels.h"
#include "model/pool.h"

namespace pliant {

class Clearance {
 public:
  using Line = std::array<std::int32_t, 2>;
  /// A piece of a surface: the corners of its primitives, and the edges and triangle sides among them, if any.
  struct Piece {
    std::vector<std::int32_t> vertices;  ///< corners of the primitives; at least one
    std::vector<Line> lines;
  };

  Clearance() = default;
  /// Adds the pieces of a body, numbered from `first_piece` on, whose vertices are in `vertices`. `joined` lists
  /// adjacent vertices in both directions; pairs of primitives with adjacent corners are excluded.
  void add(int body, int first_piece, std::vector<Piece> pieces, const std::vector<Record>& rest, const Block& vertices,
           const std::vector<Line>& joined);
  void remove(int body);

  /// Gathers the positions of a piece; different threads may gather different pieces.
  void place(const PairKernels& kernels, int piece, const Record* positions);
  /// Lower bound of the distance of any two primitives, one of each piece, except excluded pairs; at most `wanted` [m].
  /// Call place() for both pieces first. `scratch` belongs to the calling thread.
  float between(const PairKernels& kernels, int a, int b, float wanted, std::vector<std::int32_t>& scratch);

 private:
  void leave_out(int body, const Block& vertices, const std::vector<Line>& joined);

  /// The vertices of each piece along a Morton curve, padded to a multiple of sixteen by repetition.
  struct Stored {
    int first = 0, last = 0, first_line = 0, last_line = 0;
  };
  std::vector<Stored> pieces_;
  std::vector<std::int32_t> vertex_;
  std::array<std::vector<std::int32_t>, 2> line_;  ///< first and second ends of the lines of all pieces
  std::array<AlignedVector<float>, 3> place_;      ///< gathered positions, by coordinate [m]
  std::vector<BoxBounds> batch_box_;               ///< for each sixteen gathered vertices, their box
  std::vector<float> longest_;                     ///< for each piece, its largest squared line length [m^2]
  // For each gathered vertex: the vertices that its comparisons exclude, which are itself and its neighbours.
  std::vector<std::int32_t> left_out_start_;
  std::vector<LeftOut> left_out_;
  BodyBlocks vertex_blocks_, line_blocks_, left_out_blocks_;
};

}  // namespace pliant
