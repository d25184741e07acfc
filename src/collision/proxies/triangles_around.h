// The triangles incident to each vertex.
#pragma once

#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "collision/proxies/body_blocks.h"
#include "collision/proxies/contact_elements.h"

namespace pliant {

/// For each vertex of a World the range of its triangles in TrianglesAround, in which it is.
struct VertexRanges {
  std::vector<int> first, last;
};

class TrianglesAround {
 public:
  /// `ranges` may be shared with others that have other vertices.
  explicit TrianglesAround(std::shared_ptr<VertexRanges> ranges) : ranges_(std::move(ranges)) {}

  /// Adds the triangles of one body. Their corners are in the block `vertices`.
  void add(const ContactElements& elements, const Block& triangles, const Block& vertices);

  /// The indices of the triangles at a vertex, ascending.
  const int* begin(int vertex) const { return numbers_.data() + ranges_->first[static_cast<std::size_t>(vertex)]; }
  const int* end(int vertex) const { return numbers_.data() + ranges_->last[static_cast<std::size_t>(vertex)]; }
  /// The other two corners of each of these triangles.
  const std::array<int, 2>* others(int vertex) const {
    return others_.data() + ranges_->first[static_cast<std::size_t>(vertex)];
  }

 private:
  std::shared_ptr<VertexRanges> ranges_;
  std::vector<int> numbers_;  ///< triangle indices by vertex; those of a body begin at 3 times its first triangle
  std::vector<std::array<int, 2>> others_;  ///< for each of numbers_
};

}  // namespace pliant
