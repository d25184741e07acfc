// W1, the standard benchmark cloth: N x N particles over 1 m x 1 m, hung by two corners, with a distance constraint for
// each edge and optionally a bending constraint for each inner edge. Also the interface of an engine that is measured
// on it.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "pliant/mesh.h"
#include "pliant/scene.h"
#include "pliant/world.h"

namespace pliant::bench {

struct Edge {
  int a, b;
  float rest_length;
};

/// v0-v1 is the shared edge, v2 and v3 are the opposite corners; the rest angle is 0.
struct Hinge {
  int v0, v1, v2, v3;
  float compliance;
};

/// A workload in a form that does not depend on the engine.
struct Cloth {
  Object object;              ///< the cloth as an object of Pliant, with its pins
  std::vector<Edge> edges;    ///< edges in the order in which triangles use them first
  std::vector<Hinge> hinges;  ///< hinges in the order of their edges; empty without bending
  std::array<int, 2> pins{};
};

/// The diagonals of grid cells: all in one direction, or alternating, as in figures that other engines
/// publish.
enum class Diagonals { uniform, alternating };

/// Makes the object without the lists for other engines.
Object make_w1_object(int size, bool with_bending, Diagonals diagonals = Diagonals::uniform);
Cloth make_w1(int size, bool with_bending, Diagonals diagonals = Diagonals::uniform);

/// The edges that have distance constraints, in the order in which triangles use them first.
std::vector<Edge> edges_of(const Object& object);

/// A grid of size x size vertices over 1 m x 1 m that is aligned with nothing: inner vertices are displaced by up to
/// 0.3 of a cell, and diagonals have random directions.
TriangleMesh make_irregular_mesh(int size);

/// An engine that simulates a Cloth.
class Engine {
 public:
  virtual ~Engine() = default;
  virtual void step(float dt) = 0;
  virtual std::vector<Vec3f> positions() const = 0;
  virtual int threads() const { return 1; }
  /// Simulates `frames` more frames, and returns the time of each phase per frame [ms]; empty if the engine does not
  /// measure phases.
  virtual std::vector<PhaseTime> phases(float /*dt*/, int /*frames*/) { return {}; }
};

struct Steps {
  int substeps, iterations;
};

std::unique_ptr<Engine> make_plain_loop(const Cloth& cloth, Steps steps);
std::unique_ptr<Engine> make_pliant(const Cloth& cloth, Steps steps, int threads);

/// The order in which Bullet solves its links.
enum class BulletOrder {
  shuffled,  ///< the order in which Bullet's mesh helper leaves them
  spread,    ///< the order of Bullet's ReoptimizeLinkOrder: consecutive links share no particle; faster
};

/// Makes Bullet's engine for the edges of a cloth; null if this program was built without Bullet.
std::unique_ptr<Engine> make_bullet(const Cloth& cloth, Steps steps, BulletOrder order);

}  // namespace pliant::bench
