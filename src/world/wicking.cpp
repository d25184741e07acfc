#include "world/wicking.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/at.h"

namespace pliant {

namespace {

constexpr int most_steps = 100;  // of a frame; what would need more flows slower

/// In how many steps liquid spreads, so that none of them moves more than a quarter of what is between the ends of an
/// edge.
int steps_of(const CompiledAbsorbency& surface, double seconds) {
  std::vector<double> sums(surface.areas.size());
  for (const CompiledAbsorbency::Edge& edge : surface.edges) {
    sums[at(edge.a)] += static_cast<double>(edge.weight);
    sums[at(edge.b)] += static_cast<double>(edge.weight);
  }
  double fastest = 0;
  for (std::size_t i = 0; i < sums.size(); ++i)
    if (surface.areas[i] > 0) fastest = std::max(fastest, sums[i] / static_cast<double>(surface.areas[i]));
  const double wanted = std::ceil(seconds * static_cast<double>(surface.described.wicking) * fastest * 4);
  return static_cast<int>(std::clamp(wanted, 1.0, static_cast<double>(most_steps)));
}

using Carry = FunctionRef<void(int from, int to, float mass)>;

/// Moves a mass, which must not be above what is there [kg].
void move(int from, int to, double mass, float* water, Carry carry) {
  water[from] = static_cast<float>(static_cast<double>(water[from]) - mass);
  water[to] = static_cast<float>(static_cast<double>(water[to]) + mass);
  carry(from, to, static_cast<float>(mass));
}

/// One step along one edge.
void wick(const CompiledAbsorbency& surface, const CompiledAbsorbency::Edge& edge, const Slopes& slopes, double seconds,
          float* water, Carry carry) {
  const auto capacity = static_cast<double>(surface.described.capacity),
             rise = static_cast<double>(surface.described.rise);
  const auto area_a = static_cast<double>(surface.areas[at(edge.a)]),
             area_b = static_cast<double>(surface.areas[at(edge.b)]);
  const auto has_a = static_cast<double>(water[edge.a]), has_b = static_cast<double>(water[edge.b]);
  if (!(area_a > 0) || !(area_b > 0) || (has_a == 0 && has_b == 0)) return;
  const double a = std::min(has_a / area_a, capacity), b = std::min(has_b / area_b, capacity);
  const double potential = a - b + capacity * (slopes.heights[at(edge.a)] - slopes.heights[at(edge.b)]) / rise;
  const double conducts = static_cast<double>(surface.described.wicking) * static_cast<double>(edge.weight) * seconds;
  const double mobility = (a + b) / (2 * capacity);
  const double moved =
      std::clamp(std::min(conducts, 0.25 * std::min(area_a, area_b)) * mobility * potential, -has_b, has_a);
  if (moved > 0) move(edge.a, edge.b, moved, water, carry);
  if (moved < 0) move(edge.b, edge.a, -moved, water, carry);
}

/// Lets run down what is more than the capacity.
void run_off(const CompiledAbsorbency& surface, const Slopes& slopes, double seconds, float* water, Carry carry) {
  std::vector<std::pair<int, double>> leaving;  // all from what was there before
  for (int i = 0; i < static_cast<int>(slopes.down.size()); ++i) {
    const double excess = static_cast<double>(water[i]) -
                          static_cast<double>(surface.areas[at(i)]) * static_cast<double>(surface.described.capacity);
    if (slopes.down[at(i)] < 0 || !(excess > 0)) continue;
    const double share = static_cast<double>(surface.described.runoff) * slopes.shares[at(i)] * seconds;
    leaving.emplace_back(i, excess * std::min(share, 1.0));
  }
  for (const auto& [particle, mass] : leaving) move(particle, slopes.down[at(particle)], mass, water, carry);
}

}  // namespace

Slopes slopes_of(const CompiledAbsorbency& surface, std::vector<double> heights) {
  constexpr double least_slope = 0.01;  // flatter is level
  Slopes slopes{std::move(heights), std::vector<int>(surface.areas.size(), -1),
                std::vector<double>(surface.areas.size(), 0.)};
  std::vector<double> steepest(surface.areas.size(), least_slope);
  const auto try_edge = [&](int from, int to, double length) {
    const double slope = (slopes.heights[at(from)] - slopes.heights[at(to)]) / length;
    if (!(slope > steepest[at(from)])) return;
    steepest[at(from)] = slope;
    slopes.down[at(from)] = to;
    slopes.shares[at(from)] = std::min(slope, 1.0) / length;
  };
  for (const CompiledAbsorbency::Edge& edge : surface.edges) {
    const auto length = static_cast<double>(edge.length);
    try_edge(edge.a, edge.b, length);
    try_edge(edge.b, edge.a, length);
  }
  return slopes;
}

void spread(const CompiledAbsorbency& surface, const Slopes& slopes, double seconds, float* water, Carry carry) {
  const int steps = steps_of(surface, seconds);
  for (int step = 0; step < steps; ++step) {
    if (surface.described.wicking > 0)
      for (std::size_t k = 0; k < surface.edges.size();
           ++k)  // in turns from either end, so that no direction is preferred
        wick(surface, surface.edges[step % 2 == 0 ? k : surface.edges.size() - 1 - k], slopes, seconds / steps, water,
             carry);
    if (surface.described.runoff > 0) run_off(surface, slopes, seconds / steps, water, carry);
  }
}

}  // namespace pliant
