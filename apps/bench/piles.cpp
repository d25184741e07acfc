// The piles, Pliant's engine for them, and the measurement.
#include "apps/bench/piles.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>

#include "apps/bench/bench.h"
#include "apps/bench/timing.h"
#include "pliant/body.h"
#include "pliant/error.h"
#include "pliant/world.h"

namespace pliant::bench {
namespace {

Quatf turned_about_x(float angle) { return {std::sin(angle / 2), 0, 0, std::cos(angle / 2)}; }
Quatf turned_about_y(float angle) { return {0, std::sin(angle / 2), 0, std::cos(angle / 2)}; }

Quatf product(const Quatf& a, const Quatf& b) {
  return {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
          a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

Pile pyramid(int base) {
  Pile pile{"pyramid", base};
  for (int row = 0; row < base; ++row)
    for (int i = 0; i < base - row; ++i)
      pile.bodies.push_back(
          {Box{}, {static_cast<float>(i) + 0.5f * static_cast<float>(row), 0.5f + static_cast<float>(row), 0}, {}});
  pile.planes.push_back({});
  return pile;
}

Pile tower(int boxes) {
  Pile pile{"tower", boxes};
  for (int i = 0; i < boxes; ++i) pile.bodies.push_back({Box{}, {0, 0.5f + static_cast<float>(i), 0}, {}});
  pile.planes.push_back({});
  return pile;
}

decltype(PileBody::shape) poured_shape(int number) {
  if (number % 4 == 0) return Box{{0.1f, 0.08f, 0.12f}};
  if (number % 4 == 1) return Sphere{0.11f};
  if (number % 4 == 2) return Capsule{0.08f, 0.1f};
  return Cylinder{0.1f, 0.1f};
}

/// A round bowl of 2 256 triangles whose height is r^2 / size.
TriangleMesh bowl_of(float size) {
  constexpr int rings = 24, around = 48;
  TriangleMesh mesh;
  mesh.positions.push_back({});
  for (int ring = 1; ring <= rings; ++ring)
    for (int i = 0; i < around; ++i) {
      const float r = 1.3f * size * static_cast<float>(ring) / rings,
                  angle = 6.2831853f * static_cast<float>(i) / around;
      mesh.positions.push_back({r * std::cos(angle), r * r / size, r * std::sin(angle)});
    }
  const auto vertex = [](int ring, int i) { return ring == 0 ? 0 : 1 + (ring - 1) * around + i % around; };
  for (int ring = 0; ring < rings; ++ring)
    for (int i = 0; i < around; ++i) {
      mesh.triangles.push_back({vertex(ring, i), vertex(ring + 1, i + 1), vertex(ring + 1, i)});
      if (ring > 0) mesh.triangles.push_back({vertex(ring, i), vertex(ring, i + 1), vertex(ring + 1, i + 1)});
    }
  return mesh;
}

/// Bodies of 0.2 m in layers above a bowl that grows with their volume, so that piles of all sizes have the same shape.
Pile pour(int bodies) {
  Pile pile{"pour", bodies};
  const float side = 0.2f * std::cbrt(static_cast<float>(bodies));
  pile.bowl = bowl_of(side);
  const int across = std::max(1, static_cast<int>(side / 0.3f));
  for (int i = 0; i < bodies; ++i) {
    const int layer = i / (across * across), place = i % (across * across);
    const auto along = [&](int n) { return 0.3f * (static_cast<float>(n) - 0.5f * static_cast<float>(across - 1)); };
    const float jitter = 0.02f * static_cast<float>((i * 37) % 11 - 5) / 5;
    pile.bodies.push_back(
        {poured_shape(i),
         {along(place % across) + jitter, 0.3f + 0.6f * side + 0.3f * static_cast<float>(layer),
          along(place / across) - jitter},
         product(turned_about_x(static_cast<float>(i % 7)), turned_about_y(static_cast<float>(i % 5)))});
  }
  return pile;
}

class PliantPile final : public PileEngine {
 public:
  PliantPile(const Pile& pile, int threads, bool sleeps = false) : world_(scene_of(pile, threads, sleeps)) {}
  void step(float dt) override { sleeping_ = world_.step(dt).sleeping_bodies; }
  /// The number of bodies that slept at the end of the last step.
  int sleeping() const { return sleeping_; }
  std::vector<Vec3f> positions() const override { return world_.object(0).positions(); }
  std::vector<Vec3f> velocities() const override {
    std::vector<Vec3f> result;
    for (const Record& v : world_.state().velocities) result.push_back({v.x, v.y, v.z});
    return result;
  }
  int substeps() const override { return world_.settings().substeps; }

 private:
  static Scene scene_of(const Pile& pile, int threads, bool sleeps) {
    Scene scene;
    scene.settings.threads = threads;
    scene.settings.sleep.on = sleeps;
    Object bodies;
    bodies.name = pile.name;
    for (const PileBody& body : pile.bodies) {
      BodyOptions options;
      options.position = body.position;
      options.rotation = body.rotation;
      const SolidShape shape = std::visit([](const auto& kind) -> SolidShape { return kind; }, body.shape);
      add_body(bodies, {{shape}}, options);
    }
    bodies.static_friction = bodies.kinetic_friction = pile.friction;
    scene.add(bodies);
    for (const PilePlane& plane : pile.planes) {
      Collider collider;
      collider.name = "plane " + std::to_string(scene.colliders.size());
      collider.shape = Plane{};
      collider.position = plane.position;
      collider.rotation = plane.rotation;
      collider.static_friction = collider.kinetic_friction = pile.friction;
      scene.add(collider);
    }
    if (!pile.bowl.triangles.empty()) {
      MeshCollider bowl;
      bowl.name = "bowl";
      bowl.mesh = pile.bowl;
      bowl.static_friction = bowl.kinetic_friction = pile.friction;
      scene.add(bowl);
    }
    return scene;
  }

  World world_;
  int sleeping_ = 0;
};

// ------------------------------------------------------------------------------------------------ measuring

double length_of(const Vec3f& v) { return std::sqrt(static_cast<double>(length_squared(v))); }

PileSnapshot snapshot_of(const PileEngine& engine, const std::vector<Vec3f>& start, int frame) {
  PileSnapshot snapshot{frame};
  const std::vector<Vec3f> now = engine.positions();
  for (std::size_t i = 0; i < now.size(); ++i) {
    const double moved = length_of(now[i] - start[i]);
    if (!(moved <= snapshot.moved)) snapshot.moved = moved;  // keeps what is not a number
    if (now[i].y < -0.1f) ++snapshot.lost;
  }
  for (const Vec3f& v : engine.velocities()) snapshot.speed = std::max(snapshot.speed, length_of(v));
  return snapshot;
}

/// Processor time of this process, or elapsed time if threads share the work [ms].
double now_ms(int threads) {
  if (threads == 1) return static_cast<double>(std::clock()) * 1e3 / CLOCKS_PER_SEC;
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

PileRow measure(const Pile& pile, const PileOptions& options, const std::string& name, PileEngine& engine,
                int threads) {
  PileRow row{pile.name,         name,          pile.size, static_cast<int>(pile.bodies.size()), threads,
              engine.substeps(), options.frames};
  const std::vector<Vec3f> start = engine.positions();
  for (int i = 0; i < options.frames; ++i) {
    const double before = now_ms(threads);
    engine.step(frame_time);
    const double time = now_ms(threads) - before;
    row.mean_ms += time / options.frames;
    row.largest_ms = std::max(row.largest_ms, time);
  }
  row.snapshots.push_back(snapshot_of(engine, start, options.frames));
  const bool stays = std::isfinite(row.snapshots[0].moved) && pile.name != "pour";
  if (!stays || 4 * options.frames * row.mean_ms > 1e3 * options.limit) return row;
  for (int i = options.frames; i < 5 * options.frames; ++i) engine.step(frame_time);
  row.snapshots.push_back(snapshot_of(engine, start, 5 * options.frames));
  return row;
}

/// A pile that sleeps: null if it is not asleep after ten seconds.
std::unique_ptr<PliantPile> make_sleeping_pile(const Pile& pile) {
  constexpr int most_frames = 600;
  auto engine = std::make_unique<PliantPile>(pile, 1, true);
  for (int frame = 0; frame < most_frames; ++frame) {
    engine->step(frame_time);
    if (engine->sleeping() == static_cast<int>(pile.bodies.size())) return engine;
  }
  return nullptr;
}

std::vector<PileRow> measure_all(const Pile& pile, const PileOptions& options) {
  std::vector<PileRow> rows;
  const auto add = [&](const std::string& name, PileEngine& engine, int threads) {
    PileRow row = measure(pile, options, name, engine, threads);
    row.ratio = rows.empty() ? 1 : rows.front().mean_ms / row.mean_ms;
    if (options.on_row) options.on_row(row);
    rows.push_back(std::move(row));
  };
  if (options.against_bullet)
    for (const int substeps : {1, 4}) add("bullet", *make_bullet_pile(pile, substeps), 1);
  add("pliant", *make_pliant_pile(pile, 1), 1);
  if (pile.name == "pour") add("pliant", *make_pliant_pile(pile, 2), 2);
  if (pile.name != "pyramid") return rows;
  if (const auto asleep = make_sleeping_pile(pile)) add("pliant, asleep", *asleep, 1);
  return rows;
}

std::vector<int> usual_sizes(const std::string& name) {
  if (name == "pyramid") return {30, 100};
  if (name == "tower") return {50};
  return {1000, 3000, 10000};
}

}  // namespace

Pile make_pile(const std::string& name, int size) {
  if (name == "pyramid") return pyramid(size);
  if (name == "tower") return tower(size);
  if (name == "pour") return pour(size);
  throw Error({}, "there is no pile '" + name + "'", "choose pyramid, tower or pour");
}

std::unique_ptr<PileEngine> make_pliant_pile(const Pile& pile, int threads) {
  return std::make_unique<PliantPile>(pile, threads);
}

std::vector<PileRow> measure_piles(const PileOptions& options) {
  if (options.frames < 1 || !(options.limit > 0))
    throw Error({}, "there are no frames to measure", "measure at least 1");
  for (const int size : options.sizes)
    if (size < 1 || size > 100000)
      throw Error({}, "a pile of size " + std::to_string(size) + " cannot be measured", "choose a size in 1..100000");
  if (options.against_bullet && !has_bullet())
    throw Error({}, "this program was built without Bullet", "install libbullet-dev and configure again");
  std::vector<PileRow> rows;
  for (const std::string& name : options.piles)
    for (const int size : options.sizes.empty() ? usual_sizes(name) : options.sizes) {
      const std::vector<PileRow> more = measure_all(make_pile(name, size), options);
      rows.insert(rows.end(), more.begin(), more.end());
    }
  return rows;
}

}  // namespace pliant::bench
