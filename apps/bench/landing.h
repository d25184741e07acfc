// W3: cloth that meets itself lands on a ball, or on another cloth; the engine beside Bullet, with the exact count of what
// passes through what at the end. `pliant bench W3` prints it.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "apps/bench/cloth.h"

namespace pliant::bench {

/// The workload, free of any engine: N x N cloths of 1 m with rigid edges and no bending, which meet themselves and one another.
struct Landing {
  std::string on;                        ///< "ball" or "cloth"
  int size = 0;                          ///< N
  std::vector<Object> cloths;            ///< as Pliant takes them; the held one of two has its corners pinned
  std::vector<std::vector<Edge>> edges;  ///< of each
  Vec3f ball{};                          ///< its middle [m]
  float radius = 0;                      ///< of the ball [m]; 0: there is none
};

/// Throws Error where `on` is neither.
Landing make_landing(const std::string& on, int size);

/// An engine at work on a Landing.
class LandingEngine {
 public:
  virtual ~LandingEngine() = default;
  virtual void step(float dt) = 0;
  virtual std::vector<Vec3f> positions(int cloth) const = 0;
};

std::unique_ptr<LandingEngine> make_pliant_landing(const Landing& landing, Steps steps);
/// Bullet's position based soft body, kept from itself and from others by so many convex clusters of its faces; 0: one for each
/// face, the finest that it has. Null where Bullet was not found when this was built.
std::unique_ptr<LandingEngine> make_bullet_landing(const Landing& landing, Steps steps, int clusters);

/// Processor time of one thread.
struct LandingRow {
  std::string on, engine;
  int size = 0, substeps = 0, iterations = 0;
  int frames = 0;       ///< done within the limit
  bool in_time = true;  ///< whether those are all
  double mean_ms = 0, median_ms = 0, largest_ms = 0;
  std::size_t crossings =
      0;  ///< edges that pass through a triangle after the last of them; not counted where a position is no number
  double stretch_mean = 0, stretch_p99 = 0;  ///< length over rest length then; not a number where a position is not
  double ratio = 0;                          ///< how many times as fast as the first row of the same landing and size
};

struct LandingOptions {
  std::vector<std::string> on{"ball", "cloth"};  ///< landings
  std::vector<int> sizes{64, 128};
  int frames = 120;    ///< from the start: the fall, the landing and the draping
  double limit = 120;  ///< on each row's time [s]
  bool against_bullet = false;
  std::function<void(const LandingRow&)> on_row;
};

/// Throws Error where a size is out of 2..4096, there are no frames or no time, or Bullet is asked for and was not built in.
std::vector<LandingRow> measure_landings(const LandingOptions& options);

std::string to_json(const std::vector<LandingRow>& rows);

}  // namespace pliant::bench
