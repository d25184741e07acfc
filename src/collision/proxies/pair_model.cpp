// Builds the contact model: which surfaces can meet, and their contact parameters.
#include "collision/proxies/pair_model.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <string>

#include "collision/proxies/body_clusters.h"

namespace pliant {

namespace {

/// Pairs are listed up to the largest thickness plus this share of the median edge, so that lists stay valid for a while.
constexpr float skin_over_edge = 0.5f;

/// Rounding limit of a cluster without edges: its size does not say which rounding is too coarse.
constexpr float no_limit = 1e30f;

/// The search radius is kept while the median edge differs by less than this factor from the one that the radius came
/// from.
constexpr float radius_slack = 1.5f;

bool is_immovable(const CompiledObject& object) {
  for (const Record& p : object.positions)
    if (p.w > 0) return false;
  return true;
}

/// The primitives of one object, with vertices numbered from its first particle. Targets of attachments are left out.
ContactElements elements_of(const CompiledObject& object) {
  std::vector<Triangle> triangles(object.surface.triangles.begin(), object.surface.triangles.end());
  // Objects without triangles (ropes) have their distance constraints as edges.
  const std::vector<std::array<int, 2>> lines = triangles.empty() ? object.lines : std::vector<std::array<int, 2>>{};
  std::vector<int> all;
  for (int i = 0; i < object.particles; ++i)
    if (object.order[static_cast<std::size_t>(i)] < object.user_particles) all.push_back(i);
  return make_contact_elements(triangles, lines, all, object.particles);
}

ContactBody body_of(const Model& model, int number, const std::vector<char>& has) {
  const CompiledObject& object = model.objects[number];
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
  const bool is_there = object.particles > 0;  // or it was removed
  if (is_there && (has.empty() || has[number] != 0)) return body;
  body.groups = body.mask = 0;
  body.meets_itself = false;
  return body;
}

/// Applies the scene's override of a pair's material. If only the static friction is given, the kinetic one is at most
/// that.
void apply(const PairProperties& said, PairMaterial& material) {
  material.thickness = said.thickness.value_or(material.thickness);
  material.static_friction = said.static_friction.value_or(material.static_friction);
  material.kinetic_friction = std::min(said.kinetic_friction.value_or(material.kinetic_friction), material.static_friction);
  material.restitution = said.restitution.value_or(material.restitution);
}

/// Applies the overrides of pairs that the scene names.
void set_exceptions(const Model& model, ContactRules& rules) {
  std::map<std::string, std::vector<int>> named;
  for (int o = 0; o < rules.bodies(); ++o) named[model.objects[o].name].push_back(o);
  for (const PairProperties& pair : model.pairs)
    for (const int a : named[pair.first])
      for (const int b : named[pair.second]) {
        PairMaterial material = rules.material(a, b);
        apply(pair, material);
        rules.set_material(a, b, material);
      }
}

/// Updates the changed bodies. If the scene names pairs, all rules are rebuilt, because overrides refer to names of
/// objects.
void update_rules(const Model& model, const std::vector<int>& changed, PairModel& out) {
  ContactRules& rules = out.rules;
  if (!model.pairs.empty()) rules = {};
  for (int o = rules.bodies(); o < static_cast<int>(model.objects.size()); ++o) rules.add(body_of(model, o, out.has));
  if (!model.pairs.empty()) return set_exceptions(model, rules);
  for (const int o : changed) rules.set(o, body_of(model, o, out.has));
}

float median_edge(const std::vector<std::array<int, 2>>& edges, const std::vector<Record>& positions) {
  std::vector<float> lengths;
  lengths.reserve(edges.size());
  for (const auto& [a, b] : edges) {
    const Record &p = positions[a], &q = positions[b];
    lengths.push_back(length(Vec3f{p.x - q.x, p.y - q.y, p.z - q.z}));
  }
  if (lengths.empty()) return 0;
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return *middle;
}

/// The median of the bodies' median edge lengths, each weighted by the body's number of edges [m].
float median_edge(const PairModel& model) {
  std::vector<std::pair<float, int>> medians;
  std::int64_t count = 0;
  for (const BodyElements& body : model.bodies) {
    if (body.edges.size == 0) continue;
    medians.emplace_back(body.median_edge, body.edges.size);
    count += body.edges.size;
  }
  std::sort(medians.begin(), medians.end());
  std::int64_t below = 0;
  for (const auto& [edge, edges] : medians) {
    below += edges;
    if (2 * below > count) return edge;
  }
  return 0;
}

/// Updates the search radius and returns true if it changed. The radius affects only speed.
bool update_radius(PairModel& model) {
  const float thickness = model.rules.largest_thickness(), edge = median_edge(model),
              before = (model.radius - model.largest_thickness) / skin_over_edge;
  const bool is_kept =
      thickness == model.largest_thickness && edge <= before * radius_slack && before <= edge * radius_slack;
  model.largest_thickness = thickness;
  if (!is_kept) model.radius = thickness + skin_over_edge * edge;
  return !is_kept;
}

template <class T>
void fit(std::vector<T>& list, std::size_t size, const T& hole) {
  list.resize(size, hole);
}

void fit_arrays(std::size_t particles, PairModel& model) {
  ContactElements& all = model.elements;
  all.vertex_count = static_cast<int>(particles);
  fit(model.rest, particles, Record{});
  fit(model.vertex_body, particles, -1);
  fit(model.vertex_cluster, particles, -1);
  fit(all.edges, model.edge_blocks.end(), {-1, -1});
  fit(model.edge_cluster, all.edges.size(), -1);
  fit(all.triangles, model.triangle_blocks.end(), {-1, -1, -1});
  fit(model.triangle_cluster, all.triangles.size(), -1);
  model.clusters = static_cast<int>(model.cluster_blocks.end());
  fit(model.cluster_body, model.cluster_blocks.end(), -1);
  fit(model.coarsest, model.cluster_blocks.end(), 0.f);
}

template <class T>
void clear(std::vector<T>& list, const Block& block, const T& hole) {
  std::fill_n(list.begin() + block.first, block.size, hole);
}

void remove_body(int body, PairModel& model) {
  const BodyElements had = model.bodies[body];
  clear(model.rest, had.vertices, Record{});
  clear(model.vertex_body, had.vertices, -1);
  clear(model.vertex_cluster, had.vertices, -1);
  clear(model.elements.edges, had.edges, {-1, -1});
  clear(model.edge_cluster, had.edges, -1);
  clear(model.elements.triangles, had.triangles, {-1, -1, -1});
  clear(model.triangle_cluster, had.triangles, -1);
  clear(model.cluster_body, had.clusters, -1);
  model.edge_blocks.release(body);
  model.triangle_blocks.release(body);
  model.cluster_blocks.release(body);
  model.bodies[body] = {};
}

/// Adds a body's particles and, if it meets any body, its primitives and clusters.
void add_body(const Model& model, int body, bool meets, PairModel& out) {
  const CompiledObject& object = model.objects[body];
  BodyElements& of = out.bodies[body];
  of.vertices = {model.first[body], object.particles};
  std::copy(object.positions.begin(), object.positions.end(), out.rest.begin() + of.vertices.first);
  clear(out.vertex_body, of.vertices, body);
  if (!meets) return;
  const ContactElements own = elements_of(object);
  const Clusters clusters = find_clusters(own, object.positions);
  of.median_edge = median_edge(own.edges, object.positions);
  of.edges = out.edge_blocks.take(body, static_cast<int>(own.edges.size()));
  of.triangles = out.triangle_blocks.take(body, static_cast<int>(own.triangles.size()));
  of.clusters = out.cluster_blocks.take(body, clusters.count);
  fit_arrays(out.rest.size(), out);
  const int first = of.vertices.first;
  const auto number = [&](int vertex) { return clusters.of[vertex] < 0 ? -1 : of.clusters.first + clusters.of[vertex]; };
  for (int v = 0; v < of.vertices.size; ++v) out.vertex_cluster[first + v] = number(v);
  for (int e = 0; e < of.edges.size; ++e) {
    const auto [a, b] = own.edges[e];
    out.elements.edges[of.edges.first + e] = {first + a, first + b};
    out.edge_cluster[of.edges.first + e] = number(a);
  }
  for (int t = 0; t < of.triangles.size; ++t) {
    const Triangle& corners = own.triangles[t];
    out.elements.triangles[of.triangles.first + t] = {first + corners[0], first + corners[1], first + corners[2]};
    out.triangle_cluster[of.triangles.first + t] = number(corners[0]);
  }
  for (int c = 0; c < of.clusters.size; ++c) {
    out.cluster_body[of.clusters.first + c] = body;
    out.coarsest[of.clusters.first + c] = of.edges.size > 0 ? max(of.median_edge, clusters.extent[c] / 8) : no_limit;
  }
  out.triangles_around.add(out.elements, of.triangles, of.vertices);
}

/// Lists free particles that can meet others: of bodies with self-collision, or of all bodies if there are several.
void find_free_points(const Model& model, const std::vector<char>& meets_some, PairModel& out) {
  out.free_points.clear();
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

void order_clusters(PairModel& model) {
  model.cluster_order.clear();
  for (const BodyElements& body : model.bodies)
    for (int c = body.clusters.first; c < body.clusters.end(); ++c) model.cluster_order.push_back(c);
}

/// Numbers the sets of the bodies that meet some, in the order of their first such bodies.
void number_sets(const std::vector<char>& meets_some, PairModel& model) {
  const std::vector<int> first_body = model.rules.sets();
  std::vector<int> number(first_body.size(), -1);
  model.body_set.assign(first_body.size(), -1);
  model.sets = 0;
  for (std::size_t body = 0; body < first_body.size(); ++body) {
    if (meets_some[body] == 0) continue;
    int& of_set = number[static_cast<std::size_t>(first_body[body])];
    if (of_set < 0) of_set = model.sets++;
    model.body_set[body] = of_set;
  }
}

bool takes_part(const PairModel& model, int body) { return model.bodies[body].clusters.size > 0; }

}  // namespace

std::optional<PairChanges> update_pair_model(const Model& model, const std::vector<int>& changed, PairModel& out) {
  update_rules(model, changed, out);
  const std::vector<char> meets_some = out.rules.meeting();
  std::vector<int> affected = changed;
  out.bodies.resize(meets_some.size());
  number_sets(meets_some, out);
  for (int o = 0; o < out.rules.bodies(); ++o) {
    const bool has_particles = model.objects[o].particles > 0;
    if ((meets_some[o] != 0 && has_particles) != takes_part(out, o)) affected.push_back(o);
  }
  std::sort(affected.begin(), affected.end());
  affected.erase(std::unique(affected.begin(), affected.end()), affected.end());
  PairChanges changes;
  for (const int o : affected) {
    if (takes_part(out, o)) {
      changes.removed.push_back(o);
      changes.clusters.push_back(out.bodies[o].clusters);
    }
    remove_body(o, out);
  }
  fit_arrays(static_cast<std::size_t>(model.particles()), out);
  for (const int o : affected) {
    add_body(model, o, meets_some[o] != 0, out);
    if (takes_part(out, o)) changes.added.push_back(o);
  }
  fit_arrays(static_cast<std::size_t>(model.particles()), out);
  order_clusters(out);
  find_free_points(model, meets_some, out);
  changes.radius = update_radius(out);
  if (out.edge_blocks.end() == 0 && out.free_points.empty()) return std::nullopt;
  return changes;
}

std::unique_ptr<PairModel> make_pair_model(const Model& model, const std::vector<char>& has) {
  auto out = std::make_unique<PairModel>();
  out->has = has;
  std::vector<int> all(model.objects.size());
  std::iota(all.begin(), all.end(), 0);
  return update_pair_model(model, all, *out) ? std::move(out) : nullptr;
}

namespace {

/// Sets each body's block of one array, in which the entries of a body are contiguous.
template <class BodyOf>
void index_entries(std::size_t count, BodyOf body_of, BodyBlocks& blocks, Block BodyElements::*block, PairModel& model) {
  std::size_t first = 0;
  while (first < count) {
    const int body = body_of(first);
    std::size_t last = first;
    while (last < count && body_of(last) == body) ++last;
    model.bodies[body].*block = blocks.take(body, static_cast<int>(last - first));
    first = last;
  }
}

}  // namespace

void index_bodies(PairModel& model) {
  ContactElements& all = model.elements;
  model.bodies.assign(static_cast<std::size_t>(model.rules.bodies()), {});
  number_sets(std::vector<char>(model.bodies.size(), 1), model);
  BodyBlocks vertex_blocks;
  const auto body_at = [&](std::size_t i) { return model.vertex_body[i]; };
  index_entries(model.rest.size(), body_at, vertex_blocks, &BodyElements::vertices, model);
  const auto body_of_edge = [&](std::size_t i) { return model.vertex_body[all.edges[i][0]]; };
  index_entries(all.edges.size(), body_of_edge, model.edge_blocks, &BodyElements::edges, model);
  const auto body_of_triangle = [&](std::size_t i) { return model.vertex_body[all.triangles[i][0]]; };
  index_entries(all.triangles.size(), body_of_triangle, model.triangle_blocks, &BodyElements::triangles, model);
  const auto body_of_cluster = [&](std::size_t i) { return model.cluster_body[i]; };
  index_entries(model.cluster_body.size(), body_of_cluster, model.cluster_blocks, &BodyElements::clusters, model);
  for (const BodyElements& body : model.bodies) model.triangles_around.add(all, body.triangles, body.vertices);
  order_clusters(model);
}

}  // namespace pliant
