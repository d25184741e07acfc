// Finds candidates in three passes: boxes and BVHs, lists of each part, merged lists.
#include "reference/candidates.h"

#include <algorithm>

#include "parallel/ranges.h"

namespace pliant {

namespace {

constexpr int packets_in_a_part = 32, boxes_in_a_task = 2048;

bool has_corner(const Triangle& t, int vertex) { return t[0] == vertex || t[1] == vertex || t[2] == vertex; }

}  // namespace

CandidateFinder::CandidateFinder(ContactElements elements) : elements_(std::move(elements)) {
  all_vertex_boxes_.resize(static_cast<std::size_t>(elements_.vertex_count));
  vertex_boxes_.resize(elements_.vertices.size());
  edge_boxes_.resize(elements_.edges.size());
  triangle_boxes_.resize(elements_.triangles.size());
  vertex_triangles_.start.resize(all_vertex_boxes_.size() + 1);
  edge_edges_.start.resize(edge_boxes_.size() + 1);
}

void CandidateFinder::find(Executor& executor, const std::vector<Vec3f>& from, const std::vector<Vec3f>& to,
                           float radius, bool rebuild) {
  fit_boxes(executor, from, to, radius);
  fit_trees(executor, rebuild || !built_);
  built_ = true;
  find_lists(executor, vertex_tree_, triangle_tree_, elements_.vertices.data(), vertex_triangles_,
             [&](int vertex, int triangle) {
               const Triangle& corners = elements_.triangles[static_cast<std::size_t>(triangle)];
               return !has_corner(corners, vertex);
             });
  find_lists(executor, edge_tree_, edge_tree_, nullptr, edge_edges_, [&](int edge, int other) {
    const auto [a, b] = elements_.edges[static_cast<std::size_t>(edge)];
    const auto [c, d] = elements_.edges[static_cast<std::size_t>(other)];
    return other > edge && a != c && a != d && b != c && b != d;
  });
}

void CandidateFinder::fit_boxes(Executor& executor, const std::vector<Vec3f>& from, const std::vector<Vec3f>& to,
                                float radius) {
  const auto each = [&](std::size_t n, const auto& body) {
    for_items(executor, "candidate boxes", static_cast<int>(n), boxes_in_a_task,
              [&](int i) { body(static_cast<std::size_t>(i)); });
  };
  const auto box_of = [&](const auto& corners) {
    BoxBounds box = all_vertex_boxes_[static_cast<std::size_t>(corners[0])];
    for (const int corner : corners) {
      const BoxBounds& other = all_vertex_boxes_[static_cast<std::size_t>(corner)];
      box = {min(box.low, other.low), max(box.high, other.high)};
    }
    return box;
  };
  each(all_vertex_boxes_.size(), [&](std::size_t i) {
    all_vertex_boxes_[i] = BoxBounds{min(from[i], to[i]), max(from[i], to[i])}.grown(0.5f * radius);
  });
  each(vertex_boxes_.size(),
       [&](std::size_t i) { vertex_boxes_[i] = all_vertex_boxes_[static_cast<std::size_t>(elements_.vertices[i])]; });
  each(edge_boxes_.size(), [&](std::size_t i) { edge_boxes_[i] = box_of(elements_.edges[i]); });
  each(triangle_boxes_.size(), [&](std::size_t i) { triangle_boxes_[i] = box_of(elements_.triangles[i]); });
}

void CandidateFinder::fit_trees(Executor& executor, bool rebuild) {
  const struct {
    Tree<BoxBounds>& tree;
    const std::vector<BoxBounds>& boxes;
  } all[3] = {{edge_tree_, edge_boxes_}, {triangle_tree_, triangle_boxes_}, {vertex_tree_, vertex_boxes_}};
  executor.parallel_for("candidate trees", 3, [&](int i) {
    if (rebuild) {
      all[i].tree.build(all[i].boxes);
    } else {
      all[i].tree.refit(all[i].boxes);
    }
  });
}

/// Lists for each owner the leaves of `others` whose boxes overlap its box and for which wanted(owner, other) is true.
template <class Wanted>
void CandidateFinder::find_lists(Executor& executor, const Tree<BoxBounds>& owners, const Tree<BoxBounds>& others,
                                 const int* owner_of_leaf, IntLists& lists, const Wanted& wanted) {
  const int part_count = ranges_of(owners.packet_count(), packets_in_a_part);
  if (parts_.size() < static_cast<std::size_t>(part_count)) parts_.resize(static_cast<std::size_t>(part_count));
  std::fill(lists.start.begin(), lists.start.end(), 0);
  for_ranges(executor, "find candidates", owners.packet_count(), packets_in_a_part, [&](int first, int last) {
    Part& part = parts_[static_cast<std::size_t>(first / packets_in_a_part)];
    part.runs.clear();
    part.items.clear();
    for (int packet = first; packet < last; ++packet)
      owners.packet_overlaps(packet, others, part.packs, part.hits, [&](int leaf, const std::vector<int>& hits) {
        const int owner = owner_of_leaf == nullptr ? leaf : owner_of_leaf[leaf];
        const auto before = static_cast<std::ptrdiff_t>(part.items.size());
        for (const int other : hits)
          if (wanted(owner, other)) part.items.push_back(other);
        const int count = static_cast<int>(static_cast<std::ptrdiff_t>(part.items.size()) - before);
        if (count == 0) return;
        std::sort(part.items.begin() + before, part.items.end());
        part.runs.push_back({owner, count});
        lists.start[static_cast<std::size_t>(owner) + 1] = count;
      });
  });
  for (std::size_t i = 1; i < lists.start.size(); ++i) lists.start[i] += lists.start[i - 1];
  lists.items.resize(static_cast<std::size_t>(lists.start.back()));
  executor.parallel_for("gather candidates", part_count, [&](int number) {
    const Part& part = parts_[static_cast<std::size_t>(number)];
    const int* next = part.items.data();
    for (const Part::Run& run : part.runs) {
      std::copy(next, next + run.count, lists.items.data() + lists.start[static_cast<std::size_t>(run.owner)]);
      next += run.count;
    }
  });
}

}  // namespace pliant
