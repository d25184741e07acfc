#include "collision/narrow/covered_pairs.h"

#include <algorithm>

#include "math/record.h"
#include "math/vector.h"

namespace pliant {

namespace {

/// A closest point with a smaller weight of a corner counts as lying on the opposite edge or end.
constexpr float least_corner_weight = 1e-5f;
/// A neighbouring triangle is closer if one of its corners rises towards the vertex by over this share of its distance.
constexpr float least_rise = 1e-3f;

/// Branch-free, because the branches would be mispredicted.
bool has(const Triangle& t, int vertex) {
  return ((t[0] == vertex ? 1 : 0) | (t[1] == vertex ? 1 : 0) | (t[2] == vertex ? 1 : 0)) != 0;
}

/// The end of an edge if the edge's closest point is that end; -1 if the point lies between the ends.
int end_of(int a, int b, float weight_of_a, float weight_of_b) {
  if (abs(weight_of_b) < least_corner_weight) return a;
  return abs(weight_of_a) < least_corner_weight ? b : -1;
}

/// True if the angle between two edges of a triangle, or between the two edges of a pair, is at least about two degrees.
bool is_well_conditioned(const PairStencil& pair, const Record* positions) {
  const auto& v = pair.vertex;
  const bool edges = pair.first_side == 2;
  const Vec3f first = xyz(positions[v[edges ? 1 : 2]]) - xyz(positions[v[edges ? 0 : 1]]),
              second = xyz(positions[v[3]]) - xyz(positions[v[edges ? 2 : 1]]);
  return length_squared(cross(first, second)) > 1e-3f * length_squared(first) * length_squared(second);
}

}  // namespace

bool CoveredPairs::has_triangle_without(int a, int b, int vertex) const {
  return std::any_of(around_.begin(a), around_.end(a), [&](int number) {
    const Triangle& t = elements_.triangles[static_cast<std::size_t>(number)];
    return has(t, b) && !has(t, vertex);
  });
}

/// For a vertex and a triangle: true if another triangle with the same closest point comes closer to the vertex.
bool CoveredPairs::is_closer_beside(const PairStencil& pair, const Closest& at, const Record* positions) const {
  const int vertex = pair.vertex[0];
  std::array<int, 3> holds{};
  int held = 0;
  Vec3f point{};
  for (int i = 1; i < 4; ++i) {
    const float weight = -at.weight[i];
    if (weight < least_corner_weight) continue;
    holds[static_cast<std::size_t>(held++)] = pair.vertex[static_cast<std::size_t>(i)];
    point += (xyz(positions[pair.vertex[static_cast<std::size_t>(i)]]) - xyz(positions[vertex])) * weight;
  }
  if (held == 0 || held == 3) return false;
  const auto rises = [&](int corner) {
    // By rounding of the closest point along an edge, one end of the edge may seem to rise.
    if (corner == holds[0] || (held == 2 && corner == holds[1])) return false;
    const Vec3f beside = xyz(positions[corner]) - xyz(positions[vertex]) - point;
    return dot(at.normal, beside) > least_rise * length(beside);
  };
  return std::any_of(around_.begin(holds[0]), around_.end(holds[0]), [&](int number) {
    const Triangle& t = elements_.triangles[static_cast<std::size_t>(number)];
    if (has(t, vertex) || (held == 2 && !has(t, holds[1]))) return false;
    return std::any_of(t.begin(), t.end(), rises);
  });
}

bool CoveredPairs::covers(const PairStencil& pair, const Closest& at, const Record* positions) const {
  if (pair.first_side == 1) return is_closer_beside(pair, at, positions);
  const auto& v = pair.vertex;
  const int first = end_of(v[0], v[1], at.weight[0], at.weight[1]), second = end_of(v[2], v[3], at.weight[2], at.weight[3]);
  return (first >= 0 && has_triangle_without(v[2], v[3], first)) ||
         (second >= 0 && has_triangle_without(v[0], v[1], second));
}

/// For slivers and nearly parallel edges, closest points in float can be wrong, so double precision must agree before a
/// pair is dropped.
bool CoveredPairs::covers(const PairStencil& pair, const PairBatch& at, int lane, const Record* positions) const {
  const Closest coarse{{at.weight[0][lane], at.weight[1][lane], at.weight[2][lane], at.weight[3][lane]},
                       {at.normal[0][lane], at.normal[1][lane], at.normal[2][lane]}};
  if (!covers(pair, coarse, positions)) return false;
  if (is_well_conditioned(pair, positions)) return true;
  const PairDistance fine = pair_distance(pair, positions);
  const auto weight = [&](std::size_t i) { return static_cast<float>(fine.weight[i]); };
  return covers(pair, {{weight(0), weight(1), weight(2), weight(3)}, convert<float>(fine.normal)}, positions);
}

}  // namespace pliant
