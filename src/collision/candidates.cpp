// Candidates by owners, in three passes: boxes, lists of each part, lists of all in their places.
#include "collision/candidates.h"

#include <algorithm>
#include <string>

#include "pliant/error.h"

namespace pliant {

namespace {

constexpr int packets_in_a_part = 32, boxes_in_a_task = 2048;

using Element = ContactElements::Element;

void require(int vertex, int vertex_count, const char* what, std::size_t number) {
  if (vertex < 0 || vertex >= vertex_count)
    throw Error(Location{.element = std::string(what) + " " + std::to_string(number)},
                "vertex " + std::to_string(vertex) + " does not exist",
                "there are " + std::to_string(vertex_count) + " vertices");
}

int find_edge(const std::vector<std::array<int, 2>>& edges, int a, int b) {
  const std::array<int, 2> edge{std::min(a, b), std::max(a, b)};
  const auto place = std::lower_bound(edges.begin(), edges.end(), edge);
  return place != edges.end() && *place == edge ? static_cast<int>(place - edges.begin()) : -1;
}

/// Gives an element what of its parts nobody owns yet.
void claim(Element& element, const std::vector<std::array<int, 2>>& edges, std::vector<char>& vertex_taken,
           std::vector<char>& edge_taken) {
  for (std::size_t k = 0; k < 3; ++k) {
    const int vertex = element.corners[k], edge = find_edge(edges, vertex, element.corners[(k + 1) % 3]);
    const bool takes_vertex = !vertex_taken[static_cast<std::size_t>(vertex)];
    element.owned_vertices[k] = takes_vertex ? vertex : -1;
    vertex_taken[static_cast<std::size_t>(vertex)] = 1;
    const bool takes_edge = edge >= 0 && !edge_taken[static_cast<std::size_t>(edge)];
    element.owned_edges[k] = takes_edge ? edge : -1;
    if (edge >= 0) edge_taken[static_cast<std::size_t>(edge)] = 1;
  }
}

std::vector<std::array<int, 2>> all_edges(const std::vector<Triangle>& triangles,
                                          const std::vector<std::array<int, 2>>& loose_edges, int vertex_count) {
  std::vector<std::array<int, 2>> edges;
  for (const Edge& edge : find_edges(triangles, vertex_count)) edges.push_back({edge.a, edge.b});
  for (const auto& [a, b] : loose_edges)
    if (a != b) edges.push_back({std::min(a, b), std::max(a, b)});
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

bool has_corner(const Triangle& t, int vertex) { return t[0] == vertex || t[1] == vertex || t[2] == vertex; }

}  // namespace

ContactElements make_contact_elements(const std::vector<Triangle>& triangles,
                                      const std::vector<std::array<int, 2>>& loose_edges,
                                      const std::vector<int>& loose_vertices, int vertex_count) {
  for (std::size_t i = 0; i < loose_edges.size(); ++i)
    for (const int vertex : loose_edges[i]) require(vertex, vertex_count, "edge", i);
  for (std::size_t i = 0; i < loose_vertices.size(); ++i) require(loose_vertices[i], vertex_count, "loose vertex", i);
  ContactElements all;
  all.edges = all_edges(triangles, loose_edges, vertex_count);
  all.triangles = triangles;
  all.vertex_count = vertex_count;
  for (const Triangle& t : triangles) all.elements.push_back({t, {}, {}});
  for (const auto& [a, b] : loose_edges) all.elements.push_back({{a, b, b}, {}, {}});
  for (const int vertex : loose_vertices) all.elements.push_back({{vertex, vertex, vertex}, {}, {}});
  std::vector<char> vertex_taken(static_cast<std::size_t>(vertex_count)), edge_taken(all.edges.size());
  for (Element& element : all.elements) claim(element, all.edges, vertex_taken, edge_taken);
  return all;
}

CandidateFinder::CandidateFinder(ContactElements elements) : elements_(std::move(elements)) {
  vertex_boxes_.resize(static_cast<std::size_t>(elements_.vertex_count));
  boxes_.resize(elements_.elements.size());
  vertex_triangles_.start.resize(vertex_boxes_.size() + 1);
  edge_edges_.start.resize(elements_.edges.size() + 1);
}

void CandidateFinder::find(Executor& executor, const std::vector<Vec3f>& from, const std::vector<Vec3f>& to, float radius,
                           bool anew) {
  fit_boxes(executor, from, to, radius);
  if (anew || !built_) {
    tree_.build(boxes_);
    built_ = true;
  } else {
    tree_.refit(boxes_);
  }
  parts_.resize(static_cast<std::size_t>((tree_.packet_count() + packets_in_a_part - 1) / packets_in_a_part));
  std::fill(vertex_triangles_.start.begin(), vertex_triangles_.start.end(), 0);
  std::fill(edge_edges_.start.begin(), edge_edges_.start.end(), 0);
  executor.parallel_for("find candidates", static_cast<int>(parts_.size()), [&](int part) { find_part(part); });
  gather(executor);
}

void CandidateFinder::fit_boxes(Executor& executor, const std::vector<Vec3f>& from, const std::vector<Vec3f>& to,
                                float radius) {
  const auto tasks = [](std::size_t n) { return static_cast<int>((n + boxes_in_a_task - 1) / boxes_in_a_task); };
  const auto each = [&](std::size_t n, const auto& body) {
    executor.parallel_for("candidate boxes", tasks(n), [&](int task) {
      const std::size_t first = static_cast<std::size_t>(task) * boxes_in_a_task;
      for (std::size_t i = first; i < std::min(n, first + boxes_in_a_task); ++i) body(i);
    });
  };
  each(vertex_boxes_.size(), [&](std::size_t i) {
    vertex_boxes_[i] = BoxBounds{min(from[i], to[i]), max(from[i], to[i])}.grown(0.5f * radius);
  });
  each(boxes_.size(), [&](std::size_t i) {
    const auto& corners = elements_.elements[i].corners;
    const BoxBounds of_corners[3] = {vertex_boxes_[static_cast<std::size_t>(corners[0])],
                                     vertex_boxes_[static_cast<std::size_t>(corners[1])],
                                     vertex_boxes_[static_cast<std::size_t>(corners[2])]};
    boxes_[i] = BoxBounds::merged(of_corners, 3);
  });
}

BoxBounds CandidateFinder::edge_box(int edge) const {
  const auto& [a, b] = elements_.edges[static_cast<std::size_t>(edge)];
  const BoxBounds& first = vertex_boxes_[static_cast<std::size_t>(a)];
  const BoxBounds& second = vertex_boxes_[static_cast<std::size_t>(b)];
  return {min(first.low, second.low), max(first.high, second.high)};
}

void CandidateFinder::find_part(int number) {
  Part& part = parts_[static_cast<std::size_t>(number)];
  part.vertex_runs.clear();
  part.edge_runs.clear();
  part.triangles.clear();
  part.edges.clear();
  const int first = number * packets_in_a_part, last = std::min(first + packets_in_a_part, tree_.packet_count());
  for (int packet = first; packet < last; ++packet)
    tree_.packet_neighbours(packet, part.slots, part.others, [&](int a, const std::vector<int>&) {
      const Element& element = elements_.elements[static_cast<std::size_t>(a)];
      for (const int vertex : element.owned_vertices)
        if (vertex >= 0) add_vertex_triangles(vertex, part);
      for (const int edge : element.owned_edges)
        if (edge >= 0) add_edge_edges(edge, part);
    });
}

// Of the element's neighbours, part.others.
void CandidateFinder::add_vertex_triangles(int vertex, Part& part) {
  const BoxBounds& box = vertex_boxes_[static_cast<std::size_t>(vertex)];
  const std::size_t before = part.triangles.size();
  for (const int other : part.others) {
    if (static_cast<std::size_t>(other) >= elements_.triangles.size()) continue;  // a loose edge or vertex
    if (!overlap(box, boxes_[static_cast<std::size_t>(other)])) continue;
    if (!has_corner(elements_.triangles[static_cast<std::size_t>(other)], vertex)) part.triangles.push_back(other);
  }
  const int count = static_cast<int>(part.triangles.size() - before);
  if (count == 0) return;
  std::sort(part.triangles.begin() + static_cast<std::ptrdiff_t>(before), part.triangles.end());
  part.vertex_runs.push_back({vertex, count});
  vertex_triangles_.start[static_cast<std::size_t>(vertex) + 1] = count;
}

void CandidateFinder::add_edge_edges(int edge, Part& part) {
  const auto [a, b] = elements_.edges[static_cast<std::size_t>(edge)];
  const BoxBounds box = edge_box(edge);
  const std::size_t before = part.edges.size();
  for (const int other : part.others) {
    if (!overlap(box, boxes_[static_cast<std::size_t>(other)])) continue;
    for (const int second : elements_.elements[static_cast<std::size_t>(other)].owned_edges) {
      if (second <= edge) continue;
      const auto [c, d] = elements_.edges[static_cast<std::size_t>(second)];
      if (a != c && a != d && b != c && b != d && overlap(box, edge_box(second))) part.edges.push_back(second);
    }
  }
  const int count = static_cast<int>(part.edges.size() - before);
  if (count == 0) return;
  std::sort(part.edges.begin() + static_cast<std::ptrdiff_t>(before), part.edges.end());
  part.edge_runs.push_back({edge, count});
  edge_edges_.start[static_cast<std::size_t>(edge) + 1] = count;
}

void CandidateFinder::gather(Executor& executor) {
  for (IntLists* lists : {&vertex_triangles_, &edge_edges_}) {
    for (std::size_t i = 1; i < lists->start.size(); ++i) lists->start[i] += lists->start[i - 1];
    lists->items.resize(static_cast<std::size_t>(lists->start.back()));
  }
  executor.parallel_for("gather candidates", static_cast<int>(parts_.size()), [&](int number) {
    const Part& part = parts_[static_cast<std::size_t>(number)];
    const auto copy = [](const std::vector<Part::Run>& runs, const std::vector<int>& items, IntLists& lists) {
      auto next = items.begin();
      for (const Part::Run& run : runs) {
        std::copy(next, next + run.count, lists.items.begin() + lists.start[static_cast<std::size_t>(run.owner)]);
        next += run.count;
      }
    };
    copy(part.vertex_runs, part.triangles, vertex_triangles_);
    copy(part.edge_runs, part.edges, edge_edges_);
  });
}

}  // namespace pliant
