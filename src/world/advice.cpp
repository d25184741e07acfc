#include "world/advice.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "constraints/registry.h"
#include "solver/visit.h"

namespace pliant {

namespace {

/// A particle up to this many edges away from a pin counts as near it.
constexpr int near_edges = 3;

std::vector<std::array<int, 2>> edges_of(const CompiledObject& object) {
  std::vector<std::array<int, 2>> edges;
  for (int type = 0; type < constraint_type_count(); ++type) {
    if (!is_length(type)) continue;
    for_constraints(object, type, [&](const ConstraintPlace&, const std::int32_t* particle) {
      edges.push_back({particle[0], particle[1]});
    });
  }
  return edges;
}

/// For each particle, 1 if the user pinned it. Targets of attachments do not count.
std::vector<char> pinned(const CompiledObject& object) {
  std::vector<char> is_pinned(object.positions.size(), 0);
  for (std::size_t i = 0; i < is_pinned.size(); ++i)
    is_pinned[i] = object.positions[i].w == 0 && object.order[i] < object.user_particles ? 1 : 0;
  return is_pinned;
}

/// The number of edges from the nearer of the particles a and b to the nearest pin, by breadth-first search; -1 if it
/// exceeds near_edges.
int edges_to_pins(const CompiledObject& object, int a, int b) {
  const std::vector<std::array<int, 2>> edges = edges_of(object);
  std::vector<char> reached = pinned(object);
  for (int away = 0; away <= near_edges; ++away) {
    if (reached[a] != 0 || reached[b] != 0) return away;
    std::vector<char> next = reached;
    for (const auto& [from, to] : edges) {
      if (reached[from] != 0 || reached[to] != 0) next[from] = next[to] = 1;
    }
    reached = std::move(next);
  }
  return -1;
}

}  // namespace

std::string two_digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, std::fabs(value) < 99.5 ? "%.2g" : std::fabs(value) < 1e15 ? "%.0f" : "%.1e", value);
  return text;
}

std::string percent(double share) { return two_digits(100 * share) + " %"; }

std::string words_of(const Overstretch& found, const CompiledObject& object) {
  const auto [a, b] = found.particles;
  const int away = edges_to_pins(object, object.place[a], object.place[b]);
  std::string text = "object '" + object.name + "': stretched " + percent(found.largest) + " too far ";
  if (away >= 0) text += away == 0 ? "at its pins " : "near its pins ";
  text += "(edge " + std::to_string(a) + "-" + std::to_string(b) + ")";
  if (found.p99 >= tolerated_p99 / 20) text += ", 1 edge in 100 by " + percent(found.p99) + " or more";
  return text;
}

std::string words_of(const TieGap& tie, const CompiledObject& object) {
  return "object '" + object.name + "': particle " + std::to_string(tie.particle) + " is " +
         two_digits(1000 * tie.gap) + " mm away from its place on " +
         words_of_body(object.bodies, tie.body, object.name) + ", " + percent(tie.gap / tie.length) +
         " of the edges there; use more substeps or a lighter body";
}

}  // namespace pliant
