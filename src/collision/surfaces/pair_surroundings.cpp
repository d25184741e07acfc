// What lies together on a surface, once for all: elements by cluster, and the pairs that are near one another in the mesh.
//
// Most of what is near a piece of cloth is the cloth around it. Those pairs never change, so nothing looks for them: they have
// buckets of their own, and whoever looks for others leaves them out sixteen at a time.
#include <algorithm>
#include <array>
#include <tuple>

#include "collision/surfaces/pair_bounds.h"

namespace pliant {

namespace {

/// Vertices of more neighbours than this have no surroundings: what is near them is looked for like anything else.
constexpr int most_neighbours = 24;

using Numbers = std::array<std::int32_t, 2>;

/// For each vertex the elements at it, ascending.
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

/// As one number, which compares faster; neither is negative.
std::uint64_t key(const Numbers& pair) {
  return (static_cast<std::uint64_t>(pair[0]) << 32) | static_cast<std::uint64_t>(pair[1]);
}
std::int32_t key(std::int32_t number) { return number; }

template <class T>
void sort_out(std::vector<T>& list) {
  std::sort(list.begin(), list.end(), [](const T& x, const T& y) { return key(x) < key(y); });
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

/// Fills up to a multiple of sixteen by repeating the last.
void fill_up(std::vector<std::int32_t>& list) {
  while (list.size() % 16 != 0) list.push_back(list.back());
}

bool share_vertex(const std::array<int, 2>& e, const std::array<int, 2>& f) {
  return e[0] == f[0] || e[0] == f[1] || e[1] == f[0] || e[1] == f[1];
}

}  // namespace

/// Elements of a kind, along a curve through the middles of each cluster's, so that sixteen that follow one another lie together.
void PairSystem::lay_out_elements(Kind kind, int corners) {
  const ContactElements& from = model_.elements;
  const std::size_t size[3] = {from.vertices.size(), from.edges.size(), from.triangles.size()};
  const auto corner = [&](int item, int k) {
    return kind == vertex_kind ? item : kind == edge_kind ? from.edges[item][k] : from.triangles[item][k];
  };
  std::vector<std::int32_t> items(size[kind]);
  std::vector<Vec3f> middles(size[kind]);
  for (std::size_t i = 0; i < items.size(); ++i) {
    items[i] = kind == vertex_kind ? from.vertices[i] : static_cast<int>(i);
    for (int k = 0; k < corners; ++k) {
      const Record& x = model_.rest[corner(items[i], k)];
      middles[i] += Vec3f{x.x, x.y, x.z};
    }
  }
  std::vector<int> order;
  MortonSorter().sort(middles, order);
  std::vector<std::vector<std::int32_t>> of_cluster(static_cast<std::size_t>(model_.clusters));
  const std::vector<int>& cluster = kind == vertex_kind ? model_.vertex_cluster
                                    : kind == edge_kind ? model_.edge_cluster
                                                        : model_.triangle_cluster;
  for (const int i : order) of_cluster[static_cast<std::size_t>(cluster[items[i]])].push_back(items[i]);
  Elements& to = elements_[kind];
  to.corners = corners;
  to.start.push_back(0);
  for (std::vector<std::int32_t>& list : of_cluster) {
    to.count.push_back(static_cast<int>(list.size()));
    fill_up(list);
    to.item.insert(to.item.end(), list.begin(), list.end());
    to.start.push_back(static_cast<int>(to.item.size()));
  }
  for (const std::int32_t item : to.item)
    for (int k = 0; k < corners; ++k) to.corner[k].push_back(corner(item, k));
  for (std::vector<float>& row : to.box) row.resize(to.item.size());
  to.batch_box.resize(to.item.size() / 16);
  wanted_[kind].resize(of_cluster.size());
}

/// For each cluster its vertices and the corners of all that begins at them.
void PairSystem::lay_out_vertices() {
  cluster_start_.assign(1, 0);
  for (int c = 0; c < model_.clusters; ++c) {
    std::vector<std::int32_t> all;
    for (const Elements& of : elements_)
      for (int k = 0; k < of.corners; ++k)
        all.insert(all.end(), of.corner[k].begin() + of.start[c], of.corner[k].begin() + of.start[c + 1]);
    sort_out(all);
    fill_up(all);
    cluster_vertices_.insert(cluster_vertices_.end(), all.begin(), all.end());
    cluster_start_.push_back(static_cast<int>(cluster_vertices_.size()));
  }
}

/// Pairs with an edge of the mesh between them.
void PairSystem::find_surroundings() {
  const ContactElements& all = model_.elements;
  const IntLists edges_at = elements_around(all.edges, all.vertex_count),
                 triangles_at = elements_around(all.triangles, all.vertex_count);
  const auto meets_itself = [&](int v) {
    return model_.meets[static_cast<std::size_t>(model_.vertex_body[v]) * model_.bodies + model_.vertex_body[v]] != 0;
  };
  const auto other_end = [&](int edge, int v) { return all.edges[edge][0] == v ? all.edges[edge][1] : all.edges[edge][0]; };
  const auto few = [&](int v) { return count_of(edges_at, v) <= most_neighbours; };
  std::vector<Numbers> near[2], sharing[2], joined;
  for (const int v : all.vertices) {
    if (!meets_itself(v) || !few(v)) continue;
    for (const int* t = triangles_at.begin(v); t != triangles_at.end(v); ++t) sharing[0].push_back({v, *t});
    for (const int* e = edges_at.begin(v); e != edges_at.end(v); ++e) {
      const int u = other_end(*e, v);
      for (const int* f = edges_at.begin(v); f != edges_at.end(v); ++f) sharing[1].push_back({*e, *f});
      if (!few(u)) continue;
      joined.push_back({v, u});
      for (const int* t = triangles_at.begin(u); t != triangles_at.end(u); ++t) {
        const Triangle& c = all.triangles[*t];
        if (c[0] != v && c[1] != v && c[2] != v) near[0].push_back({v, *t});
      }
      for (const int* mine = edges_at.begin(v); mine != edges_at.end(v); ++mine)
        for (const int* other = edges_at.begin(u); other != edges_at.end(u); ++other)
          if (*mine < *other && !share_vertex(all.edges[*mine], all.edges[*other])) near[1].push_back({*mine, *other});
    }
  }
  for (int kind = 0; kind < 2; ++kind) {
    sort_out(near[kind]);
    fill_surroundings(kind == 0, near[kind]);
    std::vector<Numbers>& out = sharing[kind];
    out.insert(out.end(), near[kind].begin(), near[kind].end());
    if (kind == 1)
      for (const Numbers& pair : near[1]) out.push_back({pair[1], pair[0]});
    leave_out(kind == 0 ? vertex_kind : edge_kind, kind == 0 ? triangle_kind : edge_kind, out);
  }
  clearance_ = Clearance(pieces(), model_.rest, joined);
}

/// The clusters as clearance is told of them.
std::vector<Clearance::Piece> PairSystem::pieces() const {
  std::vector<Clearance::Piece> pieces(static_cast<std::size_t>(model_.clusters));
  for (int c = 0; c < model_.clusters; ++c) {
    Clearance::Piece& piece = pieces[static_cast<std::size_t>(c)];
    piece.vertices.assign(cluster_vertices_.begin() + cluster_start_[c], cluster_vertices_.begin() + cluster_start_[c + 1]);
    for (const Kind kind : {edge_kind, triangle_kind}) {
      const Elements& of = elements_[kind];
      for (int i = of.start[c]; i < of.start[c] + of.count[c]; ++i)
        for (int k = 0; k < (kind == edge_kind ? 1 : 3); ++k) {
          const auto [a, b] = std::minmax(of.corner[k][i], of.corner[(k + 1) % of.corners][i]);
          piece.lines.push_back({a, b});
        }
    }
    sort_out(piece.lines);
  }
  return pieces;
}

/// Rows leave out columns by their places, sixteen to a word.
void PairSystem::leave_out(Kind rows, Kind columns, std::vector<std::array<std::int32_t, 2>>& pairs) {
  const auto places = [&](Kind kind) {
    const Elements& of = elements_[kind];
    std::vector<std::int32_t> at(kind == vertex_kind ? model_.rest.size() : of.item.size(), -1);
    for (int c = 0; c < model_.clusters; ++c)
      for (int i = of.start[c]; i < of.start[c] + of.count[c]; ++i) at[of.item[i]] = i;
    return at;
  };
  const std::vector<std::int32_t> row_at = places(rows), column_at = places(columns);
  for (Numbers& pair : pairs) pair = {row_at[pair[0]], column_at[pair[1]]};
  sort_out(pairs);
  Elements& to = elements_[rows];
  std::size_t next = 0;
  for (std::int32_t row = 0; row < static_cast<std::int32_t>(to.item.size()); ++row) {
    to.left_out_start.push_back(static_cast<std::int32_t>(to.left_out.size()));
    for (; next < pairs.size() && pairs[next][0] == row; ++next) {
      const std::int32_t batch = pairs[next][1] / 16;
      const bool begins = to.left_out_start.back() == static_cast<std::int32_t>(to.left_out.size());
      if (begins || to.left_out.back().batch != batch) to.left_out.push_back({batch, 0});
      to.left_out.back().bits |= 1U << (pairs[next][1] % 16);
    }
    to.left_out.push_back({std::numeric_limits<std::int32_t>::max(), 0});
  }
}

/// Pairs by their clusters.
void PairSystem::fill_surroundings(bool of_vertices, const std::vector<std::array<std::int32_t, 2>>& pairs) {
  struct Placed {
    int first, second;
    PairStencil four;
  };
  std::vector<Placed> placed;
  for (const Numbers& p : pairs) {
    int first = of_vertices ? model_.vertex_cluster[p[0]] : model_.edge_cluster[p[0]],
        second = of_vertices ? model_.triangle_cluster[p[1]] : model_.edge_cluster[p[1]];
    if (!of_vertices && first > second) std::swap(first, second);
    placed.push_back({first, second, stencil(of_vertices, p[0], p[1])});
  }
  std::stable_sort(placed.begin(), placed.end(), [](const Placed& x, const Placed& y) {
    return std::tie(x.first, x.second) < std::tie(y.first, y.second);
  });
  std::vector<PairStencil> together;
  for (std::size_t i = 0; i < placed.size(); ++i) {
    const Placed& p = placed[i];
    together.push_back(p.four);
    if (i + 1 < placed.size() && p.first == placed[i + 1].first && p.second == placed[i + 1].second) continue;
    Surroundings of{};
    of.first = p.first;
    of.second = p.second;
    of.of_vertices = of_vertices;
    fill_blocks(of, together);
    surroundings_.push_back(of);
    together.clear();
  }
}

/// Sixteen by sixteen, the nearest at rest first: those that are measured often lie together.
void PairSystem::fill_blocks(Surroundings& of, std::vector<PairStencil>& pairs) {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    order.emplace_back(pair_distance(pairs[i], model_.rest.data()).distance, i);
  std::sort(order.begin(), order.end());
  of.first_block = static_cast<int>(blocks_.size());
  of.pairs = static_cast<int>(pairs.size());
  pairs_of_surroundings_ += of.pairs;
  of.least_reach = not_measured;
  for (std::size_t i = 0; i < order.size(); i += 16) {
    blocks_.emplace_back();
    block_reach_.push_back(not_measured);
    for (std::size_t lane = 0; lane < 16; ++lane)
      for (int k = 0; k < 4; ++k)
        blocks_.back().vertex[k][lane] = pairs[order[std::min(i + lane, order.size() - 1)].second].vertex[k];
  }
  of.last_block = static_cast<int>(blocks_.size());
}

}  // namespace pliant
