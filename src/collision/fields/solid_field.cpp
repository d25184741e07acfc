#include "collision/fields/solid_field.h"

namespace pliant {

namespace {

constexpr float far_away = 1e15f;
/// Share of the distance that a step along a path may use. A trilinear distance grows by at most one along each axis,
/// so by at most sqrt(3) in any direction; 0.57 < 1 / sqrt(3).
constexpr float safe_share = 0.57f;
constexpr int most_strides = 4096;

}  // namespace

SolidField::SolidField(Heightfield heights) : heights_(std::move(heights)) {
  const BoxBounds& box = heights_->bounds();
  underside_ = box.low.y - max(box.high.x - box.low.x, box.high.z - box.low.z);
}

SurfaceDistance<float> SolidField::distance(const Vec3f& p) const {
  if (grid_) return grid_->sample(p);
  Vec3f corner, normal;
  if (!heights_->column(p, corner, normal)) return {far_away, {0, 1, 0}};
  const float above = dot(normal, p - corner), below = underside_ - p.y;
  return below > above ? SurfaceDistance<float>{below, {0, -1, 0}} : SurfaceDistance<float>{above, normal};
}

BoxBounds SolidField::bounds() const {
  BoxBounds box = grid_ ? grid_->bounds() : heights_->bounds();
  if (heights_) box.low.y = underside_;
  return box;
}

FirstHit<float> SolidField::first_hit(const Vec3f& a, const Vec3f& b, float margin) const {
  const Vec3f path = b - a;
  const float way = length(path), stride = grid_ ? 0.25f * grid_->spacing() : 0.5f * heights_->smaller_cell();
  const auto at = [&](float t) { return t < 1 ? a + path * t : b; };
  SurfaceDistance<float> here = distance(a);
  if (here.distance <= margin) return {true, 0, a, here.normal, here.distance};
  if (!(way < far_away) || (is_above(a, margin) && is_above(b, margin)) || (is_below(a, margin) && is_below(b, margin)))
    return {};
  const float least = max(stride / max(way, 1e-30f), 1.f / most_strides);
  float t = 0;
  while (t < 1) {
    const float safe = grid_ ? safe_share * (here.distance - margin) / way : 0.f, next = min(t + max(least, safe), 1.f);
    SurfaceDistance<float> there = distance(at(next));
    if (there.distance <= margin) {
      float outside = t, inside = next;
      for (int halving = 0; halving < 12; ++halving) {
        const float middle = 0.5f * (outside + inside);
        (distance(at(middle)).distance <= margin ? inside : outside) = middle;
      }
      there = distance(at(outside));
      if (!(there.distance < far_away)) return {};  // the path entered through an open side of the terrain
      return {true, outside, at(outside), there.normal, there.distance};
    }
    here = there;
    t = next;
  }
  return {};
}

}  // namespace pliant
