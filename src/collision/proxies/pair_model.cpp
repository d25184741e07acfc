// Which surfaces meet, and how.
#include "collision/proxies/pair_model.h"

#include <algorithm>
#include <map>
#include <string>

#include "math/vector.h"

namespace pliant {

namespace {

/// Beyond the largest thickness, pairs are listed within this share of the median edge, so that lists last for a while.
constexpr float skin_over_edge = 0.5f;

constexpr std::size_t vertices_in_a_cluster = 64;

bool is_immovable(const CompiledObject& object) {
  for (const Record& p : object.positions)
    if (p.w > 0) return false;
  return true;
}

/// Distance constraints that are no side of a triangle: ropes.
std::vector<std::array<int, 2>> lines_of(const CompiledObject& object, int first) {
  std::vector<std::array<int, 2>> lines;
  if (!object.surface.triangles.empty()) return lines;
  for (const auto& [a, b] : object.lines) lines.push_back({first + a, first + b});
  return lines;
}

/// What neither a triangle nor a line holds, targets of attachments left out: it meets triangles as a vertex.
void add_loose(const CompiledObject& object, int first, const std::vector<std::array<int, 2>>& lines,
               std::vector<int>& loose) {
  std::vector<char> held(static_cast<std::size_t>(object.particles), 0);
  for (const auto& t : object.surface.triangles)
    for (const int corner : t) held[static_cast<std::size_t>(corner)] = 1;
  for (const auto& [a, b] : lines)
    held[static_cast<std::size_t>(a - first)] = held[static_cast<std::size_t>(b - first)] = 1;
  for (int i = 0; i < object.particles; ++i)
    if (held[static_cast<std::size_t>(i)] == 0 && object.order[static_cast<std::size_t>(i)] < object.user_particles)
      loose.push_back(first + i);
}

ContactBody body_of(const CompiledObject& object) {
  ContactBody body;
  body.groups = object.groups;
  body.mask = object.mask;
  body.collides = object.collides;
  body.is_collider = object.is_collider;
  body.is_immovable = is_immovable(object);
  body.meets_itself = object.self_collision;
  body.thickness = object.thickness;
  body.static_friction = object.static_friction;
  body.kinetic_friction = object.kinetic_friction;
  body.restitution = object.restitution;
  return body;
}

/// What the scene says of a certain pair; a static friction given alone lowers the kinetic one where it must.
void apply(const PairProperties& said, PairMaterial& material) {
  material.thickness = said.thickness.value_or(material.thickness);
  material.static_friction = said.static_friction.value_or(material.static_friction);
  material.kinetic_friction = std::min(said.kinetic_friction.value_or(material.kinetic_friction), material.static_friction);
  material.restitution = said.restitution.value_or(material.restitution);
}

ContactRules make_rules(const Model& model) {
  ContactRules rules;
  std::map<std::string, std::vector<int>> named;
  for (const CompiledObject& object : model.objects) {
    named[object.name].push_back(rules.bodies());
    rules.add(body_of(object));
  }
  for (const PairProperties& pair : model.pairs)
    for (const int a : named[pair.first])
      for (const int b : named[pair.second]) {
        PairMaterial material = rules.material(a, b);
        apply(pair, material);
        rules.set_material(a, b, material);
      }
  return rules;
}

/// Cuts vertices, `from` to `to` - 1, across where they extend farthest until so many as make a cluster are left.
void split(PairModel& model, std::vector<int>& vertices, std::size_t from, std::size_t to) {
  const std::size_t pieces = (to - from + vertices_in_a_cluster - 1) / vertices_in_a_cluster;
  if (pieces <= 1) {
    for (std::size_t i = from; i < to; ++i) model.vertex_cluster[vertices[i]] = static_cast<int>(model.cluster_body.size());
    if (from < to) model.cluster_body.push_back(model.vertex_body[vertices[from]]);
    return;
  }
  const auto place = [&](int v, int axis) {
    return axis == 0 ? model.rest[v].x : axis == 1 ? model.rest[v].y : model.rest[v].z;
  };
  int longest = 0;
  float extent = -1;
  for (int axis = 0; axis < 3; ++axis) {
    float low = place(vertices[from], axis), high = low;
    for (std::size_t i = from; i < to; ++i) {
      low = min(low, place(vertices[i], axis));
      high = max(high, place(vertices[i], axis));
    }
    if (high - low > extent) {
      extent = high - low;
      longest = axis;
    }
  }
  const std::size_t middle = from + (to - from) * (pieces / 2) / pieces;
  const auto at = [&](std::size_t i) { return vertices.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(from), at(middle), at(to), [&](int a, int b) {
    return std::make_pair(place(a, longest), a) < std::make_pair(place(b, longest), b);
  });
  split(model, vertices, from, middle);
  split(model, vertices, middle, to);
}

/// Vertices of each body in compact clusters.
void make_clusters(PairModel& model) {
  std::vector<std::vector<int>> of_body(static_cast<std::size_t>(model.rules.bodies()));
  for (const int v : model.elements.vertices) of_body[model.vertex_body[v]].push_back(v);
  model.vertex_cluster.assign(model.rest.size(), -1);
  for (std::vector<int>& vertices : of_body) split(model, vertices, 0, vertices.size());
  model.clusters = static_cast<int>(model.cluster_body.size());
  for (const Triangle& t : model.elements.triangles) model.triangle_cluster.push_back(model.vertex_cluster[t[0]]);
  for (const auto& edge : model.elements.edges) model.edge_cluster.push_back(model.vertex_cluster[edge[0]]);
}

float median_edge(const PairModel& model) {
  std::vector<float> lengths;
  for (const auto& [a, b] : model.elements.edges) {
    const Record &p = model.rest[a], &q = model.rest[b];
    lengths.push_back(length(Vec3f{p.x - q.x, p.y - q.y, p.z - q.z}));
  }
  if (lengths.empty()) return 0;
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return *middle;
}

/// About the length of a cluster's edges: a cluster of compact shape is some eight edges wide.
std::vector<float> coarsest_roundings(const PairModel& model, float edge) {
  std::vector<Vec3f> low(static_cast<std::size_t>(model.clusters), Vec3f{1e30f, 1e30f, 1e30f}), high = low;
  for (Vec3f& corner : high) corner = -corner;
  for (const int v : model.elements.vertices) {
    const Record& r = model.rest[v];
    const auto c = static_cast<std::size_t>(model.vertex_cluster[v]);
    low[c] = min(low[c], Vec3f{r.x, r.y, r.z});
    high[c] = max(high[c], Vec3f{r.x, r.y, r.z});
  }
  std::vector<float> coarsest;
  for (std::size_t c = 0; c < low.size(); ++c) {
    const Vec3f size = high[c] - low[c];
    coarsest.push_back(max(edge, max(size.x, max(size.y, size.z)) / 8));
  }
  return coarsest;
}

}  // namespace

namespace {

/// Free particles that may meet others: those of bodies that meet themselves, and of all where there are several such bodies.
void add_free_points(const Model& model, PairModel& out, const std::vector<char>& meets_some) {
  std::vector<int> bodies;
  for (int o = 0; o < out.rules.bodies(); ++o) {
    const CompiledObject& object = model.objects[o];
    if (meets_some[o] != 0 && object.surface.triangles.empty() && object.lines.empty()) bodies.push_back(o);
  }
  if (bodies.size() == 1 && !out.rules.meet(bodies[0], bodies[0])) return;
  for (const int o : bodies)
    for (int i = 0; i < model.objects[o].particles; ++i)
      if (model.objects[o].order[static_cast<std::size_t>(i)] < model.objects[o].user_particles)
        out.free_points.push_back(model.first[o] + i);
}

}  // namespace

std::unique_ptr<PairModel> make_pair_model(const Model& model, const Records& positions) {
  auto out = std::make_unique<PairModel>();
  out->rules = make_rules(model);
  out->largest_thickness = out->rules.largest_thickness();
  const std::vector<char> meets_some = out->rules.meeting();
  if (std::find(meets_some.begin(), meets_some.end(), 1) == meets_some.end()) return nullptr;
  out->rest.assign(positions.begin(), positions.end());
  out->vertex_body.assign(positions.size(), -1);
  std::vector<Triangle> triangles;
  std::vector<std::array<int, 2>> lines;
  std::vector<int> loose;
  for (int o = 0; o < out->rules.bodies(); ++o) {
    const int first = model.first[o];
    std::fill(out->vertex_body.begin() + first, out->vertex_body.begin() + model.end_of(o), o);
    if (meets_some[o] == 0) continue;
    for (const auto& t : model.objects[o].surface.triangles)
      triangles.push_back({first + t[0], first + t[1], first + t[2]});
    const auto more = lines_of(model.objects[o], first);
    lines.insert(lines.end(), more.begin(), more.end());
    add_loose(model.objects[o], first, more, loose);
  }
  add_free_points(model, *out, meets_some);
  if (triangles.empty() && lines.empty() && out->free_points.empty()) return nullptr;
  out->elements = make_contact_elements(triangles, lines, loose, static_cast<int>(positions.size()));
  make_clusters(*out);
  const float edge = median_edge(*out);
  out->radius = out->largest_thickness + skin_over_edge * edge;
  if (edge > 0) out->coarsest = coarsest_roundings(*out, edge);
  return out;
}

}  // namespace pliant
