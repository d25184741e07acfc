// Solids that bend too stiffly, because linear tetrahedra lock where few of them lie across (docs/internals/solids.md).
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string>
#include <vector>

#include "constraints/gives_shape.h"
#include "inspect/inspect_scene.h"
#include "inspect/problems.h"
#include "math/disjoint_sets.h"
#include "math/jacobi_rotation.h"
#include "math/vector.h"
#include "model/soft_body_substeps.h"

namespace pliant {

namespace {

/// A body this many times as long as thick is expected to bend.
constexpr double slender = 4.01;
/// Told beyond this: 4 cells across have 1.27, 3 have 1.46, or 1.35 where volumes are joined.
constexpr double tolerated_stiffness = 1.3;

/// A connected piece of a solid: integrals over its tetrahedra.
struct SolidPiece {
  double volume = 0, edges_squared = 0;  ///< the latter: volume times the mean of a tetrahedron's squared edges
  Vec3d first;
  std::array<double, 6> second{};  ///< xx, yy, zz, xy, xz, yz
  bool is_free = false;            ///< false: all of its particles are pinned or fixed
};

using TetrahedronCorners = std::array<Vec3d, 4>;

double mean_squared_edge(const TetrahedronCorners& x) {
  double sum = 0;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i + 1; j < 4; ++j) sum += length_squared(x[i] - x[j]);
  return sum / 6;
}

void add_tetrahedron(const TetrahedronCorners& x, SolidPiece& piece) {
  const double volume = std::fabs(dot(cross(x[1] - x[0], x[2] - x[0]), x[3] - x[0])) / 6;
  Vec3d sum{};
  for (const Vec3d& one : x) sum += one;
  const auto add_moments = [&](const Vec3d& v) {  // the integral of x x^T is V / 20 (sum of x_i x_i^T + sum sum^T)
    const std::array<double, 6> products{v.x * v.x, v.y * v.y, v.z * v.z, v.x * v.y, v.x * v.z, v.y * v.z};
    for (std::size_t k = 0; k < 6; ++k) piece.second[k] += volume / 20 * products[k];
  };
  for (const Vec3d& one : x) add_moments(one);
  add_moments(sum);
  piece.first += sum * (volume / 4);
  piece.edges_squared += volume * mean_squared_edge(x);
  piece.volume += volume;
}

/// The smallest and the largest side of the box with the same second moments [m].
std::array<double, 2> sides_of(const SolidPiece& piece) {
  const Vec3d c = piece.first * (1 / piece.volume);
  const std::array<double, 6> products{c.x * c.x, c.y * c.y, c.z * c.z, c.x * c.y, c.x * c.z, c.y * c.z};
  std::array<double, 6> s{};
  for (std::size_t k = 0; k < 6; ++k) s[k] = piece.second[k] / piece.volume - products[k];
  Diagonal<3> moments;
  const double full[3][3] = {{s[0], s[3], s[4]}, {s[3], s[1], s[5]}, {s[4], s[5], s[2]}};
  std::copy(&full[0][0], &full[0][0] + 9, &moments.a[0][0]);
  make_diagonal(moments);
  const auto [low, high] = std::minmax({moments.a[0][0], moments.a[1][1], moments.a[2][2]});
  return {std::sqrt(12 * std::max(low, 0.)), std::sqrt(12 * std::max(high, 0.))};
}

/// The edge of cubes, each cut into six tetrahedra, with the same mean square of edges [m].
double cell_of(const SolidPiece& piece) {
  constexpr double edges_of_cube = 5. / 3;
  return std::sqrt(piece.edges_squared / piece.volume / edges_of_cube);
}

/// How many times too stiffly a bar of this many cells across bends; fitted to cantilevers of 1 to 6 cells of a
/// Poisson's ratio of 0.3, and of 0.47, where volumes are joined.
double bending_stiffness(double cells, bool is_joined) {
  return is_joined ? 1 + 1.8 / std::pow(cells, 1.5) : 1 + 3.3 / std::pow(cells, 1.8);
}

Vec3d place_of(const Object& object, int particle) {
  return convert<double>(object.positions[static_cast<std::size_t>(particle)] - object.positions[0]);
}

std::vector<char> held_particles(const Object& object) {
  std::vector<char> held(object.positions.size(), 0);
  for (std::size_t i = 0; i < held.size(); ++i) held[i] = std::isfinite(object.masses[i]) ? 0 : 1;
  for (const Pin& pin : object.pins) held[static_cast<std::size_t>(pin.particle)] = 1;
  return held;
}

/// Calls visit(corners) for each tetrahedron that yields.
template <class Visit>
void for_elastic_tetrahedra(const Object& object, const Visit& visit) {
  for (const ConstraintGroup& group : object.constraints)
    if (gives_shape(group.type) && group.stiffness.kind == Stiffness::Kind::compliance)
      for (std::size_t t = 0; t + 4 <= group.particles.size(); t += 4) visit(&group.particles[t]);
}

/// The pieces of an object, by the lowest particle of each; those of other particles are empty.
std::vector<SolidPiece> pieces_of(const Object& object) {
  DisjointSets sets(object.positions.size());
  for_elastic_tetrahedra(object, [&](const int* corners) {
    for (std::size_t k = 1; k < 4; ++k)
      sets.join(static_cast<std::size_t>(corners[0]), static_cast<std::size_t>(corners[k]));
  });
  const std::vector<char> held = held_particles(object);
  std::vector<SolidPiece> pieces(object.positions.size());
  for_elastic_tetrahedra(object, [&](const int* corners) {
    SolidPiece& piece = pieces[sets.root(static_cast<std::size_t>(corners[0]))];
    TetrahedronCorners x;
    for (std::size_t k = 0; k < 4; ++k) {
      x[k] = place_of(object, corners[k]);
      if (held[static_cast<std::size_t>(corners[k])] == 0) piece.is_free = true;
    }
    add_tetrahedron(x, piece);
  });
  return pieces;
}

struct StifflyBent {
  double times = 1, cells = 0, thickness = 0;
};

/// The piece that bends most stiffly.
StifflyBent stiffest_of(const Object& object) {
  StifflyBent worst;
  const bool is_joined = keeps_volumes_jointly(object);
  for (const SolidPiece& piece : pieces_of(object)) {
    if (!piece.is_free || !(piece.volume > 0)) continue;
    const auto [thickness, longest] = sides_of(piece);
    if (!(longest > slender * thickness)) continue;
    const double cells = thickness / cell_of(piece), times = bending_stiffness(std::max(cells, 0.5), is_joined);
    if (times > worst.times) worst = {times, cells, thickness};
  }
  return worst;
}

std::string two_digits_of(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g", value);
  return text;
}

}  // namespace

void doubt_bent_solids(Problems& problems, const Scene& scene) {
  for (const Object& object : scene.objects) {
    if (!is_soft_body(object)) continue;
    const StifflyBent found = stiffest_of(object);
    if (found.times <= tolerated_stiffness) continue;
    problems.at(object.name);
    problems.doubtful("",
                      "has about " + two_digits_of(found.cells) + " cells across its thickness of " +
                          two_digits_of(found.thickness) + " m, so it bends about " + two_digits_of(found.times) +
                          " times too stiffly; pulled or pressed it is as stiff as its modulus says",
                      "if it is to bend, give 4 cells or more: edges of " + two_digits_of(found.thickness / 4) +
                          " m; a cloth or a rod bends as it should with fewer");
  }
  problems.at("");
}

}  // namespace pliant
