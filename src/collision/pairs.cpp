#include "collision/pairs.h"

#include <algorithm>
#include <cmath>

#include "math/vector.h"

namespace pliant {

namespace {

constexpr std::size_t pairs_in_a_task = 4096;
/// A contact keeps no more than this share of the distance that its primitives have at rest.
constexpr double share_of_rest = 0.9;
/// What the filter keeps, as a share of the thickness; and at least so many roundings of the positions.
constexpr double least_share = 0.05, least_roundings = 32, rounding = 6e-8;
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
  share_.assign(model.rest.size(), 1.f);
}

// ---------------------------------------------------------------- lists

/// Where a value is not finite, the end of the substep says so; until then nothing is looked for.
bool PairSystem::is_finite(const PairParticles& particles) const {
  for (const int v : model_.elements.vertices) {
    const Vec3f p = end_of(particles, static_cast<std::size_t>(v));
    if (!(largest(p) < 1e14f)) return false;
  }
  return true;
}

PairStencil PairSystem::stencil(std::size_t pair) const {
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

void PairSystem::rebuild(Executor& executor, const PairParticles& particles) {
  from_.resize(model_.rest.size());
  to_.resize(model_.rest.size());
  for (std::size_t i = 0; i < from_.size(); ++i) {
    from_[i] = end_of(particles, i, 0);
    to_[i] = end_of(particles, i);
  }
  finder_.find(executor, from_, to_, model_.radius, true);
  pairs_.clear();
  const auto append = [&](const IntLists& lists, const std::vector<std::uint64_t>& tangled) {
    for (int owner = 0; owner + 1 < static_cast<int>(lists.start.size()); ++owner)
      for (const int* other = lists.begin(owner); other != lists.end(owner); ++other) {
        const bool is = std::binary_search(tangled.begin(), tangled.end(), key_of(owner, *other));
        pairs_.push_back({owner, *other, 0, static_cast<char>(is ? 1 : 0)});
      }
  };
  append(finder_.vertex_triangles(), tangled_pairs_);
  vertex_pairs_ = pairs_.size();
  append(finder_.edge_edges(), tangled_edges_);
  vertex_sum_.assign(vertex_move_.size(), 0.f);
  triangle_sum_.assign(triangle_move_.size(), 0.f);
  edge_sum_.assign(edge_move_.size(), 0.f);
  between_sum_.assign(between_move_.size(), 0.f);
  for (Pair& pair : pairs_) pair.reach = -1e30f;  // not measured yet
  tasks_.resize(std::max(tasks_.size(), (pairs_.size() + pairs_in_a_task - 1) / pairs_in_a_task));
  listed_ = true;
  ++counts_.rebuilds;
  counts_.candidates = static_cast<std::int64_t>(pairs_.size());
}

template <class Body>
void PairSystem::for_pairs(Executor& executor, const char* name, Body body) {
  const int tasks = static_cast<int>((pairs_.size() + pairs_in_a_task - 1) / pairs_in_a_task);
  executor.parallel_for(name, tasks, [&](int number) {
    Task& task = tasks_[number];
    const std::size_t first = static_cast<std::size_t>(number) * pairs_in_a_task;
    for (std::size_t p = first; p < std::min(pairs_.size(), first + pairs_in_a_task); ++p) body(p, task);
  });
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
  each(triangle_move_.size(), [&](std::size_t i) {
    const Triangle& t = elements.triangles[i];
    triangle_move_[i] = max(max(vertex_move_[t[0]], vertex_move_[t[1]]), vertex_move_[t[2]]);
  });
  each(edge_move_.size(), [&](std::size_t i) {
    edge_move_[i] = max(vertex_move_[elements.edges[i][0]], vertex_move_[elements.edges[i][1]]);
  });
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
}

/// By how much a pair can have come closer since the lists were made, this substep's moves included [m].
float PairSystem::approach(std::size_t pair) const {
  const Pair& p = pairs_[pair];
  const bool is_vertex = pair < vertex_pairs_;
  const int a = is_vertex ? model_.vertex_body[p.a] : model_.edge_body[p.a];
  const int b = is_vertex ? model_.triangle_body[p.b] : model_.edge_body[p.b];
  float sum = is_vertex ? (vertex_sum_[p.a] + vertex_move_[p.a]) + (triangle_sum_[p.b] + triangle_move_[p.b])
                        : (edge_sum_[p.a] + edge_move_[p.a]) + (edge_sum_[p.b] + edge_move_[p.b]);
  if (a != b) {
    const std::size_t at = static_cast<std::size_t>(a) * model_.bodies + b;
    sum += between_sum_[at] + between_move_[at];
  }
  return sum;
}

// ---------------------------------------------------------------- contacts

void PairSystem::detect_pair(std::size_t pair, const PairParticles& particles, Task& task) {
  Pair& p = pairs_[pair];
  if (p.tangled != 0) return;
  const bool is_vertex = pair < vertex_pairs_;
  const PairMaterial& of = is_vertex ? material(model_.vertex_body[p.a], model_.triangle_body[p.b])
                                     : material(model_.edge_body[p.a], model_.edge_body[p.b]);
  const float closer = approach(pair);
  if (p.reach - closer > of.thickness) return;
  const PairStencil four = stencil(pair);
  const PairDistance at = pair_distance(four, particles.positions);
  // What was moved before counts into both sides of the comparison.
  float moves = is_vertex ? vertex_move_[p.a] + triangle_move_[p.b] : edge_move_[p.a] + edge_move_[p.b];
  const int a = model_.vertex_body[four.vertex[0]], b = model_.vertex_body[four.vertex[3]];
  if (a != b) moves += between_move_[static_cast<std::size_t>(a) * model_.bodies + b];
  p.reach = static_cast<float>(at.distance) * (1 - 1e-6f) + (closer - moves);
  if (!(at.distance > 0) || static_cast<float>(at.distance) - moves > of.thickness) return;
  PairMaterial kept = of;
  const double rest = share_of_rest * pair_distance(four, model_.rest.data()).distance;
  kept.thickness = min(kept.thickness, static_cast<float>(rest));
  task.contacts.push_back(make_contact(four, at, kept, particles.h));
}

void PairSystem::detect(Executor& executor, const PairParticles& particles) {
  contacts_.clear();
  if (!is_finite(particles)) return;
  const float margin = 0.5f * (model_.radius - model_.largest_thickness);
  if (!listed_ || !all_within(particles, margin)) rebuild(executor, particles);
  measure_moves(executor, particles);
  for (Task& task : tasks_) task.contacts.clear();
  for_pairs(executor, "detect contacts", [&](std::size_t p, Task& task) { detect_pair(p, particles, task); });
  contacts_.clear();
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

void PairSystem::filter_pair(std::size_t pair, const PairParticles& particles, Task& task) {
  Pair& p = pairs_[pair];
  if (p.tangled != 0) return;
  const PairStencil four = stencil(pair);
  const int a = model_.vertex_body[four.vertex[0]], b = model_.vertex_body[four.vertex[3]];
  const Record& x = particles.positions[four.vertex[0]];
  const double extent = std::max({std::fabs(double(x.x)), std::fabs(double(x.y)), std::fabs(double(x.z))});
  const double least = std::max(least_share * double(material(a, b).thickness), least_roundings * rounding * extent);
  if (double(p.reach) - double(approach(pair)) > least) return;
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
  const float least = static_cast<float>(least_share) * model_.largest_thickness;
  if (model_.filter) {
    // What moved farther than was foreseen is looked for around the moves as they are now.
    if (!all_within(particles, 0.5f * (model_.radius - least))) rebuild(executor, particles);
    measure_moves(executor, particles);
    for (Task& task : tasks_) {
      task.slabs.clear();
      task.shares.clear();
      task.hopeless = 0;
    }
    for_pairs(executor, "filter moves", [&](std::size_t p, Task& task) { filter_pair(p, particles, task); });
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
