#include "collision/filter/pair_impulses.h"

#include <algorithm>
#include <cmath>

#include "math/vector.h"

namespace pliant {

namespace {

/// Neighbours push one another back in each sweep, so an impulse passes through several layers.
constexpr int most_sweeps = 12;
/// A particle changes its velocity by no more than this times its pair's approach. Near the heavy end of an edge the
/// light one would be flung away.
constexpr double longest_lever = 2;

/// The order of vertices that decides bits.
struct VertexOrder {
  const std::vector<int>& body;

  bool operator()(std::int32_t a, std::int32_t b) const {
    const int of_a = body[static_cast<std::size_t>(a)], of_b = body[static_cast<std::size_t>(b)];
    return of_a != of_b ? of_a < of_b : a < b;
  }
  bool operator()(const SeparatingSlab& a, const SeparatingSlab& b) const {
    if (a.pair.first_side != b.pair.first_side) return a.pair.first_side < b.pair.first_side;
    return std::lexicographical_compare(a.pair.vertex.begin(), a.pair.vertex.end(), b.pair.vertex.begin(),
                                        b.pair.vertex.end(), *this);
  }
};

bool is_same(const SeparatingSlab& a, const SeparatingSlab& b) {
  return a.pair.first_side == b.pair.first_side && a.pair.vertex == b.pair.vertex;
}

/// The displacements that become velocities, of the vertices of all pairs.
class Wanted {
 public:
  Wanted(const std::vector<VertexDisplacement>& before, const std::vector<SeparatingSlab>& slabs,
         const VertexOrder& order, const Record* displacements)
      : order_(order) {
    vertices_.reserve(4 * slabs.size());
    for (const SeparatingSlab& slab : slabs)
      vertices_.insert(vertices_.end(), slab.pair.vertex.begin(), slab.pair.vertex.end());
    for (const VertexDisplacement& of : before) vertices_.push_back(of.first);
    std::sort(vertices_.begin(), vertices_.end(), order_);
    vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
    displacement_.reserve(vertices_.size());
    for (const std::int32_t v : vertices_) {
      const Record& d = displacements[v];
      displacement_.push_back({double(d.x), double(d.y), double(d.z)});
    }
    for (const auto& [vertex, d] : before) of(vertex) = convert<double>(d);
  }

  Vec3d& of(std::int32_t vertex) {
    const auto found = std::lower_bound(vertices_.begin(), vertices_.end(), vertex, order_);
    return displacement_[static_cast<std::size_t>(found - vertices_.begin())];
  }
  const std::vector<std::int32_t>& vertices() const { return vertices_; }

 private:
  VertexOrder order_;
  std::vector<std::int32_t> vertices_;  ///< in order
  std::vector<Vec3d> displacement_;     ///< of each [m]
};

/// Ends the approach of a pair beyond its margin. Returns false if there is none.
bool end_approach(const SeparatingSlab& slab, const Record* positions, Wanted& wanted) {
  double apart = slab.gap, inverse_mass = 0, largest = 0;
  for (int i = 0; i < 4; ++i) {
    const double w = double(positions[slab.pair.vertex[i]].w);
    apart += slab.weight[i] * dot(slab.normal, wanted.of(slab.pair.vertex[i]));
    inverse_mass += slab.weight[i] * slab.weight[i] * w;
    largest = std::max(largest, std::abs(slab.weight[i]) * w);
  }
  if (!(apart < slab.thickness * (1 - 1e-9)) || !(inverse_mass > 0)) return false;
  const Vec3d impulse = slab.normal * ((slab.thickness - apart) / std::max(inverse_mass, largest / longest_lever));
  for (int i = 0; i < 4; ++i)
    wanted.of(slab.pair.vertex[i]) += impulse * (slab.weight[i] * double(positions[slab.pair.vertex[i]].w));
  return true;
}

}  // namespace

void keep_momentum(std::vector<VertexDisplacement>& before, std::vector<SeparatingSlab>& slabs,
                   const std::vector<int>& body, const Record* positions, const Record* displacements,
                   std::vector<VertexDisplacement>& without_velocity) {
  const VertexOrder order{body};
  const auto by_vertex = [](const VertexDisplacement& a, const VertexDisplacement& b) { return a.first < b.first; };
  const auto of_one = [](const VertexDisplacement& a, const VertexDisplacement& b) { return a.first == b.first; };
  std::stable_sort(before.begin(), before.end(), by_vertex);
  before.erase(std::unique(before.begin(), before.end(), of_one), before.end());
  std::sort(slabs.begin(), slabs.end(), order);
  slabs.erase(std::unique(slabs.begin(), slabs.end(), is_same), slabs.end());
  Wanted wanted(before, slabs, order, displacements);
  bool any = true;
  for (int sweep = 0; sweep < most_sweeps && any; ++sweep) {
    any = false;
    for (const SeparatingSlab& slab : slabs) any = end_approach(slab, positions, wanted) || any;
    std::reverse(slabs.begin(), slabs.end());
  }
  for (const std::int32_t v : wanted.vertices()) {
    const Record& d = displacements[v];
    const Vec3d left = Vec3d{double(d.x), double(d.y), double(d.z)} - wanted.of(v);
    if (left.x != 0 || left.y != 0 || left.z != 0) without_velocity.emplace_back(v, convert<float>(left));
  }
}

}  // namespace pliant
