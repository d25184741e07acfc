// W1, the standard benchmark cloth: N x N particles, 1 m, hung by two corners, one stretching constraint per edge and
// optionally one bending constraint per inner edge; and the interface of an engine to be measured on it.
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

/// The workload in an engine-independent form.
struct Cloth {
  Object object;              ///< the cloth as an object of Pliant, with pins
  std::vector<Edge> edges;    ///< the object's edges, in the order of their first use by triangles
  std::vector<Hinge> hinges;  ///< hinges in the order of their edges; empty without bending
  std::array<int, 2> pins{};
};

/// How grid cells are cut: all alike, or alternating,
/// as in the published figures of other engines.
enum class Diagonals { uniform, alternating };

/// The object alone, without the lists for other engines.
Object make_w1_object(int size, bool with_bending, Diagonals diagonals = Diagonals::uniform);
Cloth make_w1(int size, bool with_bending, Diagonals diagonals = Diagonals::uniform);

/// The edges with distance constraints, in the order of their first use by triangles.
std::vector<Edge> edges_of(const Object& object);

/// A grid of size x size over 1 m without any alignment: inner particles are
/// displaced by up to 0.3 of a cell, and diagonals have random directions.
TriangleMesh make_irregular_mesh(int size);

/// An engine that simulates a Cloth.
class Engine {
 public:
  virtual ~Engine() = default;
  virtual void step(float dt) = 0;
  virtual std::vector<Vec3f> positions() const = 0;
  virtual int threads() const { return 1; }
  /// Milliseconds per frame by phase, over `frames` more frames; empty if the engine does not measure phases.
  virtual std::vector<PhaseTime> phases(float /*dt*/, int /*frames*/) { return {}; }
};

struct Steps {
  int substeps, iterations;
};

std::unique_ptr<Engine> make_plain_loop(const Cloth& cloth, Steps steps);
std::unique_ptr<Engine> make_pliant(const Cloth& cloth, Steps steps, int threads);

/// The order in which Bullet solves its links.
enum class BulletOrder {
  shuffled,  ///< in the order in which Bullet's mesh helper leaves them
  spread,    ///< as Bullet's ReoptimizeLinkOrder leaves them: consecutive links share no particle; the faster one
};

/// Null if this build lacks Bullet. Edges only.
std::unique_ptr<Engine> make_bullet(const Cloth& cloth, Steps steps, BulletOrder order);

}  // namespace pliant::bench
