#include "collision/near/static_pairs.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <tuple>

namespace pliant {

namespace {

/// Pairs at vertices with more neighbours are not static; they are found by search.
constexpr int most_neighbours = 24;

using Numbers = std::array<std::int32_t, 2>;

/// Lists the edges at each vertex of a body, ascending; vertices are numbered from the body's first one.
IntLists edges_around(const PairModel& model, const BodyElements& body) {
  IntLists out;
  out.start.assign(static_cast<std::size_t>(body.vertices.size) + 1, 0);
  const auto each = [&](auto visit) {
    for (int e = body.edges.first; e < body.edges.end(); ++e)
      for (const int v : model.elements.edges[e]) visit(e, static_cast<std::size_t>(v - body.vertices.first));
  };
  each([&](int, std::size_t v) { ++out.start[v + 1]; });
  for (std::size_t i = 1; i < out.start.size(); ++i) out.start[i] += out.start[i - 1];
  out.items.resize(static_cast<std::size_t>(out.start.back()));
  std::vector<int> next(out.start.begin(), out.start.end() - 1);
  each([&](int e, std::size_t v) { out.items[static_cast<std::size_t>(next[v]++)] = e; });
  return out;
}

/// Pairs of indices as one list of second indices for each first index, which is in the block `rows`.
struct Dealt {
  std::vector<int> start;
  std::vector<std::int32_t> second;

  Dealt(const std::vector<Numbers>& pairs, const Block& rows)
      : start(static_cast<std::size_t>(rows.size) + 2, 0), second(pairs.size()) {
    for (const Numbers& pair : pairs) ++start[static_cast<std::size_t>(pair[0] - rows.first) + 2];
    for (std::size_t i = 2; i < start.size(); ++i) start[i] += start[i - 1];
    for (const Numbers& pair : pairs) second[start[static_cast<std::size_t>(pair[0] - rows.first) + 1]++] = pair[1];
  }
  auto begin(int row) { return second.begin() + start[static_cast<std::size_t>(row)]; }
  auto end(int row) { return second.begin() + start[static_cast<std::size_t>(row) + 1]; }
};

/// Sorts pairs whose first indices are in `rows`, and drops duplicates. Lists of a row are short, so this beats one
/// sort.
void sort_unique(std::vector<Numbers>& list, const Block& rows) {
  Dealt dealt(list, rows);
  list.clear();
  for (int row = 0; row < rows.size; ++row) {
    std::sort(dealt.begin(row), dealt.end(row));
    const auto last = std::unique(dealt.begin(row), dealt.end(row));
    for (auto second = dealt.begin(row); second != last; ++second) list.push_back({rows.first + row, *second});
  }
}

bool share_vertex(const std::array<int, 2>& e, const std::array<int, 2>& f) {
  return e[0] == f[0] || e[0] == f[1] || e[1] == f[0] || e[1] == f[1];
}

/// Pairs of primitives that are mesh neighbours; [0]: vertex-triangle, [1]: edge-edge.
struct MeshPairs {
  std::vector<Numbers> near[2];     ///< pairs of primitives connected by one edge
  std::vector<Numbers> sharing[2];  ///< pairs with a common vertex
  std::vector<Numbers> joined;      ///< pairs of adjacent vertices
};

/// The elements incident to the vertices of one body.
struct Mesh {
  const PairModel& model;
  const BodyElements& body;
  IntLists edges_at = edges_around(model, body);

  const int* edges_begin(int v) const { return edges_at.begin(v - body.vertices.first); }
  const int* edges_end(int v) const { return edges_at.end(v - body.vertices.first); }
  bool has_few(int v) const { return edges_end(v) - edges_begin(v) <= most_neighbours; }
  int other_end(int edge, int v) const {
    const auto [a, b] = model.elements.edges[edge];
    return a == v ? b : a;
  }
};

/// Adds the pairs of a primitive at vertex v with a primitive at vertex u, where v-u is an edge.
void add_near(const Mesh& mesh, int v, int u, MeshPairs& out) {
  const ContactElements& all = mesh.model.elements;
  const TrianglesAround& around = mesh.model.triangles_around;
  out.joined.push_back({v, u});
  for (const int* t = around.begin(u); t != around.end(u); ++t) {
    const Triangle& c = all.triangles[*t];
    if (c[0] != v && c[1] != v && c[2] != v) out.near[0].push_back({v, *t});
  }
  for (const int* mine = mesh.edges_begin(v); mine != mesh.edges_end(v); ++mine)
    for (const int* other = mesh.edges_begin(u); other != mesh.edges_end(u); ++other)
      if (*mine < *other && !share_vertex(all.edges[*mine], all.edges[*other])) out.near[1].push_back({*mine, *other});
}

MeshPairs find_mesh_pairs(const PairModel& model, int body) {
  MeshPairs out;
  if (!model.shared->rules.meet(body, body)) return out;
  const Mesh mesh{model, model.bodies.at(body)};
  const TrianglesAround& around = model.triangles_around;
  for (int v = mesh.body.vertices.first; v < mesh.body.vertices.end(); ++v) {
    if (model.shared->vertex_cluster[v] < 0 || !mesh.has_few(v)) continue;
    for (const int* t = around.begin(v); t != around.end(v); ++t) out.sharing[0].push_back({v, *t});
    for (const int* e = mesh.edges_begin(v); e != mesh.edges_end(v); ++e) {
      for (const int* f = mesh.edges_begin(v); f != mesh.edges_end(v); ++f) out.sharing[1].push_back({*e, *f});
      if (const int u = mesh.other_end(*e, v); mesh.has_few(u)) add_near(mesh, v, u, out);
    }
  }
  return out;
}

/// For each primitive of a body its row or column in the SIMD layout, -1 if it has none; indexed from the block's
/// first.
std::vector<std::int32_t> places_of(const ClusterElements& of, const Block& clusters, const Block& items) {
  std::vector<std::int32_t> at(static_cast<std::size_t>(items.size), -1);
  for (int c = clusters.first; c < clusters.end(); ++c)
    for (int i = of.start[c]; i < of.start[c] + of.count[c]; ++i) at[of.item[i] - items.first] = i;
  return at;
}

/// Sets the columns that the rows of a body exclude: for each row and batch of sixteen columns, a word of bits.
void leave_out(ClusterLayout& layout, const PairModel& model, int body, bool of_vertices, std::vector<Numbers>& pairs) {
  const BodyElements& all = model.bodies.at(body);
  ClusterElements &rows = layout.elements[row_kind(of_vertices)], &columns = layout.elements[column_kind(of_vertices)];
  const Block of_rows = of_vertices ? all.vertices : all.edges, of_columns = of_vertices ? all.triangles : all.edges;
  const std::vector<std::int32_t> row_at = places_of(rows, all.clusters, of_rows),
                                  column_at = places_of(columns, all.clusters, of_columns);
  for (Numbers& pair : pairs) pair = {row_at[pair[0] - of_rows.first], column_at[pair[1] - of_columns.first]};
  const Block block = rows.row_blocks[body];
  Dealt dealt(pairs, block);
  std::vector<LeftOut> own;
  for (int row = 0; row < block.size; ++row) {
    const std::size_t start = own.size();
    rows.left_out_start[block.first + row] = static_cast<std::int32_t>(start);
    for (auto column = dealt.begin(row); column != dealt.end(row); ++column) {
      std::size_t at = start;
      while (at < own.size() && own[at].batch != *column / 16) ++at;
      if (at == own.size()) own.push_back({*column / 16, 0});
      own[at].bits |= 1U << (*column % 16);
    }
    std::sort(own.begin() + static_cast<std::ptrdiff_t>(start), own.end(),
              [](const LeftOut& x, const LeftOut& y) { return x.batch < y.batch; });
    own.push_back({std::numeric_limits<std::int32_t>::max(), 0});
  }
  const int first = rows.left_out_blocks.take(body, static_cast<int>(own.size())).first;
  rows.left_out.resize(rows.left_out_blocks.end());
  std::copy(own.begin(), own.end(), rows.left_out.begin() + first);
  for (int row = block.first; row < block.end(); ++row) rows.left_out_start[row] += first;
}

/// Appends a group of static pairs in blocks of sixteen, nearest at rest first, so that often measured pairs share
/// blocks.
void add_group(StaticGroup group, const std::vector<PairStencil>& pairs, const PairModel& model,
               std::vector<StaticGroup>& to) {
  std::vector<std::pair<double, std::size_t>> order;
  order.reserve(pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i)
    order.emplace_back(pair_distance(pairs[i], model.shared->rest.data()).distance, i);
  std::sort(order.begin(), order.end());
  group.pairs = static_cast<int>(pairs.size());
  group.blocks.resize((order.size() + 15) / 16);
  group.value.assign(group.blocks.size(), not_measured);
  for (std::size_t i = 0; i < 16 * group.blocks.size(); ++i)
    for (int k = 0; k < 4; ++k)
      group.blocks[i / 16].vertex[k][i % 16] = pairs[order[std::min(i, order.size() - 1)].second].vertex[k];
  to.push_back(std::move(group));
}

/// Sorts static pairs into one group for each two clusters.
void add_groups(const PairModel& model, bool of_vertices, const std::vector<Numbers>& pairs,
                std::vector<StaticGroup>& to) {
  struct Placed {
    int first, second;
    PairStencil four;
  };
  std::vector<Placed> placed;
  placed.reserve(pairs.size());
  for (const Numbers& p : pairs) {
    int first = of_vertices ? model.shared->vertex_cluster[p[0]] : model.edge_cluster[p[0]],
        second = of_vertices ? model.triangle_cluster[p[1]] : model.edge_cluster[p[1]];
    if (!of_vertices && first > second) std::swap(first, second);
    placed.push_back({first, second, stencil_of(model.elements, of_vertices, p[0], p[1])});
  }
  const auto is_before = [](const Placed& x, const Placed& y) {
    return std::tie(x.first, x.second) < std::tie(y.first, y.second);
  };
  if (!std::is_sorted(placed.begin(), placed.end(), is_before))
    std::stable_sort(placed.begin(), placed.end(), is_before);
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

/// Converts the clusters of a body to pieces for Clearance.
std::vector<Clearance::Piece> clearance_pieces(const ClusterLayout& layout, const Block& clusters) {
  std::vector<Clearance::Piece> pieces(static_cast<std::size_t>(clusters.size));
  for (int c = clusters.first; c < clusters.end(); ++c) {
    Clearance::Piece& piece = pieces[static_cast<std::size_t>(c - clusters.first)];
    const auto first = layout.vertices.begin() + layout.vertex_start[c];
    piece.vertices.assign(first, first + layout.vertex_count[c]);
    for (const ElementKind kind : {edge_kind, triangle_kind}) {
      const ClusterElements& of = layout.elements[kind];
      for (int i = of.start[c]; i < of.start[c] + of.count[c]; ++i)
        for (int k = 0; k < (kind == edge_kind ? 1 : 3); ++k) {
          const auto [a, b] = std::minmax(of.corner[k][i], of.corner[(k + 1) % of.corners][i]);
          piece.lines.push_back({a, b});
        }
    }
    std::sort(piece.lines.begin(), piece.lines.end());
    piece.lines.erase(std::unique(piece.lines.begin(), piece.lines.end()), piece.lines.end());
  }
  return pieces;
}

void add_pairs_of(const PairModel& model, int body, ClusterLayout& layout, std::vector<StaticGroup>& groups,
                  Clearance& clearance) {
  const BodyElements& all = model.bodies.at(body);
  MeshPairs pairs = find_mesh_pairs(model, body);
  for (const bool of_vertices : {true, false}) {
    std::vector<Numbers>&near = pairs.near[of_vertices ? 0 : 1], &sharing = pairs.sharing[of_vertices ? 0 : 1];
    sort_unique(near, of_vertices ? all.vertices : all.edges);
    add_groups(model, of_vertices, near, groups);
    sharing.insert(sharing.end(), near.begin(), near.end());
    if (!of_vertices)
      for (const Numbers& pair : near) sharing.push_back({pair[1], pair[0]});
    leave_out(layout, model, body, of_vertices, sharing);
  }
  if (!model.shared->rules.meet(body, body)) return;
  clearance.add(body, all.clusters.first, clearance_pieces(layout, all.clusters), model.shared->rest, all.vertices,
                pairs.joined);
}

}  // namespace

void StaticGroup::rebase(const Odometer& odometer) {
  const float spent = least.spent(odometer);
  for (float& bound : value) bound -= spent + 1e-6f * (abs(bound) + spent);
  least.since = odometer.total;
}

void StaticGroup::forget() {
  least.value = not_measured;
  std::fill(value.begin(), value.end(), not_measured);
}

void StaticPairs::remove(const std::vector<char>& is_removed) {
  std::erase_if(groups, [&](const StaticGroup& group) {
    if (is_removed[group.first] == 0) return false;
    count -= group.pairs;
    return true;
  });
}

PairStencil stencil_of(const ContactElements& elements, bool of_vertices, std::int32_t a, std::int32_t b) {
  if (of_vertices) {
    const Triangle& t = elements.triangles[b];
    return {{a, t[0], t[1], t[2]}, 1};
  }
  const auto &e = elements.edges[a], &f = elements.edges[b];
  return {{e[0], e[1], f[0], f[1]}, 2};
}

void add_static_pairs(const PairModel& model, const std::vector<int>& bodies, ClusterLayout& layout, StaticPairs& to,
                      Clearance& clearance) {
  std::vector<StaticGroup> added;
  for (const int body : bodies) add_pairs_of(model, body, layout, added, clearance);
  for (const StaticGroup& group : added) to.count += group.pairs;
  const auto is_before = [&](const StaticGroup& x, const StaticGroup& y) {
    return std::tuple(!x.of_vertices, model.key_of(x.first), model.key_of(x.second)) <
           std::tuple(!y.of_vertices, model.key_of(y.first), model.key_of(y.second));
  };
  std::sort(added.begin(), added.end(), is_before);
  std::vector<StaticGroup> merged;
  merged.reserve(to.groups.size() + added.size());
  std::merge(std::make_move_iterator(to.groups.begin()), std::make_move_iterator(to.groups.end()),
             std::make_move_iterator(added.begin()), std::make_move_iterator(added.end()), std::back_inserter(merged),
             is_before);
  to.groups = std::move(merged);
}

}  // namespace pliant
