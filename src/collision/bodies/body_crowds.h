// The boxes of parts of bodies in trees: one for all that may touch one another, and one for each large family, the
// parts of an object whose bodies never touch one another, as thousands of hairs. Pairs within a family are never
// looked at.
#pragma once

#include <algorithm>
#include <vector>

#include "collision/broad/bounds.h"
#include "collision/broad/tree.h"

namespace pliant {

class BodyCrowds {
 public:
  BodyCrowds() = default;
  /// `family` of each part: those of one family never touch; -1: none.
  explicit BodyCrowds(const std::vector<int>& family);

  /// Builds the trees of the boxes of all parts.
  void build(const std::vector<BoxBounds>& boxes);

  /// Searches are divided into tasks for threads.
  int tasks() const { return static_cast<int>(tasks_.size()); }
  /// True if all parts are in one tree: then the pairs of a part are contiguous, and tasks are in the order of no
  /// other.
  bool is_one() const { return crowds_.size() == 1; }

  /// Calls visit(part, others) for the parts of a task, with the parts whose boxes overlap its own. Each pair of two
  /// crowds comes once; of one crowd both ways, and with the part itself. The vectors are scratch memory.
  template <class Visit>
  void overlaps(int task, std::vector<int>& packs, std::vector<int>& hits, const Visit& visit) const {
    const Task& of = tasks_[static_cast<std::size_t>(task)];
    const Crowd &from = crowd(of.from), &to = crowd(of.to);
    for (int packet = of.first; packet < of.last; ++packet)
      from.tree.packet_overlaps(packet, to.tree, packs, hits, [&](int i, std::vector<int>& others) {
        for (int& other : others) other = to.members[static_cast<std::size_t>(other)];
        visit(from.members[static_cast<std::size_t>(i)], others);
      });
  }

  /// Calls visit(part) for every part whose box overlaps one, but for those of the family of `part`; -1: of any.
  template <class Visit>
  void query(const BoxBounds& box, int part, const Visit& visit) const {
    const int own = part < 0 ? 0 : crowd_of_[static_cast<std::size_t>(part)];
    for (int c = 0; c < static_cast<int>(crowds_.size()); ++c) {
      if (c > 0 && c == own) continue;
      crowd(c).tree.query(box, [&](int i) { visit(crowd(c).members[static_cast<std::size_t>(i)]); });
    }
  }

 private:
  /// Those of crowd 0 may touch one another.
  struct Crowd {
    std::vector<int> members;  ///< ascending
    std::vector<BoxBounds> boxes;
    Tree<BoxBounds> tree;
  };
  /// Packets of crowd `from`, to be tested with crowd `to`.
  struct Task {
    int from, to, first, last;
  };
  const Crowd& crowd(int c) const { return crowds_[static_cast<std::size_t>(c)]; }

  std::vector<Crowd> crowds_{1};
  std::vector<int> crowd_of_;  ///< [part]
  std::vector<Task> tasks_;
};

}  // namespace pliant
