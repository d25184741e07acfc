// Linear algebra of rendering beyond Vec3: 4 x 4 matrices in OpenGL's order, lengths and rotations.
#pragma once

#include <array>
#include <cmath>

#include "pliant/vec3.h"

namespace pliant::render {

inline constexpr float pi = 3.14159265f;
inline constexpr float degree = pi / 180;  ///< [rad]

inline float length(const Vec3f& v) { return std::sqrt(length_squared(v)); }

/// The unit vector v / |v|; `otherwise` if v is zero.
inline Vec3f unit(const Vec3f& v, const Vec3f& otherwise = {0, 1, 0}) {
  const float size = length(v);
  return size > 1e-20f ? v * (1 / size) : otherwise;
}

inline Vec3f rotate(const Quatf& q, const Vec3f& v) {
  const Vec3f imaginary{q.x, q.y, q.z};
  const Vec3f twice = cross(imaginary, v) * 2.f;
  return v + twice * q.w + cross(imaginary, twice);
}

/// A 4 x 4 matrix, column after column.
struct Matrix {
  std::array<float, 16> m{};
  const float* data() const { return m.data(); }
};

inline Matrix operator*(const Matrix& a, const Matrix& b) {
  Matrix result;
  for (std::size_t column = 0; column < 4; ++column)
    for (std::size_t row = 0; row < 4; ++row)
      for (std::size_t k = 0; k < 4; ++k) result.m[column * 4 + row] += a.m[k * 4 + row] * b.m[column * 4 + k];
  return result;
}

/// The camera's axes in the world: an orthonormal frame that looks along its -z.
struct ViewFrame {
  Vec3f right, up, back;
};

inline ViewFrame view_frame(const Vec3f& forward) {
  const Vec3f back = unit(-forward, {0, 0, 1});
  // If the camera looks straight up or down, the picture's up is where the viewer's back is.
  const Vec3f about = std::abs(back.y) > 0.9999f ? Vec3f{0, 0, -1} : Vec3f{0, 1, 0};
  const Vec3f right = unit(cross(about, back), {1, 0, 0});
  return {right, cross(back, right), back};
}

inline Matrix view_matrix(const ViewFrame& f, const Vec3f& eye) {
  return {{f.right.x, f.up.x, f.back.x, 0, f.right.y, f.up.y, f.back.y, 0, f.right.z, f.up.z, f.back.z, 0,
           -dot(f.right, eye), -dot(f.up, eye), -dot(f.back, eye), 1}};
}

/// The matrix of a perspective view. `half_width` and `half_height` are half the picture's size at distance 1.
inline Matrix perspective(float half_width, float half_height, float near, float far) {
  Matrix result;
  result.m[0] = 1 / half_width;
  result.m[5] = 1 / half_height;
  result.m[10] = (far + near) / (near - far);
  result.m[11] = -1;
  result.m[14] = 2 * far * near / (near - far);
  return result;
}

/// The matrix of an orthographic view of the box from `low` to `high` in camera axes; z is negative ahead.
inline Matrix orthographic(const Vec3f& low, const Vec3f& high) {
  const Vec3f size = high - low;
  return {{2 / size.x, 0, 0, 0, 0, 2 / size.y, 0, 0, 0, 0, -2 / size.z, 0, -(high.x + low.x) / size.x,
           -(high.y + low.y) / size.y, (high.z + low.z) / size.z, 1}};
}

/// The coordinates 0 to 1 of a texture instead of -1 to 1.
inline Matrix to_texture(const Matrix& clip) {
  const Matrix halve{{0.5f, 0, 0, 0, 0, 0.5f, 0, 0, 0, 0, 0.5f, 0, 0.5f, 0.5f, 0.5f, 1}};
  return halve * clip;
}

}  // namespace pliant::render
