// The shear of a triangle: by how much two directions that are square to each other at rest have closed.
//
//        2
//       / \           C(x) = atan2(f . g, |f x g|), the shear angle: pi / 2 less the angle between f and g
//      /   \          f = F d, g = F e: where the deformation takes two unit vectors d, e of the rest shape
//     0-----1
//
// The shear condition of Baraff and Witkin 1998 (4.3), here of the angle alone: stretch along d and e does no work in
// it. Unlike the sine, the angle has a gradient where a triangle is squeezed to a line. With alpha = 1 / (G A), C^2 /
// (2 alpha) is the energy of an area A with the shear modulus G [N/m]. Compliance in 1/J.
#pragma once

#include <array>

#include "pliant/formula.h"
#include "pliant/vec3.h"

namespace pliant {

struct TriangleShear {
  static constexpr const char* name = "triangle_shear";
  using slots = Points<3>;
  static constexpr int rows = 1;
  static constexpr bool is_of_woven = true;

  template <class R>
  struct Params {
    R a1, a2;  ///< D^-1 d, where D has the two edges at rest as columns, in the plane of the triangle [1/m]
    R b1, b2;  ///< D^-1 e [1/m]
  };
  static constexpr std::array<const char*, 4> fields{"a1", "a2", "b1", "b2"};

  /// C is zero, and so are its gradients, where f and g have no angle.
  template <class R>
  PLIANT_HD static R evaluate(const Vec3<R> (&x)[3], const Params<R>& p, Vec3<R> (&gradient)[3]) {
    const Vec3<R> edge1 = x[1] - x[0], edge2 = x[2] - x[0];
    const Vec3<R> f = edge1 * p.a1 + edge2 * p.a2, g = edge1 * p.b1 + edge2 * p.b2;
    const R per_f = R(1) / max(sqrt(dot(f, f)), R(1e-10f)), per_g = R(1) / max(sqrt(dot(g, g)), R(1e-10f));
    const Vec3<R> u = f * per_f, v = g * per_g, normal = cross(u, v);
    const R sine = sqrt(dot(normal, normal));  // of the angle between them
    const auto has_angle = sine > R(1e-12f);
    const R per_sine = select(has_angle, R(1) / select(has_angle, sine, R(1)), R(0));
    const Vec3<R> of_f = cross(normal, u) * (per_sine * per_f),
                  of_g = cross(v, normal) * (per_sine * per_g);  // dC/df, dC/dg
    gradient[1] = of_f * p.a1 + of_g * p.b1;
    gradient[2] = of_f * p.a2 + of_g * p.b2;
    gradient[0] = -(gradient[1] + gradient[2]);
    return select(has_angle, atan2(dot(u, v), sine), R(0));
  }

  /// Along the edge from corner 0 to corner 1, and across it; all zero, so that nothing moves, if the triangle is flat.
  template <class R>
  PLIANT_HD static Params<R> measure(const Vec3<R> (&x)[3]) {
    const Vec3<R> edge1 = x[1] - x[0], edge2 = x[2] - x[0];
    const R squared = dot(edge1, edge1), along = dot(edge1, edge2);
    const R across_squared = dot(edge2, edge2) * squared - along * along;  // of both edges' area
    const auto has_area = across_squared > squared * squared * R(1e-12f);
    const R safe = select(has_area, squared, R(1));
    const R one = select(has_area, R(1), R(0));
    const R per_length = one / sqrt(safe), per_height = sqrt(safe) / sqrt(select(has_area, across_squared, R(1))) * one;
    return {per_length, R(0), -(along / safe) * per_height, per_height};
  }
};

}  // namespace pliant
