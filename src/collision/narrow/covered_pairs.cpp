#include "collision/narrow/covered_pairs.h"

#include <algorithm>
#include <utility>

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

/// True if the angle between two edges of a triangle, or between the two edges of a pair, is at least about two
/// degrees.
bool is_well_conditioned(const PairStencil& pair, const Record* positions) {
  const auto& v = pair.vertex;
  const bool edges = pair.first_side == 2;
  const Vec3f first = xyz(positions[v[edges ? 1 : 2]]) - xyz(positions[v[edges ? 0 : 1]]),
              second = xyz(positions[v[3]]) - xyz(positions[v[edges ? 2 : 1]]);
  return length_squared(cross(first, second)) > 1e-3f * length_squared(first) * length_squared(second);
}

}  // namespace

bool CoveredPairs::has_triangle_without(int a, int b, int vertex) const {
  const std::array<int, 2>* const others = around_.others(a);
  return vertex != a && std::any_of(others, others + (around_.end(a) - around_.begin(a)), [&](const auto& other) {
           return (other[0] == b && other[1] != vertex) || (other[1] == b && other[0] != vertex);
         });
}

CoveredPairs::Feature CoveredPairs::feature_of(const PairStencil& pair, const Closest& at, int first, int last,
                                               const Record* positions) {
  Feature feature;
  for (int i = first; i < last; ++i) {
    const float weight = abs(at.weight[i]);
    if (weight < least_corner_weight) continue;
    const int corner = pair.vertex[static_cast<std::size_t>(i)];
    feature.holds[static_cast<std::size_t>(feature.held++)] = corner;
    feature.point += (xyz(positions[corner]) - xyz(positions[pair.vertex[0]])) * weight;
  }
  return feature;
}

template <class Counts>
bool CoveredPairs::rises_beside(const Feature& feature, const Vec3f& towards, int origin, const Record* positions,
                                Counts counts) const {
  const auto& holds = feature.holds;
  const auto rises = [&](int corner) {
    const Vec3f beside = xyz(positions[corner]) - xyz(positions[origin]) - feature.point;
    const float rise = dot(towards, beside);
    return rise > 0 && rise > least_rise * length(beside);  // most corners of flat meshes need no length
  };
  // Not the ends of the edge itself: by rounding of the closest point along it, one may seem to rise.
  const auto any_rises = [&](const std::array<int, 2>& others) {
    if (feature.held != 2) return rises(others[0]) || rises(others[1]);
    return (others[0] == holds[1] && rises(others[1])) || (others[1] == holds[1] && rises(others[0]));
  };
  const int* const first = around_.begin(holds[0]);
  const std::array<int, 2>* const others = around_.others(holds[0]);
  const std::ptrdiff_t count = around_.end(holds[0]) - first;
  for (std::ptrdiff_t i = 0; i < count; ++i)
    if (any_rises(others[i]) && counts(elements_.triangles[static_cast<std::size_t>(first[i])])) return true;
  return false;
}

/// For a vertex and a triangle: true if another triangle with the same closest point comes closer to the vertex.
bool CoveredPairs::is_closer_beside(const PairStencil& pair, const Closest& at, const Record* positions) const {
  const Feature feature = feature_of(pair, at, 1, 4, positions);
  if (feature.held == 0 || feature.held == 3) return false;
  const auto counts = [&](const Triangle& t) { return !has(t, pair.vertex[0]); };
  return rises_beside(feature, at.normal, pair.vertex[0], positions, counts);
}

bool CoveredPairs::is_closer_on_mesh(const PairStencil& pair, int side, const Closest& at, const Record* positions,
                                     const FunctionRef<bool(const PairStencil&)>& is_exempt) const {
  const Feature feature = side == 0 ? feature_of(pair, at, 0, pair.first_side, positions)
                                    : feature_of(pair, at, pair.first_side, 4, positions);
  if (feature.held == 0 || feature.held == 3) return false;
  const auto other = side == 0 ? std::pair{pair.first_side, 4} : std::pair{0, pair.first_side};
  const auto counts = [&](const Triangle& t) {
    return std::none_of(pair.vertex.begin() + other.first, pair.vertex.begin() + other.second, [&](std::int32_t v) {
      return is_exempt({{v, t[0], t[1], t[2]}, 1});
    });
  };
  return rises_beside(feature, side == 0 ? -at.normal : at.normal, pair.vertex[0], positions, counts);
}

bool CoveredPairs::covers(const PairStencil& pair, const Closest& at, const Record* positions) const {
  if (pair.first_side == 1) return is_closer_beside(pair, at, positions);
  const auto& v = pair.vertex;
  const int first = end_of(v[0], v[1], at.weight[0], at.weight[1]),
            second = end_of(v[2], v[3], at.weight[2], at.weight[3]);
  return (first >= 0 && has_triangle_without(v[2], v[3], first)) ||
         (second >= 0 && has_triangle_without(v[0], v[1], second));
}

namespace {

/// The closest points of a pair in double precision.
template <class Closest>
Closest in_double(const PairStencil& pair, const Record* positions) {
  const PairDistance fine = pair_distance(pair, positions);
  const auto weight = [&](std::size_t i) { return static_cast<float>(fine.weight[i]); };
  return {{weight(0), weight(1), weight(2), weight(3)}, convert<float>(fine.normal)};
}

template <class Closest>
Closest in_lane(const PairBatch& at, int lane) {
  return {{at.weight[0][lane], at.weight[1][lane], at.weight[2][lane], at.weight[3][lane]},
          {at.normal[0][lane], at.normal[1][lane], at.normal[2][lane]}};
}

}  // namespace

/// For slivers and nearly parallel edges, closest points in float can be wrong, so double precision must agree before a
/// pair is dropped.
bool CoveredPairs::covers(const PairStencil& pair, const PairBatch& at, int lane, const Record* positions) const {
  if (!covers(pair, in_lane<Closest>(at, lane), positions)) return false;
  return is_well_conditioned(pair, positions) || covers(pair, in_double<Closest>(pair, positions), positions);
}

bool CoveredPairs::is_closer_on_mesh(const PairStencil& pair, int side, const PairBatch& at, int lane,
                                     const Record* positions,
                                     const FunctionRef<bool(const PairStencil&)>& is_exempt) const {
  if (!is_closer_on_mesh(pair, side, in_lane<Closest>(at, lane), positions, is_exempt)) return false;
  return is_well_conditioned(pair, positions) ||
         is_closer_on_mesh(pair, side, in_double<Closest>(pair, positions), positions, is_exempt);
}

}  // namespace pliant
