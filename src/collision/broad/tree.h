// A bounding volume hierarchy over primitives with a Bounds: triangles, edges, points, their swept paths.
//
// It is built by sorting instead of by a cost heuristic: leaves lie along a Morton curve, and node i of a level has the
// nodes 8 i to 8 i + 7 of the level below as children. So there are no pointers, building is a sort, refitting is one
// loop per level, siblings are contiguous, and the same leaves give the same tree on any machine. Eight children per
// node mean few levels, short stacks and, for boxes, one comparison of eight (pack.h). A refit keeps the old order of
// leaves: always correct, but queries slow down as the leaves move. Rebuild then.
#pragma once

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "collision/broad/morton.h"
#include "collision/broad/pack.h"

namespace pliant {

template <Bounds B, int fanout = 8>
class Tree {
 public:
  static constexpr int most_levels = 33;

  /// Sorts the leaves and fits all nodes. Leaf i keeps its index i in all functions below.
  void build(const std::vector<B>& leaves) {
    centres_.resize(leaves.size());
    for (std::size_t i = 0; i < leaves.size(); ++i) centres_[i] = leaves[i].middle();
    sorter_.sort(centres_, order_);
    lay_out();
    refit(leaves);
  }

  /// Refits all nodes to the same number of moved leaves. Allocates nothing.
  void refit(const std::vector<B>& leaves) {
    for (int i = 0; i < leaf_count(); ++i) set_node(0, i, leaves[static_cast<std::size_t>(leaf_at(i))]);
    for (int level = 1; level < level_count_; ++level)
      for (int i = 0; i < sizes_[level]; ++i)
        set_node(level, i, pack_of_children(level, i).merged(child_count(level, i)));
  }

  int leaf_count() const { return static_cast<int>(order_.size()); }

  /// Calls visit(leaf) for every leaf that overlaps `bounds`, in an order that depends on the tree alone.
  template <class Visit>
  void query(const B& bounds, const Visit& visit) const {
    descend(0, bounds, [&](int slot) { visit(leaf_at(slot)); });
  }

  /// The number of packets: contiguous ranges of leaves, each below one node. They are the units of work for threads.
  int packet_count() const { return level_count_ == 0 ? 0 : sizes_[packet_level()]; }

  /// Calls visit(a, hits) for each leaf a of a packet. `hits` are all leaves of `other` that overlap a, in that tree's
  /// order; if `other` is this tree, they include a itself. The two vectors are scratch memory.
  template <class Visit>
  void packet_overlaps(int packet, const Tree& other, std::vector<int>& packs, std::vector<int>& hits,
                       const Visit& visit) const {
    packs.clear();
    const int level = packet_level();
    // Traverses the other tree once for all leaves of the packet, then tests each leaf against packs of leaves.
    other.descend_to_packs(node_at(level, packet), [&](int pack) { packs.push_back(pack); });
    const int first = level == 0 ? packet : packet * fanout, count = level == 0 ? 1 : child_count(1, packet);
    for (int a = first; a < first + count; ++a) {
      hits.clear();
      const B bounds = node_at(0, a);
      for (const int pack : packs) other.collect_overlapping(pack, bounds, hits);
      visit(leaf_at(a), hits);
    }
  }

  /// Calls visit(a, b), a < b, once for each pair of overlapping leaves.
  template <class Visit>
  void self_pairs(const Visit& visit) const {
    std::vector<int> packs, hits;
    for (int packet = 0; packet < packet_count(); ++packet)
      packet_overlaps(packet, *this, packs, hits, [&](int a, const std::vector<int>& list) {
        for (const int b : list)
          if (a < b) visit(a, b);
      });
  }

  /// Calls visit(a, b) once for each overlapping leaf a of this tree and b of `other`.
  template <class Visit>
  void pairs(const Tree& other, const Visit& visit) const {
    if (level_count_ == 0 || other.level_count_ == 0) return;
    const Node top{level_count_ - 1, 0}, others_top{other.level_count_ - 1, 0};
    if (overlap(node_at(top.level, 0), other.node_at(others_top.level, 0))) descend_both(other, top, others_top, visit);
  }

  /// Returns the leaf with the smallest distance(leaf) below `limit`, the first of equal ones; index -1 if there is
  /// none. distance(leaf) must be at least the leaf's distance_bound(p), up to one rounding.
  template <class Distance>
  std::pair<int, float> closest(const Vec3f& p, float limit, const Distance& distance) const {
    std::pair<int, float> best{-1, limit};
    if (level_count_ > 0) closest_below({level_count_ - 1, 0}, p, distance, best);
    return best;
  }

 private:
  struct Node {
    int level, index;
  };

  void lay_out() {
    level_count_ = 0;
    std::size_t total = 0;
    for (int size = leaf_count(); size > 0; size = size == 1 ? 0 : (size + fanout - 1) / fanout) {
      sizes_[level_count_] = size;
      first_pack_[level_count_++] = total;
      total += static_cast<std::size_t>((size + fanout - 1) / fanout);
    }
    packs_.assign(total, Pack<B, fanout>{});
  }

  int packet_level() const { return std::min(1, level_count_ - 1); }
  int child_count(int level, int index) const { return std::min(fanout, sizes_[level - 1] - index * fanout); }
  const Pack<B, fanout>& pack_of_children(int level, int index) const {
    return packs_[first_pack_[level - 1] + static_cast<std::size_t>(index)];
  }
  B node_at(int level, int index) const {
    return packs_[first_pack_[level] + static_cast<std::size_t>(index / fanout)].get(index % fanout);
  }
  void set_node(int level, int index, const B& bounds) {
    packs_[first_pack_[level] + static_cast<std::size_t>(index / fanout)].set(index % fanout, bounds);
  }
  int leaf_at(int slot) const { return order_[static_cast<std::size_t>(slot)]; }

  /// Calls visit(index) for each node of level `bottom` that overlaps `bounds`, as do all of its ancestors.
  template <class Visit>
  void descend(int bottom, const B& bounds, const Visit& visit) const {
    if (level_count_ == 0 || !overlap(node_at(level_count_ - 1, 0), bounds)) return;
    Node stack[most_levels * fanout];
    int depth = 0;
    stack[depth++] = {level_count_ - 1, 0};
    while (depth > 0) {
      const Node node = stack[--depth];
      if (node.level == bottom) {
        visit(node.index);
        continue;
      }
      const unsigned wanted =
          pack_of_children(node.level, node.index).overlaps(bounds, child_count(node.level, node.index));
      each_bit(wanted, [&](int child) { stack[depth++] = {node.level - 1, node.index * fanout + child}; });
    }
  }

  template <class Visit>
  static void each_bit(unsigned bits, const Visit& visit) {
    for (; bits != 0; bits &= bits - 1) visit(__builtin_ctz(bits));
  }

  /// Calls visit(pack) for each pack of up to eight leaves whose parent node overlaps `bounds`.
  template <class Visit>
  void descend_to_packs(const B& bounds, const Visit& visit) const {
    if (level_count_ == 1) visit(0);
    if (level_count_ > 1) descend(1, bounds, visit);
  }

  void collect_overlapping(int pack, const B& bounds, std::vector<int>& leaves) const {
    const unsigned wanted =
        packs_[static_cast<std::size_t>(pack)].overlaps(bounds, std::min(fanout, leaf_count() - pack * fanout));
    each_bit(wanted, [&](int lane) { leaves.push_back(leaf_at(pack * fanout + lane)); });
  }

  template <class Visit>
  void descend_both(const Tree& other, Node a, Node b, const Visit& visit) const {
    if (a.level == 0 && b.level == 0) {
      visit(leaf_at(a.index), other.leaf_at(b.index));
    } else if (a.level >= b.level) {
      const unsigned wanted =
          pack_of_children(a.level, a.index).overlaps(other.node_at(b.level, b.index), child_count(a.level, a.index));
      each_bit(wanted, [&](int i) { descend_both(other, {a.level - 1, a.index * fanout + i}, b, visit); });
    } else {
      const unsigned wanted = other.pack_of_children(b.level, b.index)
                                  .overlaps(node_at(a.level, a.index), other.child_count(b.level, b.index));
      each_bit(wanted, [&](int i) { descend_both(other, a, {b.level - 1, b.index * fanout + i}, visit); });
    }
  }

  template <class Distance>
  void closest_below(Node node, const Vec3f& p, const Distance& distance, std::pair<int, float>& best) const {
    if (node.level == 0) {
      const int leaf = leaf_at(node.index);
      const float d = distance(leaf);
      if (d < best.second || (d == best.second && best.first >= 0 && leaf < best.first)) best = {leaf, d};
      return;
    }
    std::pair<float, int> near_first[fanout];
    const int count = child_count(node.level, node.index);
    for (int i = 0; i < count; ++i) {
      const int index = node.index * fanout + i;
      const std::pair<float, int> child{node_at(node.level - 1, index).distance_bound(p), index};
      int place = i;
      for (; place > 0 && child < near_first[place - 1]; --place) near_first[place] = near_first[place - 1];
      near_first[place] = child;
    }
    for (int i = 0; i < count; ++i) {
      if (near_first[i].first * (1 - 1e-5f) > best.second) return;
      closest_below({node.level - 1, near_first[i].second}, p, distance, best);
    }
  }

  std::vector<Pack<B, fanout>> packs_;  ///< all levels, leaves first; one pack holds the children of one node
  std::vector<int> order_;
  std::size_t first_pack_[most_levels] = {};
  int sizes_[most_levels] = {};  ///< number of nodes of each level
  int level_count_ = 0;
  std::vector<Vec3f> centres_;
  MortonSorter sorter_;
};

}  // namespace pliant
