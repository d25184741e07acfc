// Divides one body into clusters of neighbouring vertices.
#pragma once

#include <vector>

#include "collision/proxies/contact_elements.h"
#include "model/substep.h"

namespace pliant {

struct Clusters {
  int count = 0;
  std::vector<int> of;        ///< cluster of each vertex; -1: none
  std::vector<float> extent;  ///< for each cluster: the longest side of its bounding box [m]
};

/// Divides `elements.vertices` into compact clusters of at most 64.
Clusters find_clusters(const ContactElements& elements, const std::vector<Record>& positions);

}  // namespace pliant
