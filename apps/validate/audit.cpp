// Audits surfaces by CrossingFinder, and ropes by continuous collision tests.
#include "apps/validate/audit.h"

#include <algorithm>
#include <cmath>
#include <ctime>

#include "apps/validate/rows.h"

namespace pliant::validate {
namespace {

/// Distances are measured in one of this many frames, because they take longer than the frame itself.
constexpr int frames_between_distances = 20;

/// Measures how long frames take.
class Stopwatch {
 public:
  Report step(World& world, float dt) {
    const std::clock_t start = std::clock();
    Report report = world.step(dt);
    last_ += static_cast<double>(std::clock() - start) * 1e3 / CLOCKS_PER_SEC;
    return report;
  }

  /// Ends the measurement of a frame, which may consist of several steps.
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

// ---------------------------------------------------------------- ropes

/// The box that a link sweeps.
struct SurfaceBox {
  Vec3d low, high;

  bool is_near(const SurfaceBox& other, double reach) const {
    return low.x - reach <= other.high.x && other.low.x - reach <= high.x && low.y - reach <= other.high.y &&
           other.low.y - reach <= high.y && low.z - reach <= other.high.z && other.low.z - reach <= high.z;
  }
};

SurfaceBox path_of(const std::vector<Vec3f>& from, const std::vector<Vec3f>& to, std::size_t link) {
  SurfaceBox box{to_double(from[link]), to_double(from[link])};
  for (const Vec3f& corner : {from[link + 1], to[link], to[link + 1]}) {
    const Vec3d p = to_double(corner);
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
  }
  return box;
}

/// Audits a rope: counts the pairs of links that meet while their particles move linearly, and finds the least
/// distance.
class Links {
 public:
  explicit Links(std::vector<Vec3f> start) : from_(std::move(start)), paths_(from_.size() - 1) {}

  std::size_t advance(std::vector<Vec3f> to) {
    for (std::size_t i = 0; i < paths_.size(); ++i) paths_[i] = path_of(from_, to, i);
    std::size_t met = 0;
    least_ = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < paths_.size(); ++i)
      for (std::size_t k = i + 2; k < paths_.size(); ++k) {
        if (!paths_[i].is_near(paths_[k], reach)) continue;
        const std::array<std::size_t, 4> ends{i, i + 1, k, k + 1};
        std::array<Vec3d, 4> a, b;
        for (std::size_t c = 0; c < 4; ++c) a[c] = to_double(from_[ends[c]]), b[c] = to_double(to[ends[c]]);
        least_ = std::min(least_, segment_distance(b));
        met += paths_[i].is_near(paths_[k], 0) && edge_edge_impact(a, b, 0.0) ? 1 : 0;
      }
    from_ = std::move(to);
    return met;
  }

  double least() const { return least_; }

 private:
  static constexpr double reach = 0.01;  // distances up to this one are measured [m]
  std::vector<Vec3f> from_;
  std::vector<SurfaceBox> paths_;
  double least_ = 0;
};

}  // namespace

Surfaces::Surfaces(const Scene& scene) : colliders_(static_cast<int>(scene.mesh_colliders.size())) {
  const auto add = [&](const std::vector<std::array<int, 3>>& triangles, const std::vector<Vec3f>& positions) {
    const int first = static_cast<int>(mesh_.positions.size());
    for (const auto& [a, b, c] : triangles) mesh_.triangles.push_back({first + a, first + b, first + c});
    mesh_.positions.insert(mesh_.positions.end(), positions.begin(), positions.end());
  };
  for (const Object& object : scene.objects) add(object.triangles, object.positions);
  for (const MeshCollider& collider : scene.mesh_colliders) add(collider.mesh.triangles, collider.mesh.positions);
}

const TriangleMesh& Surfaces::at(const World& world) {
  mesh_.positions.clear();
  const auto add = [&](const std::vector<Vec3f>& more) {
    mesh_.positions.insert(mesh_.positions.end(), more.begin(), more.end());
  };
  for (int o = 0; o < world.object_count(); ++o) add(world.object(o).positions());
  for (int c = 0; c < colliders_; ++c) add(world.mesh_collider(c).positions());
  return mesh_;
}

Audit audit_surfaces(const Scene& scene, int frames) {
  World world(scene);
  Surfaces surfaces(scene);
  CrossingFinder finder(surfaces.at_start().triangles, static_cast<int>(surfaces.at_start().positions.size()));
  Audit audit;
  audit.vertices = static_cast<int>(surfaces.at_start().positions.size());
  constexpr double reach = 0.005;
  audit.least_distance = least_distance(surfaces.at(world), reach);
  note(audit, finder.find(surfaces.at(world).positions, true).size(), 0);
  Stopwatch stopwatch;
  for (int frame = 1; frame <= frames && audit.ok; ++frame) {
    const Report report = stopwatch.step(world, scene.frame_time);
    stopwatch.lap(audit);
    audit.ok = report.ok();
    audit.unresolvable += report.pairs.unresolvable;
    const TriangleMesh& mesh = surfaces.at(world);
    note(audit, finder.find(mesh.positions, true).size(), frame);
    if (frame % frames_between_distances == 0)
      audit.least_distance = std::min(audit.least_distance, least_distance(mesh, reach));
  }
  return audit;
}

Audit audit_rope(const Scene& scene, int frames) {
  Settings settings = scene.settings;
  const int substeps = settings.substeps;
  settings.substeps = 1;
  World world(scene, settings);
  Links links(world.object(0).positions());
  Audit audit;
  audit.vertices = static_cast<int>(scene.objects[0].positions.size());
  audit.least_distance = std::numeric_limits<double>::infinity();
  Stopwatch stopwatch;
  for (int frame = 1; frame <= frames && audit.ok; ++frame) {
    std::size_t met = 0;
    for (int substep = 0; substep < substeps; ++substep) {
      const Report report = stopwatch.step(world, scene.frame_time / static_cast<float>(substeps));
      audit.ok = audit.ok && report.ok();
      audit.unresolvable += report.pairs.unresolvable;
      met += links.advance(world.object(0).positions());
      audit.least_distance = std::min(audit.least_distance, links.least());
    }
    stopwatch.lap(audit);
    note(audit, met, frame);
  }
  return audit;
}

}  // namespace pliant::validate
