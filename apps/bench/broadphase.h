// What the broad phases cost, one beside the other: the spatial hash and the hierarchies over each volume, on things that
// deform; and the rate of continuous tests. `pliant bench broadphase` and `pliant bench ccd` print it.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace pliant::bench {

/// One broad phase on one input; medians over frames. Processor time of one thread; where there are more, elapsed time.
struct BroadPhaseRow {
  std::string input;  ///< "cloth", "rolled cloth", "sphere"
  int triangles = 0;
  std::string method;
  double build_ms = 0;  ///< from nothing
  double refit_ms = 0;  ///< to a frame's positions; of the hash: filling it anew
  double query_ms = 0;  ///< all pairs
  double pairs = 0;     ///< pairs of triangles whose volumes overlap; of candidates: vertex-triangle and edge-edge pairs
};

struct BroadPhaseOptions {
  std::vector<int> sizes{64, 128};  ///< vertices along a side of the cloths; the sphere has as many triangles or fewer
  int frames = 20;
  int threads = 0;  ///< of the candidates' second row; 0: all
  std::function<void(const BroadPhaseRow&)> on_row;
};

/// Throws Error where a size is out of 2..4096 or there are no frames.
std::vector<BroadPhaseRow> measure_broad_phases(const BroadPhaseOptions& options);

/// A continuous test's rate on one kind of query.
struct ImpactRow {
  std::string test, queries;  ///< "vertex-triangle", "edge-edge"; what sort of motion
  std::string precision;      ///< "float", "double", "undecided" (double without a second look)
  double million_per_second = 0;
  double hits = 0;  ///< share of the queries
};

/// Random queries, one thread; by processor time.
std::vector<ImpactRow> measure_impacts();

std::string to_json(const std::vector<BroadPhaseRow>& rows);
std::string to_json(const std::vector<ImpactRow>& rows);

}  // namespace pliant::bench
