// Bodies in given motion, their pairs by brute force, and what contact of surfaces does with them.
#pragma once

#include "collision/surfaces/surface_contact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "collision/random_support.h"
#include "geometry/triangle.h"
#include "math/vector.h"
#include "pliant/mesh.h"

namespace pliant::testing_support {

struct Body {
  TriangleMesh mesh;
  bool movable = true, meets_itself = true;
  float thickness = 0.02f;  ///< thickness of either side of a pair with this body
  Vec3d velocity{};         ///< velocity of the whole body [m/s]
  Vec3d spin{};             ///< rotation about the origin [rad/s]
};

inline TriangleMesh sheet(int n, double size, const Vec3d& at) {
  TriangleMesh mesh = grid_mesh(n, n, static_cast<float>(size), static_cast<float>(size));
  for (Vec3f& p : mesh.positions) p = p + convert<float>(at);
  return mesh;
}

/// Makes clusters of nine vertices of one body each, with the primitives that begin at them.
inline void cluster(PairModel& model) {
  int size = 0;
  for (std::size_t v = 0; v < model.shared->rest.size(); ++v) {
    if (v == 0 || size == 9 || model.shared->vertex_body[v] != model.shared->vertex_body[v - 1]) {
      model.cluster_body.push_back(model.shared->vertex_body[v]);
      ++model.clusters;
      size = 0;
    }
    model.shared->vertex_cluster.push_back(model.clusters - 1);
    ++size;
  }
  for (const Triangle& t : model.elements.triangles)
    model.triangle_cluster.push_back(model.shared->vertex_cluster[t[0]]);
  for (const auto& edge : model.elements.edges) model.edge_cluster.push_back(model.shared->vertex_cluster[edge[0]]);
}

inline PairModel model_of(const std::vector<Body>& bodies, bool filter) {
  PairModel model;
  model.filter = filter;
  std::vector<Triangle> triangles;
  double edges = 0;
  for (const Body& body : bodies) {
    const int first = static_cast<int>(model.shared->rest.size()), number = static_cast<int>(&body - bodies.data());
    for (const Vec3f& p : body.mesh.positions) {
      model.shared->rest.push_back({p.x, p.y, p.z, body.movable ? 1.f : 0.f});
      model.shared->vertex_body.push_back(number);
    }
    for (const auto& t : body.mesh.triangles) triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  for (const Body& body : bodies) {
    ContactBody rule;
    rule.is_immovable = !body.movable;
    rule.meets_itself = body.meets_itself;
    rule.thickness = body.thickness;
    rule.static_friction = 0.4f;
    rule.kinetic_friction = 0.3f;
    model.shared->rules.add(rule);
  }
  model.elements = make_contact_elements(triangles, {}, {}, static_cast<int>(model.shared->rest.size()));
  cluster(model);
  index_bodies(model);
  model.largest_thickness = model.shared->rules.largest_thickness(model.members);
  for (const auto& [a, b] : model.elements.edges) {
    const Record &p = model.shared->rest[a], &q = model.shared->rest[b];
    edges += double(length(Vec3f{p.x - q.x, p.y - q.y, p.z - q.z})) / static_cast<double>(model.elements.edges.size());
  }
  model.radius = model.largest_thickness + 0.5f * static_cast<float>(edges);
  return model;
}

inline std::vector<PairStencil> all_pairs(const PairModel& model) {
  std::vector<PairStencil> pairs;
  const auto meet = [&](int a, int b) {
    return model.shared->rules.meet(model.shared->vertex_body[a], model.shared->vertex_body[b]);
  };
  for (const int v : model.elements.vertices)
    for (const Triangle& t : model.elements.triangles)
      if (v != t[0] && v != t[1] && v != t[2] && meet(v, t[0])) pairs.push_back({{v, t[0], t[1], t[2]}, 1});
  const auto& edges = model.elements.edges;
  for (std::size_t i = 0; i < edges.size(); ++i)
    for (std::size_t k = i + 1; k < edges.size(); ++k) {
      const auto [a, b] = edges[i];
      const auto [c, d] = edges[k];
      if (a != c && a != d && b != c && b != d && meet(a, c)) pairs.push_back({{a, b, c, d}, 2});
    }
  return pairs;
}

inline const auto none_free = []() -> const FreeBodies& {
  static const FreeBodies none;
  return none;
};

/// Bodies in given motion. It does with particles what a World does, without constraints.
class Soup {
 public:
  /// `are_free`: nothing fixed acts on bodies that can move, so the filter keeps their momentum.
  Soup(const std::vector<Body>& bodies, bool filter = true, bool are_free = false)
      : bodies_(bodies),
        model_(model_of(bodies, filter)),
        pairs_(all_pairs(model_)),
        system_(model_),
        positions_(model_.shared->rest),
        remainders_(positions_.size()),
        displacements_(positions_.size()),
        velocities_(positions_.size()),
        intersections_(model_.elements.triangles, model_.elements.vertex_count) {
    for (std::size_t i = 0; i < velocities_.size(); ++i) velocities_[i] = velocity_at(static_cast<int>(i));
    for (int body = 0; are_free && body < static_cast<int>(bodies.size()); ++body)
      free_.push_back({bodies[body].movable ? body : -1, 1e30f});
  }

  /// Makes a substep: predict, find contacts, project, filter, update; checks everything on the way.
  void step(Random& random, double jitter) {
    for (std::size_t i = 0; i < positions_.size(); ++i) {
      if (positions_[i].w > 0) velocities_[i] += random_place(random, jitter);
      const Vec3d d =
          velocities_[i] * h + Vec3d{double(remainders_[i].x), double(remainders_[i].y), double(remainders_[i].z)};
      displacements_[i] = {static_cast<float>(d.x), static_cast<float>(d.y), static_cast<float>(d.z), 0};
    }
    if (first_) system_.begin_frame(positions_.data(), true);
    first_ = false;
    const std::vector<Record> predicted = displacements_;
    const PairParticles particles{positions_.data(), remainders_.data(), displacements_.data(), static_cast<float>(h)};
    system_.detect(executor_, particles);
    check_contacts();
    most_contacts = std::max(most_contacts, system_.contacts().size());
    for (Contact& contact : system_.contacts()) project_contact(contact, displacements_.data());
    // Displacements change as if by constraints.
    for (std::size_t i = 0; i < positions_.size(); ++i)
      if (positions_[i].w > 0 && random() % 4 == 0) disturb(displacements_[i], random_place(random, 4 * jitter * h));
    const std::vector<Record> solved = displacements_;
    system_.filter(executor_, particles, find_free_);
    system_.end_substep(executor_, particles, false);
    check_against_a_new_system(predicted, solved);
    check_distances();
    if (std::none_of(bodies_.begin(), bodies_.end(), [](const Body& body) { return !body.movable; }))
      check_momentum(solved);
    for (const auto& [vertex, d] : system_.without_velocity()) disturb(remainders_[vertex], convert<double>(d));
    without_velocity += system_.without_velocity().size();
    update();
  }

  std::size_t crossings() {
    std::vector<Vec3f> places;
    for (const Record& r : positions_) places.push_back({r.x, r.y, r.z});
    std::size_t count = 0;
    for (const Intersection& found : intersections_.find(places)) {
      const int a = model_.shared->vertex_body[found.a],
                b = model_.shared->vertex_body[model_.elements.triangles[found.triangle][0]];
      count += model_.shared->rules.meet(a, b) ? 1 : 0;
    }
    return count;
  }

  PairCounts counts() const { return system_.counts(); }
  void push(int vertex, const Vec3d& velocity) { velocities_[vertex] = velocity; }
  Vec3d place(int vertex) const {
    return {double(positions_[vertex].x), double(positions_[vertex].y), double(positions_[vertex].z)};
  }

  static constexpr double h = 1. / 1200;
  std::size_t most_contacts = 0, without_velocity = 0;

 private:
  Vec3d velocity_at(int vertex) const {
    const Body& body = bodies_[model_.shared->vertex_body[vertex]];
    return body.velocity + cross(body.spin, place(vertex));
  }

  static void disturb(Record& d, const Vec3d& by) {
    d = {d.x + static_cast<float>(by.x), d.y + static_cast<float>(by.y), d.z + static_cast<float>(by.z), 0};
  }

  PairMaterial material(const PairStencil& pair) const {
    const int a = model_.shared->vertex_body[pair.vertex[0]], b = model_.shared->vertex_body[pair.vertex[3]];
    return model_.shared->rules.material(a, b);
  }

  /// The side of a pair that is of an immovable mesh; -1: none.
  int mesh_side(const PairStencil& pair) const {
    const auto movable = [&](int i) { return bodies_[model_.shared->vertex_body[pair.vertex[i]]].movable; };
    return !movable(3) ? 1 : !movable(0) ? 0 : -1;
  }

  /// True if a triangle of an immovable mesh, at a corner of the pair's primitive on it, is closer to the closest point
  /// on the other side than that primitive is.
  bool is_closer_on_mesh(const PairStencil& pair) const {
    const int mesh = mesh_side(pair);
    if (mesh < 0) return false;
    const PairDistance at = pair_distance(pair, positions_.data());
    const auto is_on_mesh = [&](int i) { return (i < pair.first_side) == (mesh == 0); };
    Vec3d other{};
    for (int i = 0; i < 4; ++i)
      if (!is_on_mesh(i)) other += place(pair.vertex[i]) * std::abs(at.weight[i]);
    return std::any_of(model_.elements.triangles.begin(), model_.elements.triangles.end(), [&](const Triangle& t) {
      bool touches = false;
      for (int i = 0; i < 4; ++i)
        touches = touches || (is_on_mesh(i) && std::find(t.begin(), t.end(), pair.vertex[i]) != t.end());
      return touches && length(closest_on_triangle(other, place(t[0]), place(t[1]), place(t[2])).point - other) <
                            at.distance * (1 - 1e-8);
    });
  }

  float thickness(const PairStencil& pair) const {
    const double share = mesh_side(pair) < 0 ? 0.9 : 1,
                 rest = share * pair_distance(pair, model_.shared->rest.data()).distance;
    return std::min(material(pair).thickness, static_cast<float>(rest));
  }

  /// True if another pair of the same two surfaces is closer, so that this one is oblique: for a vertex and a triangle,
  /// an adjacent triangle; for edges, an end of one and a triangle at the other.
  bool is_covered(const PairStencil& pair, double now) const {
    const auto has = [](const Triangle& t, int v) { return t[0] == v || t[1] == v || t[2] == v; };
    const auto is_closer = [&](int v, const Triangle& t, double than) {
      return !has(t, v) && pair_distance({{v, t[0], t[1], t[2]}, 1}, positions_.data()).distance < than;
    };
    const auto& v = pair.vertex;
    return std::any_of(model_.elements.triangles.begin(), model_.elements.triangles.end(), [&](const Triangle& t) {
      if (pair.first_side == 1)
        return (has(t, v[1]) || has(t, v[2]) || has(t, v[3])) && is_closer(v[0], t, now * (1 - 1e-9));
      const double as_close = now * (1 + 1e-5);
      return (has(t, v[2]) && has(t, v[3]) && (is_closer(v[0], t, as_close) || is_closer(v[1], t, as_close))) ||
             (has(t, v[0]) && has(t, v[1]) && (is_closer(v[2], t, as_close) || is_closer(v[3], t, as_close)));
    });
  }

  /// Every pair that is nearer than its thickness, or will be after the predicted motion, must be a contact, exactly
  /// once, and in order. A pair that others cover may become one later, when it is nearer. Of an immovable mesh only
  /// what is closest counts.
  void check_contacts() {
    using Key = std::array<std::int32_t, 4>;
    // The same four vertices may be a vertex and a triangle as well as two edges.
    std::map<Key, int> found, wanted;
    for (const Contact& contact : system_.contacts()) ASSERT_LE(++found[contact.point], 2) << "twice";
    for (const PairStencil& pair : pairs_) {
      Record starts[4], ends[4];
      find_path(pair, starts, ends);
      const PairStencil own{{0, 1, 2, 3}, pair.first_side};
      const double kept = double(thickness(pair)) * (1 - 1e-4);
      const double now = pair_distance(own, starts).distance, then = pair_distance(own, ends).distance;
      const bool near = now > 1e-6 && std::min(now, then) < kept;
      if (near && ((now >= kept && is_covered(pair, now)) || is_closer_on_mesh(pair))) continue;
      wanted[pair.vertex] += near ? 1 : 0;
      ASSERT_TRUE(!near || found[pair.vertex] >= wanted[pair.vertex])
          << "a pair at " << now << ", then " << then << ", is no contact";
    }
  }

  void check_against_a_new_system(const std::vector<Record>& predicted, const std::vector<Record>& solved) {
    SurfaceContact fresh(model_);
    fresh.begin_frame(positions_.data(), true);
    std::vector<Record> moved = predicted;
    const PairParticles particles{positions_.data(), remainders_.data(), moved.data(), static_cast<float>(h)};
    fresh.detect(executor_, particles);
    ASSERT_EQ(fresh.contacts().size(), system_.contacts().size());
    for (std::size_t i = 0; i < fresh.contacts().size(); ++i)
      ASSERT_EQ(fresh.contacts()[i].point, system_.contacts()[i].point) << "in the same order";
    moved = solved;
    fresh.filter(executor_, particles, find_free_);
    for (std::size_t i = 0; i < moved.size(); ++i)
      ASSERT_TRUE(moved[i].x == displacements_[i].x && moved[i].y == displacements_[i].y &&
                  moved[i].z == displacements_[i].z)
          << "particle " << i;
    ASSERT_EQ(fresh.without_velocity().size(), system_.without_velocity().size());
    for (std::size_t i = 0; i < fresh.without_velocity().size(); ++i)
      ASSERT_TRUE(fresh.without_velocity()[i] == system_.without_velocity()[i]) << "of " << i;
  }

  /// The positions of a pair's four vertices at the start and at the end.
  void find_path(const PairStencil& pair, Record (&starts)[4], Record (&ends)[4]) const {
    for (int i = 0; i < 4; ++i) {
      const Record &x = starts[i] = positions_[pair.vertex[i]], &d = displacements_[pair.vertex[i]];
      ends[i] = {x.x + d.x, x.y + d.y, x.z + d.z, x.w};
    }
  }

  /// No pair may come nearer than min(least, 0.98 of the last distance).
  void check_distances() {
    if (!model_.filter || system_.counts().unresolvable > 0) return;
    for (const PairStencil& pair : pairs_) {
      Record starts[4], ends[4];
      find_path(pair, starts, ends);
      const PairStencil own{{0, 1, 2, 3}, pair.first_side};
      const double now = pair_distance(own, starts).distance, least = 0.05 * double(material(pair).thickness);
      if (now > 1e-4) {
        ASSERT_GE(pair_distance(own, ends).distance, std::min(least, 0.98 * now) * (1 - 1e-4)) << "from " << now;
      }
    }
  }

  /// What becomes velocity has the linear and angular momentum that was there before the filter, and no more energy.
  void check_momentum(const std::vector<Record>& solved) {
    if (free_.empty()) return;
    std::vector<Record> wanted = displacements_;
    for (const auto& [vertex, d] : system_.without_velocity()) disturb(wanted[vertex], convert<double>(-d));
    Vec3d linear{}, angular{};
    double before = 0, after = 0;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      const Vec3d was{double(solved[i].x), double(solved[i].y), double(solved[i].z)},
          is{double(wanted[i].x), double(wanted[i].y), double(wanted[i].z)};
      const Vec3d arm = place(static_cast<int>(i)) - place(0);
      linear += is - was;
      angular += cross(arm, is - was);
      before += dot(was, was);
      after += dot(is, is);
    }
    const double rounded = 3e-6 * std::sqrt(before);
    ASSERT_LE(std::sqrt(dot(linear, linear)), rounded);
    ASSERT_LE(std::sqrt(dot(angular, angular)), rounded);
    ASSERT_LE(after, before * (1 + 1e-6));
  }

  void update() {
    for (std::size_t i = 0; i < positions_.size(); ++i) {
      Record &x = positions_[i], &d = displacements_[i], &r = remainders_[i];
      velocities_[i] = Vec3d{double(d.x) - double(r.x), double(d.y) - double(r.y), double(d.z) - double(r.z)} * (1 / h);
      const Record end{x.x + d.x, x.y + d.y, x.z + d.z, x.w};
      r = {d.x - (end.x - x.x), d.y - (end.y - x.y), d.z - (end.z - x.z), 0};
      x = end;
    }
  }

  std::vector<Body> bodies_;
  PairModel model_;
  std::vector<PairStencil> pairs_;
  SurfaceContact system_;
  Executor executor_{1};
  bool first_ = true;
  FreeBodies free_;
  std::function<const FreeBodies&()> find_free_ = [this]() -> const FreeBodies& { return free_; };
  std::vector<Record> positions_, remainders_, displacements_;
  std::vector<Vec3d> velocities_;
  IntersectionFinder intersections_;
};

}  // namespace pliant::testing_support
