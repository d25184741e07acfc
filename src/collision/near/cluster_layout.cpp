#include "collision/near/cluster_layout.h"

#include <algorithm>

#include "collision/broad/morton.h"
#include "math/vector.h"

namespace pliant {

namespace {

/// Pads a list to a multiple of sixteen by repeating its last entry.
void pad(std::vector<std::int32_t>& list) {
  while (list.size() % 16 != 0) list.push_back(list.back());
}

/// The primitives of one kind (vertices, edges or triangles) of a model.
struct Elements {
  const PairModel& model;
  ElementKind kind;

  int corner(int item, int k) const {
    if (kind == vertex_kind) return item;
    return kind == edge_kind ? model.elements.edges[item][k] : model.elements.triangles[item][k];
  }
  int cluster(int item) const {
    if (kind == vertex_kind) return model.shared->vertex_cluster[item];
    return kind == edge_kind ? model.edge_cluster[item] : model.triangle_cluster[item];
  }
  Block of(int body) const {
    const BodyElements& all = model.bodies.at(body);
    return kind == vertex_kind ? all.vertices : kind == edge_kind ? all.edges : all.triangles;
  }
};

/// Lists the primitives of a body by cluster. The Morton curve spans this body only, so the order depends on no other
/// body.
std::vector<std::vector<std::int32_t>> items_of(const Elements& from, int body, int corners) {
  std::vector<std::int32_t> items;
  std::vector<Vec3f> middles;
  const Block all = from.of(body);
  for (int item = all.first; item < all.end(); ++item) {
    if (from.cluster(item) < 0) continue;
    Vec3f middle{};
    for (int k = 0; k < corners; ++k) {
      const Record& x = from.model.shared->rest[from.corner(item, k)];
      middle += Vec3f{x.x, x.y, x.z};
    }
    items.push_back(item);
    middles.push_back(middle);
  }
  std::vector<int> order;
  MortonSorter().sort(middles, order);
  const Block clusters = from.model.bodies.at(body).clusters;
  std::vector<std::vector<std::int32_t>> of_cluster(static_cast<std::size_t>(clusters.size));
  for (const int i : order)
    of_cluster[static_cast<std::size_t>(from.cluster(items[i]) - clusters.first)].push_back(items[i]);
  return of_cluster;
}

void lay_out_elements(const Elements& from, int body, ClusterElements& to) {
  std::vector<std::vector<std::int32_t>> of_cluster = items_of(from, body, to.corners);
  const std::size_t clusters = from.model.cluster_body.size();
  to.start.resize(clusters);
  to.count.resize(clusters);
  const int first_cluster = from.model.bodies.at(body).clusters.first;
  std::vector<std::int32_t> items;
  for (std::size_t c = 0; c < of_cluster.size(); ++c) {
    to.start[first_cluster + c] = static_cast<int>(items.size());
    to.count[first_cluster + c] = static_cast<int>(of_cluster[c].size());
    pad(of_cluster[c]);
    items.insert(items.end(), of_cluster[c].begin(), of_cluster[c].end());
  }
  const int first = to.row_blocks.take(body, static_cast<int>(items.size())).first;
  for (std::size_t c = 0; c < of_cluster.size(); ++c) to.start[first_cluster + c] += first;
  to.item.resize(to.row_blocks.end());
  to.left_out_start.resize(to.row_blocks.end());
  std::copy(items.begin(), items.end(), to.item.begin() + first);
  for (int k = 0; k < to.corners; ++k) {
    to.corner[k].resize(to.row_blocks.end());
    for (std::size_t i = 0; i < items.size(); ++i) to.corner[k][first + i] = from.corner(items[i], k);
  }
}

void lay_out_vertices(const PairModel& model, int body, ClusterLayout& layout) {
  const Block clusters = model.bodies.at(body).clusters;
  layout.vertex_start.resize(model.cluster_body.size());
  layout.vertex_count.resize(model.cluster_body.size());
  std::vector<std::int32_t> together, all;
  for (int c = clusters.first; c < clusters.end(); ++c) {
    all.clear();
    for (const ClusterElements& of : layout.elements)
      for (int k = 0; k < of.corners; ++k)
        all.insert(all.end(), of.corner[k].begin() + of.start[c], of.corner[k].begin() + of.end(c));
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    pad(all);
    layout.vertex_start[c] = static_cast<int>(together.size());
    layout.vertex_count[c] = static_cast<int>(all.size());
    together.insert(together.end(), all.begin(), all.end());
  }
  const int first = layout.vertex_blocks.take(body, static_cast<int>(together.size())).first;
  for (int c = clusters.first; c < clusters.end(); ++c) layout.vertex_start[c] += first;
  layout.vertices.resize(layout.vertex_blocks.end());
  std::copy(together.begin(), together.end(), layout.vertices.begin() + first);
}

}  // namespace

ClusterLayout::ClusterLayout() {
  for (const ElementKind kind : {vertex_kind, edge_kind, triangle_kind}) elements[kind].corners = 1 + kind;
}

void ClusterLayout::add(const PairModel& model, int body) {
  for (const ElementKind kind : {vertex_kind, edge_kind, triangle_kind})
    lay_out_elements({model, kind}, body, elements[kind]);
  lay_out_vertices(model, body, *this);
}

void ClusterLayout::remove(int body, const Block& clusters) {
  for (ClusterElements& of : elements) {
    std::fill_n(of.count.begin() + clusters.first, clusters.size, 0);
    of.row_blocks.release(body);
    of.left_out_blocks.release(body);
  }
  std::fill_n(vertex_count.begin() + clusters.first, clusters.size, 0);
  vertex_blocks.release(body);
}

}  // namespace pliant
