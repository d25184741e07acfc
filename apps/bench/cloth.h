// W1, the cloth that everything is measured on: N x N particles, 1 m, hung by two corners, one stretching constraint an
// edge, one bending constraint an inner edge if wanted; and what an engine must offer to be measured on it.
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

/// The workload, free of any engine.
struct Cloth {
  Object object;              ///< as Pliant takes it, pins included
  std::vector<Edge> edges;    ///< the object's own, in the order in which its triangles first name them
  std::vector<Hinge> hinges;  ///< likewise; empty without bending
  std::array<int, 2> pins{};
};

/// Which way the cells of the grid are cut: all alike, or each the other way than its neighbours, as other engines' figures have
/// it.
enum class Diagonals { uniform, alternating };

/// The object alone, without the lists that other engines need.
Object make_w1_object(int size, bool with_bending, Diagonals diagonals = Diagonals::uniform);
Cloth make_w1(int size, bool with_bending, Diagonals diagonals = Diagonals::uniform);

/// The edges that a cloth's distance constraints stand on, in the order in which its triangles first name them.
std::vector<Edge> edges_of(const Object& object);

/// A grid of size x size over 1 m whose inner particles are moved by up to 0.3 of a cell, each cell's diagonal either way:
/// nothing in it lines up.
TriangleMesh make_irregular_mesh(int size);

/// An engine at work on a Cloth.
class Engine {
 public:
  virtual ~Engine() = default;
  virtual void step(float dt) = 0;
  virtual std::vector<Vec3f> positions() const = 0;
  virtual int threads() const { return 1; }
  /// Milliseconds a frame by phase, over so many more frames; nothing where an engine has none to tell.
  virtual std::vector<PhaseTime> phases(float /*dt*/, int /*frames*/) { return {}; }
};

struct Steps {
  int substeps, iterations;
};

std::unique_ptr<Engine> make_plain_loop(const Cloth& cloth, Steps steps);
std::unique_ptr<Engine> make_pliant(const Cloth& cloth, Steps steps, int threads);

/// The order in which Bullet solves its links.
enum class BulletOrder {
  shuffled,  ///< as its helper that makes a body from a mesh leaves them
  spread,    ///< as its ReoptimizeLinkOrder leaves them: neighbours do not wait for each other; the faster one
};

/// Null where Bullet was not found when this was built. Edges only.
std::unique_ptr<Engine> make_bullet(const Cloth& cloth, Steps steps, BulletOrder order);

}  // namespace pliant::bench
