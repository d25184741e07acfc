// The triangles incident to each vertex.
#pragma once

#include "collision/proxies/body_blocks.h"
#include "collision/proxies/contact_elements.h"

namespace pliant {

class TrianglesAround {
 public:
  /// Adds the triangles of one body. Their corners are in the block `vertices`.
  void add(const ContactElements& elements, const Block& triangles, const Block& vertices);

  /// The indices of the triangles at a vertex, ascending.
  const int* begin(int vertex) const { return numbers_.data() + first_[static_cast<std::size_t>(vertex)]; }
  const int* end(int vertex) const { return numbers_.data() + last_[static_cast<std::size_t>(vertex)]; }

 private:
  std::vector<int> first_, last_;  ///< range of each vertex in `numbers_`
  std::vector<int> numbers_;       ///< triangle indices by vertex; those of a body begin at 3 times its first triangle
};

}  // namespace pliant
