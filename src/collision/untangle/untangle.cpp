#include "collision/untangle/untangle.h"

#include <algorithm>
#include <map>
#include <utility>

#include "collision/proxies/pair_model.h"
#include "math/record.h"
#include "math/vector.h"

namespace pliant {

namespace {

/// Writes the triangles of a body, with vertices numbered from its first one. Returns false if they do not form a
/// closed surface.
bool closed_surface(const PairModel& model, const BodyElements& body, std::vector<Triangle>& triangles) {
  const int first = body.vertices.first;
  for (int number = body.triangles.first; number < body.triangles.end(); ++number) {
    const auto& [a, b, c] = model.elements.triangles[static_cast<std::size_t>(number)];
    triangles.push_back({a - first, b - first, c - first});
  }
  if (triangles.empty()) return false;
  for (const Edge& edge : find_edges(triangles, body.vertices.size))
    if (edge.triangle_count != 2) return false;
  return true;
}

std::vector<Vec3f> places_of(const Record* positions, int first, int count) {
  std::vector<Vec3f> places;
  for (int i = first; i < first + count; ++i) places.push_back(xyz(positions[i]));
  return places;
}

/// A connected set of vertices that are inside one closed body.
using Patch = std::vector<int>;

/// Divides ascending vertices into connected components, ordered by their first vertex.
std::vector<Patch> patches_of(const PairModel& model, const std::vector<int>& vertices) {
  std::vector<int> parent(vertices.size());
  for (std::size_t i = 0; i < parent.size(); ++i) parent[i] = static_cast<int>(i);
  const auto root = [&](int i) {
    while (parent[static_cast<std::size_t>(i)] != i) i = parent[static_cast<std::size_t>(i)];
    return i;
  };
  const auto number = [&](int v) {
    const auto at = std::lower_bound(vertices.begin(), vertices.end(), v);
    return at != vertices.end() && *at == v ? static_cast<int>(at - vertices.begin()) : -1;
  };
  for (const auto& [a, b] : model.elements.edges) {
    const int i = vertices.empty() ? -1 : number(a), j = i < 0 ? -1 : number(b);
    if (j < 0) continue;
    const int from = root(i), to = root(j);
    parent[static_cast<std::size_t>(std::max(from, to))] = std::min(from, to);
  }
  std::map<int, Patch> patches;
  for (std::size_t i = 0; i < vertices.size(); ++i) patches[root(static_cast<int>(i))].push_back(vertices[i]);
  std::vector<Patch> out;
  out.reserve(patches.size());
  for (auto& [first, patch] : patches) out.push_back(std::move(patch));
  return out;
}

/// The mean normal of the triangles at a patch; zero if their normals differ too much.
Vec3f mean_normal(const PairModel& model, const Patch& patch, const Record* positions) {
  const TrianglesAround& around = model.triangles_around;
  std::vector<int> at_patch;
  for (const int v : patch) at_patch.insert(at_patch.end(), around.begin(v), around.end(v));
  std::sort(at_patch.begin(), at_patch.end());
  at_patch.erase(std::unique(at_patch.begin(), at_patch.end()), at_patch.end());
  Vec3f sum{};
  float all = 0;
  for (const int number : at_patch) {
    const Triangle& t = model.elements.triangles[static_cast<std::size_t>(number)];
    const Vec3f normal =
        cross(xyz(positions[t[1]]) - xyz(positions[t[0]]), xyz(positions[t[2]]) - xyz(positions[t[0]]));
    sum += normal;
    all += length(normal);
  }
  return length(sum) > 0.8f * all ? unit_or(sum, Vec3f{}) : Vec3f{};
}

float thickness_of(const PairModel& model, int vertex, int body) {
  return model.shared->rules.material(model.shared->vertex_body[static_cast<std::size_t>(vertex)], body).thickness;
}

/// The vertices of a model that have a cluster, ascending.
std::vector<int> vertices_of(const PairModel& model) {
  std::vector<int> vertices;
  for (const auto& [body, of] : model.bodies)
    for (int v = of.vertices.first; v < of.vertices.end(); ++v)
      if (model.shared->vertex_cluster[static_cast<std::size_t>(v)] >= 0) vertices.push_back(v);
  std::sort(vertices.begin(), vertices.end());
  return vertices;
}

}  // namespace

Untangler::Untangler(const PairModel& model)
    : model_(model),
      finder_(model.elements.triangles, model.elements.vertex_count),
      vertices_(vertices_of(model)),
      parts_(find_parts(model)) {
  for (const auto& [body, of] : model.bodies) {
    std::vector<Triangle> triangles;
    if (!model.shared->rules.is_immovable(body) || !closed_surface(model, of, triangles)) continue;
    const auto [first, count] = of.vertices;
    closed_.push_back({body, part_of(first), first,
                       std::make_unique<MeshQuery>(places_of(model.shared->rest.data(), first, count), triangles)});
  }
}

Untangler::PartPair Untangler::parts_of(const Intersection& found) const {
  return std::minmax(part_of(found.a), part_of(model_.elements.triangles[static_cast<std::size_t>(found.triangle)][0]));
}

void Untangler::begin_frame(const Record* positions, const std::vector<Intersection>& found) {
  pushes_.clear();
  wrong_side_of_.clear();
  piece_.clear();
  led_.clear();
  speeds_.clear();
  inside_ = 0;
  find_inside(positions);
  find_pieces(positions, found);
  for (const int v : vertices_)
    if (positions[v].w > 0 && is_led(part_of(v))) speeds_.emplace_back(v, 0.f);
}

bool Untangler::leads_apart(const Intersection& found) const {
  const auto [a, b] = parts_of(found);
  return is_closed(a) || is_closed(b) ||
         std::any_of(pushes_.begin(), pushes_.end(), [&, one = a, other = b](const Push& push) {
           const auto v = static_cast<std::size_t>(push.vertex);
           return PartPair(std::minmax(parts_.of[v], wrong_side_of_[v])) == PartPair(one, other);
         });
}

bool Untangler::is_exempt(const PairStencil& pair) const {
  if (wrong_side_of_.empty()) return false;
  const int first = part_of(pair.vertex[0]), second = part_of(pair.vertex[static_cast<std::size_t>(pair.first_side)]);
  bool wrong = false, same_piece = true;
  for (int i = 0; i < 4; ++i) {
    const auto v = static_cast<std::size_t>(pair.vertex[static_cast<std::size_t>(i)]);
    wrong = wrong || wrong_side_of_[v] == (i < pair.first_side ? second : first);
    same_piece = same_piece && piece_[v] >= 0 && piece_[v] == piece_[static_cast<std::size_t>(pair.vertex[0])];
  }
  return wrong && !(first == second && same_piece);
}

void Untangler::add(int part, int piece, const Push& push) {
  if (wrong_side_of_.empty()) {
    wrong_side_of_.assign(model_.shared->rest.size(), -1);
    piece_.assign(model_.shared->rest.size(), -1);
  }
  int& wrong_side_of = wrong_side_of_[static_cast<std::size_t>(push.vertex)];
  if (wrong_side_of >= 0) return;
  wrong_side_of = part;
  piece_[static_cast<std::size_t>(push.vertex)] = piece;
  mark_led(push.vertex);
  pushes_.push_back(push);
}

void Untangler::mark_led(int vertex) {
  if (led_.empty()) led_.assign(static_cast<std::size_t>(parts_.count), 0);
  led_[static_cast<std::size_t>(part_of(vertex))] = 1;
}

// ---------------------------------------------------------------- inside closed bodies

/// Finds vertices inside closed bodies, and adds a push that moves each out to where the thickness is kept.
void Untangler::find_inside(const Record* positions) {
  for (Closed& closed : closed_) {
    MeshQuery& query = *closed.query;
    query.move(places_of(positions, closed.first, static_cast<int>(query.positions().size())));
    std::vector<int> inside;
    for (const int v : vertices_) {
      const bool meets =
          model_.shared->rules.meet(model_.shared->vertex_body[static_cast<std::size_t>(v)], closed.body);
      if (positions[v].w > 0 && meets && query.is_inside(xyz(positions[v]))) inside.push_back(v);
    }
    inside_ += static_cast<std::int64_t>(inside.size());
    for (const Patch& patch : patches_of(model_, inside)) lead_out(patch, closed, positions);
  }
}

namespace {

/// A point inside a closed surface, the direction to the closest surface point, and its distance.
struct Depth {
  Vec3f from, out;  // position, and unit vector to the closest surface point
  float way;
};

/// The distance along a unit direction to the outside of a closed surface, at most `most` [m]. Each step is the
/// distance to the closest surface point, but not less than `least`.
float way_out(const MeshQuery& query, const Vec3f& from, const Vec3f& direction, float most) {
  const float least = 0.01f * most;
  float way = 0;
  while (way < most && query.is_inside(from + direction * way))
    way += max(query.closest(from + direction * way).distance, least);
  return min(way, most);
}

/// `normal` or its opposite, whichever moves all points out sooner; zero if that is much longer than the closest
/// distances.
Vec3f common_way(const MeshQuery& query, const std::vector<Depth>& patch, const Vec3f& normal) {
  float deepest = 0, along = 0, against = 0;
  for (const Depth& depth : patch) deepest = max(deepest, depth.way);
  const float most = 1.5f * deepest;
  for (const Depth& depth : patch) {
    along = max(along, way_out(query, depth.from, normal, most));
    against = max(against, way_out(query, depth.from, -normal, most));
  }
  if (min(along, against) >= most) return {};
  return along <= against ? normal : -normal;
}

}  // namespace

void Untangler::lead_out(const Patch& patch, const Closed& closed, const Record* positions) {
  const MeshQuery& query = *closed.query;
  std::vector<Depth> depths;
  float across = 0, all = 0;
  const Vec3f normal = mean_normal(model_, patch, positions);
  for (const int v : patch) {
    const Vec3f from = xyz(positions[v]);
    const SurfacePoint near = query.closest(from);
    depths.push_back({from, unit_or(near.point - from, Vec3f{0, 1, 0}), near.distance});
    across += near.distance * abs(dot(depths.back().out, normal));
    all += near.distance;
  }
  const bool is_cut_through = length_squared(normal) > 0 && across < 0.9f * all;
  const Vec3f common = is_cut_through ? common_way(query, depths, normal) : Vec3f{};
  for (std::size_t i = 0; i < patch.size(); ++i) {
    const int v = patch[i];
    const Depth& depth = depths[i];
    const bool together = length_squared(common) > 0;
    const float way = together ? way_out(query, depth.from, common, 1e30f) : depth.way;
    add(closed.part, closed.part, {v, together ? common : depth.out, way + thickness_of(model_, v, closed.body)});
  }
}

// ---------------------------------------------------------------- connected pieces

bool Untangler::is_closed(int part) const {
  return std::any_of(closed_.begin(), closed_.end(), [&](const Closed& closed) { return closed.part == part; });
}

void Untangler::find_pieces(const Record* positions, const std::vector<Intersection>& found) {
  std::map<std::pair<int, int>, std::vector<Intersection>> cuts;  // key: the parts of the edge and of the triangle
  for (const Intersection& one : found) {
    const int a = part_of(one.a), b = part_of(model_.elements.triangles[static_cast<std::size_t>(one.triangle)][0]);
    // Closed bodies need no rule of the smaller piece: find_inside tests each vertex exactly.
    if (!model_.shared->rules.is_immovable(body_of(one.a)) && !is_closed(b)) cuts[{a, b}].push_back(one);
    // The edge's vertices may already be outside; their part keeps the speed limit until the edge itself is outside.
    if (is_closed(b)) mark_led(one.a);
    if (is_closed(a)) mark_led(model_.elements.triangles[one.triangle][0]);
  }
  std::vector<Candidate> candidates;
  for (const auto& [parts, of_pair] : cuts) lead_back(positions, of_pair, parts, candidates);
  const std::vector<PartPair> worse = made_worse(positions, found, candidates);
  for (const Candidate& candidate : candidates)
    if (!std::binary_search(worse.begin(), worse.end(),
                            PartPair(std::minmax(part_of(candidate.push.vertex), candidate.through))))
      add(candidate.through, candidate.piece, candidate.push);
}

/// The pairs of parts, ascending, that would intersect more after all candidates have moved as far as they do in 1/60
/// s. The trial uses positions alone, so a restored State gives the same bits.
std::vector<Untangler::PartPair> Untangler::made_worse(const Record* positions, const std::vector<Intersection>& found,
                                                       const std::vector<Candidate>& candidates) {
  if (candidates.empty()) return {};
  std::vector<Vec3f> places = places_of(positions, 0, static_cast<int>(model_.shared->rest.size()));
  for (const Candidate& candidate : candidates)
    places[static_cast<std::size_t>(candidate.push.vertex)] +=
        candidate.push.direction * (model_.untangling_speed / 60);
  std::map<PartPair, int> more;
  for (const Intersection& one : found) --more[parts_of(one)];
  for (const Intersection& then : finder_.find(places)) {
    const int other = model_.elements.triangles[static_cast<std::size_t>(then.triangle)][0];
    if (model_.shared->rules.meet(body_of(then.a), body_of(other))) ++more[parts_of(then)];
  }
  std::vector<PartPair> worse;
  for (const auto& [parts, by] : more)
    if (by > 0) worse.push_back(parts);
  return worse;
}

namespace {

/// The connected components of a part that remain without its intersected edges: each vertex's component, and their
/// sizes.
struct Pieces {
  std::vector<int> of, size;

  int root(int v) const {
    while (of[static_cast<std::size_t>(v)] != v) v = of[static_cast<std::size_t>(v)];
    return v;
  }
};

Pieces pieces_of(const PairModel& model, const std::vector<int>& vertices, const std::vector<Intersection>& cuts,
                 const std::vector<int>& part_of, int part) {
  std::vector<std::pair<int, int>> cut;
  cut.reserve(cuts.size());
  for (const Intersection& one : cuts) cut.push_back(std::minmax(one.a, one.b));
  std::sort(cut.begin(), cut.end());
  Pieces pieces;
  for (int i = 0; i < static_cast<int>(model.shared->rest.size()); ++i) pieces.of.push_back(i);
  pieces.size.assign(model.shared->rest.size(), 0);
  for (const auto& [a, b] : model.elements.edges) {
    if (part_of[static_cast<std::size_t>(a)] != part || std::binary_search(cut.begin(), cut.end(), std::pair{a, b}))
      continue;
    const int from = pieces.root(a), to = pieces.root(b);
    pieces.of[static_cast<std::size_t>(std::max(from, to))] = std::min(from, to);
  }
  for (const int v : vertices) {
    const int root = pieces.of[static_cast<std::size_t>(v)] = pieces.root(v);
    if (part_of[static_cast<std::size_t>(v)] == part) ++pieces.size[static_cast<std::size_t>(root)];
  }
  return pieces;
}

}  // namespace

/// Adds as candidates the vertices of all pieces of a part except the largest: they may move back through the part that
/// cuts it.
void Untangler::lead_back(const Record* positions, const std::vector<Intersection>& cuts, PartPair parts,
                          std::vector<Candidate>& out) const {
  const auto [part, through] = parts;
  const Pieces pieces = pieces_of(model_, vertices_, cuts, parts_.of, part);
  const int largest_piece =
      static_cast<int>(std::max_element(pieces.size.begin(), pieces.size.end()) - pieces.size.begin());
  std::map<int, Vec3f> ways;
  for (const Intersection& cut : cuts) {
    const Triangle& t = model_.elements.triangles[cut.triangle];
    const Vec3f normal =
        cross(xyz(positions[t[1]]) - xyz(positions[t[0]]), xyz(positions[t[2]]) - xyz(positions[t[0]]));
    for (const auto& [from, to] : {std::pair{cut.a, cut.b}, {cut.b, cut.a}}) {
      const int piece = pieces.of[static_cast<std::size_t>(from)];
      if (piece == largest_piece || piece == pieces.of[static_cast<std::size_t>(to)]) continue;
      const bool with = dot(normal, xyz(positions[to]) - xyz(positions[from])) > 0;
      ways[piece] += unit_or(with ? normal : -normal, Vec3f{});
    }
  }
  for (const int v : vertices_) {
    const auto way = ways.find(pieces.of[static_cast<std::size_t>(v)]);
    if (way == ways.end() || !(positions[v].w > 0)) continue;
    out.push_back({{v, unit_or(way->second, Vec3f{0, 1, 0}), 1e30f}, through, way->first});
  }
}

// ---------------------------------------------------------------- substeps

void Untangler::push(float distance, float h, Record* displacements, Record* remainders) {
  for (auto& [v, speed] : speeds_) {
    const Record &d = displacements[v], &r = remainders[v];
    const bool is_wrong = !wrong_side_of_.empty() && wrong_side_of_[static_cast<std::size_t>(v)] >= 0;
    speed = is_wrong ? 0 : length(Vec3f{d.x - r.x, d.y - r.y, d.z - r.z}) / h;
  }
  for (Push& push : pushes_) {
    const Record& d = displacements[push.vertex];
    if (!(abs(d.x) + abs(d.y) + abs(d.z) < 1e30f)) continue;  // the end of the substep reports the position
    const float way = min(distance, push.remaining);
    push.remaining -= way;
    Record& r = remainders[push.vertex];
    r = {r.x + push.direction.x * way, r.y + push.direction.y * way, r.z + push.direction.z * way, r.w};
    displacements[push.vertex] = {r.x, r.y, r.z, 0};
  }
}

void Untangler::limit_speeds(float limit, Record* velocities, FunctionRef<Vec3f(int body)> missing) const {
  for (const auto& [v, speed] : speeds_) {
    const Vec3f lacks = missing(model_.shared->vertex_body[static_cast<std::size_t>(v)]);
    Record& r = velocities[v];
    const Vec3f velocity = Vec3f{r.x, r.y, r.z} + lacks;
    const float is = length(velocity), most = max(speed, limit);
    if (!(is > most)) continue;
    const Vec3f kept = velocity * (most / is) - lacks;
    r = {kept.x, kept.y, kept.z, r.w};
  }
}

}  // namespace pliant
