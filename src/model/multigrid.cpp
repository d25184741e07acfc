#include "model/multigrid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "constraints/registry.h"
#include "model/attachments.h"
#include "model/spring_limit.h"

namespace pliant {

namespace {

// Stiffness limit of an edge over its share of the load per length. Edges then stretch by about 0.1 % under the weight.
constexpr double stiffness_over_weight = 1700;
// Share of a cross-section's load that one edge at a single pin carries: an eighth.
constexpr double crowding_at_pins = 0.125;

// Upper limit of the rows of a level over those of the finer level. A hub joined to all particles exceeds it and is not
// coarsened.
constexpr double largest_share = 0.75;

struct Spring {
  int a = 0, b = 0;
  float rest = 0, compliance = 0;
};

std::vector<Spring> springs_of(const std::vector<ConstraintList>& lists) {
  std::vector<Spring> springs;
  std::size_t most = 0;
  for (const ConstraintList& list : lists) most += is_length(list.type) ? list.response.size() : 0;
  springs.reserve(most);
  for (const ConstraintList& list : lists) {
    if (!is_length(list.type)) continue;
    for (std::size_t i = 0; i < list.response.size(); ++i) {
      const int a = list.stencils[2 * i], b = list.stencils[2 * i + 1];
      const bool shares = list.law == Law::pbd && list.response[i] < 1;  // PBD stiffness below 1 is no spring
      if (a != b && !shares) springs.push_back({a, b, list.rest[i], list.law == Law::pbd ? 0 : list.response[i]});
    }
  }
  return springs;
}

// ---------------------------------------------------------------- graphs

/// Weighted adjacency: sorted neighbours of each node, in both directions. A weight is the number of springs.
struct Graph {
  std::vector<int> begin, to, weight;
  int size() const { return static_cast<int>(begin.size()) - 1; }
};

struct Link {
  int from, to, weight;
  friend bool operator<(const Link& a, const Link& b) { return a.from != b.from ? a.from < b.from : a.to < b.to; }
};

Graph graph_of(int nodes, std::vector<Link>& links) {
  std::sort(links.begin(), links.end());
  Graph graph;
  graph.begin.assign(static_cast<std::size_t>(nodes) + 1, 0);
  graph.to.reserve(links.size());
  graph.weight.reserve(links.size());
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (i > 0 && links[i].from == links[i - 1].from && links[i].to == links[i - 1].to) {
      graph.weight.back() += links[i].weight;
      continue;
    }
    graph.to.push_back(links[i].to);
    graph.weight.push_back(links[i].weight);
    ++graph.begin[links[i].from + 1];
  }
  std::partial_sum(graph.begin.begin(), graph.begin.end(), graph.begin.begin());
  return graph;
}

/// Matches each node with the unmatched neighbour with which it shares most springs; of equal ones with that which has
/// fewest unmatched neighbours. `fixed` nodes get no group: -1.
std::vector<int> match(const Graph& graph, const std::vector<char>& fixed, int& groups) {
  const int nodes = graph.size();
  std::vector<int> group(nodes, -1), left(nodes, 0);
  groups = 0;
  for (int i = 0; i < nodes; ++i) left[i] = graph.begin[i + 1] - graph.begin[i];
  const auto take = [&](int i) {
    group[i] = groups;
    for (int k = graph.begin[i]; k < graph.begin[i + 1]; ++k) --left[graph.to[k]];
  };
  for (int i = 0; i < nodes; ++i) {
    if (group[i] >= 0 || (!fixed.empty() && fixed[i] != 0)) continue;
    int best = -1, weight = 0;
    for (int k = graph.begin[i]; k < graph.begin[i + 1]; ++k) {
      const int j = graph.to[k];
      if (j == i || group[j] >= 0 || (!fixed.empty() && fixed[j] != 0)) continue;
      if (graph.weight[k] > weight || (graph.weight[k] == weight && left[j] < left[best])) {
        best = j;
        weight = graph.weight[k];
      }
    }
    take(i);
    if (best >= 0) take(best);
    ++groups;
  }
  return group;
}

/// Calls body(from, to, weight) for every link of the graph that joins two different groups.
template <class Body>
void for_links_between(const Graph& graph, const std::vector<int>& group, const Body& body) {
  for (int i = 0; i < graph.size(); ++i)
    for (int k = graph.begin[i]; k < graph.begin[i + 1]; ++k) {
      const int a = group[i], b = group[graph.to[k]];
      if (a >= 0 && b >= 0 && a != b) body(a, b, graph.weight[k]);
    }
}

Graph merge(const Graph& graph, const std::vector<int>& group, int groups) {
  std::vector<Link> links;
  std::size_t count = 0;
  for_links_between(graph, group, [&](int, int, int) { ++count; });
  links.reserve(count);
  for_links_between(graph, group, [&](int a, int b, int weight) { links.push_back({a, b, weight}); });
  return graph_of(groups, links);
}

// ---------------------------------------------------------------- levels

/// Lays out rows and neighbours as the slots of a level. Returns the position of each link of the graph: 16 x slot +
/// lane.
std::vector<std::int32_t> lay_out(const Graph& graph, MultigridLevel& level) {
  level.rows = graph.size();
  level.first_slot.assign(1, 0);
  std::vector<std::int32_t> place(graph.to.size());
  for (int batch = 0; batch < level.batches(); ++batch) {
    int most = 0;
    for (int lane = 0; lane < batch_width; ++lane) {
      const int row = row_of(batch, lane);
      if (row < level.rows) most = std::max(most, graph.begin[row + 1] - graph.begin[row]);
    }
    const int first = level.first_slot.back();
    level.first_slot.push_back(first + most);
    level.column.resize(static_cast<std::size_t>(first + most) * batch_width);
    for (int lane = 0; lane < batch_width; ++lane) {
      const int row = row_of(batch, lane), links = row < level.rows ? graph.begin[row + 1] - graph.begin[row] : 0;
      for (int slot = 0; slot < most; ++slot) {
        const std::size_t at = static_cast<std::size_t>(first + slot) * batch_width + lane;
        level.column[at] = slot < links ? graph.to[graph.begin[row] + slot] : std::min(row, level.rows - 1);
        if (slot < links) place[graph.begin[row] + slot] = static_cast<std::int32_t>(at);
      }
    }
  }
  return place;
}

/// Sorts items by key into compressed rows.
void bucket(int keys, const std::vector<std::array<std::int32_t, 2>>& items, std::vector<std::int32_t>& begin,
            std::vector<std::int32_t>& out) {
  begin.assign(static_cast<std::size_t>(keys) + 1, 0);
  for (const auto& item : items) ++begin[item[0] + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  out.resize(items.size());
  std::vector<std::int32_t> next(begin.begin(), begin.end() - 1);
  for (const auto& item : items) out[next[item[0]]++] = item[1];
}

/// Lists the sources of each slot by rounds, one for each lane.
void fill_rounds(const std::vector<std::int32_t>& begin, const std::vector<std::int32_t>& blocks, std::int32_t no_block,
                 MultigridLevel& coarse) {
  coarse.first_round.assign(1, 0);
  for (std::size_t key = 0; key + 1 < begin.size(); key += batch_width) {
    int most = 0;
    for (std::size_t lane = key; lane < key + batch_width; ++lane) most = std::max(most, begin[lane + 1] - begin[lane]);
    for (int round = 0; round < most; ++round)
      for (std::size_t lane = key; lane < key + batch_width; ++lane) {
        const bool has = round < begin[lane + 1] - begin[lane];
        const std::int32_t block = has ? blocks[begin[lane] + round] : 0;
        coarse.sources.push_back(has ? row_of(block / batch_width, block % batch_width) : no_block);
      }
    coarse.first_round.push_back(coarse.first_round.back() + most);
  }
}

void fill_families(const std::vector<int>& group, MultigridLevel& fine, MultigridLevel& coarse) {
  coarse.children.assign(static_cast<std::size_t>(coarse.batches()) * largest_group * batch_width, fine.nothing());
  fine.parent.assign(static_cast<std::size_t>(fine.batches()) * batch_width, coarse.nothing());
  std::vector<int> members(coarse.rows, 0);
  for (int row = 0; row < fine.rows; ++row) {
    const int parent = group[row];
    if (parent < 0) continue;
    fine.parent[lane_place(row)] = parent;
    const int at = lane_place(parent), batch = at / batch_width, lane = at % batch_width;
    coarse.children[(static_cast<std::size_t>(batch) * largest_group + members[parent]++) * batch_width + lane] = row;
  }
}

/// Finds which blocks of the finer level sum to each block of the coarser one.
void fill_sources(const Graph& fine_graph, const std::vector<std::int32_t>& fine_place, const std::vector<int>& group,
                  const Graph& graph, const std::vector<std::int32_t>& place, std::int32_t no_block,
                  MultigridLevel& coarse) {
  std::vector<std::array<std::int32_t, 2>> sources, anchors;
  sources.reserve(fine_place.size());
  for (int i = 0; i < fine_graph.size(); ++i) {
    const int from = group[i];
    if (from < 0) continue;
    for (int k = fine_graph.begin[i]; k < fine_graph.begin[i + 1]; ++k) {
      const int to = group[fine_graph.to[k]];
      if (to < 0) anchors.push_back({lane_place(from), fine_place[k]});
      if (to < 0 || to == from) continue;
      const auto first = graph.to.begin() + graph.begin[from], last = graph.to.begin() + graph.begin[from + 1];
      sources.push_back({place[std::lower_bound(first, last, to) - graph.to.begin()], fine_place[k]});
    }
  }
  std::vector<std::int32_t> begin, blocks;
  bucket(coarse.slots() * batch_width, sources, begin, blocks);
  fill_rounds(begin, blocks, no_block, coarse);
  bucket(coarse.batches() * batch_width, anchors, coarse.anchor_begin, coarse.anchors);
}

void add_coarser(Graph graph, std::vector<std::int32_t> place, std::vector<char> fixed,
                 std::vector<MultigridLevel>& levels) {
  while (levels.back().rows > coarsest_rows) {
    int pairs = 0, groups = 0;
    const std::vector<int> paired = match(graph, fixed, pairs);
    const std::vector<int> grouped = match(merge(graph, paired, pairs), {}, groups);
    std::vector<int> group(paired.size(), -1);
    for (std::size_t i = 0; i < paired.size(); ++i) group[i] = paired[i] < 0 ? -1 : grouped[paired[i]];
    if (groups == 0 || groups > largest_share * graph.size()) return;
    Graph coarse_graph = merge(graph, group, groups);
    MultigridLevel coarse;
    std::vector<std::int32_t> coarse_place = lay_out(coarse_graph, coarse);
    fill_families(group, levels.back(), coarse);
    fill_sources(graph, place, group, coarse_graph, coarse_place, levels.back().no_block(), coarse);
    levels.push_back(std::move(coarse));
    graph = std::move(coarse_graph);
    place = std::move(coarse_place);
    fixed.clear();
  }
}

// ---------------------------------------------------------------- connected components

/// Numbers the connected components. Fixed particles belong to none and separate them.
void find_pieces(const Graph& graph, const std::vector<char>& fixed, Multigrid& out) {
  out.piece.assign(fixed.size(), -1);
  std::vector<int> stack;
  for (int seed = 0; seed < graph.size(); ++seed) {
    if (fixed[seed] != 0 || out.piece[seed] >= 0) continue;
    out.piece[seed] = out.pieces;
    stack.assign(1, seed);
    while (!stack.empty()) {
      const int i = stack.back();
      stack.pop_back();
      for (int k = graph.begin[i]; k < graph.begin[i + 1]; ++k) {
        const int j = graph.to[k];
        if (fixed[j] != 0 || out.piece[j] >= 0) continue;
        out.piece[j] = out.pieces;
        stack.push_back(j);
      }
    }
    ++out.pieces;
  }
}

/// Finds the batches of the finest level in which a row has a neighbour of another component.
void find_borders(Multigrid& out) {
  const MultigridLevel& level = out.levels[0];
  for (int batch = 0; batch < level.batches(); ++batch) {
    bool is_border = false;
    for (int at = level.first_slot[batch] * batch_width; at < level.first_slot[batch + 1] * batch_width; ++at) {
      const int row = std::min(row_of(batch, at % batch_width), level.rows - 1);
      is_border = is_border || out.piece[row] != out.piece[level.column[at]];
    }
    if (is_border) out.border_batches.push_back(batch);
  }
}

/// Finds the component of each row of the coarsest level.
void find_coarsest_pieces(Multigrid& out) {
  out.coarsest_piece = out.piece;
  for (std::size_t l = 0; l + 1 < out.levels.size(); ++l) {
    std::vector<std::int32_t> coarser(out.levels[l + 1].rows, -1);
    for (int row = 0; row < out.levels[l].rows; ++row)
      if (out.coarsest_piece[row] >= 0) coarser[out.levels[l].parent[lane_place(row)]] = out.coarsest_piece[row];
    out.coarsest_piece = std::move(coarser);
  }
}

// ---------------------------------------------------------------- stiffness

/// For each particle, the number of springs on the way to the nearest fixed particle; large if there is none.
std::vector<int> rings_from_pins(const Graph& graph, const std::vector<char>& fixed) {
  std::vector<int> ring(fixed.size(), 1 << 20), queue;
  for (int i = 0; i < graph.size(); ++i) {
    if (fixed[i] == 0) continue;
    ring[i] = 0;
    queue.push_back(i);
  }
  for (std::size_t k = 0; k < queue.size(); ++k) {
    const int i = queue[k];
    for (int link = graph.begin[i]; link < graph.begin[i + 1]; ++link) {
      if (ring[graph.to[link]] <= ring[i] + 1) continue;
      ring[graph.to[link]] = ring[i] + 1;
      queue.push_back(graph.to[link]);
    }
  }
  return ring;
}

SpringMeasures measure(const std::vector<Spring>& springs, const std::vector<Record>& positions) {
  SpringMeasures m;
  Record low{3e38f, 3e38f, 3e38f, 0}, high{-3e38f, -3e38f, -3e38f, 0};
  for (const Record& p : positions) {
    if (p.w > 0) m.mass += 1 / double(p.w);
    low = {min(low.x, p.x), min(low.y, p.y), min(low.z, p.z), 0};
    high = {max(high.x, p.x), max(high.y, p.y), max(high.z, p.z), 0};
  }
  m.extent = double(max(max(high.x - low.x, high.y - low.y), high.z - low.z));
  for (const Spring& s : springs) m.spacing += double(s.rest) / double(springs.size());
  return m;
}

/// Edges across an object.
double edges_across(const SpringMeasures& m, double particles) {
  return std::max(1., particles * m.spacing / std::max(m.extent, 1e-30));
}

/// The stiffness limit at each particle: spring_limit, and more near few pins.
std::vector<float> stiffness_limits(const std::vector<Spring>& springs, const Graph& graph,
                                    const std::vector<Record>& positions, const std::vector<char>& fixed,
                                    float gravity) {
  const SpringMeasures m = measure(springs, positions);
  const double across = edges_across(m, static_cast<double>(positions.size()));
  const double stiffness = spring_limit(m, static_cast<double>(positions.size()), static_cast<double>(gravity));
  const auto pins = static_cast<double>(std::count(fixed.begin(), fixed.end(), 1));
  const std::vector<int> ring = rings_from_pins(graph, fixed);
  std::vector<float> limits(positions.size());
  for (std::size_t i = 0; i < limits.size(); ++i) {
    const double share = pins > 0 ? crowding_at_pins * across / (pins * (1 + ring[i])) : 0;
    limits[i] = static_cast<float>(std::min(stiffness * std::max(1., share), 1e20));
  }
  return limits;
}

// ---------------------------------------------------------------- the finest level

/// The links of all springs in both directions, sorted. Their weight is the spring's index, so that two springs between
/// the same particles stay separate.
std::vector<Link> links_of(const std::vector<Spring>& springs) {
  std::vector<Link> links;
  links.reserve(2 * springs.size());
  for (std::size_t i = 0; i < springs.size(); ++i) {
    links.push_back({springs[i].a, springs[i].b, static_cast<int>(i)});
    links.push_back({springs[i].b, springs[i].a, static_cast<int>(i)});
  }
  std::sort(links.begin(), links.end(),
            [](const Link& a, const Link& b) { return a < b || (!(b < a) && a.weight < b.weight); });
  return links;
}

Graph graph_of_springs(const std::vector<Link>& links, int particles) {
  Graph graph;
  graph.begin.assign(static_cast<std::size_t>(particles) + 1, 0);
  graph.to.reserve(links.size());
  for (const Link& link : links) {
    ++graph.begin[link.from + 1];
    graph.to.push_back(link.to);
  }
  std::partial_sum(graph.begin.begin(), graph.begin.end(), graph.begin.begin());
  return graph;
}

void fill_springs(const std::vector<Spring>& springs, const std::vector<Link>& links,
                  const std::vector<std::int32_t>& place, const std::vector<float>& limit, MultigridLevel& level) {
  level.stiffness.assign(level.column.size(), 0.f);
  level.rest_length.assign(level.column.size(), 1.f);
  for (std::size_t k = 0; k < links.size(); ++k) {
    const Spring& spring = springs[links[k].weight];
    level.stiffness[place[k]] = spring_stiffness(spring.compliance, std::max(limit[spring.a], limit[spring.b]));
    level.rest_length[place[k]] = spring.rest;
  }
}

}  // namespace

double spring_limit(const SpringMeasures& m, double particles, double gravity) {
  const double load = m.mass * std::max(gravity, least_acceleration);
  return stiffness_over_weight * load / std::max(edges_across(m, particles) * m.spacing, 1e-30);
}

Multigrid build_multigrid(const std::vector<ConstraintList>& lists, const std::vector<Record>& positions,
                          float gravity) {
  Multigrid out;
  std::vector<Spring> springs = springs_of(lists);
  const int particles = static_cast<int>(positions.size());
  std::vector<char> fixed(positions.size());
  for (int i = 0; i < particles; ++i) fixed[i] = positions[i].w > 0 ? 0 : 1;
  if (springs.empty() || std::count(fixed.begin(), fixed.end(), 0) == 0) return out;
  std::vector<Link> links = links_of(springs);
  Graph graph = graph_of_springs(links, particles);
  out.levels.emplace_back();
  std::vector<std::int32_t> place = lay_out(graph, out.levels.back());
  out.edge_length = static_cast<float>(measure(springs, positions).spacing);
  out.stiffness_limit = stiffness_limits(springs, graph, positions, fixed, gravity);
  fill_springs(springs, links, place, out.stiffness_limit, out.levels.back());
  springs = {};  // frees memory for the coarser levels
  links = {};
  graph.weight.assign(graph.to.size(), 1);
  find_pieces(graph, fixed, out);
  find_borders(out);
  add_coarser(std::move(graph), std::move(place), std::move(fixed), out.levels);
  find_coarsest_pieces(out);
  return out;
}

}  // namespace pliant
