#include "collision/near/static_pairs.h"

#include <algorithm>
#include <array>
#include <limits>
#include <tuple>

namespace pliant {

namespace {

/// Vertices with more neighbours have no static pairs; pairs near them are found by search.
constexpr int most_neighbours = 24;

using Numbers = std::array<std::int32_t, 2>;

/// The elements incident to each vertex, ascending.
template <class ListOfCorners>
IntLists elements_around(const ListOfCorners& elements, int vertex_count) {
  IntLists out;
  out.start.assign(static_cast<std::size_t>(vertex_count) + 1, 0);
  for (const auto& corners : elements)
    for (const int v : corners) ++out.start[static_cast<std::size_t>(v) + 1];
  for (std::size_t i = 1; i < out.start.size(); ++i) out.start[i] += out.start[i - 1];
  out.items.resize(static_cast<std::size_t>(out.start.back()));
  std::vector<int> next(out.start.begin(), out.start.end() - 1);
  for (std::size_t e = 0; e < elements.size(); ++e)
    for (const int v : elements[e]) out.items[static_cast<std::size_t>(next[v]++)] = static_cast<int>(e);
  return out;
}

int count_of(const IntLists& lists, int i) { return static_cast<int>(lists.end(i) - lists.begin(i)); }

/// Packed into one integer, which compares faster; both numbers are >= 0.
std::uint64_t key(const Numbers& pair) {
  return (static_cast<std::uint64_t>(pair[0]) << 32) | static_cast<std::uint64_t>(pair[1]);
}

void sort_unique(std::vector<Numbers>& list) {
  std::sort(list.begin(), list.end(), [](const Numbers& x, const Numbers& y) { return key(x) < key(y); });
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

bool share_vertex(const std::array<int, 2>& e, const std::array<int, 2>& f) {
  return e[0] == f[0] || e[0] == f[1] || e[1] == f[0] || e[1] == f[1];
}

/// Pairs by kind: vertex-triangle and edge-edge.
struct MeshPairs {
  std::vector<Numbers> near[2];     ///< connected by one edge
  std::vector<Numbers> sharing[2];  ///< with a common vertex
  std::vector<Numbers> joined;      ///< adjacent vertices
};

/// The elements incident to the vertices of one mesh.
struct Mesh {
  const ContactElements& all;
  IntLists edges_at = elements_around(all.edges, all.vertex_count),
           triangles_at = elements_around(all.triangles, all.vertex_count);

  bool has_few(int v) const { return count_of(edges_at, v) <= most_neighbours; }
  int other_end(int edge, int v) const { return all.edges[edge][0] == v ? all.edges[edge][1] : all.edges[edge][0]; }
};

/// Adds the pairs of an element at v and one at u, where v-u is an edge.
void add_near(const Mesh& mesh, int v, int u, MeshPairs& out) {
  const ContactElements& all = mesh.all;
  out.joined.push_back({v, u});
  for (const int* t = mesh.triangles_at.begin(u); t != mesh.triangles_at.end(u); ++t) {
    const Triangle& c = all.triangles[*t];
    if (c[0] != v && c[1] != v && c[2] != v) out.near[0].push_back({v, *t});
  }
  for (const int* mine = mesh.edges_at.begin(v); mine != mesh.edges_at.end(v); ++mine)
    for (const int* other = mesh.edges_at.begin(u); other != mesh.edges_at.end(u); ++other)
      if (*mine < *other && !share_vertex(all.edges[*mine], all.edges[*other])) out.near[1].push_back({*mine, *other});
}

MeshPairs find_mesh_pairs(const PairModel& model) {
  const Mesh mesh{model.elements};
  MeshPairs out;
  for (const int v : model.elements.vertices) {
    if (!model.rules.meet(model.vertex_body[v], model.vertex_body[v]) || !mesh.has_few(v)) continue;
    for (const int* t = mesh.triangles_at.begin(v); t != mesh.triangles_at.end(v); ++t) out.sharing[0].push_back({v, *t});
    for (const int* e = mesh.edges_at.begin(v); e != mesh.edges_at.end(v); ++e) {
      for (const int* f = mesh.edges_at.begin(v); f != mesh.edges_at.end(v); ++f) out.sharing[1].push_back({*e, *f});
      if (const int u = mesh.other_end(*e, v); mesh.has_few(u)) add_near(mesh, v, u, out);
    }
  }
  return out;
}

/// The row or column of each primitive in its layout; -1 if it has none.
std::vector<std::int32_t> places_of(const ClusterElements& of, std::size_t items) {
  std::vector<std::int32_t> at(items, -1);
  for (std::size_t c = 0; c < of.count.size(); ++c)
    for (int i = of.start[c]; i < of.start[c] + of.count[c]; ++i) at[of.item[i]] = i;
  return at;
}

/// The columns that each row excludes, sixteen per word.
void leave_out(ClusterLayout& layout, const PairModel& model, bool of_vertices, std::vector<Numbers>& pairs) {
  ClusterElements &rows = layout.elements[row_kind(of_vertices)], &columns = layout.elements[column_kind(of_vertices)];
  const std::vector<std::int32_t> row_at = places_of(rows, of_vertices ? model.rest.size() : rows.item.size()),
                                  column_at = places_of(columns, columns.item.size());
  for (Numbers& pair : pairs) pair = {row_at[pair[0]], column_at[pair[1]]};
  sort_unique(pairs);
  std::size_t next = 0;
  for (std::int32_t row = 0; row < static_cast<std::int32_t>(rows.item.size()); ++row) {
    rows.left_out_start.push_back(static_cast<std::int32_t>(rows.left_out.size()));
    for (; next < pairs.size() && pairs[next][0] == row; ++next) {
      const std::int32_t batch = pairs[next][1] / 16;
      const bool begins = rows.left_out_start.back() == static_cast<std::int32_t>(rows.left_out.size());
      if (begins || rows.left_out.back().batch != batch) rows.left_out.push_back({batch, 0});
      rows.left_out.back().bits |= 1U << (pairs[next][1] % 16);
    }
    rows.left_out.push_back({std::numeric_limits<std::int32_t>::max(), 0});
  }
}

/// Appends a group's pairs in blocks of sixteen, nearest at rest first, so that often measured pairs share blocks.
void add_group(StaticGroup group, const std::vector<PairStencil>& pairs, const PairModel& model, StaticPairs& to) {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < pairs.size(); ++i) order.emplace_back(pair_distance(pairs[i], model.rest.data()).distance, i);
  std::sort(order.begin(), order.end());
  group.first_block = static_cast<int>(to.blocks.size());
  group.pairs = static_cast<int>(pairs.size());
  to.count += group.pairs;
  for (std::size_t i = 0; i < order.size(); i += 16) {
    to.blocks.emplace_back();
    to.value.push_back(not_measured);
    for (std::size_t lane = 0; lane < 16; ++lane)
      for (int k = 0; k < 4; ++k)
        to.blocks.back().vertex[k][lane] = pairs[order[std::min(i + lane, order.size() - 1)].second].vertex[k];
  }
  group.last_block = static_cast<int>(to.blocks.size());
  to.groups.push_back(group);
}

/// Groups pairs by their clusters.
void add_groups(const PairModel& model, bool of_vertices, const std::vector<Numbers>& pairs, StaticPairs& to) {
  struct Placed {
    int first, second;
    PairStencil four;
  };
  std::vector<Placed> placed;
  for (const Numbers& p : pairs) {
    int first = of_vertices ? model.vertex_cluster[p[0]] : model.edge_cluster[p[0]],
        second = of_vertices ? model.triangle_cluster[p[1]] : model.edge_cluster[p[1]];
    if (!of_vertices && first > second) std::swap(first, second);
    placed.push_back({first, second, stencil_of(model.elements, of_vertices, p[0], p[1])});
  }
  std::stable_sort(placed.begin(), placed.end(), [](const Placed& x, const Placed& y) {
    return std::tie(x.first, x.second) < std::tie(y.first, y.second);
  });
  std::vector<PairStencil> together;
  for (std::size_t i = 0; i < placed.size(); ++i) {
    const Placed& p = placed[i];
    together.push_back(p.four);
    if (i + 1 < placed.size() && p.first == placed[i + 1].first && p.second == placed[i + 1].second) continue;
    StaticGroup group;
    group.first = p.first;
    group.second = p.second;
    group.of_vertices = of_vertices;
    add_group(group, together, model, to);
    together.clear();
  }
}

}  // namespace

void StaticPairs::rebase(StaticGroup& group, const Odometer& odometer) {
  const float spent = group.least.spent(odometer);
  for (int b = group.first_block; b < group.last_block; ++b) value[b] -= spent + 1e-6f * (abs(value[b]) + spent);
  group.least.since = odometer.total;
}

PairStencil stencil_of(const ContactElements& elements, bool of_vertices, std::int32_t a, std::int32_t b) {
  if (of_vertices) {
    const Triangle& t = elements.triangles[b];
    return {{a, t[0], t[1], t[2]}, 1};
  }
  const auto &e = elements.edges[a], &f = elements.edges[b];
  return {{e[0], e[1], f[0], f[1]}, 2};
}

StaticPairs find_static_pairs(const PairModel& model, ClusterLayout& layout, std::vector<Clearance::Line>& joined) {
  MeshPairs pairs = find_mesh_pairs(model);
  StaticPairs out;
  for (const bool of_vertices : {true, false}) {
    std::vector<Numbers>&near = pairs.near[of_vertices ? 0 : 1], &sharing = pairs.sharing[of_vertices ? 0 : 1];
    sort_unique(near);
    add_groups(model, of_vertices, near, out);
    sharing.insert(sharing.end(), near.begin(), near.end());
    if (!of_vertices)
      for (const Numbers& pair : near) sharing.push_back({pair[1], pair[0]});
    leave_out(layout, model, of_vertices, sharing);
  }
  joined = std::move(pairs.joined);
  return out;
}

std::vector<Clearance::Piece> clearance_pieces(const PairModel& model, const ClusterLayout& layout) {
  std::vector<Clearance::Piece> pieces(static_cast<std::size_t>(model.clusters));
  for (int c = 0; c < model.clusters; ++c) {
    Clearance::Piece& piece = pieces[static_cast<std::size_t>(c)];
    piece.vertices.assign(layout.vertices.begin() + layout.vertex_start[c],
                          layout.vertices.begin() + layout.vertex_start[c + 1]);
    for (const ElementKind kind : {edge_kind, triangle_kind}) {
      const ClusterElements& of = layout.elements[kind];
      for (int i = of.start[c]; i < of.start[c] + of.count[c]; ++i)
        for (int k = 0; k < (kind == edge_kind ? 1 : 3); ++k) {
          const auto [a, b] = std::minmax(of.corner[k][i], of.corner[(k + 1) % of.corners][i]);
          piece.lines.push_back({a, b});
        }
    }
    sort_unique(piece.lines);
  }
  return pieces;
}

}  // namespace pliant
