// Builds the contact model: which surfaces can meet, and their contact parameters.
#include "collision/proxies/pair_model.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

#include "collision/proxies/body_clusters.h"

namespace pliant {

namespace {

/// Pairs are listed up to the largest thickness plus this share of the median edge, so that lists stay valid for a
/// while.
constexpr float skin_over_edge = 0.5f;

/// Rounding limit of a cluster without edges: its size does not say which rounding is too coarse.
constexpr float no_limit = 1e30f;

/// The search radius is kept while the median edge differs by less than this factor from the one that the radius came
/// from.
constexpr float radius_slack = 1.5f;

/// The primitives of one object, with vertices numbered from its first particle. Targets of attachments are left out.
ContactElements elements_of(const CompiledObject& object) {
  std::vector<Triangle> triangles(object.surface.triangles.begin(), object.surface.triangles.end());
  // Objects without triangles (ropes) have their distance constraints as edges.
  const std::vector<std::array<int, 2>> lines = triangles.empty() ? object.lines : std::vector<std::array<int, 2>>{};
  std::vector<int> all;
  for (int i = 0; i < object.particles; ++i)
    if (object.order[static_cast<std::size_t>(i)] < object.user_particles && !object.bodies.has_centre(i))
      all.push_back(i);
  return make_contact_elements(triangles, lines, all, object.particles);
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
  for (const auto& [number, body] : model.bodies) {
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
  const float thickness = model.shared->rules.largest_thickness(model.members), edge = median_edge(model),
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

void fit_arrays(PairModel& model) {
  ContactElements& all = model.elements;
  all.vertex_count = static_cast<int>(model.shared->rest.size());
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
  const BodyElements had = model.bodies.at(body);
  clear(model.elements.edges, had.edges, {-1, -1});
  clear(model.edge_cluster, had.edges, -1);
  clear(model.elements.triangles, had.triangles, {-1, -1, -1});
  clear(model.triangle_cluster, had.triangles, -1);
  clear(model.cluster_body, had.clusters, -1);
  model.edge_blocks.release(body);
  model.triangle_blocks.release(body);
  model.cluster_blocks.release(body);
  model.bodies.erase(body);
}

/// Adds a body's primitives and clusters.
void add_body(const Model& model, int body, PairModel& out) {
  const CompiledObject& object = model.objects[body];
  BodyElements& of = out.bodies[body];  // valid until another body is added
  of.vertices = {model.first[body], object.particles};
  std::copy(object.positions.begin(), object.positions.end(), out.shared->rest.begin() + of.vertices.first);
  clear(out.shared->vertex_body, of.vertices, body);
  const ContactElements own = elements_of(object);
  const Clusters clusters = find_clusters(own, object.positions);
  of.median_edge = median_edge(own.edges, object.positions);
  of.edges = out.edge_blocks.take(body, static_cast<int>(own.edges.size()));
  of.triangles = out.triangle_blocks.take(body, static_cast<int>(own.triangles.size()));
  of.clusters = out.cluster_blocks.take(body, clusters.count);
  fit_arrays(out);
  const int first = of.vertices.first;
  const auto number = [&](int vertex) {
    return clusters.of[vertex] < 0 ? -1 : of.clusters.first + clusters.of[vertex];
  };
  for (int v = 0; v < of.vertices.size; ++v) out.shared->vertex_cluster[first + v] = number(v);
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

/// Appends the particles of an object that are in no body.
void append_points(const Model& model, int object, std::vector<int>& points) {
  const CompiledObject& of = model.objects[object];
  for (int i = 0; i < of.particles; ++i)
    if (of.order[static_cast<std::size_t>(i)] < of.user_particles && !of.bodies.has_centre(i))
      points.push_back(model.first[object] + i);
}

/// Lists free particles that can meet others: of objects with self-collision, or that meet other objects of free
/// particles or lines. Lists the lines that free particles meet.
void find_free_points(const Model& model, PairModel& out) {
  out.free_points.clear();
  out.points_at_lines.clear();
  out.lines.clear();
  std::vector<int> bodies, of_lines;
  for (const auto& [number, body] : out.bodies) {
    const CompiledObject& object = model.objects[number];
    if (object.surface.triangles.empty()) (object.lines.empty() ? bodies : of_lines).push_back(number);
  }
  const auto meets_any = [&](int o, const std::vector<int>& of) {
    return std::any_of(of.begin(), of.end(), [&](int other) { return out.shared->rules.meet(o, other); });
  };
  for (const int o : bodies) {
    if (meets_any(o, bodies)) append_points(model, o, out.free_points);
    if (meets_any(o, of_lines)) append_points(model, o, out.points_at_lines);
  }
  for (const int o : of_lines) {
    const Block block = out.bodies.at(o).edges;
    const auto first = out.elements.edges.begin() + block.first;
    if (meets_any(o, bodies)) out.lines.insert(out.lines.end(), first, first + block.size);
  }
}

void order_clusters(PairModel& model) {
  model.cluster_order.clear();
  for (const auto& [number, body] : model.bodies)
    for (int c = body.clusters.first; c < body.clusters.end(); ++c) model.cluster_order.push_back(c);
}

/// Numbers the sets of the members that meet some, in the order of their first such members.
void number_sets(const std::vector<char>& meets_some, PairModel& model) {
  const std::vector<int> first_of = model.shared->rules.sets(model.members);
  std::vector<int> numbers(first_of.size(), -1);
  model.sets = 0;
  for (std::size_t i = 0; i < first_of.size(); ++i) {
    int& of_body = model.shared->body_set[static_cast<std::size_t>(model.members[i])];
    of_body = -1;
    if (meets_some[i] == 0) continue;
    int& of_set = numbers[static_cast<std::size_t>(first_of[i])];
    if (of_set < 0) of_set = model.sets++;
    of_body = of_set;
  }
}

/// All bodies of a model, ascending.
std::vector<int> all_bodies(std::size_t count) {
  std::vector<int> all(count);
  std::iota(all.begin(), all.end(), 0);
  return all;
}

/// False if an object has only the centres of rigid bodies, whose contact is elsewhere (solver/bodies/).
bool has_elements(const CompiledObject& object) {
  if (!object.surface.triangles.empty() || !object.lines.empty()) return true;
  return object.particles > static_cast<int>(object.bodies.bodies.size());
}

/// The members that meet others or themselves, ascending; numbers the sets that they form.
std::vector<int> find_meeting(const Model& model, PairModel& out) {
  std::vector<int> candidates, meeting;
  for (const int o : out.members)
    if (has_elements(model.objects[o])) candidates.push_back(o);
  const std::vector<char> meets = out.shared->rules.meeting(candidates);
  for (std::size_t i = 0; i < candidates.size(); ++i)
    if (meets[i] != 0) meeting.push_back(candidates[i]);
  std::vector<char> meets_some;
  for (const int o : out.members) meets_some.push_back(std::binary_search(meeting.begin(), meeting.end(), o) ? 1 : 0);
  number_sets(meets_some, out);
  return meeting;
}

/// The bodies to remove or to add: those changed, and those that begin or cease to meet others.
std::vector<int> find_affected(const PairModel& model, const std::vector<int>& changed,
                               const std::vector<int>& meeting) {
  std::vector<int> affected = changed, present;
  present.reserve(meeting.size());
  for (const auto& [body, elements] : model.bodies) present.push_back(body);
  std::set_symmetric_difference(meeting.begin(), meeting.end(), present.begin(), present.end(),
                                std::back_inserter(affected));
  std::sort(affected.begin(), affected.end());
  affected.erase(std::unique(affected.begin(), affected.end()), affected.end());
  return affected;
}

}  // namespace

std::optional<PairChanges> update_pair_model(const Model& model, const std::vector<int>& changed, PairModel& out) {
  if (out.has_all) out.members = all_bodies(model.objects.size());
  const std::vector<int> meeting = find_meeting(model, out), affected = find_affected(out, changed, meeting);
  PairChanges changes;
  for (const int body : affected) {
    if (!out.bodies.has(body)) continue;
    changes.removed.push_back(body);
    changes.clusters.push_back(out.bodies.at(body).clusters);
    remove_body(body, out);
  }
  fit_arrays(out);
  for (const int body : affected) {
    if (!std::binary_search(meeting.begin(), meeting.end(), body)) continue;
    add_body(model, body, out);
    changes.added.push_back(body);
  }
  fit_arrays(out);
  order_clusters(out);
  find_free_points(model, out);
  changes.radius = update_radius(out);
  if (out.edge_blocks.end() == 0 && out.free_points.empty()) return std::nullopt;
  return changes;
}

std::unique_ptr<PairModel> make_pair_model(const Model& model, std::shared_ptr<ContactTables> tables,
                                           const std::vector<int>* members) {
  auto out = std::make_unique<PairModel>(std::move(tables));
  out->has_all = members == nullptr;
  if (members != nullptr) out->members = *members;
  return update_pair_model(model, {}, *out) ? std::move(out) : nullptr;
}

std::unique_ptr<PairModel> make_pair_model(const Model& model) {
  auto tables = std::make_shared<ContactTables>();
  update_tables(model, {}, *tables);
  return make_pair_model(model, std::move(tables), nullptr);
}

namespace {

/// Sets each body's block of one array, in which the entries of a body are contiguous.
template <class BodyOf>
void index_entries(std::size_t count, BodyOf body_of, BodyBlocks& blocks, Block BodyElements::*block,
                   PairModel& model) {
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
  const ContactTables& shared = *model.shared;
  model.members = all_bodies(static_cast<std::size_t>(shared.rules.bodies()));
  model.shared->body_set.resize(model.members.size());
  number_sets(std::vector<char>(model.members.size(), 1), model);
  BodyBlocks vertex_blocks;
  const auto body_at = [&](std::size_t i) { return shared.vertex_body[i]; };
  index_entries(shared.rest.size(), body_at, vertex_blocks, &BodyElements::vertices, model);
  const auto body_of_edge = [&](std::size_t i) { return shared.vertex_body[all.edges[i][0]]; };
  index_entries(all.edges.size(), body_of_edge, model.edge_blocks, &BodyElements::edges, model);
  const auto body_of_triangle = [&](std::size_t i) { return shared.vertex_body[all.triangles[i][0]]; };
  index_entries(all.triangles.size(), body_of_triangle, model.triangle_blocks, &BodyElements::triangles, model);
  const auto body_of_cluster = [&](std::size_t i) { return model.cluster_body[i]; };
  index_entries(model.cluster_body.size(), body_of_cluster, model.cluster_blocks, &BodyElements::clusters, model);
  for (const auto& [number, body] : model.bodies) model.triangles_around.add(all, body.triangles, body.vertices);
  order_clusters(model);
}

}  // namespace pliant
