// Divides one body into clusters of neighbouring vertices.
#pragma once

#include <vector>

#include "collision/proxies/contact_elements.h"
#include "model/substep.h"

namespace pliant {

struct Clusters {
  int count = 0;
  std::vector<int> of;        ///< cluster of each vertex; -1: no cluster
  std::vector<float> extent;  ///< longest side of each cluster's bounding box [m]
};

/// Divides `elements.vertices` into compact clusters of at most 64 vertices.
Clusters find_clusters(const ContactElements& elements, const std::vector<Record>& positions);

}  // namespace pliant
