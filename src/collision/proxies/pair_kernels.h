// The inner loops of surface contact, in sixteen lanes: compiled once for each instruction set (pair_lanes.cpp), the same bits from
// each. Everything around them is written once and is compiled once.
#pragma once

#include <cstdint>

#include "collision/proxies/pair_stencil.h"
#include "math/levels.h"

namespace pliant {

/// Particles of a model in a substep.
struct PairParticles {
  const Record* positions = nullptr;
  Record* remainders = nullptr;
  Record* displacements = nullptr;
  float h = 0;
};

/// What a cluster does in a substep: it goes along and turns, and each vertex departs from that. What turns as a whole keeps
/// its distances: two points moved by spin x (x - centre) are no nearer to one another than before.
struct ClusterMotion {
  Vec3f mean{};               ///< move of the centre [m]
  Vec3f centre{};             ///< at the start [m]
  Vec3f spin{};               ///< as a vector, over the substep [rad]
  float radius = 0;           ///< how far vertices are from the centre, at most [m]
  float largest = 0;          ///< departure of any vertex from mean + spin x (x - centre), at most [m]
  Vec3f low[2]{}, high[2]{};  ///< box at the start and at the end [m]
  float extent = 0;           ///< the largest coordinate at the start [m]
  bool is_bounded = true;     ///< all coordinates at the end are finite and below 1e14
  Vec3f sum{};                ///< of the moves of vertices that can be pushed [m]
  float movable = 0;          ///< how many these are
};

/// Boxes coordinate by coordinate, a multiple of sixteen of them: low x, y, z, high x, y, z.
struct BoxRows {
  float* row[6];
};

/// Elements of one kind as their corners: vertices have one row, edges two, triangles three.
struct ElementCorners {
  const std::int32_t* row[3];
  int rows;
};

/// Sixteen columns of which some are to be left out.
struct LeftOut {
  std::int32_t batch;  ///< the columns from 16 batch on
  std::uint32_t bits;
};

/// Sixteen rows and what they are compared with: batches of sixteen columns, less those that a row leaves out.
struct BoxComparison {
  BoxRows rows;
  int first_row;     ///< a multiple of sixteen
  float reach;       ///< by which rows are grown
  const float* far;  ///< rows that don't overlap this box are left out: low x, y, z, high x, y, z
  BoxRows columns;
  const std::int32_t* batch;  ///< of columns, ascending
  int batches;
  const LeftOut* left_out;             ///< ascending by batch, each row's ending with one that is beyond all
  const std::int32_t* left_out_start;  ///< of each row
};

/// A row and a column whose boxes overlap.
struct BoxHit {
  std::int32_t row, column;
};

/// Vertices coordinate by coordinate, a multiple of sixteen of them.
struct PlaceRows {
  float* row[3];
};

/// Sixteen vertices and what they are compared with: batches of sixteen others, less those that a vertex leaves out.
struct VertexComparison {
  PlaceRows rows;
  int first_row;     ///< a multiple of sixteen
  const float* far;  ///< rows outside this box are left out: low x, y, z, high x, y, z
  PlaceRows columns;
  const std::int32_t* batch;  ///< of columns, ascending
  int batches;
  const LeftOut* left_out;             ///< ascending by batch, each row's ending with one that is beyond all
  const std::int32_t* left_out_start;  ///< of each row
};

/// What sixteen pairs do in a substep.
struct PairPaths {
  alignas(64) float falls
      [16];  ///< how far both sides depart from their clusters' motions: by as much and how these move apart, the
             ///< distance falls at most [m]
  alignas(
      64) float apart[16];  ///< the distance of the boxes around both sides' paths, along the axis where it is greatest [m]
};

/// The clusters of a pair's two sides, the first's first but for the lanes of `swapped`, and who looks on.
struct PairMotion {
  const ClusterMotion* first;
  const ClusterMotion* second;
  unsigned swapped;
  Vec3f drift;  ///< by which boxes of paths are seen to move less [m]
};

struct PairKernels {
  /// `vertices` are those of a cluster and of all that begins at it: a multiple of sixteen, filled up by repeating.
  void (*measure_cluster)(const std::int32_t* vertices, int count, const PairParticles& particles, ClusterMotion& out);
  /// Boxes around the paths of elements `first` to `last` - 1, both multiples of sixteen, as seen by one who moves by `drift`.
  void (*fit_boxes)(const ElementCorners& elements, int first, int last, const PairParticles& particles, const Vec3f& drift,
                    const BoxRows& out);
  /// Rows and columns that overlap, ascending. Returns how many there are; `hits` has room for all.
  int (*find_overlaps)(const BoxComparison& boxes, BoxHit* hits);
  /// The numbers of the reaches that, less `gone`, are within `within`, ascending, to `near`, which has room for all; the least of
  /// the others, or what it was, to `least`. Returns how many there are.
  int (*collect)(const float* reach, int count, float gone, float within, std::int32_t* near, float& least);
  /// Vertices `first` to `last` - 1, both multiples of sixteen, to `out`.
  void (*gather_places)(const std::int32_t* vertices, int first, int last, const Record* positions, const PlaceRows& out);
  /// The longest of lines `first` to `last` - 1, both multiples of sixteen, squared.
  float (*longest_squared)(const ElementCorners& lines, int first, int last, const Record* positions);
  /// The least distance of a row and a column, squared; `beyond` where all are farther. [m^2]
  float (*least_squared)(const VertexComparison& vertices, float beyond);
  /// The least of all sixteen `at_least`, or up to a rounding less.
  float (*least_distance)(const PairStencils& pairs, int first_side, const Record* positions);
  void (*distances)(const PairStencils& pairs, int first_side, const Record* positions, PairBatch& out);
  void (*paths)(const PairStencils& pairs, int first_side, const PairParticles& particles, const PairMotion& motion,
                PairPaths& out);
};

PLIANT_DECLARE_LEVELS(PairKernels, pair_kernels)

/// What is allowed for the rounding of bounds of distances.
inline constexpr float bound_slack = 1.0001f;

}  // namespace pliant
