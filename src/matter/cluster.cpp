// Makes clusters of particles that keep their shape.
#include "pliant/cluster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "pliant/error.h"

namespace pliant {

namespace {

using Cell = std::array<std::int64_t, 3>;

/// The cells of one axis whose box, grown by half its side, contains x: one, or two.
std::array<std::int64_t, 2> cells_around(double x, double low, double size) {
  const double at = (x - low) / size;
  const auto cell = static_cast<std::int64_t>(std::floor(at));
  return {cell, at - static_cast<double>(cell) < 0.5 ? cell - 1 : cell + 1};
}

Vec3f low_corner(const std::vector<Vec3f>& positions) {
  Vec3f low = positions[0];
  for (const Vec3f& p : positions) low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
  return low;
}

/// The particles of each cell that has any, with those around it.
std::map<Cell, std::vector<int>> particles_by_cell(const std::vector<Vec3f>& positions, double size) {
  const Vec3f low = low_corner(positions);
  std::map<Cell, std::vector<int>> cells;
  std::set<Cell> occupied;
  for (int i = 0; i < static_cast<int>(positions.size()); ++i) {
    const Vec3f& p = positions[static_cast<std::size_t>(i)];
    const auto x = cells_around(double(p.x), double(low.x), size), y = cells_around(double(p.y), double(low.y), size),
               z = cells_around(double(p.z), double(low.z), size);
    occupied.insert({x[0], y[0], z[0]});
    for (const std::int64_t cx : x)
      for (const std::int64_t cy : y)
        for (const std::int64_t cz : z) cells[{cx, cy, cz}].push_back(i);
  }
  std::erase_if(cells, [&](const auto& cell) { return occupied.count(cell.first) == 0; });
  return cells;
}

Cluster cluster_of(std::vector<int> particles, const ClusterOptions& options) {
  Cluster cluster;
  cluster.particles = std::move(particles);
  cluster.mode = options.mode;
  cluster.share = options.share;
  cluster.stiffness = options.stiffness;
  cluster.plasticity = options.plasticity;
  return cluster;
}

}  // namespace

void add_cluster(Object& object, const std::vector<int>& particles, const ClusterOptions& options) {
  const Location where{.object = object.name, .element = "cluster " + std::to_string(object.clusters.size())};
  if (particles.size() < 2)
    throw Error(where, "has fewer than two particles", "give the particles that keep their shape");
  std::set<int> seen;
  for (const int p : particles) {
    if (p < 0 || static_cast<std::size_t>(p) >= object.positions.size())
      throw Error(where,
                  "has particle " + std::to_string(p) + ", but there are " + std::to_string(object.positions.size()),
                  "particles count from 0");
    if (!seen.insert(p).second) throw Error(where, "has particle " + std::to_string(p) + " twice", "name it once");
  }
  object.clusters.push_back(cluster_of(particles, options));
}

void add_clusters(Object& object, float size, const ClusterOptions& options) {
  const Location where{.object = object.name, .element = "clusters"};
  if (!(size > 0) || !std::isfinite(size))
    throw Error(where, "have a size of " + std::to_string(size), "give a positive size in metres");
  if (object.positions.empty()) return;
  constexpr float most_cells = 1e6f;  // along an axis
  for (const Vec3f& p : object.positions)
    if (!(length_squared(p) < most_cells * size * most_cells * size))
      throw Error(where, "of " + std::to_string(size) + " m are too small for the object, or a position is not finite",
                  "give a larger size");
  constexpr std::size_t fewest = 4;
  std::vector<char> is_in_one(object.positions.size(), 0);
  for (auto& [cell, particles] : particles_by_cell(object.positions, double(size))) {
    if (particles.size() < fewest) continue;
    for (const int p : particles) is_in_one[static_cast<std::size_t>(p)] = 1;
    object.clusters.push_back(cluster_of(std::move(particles), options));
  }
  const auto lonely = std::find(is_in_one.begin(), is_in_one.end(), 0);
  if (lonely != is_in_one.end())
    throw Error({.object = object.name, .element = "particle " + std::to_string(lonely - is_in_one.begin())},
                "is in no cluster of " + std::to_string(size) + " m, which would have fewer than four particles",
                "give a larger size");
}

}  // namespace pliant
