// Surfaces by IntersectionFinder; ropes by continuous tests.
#include "apps/validate/audit.h"

#include <algorithm>
#include <cmath>
#include <ctime>

#include "geometry/continuous.h"
#include "geometry/triangle.h"

namespace pliant::validate {
namespace {

/// Distances are measured in every so many frames: they cost more than the frame itself.
constexpr int frames_between_distances = 20;

/// Steps a World and keeps the time that it takes.
class Stopwatch {
 public:
  Report step(World& world, float dt) {
    const std::clock_t start = std::clock();
    Report report = world.step(dt);
    last_ += static_cast<double>(std::clock() - start) * 1e3 / CLOCKS_PER_SEC;
    return report;
  }

  /// Ends a frame of one step or more.
  void lap(Audit& audit) {
    ++audit.frames;
    audit.ms += (last_ - audit.ms) / audit.frames;
    audit.slowest_ms = std::max(audit.slowest_ms, last_);
    last_ = 0;
  }

 private:
  double last_ = 0;
};

void note(Audit& audit, std::size_t found, int frame) {
  if (found > 0 && audit.first < 0) audit.first = frame;
  audit.most = std::max(audit.most, found);
}

using Corners = std::array<Vec3d, 3>;

double vertex_distance(const Vec3d& p, const Corners& t) {
  return closest_on_triangle(p, t[0], t[1], t[2]).distance_squared;
}

/// The least squared distance of a vertex of one and the other, or of an edge of each, among those that share no vertex.
double triangle_distance(const Triangle& s, const Corners& p, const Triangle& t, const Corners& q) {
  const auto shares = [](int vertex, const Triangle& of) { return std::find(of.begin(), of.end(), vertex) != of.end(); };
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    if (!shares(s[i], t)) least = std::min(least, vertex_distance(p[i], q));
    if (!shares(t[i], s)) least = std::min(least, vertex_distance(q[i], p));
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t j = (i + 1) % 3, l = (k + 1) % 3;
      if (s[i] == t[k] || s[i] == t[l] || s[j] == t[k] || s[j] == t[l]) continue;
      const Vec3d first[2] = {p[i], p[j]}, second[2] = {q[k], q[l]};
      least = std::min(least, closest_on_segments(first, second).distance_squared);
    }
  }
  return least;
}

// ---------------------------------------------------------------- ropes

BoxBounds path_of(const std::vector<Vec3f>& from, const std::vector<Vec3f>& to, std::size_t link) {
  const Vec3f corners[4] = {from[link], from[link + 1], to[link], to[link + 1]};
  return BoxBounds::of(corners, 4);
}

/// Links that meet on their straight ways, and the least distance of those that come near at the end.
class Links {
 public:
  explicit Links(std::vector<Vec3f> start) : from_(std::move(start)), paths_(from_.size() - 1) {}

  std::size_t advance(std::vector<Vec3f> to) {
    for (std::size_t i = 0; i < paths_.size(); ++i) paths_[i] = path_of(from_, to, i);
    std::size_t met = 0;
    least_ = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < paths_.size(); ++i)
      for (std::size_t k = i + 2; k < paths_.size(); ++k) {
        if (!overlap(paths_[i].grown(reach), paths_[k])) continue;
        const std::size_t ends[4] = {i, i + 1, k, k + 1};
        Vec3d a[4], b[4];
        for (int c = 0; c < 4; ++c) a[c] = convert<double>(from_[ends[c]]), b[c] = convert<double>(to[ends[c]]);
        least_ = std::min(least_, std::sqrt(closest_on_segments<double>({b[0], b[1]}, {b[2], b[3]}).distance_squared));
        met += overlap(paths_[i], paths_[k]) && edge_edge_impact(a, b, 0).hit ? 1 : 0;
      }
    from_ = std::move(to);
    return met;
  }

  double least() const { return least_; }

 private:
  static constexpr float reach = 0.01f;  // [m]
  std::vector<Vec3f> from_;
  std::vector<BoxBounds> paths_;
  double least_ = 0;
};

}  // namespace

Surfaces::Surfaces(const Scene& scene) : colliders_(static_cast<int>(scene.mesh_colliders.size())) {
  const auto add = [&](const std::vector<std::array<int, 3>>& triangles, std::size_t count) {
    for (const auto& [a, b, c] : triangles) triangles_.push_back({vertices_ + a, vertices_ + b, vertices_ + c});
    vertices_ += static_cast<int>(count);
  };
  for (const Object& object : scene.objects) add(object.triangles, object.positions.size());
  for (const MeshCollider& collider : scene.mesh_colliders) add(collider.mesh.triangles, collider.mesh.positions.size());
}

const std::vector<Vec3f>& Surfaces::places(const World& world) {
  places_.clear();
  const auto add = [&](const std::vector<Vec3f>& more) { places_.insert(places_.end(), more.begin(), more.end()); };
  for (int o = 0; o < world.object_count(); ++o) add(world.positions(o));
  for (int c = 0; c < colliders_; ++c) add(world.mesh_collider_positions(c));
  return places_;
}

double least_distance(const std::vector<Triangle>& triangles, const std::vector<Vec3f>& places, double reach) {
  std::vector<Corners> corners;
  std::vector<BoxBounds> boxes;
  for (const Triangle& t : triangles) {
    Vec3f at[3];
    for (std::size_t k = 0; k < 3; ++k) at[k] = places[static_cast<std::size_t>(t[k])];
    corners.push_back({convert<double>(at[0]), convert<double>(at[1]), convert<double>(at[2])});
    boxes.push_back(BoxBounds::of(at, 3).grown(static_cast<float>(reach)));
  }
  Tree<BoxBounds> tree;
  tree.build(boxes);
  double least = reach * reach;
  tree.self_pairs([&](int a, int b) {
    const auto i = static_cast<std::size_t>(a), k = static_cast<std::size_t>(b);
    least = std::min(least, triangle_distance(triangles[i], corners[i], triangles[k], corners[k]));
  });
  return std::sqrt(least);
}

Audit audit_surfaces(const Scene& scene, int frames) {
  World world(scene);
  Surfaces surfaces(scene);
  IntersectionFinder finder(surfaces.triangles(), surfaces.vertices());
  Audit audit;
  audit.vertices = surfaces.vertices();
  constexpr double reach = 0.005;
  audit.least_distance = least_distance(surfaces.triangles(), surfaces.places(world), reach);
  note(audit, finder.find(surfaces.places(world), true).size(), 0);
  Stopwatch stopwatch;
  for (int frame = 1; frame <= frames && audit.ok; ++frame) {
    const Report report = stopwatch.step(world, scene.frame_time);
    stopwatch.lap(audit);
    audit.ok = report.ok();
    audit.hopeless += report.pairs.hopeless;
    const std::vector<Vec3f>& places = surfaces.places(world);
    note(audit, finder.find(places, true).size(), frame);
    if (frame % frames_between_distances == 0)
      audit.least_distance = std::min(audit.least_distance, least_distance(surfaces.triangles(), places, reach));
  }
  return audit;
}

Audit audit_rope(const Scene& scene, int frames) {
  Settings settings = scene.settings;
  const int substeps = settings.substeps;
  settings.substeps = 1;
  World world(scene, settings);
  Links links(world.positions(0));
  Audit audit;
  audit.vertices = static_cast<int>(scene.objects[0].positions.size());
  audit.least_distance = std::numeric_limits<double>::infinity();
  Stopwatch stopwatch;
  for (int frame = 1; frame <= frames && audit.ok; ++frame) {
    std::size_t met = 0;
    for (int substep = 0; substep < substeps; ++substep) {
      const Report report = stopwatch.step(world, scene.frame_time / static_cast<float>(substeps));
      audit.ok = audit.ok && report.ok();
      audit.hopeless += report.pairs.hopeless;
      met += links.advance(world.positions(0));
      audit.least_distance = std::min(audit.least_distance, links.least());
    }
    stopwatch.lap(audit);
    note(audit, met, frame);
  }
  return audit;
}

}  // namespace pliant::validate
