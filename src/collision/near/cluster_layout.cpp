#include "collision/near/cluster_layout.h"

#include <algorithm>

#include "collision/broad/morton.h"
#include "math/vector.h"

namespace pliant {

namespace {

/// Pads to a multiple of sixteen by repeating the last entry.
void pad(std::vector<std::int32_t>& list) {
  while (list.size() % 16 != 0) list.push_back(list.back());
}

/// Sorts the items of each body along a Morton curve through that body alone, so that no other body changes their order.
template <class Corner>
std::vector<int> order_by_body(const PairModel& model, const std::vector<std::int32_t>& items,
                               const std::vector<Vec3f>& middles, Corner corner) {
  std::vector<std::vector<int>> of_body(static_cast<std::size_t>(model.rules.bodies()));
  for (std::size_t i = 0; i < items.size(); ++i)
    of_body[static_cast<std::size_t>(model.vertex_body[corner(items[i], 0)])].push_back(static_cast<int>(i));
  std::vector<int> all, order;
  std::vector<Vec3f> places;
  for (const std::vector<int>& own : of_body) {
    places.clear();
    for (const int i : own) places.push_back(middles[i]);
    MortonSorter().sort(places, order);
    for (const int k : order) all.push_back(own[static_cast<std::size_t>(k)]);
  }
  return all;
}

ClusterElements lay_out_elements(const PairModel& model, ElementKind kind) {
  const ContactElements& from = model.elements;
  const int corners = kind == vertex_kind ? 1 : kind == edge_kind ? 2 : 3;
  const std::size_t size[3] = {from.vertices.size(), from.edges.size(), from.triangles.size()};
  const auto corner = [&](int item, int k) {
    return kind == vertex_kind ? item : kind == edge_kind ? from.edges[item][k] : from.triangles[item][k];
  };
  std::vector<std::int32_t> items(size[kind]);
  std::vector<Vec3f> middles(size[kind]);
  for (std::size_t i = 0; i < items.size(); ++i) {
    items[i] = kind == vertex_kind ? from.vertices[i] : static_cast<int>(i);
    for (int k = 0; k < corners; ++k) {
      const Record& x = model.rest[corner(items[i], k)];
      middles[i] += Vec3f{x.x, x.y, x.z};
    }
  }
  std::vector<std::vector<std::int32_t>> of_cluster(static_cast<std::size_t>(model.clusters));
  const std::vector<int>& cluster = kind == vertex_kind ? model.vertex_cluster
                                    : kind == edge_kind ? model.edge_cluster
                                                        : model.triangle_cluster;
  for (const int i : order_by_body(model, items, middles, corner))
    of_cluster[static_cast<std::size_t>(cluster[items[i]])].push_back(items[i]);
  ClusterElements to;
  to.corners = corners;
  to.start.push_back(0);
  for (std::vector<std::int32_t>& list : of_cluster) {
    to.count.push_back(static_cast<int>(list.size()));
    pad(list);
    to.item.insert(to.item.end(), list.begin(), list.end());
    to.start.push_back(static_cast<int>(to.item.size()));
  }
  for (const std::int32_t item : to.item)
    for (int k = 0; k < corners; ++k) to.corner[k].push_back(corner(item, k));
  return to;
}

void lay_out_vertices(ClusterLayout& layout, int clusters) {
  layout.vertex_start.assign(1, 0);
  for (int c = 0; c < clusters; ++c) {
    std::vector<std::int32_t> all;
    for (const ClusterElements& of : layout.elements)
      for (int k = 0; k < of.corners; ++k)
        all.insert(all.end(), of.corner[k].begin() + of.start[c], of.corner[k].begin() + of.start[c + 1]);
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    pad(all);
    layout.vertices.insert(layout.vertices.end(), all.begin(), all.end());
    layout.vertex_start.push_back(static_cast<int>(layout.vertices.size()));
  }
}

}  // namespace

ClusterLayout lay_out_clusters(const PairModel& model) {
  ClusterLayout layout;
  for (const ElementKind kind : {vertex_kind, edge_kind, triangle_kind})
    layout.elements[kind] = lay_out_elements(model, kind);
  lay_out_vertices(layout, model.clusters);
  return layout;
}

}  // namespace pliant
