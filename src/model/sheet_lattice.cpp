#include "model/sheet_lattice.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/at.h"
#include "math/vector.h"

namespace pliant {

namespace {

/// The most that a vertex may be off the lattice, over the largest coordinate: a few roundings.
constexpr double most_off = 2.5e-7;

/// A lattice o + i a + j b.
struct Lattice {
  Vec3d o{}, a{}, b{};
  Vec3d at_node(const std::array<double, 2>& node) const { return o + a * node[0] + b * node[1]; }
};

/// The whole numbers nearest to a point's coordinates in a lattice.
std::array<double, 2> nearest_node(const Lattice& of, const Vec3d& point) {
  const double aa = dot(of.a, of.a), ab = dot(of.a, of.b), bb = dot(of.b, of.b), determinant = aa * bb - ab * ab;
  const Vec3d d = point - of.o;
  const double da = dot(d, of.a), db = dot(d, of.b);
  return {std::floor((da * bb - db * ab) / determinant + 0.5), std::floor((db * aa - da * ab) / determinant + 0.5)};
}

/// The lattice that fits points by least squares, of which each is at its node. False if the nodes are on a line.
bool fit(const std::vector<Vec3d>& points, const std::vector<std::array<double, 2>>& nodes, Lattice& out) {
  const double n = static_cast<double>(points.size());
  Vec3d middle{};
  double i = 0, j = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    middle += points[k] * (1 / n);
    i += nodes[k][0] / n;
    j += nodes[k][1] / n;
  }
  double ii = 0, ij = 0, jj = 0;
  Vec3d by_i{}, by_j{};
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double p = nodes[k][0] - i, q = nodes[k][1] - j;
    ii += p * p;
    ij += p * q;
    jj += q * q;
    by_i += (points[k] - middle) * p;
    by_j += (points[k] - middle) * q;
  }
  const double determinant = ii * jj - ij * ij;
  if (!(determinant > 1e-9 * ii * jj)) return false;
  out.a = (by_i * jj - by_j * ij) * (1 / determinant);
  out.b = (by_j * ii - by_i * ij) * (1 / determinant);
  out.o = middle - out.a * i - out.b * j;
  return true;
}

}  // namespace

std::vector<Vec3d> unrounded_rest_positions(const Object& object) {
  std::vector<Vec3d> rest;
  rest.reserve(object.positions.size());
  for (const Vec3f& p : object.positions) rest.push_back(convert<double>(p));
  if (object.triangles.empty()) return rest;
  std::vector<char> is_vertex(rest.size(), 0);
  for (const std::array<int, 3>& triangle : object.triangles)
    for (const int v : triangle) is_vertex[at(v)] = 1;
  const auto& [p, q, r] = object.triangles.front();
  Lattice lattice{rest[at(p)], rest[at(q)] - rest[at(p)], rest[at(r)] - rest[at(p)]};
  std::vector<Vec3d> points;
  std::vector<std::array<double, 2>> nodes;
  points.reserve(rest.size());
  nodes.reserve(rest.size());
  double largest = 0;
  for (std::size_t v = 0; v < rest.size(); ++v) {
    if (is_vertex[v] == 0) continue;
    points.push_back(rest[v]);
    nodes.push_back(nearest_node(lattice, rest[v]));
    largest = std::max({largest, std::fabs(rest[v].x), std::fabs(rest[v].y), std::fabs(rest[v].z)});
  }
  if (!fit(points, nodes, lattice)) return rest;
  for (std::size_t k = 0; k < points.size(); ++k)
    if (!(length(lattice.at_node(nodes[k]) - points[k]) <= most_off * largest)) return rest;
  for (std::size_t v = 0, k = 0; v < rest.size(); ++v)
    if (is_vertex[v] != 0) rest[v] = lattice.at_node(nodes[k++]);
  return rest;
}

void unify(std::vector<double>& rigidities) {
  constexpr double most = 1e-4;
  double sum = 0, count = 0, least = 0, largest = 0;
  for (const double b : rigidities) {
    if (b == 0) continue;
    least = count == 0 ? b : std::min(least, b);
    largest = std::max(largest, b);
    sum += b;
    ++count;
  }
  if (count == 0 || largest - least > most * least) return;
  for (double& b : rigidities) b = b == 0 ? 0 : sum / count;
}

}  // namespace pliant
