// A bounding volume hierarchy over anything that a Bounds holds: triangles, edges, points, their paths.
//
// Built by order instead of by cost: leaves are sorted along a Morton curve, and node i of a level holds the nodes 8 i to 8 i + 7
// of the level below. So there are no pointers, building is a sort, refitting is a flat loop a level, children lie side by
// side, and the same leaves give the same tree on any machine. Eight children a node make few levels and short stacks. Leaves
// that moved are refitted in the old order: correct whatever they did, slower the more they mix; then build again.
#pragma once

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "collision/bounds.h"
#include "collision/morton.h"

namespace pliant {

template <Bounds B, int fanout = 8>
class Tree {
 public:
  static constexpr int most_levels = 33;

  /// Orders the leaves anew and fits all nodes. Leaf i keeps its number i in everything below.
  void build(const std::vector<B>& leaves) {
    centres_.resize(leaves.size());
    for (std::size_t i = 0; i < leaves.size(); ++i) centres_[i] = leaves[i].middle();
    sorter_.sort(centres_, order_);
    lay_out();
    refit(leaves);
  }

  /// Fits all nodes to leaves that have moved, as many as there were. Allocates nothing.
  void refit(const std::vector<B>& leaves) {
    for (std::size_t i = 0; i < order_.size(); ++i) nodes_[i] = leaves[static_cast<std::size_t>(order_[i])];
    for (int level = 1; level < level_count_; ++level)
      for (int i = 0; i < size_of(level); ++i) {
        const Range children = children_of(level, i);
        nodes_[at(level, i)] = B::merged(&nodes_[at(level - 1, children.first)], children.last - children.first);
      }
  }

  int leaf_count() const { return static_cast<int>(order_.size()); }

  /// visit(leaf) for every leaf that overlaps `bounds`; in an order that depends on the tree alone.
  template <class Visit>
  void query(const B& bounds, const Visit& visit) const {
    descend(
        0, [&](const B& node) { return overlap(node, bounds); }, [&](int slot) { visit(leaf_at(slot)); });
  }

  /// The tree in packets of leaves that lie together: units of work for threads.
  int packet_count() const { return level_count_ == 0 ? 0 : size_of(std::min(1, level_count_ - 1)); }

  /// For each leaf a of a packet: visit(a, others), which are all leaves b != a that overlap a, ascending.
  template <class Visit>
  void packet_neighbours(int packet, std::vector<int>& slots, std::vector<int>& others, const Visit& visit) const {
    slots.clear();
    const int level = std::min(1, level_count_ - 1);
    const B& bounds = nodes_[at(level, packet)];
    descend(
        level, [&](const B& node) { return overlap(node, bounds); }, [&](int node) { slots.push_back(node); });
    const Range own = level == 0 ? Range{packet, packet + 1} : children_of(1, packet);
    for (int a = own.first; a < own.last; ++a) {
      others.clear();
      for (const int node : slots) collect_overlapping(level, node, a, others);
      std::sort(others.begin(), others.end());
      visit(leaf_at(a), others);
    }
  }

  /// visit(a, b), a < b, once for each pair of leaves that overlap.
  template <class Visit>
  void self_pairs(const Visit& visit) const {
    std::vector<int> slots, others;
    for (int packet = 0; packet < packet_count(); ++packet)
      packet_neighbours(packet, slots, others, [&](int a, const std::vector<int>& list) {
        for (auto b = std::upper_bound(list.begin(), list.end(), a); b != list.end(); ++b) visit(a, *b);
      });
  }

  /// visit(a, b) once for each leaf a of this tree and b of another that overlap.
  template <class Visit>
  void pairs(const Tree& other, const Visit& visit) const {
    if (level_count_ == 0 || other.level_count_ == 0) return;
    const Node top{level_count_ - 1, 0}, others_top{other.level_count_ - 1, 0};
    descend_both(other, top, others_top, visit);
  }

  /// The leaf for which distance(leaf) is least, the first of equal ones, among those nearer than `limit`; -1 where there is
  /// none. distance(leaf) must not be less than the leaf's distance_bound(p); times a rounding is allowed for.
  template <class Distance>
  std::pair<int, float> closest(const Vec3f& p, float limit, const Distance& distance) const {
    std::pair<int, float> best{-1, limit};
    if (level_count_ > 0) closest_below({level_count_ - 1, 0}, p, distance, best);
    return best;
  }

 private:
  struct Range {
    int first, last;
  };
  struct Node {
    int level, index;
  };

  void lay_out() {
    level_count_ = 0;
    std::size_t total = 0;
    for (int size = leaf_count(); size > 0; size = (size + fanout - 1) / fanout) {
      first_[level_count_++] = total;
      total += static_cast<std::size_t>(size);
      first_[level_count_] = total;
      if (size == 1) break;
    }
    nodes_.resize(total);
  }

  int size_of(int level) const { return static_cast<int>(first_[level + 1] - first_[level]); }
  std::size_t at(int level, int index) const { return first_[level] + static_cast<std::size_t>(index); }
  Range children_of(int level, int index) const {
    return {index * fanout, std::min((index + 1) * fanout, size_of(level - 1))};
  }
  int leaf_at(int slot) const { return order_[static_cast<std::size_t>(slot)]; }

  /// visit(index) for each node of the level `bottom` that, with all above it, is wanted.
  template <class Wanted, class Visit>
  void descend(int bottom, const Wanted& wanted, const Visit& visit) const {
    if (level_count_ == 0 || !wanted(nodes_[at(level_count_ - 1, 0)])) return;
    Node stack[most_levels * fanout];
    int depth = 0;
    stack[depth++] = {level_count_ - 1, 0};
    while (depth > 0) {
      const Node node = stack[--depth];
      if (node.level == bottom) {
        visit(node.index);
        continue;
      }
      const Range children = children_of(node.level, node.index);
      const B* bounds = &nodes_[at(node.level - 1, 0)];
      for (int i = children.last - 1; i >= children.first; --i) {
        stack[depth] = {node.level - 1, i};
        depth += wanted(bounds[i]);
      }
    }
  }

  void collect_overlapping(int level, int node, int slot, std::vector<int>& leaves) const {
    const Range range = level == 0 ? Range{node, node + 1} : children_of(1, node);
    const B& own = nodes_[static_cast<std::size_t>(slot)];
    if (level == 1 && !overlap(own, nodes_[at(1, node)])) return;
    for (int b = range.first; b < range.last; ++b)
      if (overlap(own, nodes_[static_cast<std::size_t>(b)]) && b != slot) leaves.push_back(leaf_at(b));
  }

  template <class Visit>
  void descend_both(const Tree& other, Node a, Node b, const Visit& visit) const {
    if (!overlap(nodes_[at(a.level, a.index)], other.nodes_[other.at(b.level, b.index)])) return;
    if (a.level == 0 && b.level == 0) {
      visit(leaf_at(a.index), other.leaf_at(b.index));
    } else if (a.level >= b.level) {
      const Range children = children_of(a.level, a.index);
      for (int i = children.first; i < children.last; ++i) descend_both(other, {a.level - 1, i}, b, visit);
    } else {
      const Range children = other.children_of(b.level, b.index);
      for (int i = children.first; i < children.last; ++i) descend_both(other, a, {b.level - 1, i}, visit);
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
    const Range children = children_of(node.level, node.index);
    std::pair<float, int> near_first[fanout];
    const int count = children.last - children.first;
    for (int i = 0; i < count; ++i) {
      const std::pair<float, int> child{nodes_[at(node.level - 1, children.first + i)].distance_bound(p),
                                        children.first + i};
      int place = i;
      for (; place > 0 && child < near_first[place - 1]; --place) near_first[place] = near_first[place - 1];
      near_first[place] = child;
    }
    for (int i = 0; i < count; ++i) {
      if (near_first[i].first * (1 - 1e-5f) > best.second) return;
      closest_below({node.level - 1, near_first[i].second}, p, distance, best);
    }
  }

  std::vector<B> nodes_;  ///< all levels, leaves first
  std::vector<int> order_;
  std::size_t first_[most_levels + 1] = {};  ///< of each level in nodes_
  int level_count_ = 0;
  std::vector<Vec3f> centres_;
  MortonSorter sorter_;
};

}  // namespace pliant
