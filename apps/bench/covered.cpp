#include "apps/bench/covered.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <memory>
#include <set>

#include "apps/bench/timing.h"
#include "pliant/body.h"
#include "pliant/error.h"
#include "pliant/queries.h"
#include "pliant/world.h"

namespace pliant::bench {
namespace {

constexpr float cloth_side = 2;

SolidShape shape_of(int number) {
  switch (number % 6) {
    case 0:
      return Box{{0.07f, 0.05f, 0.06f}};
    case 1:
      return Sphere{0.07f};
    case 2:
      return Capsule{0.05f, 0.06f};
    case 3:
      return Cylinder{0.06f, 0.06f};
    case 4:
      return Cone{0.07f, 0.07f};
    default:
      return Hull{{{0.08f, 0, 0}, {-0.06f, 0.03f, 0}, {0, 0.07f, 0.02f}, {0, -0.05f, 0.05f}, {0.01f, -0.03f, -0.07f}}};
  }
}

Quatf turned(int number) {
  const Quatf q{static_cast<float>(number % 5), static_cast<float>(number % 3), static_cast<float>(number % 7 - 3), 2};
  const float size = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  return {q.x / size, q.y / size, q.z / size, q.w / size};
}

/// The bodies' closed meshes in their own frames, and the triangles of cloth and bodies as one mesh.
class Counter {
 public:
  explicit Counter(const Covered& scene)
      : cloth_vertices_(static_cast<int>(scene.cloth.positions.size())), all_(scene.cloth.triangles) {
    int first = cloth_vertices_;
    for (const ObjectBody& body : scene.bodies.bodies) {
      meshes_.push_back(mesh_of(body.solids));
      for (const auto& [a, b, c] : meshes_.back().triangles) all_.push_back({first + a, first + b, first + c});
      for (std::size_t i = 0; i < meshes_.back().positions.size(); ++i)
        body_of_.push_back(static_cast<int>(meshes_.size()) - 1);
      first += static_cast<int>(meshes_.back().positions.size());
    }
    finder_ = std::make_unique<CrossingFinder>(all_, first);
  }

  /// Edges of the cloth through triangles of bodies, and the reverse; `bodies` gets the bodies that take part.
  int count(const World& world, const Covered& scene, std::set<int>& bodies) {
    std::vector<Vec3f> positions = world.object(0).positions();
    const std::vector<Vec3f> places = world.object(1).positions();
    const std::vector<Quatf> turns = world.object(1).orientations();
    for (std::size_t b = 0; b < meshes_.size(); ++b) {
      const ObjectBody& body = scene.bodies.bodies[b];
      const Quatf q = turns[static_cast<std::size_t>(body.frame)];
      for (const Vec3f& p : meshes_[b].positions)
        positions.push_back(places[static_cast<std::size_t>(body.particle)] + rotated(q, p));
    }
    int found = 0;
    for (const Crossing& crossing : finder_->find(positions)) {
      const int of_triangle = all_[static_cast<std::size_t>(crossing.triangle)][0];
      if ((crossing.a < cloth_vertices_) == (of_triangle < cloth_vertices_)) continue;
      bodies.insert(body_of_[static_cast<std::size_t>(std::max(crossing.a, of_triangle) - cloth_vertices_)]);
      ++found;
    }
    return found;
  }

 private:
  static Vec3f rotated(const Quatf& q, const Vec3f& p) {
    const Vec3f v{q.x, q.y, q.z};
    const auto crossed = [](const Vec3f& a, const Vec3f& b) {
      return Vec3f{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    };
    const Vec3f t = crossed(v, p) * 2.f;
    return p + t * q.w + crossed(v, t);
  }

  int cloth_vertices_ = 0;
  std::vector<std::array<int, 3>> all_;
  std::vector<TriangleMesh> meshes_;
  std::vector<int> body_of_;  ///< [vertex of bodies]
  std::unique_ptr<CrossingFinder> finder_;
};

std::unique_ptr<World> world_of(const Covered& of, bool has_cloth, bool has_bodies) {
  Scene scene;
  scene.settings.threads = 1;
  Collider ground;
  ground.static_friction = 0.5f;
  ground.kinetic_friction = 0.4f;
  scene.add(ground);
  if (has_cloth) scene.add(of.cloth);
  if (has_bodies) scene.add(of.bodies);
  return std::make_unique<World>(scene);
}

bool names_all(const Report& report, const std::set<int>& bodies) {
  return std::all_of(bodies.begin(), bodies.end(), [&](int b) {
    return std::any_of(report.warnings.begin(), report.warnings.end(), [&](const std::string& text) {
      return text.find("body " + std::to_string(b) + " of 'heap'") != std::string::npos;
    });
  });
}

void finish(std::vector<double>& times, CoveredRow& row) {
  for (const double time : times) row.mean_ms += time / static_cast<double>(times.size());
  std::sort(times.begin(), times.end());
  row.median_ms = times[times.size() / 2];
  row.largest_ms = times.back();
}

std::vector<CoveredRow> measure(int size, const CoveredOptions& options) {
  const Covered scene = make_covered(size, options.bodies);
  Counter counter(scene);
  const std::unique_ptr<World> worlds[3] = {world_of(scene, true, true), world_of(scene, true, false),
                                            world_of(scene, false, true)};
  std::vector<CoveredRow> rows;
  for (const char* what : {"together", "cloth alone", "bodies alone"})
    rows.push_back({what, size, static_cast<int>(scene.bodies.bodies.size()), options.frames});
  std::vector<double> times[3];
  for (int frame = 0; frame < options.frames; ++frame)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::clock_t start = std::clock();
      const Report report = worlds[i]->step(frame_time);
      times[i].push_back(static_cast<double>(std::clock() - start) * 1e3 / CLOCKS_PER_SEC);
      if (i > 0) continue;
      std::set<int> bodies;
      const int crossings = counter.count(*worlds[0], scene, bodies);
      rows[0].worst_crossings = std::max(rows[0].worst_crossings, crossings);
      rows[0].frames_with_crossings += crossings > 0 ? 1 : 0;
      rows[0].unnamed += names_all(report, bodies) ? 0 : 1;
    }
  for (std::size_t i = 0; i < 3; ++i) finish(times[i], rows[i]);
  for (CoveredRow& row : rows) row.ratio = row.median_ms / (rows[1].median_ms + rows[2].median_ms);
  return rows;
}

}  // namespace

Covered make_covered(int size, int bodies) {
  Covered out;
  out.cloth =
      make_cloth(grid_mesh(size, size, cloth_side, cloth_side), {.name = "cloth", .material = fabric("cotton")});
  for (Vec3f& p : out.cloth.positions) p.y = 0.9f;
  out.cloth.thickness = 0.004f;
  out.cloth.collides = out.cloth.self_collision = true;
  out.cloth.damping = 0.5f;
  out.bodies.name = "heap";
  const int across = std::max(1, static_cast<int>(std::ceil(std::sqrt(bodies / 2.))));
  for (int i = 0; i < bodies; ++i) {
    const int place = i / 2;
    const auto along = [&](int n) { return 0.24f * (static_cast<float>(n) - 0.5f * static_cast<float>(across - 1)); };
    BodyOptions body;
    body.name = "body " + std::to_string(i);
    body.position = {along(place % across), i % 2 == 0 ? 0.14f : 0.38f, along(place / across)};
    body.rotation = turned(i);
    add_body(out.bodies, {{.shape = shape_of(i + i / 6), .density = 500}}, body);
  }
  out.bodies.static_friction = 0.5f;
  out.bodies.kinetic_friction = 0.4f;
  return out;
}

std::vector<CoveredRow> measure_covered(const CoveredOptions& options) {
  if (options.frames < 1) throw Error({}, "there are no frames to measure", "measure at least 1");
  std::vector<CoveredRow> all;
  for (const int size : options.sizes) {
    if (size < 2 || size > 1000)
      throw Error({}, "a cloth of " + std::to_string(size) + " vertices per side cannot be measured",
                  "choose a size in 2..1000");
    for (const CoveredRow& row : measure(size, options)) {
      if (options.on_row) options.on_row(row);
      all.push_back(row);
    }
  }
  return all;
}

}  // namespace pliant::bench
