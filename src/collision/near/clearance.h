// How far two pieces of one surface are apart at least, what is near in the mesh left aside, from the distances of vertices alone.
//
// Between a point p of one primitive and q of another, with weights a over corners x and b over corners y,
//
//   |p - q|^2  =  sum a_i b_j |x_i - y_j|^2  -  sum_{i<k} a_i a_k |x_i - x_k|^2  -  sum_{j<k} b_j b_k |y_j - y_k|^2.
//
// The first sum is no less than the least squared distance of two corners, and the others are at most a quarter of an edge's square
// for an edge and a third of its longest side's for a triangle. Two primitives that share no vertex and have no edge between two
// corners have only corners that are no neighbours; in cloth that lies flat the nearest such are the two that an edge has on its
// sides. So where cloth neither bends sharply nor lies on itself, a few vertices say that nothing is near: a thirteenth as many as
// there are boxes of primitives to be compared, and distances ask for no paths.
#pragma once

#include <array>
#include <vector>

#include "collision/broad/bounds.h"
#include "collision/proxies/pair_kernels.h"

namespace pliant {

class Clearance {
 public:
  using Line = std::array<std::int32_t, 2>;
  /// What a piece consists of: the corners of all its primitives, and their edges and sides, if it has any.
  struct Piece {
    std::vector<std::int32_t> vertices;  ///< at least one
    std::vector<Line> lines;
  };

  Clearance() = default;
  /// `joined`: vertices that are neighbours, both ways about: pairs of primitives with such corners are left aside.
  Clearance(const std::vector<Piece>& pieces, const std::vector<Record>& rest, const std::vector<Line>& joined);

  /// Takes up where a piece is; different pieces at once if need be.
  void place(const PairKernels& kernels, int piece, const Record* positions);
  /// No two primitives, one of each piece or both of one, are nearer, those left aside: or `wanted`, if that is less [m]. Both have
  /// been placed. `scratch` is for the asking thread alone.
  float between(const PairKernels& kernels, int a, int b, float wanted, std::vector<std::int32_t>& scratch);

 private:
  void leave_out(const std::vector<Line>& joined, std::size_t vertices);

  // Piece by piece, along a curve and filled up to sixteens by repeating.
  std::vector<int> start_, line_start_;
  std::vector<std::int32_t> vertex_;
  std::array<std::vector<std::int32_t>, 2> line_;  ///< one end and the other
  std::array<std::vector<float>, 3> place_;        ///< coordinate by coordinate [m]
  std::vector<BoxBounds> batch_box_;               ///< of sixteen vertices
  std::vector<float> longest_;                     ///< of each piece's lines, squared [m^2]
  // Of each place, that vertex itself and its neighbours.
  std::vector<std::int32_t> left_out_start_;
  std::vector<LeftOut> left_out_;
};

}  // namespace pliant
