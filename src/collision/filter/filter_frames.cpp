#include "collision/filter/filter_frames.h"

#include <algorithm>

#include "math/vector.h"

namespace pliant {

Vec3f rounded_as_positions(const Vec3f& displacement, float extent) {
  float power = 1.f / (1 << 20);
  while (power < 1e30f && power < extent + 2 * length(displacement)) power *= 2;
  const auto round = [base = 1.5f * power](float x) { return (base + x) - base; };
  return {round(displacement.x), round(displacement.y), round(displacement.z)};
}

void FilterFrames::begin() {
  root_.clear();
  are_stopped_ = false;
}

void FilterFrames::know(const FreeBodies& bodies) {
  root_.clear();
  if (std::all_of(bodies.begin(), bodies.end(), [](const FreeBody& body) { return body.group < 0; })) return;
  bodies_ = bodies;
  cuts_.assign(bodies.size(), {});
  islands_.reset(static_cast<int>(bodies.size()));
  for (int body = 0; body < islands_.size(); ++body)
    if (const int group = bodies[static_cast<std::size_t>(body)].group; group >= 0) islands_.unite(body, group);
  find_roots();
}

/// Finds roots, and how their frames move. A body that is held holds its group.
void FilterFrames::find_roots() {
  const std::size_t count = bodies_.size();
  root_.resize(count);
  std::vector<Cut> sums(count);
  std::vector<char> is_held(count, 0);
  std::vector<float> room(count, 1e30f);
  for (std::size_t body = 0; body < count; ++body) {
    const auto root = static_cast<std::size_t>(root_[body] = islands_.find(static_cast<int>(body)));
    is_held[root] = static_cast<char>(is_held[root] != 0 || bodies_[body].group < 0);
    room[root] = std::min(room[root], bodies_[body].room);
    sums[root].moved += cuts_[body].moved;
    sums[root].weight += cuts_[body].weight;
    sums[root].extent = std::max(sums[root].extent, cuts_[body].extent);
  }
  displacement_.assign(count, {});
  for (std::size_t body = 0; body < count; ++body) {
    const auto root = static_cast<std::size_t>(root_[body]);
    if (is_held[root] != 0) root_[body] = -1;
    if (root != body || is_held[root] != 0 || are_stopped_ || !(sums[root].weight > 0)) continue;
    const Vec3f mean =
        rounded_as_positions(convert<float>(sums[root].moved * (1 / sums[root].weight)), sums[root].extent);
    if (length(mean) < room[root]) displacement_[root] = mean;
  }
}

void FilterFrames::move(const std::vector<Cut>& cuts) {
  std::vector<char> has_cuts(cuts.size(), 0);  // [root]
  for (std::size_t body = 0; body < cuts.size(); ++body)
    if (root_[body] >= 0 && cuts[body].weight > 0) has_cuts[static_cast<std::size_t>(root_[body])] = 1;
  for (std::size_t body = 0; body < cuts.size(); ++body)
    if (root_[body] >= 0 && has_cuts[static_cast<std::size_t>(root_[body])] != 0) cuts_[body] = cuts[body];
  find_roots();
}

bool FilterFrames::unite(const std::vector<PairStencil>& pairs) {
  if (pairs.empty()) return false;
  const std::vector<int>& body = model_.shared->vertex_body;
  for (const PairStencil& pair : pairs)
    islands_.unite(body[static_cast<std::size_t>(pair.vertex[0])], body[static_cast<std::size_t>(pair.vertex[3])]);
  find_roots();
  return true;
}

void FilterFrames::stop() {
  are_stopped_ = true;
  std::fill(displacement_.begin(), displacement_.end(), Vec3f{});
}

}  // namespace pliant
