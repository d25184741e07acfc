#include "collision/untangle/parts.h"

#include <algorithm>
#include <numeric>

namespace pliant {

namespace {

/// Disjoint sets of vertices (union-find). The root of each set is its lowest vertex.
struct Sets {
  std::vector<int> parent;

  explicit Sets(std::size_t count) : parent(count) { std::iota(parent.begin(), parent.end(), 0); }

  int& of(int v) { return parent[static_cast<std::size_t>(v)]; }
  int root(int v) {
    while (of(v) != v) v = of(v) = of(of(v));
    return v;
  }
  void join(int a, int b) {
    const int from = root(a), to = root(b);
    of(std::max(from, to)) = std::min(from, to);
  }
};

}  // namespace

Parts find_parts(const PairModel& model) {
  const auto body_of = [&](int v) { return model.shared->vertex_body[static_cast<std::size_t>(v)]; };
  const auto vertices = static_cast<int>(model.shared->rest.size());
  Sets sets(model.shared->rest.size());
  for (const auto& [a, b] : model.elements.edges) sets.join(a, b);
  for (int v = 1; v < vertices; ++v)
    if (body_of(v) >= 0 && body_of(v) == body_of(v - 1) && model.shared->rules.is_immovable(body_of(v)))
      sets.join(v - 1, v);
  Parts parts;
  parts.of.resize(model.shared->rest.size());
  for (int v = 0; v < vertices; ++v) {
    const int root = sets.root(v);
    parts.of[static_cast<std::size_t>(v)] = root == v ? parts.count++ : parts.of[static_cast<std::size_t>(root)];
  }
  return parts;
}

}  // namespace pliant
