// Piles of rigid bodies: a pyramid, a tower, and mixed bodies poured into a bowl; the engine and Bullet (`pliant bench
// bodies`).
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "pliant/mesh.h"
#include "pliant/shape.h"

namespace pliant::bench {

/// A body of 1000 kg/m^3.
struct PileBody {
  std::variant<Sphere, Capsule, Box, Cylinder> shape;
  Vec3f position{};  ///< [m]
  Quatf rotation{};
};

/// A half-space: y <= 0 of its frame.
struct PilePlane {
  Vec3f position{};
  Quatf rotation{};
};

/// A workload in a form that does not depend on the engine.
struct Pile {
  std::string name;  ///< "pyramid", "tower" or "pour"
  int size = 0;      ///< boxes in the lowest row; boxes; bodies
  float friction = 0.6f;
  std::vector<PileBody> bodies{};
  std::vector<PilePlane> planes{};
  TriangleMesh bowl{};  ///< static; empty: none
};

/// Makes a pile. Throws an Error for unknown names.
Pile make_pile(const std::string& name, int size);

/// An engine that simulates a Pile.
class PileEngine {
 public:
  virtual ~PileEngine() = default;
  virtual void step(float dt) = 0;
  virtual std::vector<Vec3f> positions() const = 0;   ///< of the bodies' centres of mass [m]
  virtual std::vector<Vec3f> velocities() const = 0;  ///< of these [m/s], in any order
  virtual int substeps() const = 0;
};

std::unique_ptr<PileEngine> make_pliant_pile(const Pile& pile, int threads);
/// Makes an engine of Bullet's rigid bodies with sequential impulses, ten iterations and its own margins, that never
/// sleep. Null if this program was built without Bullet.
std::unique_ptr<PileEngine> make_bullet_pile(const Pile& pile, int substeps);

/// A pile at some frame.
struct PileSnapshot {
  int frame = 0;
  /// Largest distance of a centre of mass from where it started [m]; not finite if a position is not.
  double moved = 0;
  double speed = 0;  ///< of the fastest body [m/s]
  int lost = 0;      ///< bodies below the ground
};

/// The results of one engine for one pile.
struct PileRow {
  std::string pile, engine;
  int size = 0, bodies = 0, threads = 1, substeps = 0;
  int frames = 0;         ///< frames until the first snapshot, which alone are timed
  double mean_ms = 0;     ///< of these: processor time of one thread, or elapsed time of several [ms]
  double largest_ms = 0;  ///< of these [ms]
  std::vector<PileSnapshot> snapshots{};
  double ratio = 0;  ///< speedup over the first row of the same pile and size
};

struct PileOptions {
  std::vector<std::string> piles{"pyramid", "tower", "pour"};
  std::vector<int> sizes;  ///< empty: pyramids of 30 and 100, a tower of 50, 1 000 to 10 000 poured bodies
  /// Frames of 1/60 s until the first snapshot; the second is at five times as many (of `pour`: none)
  int frames = 240;
  double limit = 120;  ///< no second snapshot if it would take longer [s]
  bool against_bullet = false;
  std::function<void(const PileRow&)> on_row;
};

/// Measures piles. Throws an Error if a size is outside 1..100000, there are no frames, or Bullet is requested but not
/// built in.
std::vector<PileRow> measure_piles(const PileOptions& options);

std::string to_json(const std::vector<PileRow>& rows);

}  // namespace pliant::bench
