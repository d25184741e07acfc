// The inner loops of surface contact in sixteen SIMD lanes, compiled once for each instruction set level
// (pair_lanes.cpp). All levels give the same bits. Code outside the kernels is compiled once.
#pragma once

#include <cstdint>

#include "collision/proxies/pair_stencil.h"
#include "math/levels.h"

namespace pliant {

/// The particles of all bodies in a substep.
struct PairParticles {
  const Record* positions = nullptr;
  Record* remainders = nullptr;
  Record* displacements = nullptr;
  float h = 0;
  const double* births = nullptr;  ///< State::births; null if it is empty
};

/// The motion of a cluster in a substep: a rigid motion, and the residual motion of its vertices. Rigid rotation keeps
/// distances: two points displaced by spin x (x - centre) are no nearer than before.
struct ClusterMotion {
  Vec3f mean{};       ///< displacement of the centre [m]
  Vec3f centre{};     ///< centre at the substep's start [m]
  Vec3f spin{};       ///< rotation vector over the substep [rad]
  float radius = 0;   ///< largest distance of a vertex from the centre [m]
  float largest = 0;  ///< upper bound of the residual motion: displacement minus (mean + spin x (x - centre)) [m]
  Vec3f low[2]{}, high[2]{};  ///< bounding box at the substep's start [0] and end [1] [m]
  float extent = 0;           ///< largest absolute coordinate at the substep's start [m]
  bool is_bounded = true;     ///< true if all coordinates at the substep's end are finite and below 1e14 m
  Vec3f sum{};                ///< sum of the displacements of dynamic vertices [m]
  float movable = 0;          ///< number of dynamic vertices
};

/// Boxes stored by coordinate (low x, y, z, high x, y, z), padded to a multiple of sixteen boxes.
struct BoxRows {
  float* row[6];
};

/// Vertex indices of the primitives of one kind: one array for vertices, two for edges, three for triangles.
struct ElementCorners {
  const std::int32_t* row[3];
  int rows;
};

/// The columns that a row excludes within a batch of sixteen columns.
struct LeftOut {
  std::int32_t batch;  ///< index of the batch: columns 16 batch to 16 batch + 15
  std::uint32_t bits;
};

/// A comparison of sixteen boxes (rows) with batches of other boxes (columns), without those that a row excludes.
struct BoxComparison {
  BoxRows rows;
  int first_row;     ///< index of the first row, a multiple of sixteen
  float reach;       ///< distance by which the rows' boxes are grown [m]
  const float* far;  ///< box as low x, y, z, high x, y, z; rows that do not overlap it are skipped
  BoxRows columns;
  const std::int32_t* batch;  ///< indices of the column batches to test, ascending
  int batches;
  const LeftOut* left_out;             ///< sorted by batch; the list of each row ends with a sentinel above all batches
  const std::int32_t* left_out_start;  ///< index of each row's first entry in `left_out`
};

/// A row and a column whose boxes overlap.
struct BoxHit {
  std::int32_t row, column;
};

/// Vertex positions stored by coordinate, padded to a multiple of sixteen.
struct PlaceRows {
  float* row[3];
};

/// A comparison of sixteen vertices (rows) with batches of other vertices (columns), without those that a row excludes.
struct VertexComparison {
  PlaceRows rows;
  int first_row;     ///< index of the first row, a multiple of sixteen
  const float* far;  ///< box as low x, y, z, high x, y, z; rows outside it are skipped
  PlaceRows columns;
  const std::int32_t* batch;  ///< indices of the column batches to test, ascending
  int batches;
  const LeftOut* left_out;             ///< sorted by batch; the list of each row ends with a sentinel above all batches
  const std::int32_t* left_out_start;  ///< index of each row's first entry in `left_out`
};

/// The motion of sixteen pairs in a substep.
struct PairPaths {
  /// The sum of the residual motions of both sides; the distance decreases at most by this and by the relative rigid
  /// motion of the clusters [m]
  alignas(64) float falls[16];
  /// The largest separation, along any coordinate axis, of the swept boxes of the two sides [m]
  alignas(64) float apart[16];
};

/// The clusters of both sides of a pair, exchanged in lanes of `swapped`, and the displacement of the reference frame.
struct PairMotion {
  const ClusterMotion* first;
  const ClusterMotion* second;
  unsigned swapped;
  Vec3f drift;  ///< displacement subtracted from all paths before boxes are fitted [m]
};

struct PairKernels {
  /// Measures a cluster; `vertices`: its own and its primitives' corners, padded by repetition to a multiple of
  /// sixteen.
  void (*measure_cluster)(const std::int32_t* vertices, int count, const PairParticles& particles, ClusterMotion& out);
  /// Swept boxes of primitives `first` to `last` - 1, both multiples of sixteen, relative to a frame moving by `drift`.
  void (*fit_boxes)(const ElementCorners& elements, int first, int last, const PairParticles& particles,
                    const Vec3f& drift, const BoxRows& out);
  /// Writes all pairs of overlapping rows and columns to `hits`, ascending; returns their number. Room: 256 a batch of
  /// rows.
  int (*find_overlaps)(const BoxComparison& boxes, BoxHit* hits);
  /// Gathers the positions of vertices number `first` to `last` - 1, both multiples of sixteen.
  void (*gather_places)(const std::int32_t* vertices, int first, int last, const Record* positions,
                        const PlaceRows& out);
  /// Returns the largest squared length of lines `first` to `last` - 1, both multiples of sixteen [m^2].
  float (*longest_squared)(const ElementCorners& lines, int first, int last, const Record* positions);
  /// Returns the least squared distance of a row and a column, or `beyond` if all are farther apart [m^2].
  float (*least_squared)(const VertexComparison& vertices, float beyond);
  /// Returns the least of sixteen lower bounds of distances (PairBatch::at_least), at most one rounding lower [m].
  float (*least_distance)(const PairStencils& pairs, int first_side, const Record* positions);
  /// Lower bounds of sixteen distances, at most one rounding below PairBatch::at_least [m]; `out` holds sixteen.
  void (*lower_bounds)(const PairStencils& pairs, int first_side, const Record* positions, float* out);
  void (*distances)(const PairStencils& pairs, int first_side, const Record* positions, PairBatch& out);
  void (*paths)(const PairStencils& pairs, int first_side, const PairParticles& particles, const PairMotion& motion,
                PairPaths& out);
};

PLIANT_DECLARE_LEVELS(PairKernels, pair_kernels)
/// Those of the narrowest level of the build, which run wherever it does.
const PairKernels& base_pair_kernels();

/// Factor that covers the rounding of distance bounds.
inline constexpr float bound_slack = 1.0001f;

}  // namespace pliant
