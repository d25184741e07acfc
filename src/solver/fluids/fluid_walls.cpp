#include "solver/fluids/fluid_walls.h"

#include <algorithm>

#include "core/at.h"

namespace pliant {

namespace {

/// Primitive colliders meet every object.
bool can_meet(const CompiledObject& liquid, const MovingCollider& collider) {
  return collider.field == nullptr || ((liquid.groups & collider.mask) != 0 && (collider.groups & liquid.mask) != 0);
}

/// What the walls near a place take of its kernel.
struct Walls {
  std::int32_t which[most_walls] = {};
  float share[most_walls] = {};
  Vec3f slope[most_walls] = {};
  int count = 0;

  /// The gradient of 1 - product of (1 - share) that comes from one of them.
  Vec3f gradient(int wall) const {
    float others = 1;
    for (int i = 0; i < count; ++i) others *= i == wall ? 1 : 1 - share[i];
    return slope[wall] * others;
  }
  float sum() const {
    float left = 1;
    for (int i = 0; i < count; ++i) left *= 1 - share[i];
    return 1 - left;
  }
};

Walls walls_near(const FluidLaw& law, const FluidBounds& bounds, const std::int32_t* first, const std::int32_t* last,
                 const Vec3f& place) {
  Walls walls;
  for (; first != last && walls.count < most_walls; ++first) {
    const SurfaceDistance<float> to = distance_to(bounds.at(*first), place);
    if (!(to.distance < law.reach)) continue;
    const float t = 1 - std::max(to.distance, 0.f) / law.reach;
    walls.which[walls.count] = *first;
    walls.share[walls.count] = law.wall_scale * share_behind_plane(t);
    walls.slope[walls.count++] = to.normal * (law.wall_scale * slope_behind_plane(t) / law.reach);
  }
  return walls;
}

/// The box of a group of slots.
BoundingBox<float> box_of(const Records& places, int first, int last) {
  const Record& p = places[at(first)];
  BoundingBox<float> box{{p.x, p.y, p.z}, {p.x, p.y, p.z}};
  for (int slot = first + 1; slot < last; ++slot) {
    const Record& q = places[at(slot)];
    box.low = {std::min(box.low.x, q.x), std::min(box.low.y, q.y), std::min(box.low.z, q.z)};
    box.high = {std::max(box.high.x, q.x), std::max(box.high.y, q.y), std::max(box.high.z, q.z)};
  }
  return box;
}

bool is_within(const BoundingBox<float>& a, const BoundingBox<float>& b, float distance) {
  return !(a.low.x > b.high.x + distance || a.low.y > b.high.y + distance || a.low.z > b.high.z + distance ||
           b.low.x > a.high.x + distance || b.low.y > a.high.y + distance || b.low.z > a.high.z + distance);
}

float largest_of(const Vec3f& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

/// True if no point of a box can be within a distance of a primitive: its middle is too far, beyond all rounding.
/// Distances to primitives grow no faster than ways; those to grids may.
bool is_beyond(const MovingCollider& wall, const BoundingBox<float>& box, float distance) {
  if (wall.field != nullptr) return false;
  const Vec3f middle = (box.low + box.high) * 0.5f, half = (box.high - box.low) * 0.5f;
  const float rounding = 1e-5f * (largest_of(middle) + largest_of(convert<float>(wall.after.position)) + distance);
  return distance_to(wall, middle).distance > distance + sqrt(length_squared(half)) + rounding;
}

}  // namespace

SurfaceDistance<float> distance_to(const MovingCollider& collider, const Vec3f& place) {
  const Vec3f local = to_local(collider.after, place);
  SurfaceDistance<float> to =
      collider.field != nullptr ? collider.field->distance(local) : signed_distance(collider.shape, local);
  return {to.distance - collider.thickness, rotate(collider.after.rotation, to.normal)};
}

const MovingCollider& FluidBounds::at(std::int32_t i) const {
  const int first = number_of_colliders();
  return i < first ? (*colliders)[static_cast<std::size_t>(i)] : (*solids)[static_cast<std::size_t>(i - first)];
}

void FluidWalls::find_in_task(const CompiledObject& liquid, const NeighbourLists& lists, const Records& places,
                              const FluidBounds& bounds, float distance, int task) {
  auto& [near, ends] = found_[at(task)];
  near.clear();
  ends.clear();
  const int colliders = bounds.number_of_colliders(), all = colliders + bounds.number_of_solids();
  const int first_group = task * NeighbourLists::groups_in_a_task;
  const int last_group = std::min(first_group + NeighbourLists::groups_in_a_task, lists.groups());
  for (int g = first_group; g < last_group; ++g) {
    const int first = g * NeighbourLists::lanes, last = std::min(first + NeighbourLists::lanes, lists.slots());
    const BoundingBox<float> box = box_of(places, first, last);
    for (int c = 0; c < all; ++c) {
      const MovingCollider& wall = bounds.at(c);
      if (c < colliders ? !can_meet(liquid, wall) : bounds.meets[at(c - colliders)] == 0) continue;
      if (!is_within(box, wall.swept, distance) || is_beyond(wall, box, distance)) continue;
      const auto is_near = [&](const Record& p) { return distance_to(wall, {p.x, p.y, p.z}).distance < distance; };
      if (std::any_of(places.begin() + first, places.begin() + last, is_near)) near.push_back(c);
    }
    ends.push_back(static_cast<std::int32_t>(near.size()));
  }
}

void FluidWalls::find(Executor& executor, const CompiledObject& liquid, const NeighbourLists& lists,
                      const Records& places, const FluidBounds& bounds, float reach, float motion) {
  begin_.assign(1, 0);
  near_.clear();
  near_solids_.clear();
  first_solid_.assign(1, 0);
  has_any_.assign(at(lists.groups()), 0);
  shares_.resize(places.size());
  found_.resize(at(lists.tasks()));
  executor.parallel_for("neighbours: walls", lists.tasks(),
                        [&](int task) { find_in_task(liquid, lists, places, bounds, reach + motion, task); });
  const int colliders = bounds.number_of_colliders();
  for (const Found& found : found_) {
    std::int32_t first = 0;
    for (const std::int32_t last : found.last) {
      const auto group = static_cast<std::int32_t>(begin_.size()) - 1;
      for (; first < last; ++first) {
        const std::int32_t wall = found.near[at(first)];
        near_.push_back(wall);
        if (wall >= colliders) near_solids_.push_back({group, wall - colliders});
      }
      begin_.push_back(static_cast<std::int32_t>(near_.size()));
      first_solid_.push_back(static_cast<int>(near_solids_.size()));
    }
  }
}

void FluidWalls::measure(const FluidKernels& kernels, const FluidLaw& law, const FluidBounds& bounds,
                         const Records& places, int group) {
  const std::int32_t *first = near_.data() + begin_[at(group)], *last = near_.data() + begin_[at(group) + 1];
  has_any_[at(group)] = first != last ? 1 : 0;
  if (first == last) return;
  const auto is_field = [&](std::int32_t wall) { return bounds.at(wall).field != nullptr; };
  if (last - first > most_walls || std::any_of(first, last, is_field))
    return measure_one_by_one(law, bounds, places, group);
  const int colliders = bounds.number_of_colliders();
  WallQuery query;
  query.law = law;
  NearSolid* solid = near_solids_.data() + first_solid_[at(group)];
  for (; first != last; ++first) {
    const MovingCollider& from = bounds.at(*first);
    Wall& wall = query.walls[query.count++];
    wall.shape = from.shape;
    wall.pose = from.after;
    wall.thickness = from.thickness;
    if (*first < colliders) continue;
    solid->touched = 0;
    wall.gradients = solid->gradient;
    wall.touched = &solid++->touched;
  }
  query.places = places.data() + at(group) * NeighbourLists::lanes;
  query.shares = shares_.data() + at(group) * NeighbourLists::lanes;
  kernels.measure_walls(query);
}

/// The same for walls with distance fields, or very many of them.
void FluidWalls::measure_one_by_one(const FluidLaw& law, const FluidBounds& bounds, const Records& places, int group) {
  const std::int32_t *first = near_.data() + begin_[at(group)], *last = near_.data() + begin_[at(group) + 1];
  const int first_solid = first_solid_[at(group)], colliders = bounds.number_of_colliders();
  for (int i = first_solid; i < first_solid_[at(group) + 1]; ++i)
    near_solids_[at(i)] = {group, near_solids_[at(i)].solid};
  for (int lane = 0; lane < NeighbourLists::lanes; ++lane) {
    const std::size_t slot = at(group) * NeighbourLists::lanes + at(lane);
    const Walls walls = walls_near(law, bounds, first, last, {places[slot].x, places[slot].y, places[slot].z});
    Vec3f gradient{};
    int solid = first_solid;
    for (int i = 0; i < walls.count; ++i) {
      const Vec3f of_wall = walls.gradient(i);
      gradient += of_wall;
      if (walls.which[i] < colliders) continue;
      while (near_solids_[at(solid)].solid != walls.which[i] - colliders) ++solid;
      near_solids_[at(solid)].gradient[lane] = of_wall;
      ++near_solids_[at(solid)].touched;
    }
    shares_[slot] = {gradient.x, gradient.y, gradient.z, walls.sum()};
  }
}

std::vector<WallGradient> FluidWalls::gradients(const FluidLaw& law, const FluidBounds& bounds, const Vec3f& place,
                                                int group) const {
  const std::int32_t *first = near_.data() + begin_[at(group)], *last = near_.data() + begin_[at(group) + 1];
  const Walls walls = walls_near(law, bounds, first, last, place);
  std::vector<WallGradient> all;
  all.reserve(at(walls.count));
  for (int i = 0; i < walls.count; ++i) all.push_back({walls.which[i], walls.gradient(i)});
  return all;
}

}  // namespace pliant
