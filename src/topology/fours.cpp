// Finds groups of four constraints. For each set of slots, constraints are sorted by their particles in these slots,
// relative to the lane (particle mod 4) of slot 0. Constraints that are equal except for lanes 0, 1, 2 and 3 form a
// group.
#include "topology/fours.h"

#include <algorithm>
#include <cstddef>
#include <tuple>

namespace pliant {

namespace {

constexpr int most_failures =
    16;  // per set of candidates with equal bases; limits the cost of hubs with many constraints

struct Candidate {
  std::array<int, largest_grouped_stencil> base;  // for each slot: particle minus lane if contiguous, otherwise 0
  int lane, member;
  friend bool operator<(const Candidate& a, const Candidate& b) {
    return std::tie(a.base, a.lane, a.member) < std::tie(b.base, b.lane, b.member);
  }
};

int slots_in(int runs) {
  int count = 0;
  for (; runs != 0; runs &= runs - 1) ++count;
  return count;
}

class FourFinder {
 public:
  FourFinder(const std::vector<int>& stencils, int size) : stencils_(stencils), size_(size) {}

  void find(int runs, std::vector<int>& members, std::vector<Four>& fours) {
    const std::vector<Candidate> candidates = sorted(runs, members);
    std::vector<int> taken;
    for (std::size_t first = 0; first < candidates.size();) {
      std::size_t last = first;
      while (last < candidates.size() && candidates[last].base == candidates[first].base) ++last;
      match(runs, &candidates[first], &candidates[0] + last, fours, taken);
      first = last;
    }
    std::sort(taken.begin(), taken.end());
    const auto is_taken = [&](int member) { return std::binary_search(taken.begin(), taken.end(), member); };
    members.erase(std::remove_if(members.begin(), members.end(), is_taken), members.end());
  }

 private:
  const int* stencil(int member) const { return &stencils_[static_cast<std::size_t>(size_) * member]; }

  /// Candidates sorted by base, lane and member: a counting sort by the first base does most of it, then each bucket is
  /// sorted.
  std::vector<Candidate> sorted(int runs, const std::vector<int>& members) const {
    int first = 0;
    while ((runs >> first & 1) == 0) ++first;
    const auto place = [&](int member) { return static_cast<std::size_t>(stencil(member)[first] / 4); };
    std::vector<std::size_t> begin;
    for (int member : members) {
      if (begin.size() < place(member) + 2) begin.resize(place(member) + 2, 0);
      ++begin[place(member) + 1];
    }
    for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
    std::vector<Candidate> candidates(members.size());
    std::vector<std::size_t> next = begin;
    for (int member : members) candidates[next[place(member)]++] = candidate(runs, first, member);
    for (std::size_t i = 1; i < begin.size(); ++i)
      std::sort(candidates.data() + begin[i - 1], candidates.data() + begin[i]);
    return candidates;
  }

  Candidate candidate(int runs, int first, int member) const {
    Candidate candidate{{}, stencil(member)[first] % 4, member};
    for (int slot = 0; slot < size_; ++slot) {
      if ((runs >> slot & 1) != 0) candidate.base[slot] = stencil(member)[slot] - candidate.lane;
    }
    return candidate;
  }

  bool share_a_particle(int a, int b) const {
    return std::any_of(stencil(a), stencil(a) + size_, [&](int particle) {
      return std::find(stencil(b), stencil(b) + size_, particle) != stencil(b) + size_;
    });
  }

  /// Forms groups of one candidate of each lane, while four candidates without a common particle remain.
  void match(int runs, const Candidate* first, const Candidate* last, std::vector<Four>& fours,
             std::vector<int>& taken) {
    std::array<std::vector<int>, 4> left;
    for (const Candidate* candidate = first; candidate != last; ++candidate)
      left[candidate->lane].push_back(candidate->member);
    int failures = 0;
    for (std::size_t i = 0; i < left[0].size() && failures < most_failures; ++i) {
      Four four{runs, {left[0][i]}};
      if (!join(four, left)) {
        ++failures;
        continue;
      }
      taken.insert(taken.end(), four.members.begin(), four.members.end());
      fours.push_back(four);
    }
  }

  /// Completes a group with the first candidates of lanes 1, 2 and 3 that share no particle with it; false if a lane
  /// has none.
  bool join(Four& four, std::array<std::vector<int>, 4>& left) const {
    std::array<std::vector<int>::iterator, 4> at;
    for (int lane = 1; lane < 4; ++lane) {
      at[lane] = std::find_if(left[lane].begin(), left[lane].end(), [&](int candidate) {
        return std::none_of(four.members.begin(), four.members.begin() + lane,
                            [&](int member) { return share_a_particle(member, candidate); });
      });
      if (at[lane] == left[lane].end()) return false;
      four.members[lane] = *at[lane];
    }
    for (int lane = 1; lane < 4; ++lane) left[lane].erase(at[lane]);
    return true;
  }

  const std::vector<int>& stencils_;
  int size_;
};

}  // namespace

std::vector<Four> take_fours(const std::vector<int>& stencils, int size, std::vector<int>& members) {
  std::vector<Four> fours;
  FourFinder finder(stencils, size);
  for (int in_runs = size; in_runs > 0; --in_runs) {
    for (int runs = 1; runs < 1 << size; ++runs) {
      if (slots_in(runs) == in_runs) finder.find(runs, members, fours);
    }
  }
  return fours;
}

}  // namespace pliant
