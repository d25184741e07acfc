#include "collision/untangle.h"

#include <algorithm>
#include <map>
#include <utility>

#include "collision/pairs.h"
#include "math/vector.h"

namespace pliant {

namespace {

Vec3f place(const Record& r) { return {r.x, r.y, r.z}; }

/// The triangles of a body, in its own numbers from `first`, where they close it.
bool closed_surface(const PairModel& model, int body, std::vector<Triangle>& triangles, int& first, int& count) {
  const auto of_body = [&](int v) { return model.vertex_body[static_cast<std::size_t>(v)] == body; };
  first = static_cast<int>(std::find(model.vertex_body.begin(), model.vertex_body.end(), body) - model.vertex_body.begin());
  count = static_cast<int>(std::count(model.vertex_body.begin(), model.vertex_body.end(), body));
  for (const Triangle& t : model.elements.triangles)
    if (of_body(t[0])) triangles.push_back({t[0] - first, t[1] - first, t[2] - first});
  if (triangles.empty()) return false;
  for (const Edge& edge : find_edges(triangles, count))
    if (edge.triangle_count != 2) return false;
  return true;
}

std::vector<Vec3f> places_of(const Record* positions, int first, int count) {
  std::vector<Vec3f> places;
  for (int i = first; i < first + count; ++i) places.push_back(place(positions[i]));
  return places;
}

}  // namespace

Untangler::Untangler(const PairModel& model) : model_(model) {
  for (int body = 0; body < model.bodies; ++body) {
    std::vector<Triangle> triangles;
    int first = 0, count = 0;
    if (!model.immovable[static_cast<std::size_t>(body)] || !closed_surface(model, body, triangles, first, count)) continue;
    closed_.push_back({body, first, std::make_unique<MeshQuery>(places_of(model.rest.data(), first, count), triangles)});
  }
}

void Untangler::begin_frame(const Record* positions, const std::vector<Intersection>& tangles) {
  pushes_.clear();
  lost_in_.clear();
  inside_ = 0;
  find_inside(positions);
  find_pieces(positions, tangles);
}

void Untangler::add(int vertex, int body, const Push& push) {
  if (lost_in_.empty()) lost_in_.assign(model_.rest.size(), -1);
  int& lost = lost_in_[static_cast<std::size_t>(vertex)];
  if (lost >= 0) return;
  lost = body;
  pushes_.push_back(push);
}

/// They go to where the thickness is kept.
void Untangler::find_inside(const Record* positions) {
  for (Closed& closed : closed_) {
    MeshQuery& query = *closed.query;
    query.move(places_of(positions, closed.first, static_cast<int>(query.positions().size())));
    for (const int v : model_.elements.vertices) {
      const std::size_t pair =
          static_cast<std::size_t>(model_.vertex_body[static_cast<std::size_t>(v)]) * model_.bodies + closed.body;
      const Vec3f p = place(positions[v]);
      if (!(positions[v].w > 0) || model_.meets[pair] == 0 || !query.is_inside(p)) continue;
      const SurfacePoint near = query.closest(p);
      ++inside_;
      add(v, closed.body, {v, unit_or(near.point - p, Vec3f{0, 1, 0}), near.distance + model_.materials[pair].thickness});
    }
  }
}

void Untangler::find_pieces(const Record* positions, const std::vector<Intersection>& tangles) {
  std::map<std::pair<int, int>, std::vector<Intersection>> cuts;  // by bodies of edge and triangle
  for (const Intersection& tangle : tangles) {
    const int a = model_.vertex_body[static_cast<std::size_t>(tangle.a)],
              b = model_.vertex_body[static_cast<std::size_t>(model_.elements.triangles[tangle.triangle][0])];
    if (!model_.immovable[static_cast<std::size_t>(a)]) cuts[{a, b}].push_back(tangle);
  }
  for (const auto& [bodies, of_pair] : cuts) draw_back(positions, of_pair, bodies.first, bodies.second);
}

namespace {

/// The connected pieces of a body's vertices once edges are cut: the number of each vertex's, and how many it has.
struct Pieces {
  std::vector<int> of, size;

  int root(int v) const {
    while (of[static_cast<std::size_t>(v)] != v) v = of[static_cast<std::size_t>(v)];
    return v;
  }
};

Pieces pieces_of(const PairModel& model, const std::vector<Intersection>& cuts, int body) {
  std::vector<std::pair<int, int>> cut;
  cut.reserve(cuts.size());
  for (const Intersection& one : cuts) cut.push_back(std::minmax(one.a, one.b));
  std::sort(cut.begin(), cut.end());
  Pieces pieces;
  for (int i = 0; i < static_cast<int>(model.rest.size()); ++i) pieces.of.push_back(i);
  pieces.size.assign(model.rest.size(), 0);
  for (const auto& [a, b] : model.elements.edges) {
    if (model.vertex_body[static_cast<std::size_t>(a)] != body ||
        std::binary_search(cut.begin(), cut.end(), std::pair{a, b}))
      continue;
    const int from = pieces.root(a), to = pieces.root(b);
    pieces.of[static_cast<std::size_t>(std::max(from, to))] = std::min(from, to);
  }
  for (const int v : model.elements.vertices) {
    const int root = pieces.of[static_cast<std::size_t>(v)] = pieces.root(v);
    if (model.vertex_body[static_cast<std::size_t>(v)] == body) ++pieces.size[static_cast<std::size_t>(root)];
  }
  return pieces;
}

}  // namespace

/// Every piece but the largest of a body goes back through what cuts it.
void Untangler::draw_back(const Record* positions, const std::vector<Intersection>& cuts, int body, int through) {
  const Pieces pieces = pieces_of(model_, cuts, body);
  const int largest_piece =
      static_cast<int>(std::max_element(pieces.size.begin(), pieces.size.end()) - pieces.size.begin());
  std::map<int, Vec3f> ways;
  for (const Intersection& cut : cuts) {
    const Triangle& t = model_.elements.triangles[cut.triangle];
    const Vec3f normal =
        cross(place(positions[t[1]]) - place(positions[t[0]]), place(positions[t[2]]) - place(positions[t[0]]));
    for (const auto& [from, to] : {std::pair{cut.a, cut.b}, {cut.b, cut.a}}) {
      const int piece = pieces.of[static_cast<std::size_t>(from)];
      if (piece == largest_piece || piece == pieces.of[static_cast<std::size_t>(to)]) continue;
      const bool with = dot(normal, place(positions[to]) - place(positions[from])) > 0;
      ways[piece] += unit_or(with ? normal : -normal, Vec3f{});
    }
  }
  for (const int v : model_.elements.vertices) {
    const auto way = ways.find(pieces.of[static_cast<std::size_t>(v)]);
    if (way == ways.end() || !(positions[v].w > 0)) continue;
    add(v, through, {v, unit_or(way->second, Vec3f{0, 1, 0}), 1e30f});
  }
}

void Untangler::push(float distance, Record* displacements, Record* remainders) {
  for (Push& push : pushes_) {
    const Record& d = displacements[push.vertex];
    if (!(abs(d.x) + abs(d.y) + abs(d.z) < 1e30f)) continue;  // the end of the substep says so
    const float way = min(distance, push.remaining);
    push.remaining -= way;
    Record& r = remainders[push.vertex];
    r = {r.x + push.direction.x * way, r.y + push.direction.y * way, r.z + push.direction.z * way, r.w};
    displacements[push.vertex] = {r.x, r.y, r.z, 0};
  }
}

}  // namespace pliant
