#include "geometry/mass_properties.h"

#include <cmath>
#include <numbers>

namespace pliant {

namespace {

constexpr int sweeps = 12;  ///< of Jacobi's method, whose convergence is quadratic: five suffice for any 3 x 3 matrix

using Matrix = std::array<std::array<double, 3>, 3>;

Matrix full(const std::array<double, 6>& s) { return {{{s[0], s[5], s[4]}, {s[5], s[1], s[3]}, {s[4], s[3], s[2]}}}; }

std::array<double, 6> symmetric(const Matrix& m) { return {m[0][0], m[1][1], m[2][2], m[1][2], m[2][0], m[0][1]}; }

/// a b^T + b a^T, halved if a is b.
void add_product(std::array<double, 6>& s, const Vec3d& a, const Vec3d& b, double factor) {
  s[0] += factor * a.x * b.x;
  s[1] += factor * a.y * b.y;
  s[2] += factor * a.z * b.z;
  s[3] += factor * (a.y * b.z + a.z * b.y) / 2;
  s[4] += factor * (a.z * b.x + a.x * b.z) / 2;
  s[5] += factor * (a.x * b.y + a.y * b.x) / 2;
}

Matrix rotation_matrix(const Quatd& q) {
  const Vec3d x = rotate(q, Vec3d{1, 0, 0}), y = rotate(q, Vec3d{0, 1, 0}), z = rotate(q, Vec3d{0, 0, 1});
  return {{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}}};
}

/// R m R^T
Matrix turned(const Matrix& m, const Matrix& r) {
  Matrix half{}, out{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) half[i][j] += r[i][k] * m[k][j];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) out[i][j] += half[i][k] * r[j][k];
  return out;
}

Moments centred(double mass, double xx, double yy, double zz) { return {mass, {}, {xx, yy, zz, 0, 0, 0}}; }

/// A quaternion about the axis that is neither p nor q, by the angle of cosine c and sine s.
Quatd plane_rotation(int p, int q, double c, double s) {
  const double half_c = std::sqrt((1 + c) / 2), half_s = s / (2 * half_c);  // the angle is at most 45 degrees
  const double turn = (q - p + 3) % 3 == 1 ? half_s : -half_s;
  const int axis = 3 - p - q;
  return {axis == 0 ? turn : 0, axis == 1 ? turn : 0, axis == 2 ? turn : 0, half_c};
}

/// Makes element (p, q) zero, and turns the axes with it.
void rotate_away(Matrix& m, int p, int q, Quatd& axes) {
  if (m[p][q] == 0) return;
  const double theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
  const double tangent = (theta < 0 ? -1 : 1) / (std::fabs(theta) + std::sqrt(theta * theta + 1));
  const double c = 1 / std::sqrt(tangent * tangent + 1), s = tangent * c;
  const Quatd step = plane_rotation(p, q, c, -s);
  m = turned(m, rotation_matrix(conjugate(step)));
  m[p][q] = m[q][p] = 0;
  axes = normalise(multiply(axes, step));
}

}  // namespace

Moments& Moments::operator+=(const Moments& other) {
  mass += other.mass;
  first += other.first;
  for (std::size_t i = 0; i < second.size(); ++i) second[i] += other.second[i];
  return *this;
}

Moments moved(const Moments& moments, const Posed& pose) {
  Moments out;
  out.mass = moments.mass;
  const Vec3d turned_first = rotate(pose.rotation, moments.first);
  out.first = turned_first + pose.position * moments.mass;
  out.second = symmetric(turned(full(moments.second), rotation_matrix(pose.rotation)));
  add_product(out.second, turned_first, pose.position, 2);
  add_product(out.second, pose.position, pose.position, moments.mass);
  return out;
}

Moments times(const Moments& moments, double factor) {
  Moments out = moments;
  out.mass *= factor;
  out.first = out.first * factor;
  for (double& value : out.second) value *= factor;
  return out;
}

Moments moments_of_sphere(double radius) {
  const double mass = 4 * std::numbers::pi / 3 * radius * radius * radius, square = mass * radius * radius / 5;
  return centred(mass, square, square, square);
}

Moments moments_of_box(const Vec3d& half) {
  const double mass = 8 * half.x * half.y * half.z;
  return centred(mass, mass * half.x * half.x / 3, mass * half.y * half.y / 3, mass * half.z * half.z / 3);
}

Moments moments_of_cylinder(double radius, double half_length) {
  const double mass = 2 * std::numbers::pi * radius * radius * half_length, across = mass * radius * radius / 4;
  return centred(mass, across, mass * half_length * half_length / 3, across);
}

Moments moments_of_capsule(double radius, double half_length) {
  Moments out = moments_of_cylinder(radius, half_length);
  const double caps = 4 * std::numbers::pi / 3 * radius * radius * radius, across = caps * radius * radius / 5;
  const double along = caps * (half_length * half_length + 0.75 * half_length * radius + radius * radius / 5);
  return out += centred(caps, across, along, across);
}

Moments moments_of_cone(double radius, double half_length) {
  const double height = 2 * half_length, mass = std::numbers::pi / 3 * radius * radius * height,
               across = 0.15 * mass * radius * radius;
  const double centre = height / 4 - half_length;  // the variance of the height is 3/80 of its square
  Moments out = centred(mass, across, mass * (3. / 80 * height * height + centre * centre), across);
  out.first = {0, mass * centre, 0};
  return out;
}

Moments moments_of_mesh(const std::vector<Vec3d>& vertices, const std::vector<std::array<int, 3>>& triangles) {
  Moments out;
  if (vertices.empty()) return out;
  const Vec3d origin = vertices.front();
  for (const auto& triangle : triangles) {
    const auto at = [&](int corner) { return vertices[static_cast<std::size_t>(triangle[corner])] - origin; };
    const Vec3d a = at(0), b = at(1), c = at(2), sum = a + b + c;
    const double volume = dot(a, cross(b, c)) / 6;
    out.mass += volume;
    out.first += sum * (volume / 4);
    for (const Vec3d& x : {a, b, c, sum}) add_product(out.second, x, x, volume / 20);
  }
  return moved(out, {origin, {}});
}

MassProperties mass_properties(const Moments& moments) {
  if (moments.mass == 0) return {};
  MassProperties out;
  out.mass = moments.mass;
  out.centre = moments.first * (1 / moments.mass);
  std::array<double, 6> about_centre = moments.second;
  add_product(about_centre, out.centre, out.centre, -moments.mass);
  Matrix m = full(about_centre);
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (const auto& [p, q] : {std::array{0, 1}, std::array{1, 2}, std::array{2, 0}}) rotate_away(m, p, q, out.axes);
  out.inertia = {m[1][1] + m[2][2], m[2][2] + m[0][0], m[0][0] + m[1][1]};
  return out;
}

}  // namespace pliant
