// The inner loops of surface contact in sixteen SIMD lanes, compiled once for each instruction set level (pair_lanes.cpp).
// All levels give the same bits. The code around the kernels is compiled once.
#pragma once

#include <cstdint>

#include "collision/proxies/pair_stencil.h"
#include "math/levels.h"

namespace pliant {

/// The particles of a model in a substep.
struct PairParticles {
  const Record* positions = nullptr;
  Record* remainders = nullptr;
  Record* displacements = nullptr;
  float h = 0;
};

/// The motion of a cluster in a substep: a rigid motion, and the residual motion of its vertices. Rigid rotation keeps
/// distances: two points displaced by spin x (x - centre) are no nearer than before.
struct ClusterMotion {
  Vec3f mean{};               ///< displacement of the centre [m]
  Vec3f centre{};             ///< centre at the start [m]
  Vec3f spin{};               ///< rotation vector over the substep [rad]
  float radius = 0;           ///< largest distance of a vertex from the centre [m]
  float largest = 0;          ///< upper bound of the residual motion: displacement minus mean + spin x (x - centre) [m]
  Vec3f low[2]{}, high[2]{};  ///< bounding box at the start and at the end [m]
  float extent = 0;           ///< largest absolute coordinate at the start [m]
  bool is_bounded = true;     ///< true if all coordinates at the end are finite and below 1e14
  Vec3f sum{};                ///< sum of the displacements of dynamic vertices [m]
  float movable = 0;          ///< number of dynamic vertices
};

/// Boxes stored by coordinate, padded to a multiple of sixteen: low x, y, z, high x, y, z.
struct BoxRows {
  float* row[6];
};

/// The corner indices of primitives of one kind: vertices have one row, edges two, triangles three.
struct ElementCorners {
  const std::int32_t* row[3];
  int rows;
};

/// Excluded columns within a batch of sixteen.
struct LeftOut {
  std::int32_t batch;  ///< columns 16 batch to 16 batch + 15
  std::uint32_t bits;
};

/// Sixteen rows and the batches of columns to test them against, minus the columns that a row excludes.
struct BoxComparison {
  BoxRows rows;
  int first_row;     ///< index of the first row, a multiple of sixteen
  float reach;       ///< margin by which rows are grown [m]
  const float* far;  ///< rows that do not overlap this box are skipped: low x, y, z, high x, y, z
  BoxRows columns;
  const std::int32_t* batch;  ///< column batches, ascending
  int batches;
  const LeftOut* left_out;             ///< ascending by batch; each row ends with a sentinel beyond all batches
  const std::int32_t* left_out_start;  ///< of each row
};

/// A row and a column with overlapping boxes.
struct BoxHit {
  std::int32_t row, column;
};

/// Vertex positions stored by coordinate, padded to a multiple of sixteen.
struct PlaceRows {
  float* row[3];
};

/// Sixteen vertices and the batches of other vertices to test against, minus those that a vertex excludes.
struct VertexComparison {
  PlaceRows rows;
  int first_row;     ///< index of the first row, a multiple of sixteen
  const float* far;  ///< rows outside this box are skipped: low x, y, z, high x, y, z
  PlaceRows columns;
  const std::int32_t* batch;  ///< column batches, ascending
  int batches;
  const LeftOut* left_out;             ///< ascending by batch; each row ends with a sentinel beyond all batches
  const std::int32_t* left_out_start;  ///< of each row
};

/// The motion of sixteen pairs in a substep.
struct PairPaths {
  alignas(64) float falls
      [16];  ///< the sum of the residual motions of both sides; the distance decreases at most by this and by the
             ///< relative rigid motion of the clusters [m]
  alignas(
      64) float apart[16];  ///< the largest separation, along any coordinate axis, of the swept boxes of the two sides [m]
};

/// The clusters of a pair's two sides, exchanged in the lanes of `swapped`, and the drift of the observer.
struct PairMotion {
  const ClusterMotion* first;
  const ClusterMotion* second;
  unsigned swapped;
  Vec3f drift;  ///< displacement subtracted from all paths before boxes are fitted [m]
};

struct PairKernels {
  /// `vertices` are those of the cluster and of primitives that begin in it, padded to a multiple of sixteen by repetition.
  void (*measure_cluster)(const std::int32_t* vertices, int count, const PairParticles& particles, ClusterMotion& out);
  /// Swept boxes of primitives `first` to `last` - 1, both multiples of sixteen, in a frame that moves by `drift`.
  void (*fit_boxes)(const ElementCorners& elements, int first, int last, const PairParticles& particles, const Vec3f& drift,
                    const BoxRows& out);
  /// Finds overlapping rows and columns, ascending, and returns their number; `hits` has room for all.
  int (*find_overlaps)(const BoxComparison& boxes, BoxHit* hits);
  /// Writes to `near` the ascending indices i with reach[i] - gone <= within; it has room for all. Lowers `least` to the
  /// smallest of the others. Returns the number written.
  int (*collect)(const float* reach, int count, float gone, float within, std::int32_t* near, float& least);
  /// Gathers the positions of vertices `first` to `last` - 1, both multiples of sixteen.
  void (*gather_places)(const std::int32_t* vertices, int first, int last, const Record* positions, const PlaceRows& out);
  /// The largest squared length of lines `first` to `last` - 1, both multiples of sixteen.
  float (*longest_squared)(const ElementCorners& lines, int first, int last, const Record* positions);
  /// The least squared distance of a row and a column, or `beyond` if all are farther [m^2].
  float (*least_squared)(const VertexComparison& vertices, float beyond);
  /// The least `at_least` of all sixteen pairs, at most one rounding lower.
  float (*least_distance)(const PairStencils& pairs, int first_side, const Record* positions);
  void (*distances)(const PairStencils& pairs, int first_side, const Record* positions, PairBatch& out);
  void (*paths)(const PairStencils& pairs, int first_side, const PairParticles& particles, const PairMotion& motion,
                PairPaths& out);
};

PLIANT_DECLARE_LEVELS(PairKernels, pair_kernels)

/// Factor that covers the rounding of distance bounds.
inline constexpr float bound_slack = 1.0001f;

}  // namespace pliant
