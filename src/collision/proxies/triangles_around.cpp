#include "collision/proxies/triangles_around.h"

#include <algorithm>

namespace pliant {

void TrianglesAround::add(const ContactElements& elements, const Block& triangles, const Block& vertices) {
  std::vector<int>&first = ranges_->first, &last = ranges_->last;
  const auto count = std::max(first.size(), static_cast<std::size_t>(elements.vertex_count));
  first.resize(count);
  last.resize(count);
  numbers_.resize(3 * elements.triangles.size());
  others_.resize(numbers_.size());
  std::fill_n(last.begin() + vertices.first, vertices.size, 0);
  for (int t = triangles.first; t < triangles.end(); ++t)
    for (const int v : elements.triangles[static_cast<std::size_t>(t)]) ++last[static_cast<std::size_t>(v)];
  int next = 3 * triangles.first;
  for (int v = vertices.first; v < vertices.end(); ++v) {
    const auto at = static_cast<std::size_t>(v);
    first[at] = next;
    next += last[at];
    last[at] = first[at];
  }
  for (int t = triangles.first; t < triangles.end(); ++t) {
    const Triangle& corners = elements.triangles[static_cast<std::size_t>(t)];
    for (std::size_t i = 0; i < 3; ++i) {
      const auto place = static_cast<std::size_t>(last[static_cast<std::size_t>(corners[i])]++);
      numbers_[place] = t;
      others_[place] = {corners[(i + 1) % 3], corners[(i + 2) % 3]};
    }
  }
}

}  // namespace pliant
