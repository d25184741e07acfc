// Shape matching: groups of particles that keep their shape.
#pragma once

#include <optional>
#include <vector>

#include "pliant/scene.h"

namespace pliant {

/// Options of add_cluster and add_clusters.
struct ClusterOptions {
  Cluster::Mode mode = Cluster::Mode::rigid;
  float share = 0.8f;  ///< Cluster::share
  Stiffness stiffness{};
  std::optional<Plasticity> plasticity{};  ///< Cluster::plasticity
};

/// Makes the given particles of an object keep the shape in which they are, which is then the rest shape. Throws an
/// Error if a particle does not exist or is named twice, or if there are fewer than two.
void add_cluster(Object& object, const std::vector<int>& particles, const ClusterOptions& options = {});

/// Divides all particles of an object into overlapping clusters: one for each cell of a cubic grid of side `size` [m],
/// with the particles of its cell and of half a cell around. The body as a whole bends and twists then, the more the
/// smaller `size` is. Cells of fewer than four particles have none of their own. Throws an Error if `size` is not
/// positive, or so small that a particle would be in no cluster.
void add_clusters(Object& object, float size, const ClusterOptions& options = {});

}  // namespace pliant
