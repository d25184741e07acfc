// W3: self-colliding cloth lands on a ball or on another cloth; the engine and Bullet, with the exact number of
// intersections at the end (`pliant bench W3`).
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "apps/bench/cloth.h"

namespace pliant::bench {

/// The workload in a form that does not depend on the engine: N x N cloths of 1 m with rigid edges, self-collision, no
/// bending.
struct Landing {
  std::string on;                        ///< what the cloth lands on: "ball" or "cloth"
  int size = 0;                          ///< number N of vertices along a side of each cloth
  std::vector<Object> cloths;            ///< cloths as objects of Pliant; the lower one of two has pinned corners
  std::vector<std::vector<Edge>> edges;  ///< edges of each cloth
  Vec3f ball{};                          ///< centre of the ball [m]
  float radius = 0;                      ///< radius of the ball [m]; 0: no ball
};

/// Makes a landing. Throws an Error if `on` is neither "ball" nor "cloth".
Landing make_landing(const std::string& on, int size);

/// An engine that simulates a Landing.
class LandingEngine {
 public:
  virtual ~LandingEngine() = default;
  virtual void step(float dt) = 0;
  virtual std::vector<Vec3f> positions(int cloth) const = 0;
};

std::unique_ptr<LandingEngine> make_pliant_landing(const Landing& landing, Steps steps);
/// Makes an engine of Bullet's position based soft bodies that collide by `clusters` convex clusters of their faces; 0:
/// a cluster for each face, which is finest. Null if this program was built without Bullet.
std::unique_ptr<LandingEngine> make_bullet_landing(const Landing& landing, Steps steps, int clusters);

/// The results of one engine for one landing and size, in processor time of one thread.
struct LandingRow {
  std::string on, engine;
  int size = 0, substeps = 0, iterations = 0;
  int frames = 0;       ///< frames completed within the time limit
  bool in_time = true;  ///< true if all frames were completed
  double mean_ms = 0, median_ms = 0, largest_ms = 0;
  /// Edges that intersect a triangle after the last frame; not counted if a position is not finite.
  std::size_t crossings = 0;
  double stretch_mean = 0, stretch_p99 = 0;  ///< length over rest length after the last frame; NaN if a position is
  double ratio = 0;                          ///< speedup over the first row of the same landing and size
};

struct LandingOptions {
  std::vector<std::string> on{"ball", "cloth"};  ///< what the cloth lands on: "ball", "cloth"
  std::vector<int> sizes{64, 128};
  int frames = 120;    ///< number of frames from the start, all measured: fall, landing and draping
  double limit = 120;  ///< time limit of each row [s]
  bool against_bullet = false;
  std::function<void(const LandingRow&)> on_row;
};

/// Measures landings. Throws an Error if a size is outside 2..4096, frames or time are 0, or Bullet is requested but
/// not built in.
std::vector<LandingRow> measure_landings(const LandingOptions& options);

std::string to_json(const std::vector<LandingRow>& rows);

}  // namespace pliant::bench
