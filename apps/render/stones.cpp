#include "stones.h"

#include <algorithm>
#include <cmath>

#include "matrix.h"

namespace pliant::render {

namespace {

/// The distance from its middle at which a stone ends in a direction: that of a ball with a few flat sides.
float stone_radius(const Vec3f& direction) {
  constexpr int sides = 11;
  float result = 1.02f;
  for (int i = 0; i < sides; ++i) {
    const float along = 1 - 2 * (static_cast<float>(i) + 0.5f) / sides, angle = 2.3999632f * static_cast<float>(i);
    const float across = std::sqrt(1 - along * along);
    const float cosine = dot(direction, {across * std::cos(angle), along, across * std::sin(angle)});
    const float away = 0.82f + 0.025f * static_cast<float>(i * 5 % 7);
    if (cosine > 0.5f) result = std::min(result, away / cosine);
  }
  return result;
}

}  // namespace

void make_uneven(Geometry& ball) {
  constexpr float step = 0.15f;  // over which the normal is taken, so that edges are round
  for (Vertex& vertex : ball.vertices) {
    const Vec3f n = vertex.normal;
    const ViewFrame frame = view_frame(n);
    const auto point = [&](float right, float up) {
      const Vec3f direction = unit(n + frame.right * right + frame.up * up);
      return direction * stone_radius(direction);
    };
    vertex.position = n * stone_radius(n);
    const Vec3f across = cross(point(step, 0) - point(-step, 0), point(0, step) - point(0, -step));
    vertex.normal = unit(dot(across, n) < 0 ? -across : across);
  }
}

}  // namespace pliant::render
