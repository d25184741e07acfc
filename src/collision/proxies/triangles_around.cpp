#include "collision/proxies/triangles_around.h"

#include <algorithm>

namespace pliant {

void TrianglesAround::add(const ContactElements& elements, const Block& triangles, const Block& vertices) {
  first_.resize(static_cast<std::size_t>(elements.vertex_count));
  last_.resize(first_.size());
  numbers_.resize(3 * elements.triangles.size());
  std::fill_n(last_.begin() + vertices.first, vertices.size, 0);
  for (int t = triangles.first; t < triangles.end(); ++t)
    for (const int v : elements.triangles[static_cast<std::size_t>(t)]) ++last_[static_cast<std::size_t>(v)];
  int next = 3 * triangles.first;
  for (int v = vertices.first; v < vertices.end(); ++v) {
    const auto at = static_cast<std::size_t>(v);
    first_[at] = next;
    next += last_[at];
    last_[at] = first_[at];
  }
  for (int t = triangles.first; t < triangles.end(); ++t)
    for (const int v : elements.triangles[static_cast<std::size_t>(t)])
      numbers_[static_cast<std::size_t>(last_[static_cast<std::size_t>(v)]++)] = t;
}

}  // namespace pliant
