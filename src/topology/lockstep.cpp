// Lockstep order: the particles of four patches of a tile are numbered in the same order of growth.
//
// A rank is four particles, one of each patch, that have the same index in their patches. Two ranks are linked if all
// four pairs of their particles are. A new rank is added beside two linked ranks a and b: in every patch the particle
// that forms a triangle with them. This gives two links of the three edges per vertex. A queue has the pairs of linked
// ranks: those that gain most links first, then the oldest, so that fans around old ranks close. If no pair can grow in
// all patches, a rank grows by one link; if none can, growth restarts from the first particles left.
#include "topology/lockstep.h"

#include <algorithm>
#include <cstddef>
#include <queue>
#include <tuple>

#include "topology/tiles.h"

namespace pliant {

namespace {

constexpr int patches = 4;
constexpr int most_corners = 2;  // candidates considered in each patch
// Limits of the cost of hubs with very many links: only the last links of a rank are evaluated again, and only the
// first neighbours of a particle are considered.
constexpr int most_links_seen = 16, most_neighbours_seen = 32;
using Rank = std::array<int, patches>;

/// For each particle, the particles of its patch with which it shares a constraint, ascending.
class Neighbours {
 public:
  Neighbours(const std::vector<int>& patch, const std::vector<std::array<int, 2>>& links)
      : begin_(patch.size() + 1, 0) {
    std::vector<std::array<int, 2>> both;
    for (const auto& [a, b] : links) {
      if (a == b || patch[a] != patch[b]) continue;
      both.push_back({a, b});
      both.push_back({b, a});
    }
    std::sort(both.begin(), both.end());
    both.erase(std::unique(both.begin(), both.end()), both.end());
    for (const auto& link : both) {
      ++begin_[link[0] + 1];
      to_.push_back(link[1]);
    }
    for (std::size_t i = 0; i + 1 < begin_.size(); ++i) begin_[i + 1] += begin_[i];
  }
  const int* begin(int particle) const { return to_.data() + begin_[particle]; }
  const int* end(int particle) const { return to_.data() + begin_[particle + 1]; }
  int count(int particle) const { return begin_[particle + 1] - begin_[particle]; }
  bool linked(int a, int b) const {
    constexpr int few = 24;  // of which looking at each is faster than a binary search
    if (count(a) > count(b)) std::swap(a, b);
    if (count(a) > few) return std::binary_search(begin(a), end(a), b);
    return std::find(begin(a), end(a), b) != end(a);
  }

 private:
  std::vector<int> begin_, to_;
};

/// Two linked ranks, and the number of links that a rank beside them would have, at the last evaluation.
struct Open {
  int links, older, younger;
  friend bool operator==(const Open& a, const Open& b) = default;
  friend bool operator<(const Open& a, const Open& b) {  // the priority queue returns the largest, which is the best
    return std::tuple(a.links, -a.older, -a.younger) < std::tuple(b.links, -b.older, -b.younger);
  }
};

struct Proposal {
  int links = 0;
  Rank rank{};
};

/// Numbers one tile by growing its four patches in the same order. `members` has the particles of each patch,
/// ascending.
class Growth {
 public:
  Growth(const Neighbours& neighbours, const std::array<std::vector<int>, patches>& members, std::vector<int>& rank_of,
         std::vector<int>& passed, std::vector<int>& left_around)
      : neighbours_(neighbours), members_(members), rank_of_(rank_of), passed_(passed), left_around_(left_around) {
    for (const std::vector<int>& patch : members_)
      for (const int particle : patch) left_around_[particle] = neighbours_.count(particle);
  }

  void append_to(std::vector<int>& order) {
    std::size_t ranks = members_[0].size();
    for (const std::vector<int>& patch : members_) ranks = std::min(ranks, patch.size());
    while (ranks_.size() < ranks) add(next());
    std::vector<int> rest;
    for (const std::vector<int>& patch : members_)
      std::copy_if(patch.begin(), patch.end(), std::back_inserter(rest), [&](int p) { return is_left(p); });
    // A remainder of the particles goes first, so that no later rank crosses a cache line: four records fill one line.
    const std::size_t before = (patches - order.size() % patches) % patches;
    if (rest.size() < before && !ranks_.empty()) {
      rest.insert(rest.end(), ranks_.back().begin(), ranks_.back().end());
      ranks_.pop_back();
    }
    const auto middle = rest.begin() + static_cast<std::ptrdiff_t>(std::min(before, rest.size()));
    order.insert(order.end(), rest.begin(), middle);
    for (const Rank& rank : ranks_) order.insert(order.end(), rank.begin(), rank.end());
    order.insert(order.end(), middle, rest.end());
  }

 private:
  bool is_left(int particle) const { return rank_of_[particle] < 0; }

  bool linked_to_rank(const Rank& candidate, int rank) const {
    for (int l = 0; l < patches; ++l) {
      if (!neighbours_.linked(candidate[l], ranks_[rank][l])) return false;
    }
    return true;
  }

  /// Calls a function for each rank that would be linked to a candidate.
  template <class Body>
  void for_links_of(const Rank& candidate, const Body& body) const {
    const int one = *std::min_element(candidate.begin(), candidate.end(),
                                      [&](int a, int b) { return neighbours_.count(a) < neighbours_.count(b); });
    for (const int* n = neighbours_.begin(one); n != neighbours_.end(one); ++n)
      if (!is_left(*n) && linked_to_rank(candidate, rank_of_[*n])) body(rank_of_[*n]);
  }

  /// Finds up to two particles that are not numbered yet and are linked to both a and b.
  int corners(int a, int b, std::array<int, most_corners>& found) const {
    int count = 0;
    if (neighbours_.count(a) > neighbours_.count(b)) std::swap(a, b);
    for (const int* n = neighbours_.begin(a); n != neighbours_.end(a) && count < most_corners; ++n) {
      if (is_left(*n) && neighbours_.linked(b, *n)) found[count++] = *n;
    }
    return count;
  }

  /// The rank with most links beside the linked ranks a and b; none if a patch has no particle there.
  Proposal propose(int a, int b) const {
    std::array<std::array<int, most_corners>, patches> found;
    Rank count{};
    int choices = 1;
    for (int l = 0; l < patches; ++l)
      if (left_around_[ranks_[a][l]] == 0 || left_around_[ranks_[b][l]] == 0) return {};
    for (int l = 0; l < patches; ++l) {
      count[l] = corners(ranks_[a][l], ranks_[b][l], found[l]);
      if (count[l] == 0) return {};
      choices *= count[l];
    }
    Proposal best;
    for (int choice = 0; choice < choices; ++choice) {
      Proposal proposal;
      for (int l = 0, rest = choice; l < patches; rest /= count[l++]) proposal.rank[l] = found[l][rest % count[l]];
      for_links_of(proposal.rank, [&](int) { ++proposal.links; });
      if (proposal.links > best.links) best = proposal;
    }
    return best;
  }

  Rank next() {
    while (!open_.empty()) {
      const Open open = open_.top();
      open_.pop();
      bool again = false;  // the same may wait several times; it is evaluated once
      for (; !open_.empty() && open_.top() == open; again = true) open_.pop();
      const Proposal proposal = propose(open.older, open.younger);
      if (proposal.links == open.links) {
        if (again) open_.push(open);
        return proposal.rank;
      }
      if (proposal.links > 0) open_.push({proposal.links, open.older, open.younger});
    }
    return next_with_one_link();
  }

  Rank next_with_one_link() {
    for (; oldest_ < static_cast<int>(ranks_.size()); ++oldest_) {
      Rank rank{};
      int l = 0;
      for (; l < patches; ++l) {
        rank[l] = most_enclosed(ranks_[oldest_][l]);
        if (rank[l] < 0) break;
      }
      if (l == patches) return rank;
    }
    return next_without_links();
  }

  /// Of the neighbours of a particle that have no number yet (at a hub, the first ones), returns the one with most
  /// numbered neighbours, so that no holes remain; -1 if there is none.
  int most_enclosed(int particle) {
    int& passed = passed_[particle];
    const int *first = neighbours_.begin(particle), *last = neighbours_.end(particle);
    while (first + passed != last && !is_left(first[passed])) ++passed;
    last = std::min(last, first + passed + most_neighbours_seen);
    int best = -1, most = -1;
    for (const int* n = first + passed; n < last; ++n) {
      if (!is_left(*n)) continue;
      const int numbered = numbered_around(*n);
      if (numbered > most) best = *n;
      most = std::max(most, numbered);
    }
    return best;
  }

  int numbered_around(int particle) const {
    const int* first = neighbours_.begin(particle);
    const int* last = first + std::min(neighbours_.count(particle), most_neighbours_seen);
    return static_cast<int>(std::count_if(first, last, [&](int p) { return !is_left(p); }));
  }

  Rank next_without_links() {
    Rank rank{};
    for (int l = 0; l < patches; ++l) {
      while (!is_left(members_[l][first_left_[l]])) ++first_left_[l];
      rank[l] = members_[l][first_left_[l]];
    }
    return rank;
  }

  void add(const Rank& rank) {
    const int number = static_cast<int>(ranks_.size());
    std::vector<int> links;
    for_links_of(rank, [&](int other) { links.push_back(other); });
    for (int particle : rank) {
      rank_of_[particle] = number;
      for (const int* n = neighbours_.begin(particle); n != neighbours_.end(particle); ++n) --left_around_[*n];
    }
    ranks_.push_back(rank);
    links_.push_back(links);
    for (int other : links) links_[other].push_back(number);
    for (int other : links) {
      const std::size_t first = links_[other].size() > most_links_seen ? links_[other].size() - most_links_seen : 0;
      for (std::size_t i = first; i < links_[other].size(); ++i) wait(other, links_[other][i]);
    }
  }

  void wait(int a, int b) {
    const Proposal proposal = propose(a, b);
    if (proposal.links > 0) open_.push({proposal.links, std::min(a, b), std::max(a, b)});
  }

  const Neighbours& neighbours_;
  const std::array<std::vector<int>, patches>& members_;
  std::vector<int>& rank_of_;      // rank of each particle; -1: not numbered yet
  std::vector<int>& passed_;       // for each particle, how many of its first neighbours are known to be numbered
  std::vector<int>& left_around_;  // for each particle, how many of its neighbours have no number yet
  std::vector<Rank> ranks_;
  std::vector<std::vector<int>> links_;  // for each rank, the ranks to which it is linked
  std::priority_queue<Open> open_;
  int oldest_ = 0;  // index of the oldest rank beside which another may still fit
  std::array<std::size_t, patches> first_left_{};
};

/// For each tile, its particles in ascending order.
std::vector<std::vector<int>> members_of(const std::vector<int>& tile) {
  std::vector<std::vector<int>> members;
  for (int i = 0; i < static_cast<int>(tile.size()); ++i) {
    if (static_cast<int>(members.size()) <= tile[i]) members.resize(static_cast<std::size_t>(tile[i]) + 1);
    members[tile[i]].push_back(i);
  }
  return members;
}

/// Cuts a tile into four compact patches of nearly equal size.
std::array<std::vector<int>, patches> cut_in_four(const std::vector<Vec3f>& positions,
                                                  const std::vector<int>& members) {
  std::vector<Vec3f> places;
  places.reserve(members.size());
  for (int particle : members) places.push_back(positions[particle]);
  const int quarter = static_cast<int>(members.size() + patches - 1) / patches;
  const std::vector<int> part = cut_into_tiles(places, std::max(quarter, 1));
  std::array<std::vector<int>, patches> cut;
  for (std::size_t i = 0; i < members.size(); ++i) cut[part[i] % patches].push_back(members[i]);
  return cut;
}

}  // namespace

std::vector<int> number_in_lockstep(const std::vector<Vec3f>& positions, const std::vector<int>& tile,
                                    const std::vector<std::array<int, 2>>& links) {
  std::vector<int> patch(tile.size()), rank_of(tile.size(), -1), passed(tile.size(), 0), left_around(tile.size(), 0),
      order;
  std::vector<std::array<std::vector<int>, patches>> cuts;
  for (const std::vector<int>& members : members_of(tile)) {
    cuts.push_back(cut_in_four(positions, members));
    for (int l = 0; l < patches; ++l) {
      for (int particle : cuts.back()[l]) patch[particle] = patches * static_cast<int>(cuts.size() - 1) + l;
    }
  }
  const Neighbours neighbours(patch, links);
  order.reserve(tile.size());
  for (const auto& members : cuts) Growth(neighbours, members, rank_of, passed, left_around).append_to(order);
  return order;
}

}  // namespace pliant
