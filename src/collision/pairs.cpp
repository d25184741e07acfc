#include "collision/pairs.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "math/vector.h"

namespace pliant {

namespace {

constexpr int pairs_in_a_task = 4096;
/// Pairs stay active while all moves add up to less than this share of the skin.
constexpr float share_of_skin = 0.25f;
/// Nearer than any distance: to be measured before anything else.
constexpr float not_measured = -1e30f;
/// A contact keeps no more than this share of the distance that its primitives have at rest.
constexpr double share_of_rest = 0.9;
/// What the filter keeps, as a share of the thickness; and at least so many roundings of the positions.
constexpr float least_share = 0.05f, least_roundings = 32, rounding = 6e-8f;
/// Bounds of distances are floats: this much is allowed for their rounding.
constexpr float bound_slack = 1.0001f;

std::uint64_t key_of(int a, int b) { return (static_cast<std::uint64_t>(a) << 32) | static_cast<std::uint32_t>(b); }

void sort_out(std::vector<std::uint64_t>& keys) {
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
}

/// For each vertex the triangles at it, ascending.
IntLists triangles_around(const ContactElements& elements) {
  IntLists out;
  out.start.assign(static_cast<std::size_t>(elements.vertex_count) + 1, 0);
  for (const Triangle& t : elements.triangles)
    for (const int v : t) ++out.start[static_cast<std::size_t>(v) + 1];
  for (std::size_t i = 1; i < out.start.size(); ++i) out.start[i] += out.start[i - 1];
  out.items.resize(3 * elements.triangles.size());
  std::vector<int> next(out.start.begin(), out.start.end() - 1);
  for (std::size_t t = 0; t < elements.triangles.size(); ++t)
    for (const int v : elements.triangles[t]) out.items[next[v]++] = static_cast<int>(t);
  return out;
}

Vec3f end_of(const PairParticles& particles, std::size_t i, float times = 1) {
  const Record &x = particles.positions[i], &d = particles.displacements[i];
  return {x.x + d.x * times, x.y + d.y * times, x.z + d.z * times};
}

}  // namespace

PairSystem::PairSystem(const PairModel& model)
    : model_(model), finder_(model.elements), intersections_(model.elements.triangles, model.elements.vertex_count) {
  const auto bodies = static_cast<std::size_t>(model.bodies);
  vertex_move_.resize(model.rest.size());
  triangle_move_.resize(model.elements.triangles.size());
  edge_move_.resize(model.elements.edges.size());
  body_move_.resize(bodies);
  body_size_.assign(bodies, 0);
  for (const int v : model.elements.vertices) ++body_size_[model.vertex_body[v]];
  between_move_.resize(bodies * bodies);
  between_growth_.resize(bodies * bodies);
  growth_.resize(bodies);
  body_largest_.resize(bodies);
  share_.assign(model.rest.size(), 1.f);
}

// ---------------------------------------------------------------- lists

/// Where a value is not finite, the end of the substep says so; until then nothing is looked for.
bool PairSystem::is_finite(const PairParticles& particles) const {
  for (const int v : model_.elements.vertices) {
    const Vec3f p = end_of(particles, static_cast<std::size_t>(v));
    if (!(abs(p.x) < 1e14f && abs(p.y) < 1e14f && abs(p.z) < 1e14f)) return false;
  }
  return true;
}

PairStencil PairSystem::stencil(std::int32_t pair) const {
  const Pair& p = pairs_[pair];
  if (pair < vertex_pairs_) {
    const Triangle& t = model_.elements.triangles[p.b];
    return {{p.a, t[0], t[1], t[2]}, 1};
  }
  const auto &e = model_.elements.edges[p.a], &f = model_.elements.edges[p.b];
  return {{e[0], e[1], f[0], f[1]}, 2};
}

/// Whether every vertex ends its move within its box, grown by `margin` around the motion for which lists were made.
bool PairSystem::all_within(const PairParticles& particles, float margin) const {
  for (const int v : model_.elements.vertices) {
    const auto i = static_cast<std::size_t>(v);
    const Vec3f low = min(from_[i], to_[i]), high = max(from_[i], to_[i]);
    for (const Vec3f& p : {end_of(particles, i, 0), end_of(particles, i)}) {
      const float out = max(largest(max(low - p, Vec3f{})), largest(max(p - high, Vec3f{})));
      if (!(out <= margin)) return false;
    }
  }
  return true;
}

void PairSystem::append(const IntLists& lists, const std::vector<std::uint64_t>& tangled) {
  for (int element = 0; element + 1 < static_cast<int>(lists.start.size()); ++element) {
    const auto first = static_cast<std::int32_t>(pairs_.size());
    for (const int* other = lists.begin(element); other != lists.end(element); ++other)
      if (!std::binary_search(tangled.begin(), tangled.end(), key_of(element, *other)))
        pairs_.push_back({element, *other, not_measured, -1});
    const auto last = static_cast<std::int32_t>(pairs_.size());
    if (first < last) owners_.push_back({element, first, last, not_measured});
  }
}

void PairSystem::cut_into_tasks() {
  std::size_t tasks = 0;
  for (int owner = 0; owner < static_cast<int>(owners_.size()); ++tasks) {
    if (tasks_.size() <= tasks) tasks_.emplace_back();
    tasks_[tasks].first = owner;
    // Vertices and edges are not mixed: sixteen of one kind are measured at once.
    const bool vertices = owners_[owner].first < vertex_pairs_;
    const std::int32_t first = owners_[owner].first;
    while (owner < static_cast<int>(owners_.size()) && owners_[owner].last - first <= pairs_in_a_task &&
           (owners_[owner].first < vertex_pairs_) == vertices)
      ++owner;
    if (owner == tasks_[tasks].first) ++owner;
    tasks_[tasks].last = owner;
  }
  tasks_.resize(tasks);
}

void PairSystem::rebuild(Executor& executor, const PairParticles& particles) {
  from_.resize(model_.rest.size());
  to_.resize(model_.rest.size());
  for (std::size_t i = 0; i < from_.size(); ++i) {
    from_[i] = end_of(particles, i, 0);
    to_[i] = end_of(particles, i, particles.ahead);
  }
  finder_.find(executor, from_, to_, model_.radius, true);
  pairs_.clear();
  owners_.clear();
  vertex_pairs_ = std::numeric_limits<std::int32_t>::max();
  append(finder_.vertex_triangles(), tangled_pairs_);
  vertex_pairs_ = static_cast<std::int32_t>(pairs_.size());
  append(finder_.edge_edges(), tangled_edges_);
  cut_into_tasks();
  vertex_sum_.assign(vertex_move_.size(), 0.f);
  triangle_sum_.assign(triangle_move_.size(), 0.f);
  edge_sum_.assign(edge_move_.size(), 0.f);
  between_sum_.assign(between_move_.size(), 0.f);
  listed_ = true;
  active_ = false;
  ++counts_.rebuilds;
  counts_.candidates = static_cast<std::int64_t>(pairs_.size());
}

// ---------------------------------------------------------------- bounds of distances

void PairSystem::measure_moves(Executor& executor, const PairParticles& particles) {
  const ContactElements& elements = model_.elements;
  std::fill(body_move_.begin(), body_move_.end(), Vec3d{});
  for (const int v : elements.vertices) {
    const Record& d = particles.displacements[v];
    body_move_[model_.vertex_body[v]] += Vec3d{double(d.x), double(d.y), double(d.z)};
  }
  for (std::size_t b = 0; b < body_move_.size(); ++b)
    body_move_[b] = body_size_[b] > 0 ? body_move_[b] * (1. / body_size_[b]) : Vec3d{};
  std::fill(body_largest_.begin(), body_largest_.end(), 0.f);
  for (std::size_t a = 0; a < body_move_.size(); ++a)
    for (std::size_t b = 0; b < body_move_.size(); ++b)
      between_move_[a * body_move_.size() + b] = static_cast<float>(length(body_move_[a] - body_move_[b])) * bound_slack;
  constexpr int block = 4096;
  const auto each = [&](std::size_t n, const auto& body) {
    executor.parallel_for("contact bounds", static_cast<int>((n + block - 1) / block), [&](int task) {
      const std::size_t first = static_cast<std::size_t>(task) * block;
      for (std::size_t i = first; i < std::min(n, first + block); ++i) body(i);
    });
  };
  each(elements.vertices.size(), [&](std::size_t i) {
    const int v = elements.vertices[i];
    const Record& d = particles.displacements[v];
    const Vec3f mean = convert<float>(body_move_[model_.vertex_body[v]]);
    vertex_move_[v] = length(Vec3f{d.x, d.y, d.z} - mean) * bound_slack + 1e-12f;
  });
  for (const int v : elements.vertices) {
    float& most = body_largest_[model_.vertex_body[v]];
    most = max(most, vertex_move_[v]);
  }
  each(triangle_move_.size(), [&](std::size_t i) {
    const Triangle& t = elements.triangles[i];
    triangle_move_[i] = max(max(vertex_move_[t[0]], vertex_move_[t[1]]), vertex_move_[t[2]]);
  });
  each(edge_move_.size(),
       [&](std::size_t i) { edge_move_[i] = max(vertex_move_[elements.edges[i][0]], vertex_move_[elements.edges[i][1]]); });
}

/// The substep's moves have been made.
void PairSystem::settle_moves(Executor& executor, const PairParticles& particles) {
  measure_moves(executor, particles);
  const auto add = [](std::vector<float>& to, const std::vector<float>& from) {
    for (std::size_t i = 0; i < to.size(); ++i) to[i] = (to[i] + from[i]) * (1 + 1e-7f);
  };
  add(vertex_sum_, vertex_move_);
  add(triangle_sum_, triangle_move_);
  add(edge_sum_, edge_move_);
  add(between_sum_, between_move_);
  add(growth_, body_largest_);
  add(between_growth_, between_move_);
}

/// Pairs of the task that may come within their thickness, or the filter's least distance, while all moves add up to less than
/// `margin`: what is looked at until then.
void PairSystem::activate_task(Task& task, const PairParticles& particles, float margin) {
  task.near.clear();
  for (int number = task.first; number < task.last; ++number) {
    const Owner& owner = owners_[number];
    const bool is_vertex = owner.first < vertex_pairs_;
    const int a = is_vertex ? model_.vertex_body[owner.element] : model_.edge_body[owner.element];
    const float own = is_vertex ? vertex_sum_[owner.element] : edge_sum_[owner.element];
    if (owner.reach - own - margin > owner_other_[2 * a + (is_vertex ? 0 : 1)]) continue;
    for (std::int32_t p = owner.first; p < owner.last; ++p) {
      const Pair& pair = pairs_[p];
      const int b = is_vertex ? model_.triangle_body[pair.b] : model_.edge_body[pair.b];
      const float other = is_vertex ? triangle_sum_[pair.b] : edge_sum_[pair.b];
      const float since = own + other + (a == b ? 0 : between_sum_[static_cast<std::size_t>(a) * model_.bodies + b]);
      if (pair.reach - since - margin <= material(a, b).thickness) task.near.push_back(p);
    }
  }
  measure(task, particles, [&](std::int32_t, const PairStencil&, const PairBatch&, int) {});
  task.active.clear();
  for (const std::int32_t p : task.near) {
    const PairMaterial& of = material(body_of_first(p), body_of_second(p));
    if (pairs_[p].reach - sums(p) - margin <= of.thickness) task.active.push_back(p);
  }
  for (int number = task.first; number < task.last; ++number) {
    Owner& owner = owners_[number];
    owner.reach = 1e30f;
    for (std::int32_t p = owner.first; p < owner.last; ++p) owner.reach = min(owner.reach, pairs_[p].reach);
  }
}

/// Distances of the task's `near`, sixteen at a time; visit(pair, stencil, batch, lane) each.
template <class Visit>
void PairSystem::measure(Task& task, const PairParticles& particles, Visit visit) {
  task.stencils.clear();
  for (const std::int32_t p : task.near) task.stencils.push_back(stencil(p));
  PairBatch batch;
  for (std::size_t i = 0; i < task.near.size(); i += 16) {
    const int count = static_cast<int>(std::min<std::size_t>(16, task.near.size() - i));
    pair_distances(&task.stencils[i], count, particles.positions, batch);
    for (int lane = 0; lane < count; ++lane) {
      const std::int32_t p = task.near[i + lane];
      pairs_[p].reach = batch.distance[lane] * (1 - 1e-5f) + sums(p);
      visit(p, task.stencils[i + lane], batch, lane);
    }
  }
}

/// What both sides of a pair have moved since lists were made, this substep left out.
float PairSystem::sums(std::int32_t pair) const {
  const Pair& p = pairs_[pair];
  const float own = pair < vertex_pairs_ ? vertex_sum_[p.a] + triangle_sum_[p.b] : edge_sum_[p.a] + edge_sum_[p.b];
  const int a = body_of_first(pair), b = body_of_second(pair);
  return a == b ? own : own + between_sum_[static_cast<std::size_t>(a) * model_.bodies + b];
}

/// What they move in this substep.
float PairSystem::moves(std::int32_t pair) const {
  const Pair& p = pairs_[pair];
  const float own = pair < vertex_pairs_ ? vertex_move_[p.a] + triangle_move_[p.b] : edge_move_[p.a] + edge_move_[p.b];
  const int a = body_of_first(pair), b = body_of_second(pair);
  return a == b ? own : own + between_move_[static_cast<std::size_t>(a) * model_.bodies + b];
}

/// Active pairs that can be nearer than `within(a, b)` of their bodies at the substep's end.
template <class Within>
void PairSystem::collect_near(Task& task, Within within) {
  task.near.clear();
  for (const std::int32_t p : task.active)
    if (pairs_[p].reach - sums(p) - moves(p) <= within(body_of_first(p), body_of_second(p))) task.near.push_back(p);
}

/// The most that any two things that meet can have come closer since pairs were made active, this substep included.
float PairSystem::largest_growth() const {
  float most = 0;
  for (int a = 0; a < model_.bodies; ++a)
    for (int b = 0; b < model_.bodies; ++b) {
      const std::size_t at = static_cast<std::size_t>(a) * model_.bodies + b;
      if (model_.meets[at] == 0) continue;
      const float own = (growth_[a] + body_largest_[a]) + (growth_[b] + body_largest_[b]);
      most = max(most, a == b ? own : own + (between_growth_[at] + between_move_[at]));
    }
  return most;
}

/// Sees to it that all pairs that can matter in this substep are active.
void PairSystem::activate(Executor& executor, const PairParticles& particles) {
  if (active_ && largest_growth() <= margin_) return;
  std::fill(growth_.begin(), growth_.end(), 0.f);
  std::fill(between_growth_.begin(), between_growth_.end(), 0.f);
  margin_ = max(share_of_skin * (model_.radius - model_.largest_thickness), 1.1f * largest_growth());
  bound_owners();
  executor.parallel_for("activate pairs", static_cast<int>(tasks_.size()),
                        [&](int task) { activate_task(tasks_[task], particles, margin_); });
  active_ = true;
}

/// What the other side of a body's pairs has moved at most, and how near it may be, for activate_task to look at owners alone.
void PairSystem::bound_owners() {
  const auto bodies = static_cast<std::size_t>(model_.bodies);
  body_triangle_.assign(bodies, 0.f);
  body_edge_.assign(bodies, 0.f);
  for (std::size_t i = 0; i < triangle_sum_.size(); ++i) {
    float& most = body_triangle_[model_.triangle_body[i]];
    most = max(most, triangle_sum_[i]);
  }
  for (std::size_t i = 0; i < edge_sum_.size(); ++i) {
    float& most = body_edge_[model_.edge_body[i]];
    most = max(most, edge_sum_[i]);
  }
  owner_other_.assign(2 * bodies, -1e30f);
  for (int a = 0; a < model_.bodies; ++a)
    for (int b = 0; b < model_.bodies; ++b) {
      const std::size_t at = static_cast<std::size_t>(a) * bodies + b;
      if (model_.meets[at] == 0) continue;
      const float more = material(a, b).thickness + (a == b ? 0 : between_sum_[at]);
      owner_other_[2 * a] = max(owner_other_[2 * a], body_triangle_[b] + more);
      owner_other_[2 * a + 1] = max(owner_other_[2 * a + 1], body_edge_[b] + more);
    }
}

float PairSystem::least_distance(int a, int b) const {
  return max(least_share * material(a, b).thickness, least_roundings * rounding * extent_);
}

// ---------------------------------------------------------------- contacts

void PairSystem::detect_task(Task& task, const PairParticles& particles) {
  task.contacts.clear();
  collect_near(task, [&](int a, int b) { return material(a, b).thickness; });
  measure(task, particles, [&](std::int32_t pair, const PairStencil& four, const PairBatch& at, int lane) {
    Pair& p = pairs_[pair];
    PairMaterial kept = material(body_of_first(pair), body_of_second(pair));
    const float nearest = at.distance[lane] * (1 - 1e-5f) - moves(pair);
    if (!(at.distance[lane] > 0) || nearest > kept.thickness) return;
    if (p.rest < 0) p.rest = static_cast<float>(share_of_rest * pair_distance(four, model_.rest.data()).distance);
    kept.thickness = min(kept.thickness, p.rest);
    if (nearest <= kept.thickness) task.contacts.push_back(make_contact(four, at, lane, kept, particles.h));
  });
}

void PairSystem::detect(Executor& executor, const PairParticles& particles) {
  contacts_.clear();
  if (!is_finite(particles)) return;
  const float margin = 0.5f * (model_.radius - model_.largest_thickness);
  if (!listed_ || !all_within(particles, margin)) rebuild(executor, particles);
  measure_moves(executor, particles);
  activate(executor, particles);
  executor.parallel_for("detect contacts", static_cast<int>(tasks_.size()),
                        [&](int task) { detect_task(tasks_[task], particles); });
  for (const Task& task : tasks_) contacts_.insert(contacts_.end(), task.contacts.begin(), task.contacts.end());
}

void PairSystem::project(const PairParticles& particles) {
  for (PairContact& contact : contacts_)
    project_contact(contact, particles.positions, particles.remainders, particles.displacements);
}

void PairSystem::respond(const Record* positions, Record* velocities) const {
  for (const PairContact& contact : contacts_) respond_to_contact(contact, positions, velocities);
}

// ---------------------------------------------------------------- the filter

void PairSystem::filter_task(Task& task, const PairParticles& particles) {
  task.slabs.clear();
  task.shares.clear();
  task.hopeless = 0;
  collect_near(task, [&](int a, int b) { return least_distance(a, b); });
  for (const std::int32_t p : task.near) filter_pair(p, particles, task);
}

void PairSystem::filter_pair(std::int32_t pair, const PairParticles& particles, Task& task) {
  const PairStencil four = stencil(pair);
  const double least = double(least_distance(model_.vertex_body[four.vertex[0]], model_.vertex_body[four.vertex[3]]));
  const PairDistance at = pair_distance(four, particles.positions);
  SeparatingSlab slab;
  std::array<float, 4> shares{1, 1, 1, 1};
  const Separation found = plan_separation(four, at, particles.positions, particles.displacements, least, slab, shares);
  if (found == Separation::free) return;
  if (found == Separation::hopeless) ++task.hopeless;
  if (found == Separation::planned) task.slabs.push_back(slab);
  for (int i = 0; i < 4; ++i)
    if (shares[i] < 1) task.shares.emplace_back(four.vertex[i], shares[i]);
}

/// The least of what the pairs allow; then what rounding let through stays where it was, until nothing more does.
void PairSystem::shorten(const PairParticles& particles) {
  std::vector<std::int32_t> touched;
  for (const Task& task : tasks_) {
    counts_.hopeless += task.hopeless;
    for (const auto& [vertex, share] : task.shares) {
      if (share_[vertex] == 1) touched.push_back(vertex);
      share_[vertex] = min(share_[vertex], share);
    }
  }
  for (bool again = true; again;) {
    again = false;
    for (const Task& task : tasks_)
      for (const SeparatingSlab& slab : task.slabs)
        for (int i = 0; i < 4; ++i) {
          const std::int32_t v = slab.pair.vertex[i];
          if (share_[v] == 0 || !ends_beyond(slab, i, particles.positions, particles.displacements, share_[v])) continue;
          if (share_[v] == 1) touched.push_back(v);
          share_[v] = 0;
          again = true;
        }
  }
  for (const std::int32_t v : touched) {
    Record& d = particles.displacements[v];
    d = {d.x * share_[v], d.y * share_[v], d.z * share_[v], 0};
    share_[v] = 1;
    ++counts_.shortened;
  }
}

void PairSystem::filter(Executor& executor, const PairParticles& particles) {
  counts_.contacts = 0;
  for (const PairContact& contact : contacts_) counts_.contacts += contact.push > 0 ? 1 : 0;
  if (!is_finite(particles)) return;
  const float least = least_share * model_.largest_thickness;
  if (model_.filter) {
    // What moved farther than was foreseen is looked for around the moves as they are now.
    if (!all_within(particles, 0.5f * (model_.radius - least))) rebuild(executor, particles);
    measure_moves(executor, particles);
    extent_ = 0;
    for (const int v : model_.elements.vertices) {
      const Record& x = particles.positions[v];
      extent_ = max(extent_, largest(Vec3f{x.x, x.y, x.z}));
    }
    activate(executor, particles);
    executor.parallel_for("filter moves", static_cast<int>(tasks_.size()),
                          [&](int task) { filter_task(tasks_[task], particles); });
    shorten(particles);
  }
  settle_moves(executor, particles);
}

// ---------------------------------------------------------------- tangles

void PairSystem::find_tangles(const Record* positions) {
  std::vector<Vec3f> places(model_.rest.size());
  for (std::size_t i = 0; i < places.size(); ++i) places[i] = {positions[i].x, positions[i].y, positions[i].z};
  tangles_ = intersections_.find(places);
  tangled_pairs_.clear();
  tangled_edges_.clear();
  const auto edge_number = [&](int a, int b) {
    const std::array<int, 2> edge{std::min(a, b), std::max(a, b)};
    const auto& edges = model_.elements.edges;
    const auto at = std::lower_bound(edges.begin(), edges.end(), edge);
    return at != edges.end() && *at == edge ? static_cast<int>(at - edges.begin()) : -1;
  };
  counts_.tangled = 0;
  const IntLists around = tangles_.empty() ? IntLists{} : triangles_around(model_.elements);
  for (const Intersection& tangle : tangles_) {
    const Triangle& t = model_.elements.triangles[tangle.triangle];
    const int a = model_.vertex_body[tangle.a], b = model_.vertex_body[t[0]];
    if (model_.meets[static_cast<std::size_t>(a) * model_.bodies + b] == 0) continue;
    ++counts_.tangled;
    tangled_pairs_.push_back(key_of(tangle.a, tangle.triangle));
    tangled_pairs_.push_back(key_of(tangle.b, tangle.triangle));
    const int crossing = edge_number(tangle.a, tangle.b);
    for (int k = 0; k < 3; ++k) {
      const int side = edge_number(t[k], t[(k + 1) % 3]);
      tangled_edges_.push_back(key_of(std::min(crossing, side), std::max(crossing, side)));
    }
    // The triangle's corners against the triangles of the edge.
    for (const int* other = around.begin(tangle.a); other != around.end(tangle.a); ++other) {
      const Triangle& o = model_.elements.triangles[*other];
      if (o[0] != tangle.b && o[1] != tangle.b && o[2] != tangle.b) continue;
      for (const int corner : t) tangled_pairs_.push_back(key_of(corner, *other));
    }
  }
  sort_out(tangled_pairs_);
  sort_out(tangled_edges_);
}

void PairSystem::begin_frame(const Record* positions, bool anew) {
  const std::int64_t candidates = counts_.candidates, tangled = counts_.tangled;
  counts_ = {};
  counts_.candidates = candidates;
  counts_.tangled = tangled;
  if (!anew && tangles_.empty()) return;
  find_tangles(positions);
  listed_ = false;
}

}  // namespace pliant
