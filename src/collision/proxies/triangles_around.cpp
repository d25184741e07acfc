#include "collision/proxies/triangles_around.h"

namespace pliant {

IntLists triangles_around(const ContactElements& elements) {
  IntLists out;
  out.start.assign(static_cast<std::size_t>(elements.vertex_count) + 1, 0);
  for (const Triangle& t : elements.triangles)
    for (const int v : t) ++out.start[static_cast<std::size_t>(v) + 1];
  for (std::size_t i = 1; i < out.start.size(); ++i) out.start[i] += out.start[i - 1];
  out.items.resize(3 * elements.triangles.size());
  std::vector<int> next(out.start.begin(), out.start.end() - 1);
  for (std::size_t t = 0; t < elements.triangles.size(); ++t)
    for (const int v : elements.triangles[t]) out.items[next[v]++] = static_cast<int>(t);
  return out;
}

}  // namespace pliant
