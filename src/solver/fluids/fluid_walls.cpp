#include "solver/fluids/fluid_walls.h"

#include <algorithm>

namespace pliant {

namespace {

std::size_t at(std::int64_t i) { return static_cast<std::size_t>(i); }

/// The distance from a place to a collider at the substep's end, and its normal in world axes.
SurfaceDistance<float> distance_to(const MovingCollider& collider, const Vec3f& place) {
  const Vec3f local = to_local(collider.after, place);
  SurfaceDistance<float> to =
      collider.field != nullptr ? collider.field->distance(local) : signed_distance(collider.shape, local);
  return {to.distance - collider.thickness, rotate(collider.after.rotation, to.normal)};
}

/// Primitive colliders meet every object.
bool can_meet(const CompiledObject& liquid, const MovingCollider& collider) {
  return collider.field == nullptr || ((liquid.groups & collider.mask) != 0 && (collider.groups & liquid.mask) != 0);
}

/// What the walls so far leave of a kernel, and the gradient of what they take.
struct Left {
  float share = 1;
  Vec3f gradient{};

  void take(float of_wall, const Vec3f& slope) {
    gradient = gradient * (1 - of_wall) + slope * share;
    share *= 1 - of_wall;
  }
};

Left left_by(const FluidLaw& law, const std::vector<MovingCollider>& colliders, const std::int32_t* first,
             const std::int32_t* last, const Vec3f& place) {
  Left left;
  for (; first != last; ++first) {
    const SurfaceDistance<float> to = distance_to(colliders[at(*first)], place);
    if (!(to.distance < law.reach)) continue;
    const float t = 1 - std::max(to.distance, 0.f) / law.reach;
    left.take(law.wall_scale * share_behind_plane(t), to.normal * (law.wall_scale * slope_behind_plane(t) / law.reach));
  }
  return left;
}

}  // namespace

void FluidWalls::find(const CompiledObject& liquid, const NeighbourLists& lists, const Records& places,
                      const std::vector<MovingCollider>& colliders, float reach, float motion) {
  begin_.assign(1, 0);
  near_.clear();
  has_any_.assign(at(lists.groups()), 0);
  shares_.resize(places.size());
  for (int g = 0; g < lists.groups(); ++g) {
    const int first = g * NeighbourLists::lanes, last = std::min(first + NeighbourLists::lanes, lists.slots());
    for (std::size_t c = 0; c < colliders.size(); ++c) {
      if (!can_meet(liquid, colliders[c])) continue;
      const auto is_near = [&](const Record& p) {
        return distance_to(colliders[c], {p.x, p.y, p.z}).distance < reach + motion;
      };
      if (std::any_of(places.begin() + first, places.begin() + last, is_near))
        near_.push_back(static_cast<std::int32_t>(c));
    }
    begin_.push_back(static_cast<std::int32_t>(near_.size()));
  }
}

void FluidWalls::measure(const FluidLaw& law, const std::vector<MovingCollider>& colliders, const Records& places,
                         int group) {
  const std::int32_t *first = near_.data() + begin_[at(group)], *last = near_.data() + begin_[at(group) + 1];
  has_any_[at(group)] = first != last ? 1 : 0;
  if (first == last) return;
  for (std::size_t slot = at(group) * NeighbourLists::lanes; slot < at(group + 1) * NeighbourLists::lanes; ++slot) {
    const Left left = left_by(law, colliders, first, last, {places[slot].x, places[slot].y, places[slot].z});
    shares_[slot] = {left.gradient.x, left.gradient.y, left.gradient.z, 1 - left.share};
  }
}

}  // namespace pliant
