#include "model/choose_order.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>

#include "topology/colouring.h"
#include "topology/lockstep.h"
#include "topology/numbering.h"
#include "topology/sort_by_first.h"

namespace pliant {

namespace {

/// If this share of pairs is in contiguous groups, the chain order is accepted, and no other is tried.
constexpr double enough_in_runs = 0.75;

/// Below this number of particles the order does not affect the time of a sweep.
constexpr std::size_t fewest_to_choose_for = 64;

/// Number of particles, the first in storage, whose pairs are sampled to judge an order.
constexpr int most_to_judge_by = 1 << 14;

using Links = std::vector<std::array<int, 2>>;

/// The pairs of particles that share a constraint, each once: tetrahedra share their edges. If there are two-particle
/// constraints, only those count: they are the mesh on which larger stencils are built.
Links links_of(const std::vector<ConstraintList>& lists, std::size_t particles) {
  const bool pairs = std::any_of(lists.begin(), lists.end(),
                                 [](const ConstraintList& list) { return list.in_lanes && list.size == 2; });
  Links links;
  for (const ConstraintList& list : lists) {
    if (!list.in_lanes || (pairs && list.size != 2)) continue;
    links.reserve(links.size() + list.stencils.size() / 2 * (list.size - 1));
    for (std::size_t first = 0; first < list.stencils.size(); first += list.size) {
      for (int a = 0; a < list.size; ++a) {
        for (int b = a + 1; b < list.size; ++b) {
          const int one = list.stencils[first + a], other = list.stencils[first + b];
          if (one != other) links.push_back({std::min(one, other), std::max(one, other)});
        }
      }
    }
  }
  sort_by_first(
      links, particles, [](const auto& link) { return link[0]; }, std::less<>());
  links.erase(std::unique(links.begin(), links.end()), links.end());
  return links;
}

/// Marks every particle i that shares a constraint with i + 1.
std::vector<char> find_links_to_next(const std::vector<ConstraintList>& lists, std::size_t particles) {
  std::vector<char> linked(particles, 0);
  for (const ConstraintList& list : lists) {
    if (!list.in_lanes) continue;
    for (std::size_t first = 0; first < list.stencils.size(); first += list.size) {
      for (int a = 0; a < list.size; ++a) {
        for (int b = 0; b < list.size; ++b) {
          if (list.stencils[first + a] + 1 == list.stencils[first + b]) linked[list.stencils[first + a]] = 1;
        }
      }
    }
  }
  return linked;
}

/// The share of pairs in contiguous groups of four, among the first particles in storage.
double links_in_runs(const Links& links, const std::vector<int>& order) {
  std::vector<int> place(order.size()), stencils;
  for (int storage = 0; storage < static_cast<int>(order.size()); ++storage) place[order[storage]] = storage;
  for (const auto& [a, b] : links) {
    const int i = std::min(place[a], place[b]), j = std::max(place[a], place[b]);
    if (j < most_to_judge_by) stencils.insert(stencils.end(), {i, j});
  }
  return share_in_runs(stencils, 2);
}

}  // namespace

std::vector<int> choose_order(const std::vector<Vec3f>& positions, const std::vector<int>& tile,
                              const std::vector<ConstraintList>& lists) {
  std::vector<int> chains = number_in_chains(tile, find_links_to_next(lists, tile.size()));
  if (tile.size() < fewest_to_choose_for) return chains;
  const Links links = links_of(lists, tile.size());
  const double in_chains = links_in_runs(links, chains);
  if (in_chains >= enough_in_runs) return chains;
  std::vector<int> lockstep = number_in_lockstep(positions, tile, links);
  return links_in_runs(links, lockstep) > in_chains ? lockstep : chains;
}

}  // namespace pliant
